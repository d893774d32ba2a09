/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/field.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "numerics/minimise.h"

/* The slices in mesh with the share of shaft angle errors, z from their pivot; *slope by s. */
static double even_slices_at(const struct eo_gap_field *field, double s, double z, double *slope)
{
  const struct eo_slice_gap *slice = &field->slice;
  double part;
  if (slice->nodes == 0) {
    *slope = field->misalignment * field->lean;
    return field->misalignment * (z + s * field->lean);
  }
  int i = eo_slice_gap_piece(slice, s, &part);
  double gap = eo_slice_gap_within(slice, i, part, slope);
  double from = field->shift[i] + z * field->lever[i], to = field->shift[i + 1] + z * field->lever[i + 1];
  if (part < 0 || part > 1)
    return gap + (part < 0 ? from : to);
  *slope += (to - from) / (slice->phase[i + 1] - slice->phase[i]);
  return gap + from + part * (to - from);
}

/* Where profiles vary over the face: the slice at z - pivot on its own. Without a touch, reliefs too steep for any, the
   gap is the sum of what is taken off. */
static double own_slice_at(const struct eo_gap_field *field, double s, double z, double *slope)
{
  const struct eo_geometry *geometry = field->geometry;
  struct eo_modification_shape slice[2];
  struct eo_slice_touch touch;
  for (int member = 0; member < 2; member++)
    eo_modification_slice(&field->shape[member], z - field->pivot, &slice[member]);
  if (!eo_slice_touch_at(geometry, slice, s, &touch)) {
    double rate[2][2], place = geometry->rack_factor * s;
    touch = (struct eo_slice_touch){.tilt = eo_slice_tilt_at(NULL, geometry, s)};
    touch.gap = eo_modification_profile(&slice[EO_PINION], place, rate[EO_PINION]) +
                eo_modification_profile(&slice[EO_GEAR], -place, rate[EO_GEAR]);
    touch.slope = geometry->rack_factor * (rate[EO_PINION][0] - rate[EO_GEAR][0]);
  }
  if (field->corner[0].rule != EO_TILT_ROTATED)
    touch.tilt = eo_slice_tilt_at(NULL, geometry, s);
  *slope = touch.slope + field->misalignment * field->lean;
  return touch.gap + field->errors[0] * (touch.tilt.shift[0] + z * touch.tilt.lever[0]) +
         field->errors[1] * (touch.tilt.shift[1] + z * touch.tilt.lever[1]);
}

static double slices_at(const struct eo_gap_field *field, double s, double z, double *slope)
{
  return field->varies ? own_slice_at(field, s, z, slope) : even_slices_at(field, s, z, slope);
}

/* Excess of the tip corner between two stations. */
static double corner_between(const struct eo_gap_field *field, int side, double d, double z, double *slope)
{
  double at = ((z - field->pivot) / field->geometry->face_width + 0.5) * (EO_CORNER_STATIONS - 1), rate[2];
  int i = (int)fmax(0, fmin(EO_CORNER_STATIONS - 2, floor(at)));
  const struct eo_corner_station *from = &field->station[i], *to = from + 1;
  double below = eo_corner_gap_at(&from->corner[side], &from->tilted[side], d, z, &rate[0]),
         above = eo_corner_gap_at(&to->corner[side], &to->tilted[side], d, z, &rate[1]), part = at - i;
  *slope = rate[0] + part * (rate[1] - rate[0]);
  return below + part * (above - below);
}

/* What the tip corner at the nearer end of the path has over the slices; *slope by s. It strikes from where shaft angle
   errors have moved its start, inside the path too. */
static double corner_at(const struct eo_gap_field *field, double s, double z, double *slope)
{
  const struct eo_geometry *geometry = field->geometry;
  int side = geometry->path_start - s > s - geometry->path_end ? 0 : 1;
  double d = side == 0 ? geometry->path_start - s : s - geometry->path_end;
  *slope = 0;
  if (d < field->takes_over[side])
    return 0;
  double excess = field->varies ? corner_between(field, side, d, z, slope)
                                : eo_corner_gap_at(&field->corner[side], &field->tilted[side], d, z, slope);
  *slope *= side == 0 ? -1 : 1;
  return excess;
}

/* Both flanks' profiles in the slice z from the pivot. */
static double profiles_at(const struct eo_gap_field *field, double s, double z, double *slope)
{
  double rate, gap = slices_at(field, s, z, slope) + corner_at(field, s, z, &rate);
  *slope += rate;
  return gap;
}

