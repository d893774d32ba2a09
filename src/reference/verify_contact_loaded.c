/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/verify_contact.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gear/names.h"
#include "reference/contact_case.h"

struct synthetic {
  struct eo_contact_case *c;
  struct eo_case *block;
  struct eo_closed_form form;
  double relative_share, relative_z, relative_q;
};

enum { LARGEST_PAIR = 1000 };

static double load_of_pair(const struct eo_contact_position *position, const double *line_load, int pair)
{
  double load = 0;
  for (int i = 0; i < position->points; i++)
    load += position->point[i].pair == pair ? line_load[i] * position->length[i] : 0;
  return load;
}

/* Loads of the pairs of one end, to 1 N where they vanish; all pairs that carry are named. */
static void check_shares(const struct synthetic *synthetic, struct eo_case *shares,
                         const struct eo_contact_position *position, const double *line_load)
{
  const double least = 1;
  double named = 0, total = 0;
  for (int i = 0; i < position->points; i++)
    total += line_load[i] * position->length[i];
  for (int i = 0; i < eo_case_size(shares); i++) {
    struct eo_case *share = eo_case_at(shares, i);
    double pair = eo_case_key_number(share);
    if (!(fabs(pair) < LARGEST_PAIR) || pair != floor(pair)) {
      eo_case_fault(share, "The key is the number of a pair of teeth.");
      return;
    }
    double load = load_of_pair(position, line_load, (int)pair);
    named += load;
    eo_verify_number(synthetic->c->v, share, load, synthetic->relative_share, least);
  }
  eo_verify_derived(synthetic->c->v, shares, "load of all pairs named, N", named, total,
                    synthetic->relative_share * total);
}

static void check_row(const struct synthetic *synthetic, struct eo_case *row,
                      const struct eo_contact_position *position, const struct eo_evaluation *evaluation, int j)
{
  double z[2], q[2] = {0, 0};
  struct eo_case *shares = eo_case_find(row, "share_N");
  if (shares)
    eo_verify_size(synthetic->c->v, shares, 2);
  for (int end = 0; end < 2; end++) {
    const struct eo_loaded_end *loaded = &evaluation->load_case[0].end[end].loaded;
    z[end] = 1e6 * loaded->approach[j];
    for (int i = 0; i < position->points; i++)
      q[end] = fmax(q[end], 1e-3 * loaded->line_load[position->first + i]);
    if (shares && eo_case_at(shares, end))
      check_shares(synthetic, eo_case_at(shares, end), position, loaded->line_load + position->first);
  }
  eo_verify_list(synthetic->c->v, eo_case_need(row, "Z_um"), 2, z, 1, synthetic->relative_z, 0);
  eo_contact_case_ends(synthetic->c, row, "qmax", q, synthetic->relative_q, 0);
}

static enum eo_code solve_rows(const struct synthetic *synthetic, struct eo_case *rows, const double *phase,
                               struct eo_contact_rig *rig, struct eo_error *error)
{
  int n = eo_case_size(rows);
  struct eo_contact_grid_settings grid = {
      .positions = n, .cells = eo_case_count(synthetic->block, "kernel", "equal cells per line", 60)};
  struct eo_pair_options options = {.kernel = {eo_closed_form_kernel, &synthetic->form},
                                    .grid = &grid,
                                    .phase = phase,
                                    .own_pivots = true,
                                    .tilt_rule = synthetic->c->tilt_rule};
  const struct eo_evaluation *evaluation;
  rig->design.resolution.positions = n;
  enum eo_code code = eo_contact_rig_prepare(rig, &options, error);
  if (!code)
    code = eo_evaluator_contact(rig->evaluator, &rig->design, &evaluation, error);
  if (code)
    return code;
  if (evaluation->load_case[0].contact_failures)
    eo_verify_diverged(synthetic->c->v, rows);
  else
    for (int i = 0; i < n; i++)
      check_row(synthetic, eo_case_at(rows, i), &rig->pair->grid->position[i], evaluation, i);
  return EO_OK;
}

