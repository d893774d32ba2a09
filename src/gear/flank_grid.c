/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gear/flank_grid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int numbers_of(int u_knots, int y_knots)
{
  return u_knots ? u_knots + y_knots + u_knots * y_knots : 0;
}

static struct eo_flank_grid grid_of(const struct eo_flank_grids *grids, const struct eo_grid_place *place)
{
  const double *number = grids->number + place->first;
  if (place->u_knots == 0)
    return (struct eo_flank_grid){0};
  return (struct eo_flank_grid){.u_knots = place->u_knots,
                                .y_knots = place->y_knots,
                                .u = number,
                                .y = number + place->u_knots,
                                .delta = number + place->u_knots + place->y_knots,
                                .kind = place->kind,
                                .kind_stated = place->kind_stated};
}

struct eo_flank_grid eo_flank_grid_at(const struct eo_flank_grids *grids, enum eo_flank_side side, int member, int end)
{
  return grid_of(grids, &grids->place[side][member][end]);
}

/* Takes a grid away and closes the gap that it leaves. */
static void remove_grid(struct eo_flank_grids *grids, struct eo_grid_place *place)
{
  struct eo_grid_place *all = &grids->place[0][0][0];
  int size = numbers_of(place->u_knots, place->y_knots), behind = place->first + size;
  if (size == 0)
    return;
  memmove(grids->number + place->first, grids->number + behind, sizeof(double) * (size_t)(grids->used - behind));
  for (int i = 0; i < 8; i++)
    all[i].first -= all[i].first >= behind ? size : 0;
  grids->used -= size;
  *place = (struct eo_grid_place){0};
}

static bool covers(const struct eo_grid_node *node, int row, int column)
{
  return (node->row == 0 || node->row == row + 1) && (node->column == 0 || node->column == column + 1);
}

void eo_grid_nodes_lay(int nodes, const struct eo_grid_node *node, int u_knots, int y_knots, double *delta)
{
  for (int k = 0; k < nodes; k++)
    for (int i = 0; i < u_knots * y_knots; i++)
      if (covers(&node[k], i / y_knots, i % y_knots))
        delta[i] = node[k].delta;
}

double eo_flank_grid_number(const struct eo_flank_grid *grid, int row, int column)
{
  const struct eo_grid_node node = {row, column, 0};
  double number = NAN;
  for (int i = 0, found = 0; i < grid->u_knots * grid->y_knots; i++)
    if (covers(&node, i / grid->y_knots, i % grid->y_knots)) {
      if (found++ && grid->delta[i] != number)
        return NAN;
      number = grid->delta[i];
    }
  return number;
}

enum eo_code eo_flank_grids_put(struct eo_flank_grids *grids, enum eo_flank_side side, int member, int end,
                                const struct eo_flank_grid *grid, struct eo_error *error)
{
  struct eo_grid_place *place = &grids->place[side][member][end];
  int size = numbers_of(grid->u_knots, grid->y_knots);
  remove_grid(grids, place);
  if (size > EO_GRID_NUMBERS - grids->used)
    return eo_error_set(error, EO_ERROR_INPUT, NULL,
                        "The grids of a design hold at most %d numbers together; this one of %d x %d knots leaves no "
                        "room: take every other knot.",
                        EO_GRID_NUMBERS, grid->u_knots, grid->y_knots);
  if (size == 0)
    return EO_OK;
  double *number = grids->number + grids->used;
  *place = (struct eo_grid_place){grid->u_knots, grid->y_knots, grids->used, grid->kind, grid->kind_stated};
  memcpy(number, grid->u, sizeof(double) * (size_t)grid->u_knots);
  memcpy(number + grid->u_knots, grid->y, sizeof(double) * (size_t)grid->y_knots);
  memcpy(number + grid->u_knots + grid->y_knots, grid->delta,
         sizeof(double) * (size_t)grid->u_knots * (size_t)grid->y_knots);
  grids->used += size;
  return EO_OK;
}

bool eo_flank_grid_equal(const struct eo_flank_grid *a, const struct eo_flank_grid *b)
{
  if (a->u_knots != b->u_knots || a->y_knots != b->y_knots)
    return false;
  /* the numbers of a grid stand together, u first */
  return a->u_knots == 0 || memcmp(a->u, b->u, sizeof(double) * (size_t)numbers_of(a->u_knots, a->y_knots)) == 0;
}

