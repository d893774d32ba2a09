/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Low-rank factor of a positive semi-definite matrix. */
#ifndef EASEOFF_NUMERICS_LOWRANK_H
#define EASEOFF_NUMERICS_LOWRANK_H

#include "base/error.h"

/* matrix[n][n] (symmetric; destroyed) = factor factor' up to a remainder whose diagonal stays below tolerance times the
   largest diagonal entry (pivoted Cholesky, LAPACK dpstrf). *factor: [n][*stride], row-major, from eo_gram_allocate(),
   owned by the caller (free), rows padded with zeros to a stride that is a multiple of EO_GRAM_LANE. Errors: memory;
   EO_ERROR_NUMERIC when an entry is not finite or a diagonal entry is negative. */
enum eo_code eo_lowrank_factor(int n, double *matrix, double tolerance, int *rank, int *stride, double **factor,
                               struct eo_error *error);

/* Solves matrix[n][n] (symmetric positive definite, destroyed) X = rhs[n][columns] in place. Errors: EO_ERROR_NUMERIC.
 */
enum eo_code eo_lowrank_solve(int n, double *matrix, int columns, double *rhs, struct eo_error *error);

#endif
