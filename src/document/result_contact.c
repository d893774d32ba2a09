/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The static part of a load case: transmission error, stiffness, contact, impact, root stress. */
#include <math.h>
#include <stdlib.h>
#include <stdio.h>

#include "document/result_private.h"
#include "numerics/periodic.h"

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
static json_t *encode_orders(const struct eo_result_source *source, const double *value, const struct eo_unit *unit)
{
  int n = source->positions, harmonics = (n - 1) / 2;
  double(*amplitude)[2] = malloc(sizeof *amplitude * (size_t)(harmonics + 1)),
  *order = malloc(sizeof *order * (size_t)(harmonics + 1));
  json_t *column = NULL;
  if (amplitude && order) {
    order[0] = eo_periodic_harmonics(n, value, harmonics, amplitude);
    for (int h = 1; h <= harmonics; h++)
      order[h] = hypot(amplitude[h - 1][0], amplitude[h - 1][1]);
    column = eo_json_reals(harmonics + 1, order, 1, unit, source->digits);
  }
  free(amplitude);
  free(order);
  return column;
}

static void put_end_columns(struct eo_object *object, const struct eo_result_source *source, const char *format,
                            const double *const value[2], double scale, const struct eo_unit *unit, bool wanted)
{
  for (int end = 0; end < source->ends; end++) {
    char key[64];
    snprintf(key, sizeof key, format, eo_result_end[end]);
    eo_object_put(object, key, wanted ? eo_result_end_column(source, end, value[end], scale, unit) : json_null());
  }
}

/* Where a floating pinion settles, + to the right: z = (Z_L - Z_R)/(2 sin beta_b), with the other sign where the face
   ends at the groove meet first. */
static json_t *encode_float(const struct eo_result_source *source, const double *const approach[2], bool inwards)
{
  int n = source->positions;
  double scale = (inwards ? -1 : 1) / (2 * sqrt(fmax(0, 1 - source->normal * source->normal)));
  for (int j = 0; j < n; j++)
    source->scratch[j] = approach[0][j] - approach[1][(j + n - source->lag) % n];
  return eo_json_column(n, source->scratch, scale, &eo_unit_um, source->digits);
}

static const struct eo_outline_row lte_rows[] = {
    EO_KEY("pair_um", "[number?]?", "mean of the ends, over the positions", .unit = &eo_unit_um),
    EO_KEY("left_um", "[number?]?", "left end, over the positions", .unit = &eo_unit_um),
    EO_KEY("right_um", "[number?]?", "right end, over the positions", .unit = &eo_unit_um, .when = EO_TWO_ENDS),
    EO_KEY("peak_to_peak_um", "number?", "of the pair", .unit = &eo_unit_um),
    EO_KEY("left_peak_to_peak_um", "number?", "of the left end", .unit = &eo_unit_um),
    EO_KEY("right_peak_to_peak_um", "number?", "of the right end", .unit = &eo_unit_um, .when = EO_TWO_ENDS),
    EO_KEY("mean_um", "number?", "of the pair over the mesh cycle", .unit = &eo_unit_um),
    EO_KEY("hub_windup_um", "number?",
           "what hubs that take their torque through a bore add to the mean, not in it; null unless hub_windup is on",
           .unit = &eo_unit_um),
    EO_KEY("orders_um", "[number?]?", "the mean, then the amplitudes of the mesh harmonics 1, 2, ... of the pair",
           .unit = &eo_unit_um),
    EO_KEY(
        "second_derivative_m_per_s2", "[number?]?",
        "of the pair's error by time at the speed of the load case, from the mesh harmonics up to te_harmonics, over "
        "the positions",
        .unit = &eo_unit_m_per_s2),
    EO_KEY("second_derivative_rms_m_per_s2", "number?", "RMS of it", .unit = &eo_unit_m_per_s2),
    EO_KEY("axial_float_um", "[number?]?", "where the pinion settles along its axis, over the positions",
           .unit = &eo_unit_um, .when = "with two ends and a pinion that can move"),
};
const struct eo_outline eo_outline_lte = EO_OUTLINE("TransmissionError", lte_rows);

/* The second derivative by time of the transmission error, whose mesh harmonics are known: -(2 pi f_mesh h)^2 times
   each (finer ones are noise of the positions). Its RMS comes from the same amplitudes. */