static enum eo_code check_synthetic(void *context, struct eo_case *item, struct eo_error *error)
{
  const struct synthetic *synthetic = context;
  struct eo_case *rows = eo_case_need(item, "rows");
  int n = eo_case_size(rows);
  double *phase = calloc((size_t)n + 1, sizeof *phase);
  struct eo_contact_rig *rig = calloc(1, sizeof *rig);
  enum eo_code code = phase && rig ? EO_OK : eo_error_memory(error);
  if (!code) {
    struct eo_design *design = &rig->design;
    *design = synthetic->c->design;
    for (int i = 0; i < n; i++)
      phase[i] = 1e-3 * eo_case_number(eo_case_at(rows, i), "c");
    design->load_case[0].torque = eo_case_number(item, "T");
    design->alignment.pinion_axial = eo_case_flag_or(item, "fixed", false) ? EO_AXIAL_FIXED : EO_AXIAL_FLOATING;
    eo_supports_make_rigid(&design->supports); /* fixed: one Z for both ends */
    eo_case_misalignment(eo_case_need(item, "mis"), &design->alignment);
    eo_contact_case_modify(synthetic->c, item, design);
    if (rows && n < 1)
      eo_case_fault(rows, "Rows are expected here.");
    if (!eo_case_faulty(item))
      code = solve_rows(synthetic, rows, phase, rig, error);
  }
  if (rig)
    eo_contact_rig_done(rig);
  free(rig);
  free(phase);
  return code;
}

enum eo_code eo_verify_contact_synthetic(void *context, struct eo_case *block, struct eo_error *error)
{
  struct synthetic synthetic = {.c = context,
                                .block = block,
                                .relative_share = eo_case_relative_or(block, "tol_rel_share", 0.01),
                                .relative_z = eo_case_relative_or(block, "tol_rel_Z", 0.002),
                                .relative_q = eo_case_relative_or(block, "tol_rel_qmax", 0.03)};
  eo_case_closed_form(eo_case_need(block, "kernel"), &synthetic.form);
  return eo_verify_each(synthetic.c->v, eo_case_need(block, "cases"), check_synthetic, &synthetic, error);
}

struct impacts {
  struct eo_contact_case *c;
  double speed;
  double inertia[2];
};

static enum eo_code check_corners(struct eo_contact_case *contact_case, struct eo_case *list, struct eo_error *error)
{
  const double tolerance = 1e-3; /* um, as the files say */
  struct eo_flank_modification none = {0};
  struct eo_corner_gap corner[2];
  struct eo_gap_field *field = malloc(sizeof *field);
  if (!field)
    return eo_error_memory(error);
  eo_corner_gap_init(corner, &contact_case->geometry);
  eo_gap_field_init(field, &contact_case->geometry, &none, &none, EO_RIGHT, 0, 0, 0, corner);
  for (int i = 0; i < eo_case_size(list); i++) {
    struct eo_case *row = eo_case_at(list, i);
    double s = contact_case->geometry.path_start - 1e-3 * eo_case_number(row, "before_A_mm");
    eo_verify_number(contact_case->v, eo_case_need(row, "gap_um"), 1e6 * eo_gap_field_at(field, s, 0, NULL, NULL), 0,
                     tolerance);
  }
  free(field);
  return EO_OK;
}

static void compare_impact(struct eo_contact_case *contact_case, struct eo_case *item, const struct eo_impact *impact)
{
  const double millimetre = 0.02, face = 0.5, on_line = 0.03, off_line = 0.005;
  eo_verify_fact(contact_case->v, item, "touches", impact->touched);
  if (!impact->touched) {
    eo_case_skip(item);
    return;
  }
  eo_verify_member(contact_case->v, item, "c", 1e3 * impact->phase, 0, millimetre);
  eo_verify_member(contact_case->v, item, "eta", 1e3 * impact->eta, 0, face);
  eo_verify_exact(contact_case->v, eo_case_need(item, "off_line"), impact->off_line);
  eo_verify_member(contact_case->v, item, "pinion_radius", 1e3 * impact->pinion_radius, 0, millimetre);
  eo_verify_member(contact_case->v, item, "closing_speed_mm_s", 1e3 * impact->speed,
                   impact->off_line ? off_line : on_line, 0);
}

