/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/integration.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "dynamics/settling.h"
#include "numerics/fourier.h"
#include "numerics/ode.h"

enum { MAX_LAW_ROWS = 1024 };
const struct eo_integration_options eo_integration_defaults = {
    .relative_tolerance = 1e-8, .settled = 1e-7, .max_periods = 1000, .samples = 1024, .max_repeat = 1};

/* The state handed to CVODE is the departure from the start, its velocity per phase: tolerances then see the swing. */
struct run {
  const struct eo_oscillator *oscillator;
  const struct eo_cycle *cycle;
  double period;
  const double *origin; /* [2 n], displacements, of which the motion is told apart, and speeds at the start */
};

/* Prescribed motion and its rate at one phase; the mean is left out. */
static void prescribed(const struct eo_cycle *cycle, int end, double phase, double *value, double *rate)
{
  *value = *rate = 0;
  for (int k = 1; cycle->motion[end] && k <= cycle->motion_order; k++) {
    double c = cycle->motion[end][2 * k - 1], s = cycle->motion[end][2 * k], angle = 2 * M_PI * k * phase;
    *value += c * cos(angle) + s * sin(angle);
    *rate += cycle->frequency * k * (s * cos(angle) - c * sin(angle));
  }
}

/* *slope and *damping: of the mesh force with deflection and rate. */
static struct eo_mesh_state mesh_at(const struct eo_oscillator *oscillator, const struct eo_cycle *cycle, int end,
                                    double phase, const double *position, const double *velocity, double *slope,
                                    double *damping)
{
  double row[MAX_LAW_ROWS];
  struct eo_mesh_state mesh_state;
  prescribed(cycle, end, phase, &mesh_state.deflection, &mesh_state.rate);
  for (int i = 0; i < oscillator->n; i++) {
    mesh_state.deflection += oscillator->mesh[end][i] * position[i];
    mesh_state.rate += oscillator->mesh[end][i] * velocity[i];
  }
  eo_law_rows(cycle->law[end], phase + cycle->shift[end], row);
  struct eo_mesh_force force = eo_law_force(cycle->law[end], row, mesh_state.deflection, 0);
  *slope = force.slope;
  *damping = cycle->gated && force.margin <= 0 ? 0 : cycle->mesh_damping;
  mesh_state.elastic = force.force;
  mesh_state.force = force.force + *damping * mesh_state.rate;
  mesh_state.margin = force.margin;
  mesh_state.margin_slope = force.margin_slope;
  return mesh_state;
}

void eo_oscillator_acceleration(const struct eo_oscillator *oscillator, const struct eo_cycle *cycle, double phase,
                                const double *position, const double *velocity, double *acceleration,
                                struct eo_mesh_state *mesh)
{
  int n = oscillator->n;
  for (int i = 0; i < n; i++) {
    acceleration[i] = oscillator->load[i];
    for (int j = 0; j < n; j++)
      acceleration[i] -= oscillator->stiffness[i * n + j] * position[j] + oscillator->damping[i * n + j] * velocity[j];
  }
  for (int end = 0; end < oscillator->ends; end++) {
    double slope, damping;
    struct eo_mesh_state mesh_state = mesh_at(oscillator, cycle, end, phase, position, velocity, &slope, &damping);
    double impact = eo_pulse_value(&cycle->pulse[end], cycle->frequency, phase + cycle->shift[end]);
    for (int i = 0; i < n; i++)
      acceleration[i] -= oscillator->mesh[end][i] * mesh_state.force + oscillator->pulse[end][i] * impact;
    if (mesh)
      mesh[end] = mesh_state;
  }
}

static void unpack(const struct run *run, const double *y, double *position, double *velocity)
{
  int n = run->oscillator->n;
  for (int i = 0; i < n; i++) {
    position[i] = run->origin[i] + y[i];
    velocity[i] = y[n + i] / run->period;
  }
}

static int slope_of(void *context, double t, const double *y, double *slope)
{
  const struct run *run = context;
  int n = run->oscillator->n;
  double position[EO_MAX_COORDINATES], velocity[EO_MAX_COORDINATES], acceleration[EO_MAX_COORDINATES];
  unpack(run, y, position, velocity);
  eo_oscillator_acceleration(run->oscillator, run->cycle, t, position, velocity, acceleration, NULL);
  for (int i = 0; i < n; i++) {
    slope[i] = y[n + i];
    slope[n + i] = acceleration[i] * run->period * run->period;
  }
  return 0;
}

static int jacobian_of(void *context, double t, const double *y, double *jacobian)
{
  const struct run *run = context;
  const struct eo_oscillator *oscillator = run->oscillator;
  int n = oscillator->n, size = 2 * n;
  double position[EO_MAX_COORDINATES], velocity[EO_MAX_COORDINATES], slope[2], damping[2];
  unpack(run, y, position, velocity);
  for (int end = 0; end < oscillator->ends; end++)
    mesh_at(oscillator, run->cycle, end, t, position, velocity, &slope[end], &damping[end]);
  for (int i = 0; i < n; i++) {
    jacobian[i * size + n + i] = 1;
    for (int j = 0; j < n; j++) {
      double k = oscillator->stiffness[i * n + j], c = oscillator->damping[i * n + j];
      for (int end = 0; end < oscillator->ends; end++) {
        k += slope[end] * oscillator->mesh[end][i] * oscillator->mesh[end][j];
        c += damping[end] * oscillator->mesh[end][i] * oscillator->mesh[end][j];
      }
      jacobian[(n + i) * size + j] = -k * run->period * run->period;
      jacobian[(n + i) * size + n + j] = -c * run->period;
    }
  }
  return 0;
}

