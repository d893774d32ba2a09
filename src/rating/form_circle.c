/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The form circle of a tooth cut by a rack, with undercut where there is one. */
#include <math.h>

#include "gear/geometry.h"
#include "rating/tooth_dimensions.h"

/* A rack in the transverse plane of the gear it cuts, lengths over m_n. */
struct cutting {
  double stretch;           /* 1 / cos beta: transverse over normal lengths along the pitch line */
  double reference, base;   /* radii */
  double pressure;          /* alpha_n */
  double centre[2], fillet; /* rounding of the rack's tip, normal section: across from the tooth's middle, up from the
                               rolling pitch line */
  double half_base_angle;   /* of the tooth at the base circle */
};

static struct cutting cutting_of(const struct eo_tooth *tooth)
{
  double shift = eo_tooth_generating_shift(tooth), slope = tan(tooth->normal_pressure_angle), m = tooth->normal_module;
  double transverse = eo_tooth_transverse_pressure_angle(tooth);
  struct cutting cutting = {.stretch = 1 / cos(tooth->helix_angle),
                            .reference = eo_tooth_reference_diameter(tooth) / 2 / m,
                            .base = eo_tooth_base_diameter(tooth) / 2 / m,
                            .pressure = tooth->normal_pressure_angle,
                            .fillet = tooth->fillet_radius_coefficient};
  cutting.centre[1] = shift - tooth->dedendum_coefficient + cutting.fillet;
  cutting.centre[0] = M_PI / 4 + shift * slope - cutting.centre[1] * slope + cutting.fillet / cos(cutting.pressure);
  cutting.half_base_angle = (M_PI / 2 + 2 * shift * slope) / tooth->teeth + eo_geometry_involute_function(transverse);
  return cutting;
}

/* Polar place of the trochoid's point that the rounding cuts at its angle psi (alpha_n: end of the straight flank,
   pi/2: lowest point): the normal there goes through the rolling point. */
static void trochoid(const struct cutting *cutting, double psi, double *radius, double *angle)
{
  double x = (cutting->centre[0] - cutting->fillet * cos(psi)) * cutting->stretch,
         y = cutting->centre[1] - cutting->fillet * sin(psi);
  double roll = x - y * cos(psi) / (sin(psi) * cutting->stretch);
  *radius = hypot(x - roll, y + cutting->reference);
  *angle = roll / cutting->reference + atan2(x - roll, y + cutting->reference);
}

/* How far the trochoid stands inside the involute's tooth, rad; NaN below the base circle. */
static double cut_inside(const struct cutting *cutting, double psi, double *radius)
{
  double angle;
  trochoid(cutting, psi, radius, &angle);
  if (*radius < cutting->base)
    return NAN;
  return cutting->half_base_angle - eo_geometry_involute_function(acos(cutting->base / *radius)) - angle;
}

/* With undercut the trochoid begins outside the tooth (psi = alpha_n) and cuts through the involute on its way down;
   radius over m_n. Where it first falls below the base circle, the involute reaches down to that. */
static double meeting_radius(const struct cutting *cutting)
{
  enum { STEPS = 400, HALVINGS = 60 };
  double low = cutting->pressure, high = low, radius = cutting->base;
  for (int i = 1; i <= STEPS; i++) {
    high = cutting->pressure + (M_PI / 2 - cutting->pressure) * i / STEPS;
    double inside = cut_inside(cutting, high, &radius);
    if (isnan(inside) || inside > 0)
      break;
    low = high;
  }
  for (int i = 0; i < HALVINGS; i++) {
    double middle = (low + high) / 2, inside = cut_inside(cutting, middle, &radius);
    if (isnan(inside) || inside > 0)
      high = middle;
    else
      low = middle;
  }
  return fmax(radius, cutting->base);
}

/* ISO 21771: the straight flank of the rack ends B = h_fP - x_E m_n - rho (1 - sin alpha_n) below the reference line of
   the gear; without undercut that point cuts d_Ff = sqrt((d sin alpha_t - 2 B/sin alpha_t)^2 + d_b^2). */
double eo_tooth_form_diameter(const struct eo_tooth *tooth, bool *undercut)
{
  double sine = sin(eo_tooth_transverse_pressure_angle(tooth)), m = tooth->normal_module;
  double flank_end = m * (tooth->dedendum_coefficient - eo_tooth_generating_shift(tooth) -
                          tooth->fillet_radius_coefficient * (1 - sin(tooth->normal_pressure_angle)));
  double roll = eo_tooth_reference_diameter(tooth) * sine - 2 * flank_end / sine;
  if (undercut)
    *undercut = roll < 0;
  if (roll >= 0)
    return hypot(roll, eo_tooth_base_diameter(tooth));
  struct cutting cutting = cutting_of(tooth);
  return 2 * m * meeting_radius(&cutting);
}
