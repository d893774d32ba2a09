/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Case A and case B with the paper's algorithm, the plain one it is compared with, and ours. */
#include "reproduction/reproduction_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "optimizer/settings.h"

enum { ALGORITHMS = 3 };
static const enum eo_algorithm algorithms[ALGORITHMS] = {EO_FPGA, EO_GA, EO_CREDIBILITY_GA};
static const char *const case_names[CASES] = {"A", "B"};
static const double FIRST = 0.03, LAST = 0.85; /* of the whole work */

struct run {
  struct reproduction *r;
  int step;
  char what[60];
};

static int watch(void *context, const struct eo_study_report *report)
{
  const struct run *run = context;
  double share = (run->step + report->fraction) / (CASES * ALGORITHMS);
  return eo_progress_report(run->r->plan->progress, run->what, FIRST + (LAST - FIRST) * share);
}

int eo_reproduction_generations(const struct reproduction *reproduction)
{
  return reproduction->plan->order.generations > 0 ? reproduction->plan->order.generations
         : reproduction->plan->order.quick         ? 20
                                                   : 200;
}

int eo_reproduction_budget(const struct reproduction *reproduction)
{
  return reproduction->plan->order.true_evaluations > 0 ? reproduction->plan->order.true_evaluations
         : reproduction->plan->order.quick              ? 300
                                                        : 1000;
}

static void set_up(const struct reproduction *reproduction, struct eo_design *design, int algorithm)
{
  struct eo_optimizer_settings *search = &design->optimization.search;
  search->algorithm = algorithms[algorithm];
  search->generations = eo_reproduction_generations(reproduction);
  search->true_evaluations = algorithm < 2 ? 0 : eo_reproduction_budget(reproduction);
}

static json_t *encode_run(const struct eo_study_result *result, const char *case_name, const char *algorithm)
{
  struct eo_object object = eo_object_open();
  json_t *values = json_object(), *best = json_array();
  bool there = result->best.there;
  for (int i = 0; i < result->space.count && there; i++) {
    char name[80];
    eo_study_variable_name(&result->space.variable[i], name, sizeof name);
    json_object_set_new(values, name,
                        json_real(eo_study_variable_value(&result->space.variable[i], &result->best.modification)));
  }
  for (int i = 0; i < result->generations; i++)
    json_array_append_new(best, eo_json_quantity(result->generation[i].best, NULL));
  eo_object_put(&object, "case", json_string(case_name));
  eo_object_put(&object, "algorithm", json_string(algorithm));
  eo_outline_put(&object, &eo_outline_value, &result->best.value);
  eo_object_put(&object, "true_evaluations", json_integer(result->true_evaluations));
  eo_object_put(&object, "individuals", json_integer(result->individuals));
  eo_object_put(&object, "pfc_percent", eo_json_quantity(100. * result->true_evaluations / result->individuals, NULL));
  eo_object_put(&object, "variables", values);
  eo_object_put(&object, "best_by_generation", best);
  return eo_object_close(&object);
}

/* PFC so far and best J over true evaluations, generation by generation. */
static enum eo_code plot(const struct eo_study_result *result, const char *name, json_t *pfc, json_t *convergence,
                         struct eo_error *error)
{
  size_t n = (size_t)result->generations;
  double *column = calloc(4 * n + 1, sizeof *column);
  int evaluated = 0, individuals = 0;
  if (!column)
    return eo_error_memory(error);
  double *generation = column, *share = column + n, *count = column + 2 * n, *best = column + 3 * n;
  for (int i = 0; i < result->generations; i++) {
    const struct eo_study_generation *study_generation = &result->generation[i];
    evaluated += study_generation->true_count;
    individuals += study_generation->true_count + study_generation->predicted_count + study_generation->repeated_count;
    generation[i] = i;
    share[i] = individuals ? 100. * evaluated / individuals : NAN;
    count[i] = evaluated;
    best[i] = study_generation->best;
  }
  if (pfc)
    eo_reproduction_series(pfc, name, result->generations, generation, share, false);
  eo_reproduction_series(convergence, name, result->generations, count, best, false);
  free(column);
  return EO_OK;
}

static enum eo_code study(struct run *run, int which, int algorithm, double *best, json_t *pfc, json_t *convergence,
                          struct eo_error *error)
{
  struct reproduction *reproduction = run->r;
  struct eo_design *own = reproduction->design[which == CASE_A ? OWN_A : OWN_B], *design = malloc(sizeof *design);
  struct eo_study_result result;
  char name[60];
  if (!design)
    return eo_error_memory(error);
  *design = *own;
  design->modification = reproduction->design[UNMODIFIED]->modification;
  set_up(reproduction, design, algorithm);
  const struct eo_study_plan plan = {.design = design,
                                     .pair = reproduction->pair,
                                     .store = reproduction->plan->store,
                                     .threads = reproduction->plan->threads,
                                     .fresh = true,
                                     .watch = watch,
                                     .context = run};
  snprintf(run->what, sizeof run->what, "case %s, %s", case_names[which],
           eo_optimizer_algorithm_name(algorithms[algorithm]));
  snprintf(name, sizeof name, "%s, %s", case_names[which], eo_optimizer_algorithm_name(algorithms[algorithm]));
  enum eo_code code = eo_study_run(&plan, &result, error);
  if (!code && result.stopped == EO_STOP_CANCELLED)
    code = eo_error_set(error, EO_ERROR_CANCELLED, "", "Stopped.");
  if (!code &&
      json_array_append_new(reproduction->optimizations,
                            encode_run(&result, case_names[which], eo_optimizer_algorithm_name(algorithms[algorithm]))))
    code = eo_error_memory(error);
  if (!code)
    code = plot(&result, name, algorithm == 0 ? pfc : NULL, convergence, error);
  if (!code && algorithm < 2)
    reproduction->evaluations[which][algorithm] = result.true_evaluations;
  if (!code && algorithm == 0)
    reproduction->pfc[which] = 100. * result.true_evaluations / result.individuals;
  if (!code && result.best.there && result.best.rank < *best) {
    *best = result.best.rank;
    own->modification = result.best.modification;
  }
  eo_study_result_done(&result);
  free(design);
  return code;
}

enum eo_code eo_reproduction_optimize(struct reproduction *reproduction, struct eo_error *error)
{
  static const double printed[CASES] = {39.67, 33.25};
  struct run run = {.r = reproduction};
  double generations = eo_reproduction_generations(reproduction) - 1;
  json_t *pfc = eo_reproduction_figure("13", "Percentage of fitness computed, fpga", "generation", "PFC so far, %",
                                       true);
  json_t *convergence[CASES] = {
      eo_reproduction_figure("13 a", "Convergence, case A", "true evaluations", "best J", false),
      eo_reproduction_figure("13 b", "Convergence, case B", "true evaluations", "best J", false)};
  enum eo_code code = EO_OK;
  for (int which = 0; which < CASES; which++) {
    double best = INFINITY;
    for (int algorithm = 0; algorithm < ALGORITHMS && !code; algorithm++, run.step++)
      code = study(&run, which, algorithm, &best, pfc, convergence[which], error);
  }
  eo_reproduction_series(pfc, "printed, A", 1, &generations, &printed[0], true);
  eo_reproduction_series(pfc, "printed, B", 1, &generations, &printed[1], true);
  json_array_append_new(reproduction->figures, pfc);
  for (int which = 0; which < CASES; which++)
    json_array_append_new(reproduction->figures, convergence[which]);
  return code;
}
