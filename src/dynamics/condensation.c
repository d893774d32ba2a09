/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/condensation.h"

#include <math.h>
#include <string.h>

#include "numerics/dense.h"

enum { N = EO_MAX_COORDINATES, ATTEMPTS = 8 };

static void set_dynamic_stiffness(const struct eo_oscillator *oscillator, double w, double shift, double complex *d)
{
  int n = oscillator->n;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      double k = oscillator->stiffness[i * n + j] - (i == j ? w * w : 0);
      for (int end = 0; end < oscillator->ends; end++)
        k += shift * oscillator->mesh[end][i] * oscillator->mesh[end][j];
      d[i * n + j] = k + I * w * oscillator->damping[i * n + j];
    }
}

static double complex product(int n, const double *a, const double complex *b)
{
  double complex sum = 0;
  for (int i = 0; i < n; i++)
    sum += a[i] * b[i];
  return sum;
}

static void invert(int ends, double complex m[2][2], double complex inverse[2][2])
{
  memset(inverse, 0, 4 * sizeof **inverse);
  if (ends == 1) {
    inverse[0][0] = 1 / m[0][0];
    return;
  }
  double complex determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0];
  inverse[0][0] = m[1][1] / determinant;
  inverse[1][1] = m[0][0] / determinant;
  inverse[0][1] = -m[0][1] / determinant;
  inverse[1][0] = -m[1][0] / determinant;
}

static void multiply(int ends, double complex a[2][2], double complex b[2][2], double complex c[2][2])
{
  for (int i = 0; i < ends; i++)
    for (int j = 0; j < ends; j++) {
      c[i][j] = 0;
      for (int k = 0; k < ends; k++)
        c[i][j] += a[i][k] * b[k][j];
    }
}

/* left' D'(w) right with D' = -2 k^2 w + i k C; D is symmetric, so responses stand on both sides. */
static double complex slope_product(const struct eo_oscillator *oscillator, double w, int k, const double complex *left,
                                    const double complex *right)
{
  double complex sum = 0;
  for (int i = 0; i < oscillator->n; i++) {
    double complex image = -2 * k * k * w * right[i];
    for (int j = 0; j < oscillator->n; j++)
      image += I * k * oscillator->damping[i * oscillator->n + j] * right[j];
    sum += left[i] * image;
  }
  return sum;
}

/* H' = -u' D' u, W' = -u' D' v; S' = -S~ H' S~ and T' = S~ (W' - H' T) with S~ = H^-1. */
static void add_slopes(const struct eo_oscillator *oscillator, double w, int k, double complex inverse[2][2],
                       struct eo_harmonic *harmonic)
{
  int ends = oscillator->ends;
  double complex mesh[2][2] = {0}, pulse[2][2] = {0}, scratch[2][2] = {0};
  for (int i = 0; i < ends; i++)
    for (int j = 0; j < ends; j++) {
      mesh[i][j] = -slope_product(oscillator, w, k, harmonic->mesh_response[i], harmonic->mesh_response[j]);
      pulse[i][j] = -slope_product(oscillator, w, k, harmonic->mesh_response[i], harmonic->pulse_response[j]);
    }
  multiply(ends, inverse, mesh, scratch);
  multiply(ends, scratch, inverse, harmonic->stiffness_slope);
  multiply(ends, mesh, harmonic->transfer, scratch);
  for (int i = 0; i < ends; i++)
    for (int j = 0; j < ends; j++) {
      harmonic->stiffness_slope[i][j] = -harmonic->stiffness_slope[i][j];
      pulse[i][j] -= scratch[i][j];
    }
  multiply(ends, inverse, pulse, harmonic->transfer_slope);
}

/* Right-hand sides: mesh and pulse of every end, the constant load last. */
static int solve_responses(const struct eo_oscillator *oscillator, double w, double shift, double complex *b)
{
  double complex d[N * N];
  int pivot[N], n = oscillator->n;
  set_dynamic_stiffness(oscillator, w, shift, d);
  for (int i = 0; i < n; i++) {
    for (int end = 0; end < oscillator->ends; end++) {
      b[end * n + i] = oscillator->mesh[end][i];
      b[(oscillator->ends + end) * n + i] = oscillator->pulse[end][i];
    }
    b[2 * oscillator->ends * n + i] = oscillator->load[i];
  }
  return eo_dense_complex_solve(n, d, pivot, 2 * oscillator->ends + (w == 0), b);
}

static void condense_one(const struct eo_oscillator *oscillator, double frequency, int k, bool slopes,
                         struct eo_harmonic *harmonic)
{
  static const double OTHER_SHIFT = 1.37, HAIR = 1e-10; /* of the shift: no simple ratio; of the frequency */
  int n = oscillator->n, ends = oscillator->ends;
  double complex b[5 * N], compliance[2][2] = {0}, impact[2][2] = {0}, inverse[2][2], mean[2] = {0};
  double shift = oscillator->shift, w = k * frequency;
  /* An undamped resonance just here: another shift moves it if the meshes feel it, a hair's breadth in frequency avoids
     it if not. */
  for (int attempt = 0; attempt < ATTEMPTS && solve_responses(oscillator, w, shift, b); attempt++) {
    shift *= OTHER_SHIFT;
    w *= 1 + HAIR;
  }
  memset(harmonic, 0, sizeof *harmonic);
  for (int end = 0; end < ends; end++) {
    memcpy(harmonic->mesh_response[end], b + end * n, n * sizeof *b);
    memcpy(harmonic->pulse_response[end], b + (ends + end) * n, n * sizeof *b);
  }
  for (int i = 0; i < ends; i++)
    for (int j = 0; j < ends; j++) {
      compliance[i][j] = product(n, oscillator->mesh[i], harmonic->mesh_response[j]);
      impact[i][j] = product(n, oscillator->mesh[i], harmonic->pulse_response[j]);
    }
  invert(ends, compliance, inverse);
  multiply(ends, inverse, impact, harmonic->transfer);
  for (int i = 0; i < n && k == 0; i++)
    harmonic->load_response[i] = creal(b[2 * ends * n + i]);
  for (int i = 0; i < ends && k == 0; i++)
    mean[i] = product(n, oscillator->mesh[i], b + 2 * ends * n);
  for (int i = 0; i < ends; i++)
    for (int j = 0; j < ends; j++) {
      harmonic->stiffness[i][j] = inverse[i][j] - (i == j ? shift : 0); /* theory (D4) */
      harmonic->load[i] += inverse[i][j] * mean[j];
    }
  if (slopes)
    add_slopes(oscillator, frequency, k, inverse, harmonic);
  harmonic->shift = shift;
}

void eo_condense(const struct eo_oscillator *oscillator, double frequency, int harmonics, bool slopes,
                 struct eo_harmonic *harmonic)
{
  for (int k = 0; k <= harmonics; k++)
    condense_one(oscillator, frequency, k, slopes, harmonic + k);
}

void eo_condensed_response(const struct eo_oscillator *oscillator, const struct eo_harmonic *harmonic, int k,
                           const double complex force[2], const double complex deflection[2],
                           const double complex impact[2], double complex *response)
{
  const struct eo_harmonic *this_harmonic = harmonic + k;
  for (int i = 0; i < oscillator->n; i++) {
    response[i] = this_harmonic->load_response[i];
    for (int end = 0; end < oscillator->ends; end++)
      response[i] -= this_harmonic->mesh_response[end][i] * (force[end] - this_harmonic->shift * deflection[end]) +
                     this_harmonic->pulse_response[end][i] * impact[end];
  }
}
