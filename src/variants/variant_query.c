/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "variants/variant_query.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool find_name(const struct eo_variant_table *table, const char *text, struct eo_variant_name *name)
{
  if (strcmp(text, "variant") == 0 || !*text) {
    *name = (struct eo_variant_name){EO_NAME_VARIANT, 0};
    return true;
  }
  if (strcmp(text, "outcome") == 0) {
    *name = (struct eo_variant_name){EO_NAME_OUTCOME, 0};
    return true;
  }
  for (int i = 0; i < table->plan.axes; i++)
    if (strcmp(text, table->plan.axis[i].name) == 0) {
      *name = (struct eo_variant_name){EO_NAME_AXIS, i};
      return true;
    }
  for (int i = 0; i < table->scalars.count; i++)
    if (strcmp(text, table->scalars.scalar[i].name) == 0) {
      *name = (struct eo_variant_name){EO_NAME_COLUMN, i};
      return true;
    }
  return false;
}

static enum eo_code unknown(const char *pointer, const char *name, struct eo_error *error)
{
  return eo_error_set(error, EO_ERROR_INPUT, pointer,
                      "\"%.120s\" is neither variant, outcome, nor the name of what varies or of a column.", name);
}

/* A word among the values of an axis; NaN: it is none of them. */
static double place_of(const struct eo_variant_axis *axis, const char *word)
{
  for (size_t i = 0; i < json_array_size(axis->levels); i++) {
    const json_t *level = json_array_get(axis->levels, i);
    const char *text = json_is_boolean(level) ? (json_is_true(level) ? "true" : "false") : json_string_value(level);
    if (text && strcmp(text, word) == 0)
      return (double)i;
  }
  return NAN;
}

static double read_value(const struct eo_variant_table *table, const struct eo_variant_name *name, const char *text)
{
  char *end;
  double value = strtod(text, &end);
  if (*text && !*end)
    return value;
  if (name->kind == EO_NAME_AXIS)
    return place_of(&table->plan.axis[name->index], text);
  for (int i = 0; name->kind == EO_NAME_OUTCOME && eo_store_outcomes[i]; i++)
    if (strcmp(text, eo_store_outcomes[i]) == 0)
      return i;
  return NAN;
}

static void trim(char *target, size_t size, const char *text, size_t length)
{
  while (length && *text == ' ') {
    text++;
    length--;
  }
  while (length && text[length - 1] == ' ')
    length--;
  snprintf(target, size, "%.*s", (int)length, text);
}

static enum eo_code read_condition(const struct eo_variant_table *table, const char *text, size_t length,
                                   struct eo_variant_condition *condition, struct eo_error *error)
{
  static const struct {
    const char *sign;
    int relation;
  } relations[] = {{"<=", EO_AT_MOST}, {">=", EO_AT_LEAST}, {"!=", EO_UNEQUAL},
                   {"<", EO_LESS},     {">", EO_MORE},      {"=", EO_EQUAL}};
  char name[EO_SCALAR_NAME], value[80];
  size_t at = 0, sign = 0;
  while (at < length && !strchr("<>=!", text[at]))
    at++;
  while (sign < 6 && strncmp(text + at, relations[sign].sign, strlen(relations[sign].sign)) != 0)
    sign++;
  if (at >= length || sign == 6)
    return eo_error_set(error, EO_ERROR_INPUT, "/filter", "\"%.*s\" is no condition as objectives.J<0.4.",
                        (int)(length < 100 ? length : 100), text);
  size_t behind = at + strlen(relations[sign].sign);
  trim(name, sizeof name, text, at);
  trim(value, sizeof value, text + behind, length > behind ? length - behind : 0);
  if (!*name || !find_name(table, name, &condition->name))
    return unknown("/filter", name, error);
  condition->relation = relations[sign].relation;
  condition->value = read_value(table, &condition->name, value);
  return isnan(condition->value)
             ? eo_error_set(error, EO_ERROR_INPUT, "/filter", "\"%.60s\" is no value of %.100s.", value, name)
             : EO_OK;
}

enum eo_code eo_variant_query_read(const struct eo_variant_table *table, const struct eo_variant_query *query,
                                   struct eo_variant_conditions *conditions, struct eo_error *error)
{
  const char *sort = query->sort ? query->sort : "";
  *conditions = (struct eo_variant_conditions){0};
  for (const char *at = query->filter ? query->filter : ""; *at;) {
    size_t length = strcspn(at, ",");
    if (conditions->count == EO_VARIANT_FILTERS)
      return eo_error_set(error, EO_ERROR_INPUT, "/filter", "There are more than %d conditions.", EO_VARIANT_FILTERS);
    EO_TRY(read_condition(table, at, length, &conditions->condition[conditions->count++], error));
    at += length + (at[length] == ',');
  }
  return find_name(table, sort, &conditions->sort) ? EO_OK : unknown("/sort", sort, error);
}

static double axis_number(const struct eo_variant_table *table, int index, int variant)
{
  json_t *values = eo_variant_values(&table->plan, variant), *value = json_array_get(values, (size_t)index);
  double number = json_is_number(value) ? json_number_value(value) : NAN;
  if (json_is_string(value))
    number = place_of(&table->plan.axis[index], json_string_value(value));
  else if (json_is_boolean(value))
    number = json_is_true(value);
  json_decref(values);
  return number;
}

double eo_variant_number(const struct eo_variant_table *table, const struct eo_variant_name *name,
                         const struct eo_stored_variant *row)
{
  switch (name->kind) {
  case EO_NAME_VARIANT:
    return row->ordinal;
  case EO_NAME_OUTCOME:
    return row->outcome;
  case EO_NAME_AXIS:
    return axis_number(table, name->index, row->ordinal);
  default:
    return row->number[name->index];
  }
}

bool eo_variant_fits(const struct eo_variant_table *table, const struct eo_variant_conditions *conditions,
                     const struct eo_stored_variant *row)
{
  bool fits = true;
  for (int i = 0; i < conditions->count && fits; i++) {
    const struct eo_variant_condition *condition = &conditions->condition[i];
    double value = eo_variant_number(table, &condition->name, row), limit = condition->value;
    const bool holds[] = {value<limit, value <= limit, value> limit, value >= limit, value == limit, value != limit};
    fits = holds[condition->relation];
  }
  return fits;
}
