#include "http/request.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "format/json.h"
#include "http/resource.h"
#include "http/route.h"
#include "http/server.h"

/* ---- making ---- */

void eo_reply_text(struct eo_request *request, unsigned status, const char *type, struct eo_text *text)
{
  struct eo_error error;
  if (text->failed) {
    eo_text_done(text);
    eo_error_memory(&error);
    eo_reply_error(request, "", &error);
    return;
  }
  eo_text_done(&request->reply.body);
  request->reply.status = status;
  request->reply.type = type;
  request->reply.body = *text;
  *text = (struct eo_text){0};
}

static void reply_document(struct eo_request *request, unsigned status, const char *type, json_t *document)
{
  struct eo_text text = {.failed = !document};
  if (document)
    eo_json_write(&text, document, EO_JSON_COMPACT);
  eo_text_add(&text, "\n");
  json_decref(document);
  eo_reply_text(request, status, type, &text);
}

void eo_reply_json(struct eo_request *request, unsigned status, json_t *document)
{
  reply_document(request, status, "application/json", document);
}

void eo_reply_empty(struct eo_request *request, unsigned status)
{
  eo_text_done(&request->reply.body);
  request->reply.status = status;
  request->reply.type = NULL;
}

void eo_reply_resource(struct eo_request *request, const struct eo_resource *resource)
{
  if (eo_reply_unchanged(request, resource->tag))
    return;
  request->reply.status = 200;
  request->reply.type = resource->type;
  request->reply.resource = resource;
}

bool eo_reply_unchanged(struct eo_request *request, const char *tag)
{
  const char *known = eo_request_header(request, "If-None-Match");
  snprintf(request->reply.tag, sizeof request->reply.tag, "%s", tag);
  request->reply.revalidate = true;
  if (!known || !eo_field_lists_tag(known, tag, true))
    return false;
  eo_reply_empty(request, 304);
  return true;
}

/* ---- problems ---- */

static const char *title_of(unsigned status)
{
  const char *phrase = MHD_get_reason_phrase_for(status);
  return phrase ? phrase : "Error";
}

/* Every pointer lies below the place of the document in the body. */
static json_t *encode_fault(const char *path, const struct eo_error *fault)
{
  char pointer[sizeof fault->pointer + 40];
  snprintf(pointer, sizeof pointer, "%s%s", path, fault->pointer);
  return json_pack("{s:s, s:s}", "pointer", pointer, "detail", fault->text);
}

static void put_problem_with(struct eo_request *request, unsigned status, const char *name, const char *detail,
                             json_t *errors, json_t *more)
{
  char type[80] = "about:blank";
  if (name)
    snprintf(type, sizeof type, "/problems/%s", name);
  json_t *problem = json_pack("{s:s, s:s, s:i, s:s, s:o, s:s}", "type", type, "title", title_of(status), "status",
                              (int)status, "detail", detail, "errors", errors ? errors : json_array(), "request_id",
                              request->id);
  *request->reply.file_name = '\0';
  if (problem && more)
    json_object_update(problem, more);
  json_decref(more);
  if (problem) {
    reply_document(request, status, "application/problem+json", problem);
    return;
  }
  eo_reply_empty(request, 500);
}

static void put_problem(struct eo_request *request, unsigned status, const char *name, const char *detail,
                        json_t *errors)
{
  put_problem_with(request, status, name, detail, errors, NULL);
}

void eo_reply_problem_with(struct eo_request *request, unsigned status, const char *name, json_t *more,
                           const char *detail)
{
  put_problem_with(request, status, name, detail, NULL, more);
}

void eo_reply_problem(struct eo_request *request, unsigned status, const char *name, const char *format, ...)
{
  char detail[600];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(detail, sizeof detail, format, arguments);
  va_end(arguments);
  put_problem(request, status, name, detail, NULL);
}

void eo_reply_faults(struct eo_request *request, const char *path, const struct eo_faults *faults)
{
  char detail[80];
  json_t *errors = json_array();
  int kept = faults->count < EO_MAX_FAULTS ? faults->count : EO_MAX_FAULTS;
  for (int i = 0; i < kept; i++)
    json_array_append_new(errors, encode_fault(path, &faults->fault[i]));
  snprintf(detail, sizeof detail, faults->count == 1 ? "One value is wrong." : "%d values are wrong.", faults->count);
  put_problem(request, 422, "invalid", detail, errors);
}

void eo_reply_error(struct eo_request *request, const char *path, const struct eo_error *error)
{
  if (error->code == EO_ERROR_INPUT) {
    json_t *errors = json_array();
    json_array_append_new(errors, encode_fault(path, error));
    put_problem(request, 422, "invalid", error->text, errors);
  } else if (error->code == EO_ERROR_MEMORY) {
    put_problem(request, 503, NULL, "There is not enough memory at the moment.", NULL);
    request->reply.retry_after = 5;
  } else if (error->code == EO_ERROR_FILE) {
    fprintf(stderr, "easeoff: %s: %s\n", request->id,
            error->text); /* it names files of this machine: not for the client */
    put_problem(request, 500, "storage",
                "The server's data cannot be read or written; its log says more under the request's id.", NULL);
  } else
    put_problem(request, 500, "failed", error->text, NULL);
}

