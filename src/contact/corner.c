#include "contact/corner.h"

#include <math.h>
#include <stddef.h>

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
};

static void turn(const double from[2], double angle, double to[2])
{
  double x = from[0], y = from[1];
  to[0] = cos(angle) * x - sin(angle) * y;
  to[1] = sin(angle) * x + cos(angle) * y;
}

/* A member's profile point and normal about its own centre at pinion phase 0. */
static void place_profile(const struct eo_geometry *g, int member, const struct eo_modification_shape *shape, double u,
                          double point[2], double normal[2])
{
  struct eo_slice_point p;
  eo_slice_point_at(g, member, shape, u, &p);
  double angle = eo_geometry_involute_function(g->transverse_pressure_angle) -
                 eo_geometry_involute_function(g->working_pressure_angle);
  angle += member == EO_PINION ? 0 : M_PI;
  turn(p.position, angle, point);
  turn(p.normal, angle, normal);
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
  turn(corner->point[which], c * turning(corner, corner->tip), point);
  point[1] += corner->tip == EO_PINION ? -corner->geometry->centre_distance : corner->geometry->centre_distance;
}

/* From a little above the radius that the corner has at the end of the reach down to the one it has at the start. */
static void trace_flank(struct corner *corner, double reach)
{
  const struct eo_geometry *g = corner->geometry;
  double far[2], near[2], lowest = INFINITY, span = g->rack_top - g->rack_bottom;
  place_tip(corner, 0, phase_at(corner, reach), far);
  place_tip(corner, 0, phase_at(corner, 0), near);
  double path = eo_geometry_path_at(g, corner->flank, hypot(far[0], far[1])),
         high = g->rack_factor * eo_geometry_own_path(corner->flank, path);
  double bottom = corner->flank == EO_PINION ? g->rack_bottom : -g->rack_top,
         step = (high - bottom + 0.25 * span) / (OUTLINE_NODES - 4);
  struct outline *o = &corner->outline;
  int first = OUTLINE_NODES;
  for (int i = OUTLINE_NODES - 1; i >= 0 && lowest > hypot(near[0], near[1]) - 1e-6; i--) {
    double p[2], n[2];
    place_profile(g, corner->flank, &corner->shape[corner->flank], high + (i - OUTLINE_NODES + 2) * step, p, n);
    double radius = hypot(p[0], p[1]), across = p[0] * n[1] - p[1] * n[0];
    if (!(radius < lowest))
      break; /* below the base circle the profile would turn back */
    lowest = o->radius[i] = radius;
    o->angle[i] = atan2(p[1], p[0]);
    o->slope[i] = -(p[0] * n[0] + p[1] * n[1]) / (radius * across);
    first = i;
  }
  o->nodes = OUTLINE_NODES - first;
  for (int i = 0; i < o->nodes; i++) {
    o->radius[i] = o->radius[first + i];
    o->angle[i] = o->angle[first + i];
    o->slope[i] = o->slope[first + i];
  }
}

static double flank_angle(const struct outline *o, double radius, double *slope)
{
  int low = 0, high = o->nodes - 1;
  while (high - low > 1) {
    int middle = (low + high) / 2;
    if (o->radius[middle] <= radius)
      low = middle;
    else
      high = middle;
  }
  double h = o->radius[high] - o->radius[low], t = fmin(1, fmax(0, (radius - o->radius[low]) / h)), r = 1 - t;
  double difference = remainder(o->angle[high] - o->angle[low], 2 * M_PI), a = o->slope[low] * h - difference,
         b = difference - o->slope[high] * h;
  *slope = (difference + (r - t) * (a * r + b * t) + t * r * (b - a)) / h;
  return o->angle[low] + difference * t + t * r * (a * r + b * t) + *slope * (radius - o->radius[low] - t * h);
}

/* The angle by which the flank has to turn (the pinion forwards, the gear back: clockwise both) until it meets the
   point, as an arc of its base circle, normal. */
