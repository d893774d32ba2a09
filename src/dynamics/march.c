/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/march.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "dynamics/propagator.h"
#include "dynamics/settling.h"
#include "numerics/dense.h"

enum { N = EO_MAX_COORDINATES, LEAST_STEPS = 256, MOST_STEPS = 1 << 15, STEPS_PER_PULSE = 16, LOOKS = 8 };
/* What acts at the end of a step beside the state. */
struct instant {
  double motion[2], rate[2]; /* prescribed, m and m/s */
  double pulse[2];           /* N */
};

struct marching {
  const struct eo_oscillator *oscillator;
  const struct eo_cycle *cycle;
  int steps, rows[2];
  double step, scale; /* s; velocities are kept over it, 1/s */
  double propagator[4 * N * N];
  double still[N];         /* where the constant loads leave it at rest with constant meshes */
  struct instant *instant; /* [steps] */
  double *row[2];          /* [steps][rows]: of the mesh law */
  double state[2 * N];     /* r - still, r' / scale */
};

/* Prescribed motion and its rate at one phase; the mean is left out. */
static void prescribe(const struct eo_cycle *cycle, int end, double phase, double *value, double *rate)
{
  *value = *rate = 0;
  for (int k = 1; cycle->motion[end] && k <= cycle->motion_order; k++) {
    double c = cycle->motion[end][2 * k - 1], s = cycle->motion[end][2 * k], angle = 2 * M_PI * k * phase;
    *value += c * cos(angle) + s * sin(angle);
    *rate += cycle->frequency * k * (s * cos(angle) - c * sin(angle));
  }
}

static int choose_steps(const struct eo_oscillator *oscillator, const struct eo_cycle *cycle, double angle)
{
  const double mean[2] = {oscillator->shift, oscillator->shift};
  double steps = 2 * M_PI / cycle->frequency * eo_propagator_mesh_rate(oscillator, mean) / angle;
  for (int end = 0; end < oscillator->ends; end++)
    if (cycle->pulse[end].shape == EO_PULSE_HALF_SINE)
      steps = fmax(steps, STEPS_PER_PULSE / cycle->pulse[end].duration);
  return steps > MOST_STEPS ? -1 : (int)fmax(ceil(steps), LEAST_STEPS);
}

static void fill_instants(struct marching *marching)
{
  const struct eo_cycle *cycle = marching->cycle;
  for (int i = 0; i < marching->steps; i++)
    for (int end = 0; end < marching->oscillator->ends; end++) {
      double phase = (double)i / marching->steps;
      struct instant *at = &marching->instant[i];
      prescribe(cycle, end, phase, &at->motion[end], &at->rate[end]);
      at->pulse[end] = eo_pulse_value(&cycle->pulse[end], cycle->frequency, phase + cycle->shift[end]);
      eo_law_rows(cycle->law[end], phase + cycle->shift[end],
                  marching->row[end] + (size_t)i * (size_t)marching->rows[end]);
    }
}

/* (K + sum k mesh mesh') still = load. */
static int find_still(struct marching *marching)
{
  const struct eo_oscillator *oscillator = marching->oscillator;
  double k[N * N];
  int n = oscillator->n, pivot[N];
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      k[i * n + j] = oscillator->stiffness[i * n + j];
      for (int end = 0; end < oscillator->ends; end++)
        k[i * n + j] += oscillator->shift * oscillator->mesh[end][i] * oscillator->mesh[end][j];
    }
  memcpy(marching->still, oscillator->load, sizeof *marching->still * (size_t)n);
  return eo_dense_solve(n, k, pivot, 1, marching->still);
}

static void marching_done(struct marching *marching)
{
  free(marching->instant);
  free(marching->row[0]);
  free(marching->row[1]);
}

static enum eo_code marching_init(struct marching *marching, const struct eo_oscillator *oscillator,
                                  const struct eo_cycle *cycle, double angle, struct eo_error *error)
{
  const double mean[2] = {oscillator->shift, oscillator->shift};
  *marching =
      (struct marching){.oscillator = oscillator, .cycle = cycle, .steps = choose_steps(oscillator, cycle, angle)};
  if (marching->steps < 0)
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "Time integration at %g rad/s would need too many steps.",
                        cycle->frequency);
  marching->step = 2 * M_PI / cycle->frequency / marching->steps;
  marching->scale = eo_propagator_mesh_rate(oscillator, mean);
  marching->instant = calloc((size_t)marching->steps, sizeof *marching->instant);
  bool complete = marching->instant != NULL;
  for (int end = 0; end < oscillator->ends; end++) {
    marching->rows[end] = cycle->law[end]->rows;
    marching->row[end] = malloc(sizeof(double) * (size_t)marching->steps * (size_t)marching->rows[end]);
    complete = complete && marching->row[end];
  }
  if (!complete)
    return eo_error_memory(error);
  if (find_still(marching))
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "The oscillator has no place at rest.");
  eo_propagator_fill(oscillator, cycle->mesh_damping, mean, marching->scale, marching->step, marching->propagator);
  fill_instants(marching);
  return EO_OK;
}

