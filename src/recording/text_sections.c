/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/text_sections.h"
#include "base/decimal.h"
#include "recording/text_cell.h"

#include <math.h>
#include <string.h>

static bool is_text(const struct eo_cell *cell, const char *text)
{
  return cell->length == strlen(text) && !memcmp(cell->text, text, cell->length);
}

/* The first cell behind the key that is not empty holds the value of the first channel. */
static void take_value(struct eo_text_sections *sections, const struct eo_cell *key, const char *at, const char *end)
{
  struct eo_cell value = {0};
  struct eo_moment moment, *begin = &sections->begin[sections->sections > 1];
  double number = 0;
  while (!value.length && eo_text_next_cell(&at, end, sections->separator, &value))
    ;
  bool read = value.length && value.length < 64 && eo_moment_read(value.text, value.length, &moment);
  if (is_text(key, "Date") && read && moment.has_day)
    begin->day = moment.day, begin->has_day = true;
  else if (is_text(key, "Time") && read && moment.has_time)
    begin->seconds = moment.seconds, begin->has_time = true;
  else if (value.length && eo_decimal_read(value.text, sections->point, &number) && is_text(key, "X0"))
    sections->start[sections->sections > 1] = number;
  else if (value.length && is_text(key, "Delta_X"))
    sections->interval = number;
}

bool eo_text_sections_take(struct eo_text_sections *sections, const char *line, const char *end, int64_t rows)
{
  struct eo_cell key;
  const char *at = line;
  if (!eo_text_next_cell(&at, end, sections->separator, &key))
    return sections->inside;
  if (is_text(&key, "***End_of_Header***")) {
    sections->used = true;
    sections->named = sections->inside;
    sections->inside = false;
    return true;
  }
  if (is_text(&key, "Channels")) {
    sections->inside = true;
    sections->row = rows;
    sections->sections++;
    return true;
  }
  if (sections->inside)
    take_value(sections, &key, at, end);
  bool names = sections->named;
  sections->named = false;
  sections->first = sections->first || names;
  return sections->inside || names;
}

/* s from the beginning of the first section to that of the current one, by the times that they state. */
static double offset_of(const struct eo_text_sections *sections)
{
  const struct eo_moment *begin = sections->begin;
  if (sections->sections < 2 || !begin[0].has_time || !begin[1].has_time)
    return 0;
  return (double)(begin[1].day - begin[0].day) * EO_MOMENT_DAY + begin[1].seconds - begin[0].seconds;
}

/* s that lie between the sections where their rows have no times: what the headings state less what the rows take. 0
   where they follow each other, or where nothing is stated. */
static double gap_before(const struct eo_text_sections *sections)
{
  double passed = offset_of(sections) + (sections->start[1] - sections->start[0]),
         taken = (double)sections->row * sections->interval;
  return sections->sections > 1 && sections->interval > 0 && passed != 0 &&
                 fabs(passed - taken) > 0.5 * sections->interval
             ? passed - taken
             : 0;
}

void eo_text_sections_find(struct eo_text_sections *sections, const struct eo_text_format *format, const char *head)
{
  const char *at = head + format->header_byte, *last = head + format->first_byte;
  sections->separator = format->separator;
  sections->point = format->point;
  while (at < last) {
    const char *end = memchr(at, format->line_end, (size_t)(last - at));
    end = end ? end : last;
    eo_text_sections_take(sections, at, end, 0);
    at = end + 1;
  }
  for (int c = 0; c < format->cells; c++)
    if (eo_text_is_column(format, c))
      sections->x[sections->columns++] = !strcmp(format->name[c], "X_Value");
}

enum eo_code eo_text_sections_place(struct eo_text_sections *sections, double *row, int64_t line,
                                    struct eo_error *error)
{
  bool timed = false;
  for (int c = 0; c < sections->columns; c++) {
    if (!sections->x[c])
      continue;
    timed = true;
    if (sections->first)
      sections->x_shift[c] = row[c] <= sections->x_last[c] ? offset_of(sections) : 0;
    row[c] += sections->x_shift[c];
    sections->x_last[c] = row[c];
  }
  double gap = sections->first && !timed ? gap_before(sections) : 0;
  sections->first = false;
  if (gap == 0)
    return EO_OK;
  return eo_error_set(error, EO_ERROR_INPUT, "",
                      "The section of the .lvm file whose rows begin in line %lld starts %.4g s %s the one before it "
                      "ends, and its rows have no times: save it with X columns, or one section alone.",
                      (long long)line, fabs(gap), gap > 0 ? "after" : "before");
}
