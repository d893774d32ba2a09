#include "contact/pattern.h"

#include <math.h>
#include <stddef.h>

void eo_contact_pattern_init(struct eo_contact_pattern *pattern, const struct eo_geometry *g)
{
  *pattern = (struct eo_contact_pattern){0};
  for (int i = 0; i < EO_PATTERN_ROWS; i++)
    pattern->path[i] = g->path_start + (g->path_end - g->path_start) * i / (EO_PATTERN_ROWS - 1);
  for (int j = 0; j < EO_PATTERN_COLUMNS; j++)
    pattern->eta[j] = g->face_width * ((double)j / (EO_PATTERN_COLUMNS - 1) - 0.5);
}

/* The two mesh positions next to a phase c of the mesh, and the pair that is there. */
struct neighbours {
  int position[2], pair[2];
  double weight[2];
};

static struct neighbours neighbours_of(const struct eo_contact_grid *grid, double c)
{
  double pitch = grid->geometry.transverse_base_pitch;
  int last = grid->positions - 1, pair = (int)floor((c - grid->position[0].phase) / pitch), below = 0;
  double within = c - pair * pitch;
  while (below < last && grid->position[below + 1].phase <= within)
    below++;
  struct neighbours n = {{below, below == last ? 0 : below + 1}, {pair, below == last ? pair + 1 : pair}, {0, 0}};
  double low = grid->position[below].phase, high = grid->position[n.position[1]].phase + (below == last ? pitch : 0);
  n.weight[1] = fmin(1, (within - low) / (high - low));
  n.weight[0] = 1 - n.weight[1];
  return n;
}

/* Line load of one pair at one position, between the middles of its cells; false when its contact line does not reach the flank. */
static bool line_load_at(const struct eo_contact_grid *grid, const struct eo_loaded_end *end, int position, int pair, double eta, double *q)
{
  const struct eo_contact_position *p = &grid->position[position];
  for (int i = 0; i < p->lines; i++) {
    const struct eo_contact_line *line = &p->line[i];
    if (line->pair != pair || line->kind != EO_POINT_LINE)
      continue;
    const double *load = end->line_load + p->first + line->first;
    const struct eo_flank_point *point = p->point + line->first;
    int last = line->cells - 1;
    double step = last ? (point[last].eta - point[0].eta) / last : 1;
    double t = fmin(fmax((eta - point[0].eta) / step, 0), last);
    int cell = t >= last ? (last ? last - 1 : 0) : (int)t;
    *q = last ? load[cell] + (t - cell) * (load[cell + 1] - load[cell]) : load[0];
    return true;
  }
  return false;
}

static double pressure_at(const struct eo_contact_grid *grid, const struct eo_loaded_end *end, double s, double eta)
{
  struct neighbours n = neighbours_of(grid, s - eta * tan(grid->geometry.base_helix_angle));
  double q[2] = {0, 0}, sum = 0, weight = 0;
  for (int i = 0; i < 2; i++)
    if (line_load_at(grid, end, n.position[i], n.pair[i], eta, &q[i])) {
      sum += n.weight[i] * q[i];
      weight += n.weight[i];
    }
  if (!(weight > 0) || !(sum > 0))
    return 0;
  return eo_loaded_pressure(grid, sum / weight, eo_geometry_relative_radius(&grid->geometry, s));
}

/* Which column of the pattern a place on the face belongs to. */
static int column_of(const struct eo_geometry *g, double eta)
{
  int column = (int)lround((eta / g->face_width + 0.5) * (EO_PATTERN_COLUMNS - 1));
  return column < 0 ? 0 : column >= EO_PATTERN_COLUMNS ? EO_PATTERN_COLUMNS - 1 : column;
}

static void load_edges(struct eo_contact_pattern *pattern, const struct eo_contact_grid *grid, const struct eo_loaded_end *end)
{
  for (int k = 0; k < 2; k++)
    for (int j = 0; j < EO_PATTERN_COLUMNS; j++)
      pattern->edge[k][j] = 0;
  for (int j = 0; j < grid->positions; j++) {
    const struct eo_contact_position *p = &grid->position[j];
    for (int i = 0; i < p->points; i++) {
      double q = end->line_load[p->first + i];
      if (p->kind[i] == EO_POINT_LINE || !(q > 0))
        continue;
      double *edge = &pattern->edge[p->kind[i] == EO_POINT_GEAR_TIP ? 0 : 1][column_of(&grid->geometry, p->point[i].eta)];
      *edge = fmax(*edge, eo_loaded_pressure(grid, q, p->radius[i]));
    }
  }
}

void eo_contact_pattern_load(struct eo_contact_pattern *pattern, const struct eo_contact_grid *grid, const struct eo_loaded_end *end)
{
  for (int i = 0; i < EO_PATTERN_ROWS; i++)
    for (int j = 0; j < EO_PATTERN_COLUMNS; j++)
      pattern->pressure[i * EO_PATTERN_COLUMNS + j] = pressure_at(grid, end, pattern->path[i], pattern->eta[j]);
  load_edges(pattern, grid, end);
}

void eo_contact_pattern_unload(struct eo_contact_pattern *pattern, const struct eo_contact_grid *grid, const struct eo_gap_field *field,
                               const double *unloaded)
{
  for (int i = 0; i < EO_PATTERN_ROWS; i++)
    for (int j = 0; j < EO_PATTERN_COLUMNS; j++) {
      double s = pattern->path[i], eta = pattern->eta[j];
      struct neighbours n = neighbours_of(grid, s - eta * tan(grid->geometry.base_helix_angle));
      double approach = n.weight[0] * unloaded[n.position[0]] + n.weight[1] * unloaded[n.position[1]];
      pattern->clearance[i * EO_PATTERN_COLUMNS + j] = fmax(0, eo_gap_field_at(field, s, eta, NULL, NULL) - approach);
    }
}

void eo_contact_pair_share(const struct eo_contact_grid *grid, const struct eo_loaded_end *end, int pair, double *share)
{
  for (int j = 0; j < grid->positions; j++) {
    const struct eo_contact_position *p = &grid->position[j];
    double sum = 0;
    for (int l = 0; l < p->lines; l++)
      for (int i = p->line[l].first; p->line[l].pair == pair && i < p->line[l].first + p->line[l].cells; i++)
        sum += end->line_load[p->first + i] * p->length[i];
    share[j] = sum / end->load[j];
  }
}
