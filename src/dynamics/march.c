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

static int choose_steps(const struct eo_oscillator *o, const struct eo_cycle *cycle, double angle)
{
  const double mean[2] = {o->shift, o->shift};
  double steps = 2 * M_PI / cycle->frequency * eo_propagator_mesh_rate(o, mean) / angle;
  for (int end = 0; end < o->ends; end++)
    if (cycle->pulse[end].shape == EO_PULSE_HALF_SINE)
      steps = fmax(steps, STEPS_PER_PULSE / cycle->pulse[end].duration);
  return steps > MOST_STEPS ? -1 : (int)fmax(ceil(steps), LEAST_STEPS);
}

static void fill_instants(struct marching *m)
{
  const struct eo_cycle *cycle = m->cycle;
  for (int i = 0; i < m->steps; i++)
    for (int end = 0; end < m->oscillator->ends; end++) {
      double phase = (double)i / m->steps;
      struct instant *at = &m->instant[i];
      prescribe(cycle, end, phase, &at->motion[end], &at->rate[end]);
      at->pulse[end] = eo_pulse_value(&cycle->pulse[end], cycle->frequency, phase + cycle->shift[end]);
      eo_law_rows(cycle->law[end], phase + cycle->shift[end], m->row[end] + (size_t)i * (size_t)m->rows[end]);
    }
}

/* (K + sum k mesh mesh') still = load. */
static int find_still(struct marching *m)
{
  const struct eo_oscillator *o = m->oscillator;
  double k[N * N];
  int n = o->n, pivot[N];
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      k[i * n + j] = o->stiffness[i * n + j];
      for (int end = 0; end < o->ends; end++)
        k[i * n + j] += o->shift * o->mesh[end][i] * o->mesh[end][j];
    }
  memcpy(m->still, o->load, sizeof *m->still * (size_t)n);
  return eo_dense_solve(n, k, pivot, 1, m->still);
}

static void marching_done(struct marching *m)
{
  free(m->instant);
  free(m->row[0]);
  free(m->row[1]);
}

static enum eo_code marching_init(struct marching *m, const struct eo_oscillator *o, const struct eo_cycle *cycle,
                                  double angle, struct eo_error *error)
{
  const double mean[2] = {o->shift, o->shift};
  *m = (struct marching){.oscillator = o, .cycle = cycle, .steps = choose_steps(o, cycle, angle)};
  if (m->steps < 0)
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "Time integration at %g rad/s would need too many steps.",
                        cycle->frequency);
  m->step = 2 * M_PI / cycle->frequency / m->steps;
  m->scale = eo_propagator_mesh_rate(o, mean);
  m->instant = calloc((size_t)m->steps, sizeof *m->instant);
  bool complete = m->instant != NULL;
  for (int end = 0; end < o->ends; end++) {
    m->rows[end] = cycle->law[end]->rows;
    m->row[end] = malloc(sizeof(double) * (size_t)m->steps * (size_t)m->rows[end]);
    complete = complete && m->row[end];
  }
  if (!complete)
    return eo_error_memory(error);
  if (find_still(m))
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "The oscillator has no place at rest.");
  eo_propagator_fill(o, cycle->mesh_damping, mean, m->scale, m->step, m->propagator);
  fill_instants(m);
  return EO_OK;
}

/* Share of the step about an instant that contact lasts, the margin taken as straight: switching within a step would
   otherwise be out by the step, and all that is found with it. */
static double contact_share(const struct marching *m, double margin, double rate)
{
  double moved = fabs(rate) * m->step;
  return moved > 0 ? fmin(fmax(0.5 + margin / moved, 0), 1) : margin > 0;
}

/* Velocities changed at once by what acts over a time beside constant meshes: mesh forces less k X and c_m X', and
   pulses. The mesh damping that the propagator has is taken back where contact is lost and it is gated. */
