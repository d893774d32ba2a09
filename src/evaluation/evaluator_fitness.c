/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/evaluator_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/sort.h"
#include "design/drawn_pairs.h"
#include "evaluation/objective_terms.h"
#include "tolerance/statistics.h"

_Static_assert((int)EO_MAX_DRAWN_PAIRS < (int)EO_MAX_PAIR_STATES, "drawn pairs and the nominal one have room");
_Static_assert((int)EO_MAX_SCENARIOS < (int)EO_MAX_PAIR_STATES, "scenarios and the nominal pair have room");

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

/* The design in one of its states: as drawn for the search, or under a listed scenario; behind them the nominal pair,
   where it is asked for. */
static enum eo_code run_state(struct eo_evaluator *evaluator, const struct eo_design *design, int state,
                              const struct eo_evaluation **result, struct eo_error *error)
{
  struct eo_scenario scenario;
  if (state >= eo_design_states(design) || eo_design_scenarios(design) == 1)
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
  return eo_evaluator_raw_from(evaluator, design, 0, raw, error);
}

enum eo_code eo_evaluator_raw_from(struct eo_evaluator *evaluator, const struct eo_design *design, int first,
                                   struct eo_objective_case *raw, struct eo_error *error)
{
  for (int i = first; i < eo_evaluator_scenarios(design); i++) {
    const struct eo_evaluation *result;
    EO_TRY(run_state(evaluator, design, i, &result, error));
    memcpy(raw + i * result->cases, result->objective, sizeof *raw * (size_t)result->cases);
  }
  return EO_OK;
}

/* f1, f2, f3, J and the terms of every state, state by state, so that each can be put in order. */
enum { SUMS = 4, PARTS = SUMS + EO_MAX_OBJECTIVE_TERMS };
static double part_of(const struct eo_objective_value *value, int part)
{
  return part < 3 ? value->sums.f[part] : part < SUMS ? value->objective : value->term[part - SUMS];
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
  double part[PARTS] = {0}, column[EO_MAX_PAIR_STATES];
  *value = (struct eo_objective_value){.nominal = NAN, .terms = objective->terms};
  for (int i = 0; i < states; i++) {
    value->violation += one[i].violation / states;
    value->sums.failed |= one[i].sums.failed;
  }
  for (int p = 0; p < SUMS + objective->terms; p++) {
    for (int i = 0; i < states; i++)
      column[i] = part_of(&one[i], p);
    part[p] = value->sums.failed ? NAN : over_states(objective, states, column);
  }
  for (int p = 0; p < 3; p++)
    value->sums.f[p] = part[p];
  value->objective = part[3];
  for (int t = 0; t < objective->terms; t++)
    value->term[t] = part[SUMS + t];
}

/* theory (O4); EO_ROBUST_WORST: all numbers are those of the state with the lowest fitness. */
void eo_evaluator_combine(const struct eo_design *design, const struct eo_geometry *geometry,
                          const struct eo_objective_case *raw, const struct eo_objective_case *unmodified,
                          struct eo_objective_value *value)
{
  const struct eo_objective *objective = &design->objective;
  struct eo_objective_value one[EO_MAX_PAIR_STATES] = {0};
  int scenarios = eo_evaluator_scenarios(design), states = eo_design_states(design), cases = design->load_cases,
      worst = 0;
  bool outside = eo_objective_relief_outside(&design->modification, geometry->rack_bottom, geometry->rack_top);
  for (int i = 0; i < scenarios; i++) {
    eo_objective_weigh(objective, cases, design->load_case, raw + i * cases, unmodified + i * cases, outside, &one[i]);
    struct eo_objective_value judged = one[i];
    eo_objective_judge(objective, &judged);
    one[i].fitness = judged.fitness;
    worst = i < states && one[i].fitness < one[worst].fitness ? i : worst;
  }
  if (states == 1 || objective->robust == EO_ROBUST_WORST)
    *value = one[worst];
  else
    settle(objective, states, one, value);
  if (!value->sums.failed && states > 1)
    eo_objective_add_percentiles(objective, states, cases, design->load_case, raw, unmodified, value);
  if (scenarios > states && !one[states].sums.failed) {
    int nominal = states * cases;
    eo_objective_add_percentiles(objective, 1, cases, design->load_case, raw + nominal, unmodified + nominal,
                                 &one[states]);
    value->nominal = one[states].objective;
  }
  value->sums.failed |= one[scenarios - 1].sums.failed;
  eo_objective_judge(objective, value);
}
