/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/openapi.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "format/json.h"
#include "http/guard.h"
#include "http/openapi_examples.h"
#include "http/problems.h"
#include "http/route.h"
#include "http/schemas.h"

#include <config.h>

static json_t *reference(const char *name, size_t length)
{
  json_t *text = json_sprintf("#/components/schemas/%.*s", (int)length, name);
  return text ? json_pack("{s:o}", "$ref", text) : NULL;
}

/* "Name", or one of several: "One|Other". */
static json_t *reference_any(const char *names, size_t length)
{
  const char *bar = memchr(names, '|', length);
  if (!bar)
    return reference(names, length);
  size_t first = (size_t)(bar - names);
  return json_pack("{s:[o, o]}", "anyOf", reference(names, first), reference_any(bar + 1, length - first - 1));
}

static json_t *encode_parameter(const char *name, size_t length, const char *place, json_t *schema, const char *help)
{
  return json_pack("{s:s%, s:s, s:b, s:s, s:o}", "name", name, length, "in", place, "required",
                   strcmp(place, "path") == 0, "description", help, "schema", schema);
}

static void add_path_parameters(json_t *list, const char *pattern)
{
  for (const char *open = strchr(pattern, '{'); open; open = strchr(open + 1, '{')) {
    size_t length = strcspn(open + 1, "}");
    bool number = length == 2 && strncmp(open + 1, "id", 2) == 0;
    json_array_append_new(list, encode_parameter(open + 1, length, "path",
                                                 json_pack("{s:s}", "type", number ? "integer" : "string"),
                                                 number ? "number" : "name"));
  }
}

static json_t *encode_words(const char *words)
{
  json_t *list = json_array();
  while (*words) {
    size_t length = strcspn(words, "|");
    json_array_append_new(list, json_stringn(words, length));
    words += length + (words[length] == '|');
  }
  return json_pack("{s:s, s:o}", "type", "string", "enum", list);
}

/* Words with commas between them, in one parameter. */
static json_t *encode_many(const char *words)
{
  return json_pack("{s:s, s:o}", "type", "array", "items", encode_words(words));
}

static json_t *encode_range(const struct eo_query *query)
{
  json_t *schema = json_pack("{s:s, s:I, s:I}", "type", "integer", "minimum", (json_int_t)query->low, "maximum",
                             (json_int_t)query->high);
  if (query->fallback >= query->low)
    json_object_set_new(schema, "default", json_integer((json_int_t)query->fallback));
  return schema;
}

static json_t *encode_query(const struct eo_query *query)
{
  json_t *schema = eo_query_is_list(query)   ? encode_many(query->words)
                   : eo_query_is_text(query) ? json_pack("{s:s, s:i}", "type", "string", "maxLength", EO_QUERY_TEXT)
                   : query->words            ? encode_words(query->words)
                                             : encode_range(query);
  json_t *parameter = encode_parameter(query->name, strlen(query->name), "query", schema, query->help);
  if (eo_query_is_list(query)) {
    json_object_set_new(parameter, "style", json_string("form"));
    json_object_set_new(parameter, "explode", json_false());
  }
  return parameter;
}

static void add_queries(json_t *list, const struct eo_route *route)
{
  for (const struct eo_query *query = route->query; query < route->query + EO_MOST_QUERIES && query->name; query++)
    json_array_append_new(list, encode_query(query));
}

static bool next_name(const char **list, const char **name, size_t *length)
{
  *list += strspn(*list, ", ");
  *name = *list;
  *length = strcspn(*list, ",");
  *list += *length;
  return *length > 0;
}

static json_t *require(json_t *parameter, bool required)
{
  if (required)
    json_object_set_new(parameter, "required", json_true());
  return parameter;
}

static void add_headers(json_t *list, const char *headers, unsigned method)
{
  static const struct {
    const char *name, *help;
  } known[] = {
      {"If-Match", "the ETag of the version that is meant, or *"},
      {"If-None-Match", "an ETag that is known already: 304 when it still holds"},
      {"Prefer", "wait=SECONDS (at most 60): wait for the preparation of the gear pair; respond-async: as a job, where "
                 "the summary says so"},
      {"Easeoff-Lane",
       "a token of the client's own: a newer question with the same token takes the place of one that still waits"},
      {"Idempotency-Key", "a token of the client's own: the same order with the same token is one job"},
      {"Last-Event-ID", "the number of the last event that was seen"}};
  const char *name;
  size_t length;
  while (headers && next_name(&headers, &name, &length))
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++)
      if (strlen(known[i].name) == length && strncmp(known[i].name, name, length) == 0)
        json_array_append_new(
            list, require(encode_parameter(name, length, "header", json_pack("{s:s}", "type", "string"), known[i].help),
                          method == EO_PUT && strcmp(known[i].name, "If-Match") == 0));
}

