/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The gear pair of the paper's Table 1, for tests of the floors below the design document. */
#ifndef EASEOFF_TESTS_SUPPORT_PAPER_PAIR_H
#define EASEOFF_TESTS_SUPPORT_PAPER_PAIR_H

#include "flexibility/flexibility.h"

#include <math.h>

__attribute__((unused)) static struct eo_gear_pair paper_pair(void)
{
  return (struct eo_gear_pair){.ends = 2,
                               .teeth = {17, 44},
                               .normal_module = 6e-3,
                               .normal_pressure_angle = 20 * M_PI / 180,
                               .helix_angle = 24 * M_PI / 180,
                               .face_width = 55e-3,
                               .groove_width = 50e-3,
                               .addendum_coefficient = 1,
                               .dedendum_coefficient = 1.25,
                               .fillet_radius_coefficient = 0.38,
                               .centre_distance = NAN,
                               .tip_diameter = {NAN, NAN},
                               .bore = {0, 90e-3},
                               .rim_thickness_coefficient = 3.5,
                               .backlash = 100e-6};
}

__attribute__((unused)) static struct eo_material paper_steel(void)
{
  return (struct eo_material){.youngs_modulus = 206e9, .poissons_ratio = 0.3, .density = 7850};
}

__attribute__((unused)) static struct eo_flexibility_settings default_settings(void)
{
  return (struct eo_flexibility_settings){.body = EO_BODY_SECTOR,
                                          .sector_teeth = 5,
                                          .neighbour_coupling = true,
                                          .layers = 28,
                                          .flank_rows = 10,
                                          .fillet_elements = 20,
                                          .columns = 8,
                                          .rim_elements = 8};
}

#endif
