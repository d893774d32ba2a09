/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A service on a folder of its own, with coarse pairs, and what is needed to wait for it. */
#ifndef EASEOFF_TESTS_SUPPORT_SERVICE_FIXTURE_H
#define EASEOFF_TESTS_SUPPORT_SERVICE_FIXTURE_H

#include <pthread.h>
#include <time.h>

#include "base/clock.h"
#include "service/service.h"
#include "support/study-fixture.h"

__attribute__((unused)) static struct eo_service *start_with(int most_queued, int most_pairs)
{
  struct eo_service_settings settings = {.data = folder, .threads = 2};
  eo_table_defaults(&eo_service_limits_table, &settings.limits);
  if (most_queued)
    settings.limits.queued_jobs = most_queued;
  if (most_pairs)
    settings.limits.prepared_pairs = most_pairs;
  struct eo_service *service = NULL;
  if (eo_service_new(&service, &settings, &error)) {
    printf("Bail out! %s\n", error.text);
    exit(99);
  }
  return service;
}

__attribute__((unused)) static struct eo_service *start(void)
{
  return start_with(0, 0);
}

__attribute__((unused)) static void pause_for(double milliseconds)
{
  const struct timespec time = {(time_t)(milliseconds / 1e3), (long)(1e6 * milliseconds) % 1000000000};
  nanosleep(&time, NULL);
}

/* A study that takes long enough to be interrupted. */
__attribute__((unused)) static void make_design(struct eo_design *design, int budget)
{
  coarse_design(design, "credibility-ga", budget);
  if (!complete(design))
    printf("Bail out! %s\n", error.text);
}

__attribute__((unused)) static int64_t submit(struct eo_service *service, enum eo_job_kind kind,
                                              const struct eo_design *design, const char *key,
                                              enum eo_job_outcome *outcome)
{
  const struct eo_job_order order = {.kind = kind, .design = design, .key = key};
  struct eo_job_view job;
  if (eo_service_submit(service, &order, outcome, &job, &error))
    printf("# %s\n", error.text);
  int64_t id = job.row.id;
  eo_job_view_done(&job);
  return id;
}

/* The job's document; NULL when there is none. */
__attribute__((unused)) static json_t *look(struct eo_service *service, int64_t id)
{
  enum eo_job_outcome outcome;
  struct eo_job_view job;
  eo_service_job(service, id, false, &outcome, &job, &error);
  json_t *document = job.texts ? eo_job_view_encode(&job) : NULL;
  eo_job_view_done(&job);
  return document;
}

__attribute__((unused)) static bool is_in(struct eo_service *service, int64_t id, const char *state)
{
  json_t *job = look(service, id);
  const char *now = json_string_value(json_object_get(job, "state"));
  bool is = now && strcmp(now, state) == 0;
  json_decref(job);
  return is;
}

/* True as soon as the job is in this state; gives up after a minute. */
__attribute__((unused)) static bool wait_for(struct eo_service *service, int64_t id, const char *state)
{
  for (int i = 0; i < 12000 && !is_in(service, id, state); i++)
    pause_for(5);
  return is_in(service, id, state);
}

__attribute__((unused)) static int progress_of(struct eo_service *service, int64_t id, const char *key)
{
  json_t *job = look(service, id);
  int value = (int)json_integer_value(json_object_get(json_object_get(job, "progress"), key));
  json_decref(job);
  return value;
}

/* True once the job runs and has this many evaluations. */
__attribute__((unused)) static bool wait_for_evaluations(struct eo_service *service, int64_t id, int count)
{
  for (int i = 0; i < 12000 && progress_of(service, id, "true_evaluations") < count; i++)
    pause_for(2);
  return progress_of(service, id, "true_evaluations") >= count;
}

struct answered {
  int count;
  struct eo_answer last; /* its text is owned */
};
static pthread_mutex_t answer_mutex = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t answer_changed = PTHREAD_COND_INITIALIZER;

__attribute__((unused)) static void take_answer(void *context, struct eo_answer *answer)
{
  struct answered *answered = context;
  pthread_mutex_lock(&answer_mutex);
  eo_text_done(&answered->last.text);
  answered->last = *answer;
  answer->text = (struct eo_text){0};
  answered->count++;
  pthread_cond_broadcast(&answer_changed);
  pthread_mutex_unlock(&answer_mutex);
}

__attribute__((unused)) static void wait_for_answers(struct answered *answered, int count)
{
  pthread_mutex_lock(&answer_mutex);
  while (answered->count < count)
    pthread_cond_wait(&answer_changed, &answer_mutex);
  pthread_mutex_unlock(&answer_mutex);
}

#endif
