/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pairs as made with teeth of their own: teeth alike leave the numbers of one mesh cycle, what an eccentricity and a
   drawn pattern do to the shaft orders in closed form, factors, the worst pair as a design, many pairs with few in
   full, what a search draws. */
#include "design/made_teeth.h"
#include "document/examples.h"
#include "document/tolerance_document.h"
#include "evaluation/analysis.h"
#include "evaluation/scatter_levels.h"
#include "support/synthetic-pair.h"
#include "support/tap.h"

#include <complex.h>
#include <stdlib.h>
#include <string.h>

enum { POSITIONS = 32, PINION = 18, GEAR = 45, PAIRS = 5 }; /* meet again after 90 mesh cycles */

static struct eo_pair *pair;

/* Aligned, one load case; nothing scatters yet. */
static struct eo_design plain_design(void)
{
  struct eo_design design;
  eo_example_build("paper-case-a", &design);
  design.gear_pair.teeth[EO_PINION] = PINION;
  design.gear_pair.teeth[EO_GEAR] = GEAR;
  design.alignment.shaft_angle_in_plane = 0;
  design.resolution.positions = POSITIONS;
  design.resolution.te_harmonics = 10;
  design.resolution.cells_per_line = 12;
  design.load_cases = 1;
  design.load_case[0].torque = 828;
  design.load_case[0].share = 1;
  design.tolerance.single_teeth = true;
  design.tolerance.pairs = PAIRS;
  return design;
}

static void add_row(struct eo_design *design, const char *key, int kind, double sigma, double low, double high)
{
  struct eo_scatter_row *row = &design->tolerance.row[design->tolerance.rows++];
  *row = (struct eo_scatter_row){.kind = kind, .sigma = sigma, .cut = NAN, .low = low, .high = high};
  snprintf(row->key, sizeof row->key, "%s", key);
}

struct made {
  struct eo_design design;
  struct eo_scatter scatter;
  struct eo_scatter_run run;
};

static void complete(struct made *made)
{
  struct eo_geometry geometry;
  struct eo_error error;
  if (eo_design_complete(&made->design, &geometry, &error) ||
      eo_scatter_of_design(&made->scatter, &made->design, true, NULL, &error))
    stop(&error);
}

static void run(struct made *made)
{
  struct eo_error error;
  complete(made);
  const struct eo_scatter_plan plan = eo_tolerance_plan(&made->design.tolerance);
  if (eo_scatter_run_pairs(&made->run, pair, &made->design, &made->scatter, &plan, NULL, &error))
    stop(&error);
}

static double input_of(const struct made *made, int row, const char *key)
{
  for (int i = 0; i < made->scatter.inputs; i++)
    if (strcmp(made->scatter.input[i].key, key) == 0)
      return made->run.input[row * made->run.inputs + i];
  return NAN;
}

/* row -1: of the design itself */
static double number(const struct made *made, int row, const char *key)
{
  const double *numbers = row < 0 ? made->run.nominal : made->run.output + row * made->run.outputs;
  return numbers[eo_scalar_find(key) * made->run.cases];
}

/* The pinion's shaft order is e, less what the pairs in contact average of 18 teeth; and alike teeth have none. */
static void test_eccentricity(void)
{
  static struct made made;
  made.design = plain_design();
  add_row(&made.design, "pitch.*.tolerance_share", EO_SCATTER_NORMAL, 0, 0, 0);
  add_row(&made.design, "pitch.pinion.eccentricity_um", EO_SCATTER_UNIFORM, 0, 0, 4);
  run(&made);
  close_to(number(&made, -1, "period_peak_to_peak_um"), number(&made, -1, "peak_to_peak_um"), 1e-6,
           "swing of teeth alike against that of one cycle");
  close_to(number(&made, -1, "period_rms_m_per_s2") / number(&made, -1, "rms_m_per_s2"), 1, 0.02,
           "RMS of teeth alike, by steps in time");
  ok(number(&made, -1, "pinion_order_um") < 1e-9 && number(&made, -1, "gear_order_um") < 1e-9 &&
         number(&made, -1, "sideband_um") < 1e-9,
     "teeth alike have no shaft orders");
  double largest = 0, least = INFINITY;
  for (int i = 0; i < PAIRS; i++) {
    double e = input_of(&made, i, "pitch.pinion.eccentricity_um"), ratio = number(&made, i, "pinion_order_um") / e;
    largest = fmax(largest, ratio);
    least = fmin(least, ratio);
    ok(e > 0 && number(&made, i, "period_peak_to_peak_um") > number(&made, i, "peak_to_peak_um") + e,
       "%.3f um of eccentricity are seen over the period", e);
  }
  ok(largest < 0.988 && least > 0.982, "order 1 over the eccentricity is %.4f to %.4f, as the mesh averages to 0.985",
     least, largest);
  eo_scatter_run_done(&made.run);
}

