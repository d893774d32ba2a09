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

static int make_arrays(struct eo_vibration_solver *s)
{
  size_t n = 1 + s->harmonics;
  s->harmonic = calloc(n, sizeof *s->harmonic);
  s->x = calloc(2 * eo_fourier_terms(s->harmonics), sizeof *s->x);
  s->motion[0] = calloc(2 * eo_fourier_terms(EO_MAX_HARMONICS), sizeof *s->motion[0]);
  s->spectrum.deflection[0] = calloc((4 + EO_MAX_FREEDOMS) * n, sizeof *s->spectrum.freedom);
  if (!s->harmonic || !s->x || !s->motion[0] || !s->spectrum.deflection[0])
    return -1;
  s->motion[1] = s->motion[0] + eo_fourier_terms(EO_MAX_HARMONICS);
  s->spectrum.deflection[1] = s->spectrum.deflection[0] + n;
  s->spectrum.force[0] = s->spectrum.deflection[0] + 2 * n;
  s->spectrum.force[1] = s->spectrum.deflection[0] + 3 * n;
  s->spectrum.freedom = s->spectrum.deflection[0] + 4 * n;
  return 0;
}

enum eo_code eo_vibration_new(struct eo_vibration_solver **solver, int harmonics, int samples, struct eo_error *error)
{
  struct eo_balance *balance = NULL;
  enum eo_code code = eo_balance_new(&balance, harmonics, samples, error);
  if (code)
    return code;
  struct eo_vibration_solver *s = calloc(1, sizeof *s);
  if (!s) {
    eo_balance_free(balance);
    return eo_error_memory(error);
  }
  s->balance = balance;
  s->harmonics = harmonics;
  if (make_arrays(s)) {
    eo_vibration_free(s);
    return eo_error_memory(error);
  }
  *solver = s;
  return EO_OK;
}

void eo_vibration_free(struct eo_vibration_solver *s)
{
  if (!s)
    return;
  eo_balance_free(s->balance);
  free(s->harmonic);
  free(s->x);
  free(s->motion[0]);
  free(s->spectrum.deflection[0]);
  free(s);
}

enum eo_code eo_vibration_set_model(struct eo_vibration_solver *s, const struct eo_dynamics_parameters *parameters,
                                    struct eo_error *error)
{
  struct eo_dynamics_model model;
  struct eo_dynamics_parameters but_damping = *parameters;
  enum eo_code code = eo_dynamics_parameters_check(parameters, error);
  if (code)
    return code;
  s->solved = false;
  /* the mesh damping is part of the mesh force: a new value leaves everything else as it is */
  but_damping.mesh_damping = s->model.parameters.mesh_damping;
  if (s->model.freedoms && !memcmp(&but_damping, &s->model.parameters, sizeof but_damping)) {
    s->model.parameters.mesh_damping = parameters->mesh_damping;
    return EO_OK;
  }
  code = eo_dynamics_model_init(&model, parameters, error);
  if (code)
    return code;
  s->model = model;
  s->condensed_frequency = 0;
  return EO_OK;
}

const struct eo_dynamics_model *eo_vibration_model(const struct eo_vibration_solver *s)
{
  return &s->model;
}
const struct eo_spectrum *eo_vibration_spectrum(const struct eo_vibration_solver *s)
{
  return &s->spectrum;
}

static enum eo_code check_pulse(const struct eo_pulse *p, struct eo_error *error)
{
  if (!isfinite(p->amplitude) || !isfinite(p->start) ||
      (p->shape == EO_PULSE_HALF_SINE && !(p->duration > 0 && p->duration <= 1)))
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "An impact needs a finite force and a duration of up to one mesh period, not %g of it.",
                        p->duration);
  return EO_OK;
}

static enum eo_code check_case(const struct eo_vibration_solver *s, const struct eo_vibration_case *load,
                               struct eo_error *error)
{
  if (!s->model.freedoms)
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
  for (int end = 0; end < s->model.parameters.ends && !code; end++)
    if (!load->law[end] || load->law[end]->rows < 1)
      code = eo_error_set(error, EO_ERROR_NUMERIC, "", "The mesh law of end %d has not been set.", end + 1);
  for (int end = 0; end < s->model.parameters.ends && !code; end++)
    code = load->impact == EO_IMPACT_NONE ? EO_OK : check_pulse(&load->pulse[end], error);
  return code;
}

