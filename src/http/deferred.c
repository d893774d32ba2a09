/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/deferred.h"

#include "http/http_private.h"

bool eo_http_enter(struct eo_http *http)
{
  pthread_mutex_lock(&http->lock);
  bool open = !http->closing;
  http->deferred += open;
  pthread_mutex_unlock(&http->lock);
  return open;
}

void eo_http_leave(struct eo_http *http)
{
  pthread_mutex_lock(&http->lock);
  http->deferred--;
  if (http->closing)
    pthread_cond_broadcast(&http->changed);
  pthread_mutex_unlock(&http->lock);
}

void eo_request_defer(struct eo_request *request)
{
  struct eo_http *http = request->http;
  pthread_mutex_lock(&http->lock);
  request->deferred = true;
  http->deferred++;
  pthread_mutex_unlock(&http->lock);
}

void eo_request_finish(struct eo_request *request)
{
  struct eo_http *http = request->http;
  pthread_mutex_lock(&http->lock);
  request->finished = true;
  if (request->suspended) {
    request->suspended = false;
    MHD_resume_connection(request->connection);
  }
  http->deferred--;
  if (http->closing)
    pthread_cond_broadcast(&http->changed);
  pthread_mutex_unlock(&http->lock);
}

bool eo_request_sleep(struct eo_request *request)
{
  struct eo_http *http = request->http;
  pthread_mutex_lock(&http->lock);
  bool sleeps = request->deferred && !request->finished;
  if (sleeps && !request->suspended) {
    request->suspended = true;
    MHD_suspend_connection(request->connection);
  }
  pthread_mutex_unlock(&http->lock);
  return sleeps;
}
