/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The unit cube stretched so that equal steps of a variable change what is seen by equal amounts: where bounds are far
   wider than what matters, most of the cube is the same to the value, and points spread evenly would miss the rest
   (theory (H9)). */
#ifndef EASEOFF_OPTIMIZER_CUBE_WARP_H
#define EASEOFF_OPTIMIZER_CUBE_WARP_H

#include "base/error.h"

/* seen[numbers] of a point x[variables] of the unit cube, whatever shows by how much two points differ: continuous, the
   same for the same x. */
typedef void eo_view_function(void *context, const double *x, double *seen);

struct eo_view {
  int numbers; /* 0: the cube as it is */
  eo_view_function *at;
  void *context; /* borrowed */
};

enum { EO_WARP_KNOTS = 33 };

struct eo_cube_warp {
  struct eo_view view;
  int variables;
  double (*knot)[EO_WARP_KNOTS]; /* [variables] x at equal steps of t, from 0 to 1, increasing; owned. NULL: x = t,
                                    since the bounds are not too wide */
};

/* Errors: memory. */
enum eo_code eo_cube_warp_init(struct eo_cube_warp *warp, const struct eo_view *view, int variables,
                               struct eo_error *error);
void eo_cube_warp_done(struct eo_cube_warp *warp);

/* x[variables] of t[variables] and back; 0 and 1 stay where they are. Bits stay, too, where nothing is stretched. */
void eo_cube_warp_out(const struct eo_cube_warp *warp, const double *t, double *x);
void eo_cube_warp_in(const struct eo_cube_warp *warp, const double *x, double *t);

#endif
