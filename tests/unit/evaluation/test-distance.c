/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two gears at another centre distance than they are drawn for: closed forms of the involute, pairs prepared anew at
   that distance, pairs as made whose axes scatter. */
#include "document/examples.h"
#include "document/scatter_distance.h"
#include "document/tolerance_document.h"
#include "evaluation/evaluator.h"
#include "support/synthetic-pair.h"
#include "support/tap.h"

#include <string.h>

enum { POSITIONS = 24, PAIRS = 24 };
static const double APART = 60e-6;

static struct eo_design plain_design(void)
{
  struct eo_design design;
  eo_example_build("paper", &design);
  design.resolution.positions = POSITIONS;
  design.resolution.te_harmonics = 10;
  design.resolution.cells_per_line = 12;
  design.load_cases = 1;
  design.load_case[0].share = 1;
  design.tolerance.pairs = PAIRS;
  return design;
}

static struct eo_pair *prepare(struct eo_design *design)
{
  struct eo_geometry geometry;
  struct eo_error error;
  struct eo_pair *pair = NULL;
  const struct eo_pair_options options = {.kernel = {eo_closed_form_kernel, &form}};
  if (eo_design_complete(design, &geometry, &error) || eo_pair_new(&pair, design, &options, NULL, &error))
    stop(&error);
  return pair;
}

static struct eo_pair *set_apart(const struct eo_pair *pair, double deviation)
{
  struct eo_pair *apart;
  struct eo_error error;
  if (eo_pair_apart(&apart, pair, deviation, false, &error))
    stop(&error);
  return apart;
}

static double involute(double angle)
{
  return tan(angle) - angle;
}

/* By the textbook: cos(alpha') = cos(alpha) a/a'; g = sqrt(r_a^2 - r_b^2) over both members less a' sin(alpha'). */
static void test_geometry(const struct eo_pair *pair)
{
  const struct eo_geometry *drawn = &pair->geometry;
  struct eo_pair *apart = set_apart(pair, APART);
  const struct eo_geometry *moved = &apart->geometry;
  double a = drawn->centre_distance + APART, base = drawn->base_radius[0] + drawn->base_radius[1],
         alpha = acos(drawn->centre_distance / a * cos(drawn->working_pressure_angle)), path = -a * sin(alpha);
  for (int i = 0; i < 2; i++)
    path += sqrt(pow(drawn->tip_radius[i], 2) - pow(drawn->base_radius[i], 2));
  near(moved->working_pressure_angle, alpha, 1e-12, "working pressure angle at the larger distance");
  near(moved->transverse_contact_ratio, path / drawn->transverse_base_pitch, 1e-12, "contact ratio there");
  ok(moved->transverse_contact_ratio < drawn->transverse_contact_ratio - 0.005,
     "axes further apart mesh for less long");
  close_to(moved->normal_backlash - drawn->normal_backlash,
           2 * base * cos(drawn->base_helix_angle) * (involute(alpha) - involute(drawn->working_pressure_angle)), 1e-15,
           "what the distance adds to the backlash");
  near(moved->normal_backlash - drawn->normal_backlash,
       2 * APART * sin(drawn->working_pressure_angle) * cos(drawn->base_helix_angle), 2e-3,
       "to first order 2 da sin(alpha_wt) cos(beta_b)");
  near(moved->tip_clearance[0] - drawn->tip_clearance[0], APART, 1e-9, "the tip clearance grows as the distance does");
  ok(memcmp(moved->tip_radius, drawn->tip_radius, sizeof drawn->tip_radius) == 0 &&
         memcmp(moved->form_radius, drawn->form_radius, sizeof drawn->form_radius) == 0,
     "the gears stay what they are");
  eo_pair_free(apart);
}

static struct eo_gap_field *field_of(const struct eo_pair *pair, const struct eo_design *design, bool gear_too)
{
  static const struct eo_flank_modification none;
  struct eo_gap_field *field = malloc(sizeof *field);
  eo_gap_field_init(field, &pair->geometry, &design->modification.flank[EO_PINION][EO_LEFT],
                    gear_too ? &design->modification.flank[EO_GEAR][EO_LEFT] : &none, EO_LEFT, 0, 0, 0,
                    pair->grid->corner);
  return field;
}

