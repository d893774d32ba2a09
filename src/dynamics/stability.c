/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/stability.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "dynamics/propagator.h"
#include "numerics/dense.h"
#include "numerics/fourier.h"

enum { N = EO_MAX_COORDINATES, MAX_STEPS = 200000, MIN_STEPS = 512, MAX_LAW_ROWS = 1024 };

/* The linearised mesh at one phase of the orbit. */
struct mesh_slope {
  double stiffness[2], damping[2], margin[2], margin_slope[2], rate[2];
};

struct orbit {
  const struct eo_oscillator *oscillator;
  const struct eo_cycle *cycle;
  int harmonics;
  const double *x; /* [2][1 + 2 harmonics] */
  double period;
};

static struct mesh_slope slope_at(const struct orbit *orbit, double phase)
{
  const struct eo_cycle *cycle = orbit->cycle;
  int terms = eo_fourier_terms(orbit->harmonics);
  double basis[1 + 2 * EO_MAX_HARMONICS], row[MAX_LAW_ROWS];
  struct mesh_slope slope = {0};
  eo_fourier_basis(orbit->harmonics, phase, basis);
  for (int end = 0; end < orbit->oscillator->ends; end++) {
    const double *series = orbit->x + end * terms;
    double x = series[0], v = 0;
    for (int k = 1; k <= orbit->harmonics; k++) {
      x += series[2 * k - 1] * basis[2 * k - 1] + series[2 * k] * basis[2 * k];
      v += cycle->frequency * k * (series[2 * k] * basis[2 * k - 1] - series[2 * k - 1] * basis[2 * k]);
    }
    eo_law_rows(cycle->law[end], phase + cycle->shift[end], row);
    struct eo_mesh_force force = eo_law_force(cycle->law[end], row, x, 0);
    slope.stiffness[end] = force.slope;
    slope.damping[end] = cycle->gated && force.margin <= 0 ? 0 : cycle->mesh_damping;
    slope.margin[end] = force.margin;
    slope.margin_slope[end] = force.margin_slope;
    slope.rate[end] = v;
  }
  return slope;
}

/* d(disturbance)/d phase; y[2 n][columns]: positions, then velocities per phase. */
static void disturb(const struct orbit *orbit, const struct mesh_slope *mesh_slope, const double *y, double *slope)
{
  const struct eo_oscillator *oscillator = orbit->oscillator;
  int n = oscillator->n, columns = 2 * n;
  double k[N * N], c[N * N], t = orbit->period;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      double stiffness = oscillator->stiffness[i * n + j], damping = oscillator->damping[i * n + j];
      for (int end = 0; end < oscillator->ends; end++) {
        stiffness += mesh_slope->stiffness[end] * oscillator->mesh[end][i] * oscillator->mesh[end][j];
        damping += mesh_slope->damping[end] * oscillator->mesh[end][i] * oscillator->mesh[end][j];
      }
      k[i * n + j] = stiffness * t * t;
      c[i * n + j] = damping * t;
    }
  memcpy(slope, y + n * columns, sizeof *y * n * columns);
  for (int i = 0; i < n; i++) {
    double *out = slope + (size_t)(n + i) * columns;
    memset(out, 0, sizeof *out * columns);
    for (int j = 0; j < n; j++)
      for (int l = 0; l < columns; l++)
        out[l] -= k[i * n + j] * y[(size_t)j * columns + l] + c[i * n + j] * y[(size_t)(n + j) * columns + l];
  }
}

struct work {
  double y[4 * N * N], k[4][4 * N * N], trial[4 * N * N];
};

static void advance(const struct orbit *orbit, struct work *work, double h, const struct mesh_slope *begin,
                    const struct mesh_slope *middle, const struct mesh_slope *end)
{
  int size = 4 * orbit->oscillator->n * orbit->oscillator->n;
  const struct mesh_slope *at[4] = {begin, middle, middle, end};
  const double share[4] = {0, 0.5, 0.5, 1};
  for (int stage = 0; stage < 4; stage++) {
    for (int i = 0; i < size; i++)
      work->trial[i] = work->y[i] + (stage ? share[stage] * h * work->k[stage - 1][i] : 0);
    disturb(orbit, at[stage], work->trial, work->k[stage]);
  }
  for (int i = 0; i < size; i++)
    work->y[i] += h / 6 * (work->k[0][i] + 2 * work->k[1][i] + 2 * work->k[2][i] + work->k[3][i]);
}

/* The damping force c X' is switched where the margin passes zero; a disturbed orbit passes earlier by -dX/X'. */
static void salt(const struct orbit *orbit, struct work *work, double h, const struct mesh_slope *a,
                 const struct mesh_slope *b)
{
  const struct eo_oscillator *oscillator = orbit->oscillator;
  int n = oscillator->n, columns = 2 * n;
  for (int end = 0; end < oscillator->ends && orbit->cycle->gated; end++) {
    if ((a->margin[end] > 0) == (b->margin[end] > 0) || a->margin_slope[end] != b->margin_slope[end])
      continue;
    double rate = (b->margin[end] - a->margin[end]) / h;
    double jump = orbit->cycle->mesh_damping * (a->rate[end] + b->rate[end]) / 2 * a->margin_slope[end] / fabs(rate);
    double impulse = jump * orbit->period * orbit->period;
    for (int l = 0; l < columns; l++) {
      double x = 0;
      for (int i = 0; i < n; i++)
        x += oscillator->mesh[end][i] * work->y[(size_t)i * columns + l];
      for (int i = 0; i < n; i++)
        work->y[(size_t)(n + i) * columns + l] -= impulse * oscillator->mesh[end][i] * x;
    }
  }
}

