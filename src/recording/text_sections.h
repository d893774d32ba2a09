/* SPDX-License-Identifier: GPL-3.0-or-later */
/* LabVIEW measurement files (.lvm) that were written in several sections: each has a heading of its own before its
   rows. Internal to the text reader. */
#ifndef EASEOFF_RECORDING_TEXT_SECTIONS_H
#define EASEOFF_RECORDING_TEXT_SECTIONS_H

#include "recording/moment.h"
#include "recording/text_format.h"

#include <stdbool.h>
#include <stdint.h>

struct eo_text_sections {
  bool used;          /* the file is one of these */
  bool inside, named; /* a heading of a section; its last line, the names, comes next */
  int sections;       /* so far */
  char separator, point;
  struct eo_moment begin[2]; /* of the first section and of the current one */
  double start[2];           /* s, X0 of them */
  double interval;           /* s between rows, 0: not stated */
  int64_t row;               /* first row of the current section */
  bool first;                /* the next row is the first of its section */
  int columns;
  bool x[EO_TEXT_CELLS]; /* [columns] times of the rows */
  double x_last[EO_TEXT_CELLS], x_shift[EO_TEXT_CELLS];
};

/* Reads the headings before the first row and which columns are the times of the rows. head: beginning of the file. */
void eo_text_sections_find(struct eo_text_sections *sections, const struct eo_text_format *format, const char *head);

/* Takes a line that stands before the first row or is no row; true when it belongs to a heading. rows: read so far. */
bool eo_text_sections_take(struct eo_text_sections *sections, const char *line, const char *end, int64_t rows);

/* Rows of a later section: times that start again go on from the beginning that its heading states; without times the
   section must follow the one before, by what both state. row[columns]; line: its number. Errors: EO_ERROR_INPUT. */
enum eo_code eo_text_sections_place(struct eo_text_sections *sections, double *row, int64_t line,
                                    struct eo_error *error);

#endif
