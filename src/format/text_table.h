/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows and columns for people (aligned text) and for spreadsheets (CSV, RFC 4180). */
#ifndef EASEOFF_FORMAT_TEXT_TABLE_H
#define EASEOFF_FORMAT_TEXT_TABLE_H

#include <stdbool.h>

#include "format/text.h"
#include "format/unit.h"

struct eo_text_table {
  int columns;
  int cells; /* filled so far, headings included */
  int capacity;
  struct eo_cell {
    char *text;
    bool number;
  } * cell;    /* owned, row-major */
  bool failed; /* an allocation failed; the writers then mark their text as failed */
};

/* headings: [columns], copied. */
void eo_text_table_init(struct eo_text_table *sheet, int columns, const char *const *headings);
void eo_text_table_done(struct eo_text_table *sheet);

/* Cells are added from left to right, row by row. */
void eo_text_table_string(struct eo_text_table *sheet, const char *string);
/* In the document's unit; digits 0: the shortest that reads back equal; not finite: an empty cell. */
void eo_text_table_number(struct eo_text_table *sheet, double value, const struct eo_unit *unit, int digits);

/* Numbers to the right, the rest to the left, two blanks between columns, each line indented. */
void eo_text_table_print(const struct eo_text_table *sheet, int indent, struct eo_text *text);
void eo_text_table_csv(const struct eo_text_table *sheet, struct eo_text *text);

#endif
