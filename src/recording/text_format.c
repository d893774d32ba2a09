/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/text_format.h"
#include "recording/column.h"
#include "recording/moment.h"
#include "recording/recorded_unit.h"
#include "recording/text_cell.h"
#include "recording/text_named.h"

#include <stdlib.h>
#include <string.h>

#define LINES 2000    /* of the head that are looked at */
#define STEADY_ROWS 5 /* rows after which odd lines do not end a run, */
#define ODD_LINES 3   /* unless so many follow each other */
#define TABLE_ROWS 20 /* of numbers alone are a table, unless another has */
#define TABLE_SHARE 4 /* times as much */

struct line {
  const char *start, *end;
};

/* The lines of the head; the last one is left out when the file goes on in it. */
struct lines {
  int count;
  struct line line[LINES];
};

/* What one way of reading makes of a line. The sets have a bit for each of the first 64 cells. */
struct shape {
  int cells, numbers, texts;
  int points;     /* how much speaks for this way of reading */
  bool open;      /* ends with a separator, which counts as no cell */
  uint64_t names; /* of the names before its values; 0: none has one */
  uint64_t text, moment, unit, missing;
};

/* What counts as a number: what reads as one; words for the levels of a square wave, too; or the table may hold more
   words than numbers, as lists of events do. */
enum reading { PLAIN, LEVELS, WORDY, READINGS };

/* A run of consecutive lines of one shape. */
struct run {
  enum reading reading;
  int first, lines; /* index of the first line; comments and blank lines do not count */
  struct shape shape;
  double score;
};

static char find_line_end(const char *head, size_t size)
{
  return !memchr(head, '\n', size) && memchr(head, '\r', size) ? '\r' : '\n';
}

static void split_lines(struct lines *lines, const char *head, size_t size, char line_end, bool whole)
{
  const char *at = head, *last = head + size;
  lines->count = 0;
  while (at < last && lines->count < LINES) {
    const char *end = memchr(at, line_end, (size_t)(last - at));
    if (!end && !whole && lines->count)
      return;
    lines->line[lines->count++] = (struct line){at, end ? end : last};
    at = end ? end + 1 : last;
  }
}

/* "05" is no whole number anybody writes: it is what follows a decimal comma. */
static bool follows_comma(const struct eo_cell *cell)
{
  return cell->length > 1 && cell->text[0] == '0' && cell->text[1] >= '0' && cell->text[1] <= '9' &&
         !memchr(cell->text, '.', cell->length);
}

/* A number whose comma may be the point of another way of reading speaks less for this one than a plain number. */
static int points_of(enum eo_cell_kind kind)
{
  return kind == EO_CELL_TEXT ? -1 : kind == EO_CELL_MISSING ? 0 : kind == EO_CELL_NUMBER ? 2 : 1;
}

static void add_cell(struct shape *shape, enum eo_cell_kind kind)
{
  uint64_t bit = shape->cells < 64 ? (uint64_t)1 << shape->cells : 0;
  shape->numbers += kind != EO_CELL_TEXT && kind != EO_CELL_MISSING;
  shape->texts += kind == EO_CELL_TEXT;
  shape->points += points_of(kind);
  shape->text |= kind == EO_CELL_TEXT ? bit : 0;
  shape->moment |= kind == EO_CELL_MOMENT || kind == EO_CELL_ARC ? bit : 0;
  shape->unit |= kind == EO_CELL_UNIT ? bit : 0;
  shape->missing |= kind == EO_CELL_MISSING ? bit : 0;
}

static bool has_name(const struct line *line)
{
  size_t length = (size_t)(line->end - line->start);
  return memchr(line->start, '=', length) || memchr(line->start, ':', length);
}

static struct shape shape_of(const struct line *line, char separator, char point, enum reading reading)
{
  struct shape shape = {0};
  struct eo_cell cell;
  double value;
  bool named = eo_text_is_named(separator);
  if (named && !has_name(line))
    return shape;
  for (const char *at = line->start; shape.cells < EO_TEXT_CELLS && eo_text_next_cell(&at, line->end, separator, &cell);
       shape.cells++) {
    enum eo_cell_kind kind = eo_text_cell_value(&cell, point, &value);
    if (kind == EO_CELL_NUMBER && separator == ',' && point == '.' && shape.cells > 0 && follows_comma(&cell))
      kind = EO_CELL_TEXT;
    if (kind == EO_CELL_TEXT && reading == LEVELS && eo_text_cell_level(&cell, &value))
      kind = EO_CELL_NUMBER;
    shape.open = !cell.length && !cell.quoted && shape.cells > 0;
    add_cell(&shape, kind);
    if (named)
      shape.names += eo_text_name_key(&cell); /* in whatever order */
  }
  shape.cells -= shape.open;
  if (reading == WORDY)
    shape.points += shape.texts;
  return !named || shape.names ? shape : (struct shape){0};
}

