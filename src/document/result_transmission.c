/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The transmission error of a load case and the stiffness of its meshes, over the mesh positions. */
#include <math.h>
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

/* Where a floating pinion settles, + to the right: z = (Z'_L - Z'_R)/(lean of both ends), which is
   (Z_L - Z_R)/(2 sin beta_b) of equal helices, with the other sign where the face ends at the groove meet first. */
static json_t *encode_float(const struct eo_result_source *source, const double *const approach[2], bool inwards)
{
  int n = source->positions;
  double lean = source->helix.scale[EO_RIGHT] != 1 ? eo_double_helix_lean(&source->helix)
                                                   : 2 * sqrt(fmax(0, 1 - source->normal * source->normal)),
         scale = (inwards ? -1 : 1) / lean;
  for (int j = 0; j < n; j++)
    source->scratch[j] = approach[0][j] - approach[1][(j + n - source->lag) % n] * source->helix.scale[EO_RIGHT];
  return eo_json_column(n, source->scratch, scale, &eo_unit_um, source->digits);
}

/* What a load case says about its transmission error. */
struct transmission {
  bool two, floats; /* ends; a pinion that settles between them */
  struct eo_series pair, end[2];
  double swing, end_swing[2], mean, windup, second_rms;
  json_t *orders, *second, *axial_float;
};

#define OF_TRANSMISSION(member) EO_AT(struct transmission, member)
static const struct eo_outline_row lte_rows[] = {
    EO_KEY("pair_um", "[number?]?",
           "mean of the ends, over the positions; of unequal helices weighted by the other end's tan(beta_b): the "
           "rotation alone",
           .unit = &eo_unit_um, OF_TRANSMISSION(pair)),
    EO_KEY("left_um", "[number?]?", "left end, over the positions", .unit = &eo_unit_um, OF_TRANSMISSION(end[EO_LEFT])),
    EO_KEY("right_um", "[number?]?", "right end, over the positions", .unit = &eo_unit_um, .when = EO_TWO_ENDS,
           OF_TRANSMISSION(end[EO_RIGHT]), EO_IF(struct transmission, two)),
    EO_KEY("peak_to_peak_um", "number?", "of the pair", .unit = &eo_unit_um, OF_TRANSMISSION(swing)),
    EO_KEY("left_peak_to_peak_um", "number?", "of the left end", .unit = &eo_unit_um,
           OF_TRANSMISSION(end_swing[EO_LEFT])),
    EO_KEY("right_peak_to_peak_um", "number?", "of the right end", .unit = &eo_unit_um, .when = EO_TWO_ENDS,
           OF_TRANSMISSION(end_swing[EO_RIGHT]), EO_IF(struct transmission, two)),
    EO_KEY("mean_um", "number?", "of the pair over the mesh cycle", .unit = &eo_unit_um, OF_TRANSMISSION(mean)),
    EO_KEY("hub_windup_um", "number?",
           "what hubs that take their torque through a bore add to the mean, not in it; null unless hub_windup is on",
           .unit = &eo_unit_um, OF_TRANSMISSION(windup)),
    EO_KEY("orders_um", "[number?]?", "the mean, then the amplitudes of the mesh harmonics 1, 2, ... of the pair",
           .unit = &eo_unit_um, OF_TRANSMISSION(orders)),
    EO_KEY(
        "second_derivative_m_per_s2", "[number?]?",
        "of the pair's error by time at the speed of the load case, from the mesh harmonics up to te_harmonics, over "
        "the positions",
        .unit = &eo_unit_m_per_s2, OF_TRANSMISSION(second)),
    EO_KEY("second_derivative_rms_m_per_s2", "number?", "RMS of it", .unit = &eo_unit_m_per_s2,
           OF_TRANSMISSION(second_rms)),
    EO_KEY("axial_float_um", "[number?]?", "where the pinion settles along its axis, over the positions",
           .unit = &eo_unit_um, .when = "with two ends and a pinion that can move", OF_TRANSMISSION(axial_float),
           EO_IF(struct transmission, floats)),
};
const struct eo_outline eo_outline_lte = EO_OUTLINE("TransmissionError", lte_rows);

