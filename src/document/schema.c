#include "document/schema.h"

#include "document/json.h"

static const char *const kind_names[] = {"number", "integer", "seed", "flag", "text", "choice", "numbers", "limit", "object", "list", "series"};

/* ---- what both descriptions say ---- */

static json_t *encode_choices(const struct eo_field *field)
{
  json_t *choices = json_array();
  for (int i = 0; field->choices[i]; i++)
    json_array_append_new(choices, json_string(field->choices[i]));
  return choices;
}

static json_t *encode_rows(const struct eo_field *field)
{
  json_t *rows = json_array();
  for (int i = 0; i < field->row_count; i++)
    json_array_append_new(rows, eo_table_encode(field->table, (const char *)field->rows + (size_t)i * field->table->size));
  return rows;
}

/* A whole number where it is one, so that 17 does not read 17.0. */
static json_t *encode_bound(double value)
{
  return fabs(value) < 1e15 && value == floor(value) ? json_integer((json_int_t)value) : eo_json_real(value, NULL);
}

/* NULL: the field has none. */
static json_t *encode_default(const struct eo_field *field)
{
  if (field->flags & EO_FIELD_REQUIRED)
    return NULL;
  switch (field->kind) {
  case EO_FIELD_NUMBER:
  case EO_FIELD_INTEGER:
  case EO_FIELD_SEED:
    return encode_bound(field->fallback);
  case EO_FIELD_FLAG:
    return json_boolean(field->fallback != 0);
  case EO_FIELD_TEXT:
    return json_string(field->fallback_text ? field->fallback_text : "");
  case EO_FIELD_CHOICE:
    return json_string(field->choices[(int)field->fallback]);
  case EO_FIELD_NUMBERS:
    return field->fallbacks ? eo_json_reals(field->count, field->fallbacks, 1, NULL, 0) : json_null();
  case EO_FIELD_LIMIT:
    return json_null();
  case EO_FIELD_LIST:
    return encode_rows(field);
  case EO_FIELD_OBJECT:
    return field->flags & EO_FIELD_NULLABLE ? json_null() : NULL;
  case EO_FIELD_SERIES:
    return NULL;
  }
  return NULL;
}

/* ---- for the form ---- */

static void put_range(const struct eo_field *field, json_t *object, bool *failed)
{
  bool series = field->kind == EO_FIELD_SERIES;
  double low = series ? field->series_low : field->low, high = series ? field->series_high : field->high;
  bool ranged = field->kind != EO_FIELD_FLAG && field->kind != EO_FIELD_TEXT && field->kind != EO_FIELD_CHOICE && field->kind != EO_FIELD_OBJECT;
  if (ranged && isfinite(low))
    eo_json_put(object, "low", encode_bound(low), failed);
  if (ranged && isfinite(high))
    eo_json_put(object, "high", encode_bound(high), failed);
}

static json_t *encode_fields(const struct eo_table *table);

static void put_nature(const struct eo_field *field, json_t *object, bool *failed)
{
  eo_json_put(object, "key", json_string(field->key), failed);
  eo_json_put(object, "kind", json_string(kind_names[field->kind]), failed);
  eo_json_put(object, "help", json_string(field->help ? field->help : ""), failed);
  eo_json_put(object, "required", json_boolean(field->flags & EO_FIELD_REQUIRED), failed);
  eo_json_put(object, "nullable", json_boolean(field->flags & EO_FIELD_NULLABLE), failed);
  if (field->unit) {
    eo_json_put(object, "unit", json_string(field->unit->suffix), failed);
    eo_json_put(object, "symbol", json_string(field->unit->symbol), failed);
  }
}

static json_t *encode_field(const struct eo_field *field)
{
  json_t *object = json_object(), *fallback = encode_default(field);
  bool failed = !object;
  put_nature(field, object, &failed);
  put_range(field, object, &failed);
  if (fallback)
    eo_json_put(object, "default", fallback, &failed);
  if (field->derived)
    eo_json_put(object, "derived", json_string(field->derived), &failed);
  if (field->choices)
    eo_json_put(object, "choices", encode_choices(field), &failed);
  if (field->kind == EO_FIELD_NUMBERS || field->kind == EO_FIELD_TEXT)
    eo_json_put(object, "count", json_integer(field->kind == EO_FIELD_TEXT ? field->count - 1 : field->count), &failed);
  if (field->table)
    eo_json_put(object, "fields", encode_fields(field->table), &failed);
  if (!failed)
    return object;
  json_decref(object);
  return NULL;
}

