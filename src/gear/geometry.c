/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gear/geometry.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const name[2] = {"pinion", "gear"};
static const char *const shift_key[2] = {"/gear_pair/pinion_profile_shift", "/gear_pair/gear_profile_shift"};
static const char *const tip_key[2] = {"/gear_pair/pinion_tip_diameter_mm", "/gear_pair/gear_tip_diameter_mm"};

double eo_geometry_involute_function(double angle)
{
  return tan(angle) - angle;
}

double eo_geometry_shift_sum(const int teeth[2], double normal_pressure_angle, double transverse_pressure_angle,
                             double working_pressure_angle)
{
  double difference = eo_geometry_involute_function(working_pressure_angle) -
                      eo_geometry_involute_function(transverse_pressure_angle);
  return difference * (teeth[0] + teeth[1]) / (2 * tan(normal_pressure_angle));
}

/* Newton from above: inv is convex, and tan(alpha) = value + alpha < value + pi/2 bounds alpha; small values start from
   alpha^3/3. */
double eo_geometry_involute_inverse(double value)
{
  enum { MOST_STEPS = 60 };
  if (!(value > 0))
    return isnan(value) ? NAN : 0;
  double angle = fmin(cbrt(3 * value), atan(M_PI / 2 + value));
  for (int i = 0; i < MOST_STEPS; i++) {
    double tangent = tan(angle), step = (tangent - angle - value) / (tangent * tangent);
    angle -= step;
    if (fabs(step) < 1e-16)
      break;
  }
  return angle;
}

static enum eo_code refuse(struct eo_error *error, const char *key, const char *text)
{
  return eo_error_set(error, EO_ERROR_INPUT, key, "%s", text);
}

static void set_basics(struct eo_geometry *g, const struct eo_gear_pair *pair)
{
  g->normal_module = pair->normal_module;
  g->normal_pressure_angle = pair->normal_pressure_angle;
  g->helix_angle = pair->helix_angle;
  g->transverse_module = g->normal_module / cos(g->helix_angle);
  g->transverse_pressure_angle = atan(tan(g->normal_pressure_angle) / cos(g->helix_angle));
  g->base_helix_angle = asin(sin(g->helix_angle) * cos(g->normal_pressure_angle));
  g->face_width = pair->face_width;
  g->dedendum = pair->dedendum_coefficient * g->normal_module;
  g->fillet_radius = pair->fillet_radius_coefficient * g->normal_module;
  for (int i = 0; i < 2; i++) {
    g->teeth[i] = pair->teeth[i];
    g->profile_shift[i] = pair->profile_shift[i];
    g->reference_radius[i] = g->transverse_module * g->teeth[i] / 2;
    g->base_radius[i] = g->reference_radius[i] * cos(g->transverse_pressure_angle);
    g->root_radius[i] = g->reference_radius[i] - g->dedendum + g->profile_shift[i] * g->normal_module;
    g->tip_radius[i] = isnan(pair->tip_diameter[i])
                           ? g->reference_radius[i] +
                                 (pair->addendum_coefficient + g->profile_shift[i]) * g->normal_module
                           : pair->tip_diameter[i] / 2;
  }
  g->transverse_base_pitch = M_PI * g->transverse_module * cos(g->transverse_pressure_angle);
  g->normal_base_pitch = g->transverse_base_pitch * cos(g->base_helix_angle);
  g->rack_factor = sin(g->transverse_pressure_angle) / cos(g->normal_pressure_angle);
}

