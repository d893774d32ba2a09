/* The static part of a load case: transmission error, stiffness, contact, impact, root stress. */
#include <math.h>
#include <stdlib.h>
#include <stdio.h>

#include "document/result_parts.h"
#include "numerics/periodic.h"

/* ---- transmission error and stiffness ---- */

static double swing(int n, const double *value)
{
  double low = INFINITY, high = -INFINITY;
  for (int i = 0; i < n; i++) {
    low = fmin(low, value[i]);
    high = fmax(high, value[i]);
  }
  return high - low;
}

static double mean(int n, const double *value)
{
  double sum = 0;
  for (int i = 0; i < n; i++)
    sum += value[i];
  return sum / n;
}

/* Mean, then the amplitudes of the mesh harmonics. */
static json_t *encode_orders(int n, const double *value, const struct eo_unit *unit)
{
  int harmonics = (n - 1) / 2;
  double (*amplitude)[2] = malloc(sizeof *amplitude * (size_t)(harmonics + 1)), *order = malloc(sizeof *order * (size_t)(harmonics + 1));
  json_t *column = NULL;
  if (amplitude && order) {
    order[0] = eo_periodic_harmonics(n, value, harmonics, amplitude);
    for (int h = 1; h <= harmonics; h++)
      order[h] = hypot(amplitude[h - 1][0], amplitude[h - 1][1]);
    column = eo_json_reals(harmonics + 1, order, 1, unit, EO_DIGITS_CURVE);
  }
  free(amplitude);
  free(order);
  return column;
}

static void put_end_columns(struct eo_result_object *o, const struct eo_result_source *source, const char *format, const double *const value[2],
                            double scale, const struct eo_unit *unit)
{
  for (int end = 0; end < source->ends; end++) {
    char key[64];
    snprintf(key, sizeof key, format, eo_result_end[end]);
    eo_result_put(o, key, eo_result_end_column(source, end, value[end], scale, unit));
  }
}

/* Where a floating pinion settles: z = (Z_L - Z_R)/(2 sin beta_b). */
static json_t *encode_float(const struct eo_result_source *source, const double *const approach[2])
{
  int n = source->positions;
  double scale = 1 / (2 * sqrt(fmax(0, 1 - source->normal * source->normal)));
  for (int j = 0; j < n; j++)
    source->scratch[j] = approach[0][j] - approach[1][(j + n - source->lag) % n];
  return eo_result_column(n, source->scratch, scale, &eo_unit_um, EO_DIGITS_CURVE);
}

json_t *eo_result_lte(struct eo_result_source *source, const struct eo_case_result *c)
{
  const double *const approach[2] = {c->end[0].loaded.approach, c->end[1].loaded.approach};
  struct eo_result_object o = eo_result_open();
  eo_result_put(&o, "pair_um", eo_result_column(source->positions, c->transmission, 1, &eo_unit_um, EO_DIGITS_CURVE));
  put_end_columns(&o, source, "%s_um", approach, 1 / source->normal, &eo_unit_um);
  eo_result_put_number(&o, "peak_to_peak_um", c->peak_to_peak, &eo_unit_um);
  for (int end = 0; end < source->ends; end++)
    eo_result_put_number(&o, end ? "right_peak_to_peak_um" : "left_peak_to_peak_um", c->end[end].transmission_peak, &eo_unit_um);
  eo_result_put_number(&o, "mean_um", c->mean, &eo_unit_um);
  eo_result_put(&o, "orders_um", encode_orders(source->positions, c->transmission, &eo_unit_um));
  if (source->ends == 2 && source->design->alignment.pinion_axial == EO_AXIAL_FLOATING)
    eo_result_put(&o, "axial_float_um", encode_float(source, approach));
  return eo_result_close(&o);
}

json_t *eo_result_stiffness(struct eo_result_source *source, const struct eo_case_result *c)
{
  const double *const secant[2] = {c->end[0].stiffness, c->end[1].stiffness};
  const double *const tangent[2] = {c->end[0].loaded.tangent, c->end[1].loaded.tangent};
  struct eo_result_object o = eo_result_open(), means = eo_result_open();
  put_end_columns(&o, source, "%s_N_per_um", secant, 1, &eo_unit_N_per_um);
  put_end_columns(&o, source, "tangent_%s_N_per_um", tangent, 1, &eo_unit_N_per_um);
  for (int end = 0; end < source->ends; end++) {
    eo_result_put_number(&means, end ? "right_N_per_um" : "left_N_per_um", mean(source->positions, secant[end]), &eo_unit_N_per_um);
    eo_result_put_number(&means, end ? "tangent_right_N_per_um" : "tangent_left_N_per_um", mean(source->positions, tangent[end]), &eo_unit_N_per_um);
  }
  eo_result_put(&o, "mean", eo_result_close(&means));
  return eo_result_close(&o);
}

