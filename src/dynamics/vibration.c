/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/vibration.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "dynamics/balance.h"
#include "dynamics/stability.h"
#include "dynamics/vibration_private.h"
#include "numerics/fourier.h"

enum { RESCUE_PERIODS = 60, RESCUE_SAMPLES = 256 };

static int make_arrays(struct eo_vibration_solver *solver)
{
  size_t n = 1 + solver->harmonics;
  solver->harmonic = calloc(n, sizeof *solver->harmonic);
  solver->x = calloc(2 * eo_fourier_terms(solver->harmonics), sizeof *solver->x);
  solver->motion[0] = calloc(2 * eo_fourier_terms(EO_MAX_HARMONICS), sizeof *solver->motion[0]);
  solver->spectrum.deflection[0] = calloc((4 + EO_MAX_FREEDOMS) * n, sizeof *solver->spectrum.freedom);
  if (!solver->harmonic || !solver->x || !solver->motion[0] || !solver->spectrum.deflection[0])
    return -1;
  solver->motion[1] = solver->motion[0] + eo_fourier_terms(EO_MAX_HARMONICS);
  solver->spectrum.deflection[1] = solver->spectrum.deflection[0] + n;
  solver->spectrum.force[0] = solver->spectrum.deflection[0] + 2 * n;
  solver->spectrum.force[1] = solver->spectrum.deflection[0] + 3 * n;
  solver->spectrum.freedom = solver->spectrum.deflection[0] + 4 * n;
  return 0;
}

enum eo_code eo_vibration_new(struct eo_vibration_solver **solver, int harmonics, int samples, struct eo_error *error)
{
  struct eo_balance *balance = NULL;
  enum eo_code code = eo_balance_new(&balance, harmonics, samples, error);
  if (code)
    return code;
  struct eo_vibration_solver *vibration_solver = calloc(1, sizeof *vibration_solver);
  if (!vibration_solver) {
    eo_balance_free(balance);
    return eo_error_memory(error);
  }
  vibration_solver->balance = balance;
  vibration_solver->harmonics = harmonics;
  if (make_arrays(vibration_solver)) {
    eo_vibration_free(vibration_solver);
    return eo_error_memory(error);
  }
  *solver = vibration_solver;
  return EO_OK;
}

void eo_vibration_free(struct eo_vibration_solver *solver)
{
  if (!solver)
    return;
  eo_balance_free(solver->balance);
  free(solver->harmonic);
  free(solver->x);
  free(solver->motion[0]);
  free(solver->spectrum.deflection[0]);
  free(solver);
}

enum eo_code eo_vibration_set_model(struct eo_vibration_solver *solver, const struct eo_dynamics_parameters *parameters,
                                    struct eo_error *error)
{
  struct eo_dynamics_model model;
  struct eo_dynamics_parameters but_damping = *parameters;
  enum eo_code code = eo_dynamics_parameters_check(parameters, error);
  if (code)
    return code;
  solver->solved = false;
  /* the mesh damping is part of the mesh force: a new value leaves everything else as it is */
  but_damping.mesh_damping = solver->model.parameters.mesh_damping;
  if (solver->model.freedoms && !memcmp(&but_damping, &solver->model.parameters, sizeof but_damping)) {
    solver->model.parameters.mesh_damping = parameters->mesh_damping;
    return EO_OK;
  }
  code = eo_dynamics_model_init(&model, parameters, error);
  if (code)
    return code;
  solver->model = model;
  solver->condensed_frequency = 0;
  return EO_OK;
}

const struct eo_dynamics_model *eo_vibration_model(const struct eo_vibration_solver *solver)
{
  return &solver->model;
}
const struct eo_spectrum *eo_vibration_spectrum(const struct eo_vibration_solver *solver)
{
  return &solver->spectrum;
}

static enum eo_code check_pulse(const struct eo_pulse *pulse, struct eo_error *error)
{
  if (!isfinite(pulse->amplitude) || !isfinite(pulse->start) ||
      (pulse->shape == EO_PULSE_HALF_SINE && !(pulse->duration > 0 && pulse->duration <= 1)))
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "An impact needs a finite force and a duration of up to one mesh period, not %g of it.",
                        pulse->duration);
  return EO_OK;
}

