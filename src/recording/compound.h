/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Columns that are one number only together: whole seconds beside nanoseconds, degrees beside minutes and seconds of
   arc; and steps of time, which are times only when they are summed up. Internal to the readers. */
#ifndef EASEOFF_RECORDING_COMPOUND_H
#define EASEOFF_RECORDING_COMPOUND_H

#include "recording/notes.h"
#include "recording/recording.h"

/* Replaces a recording with such columns by one in which each group of them is one column, in the place of its first
   part, and in which steps of time are times; the old one is freed. Others stay as they are. spool_directory: see
   eo_recording_new(). Errors: EO_ERROR_MEMORY, EO_ERROR_FILE; *recording is then as it was. */
enum eo_code eo_compound_join(struct eo_recording **recording, const char *spool_directory, struct eo_notes *notes,
                              struct eo_error *error);

#endif
