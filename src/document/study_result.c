/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/study_result.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "format/json.h"
#include "document/result_private.h"
#include "evaluation/objective_terms.h"
#include "gear/names.h"

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
  eo_made_check_done(&result->check);
  *result = (struct eo_study_result){.knee = -1, .weighted = -1};
}

struct variable {
  char name[80];
  const struct eo_study_variable *variable;
  int member, end;
  const char *parameter;
  int row, column;
  double best; /* in the unit of its key; NaN: none */
};

static json_t *write_bounds(const void *source)
{
  const struct variable *variable = source;
  return json_pack("[o,o]", json_real(variable->variable->low), json_real(variable->variable->high));
}

static json_t *write_best_value(const void *source)
{
  return eo_json_real(((const struct variable *)source)->best, NULL);
}

static const struct eo_outline_row variable_rows[] = {
    EO_KEY("name", "text", "MEMBER/END/PARAMETER", EO_AT(struct variable, name)),
    EO_KEY("member", "word", "whose flank", .words = eo_member_name, EO_AT(struct variable, member)),
    EO_KEY("end", "word", "both: the same on both ends", .words = eo_variable_end_name, EO_AT(struct variable, end)),
    EO_KEY("parameter", "word", "key of the flank's modification, with its unit", .words = eo_variable_parameters,
           EO_AT(struct variable, parameter)),
    EO_KEY("row", "integer", "of the grid, from 1 on, of " EO_GRID_PARAMETER "; 0: all, or another parameter",
           EO_AT(struct variable, row)),
    EO_KEY("column", "integer", "the same of its columns", EO_AT(struct variable, column)),
    EO_KEY("bounds", "[number]", "lowest, highest", .write = write_bounds),
    EO_KEY("best", "number?", "of the best design; null while there is none", .write = write_best_value),
};
static const struct eo_outline variable_outline = EO_OUTLINE("StudyVariable", variable_rows);

static json_t *encode_variable(const struct eo_study_result *result, const struct eo_study_variable *variable)
{
  struct variable row = {.variable = variable,
                         .member = variable->member,
                         .end = variable->end,
                         .parameter = variable->field->key,
                         .row = variable->row,
                         .column = variable->column,
                         .best = result->best.there ? eo_study_variable_value(variable, &result->best.modification)
                                                    : NAN};
  eo_study_variable_name(variable, row.name, sizeof row.name);
  return eo_outline_encode(&variable_outline, &row);
}

struct point {
  const struct eo_study_point *point;
  const struct eo_design *design;
  struct eo_objective_value value;
};

static json_t *write_cases(const void *source)
{
  const struct point *point = source;
  json_t *cases = json_array();
  for (int k = 0; k < point->design->load_cases && cases; k++)
    cases = eo_json_append(cases, eo_result_raw_case(&point->design->load_case[k], &point->point->raw[k]));
  return cases;
}

static const struct eo_outline_row point_rows[] = {
    {.outline = &eo_outline_value, .offset = offsetof(struct point, value)},
    EO_KEY("load_cases", "[object]", "of the nominal scenario, one for each load case", .outline = &eo_outline_raw_case,
           .write = write_cases),
};
static const struct eo_outline point_outline = EO_OUTLINE("StudyPoint", point_rows);

static json_t *encode_point(const struct eo_study_point *point, const struct eo_design *design)
{
  const struct point source = {point, design, point->value};
  return eo_outline_encode(&point_outline, &source);
}

struct reduction {
  double torque, speed;                                            /* N m, rad/s */
  double peak_to_peak, impact, rms, contact_pressure, root_stress; /* per cent */
};

static const struct eo_outline_row reduction_rows[] = {
    EO_KEY("torque_Nm", "number", "of the load case", .unit = &eo_unit_Nm, EO_AT(struct reduction, torque)),
    EO_KEY("speed_rpm", "number", "of the load case", .unit = &eo_unit_rpm, EO_AT(struct reduction, speed)),
    EO_KEY("peak_to_peak", "number?",
           "of the loaded transmission error, in per cent of the unmodified pair, positive when better",
           EO_AT(struct reduction, peak_to_peak)),
    EO_KEY("impact", "number?", "of the entering impact, likewise", EO_AT(struct reduction, impact)),
    EO_KEY("rms", "number?", "of the vibration, likewise", EO_AT(struct reduction, rms)),
    EO_KEY("contact_pressure", "number?", "of the largest contact pressure, likewise",
           EO_AT(struct reduction, contact_pressure)),
    EO_KEY("root_stress", "number?", "of the largest root stress, likewise", EO_AT(struct reduction, root_stress)),
};
static const struct eo_outline reduction_outline = EO_OUTLINE("StudyReduction", reduction_rows);

static double reduction_of(const json_t *after, const json_t *before, const char *key)
{
  return 100 * (1 - eo_json_find_number(after, key) / eo_json_find_number(before, key));
}

