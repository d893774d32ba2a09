/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "design/resolution.h"

#include <math.h>

/* What no document states: across the loaded tooth, and from the root to the bore. */
enum { COLUMNS = 8, RIM_ELEMENTS = 8 };

struct eo_flexibility_settings eo_flexibility_settings_of(const struct eo_resolution *resolution)
{
  struct eo_flexibility_settings settings = resolution->elements;
  settings.columns = COLUMNS;
  settings.rim_elements = RIM_ELEMENTS;
  return settings;
}

struct eo_contact_grid_settings eo_contact_grid_default(const struct eo_resolution *resolution)
{
  return (struct eo_contact_grid_settings){.positions = resolution->positions,
                                           .cells = resolution->cells_per_line,
                                           .partial_cells = true,
                                           .tip_edges = resolution->tip_edge_contact,
                                           .edge_cells = EO_EDGE_CELLS,
                                           .edge_reach = NAN};
}
