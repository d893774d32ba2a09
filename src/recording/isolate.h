/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Readers that rest on libraries which were not written for hostile files run in a process of their own: when it
   crashes, runs out of memory or time, that is an error of the file and nothing more. Internal to the readers. */
#ifndef EASEOFF_RECORDING_ISOLATE_H
#define EASEOFF_RECORDING_ISOLATE_H

#include "recording/series.h"

#define EO_ISOLATE_MEMORY ((size_t)1 << 30) /* bytes that the process may take beyond what it was born with */
#define EO_ISOLATE_SECONDS 600              /* of the processor */

/* What reader would do, with the same errors; EO_ERROR_INPUT when its process ends without an answer. The process is a
   copy of this one and calls nothing but reader; other threads of this one go on. Progress is asked for cancellation
   while it works. */
enum eo_code eo_isolate_read(eo_series_reader *reader, const char *path, const struct eo_reader_options *options,
                             const struct eo_series_sink *sink, struct eo_notes *notes, struct eo_error *error);

#endif
