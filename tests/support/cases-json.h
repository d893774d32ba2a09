/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reading reference files in tests. */
#ifndef EASEOFF_TESTS_SUPPORT_CASES_JSON_H
#define EASEOFF_TESTS_SUPPORT_CASES_JSON_H

#include <jansson.h>
#include <stdlib.h>
#include <string.h>

#include "support/tap.h"

/* A file of $CASES (tests/cases when unset); the reference is the caller's. */
__attribute__((unused)) static json_t *load_cases(const char *name)
{
  char path[4096];
  json_error_t fault = {0};
  const char *folder = getenv("CASES");
  snprintf(path, sizeof path, "%s/%s", folder ? folder : "tests/cases", name);
  json_t *json = json_load_file(path, JSON_REJECT_DUPLICATES, &fault);
  ok(json != NULL, "%s is read %s", name, fault.text);
  return json;
}

/* The member of an array whose "id" is given; borrowed. */
__attribute__((unused)) static json_t *find_case(const json_t *array, const char *id)
{
  size_t i;
  json_t *item;
  json_array_foreach(array, i, item) if (json_string_value(json_object_get(item, "id")) &&
                                         !strcmp(json_string_value(json_object_get(item, "id")), id)) return item;
  return NULL;
}

__attribute__((unused)) static double number_of(const json_t *object, const char *key)
{
  return json_number_value(json_object_get(object, key));
}

#endif
