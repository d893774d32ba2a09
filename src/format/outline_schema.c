/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The JSON Schema of an outline and of all below it. */
#include "format/outline.h"

#include <string.h>

#include "format/object.h"
#include "format/schema.h"

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

/* What stands between brackets: an array of it, or an object whose keys are data. */
static json_t *read_inner(const char **at, const struct eo_outline_row *row, bool array)
{
  json_t *schema = read_shape(at, row);
  if (!schema || !take(at, array ? "]" : "}")) {
    json_decref(schema);
    return NULL;
  }
  return json_pack("{s:s, s:o}", "type", array ? "array" : "object", array ? "items" : "additionalProperties", schema);
}

static json_t *read_one(const char **at, const struct eo_outline_row *row)
{
  bool array = take(at, "[");
  json_t *schema = array || take(at, "{") ? read_inner(at, row, array) : read_plain(at, row);
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
  struct eo_object object = {.json = read_shape(&at, row)};
  object.failed = !object.json || *at;
  eo_object_put(&object, "description",
                row->when ? json_sprintf("%s; %s", row->help, row->when) : json_string(row->help));
  if (row->unit)
    eo_object_put(&object, "x-unit", json_string(row->unit->symbol));
  return eo_object_close(&object);
}

static json_t *object_schema(const struct eo_outline *outline)
{
  struct eo_object object = eo_object_open(), properties = eo_object_open();
  const struct eo_outline_row *row;
  json_t *required = json_array();
  for (int i = 0; (row = eo_outline_at(outline, i)); i++) {
    eo_object_put(&properties, row->key, property(row));
    if (!row->when)
      json_array_append_new(required, json_string(row->key));
  }
  eo_object_put(&object, "type", json_string("object"));
  eo_object_put(&object, "properties", eo_object_close(&properties));
  eo_object_put(&object, "required", required);
  return eo_object_close(&object);
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
