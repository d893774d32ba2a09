/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/patch.h"

#include <math.h>
#include <string.h>

#include "numerics/dense.h"

enum { DEGREE = 3 };

static double parameter(int i, int count)
{
  return (double)i / (count - 1);
}

static void make_knots(int count, double *knot)
{
  for (int i = 0; i <= DEGREE; i++) {
    knot[i] = 0;
    knot[count + i] = 1;
  }
  for (int i = 1; i < count - DEGREE; i++)
    knot[DEGREE + i] = (parameter(i, count) + parameter(i + 1, count) + parameter(i + 2, count)) / 3;
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
static bool solve(int count, const double *knot, int columns, double *rhs)
{
  double matrix[EO_PATCH_MOST * EO_PATCH_MOST] = {0}, value[DEGREE + 1];
  int pivot[EO_PATCH_MOST];
  for (int i = 0; i < count; i++) {
    int first = basis(knot, count, parameter(i, count), value);
    for (int k = 0; k <= DEGREE; k++)
      matrix[i * count + first + k] = value[k];
  }
  return eo_dense_solve(count, matrix, pivot, columns, rhs) == 0;
}

bool eo_patch_fit(struct eo_patch *patch, const int count[2], eo_patch_surface *surface, const void *context)
{
  static const int coordinates = 3;
  double rhs[3 * EO_PATCH_MOST * EO_PATCH_MOST];
  memcpy(patch->count, count, sizeof patch->count);
  for (int d = 0; d < 2; d++)
    make_knots(count[d], patch->knot[d]);
  for (int j = 0; j < count[1]; j++)
    for (int i = 0; i < count[0]; i++)
      surface(context, parameter(i, count[0]), parameter(j, count[1]), patch->control[i * count[1] + j], NULL);
  for (int i = 0; i < count[0]; i++) /* along q: a system's right-hand sides are rows and coordinates */
    for (int c = 0; c < coordinates; c++)
      for (int j = 0; j < count[1]; j++)
        rhs[(i * coordinates + c) * count[1] + j] = patch->control[i * count[1] + j][c];
  if (!solve(count[1], patch->knot[1], count[0] * coordinates, rhs))
    return false;
  for (int i = 0; i < count[0]; i++)
    for (int c = 0; c < coordinates; c++)
      for (int j = 0; j < count[1]; j++)
        patch->control[i * count[1] + j][c] = rhs[(i * coordinates + c) * count[1] + j];
  for (int j = 0; j < count[1]; j++) /* then along p */
    for (int c = 0; c < coordinates; c++)
      for (int i = 0; i < count[0]; i++)
        rhs[(j * coordinates + c) * count[0] + i] = patch->control[i * count[1] + j][c];
  if (!solve(count[0], patch->knot[0], count[1] * coordinates, rhs))
    return false;
  for (int j = 0; j < count[1]; j++)
    for (int c = 0; c < coordinates; c++)
      for (int i = 0; i < count[0]; i++)
        patch->control[i * count[1] + j][c] = rhs[(j * coordinates + c) * count[0] + i];
  return true;
}

void eo_patch_at(const struct eo_patch *patch, double p, double q, double point[3])
{
  double along[DEGREE + 1], across[DEGREE + 1];
  int i = basis(patch->knot[0], patch->count[0], p, along), j = basis(patch->knot[1], patch->count[1], q, across);
  memset(point, 0, 3 * sizeof *point);
  for (int a = 0; a <= DEGREE; a++)
    for (int b = 0; b <= DEGREE; b++)
      for (int c = 0; c < 3; c++)
        point[c] += along[a] * across[b] * patch->control[(i + a) * patch->count[1] + j + b][c];
}

void eo_patch_error(const struct eo_patch *patch, eo_patch_surface *surface, const void *context,
                    double error[EO_PATCH_ERRORS])
{
  int steps[2] = {2 * (patch->count[0] - 1), 2 * (patch->count[1] - 1)};
  memset(error, 0, EO_PATCH_ERRORS * sizeof *error);
  for (int j = 0; j <= steps[1]; j++)
    for (int i = 1 - j % 2; i <= steps[0]; i += 2 - j % 2) {
      double p = (double)i / steps[0], q = (double)j / steps[1], off = 0;
      double exact[3], normal[3], point[3];
      surface(context, p, q, exact, normal);
      eo_patch_at(patch, p, q, point);
      for (int c = 0; c < 3; c++)
        off += (point[c] - exact[c]) * normal[c];
      double *kind = &error[i % 2 && j % 2 ? EO_PATCH_BOTH : j % 2];
      *kind = fmax(*kind, fabs(off));
    }
}
