/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reproduction/reproduction_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "document/examples.h"
#include "format/json.h"
#include "evaluation/analysis.h"

#include <config.h>

static enum eo_code build_designs(struct reproduction *reproduction, struct eo_error *error)
{
  static const char *const example[VARIANTS] = {"paper", "paper-case-a", "paper-case-b", "paper", "paper"};
  enum eo_code code = EO_OK;
  for (int i = 0; i < VARIANTS && !code; i++) {
    struct eo_geometry geometry;
    reproduction->design[i] = malloc(sizeof *reproduction->design[i]);
    if (!reproduction->design[i])
      return eo_error_memory(error);
    eo_example_build(example[i], reproduction->design[i]);
    reproduction->design[i]->optimization.variables = i == PAPER_B || i == OWN_B ? EO_VARIABLES_PER_END
                                                                                 : EO_VARIABLES_SHARED;
    if (reproduction->plan->resolution)
      reproduction->design[i]->resolution = *reproduction->plan->resolution;
    code = eo_design_complete(reproduction->design[i], &geometry, error);
  }
  return code;
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
  return eo_pair_new(&reproduction->pair, reproduction->design[UNMODIFIED], &options, &progress, error);
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
  if (!code) {
    memcpy(reproduction->raw[law][variant], analysis->evaluation->objective, sizeof reproduction->raw[law][variant]);
    reproduction->value[law][variant] = analysis->value;
  }
  if (!code && law == LAW_OURS && !(reproduction->result[variant] = eo_result_encode(analysis, design, NULL)))
    code = eo_error_memory(error);
  free(design);
  return code;
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

static json_t *encode_summary(const struct reproduction *reproduction)
{
  static const char *const laws[LAWS] = {"tangent", "secant"};
  json_t *array = json_array();
  for (int law = 0; law < LAWS; law++)
    for (int i = 0; i < VARIANTS && array; i++) {
      struct eo_object object = eo_object_open();
      json_t *cases = json_array();
      eo_object_put(&object, "design", json_string(eo_reproduction_variant[i]));
      eo_object_put(&object, "mesh_law", json_string(laws[law]));
      eo_outline_put(&object, &eo_outline_value, &reproduction->value[law][i]);
      for (int k = 0; k < TORQUES; k++)
        json_array_append_new(
            cases, eo_result_raw_case(&reproduction->design[i]->load_case[k], &reproduction->raw[law][i][k]));
      eo_object_put(&object, "load_cases", cases);
      json_array_append_new(array, eo_object_close(&object));
    }
  return array;
}

static json_t *encode(const struct reproduction *reproduction, json_t *sensitivity, double seconds)
{
  struct eo_object object = eo_object_open();
  eo_object_put(&object, "program", json_string(PACKAGE_STRING));
  eo_object_put(&object, "quick", json_boolean(reproduction->plan->quick));
  eo_object_put(&object, "design", eo_design_encode(reproduction->design[UNMODIFIED]));
  eo_object_put(&object, "table_3", eo_reproduction_table(reproduction));
  eo_object_put(&object, "results", encode_summary(reproduction));
  eo_object_put(&object, "comparisons", eo_reproduction_comparisons(reproduction));
  eo_object_put(&object, "optimizations", json_incref(reproduction->optimizations));
  eo_object_put(&object, "figures", json_incref(reproduction->figures));
  eo_object_put(&object, "sensitivity", sensitivity);
  eo_object_put(&object, "as_made", json_incref(reproduction->made));
  eo_object_put(&object, "readings", eo_reproduction_readings());
  eo_object_put(&object, "run", json_pack("{s:f}", "wall_s", round(1e3 * seconds) / 1e3));
  return eo_object_close(&object);
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
  eo_pair_free(reproduction->pair);
  json_decref(reproduction->optimizations);
  json_decref(reproduction->figures);
  json_decref(reproduction->made);
  free(reproduction);
  return code;
}
