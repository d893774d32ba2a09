/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/corner.h"

#include <math.h>
#include <string.h>

/* The flank in polar coordinates about its own centre, at pinion phase 0, root first: angle as a function of the
   radius. */
enum { OUTLINE_NODES = 128 };
struct outline {
  int nodes;
  double radius[OUTLINE_NODES], angle[OUTLINE_NODES], slope[OUTLINE_NODES];
};

/* Mesh frame: pinion centre at the origin, gear centre at (0, a); both members turn so that the pinion's phase c is the
   arc of its base circle and unmodified flanks meet at s = c. */
struct corner {
  const struct eo_geometry *geometry;
  const struct eo_modification_shape *shape; /* [2] */
  int tip, flank;                            /* members */
  double point[3][2]; /* of the tip member about its centre at phase 0: corner, a point a little inside, corner without
                         relief */
  struct outline outline; /* of the flank member */
};

struct touch {
  double gap, slope; /* slope by c */
  struct eo_tilt tilt;
};

static void turn(const double from[2], double angle, double to[2])
{
  double x = from[0], y = from[1];
  to[0] = cos(angle) * x - sin(angle) * y;
  to[1] = sin(angle) * x + cos(angle) * y;
}

/* A member's profile point and normal about its own centre at pinion phase 0. */
static void place_profile(const struct eo_geometry *geometry, int member, const struct eo_modification_shape *shape,
                          double u, double point[2], double normal[2])
{
  struct eo_slice_point slice_point;
  eo_slice_point_at(geometry, member, shape, u, &slice_point);
  double angle = eo_geometry_involute_function(geometry->transverse_pressure_angle) -
                 eo_geometry_involute_function(geometry->working_pressure_angle);
  angle += member == EO_PINION ? 0 : M_PI;
  turn(slice_point.position, angle, point);
  turn(slice_point.normal, angle, normal);
}

/* How fast a member turns with c: the pinion clockwise, the gear counterclockwise. */
static double turning(const struct corner *corner, int member)
{
  return (member == EO_PINION ? -1 : 1) / corner->geometry->base_radius[member];
}

static double phase_at(const struct corner *corner, double d)
{
  return corner->tip == EO_GEAR ? corner->geometry->path_start - d : corner->geometry->path_end + d;
}

/* A point of the tip member at phase c, about the flank member's centre. */
static void place_tip(const struct corner *corner, int which, double c, double point[2])
{
  turn(corner->point[which], c * turning(corner, corner->tip), point); /* theory (K6) (K7) */
  point[1] += corner->tip == EO_PINION ? -corner->geometry->centre_distance : corner->geometry->centre_distance;
}

/* From a little above the radius that the corner has at the end of the reach down to the one it has at the start. */
static void trace_flank(struct corner *corner, double reach)
{
  const struct eo_geometry *geometry = corner->geometry;
  double far[2], near[2], lowest = INFINITY, span = geometry->rack_top - geometry->rack_bottom;
  place_tip(corner, 0, phase_at(corner, reach), far);
  place_tip(corner, 0, phase_at(corner, 0), near);
  double path = eo_geometry_path_at(geometry, corner->flank, hypot(far[0], far[1])),
         high = geometry->rack_factor * eo_geometry_own_path(corner->flank, path);
  double bottom = corner->flank == EO_PINION ? geometry->rack_bottom : -geometry->rack_top,
         step = (high - bottom + 0.25 * span) / (OUTLINE_NODES - 4);
  struct outline *outline = &corner->outline;
  int first = OUTLINE_NODES;
  for (int i = OUTLINE_NODES - 1; i >= 0 && lowest > hypot(near[0], near[1]) - 1e-6; i--) {
    double p[2], n[2];
    place_profile(geometry, corner->flank, &corner->shape[corner->flank], high + (i - OUTLINE_NODES + 2) * step, p, n);
    double radius = hypot(p[0], p[1]), across = p[0] * n[1] - p[1] * n[0];
    if (!(radius < lowest))
      break; /* below the base circle the profile would turn back */
    lowest = outline->radius[i] = radius;
    outline->angle[i] = atan2(p[1], p[0]);
    outline->slope[i] = -(p[0] * n[0] + p[1] * n[1]) / (radius * across);
    first = i;
  }
  outline->nodes = OUTLINE_NODES - first;
  for (int i = 0; i < outline->nodes; i++) {
    outline->radius[i] = outline->radius[first + i];
    outline->angle[i] = outline->angle[first + i];
    outline->slope[i] = outline->slope[first + i];
  }
}

