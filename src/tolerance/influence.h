/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which inputs decide: standardised regression, and Sobol indices of a function that can be asked often. */
#ifndef EASEOFF_TOLERANCE_INFLUENCE_H
#define EASEOFF_TOLERANCE_INFLUENCE_H

#include <stdint.h>

#include "base/error.h"

/* Least squares with intercept of output[n] on input[n][k], all over their standard deviations. coefficient[k]: NaN for
   an input that does not vary; of inputs that depend on each other the smallest ones. Errors: EO_ERROR_NUMERIC (fewer
   rows than inputs + 2), memory. */
struct eo_regression {
  double r2, r2_adjusted; /* share of the variance that is explained; NaN when the output is constant */
  double *coefficient;    /* [k], caller's */
};
enum eo_code eo_regression_run(struct eo_regression *regression, int n, int k, const double *input,
                               const double *output, struct eo_error *error);

/* Interval of level 0 .. 1 of each coefficient from resamples of whole rows; interval[k][2]. */
enum eo_code eo_regression_bootstrap(int n, int k, const double *input, const double *output, double level,
                                     int resamples, uint64_t seed, double (*interval)[2], struct eo_error *error);

/* Order of numbers by size, largest first, NaN last; equal ones in their order. rank[k] of indices. */
void eo_order_by_size(int k, const double *value, int *rank);

/* Sobol indices of a function of independent inputs by Saltelli's and Jansen's sums (Saltelli et al. 2010): points
   (inputs + 2) calls. u: each in (0, 1). first[k], total[k]. Scrambled Sobol points; errors: of the sampler, memory. */
typedef double eo_unit_function(void *context, const double *u);
enum eo_code eo_sobol_indices(eo_unit_function *function, void *context, int inputs, int points, uint64_t seed,
                              double *first, double *total, struct eo_error *error);

#endif
