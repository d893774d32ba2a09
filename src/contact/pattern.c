/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/pattern.h"

#include <math.h>
#include <stddef.h>

/* The contact line of a pair at a position; -1: it does not reach the flank. */
static int find_line(const struct eo_contact_position *position, int pair)
{
  for (int i = 0; i < position->lines; i++)
    if (position->line[i].pair == pair && position->line[i].kind == EO_POINT_LINE)
      return i;
  return -1;
}

/* The last position at or before a phase; the first one when there is none. */
static int find_position(const struct eo_contact_grid *grid, double phase)
{
  int low = 0, high = grid->positions;
  while (high - low > 1) {
    int middle = (low + high) / 2;
    if (grid->position[middle].phase <= phase)
      low = middle;
    else
      high = middle;
  }
  return low;
}

/* The two mesh positions next to a phase c of the mesh, and the pair that is there. */
static struct eo_pattern_place place_at(const struct eo_contact_grid *grid, double c)
{
  double pitch = grid->geometry.transverse_base_pitch;
  int last = grid->positions - 1, pair = (int)floor((c - grid->position[0].phase) / pitch);
  double within = c - pair * pitch;
  int below = find_position(grid, within), above = below == last ? 0 : below + 1;
  double low = grid->position[below].phase, high = grid->position[above].phase + (below == last ? pitch : 0);
  double weight = fmin(1, (within - low) / (high - low));
  return (struct eo_pattern_place){.position = {below, above},
                                   .weight = {1 - weight, weight},
                                   .line = {find_line(&grid->position[below], pair),
                                            find_line(&grid->position[above], below == last ? pair + 1 : pair)}};
}

void eo_contact_pattern_init(struct eo_contact_pattern *pattern, const struct eo_contact_grid *grid)
{
  const struct eo_geometry *geometry = &grid->geometry;
  double lean = tan(geometry->base_helix_angle);
  *pattern = (struct eo_contact_pattern){0};
  for (int i = 0; i < EO_PATTERN_ROWS; i++)
    pattern->path[i] = geometry->path_start + (geometry->path_end - geometry->path_start) * i / (EO_PATTERN_ROWS - 1);
  for (int j = 0; j < EO_PATTERN_COLUMNS; j++)
    pattern->eta[j] = geometry->face_width * ((double)j / (EO_PATTERN_COLUMNS - 1) - 0.5);
  for (int i = 0; i < EO_PATTERN_ROWS; i++)
    for (int j = 0; j < EO_PATTERN_COLUMNS; j++) {
      struct eo_pattern_place *place = &pattern->place[i * EO_PATTERN_COLUMNS + j];
      *place = place_at(grid, pattern->path[i] - pattern->eta[j] * lean);
      place->radius = eo_geometry_relative_radius(geometry, pattern->path[i]);
    }
}

/* Line load at eta of a contact line, between the middles of its cells. */
static double line_load_at(const struct eo_contact_position *position, const struct eo_loaded_end *end, int number,
                           double eta)
{
  const struct eo_contact_line *line = &position->line[number];
  const double *load = end->line_load + position->first + line->first;
  const struct eo_flank_point *point = position->point + line->first;
  int last = line->cells - 1;
  double step = last ? (point[last].eta - point[0].eta) / last : 1;
  double t = fmin(fmax((eta - point[0].eta) / step, 0), last);
  int cell = t >= last ? (last ? last - 1 : 0) : (int)t;
  return last ? load[cell] + (t - cell) * (load[cell + 1] - load[cell]) : load[0];
}

static double pressure_at(const struct eo_contact_grid *grid, const struct eo_loaded_end *end,
                          const struct eo_pattern_place *place, double eta)
{
  double sum = 0, weight = 0;
  for (int i = 0; i < 2; i++)
    if (place->line[i] >= 0) {
      sum += place->weight[i] * line_load_at(&grid->position[place->position[i]], end, place->line[i], eta);
      weight += place->weight[i];
    }
  if (!(weight > 0) || !(sum > 0))
    return 0;
  return eo_loaded_pressure(grid, sum / weight, place->radius);
}

/* Which column of the pattern a place on the face belongs to. */
static int column_of(const struct eo_geometry *geometry, double eta)
{
  int column = (int)lround((eta / geometry->face_width + 0.5) * (EO_PATTERN_COLUMNS - 1));
  return column < 0 ? 0 : column >= EO_PATTERN_COLUMNS ? EO_PATTERN_COLUMNS - 1 : column;
}

static void load_edges(struct eo_contact_pattern *pattern, const struct eo_contact_grid *grid,
                       const struct eo_loaded_end *end)
{
  for (int k = 0; k < 2; k++)
    for (int j = 0; j < EO_PATTERN_COLUMNS; j++)
      pattern->edge[k][j] = 0;
  for (int j = 0; j < grid->positions; j++) {
    const struct eo_contact_position *position = &grid->position[j];
    for (int i = 0; i < position->points; i++) {
      double q = end->line_load[position->first + i];
      if (position->kind[i] == EO_POINT_LINE || !(q > 0))
        continue;
      double *edge = &pattern->edge[position->kind[i] == EO_POINT_GEAR_TIP ? 0 : 1]
                                   [column_of(&grid->geometry, position->point[i].eta)];
      *edge = fmax(*edge, eo_loaded_pressure(grid, q, position->radius[i]));
    }
  }
}

void eo_contact_pattern_load(struct eo_contact_pattern *pattern, const struct eo_contact_grid *grid,
                             const struct eo_loaded_end *end)
{
  for (int i = 0; i < EO_PATTERN_ROWS * EO_PATTERN_COLUMNS; i++)
    pattern->pressure[i] = pressure_at(grid, end, &pattern->place[i], pattern->eta[i % EO_PATTERN_COLUMNS]);
  load_edges(pattern, grid, end);
}

/* Hertz's pressure of line contact, p^2 = q/(pi rho K), K of the grid's local law: solved for q. */
double eo_contact_pattern_line_load(const struct eo_contact_pattern *pattern, const struct eo_contact_grid *grid,
                                    int place)
{
  double unit = eo_loaded_pressure(grid, 1, pattern->place[place].radius), ratio = pattern->pressure[place] / unit;
  return ratio * ratio;
}

void eo_contact_pattern_unload(struct eo_contact_pattern *pattern, const struct eo_gap_field *field,
                               const double *unloaded)
{
  for (int i = 0; i < EO_PATTERN_ROWS * EO_PATTERN_COLUMNS; i++) {
    const struct eo_pattern_place *place = &pattern->place[i];
    double approach = place->weight[0] * unloaded[place->position[0]] + place->weight[1] * unloaded[place->position[1]];
    double gap = eo_gap_field_at(field, pattern->path[i / EO_PATTERN_COLUMNS], pattern->eta[i % EO_PATTERN_COLUMNS],
                                 NULL, NULL);
    pattern->clearance[i] = fmax(0, gap - approach);
  }
}

void eo_contact_pair_share(const struct eo_contact_grid *grid, const struct eo_loaded_end *end, int pair, double *share)
{
  for (int j = 0; j < grid->positions; j++) {
    const struct eo_contact_position *position = &grid->position[j];
    double sum = 0;
    for (int l = 0; l < position->lines; l++)
      for (int i = position->line[l].first;
           position->line[l].pair == pair && i < position->line[l].first + position->line[l].cells; i++)
        sum += end->line_load[position->first + i] * position->length[i];
    share[j] = sum / end->load[j];
  }
}
