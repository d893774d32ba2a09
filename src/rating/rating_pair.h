/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The numbers of an external pair that rating formulae share (ISO 21771): without refusals, so that a rating also holds
   for undercut teeth. Lengths in m, angles in rad. */
#ifndef EASEOFF_RATING_RATING_PAIR_H
#define EASEOFF_RATING_RATING_PAIR_H

#include "base/error.h"

struct eo_rating_pair {
  int teeth[2];
  double normal_module, normal_pressure_angle, helix_angle;
  double face_width;      /* b; a pair with two helices: b_B, and overlap_ratio is that of one helix */
  double centre_distance; /* a */
  double tip_diameter[2];
};

struct eo_rating_geometry {
  double transverse_pressure_angle, working_pressure_angle, base_helix_angle;
  double reference_diameter[2], base_diameter[2], working_diameter[2];
  double tip_roll[2]; /* sqrt(d_a^2/d_b^2 - 1) */
  double path_length; /* g_alpha */
  double transverse_base_pitch;
  double transverse_contact_ratio, overlap_ratio; /* eps_alpha, eps_beta */
  double virtual_contact_ratio;                   /* eps_alpha_n = eps_alpha / cos^2 beta_b */
  double virtual_teeth[2];                        /* z_n = z / (cos^2 beta_b cos beta) */
};

/* EO_ERROR_INPUT: centre distance not above the base radii, tip below the base circle. */
enum eo_code eo_rating_geometry(struct eo_rating_geometry *geometry, const struct eo_rating_pair *pair,
                                struct eo_error *error);

/* x_2 without backlash at the distance, and the shortening k m_n = a - a_d - m_n (x_1 + x_2) <= 0 of both tips that
   keeps the clearance of the basic rack. */
struct eo_shift_split {
  double gear_shift, tip_alteration;
};
enum eo_code eo_shift_split(struct eo_shift_split *split, const struct eo_rating_pair *pair, double pinion_shift,
                            struct eo_error *error);

/* d_Nf of a member: where the other's tip ends the active profile. */
double eo_active_root_diameter(const struct eo_rating_pair *pair, const struct eo_rating_geometry *geometry,
                               int member);

#endif
