/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/evaluator_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "design/drawn_pairs.h"
#include "tolerance/statistics.h"

_Static_assert((int)EO_MAX_DRAWN_PAIRS <= (int)EO_MAX_SCENARIOS, "drawn pairs have room among the scenarios");

int eo_evaluator_scenarios(const struct eo_design *design)
{
  return eo_design_scenarios(design);
}

static enum eo_code fit_made(struct eo_evaluator *evaluator, struct eo_error *error)
{
  if (!evaluator->made)
    evaluator->made = malloc(sizeof *evaluator->made);
  return evaluator->made ? EO_OK : eo_error_memory(error);
}

/* The design in one of its states: as drawn for the search, or under a listed scenario. */
static enum eo_code run_state(struct eo_evaluator *evaluator, const struct eo_design *design, int state,
                              const struct eo_evaluation **result, struct eo_error *error)
{
  struct eo_scenario scenario;
  if (eo_design_scenarios(design) == 1)
    return eo_evaluator_run(evaluator, design, NULL, 0, result, error);
  if (design->drawn.pairs == 0)
    return eo_evaluator_run(evaluator, design, &design->objective.scenario[state], 0, result, error);
  EO_TRY(fit_made(evaluator, error));
  eo_drawn_pair_apply(design, state, evaluator->made, &scenario);
  return eo_evaluator_run(evaluator, evaluator->made, &scenario, 0, result, error);
}

enum eo_code eo_evaluator_raw(struct eo_evaluator *evaluator, const struct eo_design *design,
                              struct eo_objective_case *raw, struct eo_error *error)
{
  for (int i = 0; i < eo_evaluator_scenarios(design); i++) {
    const struct eo_evaluation *result;
    EO_TRY(run_state(evaluator, design, i, &result, error));
    memcpy(raw + i * result->cases, result->objective, sizeof *raw * (size_t)result->cases);
  }
  return EO_OK;
}

/* f1, f2, f3 and J of every state, state by state, so that each can be put in order. */
enum { PARTS = 4 };
static double part_of(const struct eo_objective_value *value, int part)
{
  return part < 3 ? value->sums.f[part] : value->objective;
}

/* The mean, the mean plus k standard deviations, or a percentile of f and J each. */
static double over_states(const struct eo_objective *objective, int states, double *value)
{
  struct eo_summary summary = eo_summary_of(states, value);
  if (objective->robust == EO_ROBUST_SIGMAS)
    return summary.mean + objective->robust_sigmas * summary.deviation;
  if (objective->robust != EO_ROBUST_PERCENTILE)
    return summary.mean;
  eo_sort_numbers(states, value);
  return eo_percentile(states, value, objective->robust_percent);
}

/* Limits hold for every state: the mean of the violations is 0 only then. */
static void settle(const struct eo_objective *objective, int states, const struct eo_objective_value *one,
                   struct eo_objective_value *value)
{
  double part[PARTS], column[EO_MAX_SCENARIOS];
  *value = (struct eo_objective_value){0};
  for (int i = 0; i < states; i++) {
    value->violation += one[i].violation / states;
    value->sums.failed |= one[i].sums.failed || !isfinite(one[i].objective);
  }
  for (int p = 0; p < PARTS; p++) {
    for (int i = 0; i < states; i++)
      column[i] = part_of(&one[i], p);
    part[p] = value->sums.failed ? NAN : over_states(objective, states, column);
  }
  for (int p = 0; p < 3; p++)
    value->sums.f[p] = part[p];
  value->objective = part[3];
  value->fitness = value->sums.failed ? EO_FITNESS_WORST : 1 / value->objective - objective->penalty * value->violation;
}

/* theory (O4); EO_ROBUST_WORST: all numbers are those of the state with the lowest fitness. */
void eo_evaluator_combine(const struct eo_design *design, const struct eo_geometry *geometry,
                          const struct eo_objective_case *raw, const struct eo_objective_case *unmodified,
                          struct eo_objective_value *value)
{
  const struct eo_objective *objective = &design->objective;
  struct eo_objective_value one[EO_MAX_SCENARIOS];
  int states = eo_evaluator_scenarios(design), cases = design->load_cases, worst = 0;
  bool outside = eo_objective_relief_outside(&design->modification, geometry->rack_bottom, geometry->rack_top);
  for (int i = 0; i < states; i++) {
    eo_objective_value(objective, cases, design->load_case, raw + i * cases, unmodified + i * cases, outside, &one[i]);
    worst = one[i].fitness < one[worst].fitness ? i : worst;
  }
  if (states == 1 || objective->robust == EO_ROBUST_WORST)
    *value = one[worst];
  else
    settle(objective, states, one, value);
}
