/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "flexibility/flexibility.h"

#include "flexibility/flexibility_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Points whose weights are kept at a time, and the largest grid a table may have (see the settings' ranges). */
enum { BLOCK = 128, MAX_POINTS = 33 * 97 };

/* column[points] = rows of matrix[points][stride] from `from` on, combined by the sixteen weights. */
static void combine(const struct eo_grid *grid, const struct eo_grid_weights *at, const double *matrix, size_t stride,
                    size_t points, double *column)
{
  memset(column, 0, points * sizeof *column);
  for (int r = 0; r < EO_SPLINE_WIDTH; r++) {
    const double *a = matrix + (size_t)(at->first + r * grid->eta.count) * stride;
    const double *b = a + stride, *c = b + stride, *d = c + stride, *w = at->weight + EO_SPLINE_WIDTH * r;
    for (size_t i = 0; i < points; i++)
      column[i] += w[0] * a[i] + w[1] * b[i] + w[2] * c[i] + w[3] * d[i];
  }
}

static double contract(const struct eo_grid *grid, const struct eo_grid_weights *at, const double *column)
{
  double sum = 0;
  for (int r = 0; r < EO_SPLINE_WIDTH; r++) {
    const double *c = column + at->first + r * grid->eta.count, *w = at->weight + EO_SPLINE_WIDTH * r;
    sum += w[0] * c[0] + w[1] * c[1] + w[2] * c[2] + w[3] * c[3];
  }
  return sum;
}

/* Coupled pairs ahead. */
static int reach_of(const struct eo_flexibility *flexibility, int member)
{
  return flexibility->settings.neighbour_coupling ? flexibility->table[member].reach : 0;
}

/* Adds one member's compliance between loads j and points from..to-1, whose weights are given, that stand ahead_by
   pairs ahead of them. */
static void add_block(const struct eo_flexibility *flexibility, int member, int ahead_by, int n,
                      const struct eo_flank_point *point, int from, int to, const struct eo_grid_weights *weights,
                      double *compliance)
{
  const struct eo_flank_table *table = &flexibility->table[member];
  const struct eo_grid *grid = &table->flank;
  const double *matrix = ahead_by ? eo_flank_table_ahead(table, ahead_by) : table->bulk;
  size_t points = (size_t)grid->points;
  for (int j = 0; j < n; j++) {
    double column[MAX_POINTS];
    int have_column = 0;
    struct eo_grid_weights at;
    for (int i = from; i < to; i++) {
      if (point[i].pair - point[j].pair != ahead_by || (!ahead_by && i > j))
        continue;
      if (!have_column++) {
        eo_grid_weights(grid, point[j].s[member], point[j].eta, &at);
        combine(grid, &at, matrix, points, points, column);
      }
      double value = contract(grid, &weights[i - from], column);
      compliance[(size_t)i * (size_t)n + (size_t)j] += value;
      if (i != j)
        compliance[(size_t)j * (size_t)n + (size_t)i] += value;
    }
  }
}

void eo_flexibility_add_compliance(const struct eo_flexibility *flexibility, int member, int n,
                                   const struct eo_flank_point *point, double *compliance)
{
  for (int from = 0; from < n; from += BLOCK) {
    struct eo_grid_weights weights[BLOCK];
    int to = from + BLOCK < n ? from + BLOCK : n;
    for (int i = from; i < to; i++)
      eo_grid_weights(&flexibility->table[member].flank, point[i].s[member], point[i].eta, &weights[i - from]);
    for (int ahead_by = 0; ahead_by <= reach_of(flexibility, member); ahead_by++)
      add_block(flexibility, member, ahead_by, n, point, from, to, weights, compliance);
  }
}

static void evaluate(const void *context, int n, const struct eo_flank_point *point, double *compliance)
{
  memset(compliance, 0, (size_t)n * (size_t)n * sizeof *compliance);
  eo_flexibility_add_compliance(context, EO_PINION, n, point, compliance);
  eo_flexibility_add_compliance(context, EO_GEAR, n, point, compliance);
}

struct eo_kernel eo_flexibility_kernel(const struct eo_flexibility *flexibility)
{
  return (struct eo_kernel){.evaluate = evaluate, .context = flexibility};
}

