/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper's pair as the reference files describe it (dynamics.json: defaults, law_K1), shared by the tests of the
   dynamics. */
#ifndef EASEOFF_TESTS_SUPPORT_DYNAMICS_FIXTURE_H
#define EASEOFF_TESTS_SUPPORT_DYNAMICS_FIXTURE_H

#include <math.h>
#include <stddef.h>

#include "dynamics/vibration.h"

static inline struct eo_dynamics_parameters paper_pair(void)
{
  return (struct eo_dynamics_parameters){.ends = 2,
                                         .base_radius = {0.051861854090581395, 0.13423068117562242},
                                         .base_helix_angle = 0.39218390684663407,
                                         .mass = {5.608208422335395, 35.72543996722387},
                                         .inertia = {0.008133856745044276, 0.39700498678794305},
                                         .bearing_stiffness = {8e8, 1e9},
                                         .bearing_damping = {6698.183886598155, 18901.174558006674},
                                         .gear_axial_stiffness = {2e8, 2e8},
                                         .gear_axial_damping = {8452.862233258491, 8452.862233258491},
                                         .groove_axial_stiffness = {28990449567.4799, 213161907614.72693},
                                         .groove_axial_damping = {11404.717740711703, 78052.81767515557},
                                         .mesh_damping = 8193.867393295166};
}

static inline void scale_damping(struct eo_dynamics_parameters *p, double factor)
{
  for (int i = 0; i < 2; i++) {
    p->bearing_damping[i] *= factor;
    p->gear_axial_damping[i] *= factor;
    p->groove_axial_damping[i] *= factor;
  }
  p->mesh_damping *= factor;
}

/* law_K1 with its variation multiplied, half backlash 50 um. Returns the law's error code. */
static inline enum eo_code stiffness_law(struct eo_law *law, double variation)
{
  static const double a[8] = {49500000.0,    8205251.58117,  -3609649.64789, 2723607.5292,
                              299142.171504, -806193.985749, 735609.096627,  -414577.829894},
                      b[8] = {0.0,           10339915.2071,  6171946.97154, -1863320.1622,
                              1734391.52478, -902303.306734, 227550.559129, 147394.786069};
  double series[17] = {1.1e9};
  for (int k = 0; k < 8; k++) {
    series[2 * k + 1] = variation * a[k];
    series[2 * k + 2] = variation * b[k];
  }
  return eo_law_set_stiffness(law, 8, series, 5e-5, -5e-5, NULL);
}

/* 828 N m, 2000 rpm, 17 teeth. */
static inline struct eo_vibration_case paper_case(const struct eo_law *left, const struct eo_law *right)
{
  return (struct eo_vibration_case){
      .torque = 828, .speed = 2000 * M_PI / 30, .pinion_teeth = 17, .law = {left, right}, .gated = true};
}

#endif
