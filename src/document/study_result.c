#include "document/study_result.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "format/json.h"
#include "document/result_private.h"
#include "format/text_table.h"

#include <config.h>

const char *const eo_study_stops[] = {"budget", "converged", "cancelled", NULL};

const char *eo_study_stop_name(enum eo_study_stop stop)
{
  return eo_study_stops[stop];
}

void eo_study_result_done(struct eo_study_result *result)
{
  free(result->unmodified.raw);
  free(result->best.raw);
  free(result->generation);
  free(result->front);
  *result = (struct eo_study_result){.knee = -1, .weighted = -1};
}

/* ---- JSON ---- */

static const char *const members[] = {"pinion", "gear", NULL}, *const ends[] = {"left", "right", "both", NULL};

static const struct eo_outline_row variable_rows[] = {
    EO_KEY("name", "text", "MEMBER/END/PARAMETER"),
    EO_KEY("member", "word", "whose flank", .words = members),
    EO_KEY("end", "word", "both: the same on both ends", .words = ends),
    EO_KEY("parameter", "word", "key of the flank's modification, with its unit", .words = eo_variable_parameters),
    EO_KEY("bounds", "[number]", "lowest, highest"),
    EO_KEY("best", "number?", "of the best design; null while there is none"),
};
static const struct eo_outline variable_outline = EO_OUTLINE("StudyVariable", variable_rows);

static json_t *encode_variable(const struct eo_study_result *result, const struct eo_study_variable *v)
{
  struct eo_object o = eo_object_open_as(&variable_outline);
  char name[80];
  eo_study_variable_name(v, name, sizeof name);
  eo_object_put(&o, "name", json_string(name));
  eo_object_put(&o, "member", json_string(members[v->member]));
  eo_object_put(&o, "end", json_string(ends[v->end]));
  eo_object_put(&o, "parameter", json_string(v->field->key));
  eo_object_put(&o, "bounds", json_pack("[o,o]", json_real(v->low), json_real(v->high)));
  eo_object_put(&o, "best",
                result->best.there ? json_real(eo_study_variable_value(v, &result->best.modification)) : json_null());
  return eo_object_close(&o);
}

/* Appends value to array; a failure of either leaves NULL. */
static json_t *append(json_t *array, json_t *value)
{
  if (array && json_array_append_new(array, value) == 0)
    return array;
  json_decref(array);
  return NULL;
}

static json_t *encode_variables(const struct eo_study_result *result)
{
  json_t *array = json_array();
  for (int i = 0; i < result->space.count && array; i++)
    array = append(array, encode_variable(result, &result->space.variable[i]));
  return array;
}

static const struct eo_outline_row point_rows[] = {
    {.outline = &eo_outline_value},
    EO_KEY("load_cases", "[object]", "of the nominal scenario, one for each load case",
           .outline = &eo_outline_raw_case),
};
static const struct eo_outline point_outline = EO_OUTLINE("StudyPoint", point_rows);

static json_t *encode_point(const struct eo_study_point *point, const struct eo_design *design)
{
  struct eo_object o = eo_object_open_as(&point_outline);
  json_t *cases = json_array();
  eo_result_put_value(&o, &point->value);
  for (int k = 0; k < design->load_cases && cases; k++)
    cases = append(cases, eo_result_raw_case(&design->load_case[k], &point->raw[k]));
  eo_object_put(&o, "load_cases", cases);
  return eo_object_close(&o);
}

static const struct eo_outline_row reduction_rows[] = {
    EO_KEY("torque_Nm", "number", "of the load case", .unit = &eo_unit_Nm),
    EO_KEY("speed_rpm", "number", "of the load case", .unit = &eo_unit_rpm),
    EO_KEY("peak_to_peak", "number?",
           "of the loaded transmission error, in per cent of the unmodified pair, positive when better"),
    EO_KEY("impact", "number?", "of the entering impact, likewise"),
    EO_KEY("rms", "number?", "of the vibration, likewise"),
    EO_KEY("contact_pressure", "number?", "of the largest contact pressure, likewise"),
    EO_KEY("root_stress", "number?", "of the largest root stress, likewise"),
};
static const struct eo_outline reduction_outline = EO_OUTLINE("StudyReduction", reduction_rows);

