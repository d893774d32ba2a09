/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Values between samples by the polynomial through the nearest ones, and what that does to a wave. */
#ifndef EASEOFF_RECORDING_INTERPOLATION_H
#define EASEOFF_RECORDING_INTERPOLATION_H

#include <complex.h>

enum { EO_INTERPOLATION_POINTS = 16, EO_INTERPOLATION_PLACES = 16 };

/* Where between two samples the values of a channel were wanted. */
struct eo_interpolation {
  double step;                               /* s between the samples; 0: nothing was interpolated */
  double share[EO_INTERPOLATION_PLACES + 1]; /* of the values, by place; the last: those of a sample itself */
};

/* weight[EO_INTERPOLATION_POINTS] of samples at these times for the value at t (Lagrange). */
void eo_interpolation_weights(const double *time, double t, double *weight);

/* What is left of a wave whose phase goes on by `phase` rad from sample to sample, as a factor of its amplitude: the
   mean over the places; what differs from place to place is noise at other orders. 1 where nothing was interpolated. */
double complex eo_interpolation_gain(const struct eo_interpolation *interpolation, double phase);

#endif