/* The second derivative by time of the transmission error, whose mesh harmonics are known: -(2 pi f_mesh h)^2 times
   each (finer ones are noise of the positions). Its RMS comes from the same amplitudes. */
static void find_second_derivative(const struct eo_result_source *source, const struct eo_case_result *case_result,
                                   struct transmission *view)
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
  view->second = eo_result_has(source, EO_RESULT_NO_LTE, case_result)
                     ? eo_json_column(n, source->scratch, 1, &eo_unit_m_per_s2, source->digits)
                     : json_null();
  view->second_rms = sqrt(squares);
}

/* P over the face, mean of the ends as that of Z is. */
static double mean_line_load(const struct eo_result_source *source, const struct eo_case_result *case_result)
{
  double sum = 0;
  for (int end = 0; end < source->ends; end++)
    sum += eo_result_weight(source, end) / source->ends * case_result->even_force[end] /
           eo_pair_half(source->pair, end)->geometry.face_width;
  return sum;
}

json_t *eo_result_lte(struct eo_result_source *source, const struct eo_case_result *case_result)
{
  const double *const approach[2] = {case_result->end[0].loaded.approach, case_result->end[1].loaded.approach};
  bool curves = eo_result_has_overview(source, EO_RESULT_NO_LTE, case_result),
       whole = eo_result_has(source, EO_RESULT_NO_LTE, case_result);
  double windup = eo_result_hub_windup(source, EO_PINION) + eo_result_hub_windup(source, EO_GEAR);
  struct transmission view = {
      .two = source->ends == 2,
      .floats = source->ends == 2 && source->design->alignment.pinion_axial != EO_AXIAL_FIXED,
      .pair = eo_result_curve(source, EO_LEFT, curves ? case_result->transmission : NULL, 1),
      .swing = case_result->peak_to_peak,
      .mean = case_result->mean,
      .windup = windup * mean_line_load(source, case_result) / source->normal,
      .orders = curves ? encode_orders(source, case_result->transmission, &eo_unit_um) : json_null(),
  };
  for (int end = 0; end < source->ends; end++) {
    view.end[end] = eo_result_curve(source, end, curves ? approach[end] : NULL, 1 / eo_result_normal(source, end));
    view.end_swing[end] = case_result->end[end].transmission_peak;
  }
  find_second_derivative(source, case_result, &view);
  if (view.floats)
    view.axial_float = whole ? encode_float(source, approach, case_result->running.inwards) : json_null();
  return eo_outline_encode(&eo_outline_lte, &view);
}

/* Mean over the mesh cycle of one end. */
struct mean_stiffness {
  double secant, tangent, mesh; /* normal, normal, transverse per face width */
};

struct mean_of_ends {
  bool two;
  struct mean_stiffness end[2];
};

/* What a load case says about the stiffness of its meshes. */
struct stiffness {
  bool two;
  struct eo_series secant[2], tangent[2];
  json_t *orders[2];
  struct mean_of_ends mean;
};

#define OF_MEAN(member) EO_AT(struct mean_of_ends, member)
#define IF_TWO_MEANS EO_IF(struct mean_of_ends, two)
static const struct eo_outline_row stiffness_mean_rows[] = {
    EO_KEY("left_N_per_um", "number?", "left end", .unit = &eo_unit_N_per_um, OF_MEAN(end[EO_LEFT].secant)),
    EO_KEY("tangent_left_N_per_um", "number?", "left end, tangent", .unit = &eo_unit_N_per_um,
           OF_MEAN(end[EO_LEFT].tangent)),
    EO_KEY(
        "mesh_left_N_per_mm_um", "number?",
        "left end, transverse per face width: left_N_per_um cos^2(beta_b)/b; to compare with iso_c_gamma_N_per_mm_um, "
        "which means an aligned, unmodified pair",
        .unit = &eo_unit_N_per_mm_um, OF_MEAN(end[EO_LEFT].mesh)),
    EO_KEY("right_N_per_um", "number?", "right end", .unit = &eo_unit_N_per_um, .when = EO_TWO_ENDS,
           OF_MEAN(end[EO_RIGHT].secant), IF_TWO_MEANS),
    EO_KEY("tangent_right_N_per_um", "number?", "right end, tangent", .unit = &eo_unit_N_per_um, .when = EO_TWO_ENDS,
           OF_MEAN(end[EO_RIGHT].tangent), IF_TWO_MEANS),
    EO_KEY("mesh_right_N_per_mm_um", "number?", "right end, transverse per face width", .unit = &eo_unit_N_per_mm_um,
           .when = EO_TWO_ENDS, OF_MEAN(end[EO_RIGHT].mesh), IF_TWO_MEANS),
};
static const struct eo_outline stiffness_mean = EO_OUTLINE("MeanMeshStiffness", stiffness_mean_rows);

