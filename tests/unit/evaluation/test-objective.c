/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Objectives, constraints and fitness against their formulae, paper equations (19)-(23). */
#include "evaluation/evaluator.h"
#include "evaluation/objective_terms.h"
#include "evaluation/scalar.h"
#include "support/tap.h"

#include <stddef.h>

static const struct eo_load_case load_case[3] = {{.torque = 621, .speed = 209, .share = 0.2},
                                                 {.torque = 828, .speed = 209, .share = 0.5},
                                                 {.torque = 1035, .speed = 209, .share = 0.3}};
static const struct eo_objective_case before[3] = {{2.05e-6, 2900, 62, 900e6, 48e6, 0.1, 0, .failed = false},
                                                   {1.78e-6, 3300, 66, 1000e6, 52e6, 0.1, 0, .failed = false},
                                                   {1.53e-6, 3700, 68, 1100e6, 60e6, 0.1, 0, .failed = false}};
static const struct eo_objective_case after[3] = {{0.77e-6, 700, 22.2, 800e6, 47e6, 0, 0, .failed = false},
                                                  {0.71e-6, 800, 27.9, 950e6, 51e6, 0.02, 0.01, .failed = false},
                                                  {0.57e-6, 900, 28.9, 1050e6, 59e6, 0.05, 0, .failed = false}};

static struct eo_objective plain(void)
{
  return (struct eo_objective){.weight = {0.4, 0.3, 0.3},
                               .normalise = EO_NORMALISE_UNMODIFIED,
                               .penalty = 10,
                               .contact_pressure = NAN,
                               .root_stress = NAN,
                               .peak_to_peak = NAN,
                               .edge_load_share = NAN,
                               .contact_loss = NAN,
                               .flank_safety = NAN,
                               .root_safety = NAN,
                               .film_ratio = NAN,
                               .contact_temperature = NAN};
}

static struct eo_objective_value value_of(const struct eo_objective *objective, const struct eo_objective_case *value,
                                          bool outside)
{
  struct eo_objective_value result;
  eo_objective_value(objective, 3, load_case, value, before, outside, &result);
  return result;
}

static void test_sums(void)
{
  struct eo_objective_sums sums;
  eo_objective_sum(3, load_case, after, &sums);
  near(sums.f[0], (0.2 * 0.77e-6 + 0.5 * 0.71e-6 + 0.3 * 0.57e-6) / 3, 1e-14,
       "f1: peak-to-peak weighted by the shares, over three, m");
  near(sums.f[1], (0.2 * 700 + 0.5 * 800 + 0.3 * 900) / 3, 1e-14, "f2: impacts weighted by the shares, N");
  near(sums.f[2], (0.2 * 22.2 + 0.5 * 27.9 + 0.3 * 28.9) / 3, 1e-14, "f3: accelerations weighted by the shares, m/s2");
  ok(!sums.failed, "no load case counts as failed");
  eo_objective_sum(1, load_case, after, &sums);
  near(sums.f[2], 0.2 * 22.2, 1e-14, "f1 of one load case, divided by one");
  struct eo_objective_case backward = after[0];
  backward.impact = -700;
  eo_objective_sum(1, load_case, &backward, &sums);
  near(sums.f[1], 0.2 * 700, 1e-14, "f2 of a negative impact, whose size counts");
}

static void test_objective(void)
{
  struct eo_objective objective = plain();
  struct eo_objective_value v = value_of(&objective, after, false), same = value_of(&objective, before, false);
  double f1 = (0.2 * 0.77 + 0.5 * 0.71 + 0.3 * 0.57) / (0.2 * 2.05 + 0.5 * 1.78 + 0.3 * 1.53);
  double f2 = (0.2 * 700 + 0.5 * 800 + 0.3 * 900) / (0.2 * 2900 + 0.5 * 3300 + 0.3 * 3700);
  double f3 = (0.2 * 22.2 + 0.5 * 27.9 + 0.3 * 28.9) / (0.2 * 62 + 0.5 * 66 + 0.3 * 68);
  near(v.objective, 0.4 * f1 + 0.3 * f2 + 0.3 * f3, 1e-13, "J against the unmodified pair");
  near(v.fitness, 1 / v.objective, 1e-14, "fitness without violations");
  near(same.objective, 1, 1e-14, "J of the unmodified pair itself");
  objective.weight[0] = objective.weight[1] = 0;
  objective.weight[2] = 2;
  near(value_of(&objective, after, false).objective, 2 * f3, 1e-13, "J of one objective alone");
  objective = plain();
  objective.normalise = EO_NORMALISE_NONE;
  v = value_of(&objective, after, false);
  near(v.objective, 0.4 * v.sums.f[0] + 0.3 * v.sums.f[1] + 0.3 * v.sums.f[2], 1e-14,
       "J that is not normalised, as printed");
}

