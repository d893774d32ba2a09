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

static double largest_multiplier(struct search *q, struct eo_error *error, enum eo_code *code)
{
  double complex multiplier[2 * EO_MAX_COORDINATES];
  const struct eo_oscillator *o = &q->solver->model.oscillator;
  *code = eo_floquet(o, &q->cycle, q->solver->harmonics, q->solver->x, multiplier, error);
  if (*code == EO_ERROR_NUMERIC) { /* at a speed too low for the stiffness every disturbance dies within a period */
    *code = EO_OK;
    return NAN;
  }
  return *code ? NAN : cabs(multiplier[0]);
}

static double worse_loss(const struct eo_vibration *v)
{
  return v->ends == 2 ? fmax(v->contact_loss[0], v->contact_loss[1]) : v->contact_loss[0];
}

/* Lists a state unless it is known; returns whether it is now the loudest. */
static bool note_state(struct search *q, const struct eo_vibration *v)
{
  const struct eo_vibration_state found = {
      .repeat = v->repeat,
      .rms = {v->rms_pair[EO_READING_NORMAL], v->rms_pair[EO_READING_TRANSVERSE], v->rms_pair[EO_READING_ROTATIONAL]},
      .contact_loss = worse_loss(v),
      .multiplier = v->multiplier};
  int at = q->states;
  for (int i = 0; i < q->states; i++)
    if (fabs(q->state[i].rms[0] - found.rms[0]) <= same_state * found.rms[0])
      return false;
  q->seen[q->count++] = *v;
  if (q->states == EO_MAX_STATES)
    return false;
  while (at > 0 && q->state[at - 1].rms[0] < found.rms[0]) {
    q->state[at] = q->state[at - 1];
    at--;
  }
  q->state[at] = found;
  q->states++;
  return at == 0;
}

static bool near_to(double a, double b, double share)
{
  return fabs(a - b) <= share * fmax(fabs(a), fabs(b));
}

/* Whether a state by harmonic balance is one of those seen. */
static bool is_known(const struct search *q, const struct eo_vibration *v)
{
  bool known = false;
  for (int i = 0; i < q->count && !known; i++) {
    const struct eo_vibration *s = &q->seen[i];
    known = s->repeat == v->repeat;
    for (int end = 0; end < v->ends; end++) {
      known = known && near_to(s->deflection_swing[end], v->deflection_swing[end], alike);
      for (int reading = 0; reading < EO_READINGS; reading++)
        known = known && near_to(s->rms[reading][end], v->rms[reading][end], alike);
    }
  }
  return known;
}

/* By equal steps as long as the motion seems to settle, which takes the transient off it; from there time integration
   as long as it comes nearer to repeating, or until it is lost in the integration's own noise where the steps repeat.
   Where these would be too many, at low speeds, motions settle within a few periods anyway. */
static enum eo_code integrate_from(struct search *q, const double *start, struct eo_integration *run,
                                   struct eo_error *error)
{
  const struct eo_march_options march = {step_angle, settled, MAX_REPEAT, MOST_MARCHED, LEAST_MARCHED, ever_settling};
  const struct eo_integration_options options = {relative_tolerance, settled, PERIODS, q->samples, MAX_REPEAT};
  struct eo_march found = {.periodic = false};
  struct eo_error reason;
  double state[2 * EO_MAX_COORDINATES];
  enum eo_code code = eo_march(&q->solver->model.oscillator, &q->cycle, &march, start, &found, &reason);
  run->periodic = false;
  q->periods += found.periods;
  if (code == EO_ERROR_MEMORY)
    return eo_error_memory(error);
  if (!code && found.change > ever_settling)
    return EO_OK;
  memcpy(state, code ? start : found.state, sizeof *state * 2 * (size_t)q->solver->model.oscillator.n);
  code = EO_OK;
  for (int periods = 0; !code && !run->periodic && periods < MOST_PERIODS; periods += run->periods) {
    code = eo_integrate(&q->solver->model.oscillator, &q->cycle, &options, state, run, NULL, error);
    memcpy(state, run->state, sizeof state);
    if (code)
      return code;
    q->periods += run->periods;
    if (!run->periodic && run->change > on_its_way)
      break;
    run->periodic = run->periodic || (found.periodic && found.repeat == 1 && run->change <= noise);
  }
  return code;
}

