/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gear/surface.h"

#include <math.h>
#include <stddef.h>

double eo_surface_relief(const struct eo_modification_shape *shape, double u, double x, double slope[2])
{
  double sides[2], lead = eo_modification_lead(shape, x, &slope[1]), profile;
  if (shape->varies) {
    struct eo_modification_shape slice;
    eo_modification_slice(shape, x / shape->lengthen, &slice);
    profile = eo_modification_profile(&slice, u, sides);
    slope[1] += (shape->mirrored ? -1 : 1) * eo_modification_across(&slice, u) / shape->lengthen;
  } else
    profile = eo_modification_profile(shape, u, sides);
  slope[0] = (sides[0] + sides[1]) / 2;
  return profile + lead;
}

/* Where the rack's point is over the face: x of the modification; against v on the gear. */
static double across_face(const struct eo_geometry *geometry, int member, double u, double v)
{
  double skew = sin(geometry->normal_pressure_angle) * sin(geometry->helix_angle) / cos(geometry->helix_angle);
  return (member == EO_PINION ? 1 : -1) * (v + (u + geometry->rack_offset[member]) * skew);
}

void eo_surface_evaluate(const struct eo_geometry *geometry, int member, const struct eo_modification_shape *shape,
                         double u, double v, struct eo_surface_point *point)
{
  double slope[2], delta = eo_surface_relief(shape, u, across_face(geometry, member, u, v), slope);
  eo_surface_generate(geometry, member, u, v, delta, slope, point);
}

void eo_surface_generate(const struct eo_geometry *geometry, int member, double u, double v, double delta,
                         const double slope[2], struct eo_surface_point *point)
{
  double sa = sin(geometry->normal_pressure_angle), ca = cos(geometry->normal_pressure_angle),
         sb = sin(geometry->helix_angle), cb = cos(geometry->helix_angle);
  const double e[3] = {cb, 0, -sb}, t[3] = {sb, 0, cb}, across[3] = {0, 1, 0};
  double rack = u + geometry->rack_offset[member], r = geometry->reference_radius[member];
  double skew = sa * sb / cb, dv = (member == EO_PINION ? 1 : -1) * slope[1], du = slope[0] + dv * skew, x[3], n[3];
  for (int i = 0; i < 3; i++) {
    double f = -sa * e[i] + ca * across[i], m = ca * e[i] + sa * across[i];
    x[i] = rack * f + v * t[i] - delta * m; /* theory (S1) */
    n[i] = m + du * f + dv * t[i];
  }
  /* theory (S2) */
  double roll = (x[1] * n[0] / n[1] - x[0]) / r, c = cos(roll), s = sin(roll),
         length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  double y0 = x[0] + r * roll, y1 = x[1] + r;
  point->roll = roll;
  point->position[0] = c * y0 - s * y1;
  point->position[1] = s * y0 + c * y1;
  point->position[2] = x[2];
  point->normal[0] = (c * n[0] - s * n[1]) / length;
  point->normal[1] = (s * n[0] + c * n[1]) / length;
  point->normal[2] = n[2] / length;
}

void eo_surface_coordinates(const struct eo_geometry *geometry, int member, double s, double eta, double *u, double *v)
{
  *u = geometry->rack_factor * eo_geometry_own_path(member, s);
  double rack = *u + geometry->rack_offset[member];
  *v = ((member == EO_PINION ? eta : -eta) - rack * sin(geometry->normal_pressure_angle) * sin(geometry->helix_angle)) /
       cos(geometry->helix_angle);
}
