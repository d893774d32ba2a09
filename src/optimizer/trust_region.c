/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "optimizer/trust_region.h"

#include "optimizer/operators.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double reaches[] = {1, 2.5}; /* boxes tried side by side, in radii */
static const double smallest_radius = 1e-9, largest_radius = 0.5;
static const double shrink = 0.4, grow = 1.2; /* of the radius when nothing was gained, when the first box won */
static const double same = 1e-6;              /* squared distance, in radii, at which two points teach the same */
static const double ridge = 1e-8;
enum { REACHES = 2, SAMPLES = 200, MINIMISE_STEPS = 60, WANDER_STEPS = 10, SHRINK_STEPS = 8 };

enum eo_code eo_local_init(struct eo_local *local, const struct eo_anatomy *anatomy, int variables,
                           struct eo_error *error)
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
  const enum eo_tail tail = eo_surrogate_terms(EO_TAIL_QUADRATIC, variables) < rows_max ? EO_TAIL_QUADRATIC
                                                                                        : EO_TAIL_SEPARABLE;
  return eo_composite_init(&local->composite, anatomy, variables, rows_max, tail, error);
}

void eo_local_done(struct eo_local *local)
{
  free(local->row);
  free(local->distance);
  free(local->u);
  free(local->y);
  eo_composite_done(&local->composite);
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
    if (!eo_composite_takes(&local->composite, archive, row))
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
  local->low = INFINITY;
  local->high = -INFINITY;
  for (int j = 0; j < count; j++) {
    local->y[j] = archive->value[local->row[j]];
    local->low = fmin(local->low, local->y[j]);
    local->high = fmax(local->high, local->y[j]);
    for (int k = 0; k < n; k++)
      local->u[(size_t)j * n + k] = (archive->x[(size_t)local->row[j] * n + k] - centre[k]) / local->radius;
  }
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
    sum += w * local->composite.residual[j] * local->composite.residual[j];
    weights += w;
  }
  return sqrt(sum / weights);
}

static bool fit(struct eo_local *local, const struct eo_archive *archive, enum eo_tail tail, int count)
{
  const double range = local->high > local->low ? local->high - local->low : 1;
  const struct eo_composite_rows rows = {archive, count, local->row, local->u, local->y, local->low, range, 1};
  return eo_composite_fit(&local->composite, tail, ridge, &rows);
}

