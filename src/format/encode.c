/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "format/json.h"
#include "format/object.h"
#include "format/table.h"

static const void *member(const void *source, const struct eo_field *field)
{
  return (const char *)source + field->offset;
}

static json_t *encode_numbers(const struct eo_field *field, const double *value)
{
  bool all_null = field->flags & EO_FIELD_NULLABLE;
  for (int i = 0; i < field->count; i++)
    all_null = all_null && isnan(value[i]);
  return all_null ? json_null() : eo_json_reals(field->count, value, 1, field->unit, 0);
}

static json_t *encode_list(const struct eo_field *field, const void *source)
{
  json_t *array = json_array();
  int count = *(const int *)((const char *)source + field->count_offset);
  const char *row = member(source, field);
  for (int i = 0; i < count && array; i++)
    if (json_array_append_new(array, eo_table_encode(field->table, row + (size_t)i * field->table->size)) != 0) {
      json_decref(array);
      array = NULL;
    }
  return array;
}

static json_t *encode_integer(const struct eo_field *field, int value)
{
  return value == 0 && field->flags & EO_FIELD_NULLABLE ? json_null() : json_integer(value);
}

static json_t *encode_matrix(const struct eo_field *field, const struct eo_matrix *matrix)
{
  json_t *rows = json_array();
  for (int i = 0; i < matrix->rows && rows; i++)
    if (json_array_append_new(rows, eo_json_reals(matrix->columns, matrix->value + (size_t)i * (size_t)matrix->columns,
                                                  1, field->unit, 0)) != 0) {
      json_decref(rows);
      rows = NULL;
    }
  return rows;
}

/* What is not stated is null; nothing: null in place of them all. */
static json_t *encode_names(const struct eo_field *field, const char *name)
{
  struct eo_object list = eo_list_open();
  bool stated = false;
  for (int i = 0; i < field->count; i++, name += field->room) {
    eo_list_add(&list, *name ? json_string(name) : json_null());
    stated = stated || *name;
  }
  json_t *names = eo_object_close(&list);
  if (stated)
    return names;
  json_decref(names);
  return json_null();
}

static json_t *encode_field(const struct eo_field *field, const void *source)
{
  const void *place = member(source, field);
  const struct eo_numbers *series = place;
  switch (field->kind) {
  case EO_FIELD_NUMBER:
    return eo_json_real(*(const double *)place, field->unit);
  case EO_FIELD_INTEGER:
    return encode_integer(field, *(const int *)place);
  case EO_FIELD_SEED:
    return json_integer((json_int_t) * (const uint64_t *)place);
  case EO_FIELD_FLAG:
    return json_boolean(*(const bool *)place);
  case EO_FIELD_TEXT:
    return *(const char *)place || !(field->flags & EO_FIELD_NULLABLE) ? json_string(place) : json_null();
  case EO_FIELD_CHOICE:
    return json_string(field->choices[*(const int *)place]);
  case EO_FIELD_NUMBERS:
    return encode_numbers(field, place);
  case EO_FIELD_OBJECT:
    if (field->flags & EO_FIELD_NULLABLE && !*(const int *)((const char *)source + field->count_offset))
      return json_null();
    return eo_table_encode(field->table, place);
  case EO_FIELD_LIST:
    return encode_list(field, source);
  case EO_FIELD_SERIES:
    return eo_json_reals(series->count, series->value, 1, field->unit, 0);
  case EO_FIELD_MATRIX:
    return encode_matrix(field, place);
  case EO_FIELD_DOCUMENT:
    return *(json_t *const *)place ? json_incref(*(json_t *const *)place) : json_null();
  case EO_FIELD_NAMES:
    return encode_names(field, place);
  }
  return NULL;
}

/* An object that is not what its table's defaults give, as far as bytes or else the documents of both can tell; NULL:
   it may be left out. Without memory nobody knows: *failed, since with it or without it the document has another hash.
 */
