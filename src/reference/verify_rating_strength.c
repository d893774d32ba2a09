/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of the kind "rating" with stresses, permissible stresses, life and materials (ISO 6336-2, -3, -5, -6). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "rating/root_rating.h"
#include "reference/verify_rating.h"

static const double steel_modulus_mpa = 206000;

static enum eo_rating_edition edition_of(const struct eo_rating_row *row)
{
  if (strncmp(row->edition, "DIN 3990", strlen("DIN 3990")) == 0)
    return EO_DIN3990;
  return strstr(row->edition, "2019") ? EO_ISO6336_2019 : EO_ISO6336_2006;
}

static const struct {
  const char *name;
  enum eo_rating_material material;
} materials[] = {
    {"case hardened", EO_CASE_HARDENED},
    {"flame, induction hardened", EO_FLAME_HARDENED},
    {"through hardened", EO_THROUGH_HARDENED_ALLOY},
    {"through hardened alloy", EO_THROUGH_HARDENED_ALLOY},
    {"through hardened carbon", EO_THROUGH_HARDENED_CARBON},
    {"structural", EO_STRUCTURAL},
    {"nitriding steel, nitrided", EO_NITRIDED_NITRIDING_STEEL},
    {"through hardening steel, nitrided", EO_NITRIDED_THROUGH_STEEL},
    {"nitrocarburised", EO_NITROCARBURISED},
};

/* False with a fault where the row names none that is known; absent: case hardened steel. */
static bool read_material(struct eo_rating_row *row, enum eo_rating_material *material)
{
  struct eo_case *value = eo_case_find(row->inputs, "material");
  const char *name = value ? eo_case_text(value) : "case hardened";
  for (size_t i = 0; name && i < sizeof materials / sizeof *materials; i++)
    if (strcmp(name, materials[i].name) == 0) {
      *material = materials[i].material;
      return true;
    }
  if (name)
    eo_case_fault(value, "\"%.60s\" is not a material that is known here.", name);
  return false;
}

enum eo_code eo_row_contact(struct eo_rating_row *row, struct eo_error *error)
{
  static const char *const factors[] = {"K_A", "K_gamma", "K_V", "K_Hbeta", "K_Halpha"};
  static const char *const unused[] = {"x", NULL};
  struct eo_rating_pair pair;
  struct eo_rating_geometry geometry;
  struct eo_contact_stress found;
  double modulus[2] = {steel_modulus_mpa, steel_modulus_mpa}, ratio[2] = {0.3, 0.3};
  eo_row_pair(row, &pair);
  eo_row_unused(row, unused);
  if (eo_row_has(row, "youngs_modulus_MPa"))
    eo_row_both(row, "youngs_modulus_MPa", modulus);
  if (eo_row_has(row, "poissons_ratio"))
    eo_row_both(row, "poissons_ratio", ratio);
  struct eo_contact_input in = {.edition = edition_of(row),
                                .proof = EO_PROOF_NONE,
                                .tangential_force = eo_row_number_or(row, "F_t_N", NAN),
                                .load_factor = 1,
                                .elastic = {{1e6 * modulus[0], 1e6 * modulus[1]}, {ratio[0], ratio[1]}}};
  for (size_t i = 0; i < sizeof factors / sizeof *factors; i++)
    in.load_factor *= eo_row_number_or(row, factors[i], 1);
  enum eo_code code = eo_case_faulty(row->inputs) ? EO_OK : eo_rating_geometry(&geometry, &pair, error);
  if (!code && !eo_case_faulty(row->inputs))
    code = eo_contact_stress(&found, &pair, &geometry, &in, error);
  if (code || eo_case_faulty(row->inputs))
    return code;
  eo_row_check(row, "Z_H", found.zone);
  eo_row_check(row, "Z_E", found.elasticity / 1e3);
  eo_row_check(row, "Z_eps", found.contact_ratio);
  eo_row_check(row, "Z_beta", found.helix);
  eo_row_check(row, "Z_B", found.single_contact[0]);
  eo_row_check(row, "Z_D", found.single_contact[1]);
  eo_row_check(row, "sigma_H0_MPa", found.nominal / 1e6);
  eo_row_check(row, "sigma_H_pitch_MPa", found.pitch_point / 1e6);
  eo_row_check(row, "sigma_H1_MPa", found.stress[0] / 1e6);
  eo_row_check(row, "sigma_H2_MPa", found.stress[1] / 1e6);
  eo_row_check(row, "sigma_H_MPa", fmax(found.stress[0], found.stress[1]) / 1e6);
  return EO_OK;
}

