/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/deferred.h"
#include "http/background.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "http/route.h"
#include "http/http_private.h"

enum { MOST_THREADS = 8, CLIENT = sizeof((struct eo_request *)0)->client_key };

struct eo_background {
  int threads;
  struct worker {
    struct eo_background *aside;
    struct eo_store *store;
    pthread_t thread;
    bool running, busy; /* busy, client: under the lock */
    unsigned char client[CLIENT];
  } worker[MOST_THREADS];
  pthread_mutex_t lock;
  pthread_cond_t changed;
  struct eo_request *waiting[EO_MOST_BACKGROUND]; /* in their order */
  int count;
  bool ending;
};

/* Whether a client's request may take a thread: the last free one is for others than those that are served already. */
static bool may_begin(const struct eo_background *aside, const struct eo_request *request)
{
  int busy = 0;
  bool served = false;
  for (int i = 0; i < aside->threads; i++) {
    busy += aside->worker[i].busy;
    served = served || (aside->worker[i].busy && memcmp(aside->worker[i].client, request->client_key, CLIENT) == 0);
  }
  return aside->threads == 1 || !served || busy < aside->threads - 1;
}

static struct eo_request *take_out(struct eo_background *aside)
{
  for (int i = 0; i < aside->count; i++) {
    struct eo_request *request = aside->waiting[i];
    if (!may_begin(aside, request))
      continue;
    for (aside->count--; i < aside->count; i++)
      aside->waiting[i] = aside->waiting[i + 1];
    return request;
  }
  return NULL;
}

static struct eo_request *next(struct worker *worker)
{
  struct eo_background *aside = worker->aside;
  struct eo_request *request = NULL;
  pthread_mutex_lock(&aside->lock);
  worker->busy = false;
  pthread_cond_broadcast(&aside->changed);
  while (!(request = take_out(aside)) && !(aside->ending && !aside->count))
    pthread_cond_wait(&aside->changed, &aside->lock);
  if (request) {
    worker->busy = true;
    memcpy(worker->client, request->client_key, CLIENT);
  }
  pthread_mutex_unlock(&aside->lock);
  return request;
}

static void *work(void *context)
{
  struct worker *worker = context;
  struct eo_request *request;
  while ((request = next(worker))) {
    request->store = worker->store;
    eo_route_run(request);
    eo_request_finish(request);
  }
  return NULL;
}

static enum eo_code start(struct eo_background *aside, struct worker *worker, const char *data, struct eo_error *error)
{
  worker->aside = aside;
  EO_TRY(eo_store_open(&worker->store, data, EO_STORE_WRITE, error));
  worker->running = pthread_create(&worker->thread, NULL, work, worker) == 0;
  return worker->running ? EO_OK : eo_error_set(error, EO_ERROR_MEMORY, "", "A thread cannot be started.");
}

enum eo_code eo_background_new(struct eo_background **aside, const char *data, int threads, struct eo_error *error)
{
  struct eo_background *made = calloc(1, sizeof *made);
  enum eo_code code = EO_OK;
  if (!made)
    return eo_error_memory(error);
  pthread_mutex_init(&made->lock, NULL);
  pthread_cond_init(&made->changed, NULL);
  made->threads = threads < MOST_THREADS ? threads : MOST_THREADS; /* before any of them looks */
  for (int i = 0; i < made->threads && !code; i++)
    code = start(made, &made->worker[i], data, error);
  if (code)
    eo_background_free(made);
  else
    *aside = made;
  return code;
}

void eo_background_take(struct eo_background *aside, struct eo_request *request)
{
  eo_request_defer(request);
  pthread_mutex_lock(&aside->lock);
  bool room = aside->count < EO_MOST_BACKGROUND;
  if (room) {
    aside->waiting[aside->count++] = request;
    pthread_cond_broadcast(&aside->changed);
  }
  pthread_mutex_unlock(&aside->lock);
  if (room)
    return;
  eo_reply_problem(&request->reply, 503, "busy", "Too many requests are waiting already.");
  request->reply.retry_after = 1;
  eo_request_finish(request);
}

int eo_background_waiting(struct eo_background *aside)
{
  pthread_mutex_lock(&aside->lock);
  int count = aside->count;
  pthread_mutex_unlock(&aside->lock);
  return count;
}

void eo_background_free(struct eo_background *aside)
{
  if (!aside)
    return;
  pthread_mutex_lock(&aside->lock);
  aside->ending = true;
  pthread_cond_broadcast(&aside->changed);
  pthread_mutex_unlock(&aside->lock);
  for (int i = 0; i < aside->threads; i++) {
    if (aside->worker[i].running)
      pthread_join(aside->worker[i].thread, NULL);
    eo_store_close(aside->worker[i].store);
  }
  pthread_cond_destroy(&aside->changed);
  pthread_mutex_destroy(&aside->lock);
  free(aside);
}
