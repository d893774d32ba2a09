#include "reference/verify_contact.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference/case_pair.h"
#include "evaluation/evaluator.h"

static void check_one(struct eo_contact_case *c, const char *label, const char *quantity, double value, double expected,
                      double tolerance)
{
  if (!isnan(expected))
    eo_verify_add(c->v, label, quantity, value, expected, tolerance);
}

static void check_pair(struct eo_contact_case *c, const char *label, const char *quantity, const json_t *expected,
                       const double value[2], double relative, double least)
{
  for (int end = 0; end < 2; end++) {
    char name[80];
    double wanted = eo_verify_at(expected, (size_t)end);
    snprintf(name, sizeof name, "%s %s", quantity, end ? "right" : "left");
    check_one(c, label, name, value[end], wanted, fmax(relative * fabs(wanted), least));
  }
}

/* The modification a case names by "mod", "left" and "right", or by the first word of its name. */
static void set_modification(struct eo_contact_case *c, const json_t *item, struct eo_design *design)
{
  static const char *const side[2] = {"left", "right"};
  const json_t *mods = json_object_get(json_object_get(c->file, "modification"), "mods");
  const char *both = json_string_value(json_object_get(item, "mod"));
  char word[41] = "";
  const char *name = json_string_value(json_object_get(item, json_object_get(item, "case") ? "case" : "name"));
  if (name)
    snprintf(word, sizeof word, "%.*s", (int)strcspn(name, " ,"), name);
  for (int end = 0; end < 2; end++) {
    const char *own = json_string_value(json_object_get(item, side[end]));
    const char *use = own                              ? own
                      : both                           ? both
                      : json_object_get(mods, word)    ? word
                      : strncmp(word, "unmod", 5) == 0 ? "unmod"
                                                       : word;
    eo_contact_case_modification(c, use, &design->modification.flank[EO_PINION][end]);
  }
}

/* ---- ltca_synthetic ---- */

static void check_row(struct eo_contact_case *c, const char *label, const json_t *block, const json_t *row,
                      const struct eo_pair *pair, const struct eo_evaluation *r, int j)
{
  const struct eo_contact_position *p = &pair->grid->position[j];
  double z[2], q[2] = {0, 0};
  char quantity[60];
  for (int end = 0; end < 2; end++) {
    const struct eo_loaded_end *loaded = &r->load_case[0].end[end].loaded;
    const char *key;
    json_t *share;
    z[end] = 1e6 * loaded->approach[j];
    for (int i = 0; i < p->points; i++)
      q[end] = fmax(q[end], 1e-3 * loaded->line_load[p->first + i]);
    json_object_foreach(json_array_get(json_object_get(row, "share_N"), (size_t)end), key, share)
    {
      double load = 0;
      for (int i = 0; i < p->points; i++)
        load += p->point[i].pair == atoi(key) ? loaded->line_load[p->first + i] * p->length[i] : 0;
      snprintf(quantity, sizeof quantity, "load of pair %.10s, N, c %.6g %s", key, eo_verify_number(row, "c"),
               end ? "right" : "left");
      eo_verify_add(c->v, label, quantity, load, json_number_value(share),
                    fmax(eo_verify_number_or(block, "tol_rel_share", 0.01) * json_number_value(share), 1));
    }
  }
  snprintf(quantity, sizeof quantity, "Z_um at c %.6g", eo_verify_number(row, "c"));
  check_pair(c, label, quantity, json_object_get(row, "Z_um"), z, eo_verify_number_or(block, "tol_rel_Z", 0.002), 0);
  snprintf(quantity, sizeof quantity, "qmax at c %.6g", eo_verify_number(row, "c"));
  check_pair(c, label, quantity, json_object_get(row, "qmax"), q, eo_verify_number_or(block, "tol_rel_qmax", 0.03), 0);
}

