/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gear/surface.h"

#include <math.h>
#include <stddef.h>

/* The profile at x = eta / cos(beta). */
static double profile_at(const struct eo_modification_shape *shape, double u, double x, double slope[2])
{
  struct eo_modification_shape slice;
  if (!shape->varies)
    return eo_modification_profile(shape, u, slope);
  eo_modification_slice(shape, x / shape->lengthen, &slice);
  return eo_modification_profile(&slice, u, slope);
}

void eo_surface_evaluate(const struct eo_geometry *geometry, int member, const struct eo_modification_shape *shape,
                         double u, double v, struct eo_surface_point *point)
{
  double sa = sin(geometry->normal_pressure_angle), ca = cos(geometry->normal_pressure_angle),
         sb = sin(geometry->helix_angle), cb = cos(geometry->helix_angle);
  const double e[3] = {cb, 0, -sb}, t[3] = {sb, 0, cb}, across[3] = {0, 1, 0};
  double rack = u + geometry->rack_offset[member], r = geometry->reference_radius[member];
  double skew = sa * sb / cb, side = member == EO_PINION ? 1 : -1, profile_slope[2], lead_slope;
  double across_face = side * (v + rack * skew);
  double delta = profile_at(shape, u, across_face, profile_slope) +
                 eo_modification_lead(shape, across_face, &lead_slope);
  if (shape->varies) {
    const double step = 1e-6;
    double unused[2];
    lead_slope +=
        (profile_at(shape, u, across_face + step, unused) - profile_at(shape, u, across_face - step, unused)) /
        (2 * step);
  }
  lead_slope *= side;
  double du = (profile_slope[0] + profile_slope[1]) / 2 + lead_slope * skew, dv = lead_slope, x[3], n[3];
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

/* What a slice's flank shows to its partner: the arm of its normal about its own axis, the distance along the normal
   from the foot of that arm, and the direction angle it has when the tooth stands at roll 0. */
struct ray {
  double arm, distance, angle;
};

/* Angles of the generating rack. */
struct rack {
  double sa, ca, sb, cb; /* sin and cos of alpha_n and beta */
};

static struct rack rack_of(const struct eo_geometry *geometry)
{
  return (struct rack){sin(geometry->normal_pressure_angle), cos(geometry->normal_pressure_angle),
                       sin(geometry->helix_angle), cos(geometry->helix_angle)};
}

/* delta, d: relief at u and its slope (at a kink any slope between those of its two sides: the normal there turns about
   the vertex). */
static struct ray sloped_ray_on(const struct rack *this_rack, const struct eo_geometry *geometry, int member, double u,
                                double delta, double d)
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
  return (struct ray){.arm = qy * nx - qx * ny, .distance = qx * nx + qy * ny, .angle = roll + atan2(ny, nx)};
}

static struct ray sloped_ray(const struct eo_geometry *geometry, int member, double u, double delta, double d)
{
  struct rack rack = rack_of(geometry);
  return sloped_ray_on(&rack, geometry, member, u, delta, d);
}

/* side: 0 takes the slope just below u, 1 just above. */
static struct ray slice_ray(const struct eo_geometry *geometry, int member, const struct eo_modification_shape *shape,
                            double u, int side)
{
  double slope[2], delta = eo_modification_profile(shape, u, slope);
  return sloped_ray(geometry, member, u, delta, slope[side]);
}

void eo_slice_point_at(const struct eo_geometry *geometry, int member, const struct eo_modification_shape *shape,
                       double u, struct eo_slice_point *point)
{
  struct ray ray = slice_ray(geometry, member, shape, u, 0);
  double c = cos(ray.angle), s = sin(ray.angle);
  point->normal[0] = c;
  point->normal[1] = s;
  point->position[0] = ray.distance * c - ray.arm * s;
  point->position[1] = ray.distance * s + ray.arm * c;
}

static struct ray involute_ray(const struct eo_geometry *geometry, int member, double distance)
{
  double base = geometry->base_radius[member], start = base * tan(geometry->transverse_pressure_angle);
  return (struct ray){
      .arm = base, .distance = distance, .angle = (distance - start) / base + geometry->transverse_pressure_angle};
}

