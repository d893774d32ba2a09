/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/long_response.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "dynamics/propagator.h"
#include "numerics/dense.h"
#include "numerics/fft.h"

/* STEPS_PER_CYCLE as time integration by mesh cycles takes at least; SAMPLES_PER_CYCLE: accelerations that are kept;
   LEAD_CYCLES: before the period that is looked at, and once more while the motion has not come back. */
enum { STEPS_PER_CYCLE = 256, SAMPLES_PER_CYCLE = 64, LEAD_CYCLES = 300, MOST_TRIES = 16, ROWS = 2 };
enum { N = EO_MAX_COORDINATES };

/* Forces beside the meshes of constant stiffness, straight over a step: f(t) along mesh j has the particular solution
   r = place f + lag f', with K place = mesh, K lag = -C place and the meshes in K and C. */
struct push {
  double place[N], lag[N];
  double gain[2 * N]; /* d state at the end of a step / d f there */
};

struct response {
  const struct eo_long_case *load;
  struct eo_long_response *result;
  struct eo_dynamics_model model;
  struct eo_law law[2];
  int steps, stride, samples; /* of a period */
  double step, scale;         /* s; velocities are kept over it, 1/s */
  double *row[2];             /* [end]: [steps][ROWS] Z, k_tan */
  double propagator[4 * N * N];
  double still[N]; /* under the constant loads */
  struct push push[2];
  double state[2 * N];                  /* r - still, r' / scale */
  double force[2], before[2];           /* [end] pushes at this instant and the last, N */
  double mesh_force[2], contact[2];     /* [end] with damping, N; share of the step in contact */
  double reading[EO_READINGS][2][N];    /* [reading][end]: by coordinate */
  double *acceleration[EO_READINGS][2]; /* [samples] */
};

static double dot(int n, const double *a, const double *b)
{
  double sum = 0;
  for (int i = 0; i < n; i++)
    sum += a[i] * b[i];
  return sum;
}

static double mean_of(int n, const double *value)
{
  double sum = 0;
  for (int i = 0; i < n; i++)
    sum += value[i];
  return sum / n;
}

static int power_of_two(double least)
{
  int n = 1;
  while (n < least)
    n *= 2;
  return n;
}

/* Samples of a period to as many as there are steps, by the lines that are kept: to[steps], ROWS apart. */
static enum eo_code resample(const struct response *r, const double *from, double *to, struct eo_error *error)
{
  int n = r->load->cycles * r->load->positions, lines = r->load->harmonics * r->load->cycles + 1;
  double complex *line = malloc(sizeof *line * (size_t)(n / 2 + 1)), *x = calloc((size_t)r->steps, sizeof *x);
  enum eo_code code = line && x ? eo_fft_spectrum(n, from, line, error) : eo_error_memory(error);
  for (int k = 0; k < lines && k <= n / 2 && !code; k++)
    x[k] = conj(line[k]);
  if (!code)
    eo_fft_forward(r->steps, x);
  for (int i = 0; i < r->steps && !code; i++)
    to[(size_t)i * ROWS] = creal(x[i]);
  free(line);
  free(x);
  return code;
}

/* The oscillator between kicks has the mean stiffness of the meshes; steps as small as a march by cycles takes. */
static void set_steps(struct response *r, double mean_stiffness)
{
  static const double ANGLE = 0.15; /* rad, see struct eo_march_options */
  const double mean[2] = {mean_stiffness, mean_stiffness};
  double cycle = 2 * M_PI / (r->load->speed * r->load->pinion_teeth),
         least = cycle * eo_propagator_mesh_rate(&r->model.oscillator, mean) / ANGLE;
  r->model.oscillator.shift = mean_stiffness;
  r->steps = power_of_two(r->load->cycles * fmin(fmax(least, STEPS_PER_CYCLE), 4 * STEPS_PER_CYCLE));
  r->samples = power_of_two((double)r->load->cycles * SAMPLES_PER_CYCLE);
  r->stride = r->steps / r->samples;
}

/* Rows of the tangent law; false in *lawful where its stiffness is not positive. */
static enum eo_code set_rows(struct response *r, bool *lawful, struct eo_error *error)
{
  const struct eo_long_case *load = r->load;
  int n = load->cycles * load->positions, ends = load->parameters->ends;
  double nominal = eo_dynamics_mesh_load(load->parameters, load->torque), mean = 0;
  for (int end = 0; end < ends; end++)
    mean += mean_of(n, load->tangent[end]) / ends;
  set_steps(r, mean);
  for (int end = 0; end < ends; end++) {
    r->row[end] = malloc(sizeof(double) * ROWS * (size_t)r->steps);
    if (!r->row[end])
      return eo_error_memory(error);
    EO_TRY(resample(r, load->deflection[end], r->row[end], error));
    EO_TRY(resample(r, load->tangent[end], r->row[end] + 1, error));
    for (int i = 0; i < r->steps; i++)
      *lawful = *lawful && r->row[end][(size_t)i * ROWS + 1] > 0;
    r->law[end] = (struct eo_law){.kind = EO_MESH_TANGENT,
                                  .rows = ROWS,
                                  .nominal = nominal,
                                  .back = load->back,
                                  .back_stiffness = mean_of(n, load->tangent[end])};
  }
  return EO_OK;
}

