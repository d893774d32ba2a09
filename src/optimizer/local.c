#include "optimizer/local.h"

#include "numerics/minimise.h"
#include "optimizer/operators.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double reaches[] = {1, 2.5}; /* boxes tried side by side, in radii */
static const double smallest_radius = 1e-9, largest_radius = 0.5;
static const double ridge = 1e-8;
enum { REACHES = 2, SAMPLES = 200, MINIMISE_STEPS = 60, WANDER_STEPS = 10 };
static const double gain_kept = 0.5;
static const int level_samples = 1;

enum eo_code eo_local_init(struct eo_local *local, int variables, struct eo_error *error)
{
  int rows_max = 2 * eo_surrogate_terms(EO_TAIL_QUADRATIC, variables);
  rows_max = rows_max > 200 ? 200 : rows_max < 40 ? 40 : rows_max;
  *local = (struct eo_local){.variables = variables, .rows_max = rows_max};
  const size_t m = (size_t)rows_max;
  local->row = malloc(m * sizeof(int));
  local->distance = malloc(m * sizeof(double));
  local->u = malloc(m * (size_t)variables * sizeof(double));
  local->y = malloc(m * sizeof(double));
  if (!local->row || !local->distance || !local->u || !local->y)
    return eo_error_memory(error);
  const enum eo_tail tail = eo_surrogate_terms(EO_TAIL_QUADRATIC, variables) < rows_max ? EO_TAIL_QUADRATIC : EO_TAIL_SEPARABLE;
  return eo_surrogate_init(&local->surrogate, variables, rows_max, 1, tail, error);
}

void eo_local_done(struct eo_local *local)
{
  free(local->row);
  free(local->distance);
  free(local->u);
  free(local->y);
  eo_surrogate_done(&local->surrogate);
  *local = (struct eo_local){0};
}

void eo_local_restart(struct eo_local *local, double radius)
{
  local->radius = radius;
}

/* The nearest rows of the archive, nearest first. */
static int gather(struct eo_local *local, const struct eo_archive *archive, const double *centre)
{
  const int n = local->variables;
  int count = 0;
  for (int row = 0; row < archive->count; row++) {
    if (eo_archive_failed(archive, row))
      continue;
    double sum = 0;
    for (int k = 0; k < n; k++)
      sum += (archive->x[(size_t)row * n + k] - centre[k]) * (archive->x[(size_t)row * n + k] - centre[k]);
    if (count == local->rows_max && sum >= local->distance[count - 1])
      continue;
    int j = count < local->rows_max ? count++ : count - 1;
    for (; j > 0 && local->distance[j - 1] > sum; j--) {
      local->distance[j] = local->distance[j - 1];
      local->row[j] = local->row[j - 1];
    }
    local->distance[j] = sum;
    local->row[j] = row;
  }
  return count;
}

static void scale_rows(struct eo_local *local, const struct eo_archive *archive, const double *centre, int count)
{
  const int n = local->variables;
  double low = INFINITY, high = -INFINITY;
  for (int j = 0; j < count; j++) {
    local->y[j] = archive->value[local->row[j]];
    low = fmin(low, local->y[j]);
    high = fmax(high, local->y[j]);
    for (int k = 0; k < n; k++)
      local->u[(size_t)j * n + k] = (archive->x[(size_t)local->row[j] * n + k] - centre[k]) / local->radius;
  }
  for (int j = 0; j < count; j++)
    local->y[j] = high > low ? (local->y[j] - low) / (high - low) : 0;
}

/* Leave-one-out error where it matters: rows near the centre count most. */
static double weighted_error(const struct eo_local *local, int count)
{
  double sum = 0, weights = 0;
  for (int j = 0; j < count; j++) {
    double square = 0;
    for (int k = 0; k < local->variables; k++)
      square += local->u[(size_t)j * local->variables + k] * local->u[(size_t)j * local->variables + k];
    const double w = 1 / (1 + square * square);
    sum += w * local->surrogate.residual[j] * local->surrogate.residual[j];
    weights += w;
  }
  return sqrt(sum / weights);
}

/* The tail with the least leave-one-out error stays fitted. */
static bool fit_best(struct eo_local *local, int count)
{
  struct eo_surrogate *s = &local->surrogate;
  int best = -1;
  double least = INFINITY;
  for (int tail = EO_TAIL_LINEAR; tail <= EO_TAIL_QUADRATIC; tail++) {
    if (count < eo_surrogate_terms((enum eo_tail)tail, local->variables) + 3 ||
        !eo_surrogate_fit(s, (enum eo_tail)tail, ridge, local->u, local->y, count, 1))
      continue;
    const double error = weighted_error(local, count);
    if (error < least) {
      least = error;
      best = tail;
    }
  }
  if (best >= 0 && (int)s->tail != best)
    return eo_surrogate_fit(s, (enum eo_tail)best, ridge, local->u, local->y, count, 1);
  return best >= 0;
}

static double surrogate_at(void *context, const double *x, double *gradient)
{
  struct eo_surrogate *s = context;
  eo_surrogate_visit(s, x);
  eo_surrogate_gradient(s, 0, gradient);
  return eo_surrogate_value(s, 0);
}

static void box(const struct eo_local *local, const double *centre, double reach, double *low, double *high)
{
  for (int k = 0; k < local->variables; k++) {
    low[k] = fmax(-reach, -centre[k] / local->radius);
    high[k] = fmin(reach, (1 - centre[k]) / local->radius);
  }
}

