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
  design->resolution.body_support = EO_SUPPORT_HELD;
}
static void sector(struct eo_design *design)
{
  design->resolution.body = EO_BODY_SECTOR;
}
static void small_sector(struct eo_design *design)
{
  design->resolution.body = EO_BODY_SECTOR;
  design->resolution.sector_teeth = 3;
  design->resolution.neighbour_coupling = false;
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

static json_t *encode_row(const struct alternative *alternative, const struct eo_design *design,
                          const struct eo_objective_case raw[2][TORQUES])
{
  struct eo_object object = eo_object_open();
  struct eo_objective_value value;
  json_t *unmodified = json_array(), *modified = json_array(), *reduction = json_array(), *transmission = json_array(),
         *impact = json_array();
  json_t *force[2] = {json_array(), json_array()};
  eo_objective_value(&design->objective, TORQUES, design->load_case, raw[1], raw[0], false, &value);
  for (int k = 0; k < TORQUES; k++) {
    json_array_append_new(unmodified, eo_json_quantity(raw[0][k].failed ? NAN : raw[0][k].rms, NULL));
    json_array_append_new(modified, eo_json_quantity(raw[1][k].failed ? NAN : raw[1][k].rms, NULL));
    json_array_append_new(reduction, eo_json_quantity(100 * (1 - raw[1][k].rms / raw[0][k].rms), NULL));
    json_array_append_new(transmission,
                          eo_json_quantity(100 * (1 - raw[1][k].peak_to_peak / raw[0][k].peak_to_peak), NULL));
    for (int i = 0; i < 2; i++)
      json_array_append_new(force[i], eo_json_quantity(raw[i][k].impact, NULL));
    json_array_append_new(impact, eo_json_quantity(100 * (1 - raw[1][k].impact / raw[0][k].impact), NULL));
  }
  eo_object_put(&object, "assumption", json_string(alternative->assumption));
  eo_object_put(&object, "value", json_string(alternative->value));
  eo_object_put(&object, "rms_unmodified_m_per_s2", unmodified);
  eo_object_put(&object, "rms_case_a_m_per_s2", modified);
  eo_object_put(&object, "impact_unmodified_N", force[0]);
  eo_object_put(&object, "impact_case_a_N", force[1]);
  eo_object_put(&object, "rms_reduction_percent", reduction);
  eo_object_put(&object, "lte_reduction_percent", transmission);
  eo_object_put(&object, "impact_reduction_percent", impact);
  eo_object_put(&object, "J_case_a", eo_json_quantity(value.objective, NULL));
  return eo_object_close(&object);
}

/* The pair at hand where it serves, else one made for this alternative. */
static enum eo_code try_alternative(struct reproduction *reproduction, const struct alternative *alternative,
                                    struct eo_design *design, json_t *rows, struct eo_error *error)
{
  struct eo_objective_case raw[2][TORQUES];
  const struct eo_pair_options options = {.cache_directory = reproduction->plan->cache_directory};
  struct eo_pair *own = NULL;
  struct eo_evaluator *evaluator = NULL;
  enum eo_code code = EO_OK;
  *design = *reproduction->design[UNMODIFIED];
  alternative->apply(design);
  if (!eo_pair_serves(reproduction->pair, design))
    code = eo_pair_new(&own, design, &options, NULL, error);
  if (!code)
    code = eo_evaluator_new(&evaluator, own ? own : reproduction->pair, TORQUES, error);
  for (int i = 0; i < 2 && !code; i++) {
    design->modification = reproduction->design[i ? PAPER_A : UNMODIFIED]->modification;
    code = evaluate(evaluator, design, alternative->compliance, raw[i], error);
  }
  if (!code &&
      json_array_append_new(rows, encode_row(alternative, design, (const struct eo_objective_case(*)[TORQUES])raw)))
    code = eo_error_memory(error);
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
