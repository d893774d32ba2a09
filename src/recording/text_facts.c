/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/text_facts.h"
#include "recording/letters.h"
#include "recording/moment.h"
#include "recording/recorded_unit.h"
#include "recording/series.h"
#include "recording/stated.h"
#include "recording/text_cell.h"
#include "recording/text_number.h"
#include "recording/text_turns.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define KEY 96
#define FASTEST 1.5e-6 /* s between rows */
#define MARKS " \t:=;,|\"([{<>)]}'"

void eo_header_split(struct eo_header *header, const struct eo_text_format *format, const char *head)
{
  const char *last = head + format->first_byte;
  header->lines = 0;
  for (const char *start = head + format->header_byte; start < last;) {
    const char *end = memchr(start, format->line_end, (size_t)(last - start));
    end = end ? end : last;
    const char *comment = eo_text_comment(start, end, format->separator), *from = comment ? comment : start;
    if (!eo_text_empty(from, end)) {
      if (header->lines == EO_HEADER_LINES)
        memmove(header->line, header->line + 1, (size_t)--header->lines * sizeof *header->line);
      header->line[header->lines++] = (struct eo_header_line){from, end};
    }
    start = end + 1;
  }
}

int eo_header_cells(const struct eo_header_line *line, char separator)
{
  struct eo_cell cell;
  int count = 0, filled = 0;
  for (const char *at = line->start; eo_text_next_cell(&at, line->end, separator, &cell);) {
    count++;
    if (cell.length)
      filled = count;
  }
  return filled;
}

static void use_fact(struct eo_text_format *format, const struct eo_stated *stated)
{
  for (int c = 0; c < format->cells; c++) {
    struct eo_clock *clock = &format->clock[c];
    if (!eo_header_means(format, stated, c))
      continue;
    eo_series_tell(clock, stated);
    if (stated->kind == EO_STATED_START)
      clock->start = stated->value;
  }
  if (stated->kind == EO_STATED_TICK)
    format->tick = stated->value;
  eo_turns_use(format, stated);
}

/* "4.000 Hz" in a file of decimal commas may be 4000 Hz: that is stated as well, where rows can come so fast. */
static void use_thousands(struct eo_text_format *format, const char *key, const char *at, const char *end,
                          const char *unit)
{
  int groups;
  double value;
  const char *after = format->point == ',' ? eo_text_grouped(at, end, ',', &groups, &value) : NULL;
  if (!after || groups != 1 || !memchr(at, '.', (size_t)(after - at)) || memchr(at, ',', (size_t)(after - at)))
    return;
  struct eo_stated stated = eo_stated_read(key, value, unit);
  if (stated.kind == EO_STATED_INTERVAL && stated.value > FASTEST)
    use_fact(format, &stated);
}

/* "filter at", before a number: what stands before the last word belongs to the number before. */
static bool leads_on(const char *words)
{
  const char *last = strrchr(words, ' ');
  return last && eo_letters_listed(last + 1, strlen(last + 1), "at|with|and|to|mit|bei|und|auf|a|avec|et|con|e|y");
}

/* Words behind a number and its unit, in the same cell; *ended: they belong to it and not to the next number. */
static const char *words_behind(const char *at, const char *end, char words[KEY], bool *ended)
{
  const char *last = at;
  while (last < end && !strchr("\t;,|.:=()[]\"0123456789", *last))
    last++;
  eo_header_trim(words, KEY, at, last);
  *ended = last == end || !strchr(":=0123456789", *last) || (isdigit((unsigned char)*last) && leads_on(words));
  return last;
}

/* A number whose key stands behind it: "4 kHz sampling rate, 1 kHz filter". What it is the rate or the time of may also
   be said there: of a filter, which is none of the rows. True: it is read; *behind moves on. */
static bool take_from_behind(struct eo_text_format *format, const struct eo_header_number *number, const char *end,
                             const char **behind)
{
  const char *unit = number->unit;
  char words[KEY];
  bool ended;
  double factor;
  enum eo_quantity quantity = eo_unit_find(unit, &factor);
  if (quantity != EO_QUANTITY_FREQUENCY && quantity != EO_QUANTITY_TIME)
    return false;
  const char *last = words_behind(*behind, end, words, &ended);
  if (!*words || !ended)
    return false;
  struct eo_stated stated = eo_stated_read(words, number->value, unit);
  if (!eo_stated_excludes(words) && stated.kind != EO_STATED_INTERVAL)
    return false;
  if (stated.kind == EO_STATED_INTERVAL) {
    use_thousands(format, words, number->at, end, unit);
    use_fact(format, &stated);
  }
  *behind = last;
  return true;
}