/* In per cent of the unmodified pair, positive when better, for every load case of the analysis. */
static json_t *encode_reductions(const json_t *analysis)
{
  const json_t *after = eo_json_find(analysis, "objectives/load_cases"),
               *before = eo_json_find(analysis, "objectives/unmodified/load_cases");
  json_t *array = json_array();
  for (size_t k = 0; k < json_array_size(after) && array; k++) {
    const json_t *a = json_array_get(after, k), *b = json_array_get(before, k);
    const struct reduction row = {.torque = eo_unit_in(&eo_unit_Nm, eo_json_find_number(a, "torque_Nm")),
                                  .speed = eo_unit_in(&eo_unit_rpm, eo_json_find_number(a, "speed_rpm")),
                                  .peak_to_peak = reduction_of(a, b, "peak_to_peak_um"),
                                  .impact = reduction_of(a, b, "impact_N"),
                                  .rms = reduction_of(a, b, "rms_m_per_s2"),
                                  .contact_pressure = reduction_of(a, b, "contact_pressure_MPa"),
                                  .root_stress = reduction_of(a, b, "root_stress_MPa")};
    array = eo_json_append(array, eo_outline_encode(&reduction_outline, &row));
  }
  return array;
}

/* What the document is about. */
struct source {
  struct eo_study_result result; /* borrowed members */
  const struct eo_design *design;
  const json_t *analysis;
  const struct eo_warnings *warnings;
  char algorithm[32];
  uint64_t seed;
  double pfc_percent;
};

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

static json_t *write_best_modification(const void *source)
{
  const struct source *this_source = source;
  return encode_modification(this_source->design, &this_source->result.best.modification);
}

static json_t *write_best_objectives(const void *source)
{
  const struct source *this_source = source;
  return encode_point(&this_source->result.best, this_source->design);
}

static json_t *write_reductions(const void *source)
{
  return encode_reductions(((const struct source *)source)->analysis);
}

static json_t *write_analysis(const void *source)
{
  const struct source *this_source = source;
  return this_source->analysis ? json_incref((json_t *)this_source->analysis) : json_null();
}

static const struct eo_outline_row best_rows[] = {
    EO_KEY("modification", "object", "as a design takes it", .table = &eo_modification_table, .name = "Modification",
           .write = write_best_modification),
    EO_KEY("objectives", "object", "of the duty cycle", .outline = &point_outline, .write = write_best_objectives),
    EO_KEY("reductions_percent", "[object]", "one for each load case", .outline = &reduction_outline,
           .write = write_reductions),
    EO_KEY("result", "object?", "the best design analysed; null when it was not", .outline = &eo_result_outline,
           .write = write_analysis),
};
static const struct eo_outline best_outline = EO_OUTLINE("StudyBest", best_rows);

static const struct eo_outline_row generation_rows[] = {
    EO_KEY("best", "number?", "J and penalties of the best so far", EO_AT(struct eo_study_generation, best)),
    EO_KEY("mean", "number?", "of this generation's true evaluations that converged",
           EO_AT(struct eo_study_generation, mean)),
    EO_KEY("true", "integer", "evaluations by the model, or known from the history",
           EO_AT(struct eo_study_generation, true_count)),
    EO_KEY("predicted", "integer", "individuals whose fitness was predicted",
           EO_AT(struct eo_study_generation, predicted_count)),
    EO_KEY("repeated", "integer", "individuals equal to an earlier one",
           EO_AT(struct eo_study_generation, repeated_count)),
    EO_KEY("history_rows", "integer", "fpga: rows of its history after the generation",
           EO_AT(struct eo_study_generation, history_rows)),
    EO_KEY("epoch", "integer", "credibility-ga: how often it started anew", EO_AT(struct eo_study_generation, epoch)),
};
static const struct eo_outline generation_outline = EO_OUTLINE("StudyGeneration", generation_rows);

struct front_point {
  const struct eo_study_result *result;
  const struct eo_design *design;
  const struct eo_study_point *point;
  struct eo_objective_value value;
  bool knee, weighted;
};

static json_t *write_values(const void *source)
{
  const struct front_point *front_point = source;
  json_t *values = json_array();
  for (int j = 0; j < front_point->result->space.count && values; j++)
    values = eo_json_append(values, json_real(eo_study_variable_value(&front_point->result->space.variable[j],
                                                                      &front_point->point->modification)));
  return values;
}

static json_t *write_axes(const void *source)
{
  const struct front_point *front_point = source;
  double axis[EO_MAX_OBJECTIVES];
  json_t *axes = json_array();
  eo_front_values(front_point->design, &front_point->value, &front_point->result->unmodified.value, axis);
  for (int i = 0; i < front_point->design->optimization.search.objectives && axes; i++)
    axes = eo_json_append(axes, eo_json_real(axis[i], NULL));
  return axes;
}