bool eo_flank_grids_equal(const struct eo_flank_grids *a, const struct eo_flank_grids *b)
{
  const struct eo_grid_place *of_a = &a->place[0][0][0], *of_b = &b->place[0][0][0];
  bool same = true;
  for (int i = 0; i < 8 && same; i++) {
    struct eo_flank_grid x = grid_of(a, &of_a[i]), y = grid_of(b, &of_b[i]);
    same = eo_flank_grid_equal(&x, &y);
  }
  return same;
}

/* Second derivatives of the natural cubic spline through value[n], `stride` apart, at the knots: the tridiagonal system
   h_(i-1) m_(i-1) + 2 (h_(i-1) + h_i) m_i + h_i m_(i+1) = 6 (difference quotients' difference), m = 0 at both ends. */
static void bend(int n, const double *knot, const double *value, double *second, size_t stride)
{
  double factor[EO_GRID_KNOTS], right[EO_GRID_KNOTS];
  factor[0] = right[0] = 0;
  for (int i = 1; i < n - 1; i++) {
    double before = knot[i] - knot[i - 1], after = knot[i + 1] - knot[i];
    double here = value[(size_t)i * stride];
    double rise = (value[(size_t)(i + 1) * stride] - here) / after - (here - value[(size_t)(i - 1) * stride]) / before;
    double pivot = 2 * (before + after) - before * factor[i - 1];
    factor[i] = after / pivot;
    right[i] = (6 * rise - before * right[i - 1]) / pivot;
  }
  second[0] = second[(size_t)(n - 1) * stride] = 0;
  for (int i = n - 2; i > 0; i--)
    second[(size_t)i * stride] = right[i] - factor[i] * second[(size_t)(i + 1) * stride];
}

enum { VALUE, BY_U, BY_Y, BY_BOTH, PARTS };

static void fit(struct eo_flank_spline *spline)
{
  size_t row = (size_t)spline->y_knots * PARTS;
  for (int j = 0; j < spline->y_knots; j++) {
    double *column = spline->coefficient + (size_t)j * PARTS;
    bend(spline->u_knots, spline->u, column + VALUE, column + BY_U, row);
  }
  for (int i = 0; i < spline->u_knots; i++) {
    double *line = spline->coefficient + (size_t)i * row;
    bend(spline->y_knots, spline->y, line + VALUE, line + BY_Y, PARTS);
    bend(spline->y_knots, spline->y, line + BY_U, line + BY_BOTH, PARTS);
  }
}

enum eo_code eo_flank_spline_new(struct eo_flank_spline **result, const struct eo_flank_grid *grid,
                                 struct eo_error *error)
{
  size_t u = (size_t)grid->u_knots, y = (size_t)grid->y_knots;
  struct eo_flank_spline *spline = calloc(1, sizeof *spline);
  if (!spline)
    return eo_error_memory(error);
  spline->u_knots = grid->u_knots;
  spline->y_knots = grid->y_knots;
  spline->u = malloc(u * sizeof(double));
  spline->y = malloc(y * sizeof(double));
  spline->coefficient = malloc(u * y * PARTS * sizeof(double));
  if (!spline->u || !spline->y || !spline->coefficient) {
    eo_flank_spline_free(spline);
    return eo_error_memory(error);
  }
  memcpy(spline->u, grid->u, u * sizeof(double));
  memcpy(spline->y, grid->y, y * sizeof(double));
  for (size_t i = 0; i < u * y; i++)
    spline->coefficient[i * PARTS + VALUE] = grid->delta[i];
  fit(spline);
  *result = spline;
  return EO_OK;
}

void eo_flank_spline_free(struct eo_flank_spline *spline)
{
  if (!spline)
    return;
  free(spline->u);
  free(spline->y);
  free(spline->coefficient);
  free(spline);
}

/* The piece that holds x, which lies between the outermost knots. */
static int piece_of(int n, const double *knot, double x)
{
  int low = 0, high = n - 1;
  while (high - low > 1) {
    int middle = (low + high) / 2;
    if (knot[middle] <= x)
      low = middle;
    else
      high = middle;
  }
  return low;
}

