/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/updating_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "numerics/dense.h"
#include "numerics/least_squares.h"

enum { ITERATIONS = 30, NEIGHBOURS_PER_UNKNOWN = 2, DESCENTS = 8, DESCENTS_PER_UNKNOWN = 8 };
static const double APART = 1e-3; /* of the ranges: minima nearer to each other are one */
static const double STEP = 2e-4, TOLERANCE = 1e-6;

struct sample {
  double x[EO_UNKNOWNS];
  double square;
};

static int greatest_divisor(int a, int b)
{
  return b ? greatest_divisor(b, a % b) : a;
}

/* The at-th number from 1 that shares no divisor with `of`: multiplying by it permutes 0 .. of - 1. */
static int permuting_factor(int at, int of)
{
  int factor = 1;
  while (at > 0)
    at -= greatest_divisor(++factor, of) == 1;
  return factor;
}

/* Points with one in each slice of every unknown (McKay, Beckman, Conover 1979), and what the design says now. */
static enum eo_code look_around(struct eo_fit *fit, int starts, struct sample *sample, double *residual,
                                struct eo_error *error)
{
  int n = fit->settings->unknowns;
  eo_fit_begin(fit, "fit: looking over the ranges", 0, 0.3, starts + 1);
  for (int i = 0; i <= starts; i++) {
    for (int j = 0; j < n; j++) {
      struct eo_random random = eo_random_at(fit->settings->seed, 1, (uint64_t)i, (uint64_t)j);
      int slice = (int)(((int64_t)i * permuting_factor(7 * j, starts) + j) % starts);
      sample[i].x[j] = i < starts ? (slice + eo_random_unit(random, 0)) / starts
                                  : eo_fit_to_unit(&fit->settings->range[j],
                                                   eo_unknown_get(fit->design, fit->settings->range[j].unknown));
    }
    enum eo_code code = eo_fit_residuals(fit, sample[i].x, residual, error);
    if (code)
      return code;
    sample[i].square = eo_dot(fit->residuals, residual, residual);
  }
  return EO_OK;
}

static double distance(int n, const double *a, const double *b)
{
  double most = 0;
  for (int j = 0; j < n; j++)
    most = fmax(most, fabs(a[j] - b[j]));
  return most;
}

/* Lower than its nearest neighbours: fewer of those are lower than a valley would leave. */
static bool is_promising(const struct sample *sample, int count, int at, int n)
{
  double nearest[NEIGHBOURS_PER_UNKNOWN * EO_UNKNOWNS] = {0}, square[NEIGHBOURS_PER_UNKNOWN * EO_UNKNOWNS];
  int wanted = NEIGHBOURS_PER_UNKNOWN * n, kept = 0;
  for (int i = 0; i < count; i++) {
    double far = distance(n, sample[i].x, sample[at].x);
    if (i == at || (kept == wanted && far >= nearest[kept - 1]))
      continue;
    int place = kept < wanted ? kept++ : kept - 1;
    for (; place > 0 && nearest[place - 1] > far; place--) {
      nearest[place] = nearest[place - 1];
      square[place] = square[place - 1];
    }
    nearest[place] = far;
    square[place] = sample[i].square;
  }
  for (int i = 0; i < kept; i++)
    if (square[i] < sample[at].square)
      return false;
  return true;
}

static enum eo_code descend(struct eo_fit *fit, struct eo_minimum *minimum, struct eo_error *error)
{
  const struct eo_least_squares_options options = {.iterations = ITERATIONS, .step = STEP, .tolerance = TOLERANCE};
  struct eo_least_squares_report report;
  enum eo_code code = eo_least_squares(eo_fit_residuals, fit, fit->settings->unknowns, fit->residuals, &options,
                                       minimum->x, NULL, &report, error);
  minimum->square = report.square;
  minimum->converged = report.converged;
  return code;
}

/* Puts a minimum in its place, the lowest first, unless it is there already. */
static void keep(struct eo_minima *minima, const struct eo_minimum *found, int n)
{
  int at = 0;
  for (int i = 0; i < minima->count; i++)
    if (distance(n, minima->minimum[i].x, found->x) < APART) {
      if (found->square < minima->minimum[i].square)
        minima->minimum[i] = *found;
      return;
    }
  while (at < minima->count && minima->minimum[at].square <= found->square)
    at++;
  if (at == EO_UPDATE_MINIMA)
    return;
  int moved = minima->count < EO_UPDATE_MINIMA ? minima->count : EO_UPDATE_MINIMA - 1;
  memmove(&minima->minimum[at + 1], &minima->minimum[at], sizeof *minima->minimum * (size_t)(moved - at));
  minima->minimum[at] = *found;
  minima->count = moved + 1;
}

static int ascending(const void *a, const void *b)
{
  const struct sample *x = a, *y = b;
  return (x->square > y->square) - (x->square < y->square);
}

/* Downhill from the lowest of the promising points, and from the lowest points of all. */
static enum eo_code go_down(struct eo_fit *fit, int count, struct sample *sample, struct eo_minima *minima,
                            struct eo_error *error)
{
  int n = fit->settings->unknowns, most = DESCENTS + DESCENTS_PER_UNKNOWN * n, chosen = 0;
  struct sample *start = malloc(sizeof *start * (size_t)(count + 1));
  if (!start)
    return eo_error_memory(error);
  for (int i = 0; i < count; i++)
    if (is_promising(sample, count, i, n))
      start[chosen++] = sample[i];
  qsort(start, (size_t)chosen, sizeof *start, ascending);
  qsort(sample, (size_t)count, sizeof *sample, ascending);
  chosen = chosen < most ? chosen : most;
  for (int i = 0; i < count && chosen < most && i < most / 2; i++)
    start[chosen++] = sample[i];
  eo_fit_begin(fit, "fit: downhill", 0.3, 0.6, chosen * (n + 2) * 6);
  enum eo_code code = EO_OK;
  for (int i = 0; i < chosen && !code; i++) {
    struct eo_minimum found = {.square = start[i].square};
    memcpy(found.x, start[i].x, sizeof found.x);
    code = descend(fit, &found, error);
    if (!code)
      keep(minima, &found, n);
  }
  free(start);
  return code;
}

enum eo_code eo_fit_search(struct eo_fit *fit, int starts, struct eo_minima *minima, double *before,
                           struct eo_error *error)
{
  struct sample *sample = malloc(sizeof *sample * (size_t)(starts + 1));
  double *residual = malloc(sizeof *residual * (size_t)fit->residuals);
  *minima = (struct eo_minima){0};
  enum eo_code code = sample && residual ? look_around(fit, starts, sample, residual, error) : eo_error_memory(error);
  if (!code) {
    *before = sample[starts].square;
    code = go_down(fit, starts + 1, sample, minima, error);
  }
  free(sample);
  free(residual);
  return code;
}

enum eo_code eo_fit_refine(struct eo_fit *fit, struct eo_minima *minima, struct eo_error *error)
{
  struct eo_minima again = {0};
  for (int i = 0; i < minima->count; i++) {
    struct eo_minimum found = minima->minimum[i];
    enum eo_code code = descend(fit, &found, error);
    if (code)
      return code;
    keep(&again, &found, fit->settings->unknowns);
  }
  *minima = again;
  return EO_OK;
}