/* Working centre distance and pressure angle; the backlash that a larger centre distance adds. */
static enum eo_code set_working(struct eo_geometry *g, const struct eo_gear_pair *pair, struct eo_error *error)
{
  double sum = g->reference_radius[0] + g->reference_radius[1], base = g->base_radius[0] + g->base_radius[1];
  double value = eo_geometry_involute_function(g->transverse_pressure_angle) +
                 2 * (pair->profile_shift[0] + pair->profile_shift[1]) * tan(g->normal_pressure_angle) /
                     (g->teeth[0] + g->teeth[1]);
  if (value <= 0)
    return refuse(error, "/gear_pair/pinion_profile_shift",
                  "The sum of the profile shifts is so negative that the pair has no working pressure angle.");
  /* Exactly the reference values when nothing shifts them. */
  double tight = pair->profile_shift[0] + pair->profile_shift[1] == 0 ? g->transverse_pressure_angle
                                                                      : eo_geometry_involute_inverse(value);
  g->working_pressure_angle = tight;
  g->centre_distance = pair->profile_shift[0] + pair->profile_shift[1] == 0 ? sum : base / cos(tight);
  g->normal_backlash = pair->backlash;
  if (!isnan(pair->centre_distance)) {
    if (pair->centre_distance <= base)
      return eo_error_set(error, EO_ERROR_INPUT, "/gear_pair/centre_distance_mm",
                          "The centre distance %.9g mm is not above the sum of the base radii, %.9g mm.",
                          1e3 * pair->centre_distance, 1e3 * base);
    g->centre_distance = pair->centre_distance;
    g->working_pressure_angle = acos(base / pair->centre_distance);
    /* j_wt = 2 a_w (inv alpha_wt - inv alpha_tight) at the working circles, normal: times cos alpha_wt cos beta_b */
    g->normal_backlash +=
        2 * base * cos(g->base_helix_angle) *
        (eo_geometry_involute_function(g->working_pressure_angle) - eo_geometry_involute_function(tight));
  }
  if (g->normal_backlash <= 0)
    return eo_error_set(error, EO_ERROR_INPUT,
                        isnan(pair->centre_distance) ? "/gear_pair/backlash_um" : "/gear_pair/centre_distance_mm",
                        "The normal backlash %.6g um is not positive: the teeth would jam.", 1e6 * g->normal_backlash);
  for (int i = 0; i < 2; i++) {
    g->working_radius[i] = g->centre_distance * g->teeth[i] / (g->teeth[0] + g->teeth[1]);
    g->tangent_length[i] = g->base_radius[i] * tan(g->working_pressure_angle);
    g->rack_offset[i] = g->rack_factor * g->base_radius[i] *
                        (tan(g->working_pressure_angle) - tan(g->transverse_pressure_angle));
  }
  return EO_OK;
}

static enum eo_code set_path(struct eo_geometry *g, struct eo_error *error)
{
  double length[2];
  for (int i = 0; i < 2; i++) {
    if (g->tip_radius[i] <= g->working_radius[i])
      return eo_error_set(error, EO_ERROR_INPUT, tip_key[i],
                          "The tip radius of the %s, %.6g mm, is not above its working pitch radius, %.6g mm.", name[i],
                          1e3 * g->tip_radius[i], 1e3 * g->working_radius[i]);
    length[i] = sqrt(g->tip_radius[i] * g->tip_radius[i] - g->base_radius[i] * g->base_radius[i]) -
                g->tangent_length[i];
  }
  g->path_start = -length[EO_GEAR];
  g->path_end = length[EO_PINION];
  g->transverse_contact_ratio = (length[0] + length[1]) / g->transverse_base_pitch;
  g->overlap_ratio = g->face_width * tan(g->base_helix_angle) / g->transverse_base_pitch;
  g->rack_bottom = g->rack_factor * g->path_start;
  g->rack_top = g->rack_factor * g->path_end;
  for (int i = 0; i < 2; i++) {
    double roll = g->tangent_length[i] - length[1 - i];
    if (roll <= 0)
      return eo_error_set(error, EO_ERROR_INPUT, tip_key[1 - i],
                          "The tip of the %s reaches below the base circle of the %s.", name[1 - i], name[i]);
    g->start_radius[i] = hypot(g->base_radius[i], roll);
  }
  if (g->transverse_contact_ratio + g->overlap_ratio < 1)
    return eo_error_set(error, EO_ERROR_INPUT, "/gear_pair/face_width_mm",
                        "The total contact ratio %.4g is below 1: the teeth do not mesh continuously.",
                        g->transverse_contact_ratio + g->overlap_ratio);
  return EO_OK;
}

/* Angle from the tooth's centre line to the involute at a radius. */
static double half_thickness_angle(const struct eo_geometry *g, int member, double radius)
{
  double reference = M_PI / 2 / g->teeth[member] +
                     2 * g->profile_shift[member] * tan(g->normal_pressure_angle) / g->teeth[member];
  return reference + eo_geometry_involute_function(g->transverse_pressure_angle) -
         eo_geometry_involute_function(acos(fmin(1, g->base_radius[member] / radius)));
}

