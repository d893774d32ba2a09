/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What was evaluated: by one job, and by all. */
#include <math.h>

#include "http/job_reply.h"
#include "http/request_body.h"
#include "http/route.h"
#include "http/http_private.h"
#include "study/job_history.h"
#include "study/history_document.h"
#include "study/history_prune.h"

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
    eo_reply_table(request, &text);
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

/* A sentence of the core about a number that is not there is a 404 here. */
static void reply_no_record(struct eo_request *request, const struct eo_error *error)
{
  if (error->code == EO_ERROR_INPUT)
    eo_reply_problem(&request->reply, 404, NULL, "%s", error->text);
  else
    eo_reply_error(&request->reply, "", error);
}

static void get_problem(struct eo_request *request)
{
  struct eo_error error;
  struct eo_text text = {0};
  json_t *rows = NULL;
  int64_t id;
  if (!eo_request_id_at(request, 0, &id))
    return;
  enum eo_code code = eo_records_rows(request->store, id, &rows, &error);
  if (!code && request->csv)
    code = eo_records_rows_csv(rows, &text, &error);
  if (code)
    reply_no_record(request, &error);
  else if (request->csv)
    eo_reply_table(request, &text);
  else
    eo_reply_json(&request->reply, 200, json_incref(rows));
  json_decref(rows);
  eo_text_done(&text);
}

static void get_path(struct eo_request *request)
{
  struct eo_error error;
  struct eo_text text = {0};
  int64_t id;
  if (!eo_request_id_at(request, 0, &id))
    return;
  if (eo_records_path_csv(request->store, id, &text, &error))
    reply_no_record(request, &error);
  else
    eo_reply_table(request, &text);
  eo_text_done(&text);
}

static const struct eo_field prune_fields[] = {
    EO_FLAG(struct eo_prune, predictions, "predictions", 0, "fitness values that searches predicted"),
    EO_FLAG(struct eo_prune, outdated, "outdated", 0, "rows of older versions of the model"),
    EO_FLAG(struct eo_prune, damaged, "damaged", 0, "rows that are not what was written"),
    EO_FLAG(struct eo_prune, unused, "unused", 0, "rows of studies and tolerance analyses that no job has any more"),
    EO_INTEGER_DERIVED(struct eo_prune, problem, "problem", 1, 2000000000, "none", "every row of this problem"),
};
static const struct eo_table prune_table = EO_TABLE("what goes out of the history", struct eo_prune, prune_fields);

static void prune(struct eo_request *request)
{
  struct eo_prune wanted;
  struct eo_pruned pruned;
  struct eo_error error;
  if (!eo_body_read(request, &wanted))
    return;
  enum eo_code code = eo_history_prune(request->store, &wanted, &pruned, &error);
  if (code == EO_ERROR_INPUT) /* a job runs */
    eo_reply_problem(&request->reply, 409, "state", "%s", error.text);
  else if (code)
    eo_reply_error(&request->reply, "", &error);
  else
    eo_reply_json(&request->reply, 200, eo_outline_encode(&eo_pruned_outline, &pruned));
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
     .query = {{"limit", 1, 200, 50, NULL, "most rows"},
               {"cursor", 0, 2e9, -1, NULL, "`next` of the page before"},
               EO_UNITS_OF_CSV}},
    {.method = EO_GET,
     .pattern = "/jobs/{id}/path",
     .handle = get_path,
     .name = "getJobPath",
     .gives = "200 text/csv",
     .aside = true,
     .summary = "The path of a search as CSV, each individual, whether computed, known or predicted: `easeoff history "
                "export --job`."},
    {.method = EO_GET,
     .pattern = "/history/{id}/rows",
     .handle = get_problem,
     .name = "getProblem",
     .gives = "200 ProblemRows",
     .csv = true,
     .query = {EO_UNITS_OF_CSV},
     .aside = true,
     .summary = "Every true evaluation of a problem, modification and values per load case: `easeoff history export`."},
    {.method = EO_GET,
     .pattern = "/history",
     .handle = get_all,
     .name = "getHistory",
     .gives = "200 History",
     .aside = true,
     .summary = "The problems that were worked on with the number of their evaluations, and all jobs: `easeoff history "
                "list --json`."},
    {.method = EO_POST,
     .pattern = "/history/prune",
     .handle = prune,
     .name = "pruneHistory",
     .takes = "PruneOrder",
     .order = &prune_table,
     .gives = "200 Pruned",
     .aside = true,
     .frees = true,
     .rate = EO_RATE_START,
     .summary = "Removes what is no longer wanted of the history: `easeoff history prune`. 409 while a job runs."},
    {0}};
