/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/request_log.h"

#include "base/clock.h"
#include "http/http_private.h"
#include "http/log.h"
#include "http/request.h"

enum { SHORT = 200 /* bytes of a path, of a program's name */ };

/* What the server did wrong, what somebody was refused for who he is, all else. */
static enum eo_log_level level_of(unsigned status)
{
  if (status >= 500)
    return EO_LOG_ERROR;
  return status == 401 || status == 403 ? EO_LOG_WARNING : EO_LOG_INFO;
}

void eo_log_request(const struct eo_request *request)
{
  struct eo_text line = {0};
  if (!eo_log_begin(request->http->log, level_of(request->reply.status), "request", &line))
    return;
  eo_text_print(&line, ",\"id\":\"%s\",\"client\":\"%s\",\"user\":\"%s\"", request->id, request->client, request->user);
  eo_log_add(&line, "method", request->method_name, SHORT);
  eo_log_add(&line, "path", request->path, SHORT);
  const char *agent = eo_request_header(request, "User-Agent");
  if (agent)
    eo_log_add(&line, "agent", agent, SHORT);
  eo_text_print(&line, ",\"status\":%u,\"bytes\":%zu,\"ms\":%.1f", request->reply.status, request->sent,
                eo_clock_milliseconds() - request->started);
  eo_log_put(request->http->log, &line);
}
