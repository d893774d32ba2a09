/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/tooth_spring.h"

#include <math.h>

void eo_tooth_spring_add(struct eo_tooth_spring *spring, double approach, double load, double pressure)
{
  int n = spring->knots;
  if (n > 0 && !(approach > spring->approach[n - 1] && load > spring->load[n - 1]))
    return;
  spring->approach[n] = approach;
  spring->load[n] = load;
  spring->pressure[n] = pressure;
  spring->knots = n + 1;
}

/* Slopes that keep a cubic monotone (Fritsch and Butland 1984). */
void eo_tooth_spring_settle(struct eo_tooth_spring *spring)
{
  int last = spring->knots - 1;
  double chord[EO_TOOTH_KNOTS] = {0}, width[EO_TOOTH_KNOTS] = {0};
  for (int i = 0; i < last; i++) {
    width[i] = spring->approach[i + 1] - spring->approach[i];
    chord[i] = (spring->load[i + 1] - spring->load[i]) / width[i];
  }
  for (int i = 1; i < last; i++)
    spring->slope[i] = 3 * (width[i - 1] + width[i]) /
                       ((2 * width[i] + width[i - 1]) / chord[i - 1] + (width[i] + 2 * width[i - 1]) / chord[i]);
  spring->slope[last] = chord[last - 1];
  spring->slope[0] = last > 1 ? fmax(0, (3 * chord[0] - spring->slope[1]) / 2) : chord[0];
}

double eo_tooth_spring_carry(const struct eo_tooth_spring *spring, double approach, double *stiffness)
{
  int last = spring->knots - 1, i = 0;
  *stiffness = 0;
  if (last < 0 || approach <= spring->approach[0])
    return 0;
  if (approach >= spring->approach[last]) {
    *stiffness = spring->slope[last];
    return spring->load[last] + spring->slope[last] * (approach - spring->approach[last]);
  }
  while (approach >= spring->approach[i + 1])
    i++;
  double width = spring->approach[i + 1] - spring->approach[i], t = (approach - spring->approach[i]) / width,
         rise = spring->load[i + 1] - spring->load[i], a = spring->slope[i] * width, b = spring->slope[i + 1] * width,
         square = 3 * rise - 2 * a - b, cube = a + b - 2 * rise;
  *stiffness = (a + t * (2 * square + t * 3 * cube)) / width;
  return spring->load[i] + t * (a + t * (square + t * cube));
}

double eo_tooth_spring_pressure(const struct eo_tooth_spring *spring, double load)
{
  int i = 0;
  while (i < spring->knots - 2 && load > spring->load[i + 1])
    i++;
  double low = spring->pressure[i], high = spring->pressure[i + 1],
         share = (load - spring->load[i]) / (spring->load[i + 1] - spring->load[i]);
  return sqrt(fmax(0, low * low + share * (high * high - low * low)));
}