static json_t *encode_unless_default(const struct eo_table *owner, const struct eo_field *field, const void *source,
                                     bool *failed)
{
  const struct eo_table *table = field->table;
  /* a table may stand for more than the part at its field, as those of a flank do: not all its bytes are here */
  bool here = field->offset + table->size <= owner->size;
  void *defaults = calloc(1, table->size);
  json_t *value = NULL, *other = NULL;
  *failed = *failed || !defaults;
  if (defaults)
    eo_table_defaults(table, defaults);
  if (defaults && !(here && memcmp(member(source, field), defaults, table->size) == 0)) {
    value = encode_field(field, source);
    other = eo_table_encode(table, defaults);
    *failed = *failed || !value || !other;
  }
  bool same = value && other && json_equal(value, other);
  json_decref(other);
  free(defaults);
  if (!same)
    return value;
  json_decref(value);
  return NULL;
}

/* The same for a list with nothing in it. */
static json_t *encode_optional(const struct eo_table *owner, const struct eo_field *field, const void *source,
                               bool *failed)
{
  if (field->kind != EO_FIELD_LIST)
    return encode_unless_default(owner, field, source, failed);
  if (!*(const int *)((const char *)source + field->count_offset))
    return NULL;
  json_t *list = encode_field(field, source);
  *failed = *failed || !list;
  return list;
}

json_t *eo_table_encode(const struct eo_table *table, const void *source)
{
  json_t *object = json_object();
  bool failed = !object;
  for (int i = 0; i < table->count && !failed; i++) {
    const struct eo_field *field = &table->field[i];
    if (field->flags & (EO_FIELD_ENTRY | EO_FIELD_ELSEWHERE))
      continue;
    bool optional = field->flags & EO_FIELD_OMIT;
    json_t *value = optional ? encode_optional(table, field, source, &failed) : encode_field(field, source);
    if (value || !optional)
      eo_json_put(object, field->key, value, &failed);
  }
  if (failed) {
    json_decref(object);
    return NULL;
  }
  return object;
}

static void settle_numbers(const struct eo_unit *unit, int count, double *value)
{
  for (int i = 0; i < count; i++)
    value[i] = eo_unit_in(unit, eo_unit_out(unit, value[i]));
}

static void settle_field(const struct eo_field *field, void *target)
{
  void *place = (char *)target + field->offset;
  struct eo_numbers *series = place;
  struct eo_matrix *matrix = place;
  int rows;
  if (field->flags & EO_FIELD_ELSEWHERE)
    return;
  switch (field->kind) {
  case EO_FIELD_NUMBER:
    settle_numbers(field->unit, 1, place);
    break;
  case EO_FIELD_NUMBERS:
    settle_numbers(field->unit, field->count, place);
    break;
  case EO_FIELD_OBJECT:
    eo_table_round_to_document(field->table, place);
    break;
  case EO_FIELD_LIST:
    rows = *(const int *)((const char *)target + field->count_offset);
    for (int i = 0; i < rows; i++)
      eo_table_round_to_document(field->table, (char *)place + (size_t)i * field->table->size);
    break;
  case EO_FIELD_SERIES:
    settle_numbers(field->unit, series->count, series->value);
    break;
  case EO_FIELD_MATRIX:
    settle_numbers(field->unit, matrix->rows * matrix->columns, matrix->value);
    break;
  case EO_FIELD_INTEGER:
  case EO_FIELD_SEED:
  case EO_FIELD_FLAG:
  case EO_FIELD_TEXT:
  case EO_FIELD_CHOICE:
  case EO_FIELD_DOCUMENT:
  case EO_FIELD_NAMES:
    break;
  }
}

void eo_table_round_to_document(const struct eo_table *table, void *target)
{
  for (int i = 0; i < table->count; i++)
    settle_field(&table->field[i], target);
}

void eo_table_done(const struct eo_table *table, void *target)
{
  for (int i = 0; i < table->count; i++) {
    const struct eo_field *field = &table->field[i];
    char *place = (char *)target + field->offset;
    if (field->flags & EO_FIELD_ELSEWHERE)
      continue;
    int rows = field->kind == EO_FIELD_OBJECT ? 1
               : field->kind == EO_FIELD_LIST ? *(const int *)((const char *)target + field->count_offset)
                                              : 0;
    for (int j = 0; j < rows; j++)
      eo_table_done(field->table, place + (size_t)j * field->table->size);
    if (field->kind == EO_FIELD_SERIES) {
      struct eo_numbers *series = (void *)place;
      free(series->value);
      *series = (struct eo_numbers){0};
    } else if (field->kind == EO_FIELD_MATRIX) {
      struct eo_matrix *matrix = (void *)place;
      free(matrix->value);
      *matrix = (struct eo_matrix){0};
    }
  }
}
