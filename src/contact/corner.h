/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tip corner of one member against the flank of the other beyond the ends of the path of contact (tip-edge
   contact). */
#ifndef EASEOFF_CONTACT_CORNER_H
#define EASEOFF_CONTACT_CORNER_H

#include "gear/surface.h"

/* Beyond the path of contact the slices would go on touching where the tip has already ended; what touches instead is
   the corner, and the gap is larger than the slices' by the excess E(d), d the distance from the end of the path
   (transverse, m). [0]: gear tip before s_A, [1]: pinion tip after s_E. The corner takes over at `start`, where E and
   its slope are 0: at the end of the path on unmodified flanks, beyond it where relief moves the contact away from the
   tip.

   A shaft angle error displaces the gear in every slice, and with it the place where the corner takes over: the excess
   becomes E(d + advance), with neither a step nor a kink there. To first order in the angles E' advance is what the
   turned normal and the moved place of the corner on the flank make. At 0.1 deg, module 6 mm, a rigid rotation is met
   within 0.1 um up to half a millimetre beyond the path, where the first order alone is off by up to 0.6 um. */
enum { EO_CORNER_NODES = 41 };

/* How shaft angle errors enter: as a rotation, but for reference cases that state something shorter. */
enum eo_tilt_rule {
  EO_TILT_ROTATED,
  EO_TILT_SLOPE,     /* on the path the form of unmodified flanks, relief or not; tip corners as a rotation */
  EO_TILT_AT_RADIUS, /* on the path the same; tip corners by eo_corner_gap_at_radius() */
};

struct eo_corner_gap {
  enum eo_tilt_rule rule;
  double start;                            /* d from which the corner is nearest, m; 0 for unmodified flanks */
  double reach;                            /* the table covers start .. reach, m */
  double excess[EO_CORNER_NODES];          /* E, m, normal to the flank, the tip at its nominal phase, the flank turned
                                              until it touches */
  double slope[EO_CORNER_NODES];           /* dE / dd */
  double path[EO_CORNER_NODES];            /* s of the place on the other member's flank, m */
  struct eo_tilt advance[EO_CORNER_NODES]; /* of d by shaft angle errors, per rad: lever, m per m of z; shift, m */
  struct eo_tilt added[EO_CORNER_NODES];   /* EO_TILT_AT_RADIUS: what they add to E directly */
};

/* Unmodified flanks: depends on the macro-geometry alone. */
void eo_corner_gap_init(struct eo_corner_gap corner[2], const struct eo_geometry *geometry);

/* Flanks with profile relief (shape: [member]) and their slice gap. */
void eo_corner_gap_modified(struct eo_corner_gap corner[2], const struct eo_geometry *geometry,
                            const struct eo_modification_shape shape[2], const struct eo_slice_gap *slice);

/* A shorter convention, for reference cases that state it: the unmodified excess plus the slice gap of each member's
   relief at the corner's own place, and the shaft angle errors' share of flanks that meet on the path there. slice: of
   both members. The relief is up to some micrometres too small just beyond the path, where the slices still meet inside
   the tip; the errors' share is off by up to 3 um at 0.1 deg half a millimetre beyond the path (module 6 mm). */
void eo_corner_gap_at_radius(struct eo_corner_gap corner[2], const struct eo_geometry *geometry,
                             const struct eo_modification_shape shape[2], const struct eo_slice_gap *slice);

/* The corner under one pair of shaft angle errors. */
struct eo_tilted_corner {
  double level[EO_CORNER_NODES], level_slope[EO_CORNER_NODES]; /* E and what is added to it, m, and by d */
  double lever[EO_CORNER_NODES], shift[EO_CORNER_NODES];       /* advance: shift + z lever, m */
};

/* errors: kappa, gamma, rad, as the end sees them. */
void eo_corner_gap_tilt(struct eo_tilted_corner *tilted, const struct eo_corner_gap *corner, const double errors[2]);

/* Excess at d (negative inside the path), z from the pivot of the errors, m; 0 where the flanks meet inside the tip.
 *slope: by d. */
double eo_corner_gap_at(const struct eo_corner_gap *corner, const struct eo_tilted_corner *tilted, double d, double z,
                        double *slope);

/* s of the place on the flank that the corner strikes (or, before it does, the slices) at d >= 0, errors apart; end: of
   the path. */
double eo_corner_gap_place(const struct eo_corner_gap *corner, double end, double d);

#endif
