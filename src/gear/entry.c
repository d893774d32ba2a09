/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gear/entry.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "gear/geometry.h"

static const char *const shift_mm_key[2] = {"/gear_pair/pinion_profile_shift_mm", "/gear_pair/gear_profile_shift_mm"};
static const char *const tip_key[2] = {"/gear_pair/pinion_tip_diameter_mm", "/gear_pair/gear_tip_diameter_mm"};
static const double MM = 1e-3, DEGREE = M_PI / 180;

/* Two statements of one number are one when a drawing's digits could make the difference. */
static const double SAME = 1e-6;
/* What follows from the other statements anyway, but for rounding. */
static const double DERIVED = 1e-11;

/* 12 significant digits in a unit: what the paths to one number differ by is behind them. What has several paths is
   held so on each of them, stated by itself as well: 25.4 / 7 mm and a pitch of 7 are one module. */
static double in_digits(double value, double unit)
{
  if (!isfinite(value))
    return value;
  char text[40];
  snprintf(text, sizeof text, "%.12g", value / unit);
  double rounded = strtod(text, NULL);
  return unit == MM ? rounded / 1e3 : rounded * unit;
}

/* A coefficient, to 1e-12: what remains of differences of nearly equal numbers is no digit of it. */
static double as_coefficient(double value)
{
  return round(value * 1e12) / 1e12 + 0.0;
}

static bool differ(double a, double b, double scale)
{
  return !(fabs(a - b) <= SAME * scale);
}

/* Takes *target when it is stated, else what was found; both must agree. */
static enum eo_code agree(double *target, double found, double scale, const char *key, double unit, const char *symbol,
                          struct eo_error *error)
{
  if (isnan(found))
    return EO_OK;
  if (!(fabs(*target) > 0)) {
    *target = found;
    return EO_OK;
  }
  if (!differ(*target, found, scale))
    return EO_OK;
  return eo_error_set(error, EO_ERROR_INPUT, key,
                      "This makes it %.9g %s, but the design states it as %.9g %s elsewhere too: leave one of the two "
                      "out.",
                      found / unit, symbol, *target / unit, symbol);
}

/* What is stated by itself, as the other ways to it would have it. */
static void hold_digits(struct eo_gear_pair *pair)
{
  pair->normal_module = in_digits(pair->normal_module, MM);
  pair->normal_pressure_angle = in_digits(pair->normal_pressure_angle, DEGREE);
  for (int i = 0; i < 2; i++) {
    pair->profile_shift[i] = as_coefficient(pair->profile_shift[i]);
    pair->tip_diameter[i] = in_digits(pair->tip_diameter[i], MM);
  }
}

/* m_n = m_t cos beta, 1/P_n, cos beta / P_t. */
static enum eo_code settle_module(struct eo_gear_pair *pair, struct eo_error *error)
{
  const struct eo_gear_entry *entry = &pair->entry;
  double helix = cos(pair->helix_angle);
  const struct {
    const char *key;
    double module;
  } way[] = {{"/gear_pair/transverse_module_mm", entry->transverse_module * helix},
             {"/gear_pair/normal_diametral_pitch_per_inch", 1 / entry->normal_diametral_pitch},
             {"/gear_pair/transverse_diametral_pitch_per_inch", helix / entry->transverse_diametral_pitch}};
  for (size_t i = 0; i < sizeof way / sizeof *way; i++)
    if (!isnan(way[i].module))
      EO_TRY(
          agree(&pair->normal_module, in_digits(way[i].module, MM), pair->normal_module, way[i].key, MM, "mm", error));
  if (!(pair->normal_module > 0))
    return eo_error_set(error, EO_ERROR_INPUT, "/gear_pair/normal_module_mm",
                        "The pair needs its module: normal or transverse, or a diametral pitch.");
  return EO_OK;
}

/* tan alpha_n = tan alpha_t cos beta; 20 deg where nothing is said. */
static enum eo_code settle_pressure_angle(struct eo_gear_pair *pair, struct eo_error *error)
{
  static const double BASIC_RACK = 20; /* ISO 53 */
  double transverse = pair->entry.transverse_pressure_angle;
  if (!isnan(transverse))
    EO_TRY(agree(&pair->normal_pressure_angle, in_digits(atan(tan(transverse) * cos(pair->helix_angle)), DEGREE), 1,
                 "/gear_pair/transverse_pressure_angle_deg", DEGREE, "deg", error));
  if (isnan(pair->normal_pressure_angle))
    pair->normal_pressure_angle = BASIC_RACK * DEGREE;
  return EO_OK;
}

