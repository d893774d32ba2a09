/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/axis.h"

#include <math.h>

#include "measurement/scan.h"

double eo_axis_swing(const struct eo_axis *axis, int member, double theta)
{
  double complex turn = cexp(I * axis->ratio[member] * theta), power = 1, sum = 0;
  for (int k = 0; k < EO_SHAFT_ORDERS; k++)
    sum += axis->swing[member][k] * (power *= turn);
  return creal(sum);
}

static double taken_out(const struct eo_axis *axis, double theta)
{
  double sum = 0;
  for (int member = 0; member < 2; member++)
    if (axis->share[member] > 0)
      sum += axis->share[member] * eo_axis_swing(axis, member, theta);
  return sum;
}

/* theta + e(theta) = reading, by two steps of the fixed point iteration: e is some 1e-3 rad, what is left 1e-9. */
double eo_axis_angle(const struct eo_axis *axis, double reading)
{
  double angle = axis->sign * reading;
  return angle - taken_out(axis, angle - taken_out(axis, angle));
}

double eo_axis_loss(const struct eo_axis *axis, double order, const double share[2])
{
  double left = 1;
  for (int member = 0; member < 2; member++)
    for (int k = 0; k < EO_SHAFT_ORDERS; k++)
      left *= fabs(j0(order * share[member] * cabs(axis->swing[member][k])));
  return left;
}

void eo_axis_noise_add(struct eo_axis_noise *noise, double reading)
{
  double *before = noise->reading;
  if (noise->rows++ >= 3) {
    double third = reading - 3 * before[2] + 3 * before[1] - before[0];
    noise->square += third * third;
  }
  before[0] = before[1];
  before[1] = before[2];
  before[2] = reading;
  if (noise->rows > 3 && (noise->rows - 3) % EO_AXIS_BLOCK == 0) {
    noise->mean_square[noise->blocks++ % EO_AXIS_BLOCKS] = noise->square / EO_AXIS_BLOCK;
    noise->square = 0;
  }
}

double eo_axis_noise_sigma(struct eo_axis_noise *noise)
{
  int count = noise->blocks < EO_AXIS_BLOCKS ? (int)noise->blocks : EO_AXIS_BLOCKS;
  return count ? sqrt(eo_scan_quantile(noise->mean_square, count, 0.5) / 20) : 0;
}
