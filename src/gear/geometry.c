/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gear/geometry.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "gear/entry.h"
#include "gear/fillet.h"
#include "gear/names.h"

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

static void set_widths(struct eo_geometry *geometry, const struct eo_gear_pair *pair)
{
  geometry->face_width = pair->face_width;
  for (int i = 0; i < 2; i++)
    geometry->member_width[i] = pair->member_width[i] > 0 ? pair->member_width[i] : geometry->face_width;
}

static void set_overlap(struct eo_geometry *geometry)
{
  geometry->overlap_ratio = geometry->face_width * tan(geometry->base_helix_angle) / geometry->transverse_base_pitch;
}

struct eo_geometry eo_geometry_of_half(const struct eo_geometry *geometry, const struct eo_gear_pair *pair, int end)
{
  struct eo_geometry half = *geometry;
  const struct eo_gear_pair own = eo_gear_pair_half(pair, end);
  if (end == EO_RIGHT && eo_gear_pair_has_two_helices(pair) && !eo_geometry_init(&half, &own, NULL))
    return half; /* what there is to refuse eo_design_check() has refused */
  set_widths(&half, &own);
  set_overlap(&half);
  return half;
}

double eo_geometry_right_lead(const struct eo_geometry *left, const struct eo_gear_pair *pair)
{
  const struct eo_geometry right = eo_geometry_of_half(left, pair, EO_RIGHT);
  double lean = tan(left->base_helix_angle), other = tan(right.base_helix_angle);
  if (!eo_gear_pair_is_uneven(pair))
    return 0;
  if (lean == other)
    return (right.face_width - left->face_width) / 2 * lean;
  return eo_gear_pair_mid_face(pair, EO_RIGHT) * other - eo_gear_pair_mid_face(pair, EO_LEFT) * lean; /* theory (F12) */
}

static void set_basics(struct eo_geometry *geometry, const struct eo_gear_pair *pair)
{
  geometry->normal_module = pair->normal_module;
  geometry->normal_pressure_angle = pair->normal_pressure_angle;
  geometry->helix_angle = pair->helix_angle;
  geometry->transverse_module = geometry->normal_module / cos(geometry->helix_angle); /* theory (G1) */
  geometry->transverse_pressure_angle =
      atan(tan(geometry->normal_pressure_angle) / cos(geometry->helix_angle)); /* theory (G2) */
  geometry->base_helix_angle =
      asin(sin(geometry->helix_angle) * cos(geometry->normal_pressure_angle)); /* theory (G3) */
  set_widths(geometry, pair);
  for (int i = 0; i < 2; i++) {
    struct eo_rack rack = eo_gear_pair_rack(pair, i);
    geometry->dedendum[i] = rack.dedendum_coefficient * geometry->normal_module;
    geometry->fillet_radius[i] = rack.fillet_radius_coefficient * geometry->normal_module;
    geometry->teeth[i] = pair->teeth[i];
    geometry->profile_shift[i] = pair->profile_shift[i];
    geometry->reference_radius[i] = geometry->transverse_module * geometry->teeth[i] / 2; /* theory (G4) */
    geometry->base_radius[i] = geometry->reference_radius[i] * cos(geometry->transverse_pressure_angle);
    geometry->generating_shift[i] = geometry->profile_shift[i] + pair->generating_offset[i];
    geometry->residual_undercut[i] = fmax(0, pair->protuberance[i] - pair->grinding_stock[i]);
    geometry->root_radius[i] = geometry->reference_radius[i] - geometry->dedendum[i] +
                               geometry->generating_shift[i] * geometry->normal_module;
  }
  geometry->transverse_base_pitch = M_PI * geometry->transverse_module *
                                    cos(geometry->transverse_pressure_angle); /* theory (G5) */
  geometry->normal_base_pitch = geometry->transverse_base_pitch * cos(geometry->base_helix_angle);
  geometry->rack_factor = sin(geometry->transverse_pressure_angle) /
                          cos(geometry->normal_pressure_angle); /* theory (G14) */
}

