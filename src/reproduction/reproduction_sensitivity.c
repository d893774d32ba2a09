/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One assumption changed at a time: what it does to the unmodified pair and to Table 3, case A. */
#include "reproduction/reproduction_private.h"

#include <math.h>
#include <stdlib.h>

#include "evaluation/analysis.h"

static const double DEGREE = M_PI / 180;

struct alternative {
  const char *assumption, *value;
  void (*apply)(struct eo_design *design);
  double compliance; /* factor; 0: 1 */
};

static void nothing(struct eo_design *design)
{
  (void)design;
}
static void aligned(struct eo_design *design)
{
  design->alignment.shaft_angle_in_plane = 0;
}
static void half_error(struct eo_design *design)
{
  design->alignment.shaft_angle_in_plane = 0.05 * DEGREE;
}
static void more_error(struct eo_design *design)
{
  design->alignment.shaft_angle_in_plane = 0.12 * DEGREE;
}
static void arc_minute(struct eo_design *design)
{
  design->alignment.shaft_angle_in_plane = 0.1 / 60 * DEGREE;
}
static void out_of_plane(struct eo_design *design)
{
  design->alignment.shaft_angle_in_plane = 0;
  design->alignment.shaft_angle_out_of_plane = 0.1 * DEGREE;
}
static void secant(struct eo_design *design)
{
  design->resolution.mesh_law = EO_LAW_SECANT;
}
static void table(struct eo_design *design)
{
  design->resolution.mesh_law = EO_LAW_TABLE;
}
static void pulses(struct eo_design *design)
{
  design->resolution.impact_in_dynamics = EO_IMPACT_PAPER;
}
static void scale_bearings(struct eo_design *design, double factor)
{
  for (int i = 0; i < 2; i++) {
    design->supports.bearing_stiffness[i] *= factor;
    design->supports.gear_axial_stiffness[i] *= factor;
  }
}
static void soft_bearings(struct eo_design *design)
{
  scale_bearings(design, 0.5);
}
static void stiff_bearings(struct eo_design *design)
{
  scale_bearings(design, 2);
}
static void less_damping(struct eo_design *design)
{
  design->supports.mesh_damping_ratio *= 0.5;
}
static void more_damping(struct eo_design *design)
{
  design->supports.mesh_damping_ratio *= 1.5;
}
static void small_patch(struct eo_design *design)
{
  design->resolution.impact_patch = 2e-3;
}
static void large_patch(struct eo_design *design)
{
  design->resolution.impact_patch = 20e-3;
}
static void no_edges(struct eo_design *design)
{
  design->resolution.tip_edge_contact = false;
}
static void held_ring(struct eo_design *design)
{
  design->resolution.elements.support = EO_SUPPORT_HELD;
}
static void sector(struct eo_design *design)
{
  design->resolution.elements.body = EO_BODY_SECTOR;
}
static void small_sector(struct eo_design *design)
{
  design->resolution.elements.body = EO_BODY_SECTOR;
  design->resolution.elements.sector_teeth = 3;
  design->resolution.elements.neighbour_coupling = false;
}

static const struct alternative alternatives[] = {
    {"(as assumed)", "", nothing, 0},
    {"shaft angle error", "none", aligned, 0},
    {"shaft angle error", "0.05 deg in plane", half_error, 0},
    {"shaft angle error", "0.12 deg in plane", more_error, 0},
    {"shaft angle error", "0.1 arc minute in plane", arc_minute, 0},
    {"shaft angle error", "0.1 deg out of plane", out_of_plane, 0},
    {"flexibility of the teeth", "-10 %", nothing, 0.9},
    {"flexibility of the teeth", "+10 %", nothing, 1.1},
    {"mesh law", "secant (paper)", secant, 0},
    {"mesh law", "table of loads", table, 0},
    {"impact in the equations", "as printed", pulses, 0},
    {"impact patch", "2 mm", small_patch, 0},
    {"impact patch", "20 mm", large_patch, 0},
    {"bearing stiffness", "half", soft_bearings, 0},
    {"bearing stiffness", "double", stiff_bearings, 0},
    {"mesh damping", "half", less_damping, 0},
    {"mesh damping", "+50 %", more_damping, 0},
    {"tip edge contact", "off", no_edges, 0},
    {"body of the members", "ring, held 3.5 m_n below the root", held_ring, 0},
    {"body of the members", "sector of 5 teeth, next pairs coupled", sector, 0},
    {"body of the members", "sector of 3 teeth, no coupling", small_sector, 0},
};
enum { ALTERNATIVES = sizeof alternatives / sizeof alternatives[0] };

/* Values of both designs under one alternative, at a compliance that a scenario states. */
static enum eo_code evaluate(struct eo_evaluator *evaluator, const struct eo_design *design, double compliance,
                             struct eo_objective_case raw[TORQUES], struct eo_error *error)
{
  const struct eo_scenario scenario = {design->alignment.shaft_angle_in_plane,
                                       design->alignment.shaft_angle_out_of_plane, compliance, 1};
  const struct eo_evaluation *evaluation;
  enum eo_code code = eo_evaluator_run(evaluator, design, compliance > 0 ? &scenario : NULL, 0, &evaluation, error);
  for (int k = 0; k < TORQUES && !code; k++)
    raw[k] = evaluation->objective[k];
  return code;
}

/* An alternative as it is written; at the three torques. */
struct sensitivity_row {
  const char *assumption, *value;
  struct eo_series rms[2], impact[2];                        /* unmodified, case A */
  struct eo_series less_rms, less_transmission, less_impact; /* per cent */
  double objective;
};