static void test_constraints(void)
{
  static const struct {
    const char *what;
    size_t offset;
    double limit, excess; /* the sum over the load cases of value / limit - 1 */
  } row[] = {
      {"contact pressure", offsetof(struct eo_objective, contact_pressure), 900e6, 950.0 / 900 - 1 + 1050.0 / 900 - 1},
      {"root stress", offsetof(struct eo_objective, root_stress), 50e6, 51.0 / 50 - 1 + 59.0 / 50 - 1},
      {"peak to peak", offsetof(struct eo_objective, peak_to_peak), 0.75e-6, 0.77 / 0.75 - 1},
      {"edge load", offsetof(struct eo_objective, edge_load_share), 0.04, 0.05 / 0.04 - 1},
      {"contact loss, limit 0", offsetof(struct eo_objective, contact_loss), 0, 0.01},
  };
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    struct eo_objective objective = plain();
    double *limit = (double *)(void *)((char *)&objective + row[i].offset);
    double free_fitness = value_of(&objective, after, false).fitness;
    ok(value_of(&objective, after, false).violation == 0, "%s is free by default", row[i].what);
    *limit = row[i].limit;
    struct eo_objective_value v = value_of(&objective, after, false);
    near(v.violation, row[i].excess, 1e-12, row[i].what);
    near(v.fitness, free_fitness - 10 * row[i].excess, 1e-12, "fitness less the penalty of the violation");
    *limit = 1e12;
    ok(value_of(&objective, after, false).violation == 0, "%s: a generous limit is kept", row[i].what);
  }
}

/* Limits from below: by how much of itself a value falls short; of the first load case alone. */
static void test_shortfall(void)
{
  struct eo_objective objective = plain();
  struct eo_objective_case rated[3] = {after[0], after[1], after[2]};
  for (int k = 0; k < 3; k++)
    rated[k].flank_safety = rated[k].root_safety = rated[k].film_ratio = rated[k].contact_temperature = NAN;
  rated[0].flank_safety = 0.8;
  rated[0].contact_temperature = 150;
  ok(!eo_objective_wants_rating(&objective) && value_of(&objective, rated, false).violation == 0,
     "the safety is free by default");
  objective.flank_safety = 1.2;
  ok(eo_objective_wants_rating(&objective), "a limit on it asks for the rating");
  near(value_of(&objective, rated, false).violation, 0.5, 1e-12, "violation by a safety of 0.8 where 1.2 is wanted");
  objective.contact_temperature = 120;
  near(value_of(&objective, rated, false).violation, 0.75, 1e-12, "violation by a gear that is too hot by a quarter");
  rated[0].flank_safety = 1.3;
  objective.contact_temperature = 160;
  ok(value_of(&objective, rated, false).violation == 0, "limits on the rating that are kept violate nothing");
}

static void test_no_worse(void)
{
  struct eo_objective objective = plain();
  struct eo_objective_case worse[3] = {after[0], after[1], after[2]};
  objective.no_worse_than_unmodified = true;
  ok(value_of(&objective, after, false).violation == 0, "a pair that is better everywhere violates nothing");
  worse[2].rms = 1.25 * before[2].rms;
  worse[0].peak_to_peak = 1.5 * before[0].peak_to_peak;
  near(value_of(&objective, worse, false).violation, 0.75, 1e-12,
       "violation by a pair that is worse at single load cases");
  objective.no_worse_than_unmodified = false;
  ok(value_of(&objective, worse, false).violation == 0, "a pair that is worse at single load cases is free by default");
}

