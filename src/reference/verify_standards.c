/* Kind "standards": worked numbers of standards and published reports. */
#include <math.h>
#include <string.h>

#include "reference/verify.h"
#include "reference/verify_foundation.h"
#include "contact/hertz.h"
#include "contact/iso6336.h"
#include "document/design_document.h"

static double radians(double degrees)
{
  return degrees * M_PI / 180;
}

/* NaN when the key is absent, else a check with the tolerance given, or with the rounding of the printed number when
   that is more. */
static void check_printed(struct eo_verification *v, const json_t *block, const char *label, const char *key,
                          double value, double relative)
{
  double expected = eo_verify_number(block, key);
  if (!isnan(expected))
    eo_verify_add(v, label, key, value, expected,
                  fmax(relative * fabs(expected), eo_verify_rounding(expected) * (1 + 1e-9)));
}

static void check_pair(struct eo_verification *v, const json_t *block, const char *label, const char *key,
                       const double value[2], double relative)
{
  for (int i = 0; i < 2; i++) {
    double expected = eo_verify_element(block, key, i);
    char quantity[80];
    snprintf(quantity, sizeof quantity, "%s %s", key, i ? "gear" : "pinion");
    if (!isnan(expected))
      eo_verify_add(v, label, quantity, value[i], expected,
                    fmax(relative * fabs(expected), eo_verify_rounding(expected) * (1 + 1e-9)));
  }
}

/* The gear pair that a block describes; profile shifts that it does not state are 0. */
static bool read_pair(const json_t *block, struct eo_gear_pair *pair, struct eo_verification *v, const char *label)
{
  memset(pair, 0, sizeof *pair);
  eo_table_defaults(&eo_gear_pair_table, pair);
  double helix = eo_verify_number(block, "beta_deg"), face = eo_verify_number(block, "b_mm"),
         angle = eo_verify_number(block, "alpha_n_deg");
  pair->ends = 1;
  pair->normal_module = eo_verify_number(block, "mn_mm") / 1e3;
  pair->normal_pressure_angle = radians(isnan(angle) ? 20 : angle);
  pair->helix_angle = radians(isnan(helix) ? 0 : helix);
  pair->face_width = (isnan(face) ? 1 : face) / 1e3;
  double teeth[2];
  for (int i = 0; i < 2; i++) {
    double shift = eo_verify_element(block, "x", i), dedendum = eo_verify_number(block, "h_fP");
    teeth[i] = eo_verify_element(block, "z", i);
    pair->teeth[i] = teeth[i] >= 1 && teeth[i] < 1e6 ? (int)teeth[i] : 0;
    pair->profile_shift[i] = isnan(shift) ? 0 : shift;
    pair->dedendum_coefficient = isnan(dedendum) ? pair->dedendum_coefficient : dedendum;
  }
  if (pair->teeth[0] > 0 && pair->teeth[1] > 0 && pair->normal_module > 0)
    return true;
  struct eo_error error;
  eo_error_set(&error, EO_ERROR_INPUT, "", "z and mn_mm are needed.");
  eo_verify_broken(v, label, &error);
  return false;
}

