#include "contact/field.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* Beyond the path of contact: the slices as long as they meet inside the tip, then the tip's corner. *place: s on the
   flank, joined without a step; *slope: by s, with tilt, that of misalignment and bodies, at the place. */
static double beyond_path(const struct eo_gap_field *field, int tip, double s, double tilt, double *slope,
                          double *place)
{
  const struct eo_corner_gap *corner = &field->corner[tip == EO_GEAR ? 0 : 1];
  double end = tip == EO_GEAR ? field->geometry->path_start : field->geometry->path_end, d = fabs(s - end), rate,
         travel, gap;
  int sign = tip == EO_GEAR ? -1 : 1;
  if (d < corner->start) {
    gap = eo_slice_gap_at(&field->slice, s, &rate);
    rate *= sign;
    travel = (corner->path[0] - end) / corner->start;
    *place = end + d * travel;
  } else {
    gap = eo_corner_gap_at(corner, d, &rate, place, &travel);
  }
  *slope = (rate + tilt * travel) * sign;
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

void eo_gap_field_init(struct eo_gap_field *field, const struct eo_geometry *g,
                       const struct eo_flank_modification *pinion, const struct eo_flank_modification *gear, int end,
                       double in_plane, double out_of_plane, double pivot, const struct eo_corner_gap corner[2])
{
  double sign = end == EO_LEFT ? -1 : 1;
  field->geometry = g;
  field->lean = tan(g->base_helix_angle);
  field->stretch = 1 / cos(g->helix_angle);
  eo_modification_init(&field->shape[EO_PINION], g, EO_PINION, pinion);
  eo_modification_init(&field->shape[EO_GEAR], g, EO_GEAR, gear);
  eo_slice_gap_init(&field->slice, g, field->shape);
  memcpy(field->corner, corner, sizeof field->corner);
  if (field->slice.nodes > 0 && corner[0].at_radius)
    eo_corner_gap_at_radius(field->corner, g, field->shape);
  else if (field->slice.nodes > 0)
    eo_corner_gap_modified(field->corner, g, field->shape, &field->slice);
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
    gap = beyond_path(field, tip, s, tilt, &rate, &place);
  } else {
    gap = eo_slice_gap_at(&field->slice, s, &rate);
    rate += tilt;
  }
  if (path) {
    path[EO_PINION] = tip == EO_PINION ? g->path_end : place;
    path[EO_GEAR] = tip == EO_GEAR ? g->path_start : place;
  }
  gap += eo_modification_lead(&field->shape[EO_PINION], x, &unused) +
         eo_modification_lead(&field->shape[EO_GEAR], x, &unused);
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
  double fa = eo_gap_field_at(field, c + a * tangent, a, NULL, NULL),
         fb = eo_gap_field_at(field, c + b * tangent, b, NULL, NULL);
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

/* The smallest gap over the path of contact in the transverse slice at eta, lead modification and what else is constant
   there apart. */
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
    double lead = eo_modification_lead(&field->shape[0], x, &unused) +
                  eo_modification_lead(&field->shape[1], x, &unused) + field->misalignment * eta;
    if (field->deflection)
      deflection_parts(field->deflection, g->face_width, eta, body);
    lowest = fmin(lowest,
                  lead + body[0] + (field->deflection ? lowest_profile(SAMPLES, path, profile, body[1]) : common));
  }
  return lowest + field->misalignment_offset;
}