static void add_example(json_t *content, const char *type, json_t *example)
{
  if (example)
    json_object_set_new(json_object_get(content, type), "example", example);
}

static json_t *encode_content(const char *what, size_t length, bool csv)
{
  json_t *content = json_object();
  if (memchr(what, '/', length))
    json_object_setn_new(content, what, length, json_pack("{s:{s:s}}", "schema", "type", "string"));
  else
    json_object_set_new(content, "application/json", json_pack("{s:o}", "schema", reference_any(what, length)));
  add_example(content, "application/json", eo_openapi_answer_example(what, length));
  if (csv)
    json_object_set_new(content, "text/csv", json_pack("{s:{s:s}}", "schema", "type", "string"));
  return content;
}

/* What a request can come to beside what it asked for. */
static bool can_come(const struct eo_route *route, unsigned status)
{
  bool changes = route->method & (EO_POST | EO_PUT | EO_DELETE),
       conditional = route->headers && strstr(route->headers, "If-Match");
  switch (status) {
  case 401:
    return !route->open;
  case 403:
    return changes;
  case 404:
    return strchr(route->pattern, '{');
  case 409:
    return changes || strstr(route->pattern, "/result") || (route->headers && strstr(route->headers, "Easeoff-Lane"));
  case 412:
    return conditional;
  case 413:
  case 415:
  case 422:
    return route->takes;
  case 428:
    return conditional && route->method == EO_PUT;
  case 429:
    return route->rate != EO_RATE_FREE || route->form;
  case 507:
    return changes;
  default:
    return true;
  }
}

static void add_problems(json_t *answers, const struct eo_route *route)
{
  static const struct {
    unsigned status;
    const char *what;
  } known[] = {{400, "the request is malformed"},
               {401, "the token is missing or wrong"},
               {403, "not from a page of another site"},
               {404, "there is nothing with this number"},
               {409, "not in its present state"},
               {412, "the design has changed"},
               {413, "the body is too long"},
               {415, "another type of body is expected"},
               {421, "not under this name"},
               {422, "values are wrong; errors points at each"},
               {428, "If-Match is missing"},
               {429, "more than one client may ask for at once; Retry-After"},
               {500, "the server failed"},
               {503, "not now; Retry-After"},
               {507, "there is no room"}};
  for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
    char status[8];
    struct eo_text text = {0};
    snprintf(status, sizeof status, "%u", known[i].status);
    if (!can_come(route, known[i].status))
      continue;
    eo_text_print(&text, "%s: ", known[i].what);
    if (!eo_problems_list(known[i].status, &text))
      text.data[text.size -= 2] = '\0';
    json_t *answer = json_object_get(answers, status),
           *problem = json_pack("{s:{s:o}}", "application/problem+json", "schema", reference("Problem", 7));
    if (known[i].status == 422)
      add_example(problem, "application/problem+json", eo_openapi_answer_example("Problem", 7));
    if (!answer)
      json_object_set_new(answers, status,
                          json_pack("{s:s, s:o}", "description", text.failed ? "" : text.data, "content", problem));
    else {
      json_object_update(problem, json_object_get(answer, "content"));
      json_object_set_new(answer, "content", problem);
    }
    eo_text_done(&text);
  }
}

static const char *describe_success(const char *status)
{
  static const struct {
    const char *status, *what;
  } known[] = {{"200", "what was asked for"},
               {"201", "stored; Location says where"},
               {"202", "taken; Location names the job that works on it"},
               {"204", "done; there is nothing to say"},
               {"503", "not now"}};
  for (size_t i = 0; i < sizeof known / sizeof known[0]; i++)
    if (strncmp(known[i].status, status, 3) == 0)
      return known[i].what;
  return "done";
}

static json_t *encode_answers(const struct eo_route *route)
{
  json_t *answers = json_object();
  const char *list = route->gives, *name;
  size_t length;
  while (next_name(&list, &name, &length)) {
    json_t *answer = json_object_getn(answers, name, 3), *content;
    if (!answer) {
      answer = json_pack("{s:s}", "description", describe_success(name));
      json_object_setn_new(answers, name, 3, answer);
    }
    if (name[4] == '-')
      continue;
    content = encode_content(name + 4, length - 4, route->csv && strncmp(name, "200", 3) == 0);
    json_object_update(content, json_object_get(answer, "content"));
    json_object_set_new(answer, "content", content);
  }
  if (route->headers && strstr(route->headers, "If-None-Match"))
    json_object_set_new(answers, "304", json_pack("{s:s}", "description", "the known version still holds"));
  add_problems(answers, route);
  json_object_set_new(answers, "default",
                      json_pack("{s:s, s:{s:{s:o}}}", "description", "a problem (RFC 9457)", "content",
                                "application/problem+json", "schema", reference("Problem", 7)));
  return answers;
}

