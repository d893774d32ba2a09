/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Times written as steps from row to row: a column called dt, or the periods of the pulses of two encoders. Internal to
   the readers. */
#ifndef EASEOFF_RECORDING_STEPS_H
#define EASEOFF_RECORDING_STEPS_H

#include "recording/column.h"

/* steps[columns]: whether the sums of a column are the times. look[columns]: of the
   first rows. */
void eo_steps_find(const struct eo_recording *recording, const struct eo_column *look, bool *steps);

#endif
