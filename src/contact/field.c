#include "contact/field.h"

#include <math.h>
#include <stddef.h>

/* What the tip of member `tip` shows to the flank of the other one; see eo_corner_gap. Coordinates from the pitch point, pinion centre
   at (0, -r_w1), gear centre at (0, r_w2); the pinion turns clockwise, the flank normal points to (cos alpha_wt, sin alpha_wt). */
struct corner {
  double gap, path;
};

static void place_on_path(const struct eo_geometry *g, double s, double point[2])
{
  point[0] = s * cos(g->working_pressure_angle);
  point[1] = s * sin(g->working_pressure_angle);
}

static void turn(double point[2], double centre, double angle)
{
  double x = point[0], y = point[1] - centre;
  point[0] = cos(angle) * x - sin(angle) * y;
  point[1] = centre + sin(angle) * x + cos(angle) * y;
}

static struct corner corner_at(const struct eo_geometry *g, int side, double distance)
{
  int tip = side == 0 ? EO_GEAR : EO_PINION, flank = 1 - tip;
  double end = side == 0 ? g->path_start : g->path_end, c = end + (side == 0 ? -distance : distance);
  double centre[2] = {-g->working_radius[EO_PINION], g->working_radius[EO_GEAR]}, sense[2] = {-1, 1}, point[2], place[2];
  place_on_path(g, end, point);
  turn(point, centre[tip], sense[tip] * (c - end) / g->base_radius[tip]);
  struct corner corner;
  corner.path = eo_geometry_path_at(g, flank, hypot(point[0], point[1] - centre[flank]));
  place_on_path(g, corner.path, place);
  turn(place, centre[flank], sense[flank] * (c - corner.path) / g->base_radius[flank]);
  double cross = place[0] * (point[1] - centre[flank]) - (place[1] - centre[flank]) * point[0];
  double angle = atan2(cross, place[0] * point[0] + (place[1] - centre[flank]) * (point[1] - centre[flank]));
  /* The flank has to turn in its driving sense (pinion) or back (gear) to reach the corner. */
  double arc = g->base_radius[flank] * angle * (flank == EO_PINION ? sense[flank] : -sense[flank]);
  corner.gap = arc * cos(g->base_helix_angle);
  return corner;
}

void eo_corner_gap_init(struct eo_corner_gap corner[2], const struct eo_geometry *g)
{
  for (int side = 0; side < 2; side++) {
    struct eo_corner_gap *table = &corner[side];
    table->reach = 0.25 * g->transverse_base_pitch;
    /* Nodes crowd near the end of the path, where contact happens: d = reach (i/n)^2. */
    for (int i = 0; i < EO_CORNER_NODES; i++) {
      double t = (double)i / (EO_CORNER_NODES - 1), d = table->reach * t * t, h = 1e-5 * table->reach, below = fmax(0, d - h);
      struct corner here = corner_at(g, side, d), before = corner_at(g, side, below), after = corner_at(g, side, d + h);
      table->gap[i] = here.gap;
      table->path[i] = here.path;
      table->slope[i] = (after.gap - before.gap) / (d + h - below);
    }
  }
}

/* Corner gap of the unmodified pair, plus what relief takes off the flank there and off the tip; *place: s on the flank; *slope: by s,
   with tilt, that of misalignment and bodies, at the place. */
static double corner_value(const struct eo_gap_field *field, int tip, double s, double tilt, double *slope, double *place)
{
  const struct eo_corner_gap *table = &field->corner[tip == EO_GEAR ? 0 : 1];
  double end = tip == EO_GEAR ? field->geometry->path_start : field->geometry->path_end, d = fabs(s - end), rate, side;
  int last = EO_CORNER_NODES - 1, i = (int)fmin(last - 1, sqrt(d / table->reach) * last);
  double low = table->reach * (double)(i * i) / (last * last), high = table->reach * (double)((i + 1) * (i + 1)) / (last * last);
  double h = high - low, t = (d - low) / h, r = 1 - t;
  double difference = table->gap[i + 1] - table->gap[i], a = table->slope[i] * h - difference, b = difference - table->slope[i + 1] * h;
  rate = (difference + (r - t) * (a * r + b * t) + t * r * (b - a)) / h;
  *place = table->path[i] * r + table->path[i + 1] * t;
  double gap = table->gap[i] * r + table->gap[i + 1] * t + t * r * (a * r + b * t);
  gap += eo_slice_gap_at(&field->alone[1 - tip], *place, &side) + field->tip_gap[tip];
  double travel = (table->path[i + 1] - table->path[i]) / h; /* of the place, by the distance */
  *slope = (rate + (side + tilt) * travel) * (tip == EO_GEAR ? -1 : 1);
  return gap;
}

