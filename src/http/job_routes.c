/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Jobs: ordering them, looking at them, stopping them. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "http/answers.h"
#include "format/list_page.h"
#include "format/object.h"
#include "document/search_space.h"
#include "document/study_result.h"
#include "http/request_body.h"
#include "http/job_reply.h"
#include "http/route.h"
#include "http/http_private.h"

/* The job as the reply, or why there is none. Takes the job over. */
static void reply_job(struct eo_request *request, unsigned status, enum eo_code code, enum eo_job_outcome outcome,
                      struct eo_job_view *job, const struct eo_error *error)
{
  if (code)
    eo_reply_error(&request->reply, "", error);
  else if (outcome != EO_JOB_OUTCOME_DONE && outcome != EO_JOB_OUTCOME_REPEATED)
    eo_reply_job_outcome(&request->reply, outcome);
  else {
    eo_reply_json(&request->reply, status, eo_job_view_encode(job));
    if (status == 202)
      eo_reply_job_location(&request->reply, job->row.id);
  }
  eo_job_view_done(job);
}

struct order {
  int kind; /* enum eo_job_kind */
  const json_t *design;
  int priority;
  bool fresh;
};
static const struct eo_field order_fields[] = {
    EO_CHOICE(struct order, kind, "kind", eo_store_job_kinds, EO_JOB_OPTIMIZE, "what is to be done"),
    EO_DOCUMENT(struct order, design, "design", "Design", EO_FIELD_REQUIRED, "what it is done with"),
    EO_INTEGER(struct order, priority, "priority", -EO_MOST_PRIORITY, EO_MOST_PRIORITY, 0,
               "higher ones come first, then the older"),
    EO_FLAG(struct order, fresh, "fresh", 0, "the algorithm shall know no earlier evaluations"),
};
static const struct eo_table order_table = EO_TABLE("an order of a job", struct order, order_fields);

/* Of a job that is ordered once more. */
struct change {
  double priority; /* NaN: the same */
};
static const struct eo_field change_fields[] = {
    {.key = "priority",
     .kind = EO_FIELD_NUMBER,
     .flags = EO_FIELD_NULLABLE | EO_FIELD_WHOLE,
     .offset = offsetof(struct change, priority),
     .low = -EO_MOST_PRIORITY,
     .high = EO_MOST_PRIORITY,
     .fallback = NAN,
     .derived = "that of the other job",
     .help = "higher ones come first, then the older"},
};
static const struct eo_table change_table = EO_TABLE("a change of a job", struct change, change_fields);

static void add(struct eo_request *request)
{
  struct order order;
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_study_space space;
  struct eo_error error;
  if (!eo_body_read(request, &order) || !eo_request_design(request, order.design, "/design", &design, &geometry, NULL))
    return;
  if (order.kind == EO_JOB_STUDY)
    eo_reply_problem(&request->reply, 400, NULL, "A study says what it varies: POST /studies takes it.");
  else if (order.kind == EO_JOB_REPRODUCE)
    eo_reply_problem(&request->reply, 400, NULL,
                     "A reproduction takes the paper's pair, no other design: POST /reproductions orders it.");
  else if (order.kind == EO_JOB_OPTIMIZE && eo_study_space_init(&space, &design, &geometry, &error))
    eo_reply_error(&request->reply, "/design", &error);
  else {
    struct eo_job_order wanted = {
        .kind = (enum eo_job_kind)order.kind, .design = &design, .priority = order.priority, .fresh = order.fresh};
    eo_request_order_job(request, &wanted, false);
  }
}

static void repeat(struct eo_request *request)
{
  struct change change;
  enum eo_job_outcome outcome = EO_JOB_OUTCOME_DONE;
  struct eo_error error;
  int64_t id;
  struct eo_job_view job = {0};
  if (!eo_request_id_at(request, 0, &id) || !eo_body_read(request, &change))
    return;
  int priority = isnan(change.priority) ? 0 : (int)change.priority;
  enum eo_code code = eo_service_clone(request->http->service, id, isnan(change.priority) ? NULL : &priority, &outcome,
                                       &job, &error);
  reply_job(request, 202, code, outcome, &job, &error);
}

/* -1: any. */
static int find(const char *name, int (*find_named)(const char *name))
{
  return name ? find_named(name) : -1;
}

static const struct eo_outline_row jobs_rows[] = {EO_PAGE_ROWS("newest first", .name = "Job")};
const struct eo_outline eo_outline_jobs = EO_OUTLINE("Jobs", jobs_rows);

static json_t *encode_page(const struct eo_job_page *page)
{
  struct eo_object items = eo_list_open();
  for (int i = 0; i < page->count; i++)
    eo_list_add(&items, eo_job_view_encode(&page->job[i]));
  return eo_page_encode(&eo_outline_jobs, eo_object_close(&items), page->more,
                        page->more ? page->job[page->count - 1].row.id : 0);
}