static const struct eo_outline_row front_rows[] = {
    EO_KEY("values", "[number]", "of the variables, in their order and units", .write = write_values),
    EO_KEY("axes", "[number]", "what the front is over, in the order of front_axes", .write = write_axes),
    {.outline = &eo_outline_value, .offset = offsetof(struct front_point, value)},
    EO_KEY("knee", "flag", "the point at the knee of the front", EO_AT(struct front_point, knee)),
    EO_KEY("weighted", "flag", "the point that the weights choose", EO_AT(struct front_point, weighted)),
};
static const struct eo_outline front_outline = EO_OUTLINE("FrontPoint", front_rows);

static json_t *write_front(const void *source)
{
  const struct source *this_source = source;
  const struct eo_study_result *result = &this_source->result;
  json_t *array = json_array();
  for (int i = 0; i < result->front_count && array; i++) {
    const struct eo_study_point *point = &result->front[i];
    const struct front_point row = {result,       this_source->design, point,
                                    point->value, i == result->knee,   i == result->weighted};
    array = eo_json_append(array, eo_outline_encode(&front_outline, &row));
  }
  return array;
}

static json_t *write_front_axes(const void *source)
{
  const struct eo_design *design = ((const struct source *)source)->design;
  json_t *array = json_array();
  for (int i = 0; i < design->optimization.search.objectives && array; i++) {
    char name[120];
    eo_front_axis_name(design, i, name, sizeof name);
    array = eo_json_append(array, json_string(name));
  }
  return array;
}

static bool is_race(const void *source)
{
  const struct eo_design *design = ((const struct source *)source)->design;
  return design->objective.robust != EO_ROBUST_OFF && design->drawn.pairs > 0;
}

static bool has_check(const void *source)
{
  return ((const struct source *)source)->result.check.pairs > 0;
}

static json_t *write_check(const void *source)
{
  const struct source *this_source = source;
  return eo_made_check_encode(&this_source->result.check, this_source->design);
}

static bool has_front(const void *source)
{
  return strcmp(((const struct source *)source)->algorithm, "nsga2") == 0;
}

/* What is to be said of the best one. */
static json_t *write_findings(const struct eo_study_result *result)
{
  const struct eo_study_point *best = &result->best;
  json_t *array = json_array();
  if (best->there && best->evaluation == result->unmodified.evaluation)
    array = eo_json_append(array, json_string("No flank of the search is fitter than the unmodified pair, which lies "
                                              "within the bounds: it is the result."));
  if (best->there && best->value.violation > 0)
    array = eo_json_append(array, json_sprintf("Constraints are violated by %.4g in sum.", best->value.violation));
  return array;
}

static json_t *write_warnings(const void *source)
{
  const struct eo_warnings *warnings = ((const struct source *)source)->warnings;
  json_t *array = write_findings(&((const struct source *)source)->result);
  for (int i = 0; warnings && i < warnings->count && array; i++)
    array = eo_json_append(array, json_string(warnings->text[i]));
  return array;
}

static const struct eo_outline_row run_rows[] = {
    EO_KEY("job", "integer", "number of the job", EO_AT(struct eo_study_result, job)),
    EO_KEY("taken_up", "flag", "an earlier run was continued", EO_AT(struct eo_study_result, resumed)),
    EO_KEY("computed_evaluations", "integer", "by this run", EO_AT(struct eo_study_result, computed)),
    EO_KEY("threads", "integer", "that evaluated", EO_AT(struct eo_study_result, threads)),
    EO_KEY("wall_s", "number", "of this run, s", EO_AT(struct eo_study_result, seconds)),
    EO_KEY("model_s", "number", "of it, while the model computed, s", EO_AT(struct eo_study_result, model_seconds)),
    EO_KEY("optimizer_s", "number", "of it, in the algorithm, s", EO_AT(struct eo_study_result, optimizer_seconds)),
    EO_KEY("history_s", "number", "of it, in the database, s", EO_AT(struct eo_study_result, store_seconds)),
};
static const struct eo_outline run_outline = EO_OUTLINE("StudyRun", run_rows);

static double to_milliseconds(double seconds)
{
  return round(1e3 * seconds) / 1e3;
}

static json_t *write_program(const void *source)
{
  (void)source;
  return json_string(PACKAGE_STRING);
}

static json_t *write_design(const void *source)
{
  return eo_design_encode(((const struct source *)source)->design);
}

static json_t *write_hash(const void *source)
{
  char hash[EO_HASH_LENGTH + 1];
  return eo_design_hash(((const struct source *)source)->design, hash, NULL) ? NULL : json_string(hash);
}

