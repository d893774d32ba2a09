/* Jobs: ordering them, looking at them, stopping them. */
#include <stdio.h>
#include <string.h>

#include "http/job_reply.h"
#include "http/route.h"
#include "http/server.h"

void eo_reply_job_location(struct eo_request *request, int64_t id)
{
  snprintf(request->reply.location, sizeof request->reply.location, EO_API "/jobs/%lld", (long long)id);
}

void eo_reply_job_outcome(struct eo_request *request, enum eo_job_outcome outcome)
{
  switch (outcome) {
  case EO_JOB_OUTCOME_MISSING:
    eo_reply_problem(request, 404, NULL, "There is no job with this number.");
    break;
  case EO_JOB_OUTCOME_CONFLICT:
    eo_reply_problem(request, 422, "key-used", "This Idempotency-Key came with another order before.");
    break;
  case EO_JOB_OUTCOME_STATE:
    eo_reply_problem(request, 409, "state", "The state of the job does not allow that.");
    break;
  case EO_JOB_OUTCOME_FULL:
    eo_reply_problem(request, 503, "queue-full", "Too many jobs are waiting already.");
    request->reply.retry_after = 30;
    break;
  case EO_JOB_OUTCOME_CLOSED:
    eo_reply_problem(request, 503, "stopping", "The server is stopping.");
    request->reply.retry_after = 5;
    break;
  case EO_JOB_OUTCOME_DONE:
  case EO_JOB_OUTCOME_REPEATED:
    break;
  }
}

/* The job as the reply, or why there is none. Takes the job over. */
static void reply_job(struct eo_request *request, unsigned status, enum eo_code code, enum eo_job_outcome outcome,
                      json_t *job, const struct eo_error *error)
{
  if (code)
    eo_reply_error(request, "", error);
  else if (outcome != EO_JOB_OUTCOME_DONE && outcome != EO_JOB_OUTCOME_REPEATED)
    eo_reply_job_outcome(request, outcome);
  else {
    int64_t id = json_integer_value(json_object_get(job, "id"));
    eo_reply_json(request, status, job);
    if (status == 202)
      eo_reply_job_location(request, id);
    return;
  }
  json_decref(job);
}

/* ---- ordering ---- */

struct order {
  enum eo_job_kind kind;
  int priority;
  bool fresh, has_priority;
};

static const char *const kinds[EO_JOB_KINDS] = {"optimize", "prepare"};

static bool read_kind(const json_t *value, struct order *order)
{
  for (int i = 0; i < EO_JOB_KINDS; i++)
    if (json_is_string(value) && strcmp(json_string_value(value), kinds[i]) == 0) {
      order->kind = (enum eo_job_kind)i;
      return true;
    }
  return false;
}

static void read_member(const char *key, const json_t *value, bool design, struct order *order,
                        struct eo_faults *faults)
{
  struct eo_path path = {.key = key};
  if (design && strcmp(key, "kind") == 0) {
    if (!read_kind(value, order))
      eo_faults_at(faults, &path, "The kind is one of optimize, prepare.");
  } else if (strcmp(key, "priority") == 0) {
    if (!json_is_integer(value) || json_integer_value(value) < -10 || json_integer_value(value) > 10)
      eo_faults_at(faults, &path, "The priority is a whole number from -10 to 10.");
    else
      order->priority = (int)json_integer_value(value);
    order->has_priority = true;
  } else if (design && strcmp(key, "fresh") == 0) {
    if (!json_is_boolean(value))
      eo_faults_at(faults, &path, "fresh is true or false.");
    order->fresh = json_is_true(value);
  } else if (!(design && strcmp(key, "design") == 0))
    eo_faults_at(faults, &path, "There is no such key here.");
}

/* design: the body brings one. False: the reply says what is wrong. */
static bool read_order(struct eo_request *request, const json_t *body, bool design, struct order *order)
{
  struct eo_faults faults;
  const char *key;
  json_t *value;
  faults.count = 0;
  *order = (struct order){.kind = EO_JOB_OPTIMIZE};
  json_object_foreach((json_t *)body, key, value) read_member(key, value, design, order, &faults);
  if (design && !json_is_object(json_object_get(body, "design")))
    eo_faults_add(&faults, "/design", "A design is needed.");
  if (faults.count)
    eo_reply_faults(request, "", &faults);
  return !faults.count;
}

