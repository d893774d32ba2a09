/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/layout_document.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "format/json.h"
#include "document/result_private.h"

static const char *const kinds[] = {"guess", "angles", "sine-cosine", "pulses", NULL};
static const char *const units[] = {"guess", "deg", "rad", "turn", "count", NULL};
static const char *const times[] = {"s", "ms", "us", "ns", "min", "d", NULL};
static const double time_scale[] = {1, 1e-3, 1e-6, 1e-9, 60, 86400}; /* s, of each of times */

static const struct eo_field column_fields[] = {
    EO_NAMES(struct eo_layout_request, column[EO_PINION], "pinion", EO_RECORDING_COLUMNS, "guessed",
             "column of the pinion's encoder by its name or its number from 1; raw tracks: sine and cosine"),
    EO_NAMES(struct eo_layout_request, column[EO_GEAR], "gear", EO_RECORDING_COLUMNS, "guessed",
             "the same of the gear's encoder"),
};
static const struct eo_table column_table = EO_TABLE("the columns", struct eo_layout_request, column_fields);

static const struct eo_field asked_fields[] = {
    EO_CHOICE(struct eo_layout_request, choice.kind, "kind", kinds, EO_LAYOUT_GUESS_KIND, "what the columns hold"),
    EO_CHOICE(struct eo_layout_request, choice.unit, "unit", units, EO_LAYOUT_GUESS_UNIT, "of the angles"),
    EO_NAMES(struct eo_layout_request, time, "time", EO_RECORDING_COLUMNS, "guessed",
             "column of the times, the pinion's and the gear's where each has its own; none: no column holds them"),
    EO_NUMBER_WORDED(struct eo_layout_request, choice.time_scale, "time_unit", NULL, 1e-15, 1e12, times, time_scale,
                     "guessed", "of the times, a word or seconds"),
    EO_NUMBER_DERIVED(struct eo_layout_request, choice.sample_rate, "sample_rate_Hz", &eo_unit_Hz, 1e-9, 1e12,
                      "guessed", "rows per second, where no column holds the time"),
    EO_NUMBERS(struct eo_layout_request, choice.lines, "lines", 2, NULL, 1e-9, 1e12, EO_FIELD_NULLABLE | EO_FIELD_ALONE,
               NULL, "guessed",
               "counts, sine periods or pulses per turn of both encoders, or of the pinion's and the gear's"),
    EO_GROUP("columns", &column_table, "where each encoder is"),
};
const struct eo_table eo_asked_layout_table = EO_TABLE("a layout", struct eo_layout_request, asked_fields);

static const char *name_of(const char *name)
{
  return *name ? name : NULL;
}

static double stated(double number)
{
  return isnan(number) ? 0 : number;
}

void eo_layout_decode(const json_t *document, struct eo_layout_request *request, struct eo_faults *faults)
{
  struct eo_layout_choice *choice = &request->choice;
  memset(request, 0, sizeof *request);
  if (!document || json_is_null(document))
    return;
  eo_table_decode(&eo_asked_layout_table, document, NULL, request, faults);
  choice->time = name_of(request->time[EO_PINION]);
  choice->gear_time = name_of(request->time[EO_GEAR]);
  choice->time_scale = stated(choice->time_scale);
  choice->sample_rate = stated(choice->sample_rate);
  for (int i = 0; i < 2; i++) {
    choice->lines[i] = stated(choice->lines[i]);
    for (int k = 0; k < 2; k++)
      choice->column[i][k] = name_of(request->column[i][k]);
  }
}

static enum eo_layout_unit unit_of(const struct eo_track_channel *channel)
{
  return fabs(channel->scale - 1) < 1e-12                ? EO_LAYOUT_RADIAN
         : fabs(channel->scale * 180 / M_PI - 1) < 1e-12 ? EO_LAYOUT_DEGREE
         : fabs(channel->scale / (2 * M_PI) - 1) < 1e-12 ? EO_LAYOUT_TURN
                                                         : EO_LAYOUT_COUNT;
}

static json_t *encode_column(const struct eo_track_source *source, enum eo_track track)
{
  if (track != EO_TRACK_SINE_COSINE)
    return json_integer(source->column[0] + 1);
  return json_pack("[i, i]", source->column[0] + 1, source->column[1] + 1);
}

