/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "format/inch.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "format/inch_sentence.h"

static const double PER_INCH = 25.4; /* mm in an inch, um in a thousandth of it */

/* Endings of keys. */
static const struct measure {
  const char *metric, *inch;
} measures[] = {{"_mm", "_in"}, {"_um", "_thou"}};
enum { MEASURES = sizeof measures / sizeof *measures, LONGEST_KEY = EO_INCH_KEY - 8 };

enum way { TO_METRIC, TO_INCHES };

static bool ends_with(const char *key, const char *ending)
{
  size_t whole = strlen(key), length = strlen(ending);
  return whole > length && whole < LONGEST_KEY && strcmp(key + whole - length, ending) == 0;
}

/* How a key is spelt the other way; false: it is no length, or is spelt so already. */
static bool respell(const char *key, enum way way, char other[EO_INCH_KEY])
{
  for (int i = 0; i < MEASURES; i++) {
    const char *from = way == TO_METRIC ? measures[i].inch : measures[i].metric,
               *to = way == TO_METRIC ? measures[i].metric : measures[i].inch;
    if (!ends_with(key, from) || strstr(key, "_per_"))
      continue;
    snprintf(other, EO_INCH_KEY, "%.*s%s", (int)(strlen(key) - strlen(from)), key, to);
    return true;
  }
  return false;
}

bool eo_inch_key(const char *key, size_t length, char inch[EO_INCH_KEY])
{
  char whole[LONGEST_KEY];
  if (length >= sizeof whole)
    return false;
  snprintf(whole, sizeof whole, "%.*s", (int)length, key);
  return respell(whole, TO_INCHES, inch);
}

static double convert(double value, enum way way)
{
  char text[40];
  snprintf(text, sizeof text, "%.15g", way == TO_METRIC ? value * PER_INCH : value / PER_INCH);
  return strtod(text, NULL);
}

static json_t *lengths(const json_t *value, enum way way);

/* One length per end or member. */
static json_t *named_lengths(const json_t *object, enum way way)
{
  json_t *made = json_object(), *value;
  const char *key;
  bool failed = !made;
  json_object_foreach((json_t *)object, key, value)
      failed = failed || json_object_set_new(made, key, lengths(value, way)) != 0;
  if (!failed)
    return made;
  json_decref(made);
  return NULL;
}

/* A length, several, or a map of them; all else as it is. */
static json_t *lengths(const json_t *value, enum way way)
{
  if (json_is_number(value))
    return json_real(convert(json_number_value(value), way));
  if (json_is_object(value))
    return named_lengths(value, way);
  if (!json_is_array(value))
    return json_deep_copy(value);
  json_t *list = json_array(), *element;
  size_t i;
  json_array_foreach((json_t *)value, i, element) if (json_array_append_new(list, lengths(element, way)))
  {
    json_decref(list);
    return NULL;
  }
  return list;
}

static json_t *respelt(const json_t *value, enum way way, struct eo_faults *faults);

static bool is_sentence(const char *key, const json_t *value)
{
  static const char *const keys[] = {"warnings", "notes",       "text",        "detail",   "rule",
                                     "reason",   "span_reason", "ball_reason", "unchecked"};
  const json_t *first = json_is_array(value) ? json_array_get(value, 0) : value;
  for (size_t i = 0; i < sizeof keys / sizeof *keys && json_is_string(first); i++)
    if (strcmp(key, keys[i]) == 0)
      return true;
  return false;
}

/* A sentence or a list of them. */
static json_t *sentences(const json_t *value)
{
  struct eo_text text = {0};
  json_t *made = json_is_array(value) ? json_array() : NULL, *element;
  size_t i;
  json_array_foreach((json_t *)value, i, element) json_array_append_new(made, sentences(element));
  if (made || !json_is_string(value))
    return made ? made : json_deep_copy(value);
  eo_inch_sentence(&text, json_string_value(value));
  made = text.failed ? NULL : json_string(text.data ? text.data : "");
  eo_text_done(&text);
  return made;
}

/* A row that says by "key" what its "value" is. */
static bool is_row(const json_t *object, char other[EO_INCH_KEY], enum way way)
{
  const char *key = json_string_value(json_object_get(object, "key"));
  return key && way == TO_INCHES && json_object_get(object, "value") && respell(key, way, other);
}

