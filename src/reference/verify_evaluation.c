#include "reference/verify_evaluation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "design/resolution.h"
#include "reference/case_pair.h"
#include "evaluation/evaluator.h"

/* A prepared pair is kept while the next case wants the same one. */
struct bench {
  const json_t *file;
  struct eo_verification *v;
  const char *pair_name;
  const char *flexibility;
  bool edges;
  struct eo_design design; /* of the pair, with the file's defaults */
  struct eo_closed_form form;
  struct eo_pair *pair;
  struct eo_evaluator *evaluator;
};

static const char *text_of(const json_t *object, const char *key)
{
  const char *text = json_string_value(json_object_get(object, key));
  return text ? text : "";
}

/* The file's dynamics parameters for a pair, or what the design derives where the file is silent. A mesh damping that
   differs from the usual one scales the damping ratio. */
static void set_supports(struct eo_supports *s, const json_t *p, const json_t *usually)
{
  static const char *const bearing[2] = {"kpy", "kgy"}, *const axial[2] = {"kg1z", "kg2z"},
                           *const groove[2] = {"kpz", "kgz"};
  static const char *const torsion[2] = {"kt_p", "kt_g"}, *const mass[2] = {"mp", "mg"},
                           *const inertia[2] = {"Ip", "Ig"};
  for (int i = 0; i < 2; i++) {
    s->bearing_stiffness[i] = eo_verify_number_or(p, bearing[i], s->bearing_stiffness[i]);
    s->gear_axial_stiffness[i] = eo_verify_number_or(p, axial[i], s->gear_axial_stiffness[i]);
    s->groove_axial_stiffness[i] = eo_verify_number_or(p, groove[i], s->groove_axial_stiffness[i]);
    s->mass[i] = eo_verify_number_or(p, mass[i], s->mass[i]);
    s->inertia[i] = eo_verify_number_or(p, inertia[i], s->inertia[i]);
    double cm = eo_verify_number_or(p, "cm", NAN), usual = eo_verify_number_or(usually, "cm", NAN);
    if (i == 0 && cm > 0 && usual > 0)
      s->mesh_damping_ratio *= cm / usual;
    double kt = eo_verify_number_or(p, torsion[i], 0);
    if (kt > 0) {
      s->groove_torsional_stiffness[i] = kt;
      s->torsional_coupling = EO_COUPLING_ON;
    }
  }
}

static enum eo_code set_design(struct bench *b, const json_t *pair, struct eo_error *error)
{
  const json_t *defaults = json_object_get(b->file, "defaults");
  struct eo_design *d = &b->design;
  enum eo_code code = eo_case_design(json_object_get(pair, "input"), d, error);
  if (code)
    return code;
  double bore = eo_verify_number(pair, "gear_bore_radius_m");
  d->gear_pair.bore[EO_PINION] = 0;
  if (!isnan(bore))
    d->gear_pair.bore[EO_GEAR] = 2 * bore;
  struct eo_resolution *r = &d->resolution;
  r->positions = (int)eo_verify_number_or(defaults, "positions", 64);
  r->cells_per_line = (int)eo_verify_number_or(defaults, "cells_per_line", 30);
  r->harmonics = (int)eo_verify_number_or(defaults, "hb_harmonics", 24);
  r->te_harmonics = 10;
  r->sector_teeth = eo_case_count(text_of(defaults, "fe_flexibility"), "-tooth sector", 3);
  r->neighbour_coupling = strstr(text_of(defaults, "neighbour_tooth_coupling"), "off") == NULL;
  r->tip_edge_contact = b->edges;
  d->supports.torsional_coupling = EO_COUPLING_OFF;
  d->supports.mesh_damping_stiffness = 20e9 * d->gear_pair.face_width;
  struct eo_geometry geometry;
  code = eo_geometry_init(&geometry, &d->gear_pair, error);
  if (!code)
    eo_design_resolve(d, &geometry);
  return code;
}

