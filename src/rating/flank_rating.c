/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rating/flank_rating.h"

#include <math.h>

/* ISO 6336-2 6.2: Z_H = sqrt(2 cos beta_b cos alpha_wt/(cos^2 alpha_t sin alpha_wt)). */
static double zone_factor(const struct eo_rating_geometry *geometry)
{
  double transverse = cos(geometry->transverse_pressure_angle), working = geometry->working_pressure_angle;
  return sqrt(2 * cos(geometry->base_helix_angle) * cos(working) /
              (transverse * transverse * sin(working))); /* theory (W4) */
}

/* ISO 6336-2 7: Z_E = sqrt(1/(pi sum (1 - nu^2)/E)). */
static double elasticity_factor(const struct eo_elastic *elastic)
{
  double compliance = 0;
  for (int i = 0; i < 2; i++)
    compliance += (1 - elastic->poissons_ratio[i] * elastic->poissons_ratio[i]) / elastic->youngs_modulus[i];
  return sqrt(1 / (M_PI * compliance)); /* theory (W5) */
}

/* ISO 6336-2 8: Z_eps = sqrt((4 - eps_alpha)/3 (1 - eps_beta) + eps_beta/eps_alpha), eps_beta at most 1. */
double eo_contact_ratio_factor(double alpha, double overlap)
{
  double beta = fmin(overlap, 1);
  return sqrt((4 - alpha) / 3 * (1 - beta) + beta / alpha);
}

/* ISO 6336-2 9; see enum eo_rating_edition. */
static double helix_factor(enum eo_rating_edition edition, double helix)
{
  return edition == EO_DIN3990 ? sqrt(cos(helix)) : 1 / sqrt(cos(helix));
}

/* 2019: sqrt(f_ZCa) takes the place of 1 on helical pairs with eps_beta >= 1. */
static double helical_single_contact(const struct eo_contact_input *in)
{
  static const double f_zca[] = {[EO_PROOF_ANALYSIS] = 1, [EO_PROOF_EXPERIENCE] = 1.07, [EO_PROOF_NONE] = 1.2};
  return in->edition == EO_ISO6336_2019 ? sqrt(f_zca[in->proof]) : 1;
}

/* 6.3: M_1 = tan alpha_wt/sqrt((t_1 - 2 pi/z_1)(t_2 - (eps_alpha - 1) 2 pi/z_2)), t = sqrt(d_a^2/d_b^2 - 1). */
static double inner_point(const struct eo_rating_pair *rating_pair, const struct eo_rating_geometry *geometry, int i)
{
  int other = 1 - i;
  double own = geometry->tip_roll[i] - 2 * M_PI / rating_pair->teeth[i];
  double mate = geometry->tip_roll[other] -
                (geometry->transverse_contact_ratio - 1) * 2 * M_PI / rating_pair->teeth[other];
  return own > 0 && mate > 0 ? tan(geometry->working_pressure_angle) / sqrt(own * mate) : NAN;
}

/* Spur: max(1, M). 0 < eps_beta < 1: between that of the spur pair and that of the helical one. */
static double single_contact(double inner, double overlap, double helical)
{
  double beta = fmin(overlap, 1);
  if (beta == 0)
    return fmax(1, inner);
  return fmax(1, inner - beta * (inner - helical));
}

enum eo_code eo_contact_stress(struct eo_contact_stress *stress, const struct eo_rating_pair *rating_pair,
                               const struct eo_rating_geometry *geometry, const struct eo_contact_input *in,
                               struct eo_error *error)
{
  double u = (double)rating_pair->teeth[1] / rating_pair->teeth[0];
  if (geometry->transverse_contact_ratio > 2)
    return eo_error_set(error, EO_ERROR_INPUT, "/tip_diameter_mm",
                        "The contact ratio %.4g is above 2, where ISO 6336-2 6.3 takes other points: not rated here.",
                        geometry->transverse_contact_ratio);
  stress->zone = zone_factor(geometry);
  stress->elasticity = elasticity_factor(&in->elastic);
  stress->contact_ratio = eo_contact_ratio_factor(geometry->transverse_contact_ratio, geometry->overlap_ratio);
  stress->helix = helix_factor(in->edition, rating_pair->helix_angle);
  /* theory (W3) */
  stress->nominal =
      stress->zone * stress->elasticity * stress->contact_ratio * stress->helix *
      sqrt(in->tangential_force * (u + 1) / (geometry->reference_diameter[0] * rating_pair->face_width * u)); /* 6.1 */
  stress->pitch_point = stress->nominal * sqrt(in->load_factor);
  for (int i = 0; i < 2; i++) {
    double inner = inner_point(rating_pair, geometry, i);
    if (isnan(inner))
      return eo_error_set(error, EO_ERROR_INPUT, "/tip_diameter_mm",
                          "Single pair contact of gear %d would begin below its base circle.", i + 1);
    stress->single_contact[i] = single_contact(inner, geometry->overlap_ratio, helical_single_contact(in));
    stress->stress[i] = stress->single_contact[i] * stress->pitch_point;
  }
  return EO_OK;
}

