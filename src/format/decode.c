/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "format/json.h"
#include "format/key_faults.h"
#include "format/table.h"

static void *member(void *target, const struct eo_field *field)
{
  return (char *)target + field->offset;
}

static void set_text(char *target, int size, const char *value)
{
  memset(target, 0, (size_t)size);
  strncpy(target, value, (size_t)size - 1);
}

static bool may_be_null(const struct eo_field *field)
{
  return field->flags & EO_FIELD_NULLABLE;
}

/* Whether an object that may be null is there. */
static void set_present(const struct eo_field *field, void *target, bool present)
{
  if (may_be_null(field))
    *(int *)((char *)target + field->count_offset) = present;
}

static const char *type_name(const json_t *value)
{
  static const char *const name[] = {
      [JSON_OBJECT] = "an object", [JSON_ARRAY] = "an array", [JSON_STRING] = "a string", [JSON_INTEGER] = "a number",
      [JSON_REAL] = "a number",    [JSON_TRUE] = "true",      [JSON_FALSE] = "false",     [JSON_NULL] = "null"};
  return name[json_typeof(value)];
}

/* A number within the range, in the document's unit; false and a fault otherwise. */
static bool read_number(const json_t *value, const struct eo_field *field, double low, double high,
                        const struct eo_path *path, struct eo_faults *faults, double *number)
{
  if (!json_is_number(value)) {
    eo_faults_at(faults, path, "Must be a number, not %s.", type_name(value));
    return false;
  }
  *number = json_number_value(value);
  const char *symbol = field->unit ? field->unit->symbol : "", *hint = *number < low ? field->below : NULL;
  if (!isfinite(*number) || *number < low || *number > high) {
    eo_faults_at(faults, path, "%.15g is outside %.15g .. %.15g%s%s.%s%s", *number, low, high, *symbol ? " " : "",
                 symbol, hint ? " " : "", hint ? hint : "");
    return false;
  }
  return true;
}

static bool read_whole(const json_t *value, const struct eo_field *field, double low, double high,
                       const struct eo_path *path, struct eo_faults *faults, double *number)
{
  if (!read_number(value, field, low, high, path, faults, number))
    return false;
  if (*number == floor(*number))
    return true;
  eo_faults_at(faults, path, "%.15g is not a whole number.", *number);
  return false;
}

/* A number, or a whole one where the field says so. */
static bool read_real(const json_t *value, const struct eo_field *field, double low, double high,
                      const struct eo_path *path, struct eo_faults *faults, double *number)
{
  return field->flags & EO_FIELD_WHOLE ? read_whole(value, field, low, high, path, faults, number)
                                       : read_number(value, field, low, high, path, faults, number);
}

static void list_choices(const char *const *choices, struct eo_text *text)
{
  for (int i = 0; choices[i]; i++)
    eo_text_print(text, "%s\"%s\"", i ? ", " : "", choices[i]);
}

static void refuse_choice(const json_t *value, const struct eo_field *field, const struct eo_path *path,
                          struct eo_faults *faults)
{
  struct eo_text list = {0};
  list_choices(field->choices, &list);
  const char *all = list.data ? list.data : "its values";
  if (json_is_string(value))
    eo_faults_at(faults, path, "\"%.60s\" is none of %s.", json_string_value(value), all);
  else
    eo_faults_at(faults, path, "Must be one of %s, not %s.", all, type_name(value));
  eo_text_done(&list);
}

/* Index of the string among the choices; -1 and a fault otherwise. */
static int read_choice(const json_t *value, const struct eo_field *field, const struct eo_path *path,
                       struct eo_faults *faults)
{
  for (int i = 0; field->choices[i] && json_is_string(value); i++)
    if (strcmp(field->choices[i], json_string_value(value)) == 0)
      return i;
  refuse_choice(value, field, path, faults);
  return -1;
}

/* A string of `least` bytes or more into as many as there is room for. */
static void read_string(const json_t *value, double least, int room, const struct eo_path *path, char *place,
                        struct eo_faults *faults)
{
  if (json_string_length(value) >= (size_t)room)
    eo_faults_at(faults, path, "A string of %zu bytes is longer than the %d allowed.", json_string_length(value),
                 room - 1);
  else if ((double)json_string_length(value) < least)
    eo_faults_at(faults, path, "A string of %zu bytes is shorter than the %.0f needed.", json_string_length(value),
                 least);
  else
    set_text(place, room, json_string_value(value));
}

