/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/verify_evaluation.h"

#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "design/resolution.h"
#include "evaluation/evaluator.h"
#include "gear/names.h"
#include "numerics/fourier.h"
#include "reference/case_pair.h"

enum { HARMONICS = 10 }; /* of transmission error and acceleration that the files list; the band of their mesh laws */

/* A prepared pair is kept while the next case wants the same one. */
struct bench {
  struct eo_case *file, *defaults;
  struct eo_verification *v;
  const char *pair_name;
  int flexibility;
  bool edges;
  struct eo_design design; /* of the pair, with the file's defaults */
  struct eo_closed_form form;
  struct eo_pair *pair;
  struct eo_evaluator *evaluator;
};

static const char *const flexibilities[] = {"fe", "synthetic", NULL};

static void replace(struct eo_case *block, const char *key, double *value)
{
  *value = eo_case_number_or(block, key, *value);
}

/* The file's dynamics parameters for a pair, or what the design derives where the file is silent. A mesh damping that
   differs from the usual one scales the damping ratio. */
static void set_supports(struct eo_supports *supports, struct eo_case *this_case, struct eo_case *usually)
{
  static const char *const bearing[2] = {"kpy", "kgy"}, *const axial[2] = {"kg1z", "kg2z"},
                           *const groove[2] = {"kpz", "kgz"};
  static const char *const torsion[2] = {"kt_p", "kt_g"}, *const mass[2] = {"mp", "mg"},
                           *const inertia[2] = {"Ip", "Ig"};
  for (int i = 0; i < 2; i++) {
    replace(this_case, bearing[i], &supports->bearing_stiffness[i]);
    replace(this_case, axial[i], &supports->gear_axial_stiffness[i]);
    replace(this_case, groove[i], &supports->groove_axial_stiffness[i]);
    replace(this_case, mass[i], &supports->mass[i]);
    replace(this_case, inertia[i], &supports->inertia[i]);
    double kt = eo_case_number_or(this_case, torsion[i], 0);
    if (kt > 0) {
      supports->groove_torsional_stiffness[i] = kt;
      supports->torsional_coupling = EO_COUPLING_ON;
    }
  }
  double cm = eo_case_number_or(this_case, "cm", NAN), usual = eo_case_number_or(usually, "cm", NAN);
  if (cm > 0 && usual > 0)
    supports->mesh_damping_ratio *= cm / usual;
}

/* Numbers of a block that the design derives: radii, dampers, equivalent mass. */
static enum eo_code check_parameters(struct eo_verification *verification, struct eo_case *block,
                                     const struct eo_design *design, struct eo_error *error)
{
  const double relative = 1e-6;
  struct eo_geometry geometry;
  struct eo_dynamics_parameters parameters;
  enum eo_code code = eo_geometry_init(&geometry, &design->gear_pair, error);
  if (!code)
    code = eo_dynamics_parameters_init(&parameters, &geometry, design->gear_pair.ends, 0, &design->supports, false, 1,
                                       error);
  if (code)
    return code;
  const struct {
    const char *key;
    double value;
  } row[] = {{"Rp", parameters.base_radius[0]},
             {"Rg", parameters.base_radius[1]},
             {"beta", parameters.base_helix_angle},
             {"cpy", parameters.bearing_damping[0]},
             {"cgy", parameters.bearing_damping[1]},
             {"cg1z", parameters.gear_axial_damping[0]},
             {"cg2z", parameters.gear_axial_damping[1]},
             {"cpz", parameters.groove_axial_damping[0]},
             {"cgz", parameters.groove_axial_damping[1]},
             {"cm", parameters.mesh_damping},
             {"me", eo_dynamics_equivalent_mass(&parameters)}};
  for (size_t i = 0; i < sizeof row / sizeof *row; i++)
    eo_verify_member(verification, block, row[i].key, row[i].value, relative, 0);
  return EO_OK;
}

