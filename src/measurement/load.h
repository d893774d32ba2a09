/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Torque and speed columns of a recording over the part that is measured, and what they say against what was stated. */
#ifndef EASEOFF_MEASUREMENT_LOAD_H
#define EASEOFF_MEASUREMENT_LOAD_H

#include "base/progress.h"
#include "measurement/finding.h"
#include "recording/recording.h"
#include "recording/tracks.h"

/* One column; mean NaN: there is none. */
struct eo_load_column {
  double mean, low, high; /* N m or rad/s, not signed; low and high of means over fiftieths of the part */
};

struct eo_load {
  struct eo_load_column torque[2], speed[2]; /* [member] */
  bool open[2];                              /* [member]: nothing states the unit of the speed; rpm are a guess */
  bool unnamed;                              /* the name of the pinion's speed tells no shaft */
  double pinion_torque;                      /* N m, from the columns; NaN: none tells */
};

struct eo_load_known {
  int teeth[2];
  double torque, speed; /* stated, of the pinion, N m and rad/s; NaN: not */
  double measured;      /* of the pinion by its encoder, rad/s */
  double expected[2];   /* lowest and highest speed of the load cases, rad/s; 0: not known */
};

/* Means over rows from .. to, s after the first row; columns with a clock of their own by that. Errors: memory, files.
 */
enum eo_code eo_load_read(struct eo_load *load, const struct eo_recording *recording, const struct eo_tracks *tracks,
                          double from, double to, struct eo_error *error);

/* Settles the unit of a speed that states none by the encoder, and adds findings: a torque that is not steady or not
   the stated one, a speed that is not the encoder's, a speed far from every load case of which nothing else tells. */
void eo_load_judge(struct eo_load *load, const struct eo_load_known *known, struct eo_findings *findings);

#endif
