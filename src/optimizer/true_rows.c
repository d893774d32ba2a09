/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "optimizer/true_rows.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "optimizer/rows.h"

enum eo_code eo_archive_init(struct eo_archive *archive, int variables, int objectives, struct eo_error *error)
{
  *archive = (struct eo_archive){.variables = variables, .objectives = objectives, .best = -1};
  return eo_archive_reserve(archive, 64, error);
}

void eo_archive_done(struct eo_archive *archive)
{
  free(archive->x);
  free(archive->asked);
  free(archive->value);
  free(archive->violation);
  free(archive->objective);
  free(archive->part);
  free(archive->whole);
  free(archive->generation);
  free(archive->individual);
  free(archive->next);
  free(archive->bucket);
  *archive = (struct eo_archive){.best = -1};
}

void eo_archive_set_parts(struct eo_archive *archive, int parts)
{
  archive->parts = parts;
  archive->capacity = 0; /* the next reservation makes room for them */
}

/* FNV-1a over the bits (Fowler, Noll, Vo). */
static uint64_t hash(const double *x, int n)
{
  uint64_t h = 0xCBF29CE484222325u;
  for (int k = 0; k < n; k++) {
    uint64_t bits;
    memcpy(&bits, &x[k], sizeof bits);
    h = (h ^ bits) * 0x100000001B3u;
    h ^= h >> 29;
  }
  return h;
}

static void chain(struct eo_archive *archive, int row)
{
  const uint64_t h = hash(archive->asked + (size_t)row * archive->variables, archive->variables);
  int *bucket = &archive->bucket[h % (uint64_t)archive->bucket_count];
  archive->next[row] = *bucket;
  *bucket = row;
}

enum eo_code eo_archive_reserve(struct eo_archive *archive, int rows, struct eo_error *error)
{
  if (archive->count + rows <= archive->capacity)
    return EO_OK;
  const int capacity = archive->count + rows > 2 * archive->capacity ? archive->count + rows : 2 * archive->capacity;
  const size_t c = (size_t)capacity;
  bool failed = false;
  archive->x = eo_rows_grow(archive->x, c * (size_t)archive->variables, sizeof(double), &failed);
  archive->asked = eo_rows_grow(archive->asked, c * (size_t)archive->variables, sizeof(double), &failed);
  archive->value = eo_rows_grow(archive->value, c, sizeof(double), &failed);
  archive->violation = eo_rows_grow(archive->violation, c, sizeof(double), &failed);
  archive->objective = eo_rows_grow(archive->objective, c * (size_t)archive->objectives, sizeof(double), &failed);
  archive->part = eo_rows_grow(archive->part, c * (size_t)archive->parts, sizeof(double), &failed);
  archive->whole = eo_rows_grow(archive->whole, c, sizeof(bool), &failed);
  archive->generation = eo_rows_grow(archive->generation, c, sizeof(int), &failed);
  archive->individual = eo_rows_grow(archive->individual, c, sizeof(int), &failed);
  archive->next = eo_rows_grow(archive->next, c, sizeof(int), &failed);
  archive->bucket = eo_rows_grow(archive->bucket, 2 * c, sizeof(int), &failed);
  if (failed)
    return eo_error_memory(error);
  archive->capacity = capacity;
  archive->bucket_count = 2 * capacity;
  for (int i = 0; i < archive->bucket_count; i++)
    archive->bucket[i] = -1;
  for (int row = 0; row < archive->count; row++)
    chain(archive, row);
  return EO_OK;
}

int eo_archive_add(struct eo_archive *archive, const double *x, const double *asked, double value, double violation,
                   const double *objectives, const double *part, int generation, int individual)
{
  const int row = archive->count++, n = archive->variables, m = archive->objectives;
  memcpy(archive->x + (size_t)row * n, x, (size_t)n * sizeof *x);
  memcpy(archive->asked + (size_t)row * n, asked, (size_t)n * sizeof *asked);
  archive->value[row] = isfinite(value) ? value : INFINITY;
  archive->violation[row] = violation;
  for (int k = 0; k < m; k++)
    archive->objective[(size_t)row * m + k] = objectives ? objectives[k] : archive->value[row];
  archive->whole[row] = part != NULL;
  for (int k = 0; k < archive->parts && part; k++) {
    archive->part[(size_t)row * (size_t)archive->parts + (size_t)k] = part[k];
    archive->whole[row] = archive->whole[row] && isfinite(part[k]);
  }
  archive->generation[row] = generation;
  archive->individual[row] = individual;
  chain(archive, row);
  if (isfinite(value) && (archive->best < 0 || value < archive->value[archive->best]))
    archive->best = row;
  return row;
}

int eo_archive_find(const struct eo_archive *archive, const double *asked)
{
  const size_t bytes = (size_t)archive->variables * sizeof *asked;
  int row = archive->bucket[hash(asked, archive->variables) % (uint64_t)archive->bucket_count];
  while (row >= 0 && memcmp(archive->asked + (size_t)row * archive->variables, asked, bytes) != 0)
    row = archive->next[row];
  return row;
}
