/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of the kind "rating" with the general factors of ISO 6336-1. */
#include <math.h>

#include "contact/iso6336.h"
#include "rating/load_factors.h"
#include "reference/verify_rating.h"

static const double steel_modulus = 206e9;

/* Mean over both members of a rack that may differ. */
static double mean_of(struct eo_rating_row *row, const char *key, double missing)
{
  double both[2] = {missing, missing};
  if (eo_row_has(row, key))
    eo_row_both(row, key, both);
  return (both[0] + both[1]) / 2;
}

/* eps_alpha as stated, or that of full teeth (h_aP = 1) shortened so that the clearance stays. */
static enum eo_code contact_ratio(struct eo_rating_row *row, struct eo_rating_pair *pair, const double shift[2],
                                  double *ratio, struct eo_error *error)
{
  struct eo_shift_split split;
  struct eo_rating_geometry geometry;
  *ratio = eo_row_number_or(row, "eps_alpha", NAN);
  if (!isnan(*ratio) || eo_case_faulty(row->inputs))
    return EO_OK;
  enum eo_code code = eo_shift_split(&split, pair, shift[0], error);
  if (code)
    return code;
  for (int i = 0; i < 2; i++)
    pair->tip_diameter[i] = pair->normal_module * pair->teeth[i] / cos(pair->helix_angle) +
                            2 * ((1 + shift[i]) * pair->normal_module + split.tip_alteration);
  code = eo_rating_geometry(&geometry, pair, error);
  if (!code)
    *ratio = geometry.transverse_contact_ratio;
  return code;
}

enum eo_code eo_row_stiffness(struct eo_rating_row *row, struct eo_error *error)
{
  static const char *const unused[] = {"centre_distance_mm", "face_width_mm", "tip_diameter_mm", NULL};
  struct eo_rating_pair pair;
  struct eo_iso_stiffness found;
  double shift[2], eps_alpha;
  eo_row_pair(row, &pair);
  eo_row_both(row, "x", shift);
  eo_row_unused(row, unused);
  enum eo_code code = contact_ratio(row, &pair, shift, &eps_alpha, error);
  if (code)
    return code;
  bool web = eo_row_has(row, "web_ratio");
  double blank = web ? eo_iso_blank_factor(eo_row_number(row, "web_ratio"), eo_row_number(row, "rim_over_module"))
                     : eo_row_number_or(row, "C_R", 1);
  struct eo_iso_stiffness_input in = {
      .teeth = {pair.teeth[0], pair.teeth[1]},
      .virtual_teeth = EO_ISO_VIRTUAL_EXACT,
      .normal_pressure_angle = pair.normal_pressure_angle,
      .helix_angle = pair.helix_angle,
      .profile_shift = {shift[0], shift[1]},
      .dedendum_coefficient = mean_of(row, "dedendum_coefficient", 1.25), /* C_B: mean of unlike racks */
      .transverse_contact_ratio = eps_alpha,
      .blank_factor = blank,
      .theory_factor = 0.8,
      .youngs_modulus = 1e6 * eo_row_number_or(row, "youngs_modulus_MPa", steel_modulus / 1e6)};
  double mass = eo_row_number_or(row, "reduced_mass_kg_per_mm", NAN) * 1e3;
  if (eo_case_faulty(row->inputs))
    return EO_OK;
  eo_iso_stiffness(&found, &in);
  eo_row_check(row, "C_R", blank);
  eo_row_check(row, "C_B", found.rack_factor);
  eo_row_check(row, "c_th", found.theoretical / 1e9);
  eo_row_check(row, "c_single", found.single / 1e9);
  eo_row_check(row, "c_gamma_alpha", found.mesh_alpha / 1e9);
  eo_row_check(row, "c_gamma_beta", found.mesh_beta / 1e9);
  eo_row_check(row, "n_E1_rpm", 60 * eo_resonance_speed(pair.teeth[0], found.mesh_alpha, mass));
  return EO_OK;
}

enum eo_code eo_row_mass(struct eo_rating_row *row, struct eo_error *error)
{
  static const char *const unused[] = {"normal_module_mm", "normal_pressure_angle_deg", "helix_angle_deg",
                                       "face_width_mm", NULL};
  double teeth[2], tip[2], root[2], base[2], bore[2], density[2];
  struct eo_wheel_blank blank[2];
  (void)error;
  eo_row_unused(row, unused);
  eo_row_both(row, "teeth", teeth);
  eo_row_both(row, "tip_diameter_mm", tip);
  eo_row_both(row, "root_diameter_mm", root);
  eo_row_both(row, "base_diameter_mm", base);
  eo_row_both(row, "bore_mm", bore);
  eo_row_both(row, "density_kg_per_mm3", density);
  for (int i = 0; i < 2; i++)
    blank[i] = (struct eo_wheel_blank){.tip_diameter = tip[i] / 1e3,
                                       .root_diameter = root[i] / 1e3,
                                       .base_diameter = base[i] / 1e3,
                                       .bore = bore[i] / 1e3,
                                       .density = density[i] * 1e9};
  if (!eo_case_faulty(row->inputs))
    eo_row_check(row, "reduced_mass_kg_per_mm", eo_reduced_mass(blank, teeth[1] / teeth[0]) / 1e3);
  return EO_OK;
}

