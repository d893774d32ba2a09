/* SPDX-License-Identifier: GPL-3.0-or-later */
/* JSON objects as they are written, numbers with their unit and digits. What the program answers with has an outline
   (outline.h) that writes it; this is for what has none: objects of another's form, and keys that are data. */
#ifndef EASEOFF_FORMAT_OBJECT_H
#define EASEOFF_FORMAT_OBJECT_H

#include <stdbool.h>

#include <jansson.h>

#include "format/unit.h"

/* Significant digits of what is written. */
enum { EO_DIGITS_CURVE = 9, EO_DIGITS_MAP = 6, EO_DIGITS_NUMBER = 12 };

/* A number in SI in the unit of the document (NULL: as it is). New; NULL without memory. */
json_t *eo_json_quantity(double value, const struct eo_unit *unit);

/* value[count] times scale. */
json_t *eo_json_column(int count, const double *value, double scale, const struct eo_unit *unit, int digits);

/* A JSON object while it is written: object[key] = value; what is missing marks the object itself as failed. */
struct eo_object {
  json_t *json;
  bool failed;
};
struct eo_object eo_object_open(void);
void eo_object_put(struct eo_object *object, const char *key, json_t *value);
/* An array while it is written: the same struct, opened so. */
struct eo_object eo_list_open(void);
void eo_list_add(struct eo_object *list, json_t *value);
json_t *eo_object_close(struct eo_object *object); /* NULL when anything failed */

#endif
