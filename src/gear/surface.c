#include "gear/surface.h"

#include <math.h>
#include <stddef.h>

void eo_surface_evaluate(const struct eo_geometry *g, int member, const struct eo_modification_shape *shape, double u, double v,
                         struct eo_surface_point *point)
{
  double sa = sin(g->normal_pressure_angle), ca = cos(g->normal_pressure_angle), sb = sin(g->helix_angle), cb = cos(g->helix_angle);
  const double e[3] = {cb, 0, -sb}, t[3] = {sb, 0, cb}, across[3] = {0, 1, 0};
  double rack = u + g->rack_offset[member], r = g->reference_radius[member];
  double skew = sa * sb / cb, side = member == EO_PINION ? 1 : -1, profile_slope[2], lead_slope;
  double delta = eo_modification_profile(shape, u, profile_slope) + eo_modification_lead(shape, side * (v + rack * skew), &lead_slope);
  lead_slope *= side;
  double du = (profile_slope[0] + profile_slope[1]) / 2 + lead_slope * skew, dv = lead_slope, x[3], n[3];
  for (int i = 0; i < 3; i++) {
    double f = -sa * e[i] + ca * across[i], m = ca * e[i] + sa * across[i];
    x[i] = rack * f + v * t[i] - delta * m;
    n[i] = m + du * f + dv * t[i];
  }
  double roll = (x[1] * n[0] / n[1] - x[0]) / r, c = cos(roll), s = sin(roll), length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  double y0 = x[0] + r * roll, y1 = x[1] + r;
  point->roll = roll;
  point->position[0] = c * y0 - s * y1;
  point->position[1] = s * y0 + c * y1;
  point->position[2] = x[2];
  point->normal[0] = (c * n[0] - s * n[1]) / length;
  point->normal[1] = (s * n[0] + c * n[1]) / length;
  point->normal[2] = n[2] / length;
}

void eo_surface_coordinates(const struct eo_geometry *g, int member, double s, double eta, double *u, double *v)
{
  *u = g->rack_factor * eo_geometry_own_path(member, s);
  double rack = *u + g->rack_offset[member];
  *v = ((member == EO_PINION ? eta : -eta) - rack * sin(g->normal_pressure_angle) * sin(g->helix_angle)) / cos(g->helix_angle);
}

/* What a slice's flank shows to its partner: the arm of its normal about its own axis, the distance along the normal from the foot
   of that arm, and the direction angle it has when the tooth stands at roll 0. */
struct ray {
  double arm, distance, angle;
};

static struct ray slice_ray(const struct eo_geometry *g, int member, const struct eo_modification_shape *shape, double u, int side)
{
  double sa = sin(g->normal_pressure_angle), ca = cos(g->normal_pressure_angle), sb = sin(g->helix_angle), cb = cos(g->helix_angle);
  double slope[2], delta = eo_modification_profile(shape, u, slope), d = slope[side], rack = u + g->rack_offset[member];
  double r = g->reference_radius[member];
  /* Moved along the rack's trace back into the slice: the gap would come out sin^2(beta_b) too small without. */
  double z = (rack * sa + delta * ca) * sb, x = -(rack * sa + delta * ca) * cb - z * sb / cb, y = rack * ca - delta * sa;
  double nx = (ca - d * sa) * cb, ny = sa + d * ca, length = hypot(nx, ny);
  nx /= length;
  ny /= length;
  double roll = (y * nx / ny - x) / r, qx = x + r * roll, qy = y + r;
  return (struct ray){.arm = qy * nx - qx * ny, .distance = qx * nx + qy * ny, .angle = roll + atan2(ny, nx)};
}

void eo_slice_point_at(const struct eo_geometry *g, int member, const struct eo_modification_shape *shape, double u,
                       struct eo_slice_point *point)
{
  struct ray ray = slice_ray(g, member, shape, u, 0);
  double c = cos(ray.angle), s = sin(ray.angle);
  point->normal[0] = c;
  point->normal[1] = s;
  point->position[0] = ray.distance * c - ray.arm * s;
  point->position[1] = ray.distance * s + ray.arm * c;
}

static struct ray involute_ray(const struct eo_geometry *g, int member, double distance)
{
  double base = g->base_radius[member], start = base * tan(g->transverse_pressure_angle);
  return (struct ray){.arm = base, .distance = distance, .angle = (distance - start) / base + g->transverse_pressure_angle};
}

/* Angle of the common normal for two arms. */
static double common_angle(const struct eo_geometry *g, const struct ray *p, const struct ray *q)
{
  return acos((p->arm + q->arm) / g->centre_distance);
}

/* The gear's ray in contact with the pinion's: distances along the common normal add up to a sin(alpha'). */
static struct ray partner(const struct eo_geometry *g, const struct eo_modification_shape *shape, const struct ray *p)
{
  struct ray q = involute_ray(g, EO_GEAR, 0);
  q = involute_ray(g, EO_GEAR, g->centre_distance * sin(common_angle(g, p, &q)) - p->distance);
  if (!shape)
    return q;
  double u = g->rack_factor * (q.distance - g->tangent_length[EO_GEAR]), last_u = 0, last_miss = 0;
  for (int i = 0; i < 30; i++) { /* secant; the distance runs with u at the rate 1/k_u but for the slope of the relief */
    q = slice_ray(g, EO_GEAR, shape, u, 0);
    double miss = g->centre_distance * sin(common_angle(g, p, &q)) - p->distance - q.distance;
    double rate = i == 0 || miss == last_miss ? -1 / g->rack_factor : (miss - last_miss) / (u - last_u);
    last_u = u;
    last_miss = miss;
    if (fabs(miss) < 1e-13)
      break;
    u -= miss / rate;
  }
  return q;
}

