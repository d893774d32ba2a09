/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "numerics/lowrank.h"

#include "numerics/gram.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

static double largest_diagonal(int n, const double *matrix)
{
  double largest = 0;
  for (int i = 0; i < n; i++) {
    double d = matrix[(size_t)i * (size_t)n + (size_t)i];
    if (!(d >= 0) || isinf(d))
      return NAN;
    largest = fmax(largest, d);
  }
  return largest;
}

enum eo_code eo_lowrank_factor(int n, double *matrix, double tolerance, int *rank, int *stride, double **factor,
                               struct eo_error *error)
{
  lapack_int *pivot = malloc(sizeof *pivot * (size_t)n), r = 0;
  double largest = largest_diagonal(n, matrix);
  *factor = NULL;
  if (!pivot)
    return eo_error_memory(error);
  if (isnan(largest)) {
    free(pivot);
    return eo_error_set(error, EO_ERROR_NUMERIC, "",
                        "The compliance between contact points is not positive semi-definite.");
  }
  if (largest > 0)
    LAPACKE_dpstrf(LAPACK_COL_MAJOR, 'L', n, matrix, n, pivot, &r, tolerance * largest);
  int width = r > 0 ? ((int)r + EO_GRAM_LANE - 1) / EO_GRAM_LANE * EO_GRAM_LANE : EO_GRAM_LANE;
  double *rows = eo_gram_allocate((long)n * width);
  for (int i = 0; rows && i < n; i++)
    for (int j = 0; j < r && j <= i; j++)
      rows[(size_t)(pivot[i] - 1) * (size_t)width + (size_t)j] = matrix[(size_t)j * (size_t)n + (size_t)i];
  free(pivot);
  if (!rows)
    return eo_error_memory(error);
  *rank = (int)r;
  *stride = width;
  *factor = rows;
  return EO_OK;
}

enum eo_code eo_lowrank_solve(int n, double *matrix, int columns, double *rhs, struct eo_error *error)
{
  if (LAPACKE_dposv(LAPACK_ROW_MAJOR, 'L', n, columns, matrix, n, rhs, columns) == 0)
    return EO_OK;
  return eo_error_set(error, EO_ERROR_NUMERIC, "", "A normal matrix is not positive definite.");
}
