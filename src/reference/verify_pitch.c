/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Index deviations over the hunting period: what a case of deviations.json expects of it. */
#include "reference/verify_deviations.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "contact/hunting.h"
#include "numerics/periodic.h"
#include "reference/case_pair.h"

enum { MOST_TEETH = 1024, CURVES = 4, PAIR = 2, FLOAT = 3 };

/* A case at work. Curves [instants]: transmission errors of the ends and of the pair, transverse, and the float of the
   pinion, m. */
struct trial {
  struct eo_verification *v;
  struct eo_case *item, *tolerance;
  const struct eo_pitch_bench *bench;
  const struct eo_geometry *geometry;
  int ends;
  struct eo_tooth_deviation tooth[2][2][MOST_TEETH]; /* [end][member] */
  struct eo_hunting hunting;
  double *curve[CURVES];
  double force; /* P of an end, N */
};

static const char *const member_key[2] = {"pinion_um", "gear_um"};
static const char *const tooth_key[2] = {"pinion_tooth", "gear_tooth"};

static const char *end_key(const struct trial *trial, int end)
{
  return eo_case_end_name[trial->ends == 1 ? 2 : end];
}

static void read_tables(struct trial *trial)
{
  struct eo_case *pitch = eo_case_need(trial->item, "pitch"), *hands = eo_case_need(pitch, "hands");
  double number[MOST_TEETH];
  eo_case_remark(pitch, "definition");
  for (int end = 0; end < trial->ends; end++) {
    struct eo_case *hand = eo_case_need(hands, end_key(trial, end));
    for (int member = 0; member < 2; member++) {
      struct eo_case *list = eo_case_find(hand, member_key[member]);
      int count = list ? eo_case_numbers(list, trial->geometry->teeth[member], MOST_TEETH, number) : 0;
      for (int i = 0; i < count; i++)
        trial->tooth[end][member][i].index = 1e-6 * number[i];
    }
  }
}

/* Which curve a key speaks of: of a hand, of the float (or shuttle) of the pinion, else of the pair. */
static const double *curve_of(const struct trial *trial, const char *key)
{
  if (strstr(key, "left"))
    return trial->curve[EO_LEFT];
  if (strstr(key, "right"))
    return trial->curve[trial->ends - 1];
  return strstr(key, "float") || strstr(key, "shuttle") ? trial->curve[FLOAT] : trial->curve[PAIR];
}

static enum eo_code solve(struct trial *trial, struct eo_error *error)
{
  const struct eo_pitch_bench *bench = trial->bench;
  double normal = cos(trial->geometry->base_helix_angle), lean = sin(trial->geometry->base_helix_angle);
  trial->force = eo_case_number(trial->item, "T_Nm") / (trial->ends * trial->geometry->base_radius[EO_PINION] * normal);
  struct eo_hunting_input input = {.ends = trial->ends,
                                   .grid = {bench->grid[0], bench->grid[1]},
                                   .gap = {bench->gap[0], bench->gap[1]},
                                   .inwards = bench->inwards,
                                   .positions = bench->grid[0]->positions,
                                   .compliance_factor = 1,
                                   .load = {trial->force, trial->force},
                                   .shared_load = trial->force,
                                   .hold = bench->hold,
                                   .threads = 1};
  for (int i = 0; i < 4; i++)
    input.tooth[i / 2][i % 2] = trial->tooth[i / 2][i % 2];
  EO_TRY(eo_hunting_run(&trial->hunting, &input, NULL, error));
  for (int i = 0; i < CURVES; i++) {
    trial->curve[i] = malloc(sizeof(double) * (size_t)trial->hunting.instants);
    if (!trial->curve[i])
      return eo_error_memory(error);
  }
  for (int i = 0; i < trial->hunting.instants; i++) {
    double left = trial->hunting.approach[0][i], right = trial->hunting.approach[trial->ends - 1][i];
    trial->curve[EO_LEFT][i] = left / normal;
    trial->curve[EO_RIGHT][i] = right / normal;
    trial->curve[PAIR][i] = (left + right) / (2 * normal);
    trial->curve[FLOAT][i] = trial->ends == 2 ? (left - right) / (2 * lean) : 0;
  }
  return EO_OK;
}

