/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "service/service_private.h"

#include <math.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/parallel.h"
#include "numerics/threads.h"
#include "store/lock.h"

enum {
  ANALYSIS_THREADS = 2,
  SWEEP_NICE = 5,
  OTHER_THREADS = 4,
  LOCK_MS = 250 /* that those who ask wait while another program writes */
};

static int or_standard(int value, int standard)
{
  return value > 0 ? value : standard;
}

/* Owned; other processes see another file behind /proc/self/exe. NULL without memory. */
static char *own_path(void)
{
  char path[PATH_MAX];
  ssize_t length = readlink("/proc/self/exe", path, sizeof path - 1);
  path[length > 0 ? length : 0] = '\0';
  return strdup(path);
}

static bool resolve(struct eo_service_settings *own, const struct eo_service_settings *settings)
{
  *own = *settings;
  own->threads = or_standard(settings->threads, eo_parallel_cores());
  own->analysis_threads = or_standard(settings->analysis_threads, ANALYSIS_THREADS);
  if (!settings->limits.attempts) /* at least one in any table that was read */
    eo_table_defaults(&eo_service_limits_table, &own->limits);
  own->data = strdup(settings->data);
  own->cache = settings->cache ? strdup(settings->cache) : NULL;
  own->program = settings->program ? strdup(settings->program) : NULL;
  own->launcher = settings->launcher && *settings->launcher ? strdup(settings->launcher) : NULL;
  own->worker = settings->worker ? strdup(settings->worker) : own_path();
  return own->data && (own->cache || !settings->cache) && (own->program || !settings->program) &&
         (own->launcher || !settings->launcher || !*settings->launcher) && own->worker;
}

struct eo_preparation_settings eo_service_preparation(const struct eo_service *service)
{
  const struct eo_service_limits *limits = &service->settings.limits;
  double machine = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
  return (struct eo_preparation_settings){.program = service->settings.cache ? service->settings.program : NULL,
                                          .cache = service->settings.cache,
                                          .memory = isnan(limits->pair_memory_MB) ? 0.5 * machine
                                                                                  : 1e6 * limits->pair_memory_MB,
                                          .seconds = 60 * limits->pair_minutes};
}

static enum eo_code open_store(struct eo_service *service, struct eo_error *error)
{
  bool taken = false;
  int64_t queued;
  EO_TRY(eo_store_open(&service->store, service->settings.data, EO_STORE_WRITE, error));
  EO_TRY(eo_store_claim_server(service->store, &taken, error));
  if (!taken)
    return eo_error_set(error, EO_ERROR_FILE, "", "Another server works on the data folder %.200s.",
                        service->settings.data);
  struct eo_error why = {0};
  struct eo_text fault = {0};
  eo_error_set(
      &why, EO_ERROR_NUMERIC, "",
      "The server ended %d times in the middle of this job, which came no further: it may take more memory than "
      "there is. It can be tried again.",
      service->settings.limits.attempts);
  eo_job_error_write(&why, &fault);
  enum eo_code code = fault.failed ? eo_error_memory(error)
                                   : eo_queue_recover(service->store, service->settings.limits.attempts, fault.data,
                                                      &queued, error);
  eo_text_done(&fault);
  eo_store_wait(service->store, LOCK_MS);
  return code;
}

static enum eo_code make_lanes(struct eo_service *service, struct eo_error *error)
{
  struct eo_lane_settings settings = {.threads = service->settings.analysis_threads,
                                      .most = service->settings.limits.waiting_questions,
                                      .function = eo_service_run_task,
                                      .release = eo_service_release_task,
                                      .context = service};
  EO_TRY(eo_lane_new(&service->analyses, &settings, error));
  settings.threads = 1;
  settings.overtakes_running = true;
  settings.nice = SWEEP_NICE;
  EO_TRY(eo_lane_new(&service->sweeps, &settings, error));
  return eo_lane_new(&service->works, &settings, error);
}

