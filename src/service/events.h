/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The last events and those who listen to them. Any thread may call. */
#ifndef EASEOFF_SERVICE_EVENTS_H
#define EASEOFF_SERVICE_EVENTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"
#include "format/text.h"

enum { EO_EVENTS_KEPT = 1024 };

/* A job as it was at a moment. Numbers grow by one, across restarts too (by more than one then). */
struct eo_service_event {
  int64_t number;
  int64_t job;
  const char *text; /* the job's document without design, compact JSON, one line; borrowed */
  size_t size;
};
typedef void eo_service_listener(void *context, const struct eo_service_event *event);

struct eo_events;

/* Numbers begin above those of any run before: at the milliseconds since 1970. */
enum eo_code eo_events_new(struct eo_events **events, struct eo_error *error);
void eo_events_free(struct eo_events *events); /* NULL is fine */

/* Keeps the text, taking it over, and hands it to the listeners, one event at a time. */
void eo_events_publish(struct eo_events *events, int64_t job, struct eo_text *text);

/* Number of the newest event; whether everything after a number is still kept. */
int64_t eo_events_newest(struct eo_events *events);
bool eo_events_reach(struct eo_events *events, int64_t after);

/* Hands over first[count] (their numbers are set to after), then what is kept after the number, then everything from
   now on, of one job or of all (0). Errors: memory. */
enum eo_code eo_events_subscribe(struct eo_events *events, int64_t job, int64_t after, struct eo_service_event *first,
                                 int count, eo_service_listener *listener, void *context, int64_t *subscription,
                                 struct eo_error *error);
void eo_events_unsubscribe(struct eo_events *events, int64_t subscription);

/* How many there are at the moment. */
int eo_events_subscribers(struct eo_events *events);
int64_t eo_events_published(struct eo_events *events); /* since the start */

#endif
