/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The transmission error of a load case and the stiffness of its meshes, over the mesh positions. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "document/result_private.h"
#include "numerics/periodic.h"

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
    eo_object_put_number(&means, end ? "right_N_per_um" : "left_N_per_um",
                         eo_periodic_mean(source->positions, secant[end]));
    eo_object_put_number(&means, end ? "tangent_right_N_per_um" : "tangent_left_N_per_um",
                         eo_periodic_mean(source->positions, tangent[end]));
    eo_object_put_number(&means, end ? "mesh_right_N_per_mm_um" : "mesh_left_N_per_mm_um",
                         eo_periodic_mean(source->positions, secant[end]) * source->normal * source->normal /
                             eo_pair_half(source->pair, end)->geometry.face_width);
  }
  eo_object_put(&object, "mean", eo_object_close(&means));
  return eo_object_close(&object);
}