static json_t *encode_fields(const struct eo_table *table)
{
  json_t *fields = json_array();
  for (int i = 0; i < table->count && fields; i++)
    if (json_array_append_new(fields, encode_field(&table->field[i])) != 0) {
      json_decref(fields);
      fields = NULL;
    }
  return fields;
}

json_t *eo_table_fields(const struct eo_table *table)
{
  json_t *fields = encode_fields(table);
  return fields ? json_pack("{s:s, s:o}", "name", table->name ? table->name : "", "fields", fields) : NULL;
}

/* ---- JSON Schema ---- */

static json_t *number_schema(const char *type, double low, double high, bool ranged)
{
  json_t *schema = json_pack("{s:s}", "type", type);
  if (ranged && isfinite(low))
    json_object_set_new(schema, "minimum", encode_bound(low));
  if (ranged && isfinite(high))
    json_object_set_new(schema, "maximum", encode_bound(high));
  return schema;
}

static json_t *array_schema(json_t *items, double least, double most)
{
  json_t *schema = json_pack("{s:s, s:o}", "type", "array", "items", items);
  if (isfinite(least))
    json_object_set_new(schema, "minItems", encode_bound(least));
  if (isfinite(most))
    json_object_set_new(schema, "maxItems", encode_bound(most));
  return schema;
}

static json_t *text_schema(const struct eo_field *field)
{
  if (field->choices)
    return json_pack("{s:s, s:o}", "type", "string", "enum", encode_choices(field));
  return json_pack("{s:s, s:i}", "type", "string", "maxLength", field->count - 1);
}

/* Ranges are for what comes in; derived values that go out may lie beyond them. */
static json_t *plain_schema(const struct eo_field *field, bool input)
{
  switch (field->kind) {
  case EO_FIELD_NUMBER:
  case EO_FIELD_LIMIT:
    return number_schema("number", field->low, field->high, input);
  case EO_FIELD_INTEGER:
  case EO_FIELD_SEED:
    return number_schema("integer", field->low, field->high, input);
  case EO_FIELD_FLAG:
    return json_pack("{s:s}", "type", "boolean");
  case EO_FIELD_TEXT:
  case EO_FIELD_CHOICE:
    return text_schema(field);
  case EO_FIELD_NUMBERS:
    return array_schema(number_schema("number", field->low, field->high, input), field->count, field->count);
  case EO_FIELD_SERIES:
    return array_schema(number_schema("number", field->series_low, field->series_high, input), field->low, field->high);
  case EO_FIELD_OBJECT:
    return eo_table_json_schema(field->table, input);
  case EO_FIELD_LIST:
    return array_schema(eo_table_json_schema(field->table, input), field->low, field->high);
  }
  return NULL;
}

/* What goes out is null where a number is not finite, so every number that nobody gave may be. */
static bool may_be_null(const struct eo_field *field, bool input)
{
  return field->flags & EO_FIELD_NULLABLE || (!input && field->kind == EO_FIELD_NUMBER && !isfinite(field->low));
}

static json_t *field_schema(const struct eo_field *field, bool input)
{
  json_t *schema = plain_schema(field, input), *fallback = input ? encode_default(field) : NULL;
  if (may_be_null(field, input))
    schema = json_pack("{s:[o, {s:s}]}", "anyOf", schema, "type", "null");
  if (field->help)
    json_object_set_new(schema, "description", json_string(field->help));
  if (fallback)
    json_object_set_new(schema, "default", fallback);
  return schema;
}

json_t *eo_table_json_schema(const struct eo_table *table, bool input)
{
  json_t *properties = json_object(), *required = json_array();
  bool failed = !properties || !required;
  for (int i = 0; i < table->count; i++) {
    const struct eo_field *field = &table->field[i];
    eo_json_put(properties, field->key, field_schema(field, input), &failed);
    if (input ? field->flags & EO_FIELD_REQUIRED : !(field->flags & EO_FIELD_OMIT))
      json_array_append_new(required, json_string(field->key));
  }
  json_t *schema = json_pack("{s:s, s:o, s:o, s:b}", "type", "object", "properties", properties, "required", required, "additionalProperties", 0);
  if (!failed)
    return schema;
  json_decref(schema);
  return NULL;
}
