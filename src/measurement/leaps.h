/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows that are missing while time and angles go on as if nothing were: sums of increments whose rows are numbered. The
   vibration alone tells: the orders of the mesh keep their amplitudes and leap in phase, each by its own multiple of
   one angle. */
#ifndef EASEOFF_MEASUREMENT_LEAPS_H
#define EASEOFF_MEASUREMENT_LEAPS_H

#include "measurement/transmission.h"

/* Where it leaps, a run ends and, a turn of the pinion or more behind it, another one begins; the finding says so. More
   than angles hold: a refusing finding. Errors: memory, of reading, cancelled. */
enum eo_code eo_leaps_cut(struct eo_angles *angles, const struct eo_transmission_settings *settings,
                          struct eo_findings *findings, const struct eo_progress *progress, struct eo_error *error);

#endif
