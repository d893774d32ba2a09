/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "optimizer/credibility_pool.h"

#include "optimizer/operators.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double spread[] = {0, 0, 0.003, 0.003, 0.01, 0.03, 0.1, 0.2}; /* distances to keep, over sqrt n */
enum { SPREADS = 8, ROUNDS = 3 };

enum eo_code eo_credibility_pool_init(struct eo_credibility_pool *pool, const struct eo_optimizer_settings *settings,
                                      struct eo_error *error)
{
  const int samples = settings->evolution_samples * settings->batch;
  const size_t n = (size_t)settings->variables, parents = (size_t)settings->population;
  const size_t capacity = (size_t)(samples > settings->children ? samples : settings->children);
  *pool = (struct eo_credibility_pool){.settings = settings};
  pool->x = malloc(capacity * n * sizeof(double));
  pool->score = malloc(capacity * sizeof(double));
  pool->order = malloc(capacity * sizeof(int));
  pool->barred = malloc(capacity * sizeof(bool));
  pool->gap = malloc(capacity * sizeof(double));
  pool->parents = malloc(parents * n * sizeof(double));
  pool->parent_score = malloc(parents * sizeof(double));
  return pool->x && pool->score && pool->order && pool->barred && pool->gap && pool->parents && pool->parent_score
             ? EO_OK
             : eo_error_memory(error);
}

void eo_credibility_pool_done(struct eo_credibility_pool *pool)
{
  free(pool->x);
  free(pool->score);
  free(pool->order);
  free(pool->barred);
  free(pool->gap);
  free(pool->parents);
  free(pool->parent_score);
  *pool = (struct eo_credibility_pool){0};
}

static double *point(const struct eo_credibility_pool *pool, int i)
{
  return pool->x + (size_t)i * pool->settings->variables;
}

const double *eo_credibility_pool_at(const struct eo_credibility_pool *pool, int rank)
{
  return point(pool, pool->order[rank]);
}

/* Equal scores keep their order. */
static void rank(struct eo_credibility_pool *pool)
{
  for (int i = 0; i < pool->count; i++) {
    int j = i;
    for (; j > 0 && pool->score[pool->order[j - 1]] < pool->score[i]; j--)
      pool->order[j] = pool->order[j - 1];
    pool->order[j] = i;
  }
}

static void take_rows(struct eo_credibility_pool *pool, const struct eo_archive *archive, const int *row, int count)
{
  const size_t n = (size_t)pool->settings->variables;
  pool->parents_count = count;
  for (int i = 0; i < count; i++) {
    memcpy(pool->parents + (size_t)i * n, archive->x + (size_t)row[i] * n, n * sizeof(double));
    pool->parent_score[i] = -archive->value[row[i]];
  }
}

static void take_best(struct eo_credibility_pool *pool)
{
  const size_t n = (size_t)pool->settings->variables;
  const int most = pool->settings->population;
  pool->parents_count = pool->count < most ? pool->count : most;
  for (int i = 0; i < pool->parents_count; i++) {
    memcpy(pool->parents + (size_t)i * n, eo_credibility_pool_at(pool, i), n * sizeof(double));
    pool->parent_score[i] = pool->score[pool->order[i]];
  }
}

void eo_credibility_pool_breed(struct eo_credibility_pool *pool, struct eo_credibility_model *model,
                               const struct eo_archive *archive, const int *row, int count, int batch)
{
  pool->count = pool->settings->children;
  take_rows(pool, archive, row, count);
  for (int round = 0; round < ROUNDS; round++) {
    if (round > 0)
      take_best(pool);
    eo_breed(pool->settings, pool->parents, pool->parent_score, pool->parents_count, ROUNDS * batch + round, 0, pool->x,
             pool->count);
    for (int i = 0; i < pool->count; i++)
      pool->score[i] = eo_credibility_score(model, point(pool, i));
    rank(pool);
  }
}

void eo_credibility_pool_sample(struct eo_credibility_pool *pool, struct eo_credibility_model *model,
                                const struct eo_evolution *evolution, int count, int batch)
{
  pool->count = count;
  for (int i = 0; i < count; i++) {
    eo_evolution_sample(evolution,
                        eo_random_at(pool->settings->seed, EO_STREAM_EVOLUTION, (uint64_t)batch, (uint64_t)i),
                        point(pool, i));
    pool->score[i] = eo_credibility_predict(model, point(pool, i));
  }
  rank(pool);
}

static double nearest(const double *points, int count, const double *x, int n)
{
  double least = INFINITY;
  for (int j = 0; j < count; j++) {
    double sum = 0;
    for (int k = 0; k < n; k++)
      sum += (points[(size_t)j * n + k] - x[k]) * (points[(size_t)j * n + k] - x[k]);
    least = sum < least ? sum : least;
  }
  return sqrt(least);
}

int eo_credibility_pool_spread(struct eo_credibility_pool *pool, const struct eo_archive *archive, double *chosen,
                               int first, int count)
{
  const int n = pool->settings->variables, places = count - first;
  for (int i = 0; i < pool->count; i++)
    pool->gap[i] = pool->barred[i] ? -1 : nearest(archive->x, archive->count, point(pool, i), n);
  count = first;
  for (int place = 0; place < places; place++) {
    const double apart = sqrt(n) * spread[place * SPREADS / places];
    for (int i = 0; i < pool->count; i++) {
      const double *x = eo_credibility_pool_at(pool, i);
      if (pool->gap[pool->order[i]] <= apart || nearest(chosen, count, x, n) <= apart)
        continue;
      memcpy(chosen + (size_t)count++ * n, x, (size_t)n * sizeof(double));
      break;
    }
  }
  return count;
}
