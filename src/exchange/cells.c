/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE
#include "exchange/cells.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "recording/zip_files.h"

enum { WORKBOOK_BYTES = 64 << 20 }; /* that a sheet may have as text */

static char find_separator(const char *bytes, size_t size)
{
  static const char choices[] = ";\t,";
  int most = 0;
  char found = ';';
  for (const char *choice = choices; *choice; choice++) {
    int count = 0;
    for (size_t i = 0; i < size && bytes[i] != '\n'; i++)
      count += bytes[i] == *choice;
    if (count > most) {
      most = count;
      found = *choice;
    }
  }
  return found;
}

struct scan {
  const char *at, *end;
  char separator;
  char *out; /* where the next cell goes */
};

/* One cell into the text; true when a separator follows it, false at the end of its row. */
static bool scan_cell(struct scan *scan, const char **cell)
{
  char *start = scan->out;
  bool quoted = false;
  while (scan->at < scan->end && (*scan->at == ' ' || (*scan->at == '\t' && scan->separator != '\t')))
    scan->at++;
  if (scan->at < scan->end && *scan->at == '"') {
    quoted = true;
    scan->at++;
  }
  for (; scan->at < scan->end; scan->at++) {
    if (quoted && *scan->at == '"' && scan->at + 1 < scan->end && scan->at[1] == '"')
      scan->at++;
    else if (quoted && *scan->at == '"') {
      quoted = false;
      continue;
    } else if (!quoted && (*scan->at == scan->separator || *scan->at == '\n'))
      break;
    if (*scan->at != '\r' && *scan->at)
      *scan->out++ = *scan->at;
  }
  while (scan->out > start && (scan->out[-1] == ' ' || scan->out[-1] == '\t'))
    scan->out--;
  *scan->out++ = '\0';
  *cell = start;
  bool more = scan->at < scan->end && *scan->at == scan->separator;
  if (scan->at < scan->end)
    scan->at++;
  return more;
}

/* Rows and columns, for the room that they need. */
static void measure(struct scan scan, int *rows, int *columns)
{
  const char *cell;
  char *start = scan.out;
  *rows = *columns = 0;
  while (scan.at < scan.end) {
    int count = 0;
    bool more = true;
    while (more) {
      scan.out = start;
      more = scan_cell(&scan, &cell);
      count++;
    }
    *columns = count > *columns ? count : *columns;
    ++*rows;
  }
}

enum eo_code eo_cells_read(struct eo_cells *cells, const char *bytes, size_t size, struct eo_error *error)
{
  static const char mark[] = "\xEF\xBB\xBF";
  size_t skip = size >= 3 && memcmp(bytes, mark, 3) == 0 ? 3 : 0;
  memset(cells, 0, sizeof *cells);
  bytes += skip;
  size -= skip;
  cells->separator = find_separator(bytes, size);
  cells->text = malloc(2 * size + 2); /* a cell is no longer than what it is read of, and its end */
  if (!cells->text)
    return eo_error_memory(error);
  struct scan scan = {bytes, bytes + size, cells->separator, cells->text};
  measure(scan, &cells->rows, &cells->columns);
  if (cells->rows > EO_CELLS_ROWS || cells->columns > EO_CELLS_COLUMNS || cells->rows * cells->columns > EO_CELLS)
    return eo_error_set(error, EO_ERROR_INPUT, "", "The table has %d rows and %d columns; that is no table of designs.",
                        cells->rows, cells->columns);
  cells->cell = malloc(((size_t)cells->rows * (size_t)cells->columns + 1) * sizeof *cells->cell);
  if (!cells->cell)
    return eo_error_memory(error);
  for (int row = 0; row < cells->rows; row++) {
    bool more = true;
    for (int column = 0; column < cells->columns; column++) {
      const char *cell = "";
      if (more)
        more = scan_cell(&scan, &cell);
      cells->cell[row * cells->columns + column] = cell;
    }
  }
  return EO_OK;
}

enum eo_code eo_cells_read_workbook(struct eo_cells *cells, const char *bytes, size_t size, struct eo_error *error)
{
  char path[64], name[80], *text = NULL;
  size_t length = 0;
  memset(cells, 0, sizeof *cells);
  int file = memfd_create("workbook", MFD_CLOEXEC);
  FILE *out = open_memstream(&text, &length);
  enum eo_code code = EO_OK;
  if (file < 0 || !out || write(file, bytes, size) != (ssize_t)size)
    code = eo_error_memory(error);
  snprintf(path, sizeof path, "/proc/self/fd/%d", file);
  struct eo_archive archive = {.path = path, .bytes = (int64_t)size, .limit = WORKBOOK_BYTES, .error = error};
  if (!code)
    code = eo_workbook_write(&archive, out, name, sizeof name);
  if (out && fclose(out) && !code)
    code = eo_error_memory(error);
  if (file >= 0)
    close(file);
  if (!code)
    code = eo_cells_read(cells, text, length, error);
  free(text);
  return code;
}

void eo_cells_done(struct eo_cells *cells)
{
  free(cells->text);
  free(cells->cell);
  memset(cells, 0, sizeof *cells);
}

const char *eo_cells_at(const struct eo_cells *cells, int row, int column)
{
  return row >= 0 && row < cells->rows && column >= 0 && column < cells->columns
             ? cells->cell[row * cells->columns + column]
             : "";
}
