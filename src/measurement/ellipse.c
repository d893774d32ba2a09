/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/ellipse.h"

#include <math.h>
#include <string.h>

#include "numerics/dense.h"

void eo_ellipse_start(struct eo_ellipse_sums *sums, const double centre[2], double scale)
{
  *sums = (struct eo_ellipse_sums){.centre = {centre[0], centre[1]}, .scale = scale};
}

void eo_ellipse_add(struct eo_ellipse_sums *sums, double sine, double cosine)
{
  double x = (sine - sums->centre[0]) / sums->scale, y = (cosine - sums->centre[1]) / sums->scale;
  const double term[6] = {x * x, x * y, y * y, x, y, 1};
  for (int i = 0; i < 6; i++)
    for (int j = i; j < 6; j++)
      sums->moment[i][j] += term[i] * term[j];
  sums->count++;
}

/* a x^2 + b xy + c y^2 + d x + e y = 1 by least squares. */
static bool fit_conic(const struct eo_ellipse_sums *sums, double conic[5])
{
  double matrix[25];
  int pivot[5];
  for (int i = 0; i < 5; i++) {
    for (int j = 0; j < 5; j++)
      matrix[5 * i + j] = sums->moment[i < j ? i : j][i < j ? j : i] / (double)sums->count;
    conic[i] = sums->moment[i][5] / (double)sums->count;
  }
  return eo_dense_solve(5, matrix, pivot, 1, conic) == 0;
}

bool eo_ellipse_fit(const struct eo_ellipse_sums *sums, struct eo_ellipse *ellipse)
{
  double conic[5];
  if (sums->count < 16 || !fit_conic(sums, conic))
    return false;
  double a = conic[0], b = conic[1], c = conic[2], d = conic[3], e = conic[4], determinant = 4 * a * c - b * b;
  if (!(determinant > 1e-9 * a * c) || !(a > 0))
    return false;
  double x = (b * e - 2 * c * d) / determinant, y = (b * d - 2 * a * e) / determinant;
  double level = 1 + a * x * x + b * x * y + c * y * y; /* of the form about its centre */
  if (!(level > 0))
    return false;
  /* x = A sin(t), y = B cos(t - s): with u = x / A, v = y / B it is u^2 - 2 u v sin(s) + v^2 = cos(s)^2 */
  double sine = -b / (2 * sqrt(a * c)), cosine2 = 1 - sine * sine;
  ellipse->offset[0] = sums->centre[0] + sums->scale * x;
  ellipse->offset[1] = sums->centre[1] + sums->scale * y;
  ellipse->amplitude[0] = sums->scale * sqrt(level / (a * cosine2));
  ellipse->amplitude[1] = sums->scale * sqrt(level / (c * cosine2));
  ellipse->skew = asin(sine);
  return isfinite(ellipse->amplitude[0]) && isfinite(ellipse->amplitude[1]);
}

double eo_ellipse_angle(const struct eo_ellipse *ellipse, double sine, double cosine)
{
  double u = (sine - ellipse->offset[0]) / ellipse->amplitude[0],
         v = (cosine - ellipse->offset[1]) / ellipse->amplitude[1];
  return atan2(u, (v - u * sin(ellipse->skew)) / cos(ellipse->skew));
}