static void impact_flank(struct eo_contact_case *contact_case, struct eo_case *mod, struct eo_flank_modification *flank)
{
  if (eo_case_is_text(mod))
    eo_contact_case_modification(contact_case, eo_case_text(mod), mod, flank);
  else
    eo_case_modification(mod, &contact_case->design.gear_pair, flank);
}

static enum eo_code check_impact(void *context, struct eo_case *item, struct eo_error *error)
{
  enum { POSITIONS = 8, CELLS = 4 };
  /* Where teeth touch does not depend on the compliance; any will do. */
  static const struct eo_closed_form form = {1.5e-9, 12e-3, 0, 0, 0};
  const struct impacts *all = context;
  struct eo_contact_case *contact_case = all->c;
  struct eo_kernel kernel = {eo_closed_form_kernel, &form};
  struct eo_contact_grid_settings settings = {.positions = POSITIONS, .cells = CELLS};
  struct eo_impact_settings how = {.patch = contact_case->design.resolution.impact_patch,
                                   .inertia = {all->inertia[0], all->inertia[1]}};
  struct eo_flank_modification flank, none = {0};
  struct eo_alignment alignment;
  struct eo_corner_gap corner[2];
  struct eo_impact impact;
  double approach[POSITIONS], z = 1e-6 * eo_case_number(item, "Z_um"), end = eo_case_number(item, "end");
  if (!isnan(end) && fabs(end) != 1)
    eo_case_fault(eo_case_find(item, "end"), "An end is 1 (right) or -1 (left).");
  impact_flank(contact_case, eo_case_need(item, "mod"), &flank);
  eo_case_misalignment(eo_case_need(item, "mis"), &alignment);
  if (eo_case_faulty(item))
    return EO_OK;
  struct eo_contact_grid *grid = NULL;
  struct eo_gap_field *field = malloc(sizeof *field);
  enum eo_code code = field ? eo_contact_grid_new(&grid, &contact_case->geometry, &contact_case->design.material,
                                                  &settings, NULL, kernel, NULL, error)
                            : eo_error_memory(error);
  if (!code) {
    eo_corner_gap_init(corner, &contact_case->geometry);
    corner[0].rule = corner[1].rule = contact_case->tilt_rule;
    eo_gap_field_init(field, &contact_case->geometry, &flank, &none, end < 0 ? EO_LEFT : EO_RIGHT,
                      alignment.shaft_angle_in_plane, alignment.shaft_angle_out_of_plane, 0, corner);
    for (int j = 0; j < POSITIONS; j++)
      approach[j] = z;
    eo_impact_find(&impact, grid, field, kernel, &how, approach, all->speed, 1);
    compare_impact(contact_case, item, &impact);
  }
  eo_contact_grid_free(grid);
  free(field);
  return code;
}

enum eo_code eo_verify_contact_impact(void *context, struct eo_case *block, struct eo_error *error)
{
  struct impacts all = {.c = context, .speed = eo_case_number(block, "rpm") * M_PI / 30};
  struct eo_case *inertia = eo_case_find(block, "inertia_t_mm2");
  eo_impact_inertia(&all.c->geometry, &all.c->design.material, all.inertia);
  eo_case_remark(block, "tol");
  if (inertia)
    eo_verify_list(all.c->v, inertia, 2, all.inertia, 1e3, 1e-6, 0);
  eo_verify_member(all.c->v, block, "m_eff_t", 1e-3 * eo_impact_mass(&all.c->geometry, all.inertia), 1e-9, 1e-12);
  enum eo_code code = check_corners(all.c, eo_case_find(block, "corner_gap_unmod"), error);
  return code ? code : eo_verify_each(all.c->v, eo_case_find(block, "cases"), check_impact, &all, error);
}

/* As the files' reference has it: sectors of 3 teeth, each tooth pair with its own flexibility only unless the table
   says otherwise, no contact of tip edges. */
