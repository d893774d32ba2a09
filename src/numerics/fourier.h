/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Real Fourier series over a phase of period 1: series[1 + 2 order] = mean, cos 1, sin 1, cos 2, sin 2, ...
   f(phase) = series[0] + sum_k series[2k-1] cos(2 pi k phase) + series[2k] sin(2 pi k phase). */
#ifndef EASEOFF_NUMERICS_FOURIER_H
#define EASEOFF_NUMERICS_FOURIER_H

/* Length of a series of an order. */
static inline int eo_fourier_terms(int order)
{
  return 1 + 2 * order;
}

/* The series through n equidistant samples (sample i at phase i / n), cut off at order <= n / 2; the Nyquist term, if
   asked for, is a cosine. Exact for a band-limited function (Henrici 1986, section 13.2). */
void eo_fourier_series(int n, const double *sample, int order, double *series);

/* basis[1 + 2 order] = 1, cos, sin, ... at one phase: a series' value is its scalar product with it. */
void eo_fourier_basis(int order, double phase, double *basis);

/* f(phase); any phase. */
double eo_fourier_value(int order, const double *series, double phase);

#endif