static enum eo_code make_storage(struct response *r, struct eo_error *error)
{
  const struct eo_dynamics_model *m = &r->model;
  bool complete = true;
  for (int reading = 0; reading < EO_READINGS; reading++)
    for (int end = 0; end < r->load->parameters->ends; end++) {
      r->acceleration[reading][end] = calloc((size_t)r->samples, sizeof(double));
      complete = complete && r->acceleration[reading][end];
      for (int k = 0; k < m->oscillator.n; k++)
        for (int i = 0; i < m->freedoms; i++)
          r->reading[reading][end][k] += m->reading[reading][end][i] * m->basis[i * m->oscillator.n + k];
    }
  return complete ? EO_OK : eo_error_memory(error);
}

/* K and C with the meshes at their mean stiffness and their damping. */
static void set_meshed(const struct response *r, double *stiffness, double *damping)
{
  const struct eo_oscillator *o = &r->model.oscillator;
  int n = o->n;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      stiffness[i * n + j] = o->stiffness[i * n + j];
      damping[i * n + j] = o->damping[i * n + j];
      for (int end = 0; end < o->ends; end++) {
        stiffness[i * n + j] += o->shift * o->mesh[end][i] * o->mesh[end][j];
        damping[i * n + j] += r->load->parameters->mesh_damping * o->mesh[end][i] * o->mesh[end][j];
      }
    }
}

/* x = K^-1 b; false: there is no such place. */
static bool settle(int n, const double *stiffness, const double *b, double *x)
{
  double k[N * N];
  int pivot[N];
  memcpy(k, stiffness, sizeof *k * (size_t)n * (size_t)n);
  memcpy(x, b, sizeof *x * (size_t)n);
  return eo_dense_solve(n, k, pivot, 1, x) == 0;
}

/* b = A a, both [2 n]. */
static void apply(int size, const double *matrix, const double *a, double *b)
{
  for (int i = 0; i < size; i++)
    b[i] = dot(size, matrix + (size_t)i * (size_t)size, a);
}

/* Adds what pushes of value f and rate f' have as their particular solution, times sign. */
static void add_push(const struct response *r, const double *force, const double *rate, double sign, double *state)
{
  int n = r->model.oscillator.n;
  for (int end = 0; end < r->model.oscillator.ends; end++)
    for (int i = 0; i < n; i++) {
      state[i] += sign * (r->push[end].place[i] * force[end] + r->push[end].lag[i] * rate[end]);
      state[n + i] += sign * r->push[end].place[i] * rate[end] / r->scale;
    }
}

static enum eo_code set_motion(struct response *r, struct eo_error *error)
{
  const struct eo_oscillator *o = &r->model.oscillator;
  const double mean[2] = {o->shift, o->shift};
  double stiffness[N * N], damping[N * N], drag[N];
  int n = o->n;
  set_meshed(r, stiffness, damping);
  r->step = 2 * M_PI * r->load->cycles / (r->load->speed * r->load->pinion_teeth) / r->steps;
  r->scale = eo_propagator_mesh_rate(o, mean);
  eo_propagator_fill(o, r->load->parameters->mesh_damping, mean, r->scale, r->step, r->propagator);
  bool found = settle(n, stiffness, o->load, r->still);
  for (int end = 0; end < o->ends && found; end++) {
    struct push *push = &r->push[end];
    found = settle(n, stiffness, o->mesh[end], push->place);
    for (int i = 0; i < n; i++)
      drag[i] = -dot(n, damping + (size_t)i * (size_t)n, push->place);
    found = found && settle(n, stiffness, drag, push->lag);
  }
  for (int end = 0; end < o->ends && found; end++) {
    double none[2] = {0}, one[2] = {end == 0, end == 1}, rate[2] = {one[0] / r->step, one[1] / r->step};
    double start[2 * N] = {0};
    add_push(r, none, rate, -1, start);
    apply(2 * n, r->propagator, start, r->push[end].gain);
    add_push(r, one, rate, 1, r->push[end].gain);
  }
  return found ? EO_OK : eo_error_set(error, EO_ERROR_NUMERIC, "", "The lumped model has no place at rest.");
}