/* The root of the generated tooth: no undercut, and the rounding fits into the rack's tip. */
static enum eo_code set_root(struct eo_geometry *g, int i, struct eo_error *error)
{
  /* The straight flank of the rack ends where its rounded tip begins; that point generates the form radius. */
  double flank_end = g->dedendum - g->fillet_radius * (1 - sin(g->normal_pressure_angle)) -
                     g->profile_shift[i] * g->normal_module;
  double roll = g->base_radius[i] * tan(g->transverse_pressure_angle) - flank_end / sin(g->transverse_pressure_angle);
  if (roll <= 0)
    return eo_error_set(error, EO_ERROR_INPUT, shift_key[i],
                        "The %s is undercut: it needs a profile shift of at least %.4g.", name[i],
                        g->profile_shift[i] - roll * sin(g->transverse_pressure_angle) / g->normal_module);
  g->form_radius[i] = hypot(g->base_radius[i], roll);
  if (g->root_radius[i] <= 0)
    return refuse(error, "/gear_pair/dedendum_coefficient", "The root radius is not positive.");
  double tip_half = M_PI * g->normal_module / 4 - (g->dedendum - g->fillet_radius) * tan(g->normal_pressure_angle);
  if (tip_half - g->fillet_radius / cos(g->normal_pressure_angle) < -1e-9 * g->normal_module)
    return refuse(error, "/gear_pair/fillet_radius_coefficient",
                  "The fillet radius does not fit into the tip of the basic rack.");
  return EO_OK;
}

static enum eo_code check_tip(struct eo_geometry *g, int i, const struct eo_gear_pair *pair, struct eo_error *error)
{
  int other = 1 - i;
  g->tip_thickness[i] = 2 * g->tip_radius[i] * half_thickness_angle(g, i, g->tip_radius[i]);
  if (g->tip_thickness[i] <= 0)
    return eo_error_set(error, EO_ERROR_INPUT, shift_key[i],
                        "The teeth of the %s are pointed below the tip radius %.6g mm.", name[i],
                        1e3 * g->tip_radius[i]);
  if (g->start_radius[i] < g->form_radius[i])
    return eo_error_set(error, EO_ERROR_INPUT,
                        isnan(pair->tip_diameter[other]) ? "/gear_pair/addendum_coefficient" : tip_key[other],
                        "The tip of the %s interferes with the fillet of the %s: the active profile would start at "
                        "radius %.6g mm, the involute at %.6g mm.",
                        name[other], name[i], 1e3 * g->start_radius[i], 1e3 * g->form_radius[i]);
  g->tip_clearance[i] = g->centre_distance - g->tip_radius[i] - g->root_radius[other];
  if (g->tip_clearance[i] <= 0)
    return eo_error_set(error, EO_ERROR_INPUT, "/gear_pair/dedendum_coefficient",
                        "The tip of the %s touches the root of the %s (clearance %.4g mm).", name[i], name[other],
                        1e3 * g->tip_clearance[i]);
  return EO_OK;
}

enum eo_code eo_geometry_init(struct eo_geometry *geometry, const struct eo_gear_pair *pair, struct eo_error *error)
{
  struct eo_geometry g = {0};
  set_basics(&g, pair);
  enum eo_code code = set_working(&g, pair, error);
  for (int i = 0; i < 2 && !code; i++)
    code = set_root(&g, i, error);
  if (!code)
    code = set_path(&g, error);
  for (int i = 0; i < 2 && !code; i++)
    code = check_tip(&g, i, pair, error);
  if (!code)
    *geometry = g;
  return code;
}

double eo_geometry_radius_at(const struct eo_geometry *g, int member, double s)
{
  return hypot(g->base_radius[member], g->tangent_length[member] + eo_geometry_own_path(member, s));
}

double eo_geometry_path_at(const struct eo_geometry *g, int member, double radius)
{
  double roll = sqrt(fmax(0, radius * radius - g->base_radius[member] * g->base_radius[member]));
  return eo_geometry_own_path(member, roll - g->tangent_length[member]);
}

double eo_geometry_relative_radius(const struct eo_geometry *g, double s)
{
  double length = g->tangent_length[0] + g->tangent_length[1];
  return (g->tangent_length[0] + s) * (g->tangent_length[1] - s) / (length * cos(g->base_helix_angle));
}

void eo_geometry_involute(const struct eo_geometry *g, int member, double radius, double point[2], double normal[2])
{
  double angle = half_thickness_angle(g, member, radius), pressure = acos(fmin(1, g->base_radius[member] / radius));
  point[0] = radius * sin(angle);
  point[1] = radius * cos(angle);
  normal[0] = cos(angle - pressure);
  normal[1] = -sin(angle - pressure);
}

double eo_geometry_depth(const struct eo_geometry *g, int member, double s)
{
  double point[2], normal[2];
  eo_geometry_involute(g, member, eo_geometry_radius_at(g, member, s), point, normal);
  return point[0] / normal[0] * cos(g->base_helix_angle);
}