static void put_second_derivative(struct eo_object *object, const struct eo_result_source *source,
                                  const struct eo_case_result *case_result)
{
  enum { MOST = 128 };
  double amplitude[MOST][2], squares = 0;
  int n = source->positions, most = (n - 1) / 2, harmonics = source->design->resolution.te_harmonics;
  harmonics = harmonics < most ? harmonics : most;
  double mesh = case_result->load_case.speed * source->pair->geometry.teeth[EO_PINION]; /* rad/s */
  eo_periodic_harmonics(n, case_result->transmission, harmonics, amplitude);
  for (int j = 0; j < n; j++)
    source->scratch[j] = 0;
  for (int h = 1; h <= harmonics; h++) {
    double factor = -pow(h * mesh, 2), re = factor * amplitude[h - 1][0], im = factor * amplitude[h - 1][1];
    squares += (re * re + im * im) / 2;
    for (int j = 0; j < n; j++)
      source->scratch[j] += re * cos(2 * M_PI * h * j / n) - im * sin(2 * M_PI * h * j / n);
  }
  eo_object_put(object, "second_derivative_m_per_s2",
                eo_result_has(source, EO_RESULT_NO_LTE, case_result)
                    ? eo_json_column(n, source->scratch, 1, &eo_unit_m_per_s2, source->digits)
                    : json_null());
  eo_object_put_number(object, "second_derivative_rms_m_per_s2", sqrt(squares));
}

json_t *eo_result_lte(struct eo_result_source *source, const struct eo_case_result *case_result)
{
  const double *const approach[2] = {case_result->end[0].loaded.approach, case_result->end[1].loaded.approach};
  struct eo_object object = eo_object_open_as(&eo_outline_lte);
  bool curves = eo_result_has_overview(source, EO_RESULT_NO_LTE, case_result);
  eo_object_put(&object, "pair_um",
                curves ? eo_json_column(source->positions, case_result->transmission, 1, &eo_unit_um, source->digits)
                       : json_null());
  put_end_columns(&object, source, "%s_um", approach, 1 / source->normal, &eo_unit_um, curves);
  eo_object_put_number(&object, "peak_to_peak_um", case_result->peak_to_peak);
  for (int end = 0; end < source->ends; end++)
    eo_object_put_number(&object, end ? "right_peak_to_peak_um" : "left_peak_to_peak_um",
                         case_result->end[end].transmission_peak);
  eo_object_put_number(&object, "mean_um", case_result->mean);
  eo_object_put_number(&object, "hub_windup_um",
                       (eo_result_hub_windup(source, EO_PINION) + eo_result_hub_windup(source, EO_GEAR)) *
                           case_result->force / source->pair->geometry.face_width / source->normal);
  eo_object_put(&object, "orders_um",
                curves ? encode_orders(source, case_result->transmission, &eo_unit_um) : json_null());
  put_second_derivative(&object, source, case_result);
  if (source->ends == 2 && source->design->alignment.pinion_axial != EO_AXIAL_FIXED)
    eo_object_put(&object, "axial_float_um",
                  eo_result_has(source, EO_RESULT_NO_LTE, case_result)
                      ? encode_float(source, approach, case_result->running.inwards)
                      : json_null());
  return eo_object_close(&object);
}

static const struct eo_outline_row stiffness_mean_rows[] = {
    EO_KEY("left_N_per_um", "number?", "left end", .unit = &eo_unit_N_per_um),
    EO_KEY("tangent_left_N_per_um", "number?", "left end, tangent", .unit = &eo_unit_N_per_um),
    EO_KEY("mesh_left_N_per_mm_um", "number?",
           "left end, transverse per face width: left_N_per_um cos^2(beta_b)/b; beside iso_c_gamma_N_per_mm_um, which "
           "means an aligned, unmodified pair",
           .unit = &eo_unit_N_per_mm_um),
    EO_KEY("right_N_per_um", "number?", "right end", .unit = &eo_unit_N_per_um, .when = EO_TWO_ENDS),
    EO_KEY("tangent_right_N_per_um", "number?", "right end, tangent", .unit = &eo_unit_N_per_um, .when = EO_TWO_ENDS),
    EO_KEY("mesh_right_N_per_mm_um", "number?", "right end, transverse per face width", .unit = &eo_unit_N_per_mm_um,
           .when = EO_TWO_ENDS),
};
static const struct eo_outline stiffness_mean = EO_OUTLINE("MeanMeshStiffness", stiffness_mean_rows);

