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
  struct eo_ode *w = user;
  return w->problem.function(w->problem.context, t, N_VGetArrayPointer(y), N_VGetArrayPointer(slope));
}

static int call_jacobian(double t, N_Vector y, N_Vector slope, SUNMatrix matrix, void *user, N_Vector scratch1,
                         N_Vector scratch2, N_Vector scratch3)
{
  (void)slope, (void)scratch1, (void)scratch2, (void)scratch3;
  struct eo_ode *w = user;
  int code = w->problem.jacobian(w->problem.context, t, N_VGetArrayPointer(y), eo_dense_newton_clear(&w->newton));
  if (!code)
    eo_dense_newton_put(&w->newton, matrix);
  return code;
}

static int make_parts(struct eo_ode *w)
{
  if (eo_dense_newton_init(&w->newton, w->n))
    return -1;
  w->tolerance = N_VNew_Serial(w->n, w->newton.context);
  w->cvode = CVodeCreate(CV_ADAMS, w->newton.context);
  return !w->tolerance || !w->cvode || CVodeSetErrHandlerFn(w->cvode, eo_dense_newton_quiet, NULL) ? -1 : 0;
}

enum eo_code eo_ode_new(struct eo_ode **workspace, int n, struct eo_error *error)
{
  if (n < 1)
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "A differential equation needs at least one unknown, not %d.", n);
  struct eo_ode *w = calloc(1, sizeof *w);
  if (!w)
    return eo_error_memory(error);
  w->n = n;
  if (make_parts(w)) {
    eo_ode_free(w);
    return eo_error_memory(error);
  }
  *workspace = w;
  return EO_OK;
}

void eo_ode_free(struct eo_ode *w)
{
  if (!w)
    return;
  if (w->cvode)
    CVodeFree(&w->cvode);
  if (w->tolerance)
    N_VDestroy(w->tolerance);
  eo_dense_newton_done(&w->newton);
  free(w);
}

/* CVodeInit allocates and belongs to the first start; the linear solver can only be attached after it. */
static int begin(struct eo_ode *w, double t)
{
  if (w->begun)
    return CVodeReInit(w->cvode, t, w->newton.x);
  w->begun = 1;
  return CVodeInit(w->cvode, call_function, t, w->newton.x) || CVodeSetUserData(w->cvode, w) ||
         CVodeSetLinearSolver(w->cvode, w->newton.solver, w->newton.matrix) || CVodeSetMaxNumSteps(w->cvode, MAX_STEPS);
}

enum eo_code eo_ode_start(struct eo_ode *w, const struct eo_ode_problem *problem, double t, const double *y,
                          struct eo_error *error)
{
  w->problem = *problem;
  for (int i = 0; i < w->n; i++)
    if (!(problem->absolute_tolerance[i] > 0) || !isfinite(y[i]))
      return eo_error_set(error, EO_ERROR_NUMERIC, "", "Tolerances must be positive and start values finite.");
  memcpy(N_VGetArrayPointer(w->newton.x), y, sizeof *y * w->n);
  memcpy(N_VGetArrayPointer(w->tolerance), problem->absolute_tolerance, sizeof *y * w->n);
  if (!(problem->relative_tolerance > 0) || begin(w, t) ||
      CVodeSVtolerances(w->cvode, problem->relative_tolerance, w->tolerance) ||
      CVodeSetJacFn(w->cvode, problem->jacobian ? call_jacobian : NULL) || CVodeSetMaxStep(w->cvode, problem->max_step))
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "CVODE refused the tolerances %g.", problem->relative_tolerance);
  return EO_OK;
}

enum eo_code eo_ode_advance(struct eo_ode *w, double t, double *y, struct eo_error *error)
{
  double reached;
  int flag = CVode(w->cvode, t, w->newton.x, &reached, CV_NORMAL);
  if (flag < 0) {
    char *name = CVodeGetReturnFlagName(flag);
    eo_error_set(error, EO_ERROR_NUMERIC, "", "The time integration stopped at %g of %g: %s.", reached, t,
                 name ? name : "?");
    free(name);
    return EO_ERROR_NUMERIC;
  }
  memcpy(y, N_VGetArrayPointer(w->newton.x), sizeof *y * w->n);
  return EO_OK;
}

long eo_ode_steps(const struct eo_ode *w)
{
  long steps = 0;
  if (w->begun)
    CVodeGetNumSteps(w->cvode, &steps);
  return steps;
}
