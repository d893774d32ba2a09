/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is measured on one external gear: thickness, span, balls and pins, chord, tip, and the circles that cutting
   leaves (ISO 21771:2007, DIN 3960). All checked against numbers of published reports. Lengths in m, angles in rad. */
#ifndef EASEOFF_RATING_TOOTH_DIMENSIONS_H
#define EASEOFF_RATING_TOOTH_DIMENSIONS_H

#include <stdbool.h>

#include "base/error.h"

struct eo_tooth {
  int teeth;
  double normal_module, normal_pressure_angle;
  double helix_angle;                                     /* >= 0 */
  double profile_shift;                                   /* x, without allowance */
  double thickness_allowance;                             /* A_sn, normal, at the reference cylinder; <= 0 thins */
  double dedendum_coefficient, fillet_radius_coefficient; /* of the basic rack: h_fP, rho_fP over m_n */
};

double eo_tooth_reference_diameter(const struct eo_tooth *tooth);        /* d = m_t z */
double eo_tooth_base_diameter(const struct eo_tooth *tooth);             /* d_b */
double eo_tooth_transverse_pressure_angle(const struct eo_tooth *tooth); /* alpha_t */
double eo_tooth_base_helix_angle(const struct eo_tooth *tooth);          /* beta_b */

/* s_n on the reference cylinder, with the allowance. */
double eo_tooth_normal_thickness(const struct eo_tooth *tooth);
/* Arc at a diameter >= d_b: transverse, and normal = transverse times cos(beta there). */
double eo_tooth_transverse_thickness_at(const struct eo_tooth *tooth, double diameter);
double eo_tooth_normal_thickness_at(const struct eo_tooth *tooth, double diameter);
/* x_E = x + A_sn / (2 m_n tan alpha_n): the shift that was cut. */
double eo_tooth_generating_shift(const struct eo_tooth *tooth);

/* Chord of the reference cylinder's normal section and its height below the tip. */
struct eo_tooth_chord {
  double thickness, height; /* s_c, h_c */
};
struct eo_tooth_chord eo_tooth_chord(const struct eo_tooth *tooth, double tip_diameter);

/* W_k over k teeth, k >= 1. */
double eo_tooth_span(const struct eo_tooth *tooth, int teeth_spanned);
/* Diameter at which the anvils touch. */
double eo_tooth_span_contact(const struct eo_tooth *tooth, int teeth_spanned);
/* A_sn of a gear whose span was measured. */
double eo_tooth_allowance_of_span(const struct eo_tooth *tooth, int teeth_spanned, double span);
/* k whose contact lies nearest to mid flank between form and tip diameter. EO_ERROR_INPUT with the reason where no k
   touches within the flank, or where the face is too narrow for the anvils: b >= W_k sin beta_b + anvil. */
enum eo_code eo_tooth_span_choose(const struct eo_tooth *tooth, double form_diameter, double tip_diameter,
                                  double face_width, double anvil, int *teeth_spanned, struct eo_error *error);
/* The same checks for a k that is given. */
enum eo_code eo_tooth_span_check(const struct eo_tooth *tooth, int teeth_spanned, double form_diameter,
                                 double tip_diameter, double face_width, double anvil, struct eo_error *error);

struct eo_ball_dimension {
  double centre_diameter;  /* d_K, of the circle of ball centres */
  double contact_diameter; /* where the ball touches the flanks */
  double over_one;         /* M_rK: from the axis */
  double over_two;         /* M_dK: two balls, in one transverse plane */
  double over_pins;        /* M_dR: two pins; differs from balls on helical gears with an odd number of teeth */
};

/* ball: its diameter D_M. EO_ERROR_INPUT when it drops to the base circle. */
enum eo_code eo_tooth_over_balls(const struct eo_tooth *tooth, double ball, struct eo_ball_dimension *dimension,
                                 struct eo_error *error);
/* The smallest ball of the usual steps (0.25 mm to 5, 0.5 to 10, 1 to 30, 5 mm above; below 1 mm 0.05) that is not
   below the one which touches at the cylinder d + 2 x m_n; it touches the flank between form and tip diameter and
   stands above the tip, or EO_ERROR_INPUT says why not. */
enum eo_code eo_tooth_ball_choose(const struct eo_tooth *tooth, double form_diameter, double tip_diameter, double *ball,
                                  struct eo_error *error);
/* The same checks for a ball that is given. */
enum eo_code eo_tooth_ball_check(const struct eo_tooth *tooth, double ball, double form_diameter, double tip_diameter,
                                 struct eo_error *error);

/* d_f of the tooth that was cut: with x_E. */
double eo_tooth_root_diameter(const struct eo_tooth *tooth);
/* d_Ff, the form circle that a rack cuts (with x_E): where its rounded tip's trochoid joins the involute; with
   undercut, where they meet. undercut may be NULL. */
double eo_tooth_form_diameter(const struct eo_tooth *tooth, bool *undercut);

#endif