/* N as given, or the speed over that of resonance. */
static double resonance_ratio(struct eo_rating_row *row)
{
  if (eo_row_has(row, "resonance_ratio_N"))
    return eo_row_number(row, "resonance_ratio_N");
  return eo_row_number(row, "speed_rpm") / eo_row_number(row, "n_E1_rpm");
}

/* C_a as given, or what running in leaves: the mean of both members. */
static double tip_relief(struct eo_rating_row *row)
{
  double limit[2];
  if (!eo_row_has(row, "sigma_Hlim_MPa"))
    return eo_row_number(row, "tip_relief_um") / 1e6;
  eo_row_both(row, "sigma_Hlim_MPa", limit);
  double relief = (eo_running_in_relief(1e6 * limit[0]) + eo_running_in_relief(1e6 * limit[1])) / 2;
  eo_row_check(row, "C_ay_um", 1e6 * relief);
  return eo_row_has(row, "tip_relief_um") ? eo_row_number(row, "tip_relief_um") / 1e6 : relief;
}

enum eo_code eo_row_dynamic(struct eo_rating_row *row, struct eo_error *error)
{
  enum { COARSEST = 12 };
  struct eo_dynamic_factor found;
  double relief = tip_relief(row);
  if (!eo_case_find(row->expected, "K_V"))
    return EO_OK;
  struct eo_dynamic_input in = {.resonance_ratio = resonance_ratio(row),
                                .total_contact_ratio = eo_row_number(row, "eps_gamma"),
                                .single_stiffness = 1e9 * eo_row_number(row, "c_single"),
                                .line_load = 1e3 * eo_row_number(row, "load_N_per_mm"),
                                .pitch_deviation = eo_row_number(row, "f_pb_um") / 1e6,
                                .profile_deviation = eo_row_number(row, "f_falpha_um") / 1e6,
                                .pitch_running_in = eo_row_number(row, "y_p_um") / 1e6,
                                .profile_running_in = eo_row_number(row, "y_f_um") / 1e6,
                                .tip_relief = relief,
                                .grade = eo_case_whole(row->inputs, "accuracy_grade", 0, COARSEST)};
  enum eo_code code = eo_case_faulty(row->inputs) ? EO_OK : eo_dynamic_factor(&found, &in, error);
  if (!code && !eo_case_faulty(row->inputs))
    eo_row_check(row, "K_V", found.factor);
  return code;
}

enum eo_code eo_row_transverse(struct eo_rating_row *row, struct eo_error *error)
{
  (void)error;
  struct eo_transverse_input in = {.transverse_contact_ratio = eo_row_number(row, "eps_alpha"),
                                   .total_contact_ratio = eo_row_number(row, "eps_gamma"),
                                   .contact_ratio_factor = eo_row_number(row, "Z_eps"),
                                   .mesh_stiffness = 1e9 * eo_row_number(row, "c_gamma_alpha"),
                                   .pitch_deviation = eo_row_number(row, "f_pb_um") / 1e6,
                                   .profile_deviation = eo_row_number(row, "f_falpha_um") / 1e6,
                                   .running_in = eo_row_number(row, "y_alpha_um") / 1e6,
                                   .line_load = 1e3 * eo_row_number(row, "load_KA_KV_KHb_N_per_mm")};
  struct eo_transverse_factor found = eo_transverse_factor(&in);
  eo_row_check(row, "K_Halpha", found.flank);
  eo_row_check(row, "K_Falpha", found.root);
  return EO_OK;
}

enum eo_code eo_row_root_face(struct eo_rating_row *row, struct eo_error *error)
{
  double width[2], depth[2];
  (void)error;
  eo_row_both(row, "face_width_mm", width);
  eo_row_both(row, "tooth_depth_mm", depth);
  double smaller = fmin(width[0] / depth[0], width[1] / depth[1]);
  eo_row_check(row, "K_Fbeta", eo_root_face_factor(eo_row_number(row, "K_Hbeta"), smaller));
  return EO_OK;
}

/* f_Hbeta alone gives f_ma and the least F_beta_x; f_sh and f_ma the factor. */
enum eo_code eo_row_face(struct eo_rating_row *row, struct eo_error *error)
{
  double least = 0, load = 1e3 * eo_row_number_or(row, "mean_load_N_per_mm", NAN);
  (void)error;
  if (eo_row_has(row, "f_Hbeta_um")) {
    double slope[2];
    eo_row_both(row, "f_Hbeta_um", slope);
    eo_row_check(row, "f_ma_um", 1e6 * eo_mesh_deviation(slope[0] / 1e6, slope[1] / 1e6));
    least = isnan(load) ? 0 : eo_least_deviation(load, fmax(slope[0], slope[1]) / 1e6);
    eo_row_check(row, "F_beta_x_min_um", 1e6 * least);
  }
  if (!eo_row_has(row, "f_sh_um"))
    return EO_OK;
  double deviation = eo_helix_deviation(eo_row_number(row, "f_sh_um") / 1e6, eo_row_number(row, "f_ma_um") / 1e6,
                                        eo_row_number_or(row, "B1", 1), eo_row_number_or(row, "B2", 1), least);
  double running_in = eo_row_number(row, "y_beta_factor") * deviation;
  double factor = eo_face_load_factor(deviation - running_in, 1e9 * eo_row_number(row, "c_gamma_beta"), load);
  eo_row_check(row, "F_beta_x_um", 1e6 * deviation);
  eo_row_check(row, "y_beta_um", 1e6 * running_in);
  eo_row_check(row, "K_Hbeta", factor);
  return EO_OK;
}