static json_t *respelt_object(const json_t *object, enum way way, struct eo_faults *faults)
{
  json_t *made = json_object(), *value;
  const char *key;
  char other[EO_INCH_KEY], row[EO_INCH_KEY];
  bool is_length_row = is_row(object, row, way), failed = !made;
  json_object_foreach((json_t *)object, key, value)
  {
    bool length = respell(key, way, other);
    if (length && json_object_get(object, other) && faults)
      eo_faults_add(faults, "", "%s says the same as %s: leave one of the two out.", key, other);
    json_t *element = length                                        ? lengths(value, way)
                      : is_length_row && strcmp(key, "key") == 0    ? json_string(row)
                      : is_length_row && strcmp(key, "value") == 0  ? lengths(value, way)
                      : way == TO_INCHES && is_sentence(key, value) ? sentences(value)
                                                                    : respelt(value, way, faults);
    failed = failed || json_object_set_new(made, length ? other : key, element) != 0;
  }
  if (!failed)
    return made;
  json_decref(made);
  return NULL;
}

static json_t *respelt_array(const json_t *array, enum way way, struct eo_faults *faults)
{
  json_t *made = json_array(), *value;
  bool failed = !made;
  size_t i;
  json_array_foreach((json_t *)array, i, value)
      failed = failed || json_array_append_new(made, respelt(value, way, faults)) != 0;
  if (!failed)
    return made;
  json_decref(made);
  return NULL;
}

static json_t *respelt(const json_t *value, enum way way, struct eo_faults *faults)
{
  return json_is_object(value)  ? respelt_object(value, way, faults)
         : json_is_array(value) ? respelt_array(value, way, faults)
                                : json_deep_copy(value);
}

bool eo_inch_is_used(const json_t *document)
{
  const char *key;
  json_t *value;
  char other[EO_INCH_KEY];
  size_t i;
  json_object_foreach((json_t *)document, key,
                      value) if (respell(key, TO_METRIC, other) || eo_inch_is_used(value)) return true;
  json_array_foreach((json_t *)document, i, value) if (eo_inch_is_used(value)) return true;
  return false;
}

json_t *eo_inch_to_mm(const json_t *document, struct eo_faults *faults)
{
  return respelt(document, TO_METRIC, faults);
}

/* The member, or element, of the token of a pointer. */
static const json_t *step(const json_t *value, const char *token)
{
  return json_is_array(value) ? json_array_get(value, strtoul(token, NULL, 10)) : json_object_get(value, token);
}

void eo_inch_place(const json_t *document, struct eo_error *fault)
{
  char inch[EO_INCH_KEY], pointer[sizeof fault->pointer] = "", token[LONGEST_KEY];
  bool found = false;
  size_t used = 0;
  for (const char *at = fault->pointer; *at == '/';) {
    size_t length = strcspn(at + 1, "/");
    snprintf(token, sizeof token, "%.*s", (int)length, at + 1);
    bool own = !step(document, token) && respell(token, TO_INCHES, inch) && step(document, inch);
    document = step(document, own ? inch : token);
    found = found || own;
    used += (size_t)snprintf(pointer + used, sizeof pointer - used, "/%s", own ? inch : token);
    if (used >= sizeof pointer)
      return;
    at += 1 + length;
  }
  if (!found)
    return;
  snprintf(fault->pointer, sizeof fault->pointer, "%s", pointer);
  eo_inch_error(fault);
}

json_t *eo_inch_from_mm(const json_t *document)
{
  return respelt(document, TO_INCHES, NULL);
}

/* Bytes of the cell at the place, its quotes included. */
static size_t cell_length(const char *at)
{
  size_t length = 0;
  for (bool quoted = false; at[length] && (quoted || !strchr(",\r\n", at[length])); length++)
    quoted = quoted != (at[length] == '"');
  return length;
}

static void put_number(const char *cell, size_t length, struct eo_text *text)
{
  char *end;
  double value = strtod(cell, &end);
  if (length > 0 && end == cell + length)
    eo_text_print(text, "%.10g", convert(value, TO_INCHES) + 0.0);
  else
    eo_text_add_bytes(text, cell, length);
}

void eo_inch_table(struct eo_text *table)
{
  enum { MOST_COLUMNS = 512 };
  bool length_column[MOST_COLUMNS] = {false};
  struct eo_text text = {.failed = table->failed};
  int line = 0, column = 0;
  for (const char *at = table->data ? table->data : ""; *at;) {
    size_t length = cell_length(at);
    char name[LONGEST_KEY], other[EO_INCH_KEY];
    snprintf(name, sizeof name, "%.*s", (int)length, at);
    if (line == 0 && column < MOST_COLUMNS && respell(name, TO_INCHES, other)) {
      length_column[column] = true;
      eo_text_add(&text, other);
    } else if (line > 0 && column < MOST_COLUMNS && length_column[column])
      put_number(at, length, &text);
    else
      eo_text_add_bytes(&text, at, length);
    at += length;
    column++;
    if (*at == ',')
      eo_text_add_bytes(&text, at++, 1);
    while (*at == '\r' || *at == '\n') {
      line += *at == '\n';
      column = 0;
      eo_text_add_bytes(&text, at++, 1);
    }
  }
  eo_text_done(table);
  *table = text;
}
