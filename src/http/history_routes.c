/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What was evaluated: by one job, and by all. */
#include "http/job_reply.h"
#include "http/route.h"
#include "http/http_private.h"
#include "study/job_history.h"
#include "study/history_document.h"

static void reply_rows(struct eo_request *request, int64_t id)
{
  enum eo_job_outcome outcome;
  struct eo_error error;
  json_t *page = NULL;
  int after = (int)eo_route_number(request, "cursor"), limit = (int)eo_route_number(request, "limit");
  if (eo_job_history(request->store, id, after, limit, &outcome, &page, &error))
    eo_reply_error(&request->reply, "", &error);
  else if (outcome != EO_JOB_OUTCOME_DONE)
    eo_reply_job_outcome(&request->reply, outcome);
  else
    eo_reply_json(&request->reply, 200, page);
}

static void reply_csv(struct eo_request *request, int64_t id)
{
  enum eo_job_outcome outcome;
  struct eo_error error;
  struct eo_text text = {0};
  if (eo_job_history_csv(request->store, id, &outcome, &text, &error))
    eo_reply_error(&request->reply, "", &error);
  else if (outcome != EO_JOB_OUTCOME_DONE)
    eo_reply_job_outcome(&request->reply, outcome);
  else
    eo_reply_text(&request->reply, 200, "text/csv; charset=utf-8", &text);
  eo_text_done(&text);
}

static void get_of_job(struct eo_request *request)
{
  int64_t id;
  if (!eo_request_id_at(request, 0, &id))
    return;
  if (request->csv)
    reply_csv(request, id);
  else
    reply_rows(request, id);
}

static void get_all(struct eo_request *request)
{
  struct eo_error error;
  json_t *document = NULL;
  if (eo_records_list(request->store, &document, &error))
    eo_reply_error(&request->reply, "", &error);
  else
    eo_reply_json(&request->reply, 200, document);
}

const struct eo_route eo_routes_history[] = {
    {.method = EO_GET,
     .pattern = "/jobs/{id}/history",
     .handle = get_of_job,
     .name = "getJobHistory",
     .gives = "200 JobHistory",
     .csv = true,
     .aside = true,
     .summary = "The true evaluations of an optimization in its order; as CSV all of them.",
     .query = {{"limit", 1, 200, 50, NULL, "most rows"}, {"cursor", 0, 2e9, -1, NULL, "`next` of the page before"}}},
    {.method = EO_GET,
     .pattern = "/history",
     .handle = get_all,
     .name = "getHistory",
     .gives = "200 History",
     .aside = true,
     .summary = "The problems that were worked on with the number of their evaluations, and all jobs: `easeoff history "
                "list --json`."},
    {0}};