/* In per cent of the unmodified pair, positive when better, for every load case of the analysis. */
static json_t *encode_reductions(const json_t *analysis)
{
  static const struct {
    const char *key, *value;
  } row[] = {{"peak_to_peak", "peak_to_peak_um"},
             {"impact", "impact_N"},
             {"rms", "rms_m_per_s2"},
             {"contact_pressure", "contact_pressure_MPa"},
             {"root_stress", "root_stress_MPa"}};
  const json_t *after = eo_json_find(analysis, "objectives/load_cases"),
               *before = eo_json_find(analysis, "objectives/unmodified/load_cases");
  json_t *array = json_array();
  for (size_t k = 0; k < json_array_size(after) && array; k++) {
    struct eo_object o = eo_object_open_as(&reduction_outline);
    const json_t *a = json_array_get(after, k), *b = json_array_get(before, k);
    eo_object_put(&o, "torque_Nm", json_incref(json_object_get(a, "torque_Nm")));
    eo_object_put(&o, "speed_rpm", json_incref(json_object_get(a, "speed_rpm")));
    for (size_t i = 0; i < sizeof row / sizeof *row; i++)
      eo_object_put_number(&o, row[i].key,
                           100 * (1 - eo_json_find_number(a, row[i].value) / eo_json_find_number(b, row[i].value)));
    array = append(array, eo_object_close(&o));
  }
  return array;
}

static json_t *encode_modification(const struct eo_design *design, const struct eo_modification *modification)
{
  struct eo_design *with = malloc(sizeof *with);
  if (!with)
    return NULL;
  *with = *design;
  with->modification = *modification;
  json_t *document = eo_design_encode(with), *part = json_incref(json_object_get(document, "modification"));
  json_decref(document);
  free(with);
  return part;
}

static const struct eo_outline_row best_rows[] = {
    EO_KEY("modification", "object", "as a design takes it", .table = &eo_modification_table, .name = "Modification"),
    EO_KEY("objectives", "object", "of the duty cycle", .outline = &point_outline),
    EO_KEY("reductions_percent", "[object]", "one for each load case", .outline = &reduction_outline),
    EO_KEY("result", "object?", "the best design analysed; null when it was not", .outline = &eo_result_outline),
};
static const struct eo_outline best_outline = EO_OUTLINE("StudyBest", best_rows);

static json_t *encode_best(const struct eo_study_result *result, const struct eo_design *design, const json_t *analysis)
{
  struct eo_object o = eo_object_open_as(&best_outline);
  eo_object_put(&o, "modification", encode_modification(design, &result->best.modification));
  eo_object_put(&o, "objectives", encode_point(&result->best, design));
  eo_object_put(&o, "reductions_percent", encode_reductions(analysis));
  eo_object_put(&o, "result", analysis ? json_incref((json_t *)analysis) : json_null());
  return eo_object_close(&o);
}

static const struct eo_outline_row generation_rows[] = {
    EO_KEY("best", "number?", "J and penalties of the best so far"),
    EO_KEY("mean", "number?", "of this generation's true evaluations that converged"),
    EO_KEY("true", "integer", "evaluations by the model, or known from the history"),
    EO_KEY("predicted", "integer", "individuals whose fitness was predicted"),
    EO_KEY("repeated", "integer", "individuals equal to an earlier one"),
    EO_KEY("history_rows", "integer", "fpga: rows of its history after the generation"),
    EO_KEY("epoch", "integer", "credibility-ga: how often it started anew"),
};
static const struct eo_outline generation_outline = EO_OUTLINE("StudyGeneration", generation_rows);

static json_t *encode_generation(const struct eo_study_generation *g)
{
  struct eo_object o = eo_object_open_as(&generation_outline);
  eo_object_put_number(&o, "best", g->best);
  eo_object_put_number(&o, "mean", g->mean);
  eo_object_put(&o, "true", json_integer(g->true_count));
  eo_object_put(&o, "predicted", json_integer(g->predicted_count));
  eo_object_put(&o, "repeated", json_integer(g->repeated_count));
  eo_object_put(&o, "history_rows", json_integer(g->history_rows));
  eo_object_put(&o, "epoch", json_integer(g->epoch));
  return eo_object_close(&o);
}

static json_t *encode_generations(const struct eo_study_result *result)
{
  json_t *array = json_array();
  for (int i = 0; i < result->generations && array; i++)
    array = append(array, encode_generation(&result->generation[i]));
  return array;
}

static const struct eo_outline_row front_rows[] = {
    EO_KEY("values", "[number]", "of the variables, in their order and units"),
    {.outline = &eo_outline_value},
    EO_KEY("knee", "flag", "the point at the knee of the front"),
    EO_KEY("weighted", "flag", "the point that the weights choose"),
};
static const struct eo_outline front_outline = EO_OUTLINE("FrontPoint", front_rows);

