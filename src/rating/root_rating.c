/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rating/root_rating.h"

#include <math.h>

#include "contact/iso6336.h"

/* Outer point of single pair contact of the virtual spur gear, d_en (ISO 6336-3 (26), with eps_alpha_n), over m_n. */
static double load_diameter(const struct eo_rating_pair *rating_pair, const struct eo_rating_geometry *geometry,
                            int member)
{
  double alpha = rating_pair->normal_pressure_angle, zn = geometry->virtual_teeth[member], base = zn * cos(alpha) / 2;
  double tip = zn / 2 + (rating_pair->tip_diameter[member] - geometry->reference_diameter[member]) / 2 /
                            rating_pair->normal_module;
  double roll = sqrt(tip * tip - base * base) - M_PI * cos(alpha) * (geometry->virtual_contact_ratio - 1);
  return 2 * hypot(base, roll);
}

/* f_eps of 2019: share of the load at the outer point of single pair contact. */
static double load_share(enum eo_rating_edition edition, double eps_alpha_n, double eps_beta)
{
  if (edition != EO_ISO6336_2019)
    return 1;
  if (eps_beta == 0)
    return eps_alpha_n < 2 ? 1 : 0.7;
  if (eps_beta >= 1)
    return 1 / sqrt(eps_alpha_n);
  return eps_alpha_n < 2 ? sqrt(1 - eps_beta + eps_beta / eps_alpha_n)
                         : sqrt((1 - eps_beta) / 2 + eps_beta / eps_alpha_n);
}

/* Y_beta = 1 - eps_beta beta/120, eps_beta at most 1 and beta at most 30 degrees; 2019: over cos^3 beta. */
static double helix_factor(enum eo_rating_edition edition, double eps_beta, double helix)
{
  double degrees = fmin(helix * 180 / M_PI, 30), factor = 1 - fmin(eps_beta, 1) * degrees / 120;
  return edition == EO_ISO6336_2019 ? factor / pow(cos(degrees * M_PI / 180), 3) : factor;
}

/* Y_DT of deep teeth: grade 4 or finer and eps_alpha_n above 2.05. */
static double deep_tooth(int grade, double eps_alpha_n)
{
  if (grade < 1 || grade > 4 || eps_alpha_n <= 2.05)
    return 1;
  return eps_alpha_n > 2.5 ? 0.7 : 2.366 - 0.666 * eps_alpha_n;
}

enum eo_code eo_tooth_root(struct eo_tooth_root *root, const struct eo_rating_pair *rating_pair,
                           const struct eo_rating_geometry *geometry, int member, const struct eo_tooth_root_input *in,
                           struct eo_error *error)
{
  struct eo_iso_section section;
  double load = load_diameter(rating_pair, geometry, member);
  struct eo_iso_section_input shape = {.virtual_teeth = geometry->virtual_teeth[member],
                                       .normal_pressure_angle = rating_pair->normal_pressure_angle,
                                       .profile_shift = in->generating_shift,
                                       .dedendum_coefficient = in->dedendum_coefficient,
                                       .fillet_radius_coefficient = in->fillet_radius_coefficient,
                                       .load_radius = load / 2};
  eo_iso_section(&section, &shape);
  if (!(section.chord > 0 && section.arm > 0 && section.fillet_radius > 0))
    return eo_error_set(
        error, EO_ERROR_INPUT, "/dedendum_coefficient",
        "The 30 degree tangents do not touch the fillet of gear %d: this root is not rated by ISO 6336-3.", member + 1);
  root->chord = section.chord;
  root->arm = section.arm;
  root->fillet_radius = section.fillet_radius;
  root->load_angle = section.load_angle;
  root->load_diameter = load * rating_pair->normal_module;
  root->notch = section.chord / (2 * section.fillet_radius);
  root->load_share = load_share(in->edition, geometry->virtual_contact_ratio, geometry->overlap_ratio);
  root->form_factor = section.form_factor * root->load_share;
  root->stress_correction = section.stress_correction;
  root->helix_factor = helix_factor(in->edition, geometry->overlap_ratio, rating_pair->helix_angle);
  root->deep_tooth = deep_tooth(in->grade, geometry->virtual_contact_ratio);
  double width = in->face_width > 0 ? in->face_width : rating_pair->face_width;
  root->nominal = in->tangential_force / (width * rating_pair->normal_module) * root->form_factor *
                  root->stress_correction * root->helix_factor * root->deep_tooth;
  return EO_OK;
}

