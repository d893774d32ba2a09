/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/long_response.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "dynamics/propagator.h"
#include "numerics/dense.h"
#include "numerics/fft.h"
#include "numerics/periodic.h"

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

static int power_of_two(double least)
{
  int n = 1;
  while (n < least)
    n *= 2;
  return n;
}

/* Samples of a period to as many as there are steps, by the lines that are kept: to[steps], ROWS apart. */
static enum eo_code resample(const struct response *response, const double *from, double *to, struct eo_error *error)
{
  int n = response->load->cycles * response->load->positions,
      lines = response->load->harmonics * response->load->cycles + 1;
  double complex *line = malloc(sizeof *line * (size_t)(n / 2 + 1)), *x = calloc((size_t)response->steps, sizeof *x);
  enum eo_code code = line && x ? eo_fft_spectrum(n, from, line, error) : eo_error_memory(error);
  for (int k = 0; k < lines && k <= n / 2 && !code; k++)
    x[k] = conj(line[k]);
  if (!code)
    code = eo_fft_forward(response->steps, x, error);
  for (int i = 0; i < response->steps && !code; i++)
    to[(size_t)i * ROWS] = creal(x[i]);
  free(line);
  free(x);
  return code;
}

/* The oscillator between kicks has the mean stiffness of the meshes; steps as small as a march by cycles takes. */
static void set_steps(struct response *response, double mean_stiffness)
{
  static const double ANGLE = 0.15; /* rad, see struct eo_march_options */
  const double mean[2] = {mean_stiffness, mean_stiffness};
  double cycle = 2 * M_PI / (response->load->speed * response->load->pinion_teeth),
         least = cycle * eo_propagator_mesh_rate(&response->model.oscillator, mean) / ANGLE;
  response->model.oscillator.shift = mean_stiffness;
  response->steps = power_of_two(response->load->cycles * fmin(fmax(least, STEPS_PER_CYCLE), 4 * STEPS_PER_CYCLE));
  response->samples = power_of_two((double)response->load->cycles * SAMPLES_PER_CYCLE);
  response->stride = response->steps / response->samples;
}

/* Rows of the tangent law; false in *lawful where its stiffness is not positive. */
static enum eo_code set_rows(struct response *response, bool *lawful, struct eo_error *error)
{
  const struct eo_long_case *load = response->load;
  int n = load->cycles * load->positions, ends = load->parameters->ends;
  double mean = 0;
  for (int end = 0; end < ends; end++)
    mean += eo_periodic_mean(n, load->tangent[end]) / ends;
  set_steps(response, mean);
  for (int end = 0; end < ends; end++) {
    response->row[end] = malloc(sizeof(double) * ROWS * (size_t)response->steps);
    if (!response->row[end])
      return eo_error_memory(error);
    EO_TRY(resample(response, load->deflection[end], response->row[end], error));
    EO_TRY(resample(response, load->tangent[end], response->row[end] + 1, error));
    for (int i = 0; i < response->steps; i++)
      *lawful = *lawful && response->row[end][(size_t)i * ROWS + 1] > 0;
    response->law[end] = (struct eo_law){.kind = EO_MESH_TANGENT,
                                         .rows = ROWS,
                                         .nominal = eo_dynamics_mesh_load(load->parameters, load->torque, end),
                                         .back = load->back,
                                         .back_stiffness = eo_periodic_mean(n, load->tangent[end])};
  }
  return EO_OK;
}

static enum eo_code make_storage(struct response *response, struct eo_error *error)
{
  const struct eo_dynamics_model *model = &response->model;
  bool complete = true;
  for (int reading = 0; reading < EO_READINGS; reading++)
    for (int end = 0; end < response->load->parameters->ends; end++) {
      response->acceleration[reading][end] = calloc((size_t)response->samples, sizeof(double));
      complete = complete && response->acceleration[reading][end];
      for (int k = 0; k < model->oscillator.n; k++)
        for (int i = 0; i < model->freedoms; i++)
          response->reading[reading][end][k] += model->reading[reading][end][i] *
                                                model->basis[i * model->oscillator.n + k];
    }
  return complete ? EO_OK : eo_error_memory(error);
}