static bool read_key(struct eo_request *request, const char **key)
{
  *key = eo_request_header(request, "Idempotency-Key");
  if (!*key || eo_field_is_visible(*key, 129))
    return true;
  eo_reply_problem(request, 400, NULL, "Idempotency-Key takes 1 to 128 visible characters.");
  return false;
}

static void submit(struct eo_request *request, const struct order *order, const struct eo_design *design)
{
  struct eo_job_order wanted = {
      .kind = order->kind, .design = design, .priority = order->priority, .fresh = order->fresh};
  enum eo_job_outcome outcome = EO_JOB_OUTCOME_DONE;
  struct eo_error error;
  json_t *job = NULL;
  if (!read_key(request, &wanted.key))
    return;
  enum eo_code code = eo_service_submit(request->http->service, &wanted, &outcome, &job, &error);
  reply_job(request, 202, code, outcome, job, &error);
}

static void add(struct eo_request *request)
{
  struct order order;
  struct eo_design design;
  struct eo_geometry geometry;
  json_t *body = eo_request_json(request);
  if (body && read_order(request, body, true, &order) &&
      eo_request_design(request, json_object_get(body, "design"), "/design", &design, &geometry, NULL))
    submit(request, &order, &design);
  json_decref(body);
}

static void repeat(struct eo_request *request)
{
  struct order order = {0};
  enum eo_job_outcome outcome = EO_JOB_OUTCOME_DONE;
  struct eo_error error;
  int64_t id;
  json_t *job = NULL, *body = NULL;
  if (!eo_request_id_at(request, 0, &id))
    return;
  if (request->body.size && !(body = eo_request_json(request)))
    return;
  if (!body || read_order(request, body, false, &order)) {
    enum eo_code code = eo_service_clone(request->http->service, id, order.has_priority ? &order.priority : NULL,
                                         &outcome, &job, &error);
    reply_job(request, 202, code, outcome, job, &error);
  }
  json_decref(body);
}

/* ---- looking ---- */

/* -1: any. */
static int state_of(const char *name)
{
  for (int i = 0; name && i < EO_JOB_STATES; i++)
    if (strcmp(name, eo_store_job_state_name((enum eo_job_state)i)) == 0)
      return i;
  return -1;
}

static int kind_of(const char *name)
{
  for (int i = 0; name && i < EO_JOB_KINDS; i++)
    if (strcmp(name, kinds[i]) == 0)
      return i;
  return -1;
}

static void list(struct eo_request *request)
{
  struct eo_error error;
  json_t *page = NULL;
  if (eo_service_jobs(request->http->service, state_of(eo_request_query(request, "state")),
                      kind_of(eo_request_query(request, "kind")), (int64_t)eo_request_number(request, "cursor"),
                      (int)eo_request_number(request, "limit"), &page, &error))
    eo_reply_error(request, "", &error);
  else
    eo_reply_json(request, 200, page);
}

static void get_one(struct eo_request *request)
{
  enum eo_job_outcome outcome = EO_JOB_OUTCOME_DONE;
  struct eo_error error;
  json_t *job = NULL;
  int64_t id;
  if (!eo_request_id_at(request, 0, &id))
    return;
  enum eo_code code = eo_service_job(request->http->service, id, true, &outcome, &job, &error);
  reply_job(request, 200, code, outcome, job, &error);
}

static void get_result(struct eo_request *request)
{
  enum eo_job_outcome outcome = EO_JOB_OUTCOME_DONE;
  struct eo_error error;
  struct eo_text text = {0};
  int64_t id;
  if (!eo_request_id_at(request, 0, &id))
    return;
  if (eo_service_result(request->http->service, id, &outcome, &text, &error))
    eo_reply_error(request, "", &error);
  else if (outcome != EO_JOB_OUTCOME_DONE)
    eo_reply_job_outcome(request, outcome);
  else
    eo_reply_text(request, 200, "application/json", &text);
  eo_text_done(&text);
}