static enum eo_code check_case(const struct eo_vibration_solver *solver, const struct eo_vibration_case *load,
                               struct eo_error *error)
{
  if (!solver->model.freedoms)
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "The vibration solver has no model yet.");
  if (!(load->torque > 0 && isfinite(load->torque)))
    return eo_error_set(error, EO_ERROR_INPUT, "/load_cases/torque_Nm", "The torque must be positive, not %g N m.",
                        load->torque);
  if (!(load->speed > 0 && isfinite(load->speed)))
    return eo_error_set(error, EO_ERROR_INPUT, "/load_cases/speed_rpm", "The speed must be positive, not %g rad/s.",
                        load->speed);
  if (load->pinion_teeth < 1)
    return eo_error_set(error, EO_ERROR_INPUT, "/gear_pair/pinion_teeth", "A pinion cannot have %d teeth.",
                        load->pinion_teeth);
  if (!isfinite(load->phase_right) || load->axial_order < 0 || load->axial_order > EO_MAX_HARMONICS)
    return eo_error_set(error, EO_ERROR_INPUT, "", "Phases must be finite and the axial motion at most %d harmonics.",
                        EO_MAX_HARMONICS);
  enum eo_code code = EO_OK;
  for (int end = 0; end < solver->model.parameters.ends && !code; end++)
    if (!load->law[end] || load->law[end]->rows < 1)
      code = eo_error_set(error, EO_ERROR_NUMERIC, "", "The mesh law of end %d has not been set.", end + 1);
  for (int end = 0; end < solver->model.parameters.ends && !code; end++)
    code = load->impact == EO_IMPACT_NONE ? EO_OK : check_pulse(&load->pulse[end], error);
  return code;
}

enum eo_code eo_vibration_prepare(struct eo_vibration_solver *solver, const struct eo_vibration_case *load,
                                  struct eo_cycle *cycle, struct eo_error *error)
{
  enum eo_code code = check_case(solver, load, error);
  if (code)
    return code;
  eo_dynamics_model_load(&solver->model, load->torque, load->impact);
  *cycle = (struct eo_cycle){.frequency = load->speed * load->pinion_teeth,
                             .law = {load->law[0], load->law[1]},
                             .shift = {0, load->phase_right},
                             .mesh_damping = solver->model.parameters.mesh_damping,
                             .gated = load->gated};
  for (int end = 0; end < solver->model.parameters.ends; end++) {
    double sine = sin(eo_dynamics_base_helix_angle(&solver->model.parameters, end));
    if (load->impact != EO_IMPACT_NONE)
      cycle->pulse[end] = load->pulse[end];
    if (load->axial_order < 1)
      continue;
    /* the float is one motion of the whole pinion: its phase does not follow the stagger of the right end */
    for (int i = 0; i < eo_fourier_terms(load->axial_order); i++)
      solver->motion[end][i] = (end ? -sine : sine) * load->axial_motion[i];
    cycle->motion_order = load->axial_order;
    cycle->motion[end] = solver->motion[end];
  }
  return EO_OK;
}

/* The condensed oscillator depends on model, speed, kind of impact and (harmonic 0) torque. */
void eo_vibration_condense(struct eo_vibration_solver *solver, const struct eo_vibration_case *load, double frequency)
{
  bool same = solver->condensed_frequency == frequency && solver->condensed_impact == load->impact;
  if (!same)
    eo_condense(&solver->model.oscillator, frequency, solver->harmonics, false, solver->harmonic);
  else if (solver->condensed_torque != load->torque)
    eo_condense(&solver->model.oscillator, frequency, 0, false, solver->harmonic);
  solver->condensed_frequency = frequency;
  solver->condensed_impact = load->impact;
  solver->condensed_torque = load->torque;
}

/* Static state at the mean deflection of the law: the start of a time integration. */
void eo_vibration_static_state(const struct eo_vibration_solver *solver, const struct eo_cycle *cycle, double *state)
{
  const struct eo_oscillator *oscillator = &solver->model.oscillator;
  double complex force[2] = {0}, deflection[2] = {0}, impact[2] = {0}, response[EO_MAX_COORDINATES];
  double row[EO_MAX_LAW_ROWS];
  for (int end = 0; end < oscillator->ends; end++) {
    const struct eo_law *law = cycle->law[end];
    impact[end] = eo_pulse_harmonic(&cycle->pulse[end], cycle->frequency, 0, 0);
    double load = creal(solver->harmonic[0].load[end]);
    for (int j = 0; j < oscillator->ends; j++)
      load -= creal(solver->harmonic[0].transfer[end][j] * impact[j]);
    for (int i = 0; i < law->rows; i++)
      row[i] = law->series[(size_t)i * eo_fourier_terms(law->order)];
    force[end] = load;
    deflection[end] = eo_law_deflection(law, row, fmax(load, 0));
  }
  eo_condensed_response(oscillator, solver->harmonic, 0, force, deflection, impact, response);
  for (int i = 0; i < oscillator->n; i++) {
    state[i] = creal(response[i]);
    state[oscillator->n + i] = 0;
  }
}

void eo_vibration_spectrum_state(const struct eo_vibration_solver *solver, const struct eo_cycle *cycle, double *state)
{
  const struct eo_oscillator *oscillator = &solver->model.oscillator;
  memset(state, 0, sizeof *state * 2 * (size_t)oscillator->n);
  for (int k = 0; k <= solver->harmonics; k++) {
    double complex force[2] = {0}, deflection[2] = {0}, impact[2] = {0}, response[EO_MAX_COORDINATES];
    for (int end = 0; end < oscillator->ends; end++) {
      force[end] = solver->spectrum.force[end][k];
      deflection[end] = solver->spectrum.deflection[end][k] - eo_motion_harmonic(cycle, end, k);
      impact[end] = eo_pulse_harmonic(&cycle->pulse[end], cycle->frequency, cycle->shift[end], k);
    }
    eo_condensed_response(oscillator, solver->harmonic, k, force, deflection, impact, response);
    for (int i = 0; i < oscillator->n; i++) {
      state[i] += creal(response[i]);
      state[oscillator->n + i] += creal(I * k * cycle->frequency * response[i]);
    }
  }
}

