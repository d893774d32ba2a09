/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A short queue with its own threads, for requests that somebody waits for. A request with a token takes the place of
   one with the same token that has not begun (newest wins), so a user who drags a slider never waits for what he no
   longer wants. Any thread may call. */
#ifndef EASEOFF_SERVICE_LANE_H
#define EASEOFF_SERVICE_LANE_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/error.h"

struct eo_lane;

enum eo_lane_fate {
  EO_LANE_RUN,       /* its turn */
  EO_LANE_OVERTAKEN, /* a newer one took its place */
  EO_LANE_EXPIRED,   /* it waited too long for what it waited for */
  EO_LANE_STOPPED,   /* the lane is stopping */
};

/* The first member of whatever a request is. */
struct eo_lane_task {
  struct eo_lane_task *next;
  char token[65];        /* "": none */
  double queued;         /* ms of the clock, when it came */
  int64_t awaits;        /* job to wait for (eo_lane_wake()); 0: none */
  double patience;       /* ms of the clock until which it waits */
  struct eo_error error; /* of the job it waited for; EO_OK: it went well, or nothing was waited for */
  atomic_bool overtaken; /* while it runs, in a lane that says so: a newer one is there */
};

/* Called once for each task that was taken, on a thread of the lane; afterwards the lane releases the task. */
typedef void eo_lane_function(void *context, struct eo_lane_task *task, enum eo_lane_fate fate);
typedef void eo_lane_release(struct eo_lane_task *task);

struct eo_lane_settings {
  int threads, most;      /* most: waiting */
  bool overtakes_running; /* a newer request marks the one that runs as overtaken */
  int nice;               /* how much the threads stand back */
  eo_lane_function *function;
  eo_lane_release *release;
  void *context;
};

/* Starts the threads. Errors: memory, which a thread that cannot start counts as. */
enum eo_code eo_lane_new(struct eo_lane **lane, const struct eo_lane_settings *settings, struct eo_error *error);

/* False: full, or the lane is stopping (*closed); the task stays the caller's. */
bool eo_lane_push(struct eo_lane *lane, struct eo_lane_task *task, bool *closed);

/* The job ended: those who wait for it have their turn. error: NULL or code EO_OK when it went well. */
void eo_lane_wake(struct eo_lane *lane, int64_t job, const struct eo_error *error);

/* No task is taken any more, those that wait are told, those that run see overtaken. */
void eo_lane_stop(struct eo_lane *lane);
void eo_lane_free(struct eo_lane *lane); /* stops, waits for the threads; NULL is fine */

/* Tasks that no thread has begun. */
int eo_lane_waiting(struct eo_lane *lane);

/* Lowers the priority of the calling thread, and of those it makes, by nice steps; also elsewhere in this folder. */
void eo_lane_stand_back(int nice);

#endif
