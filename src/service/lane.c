/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE
#include "service/lane.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"

enum { MOST_THREADS = 16 };

struct eo_lane {
  struct eo_lane_settings settings;
  pthread_mutex_t mutex; /* guards what follows */
  pthread_cond_t changed;
  bool stopping;
  int waiting;                  /* tasks in the two lists below */
  struct eo_lane_task *queue;   /* in order */
  struct eo_lane_task *parked;  /* waiting for a job */
  struct eo_lane_task *dropped; /* overtaken, not told yet */
  struct eo_lane_task *running[MOST_THREADS];
  struct runner {
    struct eo_lane *lane;
    int number;
    pthread_t thread;
  } runner[MOST_THREADS];
  int threads; /* that were made */
};

void eo_lane_stand_back(int nice)
{
  id_t self = (id_t)gettid();
  setpriority(PRIO_PROCESS, self, getpriority(PRIO_PROCESS, self) + nice);
}

static void append(struct eo_lane_task **list, struct eo_lane_task *task)
{
  while (*list)
    list = &(*list)->next;
  task->next = NULL;
  *list = task;
}

static struct eo_lane_task *take_first(struct eo_lane_task **list)
{
  struct eo_lane_task *task = *list;
  if (task)
    *list = task->next;
  return task;
}

static struct eo_lane_task *take_expired(struct eo_lane *lane, double now)
{
  for (struct eo_lane_task **link = &lane->parked; *link; link = &(*link)->next)
    if ((*link)->patience <= now)
      return take_first(link);
  return NULL;
}

static struct eo_lane_task **find_token(struct eo_lane_task **list, const char *token)
{
  while (*list && strcmp((*list)->token, token) != 0)
    list = &(*list)->next;
  return *list ? list : NULL;
}

/* Puts the task in the place of an older one with its token; false: there is none that waits. */
static bool overtake(struct eo_lane *lane, struct eo_lane_task *task)
{
  if (!*task->token)
    return false;
  for (int i = 0; i < lane->threads && lane->settings.overtakes_running; i++)
    if (lane->running[i] && strcmp(lane->running[i]->token, task->token) == 0)
      atomic_store(&lane->running[i]->overtaken, true);
  struct eo_lane_task **link = find_token(&lane->queue, task->token);
  if (!link)
    link = find_token(&lane->parked, task->token);
  if (!link)
    return false;
  struct eo_lane_task *older = *link;
  bool same_list = !task->awaits == !older->awaits;
  *link = older->next;
  if (same_list) { /* its place in the queue too */
    task->next = *link;
    *link = task;
  } else
    append(task->awaits ? &lane->parked : &lane->queue, task);
  append(&lane->dropped, older);
  return true;
}

static double earliest(const struct eo_lane *lane)
{
  double when = INFINITY;
  for (const struct eo_lane_task *task = lane->parked; task; task = task->next)
    when = fmin(when, task->patience);
  return when;
}

/* With the mutex held: until something changes or somebody's patience ends. */
static void wait_for_change(struct eo_lane *lane)
{
  double when = earliest(lane);
  if (isinf(when)) {
    pthread_cond_wait(&lane->changed, &lane->mutex);
    return;
  }
  const struct timespec until = {(time_t)(when / 1e3), (long)(fmod(when, 1e3) * 1e6)};
  pthread_cond_timedwait(&lane->changed, &lane->mutex, &until);
}

/* What has to be done next, if anything. */
static struct eo_lane_task *next_task(struct eo_lane *lane, enum eo_lane_fate *fate)
{
  struct eo_lane_task *task = take_first(&lane->dropped);
  *fate = EO_LANE_OVERTAKEN;
  if (task)
    return task;
  task = take_expired(lane, eo_clock_milliseconds());
  *fate = EO_LANE_EXPIRED;
  if (!task) {
    *fate = lane->stopping ? EO_LANE_STOPPED : EO_LANE_RUN;
    task = take_first(&lane->queue);
  }
  if (!task && lane->stopping)
    task = take_first(&lane->parked);
  lane->waiting -= task != NULL;
  return task;
}

