/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "numerics/ode.h"

#include "numerics/dense_newton.h"

#include <cvode/cvode.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_STEPS = 10000000 };

struct eo_ode {
  int n, begun;                  /* begun: CVodeInit has been called */
  struct eo_dense_newton newton; /* its unknowns: the state */
  void *cvode;
  N_Vector tolerance;
  struct eo_ode_problem problem;
};

static int call_function(double t, N_Vector y, N_Vector slope, void *user)
{
  struct eo_ode *ode = user;
  return ode->problem.function(ode->problem.context, t, N_VGetArrayPointer(y), N_VGetArrayPointer(slope));
}

static int call_jacobian(double t, N_Vector y, N_Vector slope, SUNMatrix matrix, void *user, N_Vector scratch1,
                         N_Vector scratch2, N_Vector scratch3)
{
  (void)slope, (void)scratch1, (void)scratch2, (void)scratch3;
  struct eo_ode *ode = user;
  int code = ode->problem.jacobian(ode->problem.context, t, N_VGetArrayPointer(y), eo_dense_newton_clear(&ode->newton));
  if (!code)
    eo_dense_newton_put(&ode->newton, matrix);
  return code;
}

static int make_parts(struct eo_ode *ode)
{
  if (eo_dense_newton_init(&ode->newton, ode->n))
    return -1;
  ode->tolerance = N_VNew_Serial(ode->n, ode->newton.context);
  ode->cvode = CVodeCreate(CV_ADAMS, ode->newton.context);
  return !ode->tolerance || !ode->cvode || CVodeSetErrHandlerFn(ode->cvode, eo_dense_newton_quiet, NULL) ? -1 : 0;
}

enum eo_code eo_ode_new(struct eo_ode **workspace, int n, struct eo_error *error)
{
  if (n < 1)
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "A differential equation needs at least one unknown, not %d.", n);
  struct eo_ode *ode = calloc(1, sizeof *ode);
  if (!ode)
    return eo_error_memory(error);
  ode->n = n;
  if (make_parts(ode)) {
    eo_ode_free(ode);
    return eo_error_memory(error);
  }
  *workspace = ode;
  return EO_OK;
}

void eo_ode_free(struct eo_ode *ode)
{
  if (!ode)
    return;
  if (ode->cvode)
    CVodeFree(&ode->cvode);
  if (ode->tolerance)
    N_VDestroy(ode->tolerance);
  eo_dense_newton_done(&ode->newton);
  free(ode);
}

/* CVodeInit allocates and belongs to the first start; the linear solver can only be attached after it. */
static int begin(struct eo_ode *ode, double t)
{
  if (ode->begun)
    return CVodeReInit(ode->cvode, t, ode->newton.x);
  ode->begun = 1;
  return CVodeInit(ode->cvode, call_function, t, ode->newton.x) || CVodeSetUserData(ode->cvode, ode) ||
         CVodeSetLinearSolver(ode->cvode, ode->newton.solver, ode->newton.matrix) ||
         CVodeSetMaxNumSteps(ode->cvode, MAX_STEPS);
}

enum eo_code eo_ode_start(struct eo_ode *ode, const struct eo_ode_problem *problem, double t, const double *y,
                          struct eo_error *error)
{
  ode->problem = *problem;
  for (int i = 0; i < ode->n; i++)
    if (!(problem->absolute_tolerance[i] > 0) || !isfinite(y[i]))
      return eo_error_set(error, EO_ERROR_NUMERIC, "", "Tolerances must be positive and start values finite.");
  memcpy(N_VGetArrayPointer(ode->newton.x), y, sizeof *y * ode->n);
  memcpy(N_VGetArrayPointer(ode->tolerance), problem->absolute_tolerance, sizeof *y * ode->n);
  if (!(problem->relative_tolerance > 0) || begin(ode, t) ||
      CVodeSVtolerances(ode->cvode, problem->relative_tolerance, ode->tolerance) ||
      CVodeSetJacFn(ode->cvode, problem->jacobian ? call_jacobian : NULL) ||
      CVodeSetMaxStep(ode->cvode, problem->max_step))
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "CVODE refused the tolerances %g.", problem->relative_tolerance);
  return EO_OK;
}

enum eo_code eo_ode_advance(struct eo_ode *ode, double t, double *y, struct eo_error *error)
{
  double reached;
  int flag = CVode(ode->cvode, t, ode->newton.x, &reached, CV_NORMAL);
  if (flag < 0) {
    char *name = CVodeGetReturnFlagName(flag);
    eo_error_set(error, EO_ERROR_NUMERIC, "", "The time integration stopped at %g of %g: %s.", reached, t,
                 name ? name : "?");
    free(name);
    return EO_ERROR_NUMERIC;
  }
  memcpy(y, N_VGetArrayPointer(ode->newton.x), sizeof *y * ode->n);
  return EO_OK;
}

long eo_ode_steps(const struct eo_ode *ode)
{
  long steps = 0;
  if (ode->begun)
    CVodeGetNumSteps(ode->cvode, &steps);
  return steps;
}
