/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/study_rows.h"

#include <stdlib.h>

static enum eo_code reserve(struct eo_rows *rows, struct eo_error *error)
{
  if (rows->count < rows->capacity)
    return EO_OK;
  int capacity = 2 * rows->capacity + 64;
  struct eo_row_data **more = realloc(rows->row, sizeof(struct eo_row_data *) * (size_t)capacity);
  if (!more)
    return eo_error_memory(error);
  rows->row = more;
  rows->capacity = capacity;
  return EO_OK;
}

enum eo_code eo_rows_add(struct eo_rows *rows, const struct eo_modification *modification, int ends,
                         struct eo_row_data **result, struct eo_error *error)
{
  enum eo_code code = reserve(rows, error);
  struct eo_row_data *row = code ? NULL : calloc(1, sizeof *row);
  if (!row)
    return code ? code : eo_error_memory(error);
  rows->row[rows->count++] = row;
  row->point.modification = *modification;
  row->point.raw = calloc((size_t)rows->values, sizeof *row->point.raw);
  code = row->point.raw ? eo_modification_write(modification, ends, &row->text, error) : eo_error_memory(error);
  if (code)
    eo_rows_drop(rows, rows->count - 1);
  else
    *result = row;
  return code;
}

void eo_rows_drop(struct eo_rows *rows, int first)
{
  for (; rows->count > first; rows->count--) {
    struct eo_row_data *row = rows->row[rows->count - 1];
    free(row->point.raw);
    eo_text_done(&row->text);
    free(row);
  }
}

void eo_rows_done(struct eo_rows *rows)
{
  eo_rows_drop(rows, 0);
  free(rows->row);
  *rows = (struct eo_rows){0};
}