/* A factor that the row states, or what the formula gives. */
static double stated_or(struct eo_rating_row *row, const char *key, double computed)
{
  return eo_row_has(row, key) ? eo_row_number(row, key) : computed;
}

static void set_surface(struct eo_rating_row *row, struct eo_flank_influence *influence, double softer)
{
  double velocity = eo_row_number_or(row, "velocity_m_per_s", NAN),
         viscosity = eo_row_number_or(row, "viscosity_40_mm2_per_s", NAN), roughness[2] = {NAN, NAN},
         base[2] = {NAN, NAN};
  if (eo_row_has(row, "R_z_flank_um"))
    eo_row_both(row, "R_z_flank_um", roughness);
  if (eo_row_has(row, "base_diameter_mm"))
    eo_row_both(row, "base_diameter_mm", base);
  double working = eo_row_angle(row, "alpha_wt_deg", NAN);
  const double metres[2] = {base[0] / 1e3, base[1] / 1e3}, peaks[2] = {roughness[0] / 1e6, roughness[1] / 1e6};
  double curvature = eo_relative_curvature(metres, working);
  influence->lubricant = stated_or(row, "Z_L", eo_lubricant_factor(softer, viscosity));
  influence->velocity = stated_or(row, "Z_v", eo_velocity_factor(softer, velocity));
  influence->roughness = stated_or(row, "Z_R", eo_roughness_factor(softer, peaks, curvature));
}

/* Z_W of a soft wheel whose hardness is stated; R_zH as stated. */
static double work_hardening(struct eo_rating_row *row)
{
  if (!eo_row_has(row, "hardness_HBW"))
    return 1;
  return eo_work_hardening(eo_row_number(row, "hardness_HBW"), eo_row_number(row, "R_zH_um_at_most") / 1e6);
}

static double flank_life(struct eo_rating_row *row, enum eo_rating_material material, double *share)
{
  bool pitting = eo_case_flag_or(row->inputs, "limited_pitting", false);
  double limit = eo_row_number_or(row, "long_life_limit", 0.85);
  if (!eo_row_has(row, "cycles"))
    return eo_row_number_or(row, "Z_NT", NAN);
  struct eo_life_line line = eo_life_flank(material, pitting, limit);
  double cycles = eo_row_number(row, "cycles");
  *share = eo_life_share(&line, cycles);
  return eo_life_factor(&line, cycles);
}

enum eo_code eo_row_flank_strength(struct eo_rating_row *row, struct eo_error *error)
{
  enum eo_rating_material material;
  struct eo_flank_influence influence;
  double limit = 1e6 * eo_row_number(row, "sigma_Hlim_MPa"), share = 1;
  double softer = 1e6 * eo_row_number_or(row, "sigma_Hlim_softer_MPa", limit / 1e6);
  (void)error;
  if (!read_material(row, &material))
    return EO_OK;
  set_surface(row, &influence, softer);
  influence.work_hardening = stated_or(row, "Z_W", work_hardening(row));
  influence.size = stated_or(row, "Z_X", 1);
  double life = flank_life(row, material, &share), least = eo_row_number_or(row, "S_H_min", 1);
  double strength = eo_flank_strength(limit, life, share, &influence);
  double stress = 1e6 * eo_row_number_or(row, "sigma_H_MPa", NAN);
  if (eo_case_faulty(row->inputs))
    return EO_OK;
  eo_row_check(row, "Z_L", influence.lubricant);
  eo_row_check(row, "Z_v", influence.velocity);
  eo_row_check(row, "Z_R", influence.roughness);
  eo_row_check(row, "Z_W", influence.work_hardening);
  eo_row_check(row, "Z_X", influence.size);
  eo_row_check(row, "Z_NT", life);
  eo_row_check(row, "sigma_HG_MPa", strength / 1e6);
  eo_row_check(row, "sigma_HP_MPa", strength / least / 1e6);
  eo_row_check(row, "S_H", strength / stress);
  return EO_OK;
}

