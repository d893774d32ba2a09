/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/patch.h"

#include <math.h>
#include <string.h>

#include "numerics/dense.h"

enum { DEGREE = 3 };

struct eo_patch_sites eo_patch_even_sites(int count)
{
  struct eo_patch_sites sites = {.count = count};
  for (int i = 0; i < count; i++)
    sites.at[i] = (double)i / (count - 1);
  return sites;
}

bool eo_patch_halve(struct eo_patch_sites *sites, const bool wide[EO_PATCH_MOST])
{
  const struct eo_patch_sites before = *sites;
  int room = EO_PATCH_MOST - before.count;
  sites->count = 0;
  for (int i = 0; i < before.count; i++) {
    sites->at[sites->count++] = before.at[i];
    if (i + 1 < before.count && wide[i] && room-- > 0)
      sites->at[sites->count++] = (before.at[i] + before.at[i + 1]) / 2;
  }
  return sites->count > before.count;
}

static void make_knots(const struct eo_patch_sites *sites, double *knot)
{
  int count = sites->count;
  for (int i = 0; i <= DEGREE; i++) {
    knot[i] = 0;
    knot[count + i] = 1;
  }
  for (int i = 1; i < count - DEGREE; i++)
    knot[DEGREE + i] = (sites->at[i] + sites->at[i + 1] + sites->at[i + 2]) / 3;
}

/* The four basis functions that are not 0 at t (Cox and de Boor); returns the index of the first. */
static int basis(const double *knot, int count, double t, double value[DEGREE + 1])
{
  int span = DEGREE;
  double left[DEGREE + 1], right[DEGREE + 1];
  while (span < count - 1 && t >= knot[span + 1])
    span++;
  value[0] = 1;
  for (int j = 1; j <= DEGREE; j++) {
    double saved = 0;
    left[j] = t - knot[span + 1 - j];
    right[j] = knot[span + j] - t;
    for (int r = 0; r < j; r++) {
      double part = value[r] / (right[r + 1] + left[j - r]);
      value[r] = saved + right[r + 1] * part;
      saved = left[j - r] * part;
    }
    value[j] = saved;
  }
  return span - DEGREE;
}

/* Control points from points, along one direction: rhs[columns][count]. */
static bool solve(const struct eo_patch_sites *sites, const double *knot, int columns, double *rhs)
{
  double matrix[EO_PATCH_MOST * EO_PATCH_MOST] = {0}, value[DEGREE + 1];
  int pivot[EO_PATCH_MOST], count = sites->count;
  for (int i = 0; i < count; i++) {
    int first = basis(knot, count, sites->at[i], value);
    for (int k = 0; k <= DEGREE; k++)
      matrix[i * count + first + k] = value[k];
  }
  return eo_dense_solve(count, matrix, pivot, columns, rhs) == 0;
}

bool eo_patch_fit(struct eo_patch *patch, const struct eo_patch_sites *const sites[2], eo_patch_surface *surface,
                  const void *context)
{
  static const int coordinates = 3;
  double rhs[3 * EO_PATCH_MOST * EO_PATCH_MOST];
  const int count[2] = {sites[0]->count, sites[1]->count};
  for (int d = 0; d < 2; d++) {
    patch->sites[d] = *sites[d];
    make_knots(sites[d], patch->knot[d]);
  }
  for (int j = 0; j < count[1]; j++)
    for (int i = 0; i < count[0]; i++)
      surface(context, sites[0]->at[i], sites[1]->at[j], patch->control[i * count[1] + j], NULL);
  for (int i = 0; i < count[0]; i++) /* along q: a system's right-hand sides are rows and coordinates */
    for (int c = 0; c < coordinates; c++)
      for (int j = 0; j < count[1]; j++)
        rhs[(i * coordinates + c) * count[1] + j] = patch->control[i * count[1] + j][c];
  if (!solve(sites[1], patch->knot[1], count[0] * coordinates, rhs))
    return false;
  for (int i = 0; i < count[0]; i++)
    for (int c = 0; c < coordinates; c++)
      for (int j = 0; j < count[1]; j++)
        patch->control[i * count[1] + j][c] = rhs[(i * coordinates + c) * count[1] + j];
  for (int j = 0; j < count[1]; j++) /* then along p */
    for (int c = 0; c < coordinates; c++)
      for (int i = 0; i < count[0]; i++)
        rhs[(j * coordinates + c) * count[0] + i] = patch->control[i * count[1] + j][c];
  if (!solve(sites[0], patch->knot[0], count[1] * coordinates, rhs))
    return false;
  for (int j = 0; j < count[1]; j++)
    for (int c = 0; c < coordinates; c++)
      for (int i = 0; i < count[0]; i++)
        patch->control[i * count[1] + j][c] = rhs[(j * coordinates + c) * count[0] + i];
  return true;
}

/* The spline's point. */
static void patch_at(const struct eo_patch *patch, double p, double q, double point[3])
{
  double along[DEGREE + 1], across[DEGREE + 1];
  int columns = patch->sites[1].count, i = basis(patch->knot[0], patch->sites[0].count, p, along),
      j = basis(patch->knot[1], columns, q, across);
  memset(point, 0, 3 * sizeof *point);
  for (int a = 0; a <= DEGREE; a++)
    for (int b = 0; b <= DEGREE; b++)
      for (int c = 0; c < 3; c++)
        point[c] += along[a] * across[b] * patch->control[(i + a) * columns + j + b][c];
}

/* The i-th site, or what lies half way to the next. */
static double place_of(const struct eo_patch_sites *sites, int i, bool between)
{
  return between ? (sites->at[i] + sites->at[i + 1]) / 2 : sites->at[i];
}

static double distance_at(const struct eo_patch *patch, eo_patch_surface *surface, const void *context, double p,
                          double q)
{
  double exact[3], normal[3], point[3], off = 0;
  surface(context, p, q, exact, normal);
  patch_at(patch, p, q, point);
  for (int c = 0; c < 3; c++)
    off += (point[c] - exact[c]) * normal[c];
  return fabs(off);
}

double eo_patch_error(const struct eo_patch *patch, eo_patch_surface *surface, const void *context, double tolerance,
                      bool wide[2][EO_PATCH_MOST])
{
  enum { ALONG_P, ALONG_Q, BOTH, KINDS };
  const struct eo_patch_sites *sites = patch->sites;
  double largest = 0;
  for (int kind = 0; kind < KINDS; kind++) /* what is off along both is wide by itself where neither direction is */
    for (int j = 0; j + (kind != ALONG_P) < sites[1].count; j++)
      for (int i = 0; i + (kind != ALONG_Q) < sites[0].count; i++) {
        double off = distance_at(patch, surface, context, place_of(&sites[0], i, kind != ALONG_Q),
                                 place_of(&sites[1], j, kind != ALONG_P));
        largest = fmax(largest, off);
        if (off <= tolerance || (kind == BOTH && (wide[0][i] || wide[1][j])))
          continue;
        wide[0][i] = wide[0][i] || kind != ALONG_Q;
        wide[1][j] = wide[1][j] || kind != ALONG_P;
      }
  return largest;
}
