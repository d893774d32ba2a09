/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Server-Sent Events (HTML Living Standard 9.2): each client's stream listens to the service by itself and keeps what
   it has not taken yet. */
#ifndef EASEOFF_HTTP_STREAM_H
#define EASEOFF_HTTP_STREAM_H

#include "http/request.h"

/* Bytes that one client, once its stream is open, and all of them may leave unread. */
enum { EO_STREAM_BACKLOG = 1 << 20, EO_MOST_BACKLOG = 128 << 20 };

/* Makes the reply a stream of the events of one job, or of all (0), after the number `after`. */
void eo_stream_open(struct eo_request *request, int64_t job, int64_t after);

/* Both with the server's lock held. A comment for every stream: only writing shows that a client has gone. */
void eo_streams_beat(struct eo_http *http);
void eo_streams_end(struct eo_http *http);

#endif
