/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rating/rating_pair.h"

#include <math.h>

#include "gear/geometry.h"

static enum eo_code refuse_distance(double distance, double least, struct eo_error *error)
{
  return eo_error_set(error, EO_ERROR_INPUT, "/centre_distance_mm",
                      "The centre distance %.9g mm is not above the sum of the base radii, %.9g mm.", 1e3 * distance,
                      1e3 * least);
}

static void set_angles(struct eo_rating_geometry *g, const struct eo_rating_pair *p)
{
  double helix = cos(p->helix_angle);
  g->transverse_pressure_angle = atan(tan(p->normal_pressure_angle) / helix);
  g->base_helix_angle = asin(sin(p->helix_angle) * cos(p->normal_pressure_angle));
  double base_helix = cos(g->base_helix_angle);
  for (int i = 0; i < 2; i++) {
    g->reference_diameter[i] = p->normal_module * p->teeth[i] / helix;
    g->base_diameter[i] = g->reference_diameter[i] * cos(g->transverse_pressure_angle);
    g->working_diameter[i] = 2 * p->centre_distance * p->teeth[i] / (p->teeth[0] + p->teeth[1]);
    g->virtual_teeth[i] = p->teeth[i] / (base_helix * base_helix * helix);
  }
  g->transverse_base_pitch = M_PI * g->base_diameter[0] / p->teeth[0];
}

/* ISO 21771: g_alpha from both tips to the pitch point; eps_beta = b sin beta/(pi m_n). */
enum eo_code eo_rating_geometry(struct eo_rating_geometry *geometry, const struct eo_rating_pair *p,
                                struct eo_error *error)
{
  struct eo_rating_geometry g = {0};
  set_angles(&g, p);
  double base = (g.base_diameter[0] + g.base_diameter[1]) / 2;
  if (!(p->centre_distance > base))
    return refuse_distance(p->centre_distance, base, error);
  g.working_pressure_angle = acos(base / p->centre_distance);
  for (int i = 0; i < 2; i++) {
    double ratio = p->tip_diameter[i] / g.base_diameter[i];
    if (!(ratio > 1))
      return eo_error_set(error, EO_ERROR_INPUT, "/tip_diameter_mm",
                          "The tip diameter %.9g mm is not above the base diameter %.9g mm.", 1e3 * p->tip_diameter[i],
                          1e3 * g.base_diameter[i]);
    g.tip_roll[i] = sqrt(ratio * ratio - 1);
    g.path_length += g.base_diameter[i] / 2 * (g.tip_roll[i] - tan(g.working_pressure_angle));
  }
  g.transverse_contact_ratio = g.path_length / g.transverse_base_pitch;
  g.virtual_contact_ratio = g.transverse_contact_ratio / pow(cos(g.base_helix_angle), 2);
  g.overlap_ratio = p->face_width * sin(p->helix_angle) / (M_PI * p->normal_module);
  *geometry = g;
  return EO_OK;
}

enum eo_code eo_shift_split(struct eo_shift_split *split, const struct eo_rating_pair *p, double pinion_shift,
                            struct eo_error *error)
{
  struct eo_rating_geometry g = {0};
  set_angles(&g, p);
  double base = (g.base_diameter[0] + g.base_diameter[1]) / 2;
  if (!(p->centre_distance > base))
    return refuse_distance(p->centre_distance, base, error);
  double sum = eo_geometry_shift_sum(p->teeth, p->normal_pressure_angle, g.transverse_pressure_angle,
                                     acos(base / p->centre_distance));
  double reference = (g.reference_diameter[0] + g.reference_diameter[1]) / 2;
  split->gear_shift = sum - pinion_shift;
  split->tip_alteration = p->centre_distance - reference - p->normal_module * sum;
  return EO_OK;
}

/* ISO 21771: the base tangent less the other's way to its tip. */
double eo_active_root_diameter(const struct eo_rating_pair *p, const struct eo_rating_geometry *g, int member)
{
  double tangent = 2 * p->centre_distance * sin(g->working_pressure_angle);
  double left = tangent - g->base_diameter[1 - member] * g->tip_roll[1 - member];
  return hypot(left, g->base_diameter[member]);
}
