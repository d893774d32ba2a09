/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every address of the API, in one table: from it come the dispatch, 405 and Allow, OPTIONS, the check of query
   parameters and the OpenAPI document. Each group of endpoints has its own file with its own part of the table. */
#ifndef EASEOFF_HTTP_ROUTE_H
#define EASEOFF_HTTP_ROUTE_H

#include "format/table.h"
#include "http/request.h"

enum { EO_MOST_QUERIES = 10, EO_MOST_ANSWERS = 10 };

/* What a request costs of what an address may start (guard.h). */
enum eo_rate { EO_RATE_FREE, EO_RATE_QUESTION, EO_RATE_START, EO_RATE_WRONG, EO_RATE_KINDS };

/* A query parameter: a whole number, one word of a list, or several, or a text. */
struct eo_query {
  const char *name;           /* NULL ends the list */
  double low, high, fallback; /* of a number; of words: high EO_SEVERAL_WORDS, with commas between them, low
                                 EO_CSV_ALONE, where the answer is a table, or none */
  const char *words;          /* "queued|running"; NULL: a number; "": a text */
  const char *help;
};
enum { EO_SEVERAL_WORDS = 1, EO_CSV_ALONE = 1, EO_QUERY_TEXT = 1000 /* most bytes */ };

static inline bool eo_query_is_list(const struct eo_query *query)
{
  return query->words && query->high == EO_SEVERAL_WORDS;
}

static inline bool eo_query_is_text(const struct eo_query *query)
{
  return query->words && !*query->words;
}

struct eo_route {
  unsigned method;
  const char *pattern; /* below /api/v1; NULL ends a table */
  void (*handle)(struct eo_request *request);
  const char *name;             /* operationId */
  const char *summary;          /* one line */
  const char *takes;            /* name of the body's schema, "A|B": either; a media type: any bytes; NULL: no body */
  const struct eo_table *order; /* describes the last name of `takes` and reads it: eo_body_read(); NULL: a design */
  const char *design_at;        /* where the body holds the design; NULL: it is the body */
  bool takes_nothing;           /* the body may be left out */
  const char *gives;            /* "200 Result, 202 Ticket": status and schema; "-": no body; problems are added */
  const char *headers;          /* request headers that matter here, "If-Match, Prefer"; may be NULL */
  struct eo_query query[EO_MOST_QUERIES];
  enum eo_rate rate;
  size_t body; /* most bytes; 0: EO_JSON_DESIGN_BYTES where a body is taken */
  bool open;   /* answers without the token */
  bool aside;  /* runs on the other thread: see background.h */
  bool form;   /* takes multipart/form-data: see upload.h; runs on the thread that reads recordings */
  bool frees;  /* goes on on a full disk, like DELETE */
  bool csv;    /* as text/csv too, by Accept or ".csv" */
};

#define EO_API "/api/v1"

/* The border of units (format/inch.h), a row of `query`: request->reply.inches says whether it is asked for. What is
   computed and stored keeps mm. */
#define EO_UNITS_QUERY                                                                          \
  {                                                                                             \
    "units", 0, 0, 0, "mm|inch",                                                                \
        "inch: lengths in inches by keys and heads of columns that end in _in, those of um in " \
        "thousandths by _thou. Either spelling is read in any design"                           \
  }
#define EO_UNITS_OF_CSV                                                                                        \
  {                                                                                                            \
    "units", EO_CSV_ALONE, 0, 0, "mm|inch",                                                                    \
        "of CSV: inch, for lengths in inches below heads that end in _in, those of um in thousandths by _thou" \
  }

/* Finds what a request means; false: the reply is there (404, 405, OPTIONS). */
bool eo_route_find(struct eo_request *request);

/* Checks the query against the route's list; false: the reply is 400. */
bool eo_route_check_query(struct eo_request *request);

/* Query numbers, checked against their rows in the route's table before the handler runs: the value or its default. */
double eo_route_number(const struct eo_request *request, const char *name);

/* Words of a query parameter that takes several: bit i is set for word i of its row's list. *given: it is there. */
unsigned eo_route_words(const struct eo_request *request, const char *name, bool *given);

/* Runs the handler, and lets go of what it has read. */
void eo_route_run(struct eo_request *request);

/* The parts of the table, each in the file of its endpoints; each ends with a row without pattern. routes.h has all. */
extern const struct eo_route eo_routes_service[], eo_routes_session[], eo_routes_examples[], eo_routes_designs[],
    eo_routes_analysis[], eo_routes_jobs[], eo_routes_events[], eo_routes_history[], eo_routes_export[],
    eo_routes_report[], eo_routes_reproduction[], eo_routes_tolerance[], eo_routes_import[], eo_routes_measurements[],
    eo_routes_comparison[], eo_routes_studies[];

#endif
