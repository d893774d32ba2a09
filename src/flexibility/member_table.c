/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "flexibility/member_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum eo_code eo_flank_table_init(struct eo_flank_table *table, const struct eo_member_settings *settings,
                                 struct eo_error *error)
{
  const struct eo_section_settings *section = &settings->section;
  int fine = section->loaded.rows, step = eo_member_row_step(fine + 1);
  *table = (struct eo_flank_table){.rows = fine + 1,
                                   .next_rows = (section->open ? fine / step : section->next.rows) + 1,
                                   .layers = settings->layers,
                                   .root_points = section->loaded.fillet[1] - 1,
                                   .reach = settings->reach};
  size_t across = (size_t)table->layers + 1, rows = (size_t)table->rows, next_rows = (size_t)table->next_rows;
  size_t flank = rows * across, next = next_rows * across, points = (size_t)table->root_points;
  size_t reach = (size_t)table->reach;
  table->stresses = points * across * EO_STRESSES;
  size_t length[] = {rows,
                     next_rows,
                     2 * points,
                     points,
                     flank * flank,
                     reach * flank * flank,
                     flank * table->stresses,
                     reach * next * table->stresses,
                     reach * next * table->stresses,
                     rows,
                     rows};
  double **place[] = {
      &table->s,      &table->next_s,         &table->root,           &table->arc,     &table->bulk,   &table->ahead,
      &table->stress, &table->next_stress[0], &table->next_stress[1], &table->part[0], &table->part[1]};
  for (size_t i = 0; i < sizeof length / sizeof *length; i++)
    table->size += length[i];
  double *data = table->data = malloc(table->size * sizeof *data);
  if (!data)
    return eo_error_memory(error);
  for (size_t i = 0; i < sizeof length / sizeof *length; i++) {
    *place[i] = data;
    data += length[i];
  }
  return EO_OK;
}

static void grid_done(struct eo_grid *grid)
{
  eo_spline_done(&grid->s);
  eo_spline_done(&grid->eta);
}

void eo_flank_table_done(struct eo_flank_table *table)
{
  if (!table)
    return;
  free(table->data);
  grid_done(&table->flank);
  grid_done(&table->next);
  *table = (struct eo_flank_table){0};
}

static enum eo_code grid_init(struct eo_grid *grid, int rows, const double *s, int layers, double width,
                              struct eo_error *error)
{
  double eta[EO_SPLINE_MAX];
  for (int l = 0; l <= layers && l < EO_SPLINE_MAX; l++)
    eta[l] = width * ((double)l / layers - 0.5);
  enum eo_code code = eo_spline_init(&grid->s, rows, s, error);
  if (!code)
    code = eo_spline_init(&grid->eta, layers + 1, eta, error);
  grid->points = rows * (layers + 1);
  return code;
}

enum eo_code eo_flank_table_connect(struct eo_flank_table *table, double width, struct eo_error *error)
{
  enum eo_code code = grid_init(&table->flank, table->rows, table->s, table->layers, width, error);
  return code ? code : grid_init(&table->next, table->next_rows, table->next_s, table->layers, width, error);
}

/* matrix[outer][n][inner] := operator[n][n] applied to its middle index; column[n * inner] is scratch. */
static void apply(const double *operator, size_t n, size_t outer, size_t inner, double *matrix, double *scratch)
{
  for (size_t o = 0; o < outer; o++, matrix += n * inner) {
    memset(scratch, 0, n * inner * sizeof *scratch);
    for (size_t i = 0; i < n; i++)
      for (size_t j = 0; j < n; j++) {
        double factor = operator[i * n + j];
        for (size_t c = 0; c < inner; c++)
          scratch[i * inner + c] += factor * matrix[j * inner + c];
      }
    memcpy(matrix, scratch, n * inner * sizeof *scratch);
  }
}

/* Values at the nodes to spline coefficients, along the first index of matrix[grid points][inner]. */
static enum eo_code to_coefficients(const struct eo_grid *grid, size_t inner, double *matrix)
{
  size_t rows = (size_t)grid->s.count, across = (size_t)grid->eta.count;
  double *scratch = malloc(rows * across * inner * sizeof *scratch);
  if (!scratch)
    return EO_ERROR_MEMORY;
  apply(grid->eta.to_coefficients, across, rows, inner, matrix, scratch);
  apply(grid->s.to_coefficients, rows, 1, across * inner, matrix, scratch);
  free(scratch);
  return EO_OK;
}

static void transpose(double *matrix, size_t n)
{
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < i; j++) {
      double kept = matrix[i * n + j];
      matrix[i * n + j] = matrix[j * n + i];
      matrix[j * n + i] = kept;
    }
}

static enum eo_code to_coefficients_twice(const struct eo_grid *grid, double *matrix)
{
  size_t n = (size_t)grid->points;
  enum eo_code code = to_coefficients(grid, n, matrix);
  transpose(matrix, n);
  if (!code)
    code = to_coefficients(grid, n, matrix);
  transpose(matrix, n);
  return code;
}

/* Response on another tooth's own rows to the rows of the flank: [flank][coupled] to [flank][flank]. */
static enum eo_code refine(const struct eo_flank_table *table, size_t coupled, const double *coarse, double *fine)
{
  size_t rows = (size_t)table->rows, next_rows = (size_t)table->next_rows, across = (size_t)table->layers + 1;
  size_t flank = rows * across, next = next_rows * across;
  if (coupled == flank) {
    memcpy(fine, coarse, flank * flank * sizeof *fine);
    return EO_OK;
  }
  double *weight = malloc(rows * next_rows * sizeof *weight);
  if (!weight)
    return EO_ERROR_MEMORY;
  for (size_t r = 0; r < rows; r++)
    eo_spline_value_weights(&table->next.s, table->s[r], weight + r * next_rows);
  memset(fine, 0, flank * flank * sizeof *fine);
  for (size_t load = 0; load < flank; load++)
    for (size_t r = 0; r < rows; r++)
      for (size_t q = 0; q < next_rows; q++)
        for (size_t l = 0; l < across; l++)
          fine[load * flank + r * across + l] += weight[r * next_rows + q] * coarse[load * next + q * across + l];
  free(weight);
  return EO_OK;
}

