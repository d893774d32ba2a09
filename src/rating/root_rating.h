/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tooth root strength by ISO 6336-3, method B: nominal and local root stress, permissible stress. SI: Pa, N, m, rad.

   Checked by reports: Y_F, Y_S, Y_beta of 2006, sigma_F0 (a helical report has h_F 0.15 to 0.19 % longer, cause
   unknown), Y_drelT and Y_RrelT of case hardened teeth, Y_X. Unchecked: f_eps and Y_beta of 2019 on helical pairs,
   Y_DT, the grinding notch, Y_drelT and Y_RrelT of the other materials, the general Y_M. The permissible factors are
   those of endurance (from 3e6 cycles on); below, only the life factor is added and their static values are not
   applied. */
#ifndef EASEOFF_RATING_ROOT_RATING_H
#define EASEOFF_RATING_ROOT_RATING_H

#include "rating/flank_rating.h"

struct eo_tooth_root_input {
  enum eo_rating_edition edition;
  double generating_shift;                                /* x_E of the tooth that is cut (or the nominal x) */
  double dedendum_coefficient, fillet_radius_coefficient; /* h_fP, rho_fP over m_n */
  double tangential_force;                                /* F_t of the width b */
  double face_width;                                      /* b of this root, m; 0: of the pair */
  int grade;                                              /* flank grade: Y_DT counts from 4 on; 0: not known */
};

/* Lengths over m_n. */
struct eo_tooth_root {
  double chord, arm, fillet_radius; /* s_Fn, h_Fe, rho_F */
  double load_angle;                /* alpha_Fen */
  double load_diameter;             /* d_en, m, of the virtual spur gear */
  double notch;                     /* q_s = s_Fn/(2 rho_F) */
  double form_factor;               /* Y_F, with f_eps in 2019 */
  double load_share;                /* f_eps; 1 in 2006 */
  double stress_correction;         /* Y_S */
  double helix_factor;              /* Y_beta */
  double deep_tooth;                /* Y_DT */
  double nominal;                   /* sigma_F0, Y_B = 1 */
};

/* Factors and nominal stress of a member, 0 or 1, by method B of ISO 6336-3. EO_ERROR_INPUT: the 30 degree tangents do
   not touch its fillet. */
enum eo_code eo_tooth_root(struct eo_tooth_root *root, const struct eo_rating_pair *pair,
                           const struct eo_rating_geometry *geometry, int member,
                           const struct eo_tooth_root_input *input, struct eo_error *error);

/* Y_B of a rim s_R thick under a tooth h deep. EO_ERROR_INPUT: s_R/h not above 0.5. */
enum eo_code eo_rim_factor(double *factor, double rim_over_depth, struct eo_error *error);

/* proof_stress (sigma_0.2 or sigma_S, Pa): of through hardened and structural steel; others do not need it. NaN there:
   EO_ERROR_INPUT. */
enum eo_code eo_notch_sensitivity(double *factor, enum eo_rating_material material, double notch, double proof_stress,
                                  struct eo_error *error);                              /* Y_drelT */
double eo_root_surface_factor(enum eo_rating_material material, double peak_to_valley); /* Y_RrelT */
double eo_root_size_factor(enum eo_rating_material material, double normal_module);     /* Y_X */

struct eo_root_influence {
  double life, notch, surface, size, mean; /* Y_NT, Y_drelT, Y_RrelT, Y_X, Y_M */
};

/* sigma_FG = sigma_FE Y_NT Y_drelT Y_RrelT Y_X Y_M, sigma_FE = sigma_Flim Y_ST, Y_ST = 2. */
double eo_root_strength(double allowable, const struct eo_root_influence *influence);

#endif
