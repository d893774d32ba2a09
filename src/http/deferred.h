/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Replies that come later: a handler defers its request and hands it to somebody who finishes it once, from any thread;
   the connection sleeps meanwhile. */
#ifndef EASEOFF_HTTP_DEFERRED_H
#define EASEOFF_HTTP_DEFERRED_H

#include "http/request.h"

/* Announces that the reply comes later, from another thread. */
void eo_request_defer(struct eo_request *request);
/* The reply is there: the connection wakes. From any thread, once. */
void eo_request_finish(struct eo_request *request);

/* True when the request has no reply yet and now sleeps. */
bool eo_request_sleep(struct eo_request *request);

/* Brackets a handler, so that a stop waits for it; false: the server is stopping. */
bool eo_http_enter(struct eo_http *http);
void eo_http_leave(struct eo_http *http);

#endif