static enum eo_code prepare_sector(struct eo_contact_case *contact_case, struct eo_error *error)
{
  struct eo_pair_options options = {.own_pivots = true, .impact_stations = 221, .tilt_rule = contact_case->tilt_rule};
  struct eo_case *table = eo_case_find(contact_case->file, "ltca_table");
  struct eo_resolution *resolution = &contact_case->sector.design.resolution;
  if (contact_case->sector.evaluator)
    return EO_OK;
  contact_case->sector.design = contact_case->design;
  resolution->elements.body = EO_BODY_SECTOR;
  resolution->elements.sector_teeth = 3;
  resolution->elements.neighbour_coupling = table && eo_case_on(table, "neighbour_tooth_coupling", false);
  resolution->tip_edge_contact = false;
  resolution->positions = table ? eo_case_count(table, "note", "positions", 32) : 32;
  resolution->cells_per_line = table ? eo_case_count(table, "note", "cells per line", 30) : 30;
  return eo_case_faulty(contact_case->file) ? EO_OK : eo_contact_rig_prepare(&contact_case->sector, &options, error);
}

/* Midpoints of equal stretches carry 1 N per mm of face width; the ends and the middle are read as well, unloaded. */
static enum eo_code row_deflection(const struct eo_flexibility *flexibility, int member, double s, double width,
                                   double deflection[3], struct eo_error *error)
{
  enum { N = 111, LOADED = N - 3 };
  struct eo_flank_point point[N];
  double *compliance = calloc((size_t)N * N, sizeof *compliance);
  if (!compliance)
    return eo_error_memory(error);
  for (int i = 0; i < LOADED; i++)
    point[i] = (struct eo_flank_point){0, {s, s}, width * ((i + 0.5) / LOADED - 0.5)};
  for (int i = 0; i < 3; i++)
    point[LOADED + i] = (struct eo_flank_point){0, {s, s}, width * (0.5 * i - 0.5)};
  eo_flexibility_add_compliance(flexibility, member, N, point, compliance);
  for (int k = 0; k < 3; k++) {
    deflection[k] = 0;
    for (int i = 0; i < LOADED; i++)
      deflection[k] += compliance[(LOADED + k) * N + i] * 1e3 * width / LOADED;
  }
  free(compliance);
  return EO_OK;
}

static enum eo_code check_bulk(struct eo_contact_case *contact_case, const struct eo_flexibility *flexibility,
                               struct eo_case *block, int member, struct eo_error *error)
{
  double relative = eo_case_relative_or(block, "tol_rel", 0.06), deflection[3];
  struct eo_case *rows = eo_case_find(block, eo_member_name[member]);
  enum eo_code code = EO_OK;
  for (int i = 0; i < eo_case_size(rows) && !code; i++) {
    struct eo_case *row = eo_case_at(rows, i);
    double s = 1e-3 * eo_case_number(row, "s");
    if (isnan(s))
      break;
    code = row_deflection(flexibility, member, s, contact_case->geometry.face_width, deflection, error);
    if (!code)
      eo_verify_list(contact_case->v, eo_case_need(row, "d"), 3, deflection, 1e6, relative, 0);
  }
  return code;
}

enum eo_code eo_verify_contact_bulk(void *context, struct eo_case *block, struct eo_error *error)
{
  struct eo_contact_case *contact_case = context;
  enum eo_code code = prepare_sector(contact_case, error);
  for (int member = 0; member < 2 && !code && !eo_case_faulty(block); member++)
    code = check_bulk(contact_case, contact_case->sector.pair->flexibility, block, member, error);
  return code;
}

struct table {
  struct eo_contact_case *c;
  double speed; /* of the pinion, rad/s */
};

/* Tolerances of the table, as its "tol" says: mean and stiffness, peak to peak, impact. */
static const double of_level = 0.08, of_peak = 0.2, of_edge = 0.3, of_impact = 0.2, least_peak = 0.15;

static double mean_of(int n, const double *value)
{
  double sum = 0;
  for (int i = 0; i < n; i++)
    sum += value[i] / n;
  return sum;
}