/* The pair's design with the file's defaults, as far as it does not depend on the flexibility. */
static void read_pair(const struct bench *bench, struct eo_case *pair, struct eo_design *design)
{
  enum { MOST_POSITIONS = 4096, MOST_CELLS = 1000, MOST_HARMONICS = 256 };
  struct eo_resolution *resolution = &design->resolution;
  eo_case_design(eo_case_need(pair, "input"), design);
  double bore = eo_case_number_or(pair, "gear_bore_radius_m", design->gear_pair.bore[EO_GEAR] / 2);
  design->gear_pair.bore[EO_PINION] = 0;
  design->gear_pair.bore[EO_GEAR] = 2 * bore;
  resolution->positions = eo_case_whole_or(bench->defaults, "positions", 4, MOST_POSITIONS, 64);
  resolution->cells_per_line = eo_case_whole_or(bench->defaults, "cells_per_line", 2, MOST_CELLS, 30);
  resolution->harmonics = eo_case_whole_or(bench->defaults, "hb_harmonics", 1, MOST_HARMONICS, 24);
  resolution->te_harmonics = HARMONICS;
  resolution->elements.body = EO_BODY_SECTOR;
  resolution->elements.sector_teeth = eo_case_count(bench->defaults, "fe_flexibility", "-tooth sector", 3);
  resolution->elements.neighbour_coupling = eo_case_on(bench->defaults, "neighbour_tooth_coupling", true);
  design->supports.torsional_coupling = EO_COUPLING_OFF;
  design->supports.mesh_damping_stiffness = 20e9 * design->gear_pair.face_width;
}

static enum eo_code check_pair(void *context, struct eo_case *pair, struct eo_error *error)
{
  const struct bench *bench = context;
  struct eo_case *output = eo_case_find(pair, "check");
  struct eo_design design;
  struct eo_geometry geometry;
  read_pair(bench, pair, &design);
  if (eo_case_faulty(pair))
    return EO_OK;
  enum eo_code code = eo_geometry_init(&geometry, &design.gear_pair, error);
  if (!code && output)
    eo_case_check_geometry(bench->v, output, &geometry, 1e3, 1e-9);
  return code;
}

static enum eo_code check_pairs(void *context, struct eo_case *pairs, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  for (int i = 0; i < eo_case_size(pairs) && !code; i++)
    code = check_pair(context, eo_case_at(pairs, i), error);
  return code;
}

/* Parameters of a pair: what is input, and what follows from it. */
static enum eo_code check_dynamics(void *context, struct eo_case *block, struct eo_error *error)
{
  const struct bench *bench = context;
  struct eo_case *pair = eo_case_find(eo_case_find(bench->file, "pairs"), eo_case_key(block));
  struct eo_design design;
  struct eo_geometry geometry;
  if (!pair) {
    eo_case_fault(block, "There is no such pair.");
    return EO_OK;
  }
  read_pair(bench, pair, &design);
  set_supports(&design.supports, block, block);
  if (eo_case_faulty(pair))
    return EO_OK;
  enum eo_code code = eo_geometry_init(&geometry, &design.gear_pair, error);
  if (code)
    return code;
  eo_design_resolve(&design, &geometry);
  return check_parameters(bench->v, block, &design, error);
}

static enum eo_code read_modifications(void *context, struct eo_case *mods, struct eo_error *error)
{
  const struct bench *bench = context;
  const struct eo_gear_pair any = {.face_width = 1};
  struct eo_flank_modification flank;
  (void)error;
  (void)bench;
  for (int i = 0; i < eo_case_size(mods); i++)
    eo_case_modification(eo_case_at(mods, i), &any, &flank);
  return EO_OK;
}