/* Share of the step about an instant that contact lasts, the margin taken as straight: switching within a step would
   otherwise be out by the step, and all that is found with it. */
static double contact_share(const struct marching *marching, double margin, double rate)
{
  double moved = fabs(rate) * marching->step;
  return moved > 0 ? fmin(fmax(0.5 + margin / moved, 0), 1) : margin > 0;
}

/* Velocities changed at once by what acts over a time beside constant meshes: mesh forces less k X and c_m X', and
   pulses. The mesh damping that the propagator has is taken back where contact is lost and it is gated. */
static void kick(struct marching *marching, int i, double time)
{
  const struct eo_oscillator *oscillator = marching->oscillator;
  const struct eo_cycle *cycle = marching->cycle;
  const struct instant *at = &marching->instant[i];
  double *position = marching->state, *velocity = marching->state + oscillator->n, impulse[2] = {0};
  for (int end = 0; end < oscillator->ends; end++) {
    double x = 0, v = 0;
    for (int j = 0; j < oscillator->n; j++) {
      x += oscillator->mesh[end][j] * (position[j] + marching->still[j]);
      v += oscillator->mesh[end][j] * velocity[j];
    }
    v *= marching->scale;
    struct eo_mesh_force force = eo_law_force(
        cycle->law[end], marching->row[end] + (size_t)i * (size_t)marching->rows[end], x + at->motion[end], 0);
    double damping = cycle->mesh_damping *
                     (cycle->gated ? contact_share(marching, force.margin, v + at->rate[end]) : 1);
    impulse[end] = force.force + damping * (v + at->rate[end]) - oscillator->shift * x - cycle->mesh_damping * v;
  }
  for (int end = 0; end < oscillator->ends; end++)
    for (int j = 0; j < oscillator->n; j++)
      velocity[j] -= time / marching->scale *
                     (oscillator->mesh[end][j] * impulse[end] + oscillator->pulse[end][j] * at->pulse[end]);
}

static void drift(struct marching *marching)
{
  int size = 2 * marching->oscillator->n;
  double next[2 * N] = {0};
  for (int i = 0; i < size; i++) {
    const double *row = marching->propagator + (size_t)i * (size_t)size;
    double sum = 0;
    for (int j = 0; j < size; j++)
      sum += row[j] * marching->state[j];
    next[i] = sum;
  }
  memcpy(marching->state, next, sizeof *next * (size_t)size);
}

/* r, r' as departure from an origin and change per period. */
static void read_state(const struct marching *marching, const double *origin, double *y)
{
  int n = marching->oscillator->n;
  for (int i = 0; i < n; i++) {
    y[i] = marching->state[i] + marching->still[i] - origin[i];
    y[n + i] = marching->state[n + i] * marching->scale * marching->step * marching->steps;
  }
}

/* One period, half a kick at either end. */
static void march_period(struct marching *marching, const double *origin, double *y, double *swing)
{
  int n = marching->oscillator->n;
  kick(marching, 0, marching->step / 2);
  for (int i = 1; i <= marching->steps; i++) {
    drift(marching);
    kick(marching, i % marching->steps, i < marching->steps ? marching->step : marching->step / 2);
    if (i * LOOKS / marching->steps == (i - 1) * LOOKS / marching->steps)
      continue;
    read_state(marching, origin, y);
    for (int j = 0; j < n; j++)
      *swing = fmax(*swing, fabs(y[j]));
  }
}

static void march_on(struct marching *marching, const struct eo_march_options *options, const double *start,
                     struct eo_march *result)
{
  int n = marching->oscillator->n;
  double y[2 * N];
  struct eo_settling settling;
  eo_settling_init(&settling, n, options->settled, options->max_repeat);
  read_state(marching, start, y);
  while (result->periods < options->max_periods && !result->periodic) {
    march_period(marching, start, y, eo_settling_begin(&settling, y));
    result->periods++;
    result->repeat = eo_settling_end(&settling, y);
    result->periodic = result->repeat > 0;
    result->change = eo_settling_change(&settling);
    if (result->periods % options->patience == 0 && !(result->change <= options->on_its_way))
      break;
  }
  for (int i = 0; i < n; i++) {
    result->state[i] = marching->state[i] + marching->still[i];
    result->state[n + i] = marching->state[n + i] * marching->scale;
  }
}

enum eo_code eo_march(const struct eo_oscillator *oscillator, const struct eo_cycle *cycle,
                      const struct eo_march_options *options, const double *start, struct eo_march *result,
                      struct eo_error *error)
{
  struct marching *marching = malloc(sizeof *marching);
  if (!marching)
    return eo_error_memory(error);
  *result = (struct eo_march){0};
  enum eo_code code = marching_init(marching, oscillator, cycle, options->angle, error);
  for (int i = 0; i < oscillator->n && !code; i++) {
    marching->state[i] = start[i] - marching->still[i];
    marching->state[oscillator->n + i] = start[oscillator->n + i] / marching->scale;
  }
  if (!code)
    march_on(marching, options, start, result);
  marching_done(marching);
  free(marching);
  return code;
}
