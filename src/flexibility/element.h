/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The eight-node brick with incompatible modes (Wilson, Taylor, Doherty, Ghaboussi 1973; made to pass the patch test as
   by Taylor, Beresford, Wilson 1976: the modes' derivatives use the Jacobian of the element's centre). It does not lock
   in bending. 2 x 2 x 2 Gauss points; the nine internal modes are condensed. */
#ifndef EASEOFF_FLEXIBILITY_ELEMENT_H
#define EASEOFF_FLEXIBILITY_ELEMENT_H

#include "gear/gear_pair.h"

enum { EO_BRICK_NODES = 8, EO_BRICK_UNKNOWNS = 24 };

/* stiffness[24][24], unknown 3 node + direction, N/m. node[8][3]: the lower face counterclockwise seen from above, then
   the upper face in the same order, m. Returns 0, or -1 when the element is turned inside out at a Gauss point. */
int eo_brick_stiffness(const double node[EO_BRICK_NODES][3], const struct eo_material *material,
                       double stiffness[EO_BRICK_UNKNOWNS][EO_BRICK_UNKNOWNS]);

#endif
