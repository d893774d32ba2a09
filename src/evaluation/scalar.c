/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/scalar.h"

#include <math.h>
#include <string.h>

#include "evaluation/pitch_analysis.h"
#include "numerics/periodic.h"

enum what {
  SWING,
  MEAN,
  ORDER,
  PRESSURE,
  LINE_LOAD,
  EDGE,
  FACE_FACTOR,
  SHARE_FACTOR,
  IMPACT,
  RMS,
  DYNAMIC,
  LOSS,
  ROOT,
  PERIOD_SWING,
  SHAFT,
  SIDEBAND,
  TOOTH_LOAD,
  TOOTH_PRESSURE,
  PERIOD_RMS,
  TOOTH_ROOT
};

/* clang-format off */
/* The rows in the order in which a history keeps their numbers: new ones stand at the end. */
#define SCALARS(ROW)                                                                                                   \
  ROW("peak_to_peak_um", "of the loaded transmission error of the pair", 1e-6, 0, 0, -1, SWING)                         \
  ROW("peak_to_peak_left_um", "of the left end alone", 1e-6, 0, 0, EO_LEFT, SWING)                                      \
  ROW("peak_to_peak_right_um", "of the right end alone", 1e-6, 0, 0, EO_RIGHT, SWING)                                   \
  ROW("mean_um", "of the loaded transmission error", 1e-6, 0, 0, -1, MEAN)                                              \
  ROW("order_1_um", "first mesh order of the transmission error, amplitude", 1e-6, 0, 1, -1, ORDER)                     \
  ROW("order_2_um", "second mesh order", 1e-6, 0, 2, -1, ORDER)                                                         \
  ROW("order_3_um", "third mesh order", 1e-6, 0, 3, -1, ORDER)                                                          \
  ROW("max_pressure_MPa", "largest contact pressure", 1e6, 0, 0, -1, PRESSURE)                                          \
  ROW("max_pressure_left_MPa", "of the left end", 1e6, 0, 0, EO_LEFT, PRESSURE)                                         \
  ROW("max_pressure_right_MPa", "of the right end", 1e6, 0, 0, EO_RIGHT, PRESSURE)                                      \
  ROW("max_line_load_N_per_mm", "largest load per length of contact line", 1e3, 0, 0, -1, LINE_LOAD)                    \
  ROW("edge_load_share", "largest share of the load on tip edges", 1, 0, 0, -1, EDGE)                                   \
  ROW("K_Hbeta", "load over the face: largest over mean", 1, 0, 0, -1, FACE_FACTOR)                                     \
  ROW("K_Halpha", "sharing among the pairs", 1, 0, 0, -1, SHARE_FACTOR)                                                 \
  ROW("impact_N", "general entering impact", 1, 0, 0, -1, IMPACT)                                                       \
  ROW("rms_m_per_s2", "RMS of the relative acceleration normal to the teeth", 1, EO_SCALAR_VIBRATION, 0, -1, RMS)       \
  ROW("dynamic_factor", "largest dynamic over static mesh force", 1, EO_SCALAR_VIBRATION, 0, -1, DYNAMIC)               \
  ROW("contact_loss", "share of the mesh cycle without contact", 1, EO_SCALAR_VIBRATION, 0, -1, LOSS)                   \
  ROW("root_stress_MPa", "largest root stress of both members", 1e6, EO_SCALAR_ROOT, 0, -1, ROOT)
/* Of the hunting period; `end` of a shaft order is its member. */
#define PERIOD(ROW)                                                                                                    \
  ROW("period_peak_to_peak_um", "of the transmission error over the hunting period", 1e-6, EO_SCALAR_TEETH, 0, -1, PERIOD_SWING) \
  ROW("pinion_order_um", "first order of the pinion's shaft in it, amplitude", 1e-6, EO_SCALAR_TEETH, 0, EO_PINION, SHAFT)  \
  ROW("gear_order_um", "first order of the gear's shaft in it, amplitude", 1e-6, EO_SCALAR_TEETH, 0, EO_GEAR, SHAFT)        \
  ROW("sideband_um", "largest sideband of the first mesh order in it, amplitude", 1e-6, EO_SCALAR_TEETH, 0, -1, SIDEBAND)   \
  ROW("tooth_load_N", "largest load of any tooth", 1, EO_SCALAR_TEETH, 0, -1, TOOTH_LOAD)                                \
  ROW("tooth_pressure_MPa", "largest contact pressure of any tooth", 1e6, EO_SCALAR_TEETH, 0, -1, TOOTH_PRESSURE)        \
  ROW("period_rms_m_per_s2", "RMS of the acceleration normal to the teeth over the hunting period", 1,                   \
      EO_SCALAR_TEETH | EO_SCALAR_VIBRATION, 0, -1, PERIOD_RMS)                                                          \
  ROW("tooth_root_stress_MPa", "largest root stress of any tooth", 1e6, EO_SCALAR_TEETH | EO_SCALAR_ROOT, 0, -1, TOOTH_ROOT)
