/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Halves of unequal width as one pair: what each half is alone, which positions meet, how a held pinion shares the
   torque, and that all that follows is there. Closed-form compliance; the numbers are those of an independent
   computation (tests/cases/deviations.json, U4). */
#include "design/resolution.h"
#include "document/design_document.h"
#include "document/examples.h"
#include "evaluation/evaluator.h"
#include "flexibility/closed_form.h"
#include "support/tap.h"

#include <stdlib.h>
#include <string.h>

static struct eo_closed_form form = {1.5e-9, 12e-3, -0.8e-3, 20, 4000};

static void stop(const struct eo_error *error)
{
  printf("Bail out! %s: %s\n", error->pointer, error->text);
  exit(1);
}

/* Aligned, case A's flanks, 621, 828 and 1035 N m; rigid supports, so that a fixed pinion has one Z. */
static struct eo_design uneven_design(double right, int positions, int cells)
{
  struct eo_design design;
  eo_example_build("paper-case-a", &design);
  design.gear_pair.right_face_width = right;
  design.alignment.shaft_angle_in_plane = 0;
  design.alignment.pinion_axial = EO_AXIAL_FIXED;
  design.modification.flank[EO_PINION][EO_RIGHT].lead_crowning = 6e-6;
  design.resolution.positions = positions;
  design.resolution.te_harmonics = 0;
  design.resolution.cells_per_line = cells;
  design.resolution.tip_edge_contact = false;
  eo_supports_make_rigid(&design.supports);
  return design;
}

static struct eo_pair *prepare(struct eo_design *design, bool partial)
{
  struct eo_geometry geometry;
  struct eo_pair *pair = NULL;
  struct eo_error error = {0};
  struct eo_supports rigid = design->supports;
  if (eo_design_settle(design, &error) || eo_geometry_init(&geometry, &design->gear_pair, &error))
    stop(&error);
  eo_design_resolve(design, &geometry);
  for (int i = 0; i < 2; i++)
    design->supports.groove_torsional_stiffness[i] = rigid.groove_torsional_stiffness[i];
  struct eo_contact_grid_settings grid = eo_contact_grid_default(&design->resolution);
  grid.partial_cells = partial;
  const struct eo_pair_options options = {.kernel = {eo_closed_form_kernel, &form}, .grid = &grid};
  if (eo_pair_new(&pair, design, &options, NULL, &error))
    stop(&error);
  return pair;
}

static const struct eo_evaluation *evaluate(struct eo_pair *pair, const struct eo_design *design,
                                            struct eo_evaluator **evaluator)
{
  const struct eo_evaluation *evaluation = NULL;
  struct eo_error error = {0};
  if (eo_evaluator_new(evaluator, pair, design->load_cases, &error) ||
      eo_evaluator_run(*evaluator, design, NULL, EO_WANT_CURVES, &evaluation, &error))
    stop(&error);
  return evaluation;
}

static double mean(int n, const double *value)
{
  double sum = 0;
  for (int j = 0; j < n; j++)
    sum += value[j] / n;
  return sum;
}

static double swing(int n, const double *value)
{
  double low = INFINITY, high = -INFINITY;
  for (int j = 0; j < n; j++) {
    low = fmin(low, value[j]);
    high = fmax(high, value[j]);
  }
  return high - low;
}

/* 55 mm and 40 mm, the pinion fixed. */
static void test_published(void)
{
  static const double swings[3] = {0.58329, 0.66586, 0.73881}, means[3] = {11.31888, 13.73603, 15.99187},
                      left[3] = {6440.1, 8709.8, 11042.7}, right[3] = {6517.8, 8567.4, 10553.9},
                      pressure[2][3] = {{766.73, 829.59, 883.34}, {766.14, 831.14, 903.85}};
  struct eo_design design = uneven_design(40e-3, 64, 30);
  struct eo_pair *pair = prepare(&design, false);
  struct eo_evaluator *evaluator;
  const struct eo_evaluation *e = evaluate(pair, &design, &evaluator);
  double lag = pair->right->grid->position[0].phase - pair->grid->position[0].phase +
               pair->ahead[0] * pair->geometry.transverse_base_pitch / 64;
  close_to(1e3 * lag, -3.102075946542652, 1e-9, "stagger of the right half, mm of roll");
  for (int k = 0; k < 3; k++) {
    const struct eo_case_result *c = &e->load_case[k];
    near(1e6 * c->peak_to_peak, swings[k], 0.005, "PPLTE of halves of uneven width, um");
    near(1e6 * c->mean, means[k], 0.002, "mean LTE of halves of uneven width, um");
    near(mean(64, c->end[EO_LEFT].loaded.load), left[k], 0.003, "mean load of the wide half, N");
    near(mean(64, c->end[EO_RIGHT].loaded.load), right[k], 0.003, "mean load of the narrow half, N");
    for (int end = 0; end < 2; end++)
      near(1e-6 * c->end[end].max_pressure, pressure[end][k], 0.01, "largest pressure of a half, MPa");
  }
  eo_evaluator_free(evaluator);
  eo_pair_free(pair);
}

