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

static struct cutting cutting_of(const struct eo_tooth *t)
{
  double shift = eo_tooth_generating_shift(t), slope = tan(t->normal_pressure_angle), m = t->normal_module;
  double transverse = eo_tooth_transverse_pressure_angle(t);
  struct cutting c = {.stretch = 1 / cos(t->helix_angle),
                      .reference = eo_tooth_reference_diameter(t) / 2 / m,
                      .base = eo_tooth_base_diameter(t) / 2 / m,
                      .pressure = t->normal_pressure_angle,
                      .fillet = t->fillet_radius_coefficient};
  c.centre[1] = shift - t->dedendum_coefficient + c.fillet;
  c.centre[0] = M_PI / 4 + shift * slope - c.centre[1] * slope + c.fillet / cos(c.pressure);
  c.half_base_angle = (M_PI / 2 + 2 * shift * slope) / t->teeth + eo_geometry_involute_function(transverse);
  return c;
}

/* Polar place of the trochoid's point that the rounding cuts at its angle psi (alpha_n: end of the straight flank,
   pi/2: lowest point): the normal there goes through the rolling point. */
static void trochoid(const struct cutting *c, double psi, double *radius, double *angle)
{
  double x = (c->centre[0] - c->fillet * cos(psi)) * c->stretch, y = c->centre[1] - c->fillet * sin(psi);
  double roll = x - y * cos(psi) / (sin(psi) * c->stretch);
  *radius = hypot(x - roll, y + c->reference);
  *angle = roll / c->reference + atan2(x - roll, y + c->reference);
}

/* How far the trochoid stands inside the involute's tooth, rad; NaN below the base circle. */
static double cut_inside(const struct cutting *c, double psi, double *radius)
{
  double angle;
  trochoid(c, psi, radius, &angle);
  if (*radius < c->base)
    return NAN;
  return c->half_base_angle - eo_geometry_involute_function(acos(c->base / *radius)) - angle;
}

/* With undercut the trochoid begins outside the tooth (psi = alpha_n) and cuts through the involute on its way down;
   radius over m_n. Where it first falls below the base circle, the involute reaches down to that. */
static double meeting_radius(const struct cutting *c)
{
  enum { STEPS = 400, HALVINGS = 60 };
  double low = c->pressure, high = low, radius = c->base;
  for (int i = 1; i <= STEPS; i++) {
    high = c->pressure + (M_PI / 2 - c->pressure) * i / STEPS;
    double inside = cut_inside(c, high, &radius);
    if (isnan(inside) || inside > 0)
      break;
    low = high;
  }
  for (int i = 0; i < HALVINGS; i++) {
    double middle = (low + high) / 2, inside = cut_inside(c, middle, &radius);
    if (isnan(inside) || inside > 0)
      high = middle;
    else
      low = middle;
  }
  return fmax(radius, c->base);
}

/* ISO 21771: the straight flank of the rack ends B = h_fP - x_E m_n - rho (1 - sin alpha_n) below the reference line of
   the gear; without undercut that point cuts d_Ff = sqrt((d sin alpha_t - 2 B/sin alpha_t)^2 + d_b^2). */
double eo_tooth_form_diameter(const struct eo_tooth *t, bool *undercut)
{
  double sine = sin(eo_tooth_transverse_pressure_angle(t)), m = t->normal_module;
  double flank_end = m * (t->dedendum_coefficient - eo_tooth_generating_shift(t) -
                          t->fillet_radius_coefficient * (1 - sin(t->normal_pressure_angle)));
  double roll = eo_tooth_reference_diameter(t) * sine - 2 * flank_end / sine;
  if (undercut)
    *undercut = roll < 0;
  if (roll >= 0)
    return hypot(roll, eo_tooth_base_diameter(t));
  struct cutting c = cutting_of(t);
  return 2 * m * meeting_radius(&c);
}
