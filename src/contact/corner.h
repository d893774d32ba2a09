/* The tip corner of one member against the flank of the other beyond the ends of the path of contact (tip-edge
   contact). */
#ifndef EASEOFF_CONTACT_CORNER_H
#define EASEOFF_CONTACT_CORNER_H

#include "gear/surface.h"

/* Gap over the distance d >= 0 from the end of the path (transverse, m), normal to the flank, the tip at its nominal
   phase, the flank turned until it touches; and the place on the flank at the corner's radius. [0]: gear tip before
   s_A, [1]: pinion tip after s_E. Up to `start` the flanks still meet inside the tip, because relief has moved the
   contact away from it: there the slice gap goes on. */
enum { EO_CORNER_NODES = 41 };
struct eo_corner_gap {
  bool at_radius;                /* relief by eo_corner_gap_at_radius() instead of exactly */
  double start;                  /* d from which the corner is nearest, m; 0 for unmodified flanks */
  double reach;                  /* the table covers start .. reach, m */
  double gap[EO_CORNER_NODES];   /* m */
  double slope[EO_CORNER_NODES]; /* d gap / d d */
  double path[EO_CORNER_NODES];  /* s of the place on the other member's flank, m */
};

/* Unmodified flanks: depends on the macro-geometry alone. */
void eo_corner_gap_init(struct eo_corner_gap corner[2], const struct eo_geometry *geometry);

/* Flanks with profile relief (shape: [member]) and their slice gap, which the corner's joins without a step. */
void eo_corner_gap_modified(struct eo_corner_gap corner[2], const struct eo_geometry *geometry,
                            const struct eo_modification_shape shape[2], const struct eo_slice_gap *slice);

/* A shorter convention, for reference cases that state it: the unmodified table plus the slice gap of each member's
   relief at the corner's own place. It is up to some micrometres too small just beyond the path, where the slices still
   meet inside the tip. */
void eo_corner_gap_at_radius(struct eo_corner_gap corner[2], const struct eo_geometry *geometry,
                             const struct eo_modification_shape shape[2]);

/* d >= start; *slope: by d; *place: s on the flank; *travel: its derivative by d. */
double eo_corner_gap_at(const struct eo_corner_gap *corner, double d, double *slope, double *place, double *travel);

#endif
