/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A quadratic response fitted to a sample, with its measured error: what it carries and what not. */
#ifndef EASEOFF_TOLERANCE_RESPONSE_SURFACE_H
#define EASEOFF_TOLERANCE_RESPONSE_SURFACE_H

#include "base/error.h"
#include "tolerance/distribution.h"

/* y = c + sum b_i z_i + sum over leading inputs i <= j of q_ij z_i z_j, z = (x - mean)/deviation of the distributions.
 */
struct eo_surface {
  int inputs, leading;        /* leading: inputs with squares and products, as many as the rows carry */
  int *lead;                  /* [leading], input */
  struct eo_moments *moments; /* [inputs] */
  double constant, *slope;    /* [inputs] */
  double *square;             /* [leading][leading], upper triangle */
  double q2;                  /* 1 - (squares of the residuals that leave their row out) / (those about the mean) */
  double residual;            /* root mean square of those residuals, in the output's unit */
};

/* From n rows input[n][inputs], output[n]. Twice as many rows as terms are kept, so the number of leading inputs
   follows from n; they are those with the largest linear effects. Errors: EO_ERROR_NUMERIC (too few rows, inputs that
   depend on each other), memory. eo_surface_done() also after an error. */
enum eo_code eo_surface_fit(struct eo_surface *surface, int n, int inputs, const struct eo_moments *moments,
                            const double *input, const double *output, struct eo_error *error);
void eo_surface_done(struct eo_surface *surface);

/* Bytes that the fit takes; 0: the rows are too few for one. */
double eo_surface_memory(int n, int inputs);

/* Sobol indices of the surface for independent inputs with these moments, exact: first[inputs], total[inputs]. */
void eo_surface_indices(const struct eo_surface *surface, double *first, double *total);

#endif
