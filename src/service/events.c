/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "service/events.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

struct kept {
  int64_t job;
  struct eo_text text; /* owned */
};

struct subscriber {
  struct subscriber *next;
  int64_t number, job;
  eo_service_listener *listener;
  void *context;
};

struct eo_events {
  pthread_mutex_t mutex;            /* guards everything; held while listeners are called */
  int64_t first, newest;            /* numbers: before the first event of this run; of the newest one */
  struct kept kept[EO_EVENTS_KEPT]; /* event n stands at n % EO_EVENTS_KEPT */
  struct subscriber *subscriber;
  int64_t subscriptions; /* so far */
};

enum eo_code eo_events_new(struct eo_events **result, struct eo_error *error)
{
  struct eo_events *events = calloc(1, sizeof *events);
  struct timespec now;
  if (!events)
    return eo_error_memory(error);
  pthread_mutex_init(&events->mutex, NULL);
  clock_gettime(CLOCK_REALTIME, &now);
  events->first = events->newest = (int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000;
  *result = events;
  return EO_OK;
}

void eo_events_free(struct eo_events *events)
{
  if (!events)
    return;
  for (struct subscriber *s = events->subscriber, *next; s; s = next) {
    next = s->next;
    free(s);
  }
  for (int i = 0; i < EO_EVENTS_KEPT; i++)
    eo_text_done(&events->kept[i].text);
  pthread_mutex_destroy(&events->mutex);
  free(events);
}

static void tell(const struct subscriber *subscriber, const struct eo_service_event *event)
{
  if (!subscriber->job || subscriber->job == event->job)
    subscriber->listener(subscriber->context, event);
}

static struct eo_service_event kept_event(const struct eo_events *events, int64_t number)
{
  const struct kept *kept = &events->kept[number % EO_EVENTS_KEPT];
  return (struct eo_service_event){number, kept->job, kept->text.data, kept->text.size};
}

void eo_events_publish(struct eo_events *events, int64_t job, struct eo_text *text)
{
  pthread_mutex_lock(&events->mutex);
  struct kept *place = &events->kept[++events->newest % EO_EVENTS_KEPT];
  eo_text_done(&place->text);
  *place = (struct kept){job, *text};
  *text = (struct eo_text){0};
  const struct eo_service_event event = kept_event(events, events->newest);
  for (const struct subscriber *s = events->subscriber; s; s = s->next)
    tell(s, &event);
  pthread_mutex_unlock(&events->mutex);
}

int64_t eo_events_newest(struct eo_events *events)
{
  pthread_mutex_lock(&events->mutex);
  int64_t newest = events->newest;
  pthread_mutex_unlock(&events->mutex);
  return newest;
}

bool eo_events_reach(struct eo_events *events, int64_t after)
{
  pthread_mutex_lock(&events->mutex);
  bool reach = after >= events->first && after >= events->newest - EO_EVENTS_KEPT && after <= events->newest;
  pthread_mutex_unlock(&events->mutex);
  return reach;
}

/* With the mutex held. */
static void replay(const struct eo_events *events, const struct subscriber *subscriber, int64_t after)
{
  int64_t oldest = events->newest - EO_EVENTS_KEPT + 1;
  oldest = oldest > events->first ? oldest : events->first + 1;
  for (int64_t number = after + 1 > oldest ? after + 1 : oldest; number <= events->newest; number++) {
    const struct eo_service_event event = kept_event(events, number);
    tell(subscriber, &event);
  }
}

enum eo_code eo_events_subscribe(struct eo_events *events, int64_t job, int64_t after, struct eo_service_event *first,
                                 int count, eo_service_listener *listener, void *context, int64_t *subscription,
                                 struct eo_error *error)
{
  struct subscriber *subscriber = calloc(1, sizeof *subscriber);
  if (!subscriber)
    return eo_error_memory(error);
  pthread_mutex_lock(&events->mutex);
  *subscriber = (struct subscriber){events->subscriber, ++events->subscriptions, job, listener, context};
  for (int i = 0; i < count; i++) {
    first[i].number = after;
    tell(subscriber, &first[i]);
  }
  replay(events, subscriber, after);
  events->subscriber = subscriber;
  *subscription = subscriber->number;
  pthread_mutex_unlock(&events->mutex);
  return EO_OK;
}

void eo_events_unsubscribe(struct eo_events *events, int64_t subscription)
{
  pthread_mutex_lock(&events->mutex);
  struct subscriber **link = &events->subscriber, *subscriber;
  while (*link && (*link)->number != subscription)
    link = &(*link)->next;
  subscriber = *link;
  if (subscriber)
    *link = subscriber->next;
  pthread_mutex_unlock(&events->mutex);
  free(subscriber);
}

int eo_events_subscribers(struct eo_events *events)
{
  int count = 0;
  pthread_mutex_lock(&events->mutex);
  for (const struct subscriber *s = events->subscriber; s; s = s->next)
    count++;
  pthread_mutex_unlock(&events->mutex);
  return count;
}

int64_t eo_events_published(struct eo_events *events)
{
  pthread_mutex_lock(&events->mutex);
  int64_t count = events->newest - events->first;
  pthread_mutex_unlock(&events->mutex);
  return count;
}
