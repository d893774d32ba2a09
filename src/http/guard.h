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

enum { EO_RATES = 256 };

struct eo_guard {
  const char *token;                /* NULL: none */
  char session[EO_HASH_LENGTH + 1]; /* the cookie of a page that gave the token */
  const char *const *host;          /* further names; NULL ends them */
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

/* Whether the request brought the token or the cookie. */
bool eo_guard_knows(const struct eo_request *request);

#endif