enum eo_code eo_row_root(struct eo_rating_row *row, struct eo_error *error)
{
  struct eo_rating_pair pair;
  struct eo_rating_geometry geometry;
  struct eo_tooth_root found;
  double shift[2];
  int member = eo_row_member(row);
  eo_row_pair(row, &pair);
  eo_row_both(row, "x", shift);
  struct eo_tooth_root_input in = {.edition = edition_of(row),
                                   .generating_shift = eo_row_number_or(row, "x_generating", shift[member]),
                                   .dedendum_coefficient = eo_row_number(row, "dedendum_coefficient"),
                                   .fillet_radius_coefficient = eo_row_number(row, "root_radius_coefficient"),
                                   .tangential_force = eo_row_number_or(row, "F_t_N", NAN)};
  double load_factor = eo_row_number_or(row, "K_product", NAN);
  enum eo_code code = eo_case_faulty(row->inputs) ? EO_OK : eo_rating_geometry(&geometry, &pair, error);
  if (!code && !eo_case_faulty(row->inputs))
    code = eo_tooth_root(&found, &pair, &geometry, member, &in, error);
  if (code || eo_case_faulty(row->inputs))
    return code;
  eo_row_check(row, "Y_F", found.form_factor);
  eo_row_check(row, "f_eps", found.load_share);
  eo_row_check(row, "Y_S", found.stress_correction);
  eo_row_check(row, "Y_beta", found.helix_factor);
  eo_row_check(row, "h_F_over_mn", found.arm);
  eo_row_check(row, "s_Fn_over_mn", found.chord);
  eo_row_check(row, "rho_F_over_mn", found.fillet_radius);
  eo_row_check(row, "alpha_Fen_deg", found.load_angle * 180 / M_PI);
  eo_row_check(row, "q_s", found.notch);
  eo_row_check(row, "d_en_mm", 1e3 * found.load_diameter);
  eo_row_check(row, "sigma_F0_MPa", found.nominal / 1e6);
  eo_row_check(row, "sigma_F_MPa", found.nominal * load_factor / 1e6);
  return EO_OK;
}

/* Y_X of one module, or of several: Y_X_0, Y_X_1, ... */
static double root_size(struct eo_rating_row *row, enum eo_rating_material material)
{
  struct eo_case *modules = eo_case_need(row->inputs, "normal_module_mm");
  char key[40];
  if (modules && !eo_case_is_list(modules))
    return eo_root_size_factor(material, eo_case_real(modules) / 1e3);
  for (int i = 0; i < eo_case_size(modules); i++) {
    snprintf(key, sizeof key, "Y_X_%d", i);
    eo_row_check(row, key, eo_root_size_factor(material, eo_case_element(modules, i) / 1e3));
  }
  return NAN;
}

static double root_life(struct eo_rating_row *row, enum eo_rating_material material)
{
  struct eo_life_line line = eo_life_root(material, eo_row_number_or(row, "long_life_limit", 0.85));
  return eo_row_has(row, "cycles") ? eo_life_factor(&line, eo_row_number(row, "cycles"))
                                   : eo_row_number_or(row, "Y_NT", NAN);
}

/* sigma_FE as stated, or sigma_Flim Y_ST. */
static double allowable(struct eo_rating_row *row)
{
  if (eo_row_has(row, "sigma_FE_MPa"))
    return 1e6 * eo_row_number(row, "sigma_FE_MPa");
  return 1e6 * eo_row_number_or(row, "sigma_Flim_MPa", NAN) * eo_row_number_or(row, "Y_ST", 2);
}