static void set_path(const struct eo_gap_field *field, double s, double path[2])
{
  const struct eo_geometry *geometry = field->geometry;
  path[EO_PINION] = path[EO_GEAR] = s;
  if (s < geometry->path_start) {
    path[EO_PINION] = eo_corner_gap_place(&field->corner[0], geometry->path_start, geometry->path_start - s);
    path[EO_GEAR] = geometry->path_start;
  } else if (s > geometry->path_end) {
    path[EO_PINION] = geometry->path_end;
    path[EO_GEAR] = eo_corner_gap_place(&field->corner[1], geometry->path_end, s - geometry->path_end);
  }
}

/* Values of both parts at eta. */
static void deflection_parts(const struct eo_deflection *deflection, double face_width, double eta, double part[2])
{
  double u = (eta / face_width + 0.5) * (EO_DEFLECTION_NODES - 1);
  int i = (int)fmax(0, fmin(EO_DEFLECTION_NODES - 2, floor(u)));
  for (int k = 0; k < 2; k++)
    part[k] = deflection->part[k][i] + (u - i) * (deflection->part[k][i + 1] - deflection->part[k][i]);
}

/* The corner under the errors, and the least d at which it can strike anywhere on the face. */
static double tilt_corner(const struct eo_gap_field *field, const struct eo_corner_gap *corner,
                          struct eo_tilted_corner *tilted)
{
  double most = fabs(field->pivot) + field->geometry->face_width / 2;
  eo_corner_gap_tilt(tilted, corner, field->errors);
  return corner->start - fabs(tilted->shift[0]) - most * fabs(tilted->lever[0]);
}

static void set_errors(struct eo_gap_field *field)
{
  const double *errors = field->errors;
  struct eo_tilt even = eo_slice_tilt_at(NULL, field->geometry, 0);
  field->misalignment = errors[0] * even.lever[0] + errors[1] * even.lever[1];
  for (int i = 0; i < field->slice.nodes; i++) {
    const struct eo_tilt *tilt = &field->slice.tilt[i];
    field->lever[i] = errors[0] * tilt->lever[0] + errors[1] * tilt->lever[1];
    field->shift[i] = errors[0] * tilt->shift[0] + errors[1] * tilt->shift[1];
  }
  for (int side = 0; side < 2; side++)
    field->takes_over[side] = tilt_corner(field, &field->corner[side], &field->tilted[side]);
}

/* The slice gap of both members' profiles and the corners that go with it. */
static void set_slices(const struct eo_geometry *geometry, const struct eo_modification_shape shape[2],
                       struct eo_slice_gap *slice, struct eo_corner_gap corner[2])
{
  enum eo_tilt_rule rule = corner[0].rule;
  eo_slice_gap_init(slice, geometry, shape);
  if (rule == EO_TILT_AT_RADIUS)
    eo_corner_gap_at_radius(corner, geometry, shape, slice);
  else if (slice->nodes > 0)
    eo_corner_gap_modified(corner, geometry, shape, slice);
  for (int i = 0; rule != EO_TILT_ROTATED && i < slice->nodes; i++)
    slice->tilt[i] = eo_slice_tilt_at(NULL, geometry, slice->phase[i]);
}

/* Corners at stations over the face, each with its own slice. */
static void set_stations(struct eo_gap_field *field, const struct eo_corner_gap even[2])
{
  const struct eo_geometry *geometry = field->geometry;
  for (int i = 0; i < EO_CORNER_STATIONS; i++) {
    struct eo_corner_station *station = &field->station[i];
    struct eo_modification_shape profile[2];
    struct eo_slice_gap slice;
    double eta = geometry->face_width * ((double)i / (EO_CORNER_STATIONS - 1) - 0.5);
    for (int member = 0; member < 2; member++)
      eo_modification_slice(&field->shape[member], eta, &profile[member]);
    memcpy(station->corner, even, sizeof station->corner);
    set_slices(geometry, profile, &slice, station->corner);
    for (int side = 0; side < 2; side++)
      field->takes_over[side] = fmin(field->takes_over[side],
                                     tilt_corner(field, &station->corner[side], &station->tilted[side]));
  }
}

void eo_gap_field_init_shapes(struct eo_gap_field *field, const struct eo_geometry *geometry,
                              const struct eo_modification_shape shape[2], int end, double in_plane,
                              double out_of_plane, double pivot, const struct eo_corner_gap corner[2])
{
  double sign = end == EO_LEFT ? -1 : 1;
  field->geometry = geometry;
  field->lean = tan(geometry->base_helix_angle);
  field->stretch = 1 / cos(geometry->helix_angle);
  memcpy(field->shape, shape, sizeof field->shape);
  for (int member = 0; member < 2; member++)
    eo_modification_move(&field->shape[member], geometry, member);
  memcpy(field->corner, corner, sizeof field->corner);
  field->pivot = pivot;
  field->offset = 0;
  field->deflection = NULL;
  field->errors[0] = sign * in_plane;
  field->errors[1] = sign * out_of_plane;
  field->varies = shape[EO_PINION].varies || shape[EO_GEAR].varies;
  set_slices(geometry, field->shape, &field->slice, field->corner);
  set_errors(field);
  if (field->varies)
    set_stations(field, corner);
}

