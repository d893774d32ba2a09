/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Optimizers on the real objective of the paper's pair, Case A (5 variables, both ends alike) and Case B (10), or of
   another design in a search space of its own: what a search minimises (J and the penalty) after 100, 200, 400 and all
   of 1000 true evaluations (--budget), beside NLopt's and pagmo's when they are there.

     bench-optimizer-gear [--quick] [--front] [--seeds N] [--first SEED] [--case a|b] [--design FILE] [--coarse]
   [--budget N] [--target VALUE] [--algorithm NAME[,NAME]...] [--set KEY=NUMBER]... [--cache DIR] [--rows FILE]
   [--blind]

   --front: Pareto fronts of the three objectives in those of the unmodified pair. --case: the variables, shared or per
   end; a design without it: as it states. --coarse: a third of the positions, cells and harmonics: an objective of the
   same kind in a fraction of the time. --blind: our own searches are not shown the flanks. --rows: every evaluation of
   seed, number, value and x. */
#include "contest.h"
#include "document/design_document.h"
#include "document/examples.h"
#include "document/search_space.h"
#include "document/search_view.h"
#include "evaluation/evaluator.h"
#include "evaluation/objective_anatomy.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct gear {
  struct eo_design design;
  struct eo_modification base; /* what the variables leave as it is */
  struct eo_pair *pair;
  struct eo_evaluator *evaluator;
  struct eo_study_space space;
  int values;                                 /* raw ones, of all scenarios */
  struct eo_objective_case *unmodified, *raw; /* [values] */
  struct eo_objective_value value, unmodified_value;
  struct eo_anatomy anatomy;
  struct eo_search_view search_view;
  struct eo_view view;
  bool shown;   /* to the searches */
  double *part; /* [anatomy.parts] of the last evaluation */
};

static void evaluate(struct gear *gear, const double *x)
{
  struct eo_error error;
  eo_study_space_apply(&gear->space, &gear->base, x, &gear->design.modification);
  if (eo_evaluator_raw(gear->evaluator, &gear->design, gear->raw, &error) != EO_OK) {
    fprintf(stderr, "%s\n", error.text);
    exit(1);
  }
  eo_objective_parts(gear->raw, gear->values, gear->part);
  eo_evaluator_combine(&gear->design, &gear->pair->geometry, gear->raw, gear->unmodified, &gear->value);
}

/* As a study ranks its rows. */
static double value(void *context, const double *x)
{
  struct gear *gear = context;
  evaluate(gear, x);
  const double rank = gear->value.objective + gear->design.objective.penalty * gear->value.violation;
  return isfinite(rank) && !gear->value.sums.failed ? rank : INFINITY;
}

/* The three in those of the unmodified pair. */
static void objectives(void *context, const double *x, double *f)
{
  struct gear *gear = context;
  evaluate(gear, x);
  for (int i = 0; i < CONTEST_OBJECTIVES; i++)
    f[i] = gear->value.sums.failed ? INFINITY : gear->value.sums.f[i] / gear->unmodified_value.sums.f[i];
}

static void prepare(struct trace *trace, const struct contest_problem *problem, uint64_t seed)
{
  (void)seed;
  trace->value = value;
  trace->objectives = objectives;
  trace->context = (void *)problem->detail;
  const struct gear *gear = problem->detail;
  trace->view = gear->shown ? &gear->view : NULL;
  if (!getenv("PLAIN")) {
    trace->anatomy = &gear->anatomy;
    trace->parts = gear->part;
  }
}

static enum eo_code read_design(struct gear *gear, const char *file, struct eo_error *error)
{
  struct eo_faults faults = {0};
  json_t *document = json_load_file(file, 0, NULL);
  if (!document)
    return eo_error_set(error, EO_ERROR_INPUT, "", "%s is no JSON document.", file);
  const bool good = eo_design_decode(document, &gear->design, NULL, &faults);
  json_decref(document);
  return good ? EO_OK : eo_error_set(error, EO_ERROR_INPUT, "", "%s: %s", file, faults.fault[0].text);
}

