/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/long_response.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "dynamics/long_motion.h"
#include "dynamics/propagator.h"
#include "numerics/dense.h"
#include "numerics/fft.h"
#include "numerics/periodic.h"

/* SAMPLES_PER_CYCLE: accelerations that are kept, at least; LEAD_CYCLES: before the period that is looked at, and once
   more while the motion has not come back. */
enum {
  STEPS_PER_CYCLE = 64,
  MOST_PER_CYCLE = 1024,
  SAMPLES_PER_CYCLE = 64,
  LEAD_CYCLES = 300,
  MOST_TRIES = 16,
  ROWS = 2
};
enum { N = EO_MAX_COORDINATES };

struct response {
  const struct eo_long_case *load;
  struct eo_long_response *result;
  struct eo_dynamics_model model;
  struct eo_law law[2];
  int steps, stride, samples;           /* of a period */
  double *row[2];                       /* [end]: [steps][ROWS] Z, k_tan */
  struct eo_long_motion motion;         /* beside where the constant loads leave the meshes at their mean stiffness */
  double still[2];                      /* [end] X there, m */
  double deflection[2], rate[2];        /* [end] X, X' */
  double force[2], before[2];           /* [end] pushes at this instant and the last, N */
  double mesh_force[2], contact[2];     /* [end] with damping, N; share of the step in contact */
  double *acceleration[EO_READINGS][2]; /* [samples] */
};

/* The least number of the kind 4, 5, 6 or 7 times a power of two: quick to transform. */
static int even_number(double least)
{
  int n = 4, part = 1;
  while (n < least) {
    n += part;
    part *= n == 8 * part ? 2 : 1;
  }
  return n;
}

/* Z and k_tan of an end, samples of a period, to as many as there are steps, by the lines that are kept: one is the
   real part of a transform, the other, made as large, the imaginary one. */
static enum eo_code resample(const struct response *response, int end, double *row, struct eo_error *error)
{
  const struct eo_long_case *load = response->load;
  const double *z = load->deflection[end], *k = load->tangent[end];
  int n = load->cycles * load->positions, steps = response->steps;
  double size = sqrt(eo_dot(n, z, z) / eo_dot(n, k, k));
  double complex *x = malloc(sizeof *x * (size_t)n), *y = calloc((size_t)steps, sizeof *y);
  enum eo_code code = x && y ? EO_OK : eo_error_memory(error);
  for (int i = 0; i < n && !code; i++)
    x[i] = (z[i] + I * size * k[i]) / n;
  if (!code)
    code = eo_fft_forward(load->fft, n, x, error);
  for (int line = -load->harmonics * load->cycles; line <= load->harmonics * load->cycles && !code; line++)
    y[line > 0 ? steps - line : -line] = x[line < 0 ? n + line : line];
  if (!code)
    code = eo_fft_forward(load->fft, steps, y, error);
  for (int i = 0; i < steps && !code; i++) {
    row[(size_t)i * ROWS] = creal(y[i]);
    row[(size_t)i * ROWS + 1] = cimag(y[i]) / size;
  }
  free(x);
  free(y);
  return code;
}

/* The oscillator between kicks has the mean stiffness of the meshes; steps as small as a march by cycles takes. */
static void set_steps(struct response *response, double mean_stiffness)
{
  static const double ANGLE = 0.5; /* rad */
  const double mean[2] = {mean_stiffness, mean_stiffness};
  double cycle = 2 * M_PI / (response->load->speed * response->load->pinion_teeth),
         least = cycle * eo_propagator_mesh_rate(&response->model.oscillator, mean) / ANGLE;
  response->model.oscillator.shift = mean_stiffness;
  response->steps = even_number(response->load->cycles * fmin(fmax(least, STEPS_PER_CYCLE), MOST_PER_CYCLE));
  response->stride = 1;
  while (response->steps % (2 * response->stride) == 0 &&
         response->steps >= 2 * response->stride * response->load->cycles * SAMPLES_PER_CYCLE)
    response->stride *= 2;
  response->samples = response->steps / response->stride;
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
    EO_TRY(resample(response, end, response->row[end], error));
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
  bool complete = true;
  for (int reading = 0; reading < EO_READINGS; reading++)
    for (int end = 0; end < response->load->parameters->ends; end++) {
      response->acceleration[reading][end] = calloc((size_t)response->samples, sizeof(double));
      complete = complete && response->acceleration[reading][end];
    }
  return complete ? EO_OK : eo_error_memory(error);
}

