/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/unloaded.h"

#include "numerics/nonlinear.h"

#include <math.h>
#include <stddef.h>

void eo_unloaded_minimum(const struct eo_gap_field *field, int n, const double *phase, struct eo_unloaded *result)
{
  const struct eo_geometry *geometry = field->geometry;
  double tangent = tan(geometry->base_helix_angle), near = 1e-6 * geometry->face_width;
  for (int i = 0; i < n; i++) {
    double eta = 0, gap = eo_gap_field_line_minimum(field, phase[i], false, &eta), range[2];
    result[i] = (struct eo_unloaded){.touch = EO_TOUCH_NONE};
    if (isinf(gap))
      continue;
    eo_gap_field_line_range(geometry, phase[i], geometry->path_start, geometry->path_end, range);
    bool edge = eta - range[0] < near || range[1] - eta < near;
    /* theory (S7) */
    result[i] = (struct eo_unloaded){.touch = edge ? EO_TOUCH_EDGE : EO_TOUCH_POINT,
                                     .transmission_error = -gap / cos(geometry->base_helix_angle),
                                     .path = phase[i] + eta * tangent,
                                     .eta = eta};
  }
}

struct contact {
  const struct eo_gap_field *field;
  const struct eo_shaft_errors *errors;
  double phase;
};

struct placed {
  double position[3], normal[3];
};

static void turn(double v[3], double angle)
{
  double x = v[0], y = v[1];
  v[0] = cos(angle) * x - sin(angle) * y;
  v[1] = sin(angle) * x + cos(angle) * y;
}

/* A member's flank point at its own phase, in its own frame turned into mesh: common normal at alpha_wt at phase 0. */
static struct placed in_mesh(const struct eo_gap_field *field, int member, double u, double v, double own_phase)
{
  const struct eo_geometry *geometry = field->geometry;
  struct eo_surface_point surface_point;
  eo_surface_evaluate(geometry, member, &field->shape[member], u, v, &surface_point);
  double offset = eo_geometry_involute_function(geometry->working_pressure_angle) -
                  eo_geometry_involute_function(geometry->transverse_pressure_angle);
  struct placed placed;
  for (int i = 0; i < 3; i++) {
    placed.position[i] = surface_point.position[i];
    placed.normal[i] = surface_point.normal[i];
  }
  turn(placed.position, -own_phase / geometry->base_radius[member] - offset);
  turn(placed.normal, -own_phase / geometry->base_radius[member] - offset);
  return placed;
}

/* Rotates about the pivot by (kappa, gamma) about (x, y), exactly (Rodrigues). */
static void tilt(double v[3], const struct eo_shaft_errors *errors)
{
  double kappa = errors->in_plane, gamma = errors->out_of_plane, angle = hypot(kappa, gamma);
  if (angle == 0)
    return;
  double k[2] = {kappa / angle, gamma / angle}, c = cos(angle), s = sin(angle),
         along = (k[0] * v[0] + k[1] * v[1]) * (1 - c);
  double cross[3] = {k[1] * v[2], -k[0] * v[2], k[0] * v[1] - k[1] * v[0]};
  for (int i = 0; i < 3; i++)
    v[i] = v[i] * c + cross[i] * s + (i < 2 ? k[i] * along : 0);
}

/* The gear's point: reflected through its centre into mesh with the pinion, tilted about the pivot, pinion axis at the
   origin. */
static struct placed gear_point(const struct contact *contact, double u, double v, double gear_phase)
{
  const struct eo_geometry *geometry = contact->field->geometry;
  struct placed placed = in_mesh(contact->field, EO_GEAR, u, v, -gear_phase);
  for (int i = 0; i < 3; i++) {
    placed.position[i] = -placed.position[i];
    placed.normal[i] = -placed.normal[i];
  }
  placed.position[2] -= contact->errors->pivot;
  tilt(placed.position, contact->errors);
  tilt(placed.normal, contact->errors);
  placed.position[2] += contact->errors->pivot;
  placed.position[1] += geometry->centre_distance;
  return placed;
}

/* x: u and v of the pinion, u and v of the gear, gear phase; all m. Positions coincide, normals are opposite. */
static int residual(void *context, const double *x, double *r)
{
  const struct contact *contact = context;
  const struct eo_geometry *geometry = contact->field->geometry;
  struct placed placed = in_mesh(contact->field, EO_PINION, x[0], x[1], contact->phase),
                this_placed = gear_point(contact, x[2], x[3], x[4]);
  for (int i = 0; i < 3; i++)
    r[i] = placed.position[i] - this_placed.position[i]; /* theory (S8) */
  /* Two directions across the common normal. */
  double ca = cos(geometry->working_pressure_angle), sa = sin(geometry->working_pressure_angle);
  r[3] = -sa * (placed.normal[0] + this_placed.normal[0]) + ca * (placed.normal[1] + this_placed.normal[1]);
  r[4] = placed.normal[2] + this_placed.normal[2];
  return 0;
}

static enum eo_code touch_exact(struct eo_nonlinear *solver, struct contact *contact, const struct eo_unloaded *seed,
                                struct eo_unloaded *result, struct eo_error *error)
{
  const struct eo_geometry *geometry = contact->field->geometry;
  const double scale[5] = {1e-3, 1e-3, 1e-3, 1e-3, 1e-3}, weight[5] = {1e-3, 1e-3, 1e-3, 1e-1, 1e-1};
  struct eo_nonlinear_problem problem = {.residual = residual, .context = contact};
  struct eo_nonlinear_options options = {.x_scale = scale,
                                         .residual_scale = weight,
                                         .residual_tolerance = 1e-11,
                                         .step_tolerance = 1e-13,
                                         .max_iterations = 100};
  struct eo_nonlinear_report report;
  double x[5];
  eo_surface_coordinates(geometry, EO_PINION, seed->path, seed->eta, &x[0], &x[1]);
  eo_surface_coordinates(geometry, EO_GEAR, seed->path, seed->eta, &x[2], &x[3]);
  x[4] = contact->phase + seed->transmission_error;
  enum eo_code code = eo_nonlinear_solve(solver, &problem, &options, x, &report, error);
  if (code)
    return code;
  struct placed placed = in_mesh(contact->field, EO_PINION, x[0], x[1], contact->phase);
  double reach = geometry->face_width / 2 * (1 + 1e-9), s = x[0] / geometry->rack_factor;
  bool inside = fabs(placed.position[2]) <= reach && s >= geometry->path_start - 1e-9 && s <= geometry->path_end + 1e-9;
  *result = (struct eo_unloaded){.touch = report.residual < 1e-8 && inside ? EO_TOUCH_POINT : EO_TOUCH_EDGE,
                                 .transmission_error = x[4] - contact->phase,
                                 .path = s,
                                 .eta = placed.position[2],
                                 .residual = report.residual};
  return EO_OK;
}

enum eo_code eo_unloaded_exact(const struct eo_gap_field *field, const struct eo_shaft_errors *errors, int n,
                               const double *phase, struct eo_unloaded *result, struct eo_error *error)
{
  struct eo_nonlinear *solver = NULL;
  enum eo_code code = eo_nonlinear_new(&solver, 5, error);
  for (int i = 0; i < n && !code; i++) {
    struct contact contact = {field, errors, phase[i]};
    struct eo_unloaded seed;
    eo_unloaded_minimum(field, 1, &phase[i], &seed);
    result[i] = seed;
    if (seed.touch != EO_TOUCH_NONE)
      code = touch_exact(solver, &contact, &seed, &result[i], error);
  }
  eo_nonlinear_free(solver);
  return code;
}