/* First order of the mean of both hands' tables of a pair, drawn here once more. */
static double order_of_teeth(const struct made *made, int row, int member)
{
  static const char *const share_key[2] = {"pitch.pinion.tolerance_share", "pitch.gear.tolerance_share"},
                           *const seed_key[2] = {"pitch.pinion.seed", "pitch.gear.seed"};
  const struct eo_pitch_member own = {.tolerance_class = made->design.tolerance.grade, .edition = EO_ISO1328_2013};
  struct eo_flank_tolerance tolerance;
  struct eo_error error;
  double complex sum = 0;
  int teeth = member ? GEAR : PINION;
  if (eo_pitch_tolerance(&tolerance, &own, &pair->geometry, member, &error))
    stop(&error);
  for (int end = 0; end < 2; end++) {
    double index[GEAR];
    eo_pitch_draw(&tolerance, input_of(made, row, share_key[member]), teeth,
                  (uint64_t)input_of(made, row, seed_key[member]), (uint64_t)(2 * member + end), index);
    for (int i = 0; i < teeth; i++)
      sum += index[i] / 2 * cexp(-2 * M_PI * I * i / teeth);
  }
  return 2e6 * cabs(sum) / teeth * cos(pair->geometry.transverse_pressure_angle);
}

/* Every pair has its own teeth: small deviations add up, so that its shaft orders are those of its tables. */
static void test_patterns(void)
{
  static const double averaged[2] = {0.985, 0.998}; /* deviations of 17 and 44 teeth: 0.984, 0.998 */
  static struct made made;
  static const char *const key[2] = {"pinion_order_um", "gear_order_um"};
  made.design = plain_design();
  made.design.tolerance.grade = 1;
  add_row(&made.design, "pitch.*.tolerance_share", EO_SCATTER_UNIFORM, 0, 0.5, 1);
  run(&made);
  for (int i = 0; i < PAIRS; i++) {
    bool alone = true;
    for (int j = 0; j < i; j++)
      alone = alone && input_of(&made, i, "pitch.gear.seed") != input_of(&made, j, "pitch.gear.seed");
    ok(alone, "pair %d has teeth of its own, seed %.0f", i + 1, input_of(&made, i, "pitch.gear.seed"));
    for (int member = 0; member < 2; member++)
      close_to(number(&made, i, key[member]) / order_of_teeth(&made, i, member), averaged[member], 0.004, key[member]);
  }
  eo_scatter_run_done(&made.run);
}

/* Teeth alike under factors: the hunting period is that of the pair with its compliance at its speed. */
static void test_factors(void)
{
  static struct made made;
  made.design = plain_design();
  add_row(&made.design, "pitch.*.tolerance_share", EO_SCATTER_NORMAL, 0, 0, 0);
  add_row(&made.design, "compliance_factor", EO_SCATTER_UNIFORM, 0, 0.2, 0.3);
  add_row(&made.design, "speed_factor", EO_SCATTER_UNIFORM, 0, -0.2, -0.1);
  run(&made);
  for (int i = 0; i < PAIRS; i++) {
    close_to(number(&made, i, "period_peak_to_peak_um"), number(&made, i, "peak_to_peak_um"), 1e-6,
             "swing over the period at another compliance");
    close_to(number(&made, i, "period_rms_m_per_s2") / number(&made, i, "rms_m_per_s2"), 1, 0.02,
             "RMS over the period at another speed");
  }
  ok(fabs(number(&made, 0, "peak_to_peak_um") - number(&made, -1, "peak_to_peak_um")) > 0.01,
     "the numbers of another speed are not those of the design");
  eo_scatter_run_done(&made.run);
}

