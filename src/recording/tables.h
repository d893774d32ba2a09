/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Several tables of one run, each with channels of its own (one below the other in a text, one for each word of a
   column of names, one in each file of an archive), become one recording. Internal to the readers. */
#ifndef EASEOFF_RECORDING_TABLES_H
#define EASEOFF_RECORDING_TABLES_H

#include "recording/notes.h"
#include "recording/recording.h"

#include <stdbool.h>

#define EO_TABLES 64

struct eo_tables {
  int count;
  bool files; /* each was a file of its own */
  struct eo_table {
    struct eo_recording *recording; /* owned; may be NULL */
    char label[EO_RECORDING_NAME];  /* what the table is called; "" when nothing says so */
    char edge[EO_RECORDING_UNIT];   /* of its first row, where the rows are edges; "": not said */
    char unit[EO_RECORDING_UNIT];   /* of its last column where that has none; "" : as it is */
  } table[EO_TABLES];
};

void eo_tables_free(struct eo_tables *tables);

/* Moves the tables into one recording: a single one as it is; of several the one that holds both encoders alone, else
   all of them side by side, columns called by their own names and that of their table, each with the times of its own
   table. Numbers in parts are joined first (compound.h). Errors: EO_ERROR_INPUT where several hold both encoders, since
   nobody can know which is meant; too many columns; EO_ERROR_MEMORY, EO_ERROR_FILE. The tables are empty afterwards. */
enum eo_code eo_tables_join(struct eo_tables *tables, const char *spool_directory, struct eo_recording **joined,
                            struct eo_notes *notes, struct eo_error *error);

/* One recording beside the other. time[count]: number of the column in each that holds its times, -1: none. */
enum eo_code eo_tables_beside(const struct eo_recording *const *side, const char *const *label, const int *time,
                              int count, const char *spool_directory, struct eo_recording **joined,
                              struct eo_error *error);

/* The column of times, by name, unit or size; -1: there is none. */
enum eo_code eo_tables_find_time(const struct eo_recording *recording, int *column, struct eo_error *error);

#endif
