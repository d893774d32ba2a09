/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/verify_tolerance_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/sort.h"
#include "tolerance/influence.h"
#include "tolerance/interval.h"
#include "tolerance/statistics.h"

enum { RESAMPLES = 4000, ROW_RESAMPLES = 1000, OWN_PAIRS = 128 };

/* Arithmetic on what is listed, in the file's words "1e-4 (um), 0.01 MPa, 1e-4 (coefficients, R2, correlations)". */
static const double LISTED_UM = 1e-4, LISTED_MPA = 0.01, LISTED_SHARE = 1e-4;
/* Ends of a bootstrap interval from other resamples: share of its width. Two of 4000 resamples of a smooth statistic
   differ by 1.5 % (one sigma); percentiles jump from value to value. */
static const double MEAN_WIDTH = 0.08, PERCENTILE_WIDTH = 0.25;

static double listed_tolerance(const char *name)
{
  return strstr(name, "MPa") ? LISTED_MPA : LISTED_UM;
}

static double width_of(struct eo_case *interval)
{
  return eo_case_element(interval, 1) - eo_case_element(interval, 0);
}

static void check_interval(struct eo_verification *verification, struct eo_case *expected, const double interval[2],
                           double share, double rounding)
{
  if (expected)
    eo_verify_list(verification, expected, 2, interval, 1, 0, fmax(share * width_of(expected), rounding));
}

static enum eo_code check_bootstrap(const struct eo_tolerance_trial *trial, struct eo_case *block, const double *value,
                                    struct eo_error *error)
{
  struct eo_case *percentiles = eo_case_need(block, "percentiles");
  int n = eo_case_size(percentiles);
  double percent[32], interval[32][2];
  struct eo_bootstrap bootstrap = {.percentile = interval};
  if (n < 1 || n > 32)
    eo_case_fault(percentiles, "1 to 32 percentiles are expected here.");
  for (int i = 0; i < n && n <= 32; i++)
    percent[i] = eo_case_key_number(eo_case_at(percentiles, i));
  if (eo_case_faulty(block))
    return EO_OK;
  EO_TRY(eo_bootstrap_run(&bootstrap, trial->rows, value, n, percent, 0.95, RESAMPLES, 1, error));
  check_interval(trial->v, eo_case_find(block, "mean"), bootstrap.mean, MEAN_WIDTH, LISTED_UM);
  check_interval(trial->v, eo_case_find(block, "std"), bootstrap.deviation, MEAN_WIDTH, LISTED_UM);
  for (int i = 0; i < n; i++)
    check_interval(trial->v, eo_case_at(percentiles, i), interval[i], PERCENTILE_WIDTH, LISTED_UM);
  return EO_OK;
}

static void check_ranks(const struct eo_tolerance_trial *trial, struct eo_case *block, const double *sorted,
                        double tolerance)
{
  for (int i = 0; i < eo_case_size(block); i++) {
    struct eo_case *row = eo_case_at(block, i);
    double share = eo_case_key_number(row) / 100;
    struct eo_rank_interval found = eo_order_statistic_ranks(trial->rows, share, 0.95);
    double ranks[2] = {found.low, found.high};
    double ends[2] = {found.low > 0 ? sorted[found.low - 1] : NAN,
                      found.high <= trial->rows ? sorted[found.high - 1] : NAN};
    eo_verify_list(trial->v, eo_case_need(row, "ranks"), 2, ranks, 1, 0, 1e-9);
    eo_verify_list(trial->v, eo_case_need(row, "interval"), 2, ends, 1, 0, tolerance);
    eo_verify_member(trial->v, row, "coverage", found.coverage, 0, 1e-4);
  }
}

static int index_of(const struct eo_tolerance_trial *trial, const char *name)
{
  for (int i = 0; i < trial->columns; i++)
    if (strcmp(name, trial->name[i]) == 0)
      return i;
  return -1;
}

