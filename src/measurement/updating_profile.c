/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/updating_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "numerics/least_squares.h"

enum { ITERATIONS = 12, MOST_STEPS = 60, HALVINGS = 12 };
static const double STEP = 2e-4, TOLERANCE = 1e-5;
static const double FIRST = 0.3, GROWTH = 1.5, LONGEST = 0.04, SHORTEST = 1e-5; /* steps along the unknown: of its
                                                                                  standard deviation, each times the one
                                                                                  before, of its range */

/* The others of one unknown that is held. */
struct held {
  struct eo_fit *fit;
  int held, n;
  double at;
};

static void put_together(const struct held *held, const double *others, double *x)
{
  for (int j = 0, k = 0; j < held->n; j++)
    x[j] = j == held->held ? held->at : others[k++];
}

static enum eo_code residuals_of_others(void *context, const double *others, double *residual, struct eo_error *error)
{
  struct held *held = context;
  double x[EO_UNKNOWNS];
  put_together(held, others, x);
  return eo_fit_residuals(held->fit, x, residual, error);
}

/* The least sum of squares over the others with the unknown held at a place; others[n - 1] go along. */
static enum eo_code least_at(struct held *held, double at, double *others, double *residual, double *square,
                             struct eo_error *error)
{
  const struct eo_least_squares_options options = {.iterations = ITERATIONS, .step = STEP, .tolerance = TOLERANCE};
  struct eo_least_squares_report report = {0};
  enum eo_code code;
  held->at = at;
  if (held->n > 1) {
    code = eo_least_squares(residuals_of_others, held, held->n - 1, held->fit->residuals, &options, others, NULL,
                            &report, error);
    *square = report.square;
    return code;
  }
  code = eo_fit_residuals(held->fit, &held->at, residual, error);
  *square = 0;
  for (int i = 0; i < held->fit->residuals && !code; i++)
    *square += residual[i] * residual[i];
  return code;
}

/* The place beyond which the profile leaves the limit, in one direction: growing steps out, then halvings between the
   last inside and the first outside. */
static enum eo_code walk(struct held *held, const struct eo_minimum *minimum, int way, double first, double limit,
                         double *residual, double *reach, struct eo_error *error)
{
  double others[EO_UNKNOWNS], inside = minimum->x[held->held], outside = NAN, step = first, square;
  for (int j = 0, k = 0; j < held->n; j++)
    if (j != held->held)
      others[k++] = minimum->x[j];
  for (int i = 0; i < MOST_STEPS && isnan(outside) && inside != (way > 0); i++) {
    double at = fmin(1, fmax(0, inside + way * step));
    enum eo_code code = least_at(held, at, others, residual, &square, error);
    if (code)
      return code;
    if (square > limit)
      outside = at;
    else
      inside = at;
    step = fmin(step * GROWTH, LONGEST);
  }
  for (int i = 0; i < HALVINGS && !isnan(outside) && fabs(outside - inside) > SHORTEST; i++) {
    double at = (inside + outside) / 2;
    enum eo_code code = least_at(held, at, others, residual, &square, error);
    if (code)
      return code;
    *(square > limit ? &outside : &inside) = at;
  }
  *reach = isnan(outside) ? inside : (inside + outside) / 2;
  return EO_OK;
}

enum eo_code eo_fit_profile(struct eo_fit *fit, const struct eo_minimum *minimum, int i, double sigma, double limit,
                            double reach[2], struct eo_error *error)
{
  struct held held = {.fit = fit, .held = i, .n = fit->settings->unknowns};
  double *residual = malloc(sizeof *residual * (size_t)fit->residuals);
  double first = fmin(fmax(FIRST * sigma, SHORTEST), LONGEST);
  if (!residual)
    return eo_error_memory(error);
  enum eo_code code = walk(&held, minimum, -1, first, limit, residual, &reach[0], error);
  if (!code)
    code = walk(&held, minimum, 1, first, limit, residual, &reach[1], error);
  free(residual);
  return code;
}
