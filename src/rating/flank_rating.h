/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Surface durability by ISO 6336-2, method B: contact stress, permissible stress, safety. SI: Pa, N, m, m/s, rad.

   Checked by reports: Z_H, Z_E, Z_eps, Z_beta, Z_B, Z_D, sigma_H0, sigma_H; Z_L, Z_v, Z_R; Z_W of a soft wheel with a
   smooth pinion. Unchecked: Z_W with R_zH above 3 um and of two through hardened members; f_ZCa of 2019; the fade of
   Z_L, Z_v, Z_R, Z_W towards the static end. */
#ifndef EASEOFF_RATING_FLANK_RATING_H
#define EASEOFF_RATING_FLANK_RATING_H

#include "rating/life.h"
#include "rating/rating_pair.h"

/* 2006 with corrigendum 1 of 2008, and 2019: in both Z_beta = 1/sqrt(cos beta). DIN 3990-2 and the first print of 2006
   have sqrt(cos beta). */
enum eo_rating_edition { EO_ISO6336_2006, EO_ISO6336_2019, EO_DIN3990 };

/* f_ZCa of 2019 for helical pairs: profile modification verified by contact analysis, by experience, or none. */
enum eo_modification_proof { EO_PROOF_ANALYSIS, EO_PROOF_EXPERIENCE, EO_PROOF_NONE };

struct eo_elastic {
  double youngs_modulus[2], poissons_ratio[2];
};

struct eo_contact_input {
  enum eo_rating_edition edition;
  enum eo_modification_proof proof; /* 2019, helical */
  double tangential_force;          /* F_t at the reference cylinder, of the width b */
  double load_factor;               /* K_A K_gamma K_V K_Hbeta K_Halpha */
  struct eo_elastic elastic;
};

struct eo_contact_stress {
  double zone, elasticity, contact_ratio, helix; /* Z_H, Z_E (sqrt Pa), Z_eps, Z_beta */
  double single_contact[2];                      /* Z_B, Z_D */
  double nominal;                                /* sigma_H0 */
  double pitch_point;                            /* sigma_H0 sqrt(load_factor) */
  double stress[2];                              /* sigma_H of both members */
};

double eo_contact_ratio_factor(double transverse_contact_ratio, double overlap_ratio); /* Z_eps */

/* EO_ERROR_INPUT: eps_alpha above 2 (6.3 has other points then) or a geometry without single pair contact points. */
enum eo_code eo_contact_stress(struct eo_contact_stress *contact, const struct eo_rating_pair *pair,
                               const struct eo_rating_geometry *geometry, const struct eo_contact_input *input,
                               struct eo_error *error);

double eo_lubricant_factor(double softer_limit, double viscosity_40); /* Z_L; sigma_Hlim of the softer member; mm2/s */
double eo_velocity_factor(double softer_limit, double velocity);      /* Z_v */
/* Relative curvature radius at the pitch point in the transverse plane (no cos beta_b). */
double eo_relative_curvature(const double base_diameter[2], double working_pressure_angle);
double eo_roughness_factor(double softer_limit, const double peak_to_valley[2], double curvature); /* Z_R; R_z, m */
/* R_zH of a hard pinion on a soft wheel, m, within 3 .. 16 um. hard, soft: R_z. */
double eo_equivalent_roughness(double hard, double soft, double curvature, double velocity, double viscosity_40);
/* Z_W of a soft wheel (HB within 130 .. 470) on a hard pinion; equivalent: R_zH, at least 3 um counts. */
double eo_work_hardening(double brinell, double equivalent_roughness);
/* Z_W of the wheel where both members are through hardened; 1 below a hardness ratio of 1.2. */
double eo_work_hardening_soft_pair(double pinion_brinell, double wheel_brinell, double gear_ratio);

struct eo_flank_influence {
  double lubricant, velocity, roughness, work_hardening, size; /* Z_L, Z_v, Z_R, Z_W, Z_X: endurance values */
};

/* sigma_HG = sigma_Hlim Z_NT (Z_L Z_v Z_R Z_W)^share Z_X; share: eo_life_share(). */
double eo_flank_strength(double flank_limit, double life_factor, double share,
                         const struct eo_flank_influence *influence);

#endif