static const struct eo_outline_row stiffness_rows[] = {
    EO_KEY("left_N_per_um", "[number?]?", "load over approach from first contact, normal, left end, over the positions",
           .unit = &eo_unit_N_per_um),
    EO_KEY("right_N_per_um", "[number?]?", "the same, right end", .unit = &eo_unit_N_per_um, .when = EO_TWO_ENDS),
    EO_KEY("tangent_left_N_per_um", "[number?]?",
           "change of load over change of approach, normal, left end, over the positions", .unit = &eo_unit_N_per_um),
    EO_KEY("tangent_right_N_per_um", "[number?]?", "the same, right end", .unit = &eo_unit_N_per_um,
           .when = EO_TWO_ENDS),
    EO_KEY("left_orders_N_per_um", "[number?]?",
           "mean of left_N_per_um, then the amplitudes of its mesh harmonics 1, 2, ...", .unit = &eo_unit_N_per_um),
    EO_KEY("right_orders_N_per_um", "[number?]?", "the same, right end", .unit = &eo_unit_N_per_um,
           .when = EO_TWO_ENDS),
    EO_KEY("mean", "object", "means over the mesh cycle", .outline = &stiffness_mean),
};
const struct eo_outline eo_outline_stiffness = EO_OUTLINE("MeshStiffness", stiffness_rows);

json_t *eo_result_stiffness(struct eo_result_source *source, const struct eo_case_result *case_result)
{
  const double *const secant[2] = {case_result->end[0].stiffness, case_result->end[1].stiffness};
  const double *const tangent[2] = {case_result->end[0].loaded.tangent, case_result->end[1].loaded.tangent};
  struct eo_object object = eo_object_open_as(&eo_outline_stiffness), means = eo_object_open_as(&stiffness_mean);
  bool curves = eo_result_has(source, EO_RESULT_NO_STIFFNESS, case_result);
  put_end_columns(&object, source, "%s_N_per_um", secant, 1, &eo_unit_N_per_um, curves);
  put_end_columns(&object, source, "tangent_%s_N_per_um", tangent, 1, &eo_unit_N_per_um, curves);
  for (int end = 0; end < source->ends; end++)
    eo_object_put(&object, end ? "right_orders_N_per_um" : "left_orders_N_per_um",
                  curves ? encode_orders(source, secant[end], &eo_unit_N_per_um) : json_null());
  for (int end = 0; end < source->ends; end++) {
    eo_object_put_number(&means, end ? "right_N_per_um" : "left_N_per_um", mean(source->positions, secant[end]));
    eo_object_put_number(&means, end ? "tangent_right_N_per_um" : "tangent_left_N_per_um",
                         mean(source->positions, tangent[end]));
    eo_object_put_number(&means, end ? "mesh_right_N_per_mm_um" : "mesh_left_N_per_mm_um",
                         mean(source->positions, secant[end]) * source->normal * source->normal /
                             eo_pair_half(source->pair, end)->geometry.face_width);
  }
  eo_object_put(&object, "mean", eo_object_close(&means));
  return eo_object_close(&object);
}

static const struct eo_outline_row unloaded_end_rows[] = {
    EO_KEY("te_um", "[number?]?", "unloaded transmission error, over the positions", .unit = &eo_unit_um),
    EO_KEY("peak_to_peak_um", "number?", "of the end", .unit = &eo_unit_um),
    EO_KEY("smallest_gap_um", "number?", "smallest gap anywhere on the flank", .unit = &eo_unit_um),
    EO_KEY("clearance_um", "[[number?]]?",
           "gap that the mesh cycle leaves, a row for every s_mm, a number for every eta_mm; null without maps",
           .unit = &eo_unit_um),
    EO_KEY("marked_share", "number?", "share of the flank closer than the marking thickness"),
};
static const struct eo_outline unloaded_end = EO_OUTLINE("UnloadedContactEnd", unloaded_end_rows);

static json_t *encode_unloaded_end(struct eo_result_source *source, int end)
{
  const struct eo_end_result *end_result = &source->evaluation->load_case[0].end[end];
  struct eo_contact_pattern *pattern = eo_result_pattern(source, end);
  struct eo_object object = eo_object_open_as(&unloaded_end);
  int marked = 0, points = EO_PATTERN_ROWS * EO_PATTERN_COLUMNS;
  eo_contact_pattern_unload(pattern, eo_evaluator_field(source->analysis->evaluator, 0, end), end_result->unloaded);
  for (int i = 0; i < points; i++)
    marked += pattern->clearance[i] < source->design->resolution.marking_thickness;
  bool curves = eo_result_has(source, EO_RESULT_NO_UNLOADED, NULL);
  eo_object_put(&object, "te_um",
                curves ? eo_result_end_column(source, end, end_result->unloaded, 1 / source->normal, &eo_unit_um)
                       : json_null());
  eo_object_put_number(&object, "peak_to_peak_um", swing(source->positions, end_result->unloaded) / source->normal);
  eo_object_put_number(&object, "smallest_gap_um", end_result->datum);
  eo_object_put(&object, "clearance_um",
                curves ? eo_result_map(source, EO_PATTERN_ROWS, EO_PATTERN_COLUMNS, pattern->clearance, &eo_unit_um)
                       : json_null());
  eo_object_put_number(&object, "marked_share", (double)marked / points);
  return eo_object_close(&object);
}