static enum eo_code read_defaults(void *context, struct eo_case *block, struct eo_error *error)
{
  static const char *const words[] = {"cells",
                                      "gap",
                                      "pinion",
                                      "law",
                                      "secant",
                                      "band_limit",
                                      "rms",
                                      "bearings",
                                      "mesh_damping",
                                      "inertia_dynamics",
                                      "inertia_impact",
                                      "impact",
                                      "impact_speed",
                                      "tip_edge_contact",
                                      "synthetic_flexibility",
                                      "fe_flexibility"};
  const struct bench *bench = context;
  struct eo_design design;
  (void)error;
  for (size_t i = 0; i < sizeof words / sizeof *words; i++)
    eo_case_remark(block, words[i]);
  read_pair(bench, eo_case_at(eo_case_find(bench->file, "pairs"), 0), &design);
  return EO_OK;
}

static enum eo_code make_pair(struct bench *bench, struct eo_error *error)
{
  struct eo_contact_grid_settings grid = eo_contact_grid_default(&bench->design.resolution);
  struct eo_pair_options options = {
      .grid = &grid, .impact_stations = 221, .own_pivots = true, .tilt_rule = eo_case_tilt_rule(bench->file)};
  grid.partial_cells = false; /* the references load a cell by its middle */
  grid.edge_cells = 12;
  grid.edge_reach = 1.6e-3;
  if (bench->flexibility == 1)
    options.kernel = (struct eo_kernel){eo_closed_form_kernel, &bench->form};
  enum eo_code code = eo_pair_new(&bench->pair, &bench->design, &options, NULL, error);
  return code ? code : eo_evaluator_new(&bench->evaluator, bench->pair, 1, error);
}

static void drop(struct bench *bench)
{
  eo_evaluator_free(bench->evaluator);
  eo_pair_free(bench->pair);
  bench->evaluator = NULL;
  bench->pair = NULL;
}

static enum eo_code prepare(struct bench *bench, struct eo_case *item, struct eo_error *error)
{
  struct eo_case *name = eo_case_need(item, "pair"), *pairs = eo_case_need(bench->file, "pairs");
  struct eo_case *pair = eo_case_is_text(name) ? eo_case_find(pairs, eo_case_text(name)) : NULL;
  struct eo_geometry geometry;
  int flexibility = eo_case_need(item, "flex") ? eo_case_choice(item, "flex", flexibilities, -1) : -1;
  bool edges = eo_case_flag_or(item, "tip_edge_contact", false);
  if (!pair && eo_case_text(name))
    eo_case_fault(name, "There is no such pair.");
  if (eo_case_faulty(item))
    return EO_OK;
  if (bench->evaluator && strcmp(bench->pair_name, eo_case_text(name)) == 0 && bench->flexibility == flexibility &&
      bench->edges == edges)
    return EO_OK;
  drop(bench);
  bench->pair_name = eo_case_text(name);
  bench->flexibility = flexibility;
  bench->edges = edges;
  read_pair(bench, pair, &bench->design);
  bench->design.resolution.tip_edge_contact = edges;
  if (flexibility == 1)
    eo_case_closed_form(eo_case_need(eo_case_need(bench->file, "defaults"), "synthetic_flexibility"), &bench->form);
  if (eo_case_faulty(item))
    return EO_OK;
  enum eo_code code = eo_geometry_init(&geometry, &bench->design.gear_pair, error);
  if (code)
    return code;
  eo_design_resolve(&bench->design, &geometry);
  return make_pair(bench, error);
}

/* What a case expects, and how close: tol_rel, where it does not say 0.5 %. */
struct expected {
  struct eo_verification *v;
  struct eo_case *out, *ends, *tolerance;
};

static double tolerance_of(const struct expected *expected, const char *key)
{
  const double usual = 0.005;
  return eo_case_relative_or(expected->tolerance, key, usual);
}

static void check(const struct expected *expected, const char *key, double value)
{
  if (eo_case_find(expected->out, key))
    eo_verify_member(expected->v, expected->out, key, value, tolerance_of(expected, key), 0);
}

