/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crew/hands.h"

#include <errno.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/parallel.h"
#include "numerics/threads.h"

/* Parcels in the order in which they came. */
struct queue {
  struct link {
    struct eo_crew_parcel parcel;
    struct link *next;
  } * first, *last;
};

struct eo_hands {
  const struct eo_crew_trade *trade;
  struct eo_crew_place place;
  struct eo_crew_bench bench;
  struct eo_text order;
  atomic_bool stopped;
  pthread_mutex_t mutex; /* guards what follows */
  pthread_cond_t given, done;
  struct queue waiting, finished;
  bool closing;
  int threads;
  struct hand {
    struct eo_hands *hands;
    int number;
    pthread_t thread;
  } hand[EO_MAX_THREADS];
};

static void append(struct queue *queue, struct link *link)
{
  link->next = NULL;
  if (queue->last)
    queue->last->next = link;
  else
    queue->first = link;
  queue->last = link;
}

static struct link *take_first(struct queue *queue)
{
  struct link *link = queue->first;
  if (!link)
    return NULL;
  queue->first = link->next;
  if (!queue->first)
    queue->last = NULL;
  return link;
}

static void empty(struct queue *queue)
{
  for (struct link *link; (link = take_first(queue));) {
    eo_text_done(&link->parcel.text);
    free(link);
  }
}

static void work_off(struct eo_hands *hands, int thread, struct eo_crew_parcel *parcel)
{
  struct eo_text item = parcel->text;
  parcel->text = (struct eo_text){0};
  parcel->error = (struct eo_error){0};
  enum eo_code code = atomic_load(&hands->stopped)
                          ? eo_error_set(&parcel->error, EO_ERROR_CANCELLED, "", "The work was cancelled.")
                          : hands->trade->work(&hands->bench, thread, item.data ? item.data : "", item.size,
                                               &parcel->text, &parcel->error);
  if (!code && parcel->text.failed)
    code = eo_error_memory(&parcel->error);
  parcel->error.code = code;
  eo_text_done(&item);
}

static void *run_hand(void *argument)
{
  struct hand *hand = argument;
  struct eo_hands *hands = hand->hands;
  eo_threads_limit();
  pthread_mutex_lock(&hands->mutex);
  while (!hands->closing) {
    struct link *link = take_first(&hands->waiting);
    if (!link) {
      pthread_cond_wait(&hands->given, &hands->mutex);
      continue;
    }
    pthread_mutex_unlock(&hands->mutex);
    work_off(hands, hand->number, &link->parcel);
    pthread_mutex_lock(&hands->mutex);
    append(&hands->finished, link);
    pthread_cond_signal(&hands->done);
  }
  pthread_mutex_unlock(&hands->mutex);
  return NULL;
}

static enum eo_code start_threads(struct eo_hands *hands, struct eo_error *error)
{
  for (int i = 0; i < hands->place.threads; i++) {
    hands->hand[i] = (struct hand){.hands = hands, .number = i};
    if (pthread_create(&hands->hand[i].thread, NULL, run_hand, &hands->hand[i]))
      break;
    hands->threads++;
  }
  return hands->threads ? EO_OK : eo_error_memory(error);
}

enum eo_code eo_hands_new(struct eo_hands **result, const struct eo_crew_trade *trade, const char *order, size_t size,
                          const struct eo_crew_place *place, struct eo_error *error)
{
  struct eo_hands *hands = calloc(1, sizeof *hands);
  if (!hands)
    return eo_error_memory(error);
  pthread_condattr_t clock;
  pthread_condattr_init(&clock);
  pthread_condattr_setclock(&clock, CLOCK_MONOTONIC);
  pthread_mutex_init(&hands->mutex, NULL);
  pthread_cond_init(&hands->given, NULL);
  pthread_cond_init(&hands->done, &clock);
  pthread_condattr_destroy(&clock);
  eo_text_add_bytes(&hands->order, order, size);
  hands->trade = trade;
  hands->place = *place;
  hands->bench = (struct eo_crew_bench){
      .place = &hands->place, .order = hands->order.data, .size = hands->order.size, .stopped = &hands->stopped};
  enum eo_code code = hands->order.failed ? eo_error_memory(error) : trade->open(&hands->bench, error);
  if (!code)
    code = start_threads(hands, error);
  if (code) {
    eo_hands_free(hands);
    return code;
  }
  *result = hands;
  return EO_OK;
}

void eo_hands_stop(struct eo_hands *hands)
{
  atomic_store(&hands->stopped, true);
}

void eo_hands_free(struct eo_hands *hands)
{
  if (!hands)
    return;
  eo_hands_stop(hands);
  pthread_mutex_lock(&hands->mutex);
  hands->closing = true;
  pthread_cond_broadcast(&hands->given);
  pthread_mutex_unlock(&hands->mutex);
  for (int i = 0; i < hands->threads; i++)
    pthread_join(hands->hand[i].thread, NULL);
  hands->trade->close(&hands->bench);
  empty(&hands->waiting);
  empty(&hands->finished);
  pthread_cond_destroy(&hands->given);
  pthread_cond_destroy(&hands->done);
  pthread_mutex_destroy(&hands->mutex);
  eo_text_done(&hands->order);
  free(hands);
}

bool eo_hands_give(struct eo_hands *hands, struct eo_crew_parcel *parcel)
{
  struct link *link = malloc(sizeof *link);
  if (!link)
    return false;
  link->parcel = *parcel;
  parcel->text = (struct eo_text){0};
  pthread_mutex_lock(&hands->mutex);
  append(&hands->waiting, link);
  pthread_cond_signal(&hands->given);
  pthread_mutex_unlock(&hands->mutex);
  return true;
}

/* The moment so many milliseconds from now. */
static struct timespec moment_in(int milliseconds)
{
  struct timespec until;
  clock_gettime(CLOCK_MONOTONIC, &until);
  until.tv_sec += milliseconds / 1000;
  until.tv_nsec += milliseconds % 1000 * 1000000L;
  if (until.tv_nsec >= 1000000000L) {
    until.tv_sec++;
    until.tv_nsec -= 1000000000L;
  }
  return until;
}

bool eo_hands_collect(struct eo_hands *hands, int milliseconds, struct eo_crew_parcel *parcel)
{
  const struct timespec until = moment_in(milliseconds);
  pthread_mutex_lock(&hands->mutex);
  struct link *link = take_first(&hands->finished);
  while (!link && milliseconds > 0) {
    if (pthread_cond_timedwait(&hands->done, &hands->mutex, &until) == ETIMEDOUT)
      milliseconds = 0;
    link = take_first(&hands->finished);
  }
  pthread_mutex_unlock(&hands->mutex);
  if (!link)
    return false;
  *parcel = link->parcel;
  free(link);
  return true;
}
