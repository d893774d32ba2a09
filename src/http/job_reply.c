/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/job_reply.h"

#include <stdio.h>

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
