/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The stable states of a load case: where teeth separate, the state that the harmonic balance finds may be one of
   several, or one that no motion keeps to. */
#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "dynamics/march.h"
#include "dynamics/stability.h"
#include "dynamics/vibration_private.h"

enum {
  PERIODS = 100,
  MOST_PERIODS = 1500,
  LEAST_MARCHED = 1000,
  MOST_MARCHED = 2000,
  LEAST_SAMPLES = 1024,
  MAX_REPEAT = 4,
  STEPS = 3
};
/* Two states by time integration whose RMS differ by less are taken for the same, and one by harmonic balance is taken
   for one of them when all that is read off it agrees so nearly: it leaves the highest harmonics out. */
static const double same_state = 1e-3, alike = 0.03;
/* A motion that comes back as nearly as this after some hundred periods is on its way, if slowly; others never settle.
 */
static const double on_its_way = 0.02;
/* By equal steps, which are cheap, it has longer, and near doublings of the period it needs longer. */
static const double ever_settling = 0.1, step_angle = 0.15;
/* Change over a period that the integration itself makes where contact comes and goes many times. */
static const double noise = 1e-4;
/* Contact comes and goes many times a period; what is found is good for four digits. */
static const double relative_tolerance = 1e-7, settled = 1e-5;
/* Share of the velocities by which an unstable state is disturbed before it is left to itself. */
static const double nudge = 1e-2;
/* Multipliers within this of 1 belong to folds and doublings themselves: neither side can be told. */
static const double margin = 1e-6;

/* A search under way; run[kept] holds the loudest state, the other is free. */
struct search {
  struct eo_vibration_solver *solver;
  const struct eo_vibration_case *load;
  struct eo_cycle cycle;
  struct eo_integration run[2];
  int samples, kept;
  struct eo_vibration best;
  int states;
  struct eo_vibration_state state[EO_MAX_STATES];
  struct eo_vibration seen[EO_MAX_STATES + STEPS]; /* states, stable or not, that need not be looked at again */
  int count;
  int periods;
};

static double largest_multiplier(struct search *search, struct eo_error *error, enum eo_code *code)
{
  double complex multiplier[2 * EO_MAX_COORDINATES];
  const struct eo_oscillator *oscillator = &search->solver->model.oscillator;
  *code = eo_floquet(oscillator, &search->cycle, search->solver->harmonics, search->solver->x, multiplier, error);
  if (*code == EO_ERROR_NUMERIC) { /* at a speed too low for the stiffness every disturbance dies within a period */
    *code = EO_OK;
    return NAN;
  }
  return *code ? NAN : cabs(multiplier[0]);
}

static double worse_loss(const struct eo_vibration *vibration)
{
  return vibration->ends == 2 ? fmax(vibration->contact_loss[0], vibration->contact_loss[1])
                              : vibration->contact_loss[0];
}

/* Lists a state unless it is known; returns whether it is now the loudest. */
static bool note_state(struct search *search, const struct eo_vibration *vibration)
{
  const struct eo_vibration_state found = {.repeat = vibration->repeat,
                                           .rms = {vibration->rms_pair[EO_READING_NORMAL],
                                                   vibration->rms_pair[EO_READING_TRANSVERSE],
                                                   vibration->rms_pair[EO_READING_ROTATIONAL]},
                                           .contact_loss = worse_loss(vibration),
                                           .multiplier = vibration->multiplier};
  int at = search->states;
  for (int i = 0; i < search->states; i++)
    if (fabs(search->state[i].rms[0] - found.rms[0]) <= same_state * found.rms[0])
      return false;
  search->seen[search->count++] = *vibration;
  if (search->states == EO_MAX_STATES)
    return false;
  while (at > 0 && search->state[at - 1].rms[0] < found.rms[0]) {
    search->state[at] = search->state[at - 1];
    at--;
  }
  search->state[at] = found;
  search->states++;
  return at == 0;
}

static bool near_to(double a, double b, double share)
{
  return fabs(a - b) <= share * fmax(fabs(a), fabs(b));
}

