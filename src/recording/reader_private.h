/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The readers behind eo_reader_read(), one per kind, shared by the files that are them. Each makes a new recording or
   fails; what eo_reader_read says of errors and notes holds for them; options and its progress are never NULL. */
#ifndef EASEOFF_RECORDING_READER_PRIVATE_H
#define EASEOFF_RECORDING_READER_PRIVATE_H

#include "recording/reader.h"
#include "recording/series.h"
#include "recording/source.h"

/* Delimited text from a source at its beginning; it stays the caller's. */
enum eo_code eo_delimited_read(struct eo_source *source, const struct eo_reader_options *options,
                               struct eo_recording **recording, struct eo_notes *notes, struct eo_error *error);

eo_series_reader eo_mdf_read, eo_octave_read, eo_tdms_read, eo_uff_read;
eo_series_reader eo_matlab_read, eo_hdf5_read; /* only by eo_isolate_read */

#endif
