/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/deferred.h"
#include "http/background.h"

#include <pthread.h>
#include <stdlib.h>

#include "http/route.h"
#include "http/http_private.h"

struct eo_background {
  struct eo_store *store;
  pthread_t thread;
  pthread_mutex_t lock;
  pthread_cond_t changed;
  struct eo_request *waiting[EO_MOST_BACKGROUND]; /* a ring */
  int first, count;
  bool ending;
};

static struct eo_request *next(struct eo_background *aside)
{
  struct eo_request *request = NULL;
  pthread_mutex_lock(&aside->lock);
  while (!aside->count && !aside->ending)
    pthread_cond_wait(&aside->changed, &aside->lock);
  if (aside->count) {
    request = aside->waiting[aside->first];
    aside->first = (aside->first + 1) % EO_MOST_BACKGROUND;
    aside->count--;
  }
  pthread_mutex_unlock(&aside->lock);
  return request;
}

static void *work(void *context)
{
  struct eo_background *aside = context;
  struct eo_request *request;
  while ((request = next(aside))) {
    request->store = aside->store;
    eo_route_run(request);
    eo_request_finish(request);
  }
  return NULL;
}

enum eo_code eo_background_new(struct eo_background **aside, const char *data, struct eo_error *error)
{
  struct eo_background *made = calloc(1, sizeof *made);
  if (!made)
    return eo_error_memory(error);
  enum eo_code code = eo_store_open(&made->store, data, EO_STORE_WRITE, error);
  pthread_mutex_init(&made->lock, NULL);
  pthread_cond_init(&made->changed, NULL);
  if (!code && pthread_create(&made->thread, NULL, work, made) != 0)
    code = eo_error_set(error, EO_ERROR_MEMORY, "", "A thread cannot be started.");
  if (!code) {
    *aside = made;
    return EO_OK;
  }
  eo_store_close(made->store);
  free(made);
  return code;
}

void eo_background_take(struct eo_background *aside, struct eo_request *request)
{
  eo_request_defer(request);
  pthread_mutex_lock(&aside->lock);
  bool room = aside->count < EO_MOST_BACKGROUND;
  if (room) {
    aside->waiting[(aside->first + aside->count++) % EO_MOST_BACKGROUND] = request;
    pthread_cond_signal(&aside->changed);
  }
  pthread_mutex_unlock(&aside->lock);
  if (room)
    return;
  eo_reply_problem(&request->reply, 503, "busy", "Too many requests are waiting already.");
  request->reply.retry_after = 1;
  eo_request_finish(request);
}

void eo_background_free(struct eo_background *aside)
{
  if (!aside)
    return;
  pthread_mutex_lock(&aside->lock);
  aside->ending = true;
  pthread_cond_signal(&aside->changed);
  pthread_mutex_unlock(&aside->lock);
  pthread_join(aside->thread, NULL);
  eo_store_close(aside->store);
  pthread_cond_destroy(&aside->changed);
  pthread_mutex_destroy(&aside->lock);
  free(aside);
}