/* Whether the profile at point i leans at least 30 degrees from the tooth's centre line. */
static bool is_critical(const double *position, int i)
{
  const double *before = position + 2 * (i - 1), *after = position + 2 * (i + 1);
  return fabs(after[0] - before[0]) >= tan(M_PI / 6) * fabs(after[1] - before[1]);
}

struct eo_root eo_flexibility_root(const struct eo_flexibility *flexibility, int member)
{
  const struct eo_flank_table *table = &flexibility->table[member];
  struct eo_root root = {.points = table->root_points,
                         .layers = table->layers,
                         .arc = table->arc,
                         .position = table->root,
                         .width = flexibility->width[member],
                         .twist = flexibility->twist[member],
                         .first = 2};
  while (root.first < root.points - 2 && !is_critical(root.position, root.first))
    root.first++;
  return root;
}

/* The table of stresses for loads on a pair, relative to the pair whose root is asked; NULL when they do not count. */
static const double *stress_table(const struct eo_flexibility *flexibility, int member, int ahead_by,
                                  const struct eo_grid **grid)
{
  return abs(ahead_by) > reach_of(flexibility, member)
             ? NULL
             : eo_flank_table_stress(&flexibility->table[member], ahead_by, grid);
}

void eo_flexibility_root_stress(const struct eo_flexibility *flexibility, int member, int pair, int n,
                                const struct eo_flank_point *point, const double *force, int from, int to,
                                double *stress)
{
  const struct eo_flank_table *table = &flexibility->table[member];
  size_t line = ((size_t)table->layers + 1) * EO_STRESSES, length = (size_t)(to - from) * line;
  memset(stress, 0, length * sizeof *stress);
  int reach = reach_of(flexibility, member);
  for (int ahead_by = -reach; ahead_by <= reach; ahead_by++) {
    double load[MAX_POINTS];
    const struct eo_grid *grid;
    const double *row = stress_table(flexibility, member, ahead_by, &grid);
    if (!row)
      continue;
    memset(load, 0, (size_t)grid->points * sizeof *load);
    for (int j = 0; j < n; j++) {
      struct eo_grid_weights at;
      if (point[j].pair - pair != ahead_by)
        continue;
      eo_grid_weights(grid, point[j].s[member], point[j].eta, &at);
      for (int k = 0; k < 16; k++)
        load[at.first + k / 4 * grid->eta.count + k % 4] += force[j] * at.weight[k];
    }
    row += (size_t)from * line;
    for (int p = 0; p < grid->points; p++, row += table->stresses)
      for (size_t i = 0; i < length && load[p] != 0; i++)
        stress[i] += load[p] * row[i];
  }
}

double eo_stress_principal(const double stress[EO_STRESSES])
{
  return 0.5 * (stress[0] + stress[1]) + hypot(0.5 * (stress[0] - stress[1]), stress[2]);
}

/* Straight between the rows. */
void eo_flexibility_parts(const struct eo_flexibility *flexibility, int member, double s, double part[2])
{
  const struct eo_flank_table *table = &flexibility->table[member];
  int row = 0;
  while (row < table->rows - 2 && table->s[row + 1] < s)
    row++;
  double way = (s - table->s[row]) / (table->s[row + 1] - table->s[row]);
  for (int k = 0; k < 2; k++)
    part[k] = (1 - way) * table->part[k][row] + way * table->part[k][row + 1];
}

double eo_flexibility_hub_windup(const struct eo_geometry *geometry, const struct eo_material *material, int member,
                                 double bore_radius)
{
  struct eo_material own = eo_material_of(material, member);
  double shear = own.youngs_modulus / (2 * (1 + own.poissons_ratio));
  double arm = geometry->base_radius[member] * cos(geometry->base_helix_angle), root = geometry->root_radius[member];
  if (!(bore_radius > 0))
    return 0;
  /* theory (B9) */
  return fmax(0, arm * arm / (4 * M_PI * shear) * (1 / (bore_radius * bore_radius) - 4 / (3 * root * root)));
}

const struct eo_flexibility_report *eo_flexibility_report(const struct eo_flexibility *flexibility)
{
  return &flexibility->report;
}

void eo_flexibility_free(struct eo_flexibility *flexibility)
{
  if (!flexibility)
    return;
  eo_flank_table_done(&flexibility->table[0]);
  eo_flank_table_done(&flexibility->table[1]);
  free(flexibility);
}
