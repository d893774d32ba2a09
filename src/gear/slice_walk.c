/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gear/slice_walk.h"

#include <math.h>
#include <stddef.h>

#include "gear/surface.h"

static const double FAN = 1e-3;   /* m of w for each kink */
static const double BEND = 1e-12; /* the slope changes by more than rounding: a kink */

struct eo_slice_rack eo_slice_rack_of(const struct eo_geometry *geometry)
{
  return (struct eo_slice_rack){sin(geometry->normal_pressure_angle), cos(geometry->normal_pressure_angle),
                                sin(geometry->helix_angle), cos(geometry->helix_angle)};
}

struct eo_slice_ray eo_slice_ray_on(const struct eo_slice_rack *this_rack, const struct eo_geometry *geometry,
                                    int member, double u, double delta, double d)
{
  double sa = this_rack->sa, ca = this_rack->ca, sb = this_rack->sb, cb = this_rack->cb;
  double rack = u + geometry->rack_offset[member], r = geometry->reference_radius[member];
  /* Moved along the rack's trace back into the slice: the gap would come out sin^2(beta_b) too small without. */
  double z = (rack * sa + delta * ca) * sb, x = -(rack * sa + delta * ca) * cb - z * sb / cb,
         y = rack * ca - delta * sa;
  double nx = (ca - d * sa) * cb, ny = sa + d * ca, length = hypot(nx, ny);
  nx /= length;
  ny /= length;
  double roll = (y * nx / ny - x) / r, qx = x + r * roll, qy = y + r;
  return (struct eo_slice_ray){.arm = qy * nx - qx * ny, .distance = qx * nx + qy * ny, .angle = roll + atan2(ny, nx)};
}

static struct eo_slice_ray sloped_ray(const struct eo_geometry *geometry, int member, double u, double delta, double d)
{
  struct eo_slice_rack rack = eo_slice_rack_of(geometry);
  return eo_slice_ray_on(&rack, geometry, member, u, delta, d);
}

/* side: 0 takes the slope just below u, 1 just above. */
static struct eo_slice_ray slice_ray(const struct eo_geometry *geometry, int member,
                                     const struct eo_modification_shape *shape, double u, int side)
{
  double slope[2], delta = eo_modification_profile(shape, u, slope);
  return sloped_ray(geometry, member, u, delta, slope[side]);
}

void eo_slice_point_at(const struct eo_geometry *geometry, int member, const struct eo_modification_shape *shape,
                       double u, struct eo_slice_point *point)
{
  struct eo_slice_ray ray = slice_ray(geometry, member, shape, u, 0);
  double c = cos(ray.angle), s = sin(ray.angle);
  point->normal[0] = c;
  point->normal[1] = s;
  point->position[0] = ray.distance * c - ray.arm * s;
  point->position[1] = ray.distance * s + ray.arm * c;
}

double eo_slice_fold(const struct eo_geometry *geometry, int member, const struct eo_modification_shape *slice,
                     double fold[2])
{
  enum { STEPS = 128 };
  double end[2], before = 0, from = NAN, longest = 0;
  eo_active_profile(geometry, member, end);
  for (int i = 0; i <= STEPS; i++) {
    double u = end[0] + (end[1] - end[0]) * i / STEPS, step = (end[1] - end[0]) / STEPS;
    struct eo_slice_ray ray = slice_ray(geometry, member, slice, u, 0);
    double radius = hypot(ray.distance, ray.arm);
    bool back = i > 0 && radius < before;
    if (back && isnan(from))
      from = u - step;
    if (back && u - from > longest) {
      longest = u - from;
      fold[0] = from;
      fold[1] = u;
    }
    from = back ? from : NAN;
    before = radius;
  }
  return longest;
}

struct eo_slice_ray eo_slice_involute_ray(const struct eo_geometry *geometry, int member, double distance)
{
  double base = geometry->base_radius[member], start = base * tan(geometry->transverse_pressure_angle);
  return (struct eo_slice_ray){
      .arm = base, .distance = distance, .angle = (distance - start) / base + geometry->transverse_pressure_angle};
}

double eo_slice_common_angle(const struct eo_geometry *geometry, const struct eo_slice_ray *ray,
                             const struct eo_slice_ray *this_ray)
{
  return acos((ray->arm + this_ray->arm) / geometry->centre_distance); /* theory (K5) (S3) */
}