static void check_stiffness(struct eo_contact_case *contact_case, struct eo_case *row,
                            const struct eo_evaluation *evaluation)
{
  const struct eo_case_result *case_result = &evaluation->load_case[0];
  double k[2] = {0, 0}, k0[2] = {0, 0}, kt[2];
  for (int end = 0; end < 2; end++) {
    const struct eo_end_result *end_result = &case_result->end[end];
    kt[end] = 1e-6 * mean_of(evaluation->positions, end_result->loaded.tangent);
    for (int j = 0; j < evaluation->positions; j++) {
      k[end] += 1e-6 * case_result->force / end_result->loaded.approach[j] / evaluation->positions;
      k0[end] += 1e-6 * case_result->force / (end_result->loaded.approach[j] - end_result->datum) /
                 evaluation->positions;
    }
  }
  eo_contact_case_ends(contact_case, row, "k_PZ_N_um", k, of_level, 0);
  eo_contact_case_ends(contact_case, row, "k_PZ0_N_um", k0, of_level, 0);
  eo_contact_case_ends(contact_case, row, "kt_N_um", kt, of_level, 0);
}

/* How far the pair is from entering the field of contact, at the leading end of A, when the tip corner touches first.
   The touch is where the gap equals the approach, so a level within 8 % moves it by as much as the slope of the gap
   makes of that. The table states no tolerance of its own: behind A, where relieved flanks close slowly and the place
   is the less certain the gentler they do, what counts of the touch is its speed and force, which are compared. */
static void check_leads(struct eo_contact_case *contact_case, struct eo_case *leads,
                        const struct eo_case_result *case_result)
{
  if (leads)
    eo_verify_size(contact_case->v, leads, 2);
  for (int end = 0; end < 2 && end < eo_case_size(leads); end++) {
    const struct eo_impact *impact = &case_result->end[end].impact;
    struct eo_case *wanted = eo_case_at(leads, end);
    double level = mean_of(contact_case->sector.pair->grid->positions, case_result->end[end].loaded.approach);
    double entry = contact_case->geometry.path_start -
                   0.5 * contact_case->geometry.face_width * tan(contact_case->geometry.base_helix_angle);
    if (impact->off_line)
      eo_verify_number(contact_case->v, wanted, 1e3 * (entry - impact->phase), 0,
                       1e3 * of_level * level / fabs(impact->slope));
    else
      eo_verify_uncompared(contact_case->v, wanted,
                           "the tip corner is not what touches first; speed and force are compared.");
  }
}

/* Impacts are within 20 %, to a thousandth of the mesh load where there is none. */
static void check_impacts(struct eo_contact_case *contact_case, struct eo_case *row,
                          const struct eo_case_result *case_result)
{
  const double least = 1e-3 * case_result->force;
  double classical[2], general[2], speed[2], duration[2];
  for (int end = 0; end < 2; end++) {
    const struct eo_impact *impact = &case_result->end[end].impact;
    classical[end] = impact->classical;
    general[end] = impact->force;
    speed[end] = 1e3 * impact->speed;
    duration[end] = 1e3 * impact->duration;
  }
  eo_contact_case_ends(contact_case, row, "impact_N", classical, of_impact, least);
  eo_contact_case_ends(contact_case, row, "impact_general_N", general, of_impact, least);
  eo_contact_case_ends(contact_case, row, "v_mm_s", speed, of_impact, 0);
  eo_contact_case_ends(contact_case, row, "pulse_ms", duration, of_impact, 0);
  check_leads(contact_case, eo_case_find(row, "emip_lead_mm"), case_result);
}

/* Peak to peak of the unloaded transmission error, both ends together, transverse. */
static double unloaded_peak(const struct eo_contact_case *contact_case, const struct eo_evaluation *evaluation)
{
  const struct eo_end_result *end_result = evaluation->load_case[0].end;
  double low = INFINITY, high = -INFINITY;
  for (int j = 0; j < evaluation->positions; j++) {
    double z = (end_result[0].unloaded[j] + end_result[1].unloaded[j]) / 2 /
               cos(contact_case->geometry.base_helix_angle);
    low = fmin(low, z);
    high = fmax(high, z);
  }
  return high - low;
}