/* 2 |mean x exp(-2 pi i o t)|, t in pinion revolutions, n samples of which `per_turn` are one. */
static double amplitude(int n, const double *value, double order, double per_turn)
{
  double complex sum = 0;
  for (int i = 0; i < n; i++)
    sum += value[i] * cexp(-2 * M_PI * I * order * i / per_turn);
  return 2 * cabs(sum) / n;
}

/* A value of an order's row: of one curve, or a list of both hands. */
static void check_order(const struct trial *trial, struct eo_case *value, const char *key, double order)
{
  double relative = eo_case_relative_or(trial->tolerance, "order_amplitude_rel", 0.005),
         absolute = eo_case_absolute_or(trial->tolerance, "order_amplitude_um", 0.005);
  int n = trial->hunting.instants, per_turn = trial->hunting.positions * trial->geometry->teeth[EO_PINION];
  const double hands[2] = {amplitude(n, trial->curve[EO_LEFT], order, per_turn),
                           amplitude(n, trial->curve[EO_RIGHT], order, per_turn)};
  if (eo_case_is_list(value))
    eo_verify_list(trial->v, value, trial->ends, hands, 1e6, relative, absolute);
  else
    eo_verify_number(trial->v, value, 1e6 * amplitude(n, curve_of(trial, key), order, per_turn), relative, absolute);
}

static void check_orders(const struct trial *trial, struct eo_case *rows)
{
  for (int i = 0; i < eo_case_size(rows); i++) {
    struct eo_case *row = eo_case_at(rows, i);
    double order = eo_case_number(row, "order_per_pinion_revolution");
    eo_case_remark(row, "name");
    for (int k = 0; k < eo_case_size(row) && !eo_case_faulty(row); k++) {
      const char *key = eo_case_key(eo_case_peek(row, k));
      if (strncmp(key, "LTE", 3) == 0 || strstr(key, "float") || strstr(key, "shuttle"))
        check_order(trial, eo_case_at(row, k), key, order);
    }
  }
}

/* Of the tables alone: what a rigid pair does, one number for each mesh cycle. Keys name orders: "2 z1/z2". */
static void check_kinematic(const struct trial *trial, struct eo_case *hands)
{
  double x[EO_HUNTING_MOST_INSTANTS / 16],
      normal = cos(trial->geometry->base_helix_angle),
      ratio = (double)trial->geometry->teeth[EO_PINION] / trial->geometry->teeth[EO_GEAR];
  const struct eo_flank_point pitch_point = {0};
  eo_case_remark(hands, "note");
  for (int end = 0; end < trial->ends; end++) {
    struct eo_case *hand = eo_case_find(hands, end_key(trial, end));
    for (int m = 0; m < trial->hunting.cycles && m < EO_HUNTING_MOST_INSTANTS / 16; m++) {
      const struct eo_tooth_deviation *const tooth[2] = {&trial->tooth[end][0][m % trial->geometry->teeth[0]],
                                                         &trial->tooth[end][1][m % trial->geometry->teeth[1]]};
      x[m] = eo_hunting_gap(trial->geometry, &pitch_point, false, tooth) / normal;
    }
    for (int k = 0; hand && k < eo_case_size(hand); k++) {
      struct eo_case *expected = eo_case_at(hand, k);
      const char *key = eo_case_key(expected);
      char *rest;
      double order = strtod(key, &rest);
      order = (rest == key ? 1 : order) * (strstr(key, "z1/z2") ? ratio : 1);
      eo_verify_number(trial->v, expected,
                       1e6 * amplitude(trial->hunting.cycles, x, order, trial->geometry->teeth[EO_PINION]), 0, 2e-4);
    }
  }
}

