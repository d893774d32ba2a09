#include "recording/text_format.h"
#include "recording/text_cell.h"

#include <stdlib.h>
#include <string.h>

#define LINES 2000    /* of the head that are looked at */
#define STEADY_ROWS 5 /* rows after which odd lines do not end a run, */
#define ODD_LINES 3   /* unless so many follow each other */

struct line {
  const char *start, *end;
};

/* The lines of the head; the last one is left out when the file goes on in it. */
struct lines {
  int count;
  struct line line[LINES];
};

/* What one way of reading makes of a line. */
struct shape {
  int cells, numbers, texts;
  bool open;        /* ends with a separator, which counts as no cell */
  uint64_t pattern; /* which of the first 64 cells are text */
};

/* A run of consecutive lines of one shape. */
struct run {
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

static struct shape shape_of(const struct line *line, char separator, char point)
{
  struct shape s = {0};
  struct eo_cell cell;
  double value;
  for (const char *at = line->start; s.cells < EO_TEXT_CELLS && eo_text_next_cell(&at, line->end, separator, &cell);
       s.cells++) {
    enum eo_cell_kind kind = eo_text_cell_value(&cell, point, &value);
    if (kind == EO_CELL_NUMBER && separator == ',' && point == '.' && s.cells > 0 && follows_comma(&cell))
      kind = EO_CELL_TEXT;
    s.open = !cell.length && !cell.quoted && s.cells > 0;
    s.numbers += kind == EO_CELL_NUMBER;
    s.texts += kind == EO_CELL_TEXT;
    if (kind == EO_CELL_TEXT && s.cells < 64)
      s.pattern |= (uint64_t)1 << s.cells;
  }
  s.cells -= s.open;
  return s;
}

/* Lines belong together when they have as many cells, but for a last empty one, and text in the same places. */
static bool same_shape(const struct shape *a, const struct shape *b)
{
  bool as_many = a->cells == b->cells || (a->cells == b->cells + 1 && b->open) || (b->cells == a->cells + 1 && a->open);
  return as_many && a->pattern == b->pattern;
}

static bool is_row(const struct shape *s)
{
  return s->numbers > 0 && 2 * s->numbers > s->texts;
}

static bool holds_cells(const struct line *line, char separator)
{
  return !eo_text_empty(line->start, line->end) && !eo_text_comment(line->start, line->end, separator);
}

/* The best run of rows; long ones with many numbers and little text win. A few odd lines do not end a run that is under
   way. */
static struct run find_run(const struct lines *lines, char separator, char point)
{
  struct run best = {0}, run = {0};
  int odd = 0, first_odd = 0;
  for (int i = 0; i < lines->count; i++) {
    if (!holds_cells(&lines->line[i], separator))
      continue;
    struct shape shape = shape_of(&lines->line[i], separator, point);
    if (run.lines && !same_shape(&run.shape, &shape)) {
      if (!odd)
        first_odd = i;
      if (run.lines >= STEADY_ROWS && ++odd < ODD_LINES)
        continue;
      i = odd ? first_odd : i;
      odd = 0;
      shape = shape_of(&lines->line[i], separator, point);
      run.lines = 0;
    }
    if (!is_row(&shape))
      continue;
    odd = 0;
    if (!run.lines)
      run = (struct run){.first = i, .shape = shape};
    if (shape.cells > run.shape.cells)
      run.shape.cells = shape.cells;
    run.lines++;
    run.score += 2 * shape.numbers - shape.texts;
    if (run.score > best.score)
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

/* Which cells hold numbers: those that are not text in the first row; cells without content count as numbers. */
static void mark_numbers(struct eo_text_format *f, const struct line *row)
{
  struct eo_cell cell;
  double value;
  const char *at = row->start;
  for (int c = 0; c < f->cells; c++)
    f->number[c] = !eo_text_next_cell(&at, row->end, f->separator, &cell) ||
                   eo_text_cell_value(&cell, f->point, &value) != EO_CELL_TEXT;
  for (int c = 0; c < f->cells; c++)
    f->columns += f->number[c];
}

/* Tries every way of reading that the choice leaves; the earlier one wins when two are as good. */
static struct run best_run(struct eo_text_format *f, const struct lines *lines, const struct eo_text_choice *choice)
{
  static const char ways[][2] = {{'\t', '.'}, {';', '.'}, {',', '.'}, {' ', '.'},
                                 {'\t', ','}, {';', ','}, {' ', ','}, {',', ','}};
  struct run best = {0};
  for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
    if ((choice->separator && choice->separator != ways[i][0]) || (choice->point && choice->point != ways[i][1]))
      continue;
    struct run run = find_run(lines, ways[i][0], ways[i][1]);
    if (run.score <= best.score)
      continue;
    best = run;
    f->separator = ways[i][0];
    f->point = ways[i][1];
  }
  return best;
}

static enum eo_code guess_from(struct eo_text_format *f, struct lines *lines, const char *head,
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
  struct run run = best_run(f, lines, choice);
  if (!run.lines)
    return no_table(lines, head, error);
  f->cells = run.shape.cells;
  mark_numbers(f, &lines->line[run.first]);
  if (f->columns < 1 || f->columns > EO_RECORDING_COLUMNS || f->cells >= EO_TEXT_CELLS)
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "The rows of the text have %d cells from line %d on; at most %d columns are read.", f->cells,
                        run.first + skipped + 1, EO_RECORDING_COLUMNS);
  f->first_line = run.first + skipped + 1;
  f->first_byte = (size_t)(lines->line[run.first].start - head);
  return EO_OK;
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
