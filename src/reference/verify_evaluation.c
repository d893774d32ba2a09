/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/verify_evaluation.h"

#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "design/resolution.h"
#include "evaluation/evaluator.h"
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
static void set_supports(struct eo_supports *s, struct eo_case *p, struct eo_case *usually)
{
  static const char *const bearing[2] = {"kpy", "kgy"}, *const axial[2] = {"kg1z", "kg2z"},
                           *const groove[2] = {"kpz", "kgz"};
  static const char *const torsion[2] = {"kt_p", "kt_g"}, *const mass[2] = {"mp", "mg"},
                           *const inertia[2] = {"Ip", "Ig"};
  for (int i = 0; i < 2; i++) {
    replace(p, bearing[i], &s->bearing_stiffness[i]);
    replace(p, axial[i], &s->gear_axial_stiffness[i]);
    replace(p, groove[i], &s->groove_axial_stiffness[i]);
    replace(p, mass[i], &s->mass[i]);
    replace(p, inertia[i], &s->inertia[i]);
    double kt = eo_case_number_or(p, torsion[i], 0);
    if (kt > 0) {
      s->groove_torsional_stiffness[i] = kt;
      s->torsional_coupling = EO_COUPLING_ON;
    }
  }
  double cm = eo_case_number_or(p, "cm", NAN), usual = eo_case_number_or(usually, "cm", NAN);
  if (cm > 0 && usual > 0)
    s->mesh_damping_ratio *= cm / usual;
}

/* Numbers of a block that the design derives: radii, dampers, equivalent mass. */
static enum eo_code check_parameters(struct eo_verification *v, struct eo_case *block, const struct eo_design *design,
                                     struct eo_error *error)
{
  const double relative = 1e-6;
  struct eo_geometry geometry;
  struct eo_dynamics_parameters p;
  enum eo_code code = eo_geometry_init(&geometry, &design->gear_pair, error);
  if (!code)
    code = eo_dynamics_parameters_init(&p, &geometry, design->gear_pair.ends, 0, &design->supports, false, 1, error);
  if (code)
    return code;
  const struct {
    const char *key;
    double value;
  } row[] = {{"Rp", p.base_radius[0]},
             {"Rg", p.base_radius[1]},
             {"beta", p.base_helix_angle},
             {"cpy", p.bearing_damping[0]},
             {"cgy", p.bearing_damping[1]},
             {"cg1z", p.gear_axial_damping[0]},
             {"cg2z", p.gear_axial_damping[1]},
             {"cpz", p.groove_axial_damping[0]},
             {"cgz", p.groove_axial_damping[1]},
             {"cm", p.mesh_damping},
             {"me", eo_dynamics_equivalent_mass(&p)}};
  for (size_t i = 0; i < sizeof row / sizeof *row; i++)
    eo_verify_member(v, block, row[i].key, row[i].value, relative, 0);
  return EO_OK;
}

/* The pair's design with the file's defaults, as far as it does not depend on the flexibility. */
static void read_pair(const struct bench *b, struct eo_case *pair, struct eo_design *d)
{
  enum { MOST_POSITIONS = 4096, MOST_CELLS = 1000, MOST_HARMONICS = 256 };
  struct eo_resolution *r = &d->resolution;
  eo_case_design(eo_case_need(pair, "input"), d);
  double bore = eo_case_number_or(pair, "gear_bore_radius_m", d->gear_pair.bore[EO_GEAR] / 2);
  d->gear_pair.bore[EO_PINION] = 0;
  d->gear_pair.bore[EO_GEAR] = 2 * bore;
  r->positions = eo_case_whole_or(b->defaults, "positions", 4, MOST_POSITIONS, 64);
  r->cells_per_line = eo_case_whole_or(b->defaults, "cells_per_line", 2, MOST_CELLS, 30);
  r->harmonics = eo_case_whole_or(b->defaults, "hb_harmonics", 1, MOST_HARMONICS, 24);
  r->te_harmonics = HARMONICS;
  r->body = EO_BODY_SECTOR;
  r->sector_teeth = eo_case_count(b->defaults, "fe_flexibility", "-tooth sector", 3);
  r->neighbour_coupling = eo_case_on(b->defaults, "neighbour_tooth_coupling", true);
  d->supports.torsional_coupling = EO_COUPLING_OFF;
  d->supports.mesh_damping_stiffness = 20e9 * d->gear_pair.face_width;
}