/* Swing of the transmission error within each mesh cycle. */
static void check_cycles(const struct trial *trial, struct eo_case *block)
{
  double low = INFINITY, sum = 0, high = 0, within = eo_case_absolute_or(trial->tolerance, "LTE_um", 0.02);
  int n = trial->hunting.positions, stated = eo_case_find(block, "cycle_of_max")
                                                 ? eo_case_whole(block, "cycle_of_max", 0, trial->hunting.cycles - 1)
                                                 : 0;
  for (int cycle = 0; cycle < trial->hunting.cycles; cycle++) {
    double own = eo_periodic_swing(n, trial->curve[PAIR] + cycle * n);
    low = fmin(low, own);
    high = fmax(high, own);
    sum += own;
  }
  eo_verify_member(trial->v, block, "min", 1e6 * low, 0, within);
  eo_verify_member(trial->v, block, "mean", 1e6 * sum / trial->hunting.cycles, 0, within);
  eo_verify_member(trial->v, block, "max", 1e6 * high, 0, within);
  if (eo_case_find(block, "cycle_of_max"))
    eo_verify_derived(trial->v, block, "swing of the cycle of the largest one",
                      1e6 * eo_periodic_swing(n, trial->curve[PAIR] + stated * n), 1e6 * high, within);
}

/* The largest load of a pair of teeth, and that the teeth and the place stated carry it: of places that differ by less
   than the tolerance none is more right than another. */
static void check_most_load(const struct trial *trial, struct eo_case *block)
{
  const struct eo_hunting *hunting = &trial->hunting;
  double relative = eo_case_relative_or(trial->tolerance, "max_tooth_load_rel", 0.005),
         most = fmax(hunting->most_load[0].value, hunting->most_load[1].value);
  int hand = eo_case_find(block, "hand") ? eo_case_choice(block, "hand", eo_case_end_name, 0) : 0,
      end = hand == 1 ? trial->ends - 1 : 0;
  int line = eo_case_whole(block, "line", hunting->first_line, hunting->first_line + hunting->lines - 1),
      cycle = eo_case_whole(block, "cycle", 0, hunting->cycles - 1),
      position = eo_case_whole(block, "position", 0, hunting->positions - 1);
  eo_verify_member(trial->v, block, "load_N", most, relative, 0);
  eo_verify_member(trial->v, block, "share_of_P", most / trial->force, relative, 0);
  if (eo_case_faulty(block))
    return;
  eo_verify_derived(trial->v, block, "load of the pair stated",
                    (double)hunting->pair_load[end][(cycle * hunting->positions + position) * hunting->lines + line -
                                                    hunting->first_line],
                    most, relative * most);
  for (int member = 0; member < 2; member++)
    if (eo_case_find(block, tooth_key[member])) {
      int tooth = eo_case_whole(block, tooth_key[member], 0, hunting->teeth[member] - 1);
      eo_verify_fact(trial->v, block,
                     member ? "the pair stated has the tooth stated of the gear"
                            : "the pair stated has the tooth stated of the pinion",
                     (cycle - line + hunting->cycles) % hunting->teeth[member] == tooth);
      eo_verify_derived(trial->v, block, "largest load of the tooth stated",
                        hunting->tooth_load[end][member][tooth].value, most, relative * most);
    }
}

static void check_means(const struct trial *trial, struct eo_case *expected)
{
  const double hands[2] = {eo_periodic_mean(trial->hunting.instants, trial->curve[EO_LEFT]),
                           eo_periodic_mean(trial->hunting.instants, trial->curve[EO_RIGHT])};
  double relative = eo_case_relative_or(trial->tolerance, "LTE_mean_rel", 0.002),
         within = eo_case_absolute_or(trial->tolerance, "LTE_um", 0.02);
  eo_verify_member(trial->v, expected, "LTE_mean_um",
                   1e6 * eo_periodic_mean(trial->hunting.instants, trial->curve[PAIR]), relative, 0);
  eo_verify_member(trial->v, expected, "LTE_range_um",
                   1e6 * eo_periodic_swing(trial->hunting.instants, trial->curve[PAIR]), relative, within);
  if (eo_case_find(expected, "LTE_mean_hands_um"))
    eo_verify_list(trial->v, eo_case_find(expected, "LTE_mean_hands_um"), trial->ends, hands, 1e6, relative, 0);
  for (int k = 0; k < eo_case_size(expected); k++) {
    const char *key = eo_case_key(eo_case_peek(expected, k));
    const double *curve = curve_of(trial, key);
    if ((strstr(key, "float") || strstr(key, "shuttle")) && !strstr(key, "revolutions_um")) {
      struct eo_case *value = eo_case_at(expected, k);
      bool is_mean = strstr(key, "mean") != NULL;
      eo_verify_number(trial->v, value,
                       1e6 * (is_mean ? eo_periodic_mean(trial->hunting.instants, curve)
                                      : eo_periodic_swing(trial->hunting.instants, curve)),
                       relative, within);
    }
  }
}

