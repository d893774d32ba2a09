/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "flexibility/stress.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "numerics/dense.h"

/* Difference quotients with respect to the node number: first layer, inside, last layer. */
static const struct {
  int step[3];
  double weight[3];
} difference[3] = {{{0, 1, 2}, {-1.5, 2, -0.5}}, {{-1, 0, 1}, {-0.5, 0, 0.5}}, {{-2, -1, 0}, {0.5, -2, 1.5}}};

/* Turn by the helix over some layers: to the frame of layer l from the frame of layer l + step. */
static void turned(const struct eo_sector *sector, int step, const double v[3], double out[3])
{
  double angle = step * sector->twist * sector->width / sector->layers, c = cos(angle), s = sin(angle);
  out[0] = c * v[0] - s * v[1];
  out[1] = s * v[0] + c * v[1];
  out[2] = v[2];
}

/* Position of root node i, `step` layers away, in the frame of the layer. */
static void root_position(const struct eo_sector *sector, int i, int step, double out[3])
{
  const double *point = sector->section->point + 2 * sector->section->root[i];
  double flat[3] = {point[0], point[1], step * sector->width / sector->layers};
  turned(sector, step, flat, out);
}

/* The surface's two tangents per node number. */
static void tangents(const struct eo_sector *sector, int i, int kind, double along[3], double sweep[3])
{
  double p[3];
  memset(along, 0, 3 * sizeof *along);
  memset(sweep, 0, 3 * sizeof *sweep);
  for (int k = 0; k < 3; k++) {
    root_position(sector, i + difference[1].step[k], 0, p);
    for (int c = 0; c < 3; c++)
      along[c] += difference[1].weight[k] * p[c];
    root_position(sector, i, difference[kind].step[k], p);
    for (int c = 0; c < 3; c++)
      sweep[c] += difference[kind].weight[k] * p[c];
  }
}

/* Stress from the three covariant strains (along-along, sweep-sweep, along-sweep), in the frame e1 = along, e2 across.
 */
static void stress_of_strains(const double along[3], const double sweep[3], const struct eo_material *material,
                              double matrix[EO_STRESSES][3])
{
  double l = sqrt(eo_dot(3, along, along)), p = eo_dot(3, along, sweep) / l, q = sqrt(eo_dot(3, sweep, sweep) - p * p);
  double strain[3][3] = {{1 / (l * l), 0, 0},
                         {p * p / (l * l * q * q), 1 / (q * q), -2 * p / (l * q * q)},
                         {-p / (l * l * q), 0, 1 / (l * q)}};
  double nu = material->poissons_ratio, e = material->youngs_modulus / (1 - nu * nu);
  for (int k = 0; k < 3; k++) {
    matrix[0][k] = e * (strain[0][k] + nu * strain[1][k]); /* theory (B10) */
    matrix[1][k] = e * (strain[1][k] + nu * strain[0][k]);
    matrix[2][k] = e * (1 - nu) * strain[2][k];
  }
}

/* Adds a node whose displacement enters the derivatives along and across with the given weights. */
static void add_node(struct eo_stress_stencil *stencil, const struct eo_sector *sector, int root_step, int layer_step,
                     const double weight[2], const double tangent[2][3], const double law[EO_STRESSES][3])
{
  if (weight[0] == 0 && weight[1] == 0)
    return;
  int n = stencil->count++;
  stencil->step[n][0] = root_step;
  stencil->step[n][1] = layer_step;
  for (int c = 0; c < 3; c++) {
    double unit[3] = {c == 0, c == 1, c == 2}, moved[3];
    turned(sector, layer_step, unit, moved);
    double on_along = eo_dot(3, tangent[0], moved), on_sweep = eo_dot(3, tangent[1], moved);
    double strain[3] = {weight[0] * on_along, weight[1] * on_sweep,
                        0.5 * (weight[1] * on_along + weight[0] * on_sweep)};
    for (int r = 0; r < EO_STRESSES; r++)
      stencil->matrix[n][r][c] = eo_dot(3, law[r], strain);
  }
}

static void fill_stencil(struct eo_stress_stencil *stencil, const struct eo_sector *sector,
                         const struct eo_material *material, int i, int kind)
{
  double tangent[2][3], law[EO_STRESSES][3];
  tangents(sector, i, kind, tangent[0], tangent[1]);
  stress_of_strains(tangent[0], tangent[1], material, law);
  stencil->count = 0;
  for (int k = 0; k < 3; k++) {
    add_node(stencil, sector, difference[1].step[k], 0, (double[]){difference[1].weight[k], 0},
             (const double(*)[3])tangent, (const double(*)[3])law);
    add_node(stencil, sector, 0, difference[kind].step[k], (double[]){0, difference[kind].weight[k]},
             (const double(*)[3])tangent, (const double(*)[3])law);
  }
}

enum eo_code eo_stress_operator_init(struct eo_stress_operator *operator, const struct eo_sector * sector,
                                     const struct eo_material *material, struct eo_error *error)
{
  *operator=(struct eo_stress_operator){.points = sector->section->root_nodes - 2, .layers = sector->layers};
  operator->stencil = malloc((size_t) operator->points * sizeof * operator->stencil);
  if (!operator->stencil)
    return eo_error_memory(error);
  for (int i = 0; i < operator->points; i++)
    for (int kind = 0; kind < 3; kind++)
      fill_stencil(&operator->stencil[i][kind], sector, material, i + 1, kind);
  return EO_OK;
}

void eo_stress_operator_done(struct eo_stress_operator *operator)
{
  if (!operator)
    return;
  free(operator->stencil);
  operator->stencil = NULL;
}

void eo_stress_operator_apply(const struct eo_stress_operator *operator, const double * displacement, double *stress)
{
  int across = operator->layers + 1;
  for (int i = 0; i < operator->points; i++)
    for (int l = 0; l < across; l++, stress += EO_STRESSES) {
      const struct eo_stress_stencil *stencil = &operator->stencil[i][l == 0 ? 0 : l == across - 1 ? 2 : 1];
      stress[0] = stress[1] = stress[2] = 0;
      for (int k = 0; k < stencil->count; k++) {
        const double *u = displacement + 3 * ((i + 1 + stencil->step[k][0]) * across + l + stencil->step[k][1]);
        for (int r = 0; r < EO_STRESSES; r++)
          stress[r] += eo_dot(3, stencil->matrix[k][r], u);
      }
    }
}
