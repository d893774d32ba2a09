/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sparse symmetric positive definite system and the part of its inverse that belongs to a few unknowns (CHOLMOD,
   supernodal L L'; Chen, Davis, Hager, Rajamanickam 2008). The few unknowns are ordered last: the last columns of L are
   then the Cholesky factor of their Schur complement, whose inverse is that part of the inverse of the whole matrix. */
#ifndef EASEOFF_NUMERICS_SPARSE_H
#define EASEOFF_NUMERICS_SPARSE_H

#include "base/error.h"

#include <stddef.h>

/* The lower triangle by columns. Owned by whoever filled it; eo_sparse_done() frees the arrays. */
struct eo_sparse {
  int n;
  int *start;    /* [n + 1] */
  int *row;      /* [start[n]], ascending within a column, row >= column */
  double *value; /* [start[n]] */
};

void eo_sparse_done(struct eo_sparse *matrix);

/* A factorisation in progress. One thread at a time; different factors may be used by different threads at once. */
struct eo_sparse_factor;

/* Orders the unknowns (METIS nested dissection of groups, for instance the nodes of a mesh; one call at a time in the
   whole process, because METIS keeps global state) and finds the pattern of L. group[n]: 0..groups-1, the group of each
   unknown; kept: unknowns wanted in the inverse, at most n; keep[kept]: which. The matrix is borrowed until
   eo_sparse_factorise() returns. Errors: memory; EO_ERROR_NUMERIC when the problem is too large for 32-bit indices. */
enum eo_code eo_sparse_analyse(const struct eo_sparse *matrix, const int *group, int groups, const int *keep, int kept,
                               struct eo_sparse_factor **factor, struct eo_error *error);

/* Factorises and keeps only the trailing block. Errors: memory; EO_ERROR_NUMERIC when the matrix is not positive
   definite. */
enum eo_code eo_sparse_factorise(struct eo_sparse_factor *factor, struct eo_error *error);

/* inverse[loaded][kept]: row j holds the values of keep[0..kept-1] under a unit load on keep[kept - loaded + j]. */
enum eo_code eo_sparse_inverse(const struct eo_sparse_factor *factor, int loaded, double *inverse,
                               struct eo_error *error);

/* Condenses the kept unknowns onto the last of them. keep[0..inner-1] are eliminated too, of which the last `loaded`
   may carry loads p; the others, outer = kept - inner, remain with a stiffness S and unit loads on them left out:
       u_inner = G p - F' u_outer,   S u_outer = -F p + loads on outer.
   compliance: G, [loaded][inner]; influence: F, [inner][outer]; stiffness: S, [outer][outer], symmetric. From the
   trailing block [L_ii 0; L_oi L_oo] of the factor: G = (L_ii L_ii')^-1, F = L_oi L_ii^-1, S = L_oo L_oo'. */
enum eo_code eo_sparse_condense(const struct eo_sparse_factor *factor, int inner, int loaded, double *compliance,
                                double *influence, double *stiffness, struct eo_error *error);

/* Entries of L and the bytes CHOLMOD held at most; known after eo_sparse_factorise(). */
double eo_sparse_entries(const struct eo_sparse_factor *factor);
size_t eo_sparse_peak_memory(const struct eo_sparse_factor *factor);

void eo_sparse_factor_free(struct eo_sparse_factor *factor);

/* Smallest and largest eigenvalue of a dense symmetric matrix[n][n] (LAPACK dsyevd); the matrix is destroyed. */
enum eo_code eo_symmetric_extremes(int n, double *matrix, double *smallest, double *largest, struct eo_error *error);

#endif
