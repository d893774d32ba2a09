#include "http/request.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "format/json.h"
#include "http/route.h"
#include "http/server.h"
#include "http/upload.h"

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
  request->path = strdup(path);
  request->method_name = strdup(method);
  if (!request->place || !request->path || !request->method_name) {
    eo_request_free(request);
    return NULL;
  }
  request->method = method_of(method, &request->head);
  snprintf(request->id, sizeof request->id, "%08x%08x", (unsigned)(http->run & 0xffffffff),
           (unsigned)(++http->requests & 0xffffffff));
  return request;
}

void eo_request_free(struct eo_request *request)
{
  if (!request)
    return;
  eo_upload_free(request);
  json_decref(request->document);
  eo_text_done(&request->body);
  eo_text_done(&request->reply.body);
  if (request->reply.stream)
    MHD_destroy_response(request->reply.stream);
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

double eo_request_number(const struct eo_request *request, const char *name)
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

const json_t *eo_request_json(struct eo_request *request)
{
  struct eo_error error;
  if (request->document)
    return request->document;
  request->document = eo_json_parse(request->body.data ? request->body.data : "", request->body.size, &error);
  if (!request->document && error.code == EO_ERROR_INPUT)
    eo_reply_problem(request, 400, "not-json", "%s", error.text);
  else if (!request->document)
    eo_reply_error(request, "", &error);
  return request->document;
}

static bool decode(struct eo_request *request, const json_t *document, struct eo_faults *faults, void *order)
{
  eo_table_decode(request->route->order, document, NULL, order, faults);
  if (faults->count)
    eo_reply_faults(request, "", faults);
  return !faults->count;
}

/* Where there is a form, its parts; where the body may be left out, nothing in its place. */
static const json_t *find_document(struct eo_request *request, struct eo_faults *faults)
{
  if (request->upload)
    return request->document = eo_upload_document(request->upload, request->route->order, faults);
  if (request->route->takes_nothing && !request->body.size)
    return request->document = json_object();
  return eo_request_json(request);
}

bool eo_request_read(struct eo_request *request, void *order)
{
  struct eo_faults *faults = calloc(1, sizeof *faults);
  struct eo_error error;
  const json_t *document = faults ? find_document(request, faults) : NULL;
  bool good = document && decode(request, document, faults, order);
  if (!document && !request->reply.status)
    eo_reply_error(request, "", (eo_error_memory(&error), &error));
  free(faults);
  return good;
}

void eo_request_handle(struct eo_request *request)
{
  request->route->handle(request);
  json_decref(request->document);
  request->document = NULL;
}

bool eo_request_design(struct eo_request *request, const json_t *document, const char *path, struct eo_design *design,
                       struct eo_geometry *geometry, struct eo_warnings *warnings)
{
  struct eo_faults *faults = calloc(1, sizeof *faults);
  struct eo_error error;
  bool good = false;
  if (!faults)
    eo_reply_error(request, path, (eo_error_memory(&error), &error));
  else if (!eo_design_decode(document, design, warnings, faults))
    eo_reply_faults(request, path, faults);
  else if (eo_design_complete(design, geometry, &error))
    eo_reply_error(request, path, &error);
  else
    good = true;
  if (good && warnings)
    eo_design_note_assumptions(document, design, warnings);
  free(faults);
  return good;
}

bool eo_request_id_at(struct eo_request *request, int n, int64_t *key)
{
  if (eo_field_integer(request->argument[n], key) && *key > 0)
    return true;
  eo_reply_problem(request, 404, NULL, "There is nothing with this number.");
  return false;
}