/* C(k + d, k) from the responses ahead and behind. A sector is not the same seen from tooth k + 1 as from k, so the
   mean of the response ahead and of the transposed response behind is taken: then C(k + d, k) = C(k, k + d)' exactly.
   In a ring both agree to rounding. */
static enum eo_code fill_ahead(struct eo_flank_table *table, const struct eo_member_result *result)
{
  size_t n = (size_t)table->flank.points, coupled = (size_t)result->coupled_rows * (result->layers + 1);
  double *behind = malloc(n * n * sizeof *behind);
  enum eo_code code = behind ? EO_OK : EO_ERROR_MEMORY;
  for (size_t d = 0; d < (size_t)table->reach && !code; d++) {
    double *ahead = table->ahead + d * n * n;
    code = refine(table, coupled, result->next[1] + d * n * coupled, ahead);
    if (!code)
      code = refine(table, coupled, result->next[0] + d * n * coupled, behind);
    for (size_t i = 0; i < n && !code; i++)
      for (size_t j = 0; j < n; j++)
        ahead[i * n + j] = 0.5 * (ahead[i * n + j] + behind[j * n + i]);
  }
  free(behind);
  return code;
}

/* Largest number of unknowns whose eigenvalues are looked for: half a second. */
enum { MOST_EIGENVALUES = 1000 };

/* matrix[teeth n][teeth n]: compliance of teeth side by side, its lower triangle by blocks. */
static void fill_side_by_side(const struct eo_flank_table *table, size_t teeth, double *matrix)
{
  size_t n = (size_t)table->flank.points, row = teeth * n;
  for (size_t a = 0; a < teeth; a++)
    for (size_t b = 0; b <= a; b++) {
      const double *block = a == b ? table->bulk : eo_flank_table_ahead(table, (int)(a - b));
      /* block[on pair b][on pair a], a ahead of b */
      for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++)
          matrix[(b * n + i) * row + a * n + j] = matrix[(a * n + j) * row + b * n + i] = block[i * n + j];
    }
}

/* Smallest over largest eigenvalue of the compliance of as many teeth side by side as are coupled, or as stay within
   the largest number. */
static enum eo_code measure(const struct eo_flank_table *table, double *smallest, struct eo_error *error)
{
  size_t n = (size_t)table->flank.points, teeth = (size_t)table->reach + 1;
  while (teeth > 1 && teeth * n > MOST_EIGENVALUES)
    teeth--;
  double *matrix = malloc(teeth * n * teeth * n * sizeof *matrix), low = 0, high = 1;
  if (!matrix)
    return eo_error_memory(error);
  fill_side_by_side(table, teeth, matrix);
  enum eo_code code = eo_symmetric_extremes((int)(teeth * n), matrix, &low, &high, error);
  *smallest = low / high;
  free(matrix);
  return code;
}

static void copy_values(struct eo_flank_table *table, const struct eo_member_result *result)
{
  size_t n = (size_t)result->rows * (result->layers + 1), next = (size_t)result->next_rows * (result->layers + 1);
  size_t reach = (size_t)table->reach;
  memcpy(table->s, result->s, (size_t)table->rows * sizeof *table->s);
  memcpy(table->next_s, result->next_s, (size_t)table->next_rows * sizeof *table->next_s);
  memcpy(table->root, result->root, 2 * (size_t)table->root_points * sizeof *table->root);
  memcpy(table->arc, result->arc, (size_t)table->root_points * sizeof *table->arc);
  memcpy(table->stress, result->stress, n * table->stresses * sizeof *table->stress);
  for (int k = 0; k < 2; k++) {
    memcpy(table->next_stress[k], result->next_stress[k], reach * next * table->stresses * sizeof *table->stress);
    memcpy(table->part[k], result->part[k], (size_t)table->rows * sizeof *table->part[k]);
  }
  for (size_t i = 0; i < n * n; i++)
    table->bulk[i] = result->full[i] - result->half[i]; /* theory (B2) */
}

/* Everything but the parts, from values at nodes to coefficients. */
static enum eo_code make_coefficients(struct eo_flank_table *table)
{
  size_t n = (size_t)table->flank.points, next = (size_t)table->next.points;
  EO_TRY(to_coefficients_twice(&table->flank, table->bulk));
  EO_TRY(to_coefficients(&table->flank, table->stresses, table->stress));
  for (size_t d = 0; d < (size_t)table->reach; d++) {
    EO_TRY(to_coefficients_twice(&table->flank, table->ahead + d * n * n));
    for (int k = 0; k < 2; k++)
      EO_TRY(to_coefficients(&table->next, table->stresses, table->next_stress[k] + d * next * table->stresses));
  }
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < i; j++)
      table->bulk[i * n + j] = table->bulk[j * n + i] = 0.5 * (table->bulk[i * n + j] + table->bulk[j * n + i]);
  return EO_OK;
}

enum eo_code eo_flank_table_fill(struct eo_flank_table *table, const struct eo_member_result *result, double width,
                                 double *smallest, struct eo_error *error)
{
  copy_values(table, result);
  EO_TRY(eo_flank_table_connect(table, width, error));
  if (fill_ahead(table, result))
    return eo_error_memory(error);
  EO_TRY(measure(table, smallest, error));
  return make_coefficients(table) ? eo_error_memory(error) : EO_OK;
}
