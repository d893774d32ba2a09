/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "flexibility/sector.h"

#include "flexibility/element.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/sort.h"

/* 3 x 3 blocks between neighbouring section nodes. */
enum {
  LOWER,
  UPPER,
  ACROSS,
  KINDS
}; /* within the lower face, within the upper face, from lower (column) to upper (row) */
struct blocks {
  int *start;                /* [free nodes + 1] */
  int *row;                  /* [start[free nodes]]: ascending, every neighbour and the node itself */
  double (*value)[KINDS][9]; /* [start[free nodes]], row-major: [row direction][column direction] */
};

double eo_sector_twist(const struct eo_geometry *geometry, int member)
{
  double twist = tan(geometry->helix_angle) / geometry->reference_radius[member];
  return member == EO_PINION ? -twist : twist;
}

static void turn(double angle, double v[3])
{
  double c = cos(angle), s = sin(angle), x = v[0];
  v[0] = c * x - s * v[1];
  v[1] = s * x + c * v[1];
}

static double layer_eta(const struct eo_sector *sector, int layer)
{
  return sector->width * ((double)layer / sector->layers - 0.5);
}

void eo_sector_position(const struct eo_sector *sector, int node, int layer, double position[3])
{
  double eta = layer_eta(sector, layer);
  position[0] = sector->section->point[2 * node];
  position[1] = sector->section->point[2 * node + 1];
  position[2] = eta;
  turn(sector->twist * eta, position);
}

void eo_sector_direction(const struct eo_sector *sector, int node, int layer, int direction, double vector[3])
{
  memcpy(vector, sector->frame[node][direction], 3 * sizeof *vector);
  turn(sector->twist * layer_eta(sector, layer), vector);
}

/* Normal of the swept flank from its transverse normal: perpendicular to the sweep direction twist (-y, x) + axis. */
static void set_flank_frame(struct eo_sector *sector, const struct eo_flank_nodes *flank)
{
  for (int k = 0; k < flank->count; k++) {
    const double *point = sector->section->point + 2 * flank->node[k], *n = flank->normal + 2 * k;
    double axial = -sector->twist * (n[1] * point[0] - n[0] * point[1]), size = sqrt(1 + axial * axial);
    double(*frame)[3] = sector->frame[flank->node[k]];
    double into[3] = {-n[0] / size, -n[1] / size, -axial / size}, along[3] = {-n[1], n[0], 0};
    memcpy(frame[0], into, sizeof into);
    memcpy(frame[1], along, sizeof along);
    for (int i = 0; i < 3; i++)
      frame[2][i] = into[(i + 1) % 3] * along[(i + 2) % 3] - into[(i + 2) % 3] * along[(i + 1) % 3];
  }
}

static void set_frames(struct eo_sector *sector)
{
  for (int a = 0; a < sector->section->nodes; a++)
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        sector->frame[a][i][j] = i == j;
  set_flank_frame(sector, &sector->section->flank);
  set_flank_frame(sector, &sector->section->next_flank[0]);
  set_flank_frame(sector, &sector->section->next_flank[1]);
}

static int belongs(const struct eo_section *section, enum eo_sector_extent extent, int quad)
{
  return extent == EO_WHOLE_SECTOR || section->half[quad];
}

static void number_nodes(struct eo_sector *sector, enum eo_sector_extent extent)
{
  const struct eo_section *section = sector->section;
  for (int a = 0; a < section->nodes; a++)
    sector->free[a] = -1;
  for (int q = 0; q < section->quads; q++)
    for (int k = 0; k < 4 && belongs(section, extent, q); k++)
      sector->free[section->quad[4 * q + k]] = 0;
  for (int q = 0; q < section->quads; q++)
    for (int k = 0; k < 4 && !belongs(section, extent, q); k++)
      sector->free[section->quad[4 * q + k]] = -1;
  for (int a = 0; a < section->nodes; a++) {
    if (section->fixed[a] == EO_HELD_ALL || (extent == EO_HALF_TOOTH && section->centre[a]))
      sector->free[a] = -1;
    if (sector->free[a] == 0)
      sector->free[a] = sector->free_nodes++;
  }
}

/* Numbers the unknowns of one layer: those directions of the free nodes that are not held. */
static enum eo_code number_unknowns(struct eo_sector *sector)
{
  const struct eo_section *section = sector->section;
  sector->place = malloc((size_t)(3 * sector->free_nodes + 1) * sizeof *sector->place);
  if (!sector->place)
    return EO_ERROR_MEMORY;
  for (int a = 0; a < section->nodes; a++)
    for (int c = 0; c < 3 && sector->free[a] >= 0; c++)
      sector->place[3 * sector->free[a] + c] = section->fixed[a] & EO_HELD_X << c ? -1 : sector->layer_unknowns++;
  return EO_OK;
}

