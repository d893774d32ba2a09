/* Names, units and the sampling rate that a text file states before its first row. */
#include "recording/decimal.h"
#include "recording/text_cell.h"
#include "recording/text_format.h"
#include "recording/unit.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

#define LOOK_BACK 8 /* lines before the first row that may hold names and units */

/* A line of the header without the mark of a comment. */
struct header_line {
  const char *start, *end;
};

/* The last lines of the header that hold anything, the very last one first. */
static int last_lines(const struct eo_text_format *f, const char *head, struct header_line *line)
{
  int count = 0;
  const char *first = head + f->header_byte, *end = head + f->first_byte;
  while (end > first && count < LOOK_BACK) {
    end--; /* the line's end */
    const char *start = end;
    while (start > first && start[-1] != f->line_end)
      start--;
    const char *comment = eo_text_comment(start, end, f->separator);
    line[count] = (struct header_line){comment ? comment : start, end};
    if (!eo_text_empty(line[count].start, end))
      count++;
    end = start;
  }
  return count;
}

static void copy_cell(char *to, size_t size, const struct eo_cell *cell)
{
  snprintf(to, size, "%.*s", (int)(cell->length < size ? cell->length : size - 1), cell->text);
}

static int count_cells(const struct header_line *line, char separator)
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

/* The separator that cuts the line into as many cells as a row has; headers do not always use that of the rows. 0: none
   does. */
static char header_separator(const struct eo_text_format *f, const struct header_line *line)
{
  const char separators[] = {f->separator, '\t', ';', ',', ' '};
  for (size_t i = 0; i < sizeof separators; i++)
    if (count_cells(line, separators[i]) == f->cells)
      return separators[i];
  return '\0';
}

static bool is_units(const struct header_line *line, char separator)
{
  struct eo_cell cell;
  int known = 0;
  char text[EO_RECORDING_UNIT];
  double factor;
  for (const char *at = line->start; eo_text_next_cell(&at, line->end, separator, &cell);) {
    copy_cell(text, sizeof text, &cell);
    bool bracketed = cell.length >= 2 && text[0] == '[';
    if (cell.length >= sizeof text || (cell.length && !bracketed && strcmp(text, "-") && !eo_unit_find(text, &factor)))
      return false;
    known += cell.length > 0;
  }
  return known > 0;
}

static void take_units(struct eo_text_format *f, const struct header_line *line, char separator)
{
  struct eo_cell cell;
  const char *at = line->start;
  for (int c = 0; c < f->cells && eo_text_next_cell(&at, line->end, separator, &cell); c++) {
    if (cell.length >= 2 && cell.text[0] == '[' && cell.text[cell.length - 1] == ']')
      cell.text++, cell.length -= 2;
    copy_cell(f->unit[c], sizeof f->unit[c], &cell);
  }
}

static void take_names(struct eo_text_format *f, const struct header_line *line, char separator)
{
  struct eo_cell cell;
  const char *at = line->start;
  for (int c = 0; c < f->cells && eo_text_next_cell(&at, line->end, separator, &cell); c++) {
    char label[EO_RECORDING_NAME + EO_RECORDING_UNIT], unit[EO_RECORDING_UNIT];
    copy_cell(label, sizeof label, &cell);
    if (*f->unit[c])
      snprintf(f->name[c], sizeof f->name[c], "%.*s", (int)sizeof f->name[c] - 1, label);
    else {
      eo_unit_split(label, f->name[c], (int)sizeof f->name[c], unit, (int)sizeof unit);
      memcpy(f->unit[c], unit, sizeof unit);
    }
  }
}

/* Hertz or the like behind a number, as a factor. */
static double frequency_factor(const char *p, const char *end)
{
  while (p < end && (eo_text_blank(*p) || *p == '[' || *p == '(' || *p == ';' || *p == ','))
    p++;
  size_t left = (size_t)(end - p);
  if (left >= 3 && (!strncasecmp(p, "khz", 3) || !strncasecmp(p, "ks/", 3)))
    return 1e3;
  return left >= 3 && (!strncmp(p, "MHz", 3) || !strncmp(p, "MS/", 3)) ? 1e6 : 1;
}

/* A number behind a key such as "Sample rate:" or "fs="; 0 when the line has no such key. */
static double value_behind(const char *line, const char *end, const char *key, char point, const char **after)
{
  size_t length = strlen(key);
  for (const char *p = line; p + length < end; p++) {
    if (strncasecmp(p, key, length) || (p > line && (p[-1] | 0x20) >= 'a' && (p[-1] | 0x20) <= 'z'))
      continue;
    p += length;
    while (p < end && strchr(" \t:=;,\"[](){}/", *p) && *p)
      p++;
    if (end - p >= 2 && !strncasecmp(p, "hz", 2)) /* "rate [Hz]: 20000" */
      for (p += 2; p < end && strchr(" \t:=;,\"])", *p) && *p;)
        p++;
    double value;
    *after = eo_decimal_read(p, point, &value);
    return *after && *after <= end && value > 0 ? value : 0;
  }
  return 0;
}

static void find_interval(struct eo_text_format *f, const char *head)
{
  static const char *const rates[] = {
      "sample rate",        "sampling rate",    "samplerate", "sample_rate",    "sampling_rate",
      "sampling frequency", "sample frequency", "abtastrate", "abtastfrequenz", "fs"};
  static const char *const intervals[] = {"delta_x",           "delta t",         "sample interval",
                                          "sampling interval", "abtastintervall", "dt"};
  const char *last = head + f->first_byte, *after;
  for (const char *line = head + f->header_byte; line < last && f->interval <= 0;) {
    const char *end = memchr(line, f->line_end, (size_t)(last - line));
    end = end ? end : last;
    for (size_t i = 0; i < sizeof rates / sizeof *rates && f->interval <= 0; i++) {
      double rate = value_behind(line, end, rates[i], f->point, &after);
      f->interval = rate > 0 ? 1 / (rate * frequency_factor(after, end)) : 0;
    }
    for (size_t i = 0; i < sizeof intervals / sizeof *intervals && f->interval <= 0; i++)
      f->interval = value_behind(line, end, intervals[i], f->point, &after);
    line = end + 1;
  }
}

void eo_text_read_header(struct eo_text_format *format, const char *head)
{
  struct header_line line[LOOK_BACK];
  int count = last_lines(format, head, line);
  bool units = false;
  for (int i = 0; i < count; i++) {
    char separator = header_separator(format, &line[i]);
    if (!separator)
      continue;
    if (!units && is_units(&line[i], separator)) {
      take_units(format, &line[i], separator);
      units = true;
      continue;
    }
    take_names(format, &line[i], separator);
    break;
  }
  find_interval(format, head);
}
