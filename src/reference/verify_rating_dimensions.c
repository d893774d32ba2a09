/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of the kind "rating" that stand on drawings: geometry, thickness, backlash, tolerances. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "rating/backlash.h"
#include "rating/flank_tolerance.h"
#include "rating/thickness_allowance.h"
#include "rating/tooth_dimensions.h"
#include "reference/verify_rating.h"

static double degrees(double angle)
{
  return angle * 180 / M_PI;
}

/* A key with the member's number: d1_mm, d2_mm. */
static void check_of(struct eo_rating_row *row, const char *format, int member, double value)
{
  char key[40];
  snprintf(key, sizeof key, format, member + 1);
  eo_row_check(row, key, value);
}

static void check_member(struct eo_rating_row *row, const struct eo_rating_pair *pair,
                         const struct eo_rating_geometry *geometry, const struct eo_tooth *tooth, int i)
{
  check_of(row, "d%d_mm", i, 1e3 * geometry->reference_diameter[i]);
  check_of(row, "db%d_mm", i, 1e3 * geometry->base_diameter[i]);
  check_of(row, "dw%d_mm", i, 1e3 * geometry->working_diameter[i]);
  check_of(row, "da%d_mm", i, 1e3 * pair->tip_diameter[i]);
  check_of(row, "df%d_mm", i, 1e3 * eo_tooth_root_diameter(tooth));
  check_of(row, "dFf%d_mm", i, 1e3 * eo_tooth_form_diameter(tooth, NULL));
  check_of(row, "dNf%d_mm", i, 1e3 * eo_active_root_diameter(pair, geometry, i));
  check_of(row, "z_n%d", i, geometry->virtual_teeth[i]);
}

static struct eo_tooth tooth_of(struct eo_rating_row *row, const struct eo_rating_pair *pair, int member)
{
  return (struct eo_tooth){.teeth = pair->teeth[member],
                           .normal_module = pair->normal_module,
                           .normal_pressure_angle = pair->normal_pressure_angle,
                           .helix_angle = pair->helix_angle,
                           .dedendum_coefficient = eo_row_number_or(row, "dedendum_coefficient", NAN),
                           .fillet_radius_coefficient = eo_row_number_or(row, "root_radius_coefficient", NAN)};
}

enum eo_code eo_row_geometry(struct eo_rating_row *row, struct eo_error *error)
{
  struct eo_rating_pair pair;
  struct eo_rating_geometry geometry;
  struct eo_shift_split split;
  eo_row_pair(row, &pair);
  double addendum = eo_row_number(row, "addendum_coefficient"), shift[2] = {eo_row_number(row, "x1")};
  enum eo_code code = eo_case_faulty(row->inputs) ? EO_OK : eo_shift_split(&split, &pair, shift[0], error);
  if (code || eo_case_faulty(row->inputs))
    return code;
  shift[1] = split.gear_shift;
  for (int i = 0; i < 2; i++)
    pair.tip_diameter[i] = pair.normal_module * pair.teeth[i] / cos(pair.helix_angle) +
                           2 * ((addendum + shift[i]) * pair.normal_module + split.tip_alteration);
  code = eo_rating_geometry(&geometry, &pair, error);
  if (code)
    return code;
  for (int i = 0; i < 2; i++) {
    struct eo_tooth tooth = tooth_of(row, &pair, i);
    tooth.profile_shift = shift[i];
    check_member(row, &pair, &geometry, &tooth, i);
  }
  eo_row_check(row, "alpha_wt_deg", degrees(geometry.working_pressure_angle));
  eo_row_check(row, "alpha_t_deg", degrees(geometry.transverse_pressure_angle));
  eo_row_check(row, "beta_b_deg", degrees(geometry.base_helix_angle));
  eo_row_check(row, "x2", shift[1]);
  eo_row_check(row, "k_mn_mm", 1e3 * split.tip_alteration);
  eo_row_check(row, "g_alpha_mm", 1e3 * geometry.path_length);
  eo_row_check(row, "p_et_mm", 1e3 * geometry.transverse_base_pitch);
  eo_row_check(row, "eps_alpha", geometry.transverse_contact_ratio);
  eo_row_check(row, "eps_beta", geometry.overlap_ratio);
  eo_row_check(row, "eps_gamma", geometry.transverse_contact_ratio + geometry.overlap_ratio);
  eo_row_check(row, "T1T2_mm", 1e3 * pair.centre_distance * sin(geometry.working_pressure_angle));
  return EO_OK;
}

