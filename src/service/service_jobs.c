/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Jobs as they are now: for whoever asks, and as events for whoever listens. */
#include "service/service_private.h"

#include <stdlib.h>

/* From before a job's row is read until it is copied: a job that ends in between would show its end with what was
   noted of it a while before. */
static void lock_jobs(struct eo_service *service)
{
  pthread_mutex_lock(&service->store_mutex);
  pthread_mutex_lock(&service->live_mutex);
}

static void unlock_jobs(struct eo_service *service)
{
  pthread_mutex_unlock(&service->live_mutex);
  pthread_mutex_unlock(&service->store_mutex);
}

/* Where a job is copied to. */
struct copying {
  struct eo_service *service;
  bool with_design;
  int64_t only; /* 0: whichever comes */
  struct eo_job_view *job;
};

static enum eo_code copy(void *context, const struct eo_stored_job *row, struct eo_error *error)
{
  const struct copying *copying = context;
  struct eo_stored_job shown = *row;
  const struct eo_job_live *live = NULL;
  if (copying->only && row->id != copying->only)
    return EO_OK;
  for (int kind = 0; kind < EO_JOB_KINDS; kind++) {
    const struct eo_service_worker *worker = &copying->service->worker[kind];
    if (worker->live.id != row->id)
      continue;
    if (!worker->launched)
      live = &worker->live;
    else if (row->state > EO_JOB_RUNNING) /* its process has still to write the result, and to end */
      shown.state = EO_JOB_RUNNING;
  }
  return eo_job_view_init(copying->job, &shown, live, copying->with_design, error);
}

/* Without the design and the result, which may be long. False: there is no such job, or an error. */
static bool find_brief(struct eo_service *service, int64_t id, struct eo_job_view *job)
{
  struct copying copying = {.service = service, .only = id, .job = job};
  const struct eo_queue_filter filter = {.state = -1, .kind = -1, .before = id + 1, .limit = 1};
  *job = (struct eo_job_view){0};
  lock_jobs(service);
  eo_queue_list(service->store, &filter, copy, &copying, NULL);
  unlock_jobs(service);
  return job->texts;
}

void eo_service_publish(struct eo_service *service, int64_t id)
{
  struct eo_text text = {0};
  struct eo_job_view job;
  pthread_mutex_lock(&service->publish_mutex);
  if (find_brief(service, id, &job))
    eo_job_view_write(&job, &text);
  if (text.size && !text.failed)
    eo_events_publish(service->events, id, &text);
  pthread_mutex_unlock(&service->publish_mutex);
  eo_text_done(&text);
  eo_job_view_done(&job);
}

struct snapshot {
  struct eo_service *service;
  int64_t only;                   /* 0: whichever comes */
  struct eo_service_event *event; /* owned, its texts too */
  int count, capacity;
};

static enum eo_code grow(struct snapshot *snapshot, struct eo_error *error)
{
  if (snapshot->count < snapshot->capacity)
    return EO_OK;
  int capacity = 2 * snapshot->capacity + 16;
  struct eo_service_event *more = realloc(snapshot->event, sizeof *more * (size_t)capacity);
  if (!more)
    return eo_error_memory(error);
  snapshot->event = more;
  snapshot->capacity = capacity;
  return EO_OK;
}

static enum eo_code add_to_snapshot(void *context, const struct eo_stored_job *row, struct eo_error *error)
{
  struct snapshot *snapshot = context;
  struct eo_text text = {0};
  struct eo_job_view job;
  struct copying copying = {.service = snapshot->service, .job = &job};
  if (snapshot->only && row->id != snapshot->only)
    return EO_OK;
  EO_TRY(grow(snapshot, error));
  EO_TRY(copy(&copying, row, error));
  eo_job_view_write(&job, &text);
  eo_job_view_done(&job);
  if (text.failed) {
    eo_text_done(&text);
    return eo_error_memory(error);
  }
  snapshot->event[snapshot->count++] = (struct eo_service_event){.job = row->id, .text = text.data, .size = text.size};
  return EO_OK;
}

/* Of one job whatever its state, since it may have ended before its listener came; of all (0) those that have not. */
static enum eo_code take_snapshot(struct eo_service *service, int64_t job, struct snapshot *snapshot,
                                  struct eo_error *error)
{
  const struct eo_queue_filter one = {.state = -1, .kind = -1, .before = job + 1, .limit = 1};
  const struct eo_queue_filter active = {.state = -1, .kind = -1, .active = true, .limit = EO_EVENTS_KEPT};
  snapshot->only = job;
  lock_jobs(service);
  enum eo_code code = eo_queue_list(service->store, job ? &one : &active, add_to_snapshot, snapshot, error);
  unlock_jobs(service);
  return code;
}

