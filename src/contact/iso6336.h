/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The standard's estimates beside the computed ones: mesh stiffness by ISO 6336-1:2006 method B and nominal root stress
   by ISO 6336-3:2006 method B. External gears, one end of a pair. SI units. */
#ifndef EASEOFF_CONTACT_ISO6336_H
#define EASEOFF_CONTACT_ISO6336_H

#include "gear/geometry.h"

/* Teeth of the virtual spur gear: z/cos^3 beta as ISO 6336-1 approximates it, or z/(cos^2 beta_b cos beta) as ISO
   6336-3 has it. At 24 degrees of helix q' differs by 0.45 %. */
enum eo_iso_virtual { EO_ISO_VIRTUAL_CUBED, EO_ISO_VIRTUAL_EXACT };

/* ISO 6336-1 9.3 */
struct eo_iso_stiffness_input {
  int teeth[2];
  enum eo_iso_virtual virtual_teeth;
  double normal_pressure_angle, helix_angle; /* rad */
  double profile_shift[2];
  double dedendum_coefficient;     /* h_fP / m_n */
  double transverse_contact_ratio; /* eps_alpha */
  double blank_factor;             /* C_R; 1: solid discs */
  double theory_factor;            /* C_M: 0.8, or 1 to leave the correction out */
  double youngs_modulus;           /* Pa; the formulae hold for steel, 206 GPa, and scale with it */
};

struct eo_iso_stiffness {
  double virtual_teeth[2]; /* z_n */
  double flexibility;      /* q', m2/N: of a pair of teeth per face width */
  double theoretical;      /* c'_th = 1/q', Pa */
  double rack_factor;      /* C_B */
  double single;           /* c', Pa = N/m per m of face width; transverse */
  double mesh_alpha;       /* c_gamma_alpha */
  double mesh_beta;        /* c_gamma_beta = 0.85 c_gamma_alpha */
};

/* Single and mesh stiffness by method B (ISO 6336-1 9.3.1, 9.3.2); the input is taken as it is. */
void eo_iso_stiffness(struct eo_iso_stiffness *stiffness, const struct eo_iso_stiffness_input *input);

/* C_R of a web of thickness b_s in a rim of thickness s_R (9.3.2.3): ratios b_s / b, within 0.2 .. 1.2, and s_R / m_n,
   at least 1; outside, the nearest value within is used, as the standard says. */
double eo_iso_blank_factor(double web_ratio, double rim_ratio);

/* The critical section of ISO 6336-3 method B, of any external tooth that a rack cuts. Lengths over m_n. */
struct eo_iso_section_input {
  double virtual_teeth;                                   /* z_n */
  double normal_pressure_angle;                           /* rad */
  double profile_shift;                                   /* of the tooth that is cut */
  double dedendum_coefficient, fillet_radius_coefficient; /* h_fP, rho_fP */
  double load_radius;                                     /* d_en / 2 */
};

struct eo_iso_section {
  double chord;             /* s_Fn at the 30 degree tangents */
  double arm;               /* h_Fe */
  double fillet_radius;     /* rho_F there */
  double load_angle;        /* alpha_Fen, rad */
  double form_factor;       /* Y_F */
  double stress_correction; /* Y_S */
};

/* Place of the 30 degree tangent by the iteration of ISO 6336-3 and what follows from it. A root that the tangents do
   not touch has a chord, an arm or a radius that is not above 0: for the caller to refuse. */
void eo_iso_section(struct eo_iso_section *section, const struct eo_iso_section_input *input);

/* ISO 6336-3 method B, load at the outer point of single pair contact; no rounding of the tip, Y_DT = 1. */
struct eo_iso_root {
  double virtual_teeth;     /* z_n */
  double tangential_force;  /* F_t at the reference cylinder of one end, N */
  double chord;             /* s_Fn at the 30 degree tangents, m */
  double arm;               /* h_Fe, m */
  double fillet_radius;     /* rho_F there, m */
  double form_factor;       /* Y_F */
  double stress_correction; /* Y_S */
  double helix_factor;      /* Y_beta */
  double rim_factor;        /* Y_B, of the rim between root and bore */
  double stress;            /* sigma_F0, Pa: all application and distribution factors 1 */
};

/* member's root under the torque (N m) on that member's shaft that one end carries. bore: its diameter, m, 0: solid. */
void eo_iso_root(struct eo_iso_root *root, const struct eo_geometry *geometry, int member, double bore, double torque);

#endif
