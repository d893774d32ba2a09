/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/result.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "document/assumption.h"
#include "document/completion.h"
#include "document/geometry_table.h"
#include "document/result_private.h"
#include "gear/names.h"

#include <config.h>

static const char *const outcomes[] = {"converged", "contact_lost", "not_converged", NULL};

static int outcome_of(const struct eo_case_result *case_result)
{
  return (int)(case_result->contact_failures > 0 ? EO_VIBRATION_NOT_CONVERGED : case_result->vibration.outcome);
}

static const char *const directions[] = {"ahead", "astern", NULL};
static const char *const sequences[] = {"forwards", "backwards", NULL};

struct contact_half {
  struct eo_load_case load_case;
  int flank, sequence, outcome;
  double force;
  json_t *axial, *position, *lte, *stiffness, *contact;
};

static const struct eo_outline_row contact_rows[] = {
    EO_KEY("torque_Nm", "number", "on the pinion shaft, both ends together", .unit = &eo_unit_Nm,
           EO_AT(struct contact_half, load_case.torque)),
    EO_KEY("speed_rpm", "number", "of the pinion", .unit = &eo_unit_rpm, EO_AT(struct contact_half, load_case.speed)),
    EO_KEY("share", "number", "of the operating time", EO_AT(struct contact_half, load_case.share)),
    EO_KEY("name", "text", "for people", EO_AT(struct contact_half, load_case.name)),
    EO_KEY("direction", "word", "of rotation", .words = directions, EO_AT(struct contact_half, load_case.direction)),
    EO_KEY("driver", "word", "which member drives", .words = eo_member_name,
           EO_AT(struct contact_half, load_case.driver)),
    EO_KEY("flank", "word", "which flanks carry", .words = eo_flank_side_name, EO_AT(struct contact_half, flank)),
    EO_KEY("sequence", "word",
           "forwards: positions follow each other in time; backwards: the gear drives, time runs "
           "against position",
           .words = sequences, EO_AT(struct contact_half, sequence)),
    EO_KEY("normal_force_N", "number", "of one end, normal to the teeth", .unit = &eo_unit_N,
           EO_AT(struct contact_half, force)),
    EO_KEY("axial", "object", "rotation, first contact and forces along the axes", .outline = &eo_outline_axial,
           EO_AT(struct contact_half, axial)),
    EO_KEY("outcome", "word", "not_converged: of the contact or of the vibration; contact_lost: teeth separate",
           .words = outcomes, EO_AT(struct contact_half, outcome)),
    EO_KEY("position", "[number]", "phase of the mesh cycle of the left end, 0..1, over which the static curves run",
           EO_AT(struct contact_half, position)),
    EO_KEY("lte", "object", "loaded transmission error, transverse", .outline = &eo_outline_lte,
           EO_AT(struct contact_half, lte)),
    EO_KEY("mesh_stiffness", "object", "mesh stiffness, normal", .outline = &eo_outline_stiffness,
           EO_AT(struct contact_half, stiffness)),
    EO_KEY("contact", "object", "loads, pressure, contact pattern", .outline = &eo_outline_contact,
           EO_AT(struct contact_half, contact)),
};
static const struct eo_outline contact_half = EO_OUTLINE(NULL, contact_rows);

struct consequence_half {
  bool elastic; /* shafts */
  json_t *bodies, *impact, *root, *vibration;
};

static const struct eo_outline_row consequence_rows[] = {
    EO_KEY("body_deflection", "object", "what shafts and bodies do to the gap", .when = "with elastic shafts",
           .outline = &eo_outline_bodies, EO_AT(struct consequence_half, bodies),
           EO_IF(struct consequence_half, elastic)),
    EO_KEY("impact", "object", "entering impact", .outline = &eo_outline_impact,
           EO_AT(struct consequence_half, impact)),
    EO_KEY("root_stress", "object?", "null when it was not asked for", .outline = &eo_outline_root_stress,
           EO_AT(struct consequence_half, root)),
    EO_KEY("vibration", "object", "vibration", .outline = &eo_outline_vibration,
           EO_AT(struct consequence_half, vibration)),
};
static const struct eo_outline consequence_half = EO_OUTLINE(NULL, consequence_rows);

