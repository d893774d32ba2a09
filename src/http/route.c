/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/route.h"

#include <stdio.h>
#include <string.h>

#include "http/http_private.h"
#include "store/spare.h"

enum { FULL = 507 };

static bool ends_with(const char *text, const char *end)
{
  size_t length = strlen(text), tail = strlen(end);
  return length > tail && strcmp(text + length - tail, end) == 0;
}

static bool matches(const struct eo_route *route, const char *path, struct eo_request *request)
{
  return eo_field_match(route->pattern, path, sizeof request->argument[0], request->argument, EO_ARGUMENTS);
}

/* All methods of a path, and the route of the request's own. */
static unsigned find(struct eo_request *request, const char *path, bool csv)
{
  unsigned allowed = 0;
  for (const struct eo_route *const *table = request->http->routes; *table; table++)
    for (const struct eo_route *route = *table; route->pattern; route++) {
      if ((csv && !route->csv) || !matches(route, path, request))
        continue;
      allowed |= route->method;
      if (route->method == request->method)
        request->route = route;
    }
  if (request->route)
    matches(request->route, path, request);
  return allowed;
}

static unsigned find_with_suffix(struct eo_request *request, const char *path)
{
  char without[256];
  size_t length = strlen(path);
  unsigned allowed = find(request, path, false);
  if (allowed || !ends_with(path, ".csv") || length >= sizeof without)
    return allowed;
  snprintf(without, sizeof without, "%.*s", (int)length - 4, path);
  request->csv = true;
  return find(request, without, true);
}

bool eo_route_find(struct eo_request *request)
{
  unsigned allowed = find_with_suffix(request, request->path + strlen(EO_API));
  if (!allowed)
    eo_reply_problem(&request->reply, 404, NULL,
                     "There is nothing at this address; " EO_API "/openapi.json lists what there is.");
  else if (request->method == EO_OPTIONS) {
    eo_reply_empty(&request->reply, 204);
    request->reply.allow = allowed | EO_OPTIONS;
  } else if (!request->route) {
    eo_reply_problem(&request->reply, 405, NULL, "This address does not answer that method.");
    request->reply.allow = allowed | EO_OPTIONS;
  } else {
    request->csv = request->csv ||
                   (request->route->csv && eo_field_prefers_type(eo_request_header(request, "Accept"), "text/csv"));
    return true;
  }
  return false;
}

/* Which word of the list this is; -1: none. */
static int word_of(const char *words, const char *word, size_t length)
{
  for (int i = 0; *words; i++) {
    size_t next = strcspn(words, "|");
    if (length == next && strncmp(words, word, length) == 0)
      return i;
    words += next + (words[next] == '|');
  }
  return -1;
}

/* Bits of the words of a list with commas; false: one is unknown. */
static bool words_of(const char *words, const char *value, unsigned *bits)
{
  *bits = 0;
  while (*value) {
    size_t length = strcspn(value, ",");
    int i = word_of(words, value, length);
    if (i < 0)
      return false;
    *bits |= 1u << i;
    value += length + (value[length] == ',');
  }
  return true;
}

static bool is_allowed(const struct eo_query *query, const char *value)
{
  int64_t number;
  unsigned bits;
  if (eo_query_is_text(query))
    return strlen(value) <= EO_QUERY_TEXT;
  if (query->words)
    return eo_query_is_list(query) ? words_of(query->words, value, &bits)
                                   : word_of(query->words, value, strlen(value)) >= 0;
  return eo_field_integer(value, &number) && (double)number >= query->low && (double)number <= query->high;
}

static enum MHD_Result check_one(void *context, enum MHD_ValueKind kind, const char *name, const char *value)
{
  struct eo_request *request = context;
  char shown[40];
  (void)kind;
  eo_text_clean(shown, sizeof shown, name);
  for (const struct eo_query *query = request->route->query;
       query < request->route->query + EO_MOST_QUERIES && query->name; query++) {
    if (strcmp(query->name, name) != 0)
      continue;
    if (value && is_allowed(query, value))
      return MHD_YES;
    if (eo_query_is_text(query))
      eo_reply_problem(&request->reply, 400, "query", "The query parameter %s takes a text of at most %d bytes.",
                       query->name, EO_QUERY_TEXT);
    else if (query->words)
      eo_reply_problem(&request->reply, 400, "query", "The query parameter %s takes %s %s.", query->name,
                       eo_query_is_list(query) ? "a list, with commas, of" : "one of", query->words);
    else
      eo_reply_problem(&request->reply, 400, "query", "The query parameter %s takes a whole number from %.0f to %.0f.",
                       query->name, query->low, query->high);
    return MHD_NO;
  }
  eo_reply_problem(&request->reply, 400, "query", "There is no query parameter \"%s\" here.", shown);
  return MHD_NO;
}

/* An option that would do nothing is refused: some documents have no other spelling than that of mm. */
static void take_units(struct eo_request *request)
{
  const char *units = eo_request_query(request, "units");
  request->reply.inches = units && strcmp(units, "inch") == 0;
  for (const struct eo_query *query = request->route->query;
       request->reply.inches && query < request->route->query + EO_MOST_QUERIES && query->name; query++)
    if (strcmp(query->name, "units") == 0 && query->low == EO_CSV_ALONE && request->route->csv && !request->csv)
      eo_reply_problem(&request->reply, 400, "query",
                       "The query parameter units=inch is for CSV here: ask for text/csv, or at %s.csv.",
                       request->path);
}

bool eo_route_check_query(struct eo_request *request)
{
  MHD_get_connection_values(request->connection, MHD_GET_ARGUMENT_KIND, check_one, request);
  if (!request->reply.status)
    take_units(request);
  return !request->reply.status;
}

unsigned eo_route_words(const struct eo_request *request, const char *name, bool *given)
{
  const char *text = eo_request_query(request, name);
  unsigned bits = 0;
  *given = text != NULL;
  for (const struct eo_query *query = request->route->query;
       text && query < request->route->query + EO_MOST_QUERIES && query->name; query++)
    if (strcmp(query->name, name) == 0)
      words_of(query->words, text, &bits);
  return bits;
}

double eo_route_number(const struct eo_request *request, const char *name)
{
  const char *text = eo_request_query(request, name);
  int64_t value;
  if (text && eo_field_integer(text, &value))
    return (double)value;
  for (const struct eo_query *query = request->route->query;
       query < request->route->query + EO_MOST_QUERIES && query->name; query++)
    if (strcmp(query->name, name) == 0)
      return query->fallback;
  return 0;
}

void eo_route_run(struct eo_request *request)
{
  request->route->handle(request);
  bool frees = request->method == EO_DELETE || request->route->frees;
  if (frees && request->reply.status == FULL && eo_spare_give(request->store)) {
    request->reply.status = 0; /* what is deleted makes more room than this */
    request->route->handle(request);
  }
  json_decref(request->document);
  request->document = NULL;
}