/* ---- sending ---- */

static void add(struct MHD_Response *response, const char *name, const char *value)
{
  if (value && *value)
    MHD_add_response_header(response, name, value);
}

static void add_allow(struct MHD_Response *response, unsigned allow)
{
  static const unsigned order[] = {EO_GET, EO_POST, EO_PUT, EO_DELETE, EO_OPTIONS};
  char text[60] = "";
  for (size_t i = 0; i < sizeof order / sizeof order[0]; i++)
    if (allow & order[i]) {
      strcat(text, *text ? ", " : "");
      strcat(text, order[i] == EO_GET ? "GET, HEAD" : eo_method_name(order[i]));
    }
  add(response, "Allow", text);
}

/* A page may load what comes from here and nothing else; an answer of the API is no page at all. */
static void add_safety(struct MHD_Response *response, const struct eo_request *request)
{
  add(response, "Content-Security-Policy",
      request->route
          ? "default-src 'none'; frame-ancestors 'none'"
          : "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; font-src 'self'; "
            "connect-src 'self'; "
            "worker-src 'self'; manifest-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
  add(response, "X-Content-Type-Options", "nosniff");
  add(response, "Referrer-Policy", "no-referrer");
  add(response, "Cross-Origin-Resource-Policy", "same-origin");
  add(response, "Cross-Origin-Opener-Policy", "same-origin");
}

static void add_headers(struct MHD_Response *response, const struct eo_request *request)
{
  const struct eo_reply *reply = &request->reply;
  char text[200];
  add(response, "X-Request-Id", request->id);
  add(response, "Content-Type", reply->type);
  add(response, "Location", reply->location);
  add(response, "Set-Cookie", reply->cookie);
  add(response, "Cache-Control",
      reply->resource && reply->resource->lasting ? "public, max-age=31536000, immutable"
      : reply->revalidate                         ? "no-cache"
                                                  : "no-store");
  if (*reply->tag) {
    snprintf(text, sizeof text, "\"%s\"", reply->tag);
    add(response, "ETag", text);
  }
  if (*reply->file_name) {
    snprintf(text, sizeof text, "attachment; filename=\"%s\"", reply->file_name);
    add(response, "Content-Disposition", text);
  }
  if (reply->retry_after) {
    snprintf(text, sizeof text, "%d", reply->retry_after);
    add(response, "Retry-After", text);
  }
  if (reply->authenticate)
    add(response, "WWW-Authenticate", "Bearer realm=\"easeoff\"");
  if (reply->close)
    add(response, "Connection", "close");
  if (reply->allow)
    add_allow(response, reply->allow);
  add_safety(response, request);
}

static struct MHD_Response *make_packed(struct MHD_Response *response)
{
  if (response)
    MHD_add_response_header(response, "Content-Encoding", "gzip");
  return response;
}

static struct MHD_Response *make_from_resource(struct eo_request *request, bool packed)
{
  const struct eo_resource *resource = request->reply.resource;
  const struct eo_text *text = packed && resource->packed.size ? &resource->packed : &resource->plain;
  struct MHD_Response *response = MHD_create_response_from_buffer(text->size, text->data, MHD_RESPMEM_PERSISTENT);
  request->sent = text->size;
  return text == &resource->packed ? make_packed(response) : response;
}

static struct MHD_Response *make_from_body(struct eo_request *request, bool packed)
{
  enum { WORTH_PACKING = 1024 };
  struct eo_text *body = &request->reply.body, small;
  bool smaller = packed && body->size > WORTH_PACKING && eo_pack(body->data, body->size, 1, &small);
  if (smaller) {
    eo_text_done(body);
    *body = small;
  }
  struct MHD_Response *response = MHD_create_response_from_buffer(body->size, body->data, MHD_RESPMEM_MUST_FREE);
  request->sent = body->size;
  if (response)
    *body = (struct eo_text){0};
  return smaller ? make_packed(response) : response;
}

static struct MHD_Response *make_response(struct eo_request *request)
{
  struct eo_reply *reply = &request->reply;
  bool packed = eo_field_accepts_coding(eo_request_header(request, "Accept-Encoding"), "gzip");
  struct MHD_Response *response = reply->stream;
  reply->stream = NULL;
  if (response)
    return response;
  response = reply->resource ? make_from_resource(request, packed) : make_from_body(request, packed);
  if (response)
    add(response, "Vary", "Accept-Encoding");
  return response;
}

enum MHD_Result eo_reply_send(struct eo_request *request)
{
  struct MHD_Response *response = make_response(request);
  bool stream = request->reply.type && strcmp(request->reply.type, "text/event-stream") == 0;
  if (!response)
    return MHD_NO;
  add_headers(response, request);
  request->http->replies[request->reply.status / 100 % 6]++;
  eo_connection_allow(request->http, request->place,
                      stream ? 0 : EO_BODY_SECONDS + (int)(request->sent / EO_SLOWEST_READER));
  enum MHD_Result result = MHD_queue_response(request->connection, request->reply.status, response);
  MHD_destroy_response(response);
  return result;
}
