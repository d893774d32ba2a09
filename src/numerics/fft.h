/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fast Fourier transform of 2^k samples (Cooley and Tukey 1965). */
#ifndef EASEOFF_NUMERICS_FFT_H
#define EASEOFF_NUMERICS_FFT_H

#include <complex.h>

/* x_k <- sum_j x_j exp(-2 pi i j k / n) in place, 0 <= k < n; n a power of two. */
void eo_fft_forward(int n, double complex *x);

#endif