static void check_suffixed(struct eo_rating_row *row, const char *name, const char *suffix, const char *unit,
                           double value)
{
  char key[60];
  snprintf(key, sizeof key, "%s%s%s", name, suffix, unit);
  eo_row_check(row, key, value);
}

enum dimension {
  THICKNESS,
  TIP_THICKNESS,
  CHORD,
  CHORD_HEIGHT,
  SHIFT,
  ROOT,
  FORM,
  SPAN,
  OVER_ONE,
  OVER_TWO,
  OVER_PINS,
  SPAN_CONTACT,
  BALL_CONTACT,
  DIMENSIONS
};

static const struct {
  const char *name, *unit;
} dimension_names[DIMENSIONS] = {
    {"s_n", "_mm"},  {"s_an", "_mm"},           {"s_c", "_mm"},           {"h_c", "_mm"},  {"x_E", ""},
    {"d_f", "_mm"},  {"d_Ff", "_mm"},           {"W_k", "_mm"},           {"M_rK", "_mm"}, {"M_dK", "_mm"},
    {"M_dR", "_mm"}, {"d_span_contact", "_mm"}, {"d_ball_contact", "_mm"}};

/* What the row measures besides the tooth: over k teeth (0: none) and over a ball (NaN: none). */
struct means {
  int teeth_spanned;
  double ball;
};

/* Everything that is measured on one tooth, in mm and as coefficients. */
static enum eo_code measure(const struct eo_tooth *tooth, const struct means *means, double tip_diameter,
                            double value[DIMENSIONS], struct eo_error *error)
{
  struct eo_tooth_chord chord = eo_tooth_chord(tooth, tip_diameter);
  struct eo_ball_dimension ball = {NAN, NAN, NAN, NAN, NAN};
  int k = means->teeth_spanned;
  enum eo_code code = isnan(means->ball) ? EO_OK : eo_tooth_over_balls(tooth, means->ball, &ball, error);
  value[THICKNESS] = 1e3 * eo_tooth_normal_thickness(tooth);
  value[TIP_THICKNESS] = 1e3 * eo_tooth_normal_thickness_at(tooth, tip_diameter);
  value[CHORD] = 1e3 * chord.thickness;
  value[CHORD_HEIGHT] = 1e3 * chord.height;
  value[SHIFT] = eo_tooth_generating_shift(tooth);
  value[ROOT] = 1e3 * eo_tooth_root_diameter(tooth);
  value[FORM] = 1e3 * eo_tooth_form_diameter(tooth, NULL);
  value[SPAN] = k ? 1e3 * eo_tooth_span(tooth, k) : NAN;
  value[SPAN_CONTACT] = k ? 1e3 * eo_tooth_span_contact(tooth, k) : NAN;
  value[OVER_ONE] = 1e3 * ball.over_one;
  value[OVER_TWO] = 1e3 * ball.over_two;
  value[OVER_PINS] = 1e3 * ball.over_pins;
  value[BALL_CONTACT] = 1e3 * ball.contact_diameter;
  return code;
}

/* A profile shift of four decimals or more was computed and rounded; one of fewer was chosen and is exact. */
static double shift_rounding(double shift)
{
  const double finest_choice = 5.1e-5;
  double rounding = eo_verify_rounding(shift);
  return rounding < finest_choice ? rounding : 0;
}