/* Lists the neighbours of every free node, through the quadrilaterals that belong. */
static enum eo_code find_neighbours(const struct eo_sector *sector, enum eo_sector_extent extent, struct blocks *blocks)
{
  const struct eo_section *section = sector->section;
  int free_nodes = sector->free_nodes, *list = malloc((size_t)(16 * section->quads + 1) * sizeof *list);
  int *start = calloc((size_t)free_nodes + 2, sizeof *start);
  blocks->start = start;
  blocks->row = list;
  if (!start || !list)
    return EO_ERROR_MEMORY;
  for (int q = 0; q < section->quads; q++)
    for (int k = 0; k < 4 && belongs(section, extent, q); k++)
      if (sector->free[section->quad[4 * q + k]] >= 0)
        start[sector->free[section->quad[4 * q + k]] + 2] += 4;
  for (int f = 0; f < free_nodes; f++)
    start[f + 2] += start[f + 1];
  for (int q = 0; q < section->quads; q++)
    for (int k = 0; k < 4 && belongs(section, extent, q); k++) {
      int f = sector->free[section->quad[4 * q + k]];
      for (int m = 0; m < 4 && f >= 0; m++)
        list[start[f + 1]++] = sector->free[section->quad[4 * q + m]];
    }
  int filled = 0;
  for (int f = 0, from = 0; f < free_nodes; f++) {
    int end = start[f + 1], last = -1;
    eo_sort_integers(end - from, list + from);
    start[f] = filled;
    for (int p = from; p < end; p++)
      if (list[p] > last)
        list[filled++] = last = list[p];
    from = end;
  }
  start[free_nodes] = filled;
  blocks->value = calloc((size_t)filled + 1, sizeof *blocks->value);
  return blocks->value ? EO_OK : EO_ERROR_MEMORY;
}

/* Frames of a brick's nodes as seen from its lower layer. */
static void brick_frame(const struct eo_sector *sector, int node, double angle, double frame[3][3])
{
  memcpy(frame, sector->frame[node], 9 * sizeof(double));
  for (int i = 0; i < 3; i++)
    turn(angle, frame[i]);
}

/* Stiffness of the brick over a quadrilateral in the frames of its nodes; -1 when it is turned inside out. */
static int brick_stiffness(const struct eo_sector *sector, const int *quad, const struct eo_material *material,
                           double rotated[EO_BRICK_NODES][EO_BRICK_NODES][9])
{
  double height = sector->width / sector->layers, angle = sector->twist * height;
  double node[EO_BRICK_NODES][3], frame[EO_BRICK_NODES][3][3], k[EO_BRICK_UNKNOWNS][EO_BRICK_UNKNOWNS];
  for (int a = 0; a < EO_BRICK_NODES; a++) {
    int upper = a / 4, section_node = quad[a % 4];
    node[a][0] = sector->section->point[2 * section_node];
    node[a][1] = sector->section->point[2 * section_node + 1];
    node[a][2] = upper * height;
    turn(upper * angle, node[a]);
    brick_frame(sector, section_node, upper * angle, frame[a]);
  }
  if (eo_brick_stiffness((const double(*)[3])node, material, k))
    return -1;
  for (int a = 0; a < EO_BRICK_NODES; a++)
    for (int b = 0; b < EO_BRICK_NODES; b++)
      for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
          double sum = 0;
          for (int c = 0; c < 3; c++)
            for (int d = 0; d < 3; d++)
              sum += frame[a][i][c] * k[3 * a + c][3 * b + d] * frame[b][j][d];
          rotated[a][b][3 * i + j] = sum;
        }
  return 0;
}