/* A size for the swing: what the oscillator's static position and its loads let expect. */
static void set_tolerances(const struct run *run, double relative, double *tolerance)
{
  int n = run->oscillator->n;
  double largest = 0;
  for (int i = 0; i < n; i++)
    largest = fmax(largest, fabs(run->origin[i]));
  double floor = relative * 1e-3 * (largest > 0 ? largest : 1);
  for (int i = 0; i < n; i++) {
    tolerance[i] = floor;
    tolerance[n + i] = 2 * M_PI * floor;
  }
}

static double longest_step(const struct eo_cycle *cycle, int ends)
{
  static const double LONGEST = 0.05, OF_PULSE = 0.125; /* of the period; of a pulse: none may be stepped over */
  double step = LONGEST;
  for (int end = 0; end < ends; end++)
    if (cycle->pulse[end].shape == EO_PULSE_HALF_SINE)
      step = fmin(step, cycle->pulse[end].duration * OF_PULSE);
  return step;
}

static void record(const struct run *run, int sample, double phase, const double *y, struct eo_integration *integration)
{
  double position[EO_MAX_COORDINATES], velocity[EO_MAX_COORDINATES];
  unpack(run, y, position, velocity);
  eo_oscillator_acceleration(run->oscillator, run->cycle, phase, position, velocity,
                             integration->acceleration + (size_t)sample * run->oscillator->n,
                             integration->mesh + 2 * sample);
}

/* One period from integer phase `period`; y is the state, *swing the largest departure met. With `r` it is recorded
   from sample `first` on. */
static enum eo_code one_period(struct eo_ode *ode, const struct run *run, int period, int samples, double *y,
                               double *swing, struct eo_integration *integration, int first, struct eo_error *error)
{
  int n = run->oscillator->n;
  for (int i = 0; i < samples; i++) {
    if (integration)
      record(run, first + i, (double)i / samples, y, integration);
    enum eo_code code = eo_ode_advance(ode, period + (i + 1.0) / samples, y, error);
    if (code)
      return code;
    for (int j = 0; j < n; j++)
      *swing = fmax(*swing, fabs(y[j]));
  }
  return EO_OK;
}

static enum eo_code run_periods(struct eo_ode *ode, const struct run *run, const struct eo_integration_options *options,
                                double *y, struct eo_integration *result, const struct eo_progress *progress,
                                struct eo_error *error)
{
  struct eo_settling settling;
  int period = 0, repeat = 0;
  eo_settling_init(&settling, run->oscillator->n, options->settled, options->max_repeat);
  result->change = 0;
  while (period < options->max_periods - 1 && !repeat) {
    enum eo_code code = one_period(ode, run, period, 8, y, eo_settling_begin(&settling, y), NULL, 0, error);
    if (code)
      return code;
    period++;
    repeat = eo_settling_end(&settling, y);
    result->change = eo_settling_change(&settling);
    if (eo_progress_report(progress, "time integration", (double)period / options->max_periods))
      return eo_error_set(error, EO_ERROR_CANCELLED, "", "The time integration was cancelled.");
  }
  result->periodic = repeat > 0;
  result->repeat = repeat > 0 ? repeat : 1;
  enum eo_code code = EO_OK;
  for (int i = 0; i < result->repeat && !code; i++) {
    double swing = 0;
    code = one_period(ode, run, period++, options->samples, y, &swing, result, i * options->samples, error);
  }
  result->periods = period;
  unpack(run, y, result->state, result->state + settling.n);
  return code;
}

static enum eo_code integrate(struct eo_ode *ode, struct run *run, const struct eo_integration_options *options,
                              struct eo_integration *result, const struct eo_progress *progress, struct eo_error *error)
{
  const struct eo_oscillator *oscillator = run->oscillator;
  int n = oscillator->n;
  double y[2 * EO_MAX_COORDINATES], tolerance[2 * EO_MAX_COORDINATES];
  for (int i = 0; i < n; i++) {
    y[i] = 0;
    y[n + i] = run->origin[n + i] * run->period;
  }
  set_tolerances(run, options->relative_tolerance, tolerance);
  const struct eo_ode_problem problem = {.function = slope_of,
                                         .jacobian = jacobian_of,
                                         .context = run,
                                         .relative_tolerance = options->relative_tolerance,
                                         .absolute_tolerance = tolerance,
                                         .max_step = longest_step(run->cycle, oscillator->ends)};
  EO_TRY(eo_ode_start(ode, &problem, 0, y, error));
  EO_TRY(run_periods(ode, run, options, y, result, progress, error));
  result->steps = eo_ode_steps(ode);
  return EO_OK;
}

enum eo_code eo_integrate(const struct eo_oscillator *oscillator, const struct eo_cycle *cycle,
                          const struct eo_integration_options *options, const double *start,
                          struct eo_integration *result, const struct eo_progress *progress, struct eo_error *error)
{
  struct run run = {oscillator, cycle, 2 * M_PI / cycle->frequency, start};
  struct eo_ode *ode = NULL;
  EO_TRY(eo_ode_new(&ode, 2 * oscillator->n, error));
  enum eo_code code = integrate(ode, &run, options, result, progress, error);
  eo_ode_free(ode);
  return code;
}
