/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tolerance/influence.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/sort.h"
#include "base/random.h"
#include "numerics/dense.h"
#include "tolerance/pair_sampler.h"
#include "tolerance/statistics.h"

enum { STREAM_RESAMPLE = 906 }; /* of the counter generator */

/* Standardised columns [k][n] of the inputs that vary, the output behind them; of[]: which input. Returns how many. */
static int standardise(int n, int k, const double *input, const double *output, double *column, int *of)
{
  int varying = 0;
  for (int i = 0; i <= k; i++) {
    double *own = column + (size_t)varying * (size_t)n;
    for (int row = 0; row < n; row++)
      own[row] = i < k ? input[(size_t)row * (size_t)k + (size_t)i] : output[row];
    struct eo_summary summary = eo_summary_of(n, own);
    if (i < k && !(summary.largest > summary.least))
      continue;
    for (int row = 0; row < n; row++)
      own[row] = summary.largest > summary.least ? (own[row] - summary.mean) / summary.deviation : 0;
    of[varying++] = i;
  }
  return varying - 1;
}

static double product(int n, const double *a, const double *b)
{
  double sum = 0;
  for (int i = 0; i < n; i++)
    sum += a[i] * b[i] / (n - 1);
  return sum;
}

/* Eigenvalues of R below belong to inputs that depend on each other, as those of a fixed sum do. */
static const double DEPENDENT = 1e-10;

/* R b = r with the correlations R of the inputs and r of inputs and output; R2 = b' r: theory (A7). Of dependent inputs
   the shortest b: what they do together is shared, and what they never do apart is not made up. */
static enum eo_code solve(struct eo_regression *regression, int n, int varying, const double *column, const int *of,
                          struct eo_error *error)
{
  size_t m = varying > 0 ? (size_t)varying : 0, rows = (size_t)n;
  double *vector = calloc(m * (m + 3) + 1, sizeof *vector), *value = vector + m * m, *with = value + m, *b = with + m;
  if (!vector)
    return eo_error_memory(error);
  for (size_t i = 0; i < m; i++) {
    with[i] = product(n, column + i * rows, column + m * rows);
    for (size_t j = 0; j < m; j++)
      vector[i * m + j] = product(n, column + i * rows, column + j * rows);
  }
  enum eo_code code = varying && eo_dense_symmetric_eigen(varying, vector, value) ? eo_error_memory(error) : EO_OK;
  int rank = 0;
  for (size_t i = 0; i < m && !code; i++)
    if (value[i] > DEPENDENT) {
      double part = eo_dot(varying, vector + i * m, with) / value[i];
      for (size_t j = 0; j < m; j++)
        b[j] += part * vector[i * m + j];
      rank++;
    }
  for (size_t i = 0; i < m; i++)
    regression->coefficient[of[i]] = b[i];
  bool constant = !(product(n, column + m * rows, column + m * rows) > 0);
  double r2 = eo_dot(varying, b, with);
  regression->r2 = constant ? NAN : r2;
  regression->r2_adjusted = constant ? NAN : 1 - (1 - r2) * (n - 1) / (n - 1 - rank);
  free(vector);
  return code;
}

enum eo_code eo_regression_run(struct eo_regression *regression, int n, int k, const double *input,
                               const double *output, struct eo_error *error)
{
  for (int i = 0; i < k; i++)
    regression->coefficient[i] = NAN;
  if (n < k + 2)
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "A regression on %d inputs takes %d rows or more, not %d.", k,
                        k + 2, n);
  double *column = malloc(sizeof *column * (size_t)(k + 1) * (size_t)n);
  int *of = malloc(sizeof *of * (size_t)(k + 1));
  enum eo_code code = column && of ? EO_OK : eo_error_memory(error);
  if (!code)
    code = solve(regression, n, standardise(n, k, input, output, column, of), column, of, error);
  free(column);
  free(of);
  return code;
}

/* The rows of one resample. */
static void draw_rows(int n, int k, const double *input, const double *output, struct eo_random random, double *own)
{
  double *own_output = own + (size_t)n * (size_t)k;
  for (int row = 0; row < n; row++) {
    size_t of = (size_t)eo_random_index(random, (uint64_t)row, n);
    memcpy(own + (size_t)row * (size_t)k, input + of * (size_t)k, sizeof *own * (size_t)k);
    own_output[row] = output[of];
  }
}