static enum eo_code prepare(struct bench *b, const json_t *item, struct eo_error *error)
{
  const char *name = text_of(item, "pair"), *flexibility = text_of(item, "flex");
  bool edges = json_is_true(json_object_get(item, "tip_edge_contact"));
  if (b->evaluator && strcmp(b->pair_name, name) == 0 && strcmp(b->flexibility, flexibility) == 0 && b->edges == edges)
    return EO_OK;
  eo_evaluator_free(b->evaluator);
  eo_pair_free(b->pair);
  b->evaluator = NULL;
  b->pair = NULL;
  b->pair_name = name;
  b->flexibility = flexibility;
  b->edges = edges;
  const json_t *pair = json_object_get(json_object_get(b->file, "pairs"), name);
  enum eo_code code = set_design(b, pair, error);
  if (code)
    return code;
  struct eo_contact_grid_settings grid = eo_contact_grid_default(&b->design.resolution);
  struct eo_pair_options options = {.grid = &grid,
                                    .impact_stations = 221,
                                    .own_pivots = true,
                                    .corner_at_radius = strstr(text_of(json_object_get(b->file, "defaults"), "gap"),
                                                               "at the pinion radius of the corner") != NULL};
  grid.partial_cells = false; /* the references load a cell by its middle */
  grid.edge_cells = 12;
  grid.edge_reach = 1.6e-3;
  if (strcmp(flexibility, "synthetic") == 0) {
    if (!eo_case_closed_form(text_of(json_object_get(b->file, "defaults"), "synthetic_flexibility"), &b->form))
      return eo_error_set(error, EO_ERROR_INPUT, "/defaults/synthetic_flexibility",
                          "The closed-form compliance could not be read.");
    options.kernel = (struct eo_kernel){eo_closed_form_kernel, &b->form};
  }
  code = eo_pair_new(&b->pair, &b->design, &options, NULL, error);
  return code ? code : eo_evaluator_new(&b->evaluator, b->pair, 1, error);
}

/* ---- expected numbers ---- */

struct expected {
  struct eo_verification *v;
  const char *label;
  const json_t *out, *tolerance;
};

static void check(const struct expected *e, const char *key, double value)
{
  double wanted = eo_verify_number(e->out, key), relative = eo_verify_number(e->tolerance, key);
  if (!isnan(wanted))
    eo_verify_add(e->v, e->label, key, value, wanted, (isnan(relative) ? 0.005 : relative) * fabs(wanted));
}

static void check_ends(const struct expected *e, const json_t *ends, const char *key, const char *like,
                       const double value[2], double scale)
{
  double relative = eo_verify_number(e->tolerance, like);
  for (int i = 0; i < 2; i++) {
    double wanted = eo_verify_element(ends, key, i);
    char quantity[60];
    snprintf(quantity, sizeof quantity, "ends %s %s", key, i ? "right" : "left");
    if (!isnan(wanted))
      eo_verify_add(e->v, e->label, quantity, value[i] * scale, wanted,
                    fmax((isnan(relative) ? 0.005 : relative) * fabs(wanted), 1e-6));
  }
}

static double mean_tangent(const struct eo_evaluation *r, int end)
{
  double sum = 0;
  for (int j = 0; j < r->positions; j++)
    sum += r->load_case[0].end[end].loaded.tangent[j] / r->positions;
  return sum;
}