static void list(struct eo_request *request)
{
  struct eo_error error;
  struct eo_job_page page;
  if (eo_service_jobs(request->http->service, find(eo_request_query(request, "state"), eo_store_job_state_find),
                      find(eo_request_query(request, "kind"), eo_store_job_kind_find),
                      (int64_t)eo_route_number(request, "cursor"), (int)eo_route_number(request, "limit"), &page,
                      &error)) {
    eo_reply_error(&request->reply, "", &error);
    return;
  }
  eo_reply_json(&request->reply, 200, encode_page(&page));
  eo_job_page_done(&page);
}

static void get_one(struct eo_request *request)
{
  enum eo_job_outcome outcome = EO_JOB_OUTCOME_DONE;
  struct eo_error error;
  struct eo_job_view job = {0};
  int64_t id;
  if (!eo_request_id_at(request, 0, &id))
    return;
  enum eo_code code = eo_service_job(request->http->service, id, true, &outcome, &job, &error);
  reply_job(request, 200, code, outcome, &job, &error);
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
    eo_reply_error(&request->reply, "", &error);
  else if (outcome != EO_JOB_OUTCOME_DONE)
    eo_request_no_result(request, id, outcome);
  else
    eo_reply_text(&request->reply, 200, "application/json", &text);
  eo_text_done(&text);
}

/* The front of a result; false: the reply says what is in the way. */
static bool read_front(struct eo_request *request, const struct eo_text *result, struct eo_text *front)
{
  json_t *document = json_loadb(result->data, result->size, 0, NULL);
  const bool there = document && eo_study_front_csv(document, front);
  if (!document)
    eo_reply_no_memory(&request->reply);
  else if (!there)
    eo_reply_problem(&request->reply, 404, NULL, "This job has no Pareto front: the algorithm nsga2 finds one.");
  json_decref(document);
  return there;
}

static void get_front(struct eo_request *request)
{
  enum eo_job_outcome outcome = EO_JOB_OUTCOME_DONE;
  struct eo_error error;
  struct eo_text result = {0}, front = {0};
  int64_t id;
  if (!eo_request_id_at(request, 0, &id))
    return;
  if (eo_service_result(request->http->service, id, &outcome, &result, &error))
    eo_reply_error(&request->reply, "", &error);
  else if (outcome != EO_JOB_OUTCOME_DONE)
    eo_request_no_result(request, id, outcome);
  else if (read_front(request, &result, &front))
    eo_reply_table(request, &front);
  eo_text_done(&result);
  eo_text_done(&front);
}

static void get_generations(struct eo_request *request)
{
  enum eo_job_outcome outcome = EO_JOB_OUTCOME_DONE;
  struct eo_error error;
  struct eo_job_convergence convergence;
  int64_t id;
  if (!eo_request_id_at(request, 0, &id))
    return;
  if (eo_service_convergence(request->http->service, id, &outcome, &convergence, &error))
    eo_reply_error(&request->reply, "", &error);
  else if (outcome != EO_JOB_OUTCOME_DONE)
    eo_reply_job_outcome(&request->reply, outcome);
  else
    eo_reply_json(&request->reply, 200, eo_job_convergence_encode(&convergence));
  eo_job_convergence_done(&convergence);
}

typedef enum eo_code change_function(struct eo_service *, int64_t, enum eo_job_outcome *, struct eo_job_view *,
                                     struct eo_error *);

static void change(struct eo_request *request, change_function *function)
{
  enum eo_job_outcome outcome = EO_JOB_OUTCOME_DONE;
  struct eo_error error;
  struct eo_job_view job = {0};
  int64_t id;
  if (!eo_request_id_at(request, 0, &id))
    return;
  enum eo_code code = function(request->http->service, id, &outcome, &job, &error);
  reply_job(request, 202, code, outcome, &job, &error);
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
    eo_reply_error(&request->reply, "", &error);
  else if (outcome != EO_JOB_OUTCOME_DONE)
    eo_reply_job_outcome(&request->reply, outcome);
  else
    eo_reply_empty(&request->reply, 204);
}

const struct eo_route eo_routes_jobs[] = {
    {.method = EO_POST,
     .pattern = "/jobs",
     .handle = add,
     .name = "addJob",
     .summary = "Orders an optimization, a tolerance analysis (the design's block `tolerance`), or the "
                "preparation of a gear pair.",
     .takes = "JobOrder",
     .order = &order_table,
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
               {"kind", 0, 0, 0, "optimize|prepare|study|tolerance", "only these"}}},
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
     .summary = "What a job found: the document that `easeoff optimize`, `tolerance` or `reproduce` prints with "
                "--json. 409 while "
                "it is not finished.",
     .gives = "200 OptimizationResult|Tolerance|Reproduction",
     .aside = true},
    {.method = EO_GET,
     .pattern = "/jobs/{id}/front",
     .handle = get_front,
     .name = "getJobFront",
     .gives = "200 text/csv",
     .aside = true,
     .query = {EO_UNITS_QUERY},
     .summary = "The Pareto front that a search by nsga2 found as CSV, a line for each point: `easeoff optimize "
                "--front`. 409 while it is not finished."},
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
     .frees = true,
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
     .order = &change_table,
     .takes_nothing = true,
     .gives = "202 Job",
     .rate = EO_RATE_START},
    {0}};
