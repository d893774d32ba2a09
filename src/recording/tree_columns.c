/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/tree_columns.h"

#define MEMORY ((size_t)1 << 19) /* bytes of a channel in memory */

enum eo_code eo_tree_columns_add(struct eo_tree_columns *columns, int first, int count, struct eo_error *error)
{
  for (int c = first; c < first + count; c++) {
    EO_TRY(eo_recording_new(&columns->column[c], 1, columns->spool_directory, error));
    if (columns->spool_directory)
      eo_recording_set_memory(columns->column[c], MEMORY);
  }
  return EO_OK;
}

void eo_tree_columns_done(struct eo_tree_columns *columns)
{
  for (int c = 0; c < EO_TREE_CHANNELS; c++)
    eo_recording_free(columns->column[c]);
  eo_tree_free(columns->tree);
}

static enum eo_code read_column(void *context, int series, int64_t first, int64_t count, double *values,
                                struct eo_error *error)
{
  const struct eo_tree_columns *columns = context;
  enum eo_code code = eo_recording_read(columns->column[series], first, count, values, error);
  for (int64_t i = 0; !code && i < count; i++)
    values[i] = eo_tree_value(columns->tree, series, values[i]);
  return code;
}

enum eo_code eo_tree_columns_copy(struct eo_tree_columns *columns, int left_out, int64_t bytes,
                                  const struct eo_reader_options *options, const struct eo_series_sink *sink,
                                  struct eo_notes *notes, struct eo_error *error)
{
  eo_tree_settle(columns->tree, notes);
  if (left_out)
    eo_notes_add(notes, "%d variable%s %s no channel of real numbers and %s left out.", left_out,
                 left_out == 1 ? "" : "s", left_out == 1 ? "is" : "are", left_out == 1 ? "was" : "were");
  struct eo_series_file content = {
      eo_tree_series(columns->tree), eo_tree_count(columns->tree), bytes, options->max_bytes, read_column, columns};
  EO_TRY(eo_tree_check_begins(columns->tree, &content, error));
  return eo_series_copy(&content, sink, notes, error);
}
