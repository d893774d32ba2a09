/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Jobs of optimizations and studies, and the path each took: which evaluations it asked for, in its order, and what it
   predicted. Adding needs a transaction (eo_store_begin()). */
#ifndef EASEOFF_STORE_JOBS_H
#define EASEOFF_STORE_JOBS_H

#include "store/store.h"

#include <stdbool.h>
#include <stddef.h>

enum eo_job_state {
  EO_JOB_QUEUED,
  EO_JOB_PREPARING,
  EO_JOB_RUNNING,
  EO_JOB_DONE,
  EO_JOB_FAILED,
  EO_JOB_CANCELLED,
  EO_JOB_STATES
};
enum eo_job_kind { EO_JOB_OPTIMIZE, EO_JOB_PREPARE, EO_JOB_STUDY, EO_JOB_TOLERANCE, EO_JOB_REPRODUCE, EO_JOB_KINDS };

struct eo_stored_job {
  int64_t id, problem; /* problem: 0 before it begins, and of a preparation */
  const char *study;   /* hash of the design: equal studies take equal paths */
  const char *space;   /* hash of the variables and their bounds */
  const char *design;  /* JSON, every default resolved */
  const char *spec;    /* JSON: the document of a study, the order of a reproduction; "" of another kind */
  const char *name, *algorithm;
  bool fresh;          /* the algorithm knew no earlier rows */
  int64_t import_upto; /* the last evaluation that was there when it began */
  enum eo_job_state state;
  const char *stopped; /* why it ended */
  int true_evaluations, individuals;
  int64_t best;       /* evaluation, 0: none */
  double best_value;  /* NaN: none */
  const char *result; /* JSON, "" while there is none */
  const char *created, *updated;

  /* what the server's queue knows; see store/queue.h */
  enum eo_job_kind kind;
  const char *pair;               /* of a preparation: hash of what is prepared */
  bool served;                    /* the queue runs it, not a terminal */
  int priority;                   /* -10..10 */
  bool stop;                      /* somebody wants it to end */
  int attempts;                   /* how often it was begun */
  const char *error;              /* JSON, "" without */
  const char *progress;           /* JSON, "" without */
  const char *started, *finished; /* "" without */
};

/* "queued", "preparing", "running", "done", "failed", "cancelled"; "optimize", "prepare", "study", "tolerance",
   "reproduce". find: -1 when it is none. */
const char *eo_store_job_state_name(enum eo_job_state state);
const char *eo_store_job_kind_name(enum eo_job_kind kind);
extern const char *const eo_store_job_states[], *const eo_store_job_kinds[]; /* by number; end with NULL */
int eo_store_job_state_find(const char *name);
int eo_store_job_kind_find(const char *name);

/* Adds a job in the state given; fills job->id and, as it stands now, ->import_upto. */
enum eo_code eo_store_add_job(struct eo_store *store, struct eo_stored_job *job, struct eo_error *error);

/* The newest job of this study, cut short or done, that nobody works on, claimed for this store; job->id, import_upto;
   id 0: none. */
enum eo_code eo_store_resume_job(struct eo_store *store, const char *study, bool fresh, struct eo_stored_job *job,
                                 struct eo_error *error);

/* Begins (or goes on with) the queued job job->id: claimed for this store, running; its problem, study and space are
   set from job and job->import_upto is filled. *resumed: it was begun before as the same study; what it logged as
   another one (of an older model) is dropped. EO_ERROR_INPUT: there is no such job, or another process works on it. */
enum eo_code eo_store_begin_job(struct eo_store *store, struct eo_stored_job *job, bool *resumed,
                                struct eo_error *error);

/* State, stopped, counters and best. */
enum eo_code eo_store_update_job(struct eo_store *store, const struct eo_stored_job *job, struct eo_error *error);

/* Whether somebody asked for the job to end. */
enum eo_code eo_store_job_shall_stop(struct eo_store *store, int64_t job, bool *stop, struct eo_error *error);

/* Keeps the document of a job's result. */
enum eo_code eo_store_keep_result(struct eo_store *store, int64_t job, const char *result, struct eo_error *error);

/* A true evaluation the job asked for; what the job logged before under this ordinal stays, and *reused tells what
   stands there. */
struct eo_stored_candidate {
  int64_t job, evaluation;
  int ordinal, generation, individual;
  bool reused;     /* known before the job asked */
  const double *x; /* [size], unit cube */
  int size;
};
enum eo_code eo_store_log_candidate(struct eo_store *store, struct eo_stored_candidate *candidate,
                                    struct eo_error *error);

struct eo_stored_prediction {
  int64_t job;
  int generation, individual;
  double fitness, credibility;
  const double *x;
  int size;
};
/* Keeps what a model foretold for an individual, x[size] in the unit cube; one that is there already stays as it is. */
enum eo_code eo_store_log_prediction(struct eo_store *store, const struct eo_stored_prediction *prediction,
                                     struct eo_error *error);

/* Jobs in ascending order, of one problem or of all (0); candidates and predictions of a job in its order. Texts are
   borrowed. */
typedef enum eo_code eo_store_visit_job(void *context, const struct eo_stored_job *job, struct eo_error *error);
typedef enum eo_code eo_store_visit_candidate(void *context, const struct eo_stored_candidate *candidate,
                                              struct eo_error *error);
typedef enum eo_code eo_store_visit_prediction(void *context, const struct eo_stored_prediction *prediction,
                                               struct eo_error *error);
enum eo_code eo_store_each_job(struct eo_store *store, int64_t problem, eo_store_visit_job *visit, void *context,
                               struct eo_error *error);
enum eo_code eo_store_each_candidate(struct eo_store *store, int64_t job, eo_store_visit_candidate *visit,
                                     void *context, struct eo_error *error);
/* At most limit candidates whose ordinal is above after (-1: from the first). */
enum eo_code eo_store_page_candidates(struct eo_store *store, int64_t job, int after, int limit,
                                      eo_store_visit_candidate *visit, void *context, struct eo_error *error);
enum eo_code eo_store_each_prediction(struct eo_store *store, int64_t job, eo_store_visit_prediction *visit,
                                      void *context, struct eo_error *error);

/* Removes the predictions of jobs that have ended, a generation at a time, each in a transaction of its own unless one
   is open; *removed: how many. */
enum eo_code eo_store_remove_predictions(struct eo_store *store, int64_t *removed, struct eo_error *error);

#endif
