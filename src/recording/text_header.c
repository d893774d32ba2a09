/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names, units and what else a text file states before its first row. Lines of facts, names and units come in any order
   and number; names are the line that reads most like names. */
#include "recording/column.h"
#include "recording/letters.h"
#include "recording/moment.h"
#include "recording/stated.h"
#include "recording/text_cell.h"
#include "recording/text_facts.h"
#include "recording/text_format.h"
#include "recording/text_turns.h"
#include "recording/recorded_unit.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define TELLING_WORDS                                                                                          \
  "t|time|zeit|timestamp|pinion|gear|ritzel|rad|wheel|angle|winkel|phi|encoder|geber|channel|kanal|ch|ai|ctr|" \
  "torque|moment|drehmoment|speed|drehzahl|count|counts|value|x|y|sin|cos|input|output|antrieb|abtrieb"
#define UNIT_WORDS "unit|units|einheit|einheiten|sequence"

/* The separator that cuts the line into as many cells as a row has; headers do not always use that of the rows. A line
   with the rows' own separator may have more cells. 0: none does. */
static char header_separator(const struct eo_text_format *format, const struct eo_header_line *line)
{
  const char marks[] = {format->separator, '\t', ';', ',', '|'}, blanks[] = {' ', EO_TEXT_WIDE};
  for (size_t i = 0; i < sizeof marks; i++)
    if (eo_header_cells(line, marks[i]) == format->cells)
      return marks[i];
  if (format->cells > 1 && format->separator != ' ' && eo_header_cells(line, format->separator) > format->cells)
    return format->separator; /* before blanks, which names have inside */
  for (size_t i = 0; i < sizeof blanks; i++)
    if (eo_header_cells(line, blanks[i]) == format->cells)
      return blanks[i];
  return '\0';
}

static bool is_unit(const struct eo_cell *cell)
{
  char text[EO_RECORDING_UNIT];
  double factor;
  eo_text_cell_copy(text, sizeof text, cell);
  return cell->length < sizeof text && ((cell->length >= 2 && text[0] == '[') || !strcmp(text, "-") ||
                                        eo_unit_find(text, &factor) != EO_QUANTITY_NONE);
}

/* How much a line reads like units: all cells, or most, or all behind a word for units; 0 when it does not. */
static int units_score(const struct eo_header_line *line, char separator, int cells)
{
  struct eo_cell cell;
  int known = 0, filled = 0, first_known = 0;
  bool key = false;
  const char *at = line->start;
  for (int c = 0; c < cells && eo_text_next_cell(&at, line->end, separator, &cell); c++) {
    char text[EO_RECORDING_NAME];
    bool unit = cell.length && is_unit(&cell);
    eo_text_cell_copy(text, sizeof text, &cell);
    filled += cell.length > 0;
    known += unit;
    if (c == 0)
      first_known = unit, key = !unit && eo_column_named(text, UNIT_WORDS);
  }
  if (known && known == filled)
    return 3;
  if (known > 1 && key && known == filled - 1)
    return 2;
  return known > 1 && known >= filled - 1 && !first_known ? 1 : 0;
}

static int name_score(const struct eo_cell *cell, char point)
{
  char text[EO_RECORDING_NAME + EO_RECORDING_UNIT], name[EO_RECORDING_NAME], unit[EO_RECORDING_UNIT];
  double value, factor;
  if (!cell->length)
    return 0;
  if (eo_text_cell_value(cell, point, &value) != EO_CELL_TEXT || memchr(cell->text, '=', cell->length))
    return -2;
  eo_text_cell_copy(text, sizeof text, cell);
  eo_unit_split(text, name, (int)sizeof name, unit, (int)sizeof unit);
  bool known = *unit && eo_unit_find(unit, &factor) != EO_QUANTITY_NONE;
  return 1 + (known || eo_column_named(name, TELLING_WORDS) ? 2 : 0);
}

static bool same_text(const struct eo_cell *a, const struct eo_cell *b)
{
  return a->length && a->length == b->length && !memcmp(a->text, b->text, a->length);
}