enum eo_code eo_vibration_prepare(struct eo_vibration_solver *s, const struct eo_vibration_case *load,
                                  struct eo_cycle *cycle, struct eo_error *error)
{
  enum eo_code code = check_case(s, load, error);
  if (code)
    return code;
  eo_dynamics_model_load(&s->model, load->torque, load->impact);
  *cycle = (struct eo_cycle){.frequency = load->speed * load->pinion_teeth,
                             .law = {load->law[0], load->law[1]},
                             .shift = {0, load->phase_right},
                             .mesh_damping = s->model.parameters.mesh_damping,
                             .gated = load->gated};
  double sine = sin(s->model.parameters.base_helix_angle);
  for (int end = 0; end < s->model.parameters.ends; end++) {
    if (load->impact != EO_IMPACT_NONE)
      cycle->pulse[end] = load->pulse[end];
    if (load->axial_order < 1)
      continue;
    /* the float is one motion of the whole pinion: its phase does not follow the stagger of the right end */
    for (int i = 0; i < eo_fourier_terms(load->axial_order); i++)
      s->motion[end][i] = (end ? -sine : sine) * load->axial_motion[i];
    cycle->motion_order = load->axial_order;
    cycle->motion[end] = s->motion[end];
  }
  return EO_OK;
}

/* The condensed oscillator depends on model, speed, kind of impact and (harmonic 0) torque. */
void eo_vibration_condense(struct eo_vibration_solver *s, const struct eo_vibration_case *load, double frequency)
{
  bool same = s->condensed_frequency == frequency && s->condensed_impact == load->impact;
  if (!same)
    eo_condense(&s->model.oscillator, frequency, s->harmonics, false, s->harmonic);
  else if (s->condensed_torque != load->torque)
    eo_condense(&s->model.oscillator, frequency, 0, false, s->harmonic);
  s->condensed_frequency = frequency;
  s->condensed_impact = load->impact;
  s->condensed_torque = load->torque;
}

/* Static state at the mean deflection of the law: the start of a time integration. */
void eo_vibration_static_state(const struct eo_vibration_solver *s, const struct eo_cycle *cycle, double *state)
{
  const struct eo_oscillator *o = &s->model.oscillator;
  double complex force[2] = {0}, deflection[2] = {0}, impact[2] = {0}, response[EO_MAX_COORDINATES];
  double row[EO_MAX_LAW_ROWS];
  for (int end = 0; end < o->ends; end++) {
    const struct eo_law *law = cycle->law[end];
    impact[end] = eo_pulse_harmonic(&cycle->pulse[end], cycle->frequency, 0, 0);
    double load = creal(s->harmonic[0].load[end]);
    for (int j = 0; j < o->ends; j++)
      load -= creal(s->harmonic[0].transfer[end][j] * impact[j]);
    for (int i = 0; i < law->rows; i++)
      row[i] = law->series[(size_t)i * eo_fourier_terms(law->order)];
    force[end] = load;
    deflection[end] = eo_law_deflection(law, row, fmax(load, 0));
  }
  eo_condensed_response(o, s->harmonic, 0, force, deflection, impact, response);
  for (int i = 0; i < o->n; i++) {
    state[i] = creal(response[i]);
    state[o->n + i] = 0;
  }
}

void eo_vibration_spectrum_state(const struct eo_vibration_solver *s, const struct eo_cycle *cycle, double *state)
{
  const struct eo_oscillator *o = &s->model.oscillator;
  memset(state, 0, sizeof *state * 2 * (size_t)o->n);
  for (int k = 0; k <= s->harmonics; k++) {
    double complex force[2] = {0}, deflection[2] = {0}, impact[2] = {0}, response[EO_MAX_COORDINATES];
    for (int end = 0; end < o->ends; end++) {
      force[end] = s->spectrum.force[end][k];
      deflection[end] = s->spectrum.deflection[end][k] - eo_motion_harmonic(cycle, end, k);
      impact[end] = eo_pulse_harmonic(&cycle->pulse[end], cycle->frequency, cycle->shift[end], k);
    }
    eo_condensed_response(o, s->harmonic, k, force, deflection, impact, response);
    for (int i = 0; i < o->n; i++) {
      state[i] += creal(response[i]);
      state[o->n + i] += creal(I * k * cycle->frequency * response[i]);
    }
  }
}