/* Whether a state by harmonic balance is one of those seen. */
static bool is_known(const struct search *search, const struct eo_vibration *vibration)
{
  bool known = false;
  for (int i = 0; i < search->count && !known; i++) {
    const struct eo_vibration *this_vibration = &search->seen[i];
    known = this_vibration->repeat == vibration->repeat;
    for (int end = 0; end < vibration->ends; end++) {
      known = known && near_to(this_vibration->deflection_swing[end], vibration->deflection_swing[end], alike);
      for (int reading = 0; reading < EO_READINGS; reading++)
        known = known && near_to(this_vibration->rms[reading][end], vibration->rms[reading][end], alike);
    }
  }
  return known;
}

/* By equal steps as long as the motion seems to settle, which takes the transient off it; from there time integration
   as long as it comes nearer to repeating, or until it is lost in the integration's own noise where the steps repeat.
   Where these would be too many, at low speeds, motions settle within a few periods anyway. */
static enum eo_code integrate_from(struct search *search, const double *start, struct eo_integration *run,
                                   struct eo_error *error)
{
  const struct eo_march_options march = {step_angle, settled, MAX_REPEAT, MOST_MARCHED, LEAST_MARCHED, ever_settling};
  const struct eo_integration_options options = {relative_tolerance, settled, PERIODS, search->samples, MAX_REPEAT};
  struct eo_march found = {.periodic = false};
  struct eo_error reason;
  double state[2 * EO_MAX_COORDINATES];
  enum eo_code code = eo_march(&search->solver->model.oscillator, &search->cycle, &march, start, &found, &reason);
  run->periodic = false;
  search->periods += found.periods;
  if (code == EO_ERROR_MEMORY)
    return eo_error_memory(error);
  if (!code && found.change > ever_settling)
    return EO_OK;
  memcpy(state, code ? start : found.state, sizeof *state * 2 * (size_t)search->solver->model.oscillator.n);
  code = EO_OK;
  for (int periods = 0; !code && !run->periodic && periods < MOST_PERIODS; periods += run->periods) {
    code = eo_integrate(&search->solver->model.oscillator, &search->cycle, &options, state, run, NULL, error);
    memcpy(state, run->state, sizeof state);
    if (code)
      return code;
    search->periods += run->periods;
    if (!run->periodic && run->change > on_its_way)
      break;
    run->periodic = run->periodic || (found.periodic && found.repeat == 1 && run->change <= noise);
  }
  return code;
}

/* Time integration from a state to where the motion repeats, if it does. */
static enum eo_code follow_from(struct search *search, const double *start, struct eo_error *error)
{
  struct eo_vibration_solver *solver = search->solver;
  struct eo_integration *run = &search->run[1 - search->kept];
  struct eo_vibration found;
  struct eo_error reason;
  enum eo_code code = integrate_from(search, start, run, &reason);
  if (code == EO_ERROR_NUMERIC)
    return EO_OK; /* an integration that cannot go on finds no state */
  if (code || !run->periodic)
    return code;
  code = eo_vibration_read_run(solver, search->load, &search->cycle, run, search->samples, &found, error);
  if (!code && found.repeat == 1)
    found.multiplier = largest_multiplier(search, error, &code);
  if (code)
    return code;
  if (note_state(search, &found)) {
    search->best = found;
    search->kept = 1 - search->kept;
  }
  return EO_OK;
}

/* From the state of the harmonic balance that the solver holds, unless that is known. */
static enum eo_code follow_balance(struct search *search, const struct eo_vibration *balance, bool stable,
                                   struct eo_error *error)
{
  double state[2 * EO_MAX_COORDINATES];
  int n = search->solver->model.oscillator.n;
  if (is_known(search, balance))
    return EO_OK;
  search->seen[search->count++] = *balance;
  eo_vibration_spectrum_state(search->solver, &search->cycle, state);
  for (int i = 0; i < n && !stable; i++)
    state[n + i] *= 1 + nudge;
  return follow_from(search, state, error);
}