/* What the distance takes from the backlash, and which shifts it would suit. */
static enum eo_code refuse_jam(const struct eo_geometry *geometry, const struct eo_gear_pair *pair, double tight,
                               struct eo_error *error)
{
  if (isnan(pair->centre_distance))
    return eo_error_set(error, EO_ERROR_INPUT, "/gear_pair/backlash_um",
                        "The normal backlash %.6g um is not positive: the teeth would jam.",
                        1e6 * geometry->normal_backlash);
  return eo_error_set(error, EO_ERROR_INPUT, "/gear_pair/centre_distance_mm",
                      "At %.9g mm the normal backlash is %.6g um, not positive: the teeth would jam. Without backlash "
                      "the profile shifts ask for %.9g mm, and this distance for a sum of the shifts of %.6g.",
                      1e3 * geometry->centre_distance, 1e6 * geometry->normal_backlash, 1e3 * tight,
                      eo_geometry_shift_sum(geometry->teeth, geometry->normal_pressure_angle,
                                            geometry->transverse_pressure_angle, geometry->working_pressure_angle));
}

enum eo_code eo_geometry_check_distance(double centre_distance, double base_radii, const char *pointer,
                                        struct eo_error *error)
{
  return centre_distance > base_radii
             ? EO_OK
             : eo_error_set(error, EO_ERROR_INPUT, pointer,
                            "The centre distance %.9g mm is not above the sum of the base radii, %.9g mm.",
                            1e3 * centre_distance, 1e3 * base_radii);
}

enum eo_code eo_geometry_refuse_shifts(const struct eo_gear_pair *pair, struct eo_error *error)
{
  return eo_error_set(error, EO_ERROR_INPUT, shift_key[EO_PINION],
                      "The profile shifts sum to %.6g, so negative that the pair has no working pressure angle.",
                      pair->profile_shift[0] + pair->profile_shift[1]);
}

/* j_wt = 2 a_w (inv alpha_wt - inv alpha_tight) at the working circles, normal: times cos alpha_wt cos beta_b. */
static double backlash_beyond(const struct eo_geometry *geometry, double tight)
{
  /* theory (G8) */
  return 2 * (geometry->base_radius[0] + geometry->base_radius[1]) * cos(geometry->base_helix_angle) *
         (eo_geometry_involute_function(geometry->working_pressure_angle) - eo_geometry_involute_function(tight));
}

/* Where the pitch point lies on both members. */
static void set_pitch_point(struct eo_geometry *geometry)
{
  for (int i = 0; i < 2; i++) {
    geometry->working_radius[i] = geometry->centre_distance * geometry->teeth[i] /
                                  (geometry->teeth[0] + geometry->teeth[1]);
    geometry->tangent_length[i] = geometry->base_radius[i] * tan(geometry->working_pressure_angle);
    geometry->rack_offset[i] = geometry->rack_factor * geometry->base_radius[i] *
                               (tan(geometry->working_pressure_angle) - tan(geometry->transverse_pressure_angle));
  }
}

