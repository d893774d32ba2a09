/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Normals of a transverse slice of a flank, one by one and in order; the inside of the slice gap (surface.h). */
#ifndef EASEOFF_GEAR_SLICE_WALK_H
#define EASEOFF_GEAR_SLICE_WALK_H

#include "gear/modification.h"

/* What a slice's flank shows to its partner: the arm of its normal about its own axis, the distance along the normal
   from the foot of that arm, and the direction angle it has when the tooth stands at roll 0. */
struct eo_slice_ray {
  double arm, distance, angle;
};

/* Angles of the generating rack. */
struct eo_slice_rack {
  double sa, ca, sb, cb; /* sin and cos of alpha_n and beta */
};

/* Of the pair as it is. */
struct eo_slice_rack eo_slice_rack_of(const struct eo_geometry *geometry);

/* delta, d: relief at u and its slope (at a kink any slope between those of its two sides: the normal there turns about
   the vertex). */
struct eo_slice_ray eo_slice_ray_on(const struct eo_slice_rack *rack, const struct eo_geometry *geometry, int member,
                                    double u, double delta, double d);

/* Of the unmodified flank, by the distance. */
struct eo_slice_ray eo_slice_involute_ray(const struct eo_geometry *geometry, int member, double distance);

/* Angle of the common normal for two arms. */
double eo_slice_common_angle(const struct eo_geometry *geometry, const struct eo_slice_ray *ray,
                             const struct eo_slice_ray *this_ray);

/* How far two normals are from lying in one line: their distances along it have to add up to a sin(alpha'). */
double eo_slice_miss(const struct eo_geometry *geometry, const struct eo_slice_ray *ray,
                     const struct eo_slice_ray *this_ray);

/* How far beyond the active profile, in parts of it, a touch is looked for: in the table of gaps, and in the walk over
   a flank, which has to hold every place that the table asks for. */
static const double EO_TABLE_MARGIN = 0.15, EO_WALK_MARGIN = 0.3;

/* A walk is every normal of a flank in order, so that the one in line with a given normal of the partner can be found.
   The coordinate w is u, stretched at each kink by the width of a fan in which the normal turns about the vertex. */
struct eo_slice_walk {
  const struct eo_geometry *geometry;
  const struct eo_modification_shape *shape;
  int member, kinks;
  double kink[EO_MOST_VERTICES]; /* u, increasing */
  double low, high;              /* w at the ends */
};

/* geometry and shape: borrowed. The walk goes EO_WALK_MARGIN beyond the active profile. */
void eo_slice_walk_init(struct eo_slice_walk *walk, const struct eo_geometry *geometry, int member,
                        const struct eo_modification_shape *shape);
/* The normal at w; within a fan it turns about the vertex. */
struct eo_slice_ray eo_slice_walk_ray(const struct eo_slice_walk *walk, double w);

/* The coordinate of a place u: before (side 0) or behind (side 1) the fan of a kink there. */
double eo_slice_walk_place(const struct eo_slice_walk *walk, double u, int side);

/* The ray of the walk in line with that of the other member, near the place *w. False when there is none: beyond
   reliefs so steep that the flank's normals leave the mesh. */
bool eo_slice_walk_in_line(const struct eo_slice_walk *walk, const struct eo_slice_ray *other, double *w,
                           struct eo_slice_ray *ray);

/* The unmodified flank's ray in line with that of the other member: its arm is the base radius. */
struct eo_slice_ray eo_slice_involute_in_line(const struct eo_geometry *geometry, int member,
                                              const struct eo_slice_ray *other);

#endif
