/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What geometry and fillet share. */
#ifndef EASEOFF_GEAR_FILLET_H
#define EASEOFF_GEAR_FILLET_H

#include "gear/geometry.h"

/* Angle of the rack's rounding at which the trochoid of an undercut tooth meets its involute, rad, and the radius of
   that point, m. */
double eo_fillet_undercut(const struct eo_geometry *geometry, int member, double *form_radius);

/* Angle from the tooth's centre line to the involute at a radius not below the base circle, rad. */
double eo_geometry_half_angle(const struct eo_geometry *geometry, int member, double radius);

#endif
