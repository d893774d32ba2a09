/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/guard.h"

#include <math.h>
#include <netinet/in.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/clock.h"
#include "http/connection.h"
#include "http/http_private.h"

const char eo_guard_cookie[] = "easeoff_session";

enum eo_code eo_guard_new(struct eo_guard **result, const struct eo_http_settings *settings, struct eo_error *error)
{
  struct eo_guard *guard = calloc(1, sizeof *guard);
  struct eo_hash hash;
  if (!guard)
    return eo_error_memory(error);
  guard->token = settings->token && *settings->token ? settings->token : NULL;
  guard->host = settings->host;
  eo_hash_init(&hash);
  eo_hash_add_text(&hash, "easeoff session", guard->token ? guard->token : "");
  eo_hash_finish(&hash, guard->session);
  *result = guard;
  return EO_OK;
}

static bool bears_token(const struct eo_request *request, const char *token)
{
  const char *given = eo_request_header(request, "Authorization");
  return given && strncasecmp(given, "Bearer ", 7) == 0 && eo_field_equal_secret(given + 7, token);
}

static bool has_session(const struct eo_request *request, const char *session)
{
  char given[EO_HASH_LENGTH + 8];
  return eo_field_cookie(eo_request_header(request, "Cookie"), eo_guard_cookie, given, sizeof given) &&
         eo_field_equal_secret(given, session);
}

bool eo_guard_knows(const struct eo_request *request)
{
  const struct eo_guard *guard = request->http->guard;
  return !guard->token || bears_token(request, guard->token) || has_session(request, guard->session);
}

static bool is_own_name(const struct eo_guard *guard, const char *host)
{
  if (strcmp(host, "localhost") == 0 || eo_field_host_is_address(host))
    return true;
  for (int i = 0; guard->host[i]; i++)
    if (strcasecmp(guard->host[i], host) == 0)
      return true;
  return false;
}

static bool host_is_right(const struct eo_request *request)
{
  char host[256];
  const char *header = eo_request_header(request, "Host");
  const struct eo_guard *guard = request->http->guard;
  return header && eo_field_host(header, host, sizeof host) && (guard->token || is_own_name(guard, host));
}

/* A browser says where a request comes from; a script says nothing. */
static bool is_cross_site(const struct eo_request *request)
{
  const char *site = eo_request_header(request, "Sec-Fetch-Site"), *origin = eo_request_header(request, "Origin");
  const char *host = eo_request_header(request, "Host");
  if (site && strcasecmp(site, "same-origin") != 0 && strcasecmp(site, "none") != 0)
    return true;
  if (!origin)
    return false;
  const char *name = strstr(origin, "://");
  return !name || !host || strcasecmp(name + 3, host) != 0;
}

bool eo_guard_admits(struct eo_request *request)
{
  if (!host_is_right(request))
    eo_reply_problem(&request->reply, 421, "wrong-host",
                     "This server does not answer under that name; --host NAME adds one.");
  else if ((request->method & (EO_POST | EO_PUT | EO_DELETE)) && is_cross_site(request))
    eo_reply_problem(&request->reply, 403, "cross-site", "A page of another site may not change anything here.");
  else if (request->route && !request->route->open && !eo_guard_knows(request)) {
    eo_reply_problem(&request->reply, 401, NULL, "This server asks for its token.");
    request->reply.authenticate = true;
  } else
    return true;
  return false;
}

/* What may come at once, and how many more every second. */
static const struct {
  double burst, per_second;
} rates[EO_RATE_KINDS] = {{0, 0}, {400, 100}, {100, 2}};

static void address_of(const struct sockaddr_storage *address, unsigned char key[16])
{
  memset(key, 0, 16);
  if (address->ss_family == AF_INET)
    memcpy(key, &((const struct sockaddr_in *)address)->sin_addr, 4);
  else if (address->ss_family == AF_INET6)
    memcpy(key, &((const struct sockaddr_in6 *)address)->sin6_addr, 8); /* a client has a whole /64 */
}

/* The address's row, or the one that was used longest ago. */
static struct eo_allowance *find_allowance(struct eo_guard *guard, const unsigned char key[16])
{
  struct eo_allowance *oldest = guard->allowance;
  for (int i = 0; i < EO_RATES; i++) {
    struct eo_allowance *row = &guard->allowance[i];
    if (row->at > 0 && memcmp(row->address, key, 16) == 0)
      return row;
    if (row->at < oldest->at)
      oldest = row;
  }
  memcpy(oldest->address, key, 16);
  for (int k = 0; k < EO_RATE_KINDS; k++)
    oldest->left[k] = rates[k].burst;
  oldest->at = 0;
  return oldest;
}

bool eo_guard_spends(struct eo_request *request, enum eo_rate rate)
{
  unsigned char key[16];
  double now = 1e-3 * eo_clock_milliseconds();
  if (rate == EO_RATE_FREE)
    return true;
  address_of(&request->place->address, key);
  struct eo_allowance *row = find_allowance(request->http->guard, key);
  double passed = row->at > 0 ? now - row->at : 0;
  for (int k = 0; k < EO_RATE_KINDS; k++)
    row->left[k] = fmin(row->left[k] + passed * rates[k].per_second, rates[k].burst);
  row->at = now;
  if (row->left[rate] < 1) {
    eo_reply_problem(&request->reply, 429, NULL, "That is more than one client may ask for at once.");
    request->reply.retry_after = (int)ceil((1 - row->left[rate]) / rates[rate].per_second);
    return false;
  }
  row->left[rate] -= 1;
  return true;
}
