/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "flexibility/spline.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The knot interval [knot[k], knot[k + 1]) that holds x, 3 <= k < count. */
static int find_interval(const struct eo_spline *spline, double x)
{
  int low = EO_SPLINE_WIDTH - 1, high = spline->count;
  while (high - low > 1) {
    int middle = (low + high) / 2;
    if (x < spline->knot[middle])
      high = middle;
    else
      low = middle;
  }
  return low;
}

/* B-splines of the given order (1: constant .. 4: cubic) that live on interval k (Cox, de Boor). */
static void basis(const double *knot, int k, double x, int order, double value[EO_SPLINE_WIDTH])
{
  value[0] = 1;
  for (int o = 1; o < order; o++) {
    double carry = 0;
    for (int i = 0; i < o; i++) {
      double right = knot[k + 1 + i], left = knot[k + 1 + i - o], part = value[i] / (right - left);
      value[i] = carry + (right - x) * part;
      carry = (x - left) * part;
    }
    value[o] = carry;
  }
}

/* Derivatives of the four cubic B-splines on interval k from the three quadratic ones. */
static void basis_slope(const double *knot, int k, double x, double slope[EO_SPLINE_WIDTH])
{
  double lower[EO_SPLINE_WIDTH];
  basis(knot, k, x, 3, lower);
  for (int i = 0; i < EO_SPLINE_WIDTH; i++) {
    int b = k - 3 + i;
    double rise = i > 0 ? lower[i - 1] / (knot[b + 3] - knot[b]) : 0;
    double fall = i < 3 ? lower[i] / (knot[b + 4] - knot[b + 1]) : 0;
    slope[i] = 3 * (rise - fall);
  }
}

void eo_spline_weights(const struct eo_spline *spline, double x, int *first, double weight[EO_SPLINE_WIDTH])
{
  double inside = fmin(fmax(x, spline->first), spline->last);
  double outside = fmin(fmax(x - inside, -spline->margin), spline->margin);
  int k = find_interval(spline, inside);
  *first = k - 3;
  basis(spline->knot, k, inside, 4, weight);
  if (outside == 0)
    return;
  double slope[EO_SPLINE_WIDTH];
  basis_slope(spline->knot, k, inside, slope);
  for (int i = 0; i < EO_SPLINE_WIDTH; i++)
    weight[i] += outside * slope[i];
}

void eo_spline_value_weights(const struct eo_spline *spline, double x, double *row)
{
  int first, n = spline->count;
  double weight[EO_SPLINE_WIDTH];
  eo_spline_weights(spline, x, &first, weight);
  memset(row, 0, (size_t)n * sizeof *row);
  for (int b = 0; b < EO_SPLINE_WIDTH; b++)
    for (int j = 0; j < n; j++)
      row[j] += weight[b] * spline->to_coefficients[(size_t)(first + b) * (size_t)n + (size_t)j];
}

/* Inverts the collocation matrix a[n][n] into inverse; it is totally positive, so no pivoting is needed (de Boor,
   Pinkus 1977). */
static void invert_collocation(int n, double *a, double *inverse)
{
  size_t row = (size_t)n;
  for (size_t i = 0; i < row; i++)
    inverse[i * row + i] = 1;
  for (size_t p = 0; p < row; p++) {
    double pivot = 1 / a[p * row + p];
    for (size_t j = 0; j < row; j++) {
      a[p * row + j] *= pivot;
      inverse[p * row + j] *= pivot;
    }
    for (size_t i = 0; i < row; i++) {
      double factor = a[i * row + p];
      if (i == p || factor == 0)
        continue;
      for (size_t j = 0; j < row; j++) {
        a[i * row + j] -= factor * a[p * row + j];
        inverse[i * row + j] -= factor * inverse[p * row + j];
      }
    }
  }
}

enum eo_code eo_spline_init(struct eo_spline *spline, int count, const double *place, struct eo_error *error)
{
  if (count < 4 || count > EO_SPLINE_MAX)
    return eo_error_set(error, EO_ERROR_INPUT, "", "A spline needs 4 to %d values, not %d.", EO_SPLINE_MAX, count);
  size_t n = (size_t)count;
  double *collocation = calloc(n * n, sizeof *collocation);
  *spline = (struct eo_spline){.count = count, .first = place[0], .last = place[count - 1]};
  spline->to_coefficients = calloc(n * n, sizeof *spline->to_coefficients);
  if (!collocation || !spline->to_coefficients) {
    free(collocation);
    eo_spline_done(spline);
    return eo_error_memory(error);
  }
  spline->margin = fmin(place[1] - place[0], place[count - 1] - place[count - 2]);
  for (int i = 0; i < 4; i++) {
    spline->knot[i] = place[0];
    spline->knot[count + i] = place[count - 1];
  }
  for (int i = 4; i < count; i++)
    spline->knot[i] = place[i - 2];
  for (int i = 0; i < count; i++) {
    int first;
    double weight[EO_SPLINE_WIDTH];
    eo_spline_weights(spline, place[i], &first, weight);
    memcpy(collocation + (size_t)i * n + (size_t)first, weight, sizeof weight);
  }
  invert_collocation(count, collocation, spline->to_coefficients);
  free(collocation);
  return EO_OK;
}

void eo_spline_done(struct eo_spline *spline)
{
  if (!spline)
    return;
  free(spline->to_coefficients);
  spline->to_coefficients = NULL;
}
