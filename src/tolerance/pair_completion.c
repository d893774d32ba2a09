/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tolerance/pair_completion.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/sort.h"
#include "base/random.h"
#include "tolerance/statistics.h"

enum { NEAREST = 8, STREAM_COMPLETION = 907 }; /* stream of the counter generator */

/* Half of the share over which the density of an output is taken. */
static const double SHARE_BESIDE = 0.02;

struct donor {
  double coarse, beside; /* beside: full number less the line */
};

/* Of one output: full pairs in the order of their coarse numbers, and the line through them. */
struct donors {
  int count;
  struct donor *donor;
  double mean_coarse, mean, slope;
  double squares; /* of the coarse numbers about their mean */
  double *beside; /* [count], sorted */
};

static int by_coarse(const void *a, const void *b)
{
  const struct donor *x = a, *y = b;
  return x->coarse != y->coarse ? (x->coarse > y->coarse) - (x->coarse < y->coarse)
                                : (x->beside > y->beside) - (x->beside < y->beside);
}

static double line_at(const struct donors *donors, double coarse)
{
  return donors->mean + donors->slope * (coarse - donors->mean_coarse);
}

static double coarse_of(const struct eo_completion *completion, int pair, int output)
{
  return completion->coarse[(size_t)pair * (size_t)completion->outputs + (size_t)output];
}

static double *output_of(const struct eo_completion *completion, int pair, int output)
{
  return &completion->output[(size_t)pair * (size_t)completion->outputs + (size_t)output];
}

static void fit_line(struct donors *donors)
{
  double mixed = 0;
  for (int i = 0; i < donors->count; i++) {
    donors->mean_coarse += donors->donor[i].coarse / donors->count;
    donors->mean += donors->donor[i].beside / donors->count;
  }
  for (int i = 0; i < donors->count; i++) {
    double from = donors->donor[i].coarse - donors->mean_coarse;
    donors->squares += from * from;
    mixed += from * (donors->donor[i].beside - donors->mean);
  }
  donors->slope = donors->squares > 0 ? mixed / donors->squares : 0;
}

static void donors_done(struct donors *donors)
{
  free(donors->donor);
  free(donors->beside);
  *donors = (struct donors){0};
}

static enum eo_code find_donors(struct donors *donors, const struct eo_completion *completion, int output,
                                struct eo_error *error)
{
  *donors = (struct donors){.donor = malloc(sizeof *donors->donor * (size_t)completion->pairs),
                            .beside = malloc(sizeof *donors->beside * (size_t)completion->pairs)};
  if (!donors->donor || !donors->beside) {
    donors_done(donors);
    return eo_error_memory(error);
  }
  for (int pair = 0; pair < completion->pairs; pair++) {
    struct donor donor = {coarse_of(completion, pair, output), *output_of(completion, pair, output)};
    if (completion->full[pair] && isfinite(donor.coarse) && isfinite(donor.beside))
      donors->donor[donors->count++] = donor;
  }
  fit_line(donors);
  for (int i = 0; i < donors->count; i++)
    donors->donor[i].beside -= line_at(donors, donors->donor[i].coarse);
  for (int i = 0; i < donors->count; i++)
    donors->beside[i] = donors->donor[i].beside;
  eo_sort_numbers(donors->count, donors->beside);
  qsort(donors->donor, (size_t)donors->count, sizeof *donors->donor, by_coarse);
  return EO_OK;
}

/* First of the nearest ones, and how many they are. */
static int nearest(const struct donors *donors, double coarse, int *count)
{
  int low = 0, high = donors->count;
  while (low < high) {
    int middle = (low + high) / 2;
    if (donors->donor[middle].coarse < coarse)
      low = middle + 1;
    else
      high = middle;
  }
  *count = donors->count < NEAREST ? donors->count : NEAREST;
  for (high = low; high - low < *count;)
    if (high == donors->count ||
        (low > 0 && coarse - donors->donor[low - 1].coarse <= donors->donor[high].coarse - coarse))
      low--;
    else
      high++;
  return low;
}

/* Root mean square of what is left, each pair left out of the line: as theory (A8). */
static double left_out(const struct donors *donors)
{
  double sum = 0;
  if (donors->count < 3)
    return NAN;
  for (int i = 0; i < donors->count; i++) {
    double from = donors->donor[i].coarse - donors->mean_coarse;
    double leverage = 1. / donors->count + (donors->squares > 0 ? from * from / donors->squares : 0);
    double own = donors->donor[i].beside / fmax(1 - leverage, 1e-9);
    sum += own * own;
  }
  return sqrt(sum / donors->count);
}