static const struct eo_outline_row case_rows[] = {{.outline = &contact_half}, {.outline = &consequence_half}};
static const struct eo_outline case_outline = EO_OUTLINE("LoadCaseResult", case_rows);

json_t *eo_result_case_contact(struct eo_result_source *source, int k)
{
  const struct eo_case_result *case_result = &source->evaluation->load_case[k];
  source->lag = eo_evaluator_stagger(source->pair, source->design, &case_result->running);
  const struct contact_half view = {.load_case = case_result->load_case,
                                    .flank = (int)case_result->running.flank,
                                    .sequence = case_result->running.backwards,
                                    .force = case_result->force,
                                    .axial = eo_result_axial(source, case_result),
                                    .outcome = outcome_of(case_result),
                                    .position = eo_result_position(source),
                                    .lte = eo_result_lte(source, case_result),
                                    .stiffness = eo_result_stiffness(source, case_result),
                                    .contact = eo_result_contact(source, k)};
  return eo_outline_encode(&contact_half, &view);
}

json_t *eo_result_case_consequences(struct eo_result_source *source, int k)
{
  const struct eo_case_result *case_result = &source->evaluation->load_case[k];
  bool elastic = source->design->shafts.enabled;
  const struct consequence_half view = {.elastic = elastic,
                                        .bodies = elastic ? eo_result_bodies(source, case_result) : NULL,
                                        .impact = eo_result_impact(source, case_result),
                                        .root = eo_result_root_stress(source, case_result),
                                        .vibration = eo_result_vibration(source, case_result)};
  return eo_outline_encode(&consequence_half, &view);
}

/* Takes both; NULL when one is. */
static json_t *unite(json_t *first, json_t *second)
{
  bool failed = !first || !second || json_object_update(first, second) != 0;
  json_decref(second);
  if (!failed)
    return first;
  json_decref(first);
  return NULL;
}

static json_t *encode_case(struct eo_result_source *source, int k)
{
  return unite(eo_result_case_contact(source, k), eo_result_case_consequences(source, k));
}

static json_t *encode_cases(struct eo_result_source *source)
{
  struct eo_object cases = eo_list_open();
  for (int k = 0; k < source->evaluation->cases; k++)
    eo_list_add(&cases, encode_case(source, k));
  return eo_object_close(&cases);
}

struct raw_case {
  struct eo_load_case load_case;
  struct eo_objective_case raw;
};

static bool raw_is_known(const void *source)
{
  return !((const struct raw_case *)source)->raw.failed;
}

#define EO_RAW(member) EO_AT(struct raw_case, raw.member), .known = raw_is_known
static const struct eo_outline_row raw_case_rows[] = {
    EO_KEY("torque_Nm", "number", "on the pinion shaft", .unit = &eo_unit_Nm, EO_AT(struct raw_case, load_case.torque)),
    EO_KEY("speed_rpm", "number", "of the pinion", .unit = &eo_unit_rpm, EO_AT(struct raw_case, load_case.speed)),
    EO_KEY("peak_to_peak_um", "number?", "loaded transmission error; null, as all below, when the evaluation failed",
           .unit = &eo_unit_um, EO_RAW(peak_to_peak)),
    EO_KEY("impact_N", "number?", "general entering impact, worse end", .unit = &eo_unit_N, EO_RAW(impact)),
    EO_KEY("rms_m_per_s2", "number?", "normal acceleration, RMS", .unit = &eo_unit_m_per_s2, EO_RAW(rms)),
    EO_KEY("contact_pressure_MPa", "number?", "largest", .unit = &eo_unit_MPa, EO_RAW(contact_pressure)),
    EO_KEY("root_stress_MPa", "number?", "largest; null when it was not computed", .unit = &eo_unit_MPa,
           EO_RAW(root_stress)),
    EO_KEY("edge_load_share", "number?", "share of the load on tip edges", EO_RAW(edge_load_share)),
    EO_KEY("contact_loss", "number?", "share of the mesh cycle without contact", EO_RAW(contact_loss)),
    EO_KEY("flank_safety", "number?",
           "least S_H of the duty cycle, at its first load case; null elsewhere, and when no limit asks for the rating",
           EO_RAW(flank_safety)),
    EO_KEY("root_safety", "number?", "least S_F, the same", EO_RAW(root_safety)),
    EO_KEY("film_ratio", "number?", "least specific film thickness, the same", EO_RAW(film_ratio)),
    EO_KEY("contact_temperature_C", "number?", "largest, the same", .unit = &eo_unit_C, EO_RAW(contact_temperature)),
};
const struct eo_outline eo_outline_raw_case = EO_OUTLINE("RawCase", raw_case_rows);

