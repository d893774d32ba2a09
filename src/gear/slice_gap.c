/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exact gap of two transverse slices in mesh (surface.h). */
#include <math.h>
#include <stddef.h>

#include "gear/slice_walk.h"
#include "gear/surface.h"

/* By how much the pitch point's angle on the working circles is ahead of that on the reference circles. */
static double angle_ahead(const struct eo_geometry *geometry)
{
  return eo_geometry_involute_function(geometry->working_pressure_angle) -
         eo_geometry_involute_function(geometry->transverse_pressure_angle);
}

/* Base-circle phase of a member whose ray lies in the common normal. */
static double phase_of(const struct eo_geometry *geometry, int member, const struct eo_slice_ray *ray, double common,
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

enum { MOST_BREAKS = 2 + 4 * EO_MOST_VERTICES };

struct node {
  double phase, gap, slope;
  struct eo_tilt tilt;
};

static struct node node_of(const struct eo_geometry *geometry, const struct eo_slice_ray *ray,
                           const struct eo_slice_ray *this_ray)
{
  double offset = angle_ahead(geometry), common = eo_slice_common_angle(geometry, ray, this_ray),
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
static int collect_breaks(const struct eo_slice_walk *lead, const struct eo_slice_walk *other,
                          double breaks[MOST_BREAKS])
{
  const struct eo_geometry *geometry = lead->geometry;
  double margin = EO_TABLE_MARGIN * (geometry->rack_top - geometry->rack_bottom), vertex[EO_MOST_VERTICES];
  double low =
      eo_slice_walk_place(lead, (lead->member == EO_PINION ? geometry->rack_bottom : -geometry->rack_top) - margin, 0);
  double high =
      eo_slice_walk_place(lead, (lead->member == EO_PINION ? geometry->rack_top : -geometry->rack_bottom) + margin, 1);
  int count = 0, kept = 0, vertices = eo_modification_vertices(lead->shape, vertex);
  breaks[count++] = low;
  breaks[count++] = high;
  for (int i = 0; i < 2 * vertices; i++)
    breaks[count++] = eo_slice_walk_place(lead, vertex[i / 2], i % 2);
  vertices = other ? eo_modification_vertices(other->shape, vertex) : 0;
  for (int i = 0; i < 2 * vertices; i++) {
    struct eo_slice_ray ray = eo_slice_walk_ray(other, eo_slice_walk_place(other, vertex[i / 2], i % 2)), this_ray;
    double w = eo_slice_walk_place(lead, -vertex[i / 2], 0);
    if (eo_slice_walk_in_line(lead, &ray, &w, &this_ray))
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
static int follow(const struct eo_slice_walk *lead, const struct eo_slice_walk *other, int places, const double *place,
                  int first, int direction, struct node *node)
{
  const struct eo_geometry *geometry = lead->geometry;
  double w = -place[first];
  int count = 0, sense = lead->member == EO_PINION ? direction : -direction;
  for (int i = first; i >= 0 && i < places; i += direction) {
    struct eo_slice_ray ray = eo_slice_walk_ray(lead, place[i]), this_ray;
    if (!other)
      this_ray = eo_slice_involute_in_line(geometry, 1 - lead->member, &ray);
    else if (!eo_slice_walk_in_line(other, &ray, &w, &this_ray))
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
static bool meet(const struct eo_geometry *geometry, const struct eo_slice_walk walk[2], const bool modified[2],
                 double place, double *w, struct node *node)
{
  struct eo_slice_ray ray = modified[EO_PINION] ? eo_slice_walk_ray(&walk[EO_PINION], place)
                                                : eo_slice_involute_ray(geometry, EO_PINION,
                                                                        geometry->tangent_length[EO_PINION] +
                                                                            place / geometry->rack_factor),
                      this_ray;
  if (!modified[EO_GEAR])
    this_ray = eo_slice_involute_in_line(geometry, EO_GEAR, &ray);
  else if (!eo_slice_walk_in_line(&walk[EO_GEAR], &ray, w, &this_ray))
    return false;
  *node = node_of(geometry, &ray, &this_ray);
  return isfinite(node->phase + node->gap + node->slope);
}

/* The slow way, for slices that touch at a kink: the pinion's place whose phase is c, between two that bracket it
   (regula falsi with halving). */
static bool touch_at_kink(const struct eo_geometry *geometry, const struct eo_modification_shape slice[2],
                          const bool modified[2], double c, struct node *node)
{
  enum { STEPS = 60, WIDENINGS = 6 };
  static const double SPAN = 0.02;                  /* of the active profile: the first stretch */
  static const double DONE = 1e-11, NARROW = 1e-15; /* m, of the phase and of the stretch: rounding */
  static const double ENOUGH = 1e-8;                /* m, of the phase when the steps are used up */
  struct eo_slice_walk walk[2];
  double w = -geometry->rack_factor * c, span = SPAN * (geometry->rack_top - geometry->rack_bottom), end[2],
         miss[2] = {1, -1};
  for (int member = 0; member < 2; member++)
    eo_slice_walk_init(&walk[member], geometry, member, &slice[member]);
  double place = modified[EO_PINION] ? eo_slice_walk_place(&walk[EO_PINION], geometry->rack_factor * c, 0)
                                     : geometry->rack_factor * c;
  for (int widen = 0; widen < WIDENINGS && !(miss[0] <= 0 && miss[1] >= 0); widen++, span *= 2)
    for (int i = 0; i < 2; i++) {
      end[i] = place + (i ? span : -span);
      if (!meet(geometry, walk, modified, end[i], &w, node))
        return false;
      miss[i] = node->phase - c;
    }
  if (!(miss[0] <= 0 && miss[1] >= 0))
    return false;
  for (int i = 0, last = -1; i < STEPS && end[1] - end[0] > NARROW; i++) {
    double at = (end[0] * miss[1] - end[1] * miss[0]) / (miss[1] - miss[0]);
    if (!meet(geometry, walk, modified, at, &w, node))
      return false;
    double here = node->phase - c;
    if (fabs(here) < DONE)
      return true;
    int side = here > 0 ? 1 : 0;
    end[side] = at;
    miss[side] = here;
    if (side == last)
      miss[1 - side] /= 2;
    last = side;
  }
  return fabs(node->phase - c) < ENOUGH;
}

/* Newton for the places of both flanks with the derivatives of the involutes: phase = c, and the distances along the
   common normal add up. What either is off by in the end costs its square times the bend of the gap: DONE is a
   picometre at a bend of 4 per metre. */
static bool touch_smoothly(const struct eo_geometry *geometry, const struct eo_modification_shape slice[2],
                           const bool modified[2], double c, struct node *node)
{
  enum { STEPS = 12 };
  static const double DONE = 5e-7;
  const struct eo_slice_rack rack = eo_slice_rack_of(geometry);
  double u[2] = {geometry->rack_factor * c, -geometry->rack_factor * c}, offset = angle_ahead(geometry), slope[2],
         miss = 0;
  for (int i = 0; i < STEPS; i++) {
    struct eo_slice_ray ray = eo_slice_involute_ray(geometry, EO_PINION,
                                                    geometry->tangent_length[EO_PINION] +
                                                        u[EO_PINION] / geometry->rack_factor),
                        this_ray;
    if (modified[EO_PINION]) {
      double delta = eo_modification_profile(&slice[EO_PINION], u[EO_PINION], slope);
      ray = eo_slice_ray_on(&rack, geometry, EO_PINION, u[EO_PINION], delta, slope[0]);
    }
    if (modified[EO_GEAR]) {
      double delta = eo_modification_profile(&slice[EO_GEAR], u[EO_GEAR], slope);
      this_ray = eo_slice_ray_on(&rack, geometry, EO_GEAR, u[EO_GEAR], delta, slope[0]);
      miss = eo_slice_miss(geometry, &ray, &this_ray);
    } else
      this_ray = eo_slice_involute_in_line(geometry, EO_GEAR, &ray);
    double off = c - phase_of(geometry, EO_PINION, &ray, eo_slice_common_angle(geometry, &ray, &this_ray), offset);
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
  double margin = EO_TABLE_MARGIN * (geometry->path_end - geometry->path_start),
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
  struct eo_slice_walk walk[2];
  struct node node[2][EO_SLICE_NODES]; /* before and behind the pitch point */
  double breaks[MOST_BREAKS], place[EO_SLICE_NODES];
  eo_slice_walk_init(&walk[0], geometry, pinion ? EO_PINION : EO_GEAR, &shape[pinion ? EO_PINION : EO_GEAR]);
  eo_slice_walk_init(&walk[1], geometry, EO_GEAR, &shape[EO_GEAR]);
  const struct eo_slice_walk *other = pinion && gear ? &walk[1] : NULL;
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