void eo_slice_walk_init(struct eo_slice_walk *walk, const struct eo_geometry *geometry, int member,
                        const struct eo_modification_shape *shape)
{
  double margin = EO_WALK_MARGIN * (geometry->rack_top - geometry->rack_bottom), vertex[EO_MOST_VERTICES];
  *walk = (struct eo_slice_walk){.geometry = geometry, .shape = shape, .member = member};
  walk->low = (member == EO_PINION ? geometry->rack_bottom : -geometry->rack_top) - margin;
  walk->high = (member == EO_PINION ? geometry->rack_top : -geometry->rack_bottom) + margin;
  int vertices = eo_modification_vertices(shape, vertex);
  for (int i = 0; i < vertices; i++) {
    double slope[2];
    eo_modification_profile(shape, vertex[i], slope);
    if (fabs(slope[1] - slope[0]) > BEND) {
      walk->kink[walk->kinks++] = vertex[i];
      walk->high += FAN;
    }
  }
}

struct eo_slice_ray eo_slice_walk_ray(const struct eo_slice_walk *walk, double w)
{
  double last = -INFINITY, slope[2];
  for (int i = 0; i < walk->kinks && w > walk->kink[i]; i++) {
    last = walk->kink[i];
    if (w < last + FAN) {
      double delta = eo_modification_profile(walk->shape, last, slope);
      return sloped_ray(walk->geometry, walk->member, last, delta, slope[0] + (slope[1] - slope[0]) * (w - last) / FAN);
    }
    w = fmax(w - FAN, last);
  }
  return slice_ray(walk->geometry, walk->member, walk->shape, w, w == last);
}

double eo_slice_walk_place(const struct eo_slice_walk *walk, double u, int side)
{
  double w = u;
  for (int i = 0; i < walk->kinks; i++)
    if (u > walk->kink[i] || (side == 1 && u == walk->kink[i]))
      w += FAN;
  return w;
}

double eo_slice_miss(const struct eo_geometry *geometry, const struct eo_slice_ray *ray,
                     const struct eo_slice_ray *this_ray)
{
  return geometry->centre_distance * sin(eo_slice_common_angle(geometry, ray, this_ray)) - ray->distance -
         this_ray->distance; /* theory (S4) */
}

/* The miss falls along a convex flank; regula falsi with halving (Illinois). */
bool eo_slice_walk_in_line(const struct eo_slice_walk *walk, const struct eo_slice_ray *other, double *w,
                           struct eo_slice_ray *ray)
{
  enum { STEPS = 80, WIDENINGS = 7 };
  static const double SPAN = 0.01;                  /* of the walk: the first stretch */
  static const double DONE = 1e-14, NARROW = 1e-15; /* m, of the miss and of the stretch: rounding */
  static const double ENOUGH = 1e-10;               /* m, of the miss when the steps are used up */
  double span = SPAN * (walk->high - walk->low), end[2], miss[2] = {-1, 1};
  for (int widen = 0; widen < WIDENINGS && !(miss[0] >= 0 && miss[1] <= 0); widen++, span *= 2)
    for (int i = 0; i < 2; i++) {
      end[i] = fmin(walk->high, fmax(walk->low, *w + (i ? span : -span)));
      *ray = eo_slice_walk_ray(walk, end[i]);
      miss[i] = eo_slice_miss(walk->geometry, other, ray);
    }
  if (!(miss[0] >= 0 && miss[1] <= 0))
    return false;
  for (int i = 0, last = -1; i < STEPS; i++) {
    *w = (end[0] * miss[1] - end[1] * miss[0]) / (miss[1] - miss[0]);
    *ray = eo_slice_walk_ray(walk, *w);
    double here = eo_slice_miss(walk->geometry, other, ray);
    if (fabs(here) < DONE || end[1] - end[0] < NARROW)
      return true;
    int side = here > 0 ? 0 : 1;
    end[side] = *w;
    miss[side] = here;
    if (side == last)
      miss[1 - side] /= 2;
    last = side;
  }
  return fabs(eo_slice_miss(walk->geometry, other, ray)) < ENOUGH;
}

struct eo_slice_ray eo_slice_involute_in_line(const struct eo_geometry *geometry, int member,
                                              const struct eo_slice_ray *other)
{
  struct eo_slice_ray ray = eo_slice_involute_ray(geometry, member, 0);
  return eo_slice_involute_ray(geometry, member,
                               geometry->centre_distance * sin(eo_slice_common_angle(geometry, other, &ray)) -
                                   other->distance);
}
