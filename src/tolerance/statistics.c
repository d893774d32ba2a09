/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tolerance/statistics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/sort.h"
#include "base/random.h"

enum { STREAM_BOOTSTRAP = 905 }; /* of the counter generator */

struct eo_summary eo_summary_of(int n, const double *value)
{
  struct eo_summary summary = {.least = INFINITY, .largest = -INFINITY};
  double squares = 0;
  for (int i = 0; i < n; i++) {
    summary.mean += value[i] / n;
    summary.least = fmin(summary.least, value[i]);
    summary.largest = fmax(summary.largest, value[i]);
  }
  for (int i = 0; i < n; i++)
    squares += (value[i] - summary.mean) * (value[i] - summary.mean);
  summary.deviation = n > 1 ? sqrt(squares / (n - 1)) : 0;
  return summary;
}

/* theory (A3) */
double eo_percentile(int n, const double *sorted, double percent)
{
  double rank = (n - 1) * percent / 100;
  int below = (int)floor(rank);
  if (below >= n - 1)
    return sorted[n - 1];
  return sorted[below] + (rank - below) * (sorted[below + 1] - sorted[below]);
}

/* What the resamples gave: a row of mean, deviation and percentiles each. */
static void set_intervals(struct eo_bootstrap *bootstrap, int percents, int resamples, double *drawn, double level)
{
  double low = 50 * (1 - level), high = 50 * (1 + level);
  for (int k = 0; k < percents + 2; k++) {
    double *own = drawn + (size_t)k * (size_t)resamples;
    double *interval = k == 0 ? bootstrap->mean : k == 1 ? bootstrap->deviation : bootstrap->percentile[k - 2];
    eo_sort_numbers(resamples, own);
    interval[0] = eo_percentile(resamples, own, low);
    interval[1] = eo_percentile(resamples, own, high);
  }
}

enum eo_code eo_bootstrap_run(struct eo_bootstrap *bootstrap, int n, const double *value, int percents,
                              const double *percent, double level, int resamples, uint64_t seed, struct eo_error *error)
{
  size_t each = (size_t)resamples;
  double *drawn = malloc(sizeof *drawn * (each * (size_t)(percents + 2) + (size_t)n)), *own = NULL;
  if (!drawn)
    return eo_error_memory(error);
  own = drawn + each * (size_t)(percents + 2);
  for (size_t r = 0; r < each; r++) {
    struct eo_random random = eo_random_at(seed, STREAM_BOOTSTRAP, 0, r);
    for (int i = 0; i < n; i++)
      own[i] = value[eo_random_index(random, (uint64_t)i, n)];
    struct eo_summary summary = eo_summary_of(n, own);
    drawn[r] = summary.mean;
    drawn[each + r] = summary.deviation;
    if (percents > 0)
      eo_sort_numbers(n, own);
    for (int k = 0; k < percents; k++)
      drawn[(size_t)(k + 2) * each + r] = eo_percentile(n, own, percent[k]);
  }
  set_intervals(bootstrap, percents, resamples, drawn, level);
  free(drawn);
  return EO_OK;
}

void eo_histogram(int n, const double *value, double low, double high, int bins, int *count)
{
  memset(count, 0, sizeof *count * (size_t)bins);
  for (int i = 0; i < n; i++) {
    int bin = high > low ? (int)floor((value[i] - low) / (high - low) * bins) : 0;
    count[bin < 0 ? 0 : bin < bins ? bin : bins - 1]++;
  }
}

double eo_correlation(int n, const double *a, const double *b)
{
  double mean[2] = {0}, aa = 0, bb = 0, ab = 0;
  for (int i = 0; i < n; i++) {
    mean[0] += a[i] / n;
    mean[1] += b[i] / n;
  }
  for (int i = 0; i < n; i++) {
    double x = a[i] - mean[0], y = b[i] - mean[1];
    aa += x * x;
    bb += y * y;
    ab += x * y;
  }
  return aa > 0 && bb > 0 ? ab / sqrt(aa * bb) : NAN;
}

struct ranked {
  double value;
  int index;
};

static int by_value(const void *a, const void *b)
{
  const struct ranked *x = a, *y = b;
  return x->value != y->value ? (x->value > y->value) - (x->value < y->value) : x->index - y->index;
}

enum eo_code eo_ranks(int n, const double *value, double *rank, struct eo_error *error)
{
  struct ranked *row = malloc(sizeof *row * (size_t)n);
  if (!row)
    return eo_error_memory(error);
  for (int i = 0; i < n; i++)
    row[i] = (struct ranked){value[i], i};
  qsort(row, (size_t)n, sizeof *row, by_value);
  for (int i = 0, j; i < n; i = j) {
    for (j = i + 1; j < n && row[j].value == row[i].value;)
      j++;
    for (int k = i; k < j; k++)
      rank[row[k].index] = (i + 1 + j) / 2.;
  }
  free(row);
  return EO_OK;
}
