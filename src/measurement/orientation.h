/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which channel is which: the ratio of the speeds against the tooth numbers, directions, units and the stated speed. */
#ifndef EASEOFF_MEASUREMENT_ORIENTATION_H
#define EASEOFF_MEASUREMENT_ORIENTATION_H

#include "measurement/angles.h"

/* Sets angles->from and factor so that both angles rise and their ratio is that of the teeth; says what had to be
   changed. A ratio that no exchange, direction or unit explains is refused, with the nearest ratio of tooth numbers.
   stated: pinion speed, rad/s; NaN: not known. */
void eo_orientation_judge(struct eo_angles *angles, const int teeth[2], double stated, struct eo_findings *findings);

/* The tooth numbers whose ratio is `ratio` (relative tolerance): one of the two teeth kept where that is possible, else
   the smallest. False when there are none up to 400 teeth. */
bool eo_orientation_nearest(double ratio, double tolerance, const int teeth[2], int nearest[2]);

#endif