/* Coefficients by name, their order and intervals. again: from the outputs computed here. */
static enum eo_code check_regression(const struct eo_tolerance_trial *trial, struct eo_case *block, const double *value,
                                     const double *again, struct eo_error *error)
{
  double coefficient[EO_BENCH_INPUTS], other[EO_BENCH_INPUTS], interval[EO_BENCH_INPUTS][2];
  int order[EO_BENCH_INPUTS];
  struct eo_regression listed = {.coefficient = coefficient}, computed = {.coefficient = other};
  struct eo_case *by_name = eo_case_need(block, "coefficient"), *rank = eo_case_need(block, "rank"),
                 *intervals = eo_case_find(block, "bootstrap_95"),
                 *within = eo_case_find(trial->tolerance, "statistics_of_recomputed_rows");
  double near = eo_case_absolute_or(within, "coefficient", 0.005), r2 = eo_case_absolute_or(within, "R2", 0.005);
  EO_TRY(eo_regression_run(&listed, trial->rows, trial->inputs, trial->input, value, error));
  EO_TRY(eo_regression_run(&computed, trial->rows, trial->inputs, trial->input, again, error));
  eo_verify_member(trial->v, block, "R2", listed.r2, 0, LISTED_SHARE);
  eo_verify_member(trial->v, block, "R2_adjusted", listed.r2_adjusted, 0, LISTED_SHARE);
  eo_verify_derived(trial->v, eo_case_find(block, "R2"), "R2 of the rows computed here", computed.r2,
                    eo_case_number(block, "R2"), r2);
  for (int i = 0; i < trial->inputs; i++) {
    struct eo_case *expected = eo_case_need(by_name, trial->name[i]);
    eo_verify_number(trial->v, expected, coefficient[i], 0, LISTED_SHARE);
    if (expected)
      eo_verify_derived(trial->v, expected, "coefficient of the rows computed here", other[i], eo_case_real(expected),
                        near);
  }
  eo_order_by_size(trial->inputs, coefficient, order);
  eo_verify_size(trial->v, rank, trial->inputs);
  for (int i = 0; i < trial->inputs && i < eo_case_size(rank); i++) {
    struct eo_case *name = eo_case_at(rank, i);
    const char *expected = eo_case_text(name);
    eo_verify_fact(trial->v, name, "rank by the size of the coefficient",
                   expected && index_of(trial, expected) == order[i]);
  }
  if (intervals)
    EO_TRY(eo_regression_bootstrap(trial->rows, trial->inputs, trial->input, value, 0.95, ROW_RESAMPLES, 1, interval,
                                   error));
  for (int i = 0; i < trial->inputs && intervals; i++)
    check_interval(trial->v, eo_case_need(intervals, trial->name[i]), interval[i], 2 * MEAN_WIDTH, 1e-3);
  return EO_OK;
}

/* Percentiles of other samples from the same distributions. */
static enum eo_code check_own_samples(const struct eo_tolerance_trial *trial, struct eo_case *block, int column,
                                      const double *own, struct eo_error *error)
{
  struct eo_case *percentiles = eo_case_find(block, "percentiles");
  struct eo_case *intervals = eo_case_find(eo_case_find(block, "bootstrap_95"), "percentiles");
  double sorted[OWN_PAIRS];
  (void)error;
  memcpy(sorted, own, sizeof sorted);
  eo_sort_numbers(OWN_PAIRS, sorted);
  for (int i = 0; i < eo_case_size(percentiles); i++) {
    struct eo_case *expected = eo_case_at(percentiles, i);
    double percent = eo_case_key_number(expected), here = width_of(eo_case_find(intervals, eo_case_key(expected))) / 4;
    struct eo_rank_interval ranks = eo_order_statistic_ranks(OWN_PAIRS, percent / 100, 0.95);
    int low = ranks.low < 1 ? 1 : ranks.low, high = ranks.high > OWN_PAIRS ? OWN_PAIRS : ranks.high;
    double standard_error = (sorted[high - 1] - sorted[low - 1]) / 4;
    eo_verify_derived(trial->v, expected, "percentile of own samples", eo_percentile(OWN_PAIRS, sorted, percent),
                      eo_case_real(expected), 4 * hypot(standard_error, here));
  }
  (void)column;
  return EO_OK;
}