/* A few dozen periods of time integration lead Newton to a stable periodic state if there is one. */
static enum eo_code rescue(struct eo_vibration_solver *s, const struct eo_cycle *cycle,
                           struct eo_balance_report *report, struct eo_error *error)
{
  struct eo_integration run;
  double state[2 * EO_MAX_COORDINATES];
  struct eo_error reason;
  const struct eo_oscillator *o = &s->model.oscillator;
  const struct eo_integration_options options = {1e-6, 1e-6, RESCUE_PERIODS, RESCUE_SAMPLES, 1};
  enum eo_code code = eo_vibration_make_run(&run, o, RESCUE_SAMPLES, error);
  if (code)
    return code;
  eo_vibration_static_state(s, cycle, state);
  /* an integration that cannot go on leaves the case not converged: an outcome */
  if (eo_integrate(o, cycle, &options, state, &run, NULL, &reason) == EO_OK) {
    int order = s->harmonics < RESCUE_SAMPLES / 2 ? s->harmonics : RESCUE_SAMPLES / 2 - 1,
        terms = eo_fourier_terms(s->harmonics);
    double sample[RESCUE_SAMPLES];
    memset(s->x, 0, sizeof *s->x * 2 * terms);
    for (int end = 0; end < o->ends; end++) {
      for (int i = 0; i < RESCUE_SAMPLES; i++)
        sample[i] = run.mesh[2 * i + end].deflection;
      eo_fourier_series(RESCUE_SAMPLES, sample, order, s->x + end * terms);
    }
    code = eo_balance_solve(s->balance, o, s->harmonic, cycle, true, s->x, report, error);
  }
  eo_vibration_free_run(&run);
  return code;
}

enum eo_code eo_vibration_solve(struct eo_vibration_solver *s, const struct eo_vibration_case *load,
                                enum eo_vibration_start start, struct eo_vibration *result, struct eo_error *error)
{
  struct eo_cycle cycle;
  struct eo_balance_report report;
  enum eo_code code = eo_vibration_prepare(s, load, &cycle, error);
  if (code)
    return code;
  eo_vibration_condense(s, load, cycle.frequency);
  bool warm = start == EO_START_WARM && s->solved;
  code = eo_balance_solve(s->balance, &s->model.oscillator, s->harmonic, &cycle, warm, s->x, &report, error);
  if (!code && !report.converged && !warm)
    code = rescue(s, &cycle, &report, error);
  if (code)
    return code;
  s->solved = report.converged;
  eo_vibration_read_balance(s, load, &cycle, &report, result);
  return EO_OK;
}

enum eo_code eo_vibration_integrate(struct eo_vibration_solver *s, const struct eo_vibration_case *load,
                                    const struct eo_integration_options *options, struct eo_vibration *result,
                                    const struct eo_progress *progress, struct eo_error *error)
{
  struct eo_cycle cycle;
  struct eo_integration run;
  double state[2 * EO_MAX_COORDINATES];
  enum eo_code code = eo_vibration_prepare(s, load, &cycle, error);
  if (code)
    return code;
  if (!options)
    options = &eo_integration_defaults;
  if (options->samples <= 2 * s->harmonics)
    return eo_error_set(error, EO_ERROR_INPUT, "/resolution/harmonics",
                        "%d samples of a period cannot carry %d harmonics.", options->samples, s->harmonics);
  if ((code = eo_vibration_make_run(&run, &s->model.oscillator, options->samples * options->max_repeat, error)))
    return code;
  eo_vibration_condense(s, load, cycle.frequency);
  eo_vibration_static_state(s, &cycle, state);
  s->solved = false;
  code = eo_integrate(&s->model.oscillator, &cycle, options, state, &run, progress, error);
  if (!code)
    code = eo_vibration_read_run(s, load, &cycle, &run, options->samples, result, error);
  eo_vibration_free_run(&run);
  return code;
}

enum eo_code eo_vibration_stability(struct eo_vibration_solver *s, const struct eo_vibration_case *load,
                                    double complex *multiplier, struct eo_error *error)
{
  struct eo_cycle cycle;
  if (!s->solved)
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "There is no periodic state whose stability could be judged.");
  enum eo_code code = eo_vibration_prepare(s, load, &cycle, error);
  return code ? code : eo_floquet(&s->model.oscillator, &cycle, s->harmonics, s->x, multiplier, error);
}
