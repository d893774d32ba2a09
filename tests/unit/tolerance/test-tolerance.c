/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Distributions, evenly spread points, statistics, influences and surfaces against closed forms and published numbers.
 */
#include <stdbool.h>
#include <string.h>

#include "support/tap.h"
#include "tolerance/distribution.h"
#include "tolerance/influence.h"
#include "tolerance/interval.h"
#include "tolerance/pair_sampler.h"
#include "tolerance/scatter.h"
#include "tolerance/sobol_sequence.h"
#include "tolerance/statistics.h"
#include "tolerance/response_surface.h"

static void test_normal(void)
{
  double worst = 0;
  for (int i = 1; i < 2000; i++)
    worst = fmax(worst, fabs(eo_normal_probability(eo_normal_quantile(i / 2000.)) - i / 2000.));
  close_to(worst, 0, 2e-15, "probability of a quantile");
  close_to(eo_normal_quantile(0.975), 1.959963984540054, 1e-14, "quantile of 97.5 %");
  close_to(eo_normal_quantile(1e-12), -7.034483825301131, 1e-11, "quantile of 1e-12, far in the tail");
}

/* Moments against the quantile function, by the midpoint rule. */
static void test_moments(const struct eo_distribution *d, double within, const char *what)
{
  enum { STEPS = 200000 };
  struct eo_moments m = eo_distribution_moments(d);
  double sum[5] = {0};
  for (int i = 0; i < STEPS; i++) {
    double z = (eo_distribution_quantile(d, (i + 0.5) / STEPS) - m.mean) / m.deviation;
    for (int k = 1; k < 5; k++)
      sum[k] += pow(z, k) / STEPS;
  }
  ok(fabs(sum[1]) < within && fabs(sum[2] - 1) < within && fabs(sum[3] - m.third) < 10 * within &&
         fabs(sum[4] - m.fourth) < 10 * within,
     "%s: the moments are %.6g %.6g %.6g, the kurtosis %.6g", what, sum[1], sum[2], sum[3], m.fourth);
}

/* |z|: mean sqrt(2/pi), variance 1 - 2/pi, skewness and kurtosis of the half normal distribution. */
static void test_half_normal(void)
{
  const struct eo_distribution whole = {.kind = EO_DISTRIBUTION_HALF_NORMAL, .mean = 1, .sigma = 2, .cut = INFINITY};
  struct eo_distribution cut = whole;
  struct eo_moments moments = eo_distribution_moments(&whole);
  close_to(moments.mean, 1 + 2 * sqrt(2 / M_PI), 1e-12, "mean of a half normal");
  close_to(moments.deviation, 2 * sqrt(1 - 2 / M_PI), 1e-12, "deviation of a half normal");
  close_to(moments.third, 0.99527174643115, 1e-9, "skewness of a half normal");
  close_to(moments.fourth, 3.86917730362, 1e-9, "kurtosis of a half normal");
  close_to(eo_distribution_quantile(&whole, 0.5), 1 + 2 * 0.674489750196082, 1e-9, "median of a half normal");
  cut.cut = 2;
  test_moments(&cut, 1e-6, "half normal, cut at 2 sigma");
  ok(eo_distribution_quantile(&cut, 1e-9) >= 1 && eo_distribution_quantile(&cut, 1 - 1e-9) <= 5,
     "sizes of a cut half normal go from 0 to the cut");
}

static void test_distributions(void)
{
  const double value[] = {1, 2, 2, 7};
  test_moments(&(struct eo_distribution){.mean = 3, .sigma = 2, .cut = INFINITY}, 1e-4, "normal");
  test_moments(&(struct eo_distribution){.mean = -1, .sigma = 0.5, .cut = 2.5}, 1e-6, "cut at 2.5 sigma");
  test_moments(&(struct eo_distribution){.kind = EO_DISTRIBUTION_UNIFORM, .low = -2, .high = 5}, 1e-6, "uniform");
  test_moments(&(struct eo_distribution){.kind = EO_DISTRIBUTION_LIST, .values = 4, .value = value}, 1e-9, "list");
  close_to(eo_distribution_moments(&(struct eo_distribution){.sigma = 1, .cut = 2.5}).deviation, 0.954597, 5e-7,
           "deviation left by a cut at 2.5 sigma");
}