/* "decimated to 400 Hz", which is another rate. */
static bool take_thinned_rate(struct eo_text_format *format, const struct eo_header_number *number)
{
  char key[KEY];
  double factor;
  eo_header_trim(key, sizeof key, number->from, number->at);
  if (!eo_stated_thins(key) || !(number->value > 0) || eo_unit_find(number->unit, &factor) != EO_QUANTITY_FREQUENCY ||
      eo_stated_read(key, number->value, number->unit).kind == EO_STATED_INTERVAL)
    return false;
  struct eo_stated rate = {EO_STATED_INTERVAL, 1 / (number->value * factor), .member = -1, .number = -1};
  use_fact(format, &rate);
  return true;
}

/* Of how many samples a row was made, as the whole line says; all columns are meant. */
static void take_ratio(struct eo_text_format *format, const struct eo_header_line *line)
{
  char text[256];
  struct eo_stated stated = {.kind = EO_STATED_THINNED, .member = -1, .number = -1};
  eo_header_trim(text, sizeof text, line->start, line->end);
  stated.value = eo_stated_ratio(text, &stated.strength);
  if (stated.value > 1)
    use_fact(format, &stated);
}

/* A date or time in the line up to its end or the next cell; *after: behind it. */
static bool moment_at(const char *p, const char *end, struct eo_moment *moment, const char **after)
{
  const char *last = p;
  while (last < end && !strchr("\t;|\"", *last))
    last++;
  for (*after = last; last > p; last--) {
    size_t length = (size_t)(last - p);
    if (length < 64 && !strchr(" \t\r", last[-1]) && eo_moment_read(p, length, moment))
      return true;
    while (last > p && last[-1] != ' ' && last[-1] != ',' && last[-1] != '\t' && last[-1] != '\r')
      last--;
  }
  return false;
}

static void use_moment(struct eo_moment *begin, const char *from, const char *at, const struct eo_moment *moment)
{
  char key[KEY];
  eo_header_trim(key, sizeof key, from, at);
  if (!eo_stated_begin(key))
    return;
  if (moment->has_day && !begin->has_day)
    begin->has_day = true, begin->day = moment->day;
  if (moment->has_time && !begin->has_time)
    begin->has_time = true, begin->seconds = moment->seconds;
}

/* "Sampling rate: " */
static bool is_key_before(const char *from, const char *number)
{
  while (number > from && (number[-1] == ' ' || number[-1] == '\t'))
    number--;
  return number > from && (number[-1] == ':' || number[-1] == '=');
}

/* Where a number may begin: behind a mark, a sign that it multiplies, or the slash behind the number before. */
static bool begins_number(const char *start, const char *p, const char *before)
{
  bool digit = isdigit((unsigned char)*p) || ((*p == '-' || *p == '.') && isdigit((unsigned char)p[1]));
  for (int i = 1; digit && i < 3 && p - i >= start; i++)
    if (eo_header_times(p - i, p + 1) == (size_t)i)
      p -= i, i = 3;
  return digit && (p == start || strchr(MARKS, p[-1]) || (p - 1 == before && *before == '/'));
}

/* Behind "[10 us]" where that is the unit in a key, "Sampling interval [10 us]: 25"; else p. */
static const char *pass_unit(const char *p, const char *end)
{
  const char *close = *p == '['   ? memchr(p, ']', (size_t)(end - p))
                      : *p == '(' ? memchr(p, ')', (size_t)(end - p))
                                  : NULL;
  const char *mark = close ? close + 1 : p;
  while (close && mark < end && *mark == ' ')
    mark++;
  return close && mark < end && (*mark == ':' || *mark == '=') ? close : p;
}