static const struct eo_outline_row place_rows[] = {
    EO_KEY("s_mm", "[number]?",
           "roll along the line of action from the pitch point, + towards the pinion's tip: rows of the maps",
           .unit = &eo_unit_mm),
    EO_KEY("eta_mm", "[number]?",
           "place along the face from its middle, + on the side that meets first: columns of the maps",
           .unit = &eo_unit_mm),
    EO_KEY("right_eta_mm", "[number]?", "the same of the right end", .unit = &eo_unit_mm, .when = EO_UNEVEN),
};
static const struct eo_outline places = EO_OUTLINE("Places", place_rows);

static void put_places(struct eo_object *object, const struct eo_result_source *source, bool wanted)
{
  const struct eo_contact_pattern *pattern = eo_result_pattern(source, EO_LEFT);
  eo_object_put(object, "s_mm",
                wanted ? eo_json_reals(EO_PATTERN_ROWS, pattern->path, 1, &eo_unit_mm, EO_DIGITS_CURVE) : json_null());
  eo_object_put(object, "eta_mm",
                wanted ? eo_json_reals(EO_PATTERN_COLUMNS, pattern->eta, 1, &eo_unit_mm, EO_DIGITS_CURVE)
                       : json_null());
  eo_result_put_right_face(object, "right_eta_mm", source, EO_PATTERN_COLUMNS, pattern->eta, wanted);
}

static json_t *encode_unloaded_pair(struct eo_result_source *source, double *peak)
{
  const struct eo_case_result *case_result = &source->evaluation->load_case[0];
  int n = source->positions, last = source->ends - 1;
  for (int j = 0; j < n; j++)
    source->scratch[j] =
        (case_result->end[0].unloaded[j] + case_result->end[last].unloaded[(j + n - source->lag) % n]) / 2;
  *peak = swing(n, source->scratch) / source->normal;
  return eo_json_column(n, source->scratch, 1 / source->normal, &eo_unit_um, source->digits);
}

static const struct eo_outline_row unloaded_rows[] = {
    EO_KEY("position", "[number]?", "phase of the mesh cycle, 0..1"),
    EO_KEY("pair_te_um", "[number?]?", "unloaded transmission error of the pair, over the positions",
           .unit = &eo_unit_um),
    EO_KEY("peak_to_peak_um", "number?", "of the pair", .unit = &eo_unit_um),
    EO_KEY("marking_thickness_um", "number", "of the marking compound, as the design states it", .unit = &eo_unit_um),
    {.outline = &places},
    EO_KEY("left", "object", "left end", .outline = &unloaded_end),
    EO_KEY("right", "object", "right end", .when = EO_TWO_ENDS, .outline = &unloaded_end),
};
const struct eo_outline eo_outline_unloaded = EO_OUTLINE("UnloadedContact", unloaded_rows);

json_t *eo_result_unloaded(struct eo_result_source *source)
{
  struct eo_object object = eo_object_open_as(&eo_outline_unloaded);
  double peak;
  bool curves = eo_result_has(source, EO_RESULT_NO_UNLOADED, NULL);
  json_t *of_pair = encode_unloaded_pair(source, &peak);
  eo_object_put(&object, "position", curves ? eo_result_position(source) : json_null());
  eo_object_put(&object, "pair_te_um", curves ? json_incref(of_pair) : json_null());
  json_decref(of_pair);
  eo_object_put_number(&object, "peak_to_peak_um", peak);
  eo_object_put_number(&object, "marking_thickness_um", source->design->resolution.marking_thickness);
  put_places(&object, source, curves);
  for (int end = 0; end < source->ends; end++)
    eo_object_put(&object, eo_result_end[end], encode_unloaded_end(source, end));
  return eo_object_close(&object);
}

static json_t *encode_share(struct eo_result_source *source, int end, const struct eo_loaded_end *loaded, int first,
                            int pairs)
{
  json_t *rows = json_array();
  double *share = malloc(sizeof *share * (size_t)source->positions);
  bool failed = !rows || !share;
  for (int i = 0; i < pairs && !failed; i++) {
    eo_contact_pair_share(eo_pair_half(source->pair, end)->grid, loaded, first + i, share);
    failed = json_array_append_new(rows, eo_result_end_column(source, end, share, 1, NULL)) != 0;
  }
  free(share);
  if (!failed)
    return rows;
  json_decref(rows);
  return NULL;
}

static const struct eo_outline_row share_rows[] = {
    EO_KEY("tooth_pair", "[integer]", "numbers of the tooth pairs that can touch: rows of the shares"),
    EO_KEY("left", "[[number?]]", "share of the end's load, a row for every tooth pair, over the positions"),
    EO_KEY("right", "[[number?]]", "the same, right end", .when = EO_TWO_ENDS),
};
static const struct eo_outline shares = EO_OUTLINE("LoadShare", share_rows);

