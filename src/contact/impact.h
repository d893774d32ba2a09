/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Entering impact: where the incoming gear tip first touches the deflected pinion, how fast, and how hard
   (doc/theory/entering-impact.md: half sine of an effective mass on the compliance of a short patch; Seireg and Houser
   1970). */
#ifndef EASEOFF_CONTACT_IMPACT_H
#define EASEOFF_CONTACT_IMPACT_H

#include "contact/loaded.h"

/* The smallest gaps of the incoming line of one gap field on its way towards mesh, as far as they are known: no load
   changes them. known = 0 for another field. */
struct eo_incoming_gaps {
  bool backwards;
  int known;
  double gap[512];
};

struct eo_impact_settings {
  double patch;      /* length of the impact patch along the face, m */
  double inertia[2]; /* of one end about its axis, kg m2; see eo_impact_inertia() */
  bool backwards;    /* the gear drives: the pinion's tip edge comes in, at the other end of the path */
  int stations;      /* 0: the touch is found anywhere on the face; n > 1: at n stations over the face, as a sampled
                        reference does */
  struct eo_incoming_gaps *incoming; /* what searches in the same field share, borrowed; NULL: nothing */
};

/* Solid disc of the pitch cylinder over the face width of one end, kg m2. */
void eo_impact_inertia(const struct eo_geometry *geometry, const struct eo_material *material, double inertia[2]);

/* Effective mass along the flank normal: J_p J_g / (J_p r_bg^2 + J_g r_bp^2) / cos^2(beta_b), kg. */
double eo_impact_mass(const struct eo_geometry *geometry, const double inertia[2]);

struct eo_impact {
  bool touched;         /* false: the incoming pair never touches (no load reaches it) */
  bool off_line;        /* first touch before s_A (backwards: behind s_E), with the tip corner: the classical entering
                           impact */
  double phase;         /* c of the incoming pair at first touch, m */
  double eta;           /* where on the face, m */
  double path;          /* s of the touch, m: path_start - s is the lead before A */
  double pinion_radius; /* of the touch, m */
  double slope;         /* of the gap there over the roll distance as it runs, negative while closing */
  double bulk;          /* compliance of the patch without the Hertz part, m/N */
  double speed;         /* closing, normal, m/s, at the given pinion speed */
  double compliance;    /* q_s of the patch, bulk + Hertz, m/N */
  double force;         /* general impact F_s = v sqrt(m_e/q_s), N */
  double classical;     /* the same when off_line, else 0 */
  double duration;      /* pi sqrt(m_e q_s), s */
  double start;         /* of the pulse, phase of the mesh cycle 0..1 */
};

/* approach: Z over the mesh cycle, [grid->positions], m. speed: of the pinion, rad/s. compliance_factor as in
   eo_loaded_solve(). */
void eo_impact_find(struct eo_impact *impact, const struct eo_contact_grid *grid, const struct eo_gap_field *field,
                    struct eo_kernel kernel, const struct eo_impact_settings *settings, const double *approach,
                    double speed, double compliance_factor);

/* Closing speed, force and duration of a touch already found, at another speed of the pinion: where it is does not
   depend on speed. */
void eo_impact_strike(struct eo_impact *impact, const struct eo_contact_grid *grid,
                      const struct eo_impact_settings *settings, double speed, double compliance_factor);

#endif
