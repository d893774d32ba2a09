/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Root stress of many load distributions at once: the stress influence of flank loads in the form coefficient x shape
   with a few dozen shapes, so that a history over the mesh cycle costs a small matrix product. The shapes are the
   stresses of some flank points, picked by pivoted Cholesky, and every other point is a combination of them. In single
   precision: its 1e-7 are far below the 1e-3 of the shapes, and it takes half the time. */
#ifndef EASEOFF_FLEXIBILITY_ROOT_MODES_H
#define EASEOFF_FLEXIBILITY_ROOT_MODES_H

#include "flexibility/flexibility.h"
#include "flexibility/spline.h"

#include <stdint.h>

struct eo_root_modes; /* constant once made; borrows the flexibility */

/* Error of the stress under distributed flank loads below about 1e-3 of the largest. Errors: memory, EO_ERROR_NUMERIC.
 */
enum eo_code eo_root_modes_new(struct eo_root_modes **modes, const struct eo_flexibility *flexibility, int member,
                               struct eo_error *error);
void eo_root_modes_free(struct eo_root_modes *modes);

int eo_root_modes_rank_stride(const struct eo_root_modes *modes);   /* floats between two rows of the scratch */
int eo_root_modes_stress_stride(const struct eo_root_modes *modes); /* floats between the stresses of two loads */
int eo_root_modes_slots(const struct eo_root_modes *modes);         /* numbers that describe a load distribution */
int eo_root_modes_nodes(const struct eo_root_modes *modes);         /* of the root: [point][layer] from root.first on */

/* How a load at a flank point is told to the splines of its own tooth [0] and of any other [1]. The same for every
   tooth, load and time. */
struct eo_root_weights {
  int first[2];
  double across[2][EO_SPLINE_WIDTH], along[2][EO_SPLINE_WIDTH];
};
void eo_root_modes_weigh(const struct eo_root_modes *modes, const struct eo_flank_point *point,
                         struct eo_root_weights *weights);

/* Adds the loads force[sets][n], N, at the points, weights[n] of them, to load[sets][slots] of the root of tooth pair
   `pair`. Returns which parts of load they touch. */
uint64_t eo_root_modes_add(const struct eo_root_modes *modes, int pair, int n, const struct eo_flank_point *point,
                           const struct eo_root_weights *weights, int sets, const double *force, float *load);

/* stress[count][sets][stress stride], Pa: [EO_STRESSES][nodes] and zeros, under load[count][sets][slots], of which
   touched[count] says which parts are not zero (see above); where none is, nothing is written. scratch:
   [count][sets][rank stride]; both aligned to EO_GRAM_ALIGN. The stresses under one load are the same to the last bit
   whatever else is asked for. */
void eo_root_modes_stress(const struct eo_root_modes *modes, int count, int sets, const float *load,
                          const uint64_t *touched, float *scratch, float *stress);

#endif