static void decode_text(const struct eo_field *field, const json_t *value, const struct eo_path *path, char *place,
                        struct eo_faults *faults)
{
  if (field->choices) {
    int choice = read_choice(value, field, path, faults);
    if (choice >= 0)
      set_text(place, field->count, field->choices[choice]);
  } else if (!json_is_string(value))
    eo_faults_at(faults, path, "Must be a string, not %s.", type_name(value));
  else
    read_string(value, field->low, field->count, path, place, faults);
}

/* A number, or a word that stands for one. */
static void decode_number(const struct eo_field *field, const json_t *value, const struct eo_path *path, double *place,
                          struct eo_faults *faults)
{
  double number;
  if (field->choices && json_is_string(value)) {
    int choice = read_choice(value, field, path, faults);
    if (choice >= 0)
      *place = eo_unit_in(field->unit, field->fallbacks[choice]);
  } else if (read_real(value, field, field->low, field->high, path, faults, &number))
    *place = eo_unit_in(field->unit, number);
}

static void decode_name(const struct eo_field *field, const json_t *value, const struct eo_path *path, char *place,
                        struct eo_faults *faults)
{
  double number;
  if (json_is_string(value))
    read_string(value, 1, field->room, path, place, faults);
  else if (!json_is_number(value))
    eo_faults_at(faults, path, "Must be a name or a number from %.0f, not %s.", field->low, type_name(value));
  else if (read_whole(value, field, field->low, field->high, path, faults, &number))
    snprintf(place, (size_t)field->room, "%.0f", number);
}

static void decode_names(const struct eo_field *field, const json_t *value, const struct eo_path *path, char *place,
                         struct eo_faults *faults)
{
  if (!json_is_array(value)) {
    decode_name(field, value, path, place, faults);
    return;
  }
  if (json_array_size(value) != (size_t)field->count)
    eo_faults_at(faults, path, "Must be one name or number, or an array of %d, not of %zu.", field->count,
                 json_array_size(value));
  for (int i = 0; i < field->count && json_array_size(value) == (size_t)field->count; i++) {
    const json_t *name = json_array_get(value, (size_t)i);
    struct eo_path element = {path, NULL, i};
    if (!json_is_null(name))
      decode_name(field, name, &element, place + (size_t)i * (size_t)field->room, faults);
  }
}

/* Numbers of an array; low and high per number. Returns false when one was wrong. */
static bool read_numbers(const json_t *value, const struct eo_field *field, double low, double high,
                         const struct eo_path *path, int count, double *number, struct eo_faults *faults)
{
  bool good = true;
  for (int i = 0; i < count; i++) {
    struct eo_path element = {path, NULL, i};
    double outside;
    if (field->flags & EO_FIELD_ALONE && json_is_null(json_array_get(value, (size_t)i)))
      number[i] = NAN;
    else if (read_real(json_array_get(value, (size_t)i), field, low, high, &element, faults, &outside))
      number[i] = eo_unit_in(field->unit, outside);
    else
      good = false;
  }
  for (int i = 1; i < count && good && field->flags & EO_FIELD_ASCENDING; i++)
    if (number[i] <= number[i - 1]) {
      eo_faults_at(faults, path, "The numbers must increase.");
      good = false;
    }
  return good;
}

static void decode_numbers(const struct eo_field *field, const json_t *value, const struct eo_path *path, double *place,
                           struct eo_faults *faults)
{
  double alone;
  if (field->flags & EO_FIELD_ALONE && json_is_number(value)) {
    if (read_real(value, field, field->low, field->high, path, faults, &alone))
      for (int i = 0; i < field->count; i++)
        place[i] = eo_unit_in(field->unit, alone);
  } else if (!json_is_array(value) || json_array_size(value) != (size_t)field->count)
    eo_faults_at(faults, path, "Must be an array of %d numbers, not %s%s.", field->count, type_name(value),
                 json_is_array(value) ? " of another length" : "");
  else
    read_numbers(value, field, field->low, field->high, path, field->count, place, faults);
}

static bool check_length(const struct eo_field *field, const json_t *value, const struct eo_path *path,
                         struct eo_faults *faults)
{
  if (!json_is_array(value)) {
    eo_faults_at(faults, path, "Must be an array, not %s.", type_name(value));
    return false;
  }
  double length = (double)json_array_size(value);
  if (length < field->low || length > field->high) {
    eo_faults_at(faults, path, "%.0f entries are outside %.0f .. %.0f.", length, field->low, field->high);
    return false;
  }
  return true;
}