json_t *eo_result_raw_case(const struct eo_load_case *load_case, const struct eo_objective_case *raw)
{
  const struct raw_case source = {*load_case, *raw};
  return eo_outline_encode(&eo_outline_raw_case, &source);
}

static json_t *encode_raw(const struct eo_result_source *source, const struct eo_objective_case *raw)
{
  struct eo_object cases = eo_list_open();
  for (int k = 0; k < source->evaluation->cases; k++)
    eo_list_add(&cases, eo_result_raw_case(&source->design->load_case[k], &raw[k]));
  return eo_object_close(&cases);
}

static bool sums_are_known(const void *source)
{
  return !((const struct eo_objective_value *)source)->sums.failed;
}

static bool has_terms(const void *source)
{
  return ((const struct eo_objective_value *)source)->terms > 0;
}

static bool has_nominal(const void *source)
{
  return !isnan(((const struct eo_objective_value *)source)->nominal);
}

static json_t *write_terms(const void *source)
{
  const struct eo_objective_value *value = source;
  json_t *array = json_array();
  for (int i = 0; i < value->terms && array; i++)
    if (json_array_append_new(array, eo_json_real(value->sums.failed ? NAN : value->term[i], NULL)) != 0) {
      json_decref(array);
      array = NULL;
    }
  return array;
}

#define EO_SUM(index) EO_AT(struct eo_objective_value, sums.f[index]), .known = sums_are_known
static const struct eo_outline_row value_rows[] = {
    EO_KEY("f1_um", "number?",
           "first objective: loaded transmission error over the duty cycle; null, as all, when it is not known",
           .unit = &eo_unit_um, EO_SUM(0)),
    EO_KEY("f2_N", "number?", "second: entering impact", .unit = &eo_unit_N, EO_SUM(1)),
    EO_KEY("f3_m_per_s2", "number?", "third: vibration", .unit = &eo_unit_m_per_s2, EO_SUM(2)),
    EO_KEY("J", "number?", "their weighted sum: what is minimised", EO_AT(struct eo_objective_value, objective)),
    EO_KEY("fitness", "number?", "1/J less penalties", EO_AT(struct eo_objective_value, fitness)),
    EO_KEY("violation", "number?", "sum of the violated constraints, relative; 0: feasible",
           EO_AT(struct eo_objective_value, violation)),
    EO_KEY("terms", "[number?]", "of objective.terms, in their order and units", .when = "of an objective with terms",
           .write = write_terms, .there = has_terms),
    EO_KEY("nominal_J", "number?", "J of the nominal pair alone, where J is the robust one",
           .when = "of a front of the nominal against the robust objective", EO_AT(struct eo_objective_value, nominal),
           .there = has_nominal),
};
const struct eo_outline eo_outline_value = EO_OUTLINE("Value", value_rows);

struct unmodified {
  struct eo_objective_value value;
  json_t *cases;
};
struct objectives {
  struct eo_objective_value value;
  json_t *cases;
  struct unmodified unmodified;
  int scenarios;
};

static const struct eo_outline_row unmodified_rows[] = {
    {.outline = &eo_outline_value, EO_AT(struct unmodified, value)},
    EO_KEY("load_cases", "[object]", "one for each load case", .outline = &eo_outline_raw_case,
           EO_AT(struct unmodified, cases)),
};
static const struct eo_outline unmodified_outline = EO_OUTLINE("UnmodifiedObjectives", unmodified_rows);