/* Time integration from a state to where the motion repeats, if it does. */
static enum eo_code follow_from(struct search *q, const double *start, struct eo_error *error)
{
  struct eo_vibration_solver *s = q->solver;
  struct eo_integration *run = &q->run[1 - q->kept];
  struct eo_vibration found;
  struct eo_error reason;
  enum eo_code code = integrate_from(q, start, run, &reason);
  if (code == EO_ERROR_NUMERIC)
    return EO_OK; /* an integration that cannot go on finds no state */
  if (code || !run->periodic)
    return code;
  code = eo_vibration_read_run(s, q->load, &q->cycle, run, q->samples, &found, error);
  if (!code && found.repeat == 1)
    found.multiplier = largest_multiplier(q, error, &code);
  if (code)
    return code;
  if (note_state(q, &found)) {
    q->best = found;
    q->kept = 1 - q->kept;
  }
  return EO_OK;
}

/* From the state of the harmonic balance that the solver holds, unless that is known. */
static enum eo_code follow_balance(struct search *q, const struct eo_vibration *balance, bool stable,
                                   struct eo_error *error)
{
  double state[2 * EO_MAX_COORDINATES];
  int n = q->solver->model.oscillator.n;
  if (is_known(q, balance))
    return EO_OK;
  q->seen[q->count++] = *balance;
  eo_vibration_spectrum_state(q->solver, &q->cycle, state);
  for (int i = 0; i < n && !stable; i++)
    state[n + i] *= 1 + nudge;
  return follow_from(q, state, error);
}

static enum eo_code follow_static(struct search *q, struct eo_error *error)
{
  double state[2 * EO_MAX_COORDINATES];
  eo_vibration_condense(q->solver, q->load, q->cycle.frequency);
  eo_vibration_static_state(q->solver, &q->cycle, state);
  return follow_from(q, state, error);
}

/* The harmonic balance led to this speed from below (direction -1: the speed comes up) or above. */
static enum eo_code follow_speed(struct search *q, int direction, struct eo_error *error)
{
  static const double away[STEPS] = {0.08, 0.04, 0};
  struct eo_vibration_case at = *q->load;
  struct eo_vibration balance = {.outcome = EO_VIBRATION_CONVERGED};
  enum eo_code code = EO_OK;
  for (int i = 0; i < STEPS && !code && balance.outcome != EO_VIBRATION_NOT_CONVERGED; i++) {
    at.speed = q->load->speed * (1 + direction * away[i]);
    code = eo_vibration_solve(q->solver, &at, i ? EO_START_WARM : EO_START_COLD, &balance, error);
  }
  if (code || balance.outcome == EO_VIBRATION_NOT_CONVERGED || is_known(q, &balance))
    return code;
  double multiplier = largest_multiplier(q, error, &code);
  return code || multiplier > 1 + margin ? code : follow_balance(q, &balance, true, error);
}

static enum eo_code begin_search(struct search *q, struct eo_vibration_solver *s, const struct eo_vibration_case *load,
                                 struct eo_error *error)
{
  *q = (struct search){.solver = s, .load = load, .samples = LEAST_SAMPLES};
  while (q->samples < 4 * s->harmonics)
    q->samples *= 2;
  enum eo_code code = eo_vibration_prepare(s, load, &q->cycle, error);
  for (int i = 0; i < 2 && !code; i++)
    code = eo_vibration_make_run(&q->run[i], &s->model.oscillator, q->samples * MAX_REPEAT, error);
  return code;
}

/* The loudest state once more, so that spectrum and orders are its own. */
static enum eo_code end_search(struct search *q, double unstable, struct eo_vibration *result, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  int ends = q->solver->model.parameters.ends;
  if (q->states == 0) {
    *result = (struct eo_vibration){.outcome = EO_VIBRATION_NOT_CONVERGED,
                                    .ends = ends,
                                    .harmonics = q->solver->harmonics,
                                    .frequency = q->cycle.frequency,
                                    .multiplier = NAN};
  } else {
    eo_vibration_condense(q->solver, q->load, q->cycle.frequency);
    code = eo_vibration_read_run(q->solver, q->load, &q->cycle, &q->run[q->kept], q->samples, result, error);
    result->multiplier = q->best.multiplier;
  }
  result->periods = q->periods;
  result->unstable = unstable;
  result->states = q->states;
  memcpy(result->state, q->state, sizeof result->state);
  q->solver->solved = !code && q->states > 0 && result->repeat == 1;
  return code;
}

