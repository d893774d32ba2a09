/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "numerics/hermitian.h"

#include <lapacke.h>

int eo_hermitian_solve(int n, double complex *a, int columns, double complex *b)
{
  int failed = LAPACKE_zpotrf_work(LAPACK_COL_MAJOR, 'L', n, a, n);
  return failed ? failed : LAPACKE_zpotrs_work(LAPACK_COL_MAJOR, 'L', n, columns, a, n, b, n);
}

int eo_symmetric_factor(int n, double *a)
{
  return LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', n, a, n);
}

void eo_symmetric_substitute(int n, const double *a, int columns, double *b)
{
  LAPACKE_dpotrs_work(LAPACK_COL_MAJOR, 'L', n, columns, a, n, b, n);
}
