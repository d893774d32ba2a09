/* A job as a document: what the table of jobs says, and what is known of one that is being worked on. */
#ifndef EASEOFF_SERVICE_JOB_DOCUMENT_H
#define EASEOFF_SERVICE_JOB_DOCUMENT_H

#include <jansson.h>

#include "format/outline.h"
#include "study/study.h"
#include "store/jobs.h"

/* A job that is being worked on. All zero: nothing is. */
struct eo_job_live {
  int64_t id;
  enum eo_job_state state;
  double fraction; /* 0..1 of the preparation, then of the study */
  char what[80];   /* for people */
  bool study;      /* what follows is known */
  int generation, true_evaluations, predicted, reused, individuals;
  double seconds, seconds_left; /* NaN: not known */
  int64_t best_evaluation;
  json_t *best, *unmodified; /* owned */
  int generations, capacity;
  struct eo_job_generation {
    double best;
    int true_count, predicted, individuals;
  } * history; /* [generations]; owned */
};

void eo_job_live_done(struct eo_job_live *live);

/* Takes over what a study reports. */
void eo_job_live_follow(struct eo_job_live *live, const struct eo_study_report *report);

/* ... and what it gave in the end. */
void eo_job_live_conclude(struct eo_job_live *live, const struct eo_study_result *result);

/* { "progress", "best", "unmodified" }: what is kept with the job. NULL without memory. */
json_t *eo_job_live_encode(const struct eo_job_live *live);

extern const struct eo_outline eo_job_outline, eo_job_generations_outline;

/* { "detail", "pointer" }: what is kept with a job that failed. NULL without memory. */
json_t *eo_job_error_encode(const struct eo_error *error);

/* The whole document, see eo_service_job(). live: of this job, or NULL. NULL without memory. */
json_t *eo_job_encode(const struct eo_stored_job *job, const struct eo_job_live *live, bool with_design);

/* The columns of eo_service_generations(), live or from a result document. NULL without memory. */
json_t *eo_job_live_generations(const struct eo_job_live *live);
json_t *eo_job_result_generations(const json_t *result);

#endif