/* The tail with the least leave-one-out error stays fitted. */
static bool fit_best(struct eo_local *local, const struct eo_archive *archive, int count)
{
  int best = -1;
  double least = INFINITY;
  for (int tail = EO_TAIL_LINEAR; tail <= EO_TAIL_QUADRATIC; tail++) {
    if (count < eo_surrogate_terms((enum eo_tail)tail, local->variables) + 3 ||
        !fit(local, archive, (enum eo_tail)tail, count))
      continue;
    const double error = weighted_error(local, count);
    if (error < least) {
      least = error;
      best = tail;
    }
  }
  if (best >= 0 && (int)local->composite.surrogate.tail != best)
    return fit(local, archive, (enum eo_tail)best, count);
  return best >= 0;
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

/* The sample of the box farthest from all rows. */
static void fill_gap(const struct eo_local *local, const double *low, const double *high, int rows,
                     struct eo_random random, double *u)
{
  const int n = local->variables;
  double farthest = -1, sample[EO_MAX_VARIABLES];
  for (int i = 0; i < SAMPLES; i++) {
    for (int k = 0; k < n; k++)
      sample[k] = low[k] + (high[k] - low[k]) * eo_random_unit(random, (uint64_t)i * (uint64_t)n + (uint64_t)k);
    const double square = nearest_square(local->u, rows, n, sample);
    if (square > farthest) {
      farthest = square;
      memcpy(u, sample, (size_t)n * sizeof *u);
    }
  }
}

/* The part of a line through u that lies in the box: u + t direction for least <= t <= most. */
static void cut_line(int n, const double *u, const double *direction, const double *low, const double *high,
                     double *least, double *most)
{
  *least = -INFINITY;
  *most = INFINITY;
  for (int k = 0; k < n; k++) {
    if (direction[k] == 0)
      continue;
    const double to_low = (low[k] - u[k]) / direction[k], to_high = (high[k] - u[k]) / direction[k];
    *least = fmax(*least, fmin(to_low, to_high));
    *most = fmin(*most, fmax(to_low, to_high));
  }
}

/* One step along a random line to a point of the box where the surrogate is not above `level`; u stays when none is
   found. Draws n + SHRINK_STEPS numbers from first_draw on. */
static void step_along(struct eo_local *local, const double *low, const double *high, double level,
                       struct eo_random random, uint64_t first_draw, double *u)
{
  const int n = local->variables;
  double direction[EO_MAX_VARIABLES], trial[EO_MAX_VARIABLES], least, most;
  for (int k = 0; k < n; k++)
    direction[k] = eo_random_normal(random, first_draw + (uint64_t)k);
  cut_line(n, u, direction, low, high, &least, &most);
  for (int shrinking = 0; shrinking < SHRINK_STEPS; shrinking++) {
    const double t = least + (most - least) * eo_random_unit(random, 2 * (first_draw + (uint64_t)(n + shrinking)));
    for (int k = 0; k < n; k++)
      trial[k] = fmin(fmax(u[k] + t * direction[k], low[k]), high[k]);
    if (eo_composite_value(&local->composite, trial) <= level) {
      memcpy(u, trial, (size_t)n * sizeof *u);
      return;
    }
    *(t < 0 ? &least : &most) = t;
  }
}

/* A point where the surrogate still promises a gain: hit and run (Smith 1984) from u, a minimum, through the part of
   the box where the surrogate is not above `level`. It follows valleys that a sample of the box would miss. */
static void wander(struct eo_local *local, const double *low, const double *high, double level, struct eo_random random,
                   double *u)
{
  for (int step = 0; step < WANDER_STEPS; step++)
    step_along(local, low, high, level, random, (uint64_t)step * (local->variables + SHRINK_STEPS), u);
}

/* Where the proposals are made: u[count][variables] so far, and what they are made from. */
struct proposals {
  const double *centre;
  int rows;                         /* of the surrogate */
  double level;                     /* the surrogate at the centre */
  double minimum[EO_MAX_VARIABLES]; /* of the surrogate within the first reach */
  int attempts, count;
  double *u;
};

static bool is_new(const struct eo_local *local, const struct proposals *proposals, const double *u)
{
  const int n = local->variables;
  return fmin(nearest_square(local->u, proposals->rows, n, u), nearest_square(proposals->u, proposals->count, n, u)) >
         same;
}

/* The next proposal: the minimum within each reach first, then points that promise a gain. False when it would teach
   nothing new. */
static bool propose_next(struct eo_local *local, struct proposals *proposals, struct eo_random random)
{
  const int n = local->variables, attempt = proposals->attempts++;
  double low[EO_MAX_VARIABLES], high[EO_MAX_VARIABLES], *u = proposals->u + (size_t)proposals->count * n;
  if (attempt < REACHES) {
    box(local, proposals->centre, reaches[attempt], low, high);
    memset(u, 0, (size_t)n * sizeof *u);
    eo_composite_minimise(&local->composite, low, high, MINIMISE_STEPS, 1e-6, u);
    if (attempt == 0)
      memcpy(proposals->minimum, u, (size_t)n * sizeof *u);
  } else {
    box(local, proposals->centre, 1, low, high);
    memcpy(u, proposals->minimum, (size_t)n * sizeof *u);
    wander(local, low, high, proposals->level, random, u);
  }
  return is_new(local, proposals, u);
}

int eo_local_propose(struct eo_local *local, const struct eo_archive *archive, int centre, uint64_t seed,
                     int generation, int count, double *x)
{
  const int n = local->variables;
  struct proposals proposals = {.centre = archive->x + (size_t)centre * n, .u = x};
  local->centre_value = archive->value[centre];
  proposals.rows = gather(local, archive, proposals.centre);
  scale_rows(local, archive, proposals.centre, proposals.rows);
  if (fit_best(local, archive, proposals.rows)) {
    proposals.level = eo_composite_value(&local->composite, proposals.minimum); /* the centre is the origin */
    while (proposals.attempts < count) {
      proposals.count += propose_next(
          local, &proposals, eo_random_at(seed, EO_STREAM_LOCAL, (uint64_t)generation, (uint64_t)proposals.attempts));
      if (proposals.attempts == REACHES)
        local->reaching = proposals.count;
    }
  }
  if (proposals.count == 0 && count > 0) {
    double low[EO_MAX_VARIABLES], high[EO_MAX_VARIABLES];
    box(local, proposals.centre, 0.5, low, high);
    fill_gap(local, low, high, proposals.rows,
             eo_random_at(seed, EO_STREAM_LOCAL, (uint64_t)generation, (uint64_t)count), x);
    proposals.count = 1;
  }
  for (int i = 0; i < proposals.count; i++)
    for (int k = 0; k < n; k++)
      x[(size_t)i * n + k] = eo_unit_clip(proposals.centre[k] + local->radius * x[(size_t)i * n + k]);
  return proposals.count;
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
    local->radius *= shrink;
  else if (winner < local->reaching)
    local->radius *= winner == 0 ? grow : reaches[winner];
  local->radius = fmin(fmax(local->radius, smallest_radius), largest_radius);
}
