/* Connections and the time they have: between requests, for header fields, for a body, for taking a reply. The
   library's own timeout starts again with every byte, so that a client which drips would stay for ever; here a thread
   looks once a second who is overdue. It is also what keeps event streams alive. */
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>

#include "base/clock.h"
#include "http/server.h"
#include "http/stream.h"

static void add(struct eo_http *http, struct MHD_Connection *connection, void **place)
{
  const union MHD_ConnectionInfo *descriptor = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
  struct eo_connection *made = calloc(1, sizeof *made);
  *place = made;
  if (!made)
    return; /* its requests get no answer */
  made->socket = descriptor ? descriptor->connect_fd : -1;
  socklen_t size = sizeof made->address;
  getpeername(made->socket, (struct sockaddr *)&made->address, &size);
  made->deadline = eo_clock_milliseconds() + 1e3 * EO_IDLE_SECONDS;
  pthread_mutex_lock(&http->lock);
  made->after = http->connections;
  if (made->after)
    made->after->before = made;
  http->connections = made;
  http->connection_count++;
  pthread_mutex_unlock(&http->lock);
}

static void drop(struct eo_http *http, struct eo_connection *place)
{
  pthread_mutex_lock(&http->lock);
  if (place->before)
    place->before->after = place->after;
  else
    http->connections = place->after;
  if (place->after)
    place->after->before = place->before;
  http->connection_count--;
  pthread_mutex_unlock(&http->lock);
  free(place);
}

void eo_connection_notify(void *context, struct MHD_Connection *connection, void **place,
                          enum MHD_ConnectionNotificationCode code)
{
  if (code == MHD_CONNECTION_NOTIFY_STARTED)
    add(context, connection, place);
  else if (*place)
    drop(context, *place);
}

void eo_connection_allow(struct eo_http *http, struct eo_connection *place, int seconds)
{
  double deadline = seconds ? eo_clock_milliseconds() + 1e3 * seconds : 0;
  pthread_mutex_lock(&http->lock);
  place->deadline = deadline;
  pthread_mutex_unlock(&http->lock);
}

/* The HTTP thread notices the end of the socket and cleans up. */
static void end_overdue(struct eo_http *http, double now)
{
  for (struct eo_connection *place = http->connections; place; place = place->after)
    if (place->deadline > 0 && place->deadline < now) {
      shutdown(place->socket, SHUT_RDWR);
      place->deadline = 0;
    }
}

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
    end_overdue(http, eo_clock_milliseconds());
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
