/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ordinary differential equations y' = f(t, y) of small size, not stiff but lightly damped: variable-order Adams with a
   dense Newton corrector (CVODE). The only user of CVODE. */
#ifndef EASEOFF_NUMERICS_ODE_H
#define EASEOFF_NUMERICS_ODE_H

#include "base/error.h"

/* Fills slope[n] = f(t, y). Returns 0; > 0 when y is outside the domain (a shorter step is tried); < 0 to stop. */
typedef int eo_ode_function(void *context, double t, const double *y, double *slope);

/* Fills jacobian[n][n], row-major, jacobian[i][j] = d f_i / d y_j (zero on entry). Returns as above. */
typedef int eo_ode_jacobian(void *context, double t, const double *y, double *jacobian);

struct eo_ode_problem {
  eo_ode_function *function;
  eo_ode_jacobian *jacobian;        /* NULL: one-sided differences */
  void *context;                    /* borrowed until the last advance */
  double relative_tolerance;        /* > 0 */
  const double *absolute_tolerance; /* [n], > 0 */
  double max_step;                  /* 0: no limit. A limit keeps short forces from being stepped over. */
};

struct eo_ode; /* workspace for one n; one thread at a time */

/* *workspace is owned by the caller. Errors: EO_ERROR_MEMORY; EO_ERROR_NUMERIC when n < 1. */
enum eo_code eo_ode_new(struct eo_ode **workspace, int n, struct eo_error *error);
void eo_ode_free(struct eo_ode *workspace); /* NULL is fine */

/* Starts afresh from y[n] at t. Errors: EO_ERROR_NUMERIC when the tolerances make no sense. */
enum eo_code eo_ode_start(struct eo_ode *workspace, const struct eo_ode_problem *problem, double t, const double *y,
                          struct eo_error *error);

/* Goes on to t (beyond where it stands) and copies the solution there to y[n]. Errors: EO_ERROR_NUMERIC with CVODE's
   reason. */
enum eo_code eo_ode_advance(struct eo_ode *workspace, double t, double *y, struct eo_error *error);

/* Steps taken since the start. */
long eo_ode_steps(const struct eo_ode *workspace);

#endif