/* Working centre distance and pressure angle; the backlash that a larger centre distance adds. */
static enum eo_code set_working(struct eo_geometry *geometry, const struct eo_gear_pair *pair, struct eo_error *error)
{
  double sum = geometry->reference_radius[0] + geometry->reference_radius[1],
         base = geometry->base_radius[0] + geometry->base_radius[1];
  /* theory (G6) */
  double value = eo_geometry_involute_function(geometry->transverse_pressure_angle) +
                 2 * (pair->profile_shift[0] + pair->profile_shift[1]) * tan(geometry->normal_pressure_angle) /
                     (geometry->teeth[0] + geometry->teeth[1]);
  if (value <= 0)
    return eo_geometry_refuse_shifts(pair, error);
  /* Exactly the reference values when nothing shifts them. */
  double tight = pair->profile_shift[0] + pair->profile_shift[1] == 0 ? geometry->transverse_pressure_angle
                                                                      : eo_geometry_involute_inverse(value);
  geometry->working_pressure_angle = tight;
  geometry->centre_distance = pair->profile_shift[0] + pair->profile_shift[1] == 0
                                  ? sum
                                  : base / cos(tight); /* theory (G7) */
  double stated = isnan(pair->backlash) ? eo_gear_pair_backlash(isnan(pair->centre_distance) ? geometry->centre_distance
                                                                                             : pair->centre_distance,
                                                                geometry->normal_module)
                                        : pair->backlash;
  geometry->normal_backlash = geometry->stated_backlash = stated;
  if (!isnan(pair->centre_distance)) {
    EO_TRY(eo_geometry_check_distance(pair->centre_distance, base, "/gear_pair/centre_distance_mm", error));
    geometry->centre_distance = pair->centre_distance;
    geometry->working_pressure_angle = acos(base / pair->centre_distance);
    geometry->normal_backlash += backlash_beyond(geometry, tight);
  }
  if (geometry->normal_backlash <= 0)
    return refuse_jam(geometry, pair, base / cos(tight), error);
  for (int i = 0; i < 2; i++)
    geometry->tip_radius[i] = isnan(pair->tip_diameter[i])
                                  ? eo_gear_pair_tip_diameter(pair, geometry->centre_distance, i) / 2
                                  : pair->tip_diameter[i] / 2;
  set_pitch_point(geometry);
  return EO_OK;
}

double eo_geometry_half_angle(const struct eo_geometry *geometry, int member, double radius)
{
  /* theory (G12) */
  double reference = M_PI / 2 / geometry->teeth[member] + 2 * geometry->profile_shift[member] *
                                                              tan(geometry->normal_pressure_angle) /
                                                              geometry->teeth[member];
  return reference + eo_geometry_involute_function(geometry->transverse_pressure_angle) -
         eo_geometry_involute_function(acos(fmin(1, geometry->base_radius[member] / radius)));
}

/* The root of the generated tooth: the rounding must fit into the rack's tip. Where the involute starts: at the point
   that the end of the rack's straight flank cuts or, with undercut, where the trochoid cuts the involute. */
static enum eo_code set_root(struct eo_geometry *geometry, int i, struct eo_error *error)
{
  double flank_end = geometry->dedendum[i] - geometry->fillet_radius[i] * (1 - sin(geometry->normal_pressure_angle)) -
                     geometry->generating_shift[i] * geometry->normal_module;
  /* theory (G13) */
  double roll = geometry->base_radius[i] * tan(geometry->transverse_pressure_angle) -
                flank_end / sin(geometry->transverse_pressure_angle);
  if (geometry->root_radius[i] <= 0)
    return eo_error_set(error, EO_ERROR_INPUT, "/gear_pair/dedendum_coefficient",
                        "The root radius of the %s, %.6g mm, is not positive.", eo_member_name[i],
                        1e3 * geometry->root_radius[i]);
  double tip_half = M_PI * geometry->normal_module / 4 -
                    (geometry->dedendum[i] - geometry->fillet_radius[i]) * tan(geometry->normal_pressure_angle);
  if (tip_half - geometry->fillet_radius[i] / cos(geometry->normal_pressure_angle) < -1e-9 * geometry->normal_module)
    return eo_error_set(
        error, EO_ERROR_INPUT, "/gear_pair/fillet_radius_coefficient",
        "The fillet radius of the %s, %.6g m_n, does not fit into the tip of the basic rack: with a "
        "dedendum of %.6g m_n at most %.4g m_n.",
        eo_member_name[i], geometry->fillet_radius[i] / geometry->normal_module,
        geometry->dedendum[i] / geometry->normal_module,
        eo_gear_rack_largest_fillet(geometry->dedendum[i] / geometry->normal_module, geometry->normal_pressure_angle));
  geometry->undercut[i] = roll <= 0;
  geometry->least_shift[i] = geometry->profile_shift[i] -
                             roll * sin(geometry->transverse_pressure_angle) / geometry->normal_module;
  geometry->fillet_end[i] = geometry->normal_pressure_angle;
  if (geometry->undercut[i] || geometry->residual_undercut[i] > 0)
    geometry->fillet_end[i] = eo_fillet_undercut(geometry, i, &geometry->form_radius[i]);
  else
    geometry->form_radius[i] = hypot(geometry->base_radius[i], roll);
  return EO_OK;
}

