/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "format/digits.h"
#include "format/json.h"

enum { LINE = 110 }; /* columns up to which a value stays on one line */

static void write_string(struct eo_text *text, const char *string)
{
  eo_text_add_bytes(text, "\"", 1);
  for (const char *rest = string; *rest;) {
    const char *plain = rest;
    while ((unsigned char)*rest >= 32 && *rest != '"' && *rest != '\\')
      rest++;
    eo_text_add_bytes(text, plain, (size_t)(rest - plain));
    if (*rest == '"' || *rest == '\\')
      eo_text_print(text, "\\%c", *rest++);
    else if (*rest)
      eo_text_print(text, "\\u%04x", (unsigned)*rest++);
  }
  eo_text_add_bytes(text, "\"", 1);
}

static void write_real(struct eo_text *text, double value)
{
  char *to = eo_text_room(text, EO_DIGITS_ROOM);
  if (to)
    text->size += (size_t)eo_digits_write(to, EO_DIGITS_ROOM, value);
}

/* A string that begins with a NUL, which none that is read can, holds what is to be written: EO_DIGITS_READY. */
static bool is_ready(const json_t *value)
{
  return json_is_string(value) && json_string_length(value) > 0 && !*json_string_value(value);
}

static void write_scalar(struct eo_text *text, const json_t *value)
{
  switch (json_typeof(value)) {
  case JSON_STRING:
    if (is_ready(value))
      eo_text_add_bytes(text, json_string_value(value) + 1, json_string_length(value) - 1);
    else
      write_string(text, json_string_value(value));
    break;
  case JSON_REAL:
    write_real(text, json_real_value(value));
    break;
  case JSON_INTEGER:
    eo_text_print(text, "%" JSON_INTEGER_FORMAT, json_integer_value(value));
    break;
  case JSON_TRUE:
  case JSON_FALSE:
    eo_text_add(text, json_is_true(value) ? "true" : "false");
    break;
  default:
    eo_text_add(text, "null");
  }
}