static void check_stiffness_row(struct eo_verification *v, const json_t *row)
{
  static const char *const known[] = {
      "name", "z",   "mn_mm",   "alpha_n_deg",   "beta_deg",     "x",        "eps_alpha", "b_mm", "a_mm",
      "h_fP", "C_R", "c_prime", "c_gamma_alpha", "c_gamma_beta", "n_E1_rpm", "tol_rel",   NULL};
  const char *name = json_string_value(json_object_get(row, "name"));
  struct eo_text label = {0};
  struct eo_gear_pair pair;
  eo_text_print(&label, "ISO 6336-1: %.60s", name ? name : "row");
  const char *where = label.data ? label.data : "ISO 6336-1";
  double blank = eo_verify_number(row, "C_R"), ratio = eo_verify_number(row, "eps_alpha"),
         tolerance = eo_verify_number(row, "tol_rel");
  if (read_pair(row, &pair, v, where)) {
    struct eo_iso_stiffness_input input = {
        .teeth = {pair.teeth[0], pair.teeth[1]},
        .virtual_teeth = EO_ISO_VIRTUAL_EXACT, /* as the case file's formula has it */
        .normal_pressure_angle = pair.normal_pressure_angle,
        .helix_angle = pair.helix_angle,
        .profile_shift = {pair.profile_shift[0], pair.profile_shift[1]},
        .dedendum_coefficient = pair.dedendum_coefficient,
        .transverse_contact_ratio = ratio,
        .blank_factor = isnan(blank) ? 1 : blank,
        .theory_factor = 0.8,
        .youngs_modulus = 206e9};
    struct eo_iso_stiffness found;
    eo_iso_stiffness(&found, &input);
    const double value[3] = {found.single, found.mesh_alpha, found.mesh_beta};
    for (int i = 0; i < 3; i++) {
      static const char *const key[3] = {"c_prime", "c_gamma_alpha", "c_gamma_beta"};
      double expected = eo_verify_number(row, key[i]);
      if (!isnan(expected))
        eo_verify_add(v, where, key[i], value[i] / 1e9, expected,
                      fabs(expected) * (isnan(tolerance) ? 1e-3 : tolerance));
    }
  }
  if (json_object_get(row, "n_E1_rpm"))
    eo_verify_ignore(v, "%s: n_E1_rpm needs the masses of the blanks, which the row does not give", where);
  eo_verify_unknown(v, where, row, known);
  eo_text_done(&label);
}

static void check_stiffness(struct eo_verification *v, const char *block_key, const json_t *block)
{
  static const char *const known[] = {"formula_source", "unit", "rows", "about", "source", "note", NULL};
  json_t *row;
  size_t i;
  json_array_foreach(json_object_get(block, "rows"), i, row) check_stiffness_row(v, row);
  eo_verify_unknown(v, block_key, block, known);
}

/* Worked macro-geometry from the centre distance: its profile shift sum and everything on the line of action. */
static void check_geometry(struct eo_verification *v, const char *label, const json_t *block)
{
  static const char *const known[] = {"z",         "mn_mm",    "alpha_n_deg", "beta_deg",     "b_mm",    "a_w_mm",
                                      "d_a_mm",    "x",        "h_fP",        "alpha_wt_deg", "sum_x",   "d_w_mm",
                                      "p_t_mm",    "p_bt_mm",  "T1T2_mm",     "g_alpha_mm",   "g_a1_mm", "g_a2_mm",
                                      "eps_alpha", "eps_beta", "source",      "note",         "about",   NULL};
  const double relative = 1e-9;
  struct eo_gear_pair pair;
  struct eo_geometry g;
  struct eo_error error;
  if (!read_pair(block, &pair, v, label))
    return;
  double distance = eo_verify_number(block, "a_w_mm") / 1e3;
  double transverse = atan(tan(pair.normal_pressure_angle) / cos(pair.helix_angle));
  double base_sum = pair.normal_module / cos(pair.helix_angle) * (pair.teeth[0] + pair.teeth[1]) / 2 * cos(transverse);
  double sum = eo_geometry_shift_sum(pair.teeth, pair.normal_pressure_angle, transverse, acos(base_sum / distance));
  if (!json_object_get(block, "x"))
    pair.profile_shift[EO_PINION] = sum; /* how it is split does not matter to anything below */
  for (int i = 0; i < 2; i++)
    pair.tip_diameter[i] = eo_verify_element(block, "d_a_mm", i) / 1e3;
  if (eo_geometry_init(&g, &pair, &error)) {
    eo_verify_broken(v, label, &error);
    return;
  }
  const double diameter[2] = {2e3 * g.working_radius[0], 2e3 * g.working_radius[1]};
  check_printed(v, block, label, "sum_x", sum, relative);
  check_printed(v, block, label, "a_w_mm", 1e3 * g.centre_distance, relative);
  check_printed(v, block, label, "alpha_wt_deg", g.working_pressure_angle * 180 / M_PI, relative);
  check_pair(v, block, label, "d_w_mm", diameter, relative);
  check_printed(v, block, label, "p_t_mm", 1e3 * M_PI * g.transverse_module, relative);
  check_printed(v, block, label, "p_bt_mm", 1e3 * g.transverse_base_pitch, relative);
  check_printed(v, block, label, "T1T2_mm", 1e3 * (g.tangent_length[0] + g.tangent_length[1]), relative);
  check_printed(v, block, label, "g_alpha_mm", 1e3 * (g.path_end - g.path_start), relative);
  check_printed(v, block, label, "g_a1_mm", 1e3 * g.path_end, relative);
  check_printed(v, block, label, "g_a2_mm", -1e3 * g.path_start, relative);
  check_printed(v, block, label, "eps_alpha", g.transverse_contact_ratio, relative);
  check_printed(v, block, label, "eps_beta", g.overlap_ratio, relative);
  eo_verify_unknown(v, label, block, known);
}

