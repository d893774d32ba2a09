/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files that hold each channel in one piece (TDMS, UFF, MATLAB, HDF5): which channels make a table, and copying them
   into rows. Internal to the readers. */
#ifndef EASEOFF_RECORDING_SERIES_H
#define EASEOFF_RECORDING_SERIES_H

#include "recording/notes.h"
#include "recording/reader.h"
#include "recording/recording.h"
#include "recording/stated.h"

#include <stdbool.h>

#define EO_SERIES 1024 /* channels of a file that are looked at */

struct eo_series {
  char name[EO_RECORDING_NAME];
  char unit[EO_RECORDING_UNIT];
  int64_t length;
  struct eo_clock clock; /* its column: number of the series with the times of this one, -1: none */
  double turn;           /* counts per turn; 0: not stated */
  double tick;           /* s of a tick, where the file states one; 0: not */
};

/* A series of this name and length whose clock is not known. */
void eo_series_init(struct eo_series *series, const char *name, int64_t length);

/* Takes what a number under a key says of a series (interval, start, tick, counts per turn); scale and offset are the
   reader's. An interval that contradicts the one that is there stands beside it. False when the key says nothing of
   that. */
bool eo_series_state(struct eo_series *series, const struct eo_stated *stated);

/* The intervals are not those of one rate; they may be rounded. */
bool eo_series_contradicts(double interval, double other);

/* Takes an interval and a number of samples for a row to a clock. */
void eo_series_tell(struct eo_clock *clock, const struct eo_stated *stated);

/* What the number of samples for a row makes of the stated rates, once all are known: of two whose ratio it is the rows
   have the lower one, that of stored rows is theirs anyway; else the other rate is set, since nobody can know. */
void eo_series_settle(struct eo_clock *clock);

/* Where the table goes: once its columns, then all rows in order. */
struct eo_series_sink {
  enum eo_code (*begin)(void *context, const struct eo_series *column, int columns, struct eo_error *error);
  enum eo_code (*rows)(void *context, const double *rows, int64_t count, struct eo_error *error); /* [count][columns] */
  void *context;
};

/* The channels of a file that is open. read copies values first .. first + count - 1 of a channel; calls for one
   channel go forwards. */
struct eo_series_file {
  const struct eo_series *series; /* [count] */
  int count;
  int64_t bytes; /* size of the file */
  int64_t limit; /* bytes of the table at most */
  enum eo_code (*read)(void *context, int series, int64_t first, int64_t count, double *values, struct eo_error *error);
  void *context;
};

/* A reader of one kind of file; max_bytes of the options is set. */
typedef enum eo_code eo_series_reader(const char *path, const struct eo_reader_options *options,
                                      const struct eo_series_sink *sink, struct eo_notes *notes,
                                      struct eo_error *error);

/* Hands all channels that are long enough, and torque and speed of a slower clock, to the sink row by row, each with
   its clock; what is left out is noted. Where there are more than a recording holds, those that share interval and
   length with the most come first. Errors: EO_ERROR_INPUT: no channel with data, a table that is far larger than its
   file, and those of read and sink. */
enum eo_code eo_series_copy(const struct eo_series_file *file, const struct eo_series_sink *sink,
                            struct eo_notes *notes, struct eo_error *error);

/* A sink that fills a new recording. It is NULL until begin; the caller frees it. */
struct eo_series_recorder {
  struct eo_recording *recording;
  const char *spool_directory;
  const struct eo_progress *progress;
  int64_t total;
};
struct eo_series_sink eo_series_recorder_sink(struct eo_series_recorder *recorder);

#endif
