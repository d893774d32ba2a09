/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE /* memrchr */
/* The rows of a text file, block by block: cells go straight from the text to doubles; only lines that are not plain
   numbers are looked at twice. */
#include "recording/decimal.h"
#include "recording/moment.h"
#include "recording/readers.h"
#include "recording/text_cell.h"
#include "recording/text_format.h"
#include "recording/text_sections.h"
#include "recording/recorded_unit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BLOCK ((size_t)1 << 20) /* bytes of text in memory, and the longest line */
#define BATCH 16384             /* values that are appended at once */
#define FAULTS_NAMED 8          /* odd rows that get a note of their own */
#define FAULTS_FREE 10          /* odd rows that every file may have, */
#define FAULT_SHARE 100         /* and one in so many rows */

_Static_assert(BLOCK > EO_TEXT_HEAD, "the layout is found in the first block");

struct text {
  struct eo_text_format format;
  struct eo_source *source;
  const struct eo_progress *progress;
  struct eo_recording *recording;
  struct eo_notes *notes;
  int64_t line;   /* of the next line of the text, from 1 */
  int64_t faults; /* rows with cells that are no numbers, or of another length */
  int64_t missing, missing_line;
  int missing_cell;
  int64_t expected;             /* line of the next row when no line is skipped */
  int batched, batch_rows;      /* rows in batch, rows that fit */
  bool based[EO_TEXT_CELLS];    /* [cells] of moments: day and before are known */
  int64_t day[EO_TEXT_CELLS];   /* from whose beginning moments are counted */
  double before[EO_TEXT_CELLS]; /* s, the moment of the row before */
  struct eo_text_sections sections;
  struct eo_cell cell[EO_TEXT_CELLS]; /* of the row that is being read */
  double batch[BATCH];                /* [batched][columns] and the row that is being read */
  size_t filled;                      /* bytes in block */
  bool ended;                         /* the block holds the end of the file */
  char block[BLOCK + 2];              /* one byte for a line end that the file lacks, one for a final 0 */
};

static double *next_row(struct text *text)
{
  return text->batch + (size_t)text->batched * (size_t)text->format.columns;
}

static enum eo_code flush(struct text *text, struct eo_error *error)
{
  int rows = text->batched;
  text->batched = 0;
  return eo_recording_append(text->recording, text->batch, rows, error);
}

/* Takes the row that was read to the end of the batch. */
static enum eo_code keep_row(struct text *text, struct eo_error *error)
{
  if (text->sections.used) {
    enum eo_code code = eo_text_sections_place(&text->sections, next_row(text), text->line, error);
    if (code)
      return code;
  }
  if (text->line != text->expected) {
    const double *row = next_row(text);
    enum eo_code code = flush(text, error);
    if (code)
      return code;
    memmove(text->batch, row, (size_t)text->format.columns * sizeof *row);
    eo_recording_set_line(text->recording, text->line);
  }
  text->expected = text->line + 1;
  return ++text->batched == text->batch_rows ? flush(text, error) : EO_OK;
}

/* An odd row or cell: said once with its place; too many of them are an error. */
static enum eo_code add_fault(struct text *text, int cell, const char *what, struct eo_error *error)
{
  int64_t rows = eo_recording_rows(text->recording) + text->batched;
  text->faults++;
  if (text->faults > FAULTS_FREE + rows / FAULT_SHARE)
    return eo_error_set(error, EO_ERROR_INPUT, "", "Line %lld, column %d: %s; that makes %lld such rows of %lld.",
                        (long long)text->line, cell + 1, what, (long long)text->faults, (long long)rows + 1);
  if (text->faults <= FAULTS_NAMED)
    eo_notes_add(text->notes, "Line %lld, column %d: %s; what is missing was left empty.", (long long)text->line,
                 cell + 1, what);
  return EO_OK;
}

static void describe_cell(const struct eo_cell *cell, char *what, size_t size)
{
  static const char tail[] = "\" is not a number";
  size_t n = 0;
  what[n++] = '"';
  for (size_t i = 0; i < cell->length && i < 24 && n < size - sizeof tail; i++)
    what[n++] = cell->text[i] >= ' ' && cell->text[i] < 127 ? cell->text[i] : '?';
  memcpy(what + n, tail, sizeof tail);
}

static void count_missing(struct text *text, int cell)
{
  if (text->missing++)
    return;
  text->missing_line = text->line;
  text->missing_cell = cell;
}

