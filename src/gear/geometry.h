/* Macro-geometry of a cylindrical involute pair (ISO 21771:2007; basic rack ISO 53). One end; both ends share it but for the hand. */
#ifndef EASEOFF_GEAR_GEOMETRY_H
#define EASEOFF_GEAR_GEOMETRY_H

#include "base/error.h"
#include "gear/design.h"

/* Lengths in m, angles in rad. [2] is [member]. */
struct eo_geometry {
  int teeth[2];
  double normal_module, transverse_module;
  double normal_pressure_angle, transverse_pressure_angle; /* alpha_n, alpha_t at the reference cylinder */
  double working_pressure_angle;                           /* alpha_wt, transverse */
  double helix_angle, base_helix_angle;                    /* beta, beta_b */
  double face_width;
  double reference_radius[2];  /* r */
  double working_radius[2];    /* r_w */
  double base_radius[2];       /* r_b */
  double tip_radius[2];        /* r_a */
  double root_radius[2];       /* r_f */
  double form_radius[2];       /* r_Ff, where the generated fillet meets the involute */
  double profile_shift[2];     /* x */
  double centre_distance;      /* a_w */
  double transverse_base_pitch;/* p_bt */
  double normal_base_pitch;    /* p_bn */
  double tangent_length[2];    /* T1C, T2C: from the base circles to the pitch point, along the transverse line of action */
  double path_start;           /* s_A < 0: contact starts at the gear's tip */
  double path_end;             /* s_E > 0: contact ends at the pinion's tip */
  double transverse_contact_ratio, overlap_ratio; /* eps_alpha, eps_beta */
  double rack_factor;          /* k_u = u / s of the pinion's generating rack */
  double rack_offset;          /* u of the pitch point (s = 0) on the pinion's generating rack: 0 unless profile shift moves it */
  double rack_bottom, rack_top;/* u_A, u_E */
  double addendum[2];          /* of the generating rack above/below, h_a, m (tip shortening included) */
  double tip_thickness[2];     /* transverse arc at the tip, m */
  double transverse_backlash;  /* circumferential at the working circles, from x, a_w and the stated backlash, m */
};

/* Computes everything above. Errors (EO_ERROR_INPUT with the key): undercut, pointed tip, interference with a fillet,
   no continuous contact (eps_gamma < 1), centre distance that leaves negative backlash, a bore that cuts the rim. */
enum eo_code eo_geometry_init(struct eo_geometry *geometry, const struct eo_gear_pair *pair, struct eo_error *error);

/* The transverse profile of one flank of a member in its own frame: tooth centre line along +y, flank at x > 0.
   Roll length r = sqrt(radius^2 - r_b^2) runs along the involute; below the form radius the generated trochoid. */

/* Point of the involute at the given radius (form_radius <= radius <= tip_radius); normal points out of the tooth. */
void eo_geometry_involute(const struct eo_geometry *geometry, int member, double radius, double point[2], double normal[2]);

/* Point of the generated fillet, t = 0 at the root circle (middle of the tooth space side), t = 1 at the form radius;
   normal points out of the tooth. */
void eo_geometry_fillet(const struct eo_geometry *geometry, int member, double t, double point[2], double normal[2]);

/* Radius on the member's flank that contacts at transverse path coordinate s. */
double eo_geometry_radius_at(const struct eo_geometry *geometry, int member, double s);

/* Relative curvature radius normal to the flank at s: rho_n = (T1C+s)(T2C-s)/((T1C+T2C) cos beta_b), m. */
double eo_geometry_relative_radius(const struct eo_geometry *geometry, double s);

/* Distance from the flank to the tooth centre surface, along the flank normal, at s (Weber-Banaschek's h), m. */
double eo_geometry_depth(const struct eo_geometry *geometry, int member, double s);

#endif