/* Straight between the values at 850 and 1200 N/mm2, level outside. */
static double between_limits(double softer_limit, double soft, double hard)
{
  double sigma = fmin(fmax(softer_limit / 1e6, 850), 1200);
  return soft + (hard - soft) * (sigma - 850) / (1200 - 850);
}

/* 11.3.1: C_ZL = 0.83 .. 0.91; Z_L = C_ZL + 4 (1 - C_ZL)/(1.2 + 134/nu_40)^2. */
double eo_lubricant_factor(double softer_limit, double viscosity_40)
{
  double c = between_limits(softer_limit, 0.83, 0.91);
  return c + 4 * (1 - c) / pow(1.2 + 134 / viscosity_40, 2);
}

/* 11.3.2: C_Zv = C_ZL + 0.02; Z_v = C_Zv + 2 (1 - C_Zv)/sqrt(0.8 + 32/v). */
double eo_velocity_factor(double softer_limit, double velocity)
{
  double c = between_limits(softer_limit, 0.83, 0.91) + 0.02;
  return c + 2 * (1 - c) / sqrt(0.8 + 32 / velocity);
}

double eo_relative_curvature(const double base_diameter[2], double working_pressure_angle)
{
  double first = 0.5 * base_diameter[0] * tan(working_pressure_angle),
         second = 0.5 * base_diameter[1] * tan(working_pressure_angle);
  return first * second / (first + second);
}

/* 11.3.3: Z_R = (3/R_z10)^C_ZR, R_z10 = mean R_z (10/rho_red)^(1/3), um and mm; C_ZR = 0.15 .. 0.08. */
double eo_roughness_factor(double softer_limit, const double peak_to_valley[2], double curvature)
{
  double mean = 1e6 * (peak_to_valley[0] + peak_to_valley[1]) / 2, relative = mean * cbrt(10e-3 / curvature);
  return pow(3 / relative, between_limits(softer_limit, 0.15, 0.08));
}

/* 12: R_zH = R_z1 (10/rho_red)^0.33 (R_z1/R_z2)^0.66/(v nu_40/1500)^0.33, within 3 .. 16 um. */
double eo_equivalent_roughness(double hard, double soft, double curvature, double velocity, double viscosity_40)
{
  double value = 1e6 * hard * pow(10e-3 / curvature, 0.33) * pow(hard / soft, 0.66) /
                 pow(velocity * viscosity_40 / 1500, 0.33);
  return 1e-6 * fmin(fmax(value, 3), 16);
}

/* 12: Z_W = (1.2 - (HB - 130)/1700)(3/R_zH)^0.15. */
double eo_work_hardening(double brinell, double equivalent_roughness)
{
  double hardness = fmin(fmax(brinell, 130), 470), roughness = fmax(1e6 * equivalent_roughness, 3);
  return (1.2 - (hardness - 130) / 1700) * pow(3 / roughness, 0.15);
}

/* 12: Z_W = 1 + (0.00898 HB_1/HB_2 - 0.00829)(u - 1), HB_1/HB_2 = 1.2 .. 1.7, u at most 20, never below 1. */
double eo_work_hardening_soft_pair(double pinion_brinell, double wheel_brinell, double gear_ratio)
{
  double ratio = fmin(pinion_brinell / wheel_brinell, 1.7);
  if (ratio < 1.2)
    return 1;
  return fmax(1, 1 + (0.00898 * ratio - 0.00829) * (fmin(gear_ratio, 20) - 1));
}

double eo_flank_strength(double flank_limit, double life_factor, double share,
                         const struct eo_flank_influence *influence)
{
  return flank_limit * life_factor *
         pow(influence->lubricant * influence->velocity * influence->roughness * influence->work_hardening, share) *
         influence->size;
}
