/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include "format/json.h"

struct place {
  int line, column, depth;
};

/* Walks to the first bracket that is nested too deep; false when there is none. jansson recurses, so this comes first.
 */
static bool too_deep(const char *data, size_t size, struct place *place)
{
  bool in_string = false;
  *place = (struct place){1, 0, 0};
  for (size_t i = 0; i < size; i++) {
    char c = data[i];
    place->column++;
    if (c == '\n') {
      place->line++;
      place->column = 0;
    } else if (in_string && c == '\\')
      i++, place->column++;
    else if (c == '"')
      in_string = !in_string;
    else if (!in_string && (c == '[' || c == '{') && ++place->depth > EO_JSON_DEPTH)
      return true;
    else if (!in_string && (c == ']' || c == '}'))
      place->depth--;
  }
  return false;
}

static enum eo_code report(const json_error_t *fault, struct eo_error *error)
{
  if (json_error_code(fault) == json_error_out_of_memory)
    return eo_error_memory(error);
  char text[200];
  eo_text_clean(text, sizeof text, fault->text);
  return eo_error_set(error, EO_ERROR_INPUT, "", "Line %d, column %d: %s.", fault->line, fault->column, text);
}

json_t *eo_json_parse(const char *data, size_t size, struct eo_error *error)
{
  struct place place;
  if (too_deep(data, size, &place)) {
    eo_error_set(error, EO_ERROR_INPUT, "", "Line %d, column %d: more than %d brackets within brackets.", place.line,
                 place.column, EO_JSON_DEPTH);
    return NULL;
  }
  json_error_t fault;
  json_t *value = json_loadb(data, size, JSON_REJECT_DUPLICATES, &fault);
  if (!value)
    report(&fault, error);
  else if (!json_is_object(value)) {
    eo_error_set(error, EO_ERROR_INPUT, "", "The document must be a JSON object, not an array.");
    json_decref(value);
    value = NULL;
  }
  return value;
}

json_t *eo_json_load(const char *path, size_t limit, struct eo_error *error)
{
  struct eo_text text = {0};
  if (eo_text_read(&text, path, limit, error))
    return NULL;
  json_t *value = eo_json_parse(text.data ? text.data : "", text.size, error);
  eo_text_done(&text);
  return value;
}

const json_t *eo_json_find(const json_t *value, const char *path)
{
  while (value && *path) {
    size_t length = strcspn(path, "/");
    value = json_object_getn(value, path, length);
    path += length + (path[length] == '/');
  }
  return value;
}

double eo_json_find_number(const json_t *value, const char *path)
{
  const json_t *found = eo_json_find(value, path);
  return json_is_number(found) ? json_number_value(found) : NAN;
}