/* Tip radius of the other member at which the active profile starts so far beyond the start of the involute along the
   line of action. */
static double clearing_tip(const struct eo_geometry *geometry, int i, double spare)
{
  double roll = sqrt(fmax(0, geometry->form_radius[i] * geometry->form_radius[i] -
                                 geometry->base_radius[i] * geometry->base_radius[i])) +
                spare;
  return hypot(geometry->base_radius[1 - i], fmax(0, geometry->tangent_length[0] + geometry->tangent_length[1] - roll));
}

/* Tip radius at which the tooth is no thicker than a share of m_n in its transverse section; the radius itself where
   it is thicker. */
static double blunt_tip(const struct eo_geometry *geometry, int i, double radius)
{
  static const double LEAST = 0.2; /* m_n: what ISO and shops take as the least */
  enum { HALVINGS = 60 };
  double low = geometry->base_radius[i], high = radius, least = LEAST * geometry->normal_module;
  if (2 * high * eo_geometry_half_angle(geometry, i, high) >= least)
    return radius;
  for (int k = 0; k < HALVINGS; k++) {
    double middle = (low + high) / 2;
    if (2 * middle * eo_geometry_half_angle(geometry, i, middle) >= least)
      low = middle;
    else
      high = middle;
  }
  return low;
}

/* Down to whole nanometres, so that the last bits of the angles do not show; the usual radius stays what it is. */
static double whole_nanometres(double radius, double usual)
{
  return radius < usual ? floor(radius * 1e9) / 1e9 : usual;
}

/* A tip that nobody stated clears the mate's root. */
static void shorten_tips(struct eo_geometry *geometry, const struct eo_gear_pair *pair)
{
  static const double SPARE = 0.01; /* m_n, along the line of action */
  for (int i = 0; i < 2; i++) {
    double usual = geometry->tip_radius[i];
    if (isnan(pair->tip_diameter[i]) && isnan(pair->tip_alteration))
      geometry->tip_radius[i] = whole_nanometres(
          fmin(blunt_tip(geometry, i, usual), clearing_tip(geometry, 1 - i, SPARE * geometry->normal_module)), usual);
    geometry->shortened[i] = usual - geometry->tip_radius[i];
    geometry->tip_form_radius[i] = geometry->tip_radius[i] - pair->tip_chamfer[i];
  }
}

/* Where the tip of the other member reaches too deep: at its diameter when that is stated, else at the shift of the
   member that has too little, or at the addendum. */
static const char *tip_or_shift(const struct eo_geometry *geometry, const struct eo_gear_pair *pair, int i)
{
  return !isnan(pair->tip_diameter[1 - i]) ? tip_key[1 - i]
         : geometry->undercut[i]           ? shift_key[i]
                                           : "/gear_pair/addendum_coefficient";
}

