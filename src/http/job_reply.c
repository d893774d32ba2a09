/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/job_reply.h"

#include <stdio.h>

#include "evaluation/scatter_tally.h"
#include "http/answers.h"
#include "http/http_private.h"
#include "http/route.h"

void eo_reply_job_location(struct eo_reply *reply, int64_t id)
{
  snprintf(reply->location, sizeof reply->location, EO_API "/jobs/%lld", (long long)id);
}

void eo_reply_job_outcome(struct eo_reply *reply, enum eo_job_outcome outcome)
{
  switch (outcome) {
  case EO_JOB_OUTCOME_MISSING:
    eo_reply_problem(reply, 404, NULL, "There is no job with this number.");
    break;
  case EO_JOB_OUTCOME_CONFLICT:
    eo_reply_problem(reply, 422, "key-used", "This Idempotency-Key came with another order before.");
    break;
  case EO_JOB_OUTCOME_STATE:
    eo_reply_problem(reply, 409, "state", "The state of the job does not allow that.");
    break;
  case EO_JOB_OUTCOME_FULL:
    eo_reply_problem(reply, 503, "queue-full", "Too many jobs are waiting already.");
    reply->retry_after = 30;
    break;
  case EO_JOB_OUTCOME_CLOSED:
    eo_reply_problem(reply, 503, "stopping", "The server is stopping.");
    reply->retry_after = 5;
    break;
  case EO_JOB_OUTCOME_DONE:
  case EO_JOB_OUTCOME_REPEATED:
    break;
  }
}

/* What was there of a tolerance analysis when it was stopped may be too little. */
static bool is_cut_short(const struct eo_job_view *job)
{
  return job->row.kind == EO_JOB_TOLERANCE && job->row.state == EO_JOB_CANCELLED;
}

void eo_reply_no_result(struct eo_reply *reply, const struct eo_job_view *job)
{
  if (is_cut_short(job))
    eo_reply_problem(
        reply, 409, "state",
        "The tolerance analysis was stopped before %d pairs were there, and fewer say nothing. Retry goes on "
        "from those that are.",
        EO_SCATTER_FEWEST);
  else
    eo_reply_job_outcome(reply, EO_JOB_OUTCOME_STATE);
}

void eo_request_no_result(struct eo_request *request, int64_t id, enum eo_job_outcome outcome)
{
  struct eo_job_view job = {0};
  struct eo_error error;
  enum eo_job_outcome found = EO_JOB_OUTCOME_MISSING;
  if (outcome == EO_JOB_OUTCOME_STATE && !eo_service_job(request->http->service, id, false, &found, &job, &error) &&
      found == EO_JOB_OUTCOME_DONE)
    eo_reply_no_result(&request->reply, &job);
  else
    eo_reply_job_outcome(&request->reply, outcome);
  eo_job_view_done(&job);
}

static bool read_key(struct eo_request *request, const char **key)
{
  *key = eo_request_header(request, "Idempotency-Key");
  if (!*key || eo_field_is_visible(*key, 129))
    return true;
  eo_reply_problem(&request->reply, 400, NULL, "Idempotency-Key takes 1 to 128 visible characters.");
  return false;
}

static const struct eo_outline_row preparing_rows[] = {
    EO_KEY("job", "object?", "that prepares the gear pair", .name = "Job", EO_AT(struct eo_preparing, job)),
};
const struct eo_outline eo_outline_preparing = EO_OUTLINE("Preparing", preparing_rows);

void eo_request_order_job(struct eo_request *request, struct eo_job_order *order, bool ticket)
{
  enum eo_job_outcome outcome = EO_JOB_OUTCOME_DONE;
  struct eo_error error;
  struct eo_job_view job = {0};
  if (!read_key(request, &order->key))
    return;
  if (eo_service_submit(request->http->service, order, &outcome, &job, &error))
    eo_reply_error(&request->reply, "/design", &error);
  else if (outcome != EO_JOB_OUTCOME_DONE && outcome != EO_JOB_OUTCOME_REPEATED)
    eo_reply_job_outcome(&request->reply, outcome);
  else {
    const struct eo_preparing preparing = {eo_job_view_encode(&job)};
    eo_reply_json(&request->reply, 202, ticket ? eo_outline_encode(&eo_outline_preparing, &preparing) : preparing.job);
    eo_reply_job_location(&request->reply, job.row.id);
  }
  eo_job_view_done(&job);
}