static enum eo_code check_pair(void *context, struct eo_case *pair, struct eo_error *error)
{
  const struct bench *b = context;
  struct eo_case *output = eo_case_find(pair, "check");
  struct eo_design design;
  struct eo_geometry geometry;
  read_pair(b, pair, &design);
  if (eo_case_faulty(pair))
    return EO_OK;
  enum eo_code code = eo_geometry_init(&geometry, &design.gear_pair, error);
  if (!code && output)
    eo_case_check_geometry(b->v, output, &geometry, 1e3, 1e-9);
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
  const struct bench *b = context;
  struct eo_case *pair = eo_case_find(eo_case_find(b->file, "pairs"), eo_case_key(block));
  struct eo_design design;
  struct eo_geometry geometry;
  if (!pair) {
    eo_case_fault(block, "There is no such pair.");
    return EO_OK;
  }
  read_pair(b, pair, &design);
  set_supports(&design.supports, block, block);
  if (eo_case_faulty(pair))
    return EO_OK;
  enum eo_code code = eo_geometry_init(&geometry, &design.gear_pair, error);
  if (code)
    return code;
  eo_design_resolve(&design, &geometry);
  return check_parameters(b->v, block, &design, error);
}

static enum eo_code read_modifications(void *context, struct eo_case *mods, struct eo_error *error)
{
  const struct bench *b = context;
  const struct eo_gear_pair any = {.face_width = 1};
  struct eo_flank_modification flank;
  (void)error;
  (void)b;
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
  const struct bench *b = context;
  struct eo_design design;
  (void)error;
  for (size_t i = 0; i < sizeof words / sizeof *words; i++)
    eo_case_remark(block, words[i]);
  read_pair(b, eo_case_at(eo_case_find(b->file, "pairs"), 0), &design);
  return EO_OK;
}

static enum eo_code make_pair(struct bench *b, struct eo_error *error)
{
  struct eo_contact_grid_settings grid = eo_contact_grid_default(&b->design.resolution);
  struct eo_pair_options options = {
      .grid = &grid, .impact_stations = 221, .own_pivots = true, .tilt_rule = eo_case_tilt_rule(b->file)};
  grid.partial_cells = false; /* the references load a cell by its middle */
  grid.edge_cells = 12;
  grid.edge_reach = 1.6e-3;
  if (b->flexibility == 1)
    options.kernel = (struct eo_kernel){eo_closed_form_kernel, &b->form};
  enum eo_code code = eo_pair_new(&b->pair, &b->design, &options, NULL, error);
  return code ? code : eo_evaluator_new(&b->evaluator, b->pair, 1, error);
}

static void drop(struct bench *b)
{
  eo_evaluator_free(b->evaluator);
  eo_pair_free(b->pair);
  b->evaluator = NULL;
  b->pair = NULL;
}

static enum eo_code prepare(struct bench *b, struct eo_case *item, struct eo_error *error)
{
  struct eo_case *name = eo_case_need(item, "pair"), *pairs = eo_case_need(b->file, "pairs");
  struct eo_case *pair = eo_case_is_text(name) ? eo_case_find(pairs, eo_case_text(name)) : NULL;
  struct eo_geometry geometry;
  int flexibility = eo_case_need(item, "flex") ? eo_case_choice(item, "flex", flexibilities, -1) : -1;
  bool edges = eo_case_flag_or(item, "tip_edge_contact", false);
  if (!pair && eo_case_text(name))
    eo_case_fault(name, "There is no such pair.");
  if (eo_case_faulty(item))
    return EO_OK;
  if (b->evaluator && strcmp(b->pair_name, eo_case_text(name)) == 0 && b->flexibility == flexibility &&
      b->edges == edges)
    return EO_OK;
  drop(b);
  b->pair_name = eo_case_text(name);
  b->flexibility = flexibility;
  b->edges = edges;
  read_pair(b, pair, &b->design);
  b->design.resolution.tip_edge_contact = edges;
  if (flexibility == 1)
    eo_case_closed_form(eo_case_need(eo_case_need(b->file, "defaults"), "synthetic_flexibility"), &b->form);
  if (eo_case_faulty(item))
    return EO_OK;
  enum eo_code code = eo_geometry_init(&geometry, &b->design.gear_pair, error);
  if (code)
    return code;
  eo_design_resolve(&b->design, &geometry);
  return make_pair(b, error);
}