enum eo_code eo_service_subscribe(struct eo_service *service, int64_t job, int64_t after, eo_service_listener *listener,
                                  void *context, int64_t *subscription, struct eo_error *error)
{
  struct snapshot snapshot = {.service = service};
  int64_t newest = eo_events_newest(service->events); /* before the snapshot: what happens from now on comes after it */
  enum eo_code code = EO_OK;
  if (after <= 0 || !eo_events_reach(service->events, after)) {
    if (job || after > 0)
      code = take_snapshot(service, job, &snapshot, error);
    after = newest;
  }
  if (!code)
    code = eo_events_subscribe(service->events, job, after, snapshot.event, snapshot.count, listener, context,
                               subscription, error);
  for (int i = 0; i < snapshot.count; i++)
    free((char *)snapshot.event[i].text);
  free(snapshot.event);
  return code;
}

void eo_service_unsubscribe(struct eo_service *service, int64_t subscription)
{
  eo_events_unsubscribe(service->events, subscription);
}

enum eo_code eo_service_job(struct eo_service *service, int64_t id, bool with_design, enum eo_job_outcome *outcome,
                            struct eo_job_view *job, struct eo_error *error)
{
  struct copying copying = {.service = service, .with_design = with_design, .job = job};
  *job = (struct eo_job_view){0};
  lock_jobs(service);
  enum eo_code code = eo_queue_find(service->store, id, copy, &copying, outcome, error);
  unlock_jobs(service);
  return code;
}

struct paging {
  struct eo_service *service;
  struct eo_job_page *page;
  int limit;
};

static enum eo_code add_to_page(void *context, const struct eo_stored_job *row, struct eo_error *error)
{
  struct paging *paging = context;
  struct eo_job_page *page = paging->page;
  if (page->count == paging->limit) {
    page->more = true;
    return EO_OK;
  }
  struct copying copying = {.service = paging->service, .job = &page->job[page->count]};
  EO_TRY(copy(&copying, row, error));
  page->count++;
  return EO_OK;
}

enum eo_code eo_service_jobs(struct eo_service *service, int state, int kind, int64_t before, int limit,
                             struct eo_job_page *page, struct eo_error *error)
{
  struct paging paging = {service, page, limit};
  const struct eo_queue_filter filter = {.state = state, .kind = kind, .before = before, .limit = limit + 1};
  *page = (struct eo_job_page){.job = calloc((size_t)limit, sizeof *page->job)};
  if (!page->job)
    return eo_error_memory(error);
  lock_jobs(service);
  enum eo_code code = eo_queue_list(service->store, &filter, add_to_page, &paging, error);
  unlock_jobs(service);
  if (code)
    eo_job_page_done(page);
  return code;
}

void eo_job_page_done(struct eo_job_page *page)
{
  for (int i = 0; i < page->count; i++)
    eo_job_view_done(&page->job[i]);
  free(page->job);
  *page = (struct eo_job_page){0};
}

struct reading {
  struct eo_text *text;
  bool there;
};

static enum eo_code read_result(void *context, const struct eo_stored_job *job, struct eo_error *error)
{
  struct reading *reading = context;
  reading->there = *job->result != '\0';
  eo_text_add(reading->text, job->result);
  return reading->text->failed ? eo_error_memory(error) : EO_OK;
}

enum eo_code eo_service_result(struct eo_service *service, int64_t id, enum eo_job_outcome *outcome,
                               struct eo_text *text, struct eo_error *error)
{
  struct reading reading = {.text = text};
  pthread_mutex_lock(&service->store_mutex);
  enum eo_code code = eo_queue_find(service->store, id, read_result, &reading, outcome, error);
  pthread_mutex_unlock(&service->store_mutex);
  if (!code && *outcome == EO_JOB_OUTCOME_DONE && !reading.there)
    *outcome = EO_JOB_OUTCOME_STATE;
  return code;
}

/* Of a job that is being worked on; false: it is another one. */
static bool copy_live(struct eo_service *service, int64_t id, struct eo_job_convergence *convergence,
                      enum eo_code *code, struct eo_error *error)
{
  const struct eo_job_live *live = &service->worker[EO_JOB_OPTIMIZE].live;
  pthread_mutex_lock(&service->live_mutex);
  bool is_live = live->id == id;
  if (is_live)
    *code = eo_job_convergence_copy(convergence, live, error);
  pthread_mutex_unlock(&service->live_mutex);
  return is_live;
}

enum eo_code eo_service_convergence(struct eo_service *service, int64_t id, enum eo_job_outcome *outcome,
                                    struct eo_job_convergence *convergence, struct eo_error *error)
{
  struct eo_text text = {0};
  enum eo_code code;
  *convergence = (struct eo_job_convergence){0};
  *outcome = EO_JOB_OUTCOME_DONE;
  if (copy_live(service, id, convergence, &code, error))
    return code;
  code = eo_service_result(service, id, outcome, &text, error);
  if (!code && *outcome != EO_JOB_OUTCOME_MISSING) {
    *outcome = EO_JOB_OUTCOME_DONE;
    code = eo_job_convergence_read(convergence, text.size ? text.data : "", error);
  }
  eo_text_done(&text);
  return code;
}