static enum eo_code check_synthetic(struct eo_contact_case *c, const json_t *block, const json_t *item,
                                    const struct eo_closed_form *form, struct eo_error *error)
{
  const json_t *rows = json_object_get(item, "rows");
  size_t n = json_array_size(rows);
  const char *name = json_string_value(json_object_get(item, "name")),
             *kernel = json_string_value(json_object_get(block, "kernel"));
  double *phase = calloc(n + 1, sizeof *phase);
  struct eo_design *design = malloc(sizeof *design);
  struct eo_pair *pair = NULL;
  struct eo_evaluator *evaluator = NULL;
  const struct eo_evaluation *r;
  enum eo_code code = phase && design ? EO_OK : eo_error_memory(error);
  if (!code) {
    struct eo_contact_grid_settings grid = {.positions = (int)n,
                                            .cells = eo_case_count(kernel, "equal cells per line", 60)};
    struct eo_pair_options options = {
        .kernel = {eo_closed_form_kernel, form}, .grid = &grid, .phase = phase, .own_pivots = true};
    for (size_t i = 0; i < n; i++)
      phase[i] = 1e-3 * eo_verify_number(json_array_get(rows, i), "c");
    *design = c->design;
    design->load_case[0].torque = eo_verify_number_or(item, "T", NAN);
    design->alignment.pinion_axial = json_is_true(json_object_get(item, "fixed")) ? EO_AXIAL_FIXED : EO_AXIAL_FLOATING;
    eo_case_misalignment(json_object_get(item, "mis"), &design->alignment);
    set_modification(c, item, design);
    design->resolution.positions = grid.positions;
    code = n < 1 ? eo_error_set(error, EO_ERROR_INPUT, "/ltca_synthetic/cases", "A case has no rows.")
                 : eo_pair_new(&pair, design, &options, NULL, error);
  }
  if (!code)
    code = eo_evaluator_new(&evaluator, pair, 1, error);
  if (!code)
    code = eo_evaluator_contact(evaluator, design, &r, error);
  for (size_t i = 0; i < n && !code; i++)
    check_row(c, name ? name : "ltca", block, json_array_get(rows, i), pair, r, (int)i);
  eo_evaluator_free(evaluator);
  eo_pair_free(pair);
  free(design);
  free(phase);
  return code;
}

/* ---- impact ---- */

static void check_corners(struct eo_contact_case *c, const json_t *list)
{
  struct eo_flank_modification none = {0};
  struct eo_corner_gap corner[2];
  struct eo_gap_field *field = malloc(sizeof *field);
  size_t index;
  json_t *row;
  if (!field)
    return;
  eo_corner_gap_init(corner, &c->geometry);
  eo_gap_field_init(field, &c->geometry, &none, &none, EO_RIGHT, 0, 0, 0, corner);
  json_array_foreach(list, index, row)
  {
    char quantity[60];
    double before = eo_verify_number(row, "before_A_mm"),
           gap = eo_gap_field_at(field, c->geometry.path_start - 1e-3 * before, 0, NULL, NULL);
    snprintf(quantity, sizeof quantity, "corner gap um, %g mm before A", before);
    check_one(c, "impact", quantity, 1e6 * gap, eo_verify_number(row, "gap_um"), 1e-3);
  }
  free(field);
}