static void decode_series(const struct eo_field *field, const json_t *value, const struct eo_path *path,
                          struct eo_numbers *series, struct eo_faults *faults)
{
  if (!check_length(field, value, path, faults))
    return;
  int count = (int)json_array_size(value);
  double *number = calloc(count ? (size_t)count : 1, sizeof *number);
  if (!number) {
    eo_faults_memory(faults);
    return;
  }
  read_numbers(value, field, field->series_low, field->series_high, path, count, number, faults);
  *series = (struct eo_numbers){count, number};
}

static void decode_matrix(const struct eo_field *field, const json_t *value, const struct eo_path *path,
                          struct eo_matrix *matrix, struct eo_faults *faults)
{
  if (!check_length(field, value, path, faults))
    return;
  size_t rows = json_array_size(value), columns = json_array_size(json_array_get(value, 0));
  double *number = calloc(rows * columns + 1, sizeof *number);
  if (!number) {
    eo_faults_memory(faults);
    return;
  }
  for (size_t i = 0; i < rows; i++) {
    const json_t *row = json_array_get(value, i);
    struct eo_path place = {path, NULL, (int)i};
    if (!json_is_array(row) || json_array_size(row) != columns)
      eo_faults_at(faults, &place, "Must be an array of %zu numbers, as the first row is.", columns);
    else
      read_numbers(row, field, field->series_low, field->series_high, &place, (int)columns, number + i * columns,
                   faults);
  }
  *matrix = (struct eo_matrix){(int)rows, (int)columns, number};
}

static void decode_keys(const struct eo_table *table, const json_t *object, const struct eo_path *path, void *target,
                        struct eo_faults *faults);

static void decode_list(const struct eo_field *field, const json_t *value, const struct eo_path *path, void *target,
                        struct eo_faults *faults)
{
  if (!check_length(field, value, path, faults))
    return;
  size_t count = json_array_size(value);
  char *row = member(target, field);
  for (int i = 0; i < (int)count; i++) {
    struct eo_path element = {path, NULL, i};
    eo_table_decode(field->table, json_array_get(value, (size_t)i), &element, row + (size_t)i * field->table->size,
                    faults);
  }
  *(int *)((char *)target + field->count_offset) = (int)count;
}

static void decode_null(const struct eo_field *field, void *target)
{
  void *place = member(target, field);
  if (field->kind == EO_FIELD_NUMBER)
    *(double *)place = NAN;
  else if (field->kind == EO_FIELD_INTEGER)
    *(int *)place = 0;
  else if (field->kind == EO_FIELD_NUMBERS)
    for (int i = 0; i < field->count; i++)
      ((double *)place)[i] = NAN;
  else if (field->kind == EO_FIELD_OBJECT)
    set_present(field, target, false);
  else if (field->kind == EO_FIELD_NAMES)
    memset(place, 0, (size_t)field->count * (size_t)field->room);
}

static void decode_flag(const json_t *value, const struct eo_path *path, bool *flag, struct eo_faults *faults)
{
  if (json_is_boolean(value))
    *flag = json_is_true(value);
  else
    eo_faults_at(faults, path, "Must be true or false, not %s.", type_name(value));
}

static void decode_document(const json_t *value, const struct eo_path *path, const json_t **document,
                            struct eo_faults *faults)
{
  if (json_is_object(value))
    *document = value;
  else
    eo_faults_at(faults, path, "Must be an object, not %s.", type_name(value));
}

static void decode_field(const struct eo_field *field, const json_t *value, const struct eo_path *path, void *target,
                         struct eo_faults *faults)
{
  void *place = member(target, field);
  double number;
  int choice;
  if (json_is_null(value) && may_be_null(field)) {
    decode_null(field, target);
    return;
  }
  switch (field->kind) {
  case EO_FIELD_NUMBER:
    decode_number(field, value, path, place, faults);
    break;
  case EO_FIELD_INTEGER:
    if (read_whole(value, field, field->low, field->high, path, faults, &number))
      *(int *)place = (int)number;
    break;
  case EO_FIELD_SEED:
    if (read_whole(value, field, field->low, field->high, path, faults, &number))
      *(uint64_t *)place = (uint64_t)number;
    break;
  case EO_FIELD_FLAG:
    decode_flag(value, path, place, faults);
    break;
  case EO_FIELD_TEXT:
    decode_text(field, value, path, place, faults);
    break;
  case EO_FIELD_CHOICE:
    choice = read_choice(value, field, path, faults);
    if (choice >= 0)
      *(int *)place = choice;
    break;
  case EO_FIELD_NUMBERS:
    decode_numbers(field, value, path, place, faults);
    break;
  case EO_FIELD_OBJECT:
    set_present(field, target, true);
    decode_keys(field->table, value, path, place, faults);
    break;
  case EO_FIELD_LIST:
    decode_list(field, value, path, target, faults);
    break;
  case EO_FIELD_SERIES:
    decode_series(field, value, path, place, faults);
    break;
  case EO_FIELD_MATRIX:
    decode_matrix(field, value, path, place, faults);
    break;
  case EO_FIELD_DOCUMENT:
    decode_document(value, path, place, faults);
    break;
  case EO_FIELD_NAMES:
    decode_names(field, value, path, place, faults);
    break;
  }
}

