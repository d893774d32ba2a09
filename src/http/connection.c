/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Between requests, for header fields, for a body, for taking a reply there is a time. The library's own timeout starts
   again with every byte, so that a client which drips would stay for ever. */
#include "http/connection.h"

#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>

#include "base/clock.h"
#include "http/http_private.h"

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
void eo_connections_end_overdue(struct eo_http *http, double now)
{
  for (struct eo_connection *place = http->connections; place; place = place->after)
    if (place->deadline > 0 && place->deadline < now) {
      shutdown(place->socket, SHUT_RDWR);
      place->deadline = 0;
    }
}