static const struct eo_outline_row objective_rows[] = {
    {.outline = &eo_outline_value, EO_AT(struct objectives, value)},
    EO_KEY("load_cases", "[object]", "one for each load case", .outline = &eo_outline_raw_case,
           EO_AT(struct objectives, cases)),
    EO_KEY("unmodified", "object", "of the pair without its modification", .outline = &unmodified_outline,
           EO_AT(struct objectives, unmodified)),
    EO_KEY("scenarios", "integer", "of a robust objective that were evaluated; 1: the nominal one",
           EO_AT(struct objectives, scenarios)),
};
static const struct eo_outline objectives_outline = EO_OUTLINE("ResultObjectives", objective_rows);

json_t *eo_result_objectives(const struct eo_result_source *source)
{
  const struct eo_analysis *analysis = source->analysis;
  const struct objectives view = {
      .value = analysis->value,
      .cases = encode_raw(source, source->evaluation->objective),
      .unmodified = {analysis->unmodified_value, encode_raw(source, analysis->unmodified)},
      .scenarios = analysis->scenarios,
  };
  return eo_outline_encode(&objectives_outline, &view);
}

struct timing {
  double preparation, unmodified, contact, impact, root, dynamics, evaluation, rating, pitch; /* s */
};

static const struct eo_outline_row timing_rows[] = {
    EO_KEY("preparation", "number", "of the gear pair, once", .unit = &eo_unit_ms, EO_AT(struct timing, preparation)),
    EO_KEY("unmodified", "number", "of the unmodified pair, once", .unit = &eo_unit_ms,
           EO_AT(struct timing, unmodified)),
    EO_KEY("static", "number", "loaded contact", .unit = &eo_unit_ms, EO_AT(struct timing, contact)),
    EO_KEY("impact", "number", "entering impact", .unit = &eo_unit_ms, EO_AT(struct timing, impact)),
    EO_KEY("root", "number", "root stress", .unit = &eo_unit_ms, EO_AT(struct timing, root)),
    EO_KEY("dynamics", "number", "vibration", .unit = &eo_unit_ms, EO_AT(struct timing, dynamics)),
    EO_KEY("rating", "number", "rating and tribology, on top of the evaluation", .unit = &eo_unit_ms,
           EO_AT(struct timing, rating)),
    EO_KEY("pitch", "number", "the hunting period, on top of the evaluation", .unit = &eo_unit_ms,
           EO_AT(struct timing, pitch)),
    EO_KEY("evaluation", "number", "of the design altogether", .unit = &eo_unit_ms, EO_AT(struct timing, evaluation)),
};
static const struct eo_outline timing = EO_OUTLINE("Timing", timing_rows);

/* To the microsecond. */
static double seconds_of(double milliseconds)
{
  return 1e-6 * round(1e3 * milliseconds);
}

static json_t *encode_timing(const struct eo_result_source *source)
{
  const struct eo_evaluation *evaluation = source->evaluation;
  const struct timing seconds = {.preparation = seconds_of(1e3 * source->pair->seconds),
                                 .unmodified = seconds_of(source->analysis->unmodified_ms),
                                 .contact = seconds_of(evaluation->static_ms),
                                 .impact = seconds_of(evaluation->impact_ms),
                                 .root = seconds_of(evaluation->root_ms),
                                 .dynamics = seconds_of(evaluation->dynamics_ms),
                                 .rating = seconds_of(source->analysis->rating_ms),
                                 .pitch = seconds_of(source->analysis->pitch.milliseconds),
                                 .evaluation = seconds_of(source->analysis->design_ms)};
  return eo_outline_encode(&timing, &seconds);
}

/* What stands before the load cases. */
struct result_head {
  const char *program;
  bool uneven, two_helices; /* halves that differ; in their helices */
  json_t *design, *assumed, *right_geometry, *dimensions, *right_dimensions, *flexibility, *modification, *unloaded;
  char design_hash[EO_HASH_LENGTH + 1], evaluation_hash[EO_HASH_LENGTH + 1];
  struct eo_resolution resolution;
  struct eo_geometry geometry;
};

