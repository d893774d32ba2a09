/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Grids of flank deviations in documents: modification.MEMBER.END.grid and .coast.grid, as numbers or as the text of a
   table. */
#ifndef EASEOFF_DOCUMENT_FLANK_GRID_DOCUMENT_H
#define EASEOFF_DOCUMENT_FLANK_GRID_DOCUMENT_H

#include <jansson.h>

#include "format/faults.h"
#include "format/table.h"
#include "design/design.h"
#include "gear/geometry.h"

extern const struct eo_table eo_flank_grid_table;

/* Reads every grid of a modification; faults with their place. *grids is made anew. ends: of the pair. */
void eo_flank_grids_decode(const json_t *modification, int ends, struct eo_flank_grids *grids,
                           struct eo_faults *faults);

/* Puts them where they stand into the modification of an encoded document; sets *failed without memory. */
void eo_flank_grids_encode(const struct eo_flank_grids *grids, int ends, json_t *modification, bool *failed);

/* A table as text, as spreadsheets and measuring machines write it: in the first row a corner cell and y in mm, in each
   further row u in mm and delta in um; separated by commas, semicolons, tabs or blanks; decimal commas where semicolons
   or tabs separate; lines that begin with # are left out. Fills u_mm, y_mm and delta_um of a grid's object; a fault
   names line and column. */
json_t *eo_flank_grid_from_text(const char *text, struct eo_error *error);

/* A flank of a design with all that is taken off it, y along eta; *spline, owned by the caller, is its grid or NULL.
   True when there is no memory for it. */
bool eo_flank_shape(const struct eo_design *design, const struct eo_geometry *geometry, enum eo_flank_side side,
                    int member, int end, struct eo_modification_shape *shape, struct eo_flank_spline **spline);

/* The same text from a grid. */
void eo_flank_grid_to_text(const struct eo_flank_grid *grid, struct eo_text *text);

/* Whether coast flanks are shown where flanks are: a load case runs on them, or one of them is modified. */
bool eo_design_shows_coast(const struct eo_design *design);

#endif