static enum eo_code check_output(const struct eo_tolerance_trial *trial, struct eo_case *block, int column,
                                 const double *own, struct eo_error *error)
{
  const double *value = trial->listed + (size_t)column * (size_t)trial->rows,
               *again = trial->computed + (size_t)column * (size_t)trial->rows;
  double within = listed_tolerance(trial->name[column]),
         near = eo_case_relative_or(eo_case_find(trial->tolerance, "statistics_of_recomputed_rows"), "percentile_rel",
                                    0.005);
  struct eo_summary summary = eo_summary_of(trial->rows, value);
  struct eo_case *percentiles = eo_case_need(block, "percentiles");
  double *sorted = malloc(sizeof *sorted * 2 * (size_t)trial->rows);
  if (!sorted)
    return eo_error_memory(error);
  double *other = sorted + trial->rows;
  memcpy(sorted, value, sizeof *sorted * (size_t)trial->rows);
  memcpy(other, again, sizeof *sorted * (size_t)trial->rows);
  eo_sort_numbers(trial->rows, sorted);
  eo_sort_numbers(trial->rows, other);
  eo_verify_member(trial->v, block, "mean", summary.mean, 0, within);
  eo_verify_member(trial->v, block, "std", summary.deviation, 0, within);
  eo_verify_member(trial->v, block, "min", summary.least, 0, within);
  eo_verify_member(trial->v, block, "max", summary.largest, 0, within);
  for (int i = 0; i < eo_case_size(percentiles); i++) {
    struct eo_case *expected = eo_case_at(percentiles, i);
    double percent = eo_case_key_number(expected), listed = eo_case_real(expected);
    eo_verify_number(trial->v, expected, eo_percentile(trial->rows, sorted, percent), 0, within);
    eo_verify_derived(trial->v, expected, "percentile of the rows computed here",
                      eo_percentile(trial->rows, other, percent), listed, near * fabs(listed));
  }
  if (eo_case_find(block, "order_statistic_95"))
    check_ranks(trial, eo_case_find(block, "order_statistic_95"), sorted, within);
  enum eo_code code = eo_case_find(block, "bootstrap_95")
                          ? check_bootstrap(trial, eo_case_find(block, "bootstrap_95"), value, error)
                          : EO_OK;
  if (!code && eo_case_find(block, "standardised_regression"))
    code = check_regression(trial, eo_case_find(block, "standardised_regression"), value, again, error);
  if (!code && !eo_case_faulty(block))
    code = check_own_samples(trial, block, column, own, error);
  free(sorted);
  return code;
}

static double pearson(int n, const double *a, const double *b, const int *row, double *scratch)
{
  for (int i = 0; i < n; i++) {
    scratch[i] = a[row ? row[i] : i];
    scratch[n + i] = b[row ? row[i] : i];
  }
  return eo_correlation(n, scratch, scratch + n);
}

static enum eo_code check_pair_of(const struct eo_tolerance_trial *trial, struct eo_case *row, const double *a,
                                  const double *b, struct eo_error *error)
{
  size_t n = (size_t)trial->rows;
  double *rank = malloc(sizeof *rank * n * 4);
  if (!rank)
    return eo_error_memory(error);
  enum eo_code code = eo_ranks(trial->rows, a, rank, error);
  if (!code)
    code = eo_ranks(trial->rows, b, rank + n, error);
  if (!code) {
    eo_verify_member(trial->v, row, "pearson", pearson(trial->rows, a, b, NULL, rank + 2 * n), 0, LISTED_SHARE);
    eo_verify_member(trial->v, row, "spearman", eo_correlation(trial->rows, rank, rank + n), 0, LISTED_SHARE);
    if (eo_case_find(row, "bootstrap_95"))
      eo_verify_uncompared(trial->v, eo_case_find(row, "bootstrap_95"), "correlations are given without an interval");
  }
  free(rank);
  return code;
}

static enum eo_code check_correlations(const struct eo_tolerance_trial *trial, struct eo_case *list,
                                       struct eo_error *error)
{
  for (int i = 0; i < eo_case_size(list); i++) {
    struct eo_case *row = eo_case_at(list, i), *of = eo_case_need(row, "of");
    int column[2] = {-1, -1};
    for (int k = 0; k < 2 && of; k++) {
      struct eo_case *name = eo_case_at(of, k);
      column[k] = name && eo_case_is_text(name) ? index_of(trial, eo_case_text(name)) : -1;
      if (column[k] < 0)
        eo_case_fault(of, "Two columns of the samples are expected here.");
    }
    if (!eo_case_faulty(row))
      EO_TRY(check_pair_of(trial, row, trial->listed + (size_t)column[0] * (size_t)trial->rows,
                           trial->listed + (size_t)column[1] * (size_t)trial->rows, error));
  }
  return EO_OK;
}

