/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Grids of a design: which of its numbers a search varies, and which of them the pair has that nobody modifies. */
#ifndef EASEOFF_DESIGN_DESIGN_GRIDS_H
#define EASEOFF_DESIGN_DESIGN_GRIDS_H

#include "design/design.h"

/* Numbers that stand in place of a grid's go into it; what a search varies of a grid is stated, as the grid has it.
   Both make it designed unless its document says what it is. Part of eo_design_resolve(). */
void eo_design_resolve_grids(struct eo_design *design);

/* The modification of the pair that all objectives relate to: none. Measured grids are as the flanks are, so it keeps
   them; of designed ones it lays on nothing (grid_gain -1). design: resolved. */
struct eo_modification eo_design_unmodified(const struct eo_design *design);

/* Whether the design is that pair. */
bool eo_design_is_unmodified(const struct eo_design *design);

#endif