/* Involutes gear at any distance; and what one member has beyond its involute opens the gap where its flank has it: to
   first order, since a steep profile turns the common normal, by less than a nanometre here. */
static void test_gap(void)
{
  static struct eo_design design;
  design = plain_design();
  struct eo_pair *pair = prepare(&design), *apart = set_apart(pair, APART);
  struct eo_gap_field *even_field = field_of(apart, &design, true);
  double most = 0, differs = 0, shift = apart->geometry.tangent_length[0] - pair->geometry.tangent_length[0];
  for (int i = 0; i <= 40; i++)
    most = fmax(most, fabs(eo_gap_field_at(even_field,
                                           apart->geometry.path_start +
                                               (apart->geometry.path_end - apart->geometry.path_start) * i / 40,
                                           1e-3, NULL, NULL)));
  ok(most < 1e-15, "unmodified rigid flanks have no transmission error at another distance (%.1e m)", most);
  struct eo_flank_modification *flank = &design.modification.flank[EO_PINION][EO_LEFT];
  *flank = (struct eo_flank_modification){.tip_relief = 20e-6,
                                          .tip_relief_start = 2e-3,
                                          .profile_slope = 8e-6,
                                          .profile_barrel = 6e-6,
                                          .twist = 5e-6,
                                          .shape = EO_RELIEF_LINEAR};
  struct eo_gap_field *drawn = field_of(pair, &design, false), *moved = field_of(apart, &design, false);
  for (int i = 0; i <= 40; i++) {
    double s = apart->geometry.path_start + (apart->geometry.path_end - apart->geometry.path_start) * (i + 0.3) / 42;
    differs = fmax(differs, fabs(eo_gap_field_at(moved, s, 4e-3, NULL, NULL) -
                                 eo_gap_field_at(drawn, s + shift, 4e-3, NULL, NULL)));
  }
  ok(fabs(shift) > 20e-6 && differs < 2e-9, "a pinion's flank opens the gap at its own places (%.1e m)", differs);
  free(even_field);
  free(drawn);
  free(moved);
  eo_pair_free(apart);
  eo_pair_free(pair);
}

static struct eo_evaluation *run(const struct eo_pair *pair, const struct eo_design *design,
                                 struct eo_evaluator **evaluator)
{
  const struct eo_evaluation *evaluation = NULL;
  struct eo_error error;
  if (eo_evaluator_new(evaluator, pair, design->load_cases, &error) ||
      eo_evaluator_run(*evaluator, design, NULL, 0, &evaluation, &error))
    stop(&error);
  return (struct eo_evaluation *)evaluation;
}

/* The same gears in a design of its own that is drawn for the other distance: a relief that is stated by a diameter is
   the same cut there. */
static void test_prepared_anew(void)
{
  static const char *const keys[] = {"peak_to_peak_um", "mean_um", "max_pressure_MPa", "impact_N", "rms_m_per_s2"};
  static struct eo_design design, other;
  design = plain_design();
  struct eo_pair *pair = prepare(&design);
  for (int member = 0; member < 2; member++)
    for (int end = 0; end < 2; end++) {
      struct eo_flank_modification *flank = &design.modification.flank[member][end];
      *flank = (struct eo_flank_modification){
          .tip_relief = 12e-6, .shape = EO_RELIEF_LINEAR, .helix_slope = 4e-6, .lead_crowning = 5e-6};
      flank->place[EO_TIP_SIDE].diameter = 2 * pair->geometry.tip_radius[member] - 1.2e-3;
    }
  for (int sign = -1; sign < 2; sign += 2) {
    struct eo_evaluator *own, *anew;
    other = design;
    other.gear_pair.centre_distance += sign * APART;
    struct eo_pair *apart = set_apart(pair, sign * APART), *drawn = prepare(&other);
    memcpy(drawn->impact.inertia, pair->impact.inertia, sizeof pair->impact.inertia); /* the bodies are the same */
    const struct eo_evaluation *there = run(apart, &design, &own), *expected = run(drawn, &other, &anew);
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
      const struct eo_scalar *scalar = eo_scalar_at(eo_scalar_find(keys[i]));
      char label[100];
      snprintf(label, sizeof label, "%s with the axes %+.0f um apart, against a pair drawn for that", keys[i],
               sign * 1e6 * APART);
      near(eo_scalar_value(scalar, there, 0), eo_scalar_value(scalar, expected, 0), 1e-6, label);
    }
    eo_evaluator_free(own);
    eo_evaluator_free(anew);
    eo_pair_free(apart);
    eo_pair_free(drawn);
  }
  eo_pair_free(pair);
}

