/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reproduction/reproduction_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "document/examples.h"
#include "document/design_document.h"
#include "document/made_check_document.h"
#include "format/json.h"
#include "format/outline.h"
#include "evaluation/analysis.h"

#include <config.h>

static const struct eo_field order_fields[] = {
    EO_FLAG(struct eo_reproduction_order, quick, "quick", 0, "a tenth of the generations, a coarser sweep"),
    EO_INTEGER_DERIVED(struct eo_reproduction_order, generations, "generations", 1, 1000, "200, or 20 when quick",
                       "of the paper's algorithm and of the plain one"),
    EO_INTEGER_DERIVED(struct eo_reproduction_order, true_evaluations, "true_evaluations", 10, 100000,
                       "1000, or 300 when quick", "of our own search"),
    EO_INTEGER_DERIVED(struct eo_reproduction_order, pairs, "pairs", 1, EO_SCATTER_MOST_PAIRS,
                       "1000, or 100 when quick", "as they are made, on which the optima are compared"),
    EO_OBJECT(struct eo_reproduction_order, resolution, "resolution", &eo_resolution_table,
              "how finely it is computed"),
};
const struct eo_table eo_reproduction_order_table = EO_TABLE("a reproduction", struct eo_reproduction_order,
                                                             order_fields);

static enum eo_code build_design(int variant, const struct eo_reproduction_order *order, struct eo_design *design,
                                 struct eo_error *error)
{
  static const char *const example[VARIANTS] = {"paper", "paper-case-a", "paper-case-b", "paper", "paper"};
  struct eo_geometry geometry;
  eo_example_build(example[variant], design);
  design->optimization.variables = variant == PAPER_B || variant == OWN_B ? EO_VARIABLES_PER_END : EO_VARIABLES_SHARED;
  design->resolution = order->resolution;
  return eo_design_complete(design, &geometry, error);
}

enum eo_code eo_reproduction_design(const struct eo_reproduction_order *order, struct eo_design *design,
                                    struct eo_error *error)
{
  return build_design(UNMODIFIED, order, design, error);
}

static enum eo_code build_designs(struct reproduction *reproduction, struct eo_error *error)
{
  for (int i = 0; i < VARIANTS; i++) {
    reproduction->design[i] = malloc(sizeof *reproduction->design[i]);
    if (!reproduction->design[i])
      return eo_error_memory(error);
    EO_TRY(build_design(i, &reproduction->plan->order, reproduction->design[i], error));
  }
  return EO_OK;
}

static int report_preparation(void *context, const char *what, double fraction)
{
  const struct reproduction *reproduction = context;
  return eo_progress_report(reproduction->plan->progress, what, 0.03 * fraction);
}

static enum eo_code prepare_pair(struct reproduction *reproduction, struct eo_error *error)
{
  const struct eo_progress progress = {.report = report_preparation, .context = reproduction};
  const struct eo_pair_options options = {.cache_directory = reproduction->plan->cache_directory};
  reproduction->pair = reproduction->plan->pair;
  if (reproduction->pair)
    return EO_OK;
  EO_TRY(eo_pair_new(&reproduction->own_pair, reproduction->design[UNMODIFIED], &options, &progress, error));
  reproduction->pair = reproduction->own_pair;
  return EO_OK;
}

static enum eo_code analyse_variant(struct reproduction *reproduction, struct eo_analysis *analysis, int law,
                                    int variant, struct eo_error *error)
{
  struct eo_design *design = malloc(sizeof *design);
  if (!design)
    return eo_error_memory(error);
  *design = *reproduction->design[variant];
  if (law == LAW_PAPER)
    design->resolution.mesh_law = EO_LAW_SECANT;
  enum eo_code code = eo_analysis_run(analysis, design,
                                      law == LAW_OURS ? EO_WANT_ROOT | EO_WANT_BAND | EO_WANT_CURVES : 0, error);
  if (!code && law == LAW_OURS && !(reproduction->result[variant] = eo_result_encode(analysis, design, NULL)))
    code = eo_error_memory(error);
  free(design);
  EO_TRY(code);
  memcpy(reproduction->raw[law][variant], analysis->evaluation->objective, sizeof reproduction->raw[law][variant]);
  reproduction->value[law][variant] = analysis->value;
  return EO_OK;
}

static enum eo_code analyse(struct reproduction *reproduction, struct eo_error *error)
{
  struct eo_analysis *analysis = NULL;
  enum eo_code code = eo_analysis_new(&analysis, reproduction->pair, error);
  for (int law = 0; law < LAWS; law++)
    for (int i = 0; i < VARIANTS && !code; i++)
      code = analyse_variant(reproduction, analysis, law, i, error);
  eo_analysis_free(analysis);
  return code;
}

static const char *const laws[] = {"tangent", "secant", NULL};

/* One design under one law. */
struct summary {
  int variant, law;
  struct eo_objective_value value;
  json_t *cases;
};

static const struct eo_outline_row summary_rows[] = {
    EO_KEY("design", "word", "which of them", .words = eo_reproduction_variant, EO_AT(struct summary, variant)),
    EO_KEY("mesh_law", "word", "tangent: ours; secant: the paper's", .words = laws, EO_AT(struct summary, law)),
    {.outline = &eo_outline_value, EO_AT(struct summary, value)},
    EO_KEY("load_cases", "[object]", "one for each load case", .outline = &eo_outline_raw_case,
           EO_AT(struct summary, cases)),
};
static const struct eo_outline summary_outline = EO_OUTLINE("ReproducedResult", summary_rows);