static json_t *encode_front(const struct eo_study_result *result)
{
  json_t *array = json_array();
  for (int i = 0; i < result->front_count && array; i++) {
    const struct eo_study_point *point = &result->front[i];
    struct eo_object o = eo_object_open_as(&front_outline);
    json_t *values = json_array();
    for (int j = 0; j < result->space.count && values; j++)
      values = append(values, json_real(eo_study_variable_value(&result->space.variable[j], &point->modification)));
    eo_object_put(&o, "values", values);
    eo_result_put_value(&o, &point->value);
    eo_object_put(&o, "knee", json_boolean(i == result->knee));
    eo_object_put(&o, "weighted", json_boolean(i == result->weighted));
    array = append(array, eo_object_close(&o));
  }
  return array;
}

static json_t *encode_warnings(const struct eo_warnings *warnings)
{
  json_t *array = json_array();
  for (int i = 0; warnings && i < warnings->count && array; i++)
    array = append(array, json_string(warnings->text[i]));
  return array;
}

static const struct eo_outline_row run_rows[] = {
    EO_KEY("job", "integer", "number of the job"),
    EO_KEY("taken_up", "flag", "an earlier run was continued"),
    EO_KEY("computed_evaluations", "integer", "by this run"),
    EO_KEY("threads", "integer", "that evaluated"),
    EO_KEY("wall_s", "number", "of this run, s"),
    EO_KEY("model_s", "number", "of it, while the model computed, s"),
    EO_KEY("optimizer_s", "number", "of it, in the algorithm, s"),
    EO_KEY("history_s", "number", "of it, in the database, s"),
};
static const struct eo_outline run_outline = EO_OUTLINE("StudyRun", run_rows);

static json_t *encode_run(const struct eo_study_result *r)
{
  struct eo_object o = eo_object_open_as(&run_outline);
  eo_object_put(&o, "job", json_integer(r->job));
  eo_object_put(&o, "taken_up", json_boolean(r->resumed));
  eo_object_put(&o, "computed_evaluations", json_integer(r->computed));
  eo_object_put(&o, "threads", json_integer(r->threads));
  eo_object_put(&o, "wall_s", json_real(round(1e3 * r->seconds) / 1e3));
  eo_object_put(&o, "model_s", json_real(round(1e3 * r->model_seconds) / 1e3));
  eo_object_put(&o, "optimizer_s", json_real(round(1e3 * r->optimizer_seconds) / 1e3));
  eo_object_put(&o, "history_s", json_real(round(1e3 * r->store_seconds) / 1e3));
  return eo_object_close(&o);
}

static void put_counts(struct eo_object *o, const struct eo_study_result *r)
{
  const struct {
    const char *key;
    int value;
  } row[] = {{"individuals", r->individuals},         {"true_evaluations", r->true_evaluations},
             {"reused_evaluations", r->reused},       {"failed_evaluations", r->failed},
             {"predicted_individuals", r->predicted}, {"repeated_individuals", r->repeated},
             {"imported_rows", r->imported}};
  for (size_t i = 0; i < sizeof row / sizeof *row; i++)
    eo_object_put(o, row[i].key, json_integer(row[i].value));
  eo_object_put_number(o, "pfc_percent", r->individuals ? 100. * r->true_evaluations / r->individuals : NAN);
}

