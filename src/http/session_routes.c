/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The token of a page: given once, kept by the browser as a cookie that no script can read and no other site can send.
 */
#include <stdio.h>
#include <string.h>

#include "http/answers.h"
#include "http/request_body.h"
#include "http/guard.h"
#include "http/route.h"
#include "http/http_private.h"

struct session {
  bool required, authorized;
};
static const struct eo_outline_row session_rows[] = {
    EO_KEY("required", "flag", "the server asks for a token", EO_AT(struct session, required)),
    EO_KEY("authorized", "flag", "this client has given it", EO_AT(struct session, authorized)),
};
const struct eo_outline eo_outline_session = EO_OUTLINE("Session", session_rows);

static void tell(struct eo_request *request)
{
  const struct session session = {request->http->guard->asks, eo_guard_knows(request)};
  eo_reply_json(&request->reply, 200, eo_outline_encode(&eo_outline_session, &session));
}

struct order {
  char token[EO_TOKEN_BYTES];
};
static const struct eo_field order_fields[] = {
    {.key = "token",
     .kind = EO_FIELD_TEXT,
     .flags = EO_FIELD_REQUIRED,
     .offset = offsetof(struct order, token),
     .count = EO_TOKEN_BYTES,
     .help = "as the server was started with it"},
};
static const struct eo_table order_table = EO_TABLE("a token", struct order, order_fields);

/* Behind TLS the browser keeps it for TLS alone. */
static void put_cookie(struct eo_request *request, const char *name, long seconds)
{
  snprintf(request->reply.cookie, sizeof request->reply.cookie,
           "%s=%s; Path=%s/; HttpOnly; SameSite=Strict; Max-Age=%ld%s", eo_guard_cookie, name,
           request->http->settings.limits.base_path, seconds, request->secure ? "; Secure" : "");
  eo_reply_empty(&request->reply, 204);
}

static void begin(struct eo_request *request)
{
  struct eo_guard *guard = request->http->guard;
  struct order order;
  char name[EO_SESSION_NAME + 1];
  double seconds = 3600 * request->http->settings.limits.session_hours;
  if (!eo_body_read(request, &order))
    return;
  if (!guard->asks)
    eo_reply_empty(&request->reply, 204);
  else if (!eo_guard_is_token(guard, order.token))
    eo_guard_refuse_token(request);
  else if (!eo_session_begin(&guard->sessions, seconds, name))
    eo_reply_problem(&request->reply, 503, NULL, "The system has no random numbers at the moment.");
  else
    put_cookie(request, name, (long)seconds);
}

static void end(struct eo_request *request)
{
  char name[EO_SESSION_NAME + 8];
  if (eo_field_cookie(eo_request_header(request, "Cookie"), eo_guard_cookie, name, sizeof name))
    eo_session_end(&request->http->guard->sessions, name);
  put_cookie(request, "", 0);
}

const struct eo_route eo_routes_session[] = {
    {.method = EO_GET,
     .pattern = "/session",
     .handle = tell,
     .name = "getSession",
     .open = true,
     .summary = "Whether this server asks for a token, and whether this client has given it.",
     .gives = "200 Session"},
    {.method = EO_POST,
     .pattern = "/session",
     .handle = begin,
     .name = "beginSession",
     .open = true,
     .body = 4096,
     .summary = "Gives the token and gets a cookie for it, as the page does; scripts send Authorization: Bearer TOKEN.",
     .takes = "Token",
     .order = &order_table,
     .gives = "204 -"},
    {.method = EO_DELETE,
     .pattern = "/session",
     .handle = end,
     .name = "endSession",
     .open = true,
     .summary = "Ends the session and forgets its cookie.",
     .gives = "204 -"},
    {0}};
