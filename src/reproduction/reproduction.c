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

static enum eo_code build_designs(struct reproduction *r, struct eo_error *error)
{
  static const char *const example[VARIANTS] = {"paper", "paper-case-a", "paper-case-b", "paper", "paper"};
  enum eo_code code = EO_OK;
  for (int i = 0; i < VARIANTS && !code; i++) {
    struct eo_geometry geometry;
    r->design[i] = malloc(sizeof *r->design[i]);
    if (!r->design[i])
      return eo_error_memory(error);
    eo_example_build(example[i], r->design[i]);
    r->design[i]->optimization.variables = i == PAPER_B || i == OWN_B ? EO_VARIABLES_PER_END : EO_VARIABLES_SHARED;
    if (r->plan->resolution)
      r->design[i]->resolution = *r->plan->resolution;
    code = eo_design_complete(r->design[i], &geometry, error);
  }
  return code;
}

static int report_preparation(void *context, const char *what, double fraction)
{
  const struct reproduction *r = context;
  return eo_progress_report(r->plan->progress, what, 0.03 * fraction);
}

static enum eo_code prepare_pair(struct reproduction *r, struct eo_error *error)
{
  const struct eo_progress progress = {.report = report_preparation, .context = r};
  const struct eo_pair_options options = {.cache_directory = r->plan->cache_directory};
  return eo_pair_new(&r->pair, r->design[UNMODIFIED], &options, &progress, error);
}

static enum eo_code analyse_variant(struct reproduction *r, struct eo_analysis *analysis, int law, int variant,
                                    struct eo_error *error)
{
  struct eo_design *design = malloc(sizeof *design);
  if (!design)
    return eo_error_memory(error);
  *design = *r->design[variant];
  if (law == LAW_PAPER)
    design->resolution.mesh_law = EO_LAW_SECANT;
  enum eo_code code = eo_analysis_run(analysis, design,
                                      law == LAW_OURS ? EO_WANT_ROOT | EO_WANT_BAND | EO_WANT_CURVES : 0, error);
  if (!code) {
    memcpy(r->raw[law][variant], analysis->evaluation->objective, sizeof r->raw[law][variant]);
    r->value[law][variant] = analysis->value;
  }
  if (!code && law == LAW_OURS && !(r->result[variant] = eo_result_encode(analysis, design, NULL)))
    code = eo_error_memory(error);
  free(design);
  return code;
}

static enum eo_code analyse(struct reproduction *r, struct eo_error *error)
{
  struct eo_analysis *analysis = NULL;
  enum eo_code code = eo_analysis_new(&analysis, r->pair, error);
  for (int law = 0; law < LAWS; law++)
    for (int i = 0; i < VARIANTS && !code; i++)
      code = analyse_variant(r, analysis, law, i, error);
  eo_analysis_free(analysis);
  return code;
}

static json_t *encode_summary(const struct reproduction *r)
{
  static const char *const laws[LAWS] = {"tangent", "secant"};
  json_t *array = json_array();
  for (int law = 0; law < LAWS; law++)
    for (int i = 0; i < VARIANTS && array; i++) {
      struct eo_object o = eo_object_open();
      json_t *cases = json_array();
      eo_object_put(&o, "design", json_string(eo_reproduction_variant[i]));
      eo_object_put(&o, "mesh_law", json_string(laws[law]));
      eo_outline_put(&o, &eo_outline_value, &r->value[law][i]);
      for (int k = 0; k < TORQUES; k++)
        json_array_append_new(cases, eo_result_raw_case(&r->design[i]->load_case[k], &r->raw[law][i][k]));
      eo_object_put(&o, "load_cases", cases);
      json_array_append_new(array, eo_object_close(&o));
    }
  return array;
}

static json_t *encode(const struct reproduction *r, json_t *sensitivity, double seconds)
{
  struct eo_object o = eo_object_open();
  eo_object_put(&o, "program", json_string(PACKAGE_STRING));
  eo_object_put(&o, "quick", json_boolean(r->plan->quick));
  eo_object_put(&o, "design", eo_design_encode(r->design[UNMODIFIED]));
  eo_object_put(&o, "table_3", eo_reproduction_table(r));
  eo_object_put(&o, "results", encode_summary(r));
  eo_object_put(&o, "comparisons", eo_reproduction_comparisons(r));
  eo_object_put(&o, "optimizations", json_incref(r->optimizations));
  eo_object_put(&o, "figures", json_incref(r->figures));
  eo_object_put(&o, "sensitivity", sensitivity);
  eo_object_put(&o, "readings", eo_reproduction_readings());
  eo_object_put(&o, "run", json_pack("{s:f}", "wall_s", round(1e3 * seconds) / 1e3));
  return eo_object_close(&o);
}

static double wall(void)
{
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static enum eo_code run(struct reproduction *r, json_t **document, struct eo_error *error)
{
  double start = wall();
  json_t *sensitivity = NULL;
  enum eo_code code = build_designs(r, error);
  if (!code)
    code = prepare_pair(r, error);
  if (!code)
    code = eo_reproduction_optimize(r, error);
  if (!code)
    code = analyse(r, error);
  if (!code)
    code = eo_reproduction_figures(r, error);
  if (!code)
    code = eo_reproduction_sensitivity(r, &sensitivity, error);
  if (!code && !(*document = encode(r, sensitivity, wall() - start)))
    code = eo_error_memory(error);
  return code;
}

enum eo_code eo_reproduction_run(const struct eo_reproduction_plan *plan, json_t **document, struct eo_error *error)
{
  struct reproduction *r = calloc(1, sizeof *r);
  if (!r)
    return eo_error_memory(error);
  r->plan = plan;
  r->optimizations = json_array();
  r->figures = json_array();
  enum eo_code code = r->optimizations && r->figures ? run(r, document, error) : eo_error_memory(error);
  for (int i = 0; i < VARIANTS; i++) {
    free(r->design[i]);
    json_decref(r->result[i]);
  }
  eo_pair_free(r->pair);
  json_decref(r->optimizations);
  json_decref(r->figures);
  free(r);
  return code;
}
