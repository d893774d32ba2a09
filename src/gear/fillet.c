/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The root of a generated tooth: the trochoid of the rack's rounded tip and the root circle between two trochoids. */
#include "gear/fillet.h"

#include <math.h>

/* The tip of the rack in its normal section: centre of the rounding (across, up from the rolling pitch line). */
struct tip {
  double centre[2];
  double land_angle; /* root circle between the end of the trochoid and the middle of the tooth space, rad */
};

static struct tip rack_tip(const struct eo_geometry *geometry, int member)
{
  double nominal = geometry->profile_shift[member] * geometry->normal_module,
         shift = geometry->generating_shift[member] * geometry->normal_module,
         slope = tan(geometry->normal_pressure_angle);
  double half_thickness = M_PI * geometry->normal_module / 4 +
                          nominal * slope; /* of the generated tooth on the pitch line */
  struct tip tip;
  tip.centre[1] = shift - geometry->dedendum[member] + geometry->fillet_radius[member];
  tip.centre[0] = half_thickness - tip.centre[1] * slope +
                  (geometry->fillet_radius[member] - geometry->residual_undercut[member]) /
                      cos(geometry->normal_pressure_angle);
  tip.land_angle = fmax(0, M_PI / geometry->teeth[member] -
                               tip.centre[0] / cos(geometry->helix_angle) / geometry->reference_radius[member]);
  return tip;
}

/* Trochoid point generated at angle psi of the rounding (alpha_n at the flank, pi/2 at its lowest point). */
static void trochoid(const struct eo_geometry *geometry, int member, const struct tip *tip, double psi, double point[2],
                     double normal[2])
{
  double r = geometry->reference_radius[member], stretch = 1 / cos(geometry->helix_angle);
  double x = (tip->centre[0] - geometry->fillet_radius[member] * cos(psi)) * stretch,
         y = tip->centre[1] - geometry->fillet_radius[member] * sin(psi);
  double n[2] = {cos(psi), sin(psi) * stretch}; /* out of the generated tooth, into the rack */
  double roll = x - y * n[0] / n[1], angle = roll / r, c = cos(angle), s = sin(angle), length = hypot(n[0], n[1]);
  point[0] = (x - roll) * c + (y + r) * s;
  point[1] = -(x - roll) * s + (y + r) * c;
  normal[0] = (n[0] * c + n[1] * s) / length;
  normal[1] = (-n[0] * s + n[1] * c) / length;
}

/* How far the trochoid stands inside the involute's tooth, rad; NaN below the base circle. */
static double cut_inside(const struct eo_geometry *geometry, int member, const struct tip *tip, double psi,
                         double *radius)
{
  double point[2], normal[2];
  trochoid(geometry, member, tip, psi, point, normal);
  *radius = hypot(point[0], point[1]);
  return *radius < geometry->base_radius[member]
             ? NAN
             : eo_geometry_half_angle(geometry, member, *radius) - atan2(point[0], point[1]);
}

/* Angle at which the rounding leaves the flank of the finished tooth: alpha_n, and before that where it stands out by
   the residual undercut, s_pr = rho (1 - cos(alpha_n - psi)). */
static double rounding_start(const struct eo_geometry *geometry, int member)
{
  double share = geometry->fillet_radius[member] > 0
                     ? fmin(1, geometry->residual_undercut[member] / geometry->fillet_radius[member])
                     : 0;
  return geometry->normal_pressure_angle - acos(1 - share);
}

/* The trochoid of an undercut tooth begins outside the tooth and cuts through the involute on its way
   down; where it first falls below the base circle, the involute reaches down to that. */
double eo_fillet_undercut(const struct eo_geometry *geometry, int member, double *form_radius)
{
  enum { STEPS = 400, HALVINGS = 60 };
  struct tip tip = rack_tip(geometry, member);
  double start = rounding_start(geometry, member), low = start, high = start, radius = geometry->base_radius[member];
  for (int i = 1; i <= STEPS; i++) {
    high = start + (M_PI / 2 - start) * i / STEPS;
    double inside = cut_inside(geometry, member, &tip, high, &radius);
    if (isnan(inside) || inside > 0)
      break;
    low = high;
  }
  for (int i = 0; i < HALVINGS; i++) {
    double middle = (low + high) / 2, inside = cut_inside(geometry, member, &tip, middle, &radius);
    if (isnan(inside) || inside > 0)
      high = middle;
    else
      low = middle;
  }
  *form_radius = fmax(radius, geometry->base_radius[member]);
  return high;
}

enum { PIECES = 256 };

void eo_geometry_fillet(const struct eo_geometry *geometry, int member, double t, double point[2], double normal[2])
{
  struct tip tip = rack_tip(geometry, member);
  double land = tip.land_angle * geometry->root_radius[member], low = M_PI / 2, high = geometry->fillet_end[member];
  double length[PIECES + 1], last[2], unused[2];
  length[0] = 0;
  trochoid(geometry, member, &tip, low, last, unused);
  for (int i = 1; i <= PIECES; i++) {
    double next[2];
    trochoid(geometry, member, &tip, low + (high - low) * i / PIECES, next, unused);
    length[i] = length[i - 1] + hypot(next[0] - last[0], next[1] - last[1]);
    last[0] = next[0];
    last[1] = next[1];
  }
  double wanted = t * (land + length[PIECES]) - land;
  if (wanted <= 0) {
    double angle = M_PI / geometry->teeth[member] - tip.land_angle * (land > 0 ? 1 + wanted / land : 0);
    point[0] = geometry->root_radius[member] * (normal[0] = sin(angle));
    point[1] = geometry->root_radius[member] * (normal[1] = cos(angle));
    return;
  }
  int i = 0;
  while (i < PIECES - 1 && length[i + 1] < wanted)
    i++;
  double part = (wanted - length[i]) / (length[i + 1] - length[i]);
  trochoid(geometry, member, &tip, low + (high - low) * fmin(1, (i + part) / PIECES), point, normal);
}