#define OF_HEAD(member) EO_AT(struct result_head, member)
static const struct eo_outline_row head_rows[] = {
    EO_KEY("program", "text", "name and version", OF_HEAD(program)),
    EO_KEY("design", "object?", "with every default resolved; null when left out", .table = &eo_design_table,
           .name = "ResolvedDesign", OF_HEAD(design)),
    EO_KEY("design_hash", "text", "SHA-256 of the canonical design", OF_HEAD(design_hash)),
    EO_KEY("evaluation_hash", "text", "the same without name, rating, pitch, objective and optimization",
           OF_HEAD(evaluation_hash)),
    EO_KEY("assumed", "[object]?",
           "what the design does not state, the value taken, and by which rule; null when left out",
           .outline = &eo_outline_assumption, OF_HEAD(assumed)),
    EO_KEY("resolution", "object", "of the design, once more", .table = &eo_resolution_table, .name = "Resolution",
           OF_HEAD(resolution)),
    EO_KEY("geometry", "object", "macro-geometry", .table = &eo_geometry_table, .name = "Geometry", OF_HEAD(geometry)),
    EO_KEY("right_geometry", "object?", "the same of the right end", .table = &eo_geometry_table, .name = "Geometry",
           .when = EO_UNEVEN, OF_HEAD(right_geometry), EO_IF(struct result_head, uneven)),
    EO_KEY("dimensions", "object?", "what is measured on the members and between them; null when left out",
           .outline = &eo_outline_dimensions, OF_HEAD(dimensions)),
    EO_KEY("right_dimensions", "object?", "the same of the right end", .outline = &eo_outline_dimensions,
           .when = EO_TWO_HELICES, OF_HEAD(right_dimensions), EO_IF(struct result_head, two_helices)),
    EO_KEY("flexibility", "object", "how the teeth's flexibility was modelled", .outline = &eo_outline_flexibility,
           OF_HEAD(flexibility)),
    EO_KEY("modification", "object?", "as curves; null when left out", .outline = &eo_outline_modification,
           OF_HEAD(modification)),
    EO_KEY("unloaded_contact", "object", "the same for every load case", .outline = &eo_outline_unloaded,
           OF_HEAD(unloaded)),
};
static const struct eo_outline head_outline = EO_OUTLINE(NULL, head_rows);

struct result_cases {
  json_t *cases;
};
static const struct eo_outline_row cases_rows[] = {
    EO_KEY("load_cases", "[object]", "in the order of the design", .outline = &case_outline,
           EO_AT(struct result_cases, cases)),
};
static const struct eo_outline cases_outline = EO_OUTLINE(NULL, cases_rows);

/* What stands behind them. */
struct result_tail {
  struct eo_series frequency, damping_ratio;
  json_t *objectives, *rating, *tribology, *pitch, *warnings, *findings, *timing;
};

#define OF_TAIL(member) EO_AT(struct result_tail, member)
static const struct eo_outline_row tail_rows[] = {
    EO_KEY("objectives", "object", "of the duty cycle", .outline = &objectives_outline, OF_TAIL(objectives)),
    EO_KEY("eigenfrequencies_Hz", "[number?]?", "with the mean mesh stiffness of the load case with the heaviest share",
           .unit = &eo_unit_Hz, OF_TAIL(frequency)),
    EO_KEY("damping_ratios", "[number?]?", "of these modes", OF_TAIL(damping_ratio)),
    EO_KEY("rating", "object?", "load capacity by ISO 6336; null when it was not asked for",
           .outline = &eo_outline_rating, OF_TAIL(rating)),
    EO_KEY("tribology", "object?", "sliding, flash temperature, film; null when it was not asked for",
           .outline = &eo_outline_tribology, OF_TAIL(tribology)),
    EO_KEY("pitch", "object?",
           "single teeth over the hunting period; null when the design states none or they were not asked for",
           .outline = &eo_outline_pitch, OF_TAIL(pitch)),
    EO_KEY("warnings", "[text]", "in plain words", OF_TAIL(warnings)),
    EO_KEY("findings", "[object]", "those of them that belong to a field of the design", .outline = &eo_outline_finding,
           OF_TAIL(findings)),
    EO_KEY("timing_ms", "object", "the only part that differs between two runs", .outline = &timing, OF_TAIL(timing)),
};
static const struct eo_outline tail_outline = EO_OUTLINE(NULL, tail_rows);