/* Steps that follow the fastest oscillation: a tenth of a radian each. */
static int choose_steps(const struct orbit *orbit)
{
  const struct eo_oscillator *oscillator = orbit->oscillator;
  double norm = 0;
  struct mesh_slope slope = slope_at(orbit, 0);
  for (int i = 0; i < oscillator->n; i++) {
    norm += oscillator->stiffness[i * oscillator->n + i];
    for (int end = 0; end < oscillator->ends; end++)
      norm += fmax(slope.stiffness[end], oscillator->shift) * oscillator->mesh[end][i] * oscillator->mesh[end][i];
  }
  double steps = 10 * orbit->period * sqrt(norm);
  return steps > MAX_STEPS ? -1 : (int)fmax(steps, MIN_STEPS);
}

static int by_size(const void *a, const void *b)
{
  double x = cabs(*(const double complex *)a), y = cabs(*(const double complex *)b);
  return (x < y) - (x > y);
}

enum eo_code eo_floquet(const struct eo_oscillator *oscillator, const struct eo_cycle *cycle, int harmonics,
                        const double *x, double complex *multiplier, struct eo_error *error)
{
  struct orbit orbit = {oscillator, cycle, harmonics, x, 2 * M_PI / cycle->frequency};
  int size = 2 * oscillator->n, steps = choose_steps(&orbit);
  if (steps < 0)
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "The stability at %g rad/s would need too many steps.",
                        cycle->frequency);
  struct work *work = calloc(1, sizeof *work);
  if (!work)
    return eo_error_memory(error);
  for (int i = 0; i < size; i++)
    work->y[i * size + i] = 1;
  double h = 1.0 / steps;
  struct mesh_slope begin = slope_at(&orbit, 0);
  for (int step = 0; step < steps; step++) {
    struct mesh_slope middle = slope_at(&orbit, (step + 0.5) * h), end = slope_at(&orbit, (step + 1) * h);
    advance(&orbit, work, h, &begin, &middle, &end);
    salt(&orbit, work, h, &begin, &end);
    begin = end;
  }
  int failed = eo_dense_eigenvalues(size, work->y, multiplier);
  free(work);
  if (failed)
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "The Floquet multipliers could not be found.");
  qsort(multiplier, size, sizeof *multiplier, by_size);
  return EO_OK;
}

enum { LEAST_KICKS = 64, MOST_KICKS = 2048, KICKS_PER_HARMONIC = 4 };
/* Largest angle by which the meshes alone would turn between two kicks, rad: 1e-5 in the multipliers. */
static const double kick_angle = 0.5;

/* Velocities changed at once by what a mesh is stiffer than the mean over one step. */
static void kick(const struct eo_oscillator *oscillator, int end, double impulse, double *y)
{
  int n = oscillator->n, columns = 2 * n;
  for (int l = 0; l < columns; l++) {
    double x = 0;
    for (int i = 0; i < n; i++)
      x += oscillator->mesh[end][i] * y[i * columns + l];
    for (int i = 0; i < n; i++)
      y[(n + i) * columns + l] -= impulse * oscillator->mesh[end][i] * x;
  }
}

enum eo_code eo_floquet_attached(const struct eo_oscillator *oscillator, const struct eo_cycle *cycle, int harmonics,
                                 const double *x, double *largest, struct eo_error *error)
{
  struct orbit orbit = {oscillator, cycle, harmonics, x, 2 * M_PI / cycle->frequency};
  int size = 2 * oscillator->n;
  double mean[2] = {0};
  double complex multiplier[2 * N];
  double(*stiffness)[2] = malloc(sizeof *stiffness * MOST_KICKS);
  struct work *work = calloc(1, sizeof *work);
  if (!work || !stiffness) {
    free(work);
    free(stiffness);
    return eo_error_memory(error);
  }
  struct mesh_slope first = slope_at(&orbit, 0);
  double angle = orbit.period * eo_propagator_mesh_rate(oscillator, first.stiffness) / kick_angle;
  double least = fmax(LEAST_KICKS,
                      KICKS_PER_HARMONIC * fmax(cycle->law[0]->order, cycle->law[oscillator->ends - 1]->order));
  int kicks = (int)fmin(MOST_KICKS, fmax(least, angle));
  for (int i = 0; i < kicks; i++) {
    struct mesh_slope slope = slope_at(&orbit, (i + 0.5) / kicks);
    for (int end = 0; end < oscillator->ends; end++) {
      stiffness[i][end] = slope.stiffness[end];
      mean[end] += slope.stiffness[end] / kicks;
    }
  }
  double rate = eo_propagator_mesh_rate(oscillator, mean), step = orbit.period / kicks;
  eo_propagator_fill(oscillator, cycle->mesh_damping, mean, rate, step, work->trial);
  double *now = work->y, *next = work->k[0];
  for (int i = 0; i < size; i++)
    now[i * size + i] = 1;
  for (int i = 0; i < kicks; i++) {
    for (int end = 0; end < oscillator->ends; end++)
      kick(oscillator, end, (stiffness[i][end] - mean[end]) * step / rate, now);
    eo_dense_product(size, work->trial, now, next);
    double *swap = now;
    now = next;
    next = swap;
  }
  int failed = eo_dense_eigenvalues(size, now, multiplier);
  for (int i = 0; i < size && !failed; i++)
    *largest = fmax(i ? *largest : 0, cabs(multiplier[i]));
  free(work);
  free(stiffness);
  return failed ? eo_error_set(error, EO_ERROR_NUMERIC, "", "The Floquet multipliers could not be found.") : EO_OK;
}