static int find_block(const struct blocks *blocks, int column, int row)
{
  int low = blocks->start[column], high = blocks->start[column + 1] - 1;
  while (low < high) {
    int middle = (low + high) / 2;
    if (blocks->row[middle] < row)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

static void add_brick(const struct eo_sector *sector, const int *quad, double k[EO_BRICK_NODES][EO_BRICK_NODES][9],
                      const struct blocks *blocks)
{
  for (int b = 0; b < 4; b++)
    for (int a = 0; a < 4; a++) {
      int column = sector->free[quad[b]], row = sector->free[quad[a]];
      if (column < 0 || row < 0)
        continue;
      double(*value)[9] = blocks->value[find_block(blocks, column, row)];
      for (int e = 0; e < 9; e++) {
        value[LOWER][e] += k[a][b][e];
        value[UPPER][e] += k[a + 4][b + 4][e];
        value[ACROSS][e] += k[a + 4][b][e];
      }
    }
}

/* One column of the lower triangle: the rest of its own layer, then the next layer. */
static int put_column(const struct eo_sector *sector, const struct blocks *blocks, int layer, int node, int direction,
                      int filled)
{
  const struct eo_sparse *sparse = &sector->matrix;
  int base = layer * sector->layer_unknowns, from = blocks->start[node], end = blocks->start[node + 1];
  double below = layer > 0, above = layer < sector->layers;
  for (int p = from; p < end; p++)
    for (int i = blocks->row[p] == node ? direction : 0; i < 3 && blocks->row[p] >= node; i++) {
      int place = sector->place[3 * blocks->row[p] + i];
      if (place < 0)
        continue;
      sparse->row[filled] = base + place;
      sparse->value[filled++] = above * blocks->value[p][LOWER][3 * i + direction] +
                                below * blocks->value[p][UPPER][3 * i + direction];
    }
  for (int p = from; p < end && layer < sector->layers; p++)
    for (int i = 0; i < 3; i++) {
      int place = sector->place[3 * blocks->row[p] + i];
      if (place < 0)
        continue;
      sparse->row[filled] = base + sector->layer_unknowns + place;
      sparse->value[filled++] = blocks->value[p][ACROSS][3 * i + direction];
    }
  return filled;
}

static enum eo_code assemble(struct eo_sector *sector, const struct blocks *blocks)
{
  struct eo_sparse *sparse = &sector->matrix;
  int nodes = sector->free_nodes;
  size_t entries = 9 * 2 * (size_t)blocks->start[nodes] * (size_t)(sector->layers + 1);
  sparse->n = sector->layer_unknowns * (sector->layers + 1);
  sparse->start = malloc(((size_t)sparse->n + 1) * sizeof *sparse->start);
  sparse->row = malloc(entries * sizeof *sparse->row);
  sparse->value = malloc(entries * sizeof *sparse->value);
  sector->group = malloc(((size_t)sparse->n + 1) * sizeof *sector->group);
  sector->groups = nodes * (sector->layers + 1);
  if (!sparse->start || !sparse->row || !sparse->value || !sector->group)
    return EO_ERROR_MEMORY;
  int filled = 0, column = 0;
  for (int layer = 0; layer <= sector->layers; layer++)
    for (int k = 0; k < 3 * nodes; k++) {
      if (sector->place[k] < 0)
        continue;
      sector->group[column] = layer * nodes + k / 3;
      sparse->start[column++] = filled;
      filled = put_column(sector, blocks, layer, k / 3, k % 3, filled);
    }
  sparse->start[sparse->n] = filled;
  return EO_OK;
}

static void free_blocks(struct blocks *blocks)
{
  free(blocks->start);
  free(blocks->row);
  free(blocks->value);
}

static enum eo_code fill(struct eo_sector *sector, const struct eo_material *material, enum eo_sector_extent extent,
                         struct blocks *blocks, struct eo_error *error)
{
  const struct eo_section *section = sector->section;
  sector->frame = malloc((size_t)section->nodes * sizeof *sector->frame);
  sector->free = malloc((size_t)section->nodes * sizeof *sector->free);
  if (!sector->frame || !sector->free)
    return EO_ERROR_MEMORY;
  set_frames(sector);
  number_nodes(sector, extent);
  EO_TRY(number_unknowns(sector));
  EO_TRY(find_neighbours(sector, extent, blocks));
  for (int q = 0; q < section->quads; q++) {
    double k[EO_BRICK_NODES][EO_BRICK_NODES][9];
    if (!belongs(section, extent, q))
      continue;
    if (brick_stiffness(sector, section->quad + 4 * q, material, k))
      return eo_error_set(error, EO_ERROR_NUMERIC, "",
                          "The finite-element mesh folds: the tooth root is too unusual for it.");
    add_brick(sector, section->quad + 4 * q, k, blocks);
  }
  return assemble(sector, blocks);
}

enum eo_code eo_sector_init(struct eo_sector *sector, const struct eo_section *section, int layers, double width,
                            double twist, const struct eo_material *material, enum eo_sector_extent extent,
                            struct eo_error *error)
{
  struct blocks blocks = {0};
  *sector = (struct eo_sector){.section = section, .layers = layers, .width = width, .twist = twist};
  enum eo_code code = fill(sector, material, extent, &blocks, error);
  free_blocks(&blocks);
  if (code)
    eo_sector_done(sector);
  return code == EO_ERROR_MEMORY ? eo_error_memory(error) : code;
}

void eo_sector_done(struct eo_sector *sector)
{
  if (!sector)
    return;
  free(sector->frame);
  free(sector->free);
  free(sector->place);
  free(sector->group);
  eo_sparse_done(&sector->matrix);
  *sector = (struct eo_sector){0};
}
