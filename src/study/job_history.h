/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a job evaluated, row by row in its order. */
#ifndef EASEOFF_STUDY_JOB_HISTORY_H
#define EASEOFF_STUDY_JOB_HISTORY_H

#include <jansson.h>

#include "format/outline.h"
#include "format/text.h"
#include "store/queue.h"

extern const struct eo_outline eo_job_history_outline, eo_outline_job_history_page; /* of an item */

/* A page of true rows: { "items": [ { "ordinal", "generation", "individual", "outcome", "reason", "modification",
   "f1_um", "f2_N", "f3_m_per_s2", "J", "fitness", "reused" } ], "next": "cursor" | null }. after: ordinal of the last
   row that is known already, -1: none. The values are weighed as the job's design says. Outcomes: DONE, MISSING. */
enum eo_code eo_job_history(struct eo_store *store, int64_t job, int after, int limit, enum eo_job_outcome *outcome,
                            json_t **page, struct eo_error *error);

/* All of it as comma-separated values, with a column for every parameter that any row changes. Appends. */
enum eo_code eo_job_history_csv(struct eo_store *store, int64_t job, enum eo_job_outcome *outcome, struct eo_text *text,
                                struct eo_error *error);

#endif
