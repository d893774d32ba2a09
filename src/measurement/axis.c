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

/* The third difference of four readings by the numbers of their rows, and by their times: a cubic through three leaves
   nothing of the fourth. Both weigh white noise alike, 1 + 9 + 9 + 1. */
static void third_differences(const struct eo_axis_reading reading[4], double *by_row, double *by_time)
{
  double weights = 0, sum = 0;
  for (int i = 0; i < 4; i++) {
    double product = 1;
    for (int j = 0; j < 4; j++)
      product *= j == i ? 1 : (reading[i].time - reading[j].time) / (reading[3].time - reading[0].time);
    sum += reading[i].angle / product;
    weights += 1 / (product * product);
  }
  /* theory (M6) */
  *by_row = reading[3].angle - 3 * reading[2].angle + 3 * reading[1].angle - reading[0].angle;
  *by_time = isfinite(sum) && isfinite(weights) ? sum * sqrt(EO_AXIS_WEIGHTS / weights) : *by_row;
}

void eo_axis_noise_add(struct eo_axis_noise *noise, double time, double angle)
{
  struct eo_axis_reading *last = noise->reading;
  last[3] = (struct eo_axis_reading){time, angle};
  if (noise->rows++ >= 3) {
    double third[2];
    third_differences(last, &third[0], &third[1]);
    for (int k = 0; k < 2; k++)
      noise->square[k] += third[k] * third[k];
  }
  for (int i = 0; i < 3; i++)
    last[i] = last[i + 1];
  if (noise->rows > 3 && (noise->rows - 3) % EO_AXIS_BLOCK == 0) {
    for (int k = 0; k < 2; k++) {
      noise->mean_square[k][noise->blocks % EO_AXIS_BLOCKS] = noise->square[k] / EO_AXIS_BLOCK;
      noise->square[k] = 0;
    }
    noise->blocks++;
  }
}

double eo_axis_noise_sigma(struct eo_axis_noise *noise)
{
  int count = noise->blocks < EO_AXIS_BLOCKS ? (int)noise->blocks : EO_AXIS_BLOCKS;
  if (!count)
    return 0;
  double by_row = eo_scan_quantile(noise->mean_square[0], count, 0.5),
         by_time = eo_scan_quantile(noise->mean_square[1], count, 0.5);
  return sqrt(fmin(by_row, by_time) / EO_AXIS_WEIGHTS);
}