/* Angle of the common normal for two arms. */
static double common_angle(const struct eo_geometry *geometry, const struct ray *ray, const struct ray *this_ray)
{
  return acos((ray->arm + this_ray->arm) / geometry->centre_distance); /* theory (K5) (S3) */
}

/* ---- walks: every normal of a flank in order, so that the one in line with a given normal of the partner can be found
   ---- The coordinate w is u, stretched at each kink by the width of a fan in which the normal turns about the vertex.
 */

enum { MOST_KINKS = EO_MOST_VERTICES, MOST_BREAKS = 2 + 4 * EO_MOST_VERTICES };
static const double FAN = 1e-3;

struct walk {
  const struct eo_geometry *geometry;
  const struct eo_modification_shape *shape;
  int member, kinks;
  double kink[MOST_KINKS]; /* u, increasing */
  double low, high;        /* w at the ends */
};

static void walk_init(struct walk *walk, const struct eo_geometry *geometry, int member,
                      const struct eo_modification_shape *shape)
{
  double margin = 0.3 * (geometry->rack_top - geometry->rack_bottom), vertex[EO_MOST_VERTICES];
  *walk = (struct walk){.geometry = geometry, .shape = shape, .member = member};
  walk->low = (member == EO_PINION ? geometry->rack_bottom : -geometry->rack_top) - margin;
  walk->high = (member == EO_PINION ? geometry->rack_top : -geometry->rack_bottom) + margin;
  int vertices = eo_modification_vertices(shape, vertex);
  for (int i = 0; i < vertices; i++) {
    double slope[2];
    eo_modification_profile(shape, vertex[i], slope);
    if (fabs(slope[1] - slope[0]) > 1e-12) {
      walk->kink[walk->kinks++] = vertex[i];
      walk->high += FAN;
    }
  }
}

static struct ray walk_ray(const struct walk *walk, double w)
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

/* The coordinate of a place u: before (side 0) or behind (side 1) the fan of a kink there. */
static double walk_place(const struct walk *walk, double u, int side)
{
  double w = u;
  for (int i = 0; i < walk->kinks; i++)
    if (u > walk->kink[i] || (side == 1 && u == walk->kink[i]))
      w += FAN;
  return w;
}

/* How far two normals are from lying in one line: their distances along it have to add up to a sin(alpha'). */
static double miss_of(const struct eo_geometry *geometry, const struct ray *ray, const struct ray *this_ray)
{
  return geometry->centre_distance * sin(common_angle(geometry, ray, this_ray)) - ray->distance -
         this_ray->distance; /* theory (S4) */
}

/* The ray of the walk in line with that of the other member, near the place *w: the miss falls along a convex flank;
   regula falsi with halving (Illinois). False when there is none: beyond reliefs so steep that the flank's normals
   leave the mesh. */
static bool in_line_with(const struct walk *walk, const struct ray *other, double *w, struct ray *ray)
{
  enum { STEPS = 80 };
  double span = 0.01 * (walk->high - walk->low), end[2], miss[2] = {-1, 1};
  for (int widen = 0; widen < 7 && !(miss[0] >= 0 && miss[1] <= 0); widen++, span *= 2)
    for (int i = 0; i < 2; i++) {
      end[i] = fmin(walk->high, fmax(walk->low, *w + (i ? span : -span)));
      *ray = walk_ray(walk, end[i]);
      miss[i] = miss_of(walk->geometry, other, ray);
    }
  if (!(miss[0] >= 0 && miss[1] <= 0))
    return false;
  for (int i = 0, last = -1; i < STEPS; i++) {
    *w = (end[0] * miss[1] - end[1] * miss[0]) / (miss[1] - miss[0]);
    *ray = walk_ray(walk, *w);
    double here = miss_of(walk->geometry, other, ray);
    if (fabs(here) < 1e-14 || end[1] - end[0] < 1e-15)
      return true;
    int side = here > 0 ? 0 : 1;
    end[side] = *w;
    miss[side] = here;
    if (side == last)
      miss[1 - side] /= 2;
    last = side;
  }
  return fabs(miss_of(walk->geometry, other, ray)) < 1e-10;
}

