/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Nonlinear least squares in the unit cube: Levenberg and Marquardt with difference quotients, for expensive residuals.
 */
#ifndef EASEOFF_NUMERICS_LEAST_SQUARES_H
#define EASEOFF_NUMERICS_LEAST_SQUARES_H

#include "base/error.h"

enum { EO_LEAST_SQUARES_MOST = 16 }; /* unknowns */

/* Fills residual[m] at x[n], each 0..1. Errors end the work and are handed up. */
typedef enum eo_code eo_residual_function(void *context, const double *x, double *residual, struct eo_error *error);

struct eo_least_squares_options {
  int iterations;   /* at most */
  double step;      /* of the difference quotients, for instance 1e-3 */
  double tolerance; /* ends when no unknown moves by more */
};

struct eo_least_squares_report {
  double square; /* sum of the squared residuals at x */
  int iterations, evaluations;
  int converged; /* 0: stopped by the number of iterations */
};

/* Improves x[n] and fills jacobian[m][n] there (one-sided quotients, backwards at the upper bound; may be NULL).
   Directions in which an unknown stands at a bound and would leave the cube are held. Allocates. Errors: EO_ERROR_INPUT
   (n), EO_ERROR_MEMORY, of the function. */
enum eo_code eo_least_squares(eo_residual_function *function, void *context, int n, int m,
                              const struct eo_least_squares_options *options, double *x, double *jacobian,
                              struct eo_least_squares_report *report, struct eo_error *error);

#endif