void eo_gap_field_init(struct eo_gap_field *field, const struct eo_geometry *geometry,
                       const struct eo_flank_modification *pinion, const struct eo_flank_modification *gear, int end,
                       double in_plane, double out_of_plane, double pivot, const struct eo_corner_gap corner[2])
{
  struct eo_modification_shape shape[2];
  eo_modification_init(&shape[EO_PINION], geometry, EO_PINION, pinion);
  eo_modification_init(&shape[EO_GEAR], geometry, EO_GEAR, gear);
  eo_gap_field_init_shapes(field, geometry, shape, end, in_plane, out_of_plane, pivot, corner);
}

double eo_gap_field_at(const struct eo_gap_field *field, double s, double eta, double *slope, double path[2])
{
  const struct eo_geometry *geometry = field->geometry;
  double rate, unused, x = eta * field->stretch, gap = profiles_at(field, s, eta + field->pivot, &rate);
  if (field->deflection) {
    double body[2];
    deflection_parts(field->deflection, geometry->face_width, eta, body);
    gap += body[0] + s * body[1]; /* theory (K12) */
    rate += body[1];
  }
  if (path)
    set_path(field, s, path);
  /* theory (S6) */
  gap += eo_modification_lead(&field->shape[EO_PINION], x, &unused) +
         eo_modification_lead(&field->shape[EO_GEAR], x, &unused) + field->offset;
  if (slope)
    *slope = rate;
  return gap;
}

bool eo_gap_field_line_range(const struct eo_geometry *geometry, double c, double low, double high, double range[2])
{
  double half = geometry->face_width / 2, tangent = tan(geometry->base_helix_angle);
  range[0] = -half;
  range[1] = half;
  if (tangent < 1e-9)
    return c >= low && c <= high;
  range[0] = fmax(range[0], (low - c) / tangent);
  range[1] = fmin(range[1], (high - c) / tangent);
  return range[1] > range[0];
}

/* The gap along one contact line. */
struct along_line {
  const struct eo_gap_field *field;
  double phase;
};

static double gap_along(void *context, double eta)
{
  const struct along_line *line = context;
  return eo_gap_field_at(line->field, line->phase + eta * line->field->lean, eta, NULL, NULL);
}

double eo_gap_field_line_descend(const struct eo_gap_field *field, double c, const double range[2], double step,
                                 double gap, double *eta)
{
  static const double SETTLED = 2e-4; /* of a step: some picometres of gap */
  struct along_line line = {field, c};
  return eo_minimise_along(gap_along, &line, fmax(range[0], *eta - step), fmin(range[1], *eta + step), SETTLED * step,
                           gap, eta);
}

bool eo_gap_field_edge_range(const struct eo_gap_field *field, double c, bool edges, double range[2])
{
  const struct eo_geometry *geometry = field->geometry;
  double reach = edges ? field->corner[0].reach / 2 : 0;
  return eo_gap_field_line_range(geometry, c, geometry->path_start - reach, geometry->path_end + reach, range);
}

double eo_gap_field_line_minimum(const struct eo_gap_field *field, double c, bool edges, double *at)
{
  enum { SAMPLES = 32 };
  struct along_line line = {field, c};
  double range[2], best = INFINITY, best_eta = 0;
  if (!eo_gap_field_edge_range(field, c, edges, range))
    return INFINITY;
  double step = (range[1] - range[0]) / SAMPLES;
  for (int i = 0; i <= SAMPLES; i++) {
    double eta = range[0] + i * step, gap = gap_along(&line, eta);
    if (gap < best) {
      best = gap;
      best_eta = eta;
    }
  }
  best = eo_gap_field_line_descend(field, c, range, step, best, &best_eta);
  if (at)
    *at = best_eta;
  return best;
}

/* The profile at places over the path of contact: gap = level + z lever + what tip corners have over that + s part[1]
   of the bodies; lead modification and what else is constant in a slice apart. */
enum { DATUM_SAMPLES = 401 };
struct profile {
  int samples;
  double path[DATUM_SAMPLES], level[DATUM_SAMPLES], lever[DATUM_SAMPLES];
};

static void set_profile(struct profile *profile, const struct eo_gap_field *field)
{
  const struct eo_geometry *geometry = field->geometry;
  double unused;
  profile->samples = DATUM_SAMPLES;
  for (int i = 0; i < DATUM_SAMPLES; i++) {
    double s = geometry->path_start + (geometry->path_end - geometry->path_start) * i / (DATUM_SAMPLES - 1);
    profile->path[i] = s;
    profile->level[i] = slices_at(field, s, 0, &unused);
    profile->lever[i] = slices_at(field, s, 1, &unused) - profile->level[i];
  }
}

