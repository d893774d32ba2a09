/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "design/design_grids.h"

#include <math.h>

static struct eo_flank_modification *flank_at(struct eo_modification *modification, int side, int member, int end)
{
  return side == EO_DRIVE_FLANK ? &modification->flank[member][end] : &modification->coast[member][end];
}

static void note_varied(struct eo_grid_place *grid)
{
  if (grid->u_knots > 0 && !grid->kind_stated)
    grid->kind = EO_GRID_DESIGNED;
}

/* What the grid does not have stays, for the check to name. */
static void drop_laid(struct eo_flank_modification *flank, struct eo_grid_place *grid)
{
  if (flank->nodes > 0)
    note_varied(grid);
  for (int k = flank->nodes; k-- > 0;) {
    struct eo_grid_node node = flank->node[k];
    if (grid->u_knots > 0 && node.row <= grid->u_knots && node.column <= grid->y_knots)
      eo_modification_drop_node(flank, node.row, node.column);
  }
}

static bool covers(const struct eo_listed_variable *variable, int side, int end)
{
  return (variable->flank == side || variable->flank == EO_BOTH_FLANKS) &&
         (variable->end == end || variable->end == EO_BOTH_ENDS);
}

static void state_varied(struct eo_design *design, const struct eo_listed_variable *variable, int side, int end)
{
  struct eo_grid_place *place = &design->grids.place[side][variable->member][end];
  const struct eo_flank_grid grid = eo_flank_grid_at(&design->grids, (enum eo_flank_side)side, variable->member, end);
  double number = eo_flank_grid_number(&grid, variable->row, variable->column);
  note_varied(place);
  if (!isnan(number))
    eo_modification_set_node(flank_at(&design->modification, side, variable->member, end), variable->row,
                             variable->column, number);
}

void eo_design_resolve_grids(struct eo_design *design)
{
  eo_modification_lay_nodes(&design->modification, &design->grids);
  for (int i = 0; i < 8; i++)
    drop_laid(flank_at(&design->modification, i / 4, i / 2 % 2, i % 2), &design->grids.place[i / 4][i / 2 % 2][i % 2]);
  for (int k = 0; k < design->optimization.listed; k++) {
    const struct eo_listed_variable *variable = &design->optimization.list[k];
    for (int i = 0; i < 4 && variable->of_grid; i++)
      if (covers(variable, i / 2, i % 2))
        state_varied(design, variable, i / 2, i % 2);
  }
}

static bool is_designed(const struct eo_grid_place *grid)
{
  return grid->u_knots > 0 && grid->kind == EO_GRID_DESIGNED;
}

struct eo_modification eo_design_unmodified(const struct eo_design *design)
{
  struct eo_modification none = {0};
  for (int i = 0; i < 8; i++)
    if (is_designed(&design->grids.place[i / 4][i / 2 % 2][i % 2]))
      flank_at(&none, i / 4, i / 2 % 2, i % 2)->grid_gain = -1;
  return none;
}

bool eo_design_is_unmodified(const struct eo_design *design)
{
  const struct eo_modification *modification = &design->modification;
  bool none = true;
  for (int member = 0; member < 2; member++)
    for (int end = 0; end < design->gear_pair.ends; end++)
      none = none && eo_modification_is_none(&modification->flank[member][end]) &&
             eo_modification_is_none(&modification->coast[member][end]) &&
             !is_designed(&design->grids.place[EO_DRIVE_FLANK][member][end]) &&
             !is_designed(&design->grids.place[EO_COAST_FLANK][member][end]);
  return none;
}
