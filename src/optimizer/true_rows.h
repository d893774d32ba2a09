/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The true rows of a run, each x once: found again by its bits. */
#ifndef EASEOFF_OPTIMIZER_TRUE_ROWS_H
#define EASEOFF_OPTIMIZER_TRUE_ROWS_H

#include "base/error.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

struct eo_archive {
  int variables, objectives, parts;
  int count, capacity;
  double *x;         /* [count][variables]; owned, as all below */
  double *asked;     /* [count][variables] as the caller knows it (cube_warp.h) */
  double *value;     /* [count], infinite when failed */
  double *violation; /* [count] */
  double *objective; /* [count][objectives] */
  double *part;      /* [count][parts] */
  bool *whole;       /* [count] the parts are there */
  int *generation;   /* [count], -1: imported */
  int *individual;   /* [count] */
  int *next;         /* [count] chain of rows with the same hash */
  int *bucket;       /* [bucket_count] first row of a chain or -1 */
  int bucket_count;
  int best; /* row with the least value, -1 when none is finite */
};

/* Empty. Errors: memory. */
enum eo_code eo_archive_init(struct eo_archive *archive, int variables, int objectives, struct eo_error *error);
void eo_archive_done(struct eo_archive *archive);

/* So many parts in every row; before the first row. */
void eo_archive_set_parts(struct eo_archive *archive, int parts);

/* Makes room for this many further rows, so that eo_archive_add() cannot fail. */
enum eo_code eo_archive_reserve(struct eo_archive *archive, int rows, struct eo_error *error);

/* Adds a row and returns its index. objectives and part may be NULL. A value that is not finite is stored as infinite.
 */
int eo_archive_add(struct eo_archive *archive, const double *x, const double *asked, double value, double violation,
                   const double *objectives, const double *part, int generation, int individual);

/* The row asked for by the same bits, or -1. */
int eo_archive_find(const struct eo_archive *archive, const double *asked);

/* Whether the row has no value. */
static inline bool eo_archive_failed(const struct eo_archive *archive, int row)
{
  return isinf(archive->value[row]);
}

#endif
