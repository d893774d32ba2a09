/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "optimizer/operators.h"

#include <math.h>
#include <string.h>

void eo_random_points(double *x, int count, int n, uint64_t seed)
{
  for (int i = 0; i < count; i++) {
    const struct eo_random random = eo_random_at(seed, EO_STREAM_START, 0, (uint64_t)i);
    for (int k = 0; k < n; k++)
      x[i * n + k] = eo_random_unit(random, (uint64_t)k);
  }
}

static int tournament(struct eo_random random, uint64_t draw, const double *fitness, int size)
{
  const int a = eo_random_index(random, draw, size), b = eo_random_index(random, draw + 1, size);
  return fitness[a] > fitness[b] ? a : b;
}

static double crossover_spread(double u, double index)
{
  return u <= 0.5 ? pow(2 * u, 1 / (index + 1)) : pow(1 / (2 * (1 - u)), 1 / (index + 1));
}

/* a and b, [n], become the two children. */
static void cross(const struct eo_optimizer_settings *settings, struct eo_random random, double *a, double *b)
{
  if (eo_random_unit(random, 0) >= settings->crossover)
    return;
  for (int k = 0; k < settings->variables; k++) {
    const uint64_t draw = 1 + 2 * (uint64_t)k;
    if (eo_random_unit(random, draw) >= 0.5)
      continue;
    const double spread = crossover_spread(eo_random_unit(random, draw + 1), settings->crossover_index);
    const double first = 0.5 * ((1 + spread) * a[k] + (1 - spread) * b[k]);
    const double second = 0.5 * ((1 - spread) * a[k] + (1 + spread) * b[k]);
    a[k] = eo_unit_clip(first);
    b[k] = eo_unit_clip(second);
  }
}

static double mutation_step(double u, double index)
{
  return u < 0.5 ? pow(2 * u, 1 / (index + 1)) - 1 : 1 - pow(2 * (1 - u), 1 / (index + 1));
}

static void mutate(const struct eo_optimizer_settings *settings, struct eo_random random, double *x)
{
  double rate = settings->mutation;
  if (settings->mutation_mode == EO_MUTATE_INDIVIDUAL) {
    if (eo_random_unit(random, 0) >= settings->mutation)
      return;
    rate = 1.0 / settings->variables;
  }
  for (int k = 0; k < settings->variables; k++) {
    const uint64_t draw = 1 + 2 * (uint64_t)k;
    if (eo_random_unit(random, draw) < rate)
      x[k] = eo_unit_clip(x[k] + mutation_step(eo_random_unit(random, draw + 1), settings->mutation_index));
  }
}

void eo_breed(const struct eo_optimizer_settings *settings, const double *parents, const double *fitness, int size,
              int generation, int first_child, double *children, int count)
{
  const int n = settings->variables;
  const size_t bytes = (size_t)n * sizeof(double);
  const uint64_t seed = settings->seed, g = (uint64_t)generation;
  double pair[2][EO_MAX_VARIABLES];
  for (int i = 0; i < count; i += 2) {
    const uint64_t p = (uint64_t)(first_child + i) / 2;
    const struct eo_random choice = eo_random_at(seed, EO_STREAM_TOURNAMENT, g, p);
    for (int side = 0; side < 2; side++)
      memcpy(pair[side], parents + (size_t)tournament(choice, 2 * (uint64_t)side, fitness, size) * n, bytes);
    cross(settings, eo_random_at(seed, EO_STREAM_CROSSOVER, g, p), pair[0], pair[1]);
    for (int side = 0; side < 2 && i + side < count; side++) {
      mutate(settings, eo_random_at(seed, EO_STREAM_MUTATION, g, (uint64_t)first_child + i + side), pair[side]);
      memcpy(children + (size_t)(i + side) * n, pair[side], bytes);
    }
  }
}

static int rank_of(const double *keys, int count, int i)
{
  int rank = 0;
  for (int j = 0; j < count; j++)
    rank += keys[j] < keys[i] || (j < i && keys[j] == keys[i]);
  return rank;
}

void eo_latin_hypercube(double *x, int count, int n, uint64_t seed, int epoch, double *scratch)
{
  const uint64_t e = (uint64_t)epoch;
  for (int k = 0; k < n; k++) {
    const uint64_t draw = (uint64_t)k;
    for (int i = 0; i < count; i++)
      scratch[i] = eo_random_unit(eo_random_at(seed, EO_STREAM_LATIN_ORDER, e, (uint64_t)i), draw);
    for (int i = 0; i < count; i++) {
      const int cell = rank_of(scratch, count, i);
      x[i * n + k] = (cell + eo_random_unit(eo_random_at(seed, EO_STREAM_LATIN_JITTER, e, (uint64_t)cell), draw)) /
                     count;
    }
  }
}
