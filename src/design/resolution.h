/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the resolution of a design means to the rooms above: the settings of the finite-element model and of the contact
   grid. */
#ifndef EASEOFF_DESIGN_RESOLUTION_H
#define EASEOFF_DESIGN_RESOLUTION_H

#include "contact/grid.h"
#include "design/design.h"
#include "flexibility/flexibility.h"

/* Cells on each of the two stretches of a tip edge outside the path of contact. */
enum { EO_EDGE_CELLS = 12 };

/* As the resolution says, with the usual columns across the loaded tooth and elements from the root to the bore. */
struct eo_flexibility_settings eo_flexibility_settings_of(const struct eo_resolution *resolution);

/* As the resolution says, with EO_EDGE_CELLS on each stretch of a tip edge. */
struct eo_contact_grid_settings eo_contact_grid_default(const struct eo_resolution *resolution);

#endif
