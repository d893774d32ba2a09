/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "optimizer/pareto.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool dominates(const double *a, double violation_a, const double *b, double violation_b, int objectives)
{
  if (violation_a != violation_b)
    return violation_a < violation_b;
  bool better = false;
  for (int k = 0; k < objectives; k++) {
    if (a[k] > b[k])
      return false;
    better |= a[k] < b[k];
  }
  return better;
}

static int count_dominators(const double *objective, const double *violation, int count, int objectives, int i,
                            const int *rank)
{
  int dominators = 0;
  for (int j = 0; j < count; j++)
    dominators += rank[j] < 0 && dominates(objective + (size_t)j * objectives, violation[j],
                                           objective + (size_t)i * objectives, violation[i], objectives);
  return dominators;
}

void eo_pareto_rank(const double *objective, const double *violation, int count, int objectives, int *rank,
                    int *scratch)
{
  int *dominators = scratch, *front = scratch + count;
  for (int i = 0; i < count; i++)
    rank[i] = -1;
  for (int i = 0; i < count; i++)
    dominators[i] = count_dominators(objective, violation, count, objectives, i, rank);
  for (int level = 0, ranked = 0; ranked < count; level++) {
    int size = 0;
    for (int i = 0; i < count; i++)
      if (rank[i] < 0 && dominators[i] == 0)
        front[size++] = i;
    for (int f = 0; f < size; f++)
      rank[front[f]] = level;
    for (int f = 0; f < size; f++)
      for (int j = 0; j < count; j++)
        dominators[j] -= rank[j] < 0 && dominates(objective + (size_t)front[f] * objectives, violation[front[f]],
                                                  objective + (size_t)j * objectives, violation[j], objectives);
    ranked += size;
  }
}

/* Sorts indices by key, then index: an insertion sort, the lists are short. */
static void sort_indices(int *index, int count, const double *key, int stride)
{
  for (int i = 1; i < count; i++) {
    const int moving = index[i];
    const double value = key[(size_t)moving * stride];
    int j = i;
    while (j > 0 && (key[(size_t)index[j - 1] * stride] > value ||
                     (key[(size_t)index[j - 1] * stride] == value && index[j - 1] > moving))) {
      index[j] = index[j - 1];
      j--;
    }
    index[j] = moving;
  }
}

static void add_crowding(const double *objective, int objectives, int k, const int *front, int size, double *crowding)
{
  const double low = objective[(size_t)front[0] * objectives + k],
               high = objective[(size_t)front[size - 1] * objectives + k];
  crowding[front[0]] = crowding[front[size - 1]] = INFINITY;
  for (int f = 1; f < size - 1 && high > low; f++)
    crowding[front[f]] +=
        (objective[(size_t)front[f + 1] * objectives + k] - objective[(size_t)front[f - 1] * objectives + k]) /
        (high - low);
}

void eo_pareto_crowding(const double *objective, const int *rank, int count, int objectives, double *crowding,
                        int *scratch)
{
  memset(crowding, 0, (size_t)count * sizeof *crowding);
  for (int level = 0, seen = 0; seen < count; level++) {
    int size = 0;
    for (int i = 0; i < count; i++)
      if (rank[i] == level)
        scratch[size++] = i;
    for (int k = 0; k < objectives && size > 0; k++) {
      sort_indices(scratch, size, objective + k, objectives);
      add_crowding(objective, objectives, k, scratch, size, crowding);
    }
    seen += size;
  }
}

void eo_pareto_order(const int *rank, const double *crowding, int count, int *order)
{
  for (int i = 0; i < count; i++) {
    int j = i;
    while (j > 0 &&
           (rank[order[j - 1]] > rank[i] || (rank[order[j - 1]] == rank[i] && crowding[order[j - 1]] < crowding[i]))) {
      order[j] = order[j - 1];
      j--;
    }
    order[j] = i;
  }
}

static bool is_dominated(const struct eo_archive *archive, int row)
{
  const int m = archive->objectives;
  for (int j = 0; j < archive->count; j++)
    if (dominates(archive->objective + (size_t)j * m, archive->violation[j], archive->objective + (size_t)row * m,
                  archive->violation[row], m))
      return true;
  return false;
}

static int find_knee(const struct eo_archive *archive, const int *front, int count)
{
  const int m = archive->objectives;
  double low[EO_MAX_OBJECTIVES], high[EO_MAX_OBJECTIVES], least = INFINITY;
  int knee = -1;
  for (int k = 0; k < m; k++) {
    low[k] = INFINITY;
    high[k] = -INFINITY;
    for (int f = 0; f < count; f++) {
      low[k] = fmin(low[k], archive->objective[(size_t)front[f] * m + k]);
      high[k] = fmax(high[k], archive->objective[(size_t)front[f] * m + k]);
    }
  }
  for (int f = 0; f < count; f++) {
    double sum = 0;
    for (int k = 0; k < m; k++)
      sum += high[k] > low[k] ? (archive->objective[(size_t)front[f] * m + k] - low[k]) / (high[k] - low[k]) : 0;
    if (sum < least) {
      least = sum;
      knee = front[f];
    }
  }
  return knee;
}

struct eo_front eo_pareto_front(const struct eo_archive *archive, int *front)
{
  struct eo_front result = {.knee = -1, .weighted = -1};
  if (archive->objectives == 0)
    return result;
  for (int row = 0; row < archive->count; row++)
    if (!eo_archive_failed(archive, row) && !is_dominated(archive, row))
      front[result.count++] = row;
  sort_indices(front, result.count, archive->objective, archive->objectives);
  result.knee = find_knee(archive, front, result.count);
  for (int f = 0; f < result.count; f++)
    if (result.weighted < 0 || archive->value[front[f]] < archive->value[result.weighted])
      result.weighted = front[f];
  return result;
}
