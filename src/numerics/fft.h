/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fast Fourier transform of any number of samples, by the mixed radices of the GNU Scientific Library: n samples with
   the prime factors p take n sum p operations. No planner stands behind it, so the bytes depend on the samples alone.

   The library's own answer to a lack of memory is to end the process; main() and whoever else would rather have the
   error calls gsl_set_error_handler_off(). */
#ifndef EASEOFF_NUMERICS_FFT_H
#define EASEOFF_NUMERICS_FFT_H

#include <complex.h>

#include "base/error.h"

/* Sines and cosines of the sizes that were transformed, which take as long to find as a transform does; for any thread.
   Errors: memory. */
struct eo_fft_tables;
enum eo_code eo_fft_tables_new(struct eo_fft_tables **tables, struct eo_error *error);
void eo_fft_tables_free(struct eo_fft_tables *tables); /* NULL is fine */

/* x_k <- sum_j x_j exp(-2 pi i j k / n) in place, 0 <= k < n, n from 1. tables NULL: made for this once, which changes
   no byte. Errors: memory. */
enum eo_code eo_fft_forward(struct eo_fft_tables *tables, int n, double complex *x, struct eo_error *error);

/* The one-sided spectrum of n real samples: value_j = line_0 + Re sum_k line_k exp(2 pi i j k / n), 0 <= k <= n/2; the
   mean square is |line_0|^2 + sum |line_k|^2/2, of the last line for even n |line|^2 (Parseval). line[n/2 + 1].
   Errors: memory. */
enum eo_code eo_fft_spectrum(struct eo_fft_tables *tables, int n, const double *value, double complex *line,
                             struct eo_error *error);

#endif
