/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Several tables in one text: rows that say which channel they are of, and tables one below the other. Internal to the
   text reader. */
#ifndef EASEOFF_RECORDING_TEXT_TABLES_H
#define EASEOFF_RECORDING_TEXT_TABLES_H

#include "recording/tables.h"
#include "recording/text_cell.h"
#include "recording/text_format.h"

/* Rows with the name or number of their channel in a cell. */
struct eo_text_channels {
  int cell, unit, edge; /* places of the name, of a unit beside it and of the kind of edge; -1: there is none */
  int64_t other_edges;  /* rows left out */
};

/* Finds them by the heading, or by names that tell encoders apart; such a cell then is none of the columns. head:
   beginning of the text, rows of the format in it. */
struct eo_text_channels eo_text_find_channels(struct eo_text_format *format, const char *head, size_t size);

/* The table of the channel in this cell, a new one with the format's columns where it is the first of its kind. Errors:
   EO_ERROR_INPUT: too many channels; EO_ERROR_MEMORY. */
enum eo_code eo_text_channel_table(struct eo_tables *tables, const struct eo_text_format *format,
                                   const struct eo_cell *channel, const struct eo_cell *unit,
                                   const char *spool_directory, struct eo_table **table, struct eo_error *error);

/* Where rows are edges, those of the kind of its channel's first one are its pulses. cell: the kind of this row's. */
bool eo_text_takes_edge(struct eo_text_channels *channels, struct eo_table *table, const struct eo_cell *cell);

/* What the heading calls the table; "" when it says nothing. A single column that has a fact of the heading for its
   name then has none. head: beginning of the heading. */
void eo_text_table_label(struct eo_text_format *format, const char *head, char label[EO_RECORDING_NAME]);

/* A line that is no row and may begin the heading of another table: a remark, or words without numbers. */
bool eo_text_may_begin_table(const struct eo_text_format *format, const char *line, const char *end);

/* Whether a heading between rows begins a table of other channels, by its names or its label. */
bool eo_text_is_other_table(const struct eo_text_format *now, const char *label, const struct eo_text_format *next,
                            const char *next_label);

/* A rate that the heading of one table states for all its columns holds for the one below it, too, which states none.
 */
void eo_text_inherit_rate(const struct eo_text_format *now, struct eo_text_format *next);

/* Names and units of the format's columns. */
void eo_text_name_columns(const struct eo_text_format *format, struct eo_recording *recording);
/* What the heading and the moments say of each column's clock and counts. */
void eo_text_state_columns(const struct eo_text_format *format, struct eo_recording *recording);

#endif