static void check_ends(const struct expected *expected, const char *key, double relative, double absolute,
                       const double value[2], double scale)
{
  struct eo_case *list = eo_case_find(expected->ends, key);
  if (list)
    eo_verify_list(expected->v, list, 2, value, scale, relative, absolute);
}

static double mean_tangent(const struct eo_evaluation *evaluation, int end)
{
  double sum = 0;
  for (int j = 0; j < evaluation->positions; j++)
    sum += evaluation->load_case[0].end[end].loaded.tangent[j] / evaluation->positions;
  return sum;
}

/* Impact of each end: force, speed and duration as the impact force of the pair; a force that is 0 to a millionth. */
static void check_impacts(const struct expected *expected, const struct eo_case_result *case_result)
{
  const struct eo_impact *left = &case_result->end[0].impact, *right = &case_result->end[1].impact;
  const double relative = tolerance_of(expected, "F_gen_N"), least = 1e-6;
  struct eo_case *off = eo_case_find(expected->ends, "emip_off_line");
  check_ends(expected, "F_gen_N", relative, least, (double[]){left->force, right->force}, 1);
  check_ends(expected, "F_off_N", relative, least, (double[]){left->classical, right->classical}, 1);
  check_ends(expected, "v_mm_s", relative, least, (double[]){left->speed, right->speed}, 1e3);
  check_ends(expected, "pulse_ms", relative, least, (double[]){left->duration, right->duration}, 1e3);
  check_ends(expected, "emip_c_mm", 0, 0.02, (double[]){left->phase, right->phase}, 1e3);
  check_ends(expected, "emip_eta_mm", 0, 0.5, (double[]){left->eta, right->eta}, 1e3);
  check_ends(expected, "pulse_start_phase", 0, 0.02, (double[]){left->start, right->start}, 1);
  for (int end = 0; end < 2 && off; end++)
    eo_verify_exact(expected->v, eo_case_at(off, end), case_result->end[end].impact.off_line);
  if (off)
    eo_verify_size(expected->v, off, 2);
}

static void check_contact(const struct expected *expected, const struct eo_evaluation *evaluation)
{
  const struct eo_case_result *case_result = &evaluation->load_case[0];
  const double tangent[2] = {mean_tangent(evaluation, 0), mean_tangent(evaluation, 1)}, least = 1e-6;
  check(expected, "PPLTE_um", 1e6 * case_result->peak_to_peak);
  check(expected, "LTE_mean_um", 1e6 * case_result->mean);
  check(expected, "kt_mean_N_um", 1e-6 * (tangent[0] + tangent[1]) / 2);
  check(expected, "F_gen_N", evaluation->objective[0].impact);
  check_ends(expected, "kt", tolerance_of(expected, "kt_mean_N_um"), least, tangent, 1e-6);
  check_ends(expected, "PPLTE_um", tolerance_of(expected, "PPLTE_um"), least,
             (double[]){case_result->end[0].transmission_peak, case_result->end[1].transmission_peak}, 1e6);
  check_ends(expected, "datum_Z_um", 0.005, 1e-3, (double[]){case_result->end[0].datum, case_result->end[1].datum},
             1e6);
  check_impacts(expected, case_result);
}

static void check_vibration(const struct expected *expected, const struct eo_vibration *vibration)
{
  const double least = 1e-6;
  check(expected, "rms_n", vibration->rms_pair[EO_READING_NORMAL]);
  check(expected, "rms_t", vibration->rms_pair[EO_READING_TRANSVERSE]);
  check(expected, "rms_rot", vibration->rms_pair[EO_READING_ROTATIONAL]);
  check_ends(expected, "rms_n", tolerance_of(expected, "rms_n"), least, vibration->rms[EO_READING_NORMAL], 1);
  check_ends(expected, "rms_rot", tolerance_of(expected, "rms_rot"), least, vibration->rms[EO_READING_ROTATIONAL], 1);
}

