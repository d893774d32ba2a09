/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the tests of gap, contact and excitation share: modifications of the paper, random ones, and compliances without
   finite elements. */
#ifndef EASEOFF_TESTS_SUPPORT_CONTACT_FIXTURE_H
#define EASEOFF_TESTS_SUPPORT_CONTACT_FIXTURE_H

#include "base/random.h"
#include "contact/field.h"
#include "flexibility/closed_form.h"
#include "support/paper-pair.h"
#include "support/tap.h"

#include <string.h>

/* Case A of Table 3; a_l = 1.35e-8 1/um at the face ends. */
__attribute__((unused)) static struct eo_flank_modification case_a(void)
{
  return (struct eo_flank_modification){.tip_relief = 14e-6,
                                        .root_relief = 17e-6,
                                        .tip_relief_start = 1.6e-3,
                                        .root_relief_start = 3.5e-3,
                                        .lead_crowning = 1.35e-2 * pow(55e-3 / 2 / cos(24 * M_PI / 180), 2)};
}

/* The compliance of tests/cases/contact.json, block ltca_synthetic. */
__attribute__((unused)) static struct eo_closed_form paper_form(void)
{
  return (struct eo_closed_form){
      .compliance = 1.5e-9, .length = 12e-3, .centre = -0.8e-3, .linear = 20, .quadratic = 4e3};
}

/* A smooth compliance with coupled neighbours: C = c exp(-(deta/l)^2 - (dpair)^2 / 2 - (ds/m)^2), positive definite as
   a product of Gaussians. context: double[3] {c, l, m}. */
__attribute__((unused)) static void smooth_kernel(const void *context, int n, const struct eo_flank_point *point,
                                                  double *compliance)
{
  const double *form = context;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      double a = (point[i].eta - point[j].eta) / form[1],
             b = (point[i].s[0] + point[i].s[1] - point[j].s[0] - point[j].s[1]) / 2 / form[2];
      double k = point[i].pair - point[j].pair;
      compliance[(size_t)i * (size_t)n + (size_t)j] = form[0] * exp(-a * a - b * b - k * k / 2);
    }
}

/* Number `draw` of random case `index`, uniform in [low, high). */
__attribute__((unused)) static double random_between(int index, int draw, double low, double high)
{
  return low + (high - low) * eo_random_unit(eo_random_at(2024, 0, 0, (uint64_t)index), (uint64_t)draw);
}

/* Any flank modification that the design document's checks let through. */
__attribute__((unused)) static struct eo_flank_modification random_modification(const struct eo_geometry *g, int index,
                                                                                int first)
{
  double top = g->rack_top, bottom = -g->rack_bottom, m = g->normal_module / 6e-3;
  return (struct eo_flank_modification){
      .shape = (enum eo_relief_shape)(int)random_between(index, first, 0, 2.999),
      .tip_relief = m * random_between(index, first + 1, 0, 40e-6),
      .tip_relief_start = top * random_between(index, first + 2, 0, 0.9),
      .root_relief = m * random_between(index, first + 3, 0, 40e-6),
      .root_relief_start = bottom * random_between(index, first + 4, 0, 0.9),
      .profile_crowning = random_between(index, first + 5, 0, 0.3) / m,
      .lead_crowning = m * random_between(index, first + 6, 0, 20e-6),
      .helix_slope = m * random_between(index, first + 7, -20e-6, 20e-6),
      .lead_offset = m * random_between(index, first + 8, 0, 5e-6),
      .end_relief = {m * random_between(index, first + 9, 0, 10e-6), m * random_between(index, first + 10, 0, 10e-6)},
      .end_relief_length = {g->face_width * random_between(index, first + 11, 0.05, 0.4),
                            g->face_width * random_between(index, first + 12, 0.05, 0.4)}};
}

/* A random gear pair that can be made: modules of 1 to 20 mm, spur to 38 degrees, overlap 0 to 4, profile shift of both
   signs. False when fifty tries found none. */
__attribute__((unused)) static bool random_pair(int index, struct eo_gear_pair *pair, struct eo_geometry *geometry)
{
  for (int attempt = 0; attempt < 50; attempt++) {
    int draw = 1000 + 100 * attempt;
    struct eo_error error;
    *pair = paper_pair();
    pair->teeth[EO_PINION] = (int)random_between(index, draw, 14, 45);
    pair->teeth[EO_GEAR] = (int)random_between(index, draw + 1, 20, 120);
    pair->normal_module = exp(random_between(index, draw + 2, log(1e-3), log(20e-3)));
    pair->normal_pressure_angle = random_between(index, draw + 3, 15, 25) * M_PI / 180;
    pair->helix_angle = random_between(index, draw + 4, 0, 1) < 0.15
                            ? 0
                            : random_between(index, draw + 5, 3, 38) * M_PI / 180;
    pair->face_width = pair->normal_module * exp(random_between(index, draw + 6, log(1.5), log(30)));
    pair->groove_width = 8 * pair->normal_module;
    pair->backlash = 0.02 * pair->normal_module;
    pair->profile_shift[EO_PINION] = random_between(index, draw + 7, -0.2, 0.6);
    pair->profile_shift[EO_GEAR] = random_between(index, draw + 8, -0.3, 0.4);
    pair->addendum_coefficient = random_between(index, draw + 9, 0.8, 1.2);
    pair->dedendum_coefficient = pair->addendum_coefficient + 0.25;
    pair->fillet_radius_coefficient = 0.25;
    if (eo_geometry_init(geometry, pair, &error) == EO_OK)
      return true;
  }
  return false;
}

/* Normal force of one end under a torque on the pinion. */
__attribute__((unused)) static double force_of(const struct eo_geometry *g, double torque)
{
  return torque / (2 * g->base_radius[EO_PINION] * cos(g->base_helix_angle));
}

#endif
