/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/request.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "format/inch.h"
#include "format/json.h"
#include "http/connection.h"
#include "http/http_private.h"
#include "http/resource.h"

static const struct {
  unsigned method;
  const char *name;
} methods[] = {{EO_GET, "GET"}, {EO_POST, "POST"}, {EO_PUT, "PUT"}, {EO_DELETE, "DELETE"}, {EO_OPTIONS, "OPTIONS"}};

const char *eo_method_name(unsigned method)
{
  for (size_t i = 0; i < sizeof methods / sizeof methods[0]; i++)
    if (methods[i].method == method)
      return methods[i].name;
  return "";
}

/* HEAD is GET without the bytes; the library leaves them out. */
static unsigned method_of(const char *name, bool *head)
{
  static const unsigned known[] = {EO_GET, EO_POST, EO_PUT, EO_DELETE, EO_OPTIONS};
  *head = strcmp(name, "HEAD") == 0;
  for (size_t i = 0; i < sizeof known / sizeof known[0]; i++)
    if (strcmp(eo_method_name(known[i]), *head ? "GET" : name) == 0)
      return known[i];
  return 0;
}

static void name_client(struct eo_request *request)
{
  struct eo_client client = eo_client_of(&request->http->proxies, &request->place->address,
                                         eo_request_header(request, "X-Forwarded-For"),
                                         eo_request_header(request, "X-Forwarded-Proto"));
  memcpy(request->client, client.text, sizeof request->client);
  memcpy(request->client_key, client.key, sizeof request->client_key);
  request->secure = client.secure;
}

/* The path as the table of routes knows it: a proxy may hand on the path under which it shows the server, or not. */
static const char *below_base(const struct eo_http *http, const char *path)
{
  const char *base = http->settings.limits.base_path;
  size_t length = strlen(base);
  return length && strncmp(path, base, length) == 0 && path[length] == '/' ? path + length : path;
}

struct eo_request *eo_request_new(struct eo_http *http, struct MHD_Connection *connection, const char *path,
                                  const char *method)
{
  struct eo_request *request = calloc(1, sizeof *request);
  const union MHD_ConnectionInfo *info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_SOCKET_CONTEXT);
  if (!request)
    return NULL;
  request->http = http;
  request->store = http->store;
  request->connection = connection;
  request->place = info ? info->socket_context : NULL;
  request->started = eo_clock_milliseconds();
  request->path = strdup(below_base(http, path));
  request->method_name = strdup(method);
  if (!request->place || !request->path || !request->method_name) {
    eo_request_free(request);
    return NULL;
  }
  request->method = method_of(method, &request->head);
  request->reply.request = request->id;
  request->reply.log = http->log;
  request->reply.storage = http->storage;
  request->user = "-";
  name_client(request);
  snprintf(request->id, sizeof request->id, "%08x%08x", (unsigned)(http->run & 0xffffffff),
           (unsigned)(++http->requests & 0xffffffff));
  return request;
}

void eo_request_free(struct eo_request *request)
{
  if (!request)
    return;
  json_decref(request->document);
  eo_text_done(&request->body);
  eo_reply_done(&request->reply);
  free(request->path);
  free(request->method_name);
  free(request);
}

const char *eo_request_header(const struct eo_request *request, const char *name)
{
  return MHD_lookup_connection_value(request->connection, MHD_HEADER_KIND, name);
}

const char *eo_request_query(const struct eo_request *request, const char *name)
{
  return MHD_lookup_connection_value(request->connection, MHD_GET_ARGUMENT_KIND, name);
}

void *eo_request_memory(struct eo_request *request, size_t size)
{
  void *memory = calloc(1, size);
  if (!memory)
    eo_reply_no_memory(&request->reply);
  return memory;
}

const json_t *eo_request_json(struct eo_request *request)
{
  struct eo_error error;
  if (request->document)
    return request->document;
  request->document = eo_json_parse(request->body.data ? request->body.data : "", request->body.size, &error);
  if (!request->document && error.code == EO_ERROR_INPUT)
    eo_reply_problem(&request->reply, 400, "not-json", "%s", error.text);
  else if (!request->document)
    eo_reply_error(&request->reply, "", &error);
  return request->document;
}

bool eo_request_design(struct eo_request *request, const json_t *document, const char *path, struct eo_design *design,
                       struct eo_geometry *geometry, struct eo_warnings *warnings)
{
  struct eo_faults *faults = eo_request_memory(request, sizeof *faults);
  struct eo_error error;
  bool good = false;
  if (!faults)
    return false;
  if (!eo_design_decode(document, design, warnings, faults))
    eo_reply_faults(&request->reply, path, faults);
  else if (eo_design_complete(design, geometry, &error)) {
    eo_inch_place(document, &error);
    eo_reply_error(&request->reply, path, &error);
  } else
    good = true;
  if (good && warnings)
    eo_design_note_findings(design, geometry, warnings);
  free(faults);
  return good;
}

void eo_reply_table(struct eo_request *request, struct eo_text *text)
{
  if (request->reply.inches)
    eo_inch_table(text);
  eo_reply_text(&request->reply, 200, "text/csv; charset=utf-8", text);
}

bool eo_request_id_at(struct eo_request *request, int n, int64_t *key)
{
  if (eo_field_integer(request->argument[n], key) && *key > 0)
    return true;
  eo_reply_problem(&request->reply, 404, NULL, "There is nothing with this number.");
  return false;
}

bool eo_request_unchanged(struct eo_request *request, const char *tag)
{
  const char *known = eo_request_header(request, "If-None-Match");
  snprintf(request->reply.tag, sizeof request->reply.tag, "%s", tag);
  request->reply.revalidate = true;
  if (!known || !eo_field_lists_tag(known, tag, true))
    return false;
  eo_reply_empty(&request->reply, 304);
  return true;
}

void eo_request_resource(struct eo_request *request, const struct eo_resource *resource)
{
  if (eo_request_unchanged(request, resource->tag))
    return;
  request->reply.status = 200;
  request->reply.type = resource->type;
  request->reply.resource = resource;
}
