/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tolerance/response_surface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "numerics/dense.h"
#include "tolerance/influence.h"
#include "tolerance/statistics.h"

enum { MOST_LEADING = 24, ROWS_PER_TERM = 2 };

/* What a fit works with; terms: 1, z of every input, z_i z_j of leading ones. */
struct fit {
  struct eo_surface *surface;
  int n, terms;
  double *row;    /* [n][terms] */
  double *normal; /* [terms][terms] */
  double *right;  /* [n + 1][terms]: the solution, then G^-1 of each row */
  int *pivot;
};

static int terms_of(int inputs, int leading)
{
  return 1 + inputs + leading * (leading + 1) / 2;
}

static int leading_of(int n, int inputs)
{
  int leading = 0;
  while (leading < inputs && leading < MOST_LEADING && ROWS_PER_TERM * terms_of(inputs, leading + 1) <= n)
    leading++;
  return leading;
}

double eo_surface_memory(int n, int inputs)
{
  double terms = terms_of(inputs, leading_of(n, inputs));
  return ROWS_PER_TERM * terms > n ? 0 : sizeof(double) * terms * (2. * n + terms);
}

static double standard(const struct eo_surface *surface, int i, const double *input)
{
  const struct eo_moments *moments = &surface->moments[i];
  return moments->deviation > 0 ? (input[i] - moments->mean) / moments->deviation : 0;
}

static void set_terms(const struct eo_surface *surface, const double *input, double *term)
{
  double z[MOST_LEADING];
  *term++ = 1;
  for (int i = 0; i < surface->inputs; i++)
    *term++ = standard(surface, i, input);
  for (int i = 0; i < surface->leading; i++)
    z[i] = standard(surface, surface->lead[i], input);
  for (int i = 0; i < surface->leading; i++)
    for (int j = i; j < surface->leading; j++)
      *term++ = z[i] * z[j];
}

/* As many as leave ROWS_PER_TERM rows for each term, by the size of their correlation with the output or with its
   distance from the mean: an even effect has no linear part. */
static enum eo_code choose_leading(struct eo_surface *surface, int n, const double *input, const double *output,
                                   struct eo_error *error)
{
  int k = surface->inputs, *order = malloc(sizeof *order * (size_t)k);
  double *column = malloc(sizeof *column * (size_t)(2 * n + k));
  enum eo_code code = order && column ? EO_OK : eo_error_memory(error);
  if (!code) {
    double *square = column + n, *size = square + n;
    for (int i = 0; i < k; i++) {
      for (int row = 0; row < n; row++) {
        column[row] = standard(surface, i, input + (size_t)row * (size_t)k);
        square[row] = column[row] * column[row];
      }
      double plain = eo_correlation(n, column, output), even = eo_correlation(n, square, output);
      size[i] = fmax(isnan(plain) ? 0 : fabs(plain), isnan(even) ? 0 : fabs(even));
    }
    eo_order_by_size(k, size, order);
    surface->leading = leading_of(n, k);
    memcpy(surface->lead, order, sizeof *order * (size_t)surface->leading);
  }
  free(order);
  free(column);
  return code;
}

/* Inputs that do not vary have a zero column: their coefficient is held at 0. */
static void hold_constant_inputs(struct fit *fit)
{
  for (int i = 0; i < fit->terms; i++) {
    size_t diagonal = (size_t)i * (size_t)fit->terms + (size_t)i;
    if (fit->normal[diagonal] == 0)
      fit->normal[diagonal] = 1;
  }
}

/* Normal equations; the residual without its own row is e/(1 - h), h = a' G^-1 a (Allen 1974): theory (A8). */
static enum eo_code solve(struct fit *fit, const double *output, struct eo_error *error)
{
  int p = fit->terms, n = fit->n;
  size_t terms = (size_t)p;
  double left_out = 0;
  memset(fit->normal, 0, sizeof(double) * terms * terms);
  eo_dense_add_gram(n, p, fit->row, fit->normal);
  for (size_t i = 0; i < terms; i++)
    for (size_t j = 0; j < i; j++)
      fit->normal[i * terms + j] = fit->normal[j * terms + i];
  hold_constant_inputs(fit);
  eo_dense_multiply_transposed(n, p, fit->row, output, fit->right);
  memcpy(fit->right + terms, fit->row, sizeof(double) * terms * (size_t)n);
  if (eo_dense_factor(p, fit->normal, fit->pivot))
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "The inputs depend on each other: no surface.");
  eo_dense_substitute(p, fit->normal, fit->pivot, n + 1, fit->right);
  struct eo_summary summary = eo_summary_of(n, output);
  for (int i = 0; i < n; i++) {
    const double *row = fit->row + (size_t)i * terms, *solved = fit->right + (size_t)(i + 1) * terms;
    double fitted = 0, leverage = 0;
    for (size_t t = 0; t < terms; t++) {
      fitted += row[t] * fit->right[t];
      leverage += row[t] * solved[t];
    }
    double error_i = (output[i] - fitted) / fmax(1 - leverage, 1e-9);
    left_out += error_i * error_i;
  }
  fit->surface->residual = sqrt(left_out / n);
  fit->surface->q2 = summary.largest > summary.least ? 1 - left_out / (summary.deviation * summary.deviation * (n - 1))
                                                     : NAN;
  return EO_OK;
}

