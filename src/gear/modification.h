/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Micro-geometry: what is taken off a flank, as one function delta(u, y) (doc/theory/flank.md; terms by name
   after ISO 21771, and a free grid). u: profile coordinate k_u sigma, m from the pitch point, + towards the member's
   own tip; y: axial, m from mid face, + towards the face end that meets first when the drive flank is used. It belongs
   to the body: on the coast flank y runs against eta. x = eta / cos(beta). */
#ifndef EASEOFF_GEAR_MODIFICATION_H
#define EASEOFF_GEAR_MODIFICATION_H

#include <stdbool.h>

#include "gear/flank_grid.h"
#include "gear/geometry.h"

enum eo_relief_shape { EO_RELIEF_PARABOLIC, EO_RELIEF_LINEAR, EO_RELIEF_CIRCULAR, EO_RELIEF_EXPONENT };

/* The shape of one relief where two share a word: 0 takes it over, else 1 + enum eo_relief_shape. */
enum { EO_RELIEF_AS_SHARED };

/* Sides of a profile and of a face. */
enum { EO_ROOT_SIDE, EO_TIP_SIDE };
enum { EO_TRAILING_SIDE, EO_LEADING_SIDE };

/* Where a relief starts, other than by the rack coordinate. One of them at most; not above 0 (or NaN): not stated. */
struct eo_relief_place {
  double diameter;    /* m */
  double roll_length; /* from the base circle, transverse, m */
  double roll_angle;  /* roll length / base radius, rad */
  double length;      /* from that end of the active profile, along the path of contact, m */
};

/* C_Ea, C_Ef: amount (1 - p / profile_length - q / face_length)^exponent where that is above 0; p, q: distances along u
   and y from the corner. */
struct eo_triangular_relief {
  double amount;         /* at the corner, m */
  double profile_length; /* along u, m */
  double face_length;    /* along y, m */
  double exponent;       /* 0: 1 */
};

enum { EO_MOST_GRID_NODES = 48 };

/* What is taken off one flank, normal to it; positive removes material. */
struct eo_flank_modification {
  enum eo_relief_shape shape;        /* of both reliefs */
  int own_shape[2];                  /* [root, tip]: EO_RELIEF_AS_SHARED or 1 + enum eo_relief_shape */
  enum eo_relief_shape end_shape[2]; /* of the end reliefs [trailing, leading] */
  double tip_relief;                 /* C_alphaa, d_tr at the end of the active profile, m */
  double tip_relief_start;           /* u_ts, distance from the pitch line along the rack profile, m, >= 0 */
  double root_relief;                /* C_alphaf, d_br, m */
  double root_relief_start;          /* u_bs, m, >= 0 */
  double profile_crowning;           /* a_m, 1/m: a_m u^2 over the middle part */
  double lead_crowning;              /* C_beta, a_l (b / (2 cos beta))^2: at the face ends, m */
  double helix_slope;   /* C_Hbeta: over the face width, 0 at mid face, m; + takes more off on the leading side */
  double lead_offset;   /* c_l, m */
  double end_relief[2]; /* [trailing, at y = -b/2; leading, at y = +b/2], m */
  double end_relief_length[2]; /* from the face end, axial, m */
  double profile_slope;        /* C_Halpha: over the active profile, 0 in its middle, m; + takes more off at the tip */
  double profile_barrel;       /* C_alpha: at both ends of the active profile, 0 in its middle, m */
  double twist;                /* S_alpha: change of C_Halpha from the trailing to the leading face end, m */
  double grid_gain;            /* what of the grid is laid on beyond it, as a share: 0 as it stands, -1 none */
  double end_exponent[2];      /* with EO_RELIEF_EXPONENT; 0: 2 */
  double exponent[2];          /* of the reliefs [root, tip] with EO_RELIEF_EXPONENT; 0: 2 */
  struct eo_relief_place place[2];              /* [root, tip] */
  struct eo_triangular_relief triangular[2][2]; /* [root, tip][trailing, leading] */
  int nodes;
  struct eo_grid_node node[EO_MOST_GRID_NODES]; /* in place of what the flank's grid has there; what a search varies */
};

struct eo_modification {
  struct eo_flank_modification flank[2][2]; /* [member][end]: the drive flanks */
  struct eo_flank_modification coast[2][2]; /* [member][end] */
};

/* One flank's modification with its coefficients worked out. Plain values; copy freely. */
struct eo_modification_shape {
  double crowning; /* a_m, 1/m */
  struct eo_relief {
    enum eo_relief_shape shape;
    double exponent;
    double start;        /* of the vertex along u, away from the middle, m (less than 0: beyond the pitch point) */
    double length;       /* from the vertex to the end of the active profile, m; 0: no relief on this side */
    double value, slope; /* of the middle parabola at the vertex, towards the end */
    double depth;        /* what is missing at the end of the active profile after value and slope, m */
  } side[2];             /* [root, tip] */
  double lead[3];        /* c_l (m), b_l, a_l (1/m) */
  struct eo_end_relief {
    enum eo_relief_shape shape;
    double exponent, amount, start; /* amount m; |x| where it starts, m */
  } end[2];                         /* [trailing, leading] */
  double half_width;                /* |x| at the face ends, m */
  double lengthen;                  /* 1/cos(beta): from y to x */
  double middle, half_profile;      /* u in the middle of the active profile and half its length, m */
  double moved; /* what u counts from beyond the pitch point that the flank is drawn for, m: eo_modification_move() */