/* Every number of a line with the words before and behind it. */
static void take_facts(struct eo_text_format *format, const struct eo_header_line *line, struct eo_moment *begin)
{
  struct eo_turns turns = {0};
  struct eo_header_number number = {.from = line->start};
  for (const char *p = line->start; p < line->end; p++) {
    struct eo_moment moment;
    const char *after;
    p = pass_unit(p, line->end);
    if (!begins_number(line->start, p, number.after))
      continue;
    if (moment_at(p, line->end, &moment, &after)) {
      use_moment(begin, number.from, p, &moment);
      number.from = p = after;
      continue;
    }
    number.at = p;
    number.from = number.from < p ? number.from : p; /* in a unit of several words */
    number.after = eo_header_number_at(format, p, line->end, is_key_before(number.from, p), &number.value);
    if (!number.after || number.after > line->end)
      continue;
    number.behind = eo_header_unit(number.after, line->end, number.unit, sizeof number.unit);
    p = number.after - 1;
    if (take_thinned_rate(format, &number) || take_from_behind(format, &number, line->end, &number.behind)) {
      number.from = number.behind;
      p = number.behind - 1;
      continue;
    }
    struct eo_stated stated = eo_turns_state(&turns, format, &number, line->end);
    if (!stated.kind || stated.kind == EO_STATED_THINNED) /* the whole line is read for it */
      continue;
    char key[KEY];
    eo_header_trim(key, sizeof key, number.from, number.at);
    use_thousands(format, key, number.at, line->end, number.unit);
    use_fact(format, &stated);
    number.from = number.behind;
  }
  eo_turns_end(&turns, format);
}

/* Names in one line and their numbers in the next: "..., Start, Increment" over "..., 0, 2.5e-4". */
static void take_below(struct eo_text_format *format, const struct eo_header_line *names,
                       const struct eo_header_line *values)
{
  struct eo_cell name, value;
  const char *at = names->start, *below = values->start;
  while (eo_text_next_cell(&at, names->end, format->separator, &name) &&
         eo_text_next_cell(&below, values->end, format->separator, &value)) {
    char key[KEY];
    double number;
    const char *end = value.length ? eo_header_number_at(format, value.text, value.text + value.length, true, &number)
                                   : NULL;
    eo_text_cell_copy(key, sizeof key, &name);
    if (end != value.text + value.length)
      continue;
    struct eo_stated stated = eo_stated_read(key, number, "");
    use_thousands(format, key, value.text, end, "");
    use_fact(format, &stated);
  }
}

/* "Delta_X  2.5E-4    3E-4": a key and a number for each column, in the places of the columns, or one cell to the right
   of them. */
static void take_for_columns(struct eo_text_format *format, const struct eo_header_line *line)
{
  struct eo_cell cell;
  char key[KEY];
  struct eo_stated stated[EO_TEXT_CELLS] = {0};
  int count = 0;
  const char *at = line->start;
  if (format->separator == ' ' || eo_text_is_named(format->separator) ||
      !eo_text_next_cell(&at, line->end, format->separator, &cell))
    return;
  int first = eo_header_cells(line, format->separator) == format->cells + 1 ? 0 : 1;
  eo_text_cell_copy(key, sizeof key, &cell);
  for (int c = first; c < format->cells && eo_text_next_cell(&at, line->end, format->separator, &cell); c++) {
    double number;
    if (!cell.length ||
        eo_header_number_at(format, cell.text, cell.text + cell.length, true, &number) != cell.text + cell.length)
      continue;
    stated[c] = eo_stated_read(key, number, "");
    count += stated[c].kind != EO_STATED_NOTHING;
  }
  for (int c = first; c < format->cells && count > 1; c++) {
    if (stated[c].kind == EO_STATED_INTERVAL)
      format->clock[c].interval = stated[c].value, format->clock[c].other = 0;
    if (stated[c].kind == EO_STATED_START)
      format->clock[c].start = stated[c].value;
    if (stated[c].kind == EO_STATED_TURN || stated[c].kind == EO_STATED_FOLD)
      eo_turns_set(format, c, &stated[c]);
  }
}

/* What is stated for one channel only holds for those of which nothing is said. */
static void fill_clocks(struct eo_text_format *format)
{
  double interval = 0;
  int told = -1;
  for (int c = 0; c < format->cells; c++) {
    interval = interval > 0 ? interval : format->clock[c].interval;
    told = told < 0 && eo_turns_known(format, c) ? c : told;
  }
  for (int c = 0; c < format->cells; c++) {
    if (!(format->clock[c].interval > 0))
      format->clock[c].interval = interval;
    if (told >= 0 && !eo_turns_known(format, c) && eo_stated_member(format->name[c]) < 0) {
      format->turn[c] = format->turn[told];
      format->lines[c] = format->lines[told];
      format->fold[c] = format->fold[told];
      format->edges[c] = format->edges[told];
    }
  }
}