#define OF_STIFFNESS(member) EO_AT(struct stiffness, member)
#define IF_TWO_STIFFNESSES EO_IF(struct stiffness, two)
static const struct eo_outline_row stiffness_rows[] = {
    EO_KEY("left_N_per_um", "[number?]?", "load over approach from first contact, normal, left end, over the positions",
           .unit = &eo_unit_N_per_um, OF_STIFFNESS(secant[EO_LEFT])),
    EO_KEY("right_N_per_um", "[number?]?", "the same, right end", .unit = &eo_unit_N_per_um, .when = EO_TWO_ENDS,
           OF_STIFFNESS(secant[EO_RIGHT]), IF_TWO_STIFFNESSES),
    EO_KEY("tangent_left_N_per_um", "[number?]?",
           "change of load over change of approach, normal, left end, over the positions", .unit = &eo_unit_N_per_um,
           OF_STIFFNESS(tangent[EO_LEFT])),
    EO_KEY("tangent_right_N_per_um", "[number?]?", "the same, right end", .unit = &eo_unit_N_per_um,
           .when = EO_TWO_ENDS, OF_STIFFNESS(tangent[EO_RIGHT]), IF_TWO_STIFFNESSES),
    EO_KEY("left_orders_N_per_um", "[number?]?",
           "mean of left_N_per_um, then the amplitudes of its mesh harmonics 1, 2, ...", .unit = &eo_unit_N_per_um,
           OF_STIFFNESS(orders[EO_LEFT])),
    EO_KEY("right_orders_N_per_um", "[number?]?", "the same, right end", .unit = &eo_unit_N_per_um, .when = EO_TWO_ENDS,
           OF_STIFFNESS(orders[EO_RIGHT]), IF_TWO_STIFFNESSES),
    EO_KEY("mean", "object", "means over the mesh cycle", .outline = &stiffness_mean, OF_STIFFNESS(mean)),
};
const struct eo_outline eo_outline_stiffness = EO_OUTLINE("MeshStiffness", stiffness_rows);

json_t *eo_result_stiffness(struct eo_result_source *source, const struct eo_case_result *case_result)
{
  bool curves = eo_result_has(source, EO_RESULT_NO_STIFFNESS, case_result), two = source->ends == 2;
  struct stiffness view = {.two = two, .mean.two = two};
  for (int end = 0; end < source->ends; end++) {
    const double *secant = case_result->end[end].stiffness, *tangent = case_result->end[end].loaded.tangent;
    double mean = eo_periodic_mean(source->positions, secant);
    view.secant[end] = eo_result_curve(source, end, curves ? secant : NULL, 1);
    view.tangent[end] = eo_result_curve(source, end, curves ? tangent : NULL, 1);
    view.orders[end] = curves ? encode_orders(source, secant, &eo_unit_N_per_um) : json_null();
    view.mean.end[end] = (struct mean_stiffness){mean, eo_periodic_mean(source->positions, tangent),
                                                 mean * eo_result_normal(source, end) * eo_result_normal(source, end) /
                                                     eo_pair_half(source->pair, end)->geometry.face_width};
  }
  return eo_outline_encode(&eo_outline_stiffness, &view);
}