static enum eo_code prepare_gear(struct gear *gear, const char *file, bool coarse, const char *cache,
                                 struct eo_error *error)
{
  struct eo_geometry geometry;
  const struct eo_pair_options options = {.cache_directory = cache};
  struct eo_modification none;
  memset(&none, 0, sizeof none);
  enum eo_code code = EO_OK;
  if (file)
    code = read_design(gear, file, error);
  else if (!eo_example_build("paper", &gear->design))
    code = eo_error_set(error, EO_ERROR_INPUT, "", "The example is missing.");
  if (coarse) {
    gear->design.resolution.positions = 24;
    gear->design.resolution.cells_per_line = 8;
    gear->design.resolution.harmonics = gear->design.resolution.te_harmonics = 12;
  }
  if (!code)
    code = eo_design_complete(&gear->design, &geometry, error);
  if (!code)
    code = eo_pair_new(&gear->pair, &gear->design, &options, NULL, error);
  if (!code)
    code = eo_evaluator_new(&gear->evaluator, gear->pair, gear->design.load_cases, error);
  if (code)
    return code;
  gear->values = eo_evaluator_scenarios(&gear->design) * gear->design.load_cases;
  gear->unmodified = calloc((size_t)gear->values, sizeof *gear->unmodified);
  gear->raw = calloc((size_t)gear->values, sizeof *gear->raw);
  if (!gear->unmodified || !gear->raw)
    return eo_error_memory(error);
  gear->base = gear->design.modification;
  gear->design.modification = none;
  code = eo_evaluator_raw(gear->evaluator, &gear->design, gear->unmodified, error);
  if (!code)
    code = eo_objective_anatomy(&gear->design, eo_evaluator_scenarios(&gear->design), gear->unmodified, &gear->anatomy,
                                error);
  gear->part = calloc((size_t)gear->anatomy.parts + 1, sizeof *gear->part);
  if (!gear->part)
    return eo_error_memory(error);
  eo_evaluator_combine(&gear->design, &gear->pair->geometry, gear->unmodified, gear->unmodified,
                       &gear->unmodified_value);
  return code;
}

static enum eo_code run_space(const struct contest *contest, struct gear *gear, const char *name,
                              struct eo_error *error)
{
  const enum eo_code code = eo_study_space_init(&gear->space, &gear->design, &gear->pair->geometry, error);
  gear->view = eo_search_view_init(&gear->search_view, &gear->design, &gear->space, &gear->pair->geometry);
  gear->anatomy.blocks = eo_study_space_blocks(&gear->space, gear->anatomy.block);
  gear->search_view.base = &gear->base; /* the design's own is what is evaluated */
  const struct contest_problem problem = {name, gear->space.count, prepare, gear};
  if (!code)
    contest_run(contest, &problem);
  return code;
}

int main(int argc, char **argv)
{
  static struct gear gear;
  struct contest contest = contest_default();
  struct eo_error error;
  const char *cache = NULL, *file = NULL;
  char only = '\0';
  bool coarse = false;
  gear.shown = true;
  for (int i = 1; i < argc; i++) {
    const int taken = contest_option(&contest, argc, argv, i);
    if (strcmp(argv[i], "--coarse") == 0)
      coarse = true;
    else if (strcmp(argv[i], "--blind") == 0)
      gear.shown = false;
    else if (!taken && i + 1 < argc && strcmp(argv[i], "--case") == 0)
      only = argv[++i][0];
    else if (!taken && i + 1 < argc && strcmp(argv[i], "--design") == 0)
      file = argv[++i];
    else if (!taken && i + 1 < argc && strcmp(argv[i], "--cache") == 0)
      cache = argv[++i];
    i += taken > 1;
  }
  enum eo_code code = prepare_gear(&gear, file, coarse, cache, &error);
  if (!code)
    contest_print_head(&contest);
  if (!code && file && !only)
    code = run_space(&contest, &gear, "gear", &error);
  for (int ends = 0; ends < 2 && !code; ends++) {
    gear.design.optimization.variables = ends ? EO_VARIABLES_PER_END : EO_VARIABLES_SHARED;
    if (only == (ends ? 'b' : 'a') || (!file && !only))
      code = run_space(&contest, &gear, ends ? "gear-b" : "gear-a", &error);
  }
  if (code)
    fprintf(stderr, "%s\n", error.text);
  eo_evaluator_free(gear.evaluator);
  eo_pair_free(gear.pair);
  free(gear.unmodified);
  free(gear.raw);
  free(gear.part);
  free(gear.anatomy.group);
  return code ? 2 : 0;
}