static json_t *encode_summary(const struct reproduction *reproduction, int law, int variant)
{
  struct eo_object cases = eo_list_open();
  for (int k = 0; k < TORQUES; k++)
    eo_list_add(&cases,
                eo_result_raw_case(&reproduction->design[variant]->load_case[k], &reproduction->raw[law][variant][k]));
  const struct summary summary = {variant, law, reproduction->value[law][variant], eo_object_close(&cases)};
  return eo_outline_encode(&summary_outline, &summary);
}

static json_t *encode_summaries(const struct reproduction *reproduction)
{
  struct eo_object list = eo_list_open();
  for (int law = 0; law < LAWS; law++)
    for (int i = 0; i < VARIANTS; i++)
      eo_list_add(&list, encode_summary(reproduction, law, i));
  return eo_object_close(&list);
}

/* What is written: what others made is taken over. */
struct document {
  const char *program;
  bool quick;
  json_t *design, *table_3, *results, *comparisons, *optimizations, *figures, *sensitivity, *as_made, *readings;
  struct duration {
    double wall; /* s */
  } run;
};

static const struct eo_outline_row run_rows[] = {
    EO_KEY("wall_s", "number", "what it took", EO_AT(struct duration, wall)),
};
static const struct eo_outline run_outline = EO_OUTLINE("ReproductionRun", run_rows);

static const struct eo_outline_row document_rows[] = {
    EO_KEY("program", "text", "name and version", EO_AT(struct document, program)),
    EO_KEY("quick", "flag", "a tenth of the generations, a coarser sweep", EO_AT(struct document, quick)),
    EO_KEY("design", "object", "the paper's pair, every default resolved", .table = &eo_design_table,
           .name = "ResolvedDesign", EO_AT(struct document, design)),
    EO_KEY("table_3", "[object]", "parameters of the optimal modification, printed and our own",
           .outline = &eo_reproduction_parameter_outline, EO_AT(struct document, table_3)),
    EO_KEY("results", "[object]", "every design under both mesh laws", .outline = &summary_outline,
           EO_AT(struct document, results)),
    EO_KEY("comparisons", "[object]", "the paper's numbers and ours", .outline = &eo_reproduction_comparison_outline,
           EO_AT(struct document, comparisons)),
    EO_KEY("optimizations", "[object]", "both cases with each algorithm", .outline = &eo_reproduction_run_outline,
           EO_AT(struct document, optimizations)),
    EO_KEY("figures", "[object]", "the data of each", .outline = &eo_reproduction_figure_outline,
           EO_AT(struct document, figures)),
    EO_KEY("sensitivity", "[object]", "one assumption changed at a time",
           .outline = &eo_reproduction_assumption_outline, EO_AT(struct document, sensitivity)),
    EO_KEY("as_made", "object", "the optima on the same pairs as made", .outline = &eo_made_check_outline,
           EO_AT(struct document, as_made)),
    EO_KEY("readings", "[text]", "what the paper leaves open and what was assumed", EO_AT(struct document, readings)),
    EO_KEY("run", "object", "how long it took", .outline = &run_outline, EO_AT(struct document, run)),
};
const struct eo_outline eo_reproduction_outline = EO_OUTLINE("Reproduction", document_rows);

static json_t *encode(const struct reproduction *reproduction, json_t *sensitivity, double seconds)
{
  const struct document document = {.program = PACKAGE_STRING,
                                    .quick = reproduction->plan->order.quick,
                                    .design = eo_design_encode(reproduction->design[UNMODIFIED]),
                                    .table_3 = eo_reproduction_table(reproduction),
                                    .results = encode_summaries(reproduction),
                                    .comparisons = eo_reproduction_comparisons(reproduction),
                                    .optimizations = json_incref(reproduction->optimizations),
                                    .figures = json_incref(reproduction->figures),
                                    .sensitivity = sensitivity,
                                    .as_made = json_incref(reproduction->made),
                                    .readings = eo_reproduction_readings(),
                                    .run = {round(1e3 * seconds) / 1e3}};
  return eo_outline_encode(&eo_reproduction_outline, &document);
}

static double wall(void)
{
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static enum eo_code run(struct reproduction *reproduction, json_t **document, struct eo_error *error)
{
  double start = wall();
  json_t *sensitivity = NULL;
  EO_TRY(build_designs(reproduction, error));
  EO_TRY(prepare_pair(reproduction, error));
  EO_TRY(eo_reproduction_optimize(reproduction, error));
  EO_TRY(eo_reproduction_made(reproduction, error));
  EO_TRY(analyse(reproduction, error));
  EO_TRY(eo_reproduction_figures(reproduction, error));
  EO_TRY(eo_reproduction_sensitivity(reproduction, &sensitivity, error));
  if (!(*document = encode(reproduction, sensitivity, wall() - start)))
    EO_TRY(eo_error_memory(error));
  return EO_OK;
}

enum eo_code eo_reproduction_run(const struct eo_reproduction_plan *plan, json_t **document, struct eo_error *error)
{
  struct reproduction *reproduction = calloc(1, sizeof *reproduction);
  if (!reproduction)
    return eo_error_memory(error);
  reproduction->plan = plan;
  reproduction->optimizations = json_array();
  reproduction->figures = json_array();
  enum eo_code code = reproduction->optimizations && reproduction->figures ? run(reproduction, document, error)
                                                                           : eo_error_memory(error);
  for (int i = 0; i < VARIANTS; i++) {
    free(reproduction->design[i]);
    json_decref(reproduction->result[i]);
  }
  eo_pair_free(reproduction->own_pair);
  json_decref(reproduction->optimizations);
  json_decref(reproduction->figures);
  json_decref(reproduction->made);
  free(reproduction);
  return code;
}