/* Floating, each half is what it is in a pair of two like it; the pair has the mean of both at their phases. */
static void test_each_half(void)
{
  enum { POSITIONS = 24 };
  struct eo_design design = uneven_design(40e-3, POSITIONS, 16), both = uneven_design(NAN, POSITIONS, 16);
  both.gear_pair.face_width = 40e-3;
  design.alignment.pinion_axial = both.alignment.pinion_axial = EO_AXIAL_FLOATING;
  struct eo_pair *pair = prepare(&design, true), *narrow = prepare(&both, true);
  struct eo_evaluator *evaluator[2];
  const struct eo_evaluation *e = evaluate(pair, &design, &evaluator[0]),
                             *other = evaluate(narrow, &both, &evaluator[1]);
  const struct eo_case_result *c = &e->load_case[1], *n = &other->load_case[1];
  const double *right = c->end[EO_RIGHT].loaded.approach;
  ok(!e->equal_ends && c->end[EO_LEFT].loaded.load[0] == c->end[EO_RIGHT].loaded.load[0],
     "each half of a floating pinion carries half");
  near(mean(POSITIONS, right), mean(POSITIONS, n->end[EO_RIGHT].loaded.approach), 1e-4, "mean Z of the narrow half, m");
  near(swing(POSITIONS, right), swing(POSITIONS, n->end[EO_RIGHT].loaded.approach), 0.05, "swing of the narrow half");
  near(c->end[EO_RIGHT].max_pressure, n->end[EO_RIGHT].max_pressure, 0.01, "pressure of the narrow half");
  near(c->end[EO_RIGHT].impact.force, n->end[EO_RIGHT].impact.force, 0.01, "entering impact of the narrow half");
  double worst = 0, normal = cos(pair->geometry.base_helix_angle);
  for (int j = 0; j < POSITIONS; j++) {
    int at = (j + pair->ahead[0] + POSITIONS) % POSITIONS;
    worst = fmax(worst, fabs(c->transmission[j] - (c->end[EO_LEFT].loaded.approach[j] + right[at]) / 2 / normal));
  }
  close_to(worst, 0, 1e-15, "transmission error of the pair, the mean at the phases that meet, m");
  ok(c->vibration.outcome != EO_VIBRATION_NOT_CONVERGED && c->vibration.rms_pair[0] > 0,
     "the pair of uneven halves vibrates with %.3g m/s2", c->vibration.rms_pair[0]);
  ok(design.supports.right_mass[0] < design.supports.mass[0] && design.supports.right_mass[0] > 0,
     "the narrow half of the pinion is lighter: %.4g and %.4g kg", design.supports.mass[0],
     design.supports.right_mass[0]);
  near(design.supports.right_mass[0], both.supports.mass[0], 1e-12, "mass of the narrow half, of its cylinder");
  for (int i = 0; i < 2; i++)
    eo_evaluator_free(evaluator[i]);
  eo_pair_free(pair);
  eo_pair_free(narrow);
}

/* On elastic bodies, turned round or with rated flanks: each has both halves. */
static void test_follows(void)
{
  struct eo_design design = uneven_design(48e-3, 16, 12);
  design.alignment.pinion_axial = EO_AXIAL_FLOATING;
  design.load_cases = 1;
  design.load_case[0].share = 1;
  struct eo_pair *pair = prepare(&design, true);
  struct eo_evaluator *evaluator;
  double stiff = evaluate(pair, &design, &evaluator)->load_case[0].mean;
  eo_evaluator_free(evaluator);
  design.shafts.enabled = true;
  const struct eo_evaluation *e = evaluate(pair, &design, &evaluator);
  ok(e->load_case[0].contact_failures == 0 && e->load_case[0].body_iterations > 0 && e->load_case[0].mean > stiff,
     "elastic bodies give more way: %.4g um, not %.4g um", 1e6 * e->load_case[0].mean, 1e6 * stiff);
  eo_evaluator_free(evaluator);
  design.shafts.enabled = false;
  design.load_case[0].flank = EO_COAST_FLANK;
  e = evaluate(pair, &design, &evaluator);
  ok(e->load_case[0].running.inwards && e->load_case[0].contact_failures == 0 && pair->ahead[1] == -pair->ahead[0],
     "the other half is ahead on the coast flanks: %d and %d positions", pair->ahead[0], pair->ahead[1]);
  eo_evaluator_free(evaluator);
  eo_pair_free(pair);
}

static void test_refusals(void)
{
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_error error = {0};
  eo_example_build("paper", &design);
  design.gear_pair.right_face_width = 55e-3;
  ok(!eo_design_complete(&design, &geometry, &error) && isnan(design.gear_pair.right_face_width),
     "a right half like the left one is not written");
  eo_example_build("single", &design);
  design.gear_pair.right_face_width = 20e-3;
  ok(eo_design_complete(&design, &geometry, &error) && strcmp(error.pointer, "/gear_pair/right_face_width_mm") == 0,
     "a pair with one end is refused a right half: %s", error.text);
}

int main(void)
{
  test_published();
  test_each_half();
  test_follows();
  test_refusals();
  return tap_done();
}