static void check_share(const struct eo_tolerance_trial *trial, struct eo_case *block, int inside)
{
  struct eo_share_interval exact = eo_clopper_pearson(inside, trial->rows, 0.95);
  double ends[2] = {exact.low, exact.high};
  if (!block)
    return;
  eo_verify_member(trial->v, block, "inside", inside, 0, 1e-9);
  eo_verify_member(trial->v, block, "of", trial->rows, 0, 1e-9);
  eo_verify_member(trial->v, block, "fraction", (double)inside / trial->rows, 0, LISTED_SHARE);
  if (eo_case_find(block, "clopper_pearson_95"))
    eo_verify_list(trial->v, eo_case_find(block, "clopper_pearson_95"), 2, ends, 1, 0, LISTED_SHARE);
  struct eo_share_interval wilson = eo_wilson(inside, trial->rows, 0.95);
  double other[2] = {wilson.low, wilson.high};
  if (eo_case_find(block, "wilson_95"))
    eo_verify_list(trial->v, eo_case_find(block, "wilson_95"), 2, other, 1, 0, LISTED_SHARE);
}

/* Each limit alone, and all of them at once ("both", "all"). */
static void check_yield(const struct eo_tolerance_trial *trial, struct eo_case *block)
{
  struct eo_case *limits = eo_case_need(block, "limits");
  int count = eo_case_size(limits), column[16] = {0}, inside[17] = {0};
  double limit[16] = {0};
  if (count < 1 || count > 16)
    eo_case_fault(block, "1 to 16 limits are expected here.");
  for (int k = 0; k < count && !eo_case_faulty(block); k++) {
    struct eo_case *own = eo_case_at(limits, k);
    column[k] = index_of(trial, eo_case_key(own));
    limit[k] = eo_case_real(own);
    if (column[k] < 0)
      eo_case_fault(own, "There is no such column.");
  }
  for (int i = 0; i < trial->rows && !eo_case_faulty(block); i++) {
    int met = 0;
    for (int k = 0; k < count; k++) {
      bool meets = trial->listed[(size_t)column[k] * (size_t)trial->rows + (size_t)i] <= limit[k];
      inside[k] += meets;
      met += meets;
    }
    inside[count] += met == count;
  }
  for (int k = 0; k < count && !eo_case_faulty(block); k++)
    check_share(trial, eo_case_find(block, trial->name[column[k]]), inside[k]);
  check_share(trial, eo_case_find(block, "both"), inside[count]);
  check_share(trial, eo_case_find(block, "all"), inside[count]);
}

/* The same distributions drawn once more: [column][OWN_PAIRS]. */
static enum eo_code draw_own(struct eo_tolerance_trial *trial, double *own, struct eo_error *error)
{
  double *value = malloc(sizeof *value * OWN_PAIRS * (size_t)trial->inputs);
  if (!value)
    return eo_error_memory(error);
  enum eo_code code = eo_bench_draw(trial->bench->input, trial->inputs, OWN_PAIRS, value, error);
  for (int i = 0; i < OWN_PAIRS && !code; i++) {
    double output[EO_BENCH_OUTPUTS] = {0};
    eo_bench_evaluate(trial->bench, value + (size_t)i * (size_t)trial->inputs, output);
    for (int c = trial->inputs; c < trial->columns; c++)
      own[(size_t)c * OWN_PAIRS + (size_t)i] = output[trial->output[c]];
  }
  free(value);
  return code;
}

enum eo_code eo_verify_tolerance_statistics(struct eo_tolerance_trial *trial, struct eo_error *error)
{
  double *own = malloc(sizeof *own * OWN_PAIRS * EO_TOLERANCE_COLUMNS);
  enum eo_code code = own ? draw_own(trial, own, error) : eo_error_memory(error);
  for (int c = trial->inputs; c < trial->columns && !code; c++) {
    struct eo_case *block = eo_case_need(trial->statistics, trial->name[c]);
    if (block)
      code = check_output(trial, block, c, own + (size_t)c * OWN_PAIRS, error);
  }
  if (!code && eo_case_find(trial->statistics, "correlation"))
    code = check_correlations(trial, eo_case_find(trial->statistics, "correlation"), error);
  if (!code && eo_case_find(trial->statistics, "yield"))
    check_yield(trial, eo_case_find(trial->statistics, "yield"));
  free(own);
  return code;
}