/* ---- unloaded contact: the same for every load case ---- */

static json_t *encode_unloaded_end(struct eo_result_source *source, int end)
{
  const struct eo_end_result *r = &source->evaluation->load_case[0].end[end];
  struct eo_contact_pattern *pattern = source->pattern;
  struct eo_result_object o = eo_result_open();
  int marked = 0, points = EO_PATTERN_ROWS * EO_PATTERN_COLUMNS;
  eo_contact_pattern_unload(pattern, eo_evaluator_field(source->analysis->evaluator, end), r->unloaded);
  for (int i = 0; i < points; i++)
    marked += pattern->clearance[i] < source->design->resolution.marking_thickness;
  eo_result_put(&o, "te_um", eo_result_end_column(source, end, r->unloaded, 1 / source->normal, &eo_unit_um));
  eo_result_put_number(&o, "peak_to_peak_um", swing(source->positions, r->unloaded) / source->normal, &eo_unit_um);
  eo_result_put_number(&o, "smallest_gap_um", r->datum, &eo_unit_um);
  eo_result_put(&o, "clearance_um", eo_result_map(source, EO_PATTERN_ROWS, EO_PATTERN_COLUMNS, pattern->clearance, &eo_unit_um));
  eo_result_put_number(&o, "marked_share", (double)marked / points, NULL);
  return eo_result_close(&o);
}

static void put_places(struct eo_result_object *o, const struct eo_result_source *source)
{
  eo_result_put(o, "s_mm", eo_json_reals(EO_PATTERN_ROWS, source->pattern->path, 1, &eo_unit_mm, EO_DIGITS_CURVE));
  eo_result_put(o, "eta_mm", eo_json_reals(EO_PATTERN_COLUMNS, source->pattern->eta, 1, &eo_unit_mm, EO_DIGITS_CURVE));
}

static json_t *encode_unloaded_pair(struct eo_result_source *source, double *peak)
{
  const struct eo_case_result *c = &source->evaluation->load_case[0];
  int n = source->positions, last = source->ends - 1;
  for (int j = 0; j < n; j++)
    source->scratch[j] = (c->end[0].unloaded[j] + c->end[last].unloaded[(j + n - source->lag) % n]) / 2;
  *peak = swing(n, source->scratch) / source->normal;
  return eo_result_column(n, source->scratch, 1 / source->normal, &eo_unit_um, EO_DIGITS_CURVE);
}

json_t *eo_result_unloaded(struct eo_result_source *source)
{
  struct eo_result_object o = eo_result_open();
  double peak;
  eo_result_put(&o, "position", eo_result_position(source));
  eo_result_put(&o, "pair_te_um", encode_unloaded_pair(source, &peak));
  eo_result_put_number(&o, "peak_to_peak_um", peak, &eo_unit_um);
  eo_result_put_number(&o, "marking_thickness_um", source->design->resolution.marking_thickness, &eo_unit_um);
  put_places(&o, source);
  for (int end = 0; end < source->ends; end++)
    eo_result_put(&o, eo_result_end[end], encode_unloaded_end(source, end));
  return eo_result_close(&o);
}

/* ---- loaded contact ---- */

static json_t *encode_share(struct eo_result_source *source, int end, const struct eo_loaded_end *loaded, int first, int pairs)
{
  json_t *rows = json_array();
  double *share = malloc(sizeof *share * (size_t)source->positions);
  bool failed = !rows || !share;
  for (int i = 0; i < pairs && !failed; i++) {
    eo_contact_pair_share(source->pair->grid, loaded, first + i, share);
    failed = json_array_append_new(rows, eo_result_end_column(source, end, share, 1, NULL)) != 0;
  }
  free(share);
  if (!failed)
    return rows;
  json_decref(rows);
  return NULL;
}

static json_t *encode_shares(struct eo_result_source *source, const struct eo_case_result *c)
{
  struct eo_result_object o = eo_result_open();
  int range[2];
  json_t *pairs = json_array();
  eo_contact_grid_pairs(source->pair->grid, range);
  for (int pair = range[0]; pair <= range[1]; pair++)
    o.failed = o.failed || json_array_append_new(pairs, json_integer(pair)) != 0;
  eo_result_put(&o, "tooth_pair", pairs);
  for (int end = 0; end < source->ends; end++)
    eo_result_put(&o, eo_result_end[end], encode_share(source, end, &c->end[end].loaded, range[0], range[1] - range[0] + 1));
  return eo_result_close(&o);
}