static void check_nominal(const struct expected *e, const json_t *item, const struct eo_evaluation *r)
{
  const struct eo_case_result *c = &r->load_case[0];
  const struct eo_vibration *w = &c->vibration;
  const json_t *ends = json_object_get(item, "ends");
  double tangent[2] = {mean_tangent(r, 0), mean_tangent(r, 1)};
  check(e, "PPLTE_um", 1e6 * c->peak_to_peak);
  check(e, "LTE_mean_um", 1e6 * c->mean);
  check(e, "kt_mean_N_um", 1e-6 * (tangent[0] + tangent[1]) / 2);
  check(e, "F_gen_N", r->objective[0].impact);
  check(e, "rms_n", w->rms_pair[EO_READING_NORMAL]);
  check(e, "rms_t", w->rms_pair[EO_READING_TRANSVERSE]);
  check(e, "rms_rot", w->rms_pair[EO_READING_ROTATIONAL]);
  check_ends(e, ends, "kt", "kt_mean_N_um", tangent, 1e-6);
  check_ends(e, ends, "PPLTE_um", "PPLTE_um", (double[]){c->end[0].transmission_peak, c->end[1].transmission_peak},
             1e6);
  check_ends(e, ends, "F_gen_N", "F_gen_N", (double[]){c->end[0].impact.force, c->end[1].impact.force}, 1);
  check_ends(e, ends, "F_off_N", "F_gen_N", (double[]){c->end[0].impact.classical, c->end[1].impact.classical}, 1);
  check_ends(e, ends, "v_mm_s", "F_gen_N", (double[]){c->end[0].impact.speed, c->end[1].impact.speed}, 1e3);
  check_ends(e, ends, "pulse_ms", "F_gen_N", (double[]){c->end[0].impact.duration, c->end[1].impact.duration}, 1e3);
  check_ends(e, ends, "rms_n", "rms_n", w->rms[EO_READING_NORMAL], 1);
  check_ends(e, ends, "rms_rot", "rms_rot", w->rms[EO_READING_ROTATIONAL], 1);
}

/* The stage arrays alone: Z and k_tan of the file through the dynamics. */
static enum eo_code check_stage(struct bench *b, const json_t *item, const struct eo_design *design,
                                struct eo_error *error)
{
  const json_t *stage = json_object_get(item, "stage"), *ends = json_object_get(item, "ends");
  struct eo_law law[2] = {{0}, {0}};
  struct eo_dynamics_parameters parameters;
  struct eo_vibration_solver *solver = NULL;
  struct eo_vibration result[2]; /* tangent, secant */
  const struct eo_geometry *g = &b->pair->geometry;
  double force = design->load_case[0].torque / (2 * g->base_radius[0] * cos(g->base_helix_angle)),
         back = -design->gear_pair.backlash;
  struct eo_vibration_case load = {.torque = design->load_case[0].torque,
                                   .speed = design->load_case[0].speed,
                                   .pinion_teeth = g->teeth[0],
                                   .law = {&law[0], &law[1]},
                                   .phase_right = -design->alignment.stagger,
                                   .gated = true};
  int n = (int)json_array_size(json_array_get(json_object_get(stage, "Z_um"), 0)),
      order = design->resolution.te_harmonics;
  double *z = calloc((size_t)(2 * (n > 0 ? n : 1)), sizeof *z), *k = z + n;
  enum eo_code code = z ? EO_OK : eo_error_memory(error);
  if (!code)
    code = eo_dynamics_parameters_init(&parameters, g, &design->gear_pair, &design->material, &design->supports, false,
                                       1, error);
  if (!code)
    code = eo_vibration_new(&solver, design->resolution.harmonics, 0, error);
  if (!code)
    code = eo_vibration_set_model(solver, &parameters, error);
  for (int secant = 0; secant < 2 && !code; secant++) {
    for (int end = 0; end < 2 && !code; end++) {
      for (int j = 0; j < n; j++) {
        z[j] = 1e-6 * json_number_value(
                          json_array_get(json_array_get(json_object_get(stage, "Z_um"), (size_t)end), (size_t)j));
        k[j] = 1e6 * json_number_value(
                         json_array_get(json_array_get(json_object_get(stage, "kt_N_um"), (size_t)end), (size_t)j));
      }
      double datum = 1e-6 * eo_verify_element(ends, "datum_Z_um", end);
      code = secant ? eo_law_set_secant(&law[end], n, z, force, isnan(datum) ? 0 : datum, order, back, error)
                    : eo_law_set_tangent(&law[end], n, z, k, force, order, back, error);
    }
    if (!code)
      code = eo_vibration_solve(solver, &load, EO_START_COLD, &result[secant], error);
  }
  if (!code) {
    char label[80];
    snprintf(label, sizeof label, "%s stage arrays", text_of(item, "id"));
    json_t *tolerance = json_pack("{s:f, s:f, s:f, s:f}", "rms_n", 1e-3, "rms_t", 1e-3, "rms_rot", 1e-3, "rms_n_secant",
                                  1e-3);
    struct expected e = {b->v, label, json_object_get(item, "out"), tolerance};
    check(&e, "rms_n", result[0].rms_pair[EO_READING_NORMAL]);
    check(&e, "rms_t", result[0].rms_pair[EO_READING_TRANSVERSE]);
    check(&e, "rms_rot", result[0].rms_pair[EO_READING_ROTATIONAL]);
    check(&e, "rms_n_secant", result[1].rms_pair[EO_READING_NORMAL]);
    json_decref(tolerance);
  }
  eo_vibration_free(solver);
  eo_law_done(&law[0]);
  eo_law_done(&law[1]);
  free(z);
  return code;
}