static double flank_angle(const struct outline *outline, double radius, double *slope)
{
  int low = 0, high = outline->nodes - 1;
  while (high - low > 1) {
    int middle = (low + high) / 2;
    if (outline->radius[middle] <= radius)
      low = middle;
    else
      high = middle;
  }
  double h = outline->radius[high] - outline->radius[low], t = fmin(1, fmax(0, (radius - outline->radius[low]) / h)),
         r = 1 - t;
  double difference = remainder(outline->angle[high] - outline->angle[low], 2 * M_PI),
         a = outline->slope[low] * h - difference, b = difference - outline->slope[high] * h;
  *slope = (difference + (r - t) * (a * r + b * t) + t * r * (b - a)) / h;
  return outline->angle[low] + difference * t + t * r * (a * r + b * t) +
         *slope * (radius - outline->radius[low] - t * h);
}

/* The normal of a flank with the polar slope d angle/d radius at the point x from its centre, and the share of shaft
   angle errors that goes with it: tan of the normal's angle against the circle is radius times slope. */
static struct eo_tilt tilt_at(const struct corner *corner, const double x[2], double bend)
{
  const struct eo_geometry *geometry = corner->geometry;
  double radius = hypot(x[0], x[1]), steep = radius * bend, arm = radius / sqrt(1 + steep * steep);
  double turned = atan2(x[1], x[0]) + atan(steep), place[2] = {x[0], x[1]}; /* theory (K8) */
  if (corner->flank == EO_PINION)
    place[1] -= geometry->centre_distance;
  /* theory (K9) */
  return eo_tilt_at(geometry, corner->flank == EO_PINION ? turned - M_PI / 2 : turned + M_PI / 2,
                    geometry->base_radius[corner->flank] / arm, place);
}

/* The angle by which the flank has to turn (the pinion forwards, the gear back: clockwise both) until it meets the
   point, as an arc of its base circle, normal. */
static struct touch touch_at(const struct corner *corner, int which, double c)
{
  const struct eo_geometry *geometry = corner->geometry;
  double x[2], rate = turning(corner, corner->tip), own = turning(corner, corner->flank), bend;
  place_tip(corner, which, c, x);
  double centre = corner->tip == EO_PINION ? -geometry->centre_distance : geometry->centre_distance,
         radius = hypot(x[0], x[1]);
  double v[2] = {-rate * (x[1] - centre), rate * x[0]},
         arm = geometry->base_radius[corner->flank] * cos(geometry->base_helix_angle);
  double angle = flank_angle(&corner->outline, radius, &bend) + own * c - atan2(x[1], x[0]);
  double turned = bend * (x[0] * v[0] + x[1] * v[1]) / radius + own - (x[0] * v[1] - x[1] * v[0]) / (radius * radius);
  return (struct touch){arm * remainder(angle, 2 * M_PI), arm * turned, tilt_at(corner, x, bend)};
}

/* Distance up to which a point inside the tip is nearer than the corner. The gap is tangent there, so that this place
   needs no great care. */
static double find_start(const struct corner *corner, double reach)
{
  enum { BISECTIONS = 12 };
  double low = 0, high = reach;
  for (int i = 0; i < BISECTIONS; i++) {
    double middle = i == 0 ? 0 : (low + high) / 2, c = phase_at(corner, middle);
    bool nearer = touch_at(corner, 1, c).gap < touch_at(corner, 0, c).gap;
    if (i == 0 && !nearer)
      return 0;
    low = nearer ? middle : low;
    high = nearer ? high : middle;
  }
  return high;
}

