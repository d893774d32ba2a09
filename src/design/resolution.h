/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the resolution of a design means to the rooms above: the settings of the finite-element model and of the contact
   grid. */
#ifndef EASEOFF_DESIGN_RESOLUTION_H
#define EASEOFF_DESIGN_RESOLUTION_H

#include "contact/grid.h"
#include "design/design.h"
#include "flexibility/flexibility.h"

/* 8 columns across the loaded tooth and 8 elements from the root to the bore; the rest as the resolution says. */
struct eo_flexibility_settings eo_flexibility_settings_of(const struct eo_resolution *resolution);

/* 12 cells on each stretch of a tip edge; the rest as the resolution says. */
struct eo_contact_grid_settings eo_contact_grid_default(const struct eo_resolution *resolution);

#endif
