/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Arrays with one entry per row of a history, which grow together. */
#ifndef EASEOFF_OPTIMIZER_ROWS_H
#define EASEOFF_OPTIMIZER_ROWS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>

/* The array with room for count entries of size bytes, or as it was and *failed set. */
static inline void *eo_rows_grow(void *array, size_t count, size_t size, bool *failed)
{
  void *larger = realloc(array, count * size + 1);
  if (larger)
    return larger;
  *failed = true;
  return array;
}

#endif