static json_t *encode_shares(struct eo_result_source *source, const struct eo_case_result *case_result)
{
  struct eo_object object = eo_object_open_as(&shares);
  int range[2], right[2];
  json_t *pairs = json_array();
  eo_contact_grid_pairs(source->pair->grid, range);
  eo_contact_grid_pairs(eo_pair_half(source->pair, EO_RIGHT)->grid, right);
  range[0] = right[0] < range[0] ? right[0] : range[0];
  range[1] = right[1] > range[1] ? right[1] : range[1];
  for (int pair = range[0]; pair <= range[1]; pair++)
    object.failed = object.failed || json_array_append_new(pairs, json_integer(pair)) != 0;
  eo_object_put(&object, "tooth_pair", pairs);
  for (int end = 0; end < source->ends; end++)
    eo_object_put(&object, eo_result_end[end],
                  encode_share(source, end, &case_result->end[end].loaded, range[0], range[1] - range[0] + 1));
  return eo_object_close(&object);
}

static const struct eo_outline_row pattern_end_rows[] = {
    EO_KEY("pressure_MPa", "[[number?]]?",
           "largest contact pressure of the mesh cycle, a row for every s_mm, a number for every eta_mm; null without "
           "maps",
           .unit = &eo_unit_MPa),
    EO_KEY("gear_tip_edge_MPa", "[number?]?", "the same at the gear's tip edge, over eta_mm (nominal)",
           .unit = &eo_unit_MPa),
    EO_KEY("pinion_tip_edge_MPa", "[number?]?", "the same at the pinion's tip edge, over eta_mm (nominal)",
           .unit = &eo_unit_MPa),
};
static const struct eo_outline pattern_end = EO_OUTLINE("ContactPatternEnd", pattern_end_rows);

static json_t *encode_pattern_end(const struct eo_result_source *source, int end, bool wanted)
{
  const struct eo_contact_pattern *pattern = eo_result_pattern(source, end);
  struct eo_object object = eo_object_open_as(&pattern_end);
  eo_object_put(&object, "pressure_MPa",
                wanted ? eo_result_map(source, EO_PATTERN_ROWS, EO_PATTERN_COLUMNS, pattern->pressure, &eo_unit_MPa)
                       : json_null());
  for (int edge = 0; edge < 2; edge++)
    eo_object_put(&object, edge ? "pinion_tip_edge_MPa" : "gear_tip_edge_MPa",
                  wanted ? eo_json_reals(EO_PATTERN_COLUMNS, pattern->edge[edge], 1, &eo_unit_MPa, EO_DIGITS_MAP)
                         : json_null());
  return eo_object_close(&object);
}

static const struct eo_outline_row pattern_rows[] = {
    {.outline = &places},
    EO_KEY("left", "object", "left end", .outline = &pattern_end),
    EO_KEY("right", "object", "right end", .when = EO_TWO_ENDS, .outline = &pattern_end),
};
static const struct eo_outline contact_pattern = EO_OUTLINE("ContactPattern", pattern_rows);

static json_t *encode_pattern(struct eo_result_source *source, int k)
{
  const struct eo_case_result *case_result = &source->evaluation->load_case[k];
  bool wanted = eo_result_has(source, EO_RESULT_NO_PATTERN, case_result);
  struct eo_object object = eo_object_open_as(&contact_pattern);
  put_places(&object, source, wanted);
  for (int end = 0; end < source->ends; end++) {
    struct eo_contact_pattern *pattern = eo_result_pattern(source, end);
    eo_contact_pattern_load(pattern, eo_pair_half(source->pair, end)->grid, &case_result->end[end].loaded);
    source->edge_pressure[k][end] = 0;
    for (int edge = 0; edge < 2; edge++)
      for (int j = 0; j < EO_PATTERN_COLUMNS; j++)
        source->edge_pressure[k][end] = fmax(source->edge_pressure[k][end], pattern->edge[edge][j]);
    eo_object_put(&object, eo_result_end[end], encode_pattern_end(source, end, wanted));
  }
  return eo_object_close(&object);
}

double eo_result_mean_load(const struct eo_result_source *source, const struct eo_case_result *case_result, int end)
{
  return mean(source->positions, case_result->end[end].loaded.load);
}

/* One number per end. */
struct of_ends {
  double end[2];
  bool two;
};

static bool has_right(const void *source)
{
  return ((const struct of_ends *)source)->two;
}

