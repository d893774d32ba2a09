/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A flank's deviation as a grid of numbers, measured or designed, and the smooth surface through it. */
#ifndef EASEOFF_GEAR_FLANK_GRID_H
#define EASEOFF_GEAR_FLANK_GRID_H

#include <stdbool.h>

#include "base/error.h"

/* Which side of the teeth: the one that carries when the design runs as it is meant to, and the other one. */
enum eo_flank_side { EO_DRIVE_FLANK, EO_COAST_FLANK };

/* All grids of a design, as plain values: copies need no care. Numbers of one grid stand together: u [u_knots], m, y
   [y_knots], m, both increasing, then delta [u_knots][y_knots], m, + removes material. u: rack coordinate from the
   working pitch point, + towards the member's own tip; y: axial from mid face, + towards the face end that meets first
   on the drive flank. */
enum { EO_GRID_NUMBERS = 16384, EO_GRID_KNOTS = 1024 };

/* What a grid says: how the flank is, also where nobody modifies it, or what a designer or a search takes off. */
enum eo_grid_kind { EO_GRID_MEASURED, EO_GRID_DESIGNED };

struct eo_flank_grids {
  struct eo_grid_place {
    int u_knots, y_knots; /* 0: no grid */
    int first;
    enum eo_grid_kind kind;
    bool kind_stated; /* by the document */
  } place[2][2][2];   /* [flank side][member][end] */
  int used;
  double number[EO_GRID_NUMBERS];
};

/* One grid, borrowed. */
struct eo_flank_grid {
  int u_knots, y_knots; /* 0: none */
  const double *u, *y;
  const double *delta; /* [u_knots][y_knots] */
  enum eo_grid_kind kind;
  bool kind_stated;
};

/* The grid of one flank; u_knots 0 where it has none. */
struct eo_flank_grid eo_flank_grid_at(const struct eo_flank_grids *grids, enum eo_flank_side side, int member, int end);

/* Adds or replaces a grid; u_knots 0 takes it away. EO_ERROR_INPUT: the grids together do not fit. */
enum eo_code eo_flank_grids_put(struct eo_flank_grids *grids, enum eo_flank_side side, int member, int end,
                                const struct eo_flank_grid *grid, struct eo_error *error);

/* A number in place of what a grid has at a knot; row of u, column of y, from 1 on; 0: at every one. */
struct eo_grid_node {
  int row, column;
  double delta; /* m */
};

/* Puts the numbers into delta[u_knots][y_knots], in their order. */
void eo_grid_nodes_lay(int nodes, const struct eo_grid_node *node, int u_knots, int y_knots, double *delta);
/* The number that every knot of a node has; NaN where they differ or the grid has no such knot. */
double eo_flank_grid_number(const struct eo_flank_grid *grid, int row, int column);

/* The same surface, of whichever kind. */
bool eo_flank_grid_equal(const struct eo_flank_grid *a, const struct eo_flank_grid *b);

/* The same surfaces everywhere. */
bool eo_flank_grids_equal(const struct eo_flank_grids *a, const struct eo_flank_grids *b);

/* Natural bicubic spline: natural cubic splines (second derivative 0 at both border knots) along u and along y, tensor
   product (de Boor 2001, chapter XVII); with 2 knots a straight line. Twice continuously differentiable inside; beyond
   the outermost knots the value of the nearest border point, along u and along y separately. */
struct eo_flank_spline {
  int u_knots, y_knots;
  double *u, *y;       /* owned */
  double *coefficient; /* owned [u_knots][y_knots][4]: delta, its second derivative by u, by y, and both */
};

/* The grid is copied. Errors: memory. */
enum eo_code eo_flank_spline_new(struct eo_flank_spline **spline, const struct eo_flank_grid *grid,
                                 struct eo_error *error);
void eo_flank_spline_free(struct eo_flank_spline *spline);

/* delta, m; slope (may be NULL): its derivative by u just below and just above u, which differ at the borders. */
double eo_flank_spline_at(const struct eo_flank_spline *spline, double u, double y, double slope[2]);

/* Its derivative by y; at the borders the mean of both sides. */
double eo_flank_spline_across(const struct eo_flank_spline *spline, double u, double y);

#endif
