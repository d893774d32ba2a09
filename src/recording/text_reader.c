/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE /* memrchr */
/* The rows of a text file, block by block: cells go straight from the text to doubles; only lines that are not plain
   numbers are looked at twice. */
#include "base/decimal.h"
#include "recording/reader_private.h"
#include "recording/text_cell.h"
#include "recording/text_facts.h"
#include "recording/text_format.h"
#include "recording/text_named.h"
#include "recording/text_sections.h"
#include "recording/text_tables.h"
#include "recording/text_turns.h"
#include "recording/text_values.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BLOCK ((size_t)1 << 20) /* bytes of text in memory, and the longest line */
#define BATCH 16384             /* values that are appended at once */
#define FAULTS_NAMED 8          /* odd rows that get a note of their own */
#define FAULTS_FREE 10          /* odd rows that every file may have, */
#define FAULT_SHARE 100         /* and one in so many rows */
#define TRIED 64                /* places between rows where another table may begin */
#define LATE_LINES 1000         /* lines between the rows that are looked at for a rate */
#define TABLE_ROWS 20           /* behind which one is looked for */

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
  int64_t kept, table_rows; /* rows so far, of them those of the current table */
  int64_t expected;         /* line of the next row when no line is skipped */
  int batched, batch_rows;  /* rows in batch, rows that fit */
  struct eo_text_moments moments;
  struct eo_text_sections sections;
  const char *spool_directory;
  struct eo_tables tables; /* those that are read, and those of channels */
  struct eo_text_channels channels;
  char label[EO_RECORDING_NAME];      /* of the current table */
  bool heading;                       /* the block begins with what may be the heading of another table */
  int tried, late;                    /* lines that are no rows */
  int64_t passed;                     /* line where none began */
  int64_t first_line;                 /* of the first row of all */
  struct eo_text_format next;         /* of another table */
  struct eo_cell cell[EO_TEXT_CELLS]; /* of the row that is being read */
  double batch[BATCH];                /* [batched][columns] and the row that is being read */
  size_t filled;                      /* bytes in block */
  bool ended, open;                   /* the block holds the end of the file; it has no line end */
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

/* Takes the row that was split to the table of its channel. */
static enum eo_code keep_channel(struct text *text, struct eo_error *error)
{
  const struct eo_cell *unit = text->channels.unit < 0 ? NULL : &text->cell[text->channels.unit];
  struct eo_table *table;
  EO_TRY(eo_text_channel_table(&text->tables, &text->format, &text->cell[text->channels.cell], unit,
                               text->spool_directory, &table, error));
  if (text->channels.edge >= 0 && !eo_text_takes_edge(&text->channels, table, &text->cell[text->channels.edge]))
    return EO_OK;
  eo_recording_set_line(table->recording, text->line);
  return eo_recording_append(table->recording, next_row(text), 1, error);
}

