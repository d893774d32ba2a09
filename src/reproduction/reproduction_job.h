/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A reproduction as a queued job. Its searches are jobs of the history too, so one that was cut short goes on where it
   was: what is evaluated stays. */
#ifndef EASEOFF_REPRODUCTION_REPRODUCTION_JOB_H
#define EASEOFF_REPRODUCTION_REPRODUCTION_JOB_H

#include "format/file_set.h"
#include "reproduction/reproduction.h"
#include "study/job_document.h"

struct eo_reproduction_job {
  struct eo_store *store;             /* of the calling thread, which alone uses it */
  int64_t job;                        /* queued, with its order as spec */
  const struct eo_pair *pair;         /* serves its design */
  int threads;                        /* 0: eo_parallel_cores() */
  const struct eo_progress *progress; /* may be NULL */
};

/* The document is kept with the job. Errors: EO_ERROR_CANCELLED when a stop was asked for, EO_ERROR_INPUT (the job), of
   eo_reproduction_run(). */
enum eo_code eo_reproduction_job_run(const struct eo_reproduction_job *job, struct eo_error *error);

/* The order as it is kept with a job, compact JSON; without memory the text has failed. */
void eo_reproduction_order_write(const struct eo_reproduction_order *order, struct eo_text *text);

/* The files of a job that is done, from its result (JSON): the tables of `easeoff reproduce --csv` and the page,
   reproduction.html. Errors: EO_ERROR_INPUT (no such document), memory. */
enum eo_code eo_reproduction_job_files(const struct eo_text *result, struct eo_file_set *files, struct eo_error *error);

/* Takes over how far it is, for whoever looks at it. */
void eo_reproduction_job_follow(struct eo_job_live *live, const char *what, double fraction);

#endif
