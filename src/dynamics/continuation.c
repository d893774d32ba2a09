/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/continuation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "numerics/dense.h"
#include "numerics/fourier.h"

enum { MAX_CORRECTIONS = 12, EASY_CORRECTIONS = 4 };
static const double converged = 1e-9, smallest_step = 1e-9, growth = 1.4, shrink = 0.4;

const struct eo_branch_options eo_branch_defaults = {
    .first_step = 0.005, .longest_step = 0.05, .fold_tolerance = 1e-5, .max_points = 2000};

/* Unknowns: the deflections / size, then frequency / start frequency: n + 1 numbers of order one. */
struct branch {
  struct eo_balance *balance;
  const struct eo_oscillator *oscillator;
  struct eo_cycle cycle;
  struct eo_harmonic *harmonic;
  int n;
  double size, start;
  double *x;                           /* [n] deflections, m */
  double *residual, *slope, *jacobian; /* [n], [n], [n][n] */
  double *matrix;                      /* [n + 1][n + 1] */
  double *step;                        /* [n + 1] */
  int *pivot;
};

static int make_branch(struct branch *b, int harmonics)
{
  size_t n = b->n;
  b->harmonic = malloc(sizeof *b->harmonic * (1 + harmonics));
  b->x = malloc(sizeof *b->x * (5 * n + 2 + n * n + (n + 1) * (n + 1)));
  b->pivot = malloc(sizeof *b->pivot * (n + 1));
  if (!b->harmonic || !b->x || !b->pivot)
    return -1;
  b->residual = b->x + n;
  b->slope = b->residual + n;
  b->step = b->slope + n;
  b->jacobian = b->step + n + 2;
  b->matrix = b->jacobian + n * n;
  return 0;
}

static void free_branch(struct branch *b)
{
  free(b->harmonic);
  free(b->x);
  free(b->pivot);
}

/* Residual and bordered matrix at u, its last row the given direction. */
static enum eo_code linearise(struct branch *b, const double *u, const double *direction, struct eo_error *error)
{
  int n = b->n;
  for (int i = 0; i < n; i++)
    b->x[i] = u[i] * b->size;
  b->cycle.frequency = u[n] * b->start;
  eo_condense(b->oscillator, b->cycle.frequency, eo_balance_harmonics(b->balance), true, b->harmonic);
  enum eo_code code = eo_balance_linearise(b->balance, b->oscillator, b->harmonic, &b->cycle, b->x, b->residual,
                                           b->jacobian, b->slope, error);
  for (int i = 0; i < n && !code; i++) {
    double *row = b->matrix + (size_t)i * (n + 1);
    for (int j = 0; j < n; j++)
      row[j] = b->jacobian[(size_t)i * n + j] * b->size;
    row[n] = b->slope[i] * b->start;
  }
  memcpy(b->matrix + (size_t)n * (n + 1), direction, sizeof *direction * (n + 1));
  return code;
}

/* The unit tangent at the point last linearised, on the side of the direction in the last row. Returns 0, or non-zero
   when singular. */
static int tangent_of(struct branch *b, double *tangent)
{
  int n = b->n;
  double length = 0;
  memset(tangent, 0, sizeof *tangent * n);
  tangent[n] = 1;
  if (eo_dense_solve(n + 1, b->matrix, b->pivot, 1, tangent))
    return 1;
  for (int i = 0; i <= n; i++)
    length += tangent[i] * tangent[i];
  length = sqrt(length);
  for (int i = 0; i <= n; i++)
    tangent[i] /= length;
  return !isfinite(length);
}

/* Newton from base + step tangent in the plane across the tangent. *corrections counts; negative when it does not
   converge. */
static enum eo_code correct(struct branch *b, const double *base, const double *tangent, double step, double *u,
                            int *corrections, struct eo_error *error)
{
  int n = b->n;
  for (int i = 0; i <= n; i++)
    u[i] = base[i] + step * tangent[i];
  for (*corrections = 0; *corrections < MAX_CORRECTIONS; ++*corrections) {
    double largest = 0;
    if (!(u[n] > 0))
      break;
    enum eo_code code = linearise(b, u, tangent, error);
    if (code)
      return code;
    for (int i = 0; i < n; i++) {
      largest = fmax(largest, fabs(b->residual[i]));
      b->step[i] = b->residual[i];
    }
    if (largest <= converged)
      return EO_OK;
    b->step[n] = 0;
    if (!isfinite(largest) || eo_dense_solve(n + 1, b->matrix, b->pivot, 1, b->step))
      break;
    for (int i = 0; i <= n; i++)
      u[i] -= b->step[i];
  }
  *corrections = -1;
  return EO_OK;
}

