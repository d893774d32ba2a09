/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Life factors Z_NT, Y_NT (ISO 6336-2, -3: 2006 and 2019 agree) and cumulative damage (ISO 6336-6). Lines through
   points in double logarithms. Checked by reports: steel Z_NT without pitting, Y_NT of St, V and Eh beyond the knee,
   the standard's own damage example. Unchecked: pitting allowed, nitrided, nitrocarburised. */
#ifndef EASEOFF_RATING_LIFE_H
#define EASEOFF_RATING_LIFE_H

#include <stdbool.h>

#include "rating/material_class.h"

enum { EO_LIFE_POINTS = 4 };

/* Below the first point the factor stays, beyond the last one too. */
struct eo_life_line {
  int count;
  double cycles[EO_LIFE_POINTS], factor[EO_LIFE_POINTS];
};

/* long_life: factor at 1e10 cycles, 0.85 .. 1 (1: optimum conditions). */
struct eo_life_line eo_life_flank(enum eo_rating_material material, bool some_pitting, double long_life);
struct eo_life_line eo_life_root(enum eo_rating_material material, double long_life);

/* Z_NT or Y_NT at a number of cycles, straight between the points of the line in logarithms; the end values beyond
 * them. */
double eo_life_factor(const struct eo_life_line *line, double cycles);

/* Cycles to failure at stress over the endurance limit. Both ends go on with the slope beside them: above the static
   value as the standard's example of a damage sum has it (check the static strength apart), below the last point so
   that small stresses still count; INFINITY where the last piece is level. */
double eo_life_cycles(const struct eo_life_line *line, double stress_ratio);

/* Share 0 .. 1 of the endurance value of an influence factor (Z_L, Z_v, Z_R, Z_W) at a life: 0 at the static end, 1
   from the knee on; the factor is Z^share (ISO 6336-2, interpolation on the logarithms). */
double eo_life_share(const struct eo_life_line *line, double cycles);

/* Miner's sum n_i/N_i of stresses over the endurance limit. */
double eo_life_damage(const struct eo_life_line *line, int count, const double *stress_ratio, const double *cycles);

/* Flank stress of a class from that of another: goes with the root of torque times K_Hbeta (and K_V K_Halpha). */
double eo_life_class_stress(double stress, double torque, double factor, double other_torque, double other_factor);

#endif
