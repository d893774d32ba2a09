/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Torsion and bending of the pinion's and the gear's body: how far a load on the flanks opens the gap everywhere on the
   flanks.

   A body is a stepped round beam (Timoshenko) from its left to its right bearing: shaft, toothed end, groove, toothed
   end, shaft; with one end: shaft, toothed end, shaft. The bore runs through. A toothed end counts as a cylinder of
   eo_shaft_effective_diameter().
   - Bearings are simple supports. Their own give is the same at both ends of a symmetric drive, and part of the
   dynamics (supports).
   - Torque enters (leaves) beyond one end. Twist is measured from the face end on that side, the datum common to both
   ends of a body.
   - Normal n = cos b e_s + s_j sin b e_z (b: base helix angle, s_j = 1 left, -1 right, e_s along the line of action,
   e_z axial, + to the right). Sections stay plane, so the point of the plane of action at s moves along n by cos b (v +
   r_b theta) - s_j sin b (xi psi - r_b chi),      xi = T1C + s on the pinion, s - T2C on the gear, v, psi: deflection
   along e_s and section rotation in the plane of e_s and the axis; chi: rotation in the plane at right angles to it;
     theta: twist. A normal force does its work on the same terms: transverse force F cos b, torque r_b F cos b and the
   moments xi F sin b and r_b F sin b of the thrust. Axial stretch (0.02 um on the paper pair) is left out.
   - Simply supported beams are statically determinate, so the influence is the virtual work of the internal moments,
   shears and torques of unit loads: exact for piecewise constant sections, symmetric and positive semi-definite by
   construction (Maxwell, Mohr). Shear coefficient: hollow circle, Cowper 1966. */
#ifndef EASEOFF_CONTACT_SHAFT_H
#define EASEOFF_CONTACT_SHAFT_H

#include <stdbool.h>

#include "base/error.h"
#include "contact/field.h"
#include "gear/geometry.h"

/* Torsional wind-up and bending of the two bodies in their bearings (off by default).
   Positions are measured from the middle of the groove (of the face, with one end), + to the right. The bore runs
   through. */
enum eo_drive_side { EO_DRIVE_LEFT, EO_DRIVE_RIGHT };
struct eo_shafts {
  bool enabled;
  double bearing_position[2][2];    /* [member][left, right], m; NaN: derived (design/) */
  double shaft_diameter[2];         /* outside the toothed body, m; NaN: derived */
  enum eo_drive_side drive_side[2]; /* where torque enters the pinion and leaves the gear */
};

enum { EO_SHAFT_MODES = 8 };

/* A load on the flanks stands in a struct eo_deflection as its dual: at each node the normal force, N, and the normal
   force times s, N m. Vectors run over [end][part][node]. */
struct eo_shaft_influence {
  int ends;
  int size;       /* ends * 2 * EO_DEFLECTION_NODES */
  double *matrix; /* [size][size], deflection by unit load, of both bodies together */
  double *mode;   /* [EO_SHAFT_MODES][size]: matrix = sum of mode' mode, nearly */
};

/* Every number and choice of both is the same: what was bent for one serves the other. */
bool eo_shafts_equal(const struct eo_shafts *a, const struct eo_shafts *b);

/* pair: resolved; geometry: of its left end. inwards: eta runs towards the groove on both ends, as where the face ends
   there meet first; the axial part of the normals has the other sign then. Errors: memory; EO_ERROR_NUMERIC from the
   eigenvalues.
 */
enum eo_code eo_shaft_influence_init(struct eo_shaft_influence *influence, const struct eo_geometry *geometry,
                                     const struct eo_gear_pair *pair, const struct eo_material *material,
                                     const struct eo_shafts *shafts, bool inwards, struct eo_error *error);
void eo_shaft_influence_done(struct eo_shaft_influence *influence);

/* deflection[ends] under load[ends]. */
void eo_shaft_deflect(const struct eo_shaft_influence *influence, const struct eo_deflection *load,
                      struct eo_deflection *deflection);

/* Root diameter + 0.75 m_n: its torsion constant is that of the toothed section (Saint-Venant; 17 and 44 teeth of the
   basic rack ISO 53). */
double eo_shaft_effective_diameter(const struct eo_geometry *geometry, int member);

/* Round section, hollow when bore > 0; diameters, m. */
struct eo_shaft_section {
  double bending; /* E I, N m2 */
  double shear;   /* kappa G A, N */
  double torsion; /* G J, N m2 */
};
struct eo_shaft_section eo_shaft_section_of(const struct eo_material *material, double diameter, double bore);

#endif
