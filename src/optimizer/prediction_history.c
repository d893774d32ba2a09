/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "optimizer/prediction_history.h"

#include "optimizer/operators.h"
#include "optimizer/rows.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct projection {
  double value;
  int row;
};

static enum eo_code enlarge(struct eo_history *history, int capacity, struct eo_error *error);

enum eo_code eo_history_init(struct eo_history *history, int variables, int capacity, struct eo_error *error)
{
  *history = (struct eo_history){.variables = variables};
  return enlarge(history, capacity, error);
}

void eo_history_done(struct eo_history *history)
{
  free(history->x);
  free(history->fitness);
  free(history->credibility);
  free(history->predicted);
  free(history->distance);
  free(history->weight);
  free(history->redundancy);
  free(history->removed);
  free(history->order);
  *history = (struct eo_history){0};
}

static enum eo_code enlarge(struct eo_history *history, int capacity, struct eo_error *error)
{
  const size_t c = (size_t)capacity;
  bool failed = false;
  history->x = eo_rows_grow(history->x, c * (size_t)history->variables, sizeof(double), &failed);
  history->fitness = eo_rows_grow(history->fitness, c, sizeof(double), &failed);
  history->credibility = eo_rows_grow(history->credibility, c, sizeof(double), &failed);
  history->predicted = eo_rows_grow(history->predicted, c, sizeof(bool), &failed);
  history->distance = eo_rows_grow(history->distance, c, sizeof(double), &failed);
  history->weight = eo_rows_grow(history->weight, c, sizeof(double), &failed);
  history->redundancy = eo_rows_grow(history->redundancy, c, sizeof(double), &failed);
  history->removed = eo_rows_grow(history->removed, c, sizeof(bool), &failed);
  history->order = eo_rows_grow(history->order, c, sizeof(struct projection), &failed);
  if (failed)
    return eo_error_memory(error);
  history->capacity = capacity;
  return EO_OK;
}

enum eo_code eo_history_add(struct eo_history *history, const double *x, double fitness, double credibility,
                            bool predicted, struct eo_error *error)
{
  if (history->count == history->capacity) {
    const enum eo_code code = enlarge(history, 2 * history->capacity + 1, error);
    if (code != EO_OK)
      return code;
  }
  const int row = history->count++, n = history->variables;
  memcpy(history->x + (size_t)row * n, x, (size_t)n * sizeof *x);
  history->fitness[row] = fitness;
  history->credibility[row] = credibility;
  history->predicted[row] = predicted;
  history->removed[row] = false;
  return EO_OK;
}

static void measure_distances(struct eo_history *history, bool rms, const double *x)
{
  const int n = history->variables;
  const double scale = rms ? 1 / sqrt(n) : 1;
  for (int j = 0; j < history->count; j++)
    history->distance[j] = scale * eo_unit_distance(history->x + (size_t)j * n, x, n);
}

/* (15) into history->weight, 0 outside the region; returns how many rows are inside. */
static int measure_weights(struct eo_history *history, const struct eo_history_law *law)
{
  const double *e = history->distance;
  double nearest = INFINITY, sum = 0;
  int region = 0;
  for (int j = 0; j < history->count; j++)
    nearest = fmin(nearest, e[j]);
  for (int j = 0; j < history->count; j++) {
    const bool inside = e[j] <= law->share_radius;
    const double w = inside || law->weights_over_all ? exp(-law->weight_decay * (e[j] - nearest)) : 0; /* theory (H1) */
    sum += w;
    region += inside;
    history->weight[j] = inside ? w : 0;
  }
  for (int j = 0; j < history->count; j++)
    history->weight[j] /= sum;
  return region;
}

