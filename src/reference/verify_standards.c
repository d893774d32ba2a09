/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Kind "standards": worked numbers of standards and published reports. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "contact/hertz.h"
#include "contact/iso6336.h"
#include "document/design_document.h"
#include "gear/entry.h"
#include "reference/verify.h"
#include "reference/verify_foundation.h"

static double radians(double degrees)
{
  return degrees * M_PI / 180;
}

/* With the tolerance given, or with the rounding of the printed number when that is more. How a 0 was rounded cannot be
   seen. */
static void check_printed(struct eo_verification *verification, struct eo_case *expected, double value, double relative)
{
  const double of_zero = 1e-9;
  double wanted = eo_case_real(expected);
  if (expected)
    eo_verify_number(verification, expected, value, relative,
                     wanted == 0 ? of_zero : eo_verify_rounding(wanted) * (1 + of_zero));
}

static void check_key(struct eo_verification *verification, struct eo_case *block, const char *key, double value,
                      double relative)
{
  check_printed(verification, eo_case_find(block, key), value, relative);
}

static void check_both(struct eo_verification *verification, struct eo_case *block, const char *key,
                       const double value[2], double relative)
{
  struct eo_case *list = eo_case_find(block, key);
  if (list)
    eo_verify_size(verification, list, 2);
  for (int i = 0; i < eo_case_size(list) && i < 2; i++)
    check_printed(verification, eo_case_at(list, i), value[i], relative);
}

/* The gear pair that a block describes; profile shifts that it does not state are 0. */
static void read_pair(struct eo_case *block, struct eo_gear_pair *pair)
{
  enum { MOST_TEETH = 1000000 };
  struct eo_case *this_case = eo_case_need(block, "z"), *the_case = eo_case_find(block, "x");
  memset(pair, 0, sizeof *pair);
  eo_table_defaults(&eo_gear_pair_table, pair);
  pair->ends = 1;
  pair->tip_alteration = 0;
  pair->addendum_coefficient = 1;
  pair->dedendum_coefficient = 1.25;
  pair->fillet_radius_coefficient = 0.38;
  pair->normal_module = eo_case_number(block, "mn_mm") / 1e3;
  pair->normal_pressure_angle = radians(eo_case_number_or(block, "alpha_n_deg", 20));
  pair->helix_angle = radians(eo_case_number_or(block, "beta_deg", 0));
  pair->face_width = eo_case_number_or(block, "b_mm", 1) / 1e3;
  pair->dedendum_coefficient = eo_case_number_or(block, "h_fP", pair->dedendum_coefficient);
  for (int i = 0; i < 2; i++) {
    double teeth = eo_case_element(this_case, i);
    bool whole = teeth >= 1 && teeth < MOST_TEETH && teeth == floor(teeth);
    pair->teeth[i] = whole ? (int)teeth : 1;
    pair->profile_shift[i] = the_case ? eo_case_element(the_case, i) : 0;
    if (!whole && !isnan(teeth))
      eo_case_fault(this_case, "Numbers of teeth are whole, from 1.");
  }
  if (pair->normal_module <= 0)
    eo_case_fault(eo_case_find(block, "mn_mm"), "A number above 0 is expected here.");
}

