/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "format/json.h"

enum { LINE = 110 }; /* columns up to which a value stays on one line */

enum { EXACT_POWER = 22 }; /* the largest power of ten that is a double */
static const double power[EXACT_POWER + 1] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                              1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

static uint64_t bits_of(double value)
{
  uint64_t bits;
  memcpy(&bits, &value, sizeof bits);
  return bits;
}

/* floor(log10(value)) for 1 <= value < 1e22: from the binary exponent, log10(2) = 1233/4096. */
static int find_exponent(double value)
{
  int exponent = ((int)(bits_of(value) >> 52) - 1023) * 1233 >> 12;
  return exponent + (value >= power[exponent + 1]);
}

/* Decimals that show so many digits of a positive value, one less for some just below a power of ten; -1: none of what
   follows can be done exactly. */
static int find_decimals(double value, int digits)
{
  if (!(value >= 1e-13 && value < 1e15))
    return -1;
  int decimals = digits - 1 - (value >= 1 ? find_exponent(value) : find_exponent(value * 1e13) - 13);
  return decimals >= 0 && decimals <= EXACT_POWER ? decimals : -1;
}

/* number / 10^decimals without trailing zeros, as C's %g writes it but for the zeros of an exponent. Returns its
   length. */
static int write_decimal(char *text, bool negative, uint64_t number, int decimals)
{
  char reversed[24], *to = text;
  int length = 0;
  for (; decimals > 0 && number % 10 == 0; decimals--)
    number /= 10;
  for (; number > 0; number /= 10)
    reversed[length++] = (char)('0' + number % 10);
  int exponent = length - 1 - decimals, point = exponent < -4 ? length - 1 : decimals;
  while (length <= point)
    reversed[length++] = '0';
  if (negative)
    *to++ = '-';
  while (length > 0) {
    if (length == point)
      *to++ = '.';
    *to++ = reversed[--length];
  }
  if (exponent < -4) {
    *to++ = 'e';
    *to++ = '-';
    if (exponent <= -10)
      *to++ = '1';
    *to++ = (char)('0' + -exponent % 10);
  }
  *to = '\0';
  return (int)(to - text);
}

/* What the loop below finds, without printing and reading: a decimal number of up to 15 digits is the nearest double of
   its digits over a power of ten, as long as both are exact. Returns its length; 0: not so short, or too large or
   small. */
static int write_short(char *text, double value)
{
  double size = fabs(value);
  for (int digits = 9; digits <= 15; digits += 3) {
    int decimals = find_decimals(size, digits);
    double number = decimals < 0 ? 0 : nearbyint(size * power[decimals]);
    if (decimals < 0 || number >= 1e15 || number / power[decimals] != size)
      continue;
    return write_decimal(text, value < 0, (uint64_t)number, decimals);
  }
  return 0;
}

static int write_long(char *text, int size, double value)
{
  for (int digits = 15; digits <= 17; digits++) {
    snprintf(text, (size_t)size, "%.*g", digits, value);
    if (strtod(text, NULL) == value)
      break;
  }
  char *exponent = strchr(text, 'e'); /* 1e-07 -> 1e-7, 1e+20 -> 1e20 */
  if (exponent) {
    char *to = exponent + 1, *from = to;
    if (*from == '-')
      to = ++from;
    while (*from == '+' || (*from == '0' && from[1]))
      from++;
    memmove(to, from, strlen(from) + 1);
  }
  return (int)strlen(text);
}

int eo_json_number(char *text, int size, double value)
{
  uint64_t bits =
      bits_of(value); /* for the sign of a zero: where it compares values, the compiler may take all zeros for one */
  int length = bits << 1 ? write_short(text, value) : write_decimal(text, bits >> 63, 0, 0);
  return length ? length : write_long(text, size, value);
}

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
  enum { ROOM = 40 };
  char *to = eo_text_room(text, ROOM);
  if (to)
    text->size += (size_t)eo_json_number(to, ROOM, value);
}

static void write_scalar(struct eo_text *text, const json_t *value)
{
  switch (json_typeof(value)) {
  case JSON_STRING:
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

/* The keys in the order of the style; the caller frees the list, not the keys. NULL: no memory. */
static const char **list_keys(const json_t *object, enum eo_json_style style)
{
  const char **keys = malloc((json_object_size(object) + 1) * sizeof *keys), *key;
  if (!keys)
    return NULL;
  size_t n = 0;
  json_t *value;
  json_object_foreach((json_t *)object, key, value) keys[n++] = key;
  if (style == EO_JSON_CANONICAL)
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

static void write_object(struct eo_text *text, const json_t *object, enum eo_json_style style, int indent)
{
  const char **keys = list_keys(object, style);
  if (!keys) {
    text->failed = true;
    return;
  }
  size_t n = json_object_size(object);
  eo_text_add(text, "{");
  for (size_t i = 0; i < n; i++) {
    begin_member(text, i, style, indent);
    write_string(text, keys[i]);
    eo_text_add(text, style == EO_JSON_PRETTY ? ": " : ":");
    write_value(text, json_object_get(object, keys[i]), style, indent < 0 ? -1 : indent + 2);
  }
  end_members(text, n, style, indent);
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
  if (json_is_object(value))
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

json_t *eo_json_real(double value, const struct eo_unit *unit)
{
  double outside = eo_unit_out(unit, value);
  return isfinite(outside) ? json_real(outside) : json_null();
}

/* Through integers where that is exact and no tie is near, else through text: the same number. */
static double round_digits(double value, int digits)
{
  char text[40];
  double size = fabs(value);
  if (size == 0)
    return value;
  int decimals = find_decimals(size, digits);
  double scaled = decimals < 0 ? 0 : size * power[decimals], number = nearbyint(scaled),
         past = fabs(scaled - floor(scaled) - 0.5);
  if (decimals >= 0 && scaled >= power[digits - 1] * (1 + 1e-12) && number < power[digits] && past > 1e-15 * scaled)
    return copysign(number / power[decimals], value);
  snprintf(text, sizeof text, "%.*g", digits, value);
  return strtod(text, NULL);
}

json_t *eo_json_reals(int count, const double *value, int stride, const struct eo_unit *unit, int digits)
{
  json_t *array = json_array();
  bool failed = !array;
  for (int i = 0; i < count && !failed; i++) {
    double si = value[(long)i * stride];
    double outside = digits ? round_digits(unit ? (unit->divide ? si * unit->factor : si / unit->factor) : si, digits)
                            : eo_unit_out(unit, si);
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
  } else if (json_object_set_new(object, key, value) != 0)
    *failed = true;
}