static enum eo_code check_impact(struct eo_contact_case *c, const json_t *block, const json_t *item,
                                 struct eo_error *error)
{
  enum { POSITIONS = 8 };
  static const struct eo_closed_form form = {1.5e-9, 12e-3, 0, 0, 0};
  struct eo_kernel kernel = {eo_closed_form_kernel, &form};
  struct eo_contact_grid_settings settings = {.positions = POSITIONS, .cells = 4};
  struct eo_contact_grid *grid = NULL;
  struct eo_gap_field *field = malloc(sizeof *field);
  struct eo_flank_modification flank, none = {0};
  struct eo_alignment alignment;
  struct eo_impact impact;
  double approach[POSITIONS], speed = eo_verify_number_or(block, "rpm", 2000) * M_PI / 30;
  struct eo_impact_settings how = {.patch = c->design.resolution.impact_patch};
  const char *label = json_string_value(json_object_get(item, "name"));
  enum eo_code code = field ? eo_contact_grid_new(&grid, &c->geometry, &c->design.material, &settings, NULL, kernel,
                                                  NULL, error)
                            : eo_error_memory(error);
  if (!code) {
    eo_impact_inertia(&c->geometry, &c->design.material, how.inertia);
    eo_case_modification(json_object_get(item, "mod"), &c->design.gear_pair, &flank);
    eo_case_misalignment(json_object_get(item, "mis"), &alignment);
    eo_gap_field_init(field, &c->geometry, &flank, &none, eo_verify_number_or(item, "end", 1) < 0 ? EO_LEFT : EO_RIGHT,
                      alignment.shaft_angle_in_plane, alignment.shaft_angle_out_of_plane, 0, grid->corner);
    for (int j = 0; j < POSITIONS; j++)
      approach[j] = 1e-6 * eo_verify_number_or(item, "Z_um", NAN);
    eo_impact_find(&impact, grid, field, kernel, &how, approach, speed, 1);
    bool off = json_is_true(json_object_get(item, "off_line"));
    double wanted = eo_verify_number(item, "closing_speed_mm_s");
    check_one(c, label, "c mm", 1e3 * impact.phase, eo_verify_number(item, "c"), 0.02);
    check_one(c, label, "eta mm", 1e3 * impact.eta, eo_verify_number(item, "eta"), 0.5);
    check_one(c, label, "off the line", impact.off_line, json_is_boolean(json_object_get(item, "off_line")) ? off : NAN,
              0);
    check_one(c, label, "pinion radius mm", 1e3 * impact.pinion_radius, eo_verify_number(item, "pinion_radius"), 0.02);
    check_one(c, label, "closing speed mm/s", 1e3 * impact.speed, wanted, (off ? 0.005 : 0.03) * fabs(wanted));
    for (int member = 0; member < 2; member++)
      check_one(c, label, member ? "inertia gear, t mm2" : "inertia pinion, t mm2", 1e3 * how.inertia[member],
                eo_verify_element(block, "inertia_t_mm2", member),
                1e-6 * eo_verify_element(block, "inertia_t_mm2", member));
    check_one(c, label, "effective mass, t", 1e-3 * eo_impact_mass(&c->geometry, how.inertia),
              eo_verify_number(block, "m_eff_t"), 1e-9 * eo_verify_number(block, "m_eff_t") + 1e-12);
  }
  eo_contact_grid_free(grid);
  free(field);
  return code;
}

/* ---- finite elements: fe_bulk, ltca_table ---- */

static void check_bulk(struct eo_contact_case *c, const struct eo_flexibility *flexibility, const json_t *block,
                       int member)
{
  enum { N = 111 };
  double *compliance = malloc(sizeof *compliance * N * N);
  double relative = eo_verify_number_or(block, "tol_rel", 0.06), width = c->geometry.face_width;
  size_t index;
  json_t *row;
  json_array_foreach(json_object_get(block, member ? "gear" : "pinion"), index, row)
  {
    struct eo_flank_point point[N];
    double s = 1e-3 * eo_verify_number(row, "s");
    if (!compliance)
      break;
    /* Midpoints of equal stretches carry 1 N per mm of face width; the ends and the middle are read as well, unloaded.
     */
    for (int i = 0; i < N - 3; i++)
      point[i] = (struct eo_flank_point){0, {s, s}, width * ((i + 0.5) / (N - 3) - 0.5)};
    for (int i = 0; i < 3; i++)
      point[N - 3 + i] = (struct eo_flank_point){0, {s, s}, width * (0.5 * i - 0.5)};
    memset(compliance, 0, sizeof *compliance * N * N);
    eo_flexibility_add_compliance(flexibility, member, N, point, compliance);
    for (int k = 0; k < 3; k++) {
      double sum = 0, wanted = eo_verify_element(row, "d", k);
      char quantity[80];
      for (int i = 0; i < N - 3; i++)
        sum += compliance[(N - 3 + k) * N + i] * 1e3 * width / (N - 3);
      snprintf(quantity, sizeof quantity, "%s, um at s %g, %s", member ? "gear" : "pinion", 1e3 * s,
               k == 0   ? "-b/2"
               : k == 1 ? "0"
                        : "+b/2");
      check_one(c, "fe_bulk", quantity, 1e6 * sum, wanted, relative * fabs(wanted));
    }
  }
  free(compliance);
}