static const struct eo_outline_row study_rows[] = {
    EO_KEY("program", "text", "name and version"),
    EO_KEY("design", "object", "with every default resolved", .table = &eo_design_table, .name = "ResolvedDesign"),
    EO_KEY("design_hash", "text", "SHA-256 of the canonical design"),
    EO_KEY("algorithm", "text", "as in the design's optimization"),
    EO_KEY("seed", "integer", "of everything random"),
    EO_KEY("variables", "[object]", "what was varied", .outline = &variable_outline),
    EO_KEY("best", "object?", "null when no evaluation gave a value", .outline = &best_outline),
    EO_KEY("unmodified", "object", "of the pair without its modification", .outline = &point_outline),
    EO_KEY("individuals", "integer", "fitness values needed"),
    EO_KEY("true_evaluations", "integer", "of them by the model, or known from the history"),
    EO_KEY("reused_evaluations", "integer", "true evaluations that the history knew before the study asked"),
    EO_KEY("failed_evaluations", "integer", "true evaluations without a value"),
    EO_KEY("predicted_individuals", "integer", "fitness values that were predicted"),
    EO_KEY("repeated_individuals", "integer", "equal to an earlier individual"),
    EO_KEY("imported_rows", "integer", "true rows of other studies that the algorithm knew at its start"),
    EO_KEY("pfc_percent", "number?", "true evaluations of the individuals, per cent"),
    EO_KEY("generations", "[object]",
           "generations (ga, fpga), batches (credibility-ga) or cycles (nsga2), in their order",
           .outline = &generation_outline),
    EO_KEY("front", "[object]", "non-dominated points", .when = "of nsga2", .outline = &front_outline),
    EO_KEY("stopped", "word", "why it ended", .words = eo_study_stops),
    EO_KEY("warnings", "[text]", "in plain words"),
    EO_KEY("run", "object", "with best/result/timing_ms the only part that differs between two runs",
           .outline = &run_outline),
};
const struct eo_outline eo_study_outline = EO_OUTLINE("OptimizationResult", study_rows);

json_t *eo_study_result_encode(const struct eo_study_result *result, const struct eo_design *design,
                               const json_t *analysis, const struct eo_warnings *warnings)
{
  struct eo_object o = eo_object_open_as(&eo_study_outline);
  char hash[EO_HASH_LENGTH + 1];
  eo_object_put(&o, "program", json_string(PACKAGE_STRING));
  eo_object_put(&o, "design", eo_design_encode(design));
  eo_object_put(&o, "design_hash", eo_design_hash(design, hash, NULL) ? NULL : json_string(hash));
  eo_object_put(&o, "algorithm", json_string(design->optimization.algorithm));
  eo_object_put(&o, "seed", json_integer((json_int_t)design->optimization.seed));
  eo_object_put(&o, "variables", encode_variables(result));
  eo_object_put(&o, "best", result->best.there ? encode_best(result, design, analysis) : json_null());
  eo_object_put(&o, "unmodified", encode_point(&result->unmodified, design));
  put_counts(&o, result);
  eo_object_put(&o, "generations", encode_generations(result));
  if (strcmp(design->optimization.algorithm, "nsga2") == 0)
    eo_object_put(&o, "front", encode_front(result));
  eo_object_put(&o, "stopped", json_string(eo_study_stops[result->stopped]));
  eo_object_put(&o, "warnings", encode_warnings(warnings));
  eo_object_put(&o, "run", encode_run(result));
  return eo_object_close(&o);
}

/* ---- for people ---- */

static const char *find_text(const json_t *value, const char *path)
{
  const char *text = json_string_value(eo_json_find(value, path));
  return text ? text : "";
}

static void print_variables(const json_t *document, struct eo_text *text)
{
  static const char *const headings[] = {"variable", "lowest", "highest", "best"};
  const json_t *row;
  size_t i;
  struct eo_text_table sheet;
  eo_text_table_init(&sheet, 4, headings);
  json_array_foreach(json_object_get(document, "variables"), i, row)
  {
    eo_text_table_string(&sheet, find_text(row, "name"));
    for (size_t j = 0; j < 2; j++)
      eo_text_table_number(&sheet, json_number_value(json_array_get(json_object_get(row, "bounds"), j)), NULL, 5);
    eo_text_table_number(&sheet, eo_json_find_number(row, "best"), NULL, 5);
  }
  eo_text_table_print(&sheet, 2, text);
  eo_text_table_done(&sheet);
  eo_text_add(text, "\n");
}

static void add_reduction(struct eo_text_table *sheet, double before, double after)
{
  char change[40] = "";
  double percent = 100 * (1 - after / before);
  if (isfinite(percent))
    snprintf(change, sizeof change, "%.*f %%", fabs(percent) < 9.95 ? 1 : 0, percent);
  eo_text_table_string(sheet, change);
}

static const struct quantity {
  const char *key, *name, *unit;
} sums[] = {{"f1_um", "f1", "um"}, {"f2_N", "f2", "N"}, {"f3_m_per_s2", "f3", "m/s2"}, {"J", "J", ""}},
  per_case[] = {{"peak_to_peak_um", "peak-to-peak loaded TE", "um"},
                {"impact_N", "entering impact", "N"},
                {"rms_m_per_s2", "vibration, RMS normal", "m/s2"},
                {"contact_pressure_MPa", "contact pressure", "MPa"},
                {"root_stress_MPa", "root stress", "MPa"}};