/* The leading 2^k points have one in each 2^k-th of every dimension, and the first two dimensions are a net. */
static void test_sequence(void)
{
  enum { DIMENSIONS = 96, POINTS = 256, SIDE = 16 };
  struct eo_sobol_sequence sequence;
  struct eo_error error;
  bool filled = true;
  int box[SIDE][SIDE] = {{0}};
  ok(eo_sobol_sequence_init(&sequence, DIMENSIONS, &error) == EO_OK, "a sequence of 96 dimensions is made");
  for (int d = 0; d < DIMENSIONS; d++) {
    bool seen[POINTS] = {false};
    for (uint32_t i = 0; i < POINTS; i++)
      seen[(int)(POINTS * eo_sobol_sequence_at(&sequence, 7, i, d))] = true;
    for (int i = 0; i < POINTS; i++)
      filled = filled && seen[i];
  }
  ok(filled, "each 256th of every dimension holds one point");
  for (uint32_t i = 0; i < POINTS; i++)
    box[(int)(SIDE * eo_sobol_sequence_at(&sequence, 7, i, 0))]
       [(int)(SIDE * eo_sobol_sequence_at(&sequence, 7, i, 1))]++;
  filled = true;
  for (int i = 0; i < SIDE * SIDE; i++)
    filled = filled && box[i / SIDE][i % SIDE] == 1;
  ok(filled, "each box of the plane holds one point");
  ok(eo_sobol_sequence_at(&sequence, 7, 5, 3) != eo_sobol_sequence_at(&sequence, 8, 5, 3),
     "another seed gives other points");
  eo_sobol_sequence_done(&sequence);
  ok(eo_sobol_sequence_init(&sequence, 0, &error) == EO_ERROR_INPUT, "a sequence of no dimension is refused");
  eo_sobol_sequence_done(&sequence);
}

static void test_samplers(void)
{
  enum { POINTS = 100, INPUTS = 5 };
  struct eo_sampler *latin, *random;
  struct eo_error error;
  double u[INPUTS], again[INPUTS];
  int seen[INPUTS][POINTS] = {{0}};
  bool filled = true;
  eo_sampler_new(&latin, EO_SAMPLING_LATIN, INPUTS, POINTS, 3, &error);
  eo_sampler_new(&random, EO_SAMPLING_RANDOM, INPUTS, POINTS, 3, &error);
  for (int i = POINTS - 1; i >= 0; i--) {
    eo_sampler_at(latin, i, u);
    for (int d = 0; d < INPUTS; d++)
      seen[d][(int)(POINTS * u[d])]++;
  }
  for (int i = 0; i < INPUTS * POINTS; i++)
    filled = filled && seen[i / POINTS][i % POINTS] == 1;
  ok(filled, "each hundredth of every dimension holds one point of a latin hypercube");
  eo_sampler_at(random, 17, u);
  eo_sampler_at(random, 3, again);
  eo_sampler_at(random, 17, again);
  ok(memcmp(u, again, sizeof u) == 0, "a point does not depend on what was asked before");
  eo_sampler_free(latin);
  eo_sampler_free(random);
  eo_sampler_free(NULL);
  ok(eo_sampler_new(&latin, EO_SAMPLING_SOBOL, 1, 0, 1, &error) == EO_ERROR_INPUT, "a sampler of no point is refused");
}

static void test_intervals(void)
{
  struct eo_rank_interval ranks = eo_order_statistic_ranks(200, 0.95, 0.95);
  ok(ranks.low == 184 && ranks.high == 197, "the ranks of the 95 %% percentile of 200 are %d .. %d", ranks.low,
     ranks.high);
  close_to(ranks.coverage, 0.9671521638567255, 1e-12, "coverage of these ranks");
  ranks = eo_order_statistic_ranks(20, 0.99, 0.95);
  ok(ranks.high == 21, "20 values do not bound the 99 %% percentile from above");
  /* Newcombe (1998), table II: 81 of 263, 15 of 148, 0 of 20 */
  struct eo_share_interval share = eo_wilson(81, 263, 0.95);
  close_to(share.low, 0.2553, 5e-5, "lower Wilson limit of 81/263");
  close_to(share.high, 0.3662, 5e-5, "upper Wilson limit of 81/263");
  share = eo_wilson(0, 20, 0.95);
  close_to(share.high, 0.1611, 5e-5, "upper Wilson limit of 0/20");
  share = eo_clopper_pearson(15, 148, 0.95);
  close_to(share.low, 0.0578, 5e-5, "lower Clopper-Pearson limit of 15/148");
  close_to(share.high, 0.1617, 5e-5, "upper Clopper-Pearson limit of 15/148");
  share = eo_clopper_pearson(0, 20, 0.95);
  close_to(share.high, 0.1684, 5e-5, "upper Clopper-Pearson limit of 0/20");
}