static double mean_of(int n, const double *value)
{
  double sum = 0;
  for (int i = 0; i < n; i++)
    sum += value[i] / n;
  return sum;
}

static void check_table_row(struct eo_contact_case *c, const json_t *row, const struct eo_evaluation *r, bool modified)
{
  const struct eo_case_result *o = &r->load_case[0];
  const struct eo_end_result *e = o->end;
  char label[100];
  double k[2] = {0, 0}, k0[2] = {0, 0}, kt[2], low = INFINITY, high = -INFINITY,
         pp = eo_verify_number_or(row, "PPLTE_um", 0);
  double normal = cos(c->geometry.base_helix_angle);
  snprintf(label, sizeof label, "table: %s, %s, %g N m", json_string_value(json_object_get(row, "case")),
           json_string_value(json_object_get(row, "mis")), eo_verify_number(row, "T"));
  for (int end = 0; end < 2; end++)
    for (int j = 0; j < r->positions; j++) {
      k[end] += 1e-6 * o->force / e[end].loaded.approach[j] / r->positions;
      k0[end] += 1e-6 * o->force / (e[end].loaded.approach[j] - e[end].datum) / r->positions;
    }
  for (int j = 0; j < r->positions; j++) {
    double z = (e[0].unloaded[j] + e[1].unloaded[j]) / 2 / normal;
    low = fmin(low, z);
    high = fmax(high, z);
  }
  for (int end = 0; end < 2; end++)
    kt[end] = 1e-6 * mean_of(r->positions, e[end].loaded.tangent);
  check_one(c, label, "PPLTE_um", 1e6 * o->peak_to_peak, pp, fmax(0.15, 0.2 * pp));
  check_pair(c, label, "PPLTE_um of the end", json_object_get(row, "PPLTE_ends_um"),
             (double[]){1e6 * e[0].transmission_peak, 1e6 * e[1].transmission_peak}, 0.2, 0.15);
  check_one(c, label, "LTE_mean_um", 1e6 * o->mean, eo_verify_number(row, "LTE_mean_um"),
            0.08 * eo_verify_number(row, "LTE_mean_um"));
  check_one(c, label, "TE0_pp_um", 1e6 * (high - low), eo_verify_number(row, "TE0_pp_um"),
            fmax(0.15, 0.2 * eo_verify_number_or(row, "TE0_pp_um", 0)));
  check_pair(c, label, "k_PZ_N_um", json_object_get(row, "k_PZ_N_um"), k, 0.08, 0);
  check_pair(c, label, "k_PZ0_N_um", json_object_get(row, "k_PZ0_N_um"), k0, 0.08, 0);
  check_pair(c, label, "kt_N_um", json_object_get(row, "kt_N_um"), kt, 0.08, 0);
  check_pair(c, label, "qmax_N_mm", json_object_get(row, "qmax_N_mm"),
             (double[]){1e-3 * e[0].max_line_load, 1e-3 * e[1].max_line_load}, modified ? 0.08 : 0.3, 0);
  check_pair(c, label, "pH_MPa", json_object_get(row, "pH_MPa"),
             (double[]){1e-6 * e[0].max_pressure, 1e-6 * e[1].max_pressure}, modified ? 0.08 : 0.3, 0);
  check_pair(c, label, "impact_N", json_object_get(row, "impact_N"),
             (double[]){e[0].impact.classical, e[1].impact.classical}, 0.2, 0);
  check_pair(c, label, "impact_general_N", json_object_get(row, "impact_general_N"),
             (double[]){e[0].impact.force, e[1].impact.force}, 0.2, 0);
  check_pair(c, label, "v_mm_s", json_object_get(row, "v_mm_s"),
             (double[]){1e3 * e[0].impact.speed, 1e3 * e[1].impact.speed}, 0.2, 0);
  check_pair(c, label, "pulse_ms", json_object_get(row, "pulse_ms"),
             (double[]){1e3 * e[0].impact.duration, 1e3 * e[1].impact.duration}, 0.2, 0);
  const json_t *z = json_object_get(row, "Z_um");
  size_t rows = json_array_size(z);
  for (size_t i = 0; i < rows; i++) {
    size_t j = i * (size_t)r->positions / rows;
    char quantity[60];
    snprintf(quantity, sizeof quantity, "Z_um [%zu]", i);
    check_pair(c, label, quantity, json_array_get(z, i),
               (double[]){1e6 * e[0].loaded.approach[j], 1e6 * e[1].loaded.approach[j]}, 0.08, 0);
  }
}

