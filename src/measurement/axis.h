/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The order axis: the angle that the pinion was measured at. Orders belong to the angle, not to the time, so no change
   of speed smears them. What moves the reading but not the mesh is taken out again: the shaft orders of an eccentric
   encoder, and of run-out of either gear, which a light pinion follows, move the mesh by a phase e(theta), which takes
   the mesh order h down to J0(h z |e|) of itself; noise of standard deviation s takes it down to
   exp(-(h z s)^2 / 2). */
#ifndef EASEOFF_MEASUREMENT_AXIS_H
#define EASEOFF_MEASUREMENT_AXIS_H

#include <complex.h>

#include "measurement/orders.h"

struct eo_axis {
  double sign;     /* -1: the part turns backwards */
  double ratio[2]; /* [member]: turns of the shaft per turn of the pinion */
  /* rad, [member]: the encoder shows theta + sum over members of share Re sum swing[k] exp(i (k + 1) ratio theta) */
  double complex swing[2][EO_SHAFT_ORDERS];
  double share[2]; /* [member]: of the swing that is taken out, 0..1 */
};

/* The pinion's angle at a reading of its encoder, both rad. */
double eo_axis_angle(const struct eo_axis *axis, double reading);

/* The swing with one shaft at an angle, all of it, rad. */
double eo_axis_swing(const struct eo_axis *axis, int member, double theta);

/* What is left of an order on an axis that still has these shares of the swings in it, 0..1. */
double eo_axis_loss(const struct eo_axis *axis, double order, const double share[2]);

/* Noise of the readings from their third differences, which no steady change of speed reaches: of white noise they have
   20 times the variance. Rows that are uneven in time leave differences by their numbers, times that are not exact
   leave differences by their times: the smaller one is noise. The median over blocks of rows, so that a gap does not
   count. Rows one after the other; time s, angle rad. */
#define EO_AXIS_WEIGHTS 20.0
enum { EO_AXIS_BLOCK = 64, EO_AXIS_BLOCKS = 2048 };
struct eo_axis_reading {
  double time, angle;
};
struct eo_axis_noise {
  struct eo_axis_reading reading[4]; /* the last three; the fourth is the one that is added */
  int64_t rows;
  double square[2]; /* sums of the squared third differences of the block: by rows, by time */
  int64_t blocks;
  double mean_square[2][EO_AXIS_BLOCKS]; /* of the last blocks */
};
void eo_axis_noise_add(struct eo_axis_noise *noise, double time, double angle);
double eo_axis_noise_sigma(struct eo_axis_noise *noise); /* rad; at the end */

#endif
