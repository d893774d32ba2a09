/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Values between samples by the polynomial through the nearest ones, and what that does to a wave. */
#ifndef EASEOFF_RECORDING_INTERPOLATION_H
#define EASEOFF_RECORDING_INTERPOLATION_H

#include <complex.h>

enum {
  EO_INTERPOLATION_EVEN = 32,   /* samples of a polynomial where they are even */
  EO_INTERPOLATION_UNEVEN = 16, /* where they are not: a longer one would swing */
  EO_INTERPOLATION_PLACES = 16
};

/* Where between two samples the values of a channel were wanted. */
struct eo_interpolation {
  int points;                                /* of the polynomial */
  double step;                               /* s between the samples; 0: nothing was interpolated */
  double share[EO_INTERPOLATION_PLACES + 1]; /* of the values, by place; the last: those of a sample itself */
};

/* weight[points] of samples at these times for the value at t (Lagrange). */
void eo_interpolation_weights(int points, const double *time, double t, double *weight);

/* What is left of a wave whose phase goes on by `phase` rad from sample to sample, as a factor of its amplitude: the
   mean over the places; what differs from place to place is noise at other orders. 1 where nothing was interpolated. */
double complex eo_interpolation_gain(const struct eo_interpolation *interpolation, double phase);

#endif
