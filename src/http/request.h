/* One request on its way: what came, and the reply that is being made. A handler reads the one, fills the other and
   returns; it runs on the HTTP thread and never waits. What takes longer is deferred: the handler calls
   eo_request_defer() and hands the request to somebody who calls eo_request_finish() once, from any thread. This header
   is for src/http/ alone. */
#ifndef EASEOFF_HTTP_REQUEST_H
#define EASEOFF_HTTP_REQUEST_H

#include <stdarg.h>

#include <jansson.h>

#include "document/design_document.h"
#include "format/faults.h"
#include "format/text.h"
#include "http/header_field.h"
#include "http/http.h"

struct MHD_Connection;
struct MHD_Response;
struct eo_route;
struct eo_resource;
struct eo_upload;

enum eo_method { EO_GET = 1, EO_POST = 2, EO_PUT = 4, EO_DELETE = 8, EO_OPTIONS = 16 };
enum { EO_REQUEST_ID = 16, EO_ARGUMENTS = 2, EO_TAG = 70 };

struct eo_reply {
  unsigned status;
  const char *type;                               /* literal */
  struct eo_text body;                            /* owned */
  const struct eo_resource *resource;             /* in place of the body: borrowed from the server */
  struct MHD_Response *stream;                    /* in place of the body: owned until it is queued */
  char tag[EO_TAG];                               /* ETag without quotes; "": none */
  char location[128], file_name[80], cookie[160]; /* "": none */
  int retry_after;                                /* s; 0: none */
  unsigned allow;                                 /* methods; 0: no Allow */
  bool authenticate, revalidate; /* WWW-Authenticate; the client may keep a copy and ask whether it still holds */
  bool close;                    /* the connection ends with this reply */
};

struct eo_request {
  struct eo_http *http;
  struct eo_store *store; /* of the thread the handler runs on */
  struct MHD_Connection *connection;
  struct eo_connection *place; /* of the connection, with its deadline */
  char id[EO_REQUEST_ID + 1];
  char *method_name, *path; /* owned */
  unsigned method;          /* one of enum eo_method; 0: none that is known */
  bool head;
  const struct eo_route *route;    /* NULL: a page, or nothing */
  char argument[EO_ARGUMENTS][64]; /* what stood in the places of the pattern */
  bool csv;                        /* asked for by Accept or by the suffix */
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

/* ---- what came ---- */

const char *eo_request_header(const struct eo_request *request, const char *name); /* NULL: it is not there */
const char *eo_request_query(const struct eo_request *request, const char *name);

/* Query numbers, checked against their rows in the route's table before the handler runs: the value or its default. */
double eo_request_number(const struct eo_request *request, const char *name);

/* The body as JSON, a form as the object of its parts; it lasts until the handler returns. NULL: the reply says what is
   wrong with it. */
const json_t *eo_request_json(struct eo_request *request);

/* Reads the body by the field table of the route into a struct of that table; false: the reply says everything that is
   wrong. A body that may be left out and was is an empty object. Release with eo_table_done() where it has lists. */
bool eo_request_read(struct eo_request *request, void *order);

/* Runs the handler of the route, and lets go of what it has read. */
void eo_request_handle(struct eo_request *request);

/* A design out of a JSON value, read, completed and checked; path: where it stands in the body ("" for all of it).
   False: the reply says everything that is wrong. warnings may be NULL. */
bool eo_request_design(struct eo_request *request, const json_t *document, const char *path, struct eo_design *design,
                       struct eo_geometry *geometry, struct eo_warnings *warnings);

/* The number in the path's n-th place; false: the reply is 404. */
bool eo_request_id_at(struct eo_request *request, int n, int64_t *key);

/* ---- the reply ---- */

/* Takes the document over; NULL: no memory, 500. */
void eo_reply_json(struct eo_request *request, unsigned status, json_t *document);

/* Takes the text over. type: a literal. */
void eo_reply_text(struct eo_request *request, unsigned status, const char *type, struct eo_text *text);
void eo_reply_resource(struct eo_request *request, const struct eo_resource *resource);
void eo_reply_empty(struct eo_request *request, unsigned status);

/* A problem document (RFC 9457). name: the last part of "/problems/NAME", or NULL for a status that says enough by
   itself. */
void eo_reply_problem(struct eo_request *request, unsigned status, const char *name, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* The same with further members, taken over: what a program can read about the problem. */
void eo_reply_problem_with(struct eo_request *request, unsigned status, const char *name, json_t *more,
                           const char *detail);

/* 422 with every fault and its pointer below path. */
void eo_reply_faults(struct eo_request *request, const char *path, const struct eo_faults *faults);

/* An error of the core: 422 when the input is wrong, else 500. */
void eo_reply_error(struct eo_request *request, const char *path, const struct eo_error *error);

/* True when the reply is complete already: the client has this version (304). */
bool eo_reply_unchanged(struct eo_request *request, const char *tag);

/* ---- later ---- */

void eo_request_defer(struct eo_request *request);
void eo_request_finish(struct eo_request *request);

#endif