/* Both members stand centred on each other, so the narrower one decides what they share. */
static enum eo_code settle_widths(struct eo_gear_pair *pair, struct eo_error *error)
{
  static const char *const key[2] = {"/gear_pair/pinion_face_width_mm", "/gear_pair/gear_face_width_mm"};
  double *own = pair->member_width;
  for (int i = 0; i < 2; i++)
    own[i] = own[i] > 0 ? own[i] : NAN;
  double common = isnan(own[0]) || isnan(own[1]) ? NAN : fmin(own[0], own[1]);
  if (isnan(pair->face_width))
    pair->face_width = isnan(common) ? fmax(own[0], own[1]) : common;
  if (!isnan(common) && differ(pair->face_width, common, pair->face_width))
    return eo_error_set(error, EO_ERROR_INPUT, "/gear_pair/face_width_mm",
                        "The members' own faces, %.9g and %.9g mm, share %.9g mm, not %.9g mm: leave this key out.",
                        own[EO_PINION] / MM, own[EO_GEAR] / MM, common / MM, pair->face_width / MM);
  for (int i = 0; i < 2; i++) {
    if (own[i] < pair->face_width * (1 - SAME))
      return eo_error_set(
          error, EO_ERROR_INPUT, key[i],
          "The member's own face, %.9g mm, is narrower than the face common to both, %.9g mm: state the "
          "own widths alone, or a common width of at most the narrower one.",
          own[i] / MM, pair->face_width / MM);
    if (fabs(own[i] - pair->face_width) <= DERIVED * own[i])
      own[i] = NAN;
  }
  return EO_OK;
}

/* A right helix like the left one is not stated; a half without a helix cannot be balanced by one that has it. */
static enum eo_code settle_right_helix(struct eo_gear_pair *pair, struct eo_error *error)
{
  double right = pair->right_helix_angle;
  if (!(right > 0) || fabs(right - pair->helix_angle) <= DERIVED * right) {
    pair->right_helix_angle = NAN;
    return EO_OK;
  }
  if (pair->ends == 1)
    return eo_error_set(error, EO_ERROR_INPUT, "/gear_pair/right_helix_angle_deg",
                        "A pair with one end has no right half of %.9g deg: leave this key out.", right / DEGREE);
  if (pair->helix_angle == 0)
    return eo_error_set(error, EO_ERROR_INPUT, "/gear_pair/right_helix_angle_deg",
                        "A left half without a helix has no thrust to balance that of a right one of %.9g deg: give "
                        "helix_angle_deg the angle of the left half.",
                        right / DEGREE);
  return EO_OK;
}

/* A right half like the left one is not stated. */
static enum eo_code settle_right_half(struct eo_gear_pair *pair, struct eo_error *error)
{
  double right = pair->right_face_width;
  if (!(right > 0) || fabs(right - pair->face_width) <= DERIVED * right) {
    pair->right_face_width = NAN;
    return EO_OK;
  }
  if (pair->ends == 1)
    return eo_error_set(error, EO_ERROR_INPUT, "/gear_pair/right_face_width_mm",
                        "A pair with one end has no right half of %.9g mm: leave this key out.", right / MM);
  return EO_OK;
}

/* The same transverse section under another helix: m_n = m_t cos beta, tan alpha_n = tan alpha_t cos beta, and every
   coefficient such that the length it stands for stays, but for a rounding that the narrower tip of a steeper rack has
   no room for: that is as large as it can be. */