enum eo_code eo_regression_bootstrap(int n, int k, const double *input, const double *output, double level,
                                     int resamples, uint64_t seed, double (*interval)[2], struct eo_error *error)
{
  size_t rows = (size_t)n, columns = (size_t)k, each = (size_t)resamples;
  double *own = malloc(sizeof *own * (rows * (columns + 1) + columns * (each + 1)));
  enum eo_code code = own ? EO_OK : eo_error_memory(error);
  for (size_t r = 0; r < each && !code; r++) {
    double *drawn = own + rows * (columns + 1), *coefficient = drawn + columns * each;
    struct eo_regression regression = {.coefficient = coefficient};
    draw_rows(n, k, input, output, eo_random_at(seed, STREAM_RESAMPLE, 0, r), own);
    code = eo_regression_run(&regression, n, k, own, own + rows * columns, error);
    for (size_t i = 0; i < columns; i++)
      drawn[i * each + r] = isnan(coefficient[i]) ? 0 : coefficient[i];
  }
  for (size_t i = 0; i < columns && !code; i++) {
    double *drawn = own + rows * (columns + 1) + i * each;
    eo_sort_numbers(resamples, drawn);
    interval[i][0] = eo_percentile(resamples, drawn, 50 * (1 - level));
    interval[i][1] = eo_percentile(resamples, drawn, 50 * (1 + level));
  }
  free(own);
  return code;
}

void eo_order_by_size(int k, const double *value, int *rank)
{
  for (int i = 0; i < k; i++) {
    double size = isnan(value[i]) ? -1 : fabs(value[i]);
    int place = i;
    while (place > 0 && size > (isnan(value[rank[place - 1]]) ? -1 : fabs(value[rank[place - 1]]))) {
      rank[place] = rank[place - 1];
      place--;
    }
    rank[place] = i;
  }
}

struct sums {
  double mean, square;
  double *first, *total; /* [inputs] */
};

/* One pair of points a, b and those of a with one coordinate of b each:
   V_i = mean of f(b) (f(a_b^i) - f(a)), T_i = mean of (f(a) - f(a_b^i))^2 / 2: theory (A9). */
static void add_point(eo_unit_function *function, void *context, int inputs, double *u, double shift, struct sums *sums)
{
  const double *other = u + inputs;
  double at = function(context, u) - shift, beside = function(context, other) - shift;
  sums->mean += at + beside;
  sums->square += at * at + beside * beside;
  for (int i = 0; i < inputs; i++) {
    double kept = u[i];
    u[i] = other[i];
    double moved = function(context, u) - shift;
    u[i] = kept;
    sums->first[i] += beside * (moved - at);
    sums->total[i] += (at - moved) * (at - moved) / 2;
  }
}

enum eo_code eo_sobol_indices(eo_unit_function *function, void *context, int inputs, int points, uint64_t seed,
                              double *first, double *total, struct eo_error *error)
{
  struct eo_sampler *sampler;
  struct sums sums = {.first = first, .total = total};
  double *u = malloc(sizeof *u * (size_t)inputs * 2);
  if (!u)
    return eo_error_memory(error);
  enum eo_code code = eo_sampler_new(&sampler, EO_SAMPLING_SOBOL, 2 * inputs, points, seed, error);
  if (code) {
    free(u);
    return code;
  }
  memset(first, 0, sizeof *first * (size_t)inputs);
  memset(total, 0, sizeof *total * (size_t)inputs);
  for (int i = 0; i < inputs; i++)
    u[i] = 0.5;
  double shift = function(context, u); /* sums of products lose least round a typical value */
  for (int point = 0; point < points; point++) {
    eo_sampler_at(sampler, point, u);
    add_point(function, context, inputs, u, shift, &sums);
  }
  double mean = sums.mean / (2 * points), variance = sums.square / (2 * points) - mean * mean;
  for (int i = 0; i < inputs; i++) {
    first[i] /= points * variance;
    total[i] /= points * variance;
  }
  eo_sampler_free(sampler);
  free(u);
  return EO_OK;
}