/* A row that has too few or too many cells: which ones are missing is not known, so that all are. */
static enum eo_code odd_length(struct text *text, int cells, struct eo_error *error)
{
  char what[80];
  bool more = cells > text->format.cells;
  snprintf(what, sizeof what, "the row has %s%d cells instead of %d", more ? "at least " : "", cells,
           text->format.cells);
  double *row = next_row(text);
  for (int c = 0; c < text->format.columns; c++)
    row[c] = NAN;
  enum eo_code code = add_fault(text, more ? cells - 1 : cells, what, error);
  return code ? code : keep_row(text, error);
}

/* True when nothing but empty cells follows. */
static bool only_empty_cells(const char *at, const char *end, char separator)
{
  struct eo_cell cell;
  while (eo_text_next_cell(&at, end, separator, &cell))
    if (cell.length)
      return false;
  return true;
}

/* A number with a unit behind it, in the unit of the column's first one. */
static enum eo_cell_kind unit_value(const struct text *text, int c, double *value)
{
  char unit[EO_RECORDING_UNIT];
  double own, first;
  enum eo_cell_kind kind = eo_text_cell_value(&text->cell[c], text->format.point, value);
  if (kind != EO_CELL_UNIT)
    return kind;
  eo_text_cell_unit(&text->cell[c], text->format.point, unit, (int)sizeof unit);
  if (eo_unit_find(unit, &own) != eo_unit_find(text->format.unit[c], &first))
    return EO_CELL_TEXT;
  *value *= own / first;
  return EO_CELL_NUMBER;
}

/* Seconds from the beginning of the first row's day. A time of day without a date goes on over midnight. */
static enum eo_cell_kind moment_value(struct text *text, int c, double *value)
{
  const struct eo_cell *cell = &text->cell[c],
                       *date = text->format.date[c] < 0 ? NULL : &text->cell[text->format.date[c]];
  struct eo_moment moment, day;
  if (!cell->length || !eo_moment_read(cell->text, cell->length, &moment))
    return eo_text_cell_value(cell, text->format.point, value) == EO_CELL_MISSING ? EO_CELL_MISSING : EO_CELL_TEXT;
  if (date && eo_moment_read(date->text, date->length, &day) && day.has_day)
    moment.has_day = true, moment.day = day.day;
  if (!text->based[c]) {
    struct eo_clock clock = {.column = -1, .epoch = EO_CLOCK_NO_EPOCH};
    text->day[c] = moment.day;
    if (moment.has_day)
      clock.epoch = moment.day * 86400000000000LL;
    text->format.clock[c] = clock;
  }
  *value = (double)(moment.day - text->day[c]) * EO_MOMENT_DAY + moment.seconds;
  if (text->based[c] && !moment.has_day) {
    double turn = moment.minutes ? 3600 : EO_MOMENT_DAY;
    *value = moment.seconds + (double)text->day[c] * turn; /* whole days, or hours, passed so far */
    if (*value < text->before[c] - turn / 2) {
      *value += turn;
      text->day[c]++;
    }
  }
  text->based[c] = true;
  text->before[c] = *value;
  return EO_CELL_NUMBER;
}

static enum eo_cell_kind cell_value(struct text *text, int c, double *value)
{
  *value = NAN;
  if (text->format.content[c] == EO_TEXT_MOMENT)
    return moment_value(text, c, value);
  if (text->format.content[c] == EO_TEXT_UNIT)
    return unit_value(text, c, value);
  if (text->format.content[c] == EO_TEXT_ARC &&
      eo_text_cell_sexagesimal(&text->cell[c], text->format.point, true, value))
    return EO_CELL_NUMBER;
  if (text->format.content[c] == EO_TEXT_HEX && eo_text_cell_hex(&text->cell[c], value))
    return EO_CELL_NUMBER;
  enum eo_cell_kind kind = eo_text_cell_value(&text->cell[c], text->format.point, value);
  bool number = kind == EO_CELL_NUMBER || kind == EO_CELL_GROUPED;
  if (!number)
    *value = NAN;
  return number || kind == EO_CELL_MISSING ? kind : EO_CELL_TEXT;
}

/* Converts the cells of the row that was split; returns the place of the first that is no number, -1: none is. */
static int convert_cells(struct text *text)
{
  const struct eo_text_format *format = &text->format;
  double *row = next_row(text);
  int odd = -1;
  for (int c = 0; c < format->cells; c++) {
    if (format->content[c] == EO_TEXT_WORDS || format->content[c] == EO_TEXT_DATE)
      continue;
    enum eo_cell_kind kind = cell_value(text, c, row++);
    if (kind == EO_CELL_MISSING)
      count_missing(text, c);
    if (kind == EO_CELL_TEXT && odd < 0)
      odd = c;
  }
  return odd;
}

