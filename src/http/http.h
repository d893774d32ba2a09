/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The HTTP server: the only user of libmicrohttpd. One thread serves all connections and never computes or waits;
   designs, jobs and what-if questions go to the service (service/service.h), which answers from its own threads. */
#ifndef EASEOFF_HTTP_HTTP_H
#define EASEOFF_HTTP_HTTP_H

#include <stdbool.h>

#include "base/error.h"
#include "http/limits.h"
#include "service/service.h"

struct eo_http;

enum { EO_HTTP_HOSTS = 8, EO_LEAST_TOKEN = 16, EO_TOKEN_BYTES = 200 }; /* characters of a token; bytes, with its end */

struct eo_http_settings {
  const char *listen;              /* "127.0.0.1:8080", "[::1]:0"; a port of 0 takes a free one */
  const char *token;               /* NULL or "": none is asked for */
  bool allow_anyone;               /* an address that others reach, without a token */
  const char *host[EO_HTTP_HOSTS]; /* names under which the server may be called beside localhost and plain addresses;
                                      NULL ends them */
  const char *pages;               /* folder of the page's files; NULL: none */
  const char *data;                /* folder of the database */
  bool quiet;                      /* no line per request on standard error */
  struct eo_http_limits limits;
  struct eo_service *service; /* borrowed; outlives the server */
};

/* Starts answering. Errors: EO_ERROR_INPUT (address, token), EO_ERROR_FILE (the address is taken, pages or database
   cannot be read, recordings that cannot be the database's). */
enum eo_code eo_http_start(struct eo_http **http, const struct eo_http_settings *settings, struct eo_error *error);

/* "http://127.0.0.1:8080/" */
const char *eo_http_url(const struct eo_http *http);

/* A sentence about what the start found and did with recordings that the database does not know; "": nothing. */
const char *eo_http_notice(const struct eo_http *http);

/* Takes no new connections and ends the streams; waiting requests are answered as the service lets go of them. First
   half of a stop: then end the service, then eo_http_stop(). */
void eo_http_quiesce(struct eo_http *http);
void eo_http_stop(struct eo_http *http); /* NULL is fine */

#endif