static int visit_point(const struct branch *b, const double *u, double along, bool fold, eo_branch_visit *visit,
                       void *context)
{
  const struct eo_branch_point point = {.frequency = u[b->n] * b->start,
                                        .x = b->x,
                                        .direction = along >= 0 ? 1 : -1,
                                        .fold = fold,
                                        .grid = eo_balance_grid(b->balance)};
  return visit(context, &point);
}

/* The walk: base and tangent, trial point and its tangent; n + 1 numbers each. */
struct walk {
  double *base, *tangent, *trial, *next;
  double step;
};

/* One accepted point: trial and next are set, the step for the one after it chosen. *found is false when the branch is
   lost. */
static enum eo_code take_step(struct branch *b, const struct eo_branch_options *o, struct walk *w, bool *fold,
                              bool *found, struct eo_error *error)
{
  int n = b->n, corrections;
  for (*found = false; w->step >= smallest_step;) {
    enum eo_code code = correct(b, w->base, w->tangent, w->step, w->trial, &corrections, error);
    if (code)
      return code;
    if (corrections < 0 || tangent_of(b, w->next)) {
      w->step *= shrink;
      continue;
    }
    *fold = (w->next[n] > 0) != (w->tangent[n] > 0);
    double moved = fabs(w->trial[n] - w->base[n]) / w->trial[n];
    if (*fold && moved > o->fold_tolerance && w->step > smallest_step / shrink) {
      w->step *= shrink;
      continue;
    }
    w->step = corrections <= EASY_CORRECTIONS ? fmin(w->step * growth, o->longest_step) : w->step;
    *found = true;
    return EO_OK;
  }
  return EO_OK;
}

static enum eo_code start_walk(struct branch *b, const double *x, int direction, struct walk *w, bool *found,
                               struct eo_error *error)
{
  int n = b->n, corrections;
  for (int i = 0; i < n; i++)
    w->base[i] = x[i] / b->size;
  w->base[n] = 1;
  memset(w->tangent, 0, sizeof *w->tangent * n);
  w->tangent[n] = direction >= 0 ? 1 : -1;
  enum eo_code code = correct(b, w->base, w->tangent, 0, w->trial, &corrections, error);
  if (code)
    return code;
  memcpy(w->base, w->trial, sizeof *w->base * (n + 1));
  *found = corrections >= 0 && !tangent_of(b, w->next);
  memcpy(w->tangent, w->next, sizeof *w->tangent * (n + 1));
  return EO_OK;
}

static enum eo_code walk_branch(struct branch *b, const struct eo_branch_options *o, const double *x, int direction,
                                struct walk *w, eo_branch_visit *visit, void *context, enum eo_branch_end *end,
                                struct eo_error *error)
{
  bool found, fold = false;
  enum eo_code code = start_walk(b, x, direction, w, &found, error);
  for (int point = 0; !code; point++) {
    *end = EO_BRANCH_LOST;
    if (!found)
      break;
    *end = EO_BRANCH_STOPPED;
    if (visit_point(b, w->base, w->tangent[b->n], fold, visit, context))
      break;
    *end = EO_BRANCH_LIMIT;
    double frequency = w->base[b->n] * b->start;
    if (point > 0 && (frequency <= o->low || frequency >= o->high))
      break;
    *end = EO_BRANCH_POINTS;
    if (point + 1 >= o->max_points)
      break;
    code = take_step(b, o, w, &fold, &found, error);
    double *swap = w->base;
    w->base = w->trial;
    w->trial = swap;
    swap = w->tangent;
    w->tangent = w->next;
    w->next = swap;
  }
  return code;
}

enum eo_code eo_branch_follow(struct eo_balance *balance, const struct eo_oscillator *oscillator,
                              const struct eo_cycle *cycle, const double *x, int direction,
                              const struct eo_branch_options *options, eo_branch_visit *visit, void *context,
                              enum eo_branch_end *end, struct eo_error *error)
{
  if (!(options->low > 0 && options->high > options->low && options->size > 0 && options->first_step > 0 &&
        options->max_points > 0))
    return eo_error_set(error, EO_ERROR_INPUT, "", "A branch between %g and %g rad/s cannot be followed.", options->low,
                        options->high);
  int harmonics = eo_balance_harmonics(balance);
  struct branch b = {.balance = balance,
                     .oscillator = oscillator,
                     .cycle = *cycle,
                     .size = options->size,
                     .start = cycle->frequency,
                     .n = oscillator->ends * eo_fourier_terms(harmonics)};
  double *all = malloc(sizeof *all * 4 * (b.n + 1));
  enum eo_code code = EO_OK;
  if (!all || make_branch(&b, harmonics))
    code = eo_error_memory(error);
  if (!code) {
    struct walk w = {all, all + b.n + 1, all + 2 * (b.n + 1), all + 3 * (b.n + 1), options->first_step};
    code = walk_branch(&b, options, x, direction, &w, visit, context, end, error);
  }
  free_branch(&b);
  free(all);
  return code;
}
