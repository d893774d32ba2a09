/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "optimizer/cube_warp.h"

#include "optimizer/operators.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LINES = 32, PASSES = 4, PARTS = EO_WARP_KNOTS - 1 };
/* Bounds are too wide for points that are spread evenly where half of what a variable shows lies within this part. */
static const double narrow = 0.1;
static const double even = 0.5; /* share of the steps that stay equal in x: no part gets less than half of its own */

static double at(const double *knot, double t)
{
  const double place = t * PARTS;
  const int i = place >= PARTS ? PARTS - 1 : (int)place;
  return place >= PARTS ? 1 : knot[i] + (place - i) * (knot[i + 1] - knot[i]);
}

/* way[i] += by how much the view changes from knot 0 to knot i, x[k] running, the others as they are. */
static void walk(const struct eo_cube_warp *warp, int k, double *x, double *seen[2], double *way)
{
  double sum = 0;
  for (int i = 0; i <= PARTS; i++) {
    double square = 0, *now = seen[i % 2], *before = seen[(i + 1) % 2];
    x[k] = warp->knot[k][i];
    warp->view.at(warp->view.context, x, now);
    for (int j = 0; j < warp->view.numbers && i > 0; j++)
      square += (now[j] - before[j]) * (now[j] - before[j]);
    sum += sqrt(square);
    way[i] += sum;
  }
}

/* Knots at equal shares of the way; where the view stays, equal in x. */
static void share_out(const double *old, double *way, double *knot)
{
  const double whole = way[PARTS];
  for (int i = 0; i <= PARTS; i++) /* theory (H9) */
    way[i] = whole > 0 ? (1 - even) * way[i] / whole + even * old[i] : old[i];
  int part = 0;
  for (int i = 0; i <= PARTS; i++) {
    const double wanted = (double)i / PARTS;
    while (part < PARTS - 1 && way[part + 1] < wanted)
      part++;
    knot[i] = old[part] + fmin(1, (wanted - way[part]) / (way[part + 1] - way[part])) * (old[part + 1] - old[part]);
  }
  knot[0] = 0;
  knot[PARTS] = 1;
}

/* x below which half of the way lies. */
static double half_way(const double *knot, const double *way)
{
  int i = 1;
  while (i < PARTS && way[i] < 0.5 * way[PARTS])
    i++;
  return way[PARTS] > 0 ? knot[i] : 1;
}

/* Along lines through points that are spread evenly over the cube as it was stretched before. Returns the least part of
   a variable in which half of what it shows lies. */
static double stretch(struct eo_cube_warp *warp, double *seen[2], double (*stretched)[EO_WARP_KNOTS])
{
  const int n = warp->variables;
  double x[EO_MAX_VARIABLES], least = 1;
  for (int k = 0; k < n; k++) {
    double way[EO_WARP_KNOTS] = {0};
    for (int line = 0; line < LINES; line++) {
      const struct eo_random random = eo_random_at(0, EO_STREAM_WARP, 0, (uint64_t)line);
      for (int j = 0; j < n; j++)
        x[j] = at(warp->knot[j], eo_random_unit(random, (uint64_t)j));
      walk(warp, k, x, seen, way);
    }
    least = fmin(least, half_way(warp->knot[k], way));
    share_out(warp->knot[k], way, stretched[k]);
  }
  memcpy(warp->knot, stretched, (size_t)n * sizeof *stretched);
  return least;
}

enum eo_code eo_cube_warp_init(struct eo_cube_warp *warp, const struct eo_view *view, int variables,
                               struct eo_error *error)
{
  *warp = (struct eo_cube_warp){.view = *view, .variables = variables};
  if (view->numbers == 0)
    return EO_OK;
  const size_t n = (size_t)variables;
  double(*stretched)[EO_WARP_KNOTS] = malloc(n * sizeof *stretched);
  double *seen[2];
  warp->knot = malloc(n * sizeof *warp->knot);
  for (int i = 0; i < 2; i++)
    seen[i] = malloc((size_t)view->numbers * sizeof **seen);
  const enum eo_code code = stretched && warp->knot && seen[0] && seen[1] ? EO_OK : eo_error_memory(error);
  for (int k = 0; k < variables && !code; k++)
    for (int i = 0; i <= PARTS; i++)
      warp->knot[k][i] = (double)i / PARTS;
  double least = 1;
  for (int pass = 0; pass < PASSES && !code; pass++)
    least = stretch(warp, seen, stretched);
  if (least > narrow) {
    free(warp->knot);
    warp->knot = NULL;
  }
  free(stretched);
  free(seen[0]);
  free(seen[1]);
  return code;
}

void eo_cube_warp_done(struct eo_cube_warp *warp)
{
  free(warp->knot);
  *warp = (struct eo_cube_warp){0};
}

void eo_cube_warp_out(const struct eo_cube_warp *warp, const double *t, double *x)
{
  for (int k = 0; k < warp->variables; k++)
    x[k] = warp->knot ? at(warp->knot[k], t[k]) : t[k];
}

void eo_cube_warp_in(const struct eo_cube_warp *warp, const double *x, double *t)
{
  for (int k = 0; k < warp->variables; k++) {
    if (!warp->knot) {
      t[k] = x[k];
      continue;
    }
    const double *knot = warp->knot[k];
    int i = 0;
    while (i < PARTS - 1 && knot[i + 1] < x[k])
      i++;
    t[k] = x[k] >= 1 ? 1 : fmin(1, (i + (x[k] - knot[i]) / (knot[i + 1] - knot[i])) / PARTS);
  }
}
