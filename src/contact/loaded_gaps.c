/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What loaded contact starts from and leads to: gaps at the points of a grid, first contact, pressure. */
#include "contact/loaded.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

/* First contact of the pair that line `first` of a position begins; with the gaps [points] at its points, which may be
   NULL: within the width of a cell of the lowest of them. INFINITY where an earlier line has the pair already. */
static double pair_contact(const struct eo_contact_grid *grid, const struct eo_contact_position *position,
                           const struct eo_gap_field *field, int first, const double *gap)
{
  double lowest = INFINITY, eta = 0, step = 0, range[2], axial = cos(grid->geometry.base_helix_angle),
         c = position->phase + position->line[first].pair * grid->geometry.transverse_base_pitch;
  bool edges = false;
  for (int l = 0; l < position->lines; l++) {
    const struct eo_contact_line *line = &position->line[l];
    edges = edges || line->kind != EO_POINT_LINE;
    if (line->pair != position->line[first].pair)
      continue;
    if (l < first)
      return INFINITY;
    for (int i = line->first; gap && i < line->first + line->cells; i++)
      if (gap[i] < lowest) {
        lowest = gap[i];
        eta = position->point[i].eta;
      }
    step = fmax(step, position->length[line->first] * axial);
  }
  if (!gap || !eo_gap_field_edge_range(field, c, edges, range))
    return eo_gap_field_line_minimum(field, c, edges, NULL);
  range[0] = fmin(range[0], eta);
  range[1] = fmax(range[1], eta);
  return eo_gap_field_line_descend(field, c, range, step, lowest, &eta);
}

/* Of positions first <= j < last. */
static void find_contact(const struct eo_contact_grid *grid, const struct eo_gap_field *field, const double *gap,
                         int first, int last, double *unloaded)
{
  for (int j = first; j < last; j++) {
    const struct eo_contact_position *position = &grid->position[j];
    unloaded[j] = INFINITY;
    for (int l = 0; l < position->lines; l++)
      unloaded[j] = fmin(unloaded[j], pair_contact(grid, position, field, l, gap ? gap + position->first : NULL));
  }
}

void eo_loaded_first_contact(const struct eo_contact_grid *grid, const struct eo_gap_field *field, const double *gap,
                             double *unloaded)
{
  find_contact(grid, field, gap, 0, grid->positions, unloaded);
}

void eo_loaded_gaps_set_some(struct eo_loaded_gaps *gaps, const struct eo_contact_grid *grid,
                             const struct eo_gap_field *field, int first, int last)
{
  for (int j = first; j < last; j++) {
    const struct eo_contact_position *position = &grid->position[j];
    for (int i = 0; i < position->points; i++)
      gaps->gap[position->first + i] = eo_gap_field_at(field, position->path[i], position->point[i].eta, NULL, NULL);
  }
  find_contact(grid, field, gaps->gap, first, last, gaps->unloaded);
}

void eo_loaded_gaps_set(struct eo_loaded_gaps *gaps, const struct eo_contact_grid *grid,
                        const struct eo_gap_field *field)
{
  eo_loaded_gaps_set_some(gaps, grid, field, 0, grid->positions);
}

double eo_loaded_pressure(const struct eo_contact_grid *grid, double line_load, double radius)
{
  /* p = sqrt(q E* / (pi rho)) with 1/E* = 2 (1 - nu^2)/E = pi K */
  return sqrt(line_load / (M_PI * M_PI * grid->compliance_scale * radius));
}