static void turn_helix(struct eo_gear_pair *half, const struct eo_gear_pair *pair, double helix_angle)
{
  double module = cos(helix_angle) / cos(pair->helix_angle), longer = 1 / module; /* theory (G17) */
  half->helix_angle = helix_angle;
  half->normal_module = pair->normal_module * module;
  half->normal_pressure_angle = atan(tan(pair->normal_pressure_angle) * module);
  for (int i = 0; i < 2; i++) {
    struct eo_rack rack = eo_gear_pair_rack(pair, i);
    double dedendum = rack.dedendum_coefficient * longer;
    half->rack[i] = (struct eo_rack){rack.addendum_coefficient * longer, dedendum,
                                     fmin(rack.fillet_radius_coefficient * longer,
                                          eo_gear_rack_largest_fillet(dedendum, half->normal_pressure_angle))};
    half->profile_shift[i] = pair->profile_shift[i] * longer;
    half->generating_offset[i] = pair->generating_offset[i] * longer;
  }
  half->tip_alteration = pair->tip_alteration * longer;
  half->rim_thickness_coefficient = pair->rim_thickness_coefficient * longer;
}

struct eo_gear_pair eo_gear_pair_half(const struct eo_gear_pair *pair, int end)
{
  struct eo_gear_pair half = *pair;
  half.face_width = eo_gear_pair_face_width(pair, end);
  half.right_face_width = NAN;
  for (int i = 0; i < 2; i++)
    if (pair->member_width[i] > 0)
      half.member_width[i] = half.face_width + eo_gear_pair_extra_width(pair, i);
  half.right_helix_angle = NAN;
  if (end == EO_RIGHT && eo_gear_pair_has_two_helices(pair))
    turn_helix(&half, pair, pair->right_helix_angle);
  return half;
}

static double transverse_pressure_angle(const struct eo_gear_pair *pair)
{
  return atan(tan(pair->normal_pressure_angle) / cos(pair->helix_angle));
}

static double reference_distance(const struct eo_gear_pair *pair)
{
  double transverse_module = pair->normal_module / cos(pair->helix_angle);
  return transverse_module * pair->teeth[0] / 2 + transverse_module * pair->teeth[1] / 2;
}

static double base_sum(const struct eo_gear_pair *pair)
{
  return reference_distance(pair) * cos(transverse_pressure_angle(pair));
}

/* Working centre distance without backlash of a settled pair, m; NaN: so much negative shift that there is none. */
static double tight_distance(const struct eo_gear_pair *pair)
{
  double sum = pair->profile_shift[0] + pair->profile_shift[1], alpha = transverse_pressure_angle(pair);
  double value = eo_geometry_involute_function(alpha) +
                 2 * sum * tan(pair->normal_pressure_angle) / (pair->teeth[0] + pair->teeth[1]);
  if (sum == 0)
    return reference_distance(pair);
  return value > 0 ? base_sum(pair) / cos(eo_geometry_involute_inverse(value)) : NAN;
}

/* x1 + x2 without backlash at a working pressure angle; NaN where that is NaN. */
static double shift_sum_at(const struct eo_gear_pair *pair, double working_pressure_angle)
{
  return as_coefficient(eo_geometry_shift_sum(pair->teeth, pair->normal_pressure_angle, transverse_pressure_angle(pair),
                                              working_pressure_angle));
}

/* alpha_wt of the stated distance. */
static enum eo_code angle_of_distance(const struct eo_gear_pair *pair, double *angle, struct eo_error *error)
{
  double base = base_sum(pair);
  *angle = NAN;
  if (isnan(pair->centre_distance))
    return EO_OK;
  if (pair->centre_distance <= base)
    return eo_error_set(error, EO_ERROR_INPUT, "/gear_pair/centre_distance_mm",
                        "The centre distance %.9g mm is not above the sum of the base radii, %.9g mm: these teeth, "
                        "module and angles need more.",
                        1e3 * pair->centre_distance, 1e3 * base);
  *angle = acos(base / pair->centre_distance);
  return EO_OK;
}

/* The sum of the shifts that the drawing implies: stated, of the working pressure angle, of the distance. */
static enum eo_code implied_sum(const struct eo_gear_pair *pair, double *sum, struct eo_error *error)
{
  double working = pair->entry.working_pressure_angle, angle;
  EO_TRY(angle_of_distance(pair, &angle, error));
  if (!isnan(working) && !isnan(angle) && differ(working, angle, 1))
    return eo_error_set(error, EO_ERROR_INPUT, "/gear_pair/working_pressure_angle_deg",
                        "The centre distance makes it %.9g deg, not %.9g deg: leave one of the two out.",
                        angle / DEGREE, working / DEGREE);
  *sum = !isnan(pair->entry.shift_sum) ? pair->entry.shift_sum : shift_sum_at(pair, isnan(working) ? angle : working);
  return EO_OK;
}