static enum eo_code follow_static(struct search *search, struct eo_error *error)
{
  double state[2 * EO_MAX_COORDINATES];
  eo_vibration_condense(search->solver, search->load, search->cycle.frequency);
  eo_vibration_static_state(search->solver, &search->cycle, state);
  return follow_from(search, state, error);
}

/* The harmonic balance led to this speed from below (direction -1: the speed comes up) or above. */
static enum eo_code follow_speed(struct search *search, int direction, struct eo_error *error)
{
  static const double away[STEPS] = {0.08, 0.04, 0};
  struct eo_vibration_case at = *search->load;
  struct eo_vibration balance = {.outcome = EO_VIBRATION_CONVERGED};
  enum eo_code code = EO_OK;
  for (int i = 0; i < STEPS && !code && balance.outcome != EO_VIBRATION_NOT_CONVERGED; i++) {
    at.speed = search->load->speed * (1 + direction * away[i]);
    code = eo_vibration_solve(search->solver, &at, i ? EO_START_WARM : EO_START_COLD, &balance, error);
  }
  if (code || balance.outcome == EO_VIBRATION_NOT_CONVERGED || is_known(search, &balance))
    return code;
  double multiplier = largest_multiplier(search, error, &code);
  return code || multiplier > 1 + margin ? code : follow_balance(search, &balance, true, error);
}

static enum eo_code begin_search(struct search *search, struct eo_vibration_solver *solver,
                                 const struct eo_vibration_case *load, struct eo_error *error)
{
  *search = (struct search){.solver = solver, .load = load, .samples = LEAST_SAMPLES};
  while (search->samples < 4 * solver->harmonics)
    search->samples *= 2;
  enum eo_code code = eo_vibration_prepare(solver, load, &search->cycle, error);
  for (int i = 0; i < 2 && !code; i++)
    code = eo_vibration_make_run(&search->run[i], &solver->model.oscillator, search->samples * MAX_REPEAT, error);
  return code;
}

/* The loudest state once more, so that spectrum and orders are its own. */
static enum eo_code end_search(struct search *search, double unstable, struct eo_vibration *result,
                               struct eo_error *error)
{
  enum eo_code code = EO_OK;
  int ends = search->solver->model.parameters.ends;
  if (search->states == 0) {
    *result = (struct eo_vibration){.outcome = EO_VIBRATION_NOT_CONVERGED,
                                    .ends = ends,
                                    .harmonics = search->solver->harmonics,
                                    .frequency = search->cycle.frequency,
                                    .multiplier = NAN};
  } else {
    eo_vibration_condense(search->solver, search->load, search->cycle.frequency);
    code = eo_vibration_read_run(search->solver, search->load, &search->cycle, &search->run[search->kept],
                                 search->samples, result, error);
    result->multiplier = search->best.multiplier;
  }
  result->periods = search->periods;
  result->unstable = unstable;
  result->states = search->states;
  memcpy(result->state, search->state, sizeof result->state);
  search->solver->solved = !code && search->states > 0 && result->repeat == 1;
  return code;
}

static void free_search(struct search *search)
{
  eo_vibration_free_run(&search->run[0]);
  eo_vibration_free_run(&search->run[1]);
}

/* The state of the harmonic balance, as far as there is one, then time integration from the other starts. A stable
   state is taken up last, since the static start mostly leads to it. */
static enum eo_code search_from(struct search *search, const struct eo_vibration *found, double *unstable,
                                struct eo_error *error)
{
  bool balanced = found->outcome != EO_VIBRATION_NOT_CONVERGED;
  if (balanced) {
    enum eo_code code = EO_OK;
    double multiplier = largest_multiplier(search, error, &code);
    EO_TRY(code);
    *unstable = multiplier > 1 + margin ? multiplier : 0;
  }
  if (balanced && *unstable > 0)
    EO_TRY(follow_balance(search, found, false, error));
  EO_TRY(follow_static(search, error));
  if (balanced && *unstable == 0 && !is_known(search, found)) {
    struct eo_vibration again;
    EO_TRY(eo_vibration_solve(search->solver, search->load, EO_START_COLD, &again, error));
    if (again.outcome != EO_VIBRATION_NOT_CONVERGED)
      EO_TRY(follow_balance(search, &again, true, error));
  }
  EO_TRY(follow_speed(search, -1, error));
  return follow_speed(search, +1, error);
}

