/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How much of the space of objectives a set of points dominates: what fronts are compared by. */
#ifndef EASEOFF_TESTS_SUPPORT_HYPERVOLUME_H
#define EASEOFF_TESTS_SUPPORT_HYPERVOLUME_H

#include "optimizer/pareto.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static void sort_points(double *point, int count, int objectives)
{
  const int last = objectives - 1;
  const size_t bytes = (size_t)objectives * sizeof *point;
  double moving[EO_MAX_OBJECTIVES];
  for (int i = 1; i < count; i++) {
    memcpy(moving, point + (size_t)i * objectives, bytes);
    int j = i;
    for (; j > 0 && point[(size_t)(j - 1) * objectives + last] > moving[last]; j--)
      memcpy(point + (size_t)j * objectives, point + (size_t)(j - 1) * objectives, bytes);
    memcpy(point + (size_t)j * objectives, moving, bytes);
  }
}

static double slice(const double *point, int count, int objectives, const double *reference);

/* Slabs along the last objective: the slab above point i is dominated by what points 0..i dominate in the others. */
static double sum_slabs(const double *point, int count, int objectives, const double *reference, double *projected)
{
  const int last = objectives - 1;
  double volume = 0;
  for (int i = 0; i < count; i++) {
    memcpy(projected + (size_t)i * last, point + (size_t)i * objectives, (size_t)last * sizeof *point);
    const double top = i + 1 < count ? fmin(point[(size_t)(i + 1) * objectives + last], reference[last])
                                     : reference[last];
    const double height = top - point[(size_t)i * objectives + last];
    if (height > 0)
      volume += height * slice(projected, i + 1, last, reference);
  }
  return volume;
}

static double slice(const double *point, int count, int objectives, const double *reference)
{
  if (objectives == 1) {
    double least = reference[0];
    for (int i = 0; i < count; i++)
      least = fmin(least, point[i]);
    return reference[0] - least;
  }
  double *copy = malloc((size_t)count * (size_t)(2 * objectives) * sizeof *copy);
  if (!copy)
    return NAN;
  memcpy(copy, point, (size_t)count * (size_t)objectives * sizeof *copy);
  sort_points(copy, count, objectives);
  const double volume = sum_slabs(copy, count, objectives, reference, copy + (size_t)count * objectives);
  free(copy);
  return volume;
}

/* Volume dominated within the box up to reference[objectives], by slicing (exact; meant for 2 and 3 objectives).
   Points beyond the reference count nothing. point: [count][objectives], reordered. */
static double hypervolume(double *point, int count, int objectives, const double *reference)
{
  int inside = 0;
  for (int i = 0; i < count; i++) {
    bool in = true;
    for (int k = 0; k < objectives; k++)
      in = in && point[(size_t)i * objectives + k] < reference[k];
    if (in)
      memmove(point + (size_t)inside++ * objectives, point + (size_t)i * objectives,
              (size_t)objectives * sizeof *point);
  }
  return inside == 0 ? 0 : slice(point, inside, objectives, reference);
}

#endif
