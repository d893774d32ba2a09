/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "numerics/dense.h"

#include <cblas.h>
#include <lapacke.h>
#include <stdbool.h>
#include <stdlib.h>

/* LAPACK sees the transpose of a row-major matrix, so every solve asks for the transposed system. */
int eo_dense_factor(int n, double *a, int *pivot)
{
  return LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, n, n, a, n, pivot);
}

void eo_dense_substitute(int n, const double *a, const int *pivot, int columns, double *b)
{
  LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'T', n, columns, a, n, pivot, b, n);
}

int eo_dense_solve(int n, double *a, int *pivot, int columns, double *b)
{
  int singular = eo_dense_factor(n, a, pivot);
  if (!singular)
    eo_dense_substitute(n, a, pivot, columns, b);
  return singular;
}

int eo_dense_complex_solve(int n, double complex *a, int *pivot, int columns, double complex *b)
{
  if (LAPACKE_zgetrf_work(LAPACK_COL_MAJOR, n, n, a, n, pivot))
    return 1;
  return LAPACKE_zgetrs_work(LAPACK_COL_MAJOR, 'T', n, columns, a, n, pivot, b, n);
}

void eo_dense_multiply(int rows, int columns, const double *a, const double *x, double *y)
{
  cblas_dgemv(CblasRowMajor, CblasNoTrans, rows, columns, 1, a, columns, x, 1, 0, y, 1);
}

void eo_dense_multiply_transposed(int rows, int columns, const double *a, const double *x, double *y)
{
  cblas_dgemv(CblasRowMajor, CblasTrans, rows, columns, 1, a, columns, x, 1, 0, y, 1);
}

void eo_dense_product(int n, const double *a, const double *b, double *c)
{
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, n, n, n, 1, a, n, b, n, 0, c, n);
}

void eo_dense_add_gram(int rows, int columns, const double *a, double *gram)
{
  if (rows > 0)
    cblas_dsyrk(CblasRowMajor, CblasUpper, CblasTrans, columns, rows, 1, a, columns, 1, gram, columns);
}

int eo_dense_symmetric_eigen(int n, double *a, double *values)
{
  return LAPACKE_dsyev(LAPACK_COL_MAJOR, 'V', 'U', n, a, n, values);
}

int eo_dense_eigenvalues(int n, double *a, double complex *values)
{
  double *part = malloc(sizeof *part * 2 * n);
  if (!part)
    return 1;
  int failed = LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'N', n, a, n, part, part + n, NULL, 1, NULL, 1);
  for (int i = 0; i < n && !failed; i++)
    values[i] = part[i] + part[n + i] * I;
  free(part);
  return failed;
}

int eo_dense_eigenvectors(int n, double *a, double complex *values, double complex *vectors)
{
  double *part = malloc(sizeof *part * (size_t)(n * (n + 2)));
  if (!part)
    return 1;
  double *vector = part + 2 * n;
  int failed = LAPACKE_dgeev(LAPACK_ROW_MAJOR, 'N', 'V', n, a, n, part, part + n, NULL, 1, vector, n);
  for (int m = 0; m < n && !failed; m++) {
    bool first = part[n + m] > 0, second = part[n + m] < 0;
    values[m] = part[m] + part[n + m] * I;
    for (int i = 0; i < n; i++)
      vectors[i * n + m] = first    ? vector[i * n + m] + vector[i * n + m + 1] * I
                           : second ? vector[i * n + m - 1] - vector[i * n + m] * I
                                    : vector[i * n + m];
  }
  free(part);
  return failed;
}