enum eo_code eo_completion_fill(const struct eo_completion *completion, int output, struct eo_completed *completed,
                                struct eo_error *error)
{
  struct donors donors;
  EO_TRY(find_donors(&donors, completion, output, error));
  *completed = (struct eo_completed){donors.count, left_out(&donors)};
  for (int pair = 0; pair < completion->pairs; pair++) {
    int count;
    double coarse = coarse_of(completion, pair, output), *own = output_of(completion, pair, output);
    if (completion->full[pair])
      continue;
    *own = NAN;
    if (!isfinite(coarse) || donors.count == 0)
      continue;
    int first = nearest(&donors, coarse, &count);
    struct eo_random random = eo_random_at(completion->seed, STREAM_COMPLETION, (uint64_t)output, (uint64_t)pair);
    /* theory (A11) */
    *own = line_at(&donors, coarse) + donors.donor[first + eo_random_index(random, 0, count)].beside;
  }
  donors_done(&donors);
  return EO_OK;
}

/* Number of the sorted values at or below one. */
static int rank_of(int n, const double *sorted, double value)
{
  int low = 0, high = n;
  while (low < high) {
    int middle = (low + high) / 2;
    if (sorted[middle] <= value)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/* Variance of whether a completed pair lies below: by the full pairs that it may be completed from, or by all of them
   where that is more. Few neighbours that happen to agree would say that nothing is open, and pairs in full would be
   sought only where they do not: what they have beside the line would be off to one side. */
static double share_of(const struct donors *donors, double coarse, double value)
{
  int count, below = 0;
  if (!isfinite(coarse) || donors->count == 0)
    return 0;
  double line = line_at(donors, coarse);
  int first = nearest(donors, coarse, &count), rank = rank_of(donors->count, donors->beside, value - line);
  for (int i = 0; i < count; i++)
    below += line + donors->donor[first + i].beside <= value;
  double near = (double)below * (count - below) / ((double)count * count), of = donors->count;
  return fmax(near, rank / of * (1 - rank / of));
}

/* Change of the percentile with the share below it. */
static double steepness(int rows, const double *sorted, double share)
{
  double low = fmax(0, share - SHARE_BESIDE), high = fmin(1, share + SHARE_BESIDE);
  return (eo_percentile(rows, sorted, 100 * high) - eo_percentile(rows, sorted, 100 * low)) / (high - low);
}

/* Variance that the completion adds to the share below a value, theory (A12): what was drawn is off by S/N with S =
   mean of p (1 - p), and the p are as good as the full pairs that they come from. share: as eo_completion_doubt(). */
static double added_variance(const struct eo_completion *completion, const struct donors *donors, int output, int rows,
                             double value, double *share)
{
  double sum = 0, n = rows;
  int completed = 0;
  for (int pair = 0; pair < completion->pairs; pair++) {
    double own = completion->full[pair] ? 0 : share_of(donors, coarse_of(completion, pair, output), value);
    completed += !completion->full[pair];
    sum += own;
    if (share)
      share[pair] = own;
  }
  return donors->count > 0 ? sum / n * (1 / n + completed / n / donors->count) : 0;
}

static double rows_as_open(double share, int rows, double added)
{
  double spread = share * (1 - share);
  return spread > 0 ? spread / (spread / rows + added) : 1 / (1. / rows + 4 * added);
}

/* The values that there are, in order; returns how many. */
static int sort_values(const struct eo_completion *completion, int output, double *sorted)
{
  int rows = 0;
  for (int pair = 0; pair < completion->pairs; pair++) {
    sorted[rows] = *output_of(completion, pair, output);
    rows += isfinite(sorted[rows]);
  }
  eo_sort_numbers(rows, sorted);
  return rows;
}

enum eo_code eo_completion_doubt(const struct eo_completion *completion, int output, double percent,
                                 struct eo_doubt *doubt, double *share, struct eo_error *error)
{
  struct donors donors = {0};
  double *sorted = malloc(sizeof *sorted * (size_t)completion->pairs);
  *doubt = (struct eo_doubt){NAN, NAN, 0};
  if (share)
    memset(share, 0, sizeof *share * (size_t)completion->pairs);
  enum eo_code code = sorted ? find_donors(&donors, completion, output, error) : eo_error_memory(error);
  int rows = code ? 0 : sort_values(completion, output, sorted);
  if (rows > 0) {
    doubt->value = eo_percentile(rows, sorted, percent);
    double added = added_variance(completion, &donors, output, rows, doubt->value, share);
    doubt->deviation = sqrt(added) * steepness(rows, sorted, percent / 100);
    doubt->rows = rows_as_open(percent / 100, rows, added);
  }
  donors_done(&donors);
  free(sorted);
  return code;
}

enum eo_code eo_completion_share(const struct eo_completion *completion, int output, double most,
                                 struct eo_doubt *doubt, struct eo_error *error)
{
  struct donors donors = {0};
  int rows = 0, below = 0;
  *doubt = (struct eo_doubt){NAN, NAN, 0};
  EO_TRY(find_donors(&donors, completion, output, error));
  for (int pair = 0; pair < completion->pairs; pair++) {
    double value = *output_of(completion, pair, output);
    rows += isfinite(value);
    below += value <= most;
  }
  if (rows > 0) {
    double added = added_variance(completion, &donors, output, rows, most, NULL);
    doubt->value = (double)below / rows;
    doubt->deviation = sqrt(added);
    doubt->rows = rows_as_open(doubt->value, rows, added);
  }
  donors_done(&donors);
  return EO_OK;
}
