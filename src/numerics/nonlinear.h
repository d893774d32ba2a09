/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Small dense systems of nonlinear equations r(x) = 0: Newton with line search (KINSOL). The only user of KINSOL.
   Newton's matrix is formed afresh in every iteration (Dennis and Schnabel 1983, chapter 6). */
#ifndef EASEOFF_NUMERICS_NONLINEAR_H
#define EASEOFF_NUMERICS_NONLINEAR_H

#include "base/error.h"

/* Fills residual[n] at x[n]. Returns 0; > 0 when x is outside the domain (the step is then given up); < 0 to stop at
   once. */
typedef int eo_nonlinear_residual(void *context, const double *x, double *residual);

/* Fills jacobian[n][n], row-major, jacobian[i][j] = d residual[i] / d x[j] (zero on entry). Returns as above. */
typedef int eo_nonlinear_jacobian(void *context, const double *x, double *jacobian);

struct eo_nonlinear_problem {
  eo_nonlinear_residual *residual;
  eo_nonlinear_jacobian *jacobian; /* NULL: one-sided differences */
  void *context;                   /* borrowed */
};

struct eo_nonlinear_options {
  const double *x_scale;        /* [n] typical size of each unknown, > 0; NULL: 1 */
  const double *residual_scale; /* [n] typical size of each equation, > 0; NULL: 1 */
  double residual_tolerance;    /* converged when max |residual / residual_scale| is not above it, > 0 */
  double step_tolerance;        /* given up when max |step / x_scale| falls below it, > 0 */
  double max_step;              /* Euclidean length of a scaled step; 0: KINSOL's own choice */
  int max_iterations;           /* > 0 */
};

enum eo_nonlinear_outcome {
  EO_NONLINEAR_CONVERGED,
  EO_NONLINEAR_STALLED, /* no further progress, or too many iterations: x is the best point reached */
  EO_NONLINEAR_FAILED,  /* the functions gave up or Newton's matrix is singular: x is where it happened */
};

struct eo_nonlinear_report {
  enum eo_nonlinear_outcome outcome;
  int iterations;
  int evaluations; /* of the residual, difference Jacobians included */
  double residual; /* max |residual / residual_scale| at the x returned; infinite if it cannot be computed there */
};

struct eo_nonlinear; /* workspace for one n; one thread at a time */

/* *workspace is owned by the caller. Errors: EO_ERROR_MEMORY; EO_ERROR_NUMERIC when n < 1. */
enum eo_code eo_nonlinear_new(struct eo_nonlinear **workspace, int n, struct eo_error *error);
void eo_nonlinear_free(struct eo_nonlinear *workspace); /* NULL is fine */

/* Solves from the guess in x[n], which it replaces. A guess that already solves the system comes back unchanged.
   Not converging is an outcome in *report; an error (EO_ERROR_NUMERIC) means that the options make no sense. */
enum eo_code eo_nonlinear_solve(struct eo_nonlinear *workspace, const struct eo_nonlinear_problem *problem,
                                const struct eo_nonlinear_options *options, double *x,
                                struct eo_nonlinear_report *report, struct eo_error *error);

#endif
