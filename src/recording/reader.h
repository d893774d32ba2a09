/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rig files of every kind, told apart by their content and read into a recording: the one entry to the readers.
   Files are hostile until read: every length is checked, memory is bounded, and what is wrong is said with its line or
   byte. */
#ifndef EASEOFF_RECORDING_READER_H
#define EASEOFF_RECORDING_READER_H

#include "base/error.h"
#include "base/progress.h"
#include "recording/notes.h"
#include "recording/recording.h"

#include <stdint.h>

enum eo_reader_kind {
  EO_READER_TEXT,   /* delimited text */
  EO_READER_MATLAB, /* .mat of versions 4, 5, 7 and 7.3 */
  EO_READER_OCTAVE, /* text of Octave's own, with the names and types of variables */
  EO_READER_TDMS,   /* NI TDMS */
  EO_READER_UFF,    /* universal file, data sets 58 and 58b */
  EO_READER_HDF5,
  EO_READER_MDF,     /* ASAM MDF 4 */
  EO_READER_ARCHIVE, /* zip or tar with files of these kinds in it, .xlsx, .ods */
  EO_READER_KINDS
};

/* How a text file is to be read; 0 in a member: guess it. */
struct eo_text_choice {
  char separator;     /* ',' ';' '\t', or ' ' for runs of blanks and tabs */
  char point;         /* '.' or ',' */
  int64_t first_line; /* line of the first row of numbers, from 1 */
};

struct eo_reader_options {
  const char *spool_directory; /* for temporary files; NULL: none, larger recordings are then refused */
  int64_t max_bytes;           /* of content, inflated; 0: EO_READER_BYTES */
  double seconds;              /* of a processor, for formats that are read in a process of their own; 0: ten minutes */
  struct eo_text_choice text;
  const struct eo_progress *progress; /* NULL: nobody watches */
  const char *unpack_to;              /* only between the readers: file for what comes out of an archive, */
  int unpack_number;                  /* and which of its files that is, from 0 */
};

#define EO_READER_BYTES ((int64_t)16 << 30)

/* Reads the file into a new recording that the caller frees. notes: what was found, guessed or left out (added to, may
   be NULL). options may be NULL. Errors: EO_ERROR_INPUT (what is wrong with the file and where), EO_ERROR_FILE,
   EO_ERROR_MEMORY, EO_ERROR_CANCELLED. */
enum eo_code eo_reader_read(const char *path, const struct eo_reader_options *options, struct eo_recording **recording,
                            struct eo_notes *notes, struct eo_error *error);

#endif