static void skip_cells(const struct eo_text_format *format, struct eo_header_line *line)
{
  struct eo_cell cell;
  const char *at = line->start;
  for (int c = 0; c < format->cells && at; c++)
    if (!eo_text_next_cell(&at, line->end, format->separator, &cell))
      at = NULL;
  line->start = at ? at : line->end;
}

/* "5000 Hz" in every cell of a line, without a word, where nothing else tells the rate. */
static void take_bare_rates(struct eo_text_format *format, const struct eo_header_line *line)
{
  struct eo_cell cell;
  double interval[EO_TEXT_CELLS] = {0};
  int count = 0;
  const char *at = line->start;
  for (int c = 0; c < format->cells && eo_text_next_cell(&at, line->end, format->separator, &cell); c++) {
    char unit[32];
    double value, factor;
    const char *end = cell.text + cell.length,
               *after = cell.length ? eo_header_number_at(format, cell.text, end, true, &value) : NULL;
    if (!after || after > end || !(value > 0))
      return;
    eo_header_unit(after, end, unit, sizeof unit);
    if (eo_unit_find(unit, &factor) != EO_QUANTITY_FREQUENCY)
      return;
    interval[c] = 1 / (value * factor);
    count++;
  }
  for (int c = 0; c < format->cells && count == format->cells; c++)
    if (!(format->clock[c].interval > 0))
      format->clock[c].interval = interval[c];
}

void eo_header_facts(const struct eo_header *header, struct eo_text_format *format, int names)
{
  struct eo_moment begin = {0};
  for (int i = 0; i < header->lines; i++) {
    struct eo_header_line line = header->line[i];
    if (i == names) /* facts stand behind the names, as in "CH1,CH2,t0 = 0 s,tInc = 2.0E-4" */
      skip_cells(format, &line);
    take_facts(format, &line, &begin);
    take_ratio(format, &line);
    if (i + 1 < header->lines && format->separator != ' ' && !eo_text_is_named(format->separator))
      take_below(format, &header->line[i], &header->line[i + 1]);
  }
  for (int i = 0; i < header->lines; i++)
    take_for_columns(format, &header->line[i]);
  for (int i = 0; i < header->lines; i++)
    take_bare_rates(format, &header->line[i]);
  fill_clocks(format);
  for (int c = 0; c < format->cells; c++)
    eo_series_settle(&format->clock[c]);
  if (begin.has_day)
    for (int c = 0; c < format->cells; c++)
      format->clock[c].epoch = eo_moment_epoch(&begin);
}

void eo_header_late_fact(struct eo_text_format *format, struct eo_text_format *scratch, const char *start,
                         const char *end)
{
  const char *comment = eo_text_comment(start, end, format->separator);
  struct eo_header_line line = {comment ? comment : start, end};
  struct eo_moment begin = {0};
  struct eo_clock *told = &scratch->clock[0];
  *told = (struct eo_clock){.column = -1, .epoch = EO_CLOCK_NO_EPOCH};
  scratch->cells = 1;
  scratch->separator = format->separator;
  scratch->point = format->point;
  scratch->line_end = format->line_end;
  scratch->name[0][0] = scratch->unit[0][0] = '\0';
  take_facts(scratch, &line, &begin);
  take_ratio(scratch, &line);
  for (int c = 0; c < format->cells; c++) {
    struct eo_clock *clock = &format->clock[c];
    struct eo_stated rate = {EO_STATED_INTERVAL, told->interval, .member = -1, .number = -1},
                     ratio = {EO_STATED_THINNED, told->thinned, .member = -1, .number = -1};
    rate.strength = (enum eo_stated_strength)told->told;
    ratio.strength = (enum eo_stated_strength)told->thins;
    if (told->interval > 0)
      eo_series_tell(clock, &rate);
    if (told->thinned > 1 && !(clock->thinned > 1)) {
      eo_series_tell(clock, &ratio);
      eo_series_settle(clock);
    }
  }
}
