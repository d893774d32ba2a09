/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "variants/variant_trade.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/clock.h"

#include "base/parallel.h"
#include "evaluation/analysis.h"
#include "evaluation/objective_terms.h"
#include "evaluation/scalar.h"
#include "document/search_space.h"
#include "format/json.h"
#include "variants/pair_rack.h"
#include "variants/variant_answer.h"

/* What one thread works with. */
struct tool {
  struct eo_design *design; /* owned */
  struct eo_racked_pair *held;
  struct eo_analysis *analysis; /* on that pair; owned */
  double *number;               /* [scalars.count]; owned */
};

struct shop {
  json_t *order; /* owned */
  const json_t *base;
  int axes;
  struct eo_variant_axis axis[EO_STUDY_AXES];
  struct eo_scalars scalars;
  struct eo_pair_rack *rack;
  struct eo_progress progress;
  struct tool tool[EO_MAX_THREADS];
};

/* The order: */

enum eo_code eo_variant_trade_order(const struct eo_variant_plan *plan, struct eo_text *order, struct eo_error *error)
{
  json_t *axes = json_array();
  for (int i = 0; i < plan->axes; i++) {
    json_t *paths = json_array();
    for (int k = 0; k < plan->axis[i].paths; k++)
      json_array_append_new(paths, json_string(plan->axis[i].path[k]));
    json_array_append_new(axes, json_pack("{s:o, s:f}", "paths", paths, "factor", plan->axis[i].factor));
  }
  json_t *document = json_pack("{s:O, s:o, s:s, s:i, s:i}", "design", plan->base, "axes", axes, "columns",
                               plan->columns, "cases", plan->design->load_cases, "ends", plan->design->gear_pair.ends);
  if (document)
    eo_json_write(order, document, EO_JSON_COMPACT);
  bool good = document && !order->failed;
  json_decref(document);
  return good ? EO_OK : eo_error_memory(error);
}

static enum eo_code read_axis(struct eo_variant_axis *axis, const json_t *asked, struct eo_error *error)
{
  const json_t *paths = json_object_get(asked, "paths");
  size_t count = json_array_size(paths);
  axis->factor = json_number_value(json_object_get(asked, "factor"));
  axis->path = calloc(count + 1, sizeof *axis->path);
  if (!axis->path)
    return eo_error_memory(error);
  axis->paths = (int)count;
  for (size_t i = 0; i < count; i++)
    snprintf(axis->path[i], EO_KEY_PATH, "%s", json_string_value(json_array_get(paths, i)));
  return EO_OK;
}

static enum eo_code open(struct eo_crew_bench *bench, struct eo_error *error)
{
  struct shop *shop = calloc(1, sizeof *shop);
  if (!shop)
    return eo_error_memory(error);
  bench->state = shop;
  shop->order = eo_json_parse(bench->order, bench->size, error);
  if (!shop->order)
    return error->code;
  const json_t *axes = json_object_get(shop->order, "axes");
  shop->base = json_object_get(shop->order, "design");
  shop->axes = (int)json_array_size(axes);
  for (int i = 0; i < shop->axes && i < EO_STUDY_AXES; i++)
    EO_TRY(read_axis(&shop->axis[i], json_array_get(axes, (size_t)i), error));
  EO_TRY(eo_scalars_init(&shop->scalars, json_string_value(json_object_get(shop->order, "columns")),
                         (int)json_integer_value(json_object_get(shop->order, "cases")),
                         (int)json_integer_value(json_object_get(shop->order, "ends")), error));
  shop->progress = eo_crew_bench_progress(bench);
  return eo_pair_rack_new(&shop->rack, bench->place, &shop->progress, error);
}

static void close(struct eo_crew_bench *bench)
{
  struct shop *shop = bench->state;
  if (!shop)
    return;
  for (int i = 0; i < EO_MAX_THREADS; i++) {
    struct tool *tool = &shop->tool[i];
    eo_analysis_free(tool->analysis);
    eo_pair_rack_put(shop->rack, tool->held);
    free(tool->design);
    free(tool->number);
  }
  for (int i = 0; i < EO_STUDY_AXES; i++)
    free(shop->axis[i].path);
  eo_pair_rack_free(shop->rack);
  eo_scalars_done(&shop->scalars);
  json_decref(shop->order);
  free(shop);
  bench->state = NULL;
}

/* An item: */

static enum eo_code ready_tool(const struct shop *shop, struct tool *tool, struct eo_error *error)
{
  if (!tool->design)
    tool->design = malloc(sizeof *tool->design);
  if (!tool->number)
    tool->number = malloc(sizeof *tool->number * (size_t)shop->scalars.count);
  return tool->design && tool->number ? EO_OK : eo_error_memory(error);
}

