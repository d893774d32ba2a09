/* SPDX-License-Identifier: GPL-3.0-or-later */
/* General factors of ISO 6336-1: K_V method B, K_Hbeta method C, K_Halpha method B and their root counterparts. Written
   for the 2006 edition with the corrigenda of 2008; the formulae here are the same in 2019, whose deviations come from
   ISO 1328-1:2013 instead of 1995. A rating never mixes the two. SI: m, N/m, Pa.

   Checked by reports: K_V below resonance, running-in of surface hardened teeth, reduced mass, K_Halpha, K_Fbeta, f_ma,
   K_Hbeta from given f_sh and f_ma. Unchecked: K_V at and above resonance, f_sh with its constants K', running-in of
   through hardened and nitrided teeth. */
#ifndef EASEOFF_RATING_LOAD_FACTORS_H
#define EASEOFF_RATING_LOAD_FACTORS_H

#include <stdbool.h>

#include "rating/material_class.h"

struct eo_wheel_blank {
  double tip_diameter, root_diameter, base_diameter, bore, density;
};

/* m_red per face width, kg/m, of two solid rims (6.5.9 (30)); u = z_2/z_1. */
double eo_reduced_mass(const struct eo_wheel_blank blank[2], double gear_ratio);
/* n_E1, 1/s, from c_gamma_alpha, Pa (6.5.3 (6)). */
double eo_resonance_speed(int pinion_teeth, double mesh_stiffness, double reduced_mass);

/* Teeth under a light load are softer: what c' and c_gamma are multiplied with below w = 100 N/mm (9.3.2.5),
   (w/100)^0.25; 1 from there on. line_load: w = F_t K_A K_gamma/b, N/m. */
double eo_light_load_factor(double line_load);

struct eo_dynamic_input {
  double resonance_ratio;     /* N = n_1/n_E1 */
  double total_contact_ratio; /* eps_gamma > 1 */
  double single_stiffness;    /* c' */
  double line_load;           /* w = F_t K_A K_gamma/b */
  double pitch_deviation;     /* f_pb, of the larger member */
  double profile_deviation;   /* f_falpha */
  double pitch_running_in;    /* y_p = y_alpha */
  double profile_running_in;  /* y_f */
  double tip_relief;          /* C_a, or eo_running_in_relief() where none is specified */
  int grade;                  /* ISO 1328-1 grade; from 6 on relief does not help: B_k = 1 */
};

enum eo_speed_range { EO_SUBCRITICAL, EO_MAIN_RESONANCE, EO_BETWEEN_RANGES, EO_SUPERCRITICAL };

struct eo_dynamic_factor {
  double factor; /* K_V */
  enum eo_speed_range range;
  double pitch_share, profile_share, relief_share; /* B_p, B_f, B_k */
};

/* K_V by method B (ISO 6336-1 6.5). EO_ERROR_INPUT: a total contact ratio that is not above 1, no load. */
enum eo_code eo_dynamic_factor(struct eo_dynamic_factor *dynamic, const struct eo_dynamic_input *input,
                               struct eo_error *error);

/* C_ay = (sigma_Hlim/97 - 18.45)^2/18 + 1.5 um, of one member; take the mean of both. */
double eo_running_in_relief(double flank_limit);

/* y_alpha from f_pb (or y_f from f_falpha): surface hardened 0.075 f, at most 3 um; else by sigma_Hlim and speed v,
 * m/s. */
double eo_pitch_running_in(enum eo_rating_material material, double flank_limit, double velocity, double deviation);
/* y_beta from F_beta_x; surface hardened 0.15 F, at most 6 um. Unlike members: the mean of the two. */
double eo_helix_running_in(enum eo_rating_material material, double flank_limit, double velocity, double deviation);

/* Arrangements of figure 13. */
enum eo_bearing_arrangement {
  EO_ARRANGEMENT_A,
  EO_ARRANGEMENT_B,
  EO_ARRANGEMENT_C,
  EO_ARRANGEMENT_D,
  EO_ARRANGEMENT_E
};

struct eo_shaft_input {
  enum eo_bearing_arrangement arrangement;
  bool stiffened; /* the pinion's body stiffens the shaft: d_1/d_sh >= 1.15 counts it only then */
  bool double_helical;
  double span, offset; /* l, s: bearing span and distance of mid face from mid span; s/l at most 0.3 */
  double reference_diameter, shaft_diameter; /* d_1, d_sh */
  double face_width;                         /* b; double helical: b_B of one helix */
  double mean_load;                          /* F_m/b, N/m */
  double power_share;                        /* k, 0 .. 1, through this mesh; 1: all */
};

/* f_sh (7.6.2.2). EO_ERROR_INPUT: s/l above 0.3, share outside (0, 1]. */
enum eo_code eo_shaft_deviation(double *deviation, const struct eo_shaft_input *input, struct eo_error *error);
/* f_ma = sqrt(f_Hbeta1^2 + f_Hbeta2^2) (64). */
double eo_mesh_deviation(double pinion_slope, double gear_slope);
/* Least F_beta_x: max(0.005 mm2/N F_m/b, f_Hbeta/2) (55), (56). */
double eo_least_deviation(double mean_load, double helix_slope);
/* B_1, B_2 of what is done to the helix (unchecked). */
enum eo_helix_measure {
  EO_HELIX_AS_IS,
  EO_HELIX_CROWNED_HALF_MESH, /* crowning of 0.5 f_ma */
  EO_HELIX_CROWNED_HALF_BOTH, /* crowning of 0.5 (f_ma + f_sh) */
  EO_HELIX_CORRECTED,         /* for the computed deflection */
  EO_HELIX_CORRECTED_CROWNED,
  EO_HELIX_END_RELIEF,
};
void eo_helix_measure_factors(enum eo_helix_measure measure, double *b1, double *b2);
/* F_beta_x = 1.33 B_1 f_sh + B_2 f_ma, at least `least` (52). */
double eo_helix_deviation(double shaft_deviation, double mesh_deviation, double b1, double b2, double least);
/* K_Hbeta (39) to (42) from F_beta_y = F_beta_x - y_beta, c_gamma_beta and F_m/b. */
double eo_face_load_factor(double effective_deviation, double mesh_stiffness, double mean_load);
/* K_Fbeta = K_Hbeta^N_F with the smaller b/h of the two members; double helical: b_B (69), (70). */
double eo_root_face_factor(double face_load_factor, double width_over_depth);

struct eo_transverse_input {
  double transverse_contact_ratio, total_contact_ratio;
  double contact_ratio_factor;               /* Z_eps */
  double mesh_stiffness;                     /* c_gamma_alpha */
  double pitch_deviation, profile_deviation; /* f_pb, f_falpha: the larger one counts */
  double running_in;                         /* y_alpha, of f_pb */
  double line_load;                          /* F_tH/b = F_t K_A K_gamma K_V K_Hbeta/b */
};

struct eo_transverse_factor {
  double flank, root; /* K_Halpha, K_Falpha */
};
/* K_Halpha and K_Falpha by method B (ISO 6336-1 8.3), within their limits. */
struct eo_transverse_factor eo_transverse_factor(const struct eo_transverse_input *input);

#endif