static struct eo_scatter scatter;

static void draw(struct eo_scatter_run *result, const struct eo_pair *pair, const struct eo_design *design, int threads)
{
  struct eo_error error;
  struct eo_scatter_plan plan = eo_tolerance_plan(&design->tolerance);
  plan.threads = threads;
  if (eo_scatter_of_design(&scatter, design, true, NULL, &error) ||
      eo_scatter_run_pairs(result, pair, design, &scatter, &plan, NULL, &error))
    stop(&error);
}

static bool same_rows(const struct eo_scatter_run *a, const struct eo_scatter_run *b)
{
  return memcmp(a->output, b->output, sizeof *a->output * (size_t)a->pairs * (size_t)a->outputs) == 0;
}

/* Rows of pairs whose axes scatter beside designs that state the drawn deviation. */
static void test_scatter(void)
{
  static struct eo_design design, made;
  struct eo_scatter_run one, two;
  design = plain_design();
  design.tolerance.centre_distance = true;
  struct eo_pair *pair = prepare(&design);
  draw(&one, pair, &design, 1);
  draw(&two, pair, &design, 2);
  int input = scatter.inputs - 1, steps = 0, swing = eo_scalar_find("peak_to_peak_um");
  double step = eo_scatter_distance_step(&scatter), allowance = 1e6 * design.gear_pair.centre_distance_allowance,
         off = 0, most = 0, largest = 0, least = INFINITY;
  ok(same_rows(&one, &two), "two threads give the bytes of one");
  near(step * EO_SCATTER_DISTANCE_STEPS, 2 * allowance, 1e-12, "steps divide the allowance both ways");
  for (int i = 0; i < PAIRS; i++) {
    double drawn = one.input[i * one.inputs + input], value = one.output[i * one.outputs + swing];
    steps += fabs(drawn / step - round(drawn / step)) < 1e-9;
    most = fmax(most, fabs(drawn));
    largest = fmax(largest, value);
    least = fmin(least, value);
    made = design;
    made.alignment.centre_distance_deviation = 1e-6 * drawn;
    struct eo_evaluator *evaluator;
    struct eo_pair *own = prepare(&made);
    off = fmax(off, fabs(eo_scalar_value(eo_scalar_at(swing), run(own, &made, &evaluator), 0) - value));
    eo_evaluator_free(evaluator);
    eo_pair_free(own);
  }
  ok(steps == PAIRS && most > 0.7 * allowance && most <= allowance * (1 + 1e-9),
     "%d pairs stand on the steps, %.1f um "
     "at most",
     steps, most);
  ok(off == 0, "every row is that of a pair prepared at its own distance (%.1e um)", off);
  ok(largest - least > 1e-4, "and they differ, by %.4f um", largest - least);
  eo_scatter_run_done(&one);
  eo_scatter_run_done(&two);
  eo_pair_free(pair);
}

