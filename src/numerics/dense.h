/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Small dense matrices by LAPACK and BLAS: linear systems, products, eigenvalues. Row-major everywhere. No allocation
   but where stated. The functions are pure; a caller that wants the same bytes on every machine load keeps BLAS on one
   thread. */
#ifndef EASEOFF_NUMERICS_DENSE_H
#define EASEOFF_NUMERICS_DENSE_H

#include <complex.h>

/* a' b of vectors [n], summed in their order. */
static inline double eo_dot(int n, const double *a, const double *b)
{
  double sum = 0;
  for (int i = 0; i < n; i++)
    sum += a[i] * b[i];
  return sum;
}

/* Solves a x = b for `columns` right-hand sides; b[columns][n] is replaced by the solutions, a[n][n] by its factors,
   pivot[n] is scratch. Returns 0, or non-zero when a is singular (b is then meaningless). */
int eo_dense_solve(int n, double *a, int *pivot, int columns, double *b);

/* The same in two halves: a[n][n] becomes its factors, which then solve for any b[columns][n]. */
int eo_dense_factor(int n, double *a, int *pivot);
void eo_dense_substitute(int n, const double *a, const int *pivot, int columns, double *b);

/* The same as eo_dense_solve() for complex numbers. */
int eo_dense_complex_solve(int n, double complex *a, int *pivot, int columns, double complex *b);

/* y[rows] = a[rows][columns] x[columns], and y[columns] = a' x[rows]. */
void eo_dense_multiply(int rows, int columns, const double *a, const double *x, double *y);
void eo_dense_multiply_transposed(int rows, int columns, const double *a, const double *x, double *y);

/* c = a b, all [n][n]. */
void eo_dense_product(int n, const double *a, const double *b, double *c);

/* gram[columns][columns] += a' a in its upper triangle, a[rows][columns]. */
void eo_dense_add_gram(int rows, int columns, const double *a, double *gram);

/* Eigenvalues (ascending) and orthonormal eigenvectors of the symmetric a[n][n]: row i of a becomes the i-th vector.
   Allocates. Returns 0, or non-zero when memory runs out or the iteration fails. */
int eo_dense_symmetric_eigen(int n, double *a, double *values);

/* Eigenvalues of a general a[n][n], which is destroyed; order as LAPACK finds them. Allocates. Returns as above. */
int eo_dense_eigenvalues(int n, double *a, double complex *values);

/* The same with the eigenvectors as the columns of vectors[n][n], of unit length; conjugates stand beside each other.
 */
int eo_dense_eigenvectors(int n, double *a, double complex *values, double complex *vectors);

#endif
