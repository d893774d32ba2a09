/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Holds every reply to call() against the OpenAPI document that the server gives. Programs that listen must end with
   tell_what_was_heard(). */
#ifndef EASEOFF_TESTS_API_DESCRIPTION_H
#define EASEOFF_TESTS_API_DESCRIPTION_H

#include "api/client.h"
#include "api/schema.h"
#include "support/tap.h"

static json_t *description; /* OpenAPI */
static int heard, misfits;

/* Whether "/jobs/{id}" is the template of "/jobs/7". */
static bool is_template(const char *template, const char *path)
{
  while (*template && *path) {
    if (*template == '{') {
      template += strcspn(template, "}") + 1;
      path += strcspn(path, "/");
    } else if (*template ++ != *path++)
      return false;
  }
  return !*template && !*path;
}

static const json_t *find_operation(const char *method, const char *path)
{
  char plain[200], lower[10] = "";
  const char *key;
  json_t *item;
  snprintf(plain, sizeof plain, "%.*s", (int)strcspn(path, "?"), path + strlen(API));
  plain[strcspn(plain, "?")] = '\0';
  for (int i = 0; method[i] && i < 9; i++)
    lower[i] = (char)(method[i] | 32);
  for (int exact = 1; exact >= 0; exact--)
    json_object_foreach(
        json_object_get(description, "paths"), key,
        item) if (exact ? strcmp(key, plain) == 0
                        : is_template(key, plain)) return json_object_get(item,
                                                                          strcmp(lower, "head") == 0 ? "get" : lower);
  return NULL;
}

/* The schema of a reply: of its status, or of a problem. */
static const json_t *find_schema(const json_t *operation, const struct reply *reply)
{
  char status[8], type[100];
  snprintf(status, sizeof status, "%d", reply->status);
  const char *header = header_of(reply, "Content-Type");
  snprintf(type, sizeof type, "%.*s", header ? (int)strcspn(header, ";") : 0, header ? header : "");
  const json_t *answers = json_object_get(operation, "responses"), *answer = json_object_get(answers, status);
  const json_t *content =
      json_object_get(json_object_get(answer ? answer : json_object_get(answers, "default"), "content"), type);
  if (!content)
    content = json_object_get(json_object_get(json_object_get(answers, "default"), "content"), type);
  return json_object_get(content, "schema");
}

static void check_reply(const char *method, const char *path, const struct reply *reply)
{
  struct schema_fault fault = {""};
  const json_t *operation = strncmp(path, API, strlen(API)) == 0 ? find_operation(method, path) : NULL;
  const char *type = header_of(reply, "Content-Type");
  bool json = type && strstr(type, "json");
  if (!operation || !json || !reply->size || header_of(reply, "Content-Encoding"))
    return;
  const json_t *schema = find_schema(operation, reply);
  json_t *body = json_loadb(reply->body, reply->size, 0, NULL);
  heard++;
  if (!schema || !body || !fits(description, schema, body, "", &fault)) {
    misfits++;
    printf("# %s %s, %d: %s\n", method, path, reply->status, schema ? body ? fault.text : "no JSON" : "not described");
  }
  json_decref(body);
}

/* False: the server does not describe itself. */
static bool listen_to_replies(void)
{
  int status;
  description = call_json("GET", API "/openapi.json", NULL, NULL, &status);
  listener = check_reply;
  return status == 200 && description;
}

static int count_unseen(const char *name, json_t *visited);

/* Of all schemas that this one names. */
static int count_unseen_below(const json_t *value, json_t *visited)
{
  const char *key, *reference = json_string_value(json_object_get(value, "$ref"));
  json_t *inner;
  size_t i;
  int unseen = reference ? count_unseen(strrchr(reference, '/') + 1, visited) : 0;
  json_array_foreach((json_t *)value, i, inner) unseen += count_unseen_below(inner, visited);
  json_object_foreach((json_t *)value, key, inner) unseen += count_unseen_below(inner, visited);
  return unseen;
}

/* Properties of answers that never came. Closed schemas are those of designs: a test need not use every key of them. */
static int count_unseen(const char *name, json_t *visited)
{
  const json_t *schema = json_object_get(json_object_get(json_object_get(description, "components"), "schemas"), name);
  const char *key;
  json_t *property;
  int unseen = 0;
  if (json_object_get(visited, name) || json_is_false(json_object_get(schema, "additionalProperties")))
    return 0;
  json_object_set_new(visited, name, json_true());
  json_object_foreach(json_object_get(schema, "properties"), key, property) if (!json_object_get(property, SCHEMA_SEEN))
  {
    printf("# %s/%s never came\n", name, key);
    unseen++;
  }
  return unseen + count_unseen_below(json_object_get(schema, "properties"), visited);
}

/* Names end with NULL. but: one that the program does not provoke, or NULL. */
__attribute__((unused)) static void expect_all_of(const char *const *names, const char *but)
{
  json_t *visited = json_object();
  int unseen = 0;
  if (but)
    json_object_set_new(visited, but, json_true());
  for (; *names; names++)
    unseen += count_unseen(*names, visited);
  ok(!unseen, "all that is described of %zu objects came", json_object_size(visited));
  json_decref(visited);
}

static void tell_what_was_heard(void)
{
  ok(heard > 0 && !misfits, "%d replies are as described, but for %d", heard, misfits);
  listener = NULL;
  json_decref(description);
}

#endif