static void test_relief(void)
{
  struct eo_objective objective = plain();
  struct eo_modification m = {0};
  double bottom = -5.7e-3, top = 5.1e-3;
  ok(!eo_objective_relief_outside(&m, bottom, top), "no relief lies outside");
  m.flank[EO_PINION][EO_LEFT] = (struct eo_flank_modification){
      .tip_relief = 1e-6, .tip_relief_start = 5.0e-3, .root_relief = 1e-6, .root_relief_start = 5.6e-3};
  m.flank[EO_GEAR][EO_RIGHT] = (struct eo_flank_modification){
      .tip_relief = 1e-6, .tip_relief_start = 5.6e-3, .root_relief = 1e-6, .root_relief_start = 5.0e-3};
  ok(!eo_objective_relief_outside(&m, bottom, top),
     "a relief that starts inside reaches the gear's tip at the pinion's root");
  m.flank[EO_GEAR][EO_RIGHT].root_relief_start = 5.2e-3;
  ok(eo_objective_relief_outside(&m, bottom, top), "root relief of the gear may lie beyond the pinion's tip");
  m.flank[EO_GEAR][EO_RIGHT].root_relief = 0;
  ok(!eo_objective_relief_outside(&m, bottom, top), "a start without relief lies nowhere outside");
  m.flank[EO_PINION][EO_LEFT].tip_relief_start = 5.1e-3;
  ok(eo_objective_relief_outside(&m, bottom, top), "a relief that starts at the very end lies outside");
  ok(value_of(&objective, after, true).violation == 0, "a relief outside is allowed unless it is forbidden");
  objective.relief_inside_active_flank = true;
  ok(value_of(&objective, after, true).violation == 1 && value_of(&objective, after, false).violation == 0,
     "a relief outside that is forbidden counts as one violation");
}

static void test_failures(void)
{
  struct eo_objective objective = plain();
  struct eo_objective_case bad[3] = {after[0], after[1], after[2]};
  bad[1].failed = true;
  struct eo_objective_value v = value_of(&objective, bad, false);
  ok(v.sums.failed && isnan(v.objective) && v.fitness == EO_FITNESS_WORST,
     "one load case that failed spoils the design");
  bad[1] = after[1];
  bad[1].rms = NAN;
  v = value_of(&objective, bad, false);
  ok(v.sums.failed && v.fitness == EO_FITNESS_WORST, "a number that is none spoils the design");
  bad[1] = after[1];
  bad[1].root_stress = NAN;
  objective.root_stress = 1e9;
  v = value_of(&objective, bad, false);
  ok(!v.sums.failed && v.violation == 0, "a root stress that was not computed violates nothing");
}

/* Where the unmodified pair is already perfect there is nothing to divide by. */
static void test_zero_baseline(void)
{
  struct eo_objective objective = plain();
  struct eo_objective_case perfect[3] = {before[0], before[1], before[2]}, quiet[3] = {after[0], after[1], after[2]};
  struct eo_objective_value v;
  for (int k = 0; k < 3; k++)
    perfect[k].impact = quiet[k].impact = 0;
  eo_objective_value(&objective, 3, load_case, quiet, perfect, false, &v);
  ok(isfinite(v.objective) && v.objective < 0.7, "an objective at zero before and after drops out: J = %.3f",
     v.objective);
  double without = v.objective;
  eo_objective_value(&objective, 3, load_case, after, perfect, false, &v);
  near(v.objective, without + 0.3, 1e-12, "J of an objective that was zero and is not");
  for (int k = 0; k < 3; k++)
    quiet[k] = (struct eo_objective_case){0};
  eo_objective_value(&objective, 3, load_case, quiet, before, false, &v);
  ok(v.fitness == EO_FITNESS_WORST, "objectives that are all zero give no infinite fitness");
}

/* Eleven states whose order_1_um is 1 .. 11 um at load case 2, the others 5 um; the unmodified pair has 10. */
enum { STATES = 11 };
static struct eo_objective_case state[STATES][3], bare[STATES][3];

static void fill_states(int output)
{
  for (int i = 0; i < STATES; i++)
    for (int k = 0; k < 3; k++) {
      state[i][k] = after[k];
      bare[i][k] = before[k];
      for (int s = 0; s < EO_SCALARS; s++)
        state[i][k].scalar[s] = bare[i][k].scalar[s] = NAN;
      state[i][k].scalar[output] = k == 1 ? (double)(7 * i % STATES + 1) : 5;
      bare[i][k].scalar[output] = 10;
    }
}

