/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/storage_watch.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "store/spare.h"
#include "store/store.h"

enum { SECONDS = 2, QUICK = 256 << 20 /* bytes of a database that is looked through at the start */ };

const char *const eo_storage_states[] = {"ok", "full", "locked", "damaged", "failing", NULL};

struct eo_storage_watch {
  struct eo_store *store; /* of the thread */
  double spare;
  pthread_t thread;
  pthread_mutex_t lock; /* of everything below */
  pthread_cond_t changed;
  struct eo_storage now;
  bool ending;
};

static enum eo_storage_state state_of(enum eo_code code)
{
  switch (code) {
  case EO_OK:
    return EO_STORAGE_OK;
  case EO_ERROR_FULL:
    return EO_STORAGE_FULL;
  case EO_ERROR_BUSY:
    return EO_STORAGE_LOCKED;
  case EO_ERROR_DAMAGED:
    return EO_STORAGE_DAMAGED;
  default:
    return EO_STORAGE_FAILING;
  }
}

static void note_damage(struct eo_storage_watch *watch, const char *text)
{
  if (!*watch->now.damage)
    snprintf(watch->now.damage, sizeof watch->now.damage, "%s", text);
}

static void look(struct eo_storage_watch *watch)
{
  struct eo_error error = {0};
  enum eo_code code = eo_store_probe(watch->store, &error);
  int64_t journal, size = eo_store_size(watch->store, &journal), free_bytes = eo_store_free_bytes(watch->store);
  bool full = free_bytes >= 0 && (double)free_bytes < watch->spare;
  eo_spare_keep(watch->store);
  pthread_mutex_lock(&watch->lock);
  if (code == EO_ERROR_DAMAGED)
    note_damage(watch, error.text);
  watch->now.state = code                 ? state_of(code)
                     : *watch->now.damage ? EO_STORAGE_DAMAGED
                     : full               ? EO_STORAGE_FULL
                                          : EO_STORAGE_OK;
  watch->now.free_bytes = free_bytes;
  watch->now.database_bytes = size;
  watch->now.journal_bytes = journal;
  pthread_mutex_unlock(&watch->lock);
}

static void *work(void *context)
{
  struct eo_storage_watch *watch = context;
  struct eo_error error;
  int64_t journal;
  if (eo_store_size(watch->store, &journal) < QUICK && eo_store_inspect(watch->store, true, &error) == EO_ERROR_DAMAGED)
    eo_storage_note(watch, &error);
  for (bool ending = false; !ending;) {
    struct timespec next;
    look(watch);
    clock_gettime(CLOCK_REALTIME, &next);
    next.tv_sec += SECONDS;
    pthread_mutex_lock(&watch->lock);
    while (!watch->ending && pthread_cond_timedwait(&watch->changed, &watch->lock, &next) == 0)
      ;
    ending = watch->ending;
    pthread_mutex_unlock(&watch->lock);
  }
  return NULL;
}

static enum eo_code begin(struct eo_storage_watch *watch, const char *data, struct eo_error *error)
{
  EO_TRY(eo_store_open(&watch->store, data, EO_STORE_WRITE, error));
  look(watch);
  return pthread_create(&watch->thread, NULL, work, watch) == 0
             ? EO_OK
             : eo_error_set(error, EO_ERROR_MEMORY, "", "A thread cannot be started.");
}

enum eo_code eo_storage_watch_new(struct eo_storage_watch **result, const char *data, double spare,
                                  struct eo_error *error)
{
  struct eo_storage_watch *watch = calloc(1, sizeof *watch);
  if (!watch)
    return eo_error_memory(error);
  watch->spare = spare;
  pthread_mutex_init(&watch->lock, NULL);
  pthread_cond_init(&watch->changed, NULL);
  enum eo_code code = begin(watch, data, error);
  if (!code) {
    *result = watch;
    return EO_OK;
  }
  eo_store_close(watch->store);
  free(watch);
  return code;
}

void eo_storage_watch_free(struct eo_storage_watch *watch)
{
  if (!watch)
    return;
  pthread_mutex_lock(&watch->lock);
  watch->ending = true;
  pthread_cond_signal(&watch->changed);
  pthread_mutex_unlock(&watch->lock);
  pthread_join(watch->thread, NULL);
  eo_store_close(watch->store);
  pthread_cond_destroy(&watch->changed);
  pthread_mutex_destroy(&watch->lock);
  free(watch);
}

struct eo_storage eo_storage_now(struct eo_storage_watch *watch)
{
  pthread_mutex_lock(&watch->lock);
  struct eo_storage now = watch->now;
  pthread_mutex_unlock(&watch->lock);
  return now;
}

void eo_storage_note(struct eo_storage_watch *watch, const struct eo_error *error)
{
  if (!watch)
    return;
  pthread_mutex_lock(&watch->lock);
  watch->now.failures[state_of(error->code)]++;
  if (error->code == EO_ERROR_DAMAGED) {
    note_damage(watch, error->text);
    watch->now.state = EO_STORAGE_DAMAGED;
  } else if (error->code == EO_ERROR_FULL)
    watch->now.state = EO_STORAGE_FULL;
  pthread_mutex_unlock(&watch->lock);
}
