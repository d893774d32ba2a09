/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "numerics/fft.h"

#include <math.h>

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
