/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "numerics/fft.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void reverse_bits(int n, double complex *x)
{
  for (int i = 1, j = 0; i < n; i++) {
    int bit = n >> 1;
    for (; j & bit; bit >>= 1)
      j ^= bit;
    j ^= bit;
    if (i < j) {
      double complex swap = x[i];
      x[i] = x[j];
      x[j] = swap;
    }
  }
}

void eo_fft_forward(int n, double complex *x)
{
  reverse_bits(n, x);
  for (int size = 2; size <= n; size *= 2) {
    int half = size / 2;
    for (int k = 0; k < half; k++) {
      double complex twiddle = cexp(-2 * M_PI * I * k / size);
      for (int i = k; i < n; i += size) {
        double complex odd = twiddle * x[i + half];
        x[i + half] = x[i] - odd;
        x[i] += odd;
      }
    }
  }
}

/* exp(-pi i k^2 / n), with k^2 taken modulo 2 n before it loses digits. */
static double complex chirp(int k, int n)
{
  long long square = (long long)k * k % (2LL * n);
  return cexp(-M_PI * I * (double)square / n);
}

/* With j k = (j^2 + k^2 - (k - j)^2)/2 the sum is a convolution, which transforms of 2^m >= 2 n - 1 samples carry out.
 */
static void convolve(int n, int size, double complex *x, double complex *a, double complex *b)
{
  for (int k = 0; k < n; k++) {
    a[k] = x[k] * chirp(k, n);
    b[k] = conj(chirp(k, n));
    if (k > 0)
      b[size - k] = b[k];
  }
  eo_fft_forward(size, a);
  eo_fft_forward(size, b);
  for (int k = 0; k < size; k++)
    a[k] = conj(a[k] * b[k]);
  eo_fft_forward(size, a);
  for (int k = 0; k < n; k++)
    x[k] = conj(a[k]) / size * chirp(k, n);
}

enum eo_code eo_fft_any(int n, double complex *x, struct eo_error *error)
{
  int size = 1;
  if ((n & (n - 1)) == 0) {
    eo_fft_forward(n, x);
    return EO_OK;
  }
  while (size < 2 * n - 1)
    size *= 2;
  double complex *scratch = calloc(2 * (size_t)size, sizeof *scratch);
  if (!scratch)
    return eo_error_memory(error);
  convolve(n, size, x, scratch, scratch + size);
  free(scratch);
  return EO_OK;
}

/* theory (P4) */
enum eo_code eo_fft_spectrum(int n, const double *value, double complex *line, struct eo_error *error)
{
  double complex *x = malloc(sizeof *x * (size_t)n);
  if (!x)
    return eo_error_memory(error);
  for (int i = 0; i < n; i++)
    x[i] = value[i];
  enum eo_code code = eo_fft_any(n, x, error);
  for (int k = 0; k <= n / 2 && !code; k++)
    line[k] = x[k] * (k == 0 || 2 * k == n ? 1.0 : 2.0) / n;
  free(x);
  return code;
}
