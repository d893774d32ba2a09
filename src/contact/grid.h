/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where teeth can touch over the mesh cycle, and how compliant they are there: all that loaded contact needs and that
   neither load nor micro-geometry changes. Made once per gear pair and resolution; read-only afterwards, shared by both
   ends and all threads. */
#ifndef EASEOFF_CONTACT_GRID_H
#define EASEOFF_CONTACT_GRID_H

#include "base/progress.h"
#include "contact/field.h"
#include "flexibility/kernel.h"
#include "gear/geometry.h"

enum eo_point_kind { EO_POINT_LINE, EO_POINT_GEAR_TIP, EO_POINT_PINION_TIP };

/* One stretch of a contact line with equal cells. */
struct eo_contact_line {
  int pair;
  enum eo_point_kind kind;
  int first, cells; /* points first .. first + cells - 1, in order of eta */
};

/* One mesh position. Arrays of `points` entries. */
struct eo_contact_position {
  double phase; /* c of pair 0 at mid face, m, 0..p_bt */
  int lines;
  struct eo_contact_line *line;
  int points;
  int first;                    /* index of its first point among those of all positions */
  struct eo_flank_point *point; /* pair, place on each flank (m), eta (m) */
  double *path;                 /* s on the plane of action, m; outside [s_A, s_E] for tip points */
  enum eo_point_kind *kind;
  double *length;    /* of the point's piece of contact line, m */
  double *law;       /* L of the local law: delta = K q (L - ln q), q in N/m */
  double *per_depth; /* 1/(K e^L), 1/m: with u = delta times it ... */
  double *strength;  /* ... the point carries length e^L w(u), N; w: numerics/local_inverse.h */
  double *radius;    /* relative curvature radius rho_n, m */
  int rank, stride;  /* of the factor; stride: see numerics/gram.h */
  float *factor;     /* [points][stride]: bulk compliance = factor factor' + remainder, m/N */
  int remainder_stride;
  float *remainder; /* [points][remainder_stride]: what the low rank leaves, some thousandths */
};

struct eo_contact_grid {
  struct eo_geometry geometry;
  struct eo_material material;
  struct eo_corner_gap corner[2];
  bool partial_cells;
  double compliance_scale; /* K = 2 (1 - nu^2) / (pi E), 1/Pa */
  int positions;
  struct eo_contact_position *position; /* [positions] */
  int points;                           /* of all positions */
  int most_points, most_rank;
};

struct eo_contact_grid_settings {
  int positions;      /* over one transverse base pitch */
  int cells;          /* equal cells on every contact line, load at their middles */
  bool partial_cells; /* a cell in which the contact ends carries as much as lies inside it; else its middle decides for
                         all of it */
  bool tip_edges;     /* points of the tip corners beyond both ends of the path of contact */
  int edge_cells;     /* on every such stretch */
  double edge_reach;  /* its length along s, m; NaN: 4/15 of the normal module */
};

/* Errors: memory, cancelled; EO_ERROR_NUMERIC when the kernel is not positive semi-definite. phase (may be NULL):
   [positions] given phases c, m, instead of equal steps. */
enum eo_code eo_contact_grid_new(struct eo_contact_grid **grid, const struct eo_geometry *geometry,
                                 const struct eo_material *material, const struct eo_contact_grid_settings *settings,
                                 const double *phase, struct eo_kernel kernel, const struct eo_progress *progress,
                                 struct eo_error *error);
void eo_contact_grid_free(struct eo_contact_grid *grid);

/* The first and the last tooth pair that can touch at any position; pair 0 is always among them. */
void eo_contact_grid_pairs(const struct eo_contact_grid *grid, int range[2]);

/* The line of the same teeth, with as many cells, at another position; NULL: there is none. */
const struct eo_contact_line *eo_contact_same_line(const struct eo_contact_position *position,
                                                   const struct eo_contact_line *line);

/* L of the local law at s: ln(4 h_p h_g pi E / (8 rho_n (1-nu^2))) - nu/(1-nu)  (Weber and Banaschek 1953). */
double eo_contact_local_constant(const struct eo_geometry *geometry, const struct eo_material *material, double s);

#endif