static enum eo_code run_case(struct bench *b, const json_t *item, struct eo_error *error)
{
  enum eo_code code = prepare(b, item, error);
  if (code)
    return code;
  struct eo_design design = b->design;
  const json_t *mods = json_object_get(b->file, "mods"), *parameters = json_object_get(b->file, "dynamics_params");
  static const char *const end_name[2] = {"left", "right"};
  const struct eo_evaluation *r;
  eo_case_misalignment(json_object_get(item, "mis_rad"), &design.alignment);
  for (int end = 0; end < 2; end++)
    eo_case_modification(json_object_get(mods, text_of(item, end_name[end])), &design.gear_pair,
                         &design.modification.flank[EO_PINION][end]);
  design.load_case[0] = (struct eo_load_case){eo_verify_number_or(item, "T_Nm", NAN),
                                              eo_verify_number_or(item, "rpm", 2000) * M_PI / 30, 1};
  design.alignment.stagger = fmod(2 - eo_verify_number_or(item, "shift_right", 0), 1);
  const json_t *usual = json_object_get(parameters, b->pair_name);
  set_supports(&design.supports, usual, usual);
  set_supports(&design.supports, json_object_get(item, "dyn_changes"), usual);
  struct expected e = {b->v, text_of(item, "id"), json_object_get(item, "out"), json_object_get(item, "tol_rel")};
  code = eo_evaluator_run(b->evaluator, &design, NULL, 0, &r, error);
  if (code)
    return code;
  check_nominal(&e, item, r);
  design.resolution.impact_in_dynamics = EO_IMPACT_PAPER;
  code = eo_evaluator_run(b->evaluator, &design, NULL, 0, &r, error);
  if (code)
    return code;
  check(&e, "rms_n_impact", r->load_case[0].vibration.rms_pair[EO_READING_NORMAL]);
  check(&e, "rms_rot_impact", r->load_case[0].vibration.rms_pair[EO_READING_ROTATIONAL]);
  design.resolution.impact_in_dynamics = EO_IMPACT_NONE;
  design.resolution.mesh_law = EO_LAW_SECANT;
  code = eo_evaluator_run(b->evaluator, &design, NULL, 0, &r, error);
  if (code)
    return code;
  check(&e, "rms_n_secant", r->load_case[0].vibration.rms_pair[EO_READING_NORMAL]);
  return json_object_get(item, "stage") ? check_stage(b, item, &design, error) : EO_OK;
}

enum eo_code eo_verify_evaluation(const json_t *file, struct eo_verification *v, struct eo_error *error)
{
  struct bench *b = calloc(1, sizeof *b);
  size_t index;
  json_t *item;
  if (!b)
    return eo_error_memory(error);
  b->file = file;
  b->v = v;
  enum eo_code code = EO_OK;
  json_array_foreach(json_object_get(file, "cases"), index, item)
  {
    code = run_case(b, item, error);
    if (code && code != EO_ERROR_INPUT && code != EO_ERROR_NUMERIC)
      break;
    if (code) /* this case alone */
      eo_verify_broken(v, text_of(item, "id"), error);
    code = EO_OK;
  }
  eo_evaluator_free(b->evaluator);
  eo_pair_free(b->pair);
  free(b);
  return code;
}