/* The unmodified flank's ray in line with that of the other member: its arm is the base radius. */
static struct ray involute_in_line_with(const struct eo_geometry *geometry, int member, const struct ray *other)
{
  struct ray ray = involute_ray(geometry, member, 0);
  return involute_ray(geometry, member,
                      geometry->centre_distance * sin(common_angle(geometry, other, &ray)) - other->distance);
}

/* By how much the pitch point's angle on the working circles is ahead of that on the reference circles. */
static double angle_ahead(const struct eo_geometry *geometry)
{
  return eo_geometry_involute_function(geometry->working_pressure_angle) -
         eo_geometry_involute_function(geometry->transverse_pressure_angle);
}

/* Base-circle phase of a member whose ray lies in the common normal. */
static double phase_of(const struct eo_geometry *geometry, int member, const struct ray *ray, double common,
                       double offset)
{
  return geometry->base_radius[member] * (ray->angle - common - offset);
}

struct eo_tilt eo_tilt_at(const struct eo_geometry *geometry, double angle, double ratio, const double place[2])
{
  double normal = ratio * cos(geometry->base_helix_angle),
         axial = sin(geometry->base_helix_angle); /* theory (K1) (K2) */
  /* theory (K3) */
  return (struct eo_tilt){.lever = {-normal * sin(angle), normal * cos(angle)},
                          .shift = {-axial * (place[1] + geometry->working_radius[EO_GEAR]), axial * place[0]}};
}

struct node {
  double phase, gap, slope;
  struct eo_tilt tilt;
};

static struct node node_of(const struct eo_geometry *geometry, const struct ray *ray, const struct ray *this_ray)
{
  double offset = angle_ahead(geometry), common = common_angle(geometry, ray, this_ray),
         c = phase_of(geometry, EO_PINION, ray, common, offset), normal = cos(geometry->base_helix_angle);
  double turned = geometry->base_radius[EO_GEAR] / this_ray->arm,
         rate = ray->arm * turned / geometry->base_radius[EO_PINION];
  double along[2] = {cos(common), sin(common)}, place[2] = {this_ray->arm * along[1] - this_ray->distance * along[0],
                                                            -this_ray->arm * along[0] - this_ray->distance * along[1]};
  /* theory (S5) */
  return (struct node){c, (c + phase_of(geometry, EO_GEAR, this_ray, common, offset)) * normal, (1 - rate) * normal,
                       eo_tilt_at(geometry, common, turned, place)};
}

static void sort(int count, double *value)
{
  for (int i = 1; i < count; i++)
    for (int j = i; j > 0 && value[j] < value[j - 1]; j--) {
      double swap = value[j];
      value[j] = value[j - 1];
      value[j - 1] = swap;
    }
}

/* Places on the leading member, which the table follows, where its own shape or that of the other member changes,
   sorted. */
static int collect_breaks(const struct walk *lead, const struct walk *other, double breaks[MOST_BREAKS])
{
  const struct eo_geometry *geometry = lead->geometry;
  double margin = 0.15 * (geometry->rack_top - geometry->rack_bottom), vertex[EO_MOST_VERTICES];
  double low = walk_place(lead, (lead->member == EO_PINION ? geometry->rack_bottom : -geometry->rack_top) - margin, 0);
  double high = walk_place(lead, (lead->member == EO_PINION ? geometry->rack_top : -geometry->rack_bottom) + margin, 1);
  int count = 0, kept = 0, vertices = eo_modification_vertices(lead->shape, vertex);
  breaks[count++] = low;
  breaks[count++] = high;
  for (int i = 0; i < 2 * vertices; i++)
    breaks[count++] = walk_place(lead, vertex[i / 2], i % 2);
  vertices = other ? eo_modification_vertices(other->shape, vertex) : 0;
  for (int i = 0; i < 2 * vertices; i++) {
    struct ray ray = walk_ray(other, walk_place(other, vertex[i / 2], i % 2)), this_ray;
    double w = walk_place(lead, -vertex[i / 2], 0);
    if (in_line_with(lead, &ray, &w, &this_ray))
      breaks[count++] = w;
  }
  sort(count, breaks);
  for (int i = 0; i < count; i++)
    if (breaks[i] >= low && breaks[i] <= high && (kept == 0 || breaks[i] - breaks[kept - 1] > 1e-9))
      breaks[kept++] = breaks[i];
  return kept;
}