static void corner_init(struct corner *corner, const struct eo_geometry *geometry,
                        const struct eo_modification_shape shape[2], int side, double reach)
{
  static const double INSIDE = 1e-4; /* of the active profile: the point a little inside */
  corner->geometry = geometry;
  corner->shape = shape;
  corner->tip = side == 0 ? EO_GEAR : EO_PINION;
  corner->flank = 1 - corner->tip;
  double top = corner->tip == EO_PINION ? geometry->rack_top : -geometry->rack_bottom,
         inside = INSIDE * (geometry->rack_top - geometry->rack_bottom), unused[2];
  static const struct eo_modification_shape none = {0};
  place_profile(geometry, corner->tip, &shape[corner->tip], top, corner->point[0], unused);
  place_profile(geometry, corner->tip, &shape[corner->tip], top - inside, corner->point[1], unused);
  place_profile(geometry, corner->tip, &none, top, corner->point[2], unused);
  trace_flank(corner, reach);
}

/* Nodes crowd near the start, where contact happens: d - start = reach (i/n)^2. */
static double node_distance(const struct eo_corner_gap *table, int i)
{
  double t = (double)i / (EO_CORNER_NODES - 1);
  return table->start + (table->reach - table->start) * t * t;
}

/* What the corner has over the slices, errors' share in `advance`. */
static void fill(struct eo_corner_gap *table, const struct corner *corner, const struct eo_slice_gap *slice)
{
  for (int i = 0; i < EO_CORNER_NODES; i++) {
    double c = phase_at(corner, node_distance(table, i)), nominal[2], rate = 0;
    struct touch here = touch_at(corner, 0, c);
    place_tip(corner, 2, c, nominal);
    table->path[i] = eo_geometry_path_at(corner->geometry, corner->flank, hypot(nominal[0], nominal[1]));
    table->excess[i] = here.gap - (slice ? eo_slice_gap_at(slice, c, &rate) : 0);
    table->slope[i] = (here.slope - rate) * (corner->tip == EO_GEAR ? -1 : 1);
    struct eo_tilt tilt = eo_slice_tilt_at(slice, corner->geometry, c);
    for (int axis = 0; axis < 2; axis++) {
      table->advance[i].lever[axis] = here.tilt.lever[axis] - tilt.lever[axis];
      table->advance[i].shift[axis] = here.tilt.shift[axis] - tilt.shift[axis];
    }
  }
}

/* Takes off what is left at the start, where the corner takes over tangentially: rounding on unmodified flanks; with
   relief the slice gap turns the gear and the corner's the flank, and off the line of action they differ by some
   hundredths. */
static void join(struct eo_corner_gap *table)
{
  double gap = table->excess[0], slope = table->slope[0];
  struct eo_tilt tilt = table->advance[0];
  for (int i = 0; i < EO_CORNER_NODES; i++) {
    table->excess[i] -= gap + slope * (node_distance(table, i) - table->start);
    table->slope[i] -= slope;
    for (int axis = 0; axis < 2; axis++) {
      table->advance[i].lever[axis] -= tilt.lever[axis];
      table->advance[i].shift[axis] -= tilt.shift[axis];
    }
  }
}

/* From the errors' first-order share to the advance that makes it: share / E'. Next to the start both are too small for
   their quotient, which is smooth: there it follows a straight line. */
static void advance(struct eo_corner_gap *table)
{
  enum { NEAR = 4, FAR = 8 };
  for (int axis = 0; axis < 2; axis++)
    for (int part = 0; part < 2; part++) {
      double value[EO_CORNER_NODES] = {0};
      for (int i = NEAR; i < EO_CORNER_NODES; i++) {
        const struct eo_tilt *share = &table->advance[i];
        double rise = part ? share->shift[axis] : share->lever[axis];
        value[i] = table->slope[i] > 0 ? rise / table->slope[i] : i > NEAR ? value[i - 1] : 0; /* theory (K10) */
      }
      for (int i = 0; i < EO_CORNER_NODES; i++) {
        double t = (node_distance(table, i) - node_distance(table, NEAR)) /
                   (node_distance(table, FAR) - node_distance(table, NEAR));
        double smooth = i < NEAR ? value[NEAR] + t * (value[FAR] - value[NEAR]) : value[i];
        *(part ? &table->advance[i].shift[axis] : &table->advance[i].lever[axis]) = smooth;
      }
    }
}