static bool as_many(const struct shape *a, const struct shape *b)
{
  return a->names != b->names
             ? false
             : a->cells == b->cells || (a->cells == b->cells + 1 && b->open) || (b->cells == a->cells + 1 && a->open);
}

/* Lines belong together when they have as many cells, but for a last empty one, and the same content in the same
   places; an empty cell goes with any. */
static bool same_shape(const struct shape *a, const struct shape *b)
{
  uint64_t both = ~(a->missing | b->missing);
  return as_many(a, b) && !((a->text ^ b->text) & both) && !((a->moment ^ b->moment) & both) &&
         !((a->unit ^ b->unit) & both);
}

/* A row of the table in which a word stands for a number ("OVER"): it does not end the table. */
static bool is_flawed_row(const struct shape *run, const struct shape *row)
{
  uint64_t both = ~(run->missing | row->missing);
  return as_many(run, row) && row->numbers > 0 && !(run->text & ~row->text & both) &&
         !(((run->moment ^ row->moment) | (run->unit ^ row->unit)) & both & ~row->text);
}

static bool is_row(const struct shape *shape, enum reading reading)
{
  return shape->numbers > 0 && (2 * shape->numbers > shape->texts || reading == WORDY);
}

static bool holds_cells(const struct line *line, char separator)
{
  return !eo_text_empty(line->start, line->end) && !eo_text_comment(line->start, line->end, separator);
}

/* Cells that were empty so far take what a later row holds there. */
static void fill_shape(struct shape *run, const struct shape *row)
{
  uint64_t learned = run->missing & ~row->missing;
  run->text |= row->text & learned;
  run->moment |= row->moment & learned;
  run->unit |= row->unit & learned;
  run->missing &= row->missing;
  if (row->cells > run->cells)
    run->cells = row->cells;
}

/* The best run of rows; long ones with many numbers and little text win. A few odd lines do not end a run that is under
   way. */
static struct run find_run(const struct lines *lines, char separator, char point, enum reading reading)
{
  struct run best = {0}, run = {0};
  int odd = 0, first_odd = 0, flawed = 0;
  for (int i = 0; i < lines->count; i++) {
    if (!holds_cells(&lines->line[i], separator))
      continue;
    struct shape shape = shape_of(&lines->line[i], separator, point, reading);
    if (run.lines && !same_shape(&run.shape, &shape)) {
      if (!odd)
        first_odd = i;
      if (is_flawed_row(&run.shape, &shape) && flawed < run.lines + STEADY_ROWS) {
        flawed++;
        continue;
      }
      if (run.lines >= STEADY_ROWS && ++odd < ODD_LINES)
        continue;
      i = odd ? first_odd : i;
      odd = 0;
      shape = shape_of(&lines->line[i], separator, point, reading);
      run.lines = 0;
    }
    if (!is_row(&shape, reading))
      continue;
    odd = 0;
    if (!run.lines) {
      run = (struct run){.reading = reading, .first = i, .shape = shape};
      flawed = 0;
    }
    fill_shape(&run.shape, &shape);
    run.lines++;
    run.score += shape.points;
    bool earlier = run.first != best.first && best.lines >= TABLE_ROWS && !best.shape.text;
    if (run.score > (earlier ? TABLE_SHARE : 1) * best.score)
      best = run;
  }
  return best;
}

static enum eo_code no_table(const struct lines *lines, const char *head, struct eo_error *error)
{
  char start[60];
  const struct line *line = lines->count ? &lines->line[0] : NULL;
  size_t length = 0;
  for (const char *p = line ? line->start : head; line && p < line->end && length < sizeof start - 1; p++)
    start[length++] = *p >= ' ' && *p < 127 ? *p : '?';
  start[length] = '\0';
  return eo_error_set(error, EO_ERROR_INPUT, "",
                      "No table of numbers was found in the first %d lines of the text, which begins with \"%s\".",
                      lines->count, start);
}

/* "20260304115959.7", "1700000000000042244": a number, too, so that it is a moment only where all of its column are. */
static bool is_compact_moment(const struct eo_cell *cell)
{
  struct eo_moment moment;
  size_t digits = 0;
  while (digits < cell->length && cell->text[digits] >= '0' && cell->text[digits] <= '9')
    digits++;
  return (digits == 14 || (digits == cell->length && digits >= EO_MOMENT_STAMP - 1)) && cell->length < 64 &&
         eo_moment_read(cell->text, cell->length, &moment);
}

