/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One cell of a line of delimited text. Internal to the text reader. */
#ifndef EASEOFF_RECORDING_TEXT_CELL_H
#define EASEOFF_RECORDING_TEXT_CELL_H

#include <stdbool.h>
#include <stddef.h>

enum eo_cell_kind {
  EO_CELL_NUMBER,
  EO_CELL_GROUPED, /* a number whose only mark is that of thousands: it may be a decimal point after all */
  EO_CELL_UNIT,    /* a number with its unit behind it: "0.25 ms", or an angle: 12°34'56.7" */
  EO_CELL_MOMENT,  /* a date or a time of day */
  EO_CELL_ARC,     /* degrees, minutes and seconds between colons that no time of day has */
  EO_CELL_HEX,     /* digits that are no decimal number but a hexadecimal one, without a mark */
  EO_CELL_MISSING,
  EO_CELL_TEXT
};

struct eo_cell {
  const char *text; /* without quotes and the blanks around it */
  size_t length;
  bool quoted;
  const char *name; /* of a value that has its name before it (text_named.h); NULL else */
  size_t name_length;
};

static inline bool eo_text_blank(char c)
{
  return c == ' ' || c == '\t' || c == '\r';
}

/* A separator: runs of two blanks or more, or with a tab in them; names between them have blanks of their own. */
#define EO_TEXT_WIDE '\v'

/* Separators: names before the values, see text_named.h; with decimal commas. */
#define EO_TEXT_NAMED '\f'
#define EO_TEXT_NAMED_COMMA '\016'

static inline bool eo_text_is_named(char separator)
{
  return separator == EO_TEXT_NAMED || separator == EO_TEXT_NAMED_COMMA;
}

/* Takes the next cell of the line that ends at end; *at moves behind its separator. False when the line has no more
   cells. A line that ends with a separator has one more, empty cell, unless the separator is a run of blanks. The byte
   at end must belong to no number. */
bool eo_text_next_cell(const char **at, const char *end, char separator, struct eo_cell *cell);

/* What a cell holds: a number ("1.5", "1,018.9", "1 018,9", "0x3F", "0.25 ms"), a moment, nothing or a word for it
   (empty, NaN, n/a, -, *), or text. *value is NaN unless it is a finite number; of a number with a unit it is the
   number. */
enum eo_cell_kind eo_text_cell_value(const struct eo_cell *cell, char point, double *value);

/* Reads a number whose digits stand in groups of three that one mark parts ("1,018.896", "1 018,896", "1'018"): the
   groups behind the first, and its value. Returns the place after it, NULL when it is no such number. */
const char *eo_text_grouped(const char *at, const char *end, char point, int *groups, double *value);

/* A hexadecimal number with or without a mark ("0x3F", "3Fh", "$3F", "3F"); false when the cell is none. */
bool eo_text_cell_hex(const struct eo_cell *cell, double *value);

/* A word for one of the two levels of a square wave: high, true, on; 1 or 0. False when the cell is none. */
bool eo_text_cell_level(const struct eo_cell *cell, double *value);

/* Degrees, minutes and seconds of arc, in degrees: 12°34'56.7", 12d34m56.7s and, where it is known for an angle,
   12:34:56.7; seconds may be missing. False when the cell is none. */
bool eo_text_cell_sexagesimal(const struct eo_cell *cell, char point, bool colons, double *value);

/* What a cell holds, as much of it as there is room for. */
void eo_text_cell_copy(char *to, size_t size, const struct eo_cell *cell);

/* The unit behind a number, as the cell has it; "" when there is none. */
void eo_text_cell_unit(const struct eo_cell *cell, char point, char *unit, int size);

/* Where a comment's own text starts ("# text", "% text", "// text", and "; text" where cells are not separated by
   semicolons); NULL when the line is no comment. */
const char *eo_text_comment(const char *line, const char *end, char separator);

/* True when the line holds nothing but blanks. */
bool eo_text_empty(const char *line, const char *end);

#endif