#define SCALAR(key, help, unit, needs, order, end, what) {key, help, unit, needs, order, end, what},
#define KEY(key, help, unit, needs, order, end, what) key,
/* clang-format on */
static const struct eo_scalar scalars[] = {SCALARS(SCALAR) PERIOD(SCALAR)};
const char *const eo_scalar_keys[] = {SCALARS(KEY) NULL};
_Static_assert(sizeof eo_scalar_keys / sizeof *eo_scalar_keys == EO_SCALARS + 1,
               "raw values have room for every scalar");
_Static_assert(sizeof scalars / sizeof *scalars == EO_ALL_SCALARS, "all are counted");

const struct eo_scalar *eo_scalar_at(int index)
{
  return index >= 0 && index < EO_ALL_SCALARS ? &scalars[index] : NULL;
}

int eo_scalar_find(const char *key)
{
  for (int i = 0; i < EO_ALL_SCALARS; i++)
    if (strcmp(scalars[i].key, key) == 0)
      return i;
  return -1;
}

static double order_of(const struct eo_evaluation *evaluation, const struct eo_case_result *case_result, int order)
{
  double amplitude[3][2];
  if (2 * order >= evaluation->positions)
    return NAN;
  eo_periodic_harmonics(evaluation->positions, case_result->transmission, order, amplitude);
  return hypot(amplitude[order - 1][0], amplitude[order - 1][1]);
}

static double root_of(const struct eo_end_result *end)
{
  double largest = NAN;
  for (int member = 0; member < 2; member++)
    if (end->root[member].phases > 0)
      largest = fmax(largest, end->root[member].maximum);
  return largest;
}

static double at_end(const struct eo_scalar *scalar, const struct eo_case_result *case_result, int end)
{
  const struct eo_end_result *end_result = &case_result->end[end];
  switch (scalar->what) {
  case SWING:
    return end_result->transmission_peak;
  case PRESSURE:
    return end_result->max_pressure;
  case LINE_LOAD:
    return end_result->max_line_load;
  case EDGE:
    return end_result->edge_share;
  case FACE_FACTOR:
    return end_result->face.face_factor;
  case SHARE_FACTOR:
    return end_result->face.share_factor;
  case IMPACT:
    return end_result->impact.force;
  case LOSS:
    return case_result->vibration.contact_loss[end];
  default:
    return root_of(end_result);
  }
}

/* The worse end; NaN of one does not hide the other. */
static double worse_of(const struct eo_scalar *scalar, const struct eo_evaluation *evaluation,
                       const struct eo_case_result *case_result)
{
  double worst = NAN;
  for (int end = 0; end < evaluation->ends; end++)
    worst = fmax(worst, at_end(scalar, case_result, end));
  return worst;
}

double eo_scalar_value(const struct eo_scalar *scalar, const struct eo_evaluation *evaluation, int load_case)
{
  const struct eo_case_result *case_result = &evaluation->load_case[load_case];
  bool shaken = !(scalar->needs & EO_SCALAR_VIBRATION) || case_result->vibration.outcome != EO_VIBRATION_NOT_CONVERGED;
  if (scalar->needs & EO_SCALAR_TEETH || case_result->contact_failures > 0 || !shaken ||
      scalar->end >= evaluation->ends)
    return NAN;
  if (scalar->end >= 0)
    return at_end(scalar, case_result, scalar->end) / scalar->unit;
  switch (scalar->what) {
  case SWING:
    return case_result->peak_to_peak / scalar->unit;
  case MEAN:
    return case_result->mean / scalar->unit;
  case ORDER:
    return order_of(evaluation, case_result, scalar->order) / scalar->unit;
  case RMS:
    return case_result->vibration.rms_pair[EO_READING_NORMAL] / scalar->unit;
  case DYNAMIC:
    return case_result->dynamic_force_factor / scalar->unit;
  default:
    return worse_of(scalar, evaluation, case_result) / scalar->unit;
  }
}

/* The largest of the lines whose names begin so. */
static double largest_order(const struct eo_pitch_case *period, const char *beginning)
{
  double largest = NAN;
  for (int i = 0; i < period->orders; i++)
    if (strncmp(period->order[i].name, beginning, strlen(beginning)) == 0)
      largest = fmax(largest, period->order[i].transmission);
  return largest;
}

/* Of both ends, or members; 0: it is not asked for, or there is no such end. */
static double larger(const struct eo_hunting_place place[2])
{
  double value = fmax(place[0].value, place[1].value);
  return value > 0 ? value : NAN;
}

static double period_value(const struct eo_scalar *scalar, const struct eo_pitch_case *period)
{
  switch (scalar->what) {
  case PERIOD_SWING:
    return period->peak_to_peak;
  case SHAFT:
    return largest_order(period, scalar->end == EO_PINION ? "pinion 1" : "gear 1");
  case SIDEBAND:
    return largest_order(period, "mesh 1 ");
  case TOOTH_LOAD:
    return larger(period->hunting.most_load);
  case TOOTH_PRESSURE:
    return larger(period->hunting.most_pressure);
  case PERIOD_RMS:
    return period->response.outcome <= EO_LONG_CONTACT_LOST ? period->response.rms[EO_READING_NORMAL] : NAN;
  default:
    return larger(period->hunting.most_stress);
  }
}

double eo_scalar_of_period(const struct eo_scalar *scalar, const struct eo_pitch_case *period)
{
  return period->hunting.failures > 0 ? NAN : period_value(scalar, period) / scalar->unit;
}
