/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A gear pair as its drawing states it, and its material. */
#ifndef EASEOFF_GEAR_GEAR_PAIR_H
#define EASEOFF_GEAR_GEAR_PAIR_H

enum { EO_PINION = 0, EO_GEAR = 1 };
enum { EO_LEFT = 0, EO_RIGHT = 1 };

/* A number the user may leave out (JSON null) is NaN here until eo_design_resolve() (design/) puts the derived default
   in its place. */
struct eo_gear_pair {
  int ends;                     /* 2: herringbone; 1: single helical or spur */
  int teeth[2];                 /* [member]: pinion, gear */
  double normal_module;         /* m_n, m */
  double normal_pressure_angle; /* alpha_n, rad */
  double helix_angle;           /* beta at the pitch cylinder, rad, >= 0 (right end; the left end has the other hand) */
  double face_width;            /* b of one end, m */
  double groove_width;          /* tool withdrawal groove between the ends, m; NaN: 8 m_n with two ends, 0 with one */
  double addendum_coefficient;  /* h_aP* */
  double dedendum_coefficient;  /* h_fP* = h_aP* + c* */
  double fillet_radius_coefficient; /* rho_fP* of the basic rack */
  double profile_shift[2];          /* x */
  double centre_distance; /* working centre distance a_w, m; NaN: without backlash for the given profile shift */
  double tip_diameter[2]; /* d_a, m; NaN: from addendum, profile shift and centre distance */
  double bore[2]; /* bore diameter, m, 0: solid; NaN: pinion solid, gear 15 m_n (at most half its root diameter) */
  double groove_diameter[2]; /* body diameter between the ends, m; NaN: root diameter - 2 mm, at least 0.9 of it */
  double rim_thickness_coefficient; /* rim below the root that flexes, times m_n; a larger bore cuts it shorter.
                                       Of a sector and a ring that is held */
  double backlash;                  /* 2 tau, normal, m */
};

struct eo_material {
  double youngs_modulus; /* Pa */
  double poissons_ratio;
  double density; /* kg/m3 */
};

#endif