/* Places between the breaks, most evenly; returns how many. */
static int spread_places(int breaks, const double *at, double place[EO_SLICE_NODES])
{
  enum { PIECES = 40 }; /* per segment between two breaks: interpolation error below 1e-12 m */
  int most = (EO_SLICE_NODES - 1) / (breaks - 1), pieces = most < PIECES ? most : PIECES, count = 0;
  for (int k = 0; k + 1 < breaks; k++)
    for (int i = 0; i < pieces; i++)
      place[count++] = at[k] + (at[k + 1] - at[k]) * i / pieces;
  place[count++] = at[breaks - 1];
  return count;
}

static void fill_buckets(struct eo_slice_gap *table)
{
  int piece = 0, last = table->nodes - 2;
  double width = (table->phase[last + 1] - table->phase[0]) / EO_SLICE_BUCKETS;
  table->bucket_rate = 1 / width;
  for (int i = 0; i < EO_SLICE_BUCKETS; i++) {
    while (piece < last && table->phase[piece + 1] <= table->phase[0] + i * width)
      piece++;
    table->bucket[i] = (unsigned char)piece;
  }
}

/* Nodes of the table from the place `first` on in one direction, until the other member has no normal left to offer.
   Where normals fold back (concave vertices) the outer branch counts. Returns how many. */
static int follow(const struct walk *lead, const struct walk *other, int places, const double *place, int first,
                  int direction, struct node *node)
{
  const struct eo_geometry *geometry = lead->geometry;
  double w = -place[first];
  int count = 0, sense = lead->member == EO_PINION ? direction : -direction;
  for (int i = first; i >= 0 && i < places; i += direction) {
    struct ray ray = walk_ray(lead, place[i]), this_ray;
    if (!other)
      this_ray = involute_in_line_with(geometry, 1 - lead->member, &ray);
    else if (!in_line_with(other, &ray, &w, &this_ray))
      break;
    struct node here = lead->member == EO_PINION ? node_of(geometry, &ray, &this_ray)
                                                 : node_of(geometry, &this_ray, &ray);
    if (!isfinite(here.phase + here.gap + here.slope))
      break;
    if (count == 0 || sense * (here.phase - node[count - 1].phase) > 0)
      node[count++] = here;
  }
  return count;
}

/* Where the gear's flank is in line with the pinion's ray, and what both make; *w: a place near it on the gear. */
static bool meet(const struct eo_geometry *geometry, const struct walk walk[2], const bool modified[2], double place,
                 double *w, struct node *node)
{
  struct ray ray = modified[EO_PINION]
                       ? walk_ray(&walk[EO_PINION], place)
                       : involute_ray(geometry, EO_PINION,
                                      geometry->tangent_length[EO_PINION] + place / geometry->rack_factor),
             this_ray;
  if (!modified[EO_GEAR])
    this_ray = involute_in_line_with(geometry, EO_GEAR, &ray);
  else if (!in_line_with(&walk[EO_GEAR], &ray, w, &this_ray))
    return false;
  *node = node_of(geometry, &ray, &this_ray);
  return isfinite(node->phase + node->gap + node->slope);
}

/* The slow way, for slices that touch at a kink: the pinion's place whose phase is c, between two that bracket it
   (regula falsi with halving). */
