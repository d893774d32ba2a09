/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pairs of which few are in full: percentiles against closed forms, and what is said to be open against what is. */
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/sort.h"
#include "base/random.h"
#include "support/tap.h"
#include "tolerance/pair_completion.h"
#include "tolerance/distribution.h"
#include "tolerance/output_report.h"
#include "tolerance/pair_sampler.h"
#include "tolerance/statistics.h"

enum { PAIRS = 1000, OUTPUTS = 2 };

static double x[PAIRS], coarse[PAIRS][OUTPUTS], output[PAIRS][OUTPUTS], all[PAIRS];
static bool full[PAIRS];

static struct eo_completion completion_of(uint64_t seed)
{
  return (struct eo_completion){PAIRS, OUTPUTS, coarse[0], output[0], full, seed};
}

/* Standard normal, evenly spread. */
static void draw(uint64_t seed)
{
  struct eo_sampler *sampler;
  struct eo_error error;
  eo_sampler_new(&sampler, EO_SAMPLING_SOBOL, 1, PAIRS, seed, &error);
  for (int i = 0; i < PAIRS; i++) {
    eo_sampler_at(sampler, i, &x[i]);
    x[i] = eo_normal_quantile(x[i]);
  }
  eo_sampler_free(sampler);
}

/* The first `rows` pairs are in full; value(i) of pair i. */
static void set(int rows, double (*value)(int), double (*coarsely)(int))
{
  for (int i = 0; i < PAIRS; i++) {
    full[i] = i < rows;
    all[i] = value(i);
    coarse[i][0] = coarse[i][1] = coarsely(i);
    output[i][0] = output[i][1] = full[i] ? all[i] : -1e9;
  }
}

static double percentile_of_all(double percent)
{
  double sorted[PAIRS];
  memcpy(sorted, all, sizeof sorted);
  eo_sort_numbers(PAIRS, sorted);
  return eo_percentile(PAIRS, sorted, percent);
}

static double linear(int i)
{
  return 3 + 2 * x[i];
}

static double linear_coarse(int i)
{
  return 1 - 0.7 * x[i];
}

/* The coarse numbers say everything, in another unit: the percentiles are those of a normal. */
static void test_linear(void)
{
  struct eo_error error;
  struct eo_completed completed;
  struct eo_doubt doubt;
  const struct eo_completion completion = completion_of(1);
  double worst = 0;
  draw(1);
  set(20, linear, linear_coarse);
  ok(eo_completion_fill(&completion, 0, &completed, &error) == EO_OK && completed.rows == 20,
     "20 rows are completed in full");
  for (int i = 0; i < PAIRS; i++)
    worst = fmax(worst, fabs(output[i][0] - all[i]));
  close_to(worst, 0, 1e-12, "error of completed rows of a linear relation");
  close_to(completed.error, 0, 1e-12, "stated error of completed rows of a linear relation");
  eo_completion_doubt(&completion, 0, 95, &doubt, NULL, &error);
  close_to(doubt.value, 3 + 2 * 1.6448536269514722, 0.02,
           "95 % of a normal distribution lies below the completed percentile");
  close_to(doubt.deviation, 0, 1e-12, "stated deviation of a percentile of which nothing is open");
  close_to(doubt.rows, PAIRS, 1e-9, "completed percentile over that of all in full");
  ok(output[PAIRS - 1][1] == -1e9, "another output is left alone");
}

static double noise[PAIRS];

static double noisy(int i)
{
  return x[i] + noise[i];
}

static double plain(int i)
{
  return x[i];
}

static double quadratic(int i)
{
  return x[i] * x[i];
}

static double size(int i)
{
  return fabs(x[i]);
}

/* What is beside the coarse numbers has a deviation of 0.3: of many draws, 95 % of all is as far off as is said, and
   the values spread as all do, which those on the line alone would not. */
static void test_noise(void)
{
  enum { DRAWS = 60 };
  struct eo_error error;
  struct eo_completed completed;
  struct eo_doubt doubt;
  double squares = 0, said = 0, spread = 0, beside = 0;
  int within = 0;
  for (int d = 0; d < DRAWS; d++) {
    const struct eo_completion completion = completion_of((uint64_t)d);
    draw((uint64_t)d + 1);
    for (int i = 0; i < PAIRS; i++)
      noise[i] = 0.3 * eo_random_normal(eo_random_at((uint64_t)d, 1, 2, (uint64_t)i), 0);
    set(64, noisy, plain);
    eo_completion_fill(&completion, 0, &completed, &error);
    eo_completion_doubt(&completion, 0, 95, &doubt, NULL, &error);
    double off = doubt.value - percentile_of_all(95), column[PAIRS];
    for (int i = 0; i < PAIRS; i++)
      column[i] = output[i][0];
    squares += off * off / DRAWS;
    said += doubt.deviation * doubt.deviation / DRAWS;
    spread += eo_summary_of(PAIRS, column).deviation / DRAWS;
    beside += completed.error / DRAWS;
    within += fabs(off) <= 2 * doubt.deviation;
  }
  ok(sqrt(squares) < 1.2 * sqrt(said) && sqrt(squares) > 0.4 * sqrt(said),
     "completed percentiles are off by %.3f and said to be by %.3f", sqrt(squares), sqrt(said));
  ok(within >= 0.9 * DRAWS, "%d of %d percentiles lie within twice what is said", within, DRAWS);
  close_to(spread, sqrt(1.09), 0.01, "deviation of the completed values");
  close_to(beside, 0.3, 0.02, "error of the coarse level against its rows in full");
}

