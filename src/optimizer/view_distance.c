/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "optimizer/view_distance.h"

#include "optimizer/operators.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PAIRS = 256 };

/* asked: a point as the caller knows it. */
static void look(const struct eo_view_distance *distance, const double *asked, double *seen)
{
  const struct eo_view *view = &distance->warp->view;
  if (view->numbers)
    view->at(view->context, asked, seen);
  else
    memcpy(seen, asked, (size_t)distance->numbers * sizeof *seen);
}

static double raw_distance(const struct eo_view_distance *distance, const double *a, const double *b)
{
  double sum = 0;
  for (int j = 0; j < distance->numbers; j++)
    sum += (a[j] - b[j]) * (a[j] - b[j]);
  return sqrt(sum);
}

/* The root mean square of the distances of random points in a cube is sqrt(n / 6). */
static void set_scale(struct eo_view_distance *distance)
{
  const int n = distance->warp->variables;
  double x[EO_MAX_VARIABLES], sum = 0, *pair[2] = {distance->row, distance->point};
  for (int i = 0; i < PAIRS; i++) {
    for (int side = 0; side < 2; side++) {
      const struct eo_random random = eo_random_at(0, EO_STREAM_PAIRS, (uint64_t)side, (uint64_t)i);
      for (int k = 0; k < n; k++)
        x[k] = eo_random_unit(random, (uint64_t)k);
      eo_cube_warp_out(distance->warp, x, x);
      look(distance, x, pair[side]);
    }
    const double apart = raw_distance(distance, pair[0], pair[1]);
    sum += apart * apart / PAIRS;
  }
  distance->scale = sum > 0 ? sqrt(n / 6. / sum) : 0;
}

static enum eo_code reserve(struct eo_view_distance *distance, int rows, struct eo_error *error)
{
  if (rows <= distance->capacity)
    return EO_OK;
  double *larger = realloc(distance->row, 2 * (size_t)rows * (size_t)distance->numbers * sizeof *larger);
  if (!larger)
    return eo_error_memory(error);
  distance->row = larger;
  distance->capacity = 2 * rows;
  return EO_OK;
}

enum eo_code eo_view_distance_init(struct eo_view_distance *distance, const struct eo_cube_warp *warp,
                                   struct eo_error *error)
{
  const int numbers = warp->view.numbers;
  *distance = (struct eo_view_distance){.warp = warp, .numbers = numbers ? numbers : warp->variables, .scale = 1};
  distance->point = malloc((size_t)distance->numbers * sizeof(double));
  if (!distance->point)
    return eo_error_memory(error);
  const enum eo_code code = reserve(distance, 64, error);
  if (code == EO_OK && numbers)
    set_scale(distance);
  return code;
}

void eo_view_distance_done(struct eo_view_distance *distance)
{
  free(distance->row);
  free(distance->point);
  *distance = (struct eo_view_distance){0};
}

static double *row_at(const struct eo_view_distance *distance, int row)
{
  return distance->row + (size_t)row * (size_t)distance->numbers;
}

enum eo_code eo_view_distance_follow(struct eo_view_distance *distance, const struct eo_archive *archive,
                                     struct eo_error *error)
{
  const enum eo_code code = reserve(distance, archive->count, error);
  for (; distance->count < archive->count && code == EO_OK; distance->count++)
    look(distance, archive->asked + (size_t)distance->count * (size_t)archive->variables,
         row_at(distance, distance->count));
  return code;
}

void eo_view_distance_visit(struct eo_view_distance *distance, const double *x)
{
  double asked[EO_MAX_VARIABLES];
  eo_cube_warp_out(distance->warp, x, asked);
  look(distance, asked, distance->point);
}

double eo_view_distance_from(const struct eo_view_distance *distance, int row)
{
  return distance->scale * raw_distance(distance, row_at(distance, row), distance->point);
}

double eo_view_distance_between(const struct eo_view_distance *distance, int row, int other)
{
  return distance->scale * raw_distance(distance, row_at(distance, row), row_at(distance, other));
}
