/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A tolerance analysis as a queued job. Its pairs are rows of the history (store/variant_rows.h), kept as they come: a
   job that was cut short goes on with the pairs that are missing, and one with the same design and scatter takes over
   what another has, whatever number of pairs either asks for. The result is the same bytes in any case. */
#ifndef EASEOFF_STUDY_TOLERANCE_JOB_H
#define EASEOFF_STUDY_TOLERANCE_JOB_H

#include "crew/crew.h"
#include "document/tolerance_document.h"
#include "store/store.h"
#include "study/job_document.h"

struct eo_tolerance_progress {
  int64_t job;
  int pairs, done, known;                 /* asked for; with a row; of them known before the job asked */
  double fraction, seconds, seconds_left; /* NaN: not known yet */
  const char *what;                       /* for people */
};

/* Several times a second, on the thread that runs the job; non-zero asks for a stop. */
typedef int eo_tolerance_watch(void *context, const struct eo_tolerance_progress *progress);

struct eo_tolerance_job {
  struct eo_store *store;         /* of the calling thread, which alone uses it */
  int64_t job;                    /* queued */
  const struct eo_design *design; /* complete, of the job */
  const struct eo_warnings *warnings;
  const struct eo_pair *pair; /* serves the design, on `threads` of this process (0: eo_parallel_cores()); NULL: crew */
  struct eo_crew *crew;       /* evaluates, and prepares for itself */
  int threads;
  eo_tolerance_watch *watch;          /* may be NULL */
  bool (*is_given_up)(void *context); /* whether a stop is for good: what is there is its result; NULL: it never is */
  void *context;
};

struct eo_tolerance_outcome {
  bool resumed, cancelled;
  int pairs, done, known, computed;
  double seconds; /* wall time */
};

/* A stop that was asked for is no error: outcome->cancelled tells. The result is kept with the job, after a stop for
   good that of the pairs that are there, where they are EO_SCATTER_FEWEST or more in full. Errors: EO_ERROR_INPUT (job,
   scatter, limits), of the evaluator, the crew, the history; pairs that were kept stay. */
enum eo_code eo_tolerance_job_run(const struct eo_tolerance_job *job, struct eo_tolerance_outcome *outcome,
                                  struct eo_error *error);

/* The pairs of a job as a table, a line for each that was computed in full. whole: it is done, so that none may be
   missing. Errors: EO_ERROR_INPUT (a pair is missing), memory, of the history. */
enum eo_code eo_tolerance_job_csv(struct eo_store *store, int64_t job, bool whole, const struct eo_design *design,
                                  struct eo_text *text, struct eo_error *error);

/* Takes over what a job reports, for whoever looks at it: true evaluations are pairs that have a row. */
void eo_tolerance_job_follow(struct eo_job_live *live, const struct eo_tolerance_progress *progress);
void eo_tolerance_job_conclude(struct eo_job_live *live, const struct eo_tolerance_outcome *outcome);

#endif
