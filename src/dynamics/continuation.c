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

static int make_branch(struct branch *branch, int harmonics)
{
  size_t n = branch->n;
  branch->harmonic = malloc(sizeof *branch->harmonic * (1 + harmonics));
  branch->x = malloc(sizeof *branch->x * (5 * n + 2 + n * n + (n + 1) * (n + 1)));
  branch->pivot = malloc(sizeof *branch->pivot * (n + 1));
  if (!branch->harmonic || !branch->x || !branch->pivot)
    return -1;
  branch->residual = branch->x + n;
  branch->slope = branch->residual + n;
  branch->step = branch->slope + n;
  branch->jacobian = branch->step + n + 2;
  branch->matrix = branch->jacobian + n * n;
  return 0;
}

static void free_branch(struct branch *branch)
{
  free(branch->harmonic);
  free(branch->x);
  free(branch->pivot);
}

/* Residual and bordered matrix at u, its last row the given direction. */
static enum eo_code linearise(struct branch *branch, const double *u, const double *direction, struct eo_error *error)
{
  int n = branch->n;
  for (int i = 0; i < n; i++)
    branch->x[i] = u[i] * branch->size;
  branch->cycle.frequency = u[n] * branch->start;
  eo_condense(branch->oscillator, branch->cycle.frequency, eo_balance_harmonics(branch->balance), true,
              branch->harmonic);
  enum eo_code code = eo_balance_linearise(branch->balance, branch->oscillator, branch->harmonic, &branch->cycle,
                                           branch->x, branch->residual, branch->jacobian, branch->slope, error);
  for (int i = 0; i < n && !code; i++) {
    double *row = branch->matrix + (size_t)i * (n + 1);
    for (int j = 0; j < n; j++)
      row[j] = branch->jacobian[(size_t)i * n + j] * branch->size;
    row[n] = branch->slope[i] * branch->start;
  }
  memcpy(branch->matrix + (size_t)n * (n + 1), direction, sizeof *direction * (n + 1));
  return code;
}

/* The unit tangent at the point last linearised, on the side of the direction in the last row. Returns 0, or non-zero
   when singular. */
