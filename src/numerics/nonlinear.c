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
  struct eo_nonlinear *nonlinear = user;
  nonlinear->evaluations++;
  int code = nonlinear->problem->residual(nonlinear->problem->context, N_VGetArrayPointer(x),
                                          N_VGetArrayPointer(residual));
  if (code)
    return code;
  const double *r = N_VGetArrayPointer(residual);
  for (int i = 0; i < nonlinear->n; i++)
    if (!isfinite(r[i]))
      return 1;
  return 0;
}

static int call_jacobian(N_Vector x, N_Vector residual, SUNMatrix matrix, void *user, N_Vector scratch1,
                         N_Vector scratch2)
{
  (void)residual, (void)scratch1, (void)scratch2;
  struct eo_nonlinear *nonlinear = user;
  int code = nonlinear->problem->jacobian(nonlinear->problem->context, N_VGetArrayPointer(x),
                                          eo_dense_newton_clear(&nonlinear->newton));
  if (!code)
    eo_dense_newton_put(&nonlinear->newton, matrix);
  return code;
}

static int make_parts(struct eo_nonlinear *nonlinear)
{
  struct eo_dense_newton *newton = &nonlinear->newton;
  if (eo_dense_newton_init(newton, nonlinear->n))
    return -1;
  nonlinear->x_scale = N_VNew_Serial(nonlinear->n, newton->context);
  nonlinear->residual_scale = N_VNew_Serial(nonlinear->n, newton->context);
  nonlinear->residual = N_VNew_Serial(nonlinear->n, newton->context);
  nonlinear->kinsol = KINCreate(newton->context);
  if (!nonlinear->x_scale || !nonlinear->residual_scale || !nonlinear->residual || !nonlinear->kinsol)
    return -1;
  return KINSetErrHandlerFn(nonlinear->kinsol, eo_dense_newton_quiet, NULL) ||
                 KINInit(nonlinear->kinsol, call_residual, newton->x) || KINSetUserData(nonlinear->kinsol, nonlinear) ||
                 KINSetLinearSolver(nonlinear->kinsol, newton->solver, newton->matrix) ||
                 KINSetMaxSetupCalls(nonlinear->kinsol, 1)
             ? -1
             : 0;
}

enum eo_code eo_nonlinear_new(struct eo_nonlinear **workspace, int n, struct eo_error *error)
{
  if (n < 1)
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "A nonlinear system needs at least one unknown, not %d.", n);
  struct eo_nonlinear *nonlinear = calloc(1, sizeof *nonlinear);
  if (!nonlinear)
    return eo_error_memory(error);
  nonlinear->n = n;
  if (make_parts(nonlinear)) {
    eo_nonlinear_free(nonlinear);
    return eo_error_memory(error);
  }
  *workspace = nonlinear;
  return EO_OK;
}

void eo_nonlinear_free(struct eo_nonlinear *nonlinear)
{
  if (!nonlinear)
    return;
  if (nonlinear->kinsol)
    KINFree(&nonlinear->kinsol);
  N_Vector vector[] = {nonlinear->x_scale, nonlinear->residual_scale, nonlinear->residual};
  for (size_t i = 0; i < sizeof vector / sizeof vector[0]; i++)
    if (vector[i])
      N_VDestroy(vector[i]);
  eo_dense_newton_done(&nonlinear->newton);
  free(nonlinear);
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

static enum eo_code apply_options(struct eo_nonlinear *nonlinear, const struct eo_nonlinear_options *options,
                                  struct eo_error *error)
{
  if (!(options->residual_tolerance > 0) || !(options->step_tolerance > 0) || options->max_iterations < 1 ||
      !(options->max_step >= 0))
    return eo_error_set(error, EO_ERROR_NUMERIC, "",
                        "The tolerances and the iteration limit of a nonlinear solve must be positive.");
  if (set_scale(nonlinear->x_scale, options->x_scale, nonlinear->n) ||
      set_scale(nonlinear->residual_scale, options->residual_scale, nonlinear->n))
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "The scales of a nonlinear solve must be positive and finite.");
  if (KINSetJacFn(nonlinear->kinsol, nonlinear->problem->jacobian ? call_jacobian : NULL) ||
      KINSetFuncNormTol(nonlinear->kinsol, options->residual_tolerance) ||
      KINSetScaledStepTol(nonlinear->kinsol, options->step_tolerance) ||
      KINSetNumMaxIters(nonlinear->kinsol, options->max_iterations) ||
      KINSetMaxNewtonStep(nonlinear->kinsol, options->max_step))
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "KINSOL refused the options of a nonlinear solve.");
  return EO_OK;
}

static double scaled_residual(struct eo_nonlinear *nonlinear)
{
  if (call_residual(nonlinear->newton.x, nonlinear->residual, nonlinear))
    return INFINITY;
  const double *r = N_VGetArrayPointer(nonlinear->residual), *scale = N_VGetArrayPointer(nonlinear->residual_scale);
  double largest = 0;
  for (int i = 0; i < nonlinear->n; i++)
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

enum eo_code eo_nonlinear_solve(struct eo_nonlinear *nonlinear, const struct eo_nonlinear_problem *problem,
                                const struct eo_nonlinear_options *options, double *x,
                                struct eo_nonlinear_report *report, struct eo_error *error)
{
  nonlinear->problem = problem;
  nonlinear->evaluations = 0;
  enum eo_code code = apply_options(nonlinear, options, error);
  if (code)
    return code;
  memcpy(N_VGetArrayPointer(nonlinear->newton.x), x, sizeof *x * nonlinear->n);
  *report = (struct eo_nonlinear_report){0};
  report->residual = scaled_residual(nonlinear);
  int flag = KIN_INITIAL_GUESS_OK;
  if (!(report->residual <= options->residual_tolerance)) {
    long iterations = 0;
    flag = KINSol(nonlinear->kinsol, nonlinear->newton.x, KIN_LINESEARCH, nonlinear->x_scale,
                  nonlinear->residual_scale);
    KINGetNumNonlinSolvIters(nonlinear->kinsol, &iterations);
    report->iterations = (int)iterations;
    report->residual = scaled_residual(nonlinear);
  }
  report->outcome = outcome_of(flag, report->residual, options->residual_tolerance);
  report->evaluations = nonlinear->evaluations;
  memcpy(x, N_VGetArrayPointer(nonlinear->newton.x), sizeof *x * nonlinear->n);
  return EO_OK;
}
