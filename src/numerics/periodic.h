/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Functions of the mesh phase given at equally spaced positions: periodic cubic spline, and harmonics. */
#ifndef EASEOFF_NUMERICS_PERIODIC_H
#define EASEOFF_NUMERICS_PERIODIC_H

enum { EO_PERIODIC_MOST = 1024 };

struct eo_periodic {
  int count;
  double value[EO_PERIODIC_MOST]; /* at phase i / count */
  double slope[EO_PERIODIC_MOST]; /* d value / d phase there */
};

/* count: 3 .. EO_PERIODIC_MOST. */
void eo_periodic_init(struct eo_periodic *spline, int count, const double *value);

/* Value at phase 0..1 (1 wraps to 0); *slope (may be NULL): derivative by phase. */
double eo_periodic_at(const struct eo_periodic *spline, double phase, double *slope);

/* Mean of the values. */
double eo_periodic_mean(int count, const double *value);

/* Largest less smallest of the values. */
double eo_periodic_swing(int count, const double *value);

/* Complex amplitudes: value = mean + sum_h re_h cos(2 pi h phi) - im_h sin(2 pi h phi), h = 1..harmonics;
   amplitude[harmonics][2] as [re, im]. Returns the mean. count > 2 harmonics. */
double eo_periodic_harmonics(int count, const double *value, int harmonics, double (*amplitude)[2]);

#endif