/* K and C with the meshes at their mean stiffness and their damping. */
static void set_meshed(const struct response *response, double *stiffness, double *damping)
{
  const struct eo_oscillator *oscillator = &response->model.oscillator;
  int n = oscillator->n;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      stiffness[i * n + j] = oscillator->stiffness[i * n + j];
      damping[i * n + j] = oscillator->damping[i * n + j];
      for (int end = 0; end < oscillator->ends; end++) {
        stiffness[i * n + j] += oscillator->shift * oscillator->mesh[end][i] * oscillator->mesh[end][j];
        damping[i * n + j] += response->load->parameters->mesh_damping * oscillator->mesh[end][i] *
                              oscillator->mesh[end][j];
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
static void add_push(const struct response *response, const double *force, const double *rate, double sign,
                     double *state)
{
  int n = response->model.oscillator.n;
  for (int end = 0; end < response->model.oscillator.ends; end++)
    for (int i = 0; i < n; i++) {
      state[i] += sign * (response->push[end].place[i] * force[end] + response->push[end].lag[i] * rate[end]);
      state[n + i] += sign * response->push[end].place[i] * rate[end] / response->scale;
    }
}

static enum eo_code set_motion(struct response *response, struct eo_error *error)
{
  const struct eo_oscillator *oscillator = &response->model.oscillator;
  const double mean[2] = {oscillator->shift, oscillator->shift};
  double stiffness[N * N], damping[N * N], drag[N];
  int n = oscillator->n;
  set_meshed(response, stiffness, damping);
  response->step = 2 * M_PI * response->load->cycles / (response->load->speed * response->load->pinion_teeth) /
                   response->steps;
  response->scale = eo_propagator_mesh_rate(oscillator, mean);
  eo_propagator_fill(oscillator, response->load->parameters->mesh_damping, mean, response->scale, response->step,
                     response->propagator);
  bool found = settle(n, stiffness, oscillator->load, response->still);
  for (int end = 0; end < oscillator->ends && found; end++) {
    struct push *push = &response->push[end];
    found = settle(n, stiffness, oscillator->mesh[end], push->place);
    for (int i = 0; i < n; i++)
      drag[i] = -dot(n, damping + (size_t)i * (size_t)n, push->place);
    found = found && settle(n, stiffness, drag, push->lag);
  }
  for (int end = 0; end < oscillator->ends && found; end++) {
    double none[2] = {0}, one[2] = {end == 0, end == 1}, rate[2] = {one[0] / response->step, one[1] / response->step};
    double start[2 * N] = {0};
    add_push(response, none, rate, -1, start);
    apply(2 * n, response->propagator, start, response->push[end].gain);
    add_push(response, one, rate, 1, response->push[end].gain);
  }
  return found ? EO_OK : eo_error_set(error, EO_ERROR_NUMERIC, "", "The lumped model has no place at rest.");
}

/* Share of the step about an instant that contact lasts, the margin taken as straight. */
static double contact_share(double margin, double moved)
{
  return moved > 0 ? fmin(fmax(0.5 + margin / moved, 0), 1) : margin > 0;
}

/* Pushes at a state: what the mesh forces differ from constant stiffness and damping. */
static void find_pushes(struct response *response, int i, const double *state, double *force)
{
  const struct eo_oscillator *oscillator = &response->model.oscillator;
  double c = response->load->parameters->mesh_damping;
  int n = oscillator->n;
  for (int end = 0; end < oscillator->ends; end++) {
    double x = dot(n, oscillator->mesh[end], state) + dot(n, oscillator->mesh[end], response->still),
           v = dot(n, oscillator->mesh[end], state + n) * response->scale;
    struct eo_mesh_force mesh_force = eo_law_force(&response->law[end], response->row[end] + (size_t)i * ROWS, x, 0);
    response->contact[end] = contact_share(mesh_force.margin, fabs(v) * response->step);
    response->mesh_force[end] = mesh_force.force + c * response->contact[end] * v;
    force[end] = oscillator->shift * x + c * v - response->mesh_force[end];
  }
}

/* theory (P5): one step to instant i, exact but for the pushes, which are straight in it; those at its end follow from
   the state there, which they hardly change. */
static void take_step(struct response *response, int i)
{
  enum { CORRECTIONS = 2 };
  int n = response->model.oscillator.n;
  double next[2] = {2 * response->force[0] - response->before[0], 2 * response->force[1] - response->before[1]},
         state[2 * N], found[2] = {0};
  double rate[2] = {(next[0] - response->force[0]) / response->step, (next[1] - response->force[1]) / response->step};
  add_push(response, response->force, rate, -1, response->state);
  apply(2 * n, response->propagator, response->state, state);
  add_push(response, next, rate, 1, state);
  for (int correction = 0; correction < CORRECTIONS; correction++) {
    find_pushes(response, i, state, found);
    for (int end = 0; end < response->model.oscillator.ends; end++) {
      for (int k = 0; k < 2 * n; k++)
        state[k] += response->push[end].gain[k] * (found[end] - next[end]);
      next[end] = found[end];
    }
  }
  find_pushes(response, i, state, found);
  memcpy(response->before, response->force, sizeof response->before);
  memcpy(response->force, found, sizeof response->force);
  memcpy(response->state, state, sizeof *state * 2 * (size_t)n);
}

/* Accelerations r" = load - K r - C r' - sum mesh F at one instant, as the readings see them. */
static void keep_accelerations(struct response *response, int sample)
{
  const struct eo_oscillator *oscillator = &response->model.oscillator;
  double acceleration[N], position[N], velocity[N];
  for (int i = 0; i < oscillator->n; i++) {
    position[i] = response->state[i] + response->still[i];
    velocity[i] = response->state[oscillator->n + i] * response->scale;
  }
  for (int i = 0; i < oscillator->n; i++) {
    acceleration[i] = oscillator->load[i] -
                      dot(oscillator->n, oscillator->stiffness + (size_t)i * (size_t)oscillator->n, position) -
                      dot(oscillator->n, oscillator->damping + (size_t)i * (size_t)oscillator->n, velocity);
    for (int end = 0; end < oscillator->ends; end++)
      acceleration[i] -= oscillator->mesh[end][i] * response->mesh_force[end];
  }
  for (int reading = 0; reading < EO_READINGS; reading++)
    for (int end = 0; end < oscillator->ends; end++)
      response->acceleration[reading][end][sample] = dot(oscillator->n, response->reading[reading][end], acceleration);
}

static void look(struct response *response, int i)
{
  struct eo_long_response *result = response->result;
  for (int end = 0; end < response->model.oscillator.ends; end++) {
    result->contact_loss[end] += (1 - response->contact[end]) / response->steps;
    if (response->mesh_force[end] > result->force_most[end]) {
      result->force_most[end] = response->mesh_force[end];
      result->force_cycle[end] = (int)((long)i * response->load->cycles / response->steps);
    }
  }
  if (i % response->stride == 0)
    keep_accelerations(response, i / response->stride);
}

/* One period under observation, and how far its end is from its start, of the swing. */
static double pass_period(struct response *response)
{
  int n = response->model.oscillator.n;
  double start[2 * N], swing[2] = {0}, change[2] = {0};
  memcpy(start, response->state, sizeof start);
  memset(response->result->contact_loss, 0, sizeof response->result->contact_loss);
  memset(response->result->force_most, 0, sizeof response->result->force_most);
  for (int i = 1; i <= response->steps; i++) {
    take_step(response, i % response->steps);
    look(response, i % response->steps);
    for (int k = 0; k < 2 * n; k++)
      swing[k / n] = fmax(swing[k / n], fabs(response->state[k] - start[k]));
  }
  for (int k = 0; k < 2 * n; k++)
    change[k / n] = fmax(change[k / n], fabs(response->state[k] - start[k]));
  return fmax(swing[0] > 0 ? change[0] / swing[0] : 0, swing[1] > 0 ? change[1] / swing[1] : 0);
}

/* From rest through cycles before the period, then the period, until the motion comes back. */
static void march(struct response *response)
{
  static const double SETTLED = 1e-4; /* of the swing */
  struct eo_long_response *result = response->result;
  int lead = (int)fmin(response->steps, (double)response->steps / response->load->cycles * LEAD_CYCLES),
      first = (response->steps - lead) % response->steps;
  memset(response->state, 0, sizeof response->state);
  /* at rest where the teeth of mean stiffness stand at Z: a push of k Z - P */
  for (int end = 0; end < response->model.oscillator.ends; end++)
    response->force[end] = response->model.oscillator.shift * response->row[end][(size_t)first * ROWS] -
                           response->law[end].nominal;
  memcpy(response->before, response->force, sizeof response->before);
  add_push(response, response->force, (const double[2]){0}, 1, response->state);
  for (int i = first + 1; i <= first + lead; i++)
    take_step(response, i % response->steps);
  result->change = INFINITY;
  for (result->periods = 0; result->periods < MOST_TRIES && !(result->change <= SETTLED); result->periods++)
    result->change = pass_period(response);
  bool lost = result->contact_loss[0] > 1e-12 || result->contact_loss[1] > 1e-12;
  result->outcome = !(result->change <= SETTLED) ? EO_LONG_NOT_SETTLED
                    : lost                       ? EO_LONG_CONTACT_LOST
                                                 : EO_LONG_IN_CONTACT;
}

static enum eo_code read_spectra(struct response *response, struct eo_error *error)
{
  struct eo_long_response *result = response->result;
  int ends = response->load->parameters->ends, n = response->samples;
  double complex *line = malloc(sizeof *line * (size_t)(n / 2 + 1));
  if (!line)
    return eo_error_memory(error);
  result->lines = response->load->harmonics * response->load->cycles + 1;
  result->lines = result->lines < n / 2 ? result->lines : n / 2;
  enum eo_code code = EO_OK;
  for (int reading = 0; reading < EO_READINGS && !code; reading++) {
    double *mean = response->acceleration[reading][0];
    for (int end = 0; end < ends; end++) {
      double level = eo_periodic_mean(n, response->acceleration[reading][end]),
             square = dot(n, response->acceleration[reading][end], response->acceleration[reading][end]) / n;
      result->rms[reading] += sqrt(fmax(0, square - level * level)) / ends;
    }
    for (int i = 0; i < n && ends == 2; i++)
      mean[i] = (mean[i] + response->acceleration[reading][1][i]) / 2;
    result->acceleration[reading] = malloc(sizeof *line * (size_t)result->lines);
    code = result->acceleration[reading] ? eo_fft_spectrum(n, mean, line, error) : eo_error_memory(error);
    if (!code)
      memcpy(result->acceleration[reading], line, sizeof *line * (size_t)result->lines);
  }
  free(line);
  return code;
}

static enum eo_code find(struct response *response, struct eo_error *error)
{
  bool lawful = true;
  EO_TRY(eo_dynamics_model_init(&response->model, response->load->parameters, error));
  eo_dynamics_model_load(&response->model, response->load->torque, EO_IMPACT_NONE);
  EO_TRY(set_rows(response, &lawful, error));
  if (!lawful) {
    response->result->outcome = EO_LONG_NO_LAW;
    return EO_OK;
  }
  EO_TRY(make_storage(response, error));
  EO_TRY(set_motion(response, error));
  march(response);
  return read_spectra(response, error);
}

enum eo_code eo_long_response_find(struct eo_long_response *response, const struct eo_long_case *load,
                                   struct eo_error *error)
{
  *response = (struct eo_long_response){.outcome = EO_LONG_TOO_LONG};
  if (load->cycles > EO_LONG_MOST_CYCLES)
    return EO_OK;
  struct response *this_response = calloc(1, sizeof *this_response);
  if (!this_response)
    return eo_error_memory(error);
  this_response->load = load;
  this_response->result = response;
  enum eo_code code = find(this_response, error);
  for (int end = 0; end < 2; end++) {
    free(this_response->row[end]);
    for (int reading = 0; reading < EO_READINGS; reading++)
      free(this_response->acceleration[reading][end]);
  }
  free(this_response);
  return code;
}

void eo_long_response_done(struct eo_long_response *response)
{
  for (int reading = 0; reading < EO_READINGS; reading++) {
    free(response->acceleration[reading]);
    response->acceleration[reading] = NULL;
  }
}