  /* beside reliefs and crowning, in the profile of one slice: */
  bool has_terms;         /* any of these */
  double incline;         /* per m of u from the middle: profile slope, and the slice's share of twist */
  double barrel;          /* 1/m, times (u - middle)^2 */
  struct eo_wedge {       /* a triangular relief, cut by the slice */
    double start, length; /* along u away from the middle, m */
    double amount;        /* per exponent-th power of (distance from start / length), m */
    double exponent;
    double rate; /* of start, along y */
  } wedge[4];
  int wedges;
  double y; /* the slice */

  /* what differs from slice to slice: */
  bool varies;
  bool mirrored; /* a coast flank: y = -eta */
  double twist;  /* incline per m of y, 1/m */
  struct eo_triangular_relief triangular[2][2];
  double grid_share;                  /* of it that is laid on: 1 as it stands */
  const struct eo_flank_spline *grid; /* borrowed; NULL: none */
};

/* Sets, or adds, a number in place of the grid's; false: there is room for no more. */
bool eo_modification_set_node(struct eo_flank_modification *flank, int row, int column, double delta);
/* That number; NULL: none is stated. */
const double *eo_modification_node(const struct eo_flank_modification *flank, int row, int column);
void eo_modification_drop_node(struct eo_flank_modification *flank, int row, int column);
/* Puts the numbers of all flanks into the grids; false: there are none. */
bool eo_modification_lay_nodes(const struct eo_modification *modification, struct eo_flank_grids *grids);
bool eo_modification_has_nodes(const struct eo_modification *modification);

/* member: whose flank it is (its active profile ends where the other member's tip leaves it). */
void eo_modification_init(struct eo_modification_shape *shape, const struct eo_geometry *geometry, int member,
                          const struct eo_flank_modification *flank);

/* Adds a grid (NULL: none); mirrored: the flank is a coast flank, so that y runs against eta. */
void eo_modification_complete(struct eo_modification_shape *shape, const struct eo_flank_spline *grid, bool mirrored);

/* From now on u counts from the pitch point of a pair whose axes may stand further apart than it is drawn for. */
void eo_modification_move(struct eo_modification_shape *shape, const struct eo_geometry *geometry, int member);

/* The shape whose profile is that of the transverse slice at eta; the lead part stays. */
void eo_modification_slice(const struct eo_modification_shape *shape, double eta, struct eo_modification_shape *slice);

/* Profile part d(u), m, of a slice (of mid face when none was taken); slope[0], slope[1]: derivative just below and
   just above u (they differ at kinks). */
double eo_modification_profile(const struct eo_modification_shape *shape, double u, double slope[2]);

/* Derivative of a slice's profile part at u by y; at a kink the mean of both sides. */
double eo_modification_across(const struct eo_modification_shape *slice, double u);

/* Places of a slice's profile where curvature or slope jump, increasing; returns how many. */
enum { EO_MOST_VERTICES = 8 };
int eo_modification_vertices(const struct eo_modification_shape *slice, double vertex[EO_MOST_VERTICES]);

/* True when the profile of a slice is not 0 everywhere. */
bool eo_modification_has_profile(const struct eo_modification_shape *slice);

/* Lead part l(x), m, and its derivative: what depends on the place over the face alone. */
double eo_modification_lead(const struct eo_modification_shape *shape, double x, double *slope);

/* All of it at (u, eta), m. */
double eo_modification_at(const struct eo_modification_shape *shape, double u, double eta);

/* a_l of a lead crowning given at the face ends, 1/m, and back. */
double eo_modification_lead_coefficient(const struct eo_geometry *geometry, double crowning);

/* One place on a flank in all the ways in which drawings state it. */
struct eo_profile_place {
  double rack;        /* u, m */
  double diameter;    /* m */
  double roll_length; /* m */
  double roll_angle;  /* rad */
  double length[2];   /* [from the root end, from the tip end] of the active profile along the path of contact, m */
};
struct eo_profile_place eo_profile_place_at(const struct eo_geometry *geometry, int member, double u);

/* u where a relief starts, m, in whichever way the flank states it; side: EO_ROOT_SIDE or EO_TIP_SIDE. NaN: at no place
   of the involute. */
double eo_relief_start_at(const struct eo_geometry *geometry, int member, const struct eo_flank_modification *flank,
                          int side);

/* How many of the other ways to state a start are used. */
int eo_relief_places_stated(const struct eo_relief_place *place);

/* Ends of a member's active profile, u, m: [root, tip]; as places, starts and shapes above, of the pair as it is drawn.
 */
void eo_active_profile(const struct eo_geometry *geometry, int member, double end[2]);

/* True when both take off the same. */
bool eo_modification_equal(const struct eo_flank_modification *a, const struct eo_flank_modification *b);

/* True when nothing is taken off beside the grid as it stands. */
bool eo_modification_is_none(const struct eo_flank_modification *flank);

#endif