#define OF_ROW(member) EO_AT(struct sensitivity_row, member)
static const struct eo_outline_row sensitivity_rows[] = {
    EO_KEY("assumption", "text", "what is changed", OF_ROW(assumption)),
    EO_KEY("value", "text", "to what; empty: as assumed", OF_ROW(value)),
    EO_KEY("rms_unmodified_m_per_s2", "[number?]", "at the three torques, as all below; null: there is no vibration",
           OF_ROW(rms[0])),
    EO_KEY("rms_case_a_m_per_s2", "[number?]", "of Table 3, case A", OF_ROW(rms[1])),
    EO_KEY("impact_unmodified_N", "[number?]", "entering impact", OF_ROW(impact[0])),
    EO_KEY("impact_case_a_N", "[number?]", "of Table 3, case A", OF_ROW(impact[1])),
    EO_KEY("rms_reduction_percent", "[number?]", "by case A", OF_ROW(less_rms)),
    EO_KEY("lte_reduction_percent", "[number?]", "of the loaded transmission error", OF_ROW(less_transmission)),
    EO_KEY("impact_reduction_percent", "[number?]", "of the entering impact", OF_ROW(less_impact)),
    EO_KEY("J_case_a", "number?", "related to the unmodified pair", OF_ROW(objective)),
};
const struct eo_outline eo_reproduction_assumption_outline = EO_OUTLINE("ReproducedAssumption", sensitivity_rows);

static json_t *encode_row(const struct alternative *alternative, const struct eo_design *design,
                          const struct eo_objective_case raw[2][TORQUES])
{
  struct eo_objective_value value;
  double rms[2][TORQUES], impact[2][TORQUES], less[3][TORQUES];
  struct sensitivity_row row = {.assumption = alternative->assumption, .value = alternative->value};
  eo_objective_value(&design->objective, TORQUES, design->load_case, raw[1], raw[0], false, &value);
  for (int k = 0; k < TORQUES; k++) {
    for (int i = 0; i < 2; i++) {
      rms[i][k] = raw[i][k].failed ? NAN : raw[i][k].rms;
      impact[i][k] = raw[i][k].impact;
    }
    less[0][k] = 100 * (1 - raw[1][k].rms / raw[0][k].rms);
    less[1][k] = 100 * (1 - raw[1][k].peak_to_peak / raw[0][k].peak_to_peak);
    less[2][k] = 100 * (1 - raw[1][k].impact / raw[0][k].impact);
  }
  for (int i = 0; i < 2; i++) {
    row.rms[i] = eo_series_of(TORQUES, rms[i], EO_DIGITS_NUMBER);
    row.impact[i] = eo_series_of(TORQUES, impact[i], EO_DIGITS_NUMBER);
  }
  row.less_rms = eo_series_of(TORQUES, less[0], EO_DIGITS_NUMBER);
  row.less_transmission = eo_series_of(TORQUES, less[1], EO_DIGITS_NUMBER);
  row.less_impact = eo_series_of(TORQUES, less[2], EO_DIGITS_NUMBER);
  row.objective = value.objective;
  return eo_outline_encode(&eo_reproduction_assumption_outline, &row);
}

static enum eo_code compare(struct reproduction *reproduction, const struct alternative *alternative,
                            struct eo_design *design, struct eo_evaluator *evaluator, json_t *rows,
                            struct eo_error *error)
{
  struct eo_objective_case raw[2][TORQUES];
  for (int i = 0; i < 2; i++) {
    design->modification = reproduction->design[i ? PAPER_A : UNMODIFIED]->modification;
    EO_TRY(evaluate(evaluator, design, alternative->compliance, raw[i], error));
  }
  json_t *row = encode_row(alternative, design, (const struct eo_objective_case(*)[TORQUES])raw);
  return json_array_append_new(rows, row) ? eo_error_memory(error) : EO_OK;
}

/* The pair at hand where it serves, else one made for this alternative. */
static enum eo_code try_alternative(struct reproduction *reproduction, const struct alternative *alternative,
                                    struct eo_design *design, json_t *rows, struct eo_error *error)
{
  const struct eo_pair_options options = {.cache_directory = reproduction->plan->cache_directory};
  struct eo_pair *own = NULL;
  struct eo_evaluator *evaluator = NULL;
  *design = *reproduction->design[UNMODIFIED];
  alternative->apply(design);
  if (!eo_pair_serves(reproduction->pair, design))
    EO_TRY(eo_pair_new(&own, design, &options, NULL, error));
  enum eo_code code = eo_evaluator_new(&evaluator, own ? own : reproduction->pair, TORQUES, error);
  if (!code)
    code = compare(reproduction, alternative, design, evaluator, rows, error);
  eo_evaluator_free(evaluator);
  eo_pair_free(own);
  return code;
}

enum eo_code eo_reproduction_sensitivity(struct reproduction *reproduction, json_t **result, struct eo_error *error)
{
  struct eo_design *design = malloc(sizeof *design);
  json_t *rows = json_array();
  enum eo_code code = design && rows ? EO_OK : eo_error_memory(error);
  for (int i = 0; i < ALTERNATIVES && !code; i++) {
    code = eo_reproduction_report(reproduction, "assumptions", 0.92 + 0.08 * i / ALTERNATIVES, error);
    if (!code)
      code = try_alternative(reproduction, &alternatives[i], design, rows, error);
  }
  free(design);
  if (code)
    json_decref(rows);
  else
    *result = rows;
  return code;
}
