/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tolerance/output_report.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/sort.h"
#include "tolerance/influence.h"
#include "tolerance/interval.h"
#include "tolerance/response_surface.h"

static const double percents[EO_REPORT_PERCENTS] = {1, 5, 10, 25, 50, 75, 90, 95, 99};
enum { RESAMPLES = 400 }; /* the ends of an interval to 5 % of its width */

/* Rows that have the number: [rows][inputs], [rows], and sorted. */
struct rows {
  int count, inputs;
  double *input, *output, *sorted;
};

static enum eo_code collect(struct rows *rows, struct eo_output_report *report, int pairs, const double *input,
                            const double *output, int stride, const bool *full, struct eo_error *error)
{
  double largest = -INFINITY;
  size_t n = (size_t)pairs, k = (size_t)rows->inputs;
  rows->input = malloc(sizeof *rows->input * n * (k + 2));
  if (!rows->input)
    return eo_error_memory(error);
  rows->output = rows->input + n * k;
  rows->sorted = rows->output + n;
  for (size_t i = 0; i < n; i++) {
    double value = output[i * (size_t)stride];
    if (!isfinite(value))
      continue;
    memcpy(rows->input + (size_t)rows->count * k, input + i * k, sizeof *input * k);
    if (!full || full[i]) {
      report->full++;
      report->largest = value > largest ? (int)i : report->largest;
      largest = fmax(largest, value);
    }
    rows->output[rows->count++] = value;
  }
  memcpy(rows->sorted, rows->output, sizeof *rows->output * (size_t)rows->count);
  eo_sort_numbers(rows->count, rows->sorted);
  return EO_OK;
}

struct eo_report_percentile eo_report_percentile_of(int rows, const double *sorted, double percent)
{
  if (rows == 0)
    return (struct eo_report_percentile){percent, NAN, NAN, NAN};
  struct eo_rank_interval ranks = eo_order_statistic_ranks(rows, percent / 100, 0.95);
  return (struct eo_report_percentile){.percent = percent,
                                       .value = eo_percentile(rows, sorted, percent),
                                       .low = ranks.low >= 1 ? sorted[ranks.low - 1] : NAN,
                                       .high = ranks.high <= rows ? sorted[ranks.high - 1] : NAN};
}

/* The same of completed values, with the interval of as many pairs in full as would leave it as open. */
static enum eo_code completed_percentile(const struct rows *rows, const struct eo_report_completion *completion,
                                         double percent, struct eo_report_percentile *found, struct eo_error *error)
{
  struct eo_doubt doubt;
  EO_TRY(eo_completion_doubt(completion->completion, completion->output, percent, &doubt, NULL, error));
  int of = doubt.rows > 2 ? (int)doubt.rows : 2;
  struct eo_rank_interval ranks = eo_order_statistic_ranks(of, percent / 100, 0.95);
  *found = (struct eo_report_percentile){percent, doubt.value, NAN, NAN};
  if (ranks.low >= 1)
    found->low = eo_percentile(rows->count, rows->sorted, 100. * (ranks.low - 1) / (of - 1));
  if (ranks.high <= of)
    found->high = eo_percentile(rows->count, rows->sorted, 100. * (ranks.high - 1) / (of - 1));
  return EO_OK;
}

/* What the line and those beside it leave open of a mean, over what the pairs themselves do: theory (A13). */
static double widening(const struct eo_output_report *report)
{
  double completed = 1 - (double)report->full / report->rows, own = report->coarse_error / report->summary.deviation;
  return report->full < report->rows && isfinite(own)
             ? sqrt(1 + completed * completed * own * own * report->rows / report->full)
             : 1;
}

static void widen(double about, double by, double interval[2])
{
  interval[0] = about - by * (about - interval[0]);
  interval[1] = about + by * (interval[1] - about);
}

static enum eo_code complete(const struct rows *rows, struct eo_output_report *report,
                             const struct eo_report_completion *completion, struct eo_error *error)
{
  report->coarse_error = completion->completed.error;
  for (int i = 0; i < EO_REPORT_PERCENTS; i++)
    EO_TRY(completed_percentile(rows, completion, percents[i], &report->percentile[i], error));
  double by = widening(report);
  widen(report->summary.mean, by, report->mean_interval);
  widen(report->summary.deviation, by, report->deviation_interval);
  return EO_OK;
}

static enum eo_code describe(const struct rows *rows, struct eo_output_report *report, uint64_t seed,
                             struct eo_error *error)
{
  struct eo_bootstrap bootstrap = {0};
  report->summary = eo_summary_of(rows->count, rows->output);
  report->varies = report->summary.largest > report->summary.least;
  eo_histogram(rows->count, rows->output, report->summary.least, report->summary.largest, EO_REPORT_BINS,
               report->count);
  for (int i = 0; i < EO_REPORT_PERCENTS; i++)
    report->percentile[i] = eo_report_percentile_of(rows->count, rows->sorted, percents[i]);
  EO_TRY(eo_bootstrap_run(&bootstrap, rows->count, rows->output, 0, NULL, 0.95, RESAMPLES, seed, error));
  memcpy(report->mean_interval, bootstrap.mean, sizeof bootstrap.mean);
  memcpy(report->deviation_interval, bootstrap.deviation, sizeof bootstrap.deviation);
  return EO_OK;
}