static double lowest_profile(const struct eo_gap_field *field, const struct profile *profile, double z, double tilt)
{
  double lowest = INFINITY, unused;
  for (int i = 0; i < profile->samples; i++) {
    double gap = profile->level[i] + z * profile->lever[i] + profile->path[i] * tilt;
    if (gap < lowest)
      lowest = fmin(lowest, gap + corner_at(field, profile->path[i], z, &unused));
  }
  return lowest;
}

/* Drops the places that are nowhere lower than the lowest one that no corner reaches: without corners gaps are straight
   over z, so both ends tell; a corner only adds to them. */
static void prune(const struct eo_gap_field *field, struct profile *profile)
{
  const struct eo_geometry *geometry = field->geometry;
  double low = field->pivot - geometry->face_width / 2, high = field->pivot + geometry->face_width / 2;
  int best = -1, kept = 0;
  for (int i = 0; i < profile->samples; i++) {
    double s = profile->path[i], value = profile->level[i] + field->pivot * profile->lever[i];
    bool free_of_corners = geometry->path_start - s < field->takes_over[0] &&
                           s - geometry->path_end < field->takes_over[1];
    if (free_of_corners && (best < 0 || value < profile->level[best] + field->pivot * profile->lever[best]))
      best = i;
  }
  if (best < 0)
    return;
  double level = profile->level[best], lever = profile->lever[best];
  for (int i = 0; i < profile->samples; i++) {
    double above = profile->level[i] - level, steeper = profile->lever[i] - lever;
    if (i == best || above + low * steeper < 0 || above + high * steeper < 0) {
      profile->path[kept] = profile->path[i];
      profile->level[kept] = profile->level[i];
      profile->lever[kept++] = profile->lever[i];
    }
  }
  profile->samples = kept;
}

/* The lowest of a grid of places and of a search about it with ever smaller steps. */
static double varying_datum(const struct eo_gap_field *field)
{
  enum { SAMPLES = 61, ROUNDS = 24 };
  const struct eo_geometry *geometry = field->geometry;
  const double low[2] = {geometry->path_start, -geometry->face_width / 2},
               high[2] = {geometry->path_end, geometry->face_width / 2};
  double best[2] = {0, 0}, lowest = INFINITY, step[2];
  for (int k = 0; k < 2; k++)
    step[k] = (high[k] - low[k]) / (SAMPLES - 1);
  for (int i = 0; i < SAMPLES * SAMPLES; i++) {
    int row = i / SAMPLES, column = i % SAMPLES;
    double s = low[0] + step[0] * row, eta = low[1] + step[1] * column,
           gap = eo_gap_field_at(field, s, eta, NULL, NULL);
    if (gap < lowest) {
      lowest = gap;
      best[0] = s;
      best[1] = eta;
    }
  }
  for (int round = 0; round < ROUNDS; round++) {
    double before = lowest, centre[2] = {best[0], best[1]};
    for (int i = 0; i < 9; i++) {
      int row = i / 3 - 1, column = i % 3 - 1;
      double s = fmin(high[0], fmax(low[0], centre[0] + step[0] * row)),
             eta = fmin(high[1], fmax(low[1], centre[1] + step[1] * column)),
             gap = eo_gap_field_at(field, s, eta, NULL, NULL);
      if (gap < lowest) {
        lowest = gap;
        best[0] = s;
        best[1] = eta;
      }
    }
    for (int k = 0; k < 2 && lowest == before; k++)
      step[k] /= 2;
  }
  return lowest;
}

double eo_gap_field_datum(const struct eo_gap_field *field)
{
  enum { SAMPLES = DATUM_SAMPLES };
  if (field->varies)
    return varying_datum(field);
  const struct eo_geometry *geometry = field->geometry;
  struct profile profile;
  double unused, lowest = INFINITY;
  set_profile(&profile, field);
  if (!field->deflection)
    prune(field, &profile);
  for (int i = 0; i < SAMPLES; i++) {
    double eta = geometry->face_width * ((double)i / (SAMPLES - 1) - 0.5), x = eta * field->stretch, body[2] = {0, 0};
    double lead = eo_modification_lead(&field->shape[0], x, &unused) +
                  eo_modification_lead(&field->shape[1], x, &unused);
    if (field->deflection)
      deflection_parts(field->deflection, geometry->face_width, eta, body);
    lowest = fmin(lowest, lead + body[0] + lowest_profile(field, &profile, eta + field->pivot, body[1]));
  }
  return lowest + field->offset;
}