/* Curves of the nominal run by their harmonics, peak to peak of the transmission error and mean of the ends' amplitudes
   of acceleration, each to the tolerance of their peak or RMS on the largest of them. */
static void check_harmonics(const struct expected *expected, struct eo_case *item,
                            const struct eo_evaluation *evaluation)
{
  const struct eo_case_result *case_result = &evaluation->load_case[0];
  struct eo_case *transmission = eo_case_find(item, "LTE_harmonics_um_pp"),
                 *acceleration = eo_case_find(item, "acc_harmonics_n");
  double series[1 + 2 * HARMONICS], peak[HARMONICS], size[HARMONICS];
  eo_fourier_series(evaluation->positions, case_result->transmission, HARMONICS, series);
  for (int k = 1; k <= HARMONICS; k++) {
    peak[k - 1] = 2e6 * hypot(series[2 * k - 1], series[2 * k]);
    size[k - 1] = (cabs(case_result->end[0].order[EO_CHANNEL_NORMAL][k]) +
                   cabs(case_result->end[1].order[EO_CHANNEL_NORMAL][k])) /
                  2;
  }
  if (transmission)
    eo_verify_list(expected->v, transmission, HARMONICS, peak, 1, 0,
                   tolerance_of(expected, "PPLTE_um") * eo_case_largest(transmission));
  if (acceleration)
    eo_verify_list(expected->v, acceleration, HARMONICS, size, 1, 0,
                   tolerance_of(expected, "rms_n") * eo_case_largest(acceleration));
  eo_verify_member(expected->v, item, "Fmin_over_P",
                   fmin(case_result->vibration.force_min[0], case_result->vibration.force_min[1]) / case_result->force,
                   0.005, 0);
}

/* The case's own design: misalignment, flanks, load, stagger and what it changes of the lumped model. */
static enum eo_code read_case(struct bench *bench, struct eo_case *item, struct eo_design *design,
                              struct eo_error *error)
{
  struct eo_case *mods = eo_case_find(bench->file, "mods"), *all = eo_case_find(bench->file, "dynamics_params"),
                 *usual = all ? eo_case_find(all, bench->pair_name) : NULL,
                 *changes = eo_case_find(item, "dyn_changes");
  eo_case_misalignment(eo_case_need(item, "mis_rad"), &design->alignment);
  for (int end = 0; end < 2; end++)
    eo_case_named_modification(mods, eo_case_word(item, eo_end_name[end]), eo_case_find(item, eo_end_name[end]),
                               &design->gear_pair, &design->modification.flank[EO_PINION][end]);
  design->load_case[0] = (struct eo_load_case){
      .torque = eo_case_number(item, "T_Nm"), .speed = eo_case_number(item, "rpm") * M_PI / 30, .share = 1};
  design->alignment.stagger = fmod(2 - eo_case_number_or(item, "shift_right", 0), 1);
  set_supports(&design->supports, usual, usual);
  set_supports(&design->supports, changes, usual);
  return eo_case_size(changes) && !eo_case_faulty(item) ? check_parameters(bench->v, changes, design, error) : EO_OK;
}

/* Runs the design; *ok is false when the case has failed because something did not converge. */
static enum eo_code evaluate(struct bench *bench, struct eo_case *item, const struct eo_design *design,
                             const struct eo_evaluation **evaluation, bool *ok, struct eo_error *error)
{
  enum eo_code code = eo_evaluator_run(bench->evaluator, design, NULL, EO_WANT_CURVES, evaluation, error);
  *ok = !code && !(*evaluation)->load_case[0].contact_failures &&
        (*evaluation)->load_case[0].vibration.outcome != EO_VIBRATION_NOT_CONVERGED;
  if (!code && !*ok)
    eo_verify_diverged(bench->v, item);
  return code;
}