/* Compares what a tooth measures; what half a unit in the last place of x moves counts as tolerance. */
static enum eo_code check_tooth(struct eo_rating_row *row, const struct eo_tooth *tooth, const struct means *means,
                                double tip_diameter, const char *suffix, struct eo_error *error)
{
  struct eo_tooth shifted = *tooth;
  double value[DIMENSIONS], moved[DIMENSIONS];
  shifted.profile_shift += shift_rounding(tooth->profile_shift);
  enum eo_code code = measure(tooth, means, tip_diameter, value, error);
  if (!code)
    code = measure(&shifted, means, tip_diameter, moved, error);
  for (int i = 0; i < DIMENSIONS && !code; i++) {
    char key[60];
    double rounding = fabs(moved[i] - value[i]);
    snprintf(key, sizeof key, "%s%s%s", dimension_names[i].name, suffix, dimension_names[i].unit);
    eo_row_check_rounded(row, key, value[i], isnan(rounding) ? 0 : rounding);
  }
  return code;
}

/* Both limits, and the middle between them. The thickest tooth goes with the smallest tip circle, as reports have it.
 */
static enum eo_code check_limits(struct eo_rating_row *row, const struct eo_tooth *nominal, const struct means *means,
                                 const double allowance[2], double tip, double smallest_tip, struct eo_error *error)
{
  static const char *const suffix[] = {"_e", "_i", "_mean"};
  const double values[] = {allowance[0], allowance[1], (allowance[0] + allowance[1]) / 2};
  double unthinned[DIMENSIONS], value[DIMENSIONS];
  enum eo_code code = measure(nominal, means, tip, unthinned, error);
  for (int i = 0; i < 3 && !code; i++) {
    struct eo_tooth tooth = *nominal;
    tooth.thickness_allowance = values[i];
    code = check_tooth(row, &tooth, means, i == 0 ? smallest_tip : tip, suffix[i], error);
    if (!code)
      code = measure(&tooth, means, tip, value, error);
    if (code)
      break;
    check_suffixed(row, "A_W", suffix[i], "_mm", value[SPAN] - unthinned[SPAN]);
    check_suffixed(row, "A_M", suffix[i], "_mm", value[OVER_TWO] - unthinned[OVER_TWO]);
  }
  return code;
}

/* x_E of teeth whose span was measured. */
static enum eo_code check_spans(struct eo_rating_row *row, const struct eo_rating_pair *pair)
{
  double span[2], spanned[2];
  eo_row_both(row, "span_mm", span);
  eo_row_both(row, "teeth_spanned", spanned);
  for (int i = 0; i < 2 && !eo_case_faulty(row->inputs); i++) {
    struct eo_tooth tooth = tooth_of(row, pair, i);
    tooth.thickness_allowance = eo_tooth_allowance_of_span(&tooth, (int)spanned[i], span[i] / 1e3);
    check_of(row, "x_E_%d", i, eo_tooth_generating_shift(&tooth));
  }
  return EO_OK;
}

enum eo_code eo_row_thickness(struct eo_rating_row *row, struct eo_error *error)
{
  enum { MOST_TEETH = 1000000 };
  struct eo_rating_pair pair;
  int member = eo_row_member(row);
  eo_row_pair(row, &pair);
  if (eo_row_has(row, "span_mm"))
    return check_spans(row, &pair);
  struct eo_tooth tooth = tooth_of(row, &pair, member);
  struct eo_case *allowance = eo_case_find(row->inputs, "A_sn_mm");
  struct means means = {.teeth_spanned = eo_case_whole_or(row->inputs, "teeth_spanned", 1, MOST_TEETH, 0),
                        .ball = eo_row_number_or(row, "ball_mm", NAN) / 1e3};
  bool limits = eo_case_is_list(allowance);
  double tip = pair.tip_diameter[member], shorter = eo_row_number_or(row, "tip_allowance_lower_mm", 0) / 1e3;
  tooth.profile_shift = eo_row_number(row, "x");
  tooth.thickness_allowance = allowance && !limits ? eo_case_real(allowance) / 1e3 : 0;
  const double values[2] = {limits ? eo_case_element(allowance, 0) / 1e3 : 0,
                            limits ? eo_case_element(allowance, 1) / 1e3 : 0};
  if (eo_case_faulty(row->inputs))
    return EO_OK;
  EO_TRY(check_tooth(row, &tooth, &means, tip, "", error));
  if (limits)
    EO_TRY(check_limits(row, &tooth, &means, values, tip, tip + shorter, error));
  return EO_OK;
}