static void add_rows(struct eo_text_table *sheet, const struct quantity *quantity, size_t count, const json_t *before,
                     const json_t *after)
{
  for (size_t i = 0; i < count; i++) {
    double a = eo_json_find_number(before, quantity[i].key), b = eo_json_find_number(after, quantity[i].key);
    eo_text_table_string(sheet, quantity[i].name);
    eo_text_table_string(sheet, quantity[i].unit);
    eo_text_table_number(sheet, a, NULL, 4);
    eo_text_table_number(sheet, b, NULL, 4);
    add_reduction(sheet, a, b);
  }
}

static void print_comparison(const struct quantity *quantity, size_t count, const json_t *before, const json_t *after,
                             struct eo_text *text)
{
  static const char *const headings[] = {"", "", "unmodified", "optimum", "reduction"};
  struct eo_text_table sheet;
  eo_text_table_init(&sheet, 5, headings);
  add_rows(&sheet, quantity, count, before, after);
  eo_text_table_print(&sheet, 2, text);
  eo_text_table_done(&sheet);
  eo_text_add(text, "\n");
}

static void print_cases(const json_t *document, struct eo_text *text)
{
  const json_t *after = eo_json_find(document, "best/result/objectives/load_cases"), *row;
  const json_t *before = eo_json_find(document, "best/result/objectives/unmodified/load_cases");
  size_t k;
  json_array_foreach((json_t *)after, k, row)
  {
    eo_text_print(text, "%.6g N m, %.6g rpm\n", eo_json_find_number(row, "torque_Nm"),
                  eo_json_find_number(row, "speed_rpm"));
    print_comparison(per_case, sizeof per_case / sizeof *per_case, json_array_get(before, k), row, text);
  }
}

static void print_effort(const json_t *document, struct eo_text *text)
{
  eo_text_print(text,
                "%s: %.0f true evaluations of %.0f individuals (PFC %.1f %%), %.0f of them known from the history, "
                "%.0f failed; %.0f earlier rows imported\n",
                find_text(document, "algorithm"), eo_json_find_number(document, "true_evaluations"),
                eo_json_find_number(document, "individuals"), eo_json_find_number(document, "pfc_percent"),
                eo_json_find_number(document, "reused_evaluations"),
                eo_json_find_number(document, "failed_evaluations"), eo_json_find_number(document, "imported_rows"));
  eo_text_print(text,
                "Job %.0f%s, %.0f evaluations computed now in %.1f s on %.0f threads (model %.1f s, optimizer %.1f s, "
                "history %.1f s); stopped: %s\n",
                eo_json_find_number(document, "run/job"),
                json_is_true(eo_json_find(document, "run/taken_up")) ? ", taken up" : "",
                eo_json_find_number(document, "run/computed_evaluations"), eo_json_find_number(document, "run/wall_s"),
                eo_json_find_number(document, "run/threads"), eo_json_find_number(document, "run/model_s"),
                eo_json_find_number(document, "run/optimizer_s"), eo_json_find_number(document, "run/history_s"),
                find_text(document, "stopped"));
}

static void print_notes(const json_t *warnings, struct eo_text *text)
{
  const json_t *row;
  size_t i;
  json_array_foreach((json_t *)warnings, i, row) eo_text_print(text, "Note: %s\n", json_string_value(row));
}

void eo_study_result_summary(const json_t *document, struct eo_text *text)
{
  char name[200];
  const json_t *best = json_object_get(document, "best"), *front = json_object_get(document, "front");
  eo_text_clean(name, sizeof name, find_text(document, "design/name"));
  eo_text_print(text, "%s%s", name, *name ? "\n" : "");
  print_variables(document, text);
  if (json_is_null(best))
    eo_text_add(text, "No evaluation has given a value yet.\n\n");
  else {
    print_comparison(sums, sizeof sums / sizeof *sums, json_object_get(document, "unmodified"),
                     json_object_get(best, "objectives"), text);
    print_cases(document, text);
  }
  if (eo_json_find_number(best, "objectives/violation") > 0)
    eo_text_print(text, "Constraints are violated by %.4g in sum.\n",
                  eo_json_find_number(best, "objectives/violation"));
  if (front)
    eo_text_print(text, "Pareto front: %zu points (--json lists them)\n", json_array_size(front));
  print_effort(document, text);
  print_notes(json_object_get(document, "warnings"), text);
  print_notes(eo_json_find(best, "result/warnings"), text);
}
