/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/text_values.h"
#include "recording/moment.h"
#include "recording/recorded_unit.h"

#include <math.h>

/* A number with a unit behind it, in the unit of the column's first one. */
static enum eo_cell_kind unit_value(const struct eo_text_format *format, const struct eo_cell *cell, int c,
                                    double *value)
{
  char unit[EO_RECORDING_UNIT];
  double own, first;
  enum eo_cell_kind kind = eo_text_cell_value(cell, format->point, value);
  if (kind != EO_CELL_UNIT)
    return kind;
  eo_text_cell_unit(cell, format->point, unit, (int)sizeof unit);
  if (eo_unit_find(unit, &own) != eo_unit_find(format->unit[c], &first))
    return EO_CELL_TEXT;
  *value *= own / first;
  return EO_CELL_NUMBER;
}

/* Seconds from the beginning of the first row's day. A time of day without a date goes on over midnight. */
static enum eo_cell_kind moment_value(struct eo_text_format *format, struct eo_text_moments *moments,
                                      const struct eo_cell *cells, int c, double *value)
{
  const struct eo_cell *cell = &cells[c], *date = format->date[c] < 0 ? NULL : &cells[format->date[c]];
  struct eo_moment moment, day;
  if (!cell->length || !eo_moment_read(cell->text, cell->length, &moment))
    return eo_text_cell_value(cell, format->point, value) == EO_CELL_MISSING ? EO_CELL_MISSING : EO_CELL_TEXT;
  if (date && eo_moment_read(date->text, date->length, &day) && day.has_day)
    moment.has_day = true, moment.day = day.day;
  if (!moments->based[c]) {
    struct eo_clock clock = {.column = -1, .epoch = EO_CLOCK_NO_EPOCH};
    moments->day[c] = moment.day;
    if (moment.has_day)
      clock.epoch = moment.day * 86400000000000LL;
    format->clock[c] = clock;
  }
  *value = (double)(moment.day - moments->day[c]) * EO_MOMENT_DAY + moment.seconds;
  if (moments->based[c] && !moment.has_day) {
    double turn = moment.minutes ? 3600 : EO_MOMENT_DAY;
    *value = moment.seconds + (double)moments->day[c] * turn; /* whole days, or hours, passed so far */
    if (*value < moments->before[c] - turn / 2) {
      *value += turn;
      moments->day[c]++;
    }
  }
  moments->based[c] = true;
  moments->before[c] = *value;
  return EO_CELL_NUMBER;
}

enum eo_cell_kind eo_text_value(struct eo_text_format *format, struct eo_text_moments *moments,
                                const struct eo_cell *cells, int c, double *value)
{
  *value = NAN;
  if (format->content[c] == EO_TEXT_MOMENT)
    return moment_value(format, moments, cells, c, value);
  if (format->content[c] == EO_TEXT_UNIT)
    return unit_value(format, &cells[c], c, value);
  if (format->content[c] == EO_TEXT_ARC && eo_text_cell_sexagesimal(&cells[c], format->point, true, value))
    return EO_CELL_NUMBER;
  if (format->content[c] == EO_TEXT_LEVEL && eo_text_cell_level(&cells[c], value))
    return EO_CELL_NUMBER;
  if (format->content[c] == EO_TEXT_HEX && eo_text_cell_hex(&cells[c], value))
    return EO_CELL_NUMBER;
  enum eo_cell_kind kind = eo_text_cell_value(&cells[c], format->point, value);
  bool number = kind == EO_CELL_NUMBER || kind == EO_CELL_GROUPED;
  if (!number)
    *value = NAN;
  return number || kind == EO_CELL_MISSING ? kind : EO_CELL_TEXT;
}
