/* Every address of the API, in one table: from it come the dispatch, 405 and Allow, OPTIONS, the check of query
   parameters and the OpenAPI document. Each group of endpoints has its own file with its own part of the table. */
#ifndef EASEOFF_HTTP_ROUTE_H
#define EASEOFF_HTTP_ROUTE_H

#include "http/guard.h"
#include "http/request.h"

enum { EO_MOST_QUERIES = 4, EO_MOST_ANSWERS = 10 };

/* A query parameter: a whole number, or one word of a list. */
struct eo_query {
  const char *name;           /* NULL ends the list */
  double low, high, fallback; /* numbers */
  const char *words;          /* "queued|running"; NULL: a number */
  const char *help;
};

struct eo_route {
  unsigned method;
  const char *pattern; /* below /api/v1; NULL ends a table */
  void (*handle)(struct eo_request *request);
  const char *name;             /* operationId */
  const char *summary;          /* one line */
  const char *takes;            /* name of the body's schema, "A|B": either; NULL: no body */
  const struct eo_table *order; /* describes the last name of `takes` and reads it: eo_request_read(); NULL: a design */
  const char *design_at;        /* where the body holds the design; NULL: it is the body */
  bool takes_nothing;           /* the body may be left out */
  const char *gives;            /* "200 Result, 202 Ticket": status and schema; "-": no body; problems are added */
  const char *headers;          /* request headers that matter here, "If-Match, Prefer"; may be NULL */
  struct eo_query query[EO_MOST_QUERIES];
  enum eo_rate rate;
  size_t body; /* most bytes; 0: EO_JSON_DESIGN_BYTES where a body is taken */
  bool open;   /* answers without the token */
  bool aside;  /* runs on the other thread: see aside.h */
  bool form;   /* takes multipart/form-data: see upload.h; runs on the thread that reads recordings */
  bool csv;    /* as text/csv too, by Accept or ".csv" */
};

#define EO_API "/api/v1"

/* The parts of the table; each ends with a row without pattern. */
extern const struct eo_route *const eo_routes[]; /* NULL after the last */

/* Finds what a request means; false: the reply is there (404, 405, OPTIONS). */
bool eo_route_find(struct eo_request *request);

/* Checks the query against the route's list; false: the reply is 400. */
bool eo_route_check_query(struct eo_request *request);

/* "GET" ... of one method. */
const char *eo_method_name(unsigned method);

extern const struct eo_route eo_routes_service[], eo_routes_session[], eo_routes_examples[], eo_routes_designs[],
    eo_routes_analysis[], eo_routes_jobs[], eo_routes_events[], eo_routes_history[], eo_routes_export[],
    eo_routes_measurements[], eo_routes_comparison[];

#endif