/* Shifts by their length x m_n. */
static enum eo_code settle_shift_lengths(struct eo_gear_pair *pair, struct eo_error *error)
{
  for (int i = 0; i < 2; i++) {
    double length = pair->entry.shift_length[i], x = as_coefficient(length / pair->normal_module);
    if (isnan(length))
      continue;
    if (!isnan(pair->profile_shift[i]) && differ(pair->profile_shift[i], x, 1))
      return eo_error_set(error, EO_ERROR_INPUT, shift_mm_key[i],
                          "%.9g mm is x = %.9g at this module, but x is stated as %.9g: leave one of the two out.",
                          1e3 * length, x, pair->profile_shift[i]);
    pair->profile_shift[i] = isnan(pair->profile_shift[i]) ? x : pair->profile_shift[i];
  }
  return EO_OK;
}

/* The shift that is not stated is what the other leaves of the sum; with neither stated the gear has it all. */
static void share_sum(double shift[2], double sum)
{
  if (isnan(shift[EO_PINION]) && isnan(shift[EO_GEAR]))
    shift[EO_PINION] = 0;
  for (int i = 0; i < 2; i++)
    if (isnan(shift[i]))
      shift[i] = isnan(sum) ? 0 : as_coefficient(sum - shift[1 - i]);
}

/* Both shifts are stated: a sum or an angle beside them must be theirs; an angle beyond them is a distance. */
static enum eo_code settle_stated_shifts(struct eo_gear_pair *pair, struct eo_error *error)
{
  double sum = pair->profile_shift[0] + pair->profile_shift[1], working = pair->entry.working_pressure_angle;
  if (!isnan(pair->entry.shift_sum) && differ(pair->entry.shift_sum, sum, 1))
    return eo_error_set(error, EO_ERROR_INPUT, "/gear_pair/profile_shift_sum",
                        "The profile shifts %.9g and %.9g sum to %.9g, not to %.9g: leave one of the three out.",
                        pair->profile_shift[0], pair->profile_shift[1], sum, pair->entry.shift_sum);
  if (!isnan(working) && isnan(pair->centre_distance))
    pair->centre_distance = base_sum(pair) / cos(working);
  return EO_OK;
}

static enum eo_code settle_shifts(struct eo_gear_pair *pair, struct eo_error *error)
{
  double sum = NAN;
  EO_TRY(settle_shift_lengths(pair, error));
  EO_TRY(implied_sum(pair, &sum, error));
  bool stated = !isnan(pair->profile_shift[0]) && !isnan(pair->profile_shift[1]);
  if (stated)
    EO_TRY(settle_stated_shifts(pair, error));
  share_sum(pair->profile_shift, sum);
  bool tight = fabs(tight_distance(pair) - pair->centre_distance) <= DERIVED * pair->centre_distance;
  pair->centre_distance = tight ? NAN : in_digits(pair->centre_distance, MM); /* not before the shifts follow from it */
  return EO_OK;
}

/* rho_fP* whose rounding is the whole tip of the rack: pi/4 - (h - rho) tan alpha = rho/cos alpha. */
double eo_gear_rack_largest_fillet(double dedendum_coefficient, double normal_pressure_angle)
{
  double alpha = normal_pressure_angle;
  return (M_PI / 4 - dedendum_coefficient * tan(alpha)) * cos(alpha) / (1 - sin(alpha));
}

/* Profile A of ISO 53, which is made for 20 deg: with larger pressure angles what still fits into the tooth space. */
static struct eo_rack usual_rack(double alpha, double dedendum)
{
  static const double ADDENDUM = 1, DEDENDUM = 1.25, FILLET = 0.38, DEEPEST = 0.9, STEP = 100;
  double depth = dedendum > 0 ? dedendum : fmin(DEDENDUM, floor(STEP * DEEPEST * M_PI / 4 / tan(alpha)) / STEP);
  return (struct eo_rack){ADDENDUM, depth,
                          fmin(FILLET, floor(STEP * eo_gear_rack_largest_fillet(depth, alpha)) / STEP)};
}

static double first_stated(double member, double both, double usual)
{
  return member > 0 ? member : both > 0 ? both : usual;
}