/* Takes the row that was read to the end of the batch. */
static enum eo_code keep_row(struct text *text, struct eo_error *error)
{
  text->kept++;
  text->table_rows++;
  if (text->channels.cell >= 0)
    return keep_channel(text, error);
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
  int64_t rows = text->kept;
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
  return code || text->channels.cell >= 0 ? code : keep_row(text, error);
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

/* Converts the cells of the row that was split; returns the place of the first that is no number, -1: none is. */
static int convert_cells(struct text *text)
{
  const struct eo_text_format *format = &text->format;
  double *row = next_row(text);
  int odd = -1;
  for (int c = 0; c < format->cells; c++) {
    if (!eo_text_is_column(format, c))
      continue;
    enum eo_cell_kind kind = eo_text_value(&text->format, &text->moments, text->cell, c, row++);
    if (kind == EO_CELL_MISSING)
      count_missing(text, c);
    if (kind == EO_CELL_TEXT && odd < 0)
      odd = c;
  }
  return odd;
}

/* The place of a cell in rows whose values have names; -1: the first rows had none of this name. */
static int place_of(const struct eo_text_format *format, const struct eo_cell *cell, int from)
{
  uint64_t key = eo_text_name_key(cell);
  for (int i = 0; i < format->cells; i++) {
    int c = (from + i) % format->cells;
    if (format->key[c] == key && (key || i == 0))
      return c;
  }
  return -1;
}

/* Cuts a row into cells, to the places of their names where they have some; returns how many there are. What a named
   row lacks is empty; one that has none of the names is none. */
static int split_row(struct text *text, const char **at, const char *end)
{
  const struct eo_text_format *format = &text->format;
  struct eo_cell cell;
  int c = 0, found = 0, place;
  if (!eo_text_is_named(format->separator)) {
    while (c < format->cells && eo_text_next_cell(at, end, format->separator, &text->cell[c]))
      c++;
    return c;
  }
  for (int i = 0; i < format->cells; i++)
    text->cell[i] = (struct eo_cell){.text = end};
  for (; c < EO_TEXT_CELLS && eo_text_next_cell(at, end, format->separator, &cell); c++)
    if ((place = place_of(format, &cell, c % format->cells)) >= 0) {
      text->cell[place] = cell;
      found += cell.name != NULL;
    }
  *at = NULL;
  return found ? format->cells : 0;
}

/* "rate changed to 5000 Hz", or the rate behind the last row: in a line that is no row. */
static void take_late(struct text *text, const char *line, const char *end)
{
  if (text->late++ < LATE_LINES)
    eo_header_late_fact(&text->format, &text->next, line, end);
}

/* Reads a line cell by cell, with quotes, empty cells and everything that is not a plain number. last: the file ends
   without a line end. */
static enum eo_code read_slowly(struct text *text, const char *line, const char *end, bool last, struct eo_error *error)
{
  const struct eo_text_format *format = &text->format;
  if (eo_text_empty(line, end))
    return EO_OK;
  if (eo_text_comment(line, end, format->separator)) {
    take_late(text, line, end);
    return EO_OK;
  }
  if (text->sections.used && eo_text_sections_take(&text->sections, line, end, text->kept))
    return EO_OK;
  const char *at = line;
  int c = split_row(text, &at, end);
  if (c < format->cells && last) {
    take_late(text, line, end);
    eo_notes_add(text->notes, "The last row, in line %lld, is cut off and was left out.", (long long)text->line);
    return EO_OK;
  }
  if (c < format->cells || !only_empty_cells(at, end, format->separator)) {
    take_late(text, line, end);
    return odd_length(text, c < format->cells ? c : c + 1, error);
  }
  enum eo_code code = EO_OK;
  int odd = convert_cells(text);
  if (odd >= 0) {
    take_late(text, line, end);
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

static bool may_begin_table(const struct text *text, const char *line, const char *end)
{
  bool looked = text->sections.used || text->channels.cell >= 0 || text->table_rows < TABLE_ROWS ||
                text->tried == TRIED || text->line <= text->passed;
  return !looked && eo_text_may_begin_table(&text->format, line, end);
}

/* Reads all whole lines of the block, or those before another table, and moves what is left to its beginning. */
static enum eo_code read_lines(struct text *text, size_t from, struct eo_error *error)
{
  char line_end = text->format.line_end;
  if (text->ended && text->filled > from && text->block[text->filled - 1] != line_end) {
    text->open = true;
    text->block[text->filled++] = line_end;
  }
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
    text->heading = !quick && may_begin_table(text, at, last);
    if (text->heading)
      break;
    bool cut = text->open && text->ended && last + 1 == end;
    enum eo_code code = quick ? keep_row(text, error) : read_slowly(text, at, last, cut, error);
    if (code)
      return code;
    text->line++;
    at = last + 1;
  }
  text->filled -= (size_t)(at - text->block);
  memmove(text->block, at, text->filled);
  return EO_OK;
}

static enum eo_code make_recording(struct text *text, struct eo_error *error)
{
  const struct eo_text_format *format = &text->format;
  for (int c = 0; c < format->cells; c++)
    if (format->content[c] == EO_TEXT_WORDS && c != text->channels.cell && c != text->channels.unit &&
        c != text->channels.edge)
      eo_notes_add(text->notes, "Column %d \"%s\" is text and was left out.", c + 1, format->name[c]);
    else if (format->content[c] == EO_TEXT_BESIDE)
      eo_notes_add(text->notes, "Column %d \"%s\" stands beside the values of the channels and was left out.", c + 1,
                   format->name[c]);
  text->batch_rows = BATCH / format->columns;
  if (text->channels.cell >= 0)
    return EO_OK;
  EO_TRY(eo_recording_new(&text->recording, format->columns, text->spool_directory, error));
  eo_text_name_columns(format, text->recording);
  return EO_OK;
}

/* The table that was read is one of them. */
static enum eo_code end_table(struct text *text, struct eo_error *error)
{
  if (text->channels.cell >= 0) {
    for (int i = 0; i < text->tables.count; i++)
      eo_text_state_columns(&text->format, text->tables.table[i].recording);
    return EO_OK;
  }
  EO_TRY(flush(text, error));
  eo_text_state_columns(&text->format, text->recording);
  if (text->tables.count == EO_TABLES)
    return eo_error_set(error, EO_ERROR_INPUT, "", "The text holds more than %d tables; line %lld begins one more.",
                        EO_TABLES, (long long)text->line);
  struct eo_table *table = &text->tables.table[text->tables.count++];
  *table = (struct eo_table){.recording = text->recording};
  memcpy(table->label, text->label, sizeof table->label);
  text->recording = NULL;
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

/* Looks whether another table begins where the block does, and goes over to it; from: byte of its first row, 0 where
   none begins. */
static enum eo_code try_table(struct text *text, size_t *from, struct eo_error *error)
{
  struct eo_error none;
  struct eo_text_choice choice = {0};
  char label[EO_RECORDING_NAME];
  *from = 0;
  text->tried++;
  text->passed = text->line;
  if (!text->ended)
    EO_TRY(fill(text, error));
  size_t size = text->filled < EO_TEXT_HEAD ? text->filled : EO_TEXT_HEAD;
  char byte = text->block[size];
  text->block[size] = '\0';
  bool other = !eo_text_guess(&text->next, text->block, size, text->ended && size == text->filled, &choice, &none);
  if (other) {
    eo_text_read_header(&text->next, text->block);
    eo_text_table_label(&text->next, text->block, label);
    other = eo_text_is_other_table(&text->format, text->label, &text->next, label);
  }
  text->block[size] = byte;
  if (!other)
    return EO_OK;
  EO_TRY(end_table(text, error));
  eo_text_inherit_rate(&text->format, &text->next);
  text->format = text->next;
  memcpy(text->label, label, sizeof text->label);
  memset(text->moments.based, 0, sizeof text->moments.based);
  text->table_rows = 0;
  text->expected = 0;
  text->line += text->format.first_line - 1;
  *from = text->format.first_byte;
  return make_recording(text, error);
}

static enum eo_code read_rows(struct text *text, struct eo_error *error)
{
  enum eo_code code = read_lines(text, text->format.first_byte, error);
  while (!code && (text->heading || !text->ended)) {
    size_t from = 0;
    if (eo_progress_report(text->progress, "rig file", eo_source_fraction(text->source)))
      return eo_error_set(error, EO_ERROR_CANCELLED, "", "Reading the file was cancelled.");
    code = text->heading ? try_table(text, &from, error) : fill(text, error);
    if (!code)
      code = read_lines(text, from, error);
  }
  return code ? code : end_table(text, error);
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
  int64_t rows = text->kept;
  if (eo_text_is_named(format->separator))
    eo_notes_add(text->notes,
                 "Text with the names of %d columns in each row and a decimal %s; the first of %lld rows is line %lld.",
                 format->cells, format->point == ',' ? "comma" : "point", (long long)rows, (long long)text->first_line);
  else
    eo_notes_add(text->notes, "Text with %d column%s%s%s and a decimal %s; the first of %lld rows is line %lld.",
                 format->cells, format->cells == 1 ? "" : "s", format->cells == 1 ? "" : " separated by ",
                 format->cells == 1 ? "" : separator_name(format->separator), format->point == ',' ? "comma" : "point",
                 (long long)rows, (long long)text->first_line);
  eo_turns_note(format, text->notes);
  if (text->missing)
    eo_notes_add(text->notes, "%lld cell%s without a number, the first in line %lld, column %d.",
                 (long long)text->missing, text->missing == 1 ? " is" : "s are", (long long)text->missing_line,
                 text->missing_cell + 1);
  if (text->channels.other_edges)
    eo_notes_add(text->notes, "%lld rows hold the other edges of pulses and were left out.",
                 (long long)text->channels.other_edges);
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
  eo_text_sections_find(&text->sections, &text->format, text->block);
  text->channels = eo_text_find_channels(&text->format, text->block, size);
  eo_text_table_label(&text->format, text->block, text->label);
  text->block[size] = next;
  text->line = text->first_line = text->format.first_line;
  EO_TRY(make_recording(text, error));
  EO_TRY(read_rows(text, error));
  note_format(text);
  return EO_OK;
}

enum eo_code eo_delimited_read(struct eo_source *source, const struct eo_reader_options *options,
                               struct eo_recording **recording, struct eo_notes *notes, struct eo_error *error)
{
  struct text *text = malloc(sizeof *text);
  if (!text)
    return eo_error_memory(error);
  memset(text, 0, offsetof(struct text, batch));
  text->filled = 0;
  text->open = false;
  text->source = source;
  text->progress = options->progress;
  text->notes = notes;
  text->spool_directory = options->spool_directory;
  enum eo_code code = read_text(text, options, error);
  if (!code)
    code = eo_tables_join(&text->tables, options->spool_directory, recording, notes, error);
  eo_recording_free(text->recording);
  eo_tables_free(&text->tables);
  free(text);
  return code;
}
