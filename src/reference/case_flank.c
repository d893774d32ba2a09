/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Flanks in the words of case files. */
#include "reference/verify_deviations.h"

#include <stdlib.h>
#include <string.h>

#include "gear/gear_pair.h"
#include "gear/modification.h"

static const double MM = 1e-3, UM = 1e-6;

/* In the order of enum eo_relief_shape. */
static const char *const shapes[] = {"parabolic", "linear", "circular", NULL};

static void read_relief(struct eo_case *block, int side, struct eo_flank_modification *flank)
{
  static const char *const amount[2] = {"root_relief_um", "tip_relief_um"},
                           *const start[2] = {"root_start_mm", "tip_start_mm"},
                           *const shape[2] = {"root_shape", "tip_shape"};
  double depth = UM * eo_case_number_or(block, amount[side], 0), from = MM * eo_case_number_or(block, start[side], 0);
  *(side == EO_TIP_SIDE ? &flank->tip_relief : &flank->root_relief) = depth;
  *(side == EO_TIP_SIDE ? &flank->tip_relief_start : &flank->root_relief_start) = from;
  flank->own_shape[side] = 1 + eo_case_choice(block, shape[side], shapes, EO_RELIEF_PARABOLIC);
}

static int face_side(struct eo_case *row)
{
  int side = eo_case_whole(row, "side", -1, 1);
  if (side == 0)
    eo_case_fault(eo_case_find(row, "side"), "A side is -1 or 1.");
  return side > 0 ? EO_LEADING_SIDE : EO_TRAILING_SIDE;
}

static void read_triangles(struct eo_case *list, struct eo_flank_modification *flank)
{
  static const char *const corners[] = {"root", "tip", NULL};
  for (int i = 0; i < eo_case_size(list); i++) {
    struct eo_case *row = eo_case_at(list, i);
    int side = eo_case_need(row, "corner") ? eo_case_choice(row, "corner", corners, -1) : -1, face = face_side(row);
    if (side < 0)
      continue;
    struct eo_triangular_relief *relief = &flank->triangular[side][face];
    if (relief->amount != 0)
      eo_case_fault(row, "This corner has a triangular relief already.");
    *relief = (struct eo_triangular_relief){.amount = UM * eo_case_number(row, "amount_um"),
                                            .profile_length = MM * eo_case_number(row, "profile_length_mm"),
                                            .face_length = MM * eo_case_number(row, "face_length_mm"),
                                            .exponent = eo_case_number_or(row, "power", 1)};
  }
}

static void read_end_reliefs(struct eo_case *list, struct eo_flank_modification *flank)
{
  for (int i = 0; i < eo_case_size(list); i++) {
    struct eo_case *row = eo_case_at(list, i);
    int face = face_side(row);
    if (flank->end_relief[face] != 0)
      eo_case_fault(row, "This side has an end relief already.");
    flank->end_relief[face] = UM * eo_case_number(row, "amount_um");
    flank->end_relief_length[face] = MM * eo_case_number(row, "length_mm");
    flank->end_shape[face] = EO_RELIEF_EXPONENT;
    flank->end_exponent[face] = eo_case_number_or(row, "power", 2);
  }
}

static void scale(int count, double *number, double unit)
{
  for (int i = 0; i < count; i++)
    number[i] *= unit;
}

static void read_grid(struct eo_case *block, enum eo_flank_side side, int member, int end, struct eo_flank_grids *grids)
{
  double *number = malloc(sizeof *number * (2 * EO_GRID_KNOTS + EO_GRID_NUMBERS));
  if (!number) {
    eo_case_fault(block, "Not enough memory for this grid.");
    return;
  }
  double *y = number + EO_GRID_KNOTS, *delta = y + EO_GRID_KNOTS;
  struct eo_case *rows = eo_case_need(block, "delta_um");
  int u_knots = eo_case_numbers(eo_case_need(block, "u_mm"), -1, EO_GRID_KNOTS, number),
      y_knots = eo_case_numbers(eo_case_need(block, "y_mm"), -1, EO_GRID_KNOTS, y);
  bool good = u_knots >= 2 && y_knots >= 2 && u_knots * y_knots <= EO_GRID_NUMBERS;
  if (!good || eo_case_size(rows) != u_knots)
    eo_case_fault(block, "A grid has at least 2 x 2 knots, a row for each u and a number for each y.");
  for (int i = 0; i < u_knots && good && !eo_case_faulty(block); i++)
    good = eo_case_numbers(eo_case_at(rows, i), y_knots, EO_GRID_KNOTS, delta + i * y_knots) >= 0;
  if (good && !eo_case_faulty(block)) {
    struct eo_error error;
    scale(u_knots, number, MM);
    scale(y_knots, y, MM);
    scale(u_knots * y_knots, delta, UM);
    struct eo_flank_grid grid = {.u_knots = u_knots, .y_knots = y_knots, .u = number, .y = y, .delta = delta};
    if (eo_flank_grids_put(grids, side, member, end, &grid, &error))
      eo_case_fault(block, "%s", error.text);
  }
  free(number);
}

/* T of the files is the amount at the corners; S_alpha is four times that. */
void eo_case_flank(struct eo_case *block, enum eo_flank_side side, int member, int end,
                   struct eo_flank_modification *flank, struct eo_flank_grids *grids)
{
  memset(flank, 0, sizeof *flank);
  for (int i = 0; i < 2; i++)
    read_relief(block, i, flank);
  flank->profile_slope = UM * eo_case_number_or(block, "profile_slope_um", 0);
  flank->profile_barrel = UM * eo_case_number_or(block, "barrel_um", 0);
  flank->helix_slope = UM * eo_case_number_or(block, "helix_slope_um", 0);
  flank->lead_crowning = UM * eo_case_number_or(block, "lead_crowning_um", 0);
  flank->twist = 4 * UM * eo_case_number_or(block, "twist_um", 0);
  read_triangles(eo_case_find(block, "triangular"), flank);
  read_end_reliefs(eo_case_find(block, "end_relief"), flank);
  if (eo_case_find(block, "grid"))
    read_grid(eo_case_find(block, "grid"), side, member, end, grids);
}
