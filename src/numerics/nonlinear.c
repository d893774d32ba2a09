/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "numerics/nonlinear.h"

#include "numerics/dense_newton.h"

#include <kinsol/kinsol.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct eo_nonlinear {
  int n;
  struct eo_dense_newton newton;
  void *kinsol;
  N_Vector x_scale, residual_scale, residual;
  const struct eo_nonlinear_problem *problem; /* during a solve */
  int evaluations;
};

static int call_residual(N_Vector x, N_Vector residual, void *user)
{
  struct eo_nonlinear *w = user;
  w->evaluations++;
  int code = w->problem->residual(w->problem->context, N_VGetArrayPointer(x), N_VGetArrayPointer(residual));
  if (code)
    return code;
  const double *r = N_VGetArrayPointer(residual);
  for (int i = 0; i < w->n; i++)
    if (!isfinite(r[i]))
      return 1;
  return 0;
}

static int call_jacobian(N_Vector x, N_Vector residual, SUNMatrix matrix, void *user, N_Vector scratch1,
                         N_Vector scratch2)
{
  (void)residual, (void)scratch1, (void)scratch2;
  struct eo_nonlinear *w = user;
  int code = w->problem->jacobian(w->problem->context, N_VGetArrayPointer(x), eo_dense_newton_clear(&w->newton));
  if (!code)
    eo_dense_newton_put(&w->newton, matrix);
  return code;
}

static int make_parts(struct eo_nonlinear *w)
{
  struct eo_dense_newton *newton = &w->newton;
  if (eo_dense_newton_init(newton, w->n))
    return -1;
  w->x_scale = N_VNew_Serial(w->n, newton->context);
  w->residual_scale = N_VNew_Serial(w->n, newton->context);
  w->residual = N_VNew_Serial(w->n, newton->context);
  w->kinsol = KINCreate(newton->context);
  if (!w->x_scale || !w->residual_scale || !w->residual || !w->kinsol)
    return -1;
  return KINSetErrHandlerFn(w->kinsol, eo_dense_newton_quiet, NULL) || KINInit(w->kinsol, call_residual, newton->x) ||
                 KINSetUserData(w->kinsol, w) || KINSetLinearSolver(w->kinsol, newton->solver, newton->matrix) ||
                 KINSetMaxSetupCalls(w->kinsol, 1)
             ? -1
             : 0;
}

enum eo_code eo_nonlinear_new(struct eo_nonlinear **workspace, int n, struct eo_error *error)
{
  if (n < 1)
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "A nonlinear system needs at least one unknown, not %d.", n);
  struct eo_nonlinear *w = calloc(1, sizeof *w);
  if (!w)
    return eo_error_memory(error);
  w->n = n;
  if (make_parts(w)) {
    eo_nonlinear_free(w);
    return eo_error_memory(error);
  }
  *workspace = w;
  return EO_OK;
}

void eo_nonlinear_free(struct eo_nonlinear *w)
{
  if (!w)
    return;
  if (w->kinsol)
    KINFree(&w->kinsol);
  N_Vector vector[] = {w->x_scale, w->residual_scale, w->residual};
  for (size_t i = 0; i < sizeof vector / sizeof vector[0]; i++)
    if (vector[i])
      N_VDestroy(vector[i]);
  eo_dense_newton_done(&w->newton);
  free(w);
}

static int set_scale(N_Vector vector, const double *typical, int n)
{
  double *scale = N_VGetArrayPointer(vector);
  for (int i = 0; i < n; i++) {
    if (typical && !(typical[i] > 0 && isfinite(typical[i])))
      return -1;
    scale[i] = typical ? 1 / typical[i] : 1;
  }
  return 0;
}

static enum eo_code apply_options(struct eo_nonlinear *w, const struct eo_nonlinear_options *o, struct eo_error *error)
{
  if (!(o->residual_tolerance > 0) || !(o->step_tolerance > 0) || o->max_iterations < 1 || !(o->max_step >= 0))
    return eo_error_set(error, EO_ERROR_NUMERIC, "",
                        "The tolerances and the iteration limit of a nonlinear solve must be positive.");
  if (set_scale(w->x_scale, o->x_scale, w->n) || set_scale(w->residual_scale, o->residual_scale, w->n))
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "The scales of a nonlinear solve must be positive and finite.");
  if (KINSetJacFn(w->kinsol, w->problem->jacobian ? call_jacobian : NULL) ||
      KINSetFuncNormTol(w->kinsol, o->residual_tolerance) || KINSetScaledStepTol(w->kinsol, o->step_tolerance) ||
      KINSetNumMaxIters(w->kinsol, o->max_iterations) || KINSetMaxNewtonStep(w->kinsol, o->max_step))
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "KINSOL refused the options of a nonlinear solve.");
  return EO_OK;
}

static double scaled_residual(struct eo_nonlinear *w)
{
  if (call_residual(w->newton.x, w->residual, w))
    return INFINITY;
  const double *r = N_VGetArrayPointer(w->residual), *scale = N_VGetArrayPointer(w->residual_scale);
  double largest = 0;
  for (int i = 0; i < w->n; i++)
    largest = fmax(largest, fabs(r[i] * scale[i]));
  return largest;
}

/* A line search that stops for want of progress may still have reached the tolerance: the residual decides. */
static enum eo_nonlinear_outcome outcome_of(int flag, double residual, double tolerance)
{
  if (residual <= tolerance)
    return EO_NONLINEAR_CONVERGED;
  switch (flag) {
  case KIN_STEP_LT_STPTOL:
  case KIN_LINESEARCH_NONCONV:
  case KIN_LINESEARCH_BCFAIL:
  case KIN_MAXITER_REACHED:
  case KIN_MXNEWT_5X_EXCEEDED:
    return EO_NONLINEAR_STALLED;
  default:
    return EO_NONLINEAR_FAILED;
  }
}

enum eo_code eo_nonlinear_solve(struct eo_nonlinear *w, const struct eo_nonlinear_problem *problem,
                                const struct eo_nonlinear_options *options, double *x,
                                struct eo_nonlinear_report *report, struct eo_error *error)
{
  w->problem = problem;
  w->evaluations = 0;
  enum eo_code code = apply_options(w, options, error);
  if (code)
    return code;
  memcpy(N_VGetArrayPointer(w->newton.x), x, sizeof *x * w->n);
  *report = (struct eo_nonlinear_report){0};
  report->residual = scaled_residual(w);
  int flag = KIN_INITIAL_GUESS_OK;
  if (!(report->residual <= options->residual_tolerance)) {
    long iterations = 0;
    flag = KINSol(w->kinsol, w->newton.x, KIN_LINESEARCH, w->x_scale, w->residual_scale);
    KINGetNumNonlinSolvIters(w->kinsol, &iterations);
    report->iterations = (int)iterations;
    report->residual = scaled_residual(w);
  }
  report->outcome = outcome_of(flag, report->residual, options->residual_tolerance);
  report->evaluations = w->evaluations;
  memcpy(x, N_VGetArrayPointer(w->newton.x), sizeof *x * w->n);
  return EO_OK;
}