static void make(struct eo_corner_gap *table, const struct corner *corner, const struct eo_slice_gap *slice)
{
  memset(table->added, 0, sizeof table->added);
  fill(table, corner, slice);
  join(table);
  advance(table);
}

static const double REACH = 0.25; /* p_bt: how far beyond the path of contact the corners' gaps are kept */

void eo_corner_gap_init(struct eo_corner_gap table[2], const struct eo_geometry *geometry)
{
  static const struct eo_modification_shape none[2];
  for (int side = 0; side < 2; side++) {
    struct corner corner;
    table[side].rule = EO_TILT_ROTATED;
    table[side].start = 0;
    table[side].reach = REACH * geometry->transverse_base_pitch;
    corner_init(&corner, geometry, none, side, table[side].reach);
    make(&table[side], &corner, NULL);
  }
}

void eo_corner_gap_modified(struct eo_corner_gap table[2], const struct eo_geometry *geometry,
                            const struct eo_modification_shape shape[2], const struct eo_slice_gap *slice)
{
  static const struct eo_modification_shape none[2];
  static const double LATEST = 0.9; /* of the reach: a table needs some of it behind its start */
  enum { LEAST_NODES = 8 }; /* fewer: relief so steep that the flank has no outline where the corner strikes; without */
  for (int side = 0; side < 2; side++) {
    struct corner corner;
    table[side].reach = REACH * geometry->transverse_base_pitch;
    corner_init(&corner, geometry, shape, side, table[side].reach);
    if (corner.outline.nodes < LEAST_NODES)
      corner_init(&corner, geometry, none, side, table[side].reach);
    table[side].start = find_start(&corner, LATEST * table[side].reach);
    make(&table[side], &corner, slice);
  }
}

void eo_corner_gap_at_radius(struct eo_corner_gap table[2], const struct eo_geometry *geometry,
                             const struct eo_modification_shape shape[2], const struct eo_slice_gap *slice)
{
  static const struct eo_modification_shape none;
  struct eo_slice_gap alone[2];
  for (int member = 0; member < 2; member++) {
    struct eo_modification_shape only[2] = {none, none};
    only[member] = shape[member];
    eo_slice_gap_init(&alone[member], geometry, only);
  }
  for (int side = 0; side < 2; side++) {
    int tip = side == 0 ? EO_GEAR : EO_PINION, sign = side == 0 ? -1 : 1;
    double end = side == 0 ? geometry->path_start : geometry->path_end,
           at_tip = eo_slice_gap_at(&alone[tip], end, NULL);
    for (int i = 0; i < EO_CORNER_NODES; i++) {
      int before = i > 0 ? i - 1 : 0, after = i + 1 < EO_CORNER_NODES ? i + 1 : i;
      double slope, rate, c = end + sign * node_distance(&table[side], i),
                          travel = (table[side].path[after] - table[side].path[before]) /
                                   (node_distance(&table[side], after) - node_distance(&table[side], before));
      table[side].excess[i] += eo_slice_gap_at(&alone[1 - tip], table[side].path[i], &slope) + at_tip -
                               eo_slice_gap_at(slice, c, &rate);
      table[side].slope[i] += slope * travel - sign * rate;
      struct eo_tilt struck = eo_slice_tilt_at(NULL, geometry, table[side].path[i]),
                     even = eo_slice_tilt_at(NULL, geometry, c);
      for (int axis = 0; axis < 2; axis++)
        table[side].added[i].shift[axis] = struck.shift[axis] - even.shift[axis];
    }
    memset(table[side].advance, 0, sizeof table[side].advance);
  }
}

