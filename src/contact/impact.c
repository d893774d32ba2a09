/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/impact.h"

#include "numerics/periodic.h"

#include <math.h>
#include <stddef.h>

void eo_impact_inertia(const struct eo_geometry *geometry, const struct eo_material *material, double inertia[2])
{
  for (int i = 0; i < 2; i++)
    inertia[i] = M_PI / 2 * eo_material_of(material, i).density * geometry->member_width[i] *
                 pow(geometry->working_radius[i], 4);
}

double eo_impact_mass(const struct eo_geometry *geometry, const double inertia[2])
{
  double p = geometry->base_radius[EO_PINION], q = geometry->base_radius[EO_GEAR], c = cos(geometry->base_helix_angle);
  return inertia[0] * inertia[1] / (inertia[0] * q * q + inertia[1] * p * p) / (c * c); /* theory (I3) */
}

/* The search for the first touch: the incoming line's smallest gap against the loaded approach. */
struct search {
  int sense; /* 1: the pinion drives, phases grow; -1: backwards */
  const struct eo_contact_grid *grid;
  const struct eo_gap_field *field;
  const struct eo_periodic *approach;
  int stations;
  struct eo_incoming_gaps *incoming;
};

/* The smallest gap of the incoming line at fixed stations over the face. */
static double sampled_minimum(const struct search *search, double c, double *eta)
{
  const struct eo_geometry *geometry = &search->grid->geometry;
  double best = INFINITY, reach = search->field->corner[0].reach / 2;
  for (int i = 0; i < search->stations; i++) {
    double at = geometry->face_width * ((double)i / (search->stations - 1) - 0.5),
           s = c + at * tan(geometry->base_helix_angle);
    double before = search->sense > 0 ? reach : 0, behind = search->sense > 0 ? 0 : reach;
    double gap = s < geometry->path_start - before || s > geometry->path_end + behind
                     ? INFINITY
                     : eo_gap_field_at(search->field, s, at, NULL, NULL);
    if (gap < best) {
      best = gap;
      *eta = at;
    }
  }
  return best;
}

static double smallest_gap(const struct search *search, double c, double *eta)
{
  return search->stations > 1 ? sampled_minimum(search, c, eta)
                              : eo_gap_field_line_minimum(search->field, c, true, eta);
}

static double loaded_approach(const struct search *search, double c)
{
  double phase = c / search->grid->geometry.transverse_base_pitch;
  return eo_periodic_at(search->approach, phase - floor(phase), NULL);
}

/* Gap left between the incoming line at phase c and the loaded approach, m; negative once it touches. */
static double clearance(const struct search *search, double c, double *eta)
{
  return smallest_gap(search, c, eta) - loaded_approach(search, c); /* theory (I1) */
}

/* The same at a step of the march. */
static double clearance_at_step(const struct search *search, int step, double c)
{
  enum { MOST = sizeof((struct eo_incoming_gaps *)0)->gap / sizeof(double) };
  struct eo_incoming_gaps *incoming = search->incoming;
  double eta;
  if (!incoming || step >= MOST)
    return clearance(search, c, &eta);
  if (step == incoming->known)
    incoming->gap[incoming->known++] = smallest_gap(search, c, &eta);
  return incoming->gap[step] - loaded_approach(search, c);
}

/* Where the clearance, open at `low` and not at `high` along the way, comes to zero: secants that give way to halves
   where they do not get on (the Illinois rule), to within a tenth of a nanometre. Returns the closed side. */
static double close_in(const struct search *search, double low, double open, double high, double closed)
{
  enum { STEPS = 200 };
  static const double APART = 1e-10;
  double eta;
  for (int i = 0, side = 0; i < STEPS && high - low > APART; i++) {
    double place = isfinite(open) && i % 8 != 7 ? low + (high - low) * open / (open - closed) : (low + high) / 2;
    place = fmin(fmax(place, low + APART / 2), high - APART / 2);
    double here = clearance(search, search->sense * place, &eta);
    if (here > 0) {
      low = place;
      open = here;
      closed = side > 0 ? closed / 2 : closed;
      side = 1;
    } else {
      high = place;
      closed = here;
      open = side < 0 ? open / 2 : open;
      side = -1;
    }
  }
  return high;
}

/* Marches the incoming line towards mesh until it touches, then closes in; false when it passes the whole path
   untouched. */
static bool first_touch(const struct search *search, double *c, double *eta)
{
  enum { STEPS_PER_PITCH = 48 };
  const struct eo_geometry *geometry = &search->grid->geometry;
  double lean = geometry->face_width / 2 * tan(geometry->base_helix_angle), reach = search->field->corner[0].reach / 2;
  double from = search->sense > 0 ? geometry->path_start : -geometry->path_end,
         to = search->sense > 0 ? geometry->path_end : -geometry->path_start;
  double low = from - lean - reach, end = to + lean, step = geometry->transverse_base_pitch / STEPS_PER_PITCH,
         high = low, open = INFINITY, closed = INFINITY; /* along the way it runs */
  for (int i = 0; closed > 0; i++) {
    low = high;
    open = closed;
    high = low + step;
    if (high >= end)
      return false;
    closed = clearance_at_step(search, i, search->sense * high);
  }
  *c = search->sense * close_in(search, low, open, high, closed);
  clearance(search, *c, eta);
  return true;
}

/* Bulk compliance of the patch: the mean deflection of its points under an even load (10 points at the place of the
   touch). */