/* Y_B = 1 from s_R/h = 1.2 on, else 1.6 ln(2.242 h/s_R). */
enum eo_code eo_rim_factor(double *factor, double ratio, struct eo_error *error)
{
  if (!(ratio > 0.5))
    return eo_error_set(error, EO_ERROR_INPUT, "/rim_thickness",
                        "A rim of %.4g tooth depths is below 0.5, where ISO 6336-3 gives no factor: make it thicker.",
                        ratio);
  *factor = ratio >= 1.2 ? 1 : 1.6 * log(2.242 / ratio);
  return EO_OK;
}

/* Slip layer thickness rho', mm, over proof stress, N/mm2; straight between, level outside. */
struct slip {
  double stress, thickness;
};

static double slip_thickness(const struct slip *points, int count, double stress)
{
  if (stress <= points[0].stress)
    return points[0].thickness;
  for (int i = 1; i < count; i++)
    if (stress <= points[i].stress) {
      double part = (stress - points[i - 1].stress) / (points[i].stress - points[i - 1].stress);
      return points[i - 1].thickness + part * (points[i].thickness - points[i - 1].thickness);
    }
  return points[count - 1].thickness;
}

/* ISO 6336-3 table 2. */
static double slip_of(enum eo_rating_material material, double proof_stress)
{
  static const struct slip through[] = {{500, 0.0281}, {600, 0.0194}, {800, 0.0064}, {1000, 0.0014}};
  static const struct slip structural[] = {{300, 0.0833}, {400, 0.0445}};
  switch (material) {
  case EO_CASE_HARDENED:
  case EO_FLAME_HARDENED:
    return 0.0030;
  case EO_NITRIDED_NITRIDING_STEEL:
  case EO_NITRIDED_THROUGH_STEEL:
  case EO_NITROCARBURISED:
    return 0.1005;
  case EO_STRUCTURAL:
    return slip_thickness(structural, 2, proof_stress / 1e6);
  default:
    return slip_thickness(through, 4, proof_stress / 1e6);
  }
}

/* Y_drelT = (1 + sqrt(0.2 rho' (1 + 2 q_s)))/(1 + sqrt(1.2 rho')). */
enum eo_code eo_notch_sensitivity(double *factor, enum eo_rating_material material, double notch, double proof_stress,
                                  struct eo_error *error)
{
  bool needs = material == EO_THROUGH_HARDENED_ALLOY || material == EO_THROUGH_HARDENED_CARBON ||
               material == EO_STRUCTURAL;
  if (needs && isnan(proof_stress))
    return eo_error_set(error, EO_ERROR_INPUT, "/proof_stress_MPa",
                        "Y_drelT of through hardened and structural steel needs the proof stress.");
  double slip = slip_of(material, proof_stress);
  *factor = (1 + sqrt(0.2 * slip * (1 + 2 * notch))) / (1 + sqrt(1.2 * slip));
  return EO_OK;
}

/* R_z of the fillet, 1 .. 40 um; below 1 um a constant. */
double eo_root_surface_factor(enum eo_rating_material material, double peak_to_valley)
{
  double rz = fmin(1e6 * peak_to_valley, 40);
  switch (material) {
  case EO_NITRIDED_NITRIDING_STEEL:
  case EO_NITRIDED_THROUGH_STEEL:
  case EO_NITROCARBURISED:
    return rz < 1 ? 1.025 : 4.299 - 3.259 * pow(rz + 1, 0.0058);
  case EO_STRUCTURAL:
    return rz < 1 ? 1.07 : 5.306 - 4.203 * pow(rz + 1, 0.01);
  default:
    return rz < 1 ? 1.12 : 1.674 - 0.529 * pow(rz + 1, 0.1);
  }
}

/* Table 5: to m_n 5 mm 1; through hardened and structural 1.03 - 0.006 m_n, at least 0.85; surface hardened
   1.05 - 0.01 m_n, at least 0.80. */
double eo_root_size_factor(enum eo_rating_material material, double normal_module)
{
  double m = 1e3 * normal_module;
  bool soft = material == EO_THROUGH_HARDENED_ALLOY || material == EO_THROUGH_HARDENED_CARBON ||
              material == EO_STRUCTURAL;
  return soft ? fmin(1, fmax(1.03 - 0.006 * m, 0.85)) : fmin(1, fmax(1.05 - 0.01 * m, 0.80));
}

double eo_root_strength(double allowable, const struct eo_root_influence *influence)
{
  return allowable * influence->life * influence->notch * influence->surface * influence->size * influence->mean;
}
