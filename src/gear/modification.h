/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Micro-geometry: what is taken off a flank, as one function delta(u, x) ((F1) to (F4) of doc/theory.md: three
   parabolas and a lead parabola). u: profile coordinate k_u sigma, m from the pitch point, + towards the member's own
   tip; x = eta / cos(beta), m from mid face. */
#ifndef EASEOFF_GEAR_MODIFICATION_H
#define EASEOFF_GEAR_MODIFICATION_H

#include <stdbool.h>

#include "gear/geometry.h"

/* What is taken off one flank, normal to it; positive removes material. u: rack coordinate, x = eta / cos(beta). */
enum eo_relief_shape { EO_RELIEF_PARABOLIC, EO_RELIEF_LINEAR, EO_RELIEF_CIRCULAR };
struct eo_flank_modification {
  enum eo_relief_shape shape;
  double tip_relief;           /* d_tr at the end of the active profile, m */
  double tip_relief_start;     /* u_ts, distance from the pitch line along the rack profile, m, >= 0 */
  double root_relief;          /* d_br, m */
  double root_relief_start;    /* u_bs, m, >= 0 */
  double profile_crowning;     /* a_m, 1/m: a_m u^2 over the middle part */
  double lead_crowning;        /* a_l (b / (2 cos beta))^2: at the face ends, m */
  double lead_slope;           /* b_l x at x = + b / (2 cos beta), m */
  double lead_offset;          /* c_l, m */
  double end_relief[2];        /* [at eta = -b/2, at eta = +b/2], parabolic, m */
  double end_relief_length[2]; /* from the face end, axial, m */
};

struct eo_modification {
  struct eo_flank_modification flank[2][2]; /* [member][end] */
};

/* One flank's modification with its coefficients worked out. Plain values; copy freely. */
struct eo_modification_shape {
  enum eo_relief_shape relief;
  double crowning; /* a_m, 1/m */
  struct eo_relief {
    double start;        /* |u| of the vertex, m */
    double length;       /* from the vertex to the end of the active profile, m; 0: no relief on this side */
    double value, slope; /* of the middle parabola at the vertex, towards the end */
    double depth;        /* what is missing at the end of the active profile after value and slope, m */
  } side[2];             /* [root, tip] */
  double lead[3];        /* c_l (m), b_l, a_l (1/m) */
  double end_relief[2], end_start[2]; /* [eta < 0, eta > 0]: amount (m) and |x| where it starts */
  double half_width;                  /* |x| at the face ends, m */
};

/* member: whose flank it is (its active profile ends where the other member's tip leaves it). */
void eo_modification_init(struct eo_modification_shape *shape, const struct eo_geometry *geometry, int member,
                          const struct eo_flank_modification *flank);

/* Profile part d(u), m; slope[0], slope[1]: derivative just below and just above u (they differ at the kink of a linear
   relief). */
double eo_modification_profile(const struct eo_modification_shape *shape, double u, double slope[2]);

/* Lead part l(x), m, and its derivative. */
double eo_modification_lead(const struct eo_modification_shape *shape, double x, double *slope);

/* a_l of a lead crowning given at the face ends, 1/m, and back. */
double eo_modification_lead_coefficient(const struct eo_geometry *geometry, double crowning);

/* True when both take off the same. */
bool eo_modification_equal(const struct eo_flank_modification *a, const struct eo_flank_modification *b);

/* True when nothing is taken off. */
bool eo_modification_is_none(const struct eo_flank_modification *flank);

#endif
