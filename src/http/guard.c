/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/guard.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/clock.h"
#include "http/connection.h"
#include "http/http_private.h"
#include "http/log.h"

const char eo_guard_cookie[] = "easeoff_session";

enum eo_code eo_guard_new(struct eo_guard **result, const struct eo_http_settings *settings, struct eo_error *error)
{
  const struct eo_http_limits *limits = &settings->limits;
  struct eo_guard *guard = calloc(1, sizeof *guard);
  if (!guard)
    return eo_error_memory(error);
  guard->asks = settings->token && *settings->token;
  if (guard->asks)
    eo_hash_hex(settings->token, strlen(settings->token), guard->token);
  guard->host = settings->host;
  guard->rate[EO_RATE_QUESTION] = (struct eo_rate_limit){limits->questions_at_once, limits->questions_per_second};
  guard->rate[EO_RATE_START] = (struct eo_rate_limit){limits->starts_at_once, limits->starts_per_second};
  guard->rate[EO_RATE_WRONG] = (struct eo_rate_limit){limits->wrong_tokens_per_minute,
                                                      limits->wrong_tokens_per_minute / 60};
  *result = guard;
  return EO_OK;
}

bool eo_guard_is_token(const struct eo_guard *guard, const char *text)
{
  char hash[EO_HASH_LENGTH + 1];
  eo_hash_hex(text, strlen(text), hash);
  return eo_field_equal_secret(hash, guard->token);
}

/* What stands behind "Bearer "; NULL: nothing. */
static const char *find_bearer(const struct eo_request *request)
{
  const char *given = eo_request_header(request, "Authorization");
  return given && strncasecmp(given, "Bearer ", 7) == 0 ? given + 7 : NULL;
}

static bool has_session(const struct eo_request *request)
{
  char given[EO_SESSION_NAME + 8];
  return eo_field_cookie(eo_request_header(request, "Cookie"), eo_guard_cookie, given, sizeof given) &&
         eo_session_holds(&request->http->guard->sessions, given);
}

bool eo_guard_knows(struct eo_request *request)
{
  const struct eo_guard *guard = request->http->guard;
  const char *bearer = find_bearer(request);
  if (!guard->asks)
    return true;
  if (bearer && eo_guard_is_token(guard, bearer))
    request->user = "token";
  else if (has_session(request))
    request->user = "session";
  return strcmp(request->user, "-") != 0;
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
  return header && eo_field_host(header, host, sizeof host) && (guard->asks || is_own_name(guard, host));
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
  else if (eo_guard_knows(request) || !request->route || request->route->open)
    return true;
  else if (find_bearer(request))
    eo_guard_refuse_token(request);
  else {
    eo_reply_problem(&request->reply, 401, NULL, "This server asks for its token.");
    request->reply.authenticate = true;
  }
  return false;
}

void eo_guard_refuse_token(struct eo_request *request)
{
  if (!eo_guard_spends(request, EO_RATE_WRONG))
    request->reply.close = true;
  else if (find_bearer(request)) {
    eo_reply_problem(&request->reply, 401, "wrong-token", "That is not this server's token.");
    request->reply.authenticate = true;
  } else
    eo_reply_problem(&request->reply, 403, "wrong-token", "That is not this server's token.");
  eo_log_event(request->http->log, EO_LOG_WARNING, "wrong-token", "%s gave a token that is not this server's.",
               request->client);
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
    oldest->left[k] = guard->rate[k].burst;
  oldest->at = 0;
  return oldest;
}

bool eo_guard_spends(struct eo_request *request, enum eo_rate rate)
{
  double now = 1e-3 * eo_clock_milliseconds();
  if (rate == EO_RATE_FREE)
    return true;
  const struct eo_rate_limit *limit = request->http->guard->rate;
  struct eo_allowance *row = find_allowance(request->http->guard, request->client_key);
  double passed = row->at > 0 ? now - row->at : 0;
  for (int k = 0; k < EO_RATE_KINDS; k++)
    row->left[k] = fmin(row->left[k] + passed * limit[k].per_second, limit[k].burst);
  row->at = now;
  if (row->left[rate] < 1) {
    eo_reply_problem(&request->reply, 429, NULL, "That is more than one client may ask for at once.");
    request->reply.retry_after = (int)ceil((1 - row->left[rate]) / limit[rate].per_second);
    return false;
  }
  row->left[rate] -= 1;
  return true;
}