/* Chi-square of one degree: the relation is bent, so the line is far off, but those nearest are not. */
static void test_quadratic(void)
{
  struct eo_error error;
  struct eo_completed completed;
  struct eo_doubt doubt;
  const struct eo_completion completion = completion_of(3);
  draw(5);
  set(128, quadratic, size);
  eo_completion_fill(&completion, 0, &completed, &error);
  eo_completion_doubt(&completion, 0, 95, &doubt, NULL, &error);
  ok(fabs(doubt.value - percentile_of_all(95)) <= 2 * doubt.deviation + 1e-12,
     "the completed 95 %% percentile is %.4f, of all %.4f, open %.4f", doubt.value, percentile_of_all(95),
     doubt.deviation);
  close_to(doubt.value, 3.841458820694124, 0.15, "95 % of a chi-square distribution lies below the percentile");
  eo_completion_doubt(&completion, 0, 50, &doubt, NULL, &error);
  close_to(doubt.value, 0.454936423119572, 0.03, "median of a chi-square distribution");
  eo_completion_share(&completion, 0, 3.841458820694124, &doubt, &error);
  ok(fabs(doubt.value - 0.95) < 0.01 && doubt.rows < PAIRS && doubt.rows > 100,
     "the share below a limit is %.3f, as of %.0f pairs", doubt.value, doubt.rows);
}

/* The interval of a report has in it what is open, and is that of the ranks when all are in full. */
static void test_report(void)
{
  struct eo_error error;
  struct eo_output_report report[3];
  struct eo_report_completion part = {.output = 0};
  const struct eo_completion completion = completion_of(7);
  draw(7);
  for (int rows = 64, k = 0; k < 2; k++, rows = PAIRS) {
    set(rows, noisy, plain);
    eo_completion_fill(&completion, 0, &part.completed, &error);
    part.completion = &completion;
    eo_output_report_make(&report[k], PAIRS, 1, x, output[0], OUTPUTS, NULL, 1, &part, &error);
  }
  eo_output_report_make(&report[2], PAIRS, 1, x, output[0], OUTPUTS, NULL, 1, NULL, &error);
  const struct eo_report_percentile *wide = &report[0].percentile[7], *narrow = &report[1].percentile[7],
                                    *ranked = &report[2].percentile[7];
  ok(report[0].full == 64 && report[1].full == PAIRS && report[2].full == PAIRS, "the pairs in full are counted");
  ok(wide->high - wide->low > 1.2 * (narrow->high - narrow->low), "64 in full leave more open than all");
  close_to(narrow->low, ranked->low, 1e-12, "lower end of the interval where all are in full, that of the ranks");
  close_to(narrow->high, ranked->high, 1e-12, "upper end of the interval where all are in full");
  ok(report[0].mean_interval[1] - report[0].mean_interval[0] > report[1].mean_interval[1] - report[1].mean_interval[0],
     "64 pairs in full leave more of the mean open than all");
  ok(report[0].largest < 64, "the largest pair is one in full");
  for (int k = 0; k < 3; k++)
    eo_output_report_done(&report[k]);
}

static void test_missing(void)
{
  struct eo_error error;
  struct eo_completed completed;
  struct eo_doubt doubt;
  const struct eo_completion completion = completion_of(1);
  draw(1);
  set(20, linear, linear_coarse);
  coarse[500][0] = NAN;
  output[3][0] = NAN;
  eo_completion_fill(&completion, 0, &completed, &error);
  ok(isnan(output[500][0]) && isnan(output[3][0]) && completed.rows == 19, "an output without a number is not made up");
  double before = output[700][0];
  output[700][0] = 0;
  eo_completion_fill(&completion, 0, &completed, &error);
  ok(output[700][0] == before, "a second completion gives the same");
  for (int i = 0; i < 20; i++)
    output[i][0] = NAN;
  eo_completion_fill(&completion, 0, &completed, &error);
  eo_completion_doubt(&completion, 0, 95, &doubt, NULL, &error);
  ok(completed.rows == 0 && isnan(completed.error) && isnan(output[700][0]) && isnan(doubt.value),
     "a completion without any pair in full gives nothing");
}

int main(void)
{
  test_linear();
  test_noise();
  test_quadratic();
  test_report();
  test_missing();
  return tap_done();
}
