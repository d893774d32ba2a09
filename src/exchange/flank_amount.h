/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is taken off a flank of a design at one place. */
#ifndef EASEOFF_EXCHANGE_FLANK_AMOUNT_H
#define EASEOFF_EXCHANGE_FLANK_AMOUNT_H

#include "design/design.h"
#include "gear/geometry.h"

/* m, normal to the flank. u: profile coordinate, m from the pitch point, + to the own tip; y: axial, m from mid face, +
   to the face that meets first on the drive flank. NaN without memory. */
double eo_flank_amount(const struct eo_design *design, const struct eo_geometry *geometry, int member, int end,
                       bool coast, double u, double y);

/* Amount at `end` of a relief of this shape (parabolic, linear, circular) that has `depth` at `reference`, both from
   where it starts; one unit. A circle ends at its radius. */
double eo_relief_carry(const char *shape, double depth, double reference, double end);

#endif
