/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "numerics/factor.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BLOCK = 64 }; /* LAPACK's largest block: workspaces of BLOCK times the order never limit it */

enum eo_code eo_saddle_init(struct eo_saddle *saddle, int rows_max, int columns_max, struct eo_error *error)
{
  *saddle = (struct eo_saddle){.rows_max = rows_max, .columns_max = columns_max};
  const size_t m = (size_t)rows_max, q = (size_t)columns_max;
  saddle->work_size = (int)(BLOCK * m + (size_t)BLOCK * BLOCK * 2);
  saddle->basis = malloc(q * m * sizeof(double));
  saddle->tau = malloc(q * sizeof(double));
  saddle->projected = malloc(m * m * sizeof(double));
  saddle->inverse = malloc(m * m * sizeof(double));
  saddle->work = malloc((size_t)saddle->work_size * sizeof(double));
  if (saddle->basis && saddle->tau && saddle->projected && saddle->inverse && saddle->work)
    return EO_OK;
  eo_saddle_done(saddle);
  return eo_error_memory(error);
}

void eo_saddle_done(struct eo_saddle *saddle)
{
  free(saddle->basis);
  free(saddle->tau);
  free(saddle->projected);
  free(saddle->inverse);
  free(saddle->work);
  *saddle = (struct eo_saddle){0};
}

/* Multiplies b, [columns][stride], by Q or Q' of the tail's QR factorisation, from the left; or [rows][rows] from the
   right. */
static void apply_basis(struct eo_saddle *saddle, char side, char transposed, double *b, int columns, int stride)
{
  const int m = side == 'L' ? saddle->rows : columns, n = side == 'L' ? columns : saddle->rows;
  LAPACKE_dormqr_work(LAPACK_COL_MAJOR, side, transposed, m, n, saddle->columns, saddle->basis, saddle->rows,
                      saddle->tau, b, stride, saddle->work, saddle->work_size);
}

static bool basis_has_full_rank(const struct eo_saddle *saddle)
{
  static const double ROUNDING = 1e-12;
  double largest = 0, smallest = INFINITY;
  for (int k = 0; k < saddle->columns; k++) {
    const double r = fabs(saddle->basis[k * saddle->rows + k]);
    largest = fmax(largest, r);
    smallest = fmin(smallest, r);
  }
  return smallest > ROUNDING * largest;
}

bool eo_saddle_factor(struct eo_saddle *saddle, int rows, int columns, const double *a, const double *p)
{
  const size_t m = (size_t)rows, q = (size_t)columns;
  if (rows <= columns || rows > saddle->rows_max || columns > saddle->columns_max)
    return false;
  saddle->rows = rows;
  saddle->columns = columns;
  memcpy(saddle->basis, p, q * m * sizeof *p);
  if (LAPACKE_dgeqrf_work(LAPACK_COL_MAJOR, rows, columns, saddle->basis, rows, saddle->tau, saddle->work,
                          saddle->work_size) != 0 ||
      !basis_has_full_rank(saddle))
    return false;
  memcpy(saddle->projected, a, m * m * sizeof *a);
  apply_basis(saddle, 'L', 'T', saddle->projected, rows, rows);
  apply_basis(saddle, 'R', 'N', saddle->projected, rows, rows);
  return LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', rows - columns, saddle->projected + q * m + q, rows) == 0;
}

void eo_saddle_solve(struct eo_saddle *saddle, int count, const double *y, double *c, int stride, double *b)
{
  const int m = saddle->rows, q = saddle->columns;
  for (int i = 0; i < count; i++)
    memcpy(c + (size_t)i * stride, y + (size_t)i * m, (size_t)m * sizeof *y);
  apply_basis(saddle, 'L', 'T', c, count, stride);
  for (int i = 0; i < count; i++)
    memcpy(b + (size_t)i * q, c + (size_t)i * stride, (size_t)q * sizeof *b);
  LAPACKE_dpotrs_work(LAPACK_COL_MAJOR, 'L', m - q, count, saddle->projected + q * m + q, m, c + q, stride);
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, q, count, m - q, -1, saddle->projected + q * m, m, c + q,
              stride, 1, b, q);
  LAPACKE_dtrtrs_work(LAPACK_COL_MAJOR, 'U', 'N', 'N', q, count, saddle->basis, m, b, q);
  for (int i = 0; i < count; i++)
    memset(c + (size_t)i * stride, 0, (size_t)q * sizeof *c);
  apply_basis(saddle, 'L', 'N', c, count, stride);
}

void eo_saddle_inverse_diagonal(struct eo_saddle *saddle, double *diagonal)
{
  const int m = saddle->rows, q = saddle->columns, inner = m - q;
  double *inverse = saddle->inverse; /* [inner][m]: Q [0; L^-T], whose rows' squares sum up to the diagonal */
  double *lower = saddle->projected + q * m + q;
  for (int j = 0; j < inner; j++)
    for (int k = 0; k < inner; k++)
      inverse[j * m + q + k] = k > j ? 0 : lower[k * m + j];
  LAPACKE_dtrtri_work(LAPACK_COL_MAJOR, 'U', 'N', inner, inverse + q, m);
  for (int j = 0; j < inner; j++)
    memset(inverse + j * m, 0, (size_t)q * sizeof *inverse);
  apply_basis(saddle, 'L', 'N', inverse, inner, m);
  memset(diagonal, 0, (size_t)m * sizeof *diagonal);
  for (int j = 0; j < inner; j++)
    for (int k = 0; k < m; k++)
      diagonal[k] += inverse[j * m + k] * inverse[j * m + k];
}