/* Slopes at the nodes: of the parabola through each and its neighbours, exact at unequal steps. */
static void differentiate(const double d[EO_CORNER_NODES], const double value[EO_CORNER_NODES],
                          double slope[EO_CORNER_NODES])
{
  for (int i = 0; i < EO_CORNER_NODES; i++) {
    int k = i == 0 ? 1 : i == EO_CORNER_NODES - 1 ? i - 1 : i;
    double before = (value[k] - value[k - 1]) / (d[k] - d[k - 1]),
           after = (value[k + 1] - value[k]) / (d[k + 1] - d[k]);
    double bend = (after - before) / (d[k + 1] - d[k - 1]);
    slope[i] = before + bend * (2 * d[i] - d[k] - d[k - 1]);
  }
}

void eo_corner_gap_tilt(struct eo_tilted_corner *tilted, const struct eo_corner_gap *corner, const double errors[2])
{
  double d[EO_CORNER_NODES], added[EO_CORNER_NODES], added_slope[EO_CORNER_NODES];
  for (int i = 0; i < EO_CORNER_NODES; i++) {
    const struct eo_tilt *advance = &corner->advance[i], *more = &corner->added[i];
    d[i] = node_distance(corner, i);
    added[i] = errors[0] * more->shift[0] + errors[1] * more->shift[1];
    tilted->lever[i] = errors[0] * advance->lever[0] + errors[1] * advance->lever[1];
    tilted->shift[i] = errors[0] * advance->shift[0] + errors[1] * advance->shift[1];
  }
  differentiate(d, added, added_slope);
  for (int i = 0; i < EO_CORNER_NODES; i++) {
    tilted->level[i] = corner->excess[i] + added[i];
    tilted->level_slope[i] = corner->slope[i] + added_slope[i];
  }
}

/* The piece that holds d (the first one also below the start, the last one also beyond the reach), its ends from the
   start. */
static int piece_of(const struct eo_corner_gap *table, double d, double ends[2])
{
  int last = EO_CORNER_NODES - 1;
  double beyond = fmax(0, d - table->start), span = table->reach - table->start;
  int i = (int)fmin(last - 1, sqrt(beyond / span) * last);
  ends[0] = span / (last * last) * (double)(i * i);
  ends[1] = span / (last * last) * (double)((i + 1) * (i + 1));
  return i;
}

double eo_corner_gap_at(const struct eo_corner_gap *table, const struct eo_tilted_corner *tilted, double d, double z,
                        double *slope)
{
  double ends[2], beyond = d - table->start;
  int i = piece_of(table, d, ends);
  double from = tilted->shift[i] + z * tilted->lever[i], h = ends[1] - ends[0],
         rate = (tilted->shift[i + 1] + z * tilted->lever[i + 1] - from) / h;
  if (beyond < 0)
    rate = 0;
  beyond += from + rate * (beyond - ends[0]); /* theory (K11) */
  *slope = 0;
  if (beyond < 0)
    return 0;
  i = piece_of(table, table->start + beyond, ends);
  h = ends[1] - ends[0];
  double t = (beyond - ends[0]) / h, r = 1 - t, difference = tilted->level[i + 1] - tilted->level[i],
         a = tilted->level_slope[i] * h - difference, b = difference - tilted->level_slope[i + 1] * h;
  *slope = (difference + (r - t) * (a * r + b * t) + t * r * (b - a)) / h * (1 + rate);
  return tilted->level[i] * r + tilted->level[i + 1] * t + t * r * (a * r + b * t);
}

double eo_corner_gap_place(const struct eo_corner_gap *table, double end, double d)
{
  double ends[2];
  if (d < table->start)
    return end + d * (table->path[0] - end) / table->start;
  int i = piece_of(table, d, ends);
  double t = (d - table->start - ends[0]) / (ends[1] - ends[0]);
  return table->path[i] + t * (table->path[i + 1] - table->path[i]);
}
