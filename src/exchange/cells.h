/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A table of texts: CSV with semicolons, tabs or commas, or the sheet of a workbook. */
#ifndef EASEOFF_EXCHANGE_CELLS_H
#define EASEOFF_EXCHANGE_CELLS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/error.h"

enum { EO_CELLS_ROWS = 20000, EO_CELLS_COLUMNS = 2000, EO_CELLS = 400000 };

struct eo_cells {
  int rows, columns; /* of the longest row */
  char separator;    /* ';', tab or ',' */
  char *text;        /* all cells, each ended by 0; owned */
  const char **cell; /* [rows][columns], "" where a row is shorter; owned */
};

/* Separator: of ; tab , the one that the first line has most of. Quotes as in RFC 4180; blanks around a cell go.
   Errors: EO_ERROR_INPUT (with the line), EO_ERROR_MEMORY. */
enum eo_code eo_cells_read(struct eo_cells *cells, const char *bytes, size_t size, struct eo_error *error);
/* What a zip archive is. */
enum eo_cells_kind { EO_CELLS_NONE, EO_CELLS_WORKBOOK, EO_CELLS_OPENDOCUMENT };
enum eo_cells_kind eo_cells_kind_of(const char *bytes, size_t size);

/* The largest sheet of a workbook (.xlsx), or of an OpenDocument spreadsheet (.ods). */
enum eo_code eo_cells_read_workbook(struct eo_cells *cells, const char *bytes, size_t size, struct eo_error *error);
void eo_cells_done(struct eo_cells *cells);

const char *eo_cells_at(const struct eo_cells *cells, int row, int column); /* "" beyond the table */

#endif