static double nearest_square(const double *points, int count, int n, const double *u)
{
  double nearest = INFINITY;
  for (int j = 0; j < count; j++) {
    double sum = 0;
    for (int k = 0; k < n; k++)
      sum += (points[(size_t)j * n + k] - u[k]) * (points[(size_t)j * n + k] - u[k]);
    nearest = fmin(nearest, sum);
  }
  return nearest;
}

/* The sample of the box farthest from all rows and proposals. */
static void fill_gap(const struct eo_local *local, const double *low, const double *high, int rows, const double *proposed,
                     int proposed_count, struct eo_random random, double *u)
{
  const int n = local->variables;
  double farthest = -1, sample[EO_MAX_VARIABLES];
  for (int i = 0; i < SAMPLES; i++) {
    for (int k = 0; k < n; k++)
      sample[k] = low[k] + (high[k] - low[k]) * eo_random_unit(random, (uint64_t)i * (uint64_t)n + (uint64_t)k);
    const double square = fmin(nearest_square(local->u, rows, n, sample), nearest_square(proposed, proposed_count, n, sample));
    if (square > farthest) {
      farthest = square;
      memcpy(u, sample, (size_t)n * sizeof *u);
    }
  }
}

/* A point where the surrogate still promises a gain: hit and run (Smith 1984) from the minimum through the part of the
   box where the surrogate stays below `level`. */
static void wander(struct eo_local *local, const double *low, const double *high, const double *from, double level,
                   struct eo_random random, double *u)
{
  const int n = local->variables;
  double direction[EO_MAX_VARIABLES], trial[EO_MAX_VARIABLES];
  uint64_t draw = 0;
  memcpy(u, from, (size_t)n * sizeof *u);
  for (int step = 0; step < WANDER_STEPS; step++) {
    double length = 0, least = -INFINITY, most = INFINITY;
    for (int k = 0; k < n; k++) {
      direction[k] = eo_random_normal(random, draw++);
      length += direction[k] * direction[k];
    }
    for (int k = 0; k < n; k++) {
      direction[k] /= sqrt(length);
      const double to_low = (low[k] - u[k]) / direction[k], to_high = (high[k] - u[k]) / direction[k];
      least = fmax(least, fmin(to_low, to_high));
      most = fmin(most, fmax(to_low, to_high));
    }
    for (int shrink = 0; shrink < 8; shrink++) {
      const double t = least + (most - least) * eo_random_unit(random, 1000000 + draw++);
      for (int k = 0; k < n; k++)
        trial[k] = fmin(fmax(u[k] + t * direction[k], low[k]), high[k]);
      eo_surrogate_visit(&local->surrogate, trial);
      if (eo_surrogate_value(&local->surrogate, 0) <= level) {
        memcpy(u, trial, (size_t)n * sizeof *u);
        break;
      }
      if (t < 0)
        least = t;
      else
        most = t;
    }
  }
}

int eo_local_propose(struct eo_local *local, const struct eo_archive *archive, int centre, uint64_t seed, int generation,
                     int count, double *x)
{
  const int n = local->variables;
  const double *c = archive->x + (size_t)centre * n;
  double low[EO_MAX_VARIABLES], high[EO_MAX_VARIABLES];
  const int rows = gather(local, archive, c);
  local->centre_value = archive->value[centre];
  scale_rows(local, archive, c, rows);
  const bool fitted = fit_best(local, rows);
  double level = 0;
  for (int i = 0; i < count; i++) { /* x holds u until the end */
    double *u = x + (size_t)i * n;
    const struct eo_random random = eo_random_at(seed, EO_STREAM_LOCAL, (uint64_t)generation, (uint64_t)i);
    box(local, c, i < REACHES ? reaches[i] : 1, low, high);
    if (fitted && i < REACHES) {
      memset(u, 0, (size_t)n * sizeof *u);
      const double least = eo_minimise(surrogate_at, &local->surrogate, low, high, n, MINIMISE_STEPS, 1e-6, u);
      if (i == 0) {
        memset(low, 0, sizeof low);
        eo_surrogate_visit(&local->surrogate, low);
        level = least + gain_kept * (eo_surrogate_value(&local->surrogate, 0) - least);
      }
      if (fmin(nearest_square(local->u, rows, n, u), nearest_square(x, i, n, u)) > 1e-6)
        continue;
    }
    box(local, c, 1, low, high);
    if (fitted && i > 0 && level_samples)
      wander(local, low, high, x, level, random, u);
    else {
      box(local, c, 0.5, low, high);
      fill_gap(local, low, high, rows, x, i, random, u);
    }
  }
  for (int i = 0; i < count; i++)
    for (int k = 0; k < n; k++)
      x[(size_t)i * n + k] = eo_unit_clip(c[k] + local->radius * x[(size_t)i * n + k]);
  return count;
}

void eo_local_learn(struct eo_local *local, const struct eo_archive *archive, int first, int count)
{
  int winner = -1;
  double best = local->centre_value;
  for (int i = 0; i < count; i++)
    if (archive->value[first + i] < best) {
      best = archive->value[first + i];
      winner = i;
    }
  if (winner < 0)
    local->radius *= 0.4;
  else if (winner < REACHES)
    local->radius *= reaches[winner] > 1 ? reaches[winner] : reaches[winner] < 1 ? 0.6 : 1.2;
  local->radius = fmin(fmax(local->radius, smallest_radius), largest_radius);
}
