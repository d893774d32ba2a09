/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/evaluator_private.h"

#include <string.h>

static bool is_robust(const struct eo_design *design)
{
  return design->objective.robust != EO_ROBUST_OFF && design->objective.scenarios > 0;
}

int eo_evaluator_scenarios(const struct eo_design *design)
{
  return is_robust(design) ? design->objective.scenarios : 1;
}

enum eo_code eo_evaluator_raw(struct eo_evaluator *evaluator, const struct eo_design *design,
                              struct eo_objective_case *raw, struct eo_error *error)
{
  for (int i = 0; i < eo_evaluator_scenarios(design); i++) {
    const struct eo_scenario *scenario = is_robust(design) ? &design->objective.scenario[i] : NULL;
    const struct eo_evaluation *result;
    EO_TRY(eo_evaluator_run(evaluator, design, scenario, 0, &result, error));
    memcpy(raw + i * result->cases, result->objective, sizeof *raw * (size_t)result->cases);
  }
  return EO_OK;
}

static void add(struct eo_objective_value *sum, const struct eo_objective_value *value)
{
  for (int i = 0; i < 3; i++)
    sum->sums.f[i] += value->sums.f[i];
  sum->sums.failed |= value->sums.failed;
  sum->objective += value->objective;
  sum->violation += value->violation;
}

/* The mean over the scenarios of f, J and the violation, and the fitness of those means. */
static void divide(struct eo_objective_value *sum, int scenarios, double penalty)
{
  for (int i = 0; i < 3; i++)
    sum->sums.f[i] /= scenarios;
  sum->objective /= scenarios;
  sum->violation /= scenarios;
  sum->fitness = sum->sums.failed ? EO_FITNESS_WORST : 1 / sum->objective - penalty * sum->violation;
}

/* EO_ROBUST_WORST: all numbers are those of the scenario with the lowest fitness. */
void eo_evaluator_combine(const struct eo_design *design, const struct eo_geometry *geometry,
                          const struct eo_objective_case *raw, const struct eo_objective_case *unmodified,
                          struct eo_objective_value *value)
{
  const struct eo_objective *objective = &design->objective;
  int scenarios = eo_evaluator_scenarios(design), cases = design->load_cases;
  bool outside = eo_objective_relief_outside(&design->modification, geometry->rack_bottom, geometry->rack_top);
  for (int i = 0; i < scenarios; i++) {
    struct eo_objective_value one;
    eo_objective_value(objective, cases, design->load_case, raw + i * cases, unmodified + i * cases, outside, &one);
    if (i == 0 || (objective->robust == EO_ROBUST_WORST && one.fitness < value->fitness))
      *value = one;
    else if (objective->robust == EO_ROBUST_MEAN)
      add(value, &one);
  }
  if (objective->robust == EO_ROBUST_MEAN && scenarios > 1)
    divide(value, scenarios, objective->penalty);
}