static enum eo_code check_stiffness_row(void *context, struct eo_case *row, struct eo_error *error)
{
  struct eo_verification *verification = context;
  struct eo_gear_pair pair;
  struct eo_iso_stiffness found;
  double tolerance = eo_case_relative_or(row, "tol_rel", 1e-3);
  (void)error;
  read_pair(row, &pair);
  struct eo_iso_stiffness_input input = {.teeth = {pair.teeth[0], pair.teeth[1]},
                                         .virtual_teeth = EO_ISO_VIRTUAL_EXACT, /* as the case file's formula has it */
                                         .normal_pressure_angle = pair.normal_pressure_angle,
                                         .helix_angle = pair.helix_angle,
                                         .profile_shift = {pair.profile_shift[0], pair.profile_shift[1]},
                                         .dedendum_coefficient = pair.dedendum_coefficient,
                                         .transverse_contact_ratio = eo_case_number(row, "eps_alpha"),
                                         .blank_factor = eo_case_number_or(row, "C_R", 1),
                                         .theory_factor = 0.8,
                                         .youngs_modulus = 206e9};
  if (eo_case_faulty(row))
    return EO_OK;
  eo_iso_stiffness(&found, &input);
  eo_verify_member(verification, row, "c_prime", found.single / 1e9, tolerance, 0);
  eo_verify_member(verification, row, "c_gamma_alpha", found.mesh_alpha / 1e9, tolerance, 0);
  eo_verify_member(verification, row, "c_gamma_beta", found.mesh_beta / 1e9, tolerance, 0);
  eo_case_number_or(row, "a_mm", NAN); /* the stiffness does not depend on it */
  eo_case_number_or(row, "n_E1_rpm", NAN);
  eo_verify_uncompared(verification, eo_case_find(row, "n_E1_rpm"),
                       "it needs the masses of the blanks, which the row lacks.");
  return EO_OK;
}

static enum eo_code check_stiffness(void *context, struct eo_case *block, struct eo_error *error)
{
  eo_case_remark(block, "formula_source");
  eo_case_remark(block, "unit");
  return eo_verify_each(context, eo_case_need(block, "rows"), check_stiffness_row, context, error);
}

/* Worked macro-geometry from the centre distance: its profile shift sum and everything on the line of action. */
static enum eo_code check_geometry(void *context, struct eo_case *block, struct eo_error *error)
{
  struct eo_verification *verification = context;
  const double relative = 1e-9;
  struct eo_gear_pair pair;
  struct eo_geometry geometry;
  read_pair(block, &pair);
  struct eo_case *tips = eo_case_need(block, "d_a_mm");
  double distance = eo_case_number(block, "a_w_mm") / 1e3;
  double transverse = atan(tan(pair.normal_pressure_angle) / cos(pair.helix_angle));
  double base_sum = pair.normal_module / cos(pair.helix_angle) * (pair.teeth[0] + pair.teeth[1]) / 2 * cos(transverse);
  double sum = eo_geometry_shift_sum(pair.teeth, pair.normal_pressure_angle, transverse, acos(base_sum / distance));
  if (!eo_case_find(block, "x"))
    pair.profile_shift[EO_PINION] = sum; /* how it is split does not matter to anything below */
  for (int i = 0; i < 2; i++)
    pair.tip_diameter[i] = eo_case_element(tips, i) / 1e3;
  enum eo_code code = eo_case_faulty(block) ? EO_OK : eo_geometry_init(&geometry, &pair, error);
  if (code || eo_case_faulty(block))
    return code;
  const double diameter[2] = {2e3 * geometry.working_radius[0], 2e3 * geometry.working_radius[1]};
  check_key(verification, block, "sum_x", sum, relative);
  check_key(verification, block, "a_w_mm", 1e3 * geometry.centre_distance, relative);
  check_key(verification, block, "alpha_wt_deg", geometry.working_pressure_angle * 180 / M_PI, relative);
  check_both(verification, block, "d_w_mm", diameter, relative);
  check_key(verification, block, "p_t_mm", 1e3 * M_PI * geometry.transverse_module, relative);
  check_key(verification, block, "p_bt_mm", 1e3 * geometry.transverse_base_pitch, relative);
  check_key(verification, block, "T1T2_mm", 1e3 * (geometry.tangent_length[0] + geometry.tangent_length[1]), relative);
  check_key(verification, block, "g_alpha_mm", 1e3 * (geometry.path_end - geometry.path_start), relative);
  check_key(verification, block, "g_a1_mm", 1e3 * geometry.path_end, relative);
  check_key(verification, block, "g_a2_mm", -1e3 * geometry.path_start, relative);
  check_key(verification, block, "eps_alpha", geometry.transverse_contact_ratio, relative);
  check_key(verification, block, "eps_beta", geometry.overlap_ratio, relative);
  return EO_OK;
}

