/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Macro-geometry of a cylindrical involute pair (ISO 21771:2007; basic rack ISO 53:1998). One end; both ends share it
   but for the hand, and for face and helix where they differ. */
#ifndef EASEOFF_GEAR_GEOMETRY_H
#define EASEOFF_GEAR_GEOMETRY_H

#include <stdbool.h>

#include "base/error.h"
#include "gear/gear_pair.h"

/* Lengths in m, angles in rad. [2] is [member]. */
struct eo_geometry {
  int teeth[2];
  double normal_module, transverse_module;
  double normal_pressure_angle, transverse_pressure_angle; /* alpha_n, alpha_t at the reference cylinder */
  double working_pressure_angle;                           /* alpha_wt, transverse */
  double helix_angle, base_helix_angle;                    /* beta, beta_b */
  double face_width;                                       /* b of one end, common to both members */
  double member_width[2];                                  /* of the member's own face, centred on the common one */
  double reference_radius[2];                              /* r */
  double working_radius[2];                                /* r_w */
  double base_radius[2];                                   /* r_b */
  double tip_radius[2];                                    /* r_a */
  double shortened[2];          /* by how much the tip radius is below d_a/2 of the rack so that it clears the mate */
  double tip_form_radius[2];    /* r_Fa, where a tip chamfer ends the flank; r_a without one */
  double root_radius[2];        /* r_f */
  double form_radius[2];        /* r_Ff, where the generated fillet meets the involute */
  double start_radius[2];       /* r_SAP, where the active profile starts (contact with the other member's tip) */
  double profile_shift[2];      /* x */
  double centre_distance;       /* a_w */
  double transverse_base_pitch; /* p_bt */
  double normal_base_pitch;     /* p_bn */
  double
      tangent_length[2]; /* T1C, T2C: from the base circles to the pitch point, along the transverse line of action */
  double moved[2];   /* by how much T1C, T2C are longer than at the distance that the pair is drawn for, which flanks
                        and flexibility count from: eo_geometry_set_apart() */
  double path_start; /* s_A < 0: contact starts at the gear's tip */
  double path_end;   /* s_E > 0: contact ends at the pinion's tip */
  double transverse_contact_ratio, overlap_ratio; /* eps_alpha, eps_beta */
  double rack_factor;    /* k_u = sin(alpha_t)/cos(alpha_n): u = k_u s, the profile coordinate of modifications */
  double rack_offset[2]; /* generating rack coordinate of the pitch point: 0 without profile shift */
  double rack_bottom, rack_top; /* u_A, u_E of the pinion; of the gear -u_E, -u_A */
  double dedendum[2];           /* h_fP, m, of the member's basic rack */
  double fillet_radius[2];      /* rho_fP, m */
  double generating_shift[2];   /* x_E: of the tool that cuts the root */
  double residual_undercut[2];  /* s_pr: protuberance of the tool beyond the stock it leaves, >= 0, m */
  bool undercut[2];             /* the rack cuts into the involute, protuberance aside */
  double least_shift[2];        /* x from which on there is no undercut */
  double fillet_end[2];         /* angle of the rack's rounding at which the trochoid ends at r_Ff, rad: alpha_n without
                                   undercut */
  double tip_thickness[2];      /* transverse arc at the tip, m */
  double tip_clearance[2];      /* between the member's tip and the other's root, m */
  double stated_backlash;       /* of the pair; eo_gear_pair_backlash() where it states none */
  double normal_backlash;       /* the stated backlash and what the centre distance adds, m */
};

/* Of one half of a pair whose geometry is that of its left one: faces and overlap may differ, and with a helix of its
   own all that depends on it (pair resolved; then eo_geometry_init() of the half must succeed). */
struct eo_geometry eo_geometry_of_half(const struct eo_geometry *geometry, const struct eo_gear_pair *pair, int end);

/* By how much the phase of the right half's mid face is ahead of the left one's where eta runs outwards, m of roll: the
   helices meet in the middle of the groove. 0 of equal halves. */