/* The worst pair is a design with these teeth. */
static void test_worst(void)
{
  static struct made made;
  struct eo_tolerance_report *report;
  struct eo_analysis *analysis = NULL;
  struct eo_geometry geometry;
  struct eo_error error;
  made.design = plain_design();
  made.design.tolerance.preset = EO_SCATTER_ISO_CLASS;
  made.design.tolerance.vibration = false;
  made.design.tolerance.pairs = 24;
  run(&made);
  if (eo_tolerance_report_new(&report, &made.design, &made.scatter, &made.run, false, NULL, &error))
    stop(&error);
  struct eo_design worst = report->worst_design;
  json_t *document = eo_design_encode(&worst);
  struct eo_design read;
  struct eo_faults faults = {0};
  ok(strcmp(report->worst_of, "period_peak_to_peak_um") == 0 && document &&
         eo_design_decode(document, &read, NULL, &faults) && read.pitch.stated,
     "the worst pair by its hunting period is a document with teeth");
  if (eo_design_complete(&read, &geometry, &error) || eo_analysis_new(&analysis, pair, &error) ||
      eo_analysis_run(analysis, &read, EO_WANT_PITCH, &error))
    stop(&error);
  close_to(1e6 * analysis->pitch.load_case[0].peak_to_peak, number(&made, report->worst, "period_peak_to_peak_um"),
           1e-4, "swing of the worst pair alone against that in the analysis");
  const struct eo_output_report *found = NULL;
  for (int i = 0; i < report->outputs; i++)
    if (strcmp(report->output[i].scalar->key, "period_peak_to_peak_um") == 0)
      found = &report->output[i].report;
  ok(found && found->inputs == made.scatter.inputs - 2 && isfinite(found->r2),
     "the seeds decide nothing and are left out: %d of %d inputs", found ? found->inputs : 0, made.scatter.inputs);
  ok(isnan(number(&made, 0, "period_rms_m_per_s2")) && isfinite(number(&made, 0, "tooth_load_N")),
     "no vibration is made where it is not asked for");
  json_decref(document);
  eo_analysis_free(analysis);
  eo_tolerance_report_free(report);
  eo_scatter_run_done(&made.run);
}

/* Rows of a run before. */
static bool find_row(void *context, int row, double *output)
{
  const struct made *before = context;
  size_t outputs = (size_t)before->run.outputs;
  if (before->run.full[row])
    memcpy(output, before->run.output + (size_t)row * outputs, sizeof *output * outputs);
  return before->run.full[row];
}

static void run_as(struct made *made, int method, int threads, struct made *before)
{
  struct eo_error error;
  made->design.tolerance.method = method;
  complete(made);
  struct eo_scatter_plan plan = eo_tolerance_plan(&made->design.tolerance);
  plan.threads = threads;
  if (before)
    plan.log = (struct eo_scatter_log){.find = find_row, .context = before};
  if (eo_scatter_run_pairs(&made->run, pair, &made->design, &made->scatter, &plan, NULL, &error))
    stop(&error);
}

/* The largest difference from pairs whose contact is solved at every instant, over the number. */
static double off_solved(const struct made *few, const struct made *solved, const char *key)
{
  double off = 0;
  for (int row = 0; row < solved->run.pairs; row++)
    off = fmax(off, fabs(number(few, row, key) / number(solved, row, key) - 1));
  return off;
}

/* Pairs in full among many, whose contact is followed, beside the same pairs with every instant solved. */
static void test_followed(const struct made *few)
{
  static const struct {
    const char *key;
    double most;
  } numbers[] = {{"period_peak_to_peak_um", 1e-3}, {"pinion_order_um", 1e-4},
                 {"gear_order_um", 1e-4},          {"sideband_um", 0.01},
                 {"tooth_load_N", 2e-3},           {"tooth_pressure_MPa", 5e-3},
                 {"period_rms_m_per_s2", 0.02},    {"peak_to_peak_um", 1e-12}};
  static struct made solved;
  solved.design = few->design;
  solved.design.tolerance.pairs = PAIRS;
  run(&solved);
  bool full = true;
  for (int row = 0; row < PAIRS; row++)
    full = full && few->run.full[row];
  ok(full && memcmp(few->run.input, solved.run.input, sizeof(double) * PAIRS * (size_t)few->run.inputs) == 0,
     "the first pairs are in full, and the same in fewer");
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
    double off = off_solved(few, &solved, numbers[i].key);
    ok(off < numbers[i].most, "%s of contact that is followed is %.2g of that solved at every instant off",
       numbers[i].key, off);
  }
  ok(off_solved(few, &solved, "period_rms_m_per_s2") > 1e-9,
     "contact that is followed gives other bytes than solved contact");
  eo_scatter_run_done(&solved.run);
}

