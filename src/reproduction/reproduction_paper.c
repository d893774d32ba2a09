/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The numbers the paper prints, ours beside them, and what it leaves open. */
#include "reproduction/reproduction_private.h"

#include <math.h>

#include "format/json.h"
#include "gear/modification.h"

/* Section 5.4. RMS of the relative vibration acceleration, m/s2, at 621, 828 and 1035 N m. */
static const double printed_rms[3][TORQUES] = {{26.13, 31.89, 35.27}, {21.17, 23.21, 31.01}, {22.43, 23.87, 30.65}};
static const double printed_pfc[CASES] = {39.67, 33.25};
static const double torque[TORQUES] = {621, 828, 1035};

/* A reduction agrees within so many percentage points, a level within this part of the printed one. */
static const double POINTS = 10, LEVEL = 0.1;

/* Of a row of Table 3: case A, case B left and right. */
struct parameter {
  const char *key;
  double printed[3], ours[3];
};

#define OF_PARAMETER(member) EO_AT(struct parameter, member)
static const struct eo_outline_row parameter_rows[] = {
    EO_KEY("parameter", "text", "with its unit", OF_PARAMETER(key)),
    EO_KEY("printed_case_a", "number", "both ends alike", OF_PARAMETER(printed[0])),
    EO_KEY("printed_case_b_left", "number", "of the left end", OF_PARAMETER(printed[1])),
    EO_KEY("printed_case_b_right", "number", "of the right end", OF_PARAMETER(printed[2])),
    EO_KEY("ours_case_a", "number", "of our optimum, as below", OF_PARAMETER(ours[0])),
    EO_KEY("ours_case_b_left", "number", "of the left end", OF_PARAMETER(ours[1])),
    EO_KEY("ours_case_b_right", "number", "of the right end", OF_PARAMETER(ours[2])),
};
const struct eo_outline eo_reproduction_parameter_outline = EO_OUTLINE("ReproducedParameter", parameter_rows);

static double value_of(const struct reproduction *reproduction, int variant, int end, int row)
{
  const struct eo_flank_modification *modification = &reproduction->design[variant]->modification.flank[EO_PINION][end];
  const double value[5] = {
      1e6 * modification->tip_relief, 1e6 * modification->root_relief, 1e3 * modification->tip_relief_start,
      1e3 * modification->root_relief_start,
      1e-6 * eo_modification_lead_coefficient(&reproduction->pair->geometry, modification->lead_crowning)};
  return value[row];
}

json_t *eo_reproduction_table(const struct reproduction *reproduction)
{
  static const struct parameter printed[5] = {
      {.key = "tip_relief_um", .printed = {14, 13, 13}},
      {.key = "root_relief_um", .printed = {17, 16, 17}},
      {.key = "tip_relief_start_mm", .printed = {1.6, 1.45, 1.31}},
      {.key = "root_relief_start_mm", .printed = {3.5, 3.8, 3.6}},
      {.key = "lead_coefficient_per_um", .printed = {1.35e-8, 1.03e-8, 1.79e-8}}};
  struct eo_object list = eo_list_open();
  for (int i = 0; i < 5; i++) {
    struct parameter row = printed[i];
    row.ours[0] = value_of(reproduction, OWN_A, EO_LEFT, i);
    row.ours[1] = value_of(reproduction, OWN_B, EO_LEFT, i);
    row.ours[2] = value_of(reproduction, OWN_B, EO_RIGHT, i);
    eo_list_add(&list, eo_outline_encode(&eo_reproduction_parameter_outline, &row));
  }
  return eo_object_close(&list);
}

static double reduction(double before, double after)
{
  return 100 * (1 - after / before);
}

enum { NO, YES, OPEN };

static json_t *verdict(int answer)
{
  return answer == OPEN ? json_null() : json_boolean(answer == YES);
}

static int agrees(double paper, double ours, bool level)
{
  if (isnan(paper) || isnan(ours))
    return OPEN;
  return (level ? fabs(ours / paper - 1) < LEVEL : fabs(ours - paper) <= POINTS) ? YES : NO;
}

/* A printed number beside ours. */
struct comparison {
  const char *figure, *quantity, *unit;
  double paper, ours, secant; /* NaN: none is printed; the paper's mesh law makes no difference */
  int trend;
  bool level; /* the numbers are levels, else percentages */
};

static json_t *write_trend(const void *source)
{
  return verdict(((const struct comparison *)source)->trend);
}

static json_t *write_agreement(const void *source)
{
  const struct comparison *comparison = source;
  return verdict(agrees(comparison->paper, comparison->ours, comparison->level));
}

static json_t *write_secant_agreement(const void *source)
{
  const struct comparison *comparison = source;
  return verdict(agrees(comparison->paper, comparison->secant, comparison->level));
}

