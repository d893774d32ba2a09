/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "numerics/periodic.h"

#include <math.h>

/* Slopes of the periodic spline: (m[i-1] + 4 m[i] + m[i+1]) = 3 n (y[i+1] - y[i-1]). The circulant matrix inverts by a
   geometric series with the ratio sqrt(3) - 2, run once forwards and once backwards from a start that the period
   closes. */
void eo_periodic_init(struct eo_periodic *spline, int n, const double *value)
{
  const double ratio = sqrt(3) - 2;
  double *m = spline->slope, start = 0, power = 1;
  spline->count = n;
  for (int i = 0; i < n; i++) {
    spline->value[i] = value[i];
    m[i] = 3.0 * n * (value[(i + 1) % n] - value[(i + n - 1) % n]);
  }
  /* (1 - ratio E^-1)(1 - ratio E) m = -ratio rhs, E the shift by one */
  for (int i = 0; i < n; i++)
    m[i] *= -ratio;
  for (int i = n - 1; i >= 0; i--, power *= ratio)
    start += power * m[i];
  start /= 1 - power; /* the forward sweep's value at n - 1 */
  for (int i = 0; i < n; i++)
    start = m[i] += ratio * start;
  start = 0;
  power = 1;
  for (int i = 0; i < n; i++, power *= ratio)
    start += power * m[i];
  start /= 1 - power;
  for (int i = n - 1; i >= 0; i--)
    start = m[i] += ratio * start;
}

double eo_periodic_at(const struct eo_periodic *spline, double phase, double *slope)
{
  int n = spline->count, i = (int)(phase * n);
  i = i < 0 ? 0 : i >= n ? n - 1 : i;
  int next = i + 1 == n ? 0 : i + 1;
  double t = phase * n - i, r = 1 - t, difference = spline->value[next] - spline->value[i];
  double a = spline->slope[i] / n - difference, b = difference - spline->slope[next] / n;
  if (slope)
    *slope = n * (difference + (r - t) * (a * r + b * t) + t * r * (b - a));
  return spline->value[i] * r + spline->value[next] * t + t * r * (a * r + b * t);
}

double eo_periodic_mean(int count, const double *value)
{
  double sum = 0;
  for (int i = 0; i < count; i++)
    sum += value[i];
  return sum / count;
}

double eo_periodic_swing(int count, const double *value)
{
  double low = INFINITY, high = -INFINITY;
  for (int i = 0; i < count; i++) {
    low = fmin(low, value[i]);
    high = fmax(high, value[i]);
  }
  return high - low;
}

double eo_periodic_harmonics(int count, const double *value, int harmonics, double (*amplitude)[2])
{
  enum { TABLE = 512 }; /* angles of a round that are kept */
  double mean = eo_periodic_mean(count, value), cosine[TABLE], sine[TABLE];
  for (int i = 0; i < count && i < TABLE; i++) {
    cosine[i] = cos(2 * M_PI * i / count);
    sine[i] = sin(2 * M_PI * i / count);
  }
  for (int h = 1; h <= harmonics; h++) {
    double re = 0, im = 0;
    for (int i = 0; i < count; i++) {
      int at = (int)((long)h * i % count);
      re += (value[i] - mean) * (at < TABLE ? cosine[at] : cos(2 * M_PI * at / count));
      im -= (value[i] - mean) * (at < TABLE ? sine[at] : sin(2 * M_PI * at / count));
    }
    amplitude[h - 1][0] = 2 * re / count;
    amplitude[h - 1][1] = 2 * im / count;
  }
  return mean;
}
