/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE
#include "base/parallel.h"

#include <pthread.h>
#include <sched.h>
#include <stdbool.h>

struct shared {
  const struct eo_parallel *parallel;
  pthread_mutex_t mutex; /* guards what follows */
  int items, next, finished;
  bool stop;
  int failed_item;
  struct eo_error error;
};

struct worker {
  struct shared *shared;
  int number;
  pthread_t thread;
};

int eo_parallel_cores(void)
{
  cpu_set_t set;
  int count = sched_getaffinity(0, sizeof set, &set) ? 1 : CPU_COUNT(&set);
  return count < 1 ? 1 : count > EO_MAX_THREADS ? EO_MAX_THREADS : count;
}

static int take_item(struct shared *shared)
{
  pthread_mutex_lock(&shared->mutex);
  int item = shared->stop || shared->next == shared->items ? -1 : shared->next++;
  pthread_mutex_unlock(&shared->mutex);
  return item;
}

/* Items below a failed one were all handed out before it, so the lowest failure is the same for any timing. */
static int finish_item(struct shared *shared, int item, enum eo_code code, const struct eo_error *error)
{
  pthread_mutex_lock(&shared->mutex);
  int finished = ++shared->finished;
  if (code) {
    shared->stop = true;
    if (shared->failed_item < 0 || item < shared->failed_item) {
      shared->failed_item = item;
      shared->error = *error;
      shared->error.code = code;
    }
  }
  pthread_mutex_unlock(&shared->mutex);
  return finished;
}

/* True when a stop was asked for. */
static bool report(struct shared *shared, int finished)
{
  const struct eo_parallel *parallel = shared->parallel;
  if (!eo_progress_report(parallel->progress, parallel->what,
                          parallel->first + (parallel->last - parallel->first) * finished / shared->items))
    return false;
  pthread_mutex_lock(&shared->mutex);
  shared->stop = true;
  pthread_mutex_unlock(&shared->mutex);
  return true;
}

static bool work_off(struct shared *shared, int thread)
{
  bool cancelled = false;
  for (int item; !cancelled && (item = take_item(shared)) >= 0;) {
    struct eo_error error = {0};
    enum eo_code code = shared->parallel->work(shared->parallel->context, thread, item, &error);
    int finished = finish_item(shared, item, code, &error);
    cancelled = thread == 0 && report(shared, finished);
  }
  return cancelled;
}

static void *run_worker(void *argument)
{
  struct worker *worker = argument;
  work_off(worker->shared, worker->number);
  return NULL;
}

enum eo_code eo_parallel_run(const struct eo_parallel *parallel, int items, struct eo_error *error)
{
  struct shared shared = {.parallel = parallel, .items = items, .failed_item = -1};
  struct worker worker[EO_MAX_THREADS];
  int threads = parallel->threads < items ? parallel->threads : items, made = 1;
  pthread_mutex_init(&shared.mutex, NULL);
  for (; made < threads && made < EO_MAX_THREADS; made++) {
    worker[made] = (struct worker){.shared = &shared, .number = made};
    if (pthread_create(&worker[made].thread, NULL, run_worker, &worker[made]))
      break;
  }
  bool cancelled = work_off(&shared, 0);
  for (int i = 1; i < made; i++)
    pthread_join(worker[i].thread, NULL);
  pthread_mutex_destroy(&shared.mutex);
  if (shared.failed_item >= 0) {
    if (error)
      *error = shared.error;
    return shared.error.code;
  }
  return cancelled ? eo_error_set(error, EO_ERROR_CANCELLED, "", "The work was cancelled.") : EO_OK;
}