static enum eo_code make_workers(struct eo_service *service, struct eo_error *error)
{
  for (int kind = 0; kind < EO_JOB_KINDS; kind++) {
    struct eo_service_worker *worker = &service->worker[kind];
    worker->service = service;
    worker->kind = (enum eo_job_kind)kind;
    EO_TRY(eo_store_open(&worker->store, service->settings.data, EO_STORE_WRITE, error));
    worker->running = pthread_create(&worker->thread, NULL, eo_service_work, worker) == 0;
    if (!worker->running)
      return eo_error_memory(error);
  }
  return EO_OK;
}

static void make_mutexes(struct eo_service *service)
{
  pthread_condattr_t attributes;
  pthread_mutex_t *const mutex[] = {&service->preparing_mutex, &service->publish_mutex, &service->store_mutex,
                                    &service->live_mutex,      &service->note_mutex,    &service->work_mutex,
                                    &service->timing_mutex};
  for (size_t i = 0; i < sizeof mutex / sizeof mutex[0]; i++)
    pthread_mutex_init(mutex[i], NULL);
  pthread_condattr_init(&attributes);
  pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
  pthread_cond_init(&service->work, &attributes);
  pthread_condattr_destroy(&attributes);
}

static enum eo_code begin(struct eo_service *service, const struct eo_service_settings *settings,
                          struct eo_error *error)
{
  if (!resolve(&service->settings, settings))
    return eo_error_memory(error);
  /* workers, an analysis and its second thread, sweeps, works, the members of a pair */
  EO_TRY(eo_threads_reserve(3 * service->settings.threads + 2 * service->settings.analysis_threads + OTHER_THREADS,
                            error));
  EO_TRY(open_store(service, error));
  const struct eo_service_limits *limits = &service->settings.limits;
  const struct eo_pairs_settings pairs = {.preparation = eo_service_preparation(service),
                                          .most = limits->prepared_pairs,
                                          .cache_bytes = 1e9 * limits->cache_GB};
  EO_TRY(eo_pairs_new(&service->pairs, &pairs, error));
  EO_TRY(eo_events_new(&service->events, error));
  EO_TRY(make_lanes(service, error));
  return make_workers(service, error);
}

enum eo_code eo_service_new(struct eo_service **result, const struct eo_service_settings *settings,
                            struct eo_error *error)
{
  struct eo_service *service = calloc(1, sizeof *service);
  if (!service)
    return eo_error_memory(error);
  make_mutexes(service);
  service->cores = eo_parallel_cores();
  enum eo_code code = begin(service, settings, error);
  if (code)
    eo_service_free(service);
  else
    *result = service;
  return code;
}

void eo_service_stop(struct eo_service *service)
{
  pthread_mutex_lock(&service->work_mutex);
  atomic_store(&service->stopping, true);
  pthread_cond_broadcast(&service->work);
  pthread_mutex_unlock(&service->work_mutex);
  if (service->analyses)
    eo_lane_stop(service->analyses);
  if (service->sweeps)
    eo_lane_stop(service->sweeps);
  if (service->works)
    eo_lane_stop(service->works);
}

void eo_service_free(struct eo_service *service)
{
  if (!service)
    return;
  eo_service_stop(service);
  for (int kind = 0; kind < EO_JOB_KINDS; kind++) {
    if (service->worker[kind].running)
      pthread_join(service->worker[kind].thread, NULL);
    eo_job_live_done(&service->worker[kind].live);
    eo_store_close(service->worker[kind].store);
  }
  eo_lane_free(service->analyses);
  eo_lane_free(service->sweeps);
  eo_lane_free(service->works);
  eo_pairs_free(service->pairs);
  eo_events_free(service->events);
  eo_store_close(service->store);
  pthread_mutex_t *const mutex[] = {&service->preparing_mutex, &service->publish_mutex, &service->store_mutex,
                                    &service->live_mutex,      &service->note_mutex,    &service->work_mutex,
                                    &service->timing_mutex};
  for (size_t i = 0; i < sizeof mutex / sizeof mutex[0]; i++)
    pthread_mutex_destroy(mutex[i]);
  pthread_cond_destroy(&service->work);
  free((char *)service->settings.data);
  free((char *)service->settings.cache);
  free((char *)service->settings.program);
  free((char *)service->settings.launcher);
  free((char *)service->settings.worker);
  free(service);
}