static void test_statistics(void)
{
  double sorted[] = {1, 2, 4, 8}, rank[4], interval[1][2];
  const double tied[] = {3, 1, 3, 2}, percent = 50;
  int count[2];
  struct eo_error error;
  close_to(eo_percentile(4, sorted, 95), 7.4, 1e-12, "percentile of type 7, rank 1 + 3 * 0.95");
  close_to(eo_summary_of(4, sorted).deviation, sqrt(28.75 / 3), 1e-12, "deviation with the divisor n - 1");
  eo_ranks(4, tied, rank, &error);
  ok(rank[0] == 3.5 && rank[1] == 1 && rank[2] == 3.5 && rank[3] == 2, "equal values share their rank");
  eo_histogram(4, sorted, 1, 8, 2, count);
  ok(count[0] == 3 && count[1] == 1, "the histogram counts every value in its bin");
  struct eo_bootstrap bootstrap = {.percentile = interval};
  eo_bootstrap_run(&bootstrap, 4, sorted, 1, &percent, 0.95, 500, 1, &error);
  ok(bootstrap.mean[0] < 3.75 && bootstrap.mean[1] > 3.75 && interval[0][0] >= 1 && interval[0][1] <= 8,
     "the bootstrap's interval holds the mean: %.3g .. %.3g", bootstrap.mean[0], bootstrap.mean[1]);
}

/* y = 2 + z0 + 0.5 z0^2 + 2 z1 z2 of standard normals: V = 1 + 0.5 + 4. */
static double quadratic(const double *x)
{
  return 2 + x[0] + 0.5 * x[0] * x[0] + 2 * x[1] * x[2];
}

static double quadratic_of_unit(void *context, const double *u)
{
  double x[3];
  for (int i = 0; i < 3; i++)
    x[i] = eo_distribution_quantile(context, u[i]);
  return quadratic(x);
}

static void test_surface(void)
{
  enum { ROWS = 200, INPUTS = 4 };
  struct eo_distribution normal = {.sigma = 1, .cut = INFINITY};
  struct eo_moments moments[INPUTS];
  struct eo_sampler *sampler;
  struct eo_surface surface;
  struct eo_error error;
  static double input[ROWS][INPUTS], output[ROWS];
  double first[INPUTS], total[INPUTS], coefficient[INPUTS];
  eo_sampler_new(&sampler, EO_SAMPLING_SOBOL, INPUTS, ROWS, 1, &error);
  for (int i = 0; i < ROWS; i++) {
    eo_sampler_at(sampler, i, input[i]);
    for (int d = 0; d < INPUTS; d++)
      input[i][d] = d < 3 ? eo_distribution_quantile(&normal, input[i][d]) : 5; /* the last does not vary */
    output[i] = quadratic(input[i]);
  }
  eo_sampler_free(sampler);
  for (int d = 0; d < INPUTS; d++)
    moments[d] = d < 3 ? eo_distribution_moments(&normal) : (struct eo_moments){.mean = 5, .fourth = 3};
  ok(eo_surface_fit(&surface, ROWS, INPUTS, moments, input[0], output, &error) == EO_OK,
     "a surface is fitted to 200 rows");
  close_to(surface.q2, 1, 1e-9, "part of a quadratic response that the surface carries");
  eo_surface_indices(&surface, first, total);
  close_to(first[0], 1.5 / 5.5, 1e-9, "first index of z0");
  close_to(total[1], 4 / 5.5, 1e-9, "total index of z1");
  close_to(first[1], 0, 1e-9, "first index of z1");
  ok(first[3] == 0 && total[3] == 0, "an input that does not vary has no index");
  eo_surface_done(&surface);
  eo_sobol_indices(quadratic_of_unit, &normal, 3, 2048, 1, first, total, &error);
  close_to(first[0], 1.5 / 5.5, 0.02, "first index of z0, sampled");
  close_to(total[2], 4 / 5.5, 0.02, "total index of z2, sampled");
  struct eo_regression regression = {.coefficient = coefficient};
  ok(eo_regression_run(&regression, ROWS, INPUTS, input[0], output, &error) == EO_OK && isnan(coefficient[3]),
     "regression passes over what does not vary");
  ok(eo_regression_run(&regression, 5, INPUTS, input[0], output, &error) == EO_ERROR_NUMERIC,
     "a regression of too few rows is refused");
  ok(eo_surface_fit(&surface, 9, INPUTS, moments, input[0], output, &error) == EO_ERROR_NUMERIC,
     "a surface of too few rows is refused");
  eo_surface_done(&surface);
}