static json_t *write_variables(const void *source)
{
  const struct eo_study_result *result = &((const struct source *)source)->result;
  json_t *array = json_array();
  for (int i = 0; i < result->space.count && array; i++)
    array = eo_json_append(array, encode_variable(result, &result->space.variable[i]));
  return array;
}

static json_t *write_best(const void *source)
{
  return ((const struct source *)source)->result.best.there ? eo_outline_encode(&best_outline, source) : json_null();
}

static json_t *write_unmodified(const void *source)
{
  const struct source *this_source = source;
  return encode_point(&this_source->result.unmodified, this_source->design);
}

static const struct eo_outline_row study_rows[] = {
    EO_KEY("program", "text", "name and version", .write = write_program),
    EO_KEY("design", "object", "with every default resolved", .table = &eo_design_table, .name = "ResolvedDesign",
           .write = write_design),
    EO_KEY("design_hash", "text", "SHA-256 of the canonical design", .write = write_hash),
    EO_KEY("algorithm", "text", "as in the design's optimization", EO_AT(struct source, algorithm)),
    EO_KEY("seed", "integer", "of everything random", EO_AT(struct source, seed)),
    EO_KEY("variables", "[object]", "what was varied", .outline = &variable_outline, .write = write_variables),
    EO_KEY("best", "object?", "null when no evaluation gave a value", .outline = &best_outline, .write = write_best),
    EO_KEY("unmodified", "object", "of the pair without its modification", .outline = &point_outline,
           .write = write_unmodified),
    EO_KEY("individuals", "integer", "fitness values needed", EO_AT(struct source, result.individuals)),
    EO_KEY("true_evaluations", "integer", "of them by the model, or known from the history",
           EO_AT(struct source, result.true_evaluations)),
    EO_KEY("reused_evaluations", "integer", "true evaluations that the history knew before the study asked",
           EO_AT(struct source, result.reused)),
    EO_KEY("failed_evaluations", "integer", "true evaluations without a value", EO_AT(struct source, result.failed)),
    EO_KEY("predicted_individuals", "integer", "fitness values that were predicted",
           EO_AT(struct source, result.predicted)),
    EO_KEY("repeated_individuals", "integer", "equal to an earlier individual", EO_AT(struct source, result.repeated)),
    EO_KEY("imported_rows", "integer", "true rows of other studies that the algorithm knew at its start",
           EO_AT(struct source, result.imported)),
    EO_KEY("pfc_percent", "number?", "true evaluations of the individuals, per cent",
           EO_AT(struct source, pfc_percent)),
    EO_KEY("generations", "[object]",
           "generations (ga, fpga), batches (credibility-ga) or cycles (nsga2), in their order",
           .outline = &generation_outline, EO_ROWS_AT(struct source, result.generation, result.generations)),
    EO_KEY("whole_evaluations", "integer",
           "true evaluations with all pairs as made; the others are with objective.first_pairs alone",
           .when = "of a robust objective over pairs as made", EO_AT(struct source, result.whole), .there = is_race),
    EO_KEY("front_axes", "[text]", "what the front is over", .when = "of nsga2", .write = write_front_axes,
           .there = has_front),
    EO_KEY("front", "[object]", "non-dominated points", .when = "of nsga2", .outline = &front_outline,
           .write = write_front, .there = has_front),
    EO_KEY("check", "object", "what was found, and the design it began with, compared with the unmodified pair",
           .when = "of a robust objective over pairs as made, with check_pairs", .outline = &eo_made_check_outline,
           .write = write_check, .there = has_check),
    EO_KEY("stopped", "word", "why it ended", .words = eo_study_stops, EO_AT(struct source, result.stopped)),
    EO_KEY("warnings", "[text]", "in plain words", .write = write_warnings),
    EO_KEY("run", "object", "with best/result/timing_ms the only part that differs between two runs",
           .outline = &run_outline, EO_AT(struct source, result)),
};
const struct eo_outline eo_study_outline = EO_OUTLINE("OptimizationResult", study_rows);

json_t *eo_study_result_encode(const struct eo_study_result *result, const struct eo_design *design,
                               const json_t *analysis, const struct eo_warnings *warnings)
{
  struct source source = {.result = *result,
                          .design = design,
                          .analysis = analysis,
                          .warnings = warnings,
                          .seed = design->optimization.search.seed,
                          .pfc_percent = result->individuals ? 100. * result->true_evaluations / result->individuals
                                                             : NAN};
  snprintf(source.algorithm, sizeof source.algorithm, "%s",
           eo_optimizer_algorithm_name(design->optimization.search.algorithm));
  source.result.seconds = to_milliseconds(result->seconds);
  source.result.model_seconds = to_milliseconds(result->model_seconds);
  source.result.optimizer_seconds = to_milliseconds(result->optimizer_seconds);
  source.result.store_seconds = to_milliseconds(result->store_seconds);
  return eo_outline_encode(&eo_study_outline, &source);
}