#define EACH_END(variable, name, unit_)                                                          \
  static const struct eo_outline_row variable##_rows[] = {                                       \
      EO_KEY("left", "number?", "left end", .unit = unit_, EO_AT(struct of_ends, end[EO_LEFT])), \
      EO_KEY("right", "number?", "right end", .unit = unit_, .when = EO_TWO_ENDS,                \
             EO_AT(struct of_ends, end[EO_RIGHT]), .there = has_right)};                         \
  static const struct eo_outline variable = EO_OUTLINE(name, variable##_rows)
EACH_END(force_ends, "ForceOfEnds", &eo_unit_N);
EACH_END(pressure_ends, "PressureOfEnds", &eo_unit_MPa);
EACH_END(line_load_ends, "LineLoadOfEnds", &eo_unit_N_per_mm);
EACH_END(share_ends, "ShareOfEnds", NULL);

/* What a load case says about its contact. */
struct contact {
  struct eo_result_source *source;
  const struct eo_case_result *load_case;
  struct of_ends load, pressure, line_load, edge_share, edge_pressure;
  json_t *pattern; /* owned */
};

static json_t *write_shares(const void *source)
{
  const struct contact *contact = source;
  return eo_result_has(contact->source, EO_RESULT_NO_SHARES, contact->load_case)
             ? encode_shares(contact->source, contact->load_case)
             : json_null();
}

static json_t *write_pattern(const void *source)
{
  return json_incref(((const struct contact *)source)->pattern);
}

static json_t *write_face_load(const void *source)
{
  const struct contact *contact = source;
  return eo_result_face_load(contact->source, contact->load_case);
}

static const struct eo_outline_row contact_rows[] = {
    EO_KEY("mean_load_N", "object", "normal force that an end carries, mean over the mesh cycle",
           .outline = &force_ends, EO_AT(struct contact, load)),
    EO_KEY("max_pressure_MPa", "object", "largest contact pressure of the mesh cycle, tip edges included",
           .outline = &pressure_ends, EO_AT(struct contact, pressure)),
    EO_KEY("max_line_load_N_per_mm", "object", "largest load per length of contact line", .outline = &line_load_ends,
           EO_AT(struct contact, line_load)),
    EO_KEY("edge_load_share", "object", "largest share of the load on tip edges", .outline = &share_ends,
           EO_AT(struct contact, edge_share)),
    EO_KEY("edge_pressure_MPa", "object", "largest pressure of the tip edges (nominal)", .outline = &pressure_ends,
           EO_AT(struct contact, edge_pressure)),
    EO_KEY("face_load", "object", "load over the face, load distribution factors", .outline = &eo_outline_face_load,
           .write = write_face_load),
    EO_KEY("load_share", "object?", "shares of the tooth pairs; null when left out", .outline = &shares,
           .write = write_shares),
    EO_KEY("pattern", "object", "contact pattern", .outline = &contact_pattern, .write = write_pattern),
};
const struct eo_outline eo_outline_contact = EO_OUTLINE("LoadedContact", contact_rows);

json_t *eo_result_contact(struct eo_result_source *source, int k)
{
  const struct eo_case_result *case_result = &source->evaluation->load_case[k];
  struct contact contact = {.source = source, .load_case = case_result, .pattern = encode_pattern(source, k)};
  struct of_ends *const ends[] = {&contact.load, &contact.pressure, &contact.line_load, &contact.edge_share,
                                  &contact.edge_pressure};
  for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++)
    ends[i]->two = source->ends == 2;
  for (int end = 0; end < source->ends; end++) {
    contact.load.end[end] = eo_result_mean_load(source, case_result, end);
    contact.pressure.end[end] = case_result->end[end].max_pressure;
    contact.line_load.end[end] = case_result->end[end].max_line_load;
    contact.edge_share.end[end] = case_result->end[end].edge_share;
    contact.edge_pressure.end[end] = source->edge_pressure[k][end];
  }
  json_t *document = eo_outline_encode(&eo_outline_contact, &contact);
  json_decref(contact.pattern);
  return document;
}

static const struct eo_outline_row body_rows[] = {
    EO_KEY("eta_mm", "[number]", "place along the face from its middle, + on the side that meets first",
           .unit = &eo_unit_mm),
    EO_KEY("right_eta_mm", "[number]", "the same of the right end", .unit = &eo_unit_mm, .when = EO_UNEVEN),
    EO_KEY("left_um", "[number?]", "normal gap that the bodies open, mean over the mesh cycle, over eta_mm, left end",
           .unit = &eo_unit_um),
    EO_KEY("right_um", "[number?]", "the same, right end", .unit = &eo_unit_um, .when = EO_TWO_ENDS),
    EO_KEY("most_iterations", "integer", "between contact and bodies, at the worst position"),
};
const struct eo_outline eo_outline_bodies = EO_OUTLINE("BodyDeflection", body_rows);