/* Base-circle phase of a member whose ray lies in the common normal. */
static double phase_of(const struct eo_geometry *g, int member, const struct ray *ray, double common)
{
  double offset = eo_geometry_involute_function(g->working_pressure_angle) - eo_geometry_involute_function(g->transverse_pressure_angle);
  return g->base_radius[member] * (ray->angle - common - offset);
}

static void add_node(struct eo_slice_gap *table, const struct eo_geometry *g, const struct eo_modification_shape *gear, const struct ray *p)
{
  struct ray q = partner(g, gear, p);
  double common = common_angle(g, p, &q), c = phase_of(g, EO_PINION, p, common);
  if (table->nodes > 0 && c <= table->phase[table->nodes - 1])
    return; /* a fold of the normals at a concave kink: the outer branch is covered by the next nodes */
  double rate = p->arm * g->base_radius[EO_GEAR] / (q.arm * g->base_radius[EO_PINION]), normal = cos(g->base_helix_angle);
  table->phase[table->nodes] = c;
  table->gap[table->nodes] = (c + phase_of(g, EO_GEAR, &q, common)) * normal;
  table->slope[table->nodes++] = (1 - rate) * normal;
}

static bool profile_is_modified(const struct eo_modification_shape *shape)
{
  return shape->crowning != 0 || shape->side[0].length > 0 || shape->side[1].length > 0;
}

/* Profile coordinates where the shape changes, on the pinion's axis (the gear's mirrored), sorted into breaks[]. */
static int collect_breaks(const struct eo_geometry *g, const struct eo_modification_shape shape[2], double breaks[8])
{
  double margin = 0.15 * (g->rack_top - g->rack_bottom);
  int count = 0;
  breaks[count++] = g->rack_bottom - margin;
  breaks[count++] = g->rack_top + margin;
  for (int member = 0; member < 2; member++)
    for (int side = 0; side < 2; side++)
      if (shape[member].side[side].length > 0) {
        double u = (side == member ? -1 : 1) * shape[member].side[side].start;
        if (u > breaks[0] && u < g->rack_top + margin)
          breaks[count++] = u;
      }
  for (int i = 1; i < count; i++)
    for (int j = i; j > 0 && breaks[j] < breaks[j - 1]; j--) {
      double swap = breaks[j];
      breaks[j] = breaks[j - 1];
      breaks[j - 1] = swap;
    }
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

void eo_slice_gap_init(struct eo_slice_gap *table, const struct eo_geometry *g, const struct eo_modification_shape shape[2])
{
  enum { PIECES = 40 }; /* per segment between two breaks: interpolation error below 1e-12 m */
  bool pinion = profile_is_modified(&shape[EO_PINION]), gear = profile_is_modified(&shape[EO_GEAR]);
  table->nodes = 0;
  if (!pinion && !gear)
    return;
  double breaks[8];
  int count = collect_breaks(g, shape, breaks);
  for (int k = 0; k + 1 < count; k++)
    for (int i = 0; i <= PIECES; i++) {
      double u = breaks[k] + (breaks[k + 1] - breaks[k]) * i / PIECES;
      struct ray p = pinion ? slice_ray(g, EO_PINION, &shape[EO_PINION], u, i == PIECES ? 0 : 1)
                            : involute_ray(g, EO_PINION, g->tangent_length[EO_PINION] + u / g->rack_factor);
      add_node(table, g, gear ? &shape[EO_GEAR] : NULL, &p);
    }
  fill_buckets(table);
}

double eo_slice_gap_at(const struct eo_slice_gap *table, double c, double *slope)
{
  double unused;
  slope = slope ? slope : &unused;
  *slope = 0;
  if (table->nodes == 0)
    return 0;
  int last = table->nodes - 1, i;
  if (c <= table->phase[0] || c >= table->phase[last]) {
    i = c <= table->phase[0] ? 0 : last;
    *slope = table->slope[i];
    return table->gap[i] + table->slope[i] * (c - table->phase[i]);
  }
  i = table->bucket[(int)((c - table->phase[0]) * table->bucket_rate) & (EO_SLICE_BUCKETS - 1)];
  while (i < last - 1 && table->phase[i + 1] < c)
    i++;
  double h = table->phase[i + 1] - table->phase[i], t = (c - table->phase[i]) / h, r = 1 - t;
  double difference = table->gap[i + 1] - table->gap[i], a = table->slope[i] * h - difference, b = difference - table->slope[i + 1] * h;
  *slope = (difference + (r - t) * (a * r + b * t) + t * r * (b - a)) / h;
  return table->gap[i] * r + table->gap[i + 1] * t + t * r * (a * r + b * t);
}
