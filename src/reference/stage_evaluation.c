/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "reference/stage.h"
#include "reference/stage_mesh.h"
#include "evaluation/evaluator.h"

struct input {
  struct eo_design design;
  struct eo_stage_kernel kernel;
  enum eo_stage_pivot pivot;
  struct eo_scenario scenario;
  int impact_stations;
  bool root, band;
};

static const struct eo_field input[] = {
    EO_STAGE_GEAR_PAIR(struct input),
    EO_STAGE_MATERIAL(struct input),
    EO_STAGE_ALIGNMENT(struct input),
    EO_OBJECT(struct input, design.supports, "supports", &eo_supports_table, "as in a design document"),
    EO_OBJECT(struct input, design.shafts, "shafts", &eo_shafts_table, "as in a design document"),
    EO_LIST(struct input, design.load_case, design.load_cases, "load_cases", &eo_load_case_table, 1, EO_MAX_LOAD_CASES,
            "as in a design document; share is not used"),
    EO_STAGE_MODIFICATION(struct input),
    EO_STAGE_RESOLUTION(struct input),
    EO_STAGE_KERNEL(struct input, kernel),
    EO_STAGE_PIVOT(struct input, pivot),
    EO_OBJECT(struct input, scenario, "scenario", &eo_scenario_table, "departure from the nominal state"),
    EO_INTEGER(struct input, impact_stations, "impact_stations", 0, 10000, 0,
               "the entering touch is looked for at so many places over the face; 0 or 1: anywhere"),
    EO_FLAG(struct input, root, "root_stress", 0, "compute it; needs finite elements"),
    EO_FLAG(struct input, band, "band", 0, "RMS at 0.9 and 1.1 times the compliance"),
};
static const struct eo_table input_table = EO_TABLE("the input", struct input, input);

enum { UNLOADED, APPROACH, TANGENT, END_COLUMNS };
struct end_output {
  double peak_to_peak, datum, tangent_mean, rms[EO_READINGS];
  struct eo_impact impact;
  struct eo_numbers column[END_COLUMNS];
};

static const struct eo_field end_output[] = {
    EO_OUT_SERIES(struct end_output, column[UNLOADED], "unloaded_um", &eo_unit_um, "Z_0, normal"),
    EO_OUT_SERIES(struct end_output, column[APPROACH], "approach_um", &eo_unit_um, "Z, normal"),
    EO_OUT_SERIES(struct end_output, column[TANGENT], "tangent_N_per_um", &eo_unit_N_per_um, "k_tan, normal"),
    EO_OUT(struct end_output, tangent_mean, "mean_tangent_N_per_um", &eo_unit_N_per_um, "mean of k_tan"),
    EO_OUT(struct end_output, peak_to_peak, "peak_to_peak_um", &eo_unit_um,
           "of this end's transmission error alone, transverse"),
    EO_OUT(struct end_output, datum, "datum_um", &eo_unit_um, "smallest gap anywhere on the active flank, normal"),
    EO_OUT(struct end_output, impact.force, "general_force_N", &eo_unit_N, "entering impact"),
    EO_OUT(struct end_output, impact.classical, "force_N", &eo_unit_N,
           "the same when the first touch is off the path of contact, else 0"),
    EO_OUT(struct end_output, impact.speed, "impact_speed_mm_per_s", &eo_unit_mm_per_s, "closing, normal"),
    EO_OUT(struct end_output, impact.duration, "impact_duration_ms", &eo_unit_ms, "of the half sine"),
    EO_OUT(struct end_output, impact.phase, "impact_phase_mm", &eo_unit_mm, "c of the incoming pair at first touch"),
    EO_OUT(struct end_output, rms[EO_READING_NORMAL], "rms_normal_m_per_s2", &eo_unit_m_per_s2, "X''"),
    EO_OUT(struct end_output, rms[EO_READING_TRANSVERSE], "rms_transverse_m_per_s2", &eo_unit_m_per_s2,
           "with the bearings' motion"),
    EO_OUT(struct end_output, rms[EO_READING_ROTATIONAL], "rms_rotational_m_per_s2", &eo_unit_m_per_s2,
           "what encoders see"),
};
static const struct eo_table end_table = EO_TABLE("an end", struct end_output, end_output);

static const char *const outcomes[] = {"converged", "contact_lost", "not_converged", NULL};

struct case_output {
  struct eo_load_case load_case;
  struct eo_objective_case raw;
  double mean, rms[EO_READINGS], band[2];
  enum eo_vibration_outcome outcome;
  struct eo_numbers transmission;
  struct end_output left, right;
  int two;
};

static const struct eo_field case_output[] = {
    EO_OUT(struct case_output, load_case.torque, "torque_Nm", &eo_unit_Nm, "on the pinion shaft"),
    EO_OUT(struct case_output, load_case.speed, "speed_rpm", &eo_unit_rpm,
           "of the pinion, without the scenario's factor"),
    EO_OBJECT(struct case_output, raw, "values", &eo_stage_raw_table, "a row of stage objective's input"),
    EO_CHOICE(struct case_output, outcome, "outcome", outcomes, EO_VIBRATION_CONVERGED, "of the vibration"),
    EO_OUT(struct case_output, mean, "mean_um", &eo_unit_um, "of the pair's loaded transmission error, transverse"),
    EO_OUT_SERIES(struct case_output, transmission, "transmission_error_um", &eo_unit_um, "of the pair, transverse"),
    EO_OUT(struct case_output, rms[EO_READING_NORMAL], "rms_normal_m_per_s2", &eo_unit_m_per_s2,
           "mean of the ends' RMS"),
    EO_OUT(struct case_output, rms[EO_READING_TRANSVERSE], "rms_transverse_m_per_s2", &eo_unit_m_per_s2, "likewise"),
    EO_OUT(struct case_output, rms[EO_READING_ROTATIONAL], "rms_rotational_m_per_s2", &eo_unit_m_per_s2, "likewise"),
    EO_OUT_PAIR(struct case_output, band, "rms_band_m_per_s2", &eo_unit_m_per_s2,
                "normal RMS at 0.9 and 1.1 times the compliance; null unless asked for"),
    EO_OBJECT(struct case_output, left, "left", &end_table, "left end"),
    EO_OPTIONAL(struct case_output, right, two, "right", &end_table, "the pair has one end", "right end"),
};
static const struct eo_table case_table = EO_TABLE("a load case", struct case_output, case_output);

