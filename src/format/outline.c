/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "format/outline.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "format/json.h"
#include "format/object.h"
#include "format/schema.h"

static bool may_be_null(const struct eo_outline_row *row)
{
  return row->shape[strlen(row->shape) - 1] == '?';
}

static json_t *encode_number(const struct eo_outline_row *row, double value)
{
  if (strncmp(row->shape, "integer", 7) != 0)
    return eo_json_quantity(value, row->unit);
  return isnan(value) ? json_null() : json_integer((json_int_t)value);
}

static json_t *encode_integer(const struct eo_outline_row *row, int value)
{
  if (!row->words)
    return json_integer(value);
  return value < 0 ? json_null() : json_string(row->words[value]);
}

static json_t *encode_text(const struct eo_outline_row *row, const char *value)
{
  return !*value && may_be_null(row) ? json_null() : json_string(value);
}

static json_t *encode_part(const struct eo_outline_row *row, const void *part)
{
  return row->outline ? eo_outline_encode(row->outline, part) : eo_table_encode(row->table, part);
}

static json_t *encode_rows(const struct eo_outline_row *row, const void *source)
{
  struct eo_object list = eo_list_open();
  const char *part = *(const char *const *)((const char *)source + row->offset);
  int count = *(const int *)((const char *)source + row->count_offset);
  for (int i = 0; i < count; i++)
    eo_list_add(&list, encode_part(row, part + (size_t)i * row->stride));
  return eo_object_close(&list);
}

struct eo_series eo_series_of(int count, const double *value, int digits)
{
  return (struct eo_series){.value = value, .count = count, .scale = 1, .digits = digits};
}

static json_t *encode_line(const struct eo_series *series, const double *value, const struct eo_unit *unit)
{
  int n = series->count;
  double *number = malloc(sizeof *number * (size_t)(n ? n : 1));
  for (int i = 0, from = n ? (n - series->lag) % n : 0; i < n && number; i++, from = from + 1 < n ? from + 1 : 0)
    number[i] = value[from] * series->scale;
  json_t *line = number ? eo_json_reals(n, number, 1, unit, series->digits) : NULL;
  free(number);
  return line;
}

static json_t *encode_series(const struct eo_outline_row *row, const struct eo_series *series)
{
  if (!series->value)
    return json_null();
  if (!series->rows)
    return encode_line(series, series->value, row->unit);
  struct eo_object list = eo_list_open();
  for (int i = 0; i < series->rows; i++)
    eo_list_add(&list, encode_line(series, series->value + (size_t)i * (size_t)series->count, row->unit));
  return eo_object_close(&list);
}

/* The value at its place in what the row is about. */
static json_t *encode_at(const struct eo_outline_row *row, const void *source, const void *place)
{
  switch (row->member) {
  case EO_MEMBER_NONE:
    return row->write ? row->write(source) : NULL;
  case EO_MEMBER_NUMBER:
    return encode_number(row, !row->known || row->known(source) ? *(const double *)place : NAN);
  case EO_MEMBER_INTEGER:
    return encode_integer(row, *(const int *)place);
  case EO_MEMBER_LONG:
    return json_integer((json_int_t) * (const int64_t *)place);
  case EO_MEMBER_FLAG:
    return json_boolean(*(const bool *)place);
  case EO_MEMBER_TEXT:
    return encode_text(row, place);
  case EO_MEMBER_STRING:
    return encode_text(row, *(const char *const *)place);
  case EO_MEMBER_PART:
    return encode_part(row, place);
  case EO_MEMBER_SERIES:
    return encode_series(row, place);
  case EO_MEMBER_JSON:
    return *(json_t *const *)place;
  case EO_MEMBER_ROWS:
    return encode_rows(row, source);
  }
  return NULL;
}

/* source: of which rows are at an offset, as many as it says */
static json_t *encode_column(const struct eo_outline_row *row, const void *source)
{
  struct eo_object list = eo_list_open();
  const char *first = *(const char *const *)((const char *)source + row->offset);
  int count = *(const int *)((const char *)source + row->count_offset);
  for (int i = 0; i < count; i++) {
    const char *each = first + (size_t)i * row->stride;
    eo_list_add(&list, encode_at(row, each, each + row->column_offset));
  }
  return eo_object_close(&list);
}

static json_t *encode(const struct eo_outline_row *row, const void *source)
{
  return row->column ? encode_column(row, source) : encode_at(row, source, (const char *)source + row->offset);
}

/* Whether the member says something; EO_FILLED names what that is. */
static bool is_filled(const struct eo_outline_row *row, const void *source)
{
  const void *place = (const char *)source + row->offset;
  switch (row->member) {
  case EO_MEMBER_INTEGER:
    return *(const int *)place != 0;
  case EO_MEMBER_TEXT:
    return *(const char *)place != '\0';
  case EO_MEMBER_STRING:
    return *(const char *const *)place && **(const char *const *)place;
  case EO_MEMBER_ROWS:
    return *(const int *)((const char *)source + row->count_offset) != 0;
  default:
    return true;
  }
}

static bool is_there(const struct eo_outline_row *row, const void *source)
{
  if (row->filled && !is_filled(row, source))
    return false;
  if (row->optional && !*(const bool *)((const char *)source + row->option_offset))
    return false;
  return !row->there || row->there(source);
}

void eo_outline_put(struct eo_object *object, const struct eo_outline *outline, const void *source)
{
  for (int i = 0; i < outline->count; i++) {
    const struct eo_outline_row *row = &outline->row[i];
    if (!row->key)
      eo_outline_put(object, row->outline, (const char *)source + row->offset);
    else if (is_there(row, source))
      eo_object_put(object, row->key, encode(row, source));
    else {
      object->failed = object->failed || !row->when;
      if (row->member == EO_MEMBER_JSON)
        json_decref(encode(row, source));
    }
  }
}

json_t *eo_outline_encode(const struct eo_outline *outline, const void *source)
{
  struct eo_object object = eo_object_open();
  eo_outline_put(&object, outline, source);
  return eo_object_close(&object);
}

static json_t *take_each(const struct eo_outline *outline, const json_t *array)
{
  struct eo_object list = eo_list_open();
  json_t *member;
  size_t i;
  json_array_foreach((json_t *)array, i, member) eo_list_add(&list, eo_outline_take(outline, member));
  return eo_object_close(&list);
}

json_t *eo_outline_take(const struct eo_outline *outline, const json_t *document)
{
  struct eo_object object = eo_object_open();
  const struct eo_outline_row *row;
  for (int i = 0; (row = eo_outline_at(outline, i)); i++) {
    json_t *value = json_object_get(document, row->key);
    if (row->outline && json_is_array(value))
      eo_object_put(&object, row->key, take_each(row->outline, value));
    else if (value)
      eo_object_put(&object, row->key,
                    row->outline && json_is_object(value) ? eo_outline_take(row->outline, value) : json_incref(value));
    else
      object.failed = object.failed || !row->when;
  }
  return eo_object_close(&object);
}
