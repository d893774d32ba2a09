/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The values of a tree's channels, for readers that come past them once (MATLAB, Octave). Internal to the readers. */
#ifndef EASEOFF_RECORDING_TREE_COLUMNS_H
#define EASEOFF_RECORDING_TREE_COLUMNS_H

#include "recording/tree.h"

struct eo_tree_columns {
  struct eo_tree *tree; /* owned */
  const char *spool_directory;
  struct eo_recording *column[EO_TREE_CHANNELS]; /* owned; by number of the series */
};

/* Makes room for the values of so many channels. Errors: EO_ERROR_MEMORY. */
enum eo_code eo_tree_columns_add(struct eo_tree_columns *columns, int first, int count, struct eo_error *error);
void eo_tree_columns_done(struct eo_tree_columns *columns); /* the tree as well */

/* Settles the tree, says how many variables were left out, and copies all channels to the sink. bytes: of the file. */
enum eo_code eo_tree_columns_copy(struct eo_tree_columns *columns, int left_out, int64_t bytes,
                                  const struct eo_reader_options *options, const struct eo_series_sink *sink,
                                  struct eo_notes *notes, struct eo_error *error);

#endif
