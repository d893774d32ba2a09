/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The gap between the flanks of one end, everywhere they can meet: one field serves loaded contact, unloaded contact
   and impact. */
#ifndef EASEOFF_CONTACT_FIELD_H
#define EASEOFF_CONTACT_FIELD_H

#include "contact/corner.h"
#include "gear/surface.h"

/* How far elastic bodies open the gap of one end: part[0](eta) + s part[1](eta), linear between nodes at equal steps
   from eta = -b/2 to +b/2. The second part is the local slope of the bodies, which acts as a shaft angle error does. */
enum { EO_DEFLECTION_NODES = 33 };
struct eo_deflection {
  double part[2][EO_DEFLECTION_NODES]; /* m, normal; m per m of s */
};

/* The tip corners of flanks whose profile changes over the face: at equal steps from eta = -b/2 to +b/2, linear between
   them. */
enum { EO_CORNER_STATIONS = 9 };
struct eo_corner_station {
  struct eo_corner_gap corner[2];
  struct eo_tilted_corner tilted[2];
};

struct eo_gap_field {
  const struct eo_geometry *geometry;    /* borrowed */
  struct eo_modification_shape shape[2]; /* [member] */
  struct eo_slice_gap slice;             /* of both members' profile relief */
  struct eo_corner_gap corner[2];        /* beyond s_A, beyond s_E */
  double lean, stretch;                  /* tan(beta_b); 1/cos(beta), from eta to x */
  double pivot;                          /* of the shaft angle errors from mid face, m */
  double misalignment;                   /* unmodified flanks on the path: the gap by eta + pivot + s tan(beta_b) */
  double lever[EO_SLICE_NODES], shift[EO_SLICE_NODES]; /* the errors' share at the nodes of the slice gap */
  struct eo_tilted_corner tilted[2];                   /* the corners under them */
  double takes_over[2];                                /* the least d at which a corner can strike anywhere, m */
  double errors[2];                                    /* kappa, gamma as the end sees them, rad */
  double offset;                                       /* on every gap, m: what displaces a whole flank */
  bool varies;                                         /* profiles differ from slice to slice: each is met on its own */
  struct eo_corner_station station[EO_CORNER_STATIONS]; /* of such flanks */
  const struct eo_deflection *deflection; /* of the bodies; borrowed; NULL: rigid, as eo_gap_field_init() leaves it */
};

/* Shaft angle errors enter as a rigid rotation of the gear (kappa in the plane of the axes, gamma across it), with the
   normal and the place of the contact as relief has moved them. On unmodified flanks, end = -1 left, +1 right,
   alpha = alpha_wt:
     D = end [gamma cos(alpha) - kappa sin(alpha)] [cos(beta_b) (eta + pivot) + sin(beta_b) s]
   as long as flanks meet; at a tip corner d beyond the end of the path, to first order in the angles,
     D = end {cos(beta_b) [gamma cos(alpha') - kappa sin(alpha')] (eta + pivot)
            + sin(beta_b) [(gamma cos(alpha) - kappa sin(alpha)) s + f d (kappa cos(alpha) + gamma sin(alpha))]},
   alpha' = alpha + |place - s| / r_b of the flank that is struck (relief turns it back by delta' r_b / (rho cos
   beta_b)), f = -(T2C - s_A)/r_b2 at the gear's tip, (T1C + s_E)/r_b1 at the pinion's. The code has the share over the
   first line as an advance of d (contact/corner.h): the errors move the end of the path of contact in each slice, and
   the corner takes over there. The constant that the rotation has at the pitch point, end sin(beta_b) kappa r_w2, and
   the axial shift kappa r_w2 are left out: axial float removes them.

   Elastic bodies open the gap by part[0](eta) + s part[1](eta), at tip corners too: their sections move in the plane of
   action, for which the rule above is the same but for 1 - cos(alpha' - alpha), less than 0.1 % of part[0] at half a
   millimetre. What the sections move across that plane (some 0.3 um from the moments of the thrust on the paper pair),
   times sin(alpha' - alpha), is left out. */

/* end: EO_LEFT or EO_RIGHT (sign -1, +1). in_plane (kappa), out_of_plane (gamma): shaft angle errors, rad.
   pivot: distance of the end's mid face from the pivot of the error, m ((b + groove)/2 for the middle of the groove, 0
   for its own mid face). corner: of the unmodified pair. */
void eo_gap_field_init(struct eo_gap_field *field, const struct eo_geometry *geometry,
                       const struct eo_flank_modification *pinion, const struct eo_flank_modification *gear, int end,
                       double in_plane, double out_of_plane, double pivot, const struct eo_corner_gap corner[2]);

/* The same for flanks of any kind: shape [member], complete, each with y along or against eta; grids stay borrowed. */
void eo_gap_field_init_shapes(struct eo_gap_field *field, const struct eo_geometry *geometry,
                              const struct eo_modification_shape shape[2], int end, double in_plane,
                              double out_of_plane, double pivot, const struct eo_corner_gap corner[2]);

/* Gap at (s, eta), m, normal; beyond the path of contact the tip corner's against the modified flank, from where the
   slices no longer meet inside the tip. *slope (may be NULL): its derivative along s at constant eta.
   path (may be NULL): [member] place on each flank. */
double eo_gap_field_at(const struct eo_gap_field *field, double s, double eta, double *slope, double path[2]);

/* The smallest gap anywhere on the active flank (rectangle s_A..s_E x face width), m; where profiles vary over the
   face, of a grid of places and a search about the lowest of them. */
double eo_gap_field_datum(const struct eo_gap_field *field);

/* The smallest gap along the contact line s = c + eta tan(beta_b), over the face width and, when edges is set, the tip
   corners within reach of it; *at: the eta where it is. Returns INFINITY when the line misses the flank. */
double eo_gap_field_line_minimum(const struct eo_gap_field *field, double c, bool edges, double *at);

/* Where that line lies over the face: range[2] of eta, m; false: it misses. */
bool eo_gap_field_edge_range(const struct eo_gap_field *field, double c, bool edges, double range[2]);

/* The smallest gap of the line within a step of *eta, where it is `gap`, and within the range; *eta: where it is. */
double eo_gap_field_line_descend(const struct eo_gap_field *field, double c, const double range[2], double step,
                                 double gap, double *eta);

/* The eta range of the contact line at phase c whose s lies in [low, high]; false when empty. */
bool eo_gap_field_line_range(const struct eo_geometry *geometry, double c, double low, double high, double range[2]);

#endif
