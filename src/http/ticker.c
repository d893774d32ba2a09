/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/ticker.h"

#include <time.h>

#include "base/clock.h"
#include "http/connection.h"
#include "http/http_private.h"
#include "http/stream.h"

static void *tick(void *context)
{
  struct eo_http *http = context;
  struct timespec next;
  clock_gettime(CLOCK_MONOTONIC, &next);
  pthread_mutex_lock(&http->lock);
  for (int second = 1; !http->closing; second++) {
    next.tv_sec++;
    while (!http->closing && pthread_cond_timedwait(&http->changed, &http->lock, &next) == 0)
      ;
    eo_connections_end_overdue(http, eo_clock_milliseconds());
    if (second % EO_HEARTBEAT_SECONDS == 0)
      eo_streams_beat(http);
  }
  pthread_mutex_unlock(&http->lock);
  return NULL;
}

enum eo_code eo_ticker_start(struct eo_http *http, struct eo_error *error)
{
  if (pthread_create(&http->ticker, NULL, tick, http) != 0)
    return eo_error_set(error, EO_ERROR_MEMORY, "", "A thread cannot be started.");
  return EO_OK;
}

void eo_ticker_stop(struct eo_http *http)
{
  pthread_join(http->ticker, NULL);
}