/* Many pairs coarsely, few in full: how far the coarse ones are off, whatever the threads and what was known before. */
static void test_coarse_first(void)
{
  enum { MANY = 64 };
  static const struct {
    const char *key;
    double most; /* error over the largest value */
  } numbers[] = {{"period_peak_to_peak_um", 0.01}, {"pinion_order_um", 0.005},   {"gear_order_um", 0.005},
                 {"tooth_load_N", 0.02},           {"tooth_pressure_MPa", 0.04}, {"period_rms_m_per_s2", 0.08}};
  static struct made few, again;
  few.design = plain_design();
  few.design.tolerance.preset = EO_SCATTER_ISO_CLASS;
  few.design.tolerance.pairs = MANY;
  again.design = few.design;
  run_as(&few, EO_SCATTER_COARSE_FIRST, 2, NULL);
  run_as(&again, EO_SCATTER_AUTO, 3, &few);
  int full = eo_scatter_full_pairs(&few.run), worst = 0, swing = eo_scalar_find(numbers[0].key);
  ok(few.run.coarse && full >= 16 && full < MANY / 2 + 8, "%d of %d pairs are in full", full, MANY);
  ok(memcmp(few.run.output, again.run.output, sizeof(double) * MANY * (size_t)few.run.outputs) == 0,
     "the bytes are the same with 3 threads, where nothing is asked for, and with rows from before");
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
    int output = eo_scalar_find(numbers[i].key);
    double largest = 0, least = INFINITY;
    for (int row = 0; row < MANY; row++) {
      largest = fmax(largest, few.run.output[row * few.run.outputs + output]);
      least = fmin(least, few.run.output[row * few.run.outputs + output]);
    }
    ok(few.run.completed[output].error < numbers[i].most * largest && largest > 1.05 * least,
       "few solutions leave %.3g of %s open, which is %.4g .. %.4g", few.run.completed[output].error, numbers[i].key,
       least, largest);
  }
  for (int i = 0; i < MANY; i++)
    worst = few.run.output[i * few.run.outputs + swing] > few.run.output[worst * few.run.outputs + swing] ? i : worst;
  ok(few.run.full[worst], "the pair with the largest swing, %d, is one of them", worst + 1);
  test_followed(&few);
  few.design.alignment.pinion_axial = EO_AXIAL_FIXED;
  ok(!eo_scatter_is_coarse_first(&few.design), "a pinion that is held has all in full");
  eo_scatter_run_done(&few.run);
  eo_scatter_run_done(&again.run);
}

/* A search does not turn the gears round: its pairs are those that it has without single teeth. */
static void test_search(void)
{
  static struct made with, without;
  with.design = plain_design();
  with.design.tolerance.preset = EO_SCATTER_ISO_CLASS;
  with.design.objective.robust = EO_ROBUST_WORST;
  with.design.objective.scatter_pairs = 4;
  without.design = with.design;
  without.design.tolerance.single_teeth = false;
  add_row(&with.design, "pitch.*.tolerance_share", EO_SCATTER_UNIFORM, 0, 0.5, 1);
  complete(&with);
  complete(&without);
  ok(with.design.drawn.inputs > 0 && memcmp(&with.design.drawn, &without.design.drawn, sizeof with.design.drawn) == 0,
     "a robust search draws %d inputs, without teeth", with.design.drawn.inputs);
  ok(with.scatter.inputs == without.scatter.inputs + 4 && eo_scatter_outputs(&without.design) == EO_SCALARS,
     "the analysis draws share and seed of both members");
}

static bool refused(struct eo_design design, const char *pointer, const char *word)
{
  static struct eo_scatter scatter;
  struct eo_geometry geometry;
  struct eo_error error = {0};
  enum eo_code code = eo_design_complete(&design, &geometry, &error);
  if (!code)
    code = eo_scatter_of_design(&scatter, &design, true, NULL, &error);
  if (!code)
    code = eo_tolerance_check_limits(&design, &error);
  return code == EO_ERROR_INPUT && strcmp(error.pointer, pointer) == 0 && strstr(error.text, word);
}

static void test_refusals(void)
{
  struct eo_design design = plain_design();
  add_row(&design, "pitch.pinion.eccentricity_mm", EO_SCATTER_NORMAL, 1, 0, 0);
  ok(refused(design, "/tolerance/inputs/0/key", "no such number"), "a key that is none");
  design = plain_design();
  design.tolerance.single_teeth = false;
  add_row(&design, "pitch.pinion.eccentricity_um", EO_SCATTER_NORMAL, 1, 0, 0);
  ok(refused(design, "/tolerance/inputs/0/key", "single_teeth"), "teeth that were not asked for");
  design = plain_design();
  design.tolerance.grade = 12;
  add_row(&design, "compliance_factor", EO_SCATTER_NORMAL, 0.1, 0, 0);
  ok(refused(design, "/tolerance/class", "12"), "a class that ISO 1328-1:2013 does not have");
  design = plain_design();
  design.tolerance.single_teeth = false;
  design.tolerance.limits = 1;
  design.tolerance.limit[0] = (struct eo_tolerance_limit){.output = "tooth_load_N", .most = 1};
  ok(refused(design, "/tolerance/limits/0/output", "single_teeth"), "a limit on what is not computed");
}

int main(void)
{
  struct eo_design design = plain_design();
  struct eo_geometry geometry;
  struct eo_error error;
  struct eo_pair_options options = {.kernel = {eo_closed_form_kernel, &form}};
  if (eo_design_complete(&design, &geometry, &error) || eo_pair_new(&pair, &design, &options, NULL, &error))
    stop(&error);
  test_eccentricity();
  test_patterns();
  test_factors();
  test_worst();
  test_coarse_first();
  test_search();
  test_refusals();
  eo_pair_free(pair);
  return tap_done();
}
