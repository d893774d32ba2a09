/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The token of a page: given once, kept by the browser as a cookie that no script can read and no other site can send.
 */
#include <stdio.h>
#include <string.h>

#include "http/request_body.h"
#include "http/guard.h"
#include "http/route.h"
#include "http/http_private.h"

static void tell(struct eo_request *request)
{
  eo_reply_json(
      &request->reply, 200,
      json_pack("{s:b, s:b}", "required", request->http->guard->token != NULL, "authorized", eo_guard_knows(request)));
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

static void begin(struct eo_request *request)
{
  const struct eo_guard *guard = request->http->guard;
  struct order order;
  if (!eo_body_read(request, &order))
    return;
  if (!guard->token)
    eo_reply_empty(&request->reply, 204);
  else if (!eo_field_equal_secret(order.token, guard->token))
    eo_reply_problem(&request->reply, 403, "wrong-token", "That is not this server's token.");
  else {
    snprintf(request->reply.cookie, sizeof request->reply.cookie, "%s=%s; Path=/; HttpOnly; SameSite=Strict",
             eo_guard_cookie, guard->session);
    eo_reply_empty(&request->reply, 204);
  }
}

static void end(struct eo_request *request)
{
  snprintf(request->reply.cookie, sizeof request->reply.cookie, "%s=; Path=/; HttpOnly; SameSite=Strict; Max-Age=0",
           eo_guard_cookie);
  eo_reply_empty(&request->reply, 204);
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
     .rate = EO_RATE_START,
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
     .summary = "Forgets the cookie.",
     .gives = "204 -"},
    {0}};