static int tangent_of(struct branch *branch, double *tangent)
{
  int n = branch->n;
  double length = 0;
  memset(tangent, 0, sizeof *tangent * n);
  tangent[n] = 1;
  if (eo_dense_solve(n + 1, branch->matrix, branch->pivot, 1, tangent))
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
static enum eo_code correct(struct branch *branch, const double *base, const double *tangent, double step, double *u,
                            int *corrections, struct eo_error *error)
{
  int n = branch->n;
  for (int i = 0; i <= n; i++)
    u[i] = base[i] + step * tangent[i];
  for (*corrections = 0; *corrections < MAX_CORRECTIONS; ++*corrections) {
    double largest = 0;
    if (!(u[n] > 0))
      break;
    enum eo_code code = linearise(branch, u, tangent, error);
    if (code)
      return code;
    for (int i = 0; i < n; i++) {
      largest = fmax(largest, fabs(branch->residual[i]));
      branch->step[i] = branch->residual[i];
    }
    if (largest <= converged)
      return EO_OK;
    branch->step[n] = 0;
    if (!isfinite(largest) || eo_dense_solve(n + 1, branch->matrix, branch->pivot, 1, branch->step))
      break;
    for (int i = 0; i <= n; i++)
      u[i] -= branch->step[i];
  }
  *corrections = -1;
  return EO_OK;
}

static int visit_point(const struct branch *branch, const double *u, double along, bool fold, eo_branch_visit *visit,
                       void *context)
{
  const struct eo_branch_point point = {.frequency = u[branch->n] * branch->start,
                                        .x = branch->x,
                                        .direction = along >= 0 ? 1 : -1,
                                        .fold = fold,
                                        .grid = eo_balance_grid(branch->balance)};
  return visit(context, &point);
}

/* The walk: base and tangent, trial point and its tangent; n + 1 numbers each. */
struct walk {
  double *base, *tangent, *trial, *next;
  double step;
};

/* One accepted point: trial and next are set, the step for the one after it chosen. *found is false when the branch is
   lost. */
static enum eo_code take_step(struct branch *branch, const struct eo_branch_options *options, struct walk *walk,
                              bool *fold, bool *found, struct eo_error *error)
{
  int n = branch->n, corrections;
  for (*found = false; walk->step >= smallest_step;) {
    enum eo_code code = correct(branch, walk->base, walk->tangent, walk->step, walk->trial, &corrections, error);
    if (code)
      return code;
    if (corrections < 0 || tangent_of(branch, walk->next)) {
      walk->step *= shrink;
      continue;
    }
    *fold = (walk->next[n] > 0) != (walk->tangent[n] > 0);
    double moved = fabs(walk->trial[n] - walk->base[n]) / walk->trial[n];
    if (*fold && moved > options->fold_tolerance && walk->step > smallest_step / shrink) {
      walk->step *= shrink;
      continue;
    }
    walk->step = corrections <= EASY_CORRECTIONS ? fmin(walk->step * growth, options->longest_step) : walk->step;
    *found = true;
    return EO_OK;
  }
  return EO_OK;
}

static enum eo_code start_walk(struct branch *branch, const double *x, int direction, struct walk *walk, bool *found,
                               struct eo_error *error)
{
  int n = branch->n, corrections;
  for (int i = 0; i < n; i++)
    walk->base[i] = x[i] / branch->size;
  walk->base[n] = 1;
  memset(walk->tangent, 0, sizeof *walk->tangent * n);
  walk->tangent[n] = direction >= 0 ? 1 : -1;
  enum eo_code code = correct(branch, walk->base, walk->tangent, 0, walk->trial, &corrections, error);
  if (code)
    return code;
  memcpy(walk->base, walk->trial, sizeof *walk->base * (n + 1));
  *found = corrections >= 0 && !tangent_of(branch, walk->next);
  memcpy(walk->tangent, walk->next, sizeof *walk->tangent * (n + 1));
  return EO_OK;
}

static enum eo_code walk_branch(struct branch *branch, const struct eo_branch_options *options, const double *x,
                                int direction, struct walk *walk, eo_branch_visit *visit, void *context,
                                enum eo_branch_end *end, struct eo_error *error)
{
  bool found, fold = false;
  enum eo_code code = start_walk(branch, x, direction, walk, &found, error);
  for (int point = 0; !code; point++) {
    *end = EO_BRANCH_LOST;
    if (!found)
      break;
    *end = EO_BRANCH_STOPPED;
    if (visit_point(branch, walk->base, walk->tangent[branch->n], fold, visit, context))
      break;
    *end = EO_BRANCH_LIMIT;
    double frequency = walk->base[branch->n] * branch->start;
    if (point > 0 && (frequency <= options->low || frequency >= options->high))
      break;
    *end = EO_BRANCH_POINTS;
    if (point + 1 >= options->max_points)
      break;
    code = take_step(branch, options, walk, &fold, &found, error);
    double *swap = walk->base;
    walk->base = walk->trial;
    walk->trial = swap;
    swap = walk->tangent;
    walk->tangent = walk->next;
    walk->next = swap;
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
  struct branch branch = {.balance = balance,
                          .oscillator = oscillator,
                          .cycle = *cycle,
                          .size = options->size,
                          .start = cycle->frequency,
                          .n = oscillator->ends * eo_fourier_terms(harmonics)};
  double *all = malloc(sizeof *all * 4 * (branch.n + 1));
  enum eo_code code = EO_OK;
  if (!all || make_branch(&branch, harmonics))
    code = eo_error_memory(error);
  if (!code) {
    struct walk walk = {all, all + branch.n + 1, all + 2 * (branch.n + 1), all + 3 * (branch.n + 1),
                        options->first_step};
    code = walk_branch(&branch, options, x, direction, &walk, visit, context, end, error);
  }
  free_branch(&branch);
  free(all);
  return code;
}
