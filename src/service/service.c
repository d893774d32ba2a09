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
                                      .overtakes_running = true, /* single teeth take a while */
                                      .function = eo_service_run_task,
                                      .release = eo_service_release_task,
                                      .context = service};
  EO_TRY(eo_lane_new(&service->analyses, &settings, error));
  settings.threads = 1;
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
  EO_TRY(eo_threads_reserve(4 * service->settings.threads + 2 * service->settings.analysis_threads + OTHER_THREADS,
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

const struct eo_service_limits *eo_service_limits_of(const struct eo_service *service)
{
  return &service->settings.limits;
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