static json_t *encode_pattern_end(const struct eo_result_source *source)
{
  const struct eo_contact_pattern *pattern = source->pattern;
  struct eo_result_object o = eo_result_open();
  eo_result_put(&o, "pressure_MPa", eo_result_map(source, EO_PATTERN_ROWS, EO_PATTERN_COLUMNS, pattern->pressure, &eo_unit_MPa));
  eo_result_put(&o, "gear_tip_edge_MPa", eo_json_reals(EO_PATTERN_COLUMNS, pattern->edge[0], 1, &eo_unit_MPa, EO_DIGITS_MAP));
  eo_result_put(&o, "pinion_tip_edge_MPa", eo_json_reals(EO_PATTERN_COLUMNS, pattern->edge[1], 1, &eo_unit_MPa, EO_DIGITS_MAP));
  return eo_result_close(&o);
}

static json_t *encode_pattern(struct eo_result_source *source, int k)
{
  const struct eo_case_result *c = &source->evaluation->load_case[k];
  struct eo_result_object o = eo_result_open();
  put_places(&o, source);
  for (int end = 0; end < source->ends; end++) {
    eo_contact_pattern_load(source->pattern, source->pair->grid, &c->end[end].loaded);
    source->edge_pressure[k][end] = 0;
    for (int edge = 0; edge < 2; edge++)
      for (int j = 0; j < EO_PATTERN_COLUMNS; j++)
        source->edge_pressure[k][end] = fmax(source->edge_pressure[k][end], source->pattern->edge[edge][j]);
    eo_result_put(&o, eo_result_end[end], encode_pattern_end(source));
  }
  return eo_result_close(&o);
}

double eo_result_mean_load(const struct eo_result_source *source, const struct eo_case_result *c, int end)
{
  return mean(source->positions, c->end[end].loaded.load);
}

json_t *eo_result_contact(struct eo_result_source *source, int k)
{
  const struct eo_case_result *c = &source->evaluation->load_case[k];
  struct eo_result_object o = eo_result_open(), pressure = eo_result_open(), line_load = eo_result_open(), edge = eo_result_open(),
                          edge_pressure = eo_result_open(), load = eo_result_open();
  json_t *pattern = encode_pattern(source, k);
  for (int end = 0; end < source->ends; end++) {
    const struct eo_end_result *r = &c->end[end];
    eo_result_put_number(&load, eo_result_end[end], eo_result_mean_load(source, c, end), &eo_unit_N);
    eo_result_put_number(&pressure, eo_result_end[end], r->max_pressure, &eo_unit_MPa);
    eo_result_put_number(&line_load, eo_result_end[end], r->max_line_load, &eo_unit_N_per_mm);
    eo_result_put_number(&edge, eo_result_end[end], r->edge_share, NULL);
    eo_result_put_number(&edge_pressure, eo_result_end[end], source->edge_pressure[k][end], &eo_unit_MPa);
  }
  eo_result_put(&o, "mean_load_N", eo_result_close(&load));
  eo_result_put(&o, "max_pressure_MPa", eo_result_close(&pressure));
  eo_result_put(&o, "max_line_load_N_per_mm", eo_result_close(&line_load));
  eo_result_put(&o, "edge_load_share", eo_result_close(&edge));
  eo_result_put(&o, "edge_pressure_MPa", eo_result_close(&edge_pressure));
  eo_result_put(&o, "load_share", encode_shares(source, c));
  eo_result_put(&o, "pattern", pattern);
  return eo_result_close(&o);
}

/* ---- elastic bodies ---- */

json_t *eo_result_bodies(struct eo_result_source *source, const struct eo_case_result *c)
{
  double eta[EO_DEFLECTION_NODES];
  struct eo_result_object o = eo_result_open();
  for (int i = 0; i < EO_DEFLECTION_NODES; i++)
    eta[i] = source->pair->geometry.face_width * ((double)i / (EO_DEFLECTION_NODES - 1) - 0.5);
  eo_result_put(&o, "eta_mm", eo_json_reals(EO_DEFLECTION_NODES, eta, 1, &eo_unit_mm, EO_DIGITS_CURVE));
  for (int end = 0; end < source->ends; end++)
    eo_result_put(&o, end ? "right_um" : "left_um", eo_json_reals(EO_DEFLECTION_NODES, c->end[end].deflection.part[0], 1, &eo_unit_um, EO_DIGITS_CURVE));
  eo_result_put(&o, "most_iterations", json_integer(c->body_iterations));
  return eo_result_close(&o);
}