#define OF_COMPARISON(member) EO_AT(struct comparison, member)
static const struct eo_outline_row comparison_rows[] = {
    EO_KEY("figure", "text", "of the paper, or its table", OF_COMPARISON(figure)),
    EO_KEY("quantity", "text", "for people", OF_COMPARISON(quantity)),
    EO_KEY("unit", "text", "of the numbers", OF_COMPARISON(unit)),
    EO_KEY("paper", "number?", "as printed; null: only a trend is", OF_COMPARISON(paper)),
    EO_KEY("ours", "number?", "null: it is not known", OF_COMPARISON(ours)),
    EO_KEY("ours_secant_law", "number?", "with the paper's mesh law; null: it makes no difference",
           OF_COMPARISON(secant)),
    EO_KEY("trend_agrees", "flag?", "ours goes the same way; null: no trend is stated", .write = write_trend),
    EO_KEY("value_agrees", "flag?", "reductions within 10 percentage points, levels within 10 %; null: none is printed",
           .write = write_agreement),
    EO_KEY("value_agrees_secant_law", "flag?", "the same with the paper's mesh law", .write = write_secant_agreement),
};
const struct eo_outline eo_reproduction_comparison_outline = EO_OUTLINE("ReproducedNumber", comparison_rows);

static void compare(struct eo_object *list, const char *figure, const char *quantity, const char *unit, double paper,
                    double ours, double secant, int trend, bool level)
{
  const struct comparison row = {figure, quantity, unit, paper, ours, secant, trend, level};
  eo_list_add(list, eo_outline_encode(&eo_reproduction_comparison_outline, &row));
}

static void compare_rms(struct eo_object *list, const struct reproduction *reproduction)
{
  static const char *const figure[TORQUES] = {"10", "11", "12"}, *const name[3] = {"unmodified", "Table 3, case A",
                                                                                   "Table 3, case B"};
  for (int k = 0; k < TORQUES; k++)
    for (int i = 0; i < 3; i++) {
      char text[120];
      double paper = printed_rms[i][k], ours = reproduction->raw[LAW_OURS][i][k].rms,
             secant = reproduction->raw[LAW_PAPER][i][k].rms;
      snprintf(text, sizeof text, "RMS, %s, %.0f N m", name[i], torque[k]);
      compare(list, figure[k], text, "m/s2", paper, ours, secant, OPEN, true);
    }
}

static void compare_reductions(struct eo_object *list, const struct reproduction *reproduction)
{
  static const char *const figure[TORQUES] = {"10", "11", "12"}, *const name[2] = {"A", "B"};
  for (int i = 0; i < 2; i++)
    for (int k = 0; k < TORQUES; k++) {
      char text[120];
      double paper = reduction(printed_rms[0][k], printed_rms[1 + i][k]);
      double ours = reduction(reproduction->raw[LAW_OURS][UNMODIFIED][k].rms,
                              reproduction->raw[LAW_OURS][PAPER_A + i][k].rms);
      double secant = reduction(reproduction->raw[LAW_PAPER][UNMODIFIED][k].rms,
                                reproduction->raw[LAW_PAPER][PAPER_A + i][k].rms);
      snprintf(text, sizeof text, "reduction of RMS, Table 3, case %s, %.0f N m", name[i], torque[k]);
      compare(list, figure[k], text, "%", paper, ours, secant, ours > 0, false);
    }
}

/* "The maximum vibration reduction of case A and case B are obtained under the torques of 828 N m." */
static int largest(const struct reproduction *reproduction, int law, int variant)
{
  int best = 0;
  double most = -INFINITY;
  for (int k = 0; k < TORQUES; k++) {
    double value = reduction(reproduction->raw[law][UNMODIFIED][k].rms, reproduction->raw[law][variant][k].rms);
    if (value > most) {
      most = value;
      best = k;
    }
  }
  return best;
}

static void compare_trends(struct eo_object *list, const struct reproduction *reproduction)
{
  const struct eo_objective_case *plain = reproduction->raw[LAW_OURS][UNMODIFIED],
                                 *secant = reproduction->raw[LAW_PAPER][UNMODIFIED];
  static const char *const name[2] = {"A", "B"};
  compare(list, "10-12", "RMS of the unmodified pair at 1035 over that at 621 N m", "",
          printed_rms[0][2] / printed_rms[0][0], plain[2].rms / plain[0].rms, secant[2].rms / secant[0].rms,
          plain[2].rms > plain[0].rms, true);
  for (int i = 0; i < 2; i++) {
    char text[120];
    int ours = largest(reproduction, LAW_OURS, PAPER_A + i), theirs = largest(reproduction, LAW_PAPER, PAPER_A + i);
    snprintf(text, sizeof text, "torque of the largest RMS reduction, Table 3, case %s", name[i]);
    compare(list, "10-12", text, "N m", 828, torque[ours], torque[theirs], ours == 1, true);
  }
  compare(list, "8", "share of 207..1242 N m with less LTE, Table 3, case A", "%", 100,
          100 * reproduction->torques_better[0], NAN, reproduction->torques_better[0] > 0.5, false);
  compare(list, "9", "share of 207..1242 N m with less impact, Table 3, case A", "%", 100,
          100 * reproduction->torques_better[1], NAN, reproduction->torques_better[1] > 0.5, false);
  compare(list, "17", "RMS at 414 N m, case A over unmodified (\"a little higher\")", "", NAN,
          reproduction->rms_414[LAW_OURS][1] / reproduction->rms_414[LAW_OURS][0],
          reproduction->rms_414[LAW_PAPER][1] / reproduction->rms_414[LAW_PAPER][0],
          reproduction->rms_414[LAW_OURS][1] > reproduction->rms_414[LAW_OURS][0], true);
  compare(list, "18", "RMS at 3000 over that at 400 rpm, unmodified (\"increases\")", "", NAN,
          reproduction->speed_slope[0], NAN, reproduction->speed_slope[0] > 1, true);
  compare(list, "18", "share of 400..3000 rpm at which case A is quieter (\"a wide range\")", "%", NAN,
          100 * reproduction->speeds_better, NAN, reproduction->speeds_better > 0.5, false);
}