static const struct eo_outline_row result_rows[] = {
    {.outline = &head_outline},
    {.outline = &cases_outline},
    {.outline = &tail_outline},
};
const struct eo_outline eo_result_outline = EO_OUTLINE("Result", result_rows);
json_t *eo_result_head(struct eo_result_source *source)
{
  const struct eo_design *design = source->design;
  const struct eo_geometry *geometry = &source->pair->geometry;
  bool rating = source->analysis->want & EO_WANT_RATING, whole = eo_result_has(source, EO_RESULT_NO_DESIGN, NULL),
       assumed = eo_result_has(source, EO_RESULT_NO_ASSUMED, NULL),
       modification = eo_result_has(source, EO_RESULT_NO_MODIFICATION, NULL);
  struct result_head head = {.program = PACKAGE_STRING, .resolution = design->resolution, .geometry = *geometry};
  json_t *document = eo_design_encode(design);
  if (eo_design_hash_document(document, head.design_hash, NULL) ||
      eo_design_evaluation_hash_document(document, head.evaluation_hash, NULL)) {
    json_decref(document);
    return NULL;
  }
  head.design = whole ? json_incref(document) : json_null();
  json_decref(document);
  head.assumed = assumed ? eo_assumptions_encode(design, rating) : json_null();
  head.dimensions = assumed ? eo_dimensions_encode(&design->gear_pair, geometry) : json_null();
  head.uneven = source->pair->right;
  head.two_helices = eo_gear_pair_has_two_helices(&source->pair->gear_pair);
  if (head.uneven)
    head.right_geometry = eo_table_encode(&eo_geometry_table, &source->pair->right->geometry);
  if (head.two_helices) {
    const struct eo_gear_pair right = eo_gear_pair_half(&design->gear_pair, EO_RIGHT);
    head.right_dimensions = assumed ? eo_dimensions_encode(&right, &source->pair->right->geometry) : json_null();
  }
  head.flexibility = eo_result_flexibility(source);
  head.modification = modification ? eo_result_modification(source) : json_null();
  head.unloaded = eo_result_unloaded(source);
  return eo_outline_encode(&head_outline, &head);
}

json_t *eo_result_tail(const struct eo_result_source *source, const struct eo_warnings *warnings)
{
  const struct eo_dynamics_modes *modes = &source->evaluation->modes;
  bool have_modes = source->analysis->want & EO_WANT_CURVES;
  const struct result_tail tail = {
      .frequency = eo_series_of(modes->n, have_modes ? modes->frequency : NULL, EO_DIGITS_CURVE),
      .damping_ratio = eo_series_of(modes->n, have_modes ? modes->damping_ratio : NULL, EO_DIGITS_CURVE),
      .objectives = eo_result_objectives(source),
      .rating = eo_result_rating(source),
      .tribology = eo_result_tribology(source),
      .pitch = eo_result_pitch(source),
      .warnings = eo_result_warnings(source, warnings),
      .findings = eo_design_findings(warnings),
      .timing = encode_timing(source)};
  return eo_outline_encode(&tail_outline, &tail);
}

static json_t *encode_all(struct eo_result_source *source, const struct eo_warnings *warnings)
{
  json_t *head = eo_result_head(source);
  const struct result_cases cases = {encode_cases(source)};
  return unite(unite(head, eo_outline_encode(&cases_outline, &cases)), eo_result_tail(source, warnings));
}

json_t *eo_result_encode(const struct eo_analysis *analysis, const struct eo_design *design,
                         const struct eo_warnings *warnings)
{
  return eo_result_encode_part(analysis, design, warnings, 0);
}

json_t *eo_result_encode_part(const struct eo_analysis *analysis, const struct eo_design *design,
                              const struct eo_warnings *warnings, unsigned left_out)
{
  struct eo_result_source source;
  double edge_pressure[EO_MAX_LOAD_CASES][2];
  bool good = eo_result_source_init(&source, analysis, design, left_out);
  source.edge_pressure = edge_pressure;
  json_t *result = good ? encode_all(&source, warnings) : NULL;
  eo_result_source_done(&source);
  return result;
}
