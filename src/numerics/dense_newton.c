/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "numerics/dense_newton.h"

#include <lapacke.h>
#include <stdlib.h>
#include <string.h>

enum { MANY = 32 }; /* unknowns from which LAPACK is the faster one */

static SUNLinearSolver_Type type_of(SUNLinearSolver solver)
{
  (void)solver;
  return SUNLINEARSOLVER_DIRECT;
}

/* Factors the matrix in place; the pivots are the solver's content. */
static int set_up(SUNLinearSolver solver, SUNMatrix matrix)
{
  int n = (int)SUNDenseMatrix_Columns(matrix),
      singular = LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, n, n, SUNDenseMatrix_Data(matrix), n, solver->content);
  return singular ? SUNLS_LUFACT_FAIL : SUNLS_SUCCESS;
}

static int solve(SUNLinearSolver solver, SUNMatrix matrix, N_Vector x, N_Vector right, realtype tolerance)
{
  (void)tolerance;
  int n = (int)SUNDenseMatrix_Columns(matrix);
  N_VScale(1, right, x);
  LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'N', n, 1, SUNDenseMatrix_Data(matrix), n, solver->content,
                      N_VGetArrayPointer(x), n);
  return SUNLS_SUCCESS;
}

static int free_solver(SUNLinearSolver solver)
{
  free(solver->content);
  solver->content = NULL;
  SUNLinSolFreeEmpty(solver);
  return SUNLS_SUCCESS;
}

static SUNLinearSolver new_lapack(int n, SUNContext context)
{
  SUNLinearSolver solver = SUNLinSolNewEmpty(context);
  if (!solver)
    return NULL;
  solver->ops->gettype = type_of;
  solver->ops->setup = set_up;
  solver->ops->solve = solve;
  solver->ops->free = free_solver;
  solver->content = malloc(sizeof(int) * (size_t)n);
  if (solver->content)
    return solver;
  free_solver(solver);
  return NULL;
}

int eo_dense_newton_init(struct eo_dense_newton *newton, int n)
{
  newton->n = n;
  if (SUNContext_Create(NULL, &newton->context))
    return -1;
  newton->x = N_VNew_Serial(n, newton->context);
  newton->matrix = SUNDenseMatrix(n, n, newton->context);
  newton->jacobian = malloc(sizeof *newton->jacobian * n * n);
  if (!newton->x || !newton->matrix || !newton->jacobian)
    return -1;
  newton->solver = n < MANY ? SUNLinSol_Dense(newton->x, newton->matrix, newton->context)
                            : new_lapack(n, newton->context);
  return newton->solver ? 0 : -1;
}

void eo_dense_newton_done(struct eo_dense_newton *newton)
{
  if (newton->solver)
    SUNLinSolFree(newton->solver);
  if (newton->matrix)
    SUNMatDestroy(newton->matrix);
  if (newton->x)
    N_VDestroy(newton->x);
  if (newton->context)
    SUNContext_Free(&newton->context);
  free(newton->jacobian);
}

double *eo_dense_newton_clear(struct eo_dense_newton *newton)
{
  memset(newton->jacobian, 0, sizeof *newton->jacobian * newton->n * newton->n);
  return newton->jacobian;
}

void eo_dense_newton_put(const struct eo_dense_newton *newton, SUNMatrix matrix)
{
  int n = newton->n;
  for (int j = 0; j < n; j++) {
    double *column = SUNDenseMatrix_Column(matrix, j);
    for (int i = 0; i < n; i++)
      column[i] = newton->jacobian[(size_t)i * n + j];
  }
}

/* NOLINTNEXTLINE(readability-non-const-parameter): the type of a handler of SUNDIALS */
void eo_dense_newton_quiet(int code, const char *module, const char *function, char *message, void *user)
{
  (void)code, (void)module, (void)function, (void)message, (void)user;
}