static enum eo_code set_path(struct eo_geometry *geometry, const struct eo_gear_pair *pair, struct eo_error *error)
{
  double length[2];
  for (int i = 0; i < 2; i++) {
    if (geometry->tip_form_radius[i] <= geometry->working_radius[i])
      return eo_error_set(
          error, EO_ERROR_INPUT, isnan(pair->tip_diameter[i]) ? shift_key[i] : tip_key[i],
          "The flank of the %s ends at %.6g mm, not above its working pitch radius, %.6g mm: more profile "
          "shift on this member and less on the other.",
          eo_member_name[i], 1e3 * geometry->tip_form_radius[i], 1e3 * geometry->working_radius[i]);
    length[i] = sqrt(geometry->tip_form_radius[i] * geometry->tip_form_radius[i] -
                     geometry->base_radius[i] * geometry->base_radius[i]) -
                geometry->tangent_length[i];
  }
  geometry->path_start = -length[EO_GEAR]; /* theory (G10) */
  geometry->path_end = length[EO_PINION];
  geometry->transverse_contact_ratio = (length[0] + length[1]) / geometry->transverse_base_pitch; /* theory (G11) */
  set_overlap(geometry);
  geometry->rack_bottom = geometry->rack_factor * geometry->path_start;
  geometry->rack_top = geometry->rack_factor * geometry->path_end;
  for (int i = 0; i < 2; i++) {
    double roll = geometry->tangent_length[i] - length[1 - i];
    if (roll <= 0)
      return eo_error_set(
          error, EO_ERROR_INPUT, tip_or_shift(geometry, pair, i),
          "The tip of the %s reaches %.4g mm below the end of the line of action at the base circle of "
          "the %s%s: at most "
          "%.6g mm of tip radius.",
          eo_member_name[1 - i], -1e3 * roll, eo_member_name[i], geometry->undercut[i] ? ", which is undercut" : "",
          1e3 * hypot(geometry->base_radius[1 - i], geometry->tangent_length[0] + geometry->tangent_length[1]));
    geometry->start_radius[i] = hypot(geometry->base_radius[i], roll);
  }
  if (geometry->transverse_contact_ratio + geometry->overlap_ratio < 1)
    return eo_error_set(
        error, EO_ERROR_INPUT, "/gear_pair/face_width_mm",
        "The total contact ratio %.4g is below 1: the teeth do not mesh continuously. A wider face, a larger "
        "helix angle or a longer addendum adds to it.",
        geometry->transverse_contact_ratio + geometry->overlap_ratio);
  return EO_OK;
}

static enum eo_code check_tip(struct eo_geometry *geometry, int i, const struct eo_gear_pair *pair,
                              struct eo_error *error)
{
  int other = 1 - i;
  geometry->tip_thickness[i] = 2 * geometry->tip_radius[i] *
                               eo_geometry_half_angle(geometry, i, geometry->tip_radius[i]);
  if (geometry->tip_thickness[i] <= 0)
    return eo_error_set(
        error, EO_ERROR_INPUT, shift_key[i],
        "The teeth of the %s are pointed below the tip radius %.6g mm: less profile shift, or a smaller tip "
        "diameter.",
        eo_member_name[i], 1e3 * geometry->tip_radius[i]);
  if (geometry->start_radius[i] < geometry->form_radius[i])
    return eo_error_set(error, EO_ERROR_INPUT, tip_or_shift(geometry, pair, i),
                        "The tip of the %s interferes with the fillet of the %s: the active profile would start at "
                        "radius %.6g mm, the involute at %.6g mm%s: a tip radius of at most %.6g mm clears it.",
                        eo_member_name[other], eo_member_name[i], 1e3 * geometry->start_radius[i],
                        1e3 * geometry->form_radius[i], geometry->undercut[i] ? ", where the undercut ends" : "",
                        1e3 * clearing_tip(geometry, i, 0));
  geometry->tip_clearance[i] = geometry->centre_distance - geometry->tip_radius[i] - geometry->root_radius[other];
  if (geometry->tip_clearance[i] <= 0)
    return eo_error_set(
        error, EO_ERROR_INPUT, "/gear_pair/dedendum_coefficient",
        "The tip of the %s touches the root of the %s (clearance %.4g mm): a smaller tip diameter, a deeper "
        "dedendum of the %s, or a larger centre distance.",
        eo_member_name[i], eo_member_name[other], 1e3 * geometry->tip_clearance[i], eo_member_name[other]);
  return EO_OK;
}

