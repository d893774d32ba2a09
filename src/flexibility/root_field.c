/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "flexibility/root_field.h"

#include "flexibility/stress.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* FIRST: shapes that are summed before the sums are looked at; then twice as many, and so on. */
enum { BLOCK = EO_GRAM_COLUMNS, SPAN = EO_STRESSES * BLOCK, FIRST = 24, MOST_LEVELS = 16 };

enum eo_code eo_root_field_init(struct eo_root_field *field, int rank, int nodes, const double *shape,
                                struct eo_error *error)
{
  int blocks = (nodes + BLOCK - 1) / BLOCK, levels = 1;
  while (levels < MOST_LEVELS && FIRST << (levels - 1) < rank)
    levels++;
  *field = (struct eo_root_field){.rank = rank, .blocks = blocks, .columns = blocks * SPAN, .levels = levels};
  field->shape = eo_gram_allocate((long)rank * field->columns / 2 + 1);
  field->rest = eo_gram_allocate((long)field->levels * blocks * BLOCK / 2 + 1);
  if (!field->shape || !field->rest)
    return eo_error_memory(error);
  for (int k = 0; k < rank; k++)
    for (int node = 0; node < nodes; node++)
      for (int part = 0; part < EO_STRESSES; part++)
        eo_root_field_block(field, node / BLOCK)[k * SPAN + part * BLOCK + node % BLOCK] =
            (float)shape[((size_t)k * (size_t)nodes + (size_t)node) * EO_STRESSES + (size_t)part];
  eo_root_field_bound(field);
  return EO_OK;
}

float *eo_root_field_block(const struct eo_root_field *field, int block)
{
  return field->shape + (size_t)block * (size_t)field->rank * SPAN;
}

void eo_root_field_done(struct eo_root_field *field)
{
  free(field->shape);
  free(field->rest);
  *field = (struct eo_root_field){0};
}

/* Shapes that are in a sum once it has reached the level. */
static int shapes_until(const struct eo_root_field *field, int level)
{
  return level == field->levels - 1 ? field->rank : FIRST << level;
}

void eo_root_field_bound(struct eo_root_field *field)
{
  for (int level = 0; level < field->levels; level++)
    for (int node = 0; node < field->blocks * BLOCK; node++) {
      const float *stress = eo_root_field_block(field, node / BLOCK) + node % BLOCK;
      double sum = 0;
      for (int k = shapes_until(field, level); k < field->rank; k++) {
        double s = stress[k * SPAN], t = stress[k * SPAN + BLOCK], u = stress[k * SPAN + 2 * BLOCK];
        sum += s * s + t * t + 2 * u * u; /* what a principal stress can change by is the norm of the tensor's change */
      }
      field->rest[level * field->blocks * BLOCK + node] = (float)sqrt(sum);
    }
}

/* Whether the larger principal stress (s + t + sqrt((s - t)^2 + 4 u^2))/2 passes the largest so far. */
static inline bool passes(float s, float t, float u, float largest)
{
  float sum = s + t, room = 2 * largest - sum, difference = s - t, square = difference * difference + 4 * u * u;
  return !(room >= 0 && square <= room * room);
}

/* The search in one row of stresses. */
struct search {
  const struct eo_root_field *field;
  const struct eo_gram *gram;
  const float *coefficient;
  float left[MOST_LEVELS]; /* norm of the coefficients behind each level */
  float *stress;           /* [columns] */
  float largest;
  int node;
};

/* The factors of theory (B12) that are the row's; eo_root_field_bound() has those of the nodes. */
static void measure_rests(struct search *search)
{
  const struct eo_root_field *field = search->field;
  float sum = 0;
  int k = field->rank;
  for (int level = field->levels - 1; level >= 0; level--) {
    for (; k > shapes_until(field, level); k--)
      sum += search->coefficient[k - 1] * search->coefficient[k - 1];
    search->left[level] = sqrtf(sum);
  }
}

/* The root is taken only where it raises the largest so far. */
static void read_block(struct search *search, int block)
{
  const float *s = search->stress + block * SPAN, *t = s + BLOCK, *u = t + BLOCK;
  for (int i = 0; i < BLOCK; i++) {
    if (!passes(s[i], t[i], u[i], search->largest))
      continue;
    float difference = s[i] - t[i];
    search->largest = (s[i] + t[i] + sqrtf(difference * difference + 4 * u[i] * u[i])) / 2; /* theory (B11) */
    search->node = block * BLOCK + i;
  }
}

static bool can_pass(const struct search *search, int block, int level)
{
  const struct eo_root_field *field = search->field;
  return search->gram->find_passing(block, block + 1, search->stress, search->left[level],
                                    field->rest + level * field->blocks * BLOCK, search->largest) == block;
}

/* Adds shapes to the sums of a block that can pass, until none of its nodes can, or all are told. */
static void finish_block(struct search *search, int block)
{
  const struct eo_root_field *field = search->field;
  int level = 0;
  do {
    if (level == field->levels - 1) {
      read_block(search, block);
      return;
    }
    int first = shapes_until(field, level), last = shapes_until(field, ++level);
    search->gram->multiply(1, last - first, SPAN, search->coefficient + first, last - first,
                           eo_root_field_block(field, block) + first * SPAN, SPAN, true, search->stress + block * SPAN,
                           SPAN);
  } while (can_pass(search, block, level));
}

static void search_row(struct search *search, int start)
{
  const struct eo_root_field *field = search->field;
  finish_block(search, start);
  for (int block = -1; block < field->blocks;) {
    block = search->gram->find_passing(block + 1, field->blocks, search->stress, search->left[0], field->rest,
                                       search->largest);
    if (block != start && block < field->blocks)
      finish_block(search, block);
  }
}

void eo_root_field_find_largest(const struct eo_root_field *field, const struct eo_gram *gram, int rows,
                                const float *coefficient, int stride, float *room, double *largest, int *node)
{
  int first = shapes_until(field, 0), start = 0;
  for (int block = 0; block < field->blocks; block++)
    gram->multiply(rows, first, SPAN, coefficient, stride, eo_root_field_block(field, block), SPAN, false,
                   room + block * SPAN, field->columns);
  for (int j = 0; j < rows; j++) {
    struct search search = {.field = field,
                            .gram = gram,
                            .coefficient = coefficient + (size_t)j * (size_t)stride,
                            .stress = room + (size_t)j * (size_t)field->columns};
    measure_rests(&search);
    search_row(&search, start);
    start = search.node / BLOCK; /* of the next: where the largest is now, it was often before */
    largest[j] = search.largest;
    node[j] = search.node;
  }
}
