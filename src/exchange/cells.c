/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE
#include "exchange/cells.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/utf8.h"
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
  bool open; /* the text ended within quotation marks */
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
  scan->open = quoted;
  while (scan->out > start && (scan->out[-1] == ' ' || scan->out[-1] == '\t'))
    scan->out--;
  *scan->out++ = '\0';
  *cell = start;
  bool more = scan->at < scan->end && *scan->at == scan->separator;
  if (scan->at < scan->end)
    scan->at++;
  return more;
}

/* Rows and columns, for the room that they need; false: a quotation mark is left open. */
static bool measure(struct scan scan, int *rows, int *columns)
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
  return !scan.open;
}

/* Two bytes a character, as spreadsheets write "Unicode text". */
static size_t widen(char *out, const unsigned char *bytes, size_t size)
{
  bool little = bytes[0] == 0xFF;
  uint32_t high = 0;
  size_t used = 0;
  for (size_t at = 2; at + 1 < size; at += 2) {
    uint32_t c = little ? bytes[at] | (uint32_t)bytes[at + 1] << 8 : (uint32_t)bytes[at] << 8 | bytes[at + 1];
    if (c >= 0xD800 && c < 0xDC00) {
      high = c;
      continue;
    }
    if (c >= 0xDC00 && c < 0xE000)
      c = high ? 0x10000 + ((high - 0xD800) << 10) + (c - 0xDC00) : '?';
    high = 0;
    used += eo_utf8_put(out + used, c);
  }
  return used;
}

/* The text as UTF-8, into out[2 size]: without its mark, from two bytes a character, and from Latin 1 where it is no
   UTF-8, as spreadsheets in Europe write CSV. */
static size_t decode(char *out, const char *bytes, size_t size)
{
  static const char mark[] = "\xEF\xBB\xBF";
  const unsigned char *byte = (const unsigned char *)bytes;
  size_t at = size >= 3 && memcmp(bytes, mark, 3) == 0 ? 3 : 0, start = at, used = 0;
  if (size >= 2 && byte[0] + byte[1] == 0xFF + 0xFE && (byte[0] == 0xFF || byte[0] == 0xFE))
    return widen(out, byte, size);
  while (at < size && eo_utf8_size(bytes + at, size - at))
    at += eo_utf8_size(bytes + at, size - at);
  if (at == size) {
    memcpy(out, bytes + start, size - start);
    return size - start;
  }
  for (at = start; at < size; at++)
    used += eo_utf8_put(out + used, byte[at] >= 0x80 && byte[at] < 0xA0 ? '?' : byte[at]);
  return used;
}

static enum eo_code read_text(struct eo_cells *cells, const char *bytes, size_t size, struct eo_error *error)
{
  cells->separator = find_separator(bytes, size);
  cells->text = malloc(2 * size + 2); /* a cell is no longer than what it is read of, and its end */
  if (!cells->text)
    return eo_error_memory(error);
  struct scan scan = {bytes, bytes + size, cells->separator, cells->text, false};
  if (!measure(scan, &cells->rows, &cells->columns))
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "A quotation mark that opens a cell is never closed; the file is damaged or was cut off.");
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

enum eo_code eo_cells_read(struct eo_cells *cells, const char *bytes, size_t size, struct eo_error *error)
{
  char *text = malloc(2 * size + 1);
  memset(cells, 0, sizeof *cells);
  if (!text)
    return eo_error_memory(error);
  enum eo_code code = read_text(cells, text, decode(text, bytes, size), error);
  free(text);
  return code;
}

/* Names of files stand in a zip archive as they are. */
enum eo_cells_kind eo_cells_kind_of(const char *bytes, size_t size)
{
  static const char workbook[] = "xl/workbook.xml", opendocument[] = "content.xml";
  if (size < 4 || memcmp(bytes, "PK", 2) != 0)
    return EO_CELLS_NONE;
  if (memmem(bytes, size, workbook, sizeof workbook - 1))
    return EO_CELLS_WORKBOOK;
  return memmem(bytes, size, opendocument, sizeof opendocument - 1) ? EO_CELLS_OPENDOCUMENT : EO_CELLS_NONE;
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
    code = eo_cells_kind_of(bytes, size) == EO_CELLS_OPENDOCUMENT
               ? eo_opendocument_write(&archive, out, name, sizeof name)
               : eo_workbook_write(&archive, out, name, sizeof name);
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