static enum eo_code check_finite_elements(struct eo_contact_case *c, struct eo_error *error)
{
  const json_t *bulk = json_object_get(c->file, "fe_bulk"), *table = json_object_get(c->file, "ltca_table");
  const char *note = json_string_value(json_object_get(table, "note"));
  struct eo_design *design = malloc(sizeof *design);
  struct eo_pair *pair = NULL;
  struct eo_evaluator *evaluator = NULL;
  const struct eo_evaluation *r;
  struct eo_pair_options options = {.own_pivots = true, .impact_stations = 221};
  size_t index;
  json_t *row;
  if (!bulk && !table) {
    free(design);
    return EO_OK;
  }
  enum eo_code code = design ? EO_OK : eo_error_memory(error);
  if (!code) {
    *design = c->design;
    design->resolution.sector_teeth = 3;
    design->resolution.neighbour_coupling = false;
    design->resolution.tip_edge_contact = false;
    design->resolution.positions = eo_case_count(note, "positions", 32);
    design->resolution.cells_per_line = eo_case_count(note, "cells per line", 30);
    code = eo_pair_new(&pair, design, &options, NULL, error);
  }
  if (!code)
    code = eo_evaluator_new(&evaluator, pair, 1, error);
  for (int member = 0; member < 2 && !code && bulk; member++)
    check_bulk(c, pair->flexibility, bulk, member);
  json_array_foreach(json_object_get(table, "rows"), index, row)
  {
    if (code)
      break;
    design->load_case[0] =
        (struct eo_load_case){eo_verify_number_or(row, "T", NAN),
                              eo_verify_number_or(json_object_get(c->file, "impact"), "rpm", 2000) * M_PI / 30, 1};
    eo_case_misalignment(json_object_get(row, "mis"), &design->alignment);
    set_modification(c, row, design);
    code = eo_evaluator_contact(evaluator, design, &r, error);
    if (!code)
      check_table_row(c, row, r, !eo_modification_is_none(&design->modification.flank[EO_PINION][EO_LEFT]));
  }
  eo_evaluator_free(evaluator);
  eo_pair_free(pair);
  free(design);
  return code;
}

enum eo_code eo_verify_contact_loaded(struct eo_contact_case *c, struct eo_error *error)
{
  const json_t *synthetic = json_object_get(c->file, "ltca_synthetic"), *impact = json_object_get(c->file, "impact");
  struct eo_closed_form form;
  enum eo_code code = EO_OK;
  size_t index;
  json_t *item;
  if (synthetic && !eo_case_closed_form(json_string_value(json_object_get(synthetic, "kernel")), &form))
    return eo_error_set(error, EO_ERROR_INPUT, "/ltca_synthetic/kernel",
                        "The closed-form compliance could not be read.");
  json_array_foreach(json_object_get(synthetic, "cases"), index, item) if (!code)
      code = check_synthetic(c, synthetic, item, &form, error);
  check_corners(c, json_object_get(impact, "corner_gap_unmod"));
  json_array_foreach(json_object_get(impact, "cases"), index, item) if (!code)
      code = check_impact(c, impact, item, error);
  return code ? code : check_finite_elements(c, error);
}
