/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Times counted by something that starts again: micros() of a microcontroller after 2^32 us, a timer of 16 bits, the
   seconds of a day. Internal to the readers. */
#ifndef EASEOFF_RECORDING_OVERFLOW_H
#define EASEOFF_RECORDING_OVERFLOW_H

#include "recording/column.h"

/* turn[columns]: after how much of its own unit a column of times starts again, 0 where it does not, or not each time
   after what counters have. look[columns]: of the first rows. Errors of reading. */
enum eo_code eo_overflow_find(const struct eo_recording *recording, const struct eo_column *look, double *turn,
                              struct eo_error *error);

#endif