enum eo_code eo_row_allowance(struct eo_rating_row *row, struct eo_error *error)
{
  struct eo_thickness_allowance found;
  const char *series = eo_case_word(row->inputs, "series");
  int tolerance = eo_case_whole(row->inputs, "tolerance", 0, 1000);
  double diameter = eo_row_number(row, "reference_diameter_mm") / 1e3;
  enum eo_code code = eo_case_faulty(row->inputs) ? EO_OK
                                                  : eo_thickness_allowance(&found, series, tolerance, diameter, error);
  if (code || eo_case_faulty(row->inputs))
    return code;
  eo_row_check(row, "A_sne_um", 1e6 * found.upper);
  eo_row_check(row, "A_sni_um", 1e6 * found.lower);
  return EO_OK;
}

static void check_backlash(struct eo_rating_row *row, const struct eo_backlash *backlash, const char *suffix)
{
  check_suffixed(row, "j_wt_", suffix, "_mm", 1e3 * backlash->circumferential);
  check_suffixed(row, "j_bn_", suffix, "_mm", 1e3 * backlash->normal);
  check_suffixed(row, "j_n_report_", suffix, "_mm", 1e3 * backlash->of_reference);
  check_suffixed(row, "j_r_", suffix, "_mm", 1e3 * backlash->radial);
  check_suffixed(row, "a_without_backlash_", suffix, "_mm", 1e3 * backlash->tight_distance);
}

/* e, i: upper and lower allowances at the nominal distance; min, max: with the distance's own limits. */
enum eo_code eo_row_backlash(struct eo_rating_row *row, struct eo_error *error)
{
  static const struct {
    const char *suffix;
    int limit;         /* of A_sn: 0 upper, 1 lower */
    double at_nominal; /* 0: with A_a */
  } places[] = {{"e", 0, 1}, {"i", 1, 1}, {"min", 0, 0}, {"max", 1, 0}};
  struct eo_rating_pair pair;
  double shift[2], distance[2];
  struct eo_case *allowances = eo_case_need(row->inputs, "A_sn_mm");
  eo_row_pair(row, &pair);
  eo_row_both(row, "x", shift);
  eo_row_both(row, "centre_distance_allowance_mm", distance);
  for (size_t i = 0; i < sizeof places / sizeof *places && !eo_case_faulty(row->inputs); i++) {
    struct eo_backlash_input in = {.teeth = {pair.teeth[0], pair.teeth[1]},
                                   .normal_module = pair.normal_module,
                                   .normal_pressure_angle = pair.normal_pressure_angle,
                                   .helix_angle = pair.helix_angle,
                                   .profile_shift = {shift[0], shift[1]},
                                   .centre_distance = pair.centre_distance};
    struct eo_backlash backlash;
    for (int k = 0; k < 2; k++)
      in.allowance[k] = eo_case_element(eo_case_at(allowances, k), places[i].limit) / 1e3;
    in.centre_distance_allowance = places[i].at_nominal != 0 ? 0 : distance[places[i].limit] / 1e3;
    enum eo_code code = eo_case_faulty(row->inputs) ? EO_OK : eo_backlash(&backlash, &in, error);
    if (code)
      return code;
    check_backlash(row, &backlash, places[i].suffix);
    if (places[i].at_nominal == 0 && places[i].limit == 1)
      eo_row_check(row, "j_wt_of_Aa_mm", 1e3 * backlash.of_distance);
  }
  return EO_OK;
}

