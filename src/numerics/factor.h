/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Small dense systems (a few hundred unknowns) by LAPACK. Matrices are column-major. One object per thread; results
   repeat bit for bit as long as BLAS runs on one thread. */
#ifndef EASEOFF_NUMERICS_FACTOR_H
#define EASEOFF_NUMERICS_FACTOR_H

#include "base/error.h"

#include <stdbool.h>

/* [A P; P' 0] [c; b] = [y; 0], A symmetric and positive definite on the null space of P', by a QR factorisation of P
   and a Cholesky factor of A in that null space (Benzi, Golub, Liesen 2005, section 6). */
struct eo_saddle {
  int rows_max, columns_max; /* room */
  int rows, columns;         /* m, q of the system that is factorised */
  double *basis;             /* [q][m] Householder reflections and R of P; owned, as all below */
  double *tau;               /* [q] */
  double *projected;         /* [m][m] Q' A Q; its trailing block holds the Cholesky factor */
  double *inverse;           /* [m][m] scratch */
  double *work;              /* LAPACK's */
  int work_size;
};

/* Room for systems of up to rows_max and columns_max; eo_saddle_done() accepts a zeroed object. */
enum eo_code eo_saddle_init(struct eo_saddle *saddle, int rows_max, int columns_max, struct eo_error *error);
void eo_saddle_done(struct eo_saddle *saddle);

/* Factorises. a: [m][m], both triangles, and p: [q][m]; both are copied. False when P has not full rank or A is not
   positive definite in its null space: then nothing may be solved. Needs m > q. */
bool eo_saddle_factor(struct eo_saddle *saddle, int rows, int columns, const double *a, const double *p);

/* Solves for right-hand sides y[count][m]: c[count][stride], of which m count, and b[count][q]. */
void eo_saddle_solve(struct eo_saddle *saddle, int count, const double *y, double *c, int stride, double *b);

/* The first m entries of the diagonal of the inverse. */
void eo_saddle_inverse_diagonal(struct eo_saddle *saddle, double *diagonal);

#endif
