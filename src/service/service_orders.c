/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Jobs ordered and changed: each is one row of the queue, told to whoever listens and to the worker. */
#include "service/service_private.h"

#include <stdlib.h>

#include "document/tolerance_document.h"

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

enum eo_code eo_service_admit_pairs(const struct eo_service *service, const struct eo_design *design,
                                    struct eo_error *error)
{
  double most = eo_service_preparation(service).memory;
  struct eo_scatter *scatter = malloc(sizeof *scatter);
  enum eo_code code = scatter ? eo_scatter_of_design(scatter, design, true, NULL, error) : eo_error_memory(error);
  if (!code)
    code = eo_tolerance_check_limits(design, error);
  double memory = code ? 0 : eo_tolerance_memory(design, scatter);
  free(scatter);
  if (code || memory <= most)
    return code;
  return eo_error_set(error, EO_ERROR_INPUT, "/tolerance/pairs",
                      "%d pairs would take about %.0f MB; this server allows %.0f MB. Fewer pairs or load cases take "
                      "less.",
                      design->tolerance.pairs, memory / 1e6, most / 1e6);
}

/* Queues; nobody is told yet, nor begins. */
static enum eo_code queue(struct eo_service *service, const struct eo_job_order *order, int64_t *id,
                          enum eo_job_outcome *outcome, struct eo_error *error)
{
  struct eo_text design = {0};
  const struct eo_preparation_settings preparation = eo_service_preparation(service);
  EO_TRY(eo_preparation_admit(&preparation, order->design, error));
  if (order->kind == EO_JOB_TOLERANCE)
    EO_TRY(eo_service_admit_pairs(service, order->design, error));
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