/* Values of both parts at eta. */
static void deflection_parts(const struct eo_deflection *deflection, double face_width, double eta, double part[2])
{
  double u = (eta / face_width + 0.5) * (EO_DEFLECTION_NODES - 1);
  int i = (int)fmax(0, fmin(EO_DEFLECTION_NODES - 2, floor(u)));
  for (int k = 0; k < 2; k++)
    part[k] = deflection->part[k][i] + (u - i) * (deflection->part[k][i + 1] - deflection->part[k][i]);
}

double eo_deflection_at(const struct eo_deflection *deflection, double face_width, double s, double eta)
{
  double part[2];
  deflection_parts(deflection, face_width, eta, part);
  return part[0] + s * part[1];
}

void eo_gap_field_init(struct eo_gap_field *field, const struct eo_geometry *g, const struct eo_flank_modification *pinion,
                       const struct eo_flank_modification *gear, int end, double in_plane, double out_of_plane, double pivot,
                       const struct eo_corner_gap corner[2])
{
  double sign = end == EO_LEFT ? -1 : 1;
  field->geometry = g;
  field->corner = corner;
  field->lean = tan(g->base_helix_angle);
  field->stretch = 1 / cos(g->helix_angle);
  eo_modification_init(&field->shape[EO_PINION], g, EO_PINION, pinion);
  eo_modification_init(&field->shape[EO_GEAR], g, EO_GEAR, gear);
  static const struct eo_modification_shape none = {0};
  for (int member = 0; member < 2; member++) {
    struct eo_modification_shape alone[2] = {none, none};
    alone[member] = field->shape[member];
    eo_slice_gap_init(&field->alone[member], g, alone);
  }
  if (field->alone[EO_PINION].nodes > 0 && field->alone[EO_GEAR].nodes > 0)
    eo_slice_gap_init(&field->slice, g, field->shape);
  else
    field->slice = field->alone[field->alone[EO_PINION].nodes > 0 ? EO_PINION : EO_GEAR];
  for (int tip = 0; tip < 2; tip++) {
    double at = tip == EO_GEAR ? g->path_start : g->path_end;
    field->tip_gap[tip] = eo_slice_gap_at(&field->slice, at, NULL) - eo_slice_gap_at(&field->alone[1 - tip], at, NULL);
  }
  /* physics: D = end cos(beta_b) (gamma cos(alpha_t) - kappa sin(alpha_t)) (eta + s tan(beta_b)) */
  field->misalignment = sign * cos(g->base_helix_angle) *
                        (out_of_plane * cos(g->working_pressure_angle) - in_plane * sin(g->working_pressure_angle));
  field->misalignment_offset = field->misalignment * pivot;
  field->deflection = NULL;
}

double eo_gap_field_at(const struct eo_gap_field *field, double s, double eta, double *slope, double path[2])
{
  const struct eo_geometry *g = field->geometry;
  double rate, unused, place = s, gap, x = eta * field->stretch, tangent = field->lean, body[2] = {0, 0};
  int tip = -1;
  if (field->deflection)
    deflection_parts(field->deflection, g->face_width, eta, body);
  double tilt = field->misalignment * tangent + body[1];
  if (s < g->path_start || s > g->path_end) {
    tip = s < g->path_start ? EO_GEAR : EO_PINION;
    gap = corner_value(field, tip, s, tilt, &rate, &place);
  } else {
    gap = eo_slice_gap_at(&field->slice, s, &rate);
    rate += tilt;
  }
  if (path) {
    path[EO_PINION] = tip == EO_PINION ? g->path_end : place;
    path[EO_GEAR] = tip == EO_GEAR ? g->path_start : place;
  }
  gap += eo_modification_lead(&field->shape[EO_PINION], x, &unused) + eo_modification_lead(&field->shape[EO_GEAR], x, &unused);
  gap += field->misalignment * eta + field->misalignment_offset + body[0] + place * tilt;
  if (slope)
    *slope = rate;
  return gap;
}