enum eo_code eo_row_root_strength(struct eo_rating_row *row, struct eo_error *error)
{
  enum eo_rating_material material;
  struct eo_root_influence influence = {.notch = NAN};
  if (!read_material(row, &material))
    return EO_OK;
  double notch = eo_row_number_or(row, "q_s", NAN), proof = 1e6 * eo_row_number_or(row, "proof_stress_MPa", NAN),
         stress = 1e6 * eo_row_number_or(row, "sigma_F_MPa", NAN), least = eo_row_number_or(row, "S_F_min", 1);
  influence.surface = eo_root_surface_factor(material, eo_row_number_or(row, "R_z_root_um", NAN) / 1e6);
  influence.size = root_size(row, material);
  influence.life = root_life(row, material);
  influence.mean = eo_row_number_or(row, "Y_M", 1);
  enum eo_code code = isnan(notch) ? EO_OK : eo_notch_sensitivity(&influence.notch, material, notch, proof, error);
  double strength = eo_root_strength(allowable(row), &influence);
  if (code || eo_case_faulty(row->inputs))
    return code;
  eo_row_check(row, "Y_drelT", influence.notch);
  eo_row_check(row, "Y_RrelT", influence.surface);
  eo_row_check(row, "Y_X", influence.size);
  eo_row_check(row, "Y_NT", influence.life);
  eo_row_check(row, "sigma_FG_MPa", strength / 1e6);
  eo_row_check(row, "sigma_FP_MPa", strength / least / 1e6);
  eo_row_check(row, "S_F", strength / stress);
  return EO_OK;
}

/* Groups of materials as the standard's tables of life factors name them. */
static bool read_group(struct eo_rating_row *row, enum eo_rating_material *material, bool *some_pitting)
{
  const char *group = eo_case_word(row->inputs, "group");
  if (!group)
    return false;
  *some_pitting = strstr(group, "pitting") && !strstr(group, "no pitting");
  if (strstr(group, "nitrocarburised"))
    *material = EO_NITROCARBURISED;
  else if (strstr(group, "nitrided"))
    *material = EO_NITRIDED_NITRIDING_STEEL;
  else if (strncmp(group, "Eh", 2) == 0 || strncmp(group, "IF", 2) == 0)
    *material = EO_CASE_HARDENED;
  else if (strncmp(group, "St", 2) == 0 || strncmp(group, "V", 1) == 0)
    *material = EO_THROUGH_HARDENED_ALLOY;
  else {
    eo_case_fault(eo_case_find(row->inputs, "group"),
                  "Groups begin with St, V, Eh or IF, or say nitrided or nitrocarburised.");
    return false;
  }
  return true;
}

enum eo_code eo_row_life(struct eo_rating_row *row, struct eo_error *error)
{
  enum eo_rating_material material;
  bool some_pitting;
  (void)error;
  double cycles = eo_row_number(row, "cycles"), limit = eo_row_number_or(row, "long_life_limit", 0.85);
  if (!read_group(row, &material, &some_pitting))
    return EO_OK;
  struct eo_life_line flank = eo_life_flank(material, some_pitting, limit), root = eo_life_root(material, limit);
  eo_row_check(row, "Z_NT", eo_life_factor(&flank, cycles));
  eo_row_check(row, "Y_NT", eo_life_factor(&root, cycles));
  return EO_OK;
}

/* Z_NT at which the flank just holds S_Hmin: from the strength at the required life, or from sigma_Hlim and its
 * factors. */
static double least_life_factor(struct eo_rating_row *row, const struct eo_life_line *line, double required)
{
  static const char *const factors[] = {"Z_L", "Z_v", "Z_R", "Z_W", "Z_X"};
  double least = eo_row_number_or(row, "S_H_min", 1);
  if (eo_row_has(row, "S_H"))
    return eo_life_factor(line, required) * least / eo_row_number(row, "S_H");
  double strength = eo_row_number(row, "sigma_Hlim_MPa");
  for (size_t i = 0; i < sizeof factors / sizeof *factors; i++)
    strength *= eo_row_number_or(row, factors[i], 1);
  return least * eo_row_number(row, "sigma_H_MPa") / strength;
}

/* Life at the least safety: the cycles of that Z_NT over 60 n; damage: the required life as its share. */
enum eo_code eo_row_service_life(struct eo_rating_row *row, struct eo_error *error)
{
  enum eo_rating_material material;
  (void)error;
  double speed = eo_row_number(row, "speed_rpm"), contacts = eo_row_number_or(row, "meshes_per_turn", 1);
  double required = eo_row_number_or(row, "required_life_h", NAN);
  double limit = eo_row_number_or(row, "long_life_limit", 0.85);
  bool pitting = eo_case_flag_or(row->inputs, "limited_pitting", false);
  if (!read_material(row, &material))
    return EO_OK;
  struct eo_life_line line = eo_life_flank(material, pitting, limit);
  double per_hour = 60 * speed * contacts;
  double life = eo_life_cycles(&line, least_life_factor(row, &line, required * per_hour)) / per_hour;
  if (eo_case_faulty(row->inputs))
    return EO_OK;
  eo_row_check(row, "life_h", life);
  eo_row_check(row, "damage_percent", 100 * required / life);
  return EO_OK;
}

