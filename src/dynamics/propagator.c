/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/propagator.h"

#include <math.h>
#include <string.h>

#include "numerics/dense.h"

enum { N = EO_MAX_COORDINATES, TAYLOR = 12 };

/* exp(a) by a Taylor polynomial of a / 2^n and n squarings, in place. */
static void exponential(int size, double *a)
{
  double norm = 0, sum[4 * N * N] = {0}, power[4 * N * N] = {0}, next[4 * N * N];
  int squarings = 0;
  for (int i = 0; i < size; i++) {
    double row = 0;
    for (int j = 0; j < size; j++)
      row += fabs(a[i * size + j]);
    norm = fmax(norm, row);
  }
  while (ldexp(norm, -squarings) > 0.25)
    squarings++;
  for (int i = 0; i < size * size; i++) {
    a[i] = ldexp(a[i], -squarings);
    sum[i] = power[i] = i % (size + 1) == 0;
  }
  for (int term = 1; term <= TAYLOR; term++) {
    eo_dense_product(size, power, a, next);
    for (int i = 0; i < size * size; i++)
      sum[i] += power[i] = next[i] / term;
  }
  memcpy(a, sum, sizeof *a * (size_t)(size * size));
  for (int i = 0; i < squarings; i++) {
    eo_dense_product(size, a, a, next);
    memcpy(a, next, sizeof *a * (size_t)(size * size));
  }
}

void eo_propagator_fill(const struct eo_oscillator *oscillator, double mesh_damping, const double mean[2], double rate,
                        double step, double *a)
{
  int n = oscillator->n, size = 2 * n;
  memset(a, 0, sizeof *a * (size_t)(size * size));
  for (int i = 0; i < n; i++) {
    a[i * size + n + i] = rate * step;
    for (int j = 0; j < n; j++) {
      double k = oscillator->stiffness[i * n + j], c = oscillator->damping[i * n + j];
      for (int end = 0; end < oscillator->ends; end++) {
        k += mean[end] * oscillator->mesh[end][i] * oscillator->mesh[end][j];
        c += mesh_damping * oscillator->mesh[end][i] * oscillator->mesh[end][j];
      }
      a[(n + i) * size + j] = -k * step / rate;
      a[(n + i) * size + n + j] = -c * step;
    }
  }
  exponential(size, a);
}

double eo_propagator_mesh_rate(const struct eo_oscillator *oscillator, const double mean[2])
{
  double square = 0;
  for (int end = 0; end < oscillator->ends; end++)
    for (int i = 0; i < oscillator->n; i++)
      square += mean[end] * oscillator->mesh[end][i] * oscillator->mesh[end][i];
  return sqrt(square);
}