json_t *eo_result_bodies(struct eo_result_source *source, const struct eo_case_result *case_result)
{
  double eta[EO_DEFLECTION_NODES];
  struct eo_object object = eo_object_open_as(&eo_outline_bodies);
  for (int i = 0; i < EO_DEFLECTION_NODES; i++)
    eta[i] = source->pair->geometry.face_width * ((double)i / (EO_DEFLECTION_NODES - 1) - 0.5);
  eo_object_put(&object, "eta_mm", eo_json_reals(EO_DEFLECTION_NODES, eta, 1, &eo_unit_mm, source->digits));
  eo_result_put_right_face(&object, "right_eta_mm", source, EO_DEFLECTION_NODES, eta, true);
  for (int end = 0; end < source->ends; end++)
    eo_object_put(
        &object, end ? "right_um" : "left_um",
        eo_json_reals(EO_DEFLECTION_NODES, case_result->end[end].deflection.part[0], 1, &eo_unit_um, source->digits));
  eo_object_put(&object, "most_iterations", json_integer(case_result->body_iterations));
  return eo_object_close(&object);
}

struct impact_end {
  struct eo_impact impact;
  double lead; /* m before the path of contact */
};

static bool has_touched(const void *source)
{
  return ((const struct impact_end *)source)->impact.touched;
}

static bool has_struck(const void *source)
{
  return has_touched(source) && ((const struct impact_end *)source)->impact.force > 0;
}

#define OF_IMPACT(member) EO_AT(struct impact_end, impact.member)
static const struct eo_outline_row impact_end_rows[] = {
    EO_KEY("force_N", "number?", "of the classical impact: 0 when first touch happens on the line of action",
           .unit = &eo_unit_N, OF_IMPACT(classical)),
    EO_KEY("general_force_N", "number?", "of the general impact, wherever first touch happens", .unit = &eo_unit_N,
           OF_IMPACT(force)),
    EO_KEY("speed_mm_per_s", "number?", "of approach along the normal", .unit = &eo_unit_mm_per_s, OF_IMPACT(speed)),
    EO_KEY("duration_ms", "number?", "of the half sine; null without a force", .unit = &eo_unit_ms, OF_IMPACT(duration),
           .known = has_struck),
    EO_KEY("off_line", "flag", "first touch happens before the line of action", OF_IMPACT(off_line)),
    EO_KEY("position", "number?", "phase of first touch (EMIP); null, as all below, when nothing touches",
           OF_IMPACT(start), .known = has_touched),
    EO_KEY("eta_mm", "number?", "its place along the face", .unit = &eo_unit_mm, OF_IMPACT(eta), .known = has_touched),
    EO_KEY("s_mm", "number?", "its roll from the pitch point", .unit = &eo_unit_mm, OF_IMPACT(path),
           .known = has_touched),
    EO_KEY("lead_before_A_mm", "number?", "how far before the path of contact", .unit = &eo_unit_mm,
           EO_AT(struct impact_end, lead), .known = has_touched),
    EO_KEY("pinion_radius_mm", "number?", "where the gear's tip meets the pinion's flank", .unit = &eo_unit_mm,
           OF_IMPACT(pinion_radius), .known = has_touched),
};
static const struct eo_outline impact_end = EO_OUTLINE("ImpactEnd", impact_end_rows);

static json_t *encode_impact_end(const struct eo_result_source *source, const struct eo_impact *impact)
{
  struct impact_end end = {*impact, fmax(0, source->pair->geometry.path_start - impact->path)};
  end.impact.off_line = impact->touched && impact->off_line;
  return eo_outline_encode(&impact_end, &end);
}

static const struct eo_outline_row impact_rows[] = {
    EO_KEY("left", "object", "left end", .outline = &impact_end),
    EO_KEY("right", "object", "right end", .when = EO_TWO_ENDS, .outline = &impact_end),
};
const struct eo_outline eo_outline_impact = EO_OUTLINE("Impact", impact_rows);

json_t *eo_result_impact(struct eo_result_source *source, const struct eo_case_result *case_result)
{
  struct eo_object object = eo_object_open_as(&eo_outline_impact);
  for (int end = 0; end < source->ends; end++)
    eo_object_put(&object, eo_result_end[end], encode_impact_end(source, &case_result->end[end].impact));
  return eo_object_close(&object);
}

static json_t *encode_root_history(const struct eo_root_history *history, bool wanted)
{
  return wanted ? eo_json_reals(history->phases, history->stress, 1, &eo_unit_MPa, EO_DIGITS_CURVE) : json_null();
}