/* What each place holds, by the rows of the run: the first cell that is not empty decides, one hexadecimal number makes
   a place hexadecimal, one angle between colons makes times of day angles. */
static void find_content(struct eo_text_format *format, const struct lines *lines, const struct run *run)
{
  bool known[EO_TEXT_CELLS] = {false}, other[EO_TEXT_CELLS] = {false};
  for (int c = 0; c < format->cells; c++)
    format->content[c] = EO_TEXT_NUMBER;
  for (int i = run->first; i < lines->count && i < run->first + run->lines; i++) {
    struct shape shape = shape_of(&lines->line[i], format->separator, format->point, run->reading);
    struct eo_cell cell;
    double value;
    const char *at = lines->line[i].start;
    if (!same_shape(&run->shape, &shape))
      continue;
    for (int c = 0; c < format->cells && eo_text_next_cell(&at, lines->line[i].end, format->separator, &cell); c++) {
      enum eo_cell_kind kind = eo_text_cell_value(&cell, format->point, &value);
      bool level = run->reading == LEVELS && kind == EO_CELL_TEXT && eo_text_cell_level(&cell, &value);
      enum eo_text_content words = level ? EO_TEXT_LEVEL : EO_TEXT_WORDS;
      if (kind == EO_CELL_HEX)
        format->content[c] = EO_TEXT_HEX;
      else if (kind == EO_CELL_ARC)
        format->content[c] = EO_TEXT_ARC;
      else if (!known[c] && kind != EO_CELL_MISSING)
        format->content[c] = kind == EO_CELL_TEXT     ? words
                             : kind == EO_CELL_MOMENT ? EO_TEXT_MOMENT
                             : kind == EO_CELL_UNIT   ? EO_TEXT_UNIT
                                                      : EO_TEXT_NUMBER;
      known[c] = known[c] || kind != EO_CELL_MISSING;
      other[c] = other[c] || (kind != EO_CELL_MISSING && !is_compact_moment(&cell));
    }
  }
  for (int c = 0; c < format->cells; c++)
    if (known[c] && !other[c])
      format->content[c] = EO_TEXT_MOMENT;
}

/* A date beside a time of day makes one moment with it. Dates alone tell no time between rows. */
static void join_dates(struct eo_text_format *format, const struct line *row)
{
  struct eo_moment moment[EO_TEXT_CELLS] = {0};
  struct eo_cell cell;
  const char *at = row->start;
  for (int c = 0; c < format->cells && eo_text_next_cell(&at, row->end, format->separator, &cell); c++) {
    format->date[c] = -1;
    if (format->content[c] == EO_TEXT_MOMENT)
      eo_moment_read(cell.text, cell.length, &moment[c]);
  }
  for (int c = 0; c < format->cells; c++)
    if (moment[c].has_day && !moment[c].has_time) {
      int time = c + 1 < format->cells && moment[c + 1].has_time && !moment[c + 1].has_day ? c + 1
                 : c > 0 && moment[c - 1].has_time && !moment[c - 1].has_day               ? c - 1
                                                                                           : -1;
      format->content[c] = time < 0 ? EO_TEXT_WORDS : EO_TEXT_DATE;
      if (time >= 0)
        format->date[time] = c;
    }
}

/* Names before the values are those of the columns. */
static void take_names(struct eo_text_format *format, const struct line *row)
{
  struct eo_cell cell;
  const char *at = row->start;
  if (!eo_text_is_named(format->separator))
    return;
  for (int c = 0; c < format->cells && eo_text_next_cell(&at, row->end, format->separator, &cell); c++) {
    char label[EO_RECORDING_NAME], name[EO_RECORDING_NAME], unit[EO_RECORDING_UNIT];
    format->key[c] = eo_text_name_key(&cell);
    cell.text = cell.name;
    cell.length = cell.name_length;
    eo_text_cell_copy(label, sizeof label, &cell);
    eo_unit_split(label, name, (int)sizeof name, unit, (int)sizeof unit);
    bool own = *format->unit[c]; /* behind the value */
    memcpy(format->name[c], own ? label : name, sizeof format->name[c]);
    if (!own)
      memcpy(format->unit[c], unit, sizeof format->unit[c]);
  }
}

static void settle_content(struct eo_text_format *format, const struct lines *lines, const struct run *run)
{
  find_content(format, lines, run);
  join_dates(format, &lines->line[run->first]);
  format->plain = true;
  struct eo_cell cell;
  const char *at = lines->line[run->first].start;
  for (int c = 0; c < format->cells && eo_text_next_cell(&at, lines->line[run->first].end, format->separator, &cell);
       c++)
    if (format->content[c] == EO_TEXT_UNIT)
      eo_text_cell_unit(&cell, format->point, format->unit[c], (int)sizeof format->unit[c]);
  take_names(format, &lines->line[run->first]);
  for (int c = 0; c < format->cells; c++) {
    format->columns += eo_text_is_column(format, c);
    format->plain = format->plain && format->content[c] == EO_TEXT_NUMBER;
  }
}