static void kick(struct marching *m, int i, double time)
{
  const struct eo_oscillator *o = m->oscillator;
  const struct eo_cycle *cycle = m->cycle;
  const struct instant *at = &m->instant[i];
  double *position = m->state, *velocity = m->state + o->n, impulse[2] = {0};
  for (int end = 0; end < o->ends; end++) {
    double x = 0, v = 0;
    for (int j = 0; j < o->n; j++) {
      x += o->mesh[end][j] * (position[j] + m->still[j]);
      v += o->mesh[end][j] * velocity[j];
    }
    v *= m->scale;
    struct eo_mesh_force f = eo_law_force(cycle->law[end], m->row[end] + (size_t)i * (size_t)m->rows[end],
                                          x + at->motion[end], 0);
    double damping = cycle->mesh_damping * (cycle->gated ? contact_share(m, f.margin, v + at->rate[end]) : 1);
    impulse[end] = f.force + damping * (v + at->rate[end]) - o->shift * x - cycle->mesh_damping * v;
  }
  for (int end = 0; end < o->ends; end++)
    for (int j = 0; j < o->n; j++)
      velocity[j] -= time / m->scale * (o->mesh[end][j] * impulse[end] + o->pulse[end][j] * at->pulse[end]);
}

static void drift(struct marching *m)
{
  int size = 2 * m->oscillator->n;
  double next[2 * N] = {0};
  for (int i = 0; i < size; i++) {
    const double *row = m->propagator + (size_t)i * (size_t)size;
    double sum = 0;
    for (int j = 0; j < size; j++)
      sum += row[j] * m->state[j];
    next[i] = sum;
  }
  memcpy(m->state, next, sizeof *next * (size_t)size);
}

/* r, r' as departure from an origin and change per period. */
static void read_state(const struct marching *m, const double *origin, double *y)
{
  int n = m->oscillator->n;
  for (int i = 0; i < n; i++) {
    y[i] = m->state[i] + m->still[i] - origin[i];
    y[n + i] = m->state[n + i] * m->scale * m->step * m->steps;
  }
}

/* One period, half a kick at either end. */
static void march_period(struct marching *m, const double *origin, double *y, double *swing)
{
  int n = m->oscillator->n;
  kick(m, 0, m->step / 2);
  for (int i = 1; i <= m->steps; i++) {
    drift(m);
    kick(m, i % m->steps, i < m->steps ? m->step : m->step / 2);
    if (i * LOOKS / m->steps == (i - 1) * LOOKS / m->steps)
      continue;
    read_state(m, origin, y);
    for (int j = 0; j < n; j++)
      *swing = fmax(*swing, fabs(y[j]));
  }
}

static void march_on(struct marching *m, const struct eo_march_options *options, const double *start,
                     struct eo_march *result)
{
  int n = m->oscillator->n;
  double y[2 * N];
  struct eo_settling s;
  eo_settling_init(&s, n, options->settled, options->max_repeat);
  read_state(m, start, y);
  while (result->periods < options->max_periods && !result->periodic) {
    march_period(m, start, y, eo_settling_begin(&s, y));
    result->periods++;
    result->repeat = eo_settling_end(&s, y);
    result->periodic = result->repeat > 0;
    result->change = eo_settling_change(&s);
    if (result->periods % options->patience == 0 && !(result->change <= options->on_its_way))
      break;
  }
  for (int i = 0; i < n; i++) {
    result->state[i] = m->state[i] + m->still[i];
    result->state[n + i] = m->state[n + i] * m->scale;
  }
}

enum eo_code eo_march(const struct eo_oscillator *oscillator, const struct eo_cycle *cycle,
                      const struct eo_march_options *options, const double *start, struct eo_march *result,
                      struct eo_error *error)
{
  struct marching *m = malloc(sizeof *m);
  if (!m)
    return eo_error_memory(error);
  *result = (struct eo_march){0};
  enum eo_code code = marching_init(m, oscillator, cycle, options->angle, error);
  for (int i = 0; i < oscillator->n && !code; i++) {
    m->state[i] = start[i] - m->still[i];
    m->state[oscillator->n + i] = start[oscillator->n + i] / m->scale;
  }
  if (!code)
    march_on(m, options, start, result);
  marching_done(m);
  free(m);
  return code;
}
