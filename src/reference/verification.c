#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "reference/verify.h"
#include "format/json.h"

static struct eo_check *next_check(struct eo_verification *v)
{
  if (v->count == v->capacity) {
    int capacity = v->capacity ? 2 * v->capacity : 64;
    struct eo_check *check = realloc(v->check, (size_t)capacity * sizeof *check);
    if (!check)
      return NULL;
    v->check = check;
    v->capacity = capacity;
  }
  return &v->check[v->count];
}

void eo_verify_add(struct eo_verification *v, const char *label, const char *quantity, double value, double expected,
                   double tolerance)
{
  bool pass = value == expected || fabs(value - expected) <= tolerance;
  struct eo_check *check = v->failed ? NULL : next_check(v);
  char *label_copy = strdup(label), *quantity_copy = strdup(quantity);
  if (!check || !label_copy || !quantity_copy) {
    free(label_copy);
    free(quantity_copy);
    v->failed = true;
    return;
  }
  *check = (struct eo_check){label_copy, quantity_copy, value, expected, tolerance, pass};
  v->count++;
}

void eo_verify_broken(struct eo_verification *v, const char *label, const struct eo_error *error)
{
  eo_verify_add(v, label, "computed at all", NAN, 1, 0);
  eo_verify_ignore(v, "%s could not be computed: %s%s%s", label, error->pointer, *error->pointer ? ": " : "",
                   error->text);
}

void eo_verify_ignore(struct eo_verification *v, const char *format, ...)
{
  char line[600], clean[300];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  eo_text_clean(clean, sizeof clean, line);
  if (json_array_append_new(v->ignored, json_string_nocheck(clean)) != 0)
    v->failed = true;
}

void eo_verify_unknown(struct eo_verification *v, const char *where, const json_t *object, const char *const *known)
{
  const char *key;
  json_t *value;
  json_object_foreach((json_t *)object, key, value)
  {
    bool found = false;
    for (int i = 0; known[i] && !found; i++)
      found = strcmp(known[i], key) == 0;
    if (!found)
      eo_verify_ignore(v, "%s: \"%s\" is not a key of this kind", where, key);
  }
}

double eo_verify_number(const json_t *object, const char *key)
{
  const json_t *value = json_object_get(object, key);
  return json_is_number(value) ? json_number_value(value) : NAN;
}

double eo_verify_number_or(const json_t *object, const char *key, double missing)
{
  double value = eo_verify_number(object, key);
  return isnan(value) ? missing : value;
}

double eo_verify_element(const json_t *object, const char *key, int index)
{
  const json_t *value = json_array_get(json_object_get(object, key), (size_t)index);
  return json_is_number(value) ? json_number_value(value) : NAN;
}

double eo_verify_at(const json_t *array, size_t index)
{
  const json_t *value = json_array_get(array, index);
  return json_is_number(value) ? json_number_value(value) : NAN;
}

double eo_verify_rounding(double printed)
{
  char text[40];
  eo_json_number(text, sizeof text, printed);
  const char *exponent = strpbrk(text, "e"), *point = strchr(text, '.');
  int decimals = point ? (int)((exponent ? (size_t)(exponent - point) : strlen(point)) - 1) : 0;
  return 0.5 * pow(10, (exponent ? atoi(exponent + 1) : 0) - decimals);
}

char *eo_verify_path(const struct eo_verification *v, const char *name)
{
  struct eo_text text = {0};
  eo_text_print(&text, "%s%s%s", name[0] == '/' ? "" : v->folder, name[0] == '/' ? "" : "/", name);
  if (text.failed)
    eo_text_done(&text);
  return text.data;
}