/* Mesh force and Hertz pressure at the pitch point. */
static void check_pitch_point(struct eo_verification *verification, struct eo_case *block,
                              const struct eo_geometry *geometry)
{
  struct eo_material material;
  eo_table_defaults(&eo_material_table, &material);
  double force = eo_case_number(block, "torque_Nm") / geometry->base_radius[EO_PINION],
         line_load = force / geometry->face_width;
  double radius = eo_geometry_relative_radius(geometry, 0);
  double pressure = eo_hertz_pressure(line_load, radius, material.youngs_modulus, material.poissons_ratio),
         half_width = eo_hertz_half_width(line_load, radius, material.youngs_modulus, material.poissons_ratio);
  check_key(verification, block, "F_bt_N", force, 0);
  check_key(verification, block, "pitch_point_hertz_pressure_MPa", pressure / 1e6, 1e-4);
  /* Pressure and half width of the report contradict each other by 1.2e-4: p b = 2 F/(pi l) holds for any radius and
     modulus. */
  check_key(verification, block, "pitch_point_half_width_um", half_width * 1e6, 2e-4);
}

/* FZG test gears: the path of contact and the Hertz pressure at the pitch point. */
static enum eo_code check_fzg(void *context, struct eo_case *block, struct eo_error *error)
{
  struct eo_verification *verification = context;
  struct eo_gear_pair pair;
  struct eo_geometry geometry;
  struct eo_case *tips = eo_case_need(block, "r_a_mm");
  read_pair(block, &pair);
  pair.centre_distance = eo_case_number(block, "a_mm") / 1e3;
  for (int i = 0; i < 2; i++)
    pair.tip_diameter[i] = 2e-3 * eo_case_element(tips, i);
  enum eo_code code = eo_case_faulty(block) ? EO_OK : eo_geometry_init(&geometry, &pair, error);
  if (code || eo_case_faulty(block))
    return code;
  const double base[2] = {1e3 * geometry.base_radius[0], 1e3 * geometry.base_radius[1]};
  double pitch = 1e3 * geometry.transverse_base_pitch, path = 1e3 * (geometry.path_end - geometry.path_start);
  check_both(verification, block, "r_b_mm", base, 0);
  check_key(verification, block, "p_b_mm", pitch, 0);
  check_key(verification, block, "T1T2_mm", 1e3 * (geometry.tangent_length[0] + geometry.tangent_length[1]), 0);
  check_key(verification, block, "AB_mm", path - pitch, 0);
  check_key(verification, block, "AC_mm", -1e3 * geometry.path_start, 0);
  check_key(verification, block, "AD_mm", pitch, 0);
  check_key(verification, block, "AE_mm", path, 0);
  check_key(verification, block, "eps_alpha", geometry.transverse_contact_ratio, 0);
  if (eo_case_find(block, "torque_Nm"))
    check_pitch_point(verification, block, &geometry);
  return EO_OK;
}

static enum eo_code check_distribution(void *context, struct eo_case *block, struct eo_error *error)
{
  struct eo_verification *verification = context;
  const double relative = 1e-4;
  double stiffness = 1e9 * eo_case_number(block, "c_N_per_mm_um"),
         line_load = 1e3 * eo_case_number(block, "w_N_per_mm");
  struct eo_case *list = eo_case_need(block, "F_by_um"), *expected = eo_case_need(block, "K_H_beta");
  enum eo_code code = EO_OK;
  eo_verify_size(verification, expected, eo_case_size(list));
  for (int i = 0; i < eo_case_size(list) && !code; i++) {
    double misalignment = eo_case_element(list, i) / 1e6, factor;
    if (eo_case_faulty(block))
      break;
    code = eo_verify_load_distribution(stiffness, line_load, misalignment, &factor, error);
    if (!code)
      eo_verify_number(verification, eo_case_at(expected, i), factor, relative, 0);
  }
  return code;
}