/* Reads a line cell by cell, with quotes, empty cells and everything that is not a plain number. last: the file ends
   without a line end. */
static enum eo_code read_slowly(struct text *text, const char *line, const char *end, bool last, struct eo_error *error)
{
  const struct eo_text_format *format = &text->format;
  if (eo_text_empty(line, end) || eo_text_comment(line, end, format->separator))
    return EO_OK;
  if (text->sections.used &&
      eo_text_sections_take(&text->sections, line, end, eo_recording_rows(text->recording) + text->batched))
    return EO_OK;
  const char *at = line;
  int c = 0;
  while (c < format->cells && eo_text_next_cell(&at, end, format->separator, &text->cell[c]))
    c++;
  if (c < format->cells && last) {
    eo_notes_add(text->notes, "The last row, in line %lld, is cut off and was left out.", (long long)text->line);
    return EO_OK;
  }
  if (c < format->cells || !only_empty_cells(at, end, format->separator))
    return odd_length(text, c < format->cells ? c : c + 1, error);
  enum eo_code code = EO_OK;
  int odd = convert_cells(text);
  if (odd >= 0) {
    char what[64];
    describe_cell(&text->cell[odd], what, sizeof what);
    code = add_fault(text, odd, what, error);
  }
  return code ? code : keep_row(text, error);
}

static inline const char *skip_blanks(const char *p)
{
  while (*p == ' ' || *p == '\t' || *p == '\r')
    p++;
  return p;
}

/* Reads a line of nothing but numbers and returns its end; NULL when there is anything else. point and separator are
   constants where it is inlined. */
static inline __attribute__((always_inline)) const char *read_numbers(const struct eo_text_format *format,
                                                                      const char *p, char separator, char point,
                                                                      double *row)
{
  for (int c = 0; c < format->columns; c++) {
    while (*p == ' ' || (separator != '\t' && *p == '\t'))
      p++;
    p = eo_decimal_read(p, point, row + c);
    if (!p)
      return NULL;
    while (*p == ' ' && separator != ' ')
      p++;
    if (c + 1 == format->columns)
      break;
    if (*p != separator && !(separator == ' ' && *p == '\t'))
      return NULL;
    p++;
  }
  p = skip_blanks(p);
  if (*p == separator)
    p = skip_blanks(p + 1);
  return *p == format->line_end ? p : NULL;
}

static const char *read_quickly(const struct eo_text_format *format, const char *p, double *row)
{
  if (!format->plain || format->separator == format->point || format->line_end != '\n')
    return NULL;
  if (format->separator == ',')
    return read_numbers(format, p, ',', '.', row);
  if (format->point == '.')
    return read_numbers(format, p, format->separator, '.', row);
  return read_numbers(format, p, format->separator, ',', row);
}

/* Reads all whole lines of the block and moves what is left to its beginning. */
static enum eo_code read_lines(struct text *text, size_t from, struct eo_error *error)
{
  char line_end = text->format.line_end;
  bool open = text->ended && text->filled > from && text->block[text->filled - 1] != line_end;
  if (open)
    text->block[text->filled++] = line_end;
  const char *at = text->block + from, *end = memrchr(at, line_end, text->filled - from);
  end = end ? end + 1 : at;
  if (end == at && text->filled - from >= BLOCK)
    return eo_error_set(error, EO_ERROR_INPUT, "", "Line %lld is longer than the %zu kB that are read at most.",
                        (long long)text->line, BLOCK >> 10);
  while (at < end) {
    const char *last = read_quickly(&text->format, at, next_row(text));
    bool quick = last;
    if (!quick)
      last = memchr(at, line_end, (size_t)(end - at));
    enum eo_code code = quick ? keep_row(text, error) : read_slowly(text, at, last, open && last + 1 == end, error);
    if (code)
      return code;
    text->line++;
    at = last + 1;
  }
  text->filled -= (size_t)(at - text->block);
  memmove(text->block, at, text->filled);
  return EO_OK;
}

static enum eo_code fill(struct text *text, struct eo_error *error)
{
  size_t got;
  enum eo_code code = eo_source_read(text->source, text->block + text->filled, BLOCK - text->filled, &got, error);
  text->ended = got < BLOCK - text->filled;
  text->filled += got;
  return code;
}

static enum eo_code read_rows(struct text *text, struct eo_error *error)
{
  enum eo_code code = read_lines(text, text->format.first_byte, error);
  while (!code && !text->ended) {
    if (eo_progress_report(text->progress, "rig file", eo_source_fraction(text->source)))
      return eo_error_set(error, EO_ERROR_CANCELLED, "", "Reading the file was cancelled.");
    code = fill(text, error);
    if (!code)
      code = read_lines(text, 0, error);
  }
  return code ? code : flush(text, error);
}