static struct touch touch_at(const struct corner *corner, int which, double c)
{
  const struct eo_geometry *g = corner->geometry;
  double x[2], rate = turning(corner, corner->tip), own = turning(corner, corner->flank), bend;
  place_tip(corner, which, c, x);
  double centre = corner->tip == EO_PINION ? -g->centre_distance : g->centre_distance, radius = hypot(x[0], x[1]);
  double v[2] = {-rate * (x[1] - centre), rate * x[0]}, arm = g->base_radius[corner->flank] * cos(g->base_helix_angle);
  double angle = flank_angle(&corner->outline, radius, &bend) + own * c - atan2(x[1], x[0]);
  double turned = bend * (x[0] * v[0] + x[1] * v[1]) / radius + own - (x[0] * v[1] - x[1] * v[0]) / (radius * radius);
  return (struct touch){arm * remainder(angle, 2 * M_PI), arm * turned};
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

static void corner_init(struct corner *corner, const struct eo_geometry *g, const struct eo_modification_shape shape[2],
                        int side, double reach)
{
  corner->geometry = g;
  corner->shape = shape;
  corner->tip = side == 0 ? EO_GEAR : EO_PINION;
  corner->flank = 1 - corner->tip;
  double top = corner->tip == EO_PINION ? g->rack_top : -g->rack_bottom, inside = 1e-4 * (g->rack_top - g->rack_bottom),
         unused[2];
  static const struct eo_modification_shape none = {0};
  place_profile(g, corner->tip, &shape[corner->tip], top, corner->point[0], unused);
  place_profile(g, corner->tip, &shape[corner->tip], top - inside, corner->point[1], unused);
  place_profile(g, corner->tip, &none, top, corner->point[2], unused);
  trace_flank(corner, reach);
}

static void fill(struct eo_corner_gap *table, const struct corner *corner)
{
  /* Nodes crowd near the start, where contact happens: d - start = reach (i/n)^2. */
  for (int i = 0; i < EO_CORNER_NODES; i++) {
    double t = (double)i / (EO_CORNER_NODES - 1), d = table->start + (table->reach - table->start) * t * t;
    struct touch here = touch_at(corner, 0, phase_at(corner, d));
    double nominal[2];
    place_tip(corner, 2, phase_at(corner, d), nominal);
    table->gap[i] = here.gap;
    table->path[i] = eo_geometry_path_at(corner->geometry, corner->flank, hypot(nominal[0], nominal[1]));
    table->slope[i] = corner->tip == EO_GEAR ? -here.slope : here.slope;
  }
}

void eo_corner_gap_init(struct eo_corner_gap table[2], const struct eo_geometry *g)
{
  static const struct eo_modification_shape none[2];
  for (int side = 0; side < 2; side++) {
    struct corner corner;
    table[side].at_radius = false;
    table[side].start = 0;
    table[side].reach = 0.25 * g->transverse_base_pitch;
    corner_init(&corner, g, none, side, table[side].reach);
    fill(&table[side], &corner);
  }
}

void eo_corner_gap_modified(struct eo_corner_gap table[2], const struct eo_geometry *g,
                            const struct eo_modification_shape shape[2], const struct eo_slice_gap *slice)
{
  static const struct eo_modification_shape none[2];
  for (int side = 0; side < 2; side++) {
    struct corner corner;
    table[side].reach = 0.25 * g->transverse_base_pitch;
    corner_init(&corner, g, shape, side, table[side].reach);
    if (corner.outline.nodes <
        8) /* relief so steep that the flank has no outline where the corner strikes: take it without */
      corner_init(&corner, g, none, side, table[side].reach);
    table[side].start = find_start(&corner, 0.9 * table[side].reach);
    fill(&table[side], &corner);
    /* The slice gap turns the gear back, the corner's turns the flank: off the line of action they differ by some
       hundredths. */
    double step = eo_slice_gap_at(slice, phase_at(&corner, table[side].start), NULL) - table[side].gap[0];
    for (int i = 0; i < EO_CORNER_NODES; i++)
      table[side].gap[i] += step;
  }
}

void eo_corner_gap_at_radius(struct eo_corner_gap table[2], const struct eo_geometry *g,
                             const struct eo_modification_shape shape[2])
{
  static const struct eo_modification_shape none;
  struct eo_slice_gap slice[2];
  for (int member = 0; member < 2; member++) {
    struct eo_modification_shape alone[2] = {none, none};
    alone[member] = shape[member];
    eo_slice_gap_init(&slice[member], g, alone);
  }
  for (int side = 0; side < 2; side++) {
    int tip = side == 0 ? EO_GEAR : EO_PINION;
    double at_tip = eo_slice_gap_at(&slice[tip], side == 0 ? g->path_start : g->path_end, NULL);
    for (int i = 0; i < EO_CORNER_NODES; i++) {
      int before = i > 0 ? i - 1 : 0, after = i + 1 < EO_CORNER_NODES ? i + 1 : i;
      double unit = table[side].reach / ((EO_CORNER_NODES - 1) * (EO_CORNER_NODES - 1)), slope;
      double travel = (table[side].path[after] - table[side].path[before]) / (unit * (after * after - before * before));
      table[side].gap[i] += eo_slice_gap_at(&slice[1 - tip], table[side].path[i], &slope) + at_tip;
      table[side].slope[i] += slope * travel;
    }
  }
}

double eo_corner_gap_at(const struct eo_corner_gap *table, double d, double *slope, double *place, double *travel)
{
  int last = EO_CORNER_NODES - 1,
      i = (int)fmin(last - 1, sqrt((d - table->start) / (table->reach - table->start)) * last);
  double unit = (table->reach - table->start) / (last * last), low = unit * (double)(i * i),
         high = unit * (double)((i + 1) * (i + 1));
  double h = high - low, t = (d - table->start - low) / h, r = 1 - t;
  double difference = table->gap[i + 1] - table->gap[i], a = table->slope[i] * h - difference,
         b = difference - table->slope[i + 1] * h;
  *slope = (difference + (r - t) * (a * r + b * t) + t * r * (b - a)) / h;
  *place = table->path[i] * r + table->path[i + 1] * t;
  *travel = (table->path[i + 1] - table->path[i]) / h;
  return table->gap[i] * r + table->gap[i + 1] * t + t * r * (a * r + b * t);
}
