/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "format/text_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "format/digits.h"
#include "format/json.h"

static void add_cell(struct eo_text_table *sheet, const char *text, bool number)
{
  if (sheet->failed)
    return;
  if (sheet->cells == sheet->capacity) {
    int capacity = sheet->capacity ? 2 * sheet->capacity : 64;
    struct eo_cell *more = realloc(sheet->cell, (size_t)capacity * sizeof *more);
    if (!more) {
      sheet->failed = true;
      return;
    }
    sheet->cell = more;
    sheet->capacity = capacity;
  }
  struct eo_cell *cell = &sheet->cell[sheet->cells];
  *cell = (struct eo_cell){.text = strdup(text), .number = number};
  if (cell->text)
    sheet->cells++;
  else
    sheet->failed = true;
}

void eo_text_table_init(struct eo_text_table *sheet, int columns, const char *const *headings)
{
  *sheet = (struct eo_text_table){.columns = columns};
  for (int i = 0; i < columns; i++)
    add_cell(sheet, headings[i], false);
}

void eo_text_table_done(struct eo_text_table *sheet)
{
  if (!sheet)
    return;
  for (int i = 0; i < sheet->cells; i++)
    free(sheet->cell[i].text);
  free(sheet->cell);
  *sheet = (struct eo_text_table){0};
}

void eo_text_table_string(struct eo_text_table *sheet, const char *string)
{
  add_cell(sheet, string, false);
}

void eo_text_table_number(struct eo_text_table *sheet, double value, const struct eo_unit *unit, int digits)
{
  char text[40] = "";
  double outside = eo_unit_out(unit, value);
  if (isfinite(outside) && digits)
    snprintf(text, sizeof text, "%.*g", digits, outside);
  else if (isfinite(outside))
    eo_digits_write(text, sizeof text, outside);
  add_cell(sheet, text, true);
}

/* Characters, not bytes, of a UTF-8 string. */
static int width(const char *string)
{
  int n = 0;
  for (; *string; string++)
    n += ((unsigned char)*string & 0xC0) != 0x80;
  return n;
}

static int column_width(const struct eo_text_table *sheet, int column)
{
  int most = 0;
  for (int i = column; i < sheet->cells; i += sheet->columns)
    if (width(sheet->cell[i].text) > most)
      most = width(sheet->cell[i].text);
  return most;
}

/* A heading stands on the side of the cells below it. */
static bool to_the_right(const struct eo_text_table *sheet, int i)
{
  int below = i < sheet->columns ? i + sheet->columns : i;
  return below < sheet->cells && sheet->cell[below].number;
}

static void print_row(const struct eo_text_table *sheet, int first, int indent, const int *widths, struct eo_text *text)
{
  int last = first + sheet->columns - 1;
  eo_text_print(text, "%*s", indent, "");
  for (int i = first; i <= last && i < sheet->cells; i++) {
    const char *cell = sheet->cell[i].text;
    int blanks = widths[i - first] - width(cell);
    bool right = to_the_right(sheet, i);
    eo_text_print(text, "%*s%s%*s", right ? blanks : 0, "", cell, right || i == last ? 0 : blanks, "");
    eo_text_add(text, i == last ? "" : "  ");
  }
  eo_text_add(text, "\n");
}

void eo_text_table_print(const struct eo_text_table *sheet, int indent, struct eo_text *text)
{
  int *widths = calloc((size_t)sheet->columns, sizeof *widths);
  if (!widths || sheet->failed)
    text->failed = true;
  else {
    for (int j = 0; j < sheet->columns; j++)
      widths[j] = column_width(sheet, j);
    for (int i = 0; i < sheet->cells; i += sheet->columns)
      print_row(sheet, i, indent, widths, text);
  }
  free(widths);
}

static void csv_cell(const char *cell, struct eo_text *text)
{
  if (!cell[strcspn(cell, ",\"\r\n")]) {
    eo_text_add(text, cell);
    return;
  }
  eo_text_add(text, "\"");
  for (const char *c = cell; *c; c++) {
    if (*c == '"')
      eo_text_add(text, "\"");
    eo_text_add_bytes(text, c, 1);
  }
  eo_text_add(text, "\"");
}

void eo_text_table_csv(const struct eo_text_table *sheet, struct eo_text *text)
{
  if (sheet->failed)
    text->failed = true;
  for (int i = 0; i < sheet->cells; i++) {
    csv_cell(sheet->cell[i].text, text);
    eo_text_add(text, (i + 1) % sheet->columns ? "," : "\r\n");
  }
}
