/* SPDX-License-Identifier: GPL-3.0-or-later */
/* As much of JSON Schema 2020-12 as the API's own description uses, and stricter: every key that comes must be
   described, also where more may come one day, and so must every object. */
#ifndef EASEOFF_TESTS_API_SCHEMA_H
#define EASEOFF_TESTS_API_SCHEMA_H

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include <jansson.h>

struct schema_fault {
  char text[300];
};

/* Marks the properties that came. */
#define SCHEMA_SEEN "x-seen"

static bool fits(const json_t *root, const json_t *schema, const json_t *value, const char *path,
                 struct schema_fault *fault);

static bool misfit(struct schema_fault *fault, const char *path, const char *what)
{
  snprintf(fault->text, sizeof fault->text, "%.200s: %.80s", *path ? path : "/", what);
  return false;
}

static const json_t *follow(const json_t *root, const char *reference)
{
  static const char start[] = "#/components/schemas/";
  if (strncmp(reference, start, sizeof start - 1) != 0)
    return NULL;
  return json_object_get(json_object_get(json_object_get(root, "components"), "schemas"), reference + sizeof start - 1);
}

static bool has_type(const char *type, const json_t *value)
{
  return (strcmp(type, "object") == 0 && json_is_object(value)) ||
         (strcmp(type, "array") == 0 && json_is_array(value)) ||
         (strcmp(type, "string") == 0 && json_is_string(value)) ||
         (strcmp(type, "boolean") == 0 && json_is_boolean(value)) ||
         (strcmp(type, "null") == 0 && json_is_null(value)) ||
         (strcmp(type, "integer") == 0 && json_is_integer(value)) ||
         (strcmp(type, "number") == 0 && json_is_number(value));
}

static bool fits_object(const json_t *root, const json_t *schema, const json_t *value, const char *path,
                        struct schema_fault *fault)
{
  const json_t *properties = json_object_get(schema, "properties"), *required,
               *others = json_object_get(schema, "additionalProperties"); /* where keys are data */
  const char *key;
  json_t *member;
  size_t i;
  char longer[300];
  json_array_foreach(
      json_object_get(schema, "required"), i,
      required) if (!json_object_get(value, json_string_value(required))) return misfit(fault, path,
                                                                                        json_string_value(required));
  json_object_foreach((json_t *)value, key, member)
  {
    const json_t *inner = json_object_get(properties, key);
    snprintf(longer, sizeof longer, "%.200s/%.80s", path, key);
    if (!inner && json_is_object(others))
      inner = others;
    if (!inner)
      return misfit(fault, longer, "a key that the schema does not know");
    json_object_set_new((json_t *)inner, SCHEMA_SEEN, json_true());
    if (!fits(root, inner, member, longer, fault))
      return false;
  }
  return true;
}

static bool fits_array(const json_t *root, const json_t *schema, const json_t *value, const char *path,
                       struct schema_fault *fault)
{
  const json_t *items = json_object_get(schema, "items"), *member, *least = json_object_get(schema, "minItems"),
               *most = json_object_get(schema, "maxItems");
  size_t i;
  char longer[300];
  if ((least && json_array_size(value) < (size_t)json_integer_value(least)) ||
      (most && json_array_size(value) > (size_t)json_integer_value(most)))
    return misfit(fault, path, "the number of items");
  if (!items)
    return misfit(fault, path, "an array of nobody knows what");
  json_array_foreach(value, i, member)
  {
    snprintf(longer, sizeof longer, "%.200s/%zu", path, i);
    if (!fits(root, items, member, longer, fault))
      return false;
  }
  return true;
}

/* The fault of the first choice is told: the others are mostly null. */
static bool fits_any(const json_t *root, const json_t *choices, const json_t *value, const char *path,
                     struct schema_fault *fault)
{
  const json_t *choice;
  struct schema_fault other;
  size_t i;
  json_array_foreach(choices, i, choice) if (fits(root, choice, value, path, i ? &other : fault)) return true;
  return false;
}

static bool fits_type(const json_t *type, const json_t *value)
{
  const json_t *choice;
  size_t i;
  bool fitting = !type || (json_is_string(type) && has_type(json_string_value(type), value));
  json_array_foreach(type, i, choice) fitting = fitting || has_type(json_string_value(choice), value);
  return fitting;
}

static bool fits(const json_t *root, const json_t *schema, const json_t *value, const char *path,
                 struct schema_fault *fault)
{
  const char *reference = json_string_value(json_object_get(schema, "$ref"));
  const json_t *type = json_object_get(schema, "type"), *choices = json_object_get(schema, "anyOf"),
               *words = json_object_get(schema, "enum"), *word;
  const json_t *low = json_object_get(schema, "minimum"), *high = json_object_get(schema, "maximum");
  size_t i;
  bool named = !words;
  if (reference && !follow(root, reference))
    return misfit(fault, path, "a schema that is not there");
  if (reference)
    return fits(root, follow(root, reference), value, path, fault);
  if (choices)
    return fits_any(root, choices, value, path, fault);
  if (!type) /* anything, and said so */
    return true;
  if (!fits_type(type, value))
    return misfit(fault, path, json_is_string(type) ? json_string_value(type) : "another type");
  json_array_foreach(words, i, word) named = named || json_equal(word, value);
  if (!named)
    return misfit(fault, path, "a word that the schema does not know");
  if (json_is_number(value) && ((low && json_number_value(value) < json_number_value(low)) ||
                                (high && json_number_value(value) > json_number_value(high))))
    return misfit(fault, path, "the range");
  if (json_is_object(value))
    return fits_object(root, schema, value, path, fault);
  return !json_is_array(value) || fits_array(root, schema, value, path, fault);
}

#endif
