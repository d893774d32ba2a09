/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/hertz.h"

#include <math.h>

double eo_hertz_half_width(double line_load, double relative_radius, double youngs_modulus, double poissons_ratio)
{
  return sqrt(8 * line_load * relative_radius * (1 - poissons_ratio * poissons_ratio) / (M_PI * youngs_modulus));
}

double eo_hertz_pressure(double line_load, double relative_radius, double youngs_modulus, double poissons_ratio)
{
  /* theory (C7) */
  return sqrt(line_load * youngs_modulus / (2 * M_PI * relative_radius * (1 - poissons_ratio * poissons_ratio)));
}

void eo_local_law_init(struct eo_local_law *law, double youngs_modulus, double poissons_ratio, double relative_radius,
                       const double depth[2])
{
  double plane = (1 - poissons_ratio * poissons_ratio) / (M_PI * youngs_modulus);
  law->slope = 2 * plane;
  law->constant = log(depth[0] * depth[1] / (2 * relative_radius * plane)) - poissons_ratio / (1 - poissons_ratio);
}

double eo_local_law_approach(const struct eo_local_law *law, double line_load)
{
  return line_load > 0 ? law->slope * line_load * (law->constant - log(line_load)) : 0;
}

double eo_local_law_derivative(const struct eo_local_law *law, double line_load)
{
  return law->slope * (law->constant - log(line_load) - 1);
}

double eo_local_law_load(const struct eo_local_law *law, double approach)
{
  double most = exp(law->constant - 1);
  if (approach <= 0)
    return 0;
  if (approach >= eo_local_law_approach(law, most))
    return most;
  enum { STEPS = 100 };
  static const double ROUNDING = 1e-16; /* of the load */
  /* The approach is concave: Newton's steps from a load that is too small approach the root from below, each one
     shorter. */
  double load = approach / law->slope / (law->constant - log(approach / law->slope) + 1);
  while (eo_local_law_approach(law, load) > approach)
    load /= 2;
  for (int i = 0; i < STEPS; i++) {
    double step = (approach - eo_local_law_approach(law, load)) / eo_local_law_derivative(law, load);
    if (!(step > ROUNDING * load))
      break;
    load += step;
  }
  return fmin(load, most);
}