/* Readings that are looked at. */
static int readings_of(const struct response *response)
{
  return response->load->levels_alone ? EO_READING_NORMAL + 1 : EO_READINGS;
}

/* Of accelerations: reading by reading, end by end. */
static int reading_of(const struct response *response, int reading, int end)
{
  return reading * response->load->parameters->ends + end;
}

static enum eo_code set_motion(struct response *response, struct eo_error *error)
{
  const struct eo_dynamics_model *model = &response->model;
  const struct eo_oscillator *oscillator = &model->oscillator;
  double weight[2 * EO_READINGS][N] = {{0}}, step = 2 * M_PI * response->load->cycles /
                                                    (response->load->speed * response->load->pinion_teeth) /
                                                    response->steps;
  for (int reading = 0; reading < readings_of(response); reading++)
    for (int end = 0; end < oscillator->ends; end++)
      for (int k = 0; k < oscillator->n; k++)
        for (int i = 0; i < model->freedoms; i++)
          weight[reading_of(response, reading, end)][k] += model->reading[reading][end][i] *
                                                           model->basis[i * oscillator->n + k];
  if (!eo_long_motion_still(oscillator, oscillator->shift, response->still))
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "The lumped model has no place at rest.");
  return eo_long_motion_init(&response->motion, oscillator, response->load->parameters->mesh_damping, oscillator->shift,
                             step, readings_of(response) * oscillator->ends, (const double(*)[N])weight, error);
}

/* Share of the step about an instant that contact lasts, the margin taken as straight. */
static double contact_share(double margin, double moved)
{
  return moved > 0 ? fmin(fmax(0.5 + margin / moved, 0), 1) : margin > 0;
}

/* Force of a mesh with its damping, which acts for the share of the step that contact lasts. */
static double mesh_force(const struct response *response, int i, int end, double x, double v, double *contact)
{
  const double *row = response->row[end] + (size_t)i * ROWS;
  double c = response->load->parameters->mesh_damping, moved = fabs(v) * response->motion.step,
         force = response->law[end].nominal + row[1] * (x - row[0]); /* theory (L2) */
  *contact = 1;
  if (force > row[1] * moved)
    return force + c * v;
  struct eo_mesh_force of_law = eo_law_force(&response->law[end], row, x, 0);
  *contact = contact_share(of_law.margin, moved);
  return of_law.force + c * *contact * v;
}

/* Pushes where the meshes are: what their forces differ from constant stiffness and damping. */
static void find_pushes(struct response *response, int i, double *force)
{
  double c = response->load->parameters->mesh_damping, k = response->model.oscillator.shift;
  for (int end = 0; end < response->motion.ends; end++) {
    double x = response->deflection[end], v = response->rate[end];
    response->mesh_force[end] = mesh_force(response, i, end, x, v, &response->contact[end]);
    force[end] = k * x + c * v - response->mesh_force[end];
  }
}

/* Where pushes at the end of a step put the meshes: x and v with none there. */
static void place_meshes(struct response *response, const double x[2], const double v[2], const double force[2])
{
  const struct eo_long_motion *motion = &response->motion;
  for (int i = 0; i < motion->ends; i++) {
    response->deflection[i] = x[i] + response->still[i];
    response->rate[i] = v[i];
    for (int j = 0; j < motion->ends; j++) {
      response->deflection[i] += motion->gain[i][j] * force[j];
      response->rate[i] += motion->rate_gain[i][j] * force[j];
    }
  }
}