static const struct eo_field *find_field(const struct eo_table *table, const char *key)
{
  for (int i = 0; i < table->count; i++)
    if (strcmp(table->field[i].key, key) == 0 || (table->field[i].alias && strcmp(table->field[i].alias, key) == 0))
      return &table->field[i];
  return NULL;
}

/* One of the keys that may stand in the place of a required one is there. */
static bool is_replaced(const struct eo_field *field, const json_t *object)
{
  for (int i = 0; field->instead && field->instead[i]; i++) {
    const json_t *value = json_object_get(object, field->instead[i]);
    if (value && !json_is_null(value))
      return true;
  }
  return false;
}

/* Objects that are absent are read as empty ones, so that each required key in them is named. */
static void decode_absent(const struct eo_field *field, const json_t *object, const struct eo_path *path, void *target,
                          struct eo_faults *faults)
{
  if (field->kind == EO_FIELD_OBJECT && !may_be_null(field)) {
    json_t *empty = json_object();
    decode_keys(field->table, empty, path, member(target, field), faults);
    json_decref(empty);
  } else if (field->flags & EO_FIELD_REQUIRED && !is_replaced(field, object))
    eo_key_missing(field, path, faults);
}

/* What stands under the key, or under its other name. */
static const json_t *find_value(const struct eo_field *field, const json_t *object, const struct eo_path *path,
                                struct eo_faults *faults)
{
  const json_t *value = json_object_get(object, field->key),
               *other = field->alias ? json_object_get(object, field->alias) : NULL;
  if (value && other)
    eo_faults_at(faults, path, "This key is there twice, as \"%s\" too.", field->alias);
  return value ? value : other;
}

/* A number under an older name that counted in another measure. */
static bool is_scaled(const struct eo_field *field, const json_t *object, const json_t *value)
{
  return field->alias && field->alias_factor != 0 && json_is_number(value) && !json_object_get(object, field->key);
}

static void decode_scaled(const struct eo_field *field, const json_t *value, const struct eo_path *path, void *target,
                          struct eo_faults *faults)
{
  json_t *scaled = json_real(json_number_value(value) * field->alias_factor);
  if (scaled)
    decode_field(field, scaled, path, target, faults);
  else
    eo_faults_memory(faults);
  json_decref(scaled);
}

/* The keys that are there; the others keep the default that they have already. */
static void decode_keys(const struct eo_table *table, const json_t *object, const struct eo_path *path, void *target,
                        struct eo_faults *faults)
{
  if (!json_is_object(object)) {
    eo_faults_at(faults, path, "Must be an object, not %s.", object ? type_name(object) : "missing");
    return;
  }
  for (int i = 0; i < table->count; i++) {
    const struct eo_field *field = &table->field[i];
    struct eo_path place = {path, field->key, 0};
    const json_t *value = find_value(field, object, &place, faults);
    if (field->flags & EO_FIELD_ELSEWHERE)
      continue;
    if (value && is_scaled(field, object, value))
      decode_scaled(field, value, &place, target, faults);
    else if (value)
      decode_field(field, value, &place, target, faults);
    else if (field->elder_key && json_object_get(object, field->elder_key))
      *(int *)member(target, field) = field->elder_choice;
    else
      decode_absent(field, object, &place, target, faults);
  }
  const char *key;
  json_t *value;
  json_object_foreach((json_t *)object, key, value) if (!find_field(table, key))
  {
    struct eo_path place = {path, key, 0};
    eo_key_unknown(table, key, &place, faults);
  }
}

void eo_table_decode(const struct eo_table *table, const json_t *object, const struct eo_path *path, void *target,
                     struct eo_faults *faults)
{
  eo_table_defaults(table, target);
  decode_keys(table, object, path, target, faults);
}