/* What a case expects, and how close: tol_rel, where it does not say 0.5 %. */
struct expected {
  struct eo_verification *v;
  struct eo_case *out, *ends, *tolerance;
};

static double tolerance_of(const struct expected *e, const char *key)
{
  const double usual = 0.005;
  return eo_case_relative_or(e->tolerance, key, usual);
}

static void check(const struct expected *e, const char *key, double value)
{
  if (eo_case_find(e->out, key))
    eo_verify_member(e->v, e->out, key, value, tolerance_of(e, key), 0);
}

static void check_ends(const struct expected *e, const char *key, double relative, double absolute,
                       const double value[2], double scale)
{
  struct eo_case *list = eo_case_find(e->ends, key);
  if (list)
    eo_verify_list(e->v, list, 2, value, scale, relative, absolute);
}

static double mean_tangent(const struct eo_evaluation *r, int end)
{
  double sum = 0;
  for (int j = 0; j < r->positions; j++)
    sum += r->load_case[0].end[end].loaded.tangent[j] / r->positions;
  return sum;
}

/* Impact of each end: force, speed and duration as the impact force of the pair; a force that is 0 to a millionth. */
static void check_impacts(const struct expected *e, const struct eo_case_result *c)
{
  const struct eo_impact *left = &c->end[0].impact, *right = &c->end[1].impact;
  const double relative = tolerance_of(e, "F_gen_N"), least = 1e-6;
  struct eo_case *off = eo_case_find(e->ends, "emip_off_line");
  check_ends(e, "F_gen_N", relative, least, (double[]){left->force, right->force}, 1);
  check_ends(e, "F_off_N", relative, least, (double[]){left->classical, right->classical}, 1);
  check_ends(e, "v_mm_s", relative, least, (double[]){left->speed, right->speed}, 1e3);
  check_ends(e, "pulse_ms", relative, least, (double[]){left->duration, right->duration}, 1e3);
  check_ends(e, "emip_c_mm", 0, 0.02, (double[]){left->phase, right->phase}, 1e3);
  check_ends(e, "emip_eta_mm", 0, 0.5, (double[]){left->eta, right->eta}, 1e3);
  check_ends(e, "pulse_start_phase", 0, 0.02, (double[]){left->start, right->start}, 1);
  for (int end = 0; end < 2 && off; end++)
    eo_verify_exact(e->v, eo_case_at(off, end), c->end[end].impact.off_line);
  if (off)
    eo_verify_size(e->v, off, 2);
}

static void check_contact(const struct expected *e, const struct eo_evaluation *r)
{
  const struct eo_case_result *c = &r->load_case[0];
  const double tangent[2] = {mean_tangent(r, 0), mean_tangent(r, 1)}, least = 1e-6;
  check(e, "PPLTE_um", 1e6 * c->peak_to_peak);
  check(e, "LTE_mean_um", 1e6 * c->mean);
  check(e, "kt_mean_N_um", 1e-6 * (tangent[0] + tangent[1]) / 2);
  check(e, "F_gen_N", r->objective[0].impact);
  check_ends(e, "kt", tolerance_of(e, "kt_mean_N_um"), least, tangent, 1e-6);
  check_ends(e, "PPLTE_um", tolerance_of(e, "PPLTE_um"), least,
             (double[]){c->end[0].transmission_peak, c->end[1].transmission_peak}, 1e6);
  check_ends(e, "datum_Z_um", 0.005, 1e-3, (double[]){c->end[0].datum, c->end[1].datum}, 1e6);
  check_impacts(e, c);
}