static enum eo_code fetch_pair(struct shop *shop, struct tool *tool, struct eo_error *error)
{
  if (tool->held && eo_pair_serves(eo_racked_pair(tool->held), tool->design))
    return EO_OK;
  eo_analysis_free(tool->analysis);
  eo_pair_rack_put(shop->rack, tool->held);
  tool->analysis = NULL;
  tool->held = NULL;
  EO_TRY(eo_pair_rack_take(shop->rack, tool->design, &tool->held, error));
  return eo_analysis_new(&tool->analysis, eo_racked_pair(tool->held), error);
}

static void judge(const struct eo_analysis *analysis, struct eo_variant_answer *answer)
{
  answer->outcome = EO_EVALUATION_CONVERGED;
  for (int k = analysis->cases * analysis->scenarios - 1; k >= 0; k--) {
    const struct eo_objective_case *raw = &analysis->raw[k];
    if (!raw->failed && isfinite(raw->peak_to_peak) && isfinite(raw->impact) && isfinite(raw->rms))
      continue;
    answer->outcome = EO_EVALUATION_NOT_CONVERGED;
    snprintf(answer->reason, sizeof answer->reason, "%s did not converge at load case %d%s.",
             isfinite(raw->rms) ? "Contact" : "Vibration or contact", k % analysis->cases + 1,
             analysis->scenarios > 1 ? " of a scenario" : "");
  }
}

/* What nobody asked for is not kept: a search of the same pair finds its own rows. */
static void forget_root(const struct eo_design *design, struct eo_analysis *analysis)
{
  int root = eo_scalar_find("root_stress_MPa");
  for (int k = 0; k < analysis->cases && !eo_objective_wants_root(&design->objective); k++)
    analysis->raw[k].root_stress = analysis->raw[k].scalar[root] = NAN;
}

static enum eo_code evaluate(struct shop *shop, struct tool *tool, struct eo_variant_answer *answer,
                             struct eo_text *modification, struct eo_error *error)
{
  EO_TRY(fetch_pair(shop, tool, error));
  double start = eo_clock_thread_seconds();
  EO_TRY(eo_analysis_run(tool->analysis, tool->design, shop->scalars.want, error));
  EO_TRY(eo_scalars_read(&shop->scalars, tool->analysis, tool->design, tool->number, error));
  judge(tool->analysis, answer);
  forget_root(tool->design, tool->analysis);
  EO_TRY(eo_modification_write(&tool->design->modification, tool->design->gear_pair.ends, modification, error));
  answer->cost = eo_clock_thread_seconds() - start;
  answer->numbers = shop->scalars.count;
  answer->number = tool->number;
  answer->cases = tool->analysis->scenarios == 1 ? tool->analysis->cases : 0;
  answer->raw = tool->analysis->raw;
  answer->modification = modification->data;
  return EO_OK;
}

static enum eo_code find_design(const struct shop *shop, struct tool *tool, const char *item, size_t size,
                                struct eo_error *error)
{
  struct eo_geometry geometry;
  json_t *wrapped = eo_json_parse(item, size, error);
  if (!wrapped)
    return eo_error_memory(error);
  enum eo_code code = eo_variant_design(shop->base, shop->axis, shop->axes, json_object_get(wrapped, "values"),
                                        tool->design, &geometry, error);
  json_decref(wrapped);
  return code;
}

/* A design that cannot be is a row with its reason. */
static enum eo_code work(struct eo_crew_bench *bench, int thread, const char *item, size_t size, struct eo_text *text,
                         struct eo_error *error)
{
  struct shop *shop = bench->state;
  struct tool *tool = &shop->tool[thread];
  struct eo_variant_answer answer = {.modification = ""};
  struct eo_text modification = {0};
  EO_TRY(ready_tool(shop, tool, error));
  enum eo_code code = find_design(shop, tool, item, size, error);
  if (!code)
    code = evaluate(shop, tool, &answer, &modification, error);
  if (code == EO_ERROR_INPUT || code == EO_ERROR_NUMERIC) {
    answer = (struct eo_variant_answer){.outcome = EO_EVALUATION_REFUSED, .modification = ""};
    snprintf(answer.reason, sizeof answer.reason, "%.80s%s%.*s", error->pointer, *error->pointer ? ": " : "",
             (int)sizeof answer.reason - 84, error->text);
    code = EO_OK;
  }
  if (!code)
    eo_variant_answer_write(&answer, text);
  eo_text_done(&modification);
  return code;
}

const struct eo_crew_trade eo_variant_trade = {"variants", open, work, close};
