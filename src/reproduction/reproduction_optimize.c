/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Case A and case B with the paper's algorithm, the plain one it is compared with, and ours. */
#include "reproduction/reproduction_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "optimizer/settings.h"

enum { ALGORITHMS = 3 };
static const enum eo_algorithm algorithms[ALGORITHMS] = {EO_FPGA, EO_GA, EO_CREDIBILITY_GA};
static const char *const case_names[] = {"A", "B", NULL};
static const double FIRST = 0.03, LAST = 0.85; /* of the whole work */

struct run {
  struct reproduction *r;
  int step;
  char what[60];
};

/* Figure 13, and the best rank of each case. */
struct drawing {
  double best[CASES];
  struct figure figure[1 + CASES]; /* part of the fitness computed; convergence of each case */
};

static int watch(void *context, const struct eo_study_report *report)
{
  const struct run *run = context;
  double share = (run->step + report->fraction) / (CASES * ALGORITHMS);
  return eo_progress_report(run->r->plan->progress, run->what, FIRST + (LAST - FIRST) * share);
}

/* Of fpga and ga. */
static int generations_of(const struct reproduction *reproduction)
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
  search->generations = generations_of(reproduction);
  search->true_evaluations = algorithm < 2 ? 0 : eo_reproduction_budget(reproduction);
}

/* A search as it is written. */
struct search_row {
  int which;
  const char *algorithm;
  struct eo_objective_value value;
  int true_evaluations, individuals;
  double pfc; /* per cent */
  const struct eo_study_result *result;
};

static json_t *write_variables(const void *source)
{
  const struct eo_study_result *result = ((const struct search_row *)source)->result;
  struct eo_object object = eo_object_open();
  for (int i = 0; i < result->space.count && result->best.there; i++) {
    char name[80];
    eo_study_variable_name(&result->space.variable[i], name, sizeof name);
    eo_object_put(&object, name,
                  json_real(eo_study_variable_value(&result->space.variable[i], &result->best.modification)));
  }
  return eo_object_close(&object);
}

static json_t *write_best(const void *source)
{
  const struct eo_study_result *result = ((const struct search_row *)source)->result;
  struct eo_object list = eo_list_open();
  for (int i = 0; i < result->generations; i++)
    eo_list_add(&list, eo_json_quantity(result->generation[i].best, NULL));
  return eo_object_close(&list);
}

#define OF_SEARCH(member) EO_AT(struct search_row, member)
static const struct eo_outline_row search_rows[] = {
    EO_KEY("case", "word", "A: both ends alike; B: each its own", .words = case_names, OF_SEARCH(which)),
    EO_KEY("algorithm", "text", "fpga and ga are the paper's, the other ours", OF_SEARCH(algorithm)),
    {.outline = &eo_outline_value, OF_SEARCH(value)},
    EO_KEY("true_evaluations", "integer", "of the model", OF_SEARCH(true_evaluations)),
    EO_KEY("individuals", "integer", "of all generations", OF_SEARCH(individuals)),
    EO_KEY("pfc_percent", "number?", "the part of them that was truly evaluated", OF_SEARCH(pfc)),
    EO_KEY("variables", "{number}", "of the best, by the name of each", .write = write_variables),
    EO_KEY("best_by_generation", "[number?]", "J; null: none was found yet", .write = write_best),
};
const struct eo_outline eo_reproduction_run_outline = EO_OUTLINE("ReproducedSearch", search_rows);

static json_t *encode_run(const struct eo_study_result *result, int which, const char *algorithm)
{
  const struct search_row row = {.which = which,
                                 .algorithm = algorithm,
                                 .value = result->best.value,
                                 .true_evaluations = result->true_evaluations,
                                 .individuals = result->individuals,
                                 .pfc = 100. * result->true_evaluations / result->individuals,
                                 .result = result};
  return eo_outline_encode(&eo_reproduction_run_outline, &row);
}

/* PFC so far and best J over true evaluations, generation by generation. */
static enum eo_code plot(const struct eo_study_result *result, const char *name, struct figure *pfc,
                         struct figure *convergence, struct eo_error *error)
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

/* What a search is kept as: its row, its curves, its best. */
static enum eo_code keep(struct run *run, int which, int algorithm, const struct eo_study_result *result,
                         struct drawing *drawing, struct eo_error *error)
{
  struct reproduction *reproduction = run->r;
  const char *name = eo_optimizer_algorithm_name(algorithms[algorithm]);
  char text[60];
  if (result->stopped == EO_STOP_CANCELLED)
    return eo_error_set(error, EO_ERROR_CANCELLED, "", "Stopped.");
  if (json_array_append_new(reproduction->optimizations, encode_run(result, which, name)))
    return eo_error_memory(error);
  snprintf(text, sizeof text, "%s, %s", case_names[which], name);
  EO_TRY(plot(result, text, algorithm == 0 ? &drawing->figure[0] : NULL, &drawing->figure[1 + which], error));
  if (algorithm < 2)
    reproduction->evaluations[which][algorithm] = result->true_evaluations;
  if (algorithm == 0)
    reproduction->pfc[which] = 100. * result->true_evaluations / result->individuals;
  if (result->best.there && result->best.rank < drawing->best[which]) {
    drawing->best[which] = result->best.rank;
    reproduction->design[which == CASE_A ? OWN_A : OWN_B]->modification = result->best.modification;
  }
  return EO_OK;
}

static enum eo_code study(struct run *run, int which, int algorithm, struct drawing *drawing, struct eo_error *error)
{
  struct reproduction *reproduction = run->r;
  struct eo_design *design = malloc(sizeof *design);
  struct eo_study_result result;
  if (!design)
    return eo_error_memory(error);
  *design = *reproduction->design[which == CASE_A ? OWN_A : OWN_B];
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
  enum eo_code code = eo_study_run(&plan, &result, error);
  if (!code)
    code = keep(run, which, algorithm, &result, drawing, error);
  eo_study_result_done(&result);
  free(design);
  return code;
}

static enum eo_code study_all(struct run *run, struct drawing *drawing, struct eo_error *error)
{
  for (int which = 0; which < CASES; which++)
    for (int algorithm = 0; algorithm < ALGORITHMS; algorithm++, run->step++)
      EO_TRY(study(run, which, algorithm, drawing, error));
  return EO_OK;
}

static enum eo_code add_figures(struct reproduction *reproduction, struct drawing *drawing, struct eo_error *error)
{
  static const double printed[CASES] = {39.67, 33.25};
  double generations = generations_of(reproduction) - 1;
  eo_reproduction_series(&drawing->figure[0], "printed, A", 1, &generations, &printed[0], true);
  eo_reproduction_series(&drawing->figure[0], "printed, B", 1, &generations, &printed[1], true);
  return eo_reproduction_add_figures(reproduction, 1 + CASES, drawing->figure, error);
}

enum eo_code eo_reproduction_optimize(struct reproduction *reproduction, struct eo_error *error)
{
  struct run run = {.r = reproduction};
  struct drawing drawing = {
      .best = {INFINITY, INFINITY},
      .figure = {
          eo_reproduction_figure("13", "Percentage of fitness computed, fpga", "generation", "PFC so far, %", true),
          eo_reproduction_figure("13 a", "Convergence, case A", "true evaluations", "best J", false),
          eo_reproduction_figure("13 b", "Convergence, case B", "true evaluations", "best J", false)}};
  enum eo_code code = study_all(&run, &drawing, error);
  enum eo_code end = add_figures(reproduction, &drawing, code ? NULL : error);
  return code ? code : end;
}