static void check_vibration(const struct expected *e, const struct eo_vibration *w)
{
  const double least = 1e-6;
  check(e, "rms_n", w->rms_pair[EO_READING_NORMAL]);
  check(e, "rms_t", w->rms_pair[EO_READING_TRANSVERSE]);
  check(e, "rms_rot", w->rms_pair[EO_READING_ROTATIONAL]);
  check_ends(e, "rms_n", tolerance_of(e, "rms_n"), least, w->rms[EO_READING_NORMAL], 1);
  check_ends(e, "rms_rot", tolerance_of(e, "rms_rot"), least, w->rms[EO_READING_ROTATIONAL], 1);
}

/* Curves of the nominal run by their harmonics, peak to peak of the transmission error and mean of the ends' amplitudes
   of acceleration, each to the tolerance of their peak or RMS on the largest of them. */
static void check_harmonics(const struct expected *e, struct eo_case *item, const struct eo_evaluation *r)
{
  const struct eo_case_result *c = &r->load_case[0];
  struct eo_case *transmission = eo_case_find(item, "LTE_harmonics_um_pp"),
                 *acceleration = eo_case_find(item, "acc_harmonics_n");
  double series[1 + 2 * HARMONICS], peak[HARMONICS], size[HARMONICS];
  eo_fourier_series(r->positions, c->transmission, HARMONICS, series);
  for (int k = 1; k <= HARMONICS; k++) {
    peak[k - 1] = 2e6 * hypot(series[2 * k - 1], series[2 * k]);
    size[k - 1] = (cabs(c->end[0].order[EO_CHANNEL_NORMAL][k]) + cabs(c->end[1].order[EO_CHANNEL_NORMAL][k])) / 2;
  }
  if (transmission)
    eo_verify_list(e->v, transmission, HARMONICS, peak, 1, 0,
                   tolerance_of(e, "PPLTE_um") * eo_case_largest(transmission));
  if (acceleration)
    eo_verify_list(e->v, acceleration, HARMONICS, size, 1, 0, tolerance_of(e, "rms_n") * eo_case_largest(acceleration));
  eo_verify_member(e->v, item, "Fmin_over_P", fmin(c->vibration.force_min[0], c->vibration.force_min[1]) / c->force,
                   0.005, 0);
}

enum { MOST_POSITIONS = 4096 };

struct stage {
  int positions;
  double z[2][MOST_POSITIONS], stiffness[2][MOST_POSITIONS]; /* [end], m, N/m */
  double datum[2];                                           /* m */
};

static void read_curves(struct eo_case *pair, double unit, int *positions, double curve[2][MOST_POSITIONS])
{
  if (pair && eo_case_size(pair) != 2)
    eo_case_fault(pair, "Two lists, [left, right], are expected here.");
  for (int end = 0; end < 2; end++) {
    int n = eo_case_numbers(eo_case_at(pair, end), *positions, MOST_POSITIONS, curve[end]);
    *positions = n > 0 ? n : *positions;
    for (int j = 0; j < n; j++)
      curve[end][j] *= unit;
  }
}

static void read_stage(struct eo_case *item, struct stage *s)
{
  struct eo_case *stage = eo_case_find(item, "stage"), *ends = eo_case_find(item, "ends"),
                 *datum = ends ? eo_case_find(ends, "datum_Z_um") : NULL;
  s->positions = -1;
  read_curves(eo_case_need(stage, "Z_um"), 1e-6, &s->positions, s->z);
  read_curves(eo_case_need(stage, "kt_N_um"), 1e6, &s->positions, s->stiffness);
  for (int end = 0; end < 2; end++)
    s->datum[end] = datum ? 1e-6 * eo_case_element(datum, end) : 0;
}

