/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Values that stand for lost ones (-9999, 99999, 0 amid a running counter): one number, far from what stands before and
   behind it wherever it is, in a column that goes one way otherwise. */
#ifndef EASEOFF_RECORDING_LOST_H
#define EASEOFF_RECORDING_LOST_H

#include "recording/notes.h"
#include "recording/recording.h"

/* Columns are read without such values from then on: eo_recording_set_lost(). Notes say so. Errors: memory, files. */
enum eo_code eo_lost_find(struct eo_recording *recording, struct eo_notes *notes, struct eo_error *error);

#endif
