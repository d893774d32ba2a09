/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rating/rating_pair.h"

#include <math.h>

#include "gear/geometry.h"

static void set_angles(struct eo_rating_geometry *geometry, const struct eo_rating_pair *rating_pair)
{
  double helix = cos(rating_pair->helix_angle);
  geometry->transverse_pressure_angle = atan(tan(rating_pair->normal_pressure_angle) / helix);
  geometry->base_helix_angle = asin(sin(rating_pair->helix_angle) * cos(rating_pair->normal_pressure_angle));
  double base_helix = cos(geometry->base_helix_angle);
  for (int i = 0; i < 2; i++) {
    geometry->reference_diameter[i] = rating_pair->normal_module * rating_pair->teeth[i] / helix;
    geometry->base_diameter[i] = geometry->reference_diameter[i] * cos(geometry->transverse_pressure_angle);
    geometry->working_diameter[i] = 2 * rating_pair->centre_distance * rating_pair->teeth[i] /
                                    (rating_pair->teeth[0] + rating_pair->teeth[1]);
    geometry->virtual_teeth[i] = rating_pair->teeth[i] / (base_helix * base_helix * helix);
  }
  geometry->transverse_base_pitch = M_PI * geometry->base_diameter[0] / rating_pair->teeth[0];
}

/* ISO 21771: g_alpha from both tips to the pitch point; eps_beta = b sin beta/(pi m_n). */
enum eo_code eo_rating_geometry(struct eo_rating_geometry *geometry, const struct eo_rating_pair *rating_pair,
                                struct eo_error *error)
{
  struct eo_rating_geometry rating_geometry = {0};
  set_angles(&rating_geometry, rating_pair);
  double base = (rating_geometry.base_diameter[0] + rating_geometry.base_diameter[1]) / 2;
  EO_TRY(eo_geometry_check_distance(rating_pair->centre_distance, base, "/centre_distance_mm", error));
  rating_geometry.working_pressure_angle = acos(base / rating_pair->centre_distance);
  for (int i = 0; i < 2; i++) {
    double ratio = rating_pair->tip_diameter[i] / rating_geometry.base_diameter[i];
    if (!(ratio > 1))
      return eo_error_set(error, EO_ERROR_INPUT, "/tip_diameter_mm",
                          "The tip diameter %.9g mm is not above the base diameter %.9g mm.",
                          1e3 * rating_pair->tip_diameter[i], 1e3 * rating_geometry.base_diameter[i]);
    rating_geometry.tip_roll[i] = sqrt(ratio * ratio - 1);
    rating_geometry.path_length += rating_geometry.base_diameter[i] / 2 *
                                   (rating_geometry.tip_roll[i] - tan(rating_geometry.working_pressure_angle));
  }
  rating_geometry.transverse_contact_ratio = rating_geometry.path_length / rating_geometry.transverse_base_pitch;
  rating_geometry.virtual_contact_ratio = rating_geometry.transverse_contact_ratio /
                                          pow(cos(rating_geometry.base_helix_angle), 2);
  rating_geometry.overlap_ratio = rating_pair->face_width * sin(rating_pair->helix_angle) /
                                  (M_PI * rating_pair->normal_module);
  *geometry = rating_geometry;
  return EO_OK;
}

enum eo_code eo_shift_split(struct eo_shift_split *split, const struct eo_rating_pair *rating_pair, double pinion_shift,
                            struct eo_error *error)
{
  struct eo_rating_geometry geometry = {0};
  set_angles(&geometry, rating_pair);
  double base = (geometry.base_diameter[0] + geometry.base_diameter[1]) / 2;
  EO_TRY(eo_geometry_check_distance(rating_pair->centre_distance, base, "/centre_distance_mm", error));
  double sum = eo_geometry_shift_sum(rating_pair->teeth, rating_pair->normal_pressure_angle,
                                     geometry.transverse_pressure_angle, acos(base / rating_pair->centre_distance));
  double reference = (geometry.reference_diameter[0] + geometry.reference_diameter[1]) / 2;
  split->gear_shift = sum - pinion_shift;
  split->tip_alteration = rating_pair->centre_distance - reference - rating_pair->normal_module * sum;
  return EO_OK;
}

/* ISO 21771: the base tangent less the other's way to its tip. */
double eo_active_root_diameter(const struct eo_rating_pair *rating_pair, const struct eo_rating_geometry *geometry,
                               int member)
{
  double tangent = 2 * rating_pair->centre_distance * sin(geometry->working_pressure_angle);
  double left = tangent - geometry->base_diameter[1 - member] * geometry->tip_roll[1 - member];
  return hypot(left, geometry->base_diameter[member]);
}