/* Stress of class i: as listed, or from that of the first class. */
static double class_stress(struct eo_rating_row *row, int i)
{
  struct eo_case *stress = eo_case_need(row->inputs, "sigma_H_times_S_MPa");
  if (eo_case_is_list(stress))
    return eo_case_element(stress, i);
  struct eo_case *torque = eo_case_need(row->inputs, "torque_kNm"), *factor = eo_case_need(row->inputs, "K_Hbeta");
  return eo_life_class_stress(eo_case_real(stress), eo_case_element(torque, 0), eo_case_element(factor, 0),
                              eo_case_element(torque, i), eo_case_element(factor, i));
}

/* Each class: its stress, its cycles to failure; then the sum. */
static enum eo_code check_classes(struct eo_rating_row *row, struct eo_case *cycles, int count, double *ratio,
                                  double *number)
{
  enum eo_rating_material material;
  double reference = eo_row_number_or(row, "sigma_H_lim_reference_MPa", NAN),
         limit = eo_row_number_or(row, "long_life_limit", 0.85);
  if (!read_material(row, &material))
    return EO_OK;
  struct eo_life_line line = eo_life_flank(material, false, limit);
  for (int i = 0; i < count && !eo_case_faulty(row->inputs); i++) {
    char key[40];
    double stress = class_stress(row, i);
    ratio[i] = stress / reference;
    number[i] = cycles ? eo_case_element(cycles, i) : NAN;
    snprintf(key, sizeof key, "sigma_H_times_S_%d_MPa", i);
    eo_row_check(row, key, stress);
    snprintf(key, sizeof key, "N_%d", i);
    eo_row_check(row, key, isnan(reference) ? NAN : eo_life_cycles(&line, ratio[i]));
  }
  if (!eo_case_faulty(row->inputs) && !isnan(reference))
    eo_row_check(row, "damage_sum", eo_life_damage(&line, count, ratio, number));
  return EO_OK;
}

enum eo_code eo_row_damage(struct eo_rating_row *row, struct eo_error *error)
{
  struct eo_case *torque = eo_case_find(row->inputs, "torque_kNm"), *factor = eo_case_find(row->inputs, "K_Hbeta"),
                 *cycles = eo_case_find(row->inputs, "cycles"),
                 *stress = eo_case_find(row->inputs, "sigma_H_times_S_MPa");
  struct eo_case *const lists[] = {torque, factor, cycles, eo_case_is_list(stress) ? stress : NULL};
  int count = eo_case_size(torque ? torque : stress);
  for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++) {
    if (lists[i] && eo_case_size(lists[i]) != count)
      eo_case_fault(lists[i], "A list of %d numbers is expected here, one for each class.", count);
    for (int k = 0; k < eo_case_size(lists[i]); k++)
      eo_case_element(lists[i], k);
  }
  if (eo_case_faulty(row->inputs) || count == 0)
    return EO_OK;
  double *room = calloc(2 * (size_t)count, sizeof *room);
  if (!room)
    return eo_error_memory(error);
  enum eo_code code = check_classes(row, cycles, count, room, room + count);
  free(room);
  return code;
}

enum eo_code eo_row_material(struct eo_rating_row *row, struct eo_error *error)
{
  static const char *const qualities[] = {"ML", "MQ", "ME", NULL};
  enum eo_rating_material material;
  struct eo_strength found;
  int quality = eo_case_choice(row->inputs, "quality", qualities, EO_QUALITY_MQ);
  double hardness = eo_row_number(row, "hardness_HV");
  if (!read_material(row, &material) || eo_case_faulty(row->inputs))
    return EO_OK;
  enum eo_code code = eo_material_strength(&found, material, (enum eo_material_quality)quality, EO_CORE_25HRC_LOW,
                                           hardness, error);
  if (code)
    return code;
  eo_row_check(row, "sigma_Hlim_MPa", found.flank / 1e6);
  eo_row_check(row, "sigma_Flim_MPa", found.root / 1e6);
  return EO_OK;
}