static void test_terms(void)
{
  struct eo_objective objective = plain();
  int output = eo_scalar_find("order_1_um");
  double without = value_of(&objective, after, false).objective;
  fill_states(output);
  objective.terms = 1;
  objective.term[0] =
      (struct eo_objective_term){.output = output, .load_case = 2, .weight = 2, .scale = NAN, .percent = NAN};
  ok(eo_objective_wants_scalars(&objective) && !eo_objective_wants_root(&objective),
     "a term asks for the numbers, this one not for root stress");
  struct eo_objective_case missing[3] = {state[0][0], state[0][1], state[0][2]};
  missing[1].scalar[output] = NAN;
  struct eo_objective_value v = value_of(&objective, missing, false);
  ok(v.sums.failed && isnan(v.objective), "a number that is missing leaves no J");
  eo_objective_value(&objective, 3, load_case, state[3], bare[0], false, &v);
  near(v.objective, without + 2 * 11 / 10.0, 1e-13, "J of a term over the unmodified pair's");
  near(v.term[0], 11, 1e-14, "J of a term in the unit of its key");
  objective.term[0].scale = 4;
  eo_objective_value(&objective, 3, load_case, state[0], bare[0], false, &v);
  near(v.objective, without + 2 * 1 / 4.0, 1e-13, "J of a term over a stated scale");
  objective.term[0].load_case = 0;
  eo_objective_value(&objective, 3, load_case, state[0], bare[0], false, &v);
  near(v.term[0], 0.2 * 5 + 0.5 * 1 + 0.3 * 5, 1e-14, "J of a term without a load case, the mean by share");
  objective.terms = 0;
  objective.limits = 1;
  objective.limit[0] = (struct eo_objective_limit){.output = output, .most = 4, .percent = NAN};
  eo_objective_value(&objective, 3, load_case, state[0], bare[0], false, &v);
  near(v.violation, 0.5, 1e-13, "violation of a limit of 4 where two load cases have 5 and one 1");
  objective.limit[0].load_case = 2;
  eo_objective_value(&objective, 3, load_case, state[0], bare[0], false, &v);
  near(v.violation, 0, 1e-13, "violation of the limit at the one load case that keeps it");
}

static void test_percentiles(void)
{
  static struct eo_design design;
  const struct eo_geometry geometry = {.rack_bottom = -1, .rack_top = 1};
  struct eo_objective_value v;
  design.objective = plain();
  design.load_cases = 3;
  for (int k = 0; k < 3; k++)
    design.load_case[k] = load_case[k];
  design.objective.robust = EO_ROBUST_MEAN;
  design.objective.scenarios = STATES;
  design.objective.terms = design.objective.limits = 1;
  int output = eo_scalar_find("order_1_um");
  design.objective.term[0] =
      (struct eo_objective_term){.output = output, .load_case = 2, .weight = 1, .scale = NAN, .percent = 90};
  design.objective.limit[0] = (struct eo_objective_limit){.output = output, .most = 8, .percent = 80};
  fill_states(output);
  double without = value_of(&(struct eo_objective){.weight = {0.4, 0.3, 0.3},
                                                   .contact_pressure = NAN,
                                                   .root_stress = NAN,
                                                   .peak_to_peak = NAN,
                                                   .edge_load_share = NAN,
                                                   .contact_loss = NAN,
                                                   .flank_safety = NAN,
                                                   .root_safety = NAN,
                                                   .film_ratio = NAN,
                                                   .contact_temperature = NAN},
                            after, false)
                       .objective;
  eo_evaluator_combine(&design, &geometry, state[0], bare[0], &v);
  near(v.objective, without + 10 / 10.0, 1e-13,
       "80 % of the pairs have 9 or less, and what is above the limit of 8 violates");
  near(v.term[0], 10, 1e-13, "J by a percentile in the unit of its key");
  near(v.violation, 9.0 / 8 - 1, 1e-13, "80 % of them are 9 or less, where 8 is the limit");
  design.objective.weight[0] = design.objective.weight[1] = design.objective.weight[2] = 0;
  eo_evaluator_combine(&design, &geometry, state[0], bare[0], &v);
  near(v.objective, 1, 1e-13, "J of a percentile alone");
  ok(isnan(v.nominal), "no nominal pair where no front asks for it");
}

int main(void)
{
  test_sums();
  test_objective();
  test_constraints();
  test_shortfall();
  test_no_worse();
  test_relief();
  test_failures();
  test_zero_baseline();
  test_terms();
  test_percentiles();
  return tap_done();
}