/* FZG test gears: the path of contact and the Hertz pressure at the pitch point. */
static void check_fzg(struct eo_verification *v, const char *label, const json_t *block)
{
  static const char *const known[] = {"z",
                                      "mn_mm",
                                      "alpha_n_deg",
                                      "beta_deg",
                                      "x",
                                      "a_mm",
                                      "b_mm",
                                      "p_b_mm",
                                      "r_b_mm",
                                      "r_a_mm",
                                      "eps_alpha",
                                      "T1T2_mm",
                                      "AB_mm",
                                      "AC_mm",
                                      "AD_mm",
                                      "AE_mm",
                                      "torque_Nm",
                                      "F_bt_N",
                                      "pitch_point_hertz_pressure_MPa",
                                      "pitch_point_half_width_um",
                                      "h_fP",
                                      "source",
                                      "note",
                                      NULL};
  struct eo_gear_pair pair;
  struct eo_geometry g;
  struct eo_material material;
  struct eo_error error;
  if (!read_pair(block, &pair, v, label))
    return;
  pair.centre_distance = eo_verify_number(block, "a_mm") / 1e3;
  for (int i = 0; i < 2; i++)
    pair.tip_diameter[i] = 2e-3 * eo_verify_element(block, "r_a_mm", i);
  if (eo_geometry_init(&g, &pair, &error)) {
    eo_verify_broken(v, label, &error);
    return;
  }
  eo_table_defaults(&eo_material_table, &material);
  const double base[2] = {1e3 * g.base_radius[0], 1e3 * g.base_radius[1]};
  double pitch = 1e3 * g.transverse_base_pitch, path = 1e3 * (g.path_end - g.path_start);
  double force = eo_verify_number(block, "torque_Nm") / g.base_radius[EO_PINION], line_load = force / g.face_width;
  double radius = eo_geometry_relative_radius(&g, 0);
  check_pair(v, block, label, "r_b_mm", base, 0);
  check_printed(v, block, label, "p_b_mm", pitch, 0);
  check_printed(v, block, label, "T1T2_mm", 1e3 * (g.tangent_length[0] + g.tangent_length[1]), 0);
  check_printed(v, block, label, "AB_mm", path - pitch, 0);
  check_printed(v, block, label, "AC_mm", -1e3 * g.path_start, 0);
  check_printed(v, block, label, "AD_mm", pitch, 0);
  check_printed(v, block, label, "AE_mm", path, 0);
  check_printed(v, block, label, "eps_alpha", g.transverse_contact_ratio, 0);
  check_printed(v, block, label, "F_bt_N", force, 0);
  check_printed(v, block, label, "pitch_point_hertz_pressure_MPa",
                eo_hertz_pressure(line_load, radius, material.youngs_modulus, material.poissons_ratio) / 1e6, 1e-4);
  /* Pressure and half width of the report contradict each other by 1.2e-4: p b = 2 F/(pi l) holds for any radius and
     modulus. */
  check_printed(v, block, label, "pitch_point_half_width_um",
                eo_hertz_half_width(line_load, radius, material.youngs_modulus, material.poissons_ratio) * 1e6, 2e-4);
  eo_verify_unknown(v, label, block, known);
}