/* ---- impact ---- */

static json_t *encode_impact_end(const struct eo_result_source *source, const struct eo_impact *impact)
{
  struct eo_result_object o = eo_result_open();
  double known = impact->touched ? 1 : NAN, struck = impact->touched && impact->force > 0 ? 1 : NAN;
  eo_result_put_number(&o, "force_N", impact->classical, &eo_unit_N);
  eo_result_put_number(&o, "general_force_N", impact->force, &eo_unit_N);
  eo_result_put_number(&o, "speed_mm_per_s", impact->speed, &eo_unit_mm_per_s);
  eo_result_put_number(&o, "duration_ms", struck * impact->duration, &eo_unit_ms);
  eo_result_put(&o, "off_line", json_boolean(impact->touched && impact->off_line));
  eo_result_put_number(&o, "position", known * impact->start, NULL);
  eo_result_put_number(&o, "eta_mm", known * impact->eta, &eo_unit_mm);
  eo_result_put_number(&o, "s_mm", known * impact->path, &eo_unit_mm);
  eo_result_put_number(&o, "lead_before_A_mm", known * fmax(0, source->pair->geometry.path_start - impact->path), &eo_unit_mm);
  eo_result_put_number(&o, "pinion_radius_mm", known * impact->pinion_radius, &eo_unit_mm);
  return eo_result_close(&o);
}

json_t *eo_result_impact(struct eo_result_source *source, const struct eo_case_result *c)
{
  struct eo_result_object o = eo_result_open();
  for (int end = 0; end < source->ends; end++)
    eo_result_put(&o, eo_result_end[end], encode_impact_end(source, &c->end[end].impact));
  return eo_result_close(&o);
}

/* ---- root stress ---- */

static json_t *encode_root_history(const struct eo_result_source *source, const struct eo_root_history *history)
{
  return source->left_out & EO_RESULT_NO_HISTORIES ? json_null()
                                                   : eo_json_reals(history->phases, history->stress, 1, &eo_unit_MPa, EO_DIGITS_CURVE);
}

static json_t *encode_root_end(const struct eo_result_source *source, const struct eo_root_history *history, double factor)
{
  struct eo_result_object o = eo_result_open();
  eo_result_put_number(&o, "max_MPa", history->maximum, &eo_unit_MPa);
  eo_result_put_number(&o, "max_dynamic_MPa", history->maximum * factor, &eo_unit_MPa);
  eo_result_put_number(&o, "arc_mm", history->arc, &eo_unit_mm);
  eo_result_put_number(&o, "eta_mm", history->eta, &eo_unit_mm);
  eo_result_put(&o, "history_MPa", encode_root_history(source, history));
  return eo_result_close(&o);
}

static double force_factor(const struct eo_case_result *c, int end)
{
  return c->vibration.outcome == EO_VIBRATION_NOT_CONVERGED ? NAN : fmax(1, c->vibration.dynamic_factor[end]);
}

static json_t *encode_root_member(const struct eo_result_source *source, const struct eo_case_result *c, int member)
{
  const struct eo_root_history *history[2] = {&c->end[0].root[member], &c->end[1].root[member]};
  int worst = source->ends == 2 && history[1]->maximum > history[0]->maximum ? EO_RIGHT : EO_LEFT;
  double dynamic = 0;
  struct eo_result_object o = eo_result_open();
  for (int end = 0; end < source->ends; end++)
    dynamic = isnan(force_factor(c, end)) ? NAN : fmax(dynamic, history[end]->maximum * force_factor(c, end));
  eo_result_put_number(&o, "max_MPa", history[worst]->maximum, &eo_unit_MPa);
  eo_result_put_number(&o, "max_dynamic_MPa", dynamic, &eo_unit_MPa);
  eo_result_put(&o, "position", eo_json_reals(history[0]->phases, history[0]->phase, 1, NULL, EO_DIGITS_CURVE));
  eo_result_put(&o, "history_MPa", encode_root_history(source, history[worst]));
  for (int end = 0; end < source->ends; end++)
    eo_result_put(&o, eo_result_end[end], encode_root_end(source, history[end], force_factor(c, end)));
  return eo_result_close(&o);
}

json_t *eo_result_root_stress(struct eo_result_source *source, const struct eo_case_result *c)
{
  if (!source->analysis->root)
    return json_null();
  struct eo_result_object o = eo_result_open();
  for (int member = 0; member < 2; member++)
    eo_result_put(&o, eo_result_member[member], encode_root_member(source, c, member));
  return eo_result_close(&o);
}
