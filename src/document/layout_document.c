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
static const char *const member_key[2] = {"pinion", "gear"};

static int choice_of(const json_t *value, const char *const *choices, const char *pointer, struct eo_faults *faults)
{
  const char *text = json_string_value(value);
  if (!value)
    return 0;
  for (int i = 0; text && choices[i]; i++)
    if (strcmp(text, choices[i]) == 0)
      return i;
  eo_faults_add(faults, pointer, "\"%.40s\" is not known here; \"%s\", \"%s\", ... are.", text ? text : "(no text)",
                choices[0], choices[1]);
  return 0;
}

/* A name or a number as text in `room`; NULL when there is none. */
static const char *column_of(const json_t *value, char *room, const char *pointer, struct eo_faults *faults)
{
  if (!value || json_is_null(value))
    return NULL;
  if (json_is_integer(value) && json_integer_value(value) >= 1 && json_integer_value(value) <= EO_RECORDING_COLUMNS)
    snprintf(room, EO_RECORDING_NAME, "%d", (int)json_integer_value(value));
  else if (json_is_string(value) && json_string_length(value) > 0 && json_string_length(value) < EO_RECORDING_NAME)
    snprintf(room, EO_RECORDING_NAME, "%s", json_string_value(value));
  else {
    eo_faults_add(faults, pointer, "A column is given by its name or by its number from 1.");
    return NULL;
  }
  return room;
}

static void read_columns(const json_t *columns, struct eo_layout_request *request, struct eo_faults *faults)
{
  const char *key;
  json_t *value;
  if (columns && !json_is_object(columns))
    eo_faults_add(faults, "/columns", "The columns are an object with \"pinion\" and \"gear\".");
  json_object_foreach((json_t *)columns, key, value)
  {
    char pointer[120];
    int member = strcmp(key, member_key[0]) == 0 ? 0 : strcmp(key, member_key[1]) == 0 ? 1 : -1;
    snprintf(pointer, sizeof pointer, "/columns/%.80s", key);
    if (member < 0) {
      eo_faults_add(faults, pointer, "Unknown key in the columns.");
    } else if (json_is_array(value)) {
      if (json_array_size(value) != 2)
        eo_faults_add(faults, pointer, "Raw tracks are two columns, sine and cosine.");
      for (size_t k = 0; k < 2; k++)
        request->choice.column[member][k] = column_of(json_array_get(value, k), request->name[1 + 2 * member + (int)k],
                                                      pointer, faults);
    } else {
      request->choice.column[member][0] = column_of(value, request->name[1 + 2 * member], pointer, faults);
    }
  }
}

static double positive(const json_t *value, const char *pointer, struct eo_faults *faults)
{
  if (!value || json_is_null(value))
    return 0;
  if (json_is_number(value) && json_number_value(value) > 0 && json_number_value(value) < 1e12)
    return json_number_value(value);
  eo_faults_add(faults, pointer, "A positive number is wanted.");
  return 0;
}

static void read_lines(const json_t *lines, double target[2], struct eo_faults *faults)
{
  bool pair = json_is_array(lines) && json_array_size(lines) == 2;
  if (json_is_array(lines) && !pair)
    eo_faults_add(faults, "/lines", "Lines are one number or two, pinion and gear.");
  else
    for (size_t i = 0; i < 2; i++)
      target[i] = positive(pair ? json_array_get(lines, i) : lines, "/lines", faults);
}

/* The column of the times, or the pinion's and the gear's; their unit as a word or as seconds. */
static void read_time(const json_t *document, struct eo_layout_request *request, struct eo_faults *faults)
{
  static const double time_scale[] = {1, 1e-3, 1e-6, 1e-9, 60, 86400};
  const json_t *time = json_object_get(document, "time"), *unit = json_object_get(document, "time_unit");
  if (json_is_array(time) && json_array_size(time) != 2)
    eo_faults_add(faults, "/time", "Times are one column or two, the pinion's and the gear's.");
  else if (json_is_array(time)) {
    request->choice.time = column_of(json_array_get(time, 0), request->name[0], "/time", faults);
    request->choice.gear_time = column_of(json_array_get(time, 1), request->name[5], "/time", faults);
  } else
    request->choice.time = column_of(time, request->name[0], "/time", faults);
  if (json_is_number(unit))
    request->choice.time_scale = positive(unit, "/time_unit", faults);
  else if (unit)
    request->choice.time_scale = time_scale[choice_of(unit, times, "/time_unit", faults)];
}

/* What can be asked for. */
static const struct eo_outline_row asked_columns_rows[] = {
    EO_KEY("pinion", "any", "of the pinion", .when = "where it is chosen"),
    EO_KEY("gear", "any", "of the gear", .when = "where it is chosen"),
};
static const struct eo_outline asked_columns = EO_OUTLINE("AskedColumns", asked_columns_rows);

static const struct eo_outline_row asked_layout_rows[] = {
    EO_KEY("kind", "text", "of the recording", .when = "where it is chosen"),
    EO_KEY("unit", "text", "of the angles", .when = "where it is chosen"),
    EO_KEY("time", "any", "column of the time", .when = "where it is chosen"),
    EO_KEY("time_unit", "text", "of the time", .when = "where it is chosen"),
    EO_KEY("columns", "object", "of the channels", .when = "where it is chosen", .outline = &asked_columns),
    EO_KEY("sample_rate_Hz", "number?", "samples per second", .when = "where it is chosen"),
    EO_KEY("lines", "any", "of the encoders", .when = "where it is chosen"),
};
const struct eo_outline eo_asked_layout_outline = EO_OUTLINE("AskedLayout", asked_layout_rows);

static bool is_asked_key(const char *key)
{
  const struct eo_outline_row *row;
  for (int i = 0; (row = eo_outline_at(&eo_asked_layout_outline, i)); i++)
    if (strcmp(key, row->key) == 0)
      return true;
  return false;
}

void eo_layout_decode(const json_t *document, struct eo_layout_request *request, struct eo_faults *faults)
{
  const char *key;
  json_t *value;
  memset(request, 0, sizeof *request);
  if (!document || json_is_null(document))
    return;
  if (!json_is_object(document)) {
    eo_faults_add(faults, "", "A layout is a JSON object.");
    return;
  }
  json_object_foreach((json_t *)document, key, value)
  {
    char pointer[120];
    snprintf(pointer, sizeof pointer, "/%.80s", key);
    if (!is_asked_key(key))
      eo_faults_add(faults, pointer, "Unknown key in a layout.");
  }
  request->choice.kind = (enum eo_layout_kind)choice_of(json_object_get(document, "kind"), kinds, "/kind", faults);
  request->choice.unit = (enum eo_layout_unit)choice_of(json_object_get(document, "unit"), units, "/unit", faults);
  read_time(document, request, faults);
  request->choice.sample_rate = positive(json_object_get(document, "sample_rate_Hz"), "/sample_rate_Hz", faults);
  read_lines(json_object_get(document, "lines"), request->choice.lines, faults);
  read_columns(json_object_get(document, "columns"), request, faults);
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
  static const double time_scale[] = {1, 1e-3, 1e-6, 1e-9, 60, 86400};
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