/* The response under the tangent or the secant law of the arrays. */
static enum eo_code solve_stage(const struct bench *b, const struct stage *s, const struct eo_design *design,
                                bool secant, struct eo_vibration_solver *solver, struct eo_vibration *result,
                                struct eo_error *error)
{
  struct eo_law law[2] = {{0}, {0}};
  const struct eo_geometry *g = &b->pair->geometry;
  const struct eo_load_case *load_case = &design->load_case[0];
  const double force = load_case->torque / (2 * g->base_radius[0] * cos(g->base_helix_angle)),
               back = -design->gear_pair.backlash;
  const int order = design->resolution.te_harmonics;
  const struct eo_vibration_case load = {.torque = load_case->torque,
                                         .speed = load_case->speed,
                                         .pinion_teeth = g->teeth[0],
                                         .law = {&law[0], &law[1]},
                                         .phase_right = -design->alignment.stagger,
                                         .gated = true};
  enum eo_code code = EO_OK;
  for (int end = 0; end < 2 && !code; end++)
    code = secant
               ? eo_law_set_secant(&law[end], s->positions, s->z[end], force, s->datum[end], order, back, error)
               : eo_law_set_tangent(&law[end], s->positions, s->z[end], s->stiffness[end], force, order, back, error);
  if (!code)
    code = eo_vibration_solve(solver, &load, EO_START_COLD, result, error);
  eo_law_done(&law[0]);
  eo_law_done(&law[1]);
  return code;
}

static void compare_stage(const struct expected *e, const char *key, const struct eo_vibration *w,
                          enum eo_reading reading)
{
  const double relative = 1e-3;
  struct eo_case *expected = eo_case_find(e->out, key);
  if (!expected)
    return;
  if (w->outcome == EO_VIBRATION_NOT_CONVERGED) {
    eo_verify_diverged(e->v, expected);
    return;
  }
  double wanted = eo_case_real(expected);
  eo_verify_derived(e->v, expected, "of the stage arrays", w->rms_pair[reading], wanted, relative * fabs(wanted));
}

static enum eo_code check_stage(const struct bench *b, struct eo_case *item, const struct expected *e,
                                const struct eo_design *design, struct eo_error *error)
{
  struct eo_dynamics_parameters parameters;
  struct eo_vibration_solver *solver = NULL;
  struct eo_vibration tangent, secant;
  struct stage *stage = calloc(1, sizeof *stage);
  enum eo_code code = stage ? EO_OK : eo_error_memory(error);
  if (!code)
    read_stage(item, stage);
  if (code || eo_case_faulty(item)) {
    free(stage);
    return code;
  }
  code = eo_dynamics_parameters_init(&parameters, &b->pair->geometry, design->gear_pair.ends, 0, &design->supports,
                                     false, 1, error);
  if (!code)
    code = eo_vibration_new(&solver, design->resolution.harmonics, 0, error);
  if (!code)
    code = eo_vibration_set_model(solver, &parameters, error);
  if (!code)
    code = solve_stage(b, stage, design, false, solver, &tangent, error);
  if (!code)
    code = solve_stage(b, stage, design, true, solver, &secant, error);
  if (!code) {
    compare_stage(e, "rms_n", &tangent, EO_READING_NORMAL);
    compare_stage(e, "rms_t", &tangent, EO_READING_TRANSVERSE);
    compare_stage(e, "rms_rot", &tangent, EO_READING_ROTATIONAL);
    compare_stage(e, "rms_n_secant", &secant, EO_READING_NORMAL);
  }
  eo_vibration_free(solver);
  free(stage);
  return code;
}