/* Rows of [left, right] at equal steps over the mesh cycle. */
static void check_approaches(struct eo_contact_case *contact_case, struct eo_case *rows,
                             const struct eo_evaluation *evaluation)
{
  const struct eo_end_result *end_result = evaluation->load_case[0].end;
  int n = eo_case_size(rows);
  if (n && evaluation->positions % n)
    eo_case_fault(rows, "%d rows do not divide the %d positions.", n, evaluation->positions);
  for (int i = 0; i < n; i++) {
    int j = i * evaluation->positions / n;
    const double z[2] = {end_result[0].loaded.approach[j], end_result[1].loaded.approach[j]};
    eo_verify_list(contact_case->v, eo_case_at(rows, i), 2, z, 1e6, of_level, 0);
  }
}

static void check_table_row(struct eo_contact_case *contact_case, struct eo_case *row,
                            const struct eo_evaluation *evaluation, bool modified)
{
  const struct eo_case_result *case_result = &evaluation->load_case[0];
  const struct eo_end_result *end_result = case_result->end;
  const double of_pressure = modified ? of_level : of_edge;
  eo_verify_number(contact_case->v, eo_case_need(row, "PPLTE_um"), 1e6 * case_result->peak_to_peak, of_peak,
                   least_peak);
  eo_contact_case_ends(contact_case, row, "PPLTE_ends_um",
                       (double[]){1e6 * end_result[0].transmission_peak, 1e6 * end_result[1].transmission_peak},
                       of_peak, least_peak);
  eo_verify_number(contact_case->v, eo_case_need(row, "LTE_mean_um"), 1e6 * case_result->mean, of_level, 0);
  eo_verify_member(contact_case->v, row, "TE0_pp_um", 1e6 * unloaded_peak(contact_case, evaluation), of_peak,
                   least_peak);
  check_stiffness(contact_case, row, evaluation);
  eo_contact_case_ends(contact_case, row, "qmax_N_mm",
                       (double[]){1e-3 * end_result[0].max_line_load, 1e-3 * end_result[1].max_line_load}, of_pressure,
                       0);
  eo_contact_case_ends(contact_case, row, "pH_MPa",
                       (double[]){1e-6 * end_result[0].max_pressure, 1e-6 * end_result[1].max_pressure}, of_pressure,
                       0);
  check_impacts(contact_case, row, case_result);
  check_approaches(contact_case, eo_case_find(row, "Z_um"), evaluation);
}

static enum eo_code check_row_of_table(void *context, struct eo_case *row, struct eo_error *error)
{
  const struct table *table = context;
  struct eo_design *design = &table->c->sector.design;
  const struct eo_evaluation *evaluation;
  design->load_case[0] = (struct eo_load_case){.torque = eo_case_number(row, "T"), .speed = table->speed, .share = 1};
  eo_case_misalignment(eo_case_need(row, "mis"), &design->alignment);
  eo_contact_case_modify(table->c, row, design);
  if (eo_case_faulty(row))
    return EO_OK;
  enum eo_code code = eo_evaluator_contact(table->c->sector.evaluator, design, &evaluation, error);
  if (code)
    return code;
  if (evaluation->load_case[0].contact_failures)
    eo_verify_diverged(table->c->v, row);
  else
    check_table_row(table->c, row, evaluation,
                    !eo_modification_is_none(&design->modification.flank[EO_PINION][EO_LEFT]));
  return EO_OK;
}

/* The speed of the table's impacts is that of the block "impact". */
static double table_speed(struct eo_contact_case *contact_case)
{
  const double usual = 2000;
  struct eo_case *impact = eo_case_find(contact_case->file, "impact");
  if (!impact)
    eo_verify_note(contact_case->v, "No block \"impact\" states the speed; ltca_table is run at %g rpm.", usual);
  return (impact ? eo_case_number(impact, "rpm") : usual) * M_PI / 30;
}

enum eo_code eo_verify_contact_table(void *context, struct eo_case *block, struct eo_error *error)
{
  struct eo_contact_case *contact_case = context;
  struct table table = {.c = contact_case, .speed = table_speed(contact_case)};
  eo_case_remark(block, "tol");
  enum eo_code code = prepare_sector(contact_case, error);
  return code || eo_case_faulty(block)
             ? code
             : eo_verify_each(contact_case->v, eo_case_need(block, "rows"), check_row_of_table, &table, error);
}
