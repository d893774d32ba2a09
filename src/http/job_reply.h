/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What several groups of endpoints say about jobs. */
#ifndef EASEOFF_HTTP_JOB_REPLY_H
#define EASEOFF_HTTP_JOB_REPLY_H

#include "http/reply.h"
#include "http/request.h"
#include "service/service.h"

/* What stands in the way of a job; nothing with DONE and REPEATED. */
void eo_reply_job_outcome(struct eo_reply *reply, enum eo_job_outcome outcome);

/* Of a job that has no result, 409: why. */
void eo_reply_no_result(struct eo_reply *reply, const struct eo_job_view *job);
/* Of a job whose result was asked for with another outcome than DONE. */
void eo_request_no_result(struct eo_request *request, int64_t id, enum eo_job_outcome outcome);

/* Orders a job under the Idempotency-Key of the request and replies with it, 202, or why it is not taken. ticket: as
   { "job": ... }, where another answer would be the document itself. */
void eo_request_order_job(struct eo_request *request, struct eo_job_order *order, bool ticket);

/* Location: the job. */
void eo_reply_job_location(struct eo_reply *reply, int64_t id);

#endif
