/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How far two points are apart by what is seen of them (cube_warp.h), in the unit of the cube: random points are as far
   from each other as in it. Points that differ in what does nothing are the same. Without a view the distance in the
   cube. */
#ifndef EASEOFF_OPTIMIZER_VIEW_DISTANCE_H
#define EASEOFF_OPTIMIZER_VIEW_DISTANCE_H

#include "optimizer/cube_warp.h"
#include "optimizer/true_rows.h"

struct eo_view_distance {
  const struct eo_cube_warp *warp; /* borrowed */
  int numbers;                     /* that describe a point */
  double scale;
  int count, capacity;
  double *row;   /* [count][numbers] of the archive's rows; owned, as is the next */
  double *point; /* [numbers] of the point last looked at */
};

/* Without rows. warp: borrowed. Errors: memory. */
enum eo_code eo_view_distance_init(struct eo_view_distance *distance, const struct eo_cube_warp *warp,
                                   struct eo_error *error);
void eo_view_distance_done(struct eo_view_distance *distance);

/* Looks at the rows that it does not know: before anything below is asked of them. */
enum eo_code eo_view_distance_follow(struct eo_view_distance *distance, const struct eo_archive *archive,
                                     struct eo_error *error);

/* Goes to x[variables]; then its distance from a row. */
void eo_view_distance_visit(struct eo_view_distance *distance, const double *x);
double eo_view_distance_from(const struct eo_view_distance *distance, int row);

/* Of two rows. */
double eo_view_distance_between(const struct eo_view_distance *distance, int row, int other);

#endif