/* Share of the step about an instant that contact lasts, the margin taken as straight. */
static double contact_share(double margin, double moved)
{
  return moved > 0 ? fmin(fmax(0.5 + margin / moved, 0), 1) : margin > 0;
}

/* Pushes at a state: what the mesh forces differ from constant stiffness and damping. */
static void find_pushes(struct response *r, int i, const double *state, double *force)
{
  const struct eo_oscillator *o = &r->model.oscillator;
  double c = r->load->parameters->mesh_damping;
  int n = o->n;
  for (int end = 0; end < o->ends; end++) {
    double x = dot(n, o->mesh[end], state) + dot(n, o->mesh[end], r->still),
           v = dot(n, o->mesh[end], state + n) * r->scale;
    struct eo_mesh_force f = eo_law_force(&r->law[end], r->row[end] + (size_t)i * ROWS, x, 0);
    r->contact[end] = contact_share(f.margin, fabs(v) * r->step);
    r->mesh_force[end] = f.force + c * r->contact[end] * v;
    force[end] = o->shift * x + c * v - r->mesh_force[end];
  }
}

/* theory (P6): one step to instant i, exact but for the pushes, which are straight in it; those at its end follow from
   the state there, which they hardly change. */
static void take_step(struct response *r, int i)
{
  enum { CORRECTIONS = 2 };
  int n = r->model.oscillator.n;
  double next[2] = {2 * r->force[0] - r->before[0], 2 * r->force[1] - r->before[1]}, state[2 * N], found[2] = {0};
  double rate[2] = {(next[0] - r->force[0]) / r->step, (next[1] - r->force[1]) / r->step};
  add_push(r, r->force, rate, -1, r->state);
  apply(2 * n, r->propagator, r->state, state);
  add_push(r, next, rate, 1, state);
  for (int correction = 0; correction < CORRECTIONS; correction++) {
    find_pushes(r, i, state, found);
    for (int end = 0; end < r->model.oscillator.ends; end++) {
      for (int k = 0; k < 2 * n; k++)
        state[k] += r->push[end].gain[k] * (found[end] - next[end]);
      next[end] = found[end];
    }
  }
  find_pushes(r, i, state, found);
  memcpy(r->before, r->force, sizeof r->before);
  memcpy(r->force, found, sizeof r->force);
  memcpy(r->state, state, sizeof *state * 2 * (size_t)n);
}

/* Accelerations r" = load - K r - C r' - sum mesh F at one instant, as the readings see them. */
static void keep_accelerations(struct response *r, int sample)
{
  const struct eo_oscillator *o = &r->model.oscillator;
  double acceleration[N], position[N], velocity[N];
  for (int i = 0; i < o->n; i++) {
    position[i] = r->state[i] + r->still[i];
    velocity[i] = r->state[o->n + i] * r->scale;
  }
  for (int i = 0; i < o->n; i++) {
    acceleration[i] = o->load[i] - dot(o->n, o->stiffness + (size_t)i * (size_t)o->n, position) -
                      dot(o->n, o->damping + (size_t)i * (size_t)o->n, velocity);
    for (int end = 0; end < o->ends; end++)
      acceleration[i] -= o->mesh[end][i] * r->mesh_force[end];
  }
  for (int reading = 0; reading < EO_READINGS; reading++)
    for (int end = 0; end < o->ends; end++)
      r->acceleration[reading][end][sample] = dot(o->n, r->reading[reading][end], acceleration);
}

static void look(struct response *r, int i)
{
  struct eo_long_response *result = r->result;
  for (int end = 0; end < r->model.oscillator.ends; end++) {
    result->contact_loss[end] += (1 - r->contact[end]) / r->steps;
    if (r->mesh_force[end] > result->force_most[end]) {
      result->force_most[end] = r->mesh_force[end];
      result->force_cycle[end] = (int)((long)i * r->load->cycles / r->steps);
    }
  }
  if (i % r->stride == 0)
    keep_accelerations(r, i / r->stride);
}

/* One period under observation, and how far its end is from its start, of the swing. */
static double pass_period(struct response *r)
{
  int n = r->model.oscillator.n;
  double start[2 * N], swing[2] = {0}, change[2] = {0};
  memcpy(start, r->state, sizeof start);
  memset(r->result->contact_loss, 0, sizeof r->result->contact_loss);
  memset(r->result->force_most, 0, sizeof r->result->force_most);
  for (int i = 1; i <= r->steps; i++) {
    take_step(r, i % r->steps);
    look(r, i % r->steps);
    for (int k = 0; k < 2 * n; k++)
      swing[k / n] = fmax(swing[k / n], fabs(r->state[k] - start[k]));
  }
  for (int k = 0; k < 2 * n; k++)
    change[k / n] = fmax(change[k / n], fabs(r->state[k] - start[k]));
  return fmax(swing[0] > 0 ? change[0] / swing[0] : 0, swing[1] > 0 ? change[1] / swing[1] : 0);
}

