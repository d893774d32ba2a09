/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stress in the free surface of the loaded root, from the strains of that surface: no stress acts across it, so plane
   stress holds in it. First and second order of the surface by central differences of the nodes; exact for any linear
   displacement. */
#ifndef EASEOFF_FLEXIBILITY_STRESS_H
#define EASEOFF_FLEXIBILITY_STRESS_H

#include "flexibility/sector.h"

/* Stresses of a node: along the profile, across it in the surface, shear. */
enum { EO_STRESSES = 3 };

struct eo_stress_stencil {
  int count;
  int step[5][2]; /* of the root index and of the layer */
  double matrix[5][EO_STRESSES][3];
};

/* For root nodes 1 .. root_nodes - 2 and the first, an inner and the last layer; Pa/m. */
struct eo_stress_operator {
  int points; /* root_nodes - 2 */
  int layers;
  struct eo_stress_stencil (*stencil)[3]; /* [points] */
};

/* From the root nodes of a meshed sector. Errors: memory. */
enum eo_code eo_stress_operator_init(struct eo_stress_operator *operator, const struct eo_sector * sector,
                                     const struct eo_material *material, struct eo_error *error);
void eo_stress_operator_done(struct eo_stress_operator *operator);

/* displacement[root_nodes][layers + 1][3]: components in the frame of each layer, m; stress[points][layers +
   1][EO_STRESSES], Pa. */
void eo_stress_operator_apply(const struct eo_stress_operator *operator, const double * displacement, double *stress);

#endif