/* The case's own design: misalignment, flanks, load, stagger and what it changes of the lumped model. */
static enum eo_code read_case(struct bench *b, struct eo_case *item, struct eo_design *design, struct eo_error *error)
{
  static const char *const end_name[2] = {"left", "right"};
  struct eo_case *mods = eo_case_find(b->file, "mods"), *all = eo_case_find(b->file, "dynamics_params"),
                 *usual = all ? eo_case_find(all, b->pair_name) : NULL, *changes = eo_case_find(item, "dyn_changes");
  eo_case_misalignment(eo_case_need(item, "mis_rad"), &design->alignment);
  for (int end = 0; end < 2; end++)
    eo_case_named_modification(mods, eo_case_word(item, end_name[end]), eo_case_find(item, end_name[end]),
                               &design->gear_pair, &design->modification.flank[EO_PINION][end]);
  design->load_case[0] = (struct eo_load_case){
      .torque = eo_case_number(item, "T_Nm"), .speed = eo_case_number(item, "rpm") * M_PI / 30, .share = 1};
  design->alignment.stagger = fmod(2 - eo_case_number_or(item, "shift_right", 0), 1);
  set_supports(&design->supports, usual, usual);
  set_supports(&design->supports, changes, usual);
  return eo_case_size(changes) && !eo_case_faulty(item) ? check_parameters(b->v, changes, design, error) : EO_OK;
}

/* Runs the design; *ok is false when the case has failed because something did not converge. */
static enum eo_code evaluate(struct bench *b, struct eo_case *item, const struct eo_design *design,
                             const struct eo_evaluation **r, bool *ok, struct eo_error *error)
{
  enum eo_code code = eo_evaluator_run(b->evaluator, design, NULL, EO_WANT_CURVES, r, error);
  *ok = !code && !(*r)->load_case[0].contact_failures &&
        (*r)->load_case[0].vibration.outcome != EO_VIBRATION_NOT_CONVERGED;
  if (!code && !*ok)
    eo_verify_diverged(b->v, item);
  return code;
}

/* The nominal response, the one with the impact in it, and the one under the secant law. */
static enum eo_code check_runs(struct bench *b, struct eo_case *item, const struct expected *e,
                               struct eo_design *design, struct eo_error *error)
{
  const struct eo_evaluation *r;
  bool ok;
  enum eo_code code = evaluate(b, item, design, &r, &ok, error);
  if (!ok)
    return code;
  check_contact(e, r);
  check_vibration(e, &r->load_case[0].vibration);
  check_harmonics(e, item, r);
  design->resolution.impact_in_dynamics = EO_IMPACT_PAPER;
  code = evaluate(b, item, design, &r, &ok, error);
  if (!ok)
    return code;
  check(e, "rms_n_impact", r->load_case[0].vibration.rms_pair[EO_READING_NORMAL]);
  check(e, "rms_rot_impact", r->load_case[0].vibration.rms_pair[EO_READING_ROTATIONAL]);
  design->resolution.impact_in_dynamics = EO_IMPACT_NONE;
  design->resolution.mesh_law = EO_LAW_SECANT;
  code = evaluate(b, item, design, &r, &ok, error);
  if (ok)
    check(e, "rms_n_secant", r->load_case[0].vibration.rms_pair[EO_READING_NORMAL]);
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
  struct bench *b = context;
  enum eo_code code = prepare(b, item, error);
  if (code || eo_case_faulty(item))
    return code;
  struct eo_design design = b->design;
  const struct expected e = {b->v, eo_case_need(item, "out"), eo_case_find(item, "ends"),
                             eo_case_find(item, "tol_rel")};
  read_uncertainty(item, "discretisation_rel", e.out);
  read_uncertainty(item, "compliance_8pct_rel", e.out);
  code = read_case(b, item, &design, error);
  if (code || eo_case_faulty(item))
    return code;
  struct eo_design changed = design;
  code = check_runs(b, item, &e, &changed, error);
  return !code && eo_case_find(item, "stage") ? check_stage(b, item, &e, &design, error) : code;
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

enum eo_code eo_verify_evaluation(struct eo_case *file, struct eo_verification *v, struct eo_error *error)
{
  struct bench *b = calloc(1, sizeof *b);
  if (!b)
    return eo_error_memory(error);
  b->file = file;
  b->defaults = eo_case_find(file, "defaults");
  b->v = v;
  eo_case_need(file, "cases");
  enum eo_code code = eo_case_faulty(file) ? EO_OK : eo_verify_blocks(v, file, blocks, b, error);
  drop(b);
  free(b);
  return code;
}