static int compare_keys(const void *a, const void *b)
{
  return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* The keys by their bytes; the caller frees the list, not the keys. NULL: no memory. */
static const char **list_keys(const json_t *object)
{
  const char **keys = malloc((json_object_size(object) + 1) * sizeof *keys), *key;
  if (!keys)
    return NULL;
  size_t n = 0;
  json_t *value;
  json_object_foreach((json_t *)object, key, value) keys[n++] = key;
  qsort(keys, n, sizeof *keys, compare_keys);
  return keys;
}

static void write_value(struct eo_text *text, const json_t *value, enum eo_json_style style, int indent);

/* One line: indent < 0; else each member on its own line. */
static void begin_member(struct eo_text *text, size_t i, enum eo_json_style style, int indent)
{
  if (i)
    eo_text_add_bytes(text, ",", 1);
  if (indent >= 0)
    eo_text_print(text, "\n%*s", indent + 2, "");
  else if (style == EO_JSON_PRETTY)
    eo_text_add(text, " ");
}

static void end_members(struct eo_text *text, size_t n, enum eo_json_style style, int indent)
{
  if (n && indent >= 0)
    eo_text_print(text, "\n%*s", indent, "");
  else if (n && style == EO_JSON_PRETTY)
    eo_text_add(text, " ");
}

static void write_member(struct eo_text *text, const char *key, const json_t *value, enum eo_json_style style,
                         int indent)
{
  write_string(text, key);
  eo_text_add(text, style == EO_JSON_PRETTY ? ": " : ":");
  write_value(text, value, style, indent < 0 ? -1 : indent + 2);
}

static void write_object(struct eo_text *text, const json_t *object, enum eo_json_style style, int indent)
{
  size_t n = json_object_size(object), i = 0;
  const char *key;
  json_t *value;
  eo_text_add(text, "{");
  json_object_foreach((json_t *)object, key, value)
  {
    begin_member(text, i++, style, indent);
    write_member(text, key, value, style, indent);
  }
  end_members(text, n, style, indent);
  eo_text_add(text, "}");
}

static void write_sorted(struct eo_text *text, const json_t *object)
{
  const char **keys = list_keys(object);
  if (!keys) {
    text->failed = true;
    return;
  }
  eo_text_add(text, "{");
  for (size_t i = 0; i < json_object_size(object); i++) {
    begin_member(text, i, EO_JSON_CANONICAL, -1);
    write_member(text, keys[i], json_object_get(object, keys[i]), EO_JSON_CANONICAL, -1);
  }
  eo_text_add(text, "}");
  free(keys);
}

static bool holds_containers(const json_t *array)
{
  return json_array_size(array) &&
         !(json_is_number(json_array_get(array, 0)) || json_is_null(json_array_get(array, 0)));
}

static void write_array(struct eo_text *text, const json_t *array, enum eo_json_style style, int indent)
{
  if (!holds_containers(array))
    indent = -1; /* numbers always stand in one row */
  size_t n = json_array_size(array);
  eo_text_add(text, "[");
  for (size_t i = 0; i < n; i++) {
    if (indent >= 0 || i)
      begin_member(text, i, style, indent);
    write_value(text, json_array_get(array, i), style, indent < 0 ? -1 : indent + 2);
  }
  if (indent >= 0)
    end_members(text, n, style, indent);
  eo_text_add(text, "]");
}

/* What is left of a line after a value; negative: it does not fit. Stops early on large values. */
static int room_after(const json_t *value, int room)
{
  const char *key;
  json_t *member;
  size_t i;
  if (json_is_object(value)) {
    json_object_foreach((json_t *)value, key, member)
    {
      if (room < 0)
        break;
      room = room_after(member, room - (int)strlen(key) - 4);
    }
  } else if (json_is_array(value)) {
    json_array_foreach(value, i, member)
    {
      if (room < 0)
        break;
      room = room_after(member, room - 2);
    }
  } else
    room -= 1;
  return room;
}

/* indent: of the line on which the value starts; negative: everything on this line. */
static void write_value(struct eo_text *text, const json_t *value, enum eo_json_style style, int indent)
{
  if (indent >= 0 && (json_is_object(value) || json_is_array(value)) && room_after(value, LINE - indent) >= 0) {
    struct eo_text line = {0};
    write_value(&line, value, style, -1);
    bool short_enough = line.size + (size_t)indent <= LINE;
    if (line.failed)
      text->failed = true;
    else if (short_enough)
      eo_text_add_bytes(text, line.data, line.size);
    eo_text_done(&line);
    if (short_enough || text->failed)
      return;
  }
  if (json_is_object(value) && style == EO_JSON_CANONICAL)
    write_sorted(text, value);
  else if (json_is_object(value))
    write_object(text, value, style, indent);
  else if (json_is_array(value))
    write_array(text, value, style, indent);
  else
    write_scalar(text, value);
}

void eo_json_write(struct eo_text *text, const json_t *value, enum eo_json_style style)
{
  write_value(text, value, style, style == EO_JSON_PRETTY ? 0 : -1);
  if (style == EO_JSON_PRETTY)
    eo_text_add(text, "\n");
}

void eo_json_write_new(struct eo_text *text, json_t *value, enum eo_json_style style)
{
  if (value)
    eo_json_write(text, value, style);
  text->failed = text->failed || !value;
  json_decref(value);
}

json_t *eo_json_real(double value, const struct eo_unit *unit)
{
  double outside = eo_unit_out(unit, value);
  return isfinite(outside) ? json_real(outside) : json_null();
}

json_t *eo_json_whole(double value)
{
  static const double EXACT = 9007199254740992; /* 2^53 */
  return fabs(value) < EXACT && value == floor(value) ? json_integer((json_int_t)value) : json_real(value);
}

enum { ROOM_AT_ONCE = 64 }; /* numbers for which a list asks for room together */

/* A number and its comma. Returns their length. */
static int write_ready(char *to, double value, int digits)
{
  static const char nothing[] = "null,";
  if (!isfinite(value)) {
    memcpy(to, nothing, sizeof nothing);
    return (int)sizeof nothing - 1;
  }
  int length = eo_digits_write_rounded(to, EO_DIGITS_ROOM, value, digits);
  to[length] = ',';
  return length + 1;
}

static json_t *ready_reals(int count, const double *value, int stride, const struct eo_unit *unit, int digits)
{
  struct eo_text text = {0};
  eo_text_room(&text, (size_t)(digits + 3) * (size_t)count + ROOM_AT_ONCE * (EO_DIGITS_ROOM + 1));
  eo_text_add_bytes(&text, "\0[", 2);
  for (int first = 0; first < count; first += ROOM_AT_ONCE) {
    int last = count - first < ROOM_AT_ONCE ? count : first + ROOM_AT_ONCE;
    char *start = eo_text_room(&text, ROOM_AT_ONCE * (size_t)(EO_DIGITS_ROOM + 1)), *to = start;
    for (int i = first; i < last && start; i++)
      to += write_ready(to, eo_unit_near(unit, value[(long)i * stride]), digits);
    text.size += (size_t)(to - start);
  }
  text.size -= count > 0 && !text.failed; /* the last comma */
  eo_text_add_bytes(&text, "]", 1);
  json_t *ready = text.failed ? NULL : json_stringn_nocheck(text.data, text.size);
  eo_text_done(&text);
  return ready;
}

json_t *eo_json_reals(int count, const double *value, int stride, const struct eo_unit *unit, int digits)
{
  if (digits & EO_DIGITS_READY)
    return ready_reals(count, value, stride, unit, digits & ~EO_DIGITS_READY);
  json_t *array = json_array();
  bool failed = !array;
  for (int i = 0; i < count && !failed; i++) {
    double si = value[(long)i * stride], outside = digits ? eo_unit_round(unit, si, digits) : eo_unit_out(unit, si);
    failed = json_array_append_new(array, isfinite(outside) ? json_real(outside) : json_null()) != 0;
  }
  if (failed) {
    json_decref(array);
    return NULL;
  }
  return array;
}

json_t *eo_json_append(json_t *array, json_t *value)
{
  if (json_array_append_new(array, value) == 0)
    return array;
  json_decref(array);
  return NULL;
}

void eo_json_put(json_t *object, const char *key, json_t *value, bool *failed)
{
  if (*failed || !value) {
    json_decref(value);
    *failed = true;
  } else if (json_object_set_new_nocheck(object, key, value) != 0)
    *failed = true;
}