/* y = 2 x + (u - v)/sqrt 2 where v is -u: of all coefficients that say so, those that share it. */
static void test_dependent_inputs(void)
{
  enum { ROWS = 64 };
  static double input[ROWS][3], output[ROWS];
  double coefficient[3];
  struct eo_regression regression = {.coefficient = coefficient};
  struct eo_error error;
  for (int i = 0; i < ROWS; i++) {
    double x = cos(2 * M_PI * i / ROWS), u = sin(2 * M_PI * i / ROWS);
    input[i][0] = 7 + x;
    input[i][1] = 3 * u;
    input[i][2] = -5 * u;
    output[i] = 2 * x + u;
  }
  ok(eo_regression_run(&regression, ROWS, 3, input[0], output, &error) == EO_OK,
     "a regression takes inputs of a fixed sum");
  close_to(coefficient[0], 2 / sqrt(5), 1e-12, "what depends on none has its own coefficient");
  close_to(coefficient[1], 0.5 / sqrt(5), 1e-12, "two that depend on each other share theirs");
  close_to(coefficient[2], -0.5 / sqrt(5), 1e-12, "with the sign of each");
  close_to(regression.r2, 1, 1e-12, "they explain what they make");
  close_to(regression.r2_adjusted, 1, 1e-12, "as two inputs would");
}

/* Sigma 3 and 4 under a fixed sum: what is left of 3 is 3 sqrt(1 - 9/25) = 2.4, and of 4 the same. */
static void test_scatter(void)
{
  enum { PAIRS = 2000 };
  static struct eo_scatter scatter;
  static double column[2][PAIRS];
  struct eo_sampler *sampler;
  struct eo_error error;
  const double unbounded = INFINITY;
  double over = 0, member[3] = {0, 0, 7}, compliance, speed;
  int bounded = 0;
  scatter.inputs = 3;
  for (int i = 0; i < 3; i++)
    scatter.input[i] = (struct eo_scatter_input){.offset = sizeof(double) * (size_t)i,
                                                 .unit = 1e-3,
                                                 .nominal = 10,
                                                 .least = -unbounded,
                                                 .most = unbounded,
                                                 .deviation = {.sigma = 3 + i, .cut = INFINITY},
                                                 .fixed_sum = i < 2};
  scatter.input[2].target = EO_TARGET_COMPLIANCE;
  scatter.input[2].nominal = 1;
  scatter.input[2].least = 0.1;
  ok(eo_scatter_settle(&scatter, &error) == EO_OK && scatter.dimensions == 3, "three inputs are settled");
  ok(!eo_scatter_is_independent(&scatter), "a fixed sum ties two of them");
  eo_sampler_new(&sampler, EO_SAMPLING_SOBOL, 3, PAIRS, 1, &error);
  for (int i = 0; i < PAIRS; i++) {
    double value[3];
    bounded += eo_scatter_draw(&scatter, sampler, i, value);
    over = fmax(over, fabs(value[0] + value[1] - 20));
    column[0][i] = value[0];
    column[1][i] = value[1];
    eo_scatter_apply(&scatter, value, member, &compliance, &speed);
  }
  eo_sampler_free(sampler);
  close_to(over, 0, 1e-12, "sum of the two inputs, less the stated one");
  close_to(eo_summary_of(PAIRS, column[0]).deviation, 2.4, 0.03, "deviation of an input under a fixed sum");
  close_to(eo_scatter_moments(&scatter, 1).deviation, 2.4, 1e-12, "deviation of the other input of the sum, as stated");
  close_to(member[0], 1e-3 * column[0][PAIRS - 1], 1e-15, "value of a drawn pair in the struct");
  ok(member[2] == 7 && speed == 1 && compliance >= 0.1 && bounded > 500,
     "a drawn factor keeps within its bound: %d times", bounded);
}

/* A phase about 0 lies on both sides of it: -0.1 of a cycle is 0.9. */
static void test_phase(void)
{
  static struct eo_scatter scatter;
  struct eo_error error;
  struct eo_sampler *sampler;
  double value, phase, compliance, speed, lowest = 1, below = 0;
  int bounded = 0;
  scatter.inputs = 1;
  scatter.input[0] = (struct eo_scatter_input){
      .unit = 1, .least = 0, .most = 1, .cyclic = true, .deviation = {.sigma = 0.02, .cut = INFINITY}};
  eo_scatter_settle(&scatter, &error);
  eo_sampler_new(&sampler, EO_SAMPLING_SOBOL, 1, 64, 1, &error);
  for (int i = 0; i < 64; i++) {
    bounded += eo_scatter_draw(&scatter, sampler, i, &value);
    eo_scatter_apply(&scatter, &value, &phase, &compliance, &speed);
    lowest = fmin(lowest, phase);
    below += value < 0 && fabs(phase - 1 - value) < 1e-15;
  }
  eo_sampler_free(sampler);
  ok(bounded == 0, "a phase meets no bound");
  ok(below == 32 && lowest >= 0, "what lies before 0 is the end of the cycle before");
}

int main(void)
{
  test_dependent_inputs();
  test_scatter();
  test_phase();
  test_normal();
  test_distributions();
  test_half_normal();
  test_sequence();
  test_samplers();
  test_intervals();
  test_statistics();
  test_surface();
  return tap_done();
}