static void check_tolerances(struct eo_rating_row *row, const struct eo_flank_tolerance *tolerance)
{
  const struct {
    const char *old, *new;
    double value;
  } all[] = {{"f_pt_um", "f_pT_um", tolerance->single_pitch},
             {"F_pk8_um", "F_pk8T_um", tolerance->cumulative_pitch},
             {"F_p_um", "F_pT_um", tolerance->total_pitch},
             {"F_alpha_um", "F_alphaT_um", tolerance->profile_total},
             {"f_falpha_um", "f_falphaT_um", tolerance->profile_form},
             {"f_Halpha_um", "f_HalphaT_um", tolerance->profile_slope},
             {"F_beta_um", "F_betaT_um", tolerance->helix_total},
             {"f_fbeta_um", "f_fbetaT_um", tolerance->helix_form},
             {"f_Hbeta_um", "f_HbetaT_um", tolerance->helix_slope},
             {"F_r_um", "F_rT_um", tolerance->runout},
             {"f_i_um", "f_isT_um", tolerance->tooth_composite},
             {"F_i_um", "F_isT_um", tolerance->total_composite}};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
    eo_row_check(row, all[i].old, 1e6 * all[i].value);
    eo_row_check(row, all[i].new, 1e6 * all[i].value);
  }
}

/* Tolerances that follow from others: base pitch, parallelism of the axes. */
static void check_derived(struct eo_rating_row *row, const struct eo_flank_tolerance *tolerance)
{
  if (eo_row_has(row, "alpha_t_deg")) {
    double pitch = tolerance ? tolerance->single_pitch : eo_row_number(row, "f_pt_um") / 1e6;
    eo_row_check(row, "f_pb_um", 1e6 * eo_base_pitch_tolerance(pitch, eo_row_angle(row, "alpha_t_deg", NAN)));
  }
  if (eo_row_has(row, "bearing_span_over_face_width")) {
    double helix = tolerance ? tolerance->helix_total : eo_row_number(row, "F_beta_um") / 1e6;
    struct eo_axis_tolerance axes = eo_axis_tolerance(helix, eo_row_number(row, "bearing_span_over_face_width"));
    eo_row_check(row, "f_Sigma_beta_um", 1e6 * axes.out_of_plane);
    eo_row_check(row, "f_Sigma_delta_um", 1e6 * axes.in_plane);
  }
}

enum eo_code eo_row_tolerances(struct eo_rating_row *row, struct eo_error *error)
{
  struct eo_flank_tolerance found;
  bool new = strstr(row->edition, "2013") != NULL;
  if (!eo_row_has(row, "reference_diameter_mm")) {
    check_derived(row, NULL);
    return EO_OK;
  }
  struct eo_tolerance_input in = {.reference_diameter = eo_row_number(row, "reference_diameter_mm") / 1e3,
                                  .normal_module = eo_row_number(row, "normal_module_mm") / 1e3,
                                  .face_width = eo_row_number(row, "face_width_mm") / 1e3,
                                  .teeth = eo_case_whole_or(row->inputs, "teeth", 1, 1000000, 0),
                                  .grade = eo_case_whole(row->inputs, new ? "tolerance_class" : "grade", 0, 20),
                                  .total_contact_ratio = eo_row_number_or(row, "eps_gamma", NAN)};
  enum eo_code code = eo_case_faulty(row->inputs)
                          ? EO_OK
                          : eo_flank_tolerance(&found, new ? EO_ISO1328_2013 : EO_ISO1328_1995, &in, error);
  if (code || eo_case_faulty(row->inputs))
    return code;
  check_tolerances(row, &found);
  check_derived(row, &found);
  return EO_OK;
}