/* From rest through cycles before the period, then the period, until the motion comes back. */
static void march(struct response *r)
{
  static const double SETTLED = 1e-4; /* of the swing */
  struct eo_long_response *result = r->result;
  int lead = (int)fmin(r->steps, (double)r->steps / r->load->cycles * LEAD_CYCLES),
      first = (r->steps - lead) % r->steps;
  memset(r->state, 0, sizeof r->state);
  /* at rest where the teeth of mean stiffness stand at Z: a push of k Z - P */
  for (int end = 0; end < r->model.oscillator.ends; end++)
    r->force[end] = r->model.oscillator.shift * r->row[end][(size_t)first * ROWS] - r->law[end].nominal;
  memcpy(r->before, r->force, sizeof r->before);
  add_push(r, r->force, (const double[2]){0}, 1, r->state);
  for (int i = first + 1; i <= first + lead; i++)
    take_step(r, i % r->steps);
  result->change = INFINITY;
  for (result->periods = 0; result->periods < MOST_TRIES && !(result->change <= SETTLED); result->periods++)
    result->change = pass_period(r);
  bool lost = result->contact_loss[0] > 1e-12 || result->contact_loss[1] > 1e-12;
  result->outcome = !(result->change <= SETTLED) ? EO_LONG_NOT_SETTLED
                    : lost                       ? EO_LONG_CONTACT_LOST
                                                 : EO_LONG_IN_CONTACT;
}

static enum eo_code read_spectra(struct response *r, struct eo_error *error)
{
  struct eo_long_response *result = r->result;
  int ends = r->load->parameters->ends, n = r->samples;
  double complex *line = malloc(sizeof *line * (size_t)(n / 2 + 1));
  if (!line)
    return eo_error_memory(error);
  result->lines = r->load->harmonics * r->load->cycles + 1;
  result->lines = result->lines < n / 2 ? result->lines : n / 2;
  enum eo_code code = EO_OK;
  for (int reading = 0; reading < EO_READINGS && !code; reading++) {
    double *mean = r->acceleration[reading][0];
    for (int end = 0; end < ends; end++) {
      double level = mean_of(n, r->acceleration[reading][end]),
             square = dot(n, r->acceleration[reading][end], r->acceleration[reading][end]) / n;
      result->rms[reading] += sqrt(fmax(0, square - level * level)) / ends;
    }
    for (int i = 0; i < n && ends == 2; i++)
      mean[i] = (mean[i] + r->acceleration[reading][1][i]) / 2;
    result->acceleration[reading] = malloc(sizeof *line * (size_t)result->lines);
    code = result->acceleration[reading] ? eo_fft_spectrum(n, mean, line, error) : eo_error_memory(error);
    if (!code)
      memcpy(result->acceleration[reading], line, sizeof *line * (size_t)result->lines);
  }
  free(line);
  return code;
}

static enum eo_code find(struct response *r, struct eo_error *error)
{
  bool lawful = true;
  EO_TRY(eo_dynamics_model_init(&r->model, r->load->parameters, error));
  eo_dynamics_model_load(&r->model, r->load->torque, EO_IMPACT_NONE);
  EO_TRY(set_rows(r, &lawful, error));
  if (!lawful) {
    r->result->outcome = EO_LONG_NO_LAW;
    return EO_OK;
  }
  EO_TRY(make_storage(r, error));
  EO_TRY(set_motion(r, error));
  march(r);
  return read_spectra(r, error);
}

enum eo_code eo_long_response_find(struct eo_long_response *response, const struct eo_long_case *load,
                                   struct eo_error *error)
{
  *response = (struct eo_long_response){.outcome = EO_LONG_TOO_LONG};
  if (load->cycles > EO_LONG_MOST_CYCLES)
    return EO_OK;
  struct response *r = calloc(1, sizeof *r);
  if (!r)
    return eo_error_memory(error);
  r->load = load;
  r->result = response;
  enum eo_code code = find(r, error);
  for (int end = 0; end < 2; end++) {
    free(r->row[end]);
    for (int reading = 0; reading < EO_READINGS; reading++)
      free(r->acceleration[reading][end]);
  }
  free(r);
  return code;
}

void eo_long_response_done(struct eo_long_response *response)
{
  for (int reading = 0; reading < EO_READINGS; reading++) {
    free(response->acceleration[reading]);
    response->acceleration[reading] = NULL;
  }
}
