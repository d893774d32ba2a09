/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/interpolation.h"

void eo_interpolation_weights(int points, const double *time, double t, double *weight)
{
  for (int i = 0; i < points; i++) {
    weight[i] = 1;
    for (int k = 0; k < points; k++)
      if (k != i)
        weight[i] *= (t - time[k]) / (time[i] - time[k]);
  }
}

/* Sum of the weights times the wave's values at the samples, over its value at the place x behind the middle one. */
static double complex gain_at(int points, double x, double phase)
{
  double time[EO_INTERPOLATION_EVEN] = {0}, weight[EO_INTERPOLATION_EVEN];
  const int whole = points / 2 - 1; /* of the sample before the place */
  double middle = whole + x;
  double complex sum = 0;
  for (int i = 0; i < points; i++)
    time[i] = i;
  eo_interpolation_weights(points, time, middle, weight);
  for (int i = 0; i < points; i++)
    sum += weight[i] * cexp(I * phase * (i - middle));
  return sum;
}

double complex eo_interpolation_gain(const struct eo_interpolation *interpolation, double phase)
{
  if (!(interpolation->step > 0))
    return 1;
  double complex gain = interpolation->share[EO_INTERPOLATION_PLACES];
  for (int i = 0; i < EO_INTERPOLATION_PLACES; i++)
    if (interpolation->share[i] > 0)
      gain += interpolation->share[i] * gain_at(interpolation->points, (i + 0.5) / EO_INTERPOLATION_PLACES, phase);
  return gain;
}
