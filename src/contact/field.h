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

double eo_deflection_at(const struct eo_deflection *deflection, double face_width, double s, double eta);

struct eo_gap_field {
  const struct eo_geometry *geometry;     /* borrowed */
  struct eo_modification_shape shape[2];  /* [member] */
  struct eo_slice_gap slice;              /* of both members' profile relief */
  struct eo_corner_gap corner[2];         /* beyond s_A, beyond s_E */
  double lean, stretch;                   /* tan(beta_b); 1/cos(beta), from eta to x */
  double misalignment;                    /* slope of the misalignment gap along eta + s tan(beta_b) */
  double misalignment_offset;             /* its constant, m (removed by axial float) */
  const struct eo_deflection *deflection; /* of the bodies; borrowed; NULL: rigid, as eo_gap_field_init() leaves it */
};

/* end: EO_LEFT or EO_RIGHT (sign -1, +1). in_plane (kappa), out_of_plane (gamma): shaft angle errors, rad.
   pivot: distance of the end's mid face from the pivot of the error, m ((b + groove)/2 for the middle of the groove, 0
   for its own mid face). corner: of the unmodified pair. */
void eo_gap_field_init(struct eo_gap_field *field, const struct eo_geometry *geometry,
                       const struct eo_flank_modification *pinion, const struct eo_flank_modification *gear, int end,
                       double in_plane, double out_of_plane, double pivot, const struct eo_corner_gap corner[2]);

/* Gap at (s, eta), m, normal; beyond the path of contact the tip corner's against the modified flank at the
   corner's radius. *slope (may be NULL): its derivative along s at constant eta.
   path (may be NULL): [member] place on each flank. */
double eo_gap_field_at(const struct eo_gap_field *field, double s, double eta, double *slope, double path[2]);

/* The smallest gap anywhere on the active flank (rectangle s_A..s_E x face width), m. */
double eo_gap_field_datum(const struct eo_gap_field *field);

/* The smallest gap along the contact line s = c + eta tan(beta_b), over the face width and, when edges is set, the tip
   corners within reach of it; *at: the eta where it is. Returns INFINITY when the line misses the flank. */
double eo_gap_field_line_minimum(const struct eo_gap_field *field, double c, bool edges, double *at);

/* The eta range of the contact line at phase c whose s lies in [low, high]; false when empty. */
bool eo_gap_field_line_range(const struct eo_geometry *geometry, double c, double low, double high, double range[2]);

#endif
