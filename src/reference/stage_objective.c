/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "reference/stage.h"
#include "reference/stage_input.h"
#include "evaluation/objective_terms.h"
#include "evaluation/evaluator.h"

#define RAW(member_, key_, unit_, high_, help_)                                                                     \
  {                                                                                                                 \
    .key = key_, .kind = EO_FIELD_NUMBER, .flags = EO_FIELD_REQUIRED | EO_FIELD_NULLABLE,                           \
    .offset = offsetof(struct eo_objective_case, member_), .unit = unit_, .low = 0, .high = high_, .fallback = NAN, \
    .derived = "the load case failed", .help = help_                                                                \
  }

static const struct eo_field raw[] = {
    RAW(peak_to_peak, "peak_to_peak_um", &eo_unit_um, 1e9, "of the pair's loaded transmission error"),
    RAW(impact, "impact_N", &eo_unit_N, 1e12, "general entering impact, worse end"),
    RAW(rms, "rms_m_per_s2", &eo_unit_m_per_s2, 1e12, "normal acceleration, mean of the ends' RMS"),
    EO_NUMBER(struct eo_objective_case, contact_pressure, "contact_pressure_MPa", &eo_unit_MPa, 0, 1e9, 0, "largest"),
    EO_NUMBER_DERIVED(struct eo_objective_case, root_stress, "root_stress_MPa", &eo_unit_MPa, 0, 1e9, "not computed",
                      "largest"),
    EO_NUMBER(struct eo_objective_case, edge_load_share, "edge_load_share", NULL, 0, 1.1, 0,
              "largest part of an end's load on tip edges"),
    EO_NUMBER(struct eo_objective_case, contact_loss, "contact_loss", NULL, 0, 1, 0,
              "largest part of the cycle out of contact"),
    EO_NUMBER_DERIVED(struct eo_objective_case, flank_safety, "flank_safety", NULL, 0, 1e9, "not rated", "least S_H"),
    EO_NUMBER_DERIVED(struct eo_objective_case, root_safety, "root_safety", NULL, 0, 1e9, "not rated", "least S_F"),
    EO_NUMBER_DERIVED(struct eo_objective_case, film_ratio, "film_ratio", NULL, 0, 1e9, "not rated",
                      "least specific film thickness"),
    EO_NUMBER_DERIVED(struct eo_objective_case, contact_temperature, "contact_temperature_C", &eo_unit_C, -300, 1e5,
                      "not rated", "largest"),
    EO_FLAG(struct eo_objective_case, failed, "failed", 0, "contact or vibration did not converge"),
};
const struct eo_table eo_stage_raw_table = EO_TABLE("raw values", struct eo_objective_case, raw);

struct input {
  struct eo_design design;
  double bottom, top;
  int values, unmodified_values;
  struct eo_objective_case value[EO_STAGE_RAW], unmodified[EO_STAGE_RAW];
};

static const struct eo_field input[] = {
    EO_LIST(struct input, design.load_case, design.load_cases, "load_cases", &eo_load_case_table, 1, EO_MAX_LOAD_CASES,
            "as in a design document"),
    EO_OBJECT(struct input, design.objective, "objective", &eo_objective_table, "as in a design document"),
    EO_OBJECT(struct input, design.modification, "modification", &eo_modification_terms_table,
              "as in a design document; only where reliefs start is used"),
    EO_NUMBER(struct input, bottom, "rack_bottom_mm", &eo_unit_mm, -1e4, 0, -1e4,
              "u_A, the end of the pinion's active profile, as stage geometry prints it"),
    EO_NUMBER(struct input, top, "rack_top_mm", &eo_unit_mm, 0, 1e4, 1e4, "u_E, its other end"),
    EO_LIST(struct input, value, values, "values", &eo_stage_raw_table, 1, EO_STAGE_RAW,
            "raw values, one row per load case; with a robust objective all load cases of the first scenario, then of "
            "the second .."),
    EO_LIST(struct input, unmodified, unmodified_values, "unmodified", &eo_stage_raw_table, 1, EO_STAGE_RAW,
            "the same of the unmodified pair"),
};
static const struct eo_table input_table = EO_TABLE("the input", struct input, input);

static const struct eo_field value[] = {
    EO_OUT(struct eo_objective_value, sums.f[0], "f1_um", &eo_unit_um,
           "peak-to-peak transmission error over the load cases"),
    EO_OUT(struct eo_objective_value, sums.f[1], "f2_N", &eo_unit_N, "entering impact"),
    EO_OUT(struct eo_objective_value, sums.f[2], "f3_m_per_s2", &eo_unit_m_per_s2, "vibration"),
    EO_OUT(struct eo_objective_value, objective, "J", NULL, "null when a load case failed"),
    EO_OUT(struct eo_objective_value, violation, "violation", NULL,
           "sum of the relative excesses over the constraints"),
    EO_OUT(struct eo_objective_value, fitness, "fitness", NULL, "1/J - penalty violation"),
    EO_FLAG(struct eo_objective_value, sums.failed, "failed", 0, "a load case failed"),
};
static const struct eo_table value_table = EO_TABLE("a value", struct eo_objective_value, value);

struct output {
  struct eo_objective_value given, unmodified;
};

static const struct eo_field output[] = {
    EO_OBJECT(struct output, given, "objectives", &value_table, "of values"),
    EO_OBJECT(struct output, unmodified, "unmodified", &value_table, "of the unmodified pair"),
};
static const struct eo_table output_table = EO_TABLE("the output", struct output, output);

static enum eo_code check_rows(const struct input *given, int rows, struct eo_error *error)
{
  if (given->values != rows)
    return eo_error_set(error, EO_ERROR_INPUT, "/values", "%d rows, but %d load cases times %d scenarios.",
                        given->values, given->design.load_cases, rows / given->design.load_cases);
  if (given->unmodified_values != rows)
    return eo_error_set(error, EO_ERROR_INPUT, "/unmodified", "%d rows, but %d in values.", given->unmodified_values,
                        rows);
  return EO_OK;
}

static enum eo_code run(const void *in, void *out, struct eo_error *error)
{
  const struct input *given = in;
  struct output *found = out;
  struct eo_design design = given->design;
  const struct eo_geometry profile = {.rack_bottom = given->bottom, .rack_top = given->top};
  static const struct eo_modification none = {0};
  struct eo_faults faults = {0};
  if (eo_objective_wants_scalars(&design.objective))
    return eo_error_set(
        error, EO_ERROR_INPUT, design.objective.terms > 0 ? "/objective/terms" : "/objective/limits",
        "The raw values of this stage do not hold the numbers that terms and limits ask for: leave them "
        "out.");
  eo_load_cases_settle(NULL, design.load_case, design.load_cases, NULL, &faults);
  enum eo_code code = eo_faults_first(&faults, error);
  if (!code)
    code = check_rows(given, design.load_cases * eo_evaluator_scenarios(&design), error);
  if (code)
    return code;
  eo_evaluator_combine(&design, &profile, given->value, given->unmodified, &found->given);
  design.modification = none;
  eo_evaluator_combine(&design, &profile, given->unmodified, given->unmodified, &found->unmodified);
  return EO_OK;
}

const struct eo_stage eo_stage_objective = {
    "objective", "objectives and fitness from raw values", &input_table, &output_table, true, run};
