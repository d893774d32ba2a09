/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/send.h"

#include <stdio.h>
#include <string.h>

#include "http/connection.h"
#include "http/http_private.h"
#include "http/resource.h"

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
  char text[400];
  add(response, "X-Request-Id", request->id);
  add(response, "Content-Type", reply->type);
  if (*reply->location) {
    snprintf(text, sizeof text, "%s%s", request->http->settings.limits.base_path, reply->location);
    add(response, "Location", text);
  }
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
  if (*reply->notes)
    add(response, "Easeoff-Notes", reply->notes);
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

enum MHD_Result eo_send_reply(struct eo_request *request)
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
