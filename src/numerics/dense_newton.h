/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the users of SUNDIALS share: a context, the unknowns, and the dense matrix of Newton's method with its solver.
   With many unknowns that is LAPACK's: the one of SUNDIALS itself takes ten times as long on a hundred. For one thread.
 */
#ifndef EASEOFF_NUMERICS_DENSE_NEWTON_H
#define EASEOFF_NUMERICS_DENSE_NEWTON_H

#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_linearsolver.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

struct eo_dense_newton {
  int n;
  SUNContext context;
  N_Vector x;
  SUNMatrix matrix;
  SUNLinearSolver solver;
  double *jacobian; /* [n][n], row-major, as callers fill it */
};

/* Not 0: no memory; what is there is for eo_dense_newton_done(). From {0}. */
int eo_dense_newton_init(struct eo_dense_newton *newton, int n);
void eo_dense_newton_done(struct eo_dense_newton *newton);

/* The row-major matrix, cleared for the caller's function; and from there to the matrix of SUNDIALS, which goes by
   columns. */
double *eo_dense_newton_clear(struct eo_dense_newton *newton);
void eo_dense_newton_put(const struct eo_dense_newton *newton, SUNMatrix matrix);

/* For SUNDIALS' complaints, which would be printed; the reports say the same. */
void eo_dense_newton_quiet(int code, const char *module, const char *function, char *message, void *user);

#endif