/* How much a line reads like the names of the columns: not at all when all its cells are equal, and a cell like the one
   before ("X_Dimension Time Time") says nothing. */
static int names_score(const struct eo_header_line *line, char separator, int cells, char point)
{
  struct eo_cell cell, first = {0}, before = {0};
  int score = 0, filled = 0, equal = 0;
  const char *at = line->start;
  for (int c = 0; c < cells && eo_text_next_cell(&at, line->end, separator, &cell); c++) {
    if (!same_text(&cell, &before))
      score += name_score(&cell, point);
    before = cell;
    if (cell.length && !filled++)
      first = cell;
    equal += same_text(&cell, &first);
  }
  return filled > 1 && equal == filled ? 0 : score;
}

static void take_units(struct eo_text_format *format, const struct eo_header_line *line, char separator)
{
  struct eo_cell cell;
  const char *at = line->start;
  for (int c = 0; c < format->cells && eo_text_next_cell(&at, line->end, separator, &cell); c++) {
    char text[EO_RECORDING_UNIT + 2];
    double factor;
    eo_text_cell_copy(text, sizeof text, &cell);
    size_t length = strlen(text);
    bool bracketed = length >= 2 && text[0] == '[' && text[length - 1] == ']';
    if (!cell.length || (!bracketed && eo_unit_find_multiple(text, &factor) == EO_QUANTITY_NONE))
      continue;
    snprintf(format->unit[c], sizeof format->unit[c], "%.*s", (int)(bracketed ? length - 2 : length), text + bracketed);
  }
}

/* The unit without what stands beside it: "counts" of "counts, 18000000/rev", and of "[counts]" before "(9000/rev)". */
static void settle_unit(char name[EO_RECORDING_NAME], char unit[EO_RECORDING_UNIT])
{
  char first[EO_RECORDING_UNIT], shorter[EO_RECORDING_NAME];
  double factor;
  if (!*unit || eo_unit_find(unit, &factor) != EO_QUANTITY_NONE)
    return;
  snprintf(first, sizeof first, "%.*s", (int)strcspn(unit, ",;"), unit);
  snprintf(shorter, sizeof shorter, "%s", name);
  if (eo_unit_find(first, &factor) == EO_QUANTITY_NONE)
    eo_unit_split(name, shorter, (int)sizeof shorter, first, (int)sizeof first);
  if (eo_unit_find(first, &factor) != EO_QUANTITY_COUNT) /* "[V] (36 deg/V)" is for its reader to judge */
    return;
  memcpy(name, shorter, sizeof shorter);
  memcpy(unit, first, sizeof first);
}

static void take_names(struct eo_text_format *format, const struct eo_header_line *line, char separator)
{
  struct eo_cell cell;
  const char *at = line->start;
  for (int c = 0; c < format->cells && eo_text_next_cell(&at, line->end, separator, &cell); c++) {
    char label[EO_RECORDING_NAME + EO_RECORDING_UNIT], unit[EO_RECORDING_UNIT];
    eo_text_cell_copy(label, sizeof label, &cell);
    eo_turns_of_name(format, c, &cell);
    if (*format->unit[c])
      snprintf(format->name[c], sizeof format->name[c], "%.*s", (int)sizeof format->name[c] - 1, label);
    else {
      eo_unit_split(label, format->name[c], (int)sizeof format->name[c], unit, (int)sizeof unit);
      settle_unit(format->name[c], unit);
      memcpy(format->unit[c], unit, sizeof unit);
    }
  }
}

/* The lines of names and units; of equally good ones the last. */
static int find_names(const struct eo_text_format *format, const struct eo_header *header, int *units)
{
  int names = -1, best = 0, most = 0;
  *units = -1;
  for (int i = 0; i < header->lines; i++) {
    char separator = header_separator(format, &header->line[i]);
    int as_units = units_score(&header->line[i], separator ? separator : format->separator, format->cells);
    int as_names = separator ? names_score(&header->line[i], separator, format->cells, format->point) : 0;
    if (as_units == 2 || (separator && as_units == 3) || (as_units && i > 0 && names == i - 1)) {
      if (as_units >= most)
        most = as_units, *units = i;
    } else if (as_names > 0 && as_names >= best)
      best = as_names, names = i;
  }
  return names;
}

