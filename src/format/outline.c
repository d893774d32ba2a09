/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "format/outline.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "format/object.h"
#include "format/schema.h"

/* Counts *index down to the row; NULL: it stands behind these. */
static const struct eo_outline_row *walk(const struct eo_outline *outline, int *index)
{
  for (int i = 0; i < outline->count; i++) {
    const struct eo_outline_row *row = &outline->row[i], *found = row->key ? NULL : walk(row->outline, index);
    if (found)
      return found;
    if (row->key && (*index)-- == 0)
      return row;
  }
  return NULL;
}

const struct eo_outline_row *eo_outline_at(const struct eo_outline *outline, int index)
{
  return walk(outline, &index);
}

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
  struct eo_object list = {.json = json_array()};
  const char *part = *(const char *const *)((const char *)source + row->offset);
  int count = *(const int *)((const char *)source + row->count_offset);
  for (int i = 0; i < count; i++)
    list.failed = json_array_append_new(list.json, encode_part(row, part + (size_t)i * row->stride)) != 0 ||
                  list.failed;
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
  case EO_MEMBER_ROWS:
    return encode_rows(row, source);
  }
  return NULL;
}

/* source: of which rows are at an offset, as many as it says */
static json_t *encode_column(const struct eo_outline_row *row, const void *source)
{
  struct eo_object list = {.json = json_array()};
  const char *first = *(const char *const *)((const char *)source + row->offset);
  int count = *(const int *)((const char *)source + row->count_offset);
  for (int i = 0; i < count; i++) {
    const char *each = first + (size_t)i * row->stride;
    list.failed = json_array_append_new(list.json, encode_at(row, each, each + row->column_offset)) != 0 || list.failed;
  }
  return eo_object_close(&list);
}

static json_t *encode(const struct eo_outline_row *row, const void *source)
{
  return row->column ? encode_column(row, source) : encode_at(row, source, (const char *)source + row->offset);
}

void eo_outline_put(struct eo_object *object, const struct eo_outline *outline, const void *source)
{
  for (int i = 0; i < outline->count; i++) {
    const struct eo_outline_row *row = &outline->row[i];
    if (!row->key)
      eo_outline_put(object, row->outline, (const char *)source + row->offset);
    else if (!row->there || row->there(source))
      eo_object_put(object, row->key, encode(row, source));
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
  struct eo_object list = {.json = json_array()};
  json_t *member;
  size_t i;
  json_array_foreach((json_t *)array, i, member)
      list.failed = json_array_append_new(list.json, eo_outline_take(outline, member)) != 0 || list.failed;
  return eo_object_close(&list);
}

json_t *eo_outline_take(const struct eo_outline *outline, const json_t *document)
{
  struct eo_object o = eo_object_open_as(outline);
  const struct eo_outline_row *row;
  for (int i = 0; (row = eo_outline_at(outline, i)); i++) {
    json_t *value = json_object_get(document, row->key);
    if (row->outline && json_is_array(value))
      eo_object_put(&o, row->key, take_each(row->outline, value));
    else if (value)
      eo_object_put(&o, row->key,
                    row->outline && json_is_object(value) ? eo_outline_take(row->outline, value) : json_incref(value));
  }
  return eo_object_close(&o);
}

static json_t *reference(const struct eo_outline_row *row)
{
  return json_pack("{s:o}", "$ref",
                   json_sprintf("#/components/schemas/%s", row->outline ? row->outline->name : row->name));
}

static json_t *list_words(const char *const *words)
{
  json_t *list = json_array();
  for (int i = 0; words[i]; i++)
    json_array_append_new(list, json_string(words[i]));
  return list;
}

static bool take(const char **at, const char *word)
{
  size_t length = strlen(word);
  if (strncmp(*at, word, length) != 0)
    return false;
  *at += length;
  return true;
}

static json_t *read_plain(const char **at, const struct eo_outline_row *row)
{
  static const char *const word[] = {"number", "integer", "flag", "text"}, *const type[] = {"number", "integer",
                                                                                            "boolean", "string"};
  for (int i = 0; i < 4; i++)
    if (take(at, word[i]))
      return json_pack("{s:s}", "type", type[i]);
  if (take(at, "word") && row->words)
    return json_pack("{s:s, s:o}", "type", "string", "enum", list_words(row->words));
  if (take(at, "any"))
    return json_object();
  return take(at, "object") ? reference(row) : NULL;
}

static json_t *read_shape(const char **at, const struct eo_outline_row *row);

static json_t *read_one(const char **at, const struct eo_outline_row *row)
{
  json_t *schema = NULL;
  if (!take(at, "["))
    schema = read_plain(at, row);
  else if ((schema = read_shape(at, row)))
    schema = take(at, "]") ? json_pack("{s:s, s:o}", "type", "array", "items", schema) : (json_decref(schema), NULL);
  return schema && take(at, "?") ? json_pack("{s:[o, {s:s}]}", "anyOf", schema, "type", "null") : schema;
}

static json_t *read_shape(const char **at, const struct eo_outline_row *row)
{
  json_t *schema = read_one(at, row);
  return schema && take(at, "|") ? json_pack("{s:[o, o]}", "anyOf", schema, read_shape(at, row)) : schema;
}

static json_t *property(const struct eo_outline_row *row)
{
  const char *at = row->shape;
  struct eo_object o = {.json = read_shape(&at, row)};
  o.failed = !o.json || *at;
  eo_object_put(&o, "description", row->when ? json_sprintf("%s; %s", row->help, row->when) : json_string(row->help));
  if (row->unit)
    eo_object_put(&o, "x-unit", json_string(row->unit->symbol));
  return eo_object_close(&o);
}

static json_t *object_schema(const struct eo_outline *outline)
{
  struct eo_object o = eo_object_open(), properties = eo_object_open();
  const struct eo_outline_row *row;
  json_t *required = json_array();
  for (int i = 0; (row = eo_outline_at(outline, i)); i++) {
    eo_object_put(&properties, row->key, property(row));
    if (!row->when)
      json_array_append_new(required, json_string(row->key));
  }
  eo_object_put(&o, "type", json_string("object"));
  eo_object_put(&o, "properties", eo_object_close(&properties));
  eo_object_put(&o, "required", required);
  return eo_object_close(&o);
}

bool eo_outline_add_schemas(const struct eo_outline *outline, json_t *schemas)
{
  const struct eo_outline_row *row;
  bool good = json_object_get(schemas, outline->name) ||
              json_object_set_new(schemas, outline->name, object_schema(outline)) == 0;
  for (int i = 0; good && (row = eo_outline_at(outline, i)); i++) {
    if (row->outline && !json_object_get(schemas, row->outline->name))
      good = eo_outline_add_schemas(row->outline, schemas);
    else if (row->table && !json_object_get(schemas, row->name))
      good = json_object_set_new(schemas, row->name, eo_table_json_schema(row->table, row->sparse)) == 0;
  }
  return good;
}
