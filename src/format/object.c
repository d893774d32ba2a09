/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "format/object.h"

#include <math.h>
#include <stdlib.h>

#include "format/json.h"

json_t *eo_json_quantity(double value, const struct eo_unit *unit)
{
  double outside = eo_unit_round(unit, value, EO_DIGITS_NUMBER);
  return isfinite(outside) ? json_real(outside) : json_null();
}

json_t *eo_json_column(int count, const double *value, double scale, const struct eo_unit *unit, int digits)
{
  double *scaled = malloc(sizeof *scaled * (size_t)(count ? count : 1));
  for (int i = 0; i < count && scaled; i++)
    scaled[i] = value[i] * scale;
  json_t *column = scaled ? eo_json_reals(count, scaled, 1, unit, digits) : NULL;
  free(scaled);
  return column;
}

struct eo_object eo_object_open(void)
{
  struct eo_object object = {.json = json_object()};
  object.failed = !object.json;
  return object;
}

void eo_object_put(struct eo_object *object, const char *key, json_t *value)
{
  eo_json_put(object->json, key, value, &object->failed);
}

struct eo_object eo_list_open(void)
{
  struct eo_object list = {.json = json_array()};
  list.failed = !list.json;
  return list;
}

void eo_list_add(struct eo_object *list, json_t *value)
{
  list->failed = json_array_append_new(list->json, value) != 0 || list->failed;
}

json_t *eo_object_close(struct eo_object *object)
{
  if (!object->failed)
    return object->json;
  json_decref(object->json);
  return NULL;
}