struct root_end {
  const struct eo_root_history *history;
  bool wanted;                       /* the history itself */
  double maximum, dynamic, arc, eta; /* Pa, m */
};

static json_t *write_root_history(const void *source)
{
  const struct root_end *end = source;
  return encode_root_history(end->history, end->wanted);
}

static const struct eo_outline_row root_end_rows[] = {
    EO_KEY("max_MPa", "number?", "largest static root stress of the end", .unit = &eo_unit_MPa,
           EO_AT(struct root_end, maximum)),
    EO_KEY("max_dynamic_MPa", "number?", "times the dynamic factor; null without a periodic vibration",
           .unit = &eo_unit_MPa, EO_AT(struct root_end, dynamic)),
    EO_KEY("arc_mm", "number?", "its place along the fillet", .unit = &eo_unit_mm, EO_AT(struct root_end, arc)),
    EO_KEY("eta_mm", "number?", "its place along the face", .unit = &eo_unit_mm, EO_AT(struct root_end, eta)),
    EO_KEY("history_MPa", "[number?]?",
           "largest stress of one tooth over `position` of the member; null without histories", .unit = &eo_unit_MPa,
           .write = write_root_history),
};
static const struct eo_outline root_end = EO_OUTLINE("RootStressEnd", root_end_rows);

static json_t *encode_root_end(const struct eo_root_history *history, double factor, bool wanted)
{
  const struct root_end end = {history,      wanted,      history->maximum, history->maximum * factor,
                               history->arc, history->eta};
  return eo_outline_encode(&root_end, &end);
}

static double force_factor(const struct eo_case_result *case_result, int end)
{
  return case_result->vibration.outcome == EO_VIBRATION_NOT_CONVERGED
             ? NAN
             : fmax(1, case_result->vibration.dynamic_factor[end]);
}

static const struct eo_outline_row root_member_rows[] = {
    EO_KEY("max_MPa", "number?", "largest static root stress, worse end", .unit = &eo_unit_MPa),
    EO_KEY("max_dynamic_MPa", "number?", "times the dynamic factor of its end; null without a periodic vibration",
           .unit = &eo_unit_MPa),
    EO_KEY("position", "[number]?",
           "phase of the tooth's way through the mesh, in mesh cycles; null without histories"),
    EO_KEY("history_MPa", "[number?]?", "of the worse end; null without histories", .unit = &eo_unit_MPa),
    EO_KEY("left", "object", "left end", .outline = &root_end),
    EO_KEY("right", "object", "right end", .when = EO_TWO_ENDS, .outline = &root_end),
};
static const struct eo_outline root_member = EO_OUTLINE("RootStressMember", root_member_rows);

static json_t *encode_root_member(const struct eo_result_source *source, const struct eo_case_result *case_result,
                                  int member)
{
  const struct eo_root_history *history[2] = {&case_result->end[0].root[member], &case_result->end[1].root[member]};
  int worst = source->ends == 2 && history[1]->maximum > history[0]->maximum ? EO_RIGHT : EO_LEFT;
  double dynamic = 0;
  bool wanted = eo_result_has(source, EO_RESULT_NO_HISTORIES, case_result);
  struct eo_object object = eo_object_open_as(&root_member);
  for (int end = 0; end < source->ends; end++)
    dynamic = isnan(force_factor(case_result, end))
                  ? NAN
                  : fmax(dynamic, history[end]->maximum * force_factor(case_result, end));
  eo_object_put_number(&object, "max_MPa", history[worst]->maximum);
  eo_object_put_number(&object, "max_dynamic_MPa", dynamic);
  eo_object_put(&object, "position",
                wanted ? eo_json_reals(history[0]->phases, history[0]->phase, 1, NULL, EO_DIGITS_CURVE) : json_null());
  eo_object_put(&object, "history_MPa", encode_root_history(history[worst], wanted));
  for (int end = 0; end < source->ends; end++)
    eo_object_put(&object, eo_result_end[end], encode_root_end(history[end], force_factor(case_result, end), wanted));
  return eo_object_close(&object);
}

static const struct eo_outline_row root_rows[] = {
    EO_KEY("pinion", "object", "pinion", .outline = &root_member),
    EO_KEY("gear", "object", "gear", .outline = &root_member),
};
const struct eo_outline eo_outline_root_stress = EO_OUTLINE("RootStress", root_rows);

json_t *eo_result_root_stress(struct eo_result_source *source, const struct eo_case_result *case_result)
{
  if (!source->analysis->root)
    return json_null();
  struct eo_object object = eo_object_open_as(&eo_outline_root_stress);
  for (int member = 0; member < 2; member++)
    eo_object_put(&object, eo_result_member[member], encode_root_member(source, case_result, member));
  return eo_object_close(&object);
}