static const char *body_type(const struct eo_route *route)
{
  return strchr(route->takes, '/') ? route->takes : route->form ? "multipart/form-data" : "application/json";
}

static json_t *body_schema(const struct eo_route *route)
{
  return strchr(route->takes, '/') ? json_pack("{s:s, s:s}", "type", "string", "format", "binary")
                                   : reference_any(route->takes, strlen(route->takes));
}

/* With the size that it may have; of a form what the limits say. */
static json_t *encode_body(const struct eo_route *route)
{
  json_t *content = json_pack("{s:{s:o}}", body_type(route), "schema", body_schema(route));
  add_example(content, body_type(route), eo_openapi_body_example(route));
  json_t *body = json_pack("{s:b, s:o}", "required", !route->takes_nothing, "content", content);
  if (!route->form)
    json_object_set_new(body, "x-max-bytes",
                        json_integer((json_int_t)(route->body ? route->body : EO_JSON_DESIGN_BYTES)));
  return body;
}

/* What of x-limits counts a request. */
static void add_rate(json_t *operation, const struct eo_route *route)
{
  static const char *const names[EO_RATE_KINDS] = {NULL, "questions_at_once, questions_per_second",
                                                   "starts_at_once, starts_per_second", "wrong_tokens_per_minute"};
  if (names[route->rate])
    json_object_set_new(operation, "x-rate", json_string(names[route->rate]));
}

static json_t *encode_operation(const struct eo_route *route)
{
  json_t *parameters = json_array();
  add_path_parameters(parameters, route->pattern);
  add_queries(parameters, route);
  add_headers(parameters, route->headers, route->method);
  json_t *operation = json_pack("{s:s, s:s, s:o, s:o}", "operationId", route->name, "summary", route->summary,
                                "parameters", parameters, "responses", encode_answers(route));
  if (route->takes)
    json_object_set_new(operation, "requestBody", encode_body(route));
  add_rate(operation, route);
  if (route->csv)
    json_object_set_new(operation, "description",
                        json_sprintf("As text/csv by the Accept header, or at %s%s.csv.", EO_API, route->pattern));
  if (route->open)
    json_object_set_new(operation, "security", json_array());
  return operation;
}

static json_t *encode_paths(const struct eo_route *const *routes)
{
  json_t *paths = json_object();
  for (; *routes; routes++)
    for (const struct eo_route *route = *routes; route->pattern; route++) {
      char method[8] = "";
      const char *name = eo_method_name(route->method);
      json_t *path = json_object_get(paths, route->pattern);
      if (!path) {
        path = json_object();
        json_object_set_new(paths, route->pattern, path);
      }
      for (size_t k = 0; k < sizeof method - 1 && name[k]; k++)
        method[k] = (char)tolower((unsigned char)name[k]);
      json_object_set_new(path, method, encode_operation(route));
    }
  return paths;
}

/* What this server allows, key by key as `easeoff serve --help` describes it. */
static json_t *encode_limits(const struct eo_http_limits *http, const struct eo_service_limits *work)
{
  json_t *requests = eo_table_encode(&eo_http_limits_table, http);
  static const char *const own[] = {"base_path", "trusted_proxies", "log_level"}; /* of whoever runs it */
  for (size_t i = 0; i < sizeof own / sizeof *own; i++)
    json_object_del(requests, own[i]);
  return json_pack("{s:o, s:o}", "requests", requests, "work", eo_table_encode(&eo_service_limits_table, work));
}

json_t *eo_openapi(const struct eo_route *const *routes, const struct eo_http_limits *http,
                   const struct eo_service_limits *work)
{
  return json_pack(
      "{s:s, s:{s:s, s:s, s:s, s:o}, s:[{s:s}], s:[{s:[]}, {s:[]}], s:o, s:{s:o, s:{s:{s:s, s:s}, s:{s:s, s:s, s:s}}}}",
      "openapi", "3.1.0", "info", "title", "Easeoff", "version", PACKAGE_VERSION, "description",
      "Quiet herringbone gears by tooth micro-geometry. x-limits: what this server allows; x-rate of an operation: "
      "which "
      "of them count it; x-max-bytes of a body: its most.",
      "x-limits", encode_limits(http, work), "servers", "url", EO_API, "security", "token", "session", "paths",
      encode_paths(routes), "components", "schemas", eo_openapi_schemas(routes), "securitySchemes", "token", "type",
      "http", "scheme", "bearer", "session", "type", "apiKey", "in", "cookie", "name", eo_guard_cookie);
}