/* The worst pair as a design gives the number it has in the run. */
static void test_worst(void)
{
  static struct eo_design design;
  struct eo_scatter_run result;
  struct eo_tolerance_report *report;
  struct eo_error error;
  struct eo_evaluator *evaluator;
  int swing = eo_scalar_find("peak_to_peak_um");
  design = plain_design();
  design.name[0] = '\0';
  design.tolerance.centre_distance = true;
  struct eo_pair *pair = prepare(&design);
  draw(&result, pair, &design, 2);
  if (eo_tolerance_report_new(&report, &design, &scatter, &result, false, NULL, &error))
    stop(&error);
  struct eo_design *worst = &report->worst_design;
  ok(worst->alignment.centre_distance_deviation != 0 && !eo_pair_serves(pair, worst),
     "the worst pair has its distance, %.2f um off, and asks for a pair of its own",
     1e6 * worst->alignment.centre_distance_deviation);
  char name[60];
  snprintf(name, sizeof name, "Pair %d as made", report->worst + 1);
  ok(strcmp(worst->name, name) == 0, "of a design without a name it is called %s", worst->name);
  struct eo_pair *own = prepare(worst);
  near(eo_scalar_value(eo_scalar_at(swing), run(own, worst, &evaluator), 0),
       result.output[report->worst * result.outputs + swing], 1e-6, "opened as a design it has its number");
  eo_evaluator_free(evaluator);
  eo_pair_free(own);
  eo_tolerance_report_free(report);
  eo_scatter_run_done(&result);
  eo_pair_free(pair);
}

static void add_row(struct eo_design *design, int kind, double sigma, double low, double high)
{
  struct eo_scatter_row *row = &design->tolerance.row[design->tolerance.rows++];
  *row = (struct eo_scatter_row){.kind = kind, .sigma = sigma, .cut = NAN, .low = low, .high = high};
  snprintf(row->key, sizeof row->key, "alignment.centre_distance_deviation_um");
}

static bool refused(struct eo_design *design, const char *pointer, const char *word)
{
  struct eo_geometry geometry;
  struct eo_error error = {0};
  enum eo_code code = eo_design_complete(design, &geometry, &error);
  if (!code)
    code = eo_scatter_of_design(&scatter, design, true, NULL, &error);
  return code == EO_ERROR_INPUT && strcmp(error.pointer, pointer) == 0 && strstr(error.text, word);
}

static void test_refusals(void)
{
  static struct eo_design design;
  design = plain_design();
  add_row(&design, EO_SCATTER_UNIFORM, 0, -400, 0);
  ok(refused(&design, "/tolerance/inputs/0/key", "jam"), "a distance at which the teeth jam");
  design = plain_design();
  add_row(&design, EO_SCATTER_FIXED_SUM, 3, 0, 0);
  snprintf(design.tolerance.row[0].group, sizeof design.tolerance.row[0].group, "a");
  ok(refused(&design, "/tolerance/inputs/0/distribution", "keeps no sum"), "a fixed sum of a number drawn in steps");
  design = plain_design();
  add_row(&design, EO_SCATTER_NORMAL, 3, 0, 0);
  design.objective.robust = EO_ROBUST_MEAN;
  design.objective.scatter_pairs = 4;
  ok(refused(&design, "/tolerance/inputs/0/key", "a search evaluates every design at one centre distance"),
     "a robust search at many distances");
  design = plain_design();
  design.alignment.centre_distance_deviation = -400e-6;
  struct eo_geometry geometry;
  struct eo_pair *pair;
  struct eo_error error = {0};
  const struct eo_pair_options options = {.kernel = {eo_closed_form_kernel, &form}};
  eo_design_complete(&design, &geometry, &error);
  ok(eo_pair_new(&pair, &design, &options, NULL, &error) == EO_ERROR_INPUT &&
         strcmp(error.pointer, "/alignment/centre_distance_deviation_um") == 0 && strstr(error.text, "jam"),
     "a design whose axes stand so close is told so");
}

int main(void)
{
  static struct eo_design design;
  design = plain_design();
  form.linear = form.quadratic = 0; /* the same all over a flank: it does not tell where the pitch point is */
  struct eo_pair *pair = prepare(&design);
  test_geometry(pair);
  eo_pair_free(pair);
  test_gap();
  test_prepared_anew();
  test_scatter();
  test_worst();
  test_refusals();
  return tap_done();
}