/* A pair with eps_beta whole (axial pitches in the face), or a spur pair whose tips reach one base pitch to either
   side. */
static enum eo_code overlap_geometry(struct eo_geometry *geometry, double helix, int overlap, struct eo_error *error)
{
  struct eo_gear_pair pair;
  memset(&pair, 0, sizeof pair);
  eo_table_defaults(&eo_gear_pair_table, &pair);
  pair.ends = 1;
  pair.teeth[0] = pair.teeth[1] = 60;
  pair.normal_module = 3e-3;
  pair.helix_angle = helix;
  pair.face_width = helix > 0 ? overlap * M_PI * pair.normal_module / sin(helix) : 0.03;
  pair.dedendum_coefficient = 1.4;
  enum eo_code code = eo_gear_pair_settle(&pair, error);
  if (!code)
    code = eo_geometry_init(geometry, &pair, error);
  if (code || helix > 0)
    return code;
  for (int i = 0; i < 2; i++)
    pair.tip_diameter[i] = 2 * hypot(geometry->base_radius[i],
                                     geometry->tangent_length[i] + geometry->transverse_base_pitch);
  return eo_geometry_init(geometry, &pair, error);
}

/* The block is a statement in words: the contact length is constant, the loaded transmission error has no ripple. */
static enum eo_code check_overlap(void *context, struct eo_case *block, struct eo_error *error)
{
  static const struct {
    const char *what;
    double helix_deg;
    int overlap;
  } cases[] = {{"eps_beta = 1", 24, 1}, {"eps_beta = 2", 15, 2}, {"eps_alpha = 2, spur", 0, 0}};
  struct eo_verification *verification = context;
  enum eo_code code = EO_OK;
  if (!eo_case_text(block))
    return EO_OK;
  for (size_t i = 0; i < sizeof cases / sizeof cases[0] && !code; i++) {
    struct eo_geometry geometry;
    double peak_to_peak, variation;
    char quantity[80];
    code = overlap_geometry(&geometry, radians(cases[i].helix_deg), cases[i].overlap, error);
    if (!code)
      code = eo_verify_overlap(&geometry, &peak_to_peak, &variation, error);
    if (code)
      break;
    snprintf(quantity, sizeof quantity, "peak-to-peak LTE, um, %s", cases[i].what);
    eo_verify_derived(verification, block, quantity, 1e6 * peak_to_peak, 0, 1e-6);
    snprintf(quantity, sizeof quantity, "variation of the contact length, %s", cases[i].what);
    eo_verify_derived(verification, block, quantity, variation, 0, 1e-12);
  }
  return code;
}

static enum eo_code note_paper(void *context, struct eo_case *block, struct eo_error *error)
{
  (void)error;
  eo_case_skip(block);
  eo_verify_note(context, "/paper is not compared: printed levels for information, which depend on data the paper does "
                          "not give.");
  return EO_OK;
}

static const struct eo_verify_block blocks[] = {
    {"iso_6336_1_stiffness*", EO_BLOCK_WHOLE, check_stiffness},
    {"iso_tr_6336_30*", EO_BLOCK_WHOLE, check_geometry},
    {"fzg*", EO_BLOCK_WHOLE, check_fzg},
    {"load_distribution*", EO_BLOCK_WHOLE, check_distribution},
    {"integer_overlap*", EO_BLOCK_WHOLE, check_overlap},
    {"paper", EO_BLOCK_EITHER, note_paper},
    {NULL, EO_BLOCK_INPUT, NULL},
};

enum eo_code eo_verify_standards(struct eo_case *file, struct eo_verification *verification, struct eo_error *error)
{
  return eo_verify_blocks(verification, file, blocks, verification, error);
}