static bool touch_at_kink(const struct eo_geometry *geometry, const struct eo_modification_shape slice[2],
                          const bool modified[2], double c, struct node *node)
{
  enum { STEPS = 60 };
  struct walk walk[2];
  double w = -geometry->rack_factor * c, span = 0.02 * (geometry->rack_top - geometry->rack_bottom), end[2],
         miss[2] = {1, -1};
  for (int member = 0; member < 2; member++)
    walk_init(&walk[member], geometry, member, &slice[member]);
  double place = modified[EO_PINION] ? walk_place(&walk[EO_PINION], geometry->rack_factor * c, 0)
                                     : geometry->rack_factor * c;
  for (int widen = 0; widen < 6 && !(miss[0] <= 0 && miss[1] >= 0); widen++, span *= 2)
    for (int i = 0; i < 2; i++) {
      end[i] = place + (i ? span : -span);
      if (!meet(geometry, walk, modified, end[i], &w, node))
        return false;
      miss[i] = node->phase - c;
    }
  if (!(miss[0] <= 0 && miss[1] >= 0))
    return false;
  for (int i = 0, last = -1; i < STEPS && end[1] - end[0] > 1e-15; i++) {
    double at = (end[0] * miss[1] - end[1] * miss[0]) / (miss[1] - miss[0]);
    if (!meet(geometry, walk, modified, at, &w, node))
      return false;
    double here = node->phase - c;
    if (fabs(here) < 1e-11)
      return true;
    int side = here > 0 ? 1 : 0;
    end[side] = at;
    miss[side] = here;
    if (side == last)
      miss[1 - side] /= 2;
    last = side;
  }
  return fabs(node->phase - c) < 1e-8;
}

/* Newton for the places of both flanks with the derivatives of the involutes: phase = c, and the distances along the
   common normal add up. What either is off by in the end costs its square times the bend of the gap: DONE is a
   picometre at a bend of 4 per metre. */
static bool touch_smoothly(const struct eo_geometry *geometry, const struct eo_modification_shape slice[2],
                           const bool modified[2], double c, struct node *node)
{
  enum { STEPS = 12 };
  static const double DONE = 5e-7;
  const struct rack rack = rack_of(geometry);
  double u[2] = {geometry->rack_factor * c, -geometry->rack_factor * c}, offset = angle_ahead(geometry), slope[2],
         miss = 0;
  for (int i = 0; i < STEPS; i++) {
    struct ray ray = involute_ray(geometry, EO_PINION,
                                  geometry->tangent_length[EO_PINION] + u[EO_PINION] / geometry->rack_factor),
               this_ray;
    if (modified[EO_PINION]) {
      double delta = eo_modification_profile(&slice[EO_PINION], u[EO_PINION], slope);
      ray = sloped_ray_on(&rack, geometry, EO_PINION, u[EO_PINION], delta, slope[0]);
    }
    if (modified[EO_GEAR]) {
      double delta = eo_modification_profile(&slice[EO_GEAR], u[EO_GEAR], slope);
      this_ray = sloped_ray_on(&rack, geometry, EO_GEAR, u[EO_GEAR], delta, slope[0]);
      miss = miss_of(geometry, &ray, &this_ray);
    } else
      this_ray = involute_in_line_with(geometry, EO_GEAR, &ray);
    double off = c - phase_of(geometry, EO_PINION, &ray, common_angle(geometry, &ray, &this_ray), offset);
    if (!(isfinite(off) && isfinite(miss)))
      return false;
    if (fabs(off) < DONE && fabs(miss) < DONE) {
      *node = node_of(geometry, &ray, &this_ray);
      node->gap += miss * cos(geometry->base_helix_angle); /* what is missing along the normal is missing in the gap */
      return isfinite(node->gap + node->slope);
    }
    u[EO_PINION] += geometry->rack_factor * off;
    u[EO_GEAR] += geometry->rack_factor * (miss - off);
  }
  return false;
}

bool eo_slice_touch_at(const struct eo_geometry *geometry, const struct eo_modification_shape slice[2], double c,
                       struct eo_slice_touch *touch)
{
  const bool modified[2] = {eo_modification_has_profile(&slice[EO_PINION]),
                            eo_modification_has_profile(&slice[EO_GEAR])};
  double margin = 0.15 * (geometry->path_end - geometry->path_start),
         inside = fmin(geometry->path_end + margin, fmax(geometry->path_start - margin, c));
  struct node node;
  if (!touch_smoothly(geometry, slice, modified, inside, &node) &&
      !touch_at_kink(geometry, slice, modified, inside, &node))
    return false;
  touch->gap = node.gap + node.slope * (c - node.phase);
  touch->slope = node.slope;
  touch->tilt = node.tilt;
  return true;
}

