/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One request on its way: what came, and the reply that is being made. A handler reads the one, fills the other and
   returns; it runs on the HTTP thread and never waits. What takes longer is deferred (deferred.h). This header is for
   src/http/ alone. */
#ifndef EASEOFF_HTTP_REQUEST_H
#define EASEOFF_HTTP_REQUEST_H

#include <jansson.h>

#include "document/design_document.h"
#include "format/text.h"
#include "http/client.h"
#include "http/header_field.h"
#include "http/reply.h"

struct MHD_Connection;
struct eo_connection;
struct eo_http;
struct eo_route;
struct eo_store;
struct eo_resource;
struct eo_upload;

enum eo_method { EO_GET = 1, EO_POST = 2, EO_PUT = 4, EO_DELETE = 8, EO_OPTIONS = 16 };
enum { EO_REQUEST_ID = 16, EO_ARGUMENTS = 2 };

struct eo_request {
  struct eo_http *http;
  struct eo_store *store; /* of the thread the handler runs on */
  struct MHD_Connection *connection;
  struct eo_connection *place; /* of the connection, with its deadline */
  char id[EO_REQUEST_ID + 1];
  char *method_name, *path; /* owned */
  unsigned method;          /* one of enum eo_method; 0: none that is known */
  bool head;
  char client[EO_CLIENT_TEXT]; /* address of who asks, as the proxy says where there is one */
  unsigned char client_key[16];
  bool secure;                     /* he speaks TLS with a proxy */
  const char *user;                /* "token", "session", or "-" */
  const struct eo_route *route;    /* NULL: a page, or nothing */
  char argument[EO_ARGUMENTS][64]; /* what stood in the places of the pattern */
  bool csv;                        /* asked for by Accept or by the suffix */
  const char *answer_type;         /* literal: of what the service answers; NULL: JSON, or CSV */
  struct eo_text body;
  json_t *document;         /* the body as JSON, once it was asked for; owned until the handler has returned */
  struct eo_upload *upload; /* in place of the body, of a route that takes a form; owned */
  size_t received, body_limit, refused; /* refused: bytes that came after the reply was known */
  size_t held;                          /* bytes of the body in memory */
  double started;                       /* ms of the monotonic clock */
  struct eo_reply reply;
  bool dispatched;
  bool deferred, finished, suspended; /* under the server's lock */
  size_t sent;                        /* bytes of the reply's body, for the log */
};

/* path, method: as they came, copied. NULL without memory. */
struct eo_request *eo_request_new(struct eo_http *http, struct MHD_Connection *connection, const char *path,
                                  const char *method);
void eo_request_free(struct eo_request *request); /* after its upload */

/* "GET" ... of one method. */
const char *eo_method_name(unsigned method);

const char *eo_request_header(const struct eo_request *request, const char *name); /* NULL: it is not there */
/* The value of a parameter, decoded; NULL: it is not there. */
const char *eo_request_query(const struct eo_request *request, const char *name);

/* Zeroed memory for a handler, its to free; NULL: the reply says so. */
void *eo_request_memory(struct eo_request *request, size_t size);

/* The body as JSON; it lasts until the handler returns. NULL: the reply says what is wrong with it. */
const json_t *eo_request_json(struct eo_request *request);

/* A design out of a JSON value, read, completed and checked; path: where it stands in the body ("" for all of it).
   False: the reply says everything that is wrong. warnings may be NULL. */
bool eo_request_design(struct eo_request *request, const json_t *document, const char *path, struct eo_design *design,
                       struct eo_geometry *geometry, struct eo_warnings *warnings);

/* Replies with a table of comma-separated values, taken over; lengths in inches where ?units asks for them. */
void eo_reply_table(struct eo_request *request, struct eo_text *text);

/* The number in the path's n-th place; false: the reply is 404. */
bool eo_request_id_at(struct eo_request *request, int n, int64_t *key);

/* Whether the client has this version already, which completes the reply (304); the reply carries the tag. */
bool eo_request_unchanged(struct eo_request *request, const char *tag);

/* Replies with something that was made when the server started, or 304. */
void eo_request_resource(struct eo_request *request, const struct eo_resource *resource);

#endif