/* Weights of the values and second derivatives at both ends of a piece, h wide, at the part t of it. */
static void weigh(double h, double t, double weight[4])
{
  double r = 1 - t;
  weight[0] = r;
  weight[1] = t;
  weight[2] = h * h / 6 * r * (r * r - 1);
  weight[3] = h * h / 6 * t * (t * t - 1);
}

static void weigh_slope(double h, double t, double weight[4])
{
  double r = 1 - t;
  weight[0] = -1 / h;
  weight[1] = 1 / h;
  weight[2] = -h / 6 * (3 * r * r - 1);
  weight[3] = h / 6 * (3 * t * t - 1);
}

static double clamp(double x, double low, double high)
{
  return x < low ? low : x > high ? high : x;
}

/* The cell that holds a place, or the nearest one, and the part of it below the place. */
struct cell {
  int i, j;
  double size[2], part[2]; /* along u and y */
};

static struct cell cell_at(const struct eo_flank_spline *spline, double u, double y)
{
  const double *us = spline->u, *ys = spline->y;
  double inside = clamp(u, us[0], us[spline->u_knots - 1]), across = clamp(y, ys[0], ys[spline->y_knots - 1]);
  struct cell cell = {.i = piece_of(spline->u_knots, us, inside), .j = piece_of(spline->y_knots, ys, across)};
  cell.size[0] = us[cell.i + 1] - us[cell.i];
  cell.size[1] = ys[cell.j + 1] - ys[cell.j];
  cell.part[0] = (inside - us[cell.i]) / cell.size[0];
  cell.part[1] = (across - ys[cell.j]) / cell.size[1];
  return cell;
}

/* What by_y makes of the cell at both its knots of u: [delta below, above, its second derivative by u below, above]. */
static void weigh_rows(const struct eo_flank_spline *spline, const struct cell *cell, const double by_y[4],
                       double row[4])
{
  for (int k = 0; k < 2; k++) {
    const double *c = spline->coefficient + ((size_t)(cell->i + k) * (size_t)spline->y_knots + (size_t)cell->j) * PARTS;
    row[k] = by_y[0] * c[VALUE] + by_y[1] * c[PARTS + VALUE] + by_y[2] * c[BY_Y] + by_y[3] * c[PARTS + BY_Y];
    row[2 + k] = by_y[0] * c[BY_U] + by_y[1] * c[PARTS + BY_U] + by_y[2] * c[BY_BOTH] + by_y[3] * c[PARTS + BY_BOTH];
  }
}

static double sum(const double weight[4], const double row[4])
{
  return weight[0] * row[0] + weight[1] * row[1] + weight[2] * row[2] + weight[3] * row[3];
}

double eo_flank_spline_at(const struct eo_flank_spline *spline, double u, double y, double slope[2])
{
  const double *us = spline->u;
  int last = spline->u_knots - 1;
  struct cell cell = cell_at(spline, u, y);
  double by_y[4], by_u[4], row[4];
  weigh(cell.size[1], cell.part[1], by_y);
  weigh_rows(spline, &cell, by_y, row);
  weigh(cell.size[0], cell.part[0], by_u);
  if (slope) {
    double rate[4];
    weigh_slope(cell.size[0], cell.part[0], rate);
    double inner = sum(rate, row);
    slope[0] = u <= us[0] || u > us[last] ? 0 : inner;
    slope[1] = u < us[0] || u >= us[last] ? 0 : inner;
  }
  return sum(by_u, row);
}

double eo_flank_spline_across(const struct eo_flank_spline *spline, double u, double y)
{
  double low = spline->y[0], high = spline->y[spline->y_knots - 1], by_y[4], by_u[4], row[4];
  struct cell cell = cell_at(spline, u, y);
  if (y < low || y > high)
    return 0;
  weigh_slope(cell.size[1], cell.part[1], by_y);
  weigh_rows(spline, &cell, by_y, row);
  weigh(cell.size[0], cell.part[0], by_u);
  return (y > low && y < high ? 1 : 0.5) * sum(by_u, row);
}