struct eo_rack eo_gear_pair_rack(const struct eo_gear_pair *pair, int member)
{
  const struct eo_rack *own = &pair->rack[member];
  struct eo_rack usual = usual_rack(pair->normal_pressure_angle,
                                    first_stated(own->dedendum_coefficient, pair->dedendum_coefficient, NAN));
  return (struct eo_rack){
      first_stated(own->addendum_coefficient, pair->addendum_coefficient, usual.addendum_coefficient),
      usual.dedendum_coefficient,
      first_stated(own->fillet_radius_coefficient, pair->fillet_radius_coefficient, usual.fillet_radius_coefficient)};
}

/* k of both members at a centre distance a_w; not stated: the clearance of the basic rack is kept there, k = a_w/m_n -
   (z1 + z2)/(2 cos beta) - (x1 + x2), never above 0. */
static double tip_alteration(const struct eo_gear_pair *pair, double centre_distance)
{
  double sum = pair->profile_shift[0] + pair->profile_shift[1];
  return isnan(pair->tip_alteration) ? fmin(0, (centre_distance - reference_distance(pair)) / pair->normal_module - sum)
                                     : pair->tip_alteration;
}

double eo_gear_pair_tip_diameter(const struct eo_gear_pair *pair, double centre_distance, int member)
{
  double coefficient = eo_gear_pair_rack(pair, member).addendum_coefficient + pair->profile_shift[member];
  double alteration = tip_alteration(pair, centre_distance);
  return 2 * (pair->normal_module / cos(pair->helix_angle) * pair->teeth[member] / 2 +
              (alteration == 0 ? coefficient : coefficient + alteration) * pair->normal_module); /* theory (G9) */
}

/* d_a = d + 2 h_a; a tip that the rack gives anyway is derived. */
static enum eo_code settle_tip(struct eo_gear_pair *pair, int i, struct eo_error *error)
{
  double distance = isnan(pair->centre_distance) ? tight_distance(pair) : pair->centre_distance;
  double reference = pair->normal_module / cos(pair->helix_angle) * pair->teeth[i], addendum = pair->entry.addendum[i],
         usual = eo_gear_pair_tip_diameter(pair, distance, i);
  if (!isnan(addendum)) {
    double found = in_digits(reference + 2 * addendum, MM);
    if (!isnan(pair->tip_diameter[i]) && differ(pair->tip_diameter[i], found, pair->normal_module))
      return eo_error_set(
          error, EO_ERROR_INPUT, tip_key[i],
          "An addendum of %.9g mm makes the tip diameter %.9g mm, not %.9g mm: leave one of the two out.",
          1e3 * addendum, 1e3 * found, 1e3 * pair->tip_diameter[i]);
    pair->tip_diameter[i] = isnan(pair->tip_diameter[i]) ? found : pair->tip_diameter[i];
  }
  if (fabs(pair->tip_diameter[i] - usual) <= DERIVED * usual)
    pair->tip_diameter[i] = NAN;
  return EO_OK;
}

enum eo_code eo_gear_pair_settle(struct eo_gear_pair *pair, struct eo_error *error)
{
  struct eo_gear_pair settled = *pair;
  hold_digits(&settled);
  EO_TRY(settle_module(&settled, error));
  EO_TRY(settle_pressure_angle(&settled, error));
  EO_TRY(settle_widths(&settled, error));
  EO_TRY(settle_right_half(&settled, error));
  EO_TRY(settle_right_helix(&settled, error));
  EO_TRY(settle_shifts(&settled, error));
  if (isnan(tight_distance(&settled)))
    return eo_geometry_refuse_shifts(&settled, error);
  for (int i = 0; i < 2; i++)
    EO_TRY(settle_tip(&settled, i, error));
  for (int i = 0; i < 2; i++)
    if (!isnan(settled.entry.generating_shift[i]))
      settled.generating_offset[i] = as_coefficient(settled.entry.generating_shift[i] - settled.profile_shift[i]);
  settled.entry = (struct eo_gear_entry){NAN, NAN, NAN, NAN, NAN, NAN, {NAN, NAN}, {NAN, NAN}, {NAN, NAN}};
  *pair = settled;
  return EO_OK;
}

double eo_gear_pair_backlash(double centre_distance, double normal_module)
{
  return 2. / 3 * (0.06e-3 + 0.0005 * centre_distance + 0.03 * normal_module);
}
