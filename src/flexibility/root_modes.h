/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Root stress of many load distributions at once: the stress influence of flank loads in the form coefficient x shape
   with a few dozen shapes, so that a history over the mesh cycle costs a small matrix product. The shapes are the
   stresses of some flank points, picked by pivoted Cholesky, and every other point is a combination of them. Loads on
   other teeth reach the root far and smoothly: they are told by fewer numbers still, which each distance turns into
   coefficients. In single precision: its 1e-7 are far below the 1e-3 of the shapes, and it takes half the time. */
#ifndef EASEOFF_FLEXIBILITY_ROOT_MODES_H
#define EASEOFF_FLEXIBILITY_ROOT_MODES_H

#include "flexibility/flexibility.h"

/* Whose loads the coefficients are of: shapes of what the others carry alone are a quarter as many. */
enum eo_root_carriers { EO_ROOT_ALL, EO_ROOT_OTHERS, EO_ROOT_CARRIERS };

struct eo_root_modes; /* constant once made; borrows the flexibility */

/* Shapes in the order in which they were picked. Error of the stress under distributed flank loads below about 1e-3 of
 * the largest. Errors: memory, EO_ERROR_NUMERIC.
 */
enum eo_code eo_root_modes_new(struct eo_root_modes **modes, const struct eo_flexibility *flexibility, int member,
                               struct eo_error *error);
void eo_root_modes_free(struct eo_root_modes *modes);

/* Turns the shapes of EO_ROOT_ALL, so that the first ones carry most of such loads: moment[stride][stride] = sum of c
   c' over their coefficients c, its upper triangle. Stresses stay what they are. Errors: memory, EO_ERROR_NUMERIC. */
enum eo_code eo_root_modes_turn(struct eo_root_modes *modes, const double *moment, struct eo_error *error);

int eo_root_modes_reach(const struct eo_root_modes *modes); /* teeth on either side whose loads count */
/* Floats of the coefficients of a distribution; 0 of others that do not count. */
int eo_root_modes_stride(const struct eo_root_modes *modes, enum eo_root_carriers carriers);
int eo_root_modes_remote_stride(
    const struct eo_root_modes *modes);                    /* floats of what other teeth carry; 0: none counts */
int eo_root_modes_room(const struct eo_root_modes *modes); /* floats that a search takes for each distribution */

/* What 1 N at a flank point is to the root of its own tooth, own[stride], and to those of others, remote[remote
   stride]. The same for every tooth, load and time. */
void eo_root_modes_own(const struct eo_root_modes *modes, const struct eo_flank_point *point, float *own);
void eo_root_modes_remote(const struct eo_root_modes *modes, const struct eo_flank_point *point, float *remote);

/* All arrays of the following are aligned to EO_GRAM_ALIGN but for the forces, and a row of a result comes from its own
   rows alone, to the last bit, whatever else is asked for. */

/* sum[stride] of each of the loads += what its forces, N, are at n points whose own (or remote) rows follow each other
   in row[n][stride]: force[loads][n], force_stride apart, sum[loads], sum_stride apart. stride: that of own
   (EO_ROOT_ALL) or of remote rows. */
void eo_root_modes_add(const struct eo_root_modes *modes, int loads, int n, const float *force, int force_stride,
                       const float *row, int stride, float *sum, int sum_stride);

/* coefficient[count][stride] += that of remote[count][remote stride], the loads of the tooth `ahead_by` pairs ahead,
   not 0, within reach. */
void eo_root_modes_pass(const struct eo_root_modes *modes, enum eo_root_carriers carriers, int ahead_by, int count,
                        const float *remote, float *coefficient);

/* The largest principal stress largest[count], Pa, 0 where nothing is in tension, and its node[count] of the root,
   [point][layer] from root.first on, of coefficient[count][stride]. room[count][room]: scratch. */
void eo_root_modes_find_largest(const struct eo_root_modes *modes, enum eo_root_carriers carriers, int count,
                                const float *coefficient, float *room, double *largest, int *node);

#endif