static const char *const no_time[] = {"none", NULL};

/* A layout as it is written. */
struct layout {
  int kind, unit, time_unit;
  bool angles, timed, with_unit, even, with_lines;
  json_t *time, *sample_rate; /* sample_rate: whole, as it is read again */
  json_t *column[2];
  struct eo_series lines;
};

#define OF_LAYOUT(member) EO_AT(struct layout, member)
#define WHERE(flag) EO_IF(struct layout, flag)
static const struct eo_outline_row column_rows[] = {
    EO_KEY("pinion", "integer|[integer]", "of the pinion's encoder: a number from 1, or sine and cosine",
           OF_LAYOUT(column[0])),
    EO_KEY("gear", "integer|[integer]", "of the gear's encoder, likewise", OF_LAYOUT(column[1])),
};
static const struct eo_outline column_outline = EO_OUTLINE("LayoutColumns", column_rows);

static json_t *write_columns(const void *source)
{
  return eo_outline_encode(&column_outline, source);
}

static const struct eo_outline_row layout_rows[] = {
    EO_KEY("kind", "word", "what the columns hold", .words = kinds + 1, OF_LAYOUT(kind)),
    EO_KEY("unit", "word", "of the angles", .when = "of angles and counts", .words = units + 1, OF_LAYOUT(unit),
           WHERE(angles)),
    EO_KEY("time", "integer|word|[integer]", "column of the time, from 1, or none; the pinion's and the gear's",
           .when = "but of pulses", .words = no_time, OF_LAYOUT(time), WHERE(timed)),
    EO_KEY("time_unit", "word", "of the time", .when = "where it is one of these", .words = times, OF_LAYOUT(time_unit),
           WHERE(with_unit)),
    EO_KEY("sample_rate_Hz", "number", "rows per second", .unit = &eo_unit_Hz, .when = "without a column of the time",
           OF_LAYOUT(sample_rate), WHERE(even)),
    EO_KEY("columns", "object", "where each encoder is", .outline = &column_outline, .write = write_columns),
    EO_KEY("lines", "[number]", "per turn of the pinion's and the gear's encoder", .when = "but of angles",
           OF_LAYOUT(lines), WHERE(with_lines)),
};
const struct eo_outline eo_layout_outline = EO_OUTLINE("Layout", layout_rows);

static json_t *encode_time(const struct eo_track_source source[2])
{
  bool one = source[0].time == source[1].time || source[0].time < 0 || source[1].time < 0;
  return source[0].time < 0 ? json_string(no_time[0])
         : one              ? json_integer(source[0].time + 1)
                            : json_pack("[i, i]", source[0].time + 1, source[1].time + 1);
}

json_t *eo_layout_encode(const struct eo_tracks *tracks)
{
  const struct eo_track_channel *channel = tracks->channel;
  const struct eo_track_source *source = tracks->source;
  bool angles = channel[0].track == EO_TRACK_ANGLE;
  enum eo_layout_unit unit = unit_of(&channel[0]);
  double lines[2] = {angles ? 2 * M_PI / channel[0].scale : channel[0].lines,
                     angles ? 2 * M_PI / channel[1].scale : channel[1].lines};
  struct layout layout = {.kind = (int)channel[0].track,
                          .unit = (int)unit - EO_LAYOUT_DEGREE,
                          .angles = angles,
                          .timed = channel[0].track != EO_TRACK_PULSES,
                          .even = source[0].time < 0 && tracks->interval > 0,
                          .with_lines = !angles || unit == EO_LAYOUT_COUNT,
                          .time = encode_time(source),
                          .sample_rate = eo_json_real(1 / tracks->interval, NULL),
                          .lines = eo_series_of(2, lines, EO_DIGITS_NUMBER)};
  for (int i = 0; times[i]; i++)
    if (fabs(source[0].time_scale / time_scale[i] - 1) < 1e-9) {
      layout.time_unit = i;
      layout.with_unit = true;
    }
  for (int i = 0; i < 2; i++)
    layout.column[i] = encode_column(&source[i], channel[i].track);
  return eo_outline_encode(&eo_layout_outline, &layout);
}
