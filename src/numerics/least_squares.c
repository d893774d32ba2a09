/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "numerics/least_squares.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "numerics/dense.h"

enum { MOST = EO_LEAST_SQUARES_MOST };

struct search {
  eo_residual_function *function;
  void *context;
  int n, m;
  const struct eo_least_squares_options *options;
  struct eo_least_squares_report *report;
  double *residual, *trial, *jacobian; /* [m], [m], [m][n] */
};

static enum eo_code evaluate(struct search *search, const double *x, double *residual, struct eo_error *error)
{
  search->report->evaluations++;
  return search->function(search->context, x, residual, error);
}

static enum eo_code differentiate(struct search *search, const double *x, struct eo_error *error)
{
  double moved[MOST];
  for (int j = 0; j < search->n; j++) {
    double step = x[j] + search->options->step <= 1 ? search->options->step : -search->options->step;
    memcpy(moved, x, sizeof *x * (size_t)search->n);
    moved[j] += step;
    enum eo_code code = evaluate(search, moved, search->trial, error);
    if (code)
      return code;
    for (int i = 0; i < search->m; i++)
      search->jacobian[i * search->n + j] = (search->trial[i] - search->residual[i]) / step;
  }
  return EO_OK;
}

/* (J'J + damping diag) step = -J'r among the unknowns that may move. */
static bool find_step(const struct search *search, const double *x, double damping, double *step)
{
  double matrix[MOST * MOST], gradient[MOST];
  int pivot[MOST], at[MOST], free_unknowns = 0;
  for (int j = 0; j < search->n; j++) {
    gradient[j] = 0;
    for (int i = 0; i < search->m; i++)
      gradient[j] += search->jacobian[i * search->n + j] * search->residual[i];
    step[j] = 0;
    bool held = (x[j] <= 0 && gradient[j] > 0) || (x[j] >= 1 && gradient[j] < 0);
    if (!held)
      at[free_unknowns++] = j;
  }
  static const double BARE = 1e-12; /* on the diagonal: of an unknown that moves nothing */
  double solution[MOST];
  for (int a = 0; a < free_unknowns; a++) {
    solution[a] = -gradient[at[a]];
    for (int b = 0; b < free_unknowns; b++) {
      double sum = 0;
      for (int i = 0; i < search->m; i++)
        sum += search->jacobian[i * search->n + at[a]] * search->jacobian[i * search->n + at[b]];
      matrix[a * free_unknowns + b] = a == b ? sum * (1 + damping) + BARE : sum;
    }
  }
  if (!free_unknowns || eo_dense_solve(free_unknowns, matrix, pivot, 1, solution))
    return false;
  for (int a = 0; a < free_unknowns; a++)
    step[at[a]] = solution[a];
  return true;
}

/* Tries steps with growing damping; *moved: the largest change of an unknown, 0 when none helps. */
static enum eo_code improve(struct search *search, double *x, double *damping, double *moved, struct eo_error *error)
{
  double step[MOST], next[MOST];
  *moved = 0;
  for (int attempt = 0; attempt < 12; attempt++, *damping *= 4) {
    double change = 0;
    if (!find_step(search, x, *damping, step))
      return EO_OK;
    for (int j = 0; j < search->n; j++) {
      next[j] = fmin(1, fmax(0, x[j] + step[j]));
      change = fmax(change, fabs(next[j] - x[j]));
    }
    if (change < search->options->tolerance)
      return EO_OK;
    enum eo_code code = evaluate(search, next, search->trial, error);
    if (code)
      return code;
    double value = eo_dot(search->m, search->trial, search->trial);
    if (value < search->report->square) {
      memcpy(x, next, sizeof *x * (size_t)search->n);
      memcpy(search->residual, search->trial, sizeof *search->residual * (size_t)search->m);
      search->report->square = value;
      *damping = fmax(*damping / 6, 1e-9);
      *moved = change;
      return EO_OK;
    }
  }
  return EO_OK;
}

enum eo_code eo_least_squares(eo_residual_function *function, void *context, int n, int m,
                              const struct eo_least_squares_options *options, double *x, double *jacobian,
                              struct eo_least_squares_report *report, struct eo_error *error)
{
  *report = (struct eo_least_squares_report){0};
  if (n < 1 || n > MOST || m < 1)
    return eo_error_set(error, EO_ERROR_INPUT, "", "A fit takes 1 to %d unknowns.", MOST);
  double *room = calloc((size_t)m * (size_t)(n + 2), sizeof *room), damping = 1e-3, moved = 1;
  if (!room)
    return eo_error_memory(error);
  struct search search = {function, context, n, m, options, report, room, room + m, room + 2 * m};
  enum eo_code code = evaluate(&search, x, search.residual, error);
  report->square = code ? NAN : eo_dot(m, search.residual, search.residual);
  while (!code && !report->converged && report->iterations < options->iterations) {
    report->iterations++;
    code = differentiate(&search, x, error);
    if (!code)
      code = improve(&search, x, &damping, &moved, error);
    report->converged = moved < options->tolerance;
  }
  if (!code && jacobian) {
    code = differentiate(&search, x, error);
    memcpy(jacobian, search.jacobian, sizeof *jacobian * (size_t)(m * n));
  }
  free(room);
  return code;
}