/* The first revolutions, sample by sample. */
static void check_curves(const struct trial *trial, struct eo_case *expected)
{
  double within = eo_case_absolute_or(trial->tolerance, "LTE_um", 0.02);
  for (int k = 0; k < eo_case_size(expected); k++) {
    const char *key = eo_case_key(eo_case_peek(expected, k));
    if (!strstr(key, "revolutions_um"))
      continue;
    struct eo_case *list = eo_case_at(expected, k);
    int count = eo_case_size(list) <= trial->hunting.instants ? eo_case_size(list) : trial->hunting.instants;
    eo_verify_list(trial->v, list, count, curve_of(trial, key), 1e6, 0, within);
  }
}

static void check_pressure(const struct trial *trial, struct eo_case *expected)
{
  struct eo_case *pressure = eo_case_find(expected, "max_pressure_MPa");
  const double most[2] = {trial->hunting.most_pressure[0].value, trial->hunting.most_pressure[1].value};
  double relative = eo_case_relative_or(trial->tolerance, "max_pressure_rel", 0.01);
  if (pressure && eo_case_is_list(pressure))
    eo_verify_list(trial->v, pressure, trial->ends, most, 1e-6, relative, 0);
  else if (pressure)
    eo_verify_number(trial->v, pressure, 1e-6 * fmax(most[0], most[1]), relative, 0);
}

static void check(const struct trial *trial, struct eo_case *expected)
{
  eo_case_remark(trial->item, "orders_note");
  if (eo_case_find(expected, "cycles"))
    eo_verify_exact(trial->v, eo_case_find(expected, "cycles"), trial->hunting.cycles);
  eo_verify_member(trial->v, expected, "pinion_revolutions",
                   (double)trial->hunting.cycles / trial->geometry->teeth[EO_PINION], 1e-9, 0);
  check_means(trial, expected);
  check_curves(trial, expected);
  if (eo_case_find(expected, "PPLTE_of_one_cycle_um"))
    check_cycles(trial, eo_case_find(expected, "PPLTE_of_one_cycle_um"));
  check_orders(trial, eo_case_find(expected, "order_amplitude_um"));
  check_kinematic(trial, eo_case_find(expected, "kinematic_order_amplitude_um"));
  if (eo_case_find(expected, "max_tooth_load"))
    check_most_load(trial, eo_case_find(expected, "max_tooth_load"));
  check_pressure(trial, expected);
  if (trial->hunting.failures)
    eo_verify_diverged(trial->v, expected);
}

enum eo_code eo_verify_pitch(struct eo_verification *verification, struct eo_case *item,
                             const struct eo_pitch_bench *bench, struct eo_error *error)
{
  struct trial *trial = calloc(1, sizeof *trial);
  if (!trial)
    return eo_error_memory(error);
  trial->v = verification;
  trial->item = item;
  trial->tolerance = eo_case_find(item, "tolerance");
  trial->bench = bench;
  trial->ends = bench->ends;
  trial->geometry = &bench->grid[0]->geometry;
  read_tables(trial);
  struct eo_case *expected = eo_case_need(item, "expected");
  enum eo_code code = eo_case_faulty(item) ? EO_OK : solve(trial, error);
  if (!code && !eo_case_faulty(item))
    check(trial, expected);
  eo_hunting_done(&trial->hunting);
  for (int i = 0; i < CURVES; i++)
    free(trial->curve[i]);
  free(trial);
  return code;
}
