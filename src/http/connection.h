/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Who is connected, and for how long a client may keep a connection busy. */
#ifndef EASEOFF_HTTP_CONNECTION_H
#define EASEOFF_HTTP_CONNECTION_H

#include <sys/socket.h>

#include <microhttpd.h>

struct eo_http;

/* A client's connection. */
struct eo_connection {
  int socket;
  double deadline; /* ms of the monotonic clock; 0: none */
  struct eo_connection *before, *after;
  struct sockaddr_storage address;
};

/* What the library calls. */
void eo_connection_notify(void *context, struct MHD_Connection *connection, void **place,
                          enum MHD_ConnectionNotificationCode code);

/* The seconds that a client has from now on; 0: no deadline. */
void eo_connection_allow(struct eo_http *http, struct eo_connection *place, int seconds);

/* Ends the connections whose time is over; with the server's lock held. now: ms of the monotonic clock. */
void eo_connections_end_overdue(struct eo_http *http, double now);

#endif
