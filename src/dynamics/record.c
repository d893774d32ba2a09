/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A period recorded by time integration, brought into the same spectrum and result as the harmonic balance. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "dynamics/vibration_private.h"
#include "numerics/dense.h"
#include "numerics/fourier.h"

enum eo_code eo_vibration_make_run(struct eo_integration *run, const struct eo_oscillator *oscillator, int samples,
                                   struct eo_error *error)
{
  *run = (struct eo_integration){0};
  run->acceleration = calloc((size_t)samples * oscillator->n, sizeof *run->acceleration);
  run->mesh = calloc((size_t)samples * 2, sizeof *run->mesh);
  if (run->acceleration && run->mesh)
    return EO_OK;
  eo_vibration_free_run(run);
  return eo_error_memory(error);
}

void eo_vibration_free_run(struct eo_integration *run)
{
  free(run->acceleration);
  free(run->mesh);
}

/* The recorded meshes on a time grid like the harmonic balance's, and their deflections as series: of the mesh periods
   first..last, phase by phase their mean. */
static void fill_grid(const struct eo_cycle *cycle, const struct eo_integration *run, int ends, int first, int last,
                      struct eo_alternating *grid, double *x)
{
  for (int end = 0; end < ends; end++) {
    struct eo_time_end *time_end = &grid->end[end];
    double share = 1.0 / (last - first + 1);
    for (int i = 0; i < grid->samples; i++) {
      struct eo_mesh_state mesh_state = {0};
      for (int period = first; period <= last; period++) {
        const struct eo_mesh_state *at = &run->mesh[2 * (period * grid->samples + i) + end];
        mesh_state.deflection += share * at->deflection;
        mesh_state.rate += share * at->rate;
        mesh_state.force += share * at->force;
        mesh_state.elastic += share * at->elastic;
        mesh_state.margin += share * at->margin;
        mesh_state.margin_slope = at->margin_slope;
      }
      time_end->x[i] = mesh_state.deflection;
      time_end->v[i] = mesh_state.rate;
      time_end->force[i] = mesh_state.force;
      time_end->elastic[i] = mesh_state.elastic;
      time_end->margin[i] = mesh_state.margin;
      time_end->margin_slope[i] = mesh_state.margin_slope;
    }
    eo_alternating_gate(grid, end, cycle->gated);
    eo_alternating_transform(grid, eo_fourier_terms(grid->harmonics), time_end->x,
                             x + end * eo_fourier_terms(grid->harmonics));
  }
}

/* RMS straight from the time history of the accelerations, no harmonic left out. */
static void read_rms(const struct eo_vibration_solver *solver, const struct eo_cycle *cycle,
                     const struct eo_integration *run, int samples, struct eo_vibration *result)
{
  const struct eo_dynamics_model *model = &solver->model;
  int ends = model->oscillator.ends;
  double sum[EO_READINGS][3] = {0}, square[EO_READINGS][3] = {0}; /* left, right, mean of both */
  for (int i = 0; i < samples; i++) {
    double q[EO_MAX_FREEDOMS], phase = (double)i * run->repeat / samples;
    eo_dense_multiply(model->freedoms, model->oscillator.n, model->basis,
                      run->acceleration + (size_t)i * model->oscillator.n, q);
    for (int reading = 0; reading < EO_READINGS; reading++) {
      double value[3] = {0};
      for (int end = 0; end < ends; end++) {
        value[end] = reading == EO_READING_NORMAL ? eo_motion_acceleration(cycle, end, phase) : 0;
        for (int f = 0; f < model->freedoms; f++)
          value[end] += model->reading[reading][end][f] * q[f];
        value[2] += value[end] / ends;
      }
      for (int c = 0; c < 3; c++) {
        sum[reading][c] += value[c] / samples;
        square[reading][c] += value[c] * value[c] / samples;
      }
    }
  }
  for (int reading = 0; reading < EO_READINGS; reading++) {
    double rms[3];
    for (int c = 0; c < 3; c++)
      rms[c] = sqrt(fmax(0, square[reading][c] - sum[reading][c] * sum[reading][c]));
    result->rms[reading][0] = rms[0];
    result->rms[reading][1] = ends == 2 ? rms[1] : 0;
    result->rms_pair[reading] = ends == 2 ? (rms[0] + rms[1]) / 2 : rms[0];
    result->rms_of_mean[reading] = rms[2];
  }
}

/* What the mean over several mesh periods hides: extremes, contact and power of each of them. */
static void merge_periods(const struct eo_vibration *period, int repeat, struct eo_vibration *result)
{
  result->power_supplied = result->power_dissipated = 0;
  for (int end = 0; end < result->ends; end++) {
    result->contact_loss[end] = 0;
    result->force_min[end] = INFINITY;
    result->force_max[end] = -INFINITY;
    result->dynamic_factor[end] = -INFINITY;
    result->deflection_swing[end] = 0;
  }
  for (int i = 0; i < repeat; i++) {
    const struct eo_vibration *vibration = &period[i];
    result->back_contact = result->back_contact || vibration->back_contact;
    result->power_supplied += vibration->power_supplied / repeat;
    result->power_dissipated += vibration->power_dissipated / repeat;
    for (int end = 0; end < result->ends; end++) {
      result->contact_loss[end] += vibration->contact_loss[end] / repeat;
      result->force_min[end] = fmin(result->force_min[end], vibration->force_min[end]);
      result->force_max[end] = fmax(result->force_max[end], vibration->force_max[end]);
      result->dynamic_factor[end] = fmax(result->dynamic_factor[end], vibration->dynamic_factor[end]);
      result->deflection_swing[end] = fmax(result->deflection_swing[end], vibration->deflection_swing[end]);
      if (vibration->contact_loss[end] > 0)
        result->outcome = EO_VIBRATION_CONTACT_LOST;
    }
    for (int member = 0; member < 2; member++)
      for (int end = 0; end < result->ends; end++)
        result->bearing_force_max[member][end] = fmax(result->bearing_force_max[member][end],
                                                      vibration->bearing_force_max[member][end]);
  }
}

enum eo_code eo_vibration_read_run(struct eo_vibration_solver *solver, const struct eo_vibration_case *load,
                                   const struct eo_cycle *cycle, const struct eo_integration *run, int samples,
                                   struct eo_vibration *result, struct eo_error *error)
{
  struct eo_alternating *grid = NULL;
  enum eo_code code = eo_alternating_new(&grid, solver->harmonics, samples, error);
  if (code)
    return code;
  struct eo_vibration period[4];
  const struct eo_balance_report report = {
      .converged = run->periodic, .residual = run->change, .grid = grid, .ends = solver->model.parameters.ends};
  for (int i = 0; i < run->repeat && run->repeat > 1; i++) {
    fill_grid(cycle, run, solver->model.parameters.ends, i, i, grid, solver->x);
    eo_vibration_read_balance(solver, load, cycle, &report, &period[i]);
  }
  fill_grid(cycle, run, solver->model.parameters.ends, 0, run->repeat - 1, grid, solver->x);
  eo_vibration_read_balance(solver, load, cycle, &report, result);
  if (run->periodic && run->repeat > 1)
    merge_periods(period, run->repeat, result);
  result->periods = run->periods;
  result->repeat = run->repeat;
  if (run->periodic)
    read_rms(solver, cycle, run, samples * run->repeat, result);
  eo_alternating_free(grid);
  return EO_OK;
}