static void check_distribution(struct eo_verification *v, const char *label, const json_t *block)
{
  static const char *const known[] = {"source",   "c_N_per_mm_um", "w_N_per_mm", "F_by_um",
                                      "K_H_beta", "note",          "about",      NULL};
  double stiffness = 1e9 * eo_verify_number(block, "c_N_per_mm_um"),
         line_load = 1e3 * eo_verify_number(block, "w_N_per_mm");
  size_t count = json_array_size(json_object_get(block, "F_by_um"));
  for (size_t i = 0; i < count; i++) {
    double misalignment = eo_verify_element(block, "F_by_um", (int)i),
           expected = eo_verify_element(block, "K_H_beta", (int)i), factor;
    char quantity[60];
    struct eo_error error;
    snprintf(quantity, sizeof quantity, "K_H_beta at F_by %.6g um", misalignment);
    if (eo_verify_load_distribution(stiffness, line_load, misalignment / 1e6, &factor, &error))
      eo_verify_broken(v, label, &error);
    else
      eo_verify_add(v, label, quantity, factor, expected, 1e-4 * fabs(expected));
  }
  eo_verify_unknown(v, label, block, known);
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
  enum eo_code code = eo_geometry_init(geometry, &pair, error);
  if (code || helix > 0)
    return code;
  for (int i = 0; i < 2; i++)
    pair.tip_diameter[i] = 2 * hypot(geometry->base_radius[i],
                                     geometry->tangent_length[i] + geometry->transverse_base_pitch);
  return eo_geometry_init(geometry, &pair, error);
}

static void check_overlap(struct eo_verification *v, const char *label)
{
  static const struct {
    const char *what;
    double helix_deg;
    int overlap;
  } cases[] = {{"eps_beta = 1", 24, 1}, {"eps_beta = 2", 15, 2}, {"eps_alpha = 2, spur", 0, 0}};
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    struct eo_geometry geometry;
    struct eo_error error;
    double peak_to_peak, variation;
    char quantity[80];
    if (overlap_geometry(&geometry, radians(cases[i].helix_deg), cases[i].overlap, &error) ||
        eo_verify_overlap(&geometry, &peak_to_peak, &variation, &error)) {
      eo_verify_broken(v, label, &error);
      continue;
    }
    snprintf(quantity, sizeof quantity, "peak-to-peak LTE, um, %s", cases[i].what);
    eo_verify_add(v, label, quantity, 1e6 * peak_to_peak, 0, 1e-6);
    snprintf(quantity, sizeof quantity, "variation of the contact length, %s", cases[i].what);
    eo_verify_add(v, label, quantity, variation, 0, 1e-12);
  }
}

static bool begins(const char *text, const char *prefix)
{
  return strncmp(text, prefix, strlen(prefix)) == 0;
}

enum eo_code eo_verify_standards(const json_t *cases, struct eo_verification *v, struct eo_error *error)
{
  const char *key;
  json_t *block;
  (void)error;
  json_object_foreach((json_t *)cases, key, block)
  {
    if (begins(key, "iso_6336_1_stiffness"))
      check_stiffness(v, key, block);
    else if (begins(key, "iso_tr_6336_30"))
      check_geometry(v, key, block);
    else if (begins(key, "fzg"))
      check_fzg(v, key, block);
    else if (begins(key, "load_distribution"))
      check_distribution(v, key, block);
    else if (begins(key, "integer_overlap"))
      check_overlap(v, key);
    else if (begins(key, "paper"))
      eo_verify_ignore(
          v, "%s: printed levels of the paper, for information; its absolute values depend on data it does not give",
          key);
    else if (strcmp(key, "kind") && strcmp(key, "about"))
      eo_verify_ignore(v, "\"%s\" is not a block of this kind", key);
  }
  return EO_OK;
}