/* Tries every way of reading that the choice leaves; the earlier one wins when two are as good. */
static struct run best_run(struct eo_text_format *format, const struct lines *lines,
                           const struct eo_text_choice *choice, enum reading reading)
{
  static const char ways[][2] = {{'\t', '.'}, {';', '.'},  {'|', '.'},           {',', '.'},
                                 {' ', '.'},  {'\t', ','}, {';', ','},           {'|', ','},
                                 {' ', ','},  {',', ','},  {EO_TEXT_NAMED, '.'}, {EO_TEXT_NAMED_COMMA, ','}};
  struct run best = {0};
  for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
    if ((choice->separator && choice->separator != ways[i][0]) || (choice->point && choice->point != ways[i][1]))
      continue;
    struct run run = find_run(lines, ways[i][0], ways[i][1], reading);
    if (run.score <= best.score)
      continue;
    best = run;
    format->separator = ways[i][0];
    format->point = ways[i][1];
  }
  return best;
}

/* Words make a table only where numbers make none: a heading of keys and numbers is shorter than its rows. */
static struct run find_table(struct eo_text_format *format, const struct lines *lines,
                             const struct eo_text_choice *choice)
{
  struct run run = best_run(format, lines, choice, PLAIN);
  for (enum reading reading = LEVELS; reading < READINGS && run.lines < TABLE_ROWS; reading++) {
    struct eo_text_format other = *format;
    struct run worded = best_run(&other, lines, choice, reading);
    if (worded.lines < TABLE_ROWS || worded.lines <= TABLE_SHARE * run.lines)
      continue;
    run = worded;
    format->separator = other.separator;
    format->point = other.point;
  }
  return run;
}

static enum eo_code guess_from(struct eo_text_format *format, struct lines *lines, const char *head,
                               const struct eo_text_choice *choice, struct eo_error *error)
{
  int skipped = 0;
  if (choice->first_line > lines->count)
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "The first row is said to stand in line %lld; the first %zu kB of the file have %d lines.",
                        (long long)choice->first_line, EO_TEXT_HEAD >> 10, lines->count);
  if (choice->first_line > 1) {
    skipped = (int)choice->first_line - 1;
    lines->count -= skipped;
    memmove(lines->line, lines->line + skipped, (size_t)lines->count * sizeof *lines->line);
  }
  struct run run = find_table(format, lines, choice);
  if (!run.lines || (eo_text_is_named(format->separator) && run.lines < STEADY_ROWS)) /* facts */
    return no_table(lines, head, error);
  format->cells = run.shape.cells;
  settle_content(format, lines, &run);
  if (format->columns < 1 || format->columns > EO_RECORDING_COLUMNS || format->cells >= EO_TEXT_CELLS)
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "The rows of the text have %d cells from line %d on; at most %d columns are read.",
                        format->cells, run.first + skipped + 1, EO_RECORDING_COLUMNS);
  format->first_line = run.first + skipped + 1;
  format->first_byte = (size_t)(lines->line[run.first].start - head);
  format->rows = run.lines;
  return EO_OK;
}

bool eo_text_is_column(const struct eo_text_format *format, int cell)
{
  enum eo_text_content content = format->content[cell];
  return content != EO_TEXT_WORDS && content != EO_TEXT_DATE && content != EO_TEXT_BESIDE;
}

bool eo_text_is_called_time(const struct eo_text_format *format, int cell)
{
  double factor;
  return eo_column_named(format->name[cell], EO_CLOCK_WORDS "|" EO_TICK_WORDS) ||
         eo_unit_find(format->unit[cell], &factor) == EO_QUANTITY_TIME;
}

enum eo_code eo_text_guess(struct eo_text_format *format, const char *head, size_t size, bool whole,
                           const struct eo_text_choice *choice, struct eo_error *error)
{
  struct lines *lines = malloc(sizeof *lines);
  if (!lines)
    return eo_error_memory(error);
  memset(format, 0, sizeof *format);
  format->header_byte = size >= 3 && !memcmp(head, "\xef\xbb\xbf", 3) ? 3 : 0;
  format->line_end = find_line_end(head, size);
  split_lines(lines, head + format->header_byte, size - format->header_byte, format->line_end, whole);
  enum eo_code code = guess_from(format, lines, head, choice, error);
  free(lines);
  return code;
}
