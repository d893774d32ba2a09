/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What loaded contact starts from and leads to: gaps at the points of a grid, first contact, pressure. */
#include "contact/loaded.h"

#include <math.h>
#include <stddef.h>

void eo_loaded_first_contact(const struct eo_contact_grid *grid, const struct eo_gap_field *field, double *unloaded)
{
  for (int j = 0; j < grid->positions; j++) {
    const struct eo_contact_position *p = &grid->position[j];
    bool edges = false;
    unloaded[j] = INFINITY;
    for (int l = 0; l < p->lines; l++)
      edges |= p->line[l].kind != EO_POINT_LINE;
    for (int l = 0; l < p->lines; l++) {
      bool seen = false;
      for (int m = 0; m < l; m++)
        seen |= p->line[m].pair == p->line[l].pair;
      double c = p->phase + p->line[l].pair * grid->geometry.transverse_base_pitch;
      if (!seen)
        unloaded[j] = fmin(unloaded[j], eo_gap_field_line_minimum(field, c, edges, NULL));
    }
  }
}

void eo_loaded_gaps_set(struct eo_loaded_gaps *gaps, const struct eo_contact_grid *grid,
                        const struct eo_gap_field *field)
{
  for (int j = 0; j < grid->positions; j++) {
    const struct eo_contact_position *p = &grid->position[j];
    for (int i = 0; i < p->points; i++)
      gaps->gap[p->first + i] = eo_gap_field_at(field, p->path[i], p->point[i].eta, NULL, NULL);
  }
  eo_loaded_first_contact(grid, field, gaps->unloaded);
}

double eo_loaded_pressure(const struct eo_contact_grid *grid, double line_load, double radius)
{
  /* p = sqrt(q E* / (pi rho)) with 1/E* = 2 (1 - nu^2)/E = pi K */
  return sqrt(line_load / (M_PI * M_PI * grid->compliance_scale * radius));
}
