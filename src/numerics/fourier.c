/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "numerics/fourier.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

enum { TABLE = 1024 };

/* One pair of coefficients; cosine and sine are tables of n entries, or NULL when n is too large for them. */
static void coefficients(int n, const double *sample, int k, const double *cosine, const double *sine, double *c,
                         double *s)
{
  *c = *s = 0;
  for (int i = 0, at = 0; i < n; i++) {
    *c += sample[i] * (cosine ? cosine[at] : cos(2 * M_PI * at / n));
    *s += sample[i] * (sine ? sine[at] : sin(2 * M_PI * at / n));
    at += k;
    if (at >= n)
      at -= n;
  }
}

void eo_fourier_series(int n, const double *sample, int order, double *series)
{
  double cosine[TABLE], sine[TABLE];
  bool tabulated = n <= TABLE;
  for (int i = 0; i < n && tabulated; i++) {
    cosine[i] = cos(2 * M_PI * i / n);
    sine[i] = sin(2 * M_PI * i / n);
  }
  for (int k = 0; k <= order; k++) {
    double c, s, weight = (k == 0 || 2 * k == n) ? 1.0 / n : 2.0 / n;
    coefficients(n, sample, k, tabulated ? cosine : NULL, tabulated ? sine : NULL, &c, &s);
    if (k == 0)
      series[0] = weight * c;
    else {
      series[2 * k - 1] = weight * c;
      series[2 * k] = 2 * k == n ? 0 : weight * s;
    }
  }
}

void eo_fourier_basis(int order, double phase, double *basis)
{
  double c = cos(2 * M_PI * phase), s = sin(2 * M_PI * phase);
  double ck = 1, sk = 0;
  basis[0] = 1;
  for (int k = 1; k <= order; k++) {
    double next = ck * c - sk * s;
    sk = sk * c + ck * s;
    ck = next;
    basis[2 * k - 1] = ck;
    basis[2 * k] = sk;
  }
}

double eo_fourier_value(int order, const double *series, double phase)
{
  double c = cos(2 * M_PI * phase), s = sin(2 * M_PI * phase);
  double ck = 1, sk = 0, value = series[0];
  for (int k = 1; k <= order; k++) {
    double next = ck * c - sk * s;
    sk = sk * c + ck * s;
    ck = next;
    value += series[2 * k - 1] * ck + series[2 * k] * sk;
  }
  return value;
}