void eo_slice_gap_init(struct eo_slice_gap *table, const struct eo_geometry *geometry,
                       const struct eo_modification_shape shape[2])
{
  bool pinion = eo_modification_has_profile(&shape[EO_PINION]), gear = eo_modification_has_profile(&shape[EO_GEAR]);
  table->nodes = 0;
  if (!pinion && !gear)
    return;
  struct walk walk[2];
  struct node node[2][EO_SLICE_NODES]; /* before and behind the pitch point */
  double breaks[MOST_BREAKS], place[EO_SLICE_NODES];
  walk_init(&walk[0], geometry, pinion ? EO_PINION : EO_GEAR, &shape[pinion ? EO_PINION : EO_GEAR]);
  walk_init(&walk[1], geometry, EO_GEAR, &shape[EO_GEAR]);
  const struct walk *other = pinion && gear ? &walk[1] : NULL;
  int count = spread_places(collect_breaks(&walk[0], other, breaks), breaks, place), middle = 0;
  while (middle < count - 1 && place[middle] < 0)
    middle++;
  int outwards[2] = {follow(&walk[0], other, count, place, middle, pinion ? -1 : 1, node[0]),
                     follow(&walk[0], other, count, place, middle, pinion ? 1 : -1, node[1])};
  for (int i = -outwards[0] + 1; i < outwards[1]; i++) {
    const struct node *this_node = i <= 0 ? &node[0][-i] : &node[1][i];
    table->phase[table->nodes] = this_node->phase;
    table->gap[table->nodes] = this_node->gap;
    table->tilt[table->nodes] = this_node->tilt;
    table->slope[table->nodes++] = this_node->slope;
  }
  if (table->nodes < 2)
    table->nodes = 0; /* no two places with a normal in common: no table either */
  else
    fill_buckets(table);
}

int eo_slice_gap_piece(const struct eo_slice_gap *table, double c, double *part)
{
  int last = table->nodes - 1, i = 0;
  if (c >= table->phase[last]) {
    i = last - 1;
  } else if (c > table->phase[0]) {
    i = table->bucket[(int)((c - table->phase[0]) * table->bucket_rate) & (EO_SLICE_BUCKETS - 1)];
    while (i < last - 1 && table->phase[i + 1] < c)
      i++;
  }
  *part = (c - table->phase[i]) / (table->phase[i + 1] - table->phase[i]);
  return i;
}

double eo_slice_gap_within(const struct eo_slice_gap *table, int i, double t, double *slope)
{
  double h = table->phase[i + 1] - table->phase[i], r = 1 - t;
  if (t < 0 || t > 1) {
    int end = t < 0 ? i : i + 1;
    *slope = table->slope[end];
    return table->gap[end] + *slope * h * (t < 0 ? t : t - 1);
  }
  double difference = table->gap[i + 1] - table->gap[i], a = table->slope[i] * h - difference,
         b = difference - table->slope[i + 1] * h;
  *slope = (difference + (r - t) * (a * r + b * t) + t * r * (b - a)) / h;
  return table->gap[i] * r + table->gap[i + 1] * t + t * r * (a * r + b * t);
}

double eo_slice_gap_at(const struct eo_slice_gap *table, double c, double *slope)
{
  double unused = 0, part;
  slope = slope ? slope : &unused;
  *slope = 0;
  if (table->nodes == 0)
    return 0;
  int piece = eo_slice_gap_piece(table, c, &part);
  return eo_slice_gap_within(table, piece, part, slope);
}

struct eo_tilt eo_slice_tilt_at(const struct eo_slice_gap *table, const struct eo_geometry *geometry, double c)
{
  double along[2] = {cos(geometry->working_pressure_angle), sin(geometry->working_pressure_angle)},
         place[2] = {c * along[0], c * along[1] - geometry->working_radius[EO_GEAR]}, t;
  if (!table || table->nodes == 0)
    return eo_tilt_at(geometry, geometry->working_pressure_angle, 1, place); /* theory (K4) */
  int i = eo_slice_gap_piece(table, c, &t);
  struct eo_tilt tilt = table->tilt[i];
  t = fmin(1, fmax(0, t));
  for (int axis = 0; axis < 2; axis++) {
    tilt.lever[axis] += t * (table->tilt[i + 1].lever[axis] - tilt.lever[axis]);
    tilt.shift[axis] += t * (table->tilt[i + 1].shift[axis] - tilt.shift[axis]);
  }
  return tilt;
}