static void *run(void *argument)
{
  const struct runner *runner = argument;
  struct eo_lane *lane = runner->lane;
  enum eo_lane_fate fate;
  eo_lane_stand_back(lane->settings.nice);
  pthread_mutex_lock(&lane->mutex);
  for (;;) {
    struct eo_lane_task *task = next_task(lane, &fate);
    if (!task && lane->stopping)
      break;
    if (!task) {
      wait_for_change(lane);
      continue;
    }
    lane->running[runner->number] = fate == EO_LANE_RUN ? task : NULL;
    pthread_mutex_unlock(&lane->mutex);
    lane->settings.function(lane->settings.context, task, fate);
    pthread_mutex_lock(&lane->mutex);
    lane->running[runner->number] = NULL;
    lane->settings.release(task); /* not before: a newer one looks at its token */
  }
  pthread_mutex_unlock(&lane->mutex);
  return NULL;
}

enum eo_code eo_lane_new(struct eo_lane **result, const struct eo_lane_settings *settings, struct eo_error *error)
{
  struct eo_lane *lane = calloc(1, sizeof *lane);
  pthread_condattr_t attributes;
  if (!lane)
    return eo_error_memory(error);
  lane->settings = *settings;
  pthread_mutex_init(&lane->mutex, NULL);
  pthread_condattr_init(&attributes);
  pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
  pthread_cond_init(&lane->changed, &attributes);
  pthread_condattr_destroy(&attributes);
  int made = 0;
  for (; made < settings->threads && made < MOST_THREADS; made++) {
    struct runner *runner = &lane->runner[made];
    *runner = (struct runner){.lane = lane, .number = made};
    if (pthread_create(&runner->thread, NULL, run, runner))
      break;
    pthread_mutex_lock(&lane->mutex);
    lane->threads = made + 1;
    pthread_mutex_unlock(&lane->mutex);
  }
  if (!made) {
    eo_lane_free(lane);
    return eo_error_memory(error);
  }
  *result = lane;
  return EO_OK;
}

bool eo_lane_push(struct eo_lane *lane, struct eo_lane_task *task, bool *closed)
{
  task->queued = eo_clock_milliseconds();
  pthread_mutex_lock(&lane->mutex);
  *closed = lane->stopping;
  bool taken = !lane->stopping && overtake(lane, task);
  if (!taken && !lane->stopping && lane->waiting < lane->settings.most) {
    append(task->awaits ? &lane->parked : &lane->queue, task);
    lane->waiting++;
    taken = true;
  }
  pthread_cond_broadcast(&lane->changed);
  pthread_mutex_unlock(&lane->mutex);
  return taken;
}

void eo_lane_wake(struct eo_lane *lane, int64_t job, const struct eo_error *error)
{
  pthread_mutex_lock(&lane->mutex);
  for (struct eo_lane_task **link = &lane->parked; *link;) {
    if ((*link)->awaits != job) {
      link = &(*link)->next;
      continue;
    }
    struct eo_lane_task *task = take_first(link);
    task->awaits = 0;
    if (error)
      task->error = *error;
    append(&lane->queue, task);
  }
  pthread_cond_broadcast(&lane->changed);
  pthread_mutex_unlock(&lane->mutex);
}

void eo_lane_stop(struct eo_lane *lane)
{
  pthread_mutex_lock(&lane->mutex);
  lane->stopping = true;
  for (int i = 0; i < lane->threads; i++)
    if (lane->running[i])
      atomic_store(&lane->running[i]->overtaken, true);
  pthread_cond_broadcast(&lane->changed);
  pthread_mutex_unlock(&lane->mutex);
}

void eo_lane_free(struct eo_lane *lane)
{
  if (!lane)
    return;
  eo_lane_stop(lane);
  for (int i = 0; i < lane->threads; i++)
    pthread_join(lane->runner[i].thread, NULL);
  pthread_cond_destroy(&lane->changed);
  pthread_mutex_destroy(&lane->mutex);
  free(lane);
}

int eo_lane_waiting(struct eo_lane *lane)
{
  pthread_mutex_lock(&lane->mutex);
  int waiting = lane->waiting;
  pthread_mutex_unlock(&lane->mutex);
  return waiting;
}