static void get_generations(struct eo_request *request)
{
  enum eo_job_outcome outcome = EO_JOB_OUTCOME_DONE;
  struct eo_error error;
  json_t *columns = NULL;
  int64_t id;
  if (!eo_request_id_at(request, 0, &id))
    return;
  enum eo_code code = eo_service_generations(request->http->service, id, &outcome, &columns, &error);
  reply_job(request, 200, code, outcome, columns, &error);
}

/* ---- changing ---- */

typedef enum eo_code change_function(struct eo_service *, int64_t, enum eo_job_outcome *, json_t **, struct eo_error *);

static void change(struct eo_request *request, change_function *function)
{
  enum eo_job_outcome outcome = EO_JOB_OUTCOME_DONE;
  struct eo_error error;
  json_t *job = NULL;
  int64_t id;
  if (!eo_request_id_at(request, 0, &id))
    return;
  enum eo_code code = function(request->http->service, id, &outcome, &job, &error);
  reply_job(request, 202, code, outcome, job, &error);
}

static void cancel(struct eo_request *request)
{
  change(request, eo_service_cancel);
}

static void retry(struct eo_request *request)
{
  change(request, eo_service_retry);
}

static void take_out(struct eo_request *request)
{
  enum eo_job_outcome outcome = EO_JOB_OUTCOME_DONE;
  struct eo_error error;
  int64_t id;
  if (!eo_request_id_at(request, 0, &id))
    return;
  if (eo_service_remove(request->http->service, id, &outcome, &error))
    eo_reply_error(request, "", &error);
  else if (outcome != EO_JOB_OUTCOME_DONE)
    eo_reply_job_outcome(request, outcome);
  else
    eo_reply_empty(request, 204);
}

const struct eo_route eo_routes_jobs[] = {
    {.method = EO_POST,
     .pattern = "/jobs",
     .handle = add,
     .name = "addJob",
     .summary = "Orders an optimization, or the preparation of a gear pair.",
     .takes = "JobOrder",
     .gives = "202 Job",
     .headers = "Idempotency-Key",
     .rate = EO_RATE_START},
    {.method = EO_GET,
     .pattern = "/jobs",
     .handle = list,
     .name = "listJobs",
     .summary = "Jobs, newest first.",
     .gives = "200 Jobs",
     .query = {{"limit", 1, 200, 50, NULL, "most items"},
               {"cursor", 1, 9e15, 0, NULL, "`next` of the page before"},
               {"state", 0, 0, 0, "queued|preparing|running|done|failed|cancelled", "only these"},
               {"kind", 0, 0, 0, "optimize|prepare", "only these"}}},
    {.method = EO_GET,
     .pattern = "/jobs/{id}",
     .handle = get_one,
     .name = "getJob",
     .summary = "A job with its design.",
     .gives = "200 Job"},
    {.method = EO_DELETE,
     .pattern = "/jobs/{id}",
     .handle = take_out,
     .name = "removeJob",
     .summary = "Removes a job that has ended.",
     .gives = "204 -"},
    {.method = EO_GET,
     .pattern = "/jobs/{id}/result",
     .handle = get_result,
     .name = "getJobResult",
     .summary = "What an optimization found: the document of `easeoff optimize --json`. 409 while it is not finished.",
     .gives = "200 OptimizationResult",
     .aside = true},
    {.method = EO_GET,
     .pattern = "/jobs/{id}/generations",
     .handle = get_generations,
     .name = "getJobGenerations",
     .summary = "The convergence of an optimization as columns, also while it runs.",
     .gives = "200 Generations",
     .aside = true},
    {.method = EO_POST,
     .pattern = "/jobs/{id}/cancel",
     .handle = cancel,
     .name = "cancelJob",
     .summary = "Stops a job; one that runs ends within an evaluation and keeps what it found.",
     .gives = "202 Job",
     .rate = EO_RATE_START},
    {.method = EO_POST,
     .pattern = "/jobs/{id}/retry",
     .handle = retry,
     .name = "retryJob",
     .summary = "Queues a failed or cancelled job again.",
     .gives = "202 Job",
     .rate = EO_RATE_START},
    {.method = EO_POST,
     .pattern = "/jobs/{id}/clone",
     .handle = repeat,
     .name = "cloneJob",
     .summary = "Orders the same once more.",
     .takes = "JobChange",
     .takes_nothing = true,
     .gives = "202 Job",
     .rate = EO_RATE_START},
    {0}};