struct output {
  struct eo_numbers position;
  int cases;
  struct case_output load_case[EO_MAX_LOAD_CASES];
};

static const struct eo_field output[] = {
    EO_OUT_SERIES(struct output, position, "position", NULL, "mesh positions of the curves, 0 .. 1"),
    EO_LIST(struct output, load_case, cases, "load_cases", &case_table, 0, EO_MAX_LOAD_CASES, "one row per load case"),
};
static const struct eo_table output_table = EO_TABLE("the output", struct output, output);

static enum eo_code read_end(struct end_output *out, const struct eo_case_result *case_result, int end, int positions,
                             struct eo_error *error)
{
  const struct eo_end_result *end_result = &case_result->end[end];
  *out = (struct end_output){
      .peak_to_peak = end_result->transmission_peak, .datum = end_result->datum, .impact = end_result->impact};
  for (int i = 0; i < EO_READINGS; i++)
    out->rms[i] = case_result->vibration.rms[i][end];
  for (int j = 0; j < positions; j++)
    out->tangent_mean += end_result->loaded.tangent[j] / positions;
  EO_TRY(eo_stage_copy(&out->column[UNLOADED], positions, end_result->unloaded, error));
  EO_TRY(eo_stage_copy(&out->column[APPROACH], positions, end_result->loaded.approach, error));
  return eo_stage_copy(&out->column[TANGENT], positions, end_result->loaded.tangent, error);
}

static enum eo_code read_case(struct case_output *out, const struct eo_evaluation *evaluation, int k,
                              struct eo_error *error)
{
  const struct eo_case_result *case_result = &evaluation->load_case[k];
  out->load_case = case_result->load_case;
  out->raw = evaluation->objective[k];
  out->mean = case_result->mean;
  out->outcome = case_result->vibration.outcome;
  out->two = evaluation->ends == 2;
  for (int i = 0; i < EO_READINGS; i++)
    out->rms[i] = case_result->vibration.rms_pair[i];
  for (int i = 0; i < 2; i++)
    out->band[i] = case_result->band[EO_READING_NORMAL][i];
  EO_TRY(eo_stage_copy(&out->transmission, evaluation->positions, case_result->transmission, error));
  EO_TRY(read_end(&out->left, case_result, EO_LEFT, evaluation->positions, error));
  if (out->two)
    EO_TRY(read_end(&out->right, case_result, EO_RIGHT, evaluation->positions, error));
  return EO_OK;
}

static enum eo_code read_evaluation(struct output *out, const struct eo_evaluation *evaluation, struct eo_error *error)
{
  EO_TRY(eo_stage_columns(1, &out->position, evaluation->positions, error));
  for (int j = 0; j < evaluation->positions; j++)
    out->position.value[j] = (double)j / evaluation->positions;
  for (int k = 0; k < evaluation->cases; k++) {
    out->cases = k + 1;
    EO_TRY(read_case(&out->load_case[k], evaluation, k, error));
  }
  return EO_OK;
}

static enum eo_code evaluate_with(struct eo_evaluator *evaluator, struct output *found, const struct input *given,
                                  const struct eo_design *design, struct eo_error *error)
{
  const struct eo_evaluation *evaluation;
  int want = (given->root ? EO_WANT_ROOT : 0) | (given->band ? EO_WANT_BAND : 0);
  EO_TRY(eo_evaluator_run(evaluator, design, &given->scenario, want, &evaluation, error));
  return read_evaluation(found, evaluation, error);
}

static enum eo_code evaluate(struct output *found, const struct input *given, const struct eo_design *design,
                             struct eo_error *error)
{
  struct eo_pair *pair = NULL;
  struct eo_evaluator *evaluator = NULL;
  struct eo_pair_options options = eo_stage_pair_options(&given->kernel, given->pivot);
  options.impact_stations = given->impact_stations;
  EO_TRY(eo_pair_new(&pair, design, &options, NULL, error));
  enum eo_code code = eo_evaluator_new(&evaluator, pair, design->load_cases, error);
  if (!code)
    code = evaluate_with(evaluator, found, given, design, error);
  eo_evaluator_free(evaluator);
  eo_pair_free(pair);
  return code;
}

static enum eo_code run(const void *in, void *out, struct eo_error *error)
{
  const struct input *given = in;
  struct eo_design design = given->design;
  struct eo_geometry geometry;
  if (given->root && given->kernel.closed)
    return eo_error_set(error, EO_ERROR_INPUT, "/root_stress",
                        "A closed form knows no roots: finite elements are needed.");
  enum eo_code code = eo_stage_complete(&design, &geometry, EO_LEFT, error);
  return code ? code : evaluate(out, given, &design, error);
}

const struct eo_stage eo_stage_evaluation = {
    "evaluation", "one evaluation of a design: raw objectives and the curves they come from",
    &input_table, &output_table,
    true,         run};