/* A few dozen periods of time integration lead Newton to a stable periodic state if there is one. */
static enum eo_code rescue(struct eo_vibration_solver *solver, const struct eo_cycle *cycle,
                           struct eo_balance_report *report, struct eo_error *error)
{
  struct eo_integration run;
  double state[2 * EO_MAX_COORDINATES];
  struct eo_error reason;
  const struct eo_oscillator *oscillator = &solver->model.oscillator;
  const struct eo_integration_options options = {1e-6, 1e-6, RESCUE_PERIODS, RESCUE_SAMPLES, 1};
  enum eo_code code = eo_vibration_make_run(&run, oscillator, RESCUE_SAMPLES, error);
  if (code)
    return code;
  eo_vibration_static_state(solver, cycle, state);
  /* an integration that cannot go on leaves the case not converged: an outcome */
  if (eo_integrate(oscillator, cycle, &options, state, &run, NULL, &reason) == EO_OK) {
    int order = solver->harmonics < RESCUE_SAMPLES / 2 ? solver->harmonics : RESCUE_SAMPLES / 2 - 1,
        terms = eo_fourier_terms(solver->harmonics);
    double sample[RESCUE_SAMPLES];
    memset(solver->x, 0, sizeof *solver->x * 2 * terms);
    for (int end = 0; end < oscillator->ends; end++) {
      for (int i = 0; i < RESCUE_SAMPLES; i++)
        sample[i] = run.mesh[2 * i + end].deflection;
      eo_fourier_series(RESCUE_SAMPLES, sample, order, solver->x + end * terms);
    }
    code = eo_balance_solve(solver->balance, oscillator, solver->harmonic, cycle, true, solver->x, report, error);
  }
  eo_vibration_free_run(&run);
  return code;
}

enum eo_code eo_vibration_solve(struct eo_vibration_solver *solver, const struct eo_vibration_case *load,
                                enum eo_vibration_start start, struct eo_vibration *result, struct eo_error *error)
{
  struct eo_cycle cycle;
  struct eo_balance_report report;
  enum eo_code code = eo_vibration_prepare(solver, load, &cycle, error);
  if (code)
    return code;
  eo_vibration_condense(solver, load, cycle.frequency);
  bool warm = start == EO_START_WARM && solver->solved;
  code = eo_balance_solve(solver->balance, &solver->model.oscillator, solver->harmonic, &cycle, warm, solver->x,
                          &report, error);
  if (!code && !report.converged && !warm)
    code = rescue(solver, &cycle, &report, error);
  if (code)
    return code;
  solver->solved = report.converged;
  eo_vibration_read_balance(solver, load, &cycle, &report, result);
  return EO_OK;
}

enum eo_code eo_vibration_integrate(struct eo_vibration_solver *solver, const struct eo_vibration_case *load,
                                    const struct eo_integration_options *options, struct eo_vibration *result,
                                    const struct eo_progress *progress, struct eo_error *error)
{
  struct eo_cycle cycle;
  struct eo_integration run;
  double state[2 * EO_MAX_COORDINATES];
  enum eo_code code = eo_vibration_prepare(solver, load, &cycle, error);
  if (code)
    return code;
  if (!options)
    options = &eo_integration_defaults;
  if (options->samples <= 2 * solver->harmonics)
    return eo_error_set(error, EO_ERROR_INPUT, "/resolution/harmonics",
                        "%d samples of a period cannot carry %d harmonics.", options->samples, solver->harmonics);
  if ((code = eo_vibration_make_run(&run, &solver->model.oscillator, options->samples * options->max_repeat, error)))
    return code;
  eo_vibration_condense(solver, load, cycle.frequency);
  eo_vibration_static_state(solver, &cycle, state);
  solver->solved = false;
  code = eo_integrate(&solver->model.oscillator, &cycle, options, state, &run, progress, error);
  if (!code)
    code = eo_vibration_read_run(solver, load, &cycle, &run, options->samples, result, error);
  eo_vibration_free_run(&run);
  return code;
}

enum eo_code eo_vibration_stability(struct eo_vibration_solver *solver, const struct eo_vibration_case *load,
                                    double complex *multiplier, struct eo_error *error)
{
  struct eo_cycle cycle;
  if (!solver->solved)
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "There is no periodic state whose stability could be judged.");
  enum eo_code code = eo_vibration_prepare(solver, load, &cycle, error);
  return code ? code : eo_floquet(&solver->model.oscillator, &cycle, solver->harmonics, solver->x, multiplier, error);
}