struct eo_history_estimate eo_history_predict(struct eo_history *history, const struct eo_history_law *law,
                                              const double *x)
{
  struct eo_history_estimate estimate = {.fitness = NAN};
  measure_distances(history, law->rms, x);
  estimate.region = measure_weights(history, law);
  if (estimate.region == 0)
    return estimate;
  double credibility = 0, fitness = 0, low = INFINITY, high = 0;
  for (int j = 0; j < history->count; j++) {
    if (!(history->distance[j] <= law->share_radius))
      continue;
    credibility += history->weight[j] * history->credibility[j]; /* theory (H2) */
    fitness += history->weight[j] * history->fitness[j];         /* theory (H3) */
    low = fmin(low, history->credibility[j]);
    high = fmax(high, history->credibility[j]);
  }
  /* A mean stays within the range of its rows: rounding must not decide whether R reaches R*. */
  estimate.credibility = law->weights_over_all ? credibility : fmin(fmax(credibility, low), high);
  estimate.fitness = fitness;
  return estimate;
}

bool eo_history_trusts(const struct eo_history_estimate *estimate, double trust_threshold)
{
  const double rounding = 1e-12; /* R(i) is a rounded mean */
  return estimate->region > 0 && estimate->credibility >= trust_threshold - rounding;
}

static int compare_projections(const void *a, const void *b)
{
  const struct projection *projection = a, *this_projection = b;
  return projection->value != this_projection->value
             ? (projection->value > this_projection->value) - (projection->value < this_projection->value)
             : projection->row - this_projection->row;
}

/* (H4) of every row into history->redundancy. */
static void measure_redundancy(struct eo_history *history)
{
  const int n = history->variables, count = history->count;
  struct projection *order = history->order;
  memset(history->redundancy, 0, (size_t)count * sizeof *history->redundancy);
  for (int k = 0; k < n; k++) {
    for (int j = 0; j < count; j++)
      order[j] = (struct projection){history->x[(size_t)j * n + k], j};
    qsort(order, (size_t)count, sizeof *order, compare_projections);
    for (int j = 0; j < count; j++)
      /* theory (H4) */
      history->redundancy[order[j].row] += j == 0 || j == count - 1 ? INFINITY
                                                                    : order[j + 1].value - order[j - 1].value;
  }
}

/* A true row is replaced by another true row only. */
static bool has_twin(const struct eo_history *history, int row, double threshold)
{
  const int n = history->variables;
  for (int j = 0; j < history->count; j++)
    if (j != row && !history->removed[j] && (history->predicted[row] || !history->predicted[j]) &&
        eo_unit_distance(history->x + (size_t)j * n, history->x + (size_t)row * n, n) < threshold)
      return true;
  return false;
}

int eo_history_mark_redundant(struct eo_history *history, const struct eo_history_law *law)
{
  int removed = 0;
  measure_redundancy(history);
  for (int j = 0; j < history->count; j++) {
    if (!(history->redundancy[j] < law->redundancy_threshold))
      continue;
    history->removed[j] = law->literal_redundancy || has_twin(history, j, law->redundancy_threshold);
    removed += history->removed[j];
  }
  return removed;
}

int eo_history_decay(struct eo_history *history, const struct eo_history_law *law)
{
  int removed = 0;
  for (int j = 0; j < history->count; j++) {
    if (!history->predicted[j] || history->removed[j])
      continue;
    history->credibility[j] *= law->credibility_loss; /* theory (H5) */
    history->removed[j] = history->credibility[j] < law->removal_threshold;
    removed += history->removed[j];
  }
  return removed;
}

void eo_history_compact(struct eo_history *history)
{
  const int n = history->variables;
  int kept = 0;
  for (int j = 0; j < history->count; j++) {
    if (history->removed[j])
      continue;
    memmove(history->x + (size_t)kept * n, history->x + (size_t)j * n, (size_t)n * sizeof(double));
    history->fitness[kept] = history->fitness[j];
    history->credibility[kept] = history->credibility[j];
    history->predicted[kept] = history->predicted[j];
    history->removed[kept++] = false;
  }
  history->count = kept;
}