bool eo_gap_field_line_range(const struct eo_geometry *g, double c, double low, double high, double range[2])
{
  double half = g->face_width / 2, tangent = tan(g->base_helix_angle);
  range[0] = -half;
  range[1] = half;
  if (tangent < 1e-9)
    return c >= low && c <= high;
  range[0] = fmax(range[0], (low - c) / tangent);
  range[1] = fmin(range[1], (high - c) / tangent);
  return range[1] > range[0];
}

double eo_gap_field_line_minimum(const struct eo_gap_field *field, double c, bool edges, double *at)
{
  enum { SAMPLES = 32, GOLDEN_STEPS = 18 };
  const struct eo_geometry *g = field->geometry;
  double range[2], tangent = field->lean, best = INFINITY, best_eta = 0;
  double reach = edges ? field->corner[0].reach / 2 : 0;
  if (!eo_gap_field_line_range(g, c, g->path_start - reach, g->path_end + reach, range))
    return INFINITY;
  double step = (range[1] - range[0]) / SAMPLES;
  for (int i = 0; i <= SAMPLES; i++) {
    double eta = range[0] + i * step, gap = eo_gap_field_at(field, c + eta * tangent, eta, NULL, NULL);
    if (gap < best) {
      best = gap;
      best_eta = eta;
    }
  }
  double low = fmax(range[0], best_eta - step), high = fmin(range[1], best_eta + step), ratio = 0.6180339887498949;
  double a = high - ratio * (high - low), b = low + ratio * (high - low);
  double fa = eo_gap_field_at(field, c + a * tangent, a, NULL, NULL), fb = eo_gap_field_at(field, c + b * tangent, b, NULL, NULL);
  for (int i = 0; i < GOLDEN_STEPS; i++) {
    if (fmin(fa, fb) < best) {
      best = fmin(fa, fb);
      best_eta = fa < fb ? a : b;
    }
    if (fa < fb) {
      high = b;
      b = a;
      fb = fa;
      a = high - ratio * (high - low);
      fa = eo_gap_field_at(field, c + a * tangent, a, NULL, NULL);
    } else {
      low = a;
      a = b;
      fa = fb;
      b = low + ratio * (high - low);
      fb = eo_gap_field_at(field, c + b * tangent, b, NULL, NULL);
    }
  }
  if (at)
    *at = best_eta;
  return best;
}

/* The smallest gap over the path of contact in the transverse slice at eta, lead modification and what else is constant there apart. */
static double lowest_profile(int samples, const double *path, const double *profile, double tilt)
{
  double lowest = INFINITY;
  for (int i = 0; i < samples; i++)
    lowest = fmin(lowest, profile[i] + path[i] * tilt);
  return lowest;
}

double eo_gap_field_datum(const struct eo_gap_field *field)
{
  enum { SAMPLES = 401 };
  const struct eo_geometry *g = field->geometry;
  double path[SAMPLES], profile[SAMPLES], unused, lowest = INFINITY;
  for (int i = 0; i < SAMPLES; i++) {
    path[i] = g->path_start + (g->path_end - g->path_start) * i / (SAMPLES - 1);
    profile[i] = eo_slice_gap_at(&field->slice, path[i], NULL) + field->misalignment * path[i] * field->lean;
  }
  double common = lowest_profile(SAMPLES, path, profile, 0);
  for (int i = 0; i < SAMPLES; i++) {
    double eta = g->face_width * ((double)i / (SAMPLES - 1) - 0.5), x = eta * field->stretch, body[2] = {0, 0};
    double lead = eo_modification_lead(&field->shape[0], x, &unused) + eo_modification_lead(&field->shape[1], x, &unused) + field->misalignment * eta;
    if (field->deflection)
      deflection_parts(field->deflection, g->face_width, eta, body);
    lowest = fmin(lowest, lead + body[0] + (field->deflection ? lowest_profile(SAMPLES, path, profile, body[1]) : common));
  }
  return lowest + field->misalignment_offset;
}
