/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What several groups of endpoints say about jobs. */
#ifndef EASEOFF_HTTP_JOB_REPLY_H
#define EASEOFF_HTTP_JOB_REPLY_H

#include "http/reply.h"
#include "store/queue.h"

/* What stands in the way of a job; nothing with DONE and REPEATED. */
void eo_reply_job_outcome(struct eo_reply *reply, enum eo_job_outcome outcome);

/* Location: the job. */
void eo_reply_job_location(struct eo_reply *reply, int64_t id);

#endif
