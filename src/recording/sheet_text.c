/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/sheet_text.h"
#include "base/decimal.h"
#include "recording/source.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define TICKS 864000000000LL /* tenths of a microsecond in a day: what a number of days still resolves */
#define SHARE 4              /* of the cells of the largest table: one in so many is nearly as large */

enum {
  FACT_SHEETS = 8, /* sheets that are no table, */
  FACT_CELLS = 200 /* and what they hold at most */
};

static bool is_table(const struct eo_sheet_text *text, int sheet)
{
  int64_t cells = text->sheet[sheet].cells, most = text->sheet[text->best].cells;
  return sheet == text->best || (text->several && cells > FACT_CELLS && cells > most / SHARE);
}

static bool may_hold_facts(const struct eo_sheet_text *text, int sheet)
{
  int64_t cells = text->sheet[sheet].cells;
  return sheet != text->best && cells > 0 && cells <= FACT_CELLS && text->facts < FACT_SHEETS;
}

/* What is written, once all sheets have been counted. */
static void settle(struct eo_sheet_text *text)
{
  int64_t commas = 0, points = 0;
  for (int i = 1; i < text->sheets; i++)
    if (text->sheet[i].cells > text->sheet[text->best].cells)
      text->best = i;
  for (int i = 0; i < text->sheets; i++) {
    text->sheet[i].facts = may_hold_facts(text, i);
    text->facts += text->sheet[i].facts;
    if (!is_table(text, i))
      continue;
    text->tables++;
    commas += text->sheet[i].commas;
    points += text->sheet[i].points;
  }
  text->comma = text->several && commas > points;
}

static bool go_to(struct eo_sheet_text *text, int column)
{
  if (!text->writing || column < text->written || column >= EO_SHEET_COLUMNS)
    return false;
  for (; text->written < column; text->written++)
    putc('\t', text->line);
  return true;
}

static void put(struct eo_sheet_text *text, const char *cell, char point)
{
  while (*cell == ' ')
    cell++;
  for (; *cell; cell++)
    putc(*cell == '\t' || *cell == '\n' || *cell == '\r' ? ' ' : *cell == '.' ? point : *cell, text->line);
}

bool eo_sheet_text_next(struct eo_sheet_text *text, const char *name)
{
  int sheet = ++text->current;
  bool known = sheet < EO_SHEETS;
  text->written = text->widest = 0;
  text->numbers = text->texts = 0;
  text->names = text->heading = text->writing = false;
  if (known && text->pass == EO_SHEET_COUNT) {
    snprintf(text->sheet[sheet].name, sizeof text->sheet[sheet].name, "%s", name);
    text->sheets = sheet + 1;
    return true;
  }
  if (!known || sheet >= text->sheets)
    return false;
  text->writing = text->pass == EO_SHEET_FACTS ? text->sheet[sheet].facts : is_table(text, sheet);
  if (text->pass == EO_SHEET_TABLES && text->writing && text->tables > 1)
    fputs("Sheet: ", text->file), fputs(text->sheet[sheet].name, text->file), putc('\n', text->file);
  return text->writing;
}

/* A text that is a number with a decimal point or comma; *mark: which, 0: none, or it may as well be that of thousands.
 */
static bool is_number(const char *text, char *mark)
{
  double value;
  while (*text == ' ')
    text++;
  size_t sign = *text == '-' || *text == '+', digits = strspn(text + sign, "0123456789");
  const char *at = text + sign + digits;
  char point = *at == ',' ? ',' : '.';
  const char *end = digits ? eo_decimal_read(text, point, &value) : NULL;
  bool thousands = digits <= 3 && text[sign] != '0' && *at == point && strspn(at + 1, "0123456789") == 3 && !at[4];
  *mark = end && !*end && *at == point && !thousands ? point : 0;
  return end && !*end;
}

/* A cell that holds something. */
static struct eo_sheet *count(struct eo_sheet_text *text, bool number)
{
  struct eo_sheet *sheet = text->current < EO_SHEETS ? &text->sheet[text->current] : NULL;
  text->numbers += number;
  text->texts += !number;
  if (!sheet || text->pass != EO_SHEET_COUNT)
    return NULL;
  sheet->cells++;
  return sheet;
}

void eo_sheet_text_cell(struct eo_sheet_text *text, int column, const char *cell)
{
  char mark;
  if (!cell[strspn(cell, " ")])
    return;
  struct eo_sheet *sheet = count(text, is_number(cell, &mark));
  if (sheet) {
    sheet->commas += mark == ',';
    sheet->points += mark == '.';
  }
  if (go_to(text, column))
    put(text, cell, '.');
}

void eo_sheet_text_number(struct eo_sheet_text *text, int column, const char *number)
{
  count(text, true);
  if (go_to(text, column))
    put(text, number, text->comma ? ',' : '.');
}

static void print_time(struct eo_sheet_text *text, int64_t ticks)
{
  int64_t second = ticks / 10000000;
  char out[64];
  snprintf(out, sizeof out, "%02d:%02d:%02d.%07d", (int)(second / 3600), (int)(second / 60 % 60), (int)(second % 60),
           (int)(ticks % 10000000));
  fputs(out, text->line);
}