/* theory (P5): one step to instant i, exact but for the pushes, a parabola in it; those at its end follow from
   where the meshes are there, which they hardly change. */
static void take_step(struct response *response, int i)
{
  double next[2] = {2 * response->force[0] - response->before[0], 2 * response->force[1] - response->before[1]},
         x[2] = {0}, v[2] = {0};
  eo_long_motion_go(&response->motion, response->before, response->force, x, v);
  place_meshes(response, x, v, next);
  find_pushes(response, i, next);
  place_meshes(response, x, v, next);
  memcpy(response->before, response->force, sizeof response->before);
  find_pushes(response, i, response->force);
}

/* Accelerations at one instant, as the readings see them. */
static void keep_accelerations(struct response *response, int sample)
{
  for (int reading = 0; reading < readings_of(response); reading++)
    for (int end = 0; end < response->motion.ends; end++)
      response->acceleration[reading][end][sample] =
          eo_long_motion_read(&response->motion, reading_of(response, reading, end), response->before, response->force);
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

/* One period under observation, and how far its end is from its start, of the swing of the meshes. */
static double pass_period(struct response *response)
{
  double start[2][2], swing[2] = {0}, change[2] = {0};
  memcpy(start[0], response->deflection, sizeof start[0]);
  memcpy(start[1], response->rate, sizeof start[1]);
  memset(response->result->contact_loss, 0, sizeof response->result->contact_loss);
  memset(response->result->force_most, 0, sizeof response->result->force_most);
  for (int i = 1; i <= response->steps; i++) {
    take_step(response, i % response->steps);
    look(response, i % response->steps);
    for (int end = 0; end < response->motion.ends; end++) {
      swing[0] = fmax(swing[0], fabs(response->deflection[end] - start[0][end]));
      swing[1] = fmax(swing[1], fabs(response->rate[end] - start[1][end]));
    }
  }
  for (int end = 0; end < response->motion.ends; end++) {
    change[0] = fmax(change[0], fabs(response->deflection[end] - start[0][end]));
    change[1] = fmax(change[1], fabs(response->rate[end] - start[1][end]));
  }
  return fmax(swing[0] > 0 ? change[0] / swing[0] : 0, swing[1] > 0 ? change[1] / swing[1] : 0);
}

/* From rest through cycles before the period, then the period, until the motion comes back. */
static void march(struct response *response)
{
  static const double SETTLED = 1e-4; /* of the swing */
  struct eo_long_response *result = response->result;
  int lead = (int)fmin(response->steps, (double)response->steps / response->load->cycles * LEAD_CYCLES),
      first = (response->steps - lead) % response->steps;
  /* at rest where the teeth of mean stiffness stand at Z: a push of k Z - P */
  for (int end = 0; end < response->model.oscillator.ends; end++)
    response->force[end] = response->model.oscillator.shift * response->row[end][(size_t)first * ROWS] -
                           response->law[end].nominal;
  memcpy(response->before, response->force, sizeof response->before);
  eo_long_motion_rest(&response->motion, response->force);
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

/* Mean of the ends' RMS, reading by reading. */
static void read_levels(struct response *response)
{
  int ends = response->load->parameters->ends, n = response->samples;
  for (int reading = 0; reading < readings_of(response); reading++)
    for (int end = 0; end < ends; end++) {
      double level = eo_periodic_mean(n, response->acceleration[reading][end]),
             square = eo_dot(n, response->acceleration[reading][end], response->acceleration[reading][end]) / n;
      response->result->rms[reading] += sqrt(fmax(0, square - level * level)) / ends;
    }
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
    for (int i = 0; i < n && ends == 2; i++)
      mean[i] = (mean[i] + response->acceleration[reading][1][i]) / 2;
    result->acceleration[reading] = malloc(sizeof *line * (size_t)result->lines);
    code = result->acceleration[reading] ? eo_fft_spectrum(response->load->fft, n, mean, line, error)
                                         : eo_error_memory(error);
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
  read_levels(response);
  return response->load->levels_alone ? EO_OK : read_spectra(response, error);
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