static void compare_search(struct eo_object *list, const struct reproduction *reproduction)
{
  static const char *const name[CASES] = {"A", "B"};
  for (int i = 0; i < CASES; i++) {
    char text[120];
    snprintf(text, sizeof text, "PFC of fpga, case %s", name[i]);
    compare(list, "13", text, "%", printed_pfc[i], reproduction->pfc[i], NAN,
            reproduction->evaluations[i][0] < reproduction->evaluations[i][1], false);
  }
  double a = reproduction->value[LAW_OURS][OWN_A].objective, b = reproduction->value[LAW_OURS][OWN_B].objective;
  compare(list, "13", "J of our case B over that of our case A (\"similar\")", "", NAN, b / a, NAN,
          b / a > 0.7 && b / a < 1.02, true);
  for (int i = 0; i < CASES; i++) {
    char text[120];
    const struct eo_objective_value *table = &reproduction->value[LAW_OURS][PAPER_A + i],
                                    *own = &reproduction->value[LAW_OURS][OWN_A + i];
    snprintf(text, sizeof text, "J of our optimum over that of Table 3, case %s", name[i]);
    compare(list, "Table 3", text, "", NAN, own->objective / table->objective, NAN, own->objective <= table->objective,
            true);
  }
}

/* Largest less smallest stress of a loaded tooth while it carries: the largest of the history is what fluctuates from
   zero. */
static double root_peak(const struct reproduction *reproduction, int variant, int k)
{
  return eo_json_find_number(json_array_get(json_object_get(reproduction->result[variant], "load_cases"), (size_t)k),
                             "root_stress/pinion/max_MPa");
}

static void compare_root(struct eo_object *list, const struct reproduction *reproduction)
{
  for (int k = 0; k < TORQUES; k++) {
    char text[120];
    double ours = reduction(root_peak(reproduction, UNMODIFIED, k), root_peak(reproduction, PAPER_A, k));
    snprintf(text, sizeof text, "reduction of the root stress amplitude, case A, %.0f N m", torque[k]);
    compare(list, "14-15", text, "%", NAN, ours, NAN, ours > 0, false);
  }
}

json_t *eo_reproduction_comparisons(const struct reproduction *reproduction)
{
  struct eo_object list = eo_list_open();
  compare_rms(&list, reproduction);
  compare_reductions(&list, reproduction);
  compare_trends(&list, reproduction);
  compare_search(&list, reproduction);
  compare_root(&list, reproduction);
  return eo_object_close(&list);
}

json_t *eo_reproduction_readings(void)
{
  static const char *const reading[] = {
      "Signs and indices in equations (4) to (7): taken so that stiffness is symmetric and damping positive; as "
      "printed the motion diverges.",
      "Equations (9), (10): the helix angle at the base cylinder; an axial float that is constant drops out.",
      "Mesh stiffness: P/Z of the paper (secant) needs a datum for Z; the default here is the tangent at the load "
      "case. Both are shown.",
      "a_l of Table 3 is in 1/um: 1.35e-8 is 12.2 um at the face ends.",
      "Equation (15): the weights sum to 1 over the rows of the region.",
      "Equations (19) to (21): the division by 3 is kept; equation (22): each objective is related to that of the "
      "unmodified pair.",
      "Equation (23): penalties lower the fitness.",
      "Shaft angle error of Table 1: 0.1 degree in the plane of the axes.",
      "Not given: masses, bearings, damping, backlash, blanks, alpha, beta, R_0 and the radius of the FPGA, bounds of "
      "the starts and of the crowning.",
      "The speed of the optimization is not given either: 2000 rpm. So levels cannot be matched point by point; trends "
      "and reductions are compared.",
      "A reduction counts as agreeing within 10 percentage points, a level within 10 %; a trend when it has the same "
      "direction.",
  };
  struct eo_object list = eo_list_open();
  for (size_t i = 0; i < sizeof reading / sizeof *reading; i++)
    eo_list_add(&list, json_string(reading[i]));
  return eo_object_close(&list);
}
