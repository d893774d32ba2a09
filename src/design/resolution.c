/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "design/resolution.h"

#include <math.h>

struct eo_flexibility_settings eo_flexibility_settings_of(const struct eo_resolution *resolution)
{
  return (struct eo_flexibility_settings){.body = resolution->body,
                                          .support = resolution->body_support,
                                          .sector_teeth = resolution->sector_teeth,
                                          .neighbour_coupling = resolution->neighbour_coupling,
                                          .layers = resolution->layers,
                                          .flank_rows = resolution->flank_rows,
                                          .fillet_elements = resolution->fillet_elements,
                                          .columns = 8,
                                          .rim_elements = 8};
}

struct eo_contact_grid_settings eo_contact_grid_default(const struct eo_resolution *resolution)
{
  return (struct eo_contact_grid_settings){.positions = resolution->positions,
                                           .cells = resolution->cells_per_line,
                                           .partial_cells = true,
                                           .tip_edges = resolution->tip_edge_contact,
                                           .edge_cells = 12,
                                           .edge_reach = NAN};
}
