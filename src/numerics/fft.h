/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fast Fourier transform: of 2^k samples (Cooley and Tukey 1965), and of any number (Bluestein 1970). */
#ifndef EASEOFF_NUMERICS_FFT_H
#define EASEOFF_NUMERICS_FFT_H

#include <complex.h>

#include "base/error.h"

/* x_k <- sum_j x_j exp(-2 pi i j k / n) in place, 0 <= k < n; n a power of two. */
void eo_fft_forward(int n, double complex *x);

/* The same for any n from 1. Errors: memory. */
enum eo_code eo_fft_any(int n, double complex *x, struct eo_error *error);

/* The one-sided spectrum of n real samples: value_j = line_0 + Re sum_k line_k exp(2 pi i j k / n), 0 <= k <= n/2; the
   mean square is |line_0|^2 + sum |line_k|^2/2, of the last line for even n |line|^2 (Parseval). line[n/2 + 1].
   Errors: memory. */
enum eo_code eo_fft_spectrum(int n, const double *value, double complex *line, struct eo_error *error);

#endif
