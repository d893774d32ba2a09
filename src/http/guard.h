/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Who may ask for what. Without a token: only what comes for this machine by its own name (a page of another site
   cannot get through by bending its name to this address), and nothing that changes something from another site's page.
   With one: whoever has it. */
#ifndef EASEOFF_HTTP_GUARD_H
#define EASEOFF_HTTP_GUARD_H

#include <stdbool.h>
#include <sys/socket.h>

#include "base/hash.h"
#include "http/http.h"
#include "http/route.h"
#include "http/sessions.h"

enum { EO_RATES = 256 };

struct eo_guard {
  bool asks;                      /* for a token */
  char token[EO_HASH_LENGTH + 1]; /* its hash: the token itself is not kept */
  const char *const *host;        /* further names; NULL ends them */
  struct eo_sessions sessions;
  struct eo_rate_limit {
    double burst, per_second;
  } rate[EO_RATE_KINDS];
  struct eo_allowance {
    unsigned char address[16];
    double left[EO_RATE_KINDS], at;
  } allowance[EO_RATES]; /* at: s of the monotonic clock, 0: free */
};

extern const char eo_guard_cookie[];

/* Errors: memory. */
enum eo_code eo_guard_new(struct eo_guard **guard, const struct eo_http_settings *settings, struct eo_error *error);

/* False: the reply says why not. */
bool eo_guard_admits(struct eo_request *request);

/* Takes one from what an address may start; false: the reply is 429. */
bool eo_guard_spends(struct eo_request *request, enum eo_rate rate);

/* Whether the request brought the token or the cookie; notes in the request which. */
bool eo_guard_knows(struct eo_request *request);

/* Whether a text is the token. */
bool eo_guard_is_token(const struct eo_guard *guard, const char *text);

/* The reply to a wrong token: 403, or 429 for an address that has tried too many. The right one is never refused, so
   that nobody can lock out who comes by the same proxy. */
void eo_guard_refuse_token(struct eo_request *request);

#endif