static void free_search(struct search *q)
{
  eo_vibration_free_run(&q->run[0]);
  eo_vibration_free_run(&q->run[1]);
}

/* The state of the harmonic balance, as far as there is one, then time integration from the other starts. A stable
   state is taken up last, since the static start mostly leads to it. */
static enum eo_code search_from(struct search *q, const struct eo_vibration *found, double *unstable,
                                struct eo_error *error)
{
  enum eo_code code = EO_OK;
  bool balanced = found->outcome != EO_VIBRATION_NOT_CONVERGED;
  if (balanced) {
    double multiplier = largest_multiplier(q, error, &code);
    *unstable = multiplier > 1 + margin ? multiplier : 0;
  }
  if (!code && balanced && *unstable > 0)
    code = follow_balance(q, found, false, error);
  if (!code)
    code = follow_static(q, error);
  if (!code && balanced && *unstable == 0 && !is_known(q, found)) {
    struct eo_vibration again;
    code = eo_vibration_solve(q->solver, q->load, EO_START_COLD, &again, error);
    if (!code && again.outcome != EO_VIBRATION_NOT_CONVERGED)
      code = follow_balance(q, &again, true, error);
  }
  if (!code)
    code = follow_speed(q, -1, error);
  return code ? code : follow_speed(q, +1, error);
}

/* found: by harmonic balance, which the solver still holds. */
static enum eo_code search_states(struct eo_vibration_solver *s, const struct eo_vibration_case *load,
                                  const struct eo_vibration *found, struct eo_vibration *result, struct eo_error *error)
{
  struct search *q = malloc(sizeof *q);
  double unstable = 0;
  if (!q)
    return eo_error_memory(error);
  enum eo_code code = begin_search(q, s, load, error);
  if (!code)
    code = search_from(q, found, &unstable, error);
  if (!code)
    code = end_search(q, unstable, result, error);
  free_search(q);
  free(q);
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

enum eo_code eo_vibration_settle(struct eo_vibration_solver *s, const struct eo_vibration_case *load,
                                 struct eo_vibration *result, struct eo_error *error)
{
  struct eo_vibration found;
  struct eo_cycle cycle;
  enum eo_code code = eo_vibration_solve(s, load, EO_START_COLD, &found, error);
  if (!code && found.outcome == EO_VIBRATION_CONVERGED) {
    code = eo_vibration_prepare(s, load, &cycle, error);
    if (!code)
      code = eo_floquet_attached(&s->model.oscillator, &cycle, s->harmonics, s->x, &found.multiplier, error);
    if (!code && !(found.multiplier > 1 + margin)) {
      keep_alone(&found);
      *result = found;
      return EO_OK;
    }
  }
  return code ? code : search_states(s, load, &found, result, error);
}

enum eo_code eo_vibration_settle_integrated(struct eo_vibration_solver *s, const struct eo_vibration_case *load,
                                            struct eo_vibration *result, struct eo_error *error)
{
  enum eo_code code = eo_vibration_integrate(s, load, NULL, result, NULL, error);
  struct eo_vibration balance;
  struct eo_cycle cycle;
  if (!code && result->outcome == EO_VIBRATION_CONVERGED) {
    code = eo_vibration_prepare(s, load, &cycle, error);
    if (!code)
      code = eo_floquet_attached(&s->model.oscillator, &cycle, s->harmonics, s->x, &result->multiplier, error);
    keep_alone(result);
    return code;
  }
  if (!code)
    code = eo_vibration_solve(s, load, EO_START_COLD, &balance, error);
  return code ? code : search_states(s, load, &balance, result, error);
}

enum eo_code eo_vibration_keep_stable(struct eo_vibration_solver *s, const struct eo_vibration_case *load,
                                      struct eo_vibration *result, struct eo_error *error)
{
  struct search *q = malloc(sizeof *q);
  if (!q)
    return eo_error_memory(error);
  enum eo_code code = begin_search(q, s, load, error);
  if (!code)
    result->multiplier = largest_multiplier(q, error, &code);
  const double multiplier = result->multiplier;
  if (!code && multiplier > 1 + margin) {
    code = follow_balance(q, result, false, error);
    if (!code)
      code = end_search(q, multiplier, result, error);
  }
  free_search(q);
  free(q);
  return code;
}