/* found: by harmonic balance, which the solver still holds. */
static enum eo_code search_states(struct eo_vibration_solver *solver, const struct eo_vibration_case *load,
                                  const struct eo_vibration *found, struct eo_vibration *result, struct eo_error *error)
{
  struct search *search = malloc(sizeof *search);
  double unstable = 0;
  if (!search)
    return eo_error_memory(error);
  enum eo_code code = begin_search(search, solver, load, error);
  if (!code)
    code = search_from(search, found, &unstable, error);
  if (!code)
    code = end_search(search, unstable, result, error);
  free_search(search);
  free(search);
  return code;
}

static void keep_alone(struct eo_vibration *result)
{
  result->states = 1;
  result->state[0] = (struct eo_vibration_state){.repeat = 1, .multiplier = result->multiplier};
  for (int i = 0; i < EO_READINGS; i++)
    result->state[0].rms[i] = result->rms_pair[i];
  result->state[0].contact_loss = worse_loss(result);
}

/* The multiplier of the state that the solver holds. */
static enum eo_code find_multiplier(struct eo_vibration_solver *solver, const struct eo_vibration_case *load,
                                    struct eo_vibration *found, struct eo_error *error)
{
  struct eo_cycle cycle;
  EO_TRY(eo_vibration_prepare(solver, load, &cycle, error));
  return eo_floquet_attached(&solver->model.oscillator, &cycle, solver->harmonics, solver->x, &found->multiplier,
                             error);
}

enum eo_code eo_vibration_settle(struct eo_vibration_solver *solver, const struct eo_vibration_case *load,
                                 struct eo_vibration *result, struct eo_error *error)
{
  struct eo_vibration found;
  EO_TRY(eo_vibration_solve(solver, load, EO_START_COLD, &found, error));
  if (found.outcome != EO_VIBRATION_CONVERGED)
    return search_states(solver, load, &found, result, error);
  EO_TRY(find_multiplier(solver, load, &found, error));
  if (found.multiplier > 1 + margin)
    return search_states(solver, load, &found, result, error);
  keep_alone(&found);
  *result = found;
  return EO_OK;
}

enum eo_code eo_vibration_settle_integrated(struct eo_vibration_solver *solver, const struct eo_vibration_case *load,
                                            struct eo_vibration *result, struct eo_error *error)
{
  struct eo_vibration balance;
  EO_TRY(eo_vibration_integrate(solver, load, NULL, result, NULL, error));
  if (result->outcome == EO_VIBRATION_CONVERGED) {
    EO_TRY(find_multiplier(solver, load, result, error));
    keep_alone(result);
    return EO_OK;
  }
  EO_TRY(eo_vibration_solve(solver, load, EO_START_COLD, &balance, error));
  return search_states(solver, load, &balance, result, error);
}

static enum eo_code keep_stable(struct search *search, struct eo_vibration_solver *solver,
                                const struct eo_vibration_case *load, struct eo_vibration *result,
                                struct eo_error *error)
{
  enum eo_code code = EO_OK;
  EO_TRY(begin_search(search, solver, load, error));
  double multiplier = result->multiplier = largest_multiplier(search, error, &code);
  if (code || !(multiplier > 1 + margin))
    return code;
  EO_TRY(follow_balance(search, result, false, error));
  return end_search(search, multiplier, result, error);
}

enum eo_code eo_vibration_keep_stable(struct eo_vibration_solver *solver, const struct eo_vibration_case *load,
                                      struct eo_vibration *result, struct eo_error *error)
{
  struct search *search = malloc(sizeof *search);
  if (!search)
    return eo_error_memory(error);
  enum eo_code code = keep_stable(search, solver, load, result, error);
  free_search(search);
  free(search);
  return code;
}