/* What cannot be fitted (too few rows, inputs that depend on each other) is left out. */
static enum eo_code regress(const struct rows *rows, struct eo_output_report *report, double *size,
                            struct eo_error *error)
{
  struct eo_error found;
  struct eo_regression regression = {0};
  regression.coefficient = size;
  enum eo_code code = eo_regression_run(&regression, rows->count, rows->inputs, rows->input, rows->output, &found);
  if (code == EO_ERROR_NUMERIC)
    return EO_OK;
  if (code)
    return eo_error_memory(error);
  report->r2 = regression.r2;
  report->r2_adjusted = regression.r2_adjusted;
  for (int i = 0; i < rows->inputs; i++)
    report->influence[i].coefficient = size[i];
  return EO_OK;
}

static enum eo_code fit_surface(const struct rows *rows, struct eo_output_report *report,
                                const struct eo_moments *moments, double *scratch, struct eo_error *error)
{
  struct eo_surface surface;
  struct eo_error found;
  enum eo_code code = eo_surface_fit(&surface, rows->count, rows->inputs, moments, rows->input, rows->output, &found);
  if (!code) {
    report->q2 = surface.q2;
    report->residual = surface.residual;
    report->leading = surface.leading;
    eo_surface_indices(&surface, scratch, scratch + rows->inputs);
    for (int i = 0; i < rows->inputs; i++) {
      report->influence[i].first = scratch[i];
      report->influence[i].total = scratch[rows->inputs + i];
    }
  }
  eo_surface_done(&surface);
  return code == EO_ERROR_MEMORY ? eo_error_memory(error) : EO_OK;
}

static enum eo_code put_in_order(struct eo_output_report *report, double *size, struct eo_error *error)
{
  int k = report->inputs, *order = malloc(sizeof *order * (size_t)k);
  struct eo_report_influence *old = malloc(sizeof *old * (size_t)k);
  bool by_surface = report->q2 > report->r2;
  enum eo_code code = order && old ? EO_OK : eo_error_memory(error);
  if (!code) {
    memcpy(old, report->influence, sizeof *old * (size_t)k);
    for (int i = 0; i < k; i++)
      size[i] = by_surface ? old[i].total : old[i].coefficient;
    eo_order_by_size(k, size, order);
    for (int i = 0; i < k; i++)
      report->influence[i] = old[order[i]];
  }
  free(order);
  free(old);
  return code;
}

static enum eo_code weigh_inputs(const struct rows *rows, struct eo_output_report *report,
                                 const struct eo_moments *moments, double *scratch, struct eo_error *error)
{
  EO_TRY(regress(rows, report, scratch, error));
  if (moments)
    EO_TRY(fit_surface(rows, report, moments, scratch, error));
  return put_in_order(report, scratch, error);
}

static enum eo_code find_influences(const struct rows *rows, struct eo_output_report *report,
                                    const struct eo_moments *moments, struct eo_error *error)
{
  double *scratch = malloc(sizeof *scratch * 2 * (size_t)rows->inputs);
  if (!scratch)
    return eo_error_memory(error);
  enum eo_code code = weigh_inputs(rows, report, moments, scratch, error);
  free(scratch);
  return code;
}

static enum eo_code tell(const struct rows *rows, struct eo_output_report *report, const struct eo_moments *moments,
                         uint64_t seed, const struct eo_report_completion *completion, struct eo_error *error)
{
  report->rows = rows->count;
  if (rows->count > 0)
    EO_TRY(describe(rows, report, seed, error));
  if (rows->count > 0 && completion)
    EO_TRY(complete(rows, report, completion, error));
  return report->varies ? find_influences(rows, report, moments, error) : EO_OK;
}

enum eo_code eo_output_report_make(struct eo_output_report *report, int pairs, int inputs, const double *input,
                                   const double *output, int stride, const struct eo_moments *moments, uint64_t seed,
                                   const struct eo_report_completion *completion, struct eo_error *error)
{
  struct rows rows = {.inputs = inputs};
  *report = (struct eo_output_report){
      .inputs = inputs, .coarse_error = NAN, .r2 = NAN, .r2_adjusted = NAN, .q2 = NAN, .residual = NAN};
  report->influence = malloc(sizeof *report->influence * (size_t)inputs);
  if (!report->influence)
    return eo_error_memory(error);
  for (int i = 0; i < inputs; i++)
    report->influence[i] = (struct eo_report_influence){i, NAN, NAN, NAN};
  enum eo_code code = collect(&rows, report, pairs, input, output, stride,
                              completion ? completion->completion->full : NULL, error);
  if (!code)
    code = tell(&rows, report, moments, seed, completion, error);
  free(rows.input);
  return code;
}

void eo_output_report_done(struct eo_output_report *report)
{
  if (report)
    free(report->influence);
}
