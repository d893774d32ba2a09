/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "format/schema.h"

#include <math.h>
#include <stdlib.h>

#include "format/object.h"
#include "format/schema_private.h"

json_t *eo_schema_defaults(const struct eo_table *table)
{
  void *defaults = calloc(1, table->size);
  if (!defaults)
    return NULL;
  eo_table_defaults(table, defaults);
  json_t *document = eo_table_encode(table, defaults);
  eo_table_done(table, defaults);
  free(defaults);
  return document;
}

json_t *eo_schema_default(const struct eo_field *field, const json_t *defaults)
{
  json_t *value = json_object_get(defaults, field->key);
  return value ? json_incref(value) : json_null();
}

bool eo_schema_has_default(const struct eo_field *field)
{
  return !(field->flags & (EO_FIELD_REQUIRED | EO_FIELD_ELSEWHERE)) && field->kind != EO_FIELD_SERIES &&
         field->kind != EO_FIELD_MATRIX && field->kind != EO_FIELD_DOCUMENT &&
         (field->kind != EO_FIELD_OBJECT || field->flags & EO_FIELD_NULLABLE);
}

static bool is_whole(const struct eo_field *field)
{
  return field->kind == EO_FIELD_INTEGER || field->kind == EO_FIELD_SEED || field->flags & EO_FIELD_WHOLE;
}

json_t *eo_schema_bound(double bound)
{
  return fabs(bound) < 1e15 && bound == floor(bound) ? json_integer((json_int_t)bound) : json_real(bound);
}

/* Ranges without an end are left out. */
static void put_bound(struct eo_object *object, const char *key, double bound)
{
  if (isfinite(bound))
    eo_object_put(object, key, eo_schema_bound(bound));
}

json_t *eo_schema_texts(const char *const *text)
{
  json_t *list = json_array();
  bool failed = !list;
  for (int i = 0; text[i]; i++)
    failed = json_array_append_new(list, json_string(text[i])) != 0 || failed;
  if (!failed)
    return list;
  json_decref(list);
  return NULL;
}

static void put_type(struct eo_object *object, const char *type, bool nullable)
{
  eo_object_put(object, "type", nullable ? json_pack("[s,s]", type, "null") : json_string(type));
}

static void put_number(struct eo_object *object, const struct eo_field *field, double low, double high, bool nullable,
                       bool input)
{
  put_type(object, is_whole(field) ? "integer" : "number", nullable);
  if (!input)
    return;
  put_bound(object, "minimum", low);
  put_bound(object, "maximum", high);
}

/* Numbers of an array that is written may be missing one by one. */
static json_t *number_items(const struct eo_field *field, double low, double high, bool input)
{
  struct eo_object object = eo_object_open();
  put_number(&object, field, low, high, !input || field->flags & EO_FIELD_ALONE, input);
  return eo_object_close(&object);
}

static void put_text(struct eo_object *object, const struct eo_field *field)
{
  put_type(object, "string", field->flags & EO_FIELD_NULLABLE);
  if (!field->choices && field->low > 0)
    eo_object_put(object, "minLength", json_integer((json_int_t)field->low));
  if (field->choices) {
    json_t *words = eo_schema_texts(field->choices);
    if (field->flags & EO_FIELD_NULLABLE) /* an enumeration admits null only where it lists it */
      object->failed = json_array_append_new(words, json_null()) != 0 || object->failed;
    eo_object_put(object, "enum", words);
  } else
    eo_object_put(object, "maxLength", json_integer(field->count - 1));
}

static void put_array(struct eo_object *object, const struct eo_field *field, json_t *items, double low, double high)
{
  put_type(object, "array", field->flags & EO_FIELD_NULLABLE);
  eo_object_put(object, "items", items);
  put_bound(object, "minItems", low);
  put_bound(object, "maxItems", high);
}

static json_t *array_schema(const struct eo_field *field, json_t *items)
{
  struct eo_object object = eo_object_open();
  put_array(&object, field, items, field->count, field->count);
  return eo_object_close(&object);
}

/* A number, or a word that stands for one. */
static void put_worded(struct eo_object *object, const struct eo_field *field, bool nullable, bool input)
{
  struct eo_object number = eo_object_open();
  put_number(&number, field, field->low, field->high, nullable, input);
  eo_object_put(object, "anyOf",
                json_pack("[o, {s:s, s:o}]", eo_object_close(&number), "type", "string", "enum",
                          eo_schema_texts(field->choices)));
}

/* One number, or as many as the field has. */
static void put_numbers(struct eo_object *object, const struct eo_field *field, bool input)
{
  json_t *items = number_items(field, field->low, field->high, input);
  if (!(field->flags & EO_FIELD_ALONE)) {
    put_array(object, field, items, field->count, field->count);
    return;
  }
  struct eo_object number = eo_object_open();
  put_number(&number, field, field->low, field->high, false, input);
  eo_object_put(object, "anyOf", json_pack("[o, o]", eo_object_close(&number), array_schema(field, items)));
}

static json_t *name_schema(const struct eo_field *field, bool nullable)
{
  struct eo_object text = eo_object_open(), number = eo_object_open();
  put_type(&text, "string", nullable);
  eo_object_put(&text, "minLength", json_integer(1));
  eo_object_put(&text, "maxLength", json_integer(field->room - 1));
  put_type(&number, "integer", false);
  put_bound(&number, "minimum", field->low);
  put_bound(&number, "maximum", field->high);
  return json_pack("[o, o]", eo_object_close(&text), eo_object_close(&number));
}