static void keep(struct fit *fit)
{
  struct eo_surface *surface = fit->surface;
  const double *term = fit->right;
  surface->constant = *term++;
  for (int i = 0; i < surface->inputs; i++)
    surface->slope[i] = *term++;
  for (int i = 0; i < surface->leading; i++)
    for (int j = i; j < surface->leading; j++)
      surface->square[i * surface->leading + j] = *term++;
}

static enum eo_code run_fit(struct eo_surface *surface, int n, const double *input, const double *output,
                            struct eo_error *error)
{
  struct fit fit = {.surface = surface, .n = n, .terms = terms_of(surface->inputs, surface->leading)};
  size_t terms = (size_t)fit.terms, rows = (size_t)n;
  fit.row = malloc(sizeof(double) * terms * rows);
  fit.normal = malloc(sizeof(double) * terms * terms);
  fit.right = malloc(sizeof(double) * terms * (rows + 1));
  fit.pivot = malloc(sizeof(int) * terms);
  enum eo_code code = fit.row && fit.normal && fit.right && fit.pivot ? EO_OK : eo_error_memory(error);
  for (size_t i = 0; i < rows && !code; i++)
    set_terms(surface, input + i * (size_t)surface->inputs, fit.row + i * terms);
  if (!code)
    code = solve(&fit, output, error);
  if (!code)
    keep(&fit);
  free(fit.row);
  free(fit.normal);
  free(fit.right);
  free(fit.pivot);
  return code;
}

enum eo_code eo_surface_fit(struct eo_surface *surface, int n, int inputs, const struct eo_moments *moments,
                            const double *input, const double *output, struct eo_error *error)
{
  *surface = (struct eo_surface){.inputs = inputs};
  if (n < ROWS_PER_TERM * terms_of(inputs, 0))
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "A surface over %d inputs takes %d rows or more, not %d.", inputs,
                        ROWS_PER_TERM * terms_of(inputs, 0), n);
  surface->lead = malloc(sizeof *surface->lead * MOST_LEADING);
  surface->moments = malloc(sizeof *surface->moments * (size_t)inputs);
  surface->slope = calloc((size_t)inputs, sizeof *surface->slope);
  surface->square = calloc((size_t)MOST_LEADING * MOST_LEADING, sizeof *surface->square);
  if (!surface->lead || !surface->moments || !surface->slope || !surface->square)
    return eo_error_memory(error);
  memcpy(surface->moments, moments, sizeof *moments * (size_t)inputs);
  EO_TRY(choose_leading(surface, n, input, output, error));
  return run_fit(surface, n, input, output, error);
}

void eo_surface_done(struct eo_surface *surface)
{
  if (!surface)
    return;
  free(surface->lead);
  free(surface->moments);
  free(surface->slope);
  free(surface->square);
  *surface = (struct eo_surface){0};
}

/* theory (A10): variance of b z + q z^2 with E z = 0, E z^2 = 1, and of q z_i z_j. */
void eo_surface_indices(const struct eo_surface *surface, double *first, double *total)
{
  double variance = 0;
  for (int i = 0; i < surface->inputs; i++)
    first[i] = surface->moments[i].deviation > 0 ? surface->slope[i] * surface->slope[i] : 0;
  for (int i = 0; i < surface->leading; i++) {
    int k = surface->lead[i];
    const struct eo_moments *moments = &surface->moments[k];
    double q = surface->square[i * surface->leading + i];
    if (moments->deviation > 0)
      first[k] += 2 * surface->slope[k] * q * moments->third + q * q * (moments->fourth - 1);
  }
  for (int i = 0; i < surface->inputs; i++) {
    total[i] = first[i];
    variance += first[i];
  }
  for (int i = 0; i < surface->leading; i++)
    for (int j = i + 1; j < surface->leading; j++) {
      double q = surface->square[i * surface->leading + j];
      variance += q * q;
      total[surface->lead[i]] += q * q;
      total[surface->lead[j]] += q * q;
    }
  for (int i = 0; i < surface->inputs; i++) {
    first[i] = variance > 0 ? first[i] / variance : NAN;
    total[i] = variance > 0 ? total[i] / variance : NAN;
  }
}