/* The nominal response, the one with the impact in it, and the one under the secant law. */
static enum eo_code check_runs(struct bench *bench, struct eo_case *item, const struct expected *expected,
                               struct eo_design *design, struct eo_error *error)
{
  const struct eo_evaluation *evaluation;
  bool ok;
  enum eo_code code = evaluate(bench, item, design, &evaluation, &ok, error);
  if (!ok)
    return code;
  check_contact(expected, evaluation);
  check_vibration(expected, &evaluation->load_case[0].vibration);
  check_harmonics(expected, item, evaluation);
  design->resolution.impact_in_dynamics = EO_IMPACT_PAPER;
  code = evaluate(bench, item, design, &evaluation, &ok, error);
  if (!ok)
    return code;
  check(expected, "rms_n_impact", evaluation->load_case[0].vibration.rms_pair[EO_READING_NORMAL]);
  check(expected, "rms_rot_impact", evaluation->load_case[0].vibration.rms_pair[EO_READING_ROTATIONAL]);
  design->resolution.impact_in_dynamics = EO_IMPACT_NONE;
  design->resolution.mesh_law = EO_LAW_SECANT;
  code = evaluate(bench, item, design, &evaluation, &ok, error);
  if (ok)
    check(expected, "rms_n_secant", evaluation->load_case[0].vibration.rms_pair[EO_READING_NORMAL]);
  return code;
}

/* How the tolerances came about: a number for each of the case's results, or null. */
static void read_uncertainty(struct eo_case *item, const char *key, struct eo_case *out)
{
  struct eo_case *block = eo_case_given(item, key);
  if (block && !eo_case_is_object(block))
    eo_case_fault(block, "An object or null is expected here.");
  for (int i = 0; i < eo_case_size(block); i++) {
    struct eo_case *value = eo_case_at(block, i);
    eo_case_real(value);
    if (eo_case_key(value) && !eo_case_find(out, eo_case_key(value)))
      eo_case_fault(value, "The case expects no such result.");
  }
}

static enum eo_code run_case(void *context, struct eo_case *item, struct eo_error *error)
{
  struct bench *bench = context;
  enum eo_code code = prepare(bench, item, error);
  if (code || eo_case_faulty(item))
    return code;
  struct eo_design design = bench->design;
  const struct expected expected = {bench->v, eo_case_need(item, "out"), eo_case_find(item, "ends"),
                                    eo_case_find(item, "tol_rel")};
  read_uncertainty(item, "discretisation_rel", expected.out);
  read_uncertainty(item, "compliance_8pct_rel", expected.out);
  code = read_case(bench, item, &design, error);
  if (code || eo_case_faulty(item))
    return code;
  struct eo_design changed = design;
  code = check_runs(bench, item, &expected, &changed, error);
  return !code && eo_case_find(item, "stage")
             ? eo_verify_stage_arrays(expected.v, expected.out, item, &bench->pair->geometry, &design, error)
             : code;
}

static const struct eo_verify_block blocks[] = {
    {"defaults", EO_BLOCK_EITHER, read_defaults},
    {"tolerances", EO_BLOCK_REMARKS, NULL},
    {"pairs", EO_BLOCK_EITHER, check_pairs},
    {"dynamics_params", EO_BLOCK_EACH, check_dynamics},
    {"mods", EO_BLOCK_EITHER, read_modifications},
    {"cases", EO_BLOCK_EACH, run_case},
    {NULL, EO_BLOCK_INPUT, NULL},
};

enum eo_code eo_verify_evaluation(struct eo_case *file, struct eo_verification *verification, struct eo_error *error)
{
  struct bench *bench = calloc(1, sizeof *bench);
  if (!bench)
    return eo_error_memory(error);
  bench->file = file;
  bench->defaults = eo_case_find(file, "defaults");
  bench->v = verification;
  eo_case_need(file, "cases");
  enum eo_code code = eo_case_faulty(file) ? EO_OK : eo_verify_blocks(verification, file, blocks, bench, error);
  drop(bench);
  free(bench);
  return code;
}