/* One name, or as many as the field has. */
static void put_names(struct eo_object *object, const struct eo_field *field)
{
  json_t *choices = name_schema(field, false), *items = json_pack("{s:o}", "anyOf", name_schema(field, true));
  object->failed = json_array_append_new(choices, array_schema(field, items)) != 0 || object->failed;
  eo_object_put(object, "anyOf", choices);
}

static void put_object(struct eo_object *object, const struct eo_table *table, bool nullable, bool input);

static json_t *row_schema(const struct eo_table *table, bool input)
{
  struct eo_object object = eo_object_open();
  put_object(&object, table, false, input);
  return eo_object_close(&object);
}

static void put_reference(struct eo_object *object, const struct eo_field *field)
{
  json_t *reference = json_sprintf("#/components/schemas/%s", field->document);
  if (field->flags & EO_FIELD_NULLABLE)
    eo_object_put(object, "anyOf", json_pack("[{s:o}, {s:s}]", "$ref", reference, "type", "null"));
  else
    eo_object_put(object, "$ref", reference);
}

/* Rows of numbers. */
static json_t *matrix_row(const struct eo_field *field, bool input)
{
  struct eo_object object = eo_object_open();
  eo_object_put(&object, "type", json_string("array"));
  eo_object_put(&object, "items", number_items(field, field->series_low, field->series_high, input));
  return eo_object_close(&object);
}

static void put_constraints(struct eo_object *object, const struct eo_field *field, bool input)
{
  bool nullable = field->flags & EO_FIELD_NULLABLE || (!input && field->kind == EO_FIELD_NUMBER);
  switch (field->kind) {
  case EO_FIELD_NUMBER:
    if (field->choices)
      put_worded(object, field, nullable, input);
    else
      put_number(object, field, field->low, field->high, nullable, input);
    break;
  case EO_FIELD_INTEGER:
  case EO_FIELD_SEED:
    put_number(object, field, field->low, field->high, nullable, input);
    break;
  case EO_FIELD_FLAG:
    put_type(object, "boolean", false);
    break;
  case EO_FIELD_TEXT:
  case EO_FIELD_CHOICE:
    put_text(object, field);
    break;
  case EO_FIELD_NUMBERS:
    put_numbers(object, field, input);
    break;
  case EO_FIELD_NAMES:
    put_names(object, field);
    break;
  case EO_FIELD_SERIES:
    put_array(object, field, number_items(field, field->series_low, field->series_high, input),
              input ? field->low : NAN, input ? field->high : NAN);
    break;
  case EO_FIELD_MATRIX:
    put_array(object, field, matrix_row(field, input), input ? field->low : NAN, input ? field->high : NAN);
    break;
  case EO_FIELD_LIST:
    put_array(object, field, row_schema(field->table, input), field->low, field->high);
    break;
  case EO_FIELD_OBJECT:
    put_object(object, field->table, nullable, input);
    break;
  case EO_FIELD_DOCUMENT:
    put_reference(object, field);
    break;
  }
}

static json_t *property(const struct eo_field *field, const json_t *defaults, bool input)
{
  struct eo_object object = eo_object_open();
  put_constraints(&object, field, input);
  if (field->help && field->derived)
    eo_object_put(&object, "description", json_sprintf("%s; null: %s", field->help, field->derived));
  else if (field->help)
    eo_object_put(&object, "description", json_string(field->help));
  if (field->unit)
    eo_object_put(&object, "x-unit", json_string(field->unit->symbol));
  if (input && eo_schema_has_default(field))
    eo_object_put(&object, "default", eo_schema_default(field, defaults));
  return eo_object_close(&object);
}

/* An object that is absent is read as an empty one, in which a required key is missing. What another key may stand for
   is required by nobody alone. */
static bool must_be_there(const struct eo_field *field)
{
  bool required = field->flags & EO_FIELD_REQUIRED && !field->instead;
  for (int i = 0;
       field->kind == EO_FIELD_OBJECT && !(field->flags & EO_FIELD_NULLABLE) && i < field->table->count && !required;
       i++)
    required = must_be_there(&field->table->field[i]);
  return required;
}

static void put_object(struct eo_object *object, const struct eo_table *table, bool nullable, bool input)
{
  json_t *required = json_array(), *defaults = eo_schema_defaults(table);
  struct eo_object properties = eo_object_open();
  object->failed = object->failed || !required || !defaults;
  put_type(object, "object", nullable);
  for (int i = 0; i < table->count && !object->failed; i++) {
    const struct eo_field *field = &table->field[i];
    if (!input && field->flags & EO_FIELD_ENTRY)
      continue;
    eo_object_put(&properties, field->key, property(field, defaults, input));
    if (input && field->alias)
      eo_object_put(&properties, field->alias, property(field, defaults, input));
    if (input ? must_be_there(field) : !(field->flags & (EO_FIELD_OMIT | EO_FIELD_SOMETIMES | EO_FIELD_ELSEWHERE)))
      object->failed = json_array_append_new(required, json_string(field->key)) != 0;
  }
  eo_object_put(object, "properties", eo_object_close(&properties));
  if (json_array_size(required))
    eo_object_put(object, "required", json_incref(required));
  eo_object_put(object, "additionalProperties", json_false());
  json_decref(required);
  json_decref(defaults);
}

json_t *eo_table_json_schema(const struct eo_table *table, bool input)
{
  return row_schema(table, input);
}
