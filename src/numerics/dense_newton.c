/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "numerics/dense_newton.h"

#include <stdlib.h>
#include <string.h>

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
  newton->solver = SUNLinSol_Dense(newton->x, newton->matrix, newton->context);
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