/* What looks like a time of day is an angle where the heading gives it the unit of one. */
static void settle_arcs(struct eo_text_format *format)
{
  double factor;
  for (int c = 0; c < format->cells; c++)
    if (format->content[c] == EO_TEXT_MOMENT && eo_unit_find(format->unit[c], &factor) == EO_QUANTITY_ANGLE)
      format->content[c] = EO_TEXT_ARC;
}

static enum eo_code make_recording(struct text *text, const char *spool_directory, struct eo_error *error)
{
  const struct eo_text_format *format = &text->format;
  enum eo_code code = eo_recording_new(&text->recording, format->columns, spool_directory, error);
  if (code)
    return code;
  for (int c = 0, column = 0; c < format->cells; c++)
    if (format->content[c] == EO_TEXT_WORDS)
      eo_notes_add(text->notes, "Column %d \"%s\" is text and was left out.", c + 1, format->name[c]);
    else if (format->content[c] != EO_TEXT_DATE)
      eo_recording_set_column(text->recording, column++, format->name[c],
                              format->content[c] == EO_TEXT_MOMENT ? "s" : format->unit[c]);
  text->batch_rows = BATCH / format->columns;
  text->line = format->first_line;
  return EO_OK;
}

/* What the heading and the moments say of each column's clock and counts. */
static void state_columns(const struct text *text)
{
  const struct eo_text_format *format = &text->format;
  for (int c = 0, column = 0; c < format->cells; c++)
    if (format->content[c] != EO_TEXT_WORDS && format->content[c] != EO_TEXT_DATE) {
      eo_recording_set_clock(text->recording, column, &format->clock[c]);
      eo_recording_set_turn(text->recording, column++, format->turn[c]);
    }
  eo_recording_set_tick(text->recording, format->tick);
}

static const char *separator_name(char separator)
{
  return separator == ','    ? "commas"
         : separator == '|'  ? "bars"
         : separator == ';'  ? "semicolons"
         : separator == '\t' ? "tabs"
                             : "blanks";
}

static void note_format(const struct text *text)
{
  const struct eo_text_format *format = &text->format;
  int64_t rows = eo_recording_rows(text->recording);
  eo_notes_add(text->notes, "Text with %d column%s%s%s and a decimal %s; the first of %lld rows is line %lld.",
               format->cells, format->cells == 1 ? "" : "s", format->cells == 1 ? "" : " separated by ",
               format->cells == 1 ? "" : separator_name(format->separator), format->point == ',' ? "comma" : "point",
               (long long)rows, (long long)format->first_line);
  if (text->missing)
    eo_notes_add(text->notes, "%lld cell%s without a number, the first in line %lld, column %d.",
                 (long long)text->missing, text->missing == 1 ? " is" : "s are", (long long)text->missing_line,
                 text->missing_cell + 1);
  if (text->faults > FAULTS_NAMED)
    eo_notes_add(text->notes, "%lld rows are odd in all; the first %d are named above.", (long long)text->faults,
                 FAULTS_NAMED);
}

static enum eo_code read_text(struct text *text, const struct eo_reader_options *options, struct eo_error *error)
{
  enum eo_code code = fill(text, error);
  if (code)
    return code;
  bool whole = text->filled <= EO_TEXT_HEAD;
  size_t size = whole ? text->filled : EO_TEXT_HEAD;
  char next = text->block[size];
  text->block[size] = '\0';
  code = eo_text_guess(&text->format, text->block, size, whole && text->ended, &options->text, error);
  if (code)
    return code;
  eo_text_read_header(&text->format, text->block);
  settle_arcs(&text->format);
  eo_text_sections_find(&text->sections, &text->format, text->block);
  text->block[size] = next;
  code = make_recording(text, options->spool_directory, error);
  if (!code)
    code = read_rows(text, error);
  if (!code) {
    state_columns(text);
    note_format(text);
  }
  return code;
}

enum eo_code eo_delimited_read(struct eo_source *source, const struct eo_reader_options *options,
                               struct eo_recording **recording, struct eo_notes *notes, struct eo_error *error)
{
  struct text *text = malloc(sizeof *text);
  if (!text)
    return eo_error_memory(error);
  memset(text, 0, offsetof(struct text, batch));
  text->filled = 0;
  text->source = source;
  text->progress = options->progress;
  text->notes = notes;
  enum eo_code code = read_text(text, options, error);
  if (code)
    eo_recording_free(text->recording);
  else
    *recording = text->recording;
  free(text);
  return code;
}