/* "Channel;pinion;gear" over rows of two cells: a cell more than the rows have, and the first says what the others are.
   Without it they stand in the places of the columns. */
static void drop_key(const struct eo_text_format *format, struct eo_header_line *line)
{
  static const char *const KEYS[] = {"channel", "channels", "channel name", "kanal",  "kanalname", "name",   "names",
                                     "signal",  "signals",  "label",        "labels", "unit",      "units",  "einheit",
                                     "voie",    "grandeur", "unite",        "canal",  "canale",    "unidad", "unita"};
  struct eo_cell cell;
  char text[EO_RECORDING_NAME];
  const char *at = line->start;
  if (format->separator == ' ' || eo_header_cells(line, format->separator) != format->cells + 1 ||
      !eo_text_next_cell(&at, line->end, format->separator, &cell) || !at)
    return;
  eo_text_cell_copy(text, sizeof text, &cell);
  text[strcspn(text, ":")] = '\0';
  for (size_t i = 0; i < sizeof KEYS / sizeof *KEYS; i++)
    if (!strcasecmp(text, KEYS[i]))
      line->start = at;
}

#define ARC_UNITS "dms|d:m:s|dd:mm:ss|ddd:mm:ss|deg:min:sec|degrees:minutes:seconds|gms|g:m:s"
#define ARC_WORDS EO_PINION_WORDS "|" EO_GEAR_WORDS "|angle|angles|winkel|angulo|angolo|position|deg|grad|dms"

/* What looks like a time of day is an angle where the heading gives it the unit of one; or calls it after an encoder
   while something else tells the time, since encoders have times of their pulses, too. */
static void settle_arcs(struct eo_text_format *format)
{
  double factor;
  bool timed = false;
  for (int c = 0; c < format->cells; c++)
    timed = timed || eo_text_is_called_time(format, c) || format->clock[c].interval > 0;
  for (int c = 0; c < format->cells; c++) {
    const char *unit = format->unit[c];
    bool stated = eo_unit_find(unit, &factor) == EO_QUANTITY_ANGLE || eo_letters_listed(unit, strlen(unit), ARC_UNITS),
         called = timed && !eo_text_is_called_time(format, c) && eo_column_named(format->name[c], ARC_WORDS);
    if (format->content[c] == EO_TEXT_MOMENT && (stated || called))
      format->content[c] = EO_TEXT_ARC;
    else if (format->content[c] == EO_TEXT_ARC && eo_text_is_called_time(format, c))
      format->content[c] = EO_TEXT_MOMENT; /* down to zero, or of more than 999 hours: not read */
  }
}

void eo_text_read_header(struct eo_text_format *format, const char *head)
{
  struct eo_header *header = malloc(sizeof *header);
  int units;
  for (int c = 0; c < format->cells; c++)
    format->clock[c] = (struct eo_clock){.column = -1, .epoch = EO_CLOCK_NO_EPOCH};
  if (!header)
    return;
  eo_header_split(header, format, head);
  for (int i = 0; i < header->lines; i++)
    drop_key(format, &header->line[i]);
  int names = find_names(format, header, &units);
  if (eo_text_is_named(format->separator)) /* they stand in the rows */
    names = units = -1;
  if (units >= 0) {
    char separator = header_separator(format, &header->line[units]);
    take_units(format, &header->line[units], separator ? separator : format->separator);
  }
  if (names >= 0)
    take_names(format, &header->line[names], header_separator(format, &header->line[names]));
  eo_header_facts(header, format, format->cells > 1 ? names : -1); /* a fact may stand in the place of one name */
  eo_turns_settle(format, head);
  settle_arcs(format);
  free(header);
}