double eo_geometry_right_lead(const struct eo_geometry *geometry, const struct eo_gear_pair *pair);

/* Computes everything above. pair: settled (eo_gear_pair_settle()). Errors (EO_ERROR_INPUT with the key): pointed tip,
   interference with a fillet or with undercut, no continuous contact (eps_gamma < 1), a centre distance that leaves no
   backlash, no tip clearance. */
enum eo_code eo_geometry_init(struct eo_geometry *geometry, const struct eo_gear_pair *pair, struct eo_error *error);

/* EO_ERROR_INPUT at the pointer: a centre distance, m, that is not above the sum of the base radii, m. */
enum eo_code eo_geometry_check_distance(double centre_distance, double base_radii, const char *pointer,
                                        struct eo_error *error);

/* EO_ERROR_INPUT, always: shifts so negative that the tight mesh has no pressure angle. */
enum eo_code eo_geometry_refuse_shifts(const struct eo_gear_pair *pair, struct eo_error *error);

/* The same two gears with their axes that much further apart than the pair is drawn for (0: nothing changes): working
   pressure angle, path of contact, contact ratio, backlash and clearances; flanks, tips and roots stay. geometry: of
   eo_geometry_init(). Errors (EO_ERROR_INPUT with the key of the deviation): as above. */
enum eo_code eo_geometry_set_apart(struct eo_geometry *geometry, const struct eo_gear_pair *pair, double deviation,
                                   struct eo_error *error);

/* Sum of the profile shift coefficients without backlash at the working pressure angle alpha_wt (ISO 21771 (56)). */
double eo_geometry_shift_sum(const int teeth[2], double normal_pressure_angle, double transverse_pressure_angle,
                             double working_pressure_angle);

/* inv(alpha) = tan(alpha) - alpha. */
double eo_geometry_involute_function(double angle);
/* The angle, rad, whose involute function it is; 0 for what is not above 0. */
double eo_geometry_involute_inverse(double value);

/* The path coordinate as a member sees it: sigma = s on the pinion, -s on the gear; + towards its own tip. */
static inline double eo_geometry_own_path(int member, double s)
{
  return member == EO_PINION ? s : -s;
}

/* The path coordinate of a member's flank as it is at the distance that the pair is drawn for. */
static inline double eo_geometry_drawn_path(const struct eo_geometry *geometry, int member, double s)
{
  return s + eo_geometry_own_path(member, geometry->moved[member]);
}

/* The transverse profile of one flank of a member in its own frame: tooth centre line along +y, flank at x > 0,
   tooth without thickness allowance. normal: unit, out of the tooth. */

/* Point of the involute at the given radius (base_radius <= radius <= tip_radius). */
void eo_geometry_involute(const struct eo_geometry *geometry, int member, double radius, double point[2],
                          double normal[2]);

/* Point of the root: t = 0 in the middle of the tooth space, t = 1 at the form radius, t in proportion to the arc
   length; root circle first, then the trochoid that the rack's rounded tip generates (both meshed exactly in the normal
   section); with undercut it ends where it cuts the involute. */
void eo_geometry_fillet(const struct eo_geometry *geometry, int member, double t, double point[2], double normal[2]);

/* Radius on the member's flank that contacts at transverse path coordinate s, and back. */
double eo_geometry_radius_at(const struct eo_geometry *geometry, int member, double s);
double eo_geometry_path_at(const struct eo_geometry *geometry, int member, double radius);

/* Relative curvature radius normal to the flank at s: rho_n = (T1C+s)(T2C-s)/((T1C+T2C) cos beta_b), m. */
double eo_geometry_relative_radius(const struct eo_geometry *geometry, double s);

/* Distance from the flank to the tooth centre surface, along the flank normal, at s (Weber and Banaschek's h), m. */
double eo_geometry_depth(const struct eo_geometry *geometry, int member, double s);

#endif