enum eo_code eo_geometry_init(struct eo_geometry *geometry, const struct eo_gear_pair *pair, struct eo_error *error)
{
  struct eo_geometry this_geometry = {0};
  set_basics(&this_geometry, pair);
  EO_TRY(set_working(&this_geometry, pair, error));
  for (int i = 0; i < 2; i++)
    EO_TRY(set_root(&this_geometry, i, error));
  shorten_tips(&this_geometry, pair);
  EO_TRY(set_path(&this_geometry, pair, error));
  for (int i = 0; i < 2; i++)
    EO_TRY(check_tip(&this_geometry, i, pair, error));
  *geometry = this_geometry;
  return EO_OK;
}

/* What the distance makes of a pair whose gears are there already. */
static enum eo_code assemble(struct eo_geometry *geometry, const struct eo_gear_pair *pair, struct eo_error *error)
{
  const struct eo_geometry drawn = *geometry;
  double base = geometry->base_radius[0] + geometry->base_radius[1];
  if (geometry->centre_distance <= base)
    return eo_error_set(error, EO_ERROR_INPUT, "", "The axes are not further apart than the base radii add up to.");
  geometry->working_pressure_angle = acos(base / geometry->centre_distance); /* theory (G18) */
  geometry->normal_backlash += backlash_beyond(geometry, drawn.working_pressure_angle);
  if (geometry->normal_backlash <= 0)
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "The normal backlash, %.6g um, is not positive: the teeth would jam.",
                        1e6 * geometry->normal_backlash);
  set_pitch_point(geometry);
  for (int i = 0; i < 2; i++)
    geometry->moved[i] = geometry->tangent_length[i] - drawn.tangent_length[i];
  EO_TRY(set_path(geometry, pair, error));
  for (int i = 0; i < 2; i++)
    EO_TRY(check_tip(geometry, i, pair, error));
  return EO_OK;
}

enum eo_code eo_geometry_set_apart(struct eo_geometry *geometry, const struct eo_gear_pair *pair, double deviation,
                                   struct eo_error *error)
{
  struct eo_geometry apart = *geometry;
  struct eo_error found;
  if (deviation == 0)
    return EO_OK;
  apart.centre_distance += deviation;
  if (assemble(&apart, pair, &found))
    return eo_error_set(error, EO_ERROR_INPUT, "/alignment/centre_distance_deviation_um",
                        "With the axes %.6g um from the centre distance of the drawing: %.380s", 1e6 * deviation,
                        found.text);
  *geometry = apart;
  return EO_OK;
}

double eo_geometry_radius_at(const struct eo_geometry *geometry, int member, double s)
{
  return hypot(geometry->base_radius[member], geometry->tangent_length[member] + eo_geometry_own_path(member, s));
}

double eo_geometry_path_at(const struct eo_geometry *geometry, int member, double radius)
{
  double roll = sqrt(fmax(0, radius * radius - geometry->base_radius[member] * geometry->base_radius[member]));
  return eo_geometry_own_path(member, roll - geometry->tangent_length[member]);
}

double eo_geometry_relative_radius(const struct eo_geometry *geometry, double s)
{
  double length = geometry->tangent_length[0] + geometry->tangent_length[1];
  /* theory (G15) */
  return (geometry->tangent_length[0] + s) * (geometry->tangent_length[1] - s) /
         (length * cos(geometry->base_helix_angle));
}

void eo_geometry_involute(const struct eo_geometry *geometry, int member, double radius, double point[2],
                          double normal[2])
{
  double angle = eo_geometry_half_angle(geometry, member, radius),
         pressure = acos(fmin(1, geometry->base_radius[member] / radius));
  point[0] = radius * sin(angle);
  point[1] = radius * cos(angle);
  normal[0] = cos(angle - pressure);
  normal[1] = -sin(angle - pressure);
}

double eo_geometry_depth(const struct eo_geometry *geometry, int member, double s)
{
  double point[2], normal[2];
  eo_geometry_involute(geometry, member, eo_geometry_radius_at(geometry, member, s), point, normal);
  return point[0] / normal[0] * cos(geometry->base_helix_angle); /* theory (G16) */
}
