/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "format/outline_row.h"

/* Counts *index down to the row; NULL: it stands behind these. */
static const struct eo_outline_row *walk(const struct eo_outline *outline, int *index)
{
  for (int i = 0; i < outline->count; i++) {
    const struct eo_outline_row *row = &outline->row[i], *found = row->key ? NULL : walk(row->outline, index);
    if (found)
      return found;
    if (row->key && (*index)-- == 0)
      return row;
  }
  return NULL;
}

const struct eo_outline_row *eo_outline_at(const struct eo_outline *outline, int index)
{
  return walk(outline, &index);
}