void eo_service_tell(struct eo_service *service, eo_service_note *note, void *context)
{
  pthread_mutex_lock(&service->note_mutex);
  service->note = note;
  service->note_context = context;
  pthread_mutex_unlock(&service->note_mutex);
}

void eo_service_wake(struct eo_service *service)
{
  pthread_mutex_lock(&service->work_mutex);
  service->calls++;
  pthread_cond_broadcast(&service->work);
  pthread_mutex_unlock(&service->work_mutex);
}

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

enum eo_code eo_service_subscribe(struct eo_service *service, int64_t job, int64_t after, eo_service_listener *listener,
                                  void *context, int64_t *subscription, struct eo_error *error)
{
  struct snapshot snapshot = {.service = service};
  const struct eo_queue_filter filter = {.state = -1, .kind = -1, .active = true, .limit = EO_EVENTS_KEPT};
  int64_t newest = eo_events_newest(service->events); /* before the snapshot: what happens from now on comes after it */
  enum eo_code code = EO_OK;
  if (after > 0 && !eo_events_reach(service->events, after)) {
    lock_jobs(service);
    code = eo_queue_list(service->store, &filter, add_to_snapshot, &snapshot, error);
    unlock_jobs(service);
    after = newest;
  } else if (after <= 0)
    after = newest;
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

static bool is_closed(struct eo_service *service, enum eo_job_outcome *outcome)
{
  *outcome = EO_JOB_OUTCOME_CLOSED;
  return atomic_load(&service->stopping);
}

/* Everybody is told of a job that was changed, and whoever changed it gets it. */
static enum eo_code show(struct eo_service *service, int64_t id, struct eo_job_view *job, struct eo_error *error)
{
  enum eo_job_outcome outcome;
  eo_service_publish(service, id);
  return eo_service_job(service, id, true, &outcome, job, error);
}

/* In this order, so that a job is seen waiting before it is seen running. */
static enum eo_code publish_then_wake(struct eo_service *service, int64_t id, struct eo_job_view *job,
                                      struct eo_error *error)
{
  enum eo_code code = show(service, id, job, error);
  eo_service_wake(service);
  return code;
}

static void hash_request(const struct eo_job_order *order, const struct eo_text *design, char hash[EO_HASH_LENGTH + 1])
{
  struct eo_hash this_hash;
  eo_hash_init(&this_hash);
  eo_hash_add_number(&this_hash, "kind", order->kind);
  eo_hash_add_number(&this_hash, "priority", order->priority);
  eo_hash_add_number(&this_hash, "fresh", order->fresh);
  eo_hash_add_text(&this_hash, "design", design->data);
  if (order->spec)
    eo_hash_add_text(&this_hash, "spec", order->spec);
  eo_hash_finish(&this_hash, hash);
}

static enum eo_code add_job(struct eo_service *service, const struct eo_job_order *order, const struct eo_text *design,
                            int64_t *id, enum eo_job_outcome *outcome, struct eo_error *error)
{
  char pair[EO_HASH_LENGTH + 1], request[EO_HASH_LENGTH + 1];
  bool keyed = order->key && *order->key, optimize = order->kind == EO_JOB_OPTIMIZE;
  const char *algorithm = optimize ? eo_optimizer_algorithm_name(order->design->optimization.search.algorithm)
                                   : order->algorithm;
  eo_pairs_key(order->design, pair);
  hash_request(order, design, request);
  const struct eo_queue_entry entry = {.kind = order->kind,
                                       .design = design->data,
                                       .spec = order->spec,
                                       .name = order->name ? order->name : order->design->name,
                                       .algorithm = algorithm ? algorithm : "",
                                       .pair = order->kind == EO_JOB_PREPARE ? pair : NULL,
                                       .key = keyed ? order->key : NULL,
                                       .request = keyed ? request : NULL,
                                       .fresh = order->fresh,
                                       .priority = order->priority};
  pthread_mutex_lock(&service->store_mutex);
  enum eo_code code = eo_queue_add(service->store, &entry, service->settings.limits.queued_jobs, id, outcome, error);
  pthread_mutex_unlock(&service->store_mutex);
  return code;
}

/* Queues; nobody is told yet, nor begins. */
static enum eo_code queue(struct eo_service *service, const struct eo_job_order *order, int64_t *id,
                          enum eo_job_outcome *outcome, struct eo_error *error)
{
  struct eo_text design = {0};
  const struct eo_preparation_settings preparation = eo_service_preparation(service);
  EO_TRY(eo_preparation_admit(&preparation, order->design, error));
  eo_design_write(order->design, &design);
  enum eo_code code = design.failed ? eo_error_memory(error) : add_job(service, order, &design, id, outcome, error);
  eo_text_done(&design);
  if (!code && *outcome == EO_JOB_OUTCOME_FULL)
    atomic_fetch_add(&service->refused, 1);
  return code;
}

enum eo_code eo_service_submit(struct eo_service *service, const struct eo_job_order *order,
                               enum eo_job_outcome *outcome, struct eo_job_view *job, struct eo_error *error)
{
  int64_t id;
  *job = (struct eo_job_view){0};
  if (is_closed(service, outcome))
    return EO_OK;
  enum eo_code code = queue(service, order, &id, outcome, error);
  if (code || (*outcome != EO_JOB_OUTCOME_DONE && *outcome != EO_JOB_OUTCOME_REPEATED))
    return code;
  return publish_then_wake(service, id, job, error);
}

enum eo_code eo_service_cancel(struct eo_service *service, int64_t id, enum eo_job_outcome *outcome,
                               struct eo_job_view *job, struct eo_error *error)
{
  *job = (struct eo_job_view){0};
  pthread_mutex_lock(&service->store_mutex);
  enum eo_code code = eo_queue_cancel(service->store, id, outcome, error);
  pthread_mutex_unlock(&service->store_mutex);
  if (code || *outcome)
    return code;
  pthread_mutex_lock(&service->live_mutex);
  for (int kind = 0; kind < EO_JOB_KINDS; kind++)
    if (service->worker[kind].live.id == id)
      atomic_store(&service->worker[kind].cancelled, true);
  pthread_mutex_unlock(&service->live_mutex);
  return show(service, id, job, error);
}

enum eo_code eo_service_retry(struct eo_service *service, int64_t id, enum eo_job_outcome *outcome,
                              struct eo_job_view *job, struct eo_error *error)
{
  *job = (struct eo_job_view){0};
  if (is_closed(service, outcome))
    return EO_OK;
  pthread_mutex_lock(&service->store_mutex);
  enum eo_code code = eo_queue_retry(service->store, id, service->settings.limits.queued_jobs, outcome, error);
  pthread_mutex_unlock(&service->store_mutex);
  return code || *outcome ? code : publish_then_wake(service, id, job, error);
}

enum eo_code eo_service_clone(struct eo_service *service, int64_t id, const int *priority, enum eo_job_outcome *outcome,
                              struct eo_job_view *job, struct eo_error *error)
{
  int64_t clone;
  *job = (struct eo_job_view){0};
  if (is_closed(service, outcome))
    return EO_OK;
  pthread_mutex_lock(&service->store_mutex);
  enum eo_code code = eo_queue_clone(service->store, id, priority, service->settings.limits.queued_jobs, &clone,
                                     outcome, error);
  pthread_mutex_unlock(&service->store_mutex);
  return code || *outcome ? code : publish_then_wake(service, clone, job, error);
}

enum eo_code eo_service_remove(struct eo_service *service, int64_t id, enum eo_job_outcome *outcome,
                               struct eo_error *error)
{
  pthread_mutex_lock(&service->live_mutex);
  bool live = false;
  for (int kind = 0; kind < EO_JOB_KINDS; kind++)
    live = live || service->worker[kind].live.id == id;
  pthread_mutex_unlock(&service->live_mutex);
  *outcome = EO_JOB_OUTCOME_STATE;
  if (live)
    return EO_OK;
  pthread_mutex_lock(&service->store_mutex);
  enum eo_code code = eo_queue_remove(service->store, id, outcome, error);
  pthread_mutex_unlock(&service->store_mutex);
  return code;
}