static double patch_bulk(const struct eo_geometry *geometry, struct eo_kernel kernel, double patch, double s,
                         double eta)
{
  enum { POINTS = 10 };
  struct eo_flank_point point[POINTS];
  double matrix[POINTS * POINTS], sum = 0, half = geometry->face_width / 2, length = fmin(patch, geometry->face_width);
  double low = fmax(-half, fmin(half - length, eta - length / 2));
  for (int i = 0; i < POINTS; i++)
    point[i] = (struct eo_flank_point){
        .pair = 0,
        .s = {eo_geometry_drawn_path(geometry, EO_PINION, s), eo_geometry_drawn_path(geometry, EO_GEAR, s)},
        .eta = low + length * (i + 0.5) / POINTS};
  kernel.evaluate(kernel.context, POINTS, point, matrix);
  for (int i = 0; i < POINTS * POINTS; i++)
    sum += matrix[i];
  return sum / (POINTS * POINTS);
}

/* How far the place of a touch may be off along the path, m: what the search for the smallest gap leaves open. */
static const double place_error = 5e-7;

/* Slope of the gap over the roll where the line touches. Where the gap has a kink (a relief that starts with an angle),
   the touch can stay on it for a whole range of designs: there the line closes at the rate of its smallest gap,
   -dg/deta / tan(beta_b) along the kink, between the slopes of both sides. Away from kinks the three are the same;
   where the tip corner takes over there is none. */
static double closing_slope(const struct search *search, double s, double eta)
{
  const struct eo_gap_field *field = search->field;
  static const double LEVEL = 1e-9; /* of the lean: spur teeth touch all along the face at once */
  const double half = search->grid->geometry.face_width / 2, step = 1e-5; /* m, of the slope along the kink */
  double slope, before, after;
  eo_gap_field_at(field, s, eta, &slope, NULL);
  if (search->stations > 1 || field->lean < LEVEL || fabs(eta) > half - step)
    return slope;
  eo_gap_field_at(field, s - place_error, eta, &before, NULL);
  eo_gap_field_at(field, s + place_error, eta, &after, NULL);
  double along =
      (eo_gap_field_at(field, s, eta + step, NULL, NULL) - eo_gap_field_at(field, s, eta - step, NULL, NULL)) /
      (2 * step);
  return fmin(fmax(-along / field->lean, fmin(before, after)), fmax(before, after));
}

void eo_impact_strike(struct eo_impact *impact, const struct eo_contact_grid *grid,
                      const struct eo_impact_settings *settings, double speed, double compliance_factor)
{
  const struct eo_geometry *geometry = &grid->geometry;
  double s = settings->backwards ? fmin(impact->path, geometry->path_end) : fmax(impact->path, geometry->path_start),
         length = fmin(settings->patch, geometry->face_width) / cos(geometry->base_helix_angle);
  double law = eo_contact_local_constant(geometry, &grid->material, s),
         mass = eo_impact_mass(geometry, settings->inertia);
  enum { ROUNDS = 200 };
  static const double SETTLED = 1e-12; /* of the force */
  if (!impact->touched)
    return;
  impact->speed = fmax(0, -impact->slope) * speed * geometry->base_radius[EO_PINION]; /* theory (I2) */
  /* The Hertz part depends on the force it helps to make: fixed point on the secant of the local law. */
  double force = impact->speed * sqrt(mass / (compliance_factor * 2 * impact->bulk));
  for (int i = 0; i < ROUNDS; i++) {
    impact->compliance = compliance_factor *
                         (impact->bulk + grid->compliance_scale / length * (law - log(force / length)));
    double next = impact->speed * sqrt(mass / impact->compliance);
    bool settled = fabs(next - force) <= SETTLED * next;
    force = next;
    if (settled || force == 0)
      break;
  }
  impact->force = force;
  impact->classical = impact->off_line ? force : 0;
  impact->duration = M_PI * sqrt(mass * impact->compliance); /* theory (I4) */
}

void eo_impact_find(struct eo_impact *impact, const struct eo_contact_grid *grid, const struct eo_gap_field *field,
                    struct eo_kernel kernel, const struct eo_impact_settings *settings, const double *approach,
                    double speed, double compliance_factor)
{
  const struct eo_geometry *geometry = &grid->geometry;
  struct eo_periodic spline;
  double place[2];
  *impact = (struct eo_impact){0};
  eo_periodic_init(&spline, grid->positions, approach);
  struct search search = {settings->backwards ? -1 : 1, grid, field, &spline, settings->stations, settings->incoming};
  if (settings->incoming && settings->incoming->backwards != settings->backwards)
    *settings->incoming = (struct eo_incoming_gaps){.backwards = settings->backwards};
  impact->touched = first_touch(&search, &impact->phase, &impact->eta);
  if (!impact->touched)
    return;
  impact->path = impact->phase + impact->eta * tan(geometry->base_helix_angle);
  impact->off_line = settings->backwards ? impact->path > geometry->path_end + place_error
                                         : impact->path < geometry->path_start - place_error;
  impact->slope = search.sense * closing_slope(&search, impact->path, impact->eta);
  eo_gap_field_at(field, impact->path, impact->eta, NULL, place);
  impact->pinion_radius = eo_geometry_radius_at(geometry, EO_PINION, place[EO_PINION]);
  double phase = search.sense * impact->phase / geometry->transverse_base_pitch;
  impact->start = phase - floor(phase);
  double place_of_patch = settings->backwards ? fmin(impact->path, geometry->path_end)
                                              : fmax(impact->path, geometry->path_start);
  impact->bulk = patch_bulk(geometry, kernel, settings->patch, place_of_patch, impact->eta);
  eo_impact_strike(impact, grid, settings, speed, compliance_factor);
}
