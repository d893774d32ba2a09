#include "http/shape.h"

#include <ctype.h>
#include <stdbool.h>
#include <string.h>

static json_t *read_type(const char **at);

static void skip(const char **at)
{
  *at += strspn(*at, " \n");
}

static bool take(const char **at, const char *token)
{
  skip(at);
  size_t length = strlen(token);
  if (strncmp(*at, token, length) != 0)
    return false;
  *at += length;
  return true;
}

static size_t word_length(const char *at)
{
  size_t length = 0;
  while (isalnum((unsigned char)at[length]) || at[length] == '_')
    length++;
  return length;
}

static json_t *read_choices(const char **at)
{
  json_t *words = json_array();
  do {
    size_t length = strcspn(*at, "|'");
    json_array_append_new(words, json_stringn(*at, length));
    *at += length;
  } while (*(*at)++ == '|');
  return json_pack("{s:s, s:o}", "type", "string", "enum", words);
}

static bool read_member(const char **at, json_t *properties, json_t *required)
{
  skip(at);
  size_t length = word_length(*at);
  const char *key = *at;
  *at += length;
  bool optional = **at == '?';
  *at += optional;
  json_t *type = length ? read_type(at) : NULL;
  if (!optional)
    json_array_append_new(required, json_stringn(key, length));
  return type && json_object_setn_new(properties, key, length, type) == 0;
}

static json_t *read_object(const char **at)
{
  json_t *properties = json_object(), *required = json_array();
  bool good = true, open = false, closed = take(at, "}");
  while (good && !closed) {
    open = take(at, "...");
    good = open || read_member(at, properties, required);
    closed = take(at, "}");
    good = good && (closed || (!open && take(at, ",")));
  }
  if (good)
    return json_pack("{s:s, s:o, s:o, s:b}", "type", "object", "properties", properties, "required", required,
                     "additionalProperties", open);
  json_decref(properties);
  json_decref(required);
  return NULL;
}

static json_t *read_array(const char **at)
{
  json_t *items = read_type(at);
  if (items && take(at, "]"))
    return json_pack("{s:s, s:o}", "type", "array", "items", items);
  json_decref(items);
  return NULL;
}

static json_t *read_word(const char **at)
{
  static const char *const word[] = {"text", "number", "integer", "flag"}, *const type[] = {"string", "number",
                                                                                            "integer", "boolean"};
  size_t length = word_length(*at);
  const char *name = *at;
  *at += length;
  for (int i = 0; i < 4; i++)
    if (length == strlen(word[i]) && strncmp(name, word[i], length) == 0)
      return json_pack("{s:s}", "type", type[i]);
  if (length == 3 && strncmp(name, "any", 3) == 0)
    return json_object();
  if (!length || !isupper((unsigned char)*name))
    return NULL;
  json_t *reference = json_sprintf("#/components/schemas/%.*s", (int)length, name);
  return reference ? json_pack("{s:o}", "$ref", reference) : NULL;
}

static json_t *read_type(const char **at)
{
  json_t *type = take(at, "{")   ? read_object(at)
                 : take(at, "[") ? read_array(at)
                 : take(at, "'") ? read_choices(at)
                                 : (skip(at), read_word(at));
  if (!type || !take(at, "?"))
    return type;
  return json_pack("{s:[o, {s:s}]}", "anyOf", type, "type", "null");
}

json_t *eo_shape_schema(const char *notation)
{
  json_t *schema = read_type(&notation);
  skip(&notation);
  if (schema && !*notation)
    return schema;
  json_decref(schema);
  return NULL;
}
