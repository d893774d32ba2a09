/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Dense Hermitian positive definite systems by LAPACK. */
#ifndef EASEOFF_NUMERICS_HERMITIAN_H
#define EASEOFF_NUMERICS_HERMITIAN_H

#include <complex.h>

/* Solves a x = b for `columns` right-hand sides: a[n][n] by columns, its lower triangle, is replaced by its Cholesky
   factor, b[columns][n] by the solutions. Returns 0, or non-zero when a is not positive definite (b is then
   meaningless). Allocates nothing. Pure; with BLAS on one thread the same bytes on every machine load. */
int eo_hermitian_solve(int n, double complex *a, int columns, double complex *b);

/* The same for a real symmetric matrix in two halves: a becomes its factor, which then solves for any b[columns][n]. */
int eo_symmetric_factor(int n, double *a);
void eo_symmetric_substitute(int n, const double *a, int columns, double *b);

#endif
