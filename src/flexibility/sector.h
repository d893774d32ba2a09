/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A section swept along the helix: bricks between layers, each layer the section turned by eta tan(beta)/r. Every layer
   uses its own turned frame; in it all layers are alike, so one layer of elements is computed and put in everywhere. */
#ifndef EASEOFF_FLEXIBILITY_SECTOR_H
#define EASEOFF_FLEXIBILITY_SECTOR_H

#include "flexibility/section.h"
#include "numerics/sparse.h"

/* What is modelled. The half tooth is the material between the centre surface and the loaded flank of the loaded tooth,
   outside the root cylinder; the centre surface and the root cylinder are fixed (Chang, Liu, Wu 2015). Because whatever
   is cut is held, its compliance is never above that of the whole sector, in the sense of quadratic forms. */
enum eo_sector_extent { EO_WHOLE_SECTOR, EO_HALF_TOOTH };

struct eo_sector {
  const struct eo_section *section; /* borrowed */
  int layers;
  double width;          /* of the face, m */
  double twist;          /* turn of the section per length, counterclockwise towards + eta, rad/m */
  double (*frame)[3][3]; /* [section node][direction][component]: (1, 0, 0).. or, on flanks, into the tooth along
                            the normal, along the profile, across both; in the frame of the layer */
  int free_nodes;
  int *free;          /* [section node]: number among the free nodes, -1: fixed or absent */
  int layer_unknowns; /* of one layer */
  int *place;         /* [free_nodes][3]: number among them, -1: held in this direction */
  struct eo_sparse matrix;
  int groups; /* nodes with unknowns */
  int *group; /* [matrix.n]: node of each unknown */
};

/* Adds a spring to the ground to an unknown, N/m. */
static inline void eo_sector_add_spring(struct eo_sector *sector, int unknown, double stiffness)
{
  sector->matrix.value[sector->matrix.start[unknown]] += stiffness;
}

/* eta > 0 is the side that meets first: it leads on the pinion (turned clockwise, towards its loaded flank) and on the
   gear. */
double eo_sector_twist(const struct eo_geometry *geometry, int member);

/* Assembles the stiffness. section is borrowed for the life of the sector.
   Errors: memory; EO_ERROR_NUMERIC when the mesh folds. */
enum eo_code eo_sector_init(struct eo_sector *sector, const struct eo_section *section, int layers, double width,
                            double twist, const struct eo_material *material, enum eo_sector_extent extent,
                            struct eo_error *error);
void eo_sector_done(struct eo_sector *sector);

/* Number of the unknown, -1 when the node is absent or held in this direction. */
static inline int eo_sector_unknown(const struct eo_sector *sector, int node, int layer, int direction)
{
  int free = sector->free[node];
  int place = free < 0 ? -1 : sector->place[3 * free + direction];
  return place < 0 ? -1 : layer * sector->layer_unknowns + place;
}

/* Position of a node, m, in the frame of the middle of the face. */
void eo_sector_position(const struct eo_sector *sector, int node, int layer, double position[3]);

/* Unit vector of a node's unknown in the same frame; direction 0 on a flank points into the tooth. */
void eo_sector_direction(const struct eo_sector *sector, int node, int layer, int direction, double vector[3]);

#endif
