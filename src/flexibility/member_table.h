/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is kept of one member: spline coefficients over (path coordinate, eta) of compliance and root stress. */
#ifndef EASEOFF_FLEXIBILITY_MEMBER_TABLE_H
#define EASEOFF_FLEXIBILITY_MEMBER_TABLE_H

#include "flexibility/member.h"
#include "flexibility/spline.h"

/* Tensor spline: coefficient number row * (layers + 1) + layer. */
struct eo_grid {
  struct eo_spline s, eta;
  int points; /* rows * (layers + 1) */
};

/* The sixteen coefficients that count at a point. */
struct eo_grid_weights {
  int first;         /* number of the first; rows follow at distance eta.count */
  double weight[16]; /* [row][layer] */
};

struct eo_flank_table {
  int rows, next_rows, layers, root_points;
  int reach;                  /* D: pairs ahead and behind whose loads are known here */
  struct eo_grid flank, next; /* of the tooth itself, of the loads on others */
  size_t stresses;            /* root_points * (layers + 1) * EO_STRESSES */
  double *data;               /* the arrays below, one block of `size` doubles */
  size_t size;
  double *s;              /* [rows] */
  double *next_s;         /* [next_rows] */
  double *root;           /* [root_points][2] */
  double *arc;            /* [root_points] */
  double *bulk;           /* [flank][flank], symmetric */
  double *ahead;          /* [reach][flank on pair k][flank on pair k + d], d = 1 .. reach */
  double *stress;         /* [flank][stresses] */
  double *next_stress[2]; /* [reach][next][stresses]: loads on pair k - d, k + d */
  double *part[2];        /* [rows]: see struct eo_member_result; values, not coefficients */
};

/* Allocates for the settings; the numbers are still to be filled. */
enum eo_code eo_flank_table_init(struct eo_flank_table *table, const struct eo_member_settings *settings,
                                 struct eo_error *error);
void eo_flank_table_done(struct eo_flank_table *table);

/* Compliance between pair k and pair k + d, d = 1 .. reach. */
static inline const double *eo_flank_table_ahead(const struct eo_flank_table *table, int d)
{
  size_t points = (size_t)table->flank.points;
  return table->ahead + (size_t)(d - 1) * points * points;
}

/* Stress influence of the loads on pair k + ahead_by on the root of pair k, and the grid of its rows; NULL beyond the
   reach. */
static inline const double *eo_flank_table_stress(const struct eo_flank_table *table, int ahead_by,
                                                  const struct eo_grid **grid)
{
  int d = ahead_by < 0 ? -ahead_by : ahead_by;
  *grid = d == 0 ? &table->flank : &table->next;
  if (d == 0)
    return table->stress;
  return d > table->reach
             ? NULL
             : table->next_stress[ahead_by > 0] + (size_t)(d - 1) * (size_t)table->next.points * table->stresses;
}

/* Fills the data from finite-element results. smallest: smallest eigenvalue of the compliance of some teeth side by
   side, over the largest. */
enum eo_code eo_flank_table_fill(struct eo_flank_table *table, const struct eo_member_result *result, double width,
                                 double *smallest, struct eo_error *error);

/* Makes the splines from the data; width: of the face. */
enum eo_code eo_flank_table_connect(struct eo_flank_table *table, double width, struct eo_error *error);

/* Nodes and weights with which a table is read at (s, eta), m. */
static inline void eo_grid_weights(const struct eo_grid *grid, double s, double eta, struct eo_grid_weights *out)
{
  double across[EO_SPLINE_WIDTH], along[EO_SPLINE_WIDTH];
  int row, layer;
  eo_spline_weights(&grid->s, s, &row, across);
  eo_spline_weights(&grid->eta, eta, &layer, along);
  out->first = row * grid->eta.count + layer;
  for (int r = 0; r < EO_SPLINE_WIDTH; r++)
    for (int l = 0; l < EO_SPLINE_WIDTH; l++)
      out->weight[EO_SPLINE_WIDTH * r + l] = across[r] * along[l];
}

#endif