/* Year, month and day from days since 1970, by years that begin in March. */
static void print_date(struct eo_sheet_text *text, int64_t day)
{
  int64_t shifted = day + 719468, era = (shifted >= 0 ? shifted : shifted - 146096) / 146097;
  int64_t of_era = shifted - era * 146097;
  int64_t of_year = (of_era - of_era / 1460 + of_era / 36524 - of_era / 146096) / 365;
  int64_t rest = of_era - (365 * of_year + of_year / 4 - of_year / 100), month = (5 * rest + 2) / 153;
  int64_t date = rest - (153 * month + 2) / 5 + 1, real = month < 10 ? month + 3 : month - 9;
  char out[64];
  snprintf(out, sizeof out, "%04d-%02d-%02dT", (int)(of_year + era * 400 + (real <= 2)), (int)real, (int)date);
  fputs(out, text->line);
}

void eo_sheet_text_moment(struct eo_sheet_text *text, int column, double days)
{
  count(text, true);
  if (!(fabs(days) < 1e6) || !go_to(text, column))
    return;
  double whole = floor(days);
  int64_t ticks = llround((days - whole) * (double)TICKS), day = (int64_t)whole + ticks / TICKS;
  print_date(text, day);
  print_time(text, ticks % TICKS);
}

void eo_sheet_text_time(struct eo_sheet_text *text, int column, double days)
{
  count(text, true);
  if (days >= 0 && days < 1 && go_to(text, column))
    print_time(text, llround(days * (double)TICKS));
}

void eo_sheet_text_formula(struct eo_sheet_text *text, const char *value)
{
  if (text->pass != EO_SHEET_COUNT || text->current >= EO_SHEETS)
    return;
  struct eo_sheet *sheet = &text->sheet[text->current];
  sheet->formulas++;
  sheet->empty += !*value;
  sheet->zero += !strcmp(value, "0");
}

/* A heading begins another table, which may be narrower than the one above it. Names stand without a gap, and units
   below them may be fewer; a title may stand far apart. Facts have numbers among their texts. */
static void settle_width(struct eo_sheet_text *text)
{
  bool heading = text->texts > text->numbers, above = heading && !(text->heading && text->names);
  if (above || (heading && text->numbers))
    text->widest = 0;
  if (!heading || !text->numbers)
    text->widest = text->written > text->widest ? text->written : text->widest;
  text->heading = heading;
  text->names = heading && !text->numbers && text->texts == text->written + 1;
}

void eo_sheet_text_row(struct eo_sheet_text *text, int64_t times)
{
  bool filled = text->numbers + text->texts > 0;
  if (text->writing && filled) {
    settle_width(text);
    if (!text->heading)
      go_to(text, text->widest);
  }
  if (text->writing) {
    putc('\n', text->line);
    fflush(text->line);
    for (int64_t i = 0; i < (filled ? times : 1) && text->bytes <= text->most; i++)
      text->bytes += (int64_t)fwrite(text->row, 1, text->length, text->file);
    rewind(text->line);
  }
  text->written = text->numbers = text->texts = 0;
}

/* Programs that write workbooks and compute nothing leave formulas without a value, or all of them with the value 0. */
static void note_formulas(const struct eo_sheet_text *text, struct eo_notes *notes)
{
  for (int i = 0; i < text->sheets; i++) {
    const struct eo_sheet *sheet = &text->sheet[i];
    bool zeros = text->recalculated && sheet->zero > 1 && sheet->zero + sheet->empty == sheet->formulas;
    int64_t missing = sheet->empty + (zeros ? sheet->zero : 0);
    if (missing && (is_table(text, i) || sheet->facts))
      eo_notes_add(notes,
                   "%lld cell%s of the sheet \"%.60s\" hold%s formulas that were never computed, so that the file has "
                   "no numbers there: open it in a spreadsheet program and save it once.",
                   (long long)missing, missing == 1 ? "" : "s", sheet->name, missing == 1 ? "s" : "");
  }
}

static enum eo_code pass_over(struct eo_sheet_text *text, enum eo_sheet_pass pass, struct eo_archive *archive,
                              bool (*visit)(void *context, struct eo_archive *archive, const char *name), void *context)
{
  text->pass = pass;
  text->current = -1;
  return eo_archive_visit(archive, visit, context);
}

static enum eo_code write_passes(struct eo_sheet_text *text, struct eo_archive *archive,
                                 bool (*visit)(void *context, struct eo_archive *archive, const char *name),
                                 void *context)
{
  EO_TRY(pass_over(text, EO_SHEET_COUNT, archive, visit, context));
  settle(text);
  if (!text->sheet[text->best].cells)
    return eo_error_set(archive->error, EO_ERROR_INPUT, "", "No sheet of the spreadsheet holds anything.");
  note_formulas(text, archive->notes);
  if (text->facts)
    EO_TRY(pass_over(text, EO_SHEET_FACTS, archive, visit, context));
  EO_TRY(pass_over(text, EO_SHEET_TABLES, archive, visit, context));
  if (text->bytes > text->most)
    return eo_error_set(
        archive->error, EO_ERROR_INPUT, "",
        "The rows of the spreadsheet grow to more than %lld MB by being repeated; that is no recording.",
        (long long)(text->most >> 20));
  return EO_OK;
}

enum eo_code eo_sheet_text_write(struct eo_sheet_text *text, struct eo_archive *archive,
                                 bool (*visit)(void *context, struct eo_archive *archive, const char *name),
                                 void *context)
{
  text->several = archive->tables;
  text->most = eo_source_growth(archive->path, archive->limit);
  text->line = open_memstream(&text->row, &text->length);
  if (!text->line)
    return eo_error_memory(archive->error);
  enum eo_code code = write_passes(text, archive, visit, context);
  fclose(text->line);
  free(text->row);
  return code;
}

const char *eo_sheet_text_name(const struct eo_sheet_text *text)
{
  return text->sheets && text->sheet[text->best].cells ? text->sheet[text->best].name : "";
}
