/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What stands behind the server: the queue of jobs and the threads that work it off, prepared gear pairs, what-if
   analyses, events.

   Threads. One optimizes, one works off studies and one tolerance analyses: jobs of a kind run one after the other,
   each on all cores at a low priority (or on the machines of a launcher, service/launcher.h). One prepares gear pairs,
   so that a new pair need not wait for an optimization. Small lanes of their own answer analyses, sweeps, and work on
   measurements; they come before jobs wherever they meet. Every function below may be called from any thread at any
   time between new and free, and none of them computes: they look something up, write a row, answer.

   The queue stands in the data folder's database. A job is found again after whatever ended the process: what was
   preparing or running is queued again when a service starts, and an optimization goes through its history first, so
   nothing is evaluated twice. One service works on a data folder at a time (a byte of easeoff.lock says so); the
   terminal's commands may work beside it.

   Callbacks run on the service's threads and must be short. One that is given an answer may call everything here but
   eo_service_free(); a listener to events, nothing. */
#ifndef EASEOFF_SERVICE_SERVICE_H
#define EASEOFF_SERVICE_SERVICE_H

#include "document/result.h"
#include "document/sweep_document.h"
#include "evaluation/analysis.h"
#include "service/events.h"
#include "service/service_limits.h"
#include "store/queue.h"
#include "study/job_document.h"

struct eo_service;

/* Hears what happens to jobs, for a log: what is "begun" or a state, detail an error or "". Called from the workers'
   threads; it must not call the service. */
typedef void eo_service_note(void *context, int64_t job, const char *kind, const char *what, const char *detail);

struct eo_service_settings {
  const char *data;     /* data folder: the database */
  const char *cache;    /* flexibility cache; NULL: keep none on disk */
  const char *program;  /* easeoff, which prepares gear pairs in a process of its own (service/preparation.h); NULL, or
                           no  cache: they are prepared in this one, which nobody can end then */
  const char *launcher; /* words of a command that runs all jobs but preparations (service/launcher.h); NULL: here */
  const char *worker;   /* path of easeoff on the machines of the launcher; NULL: that of this process */
  int threads;          /* of a job or a sweep; 0: eo_parallel_cores() */
  int analysis_threads; /* 0: 2 */
  struct eo_service_limits limits; /* all 0: the defaults of the table */
};

/* Opens the data folder, queues again what an earlier process left, starts the threads. Errors: EO_ERROR_FILE (folder,
   database; another service works on it), EO_ERROR_MEMORY. Strings are copied. */
enum eo_code eo_service_new(struct eo_service **service, const struct eo_service_settings *settings,
                            struct eo_error *error);

/* What it allows; as long as the service is there. */
const struct eo_service_limits *eo_service_limits_of(const struct eo_service *service);

/* Begins to stop: running jobs are parked within an evaluation (they go on when a service starts again), every request
   that waits is answered with EO_ANSWER_STOPPED, new ones are refused with EO_ADMISSION_CLOSED. Returns at once;
   calling it again is fine. */
void eo_service_stop(struct eo_service *service);

/* Stops, waits for the threads, closes the database. NULL is fine. No callback comes after it. */
void eo_service_free(struct eo_service *service);

/* Who hears of jobs from now on; NULL: nobody. Once it returns the one before is not called any more. */
void eo_service_tell(struct eo_service *service, eo_service_note *note, void *context);

/* Outcomes: enum eo_job_outcome of store/queue.h. */
struct eo_job_order {
  enum eo_job_kind kind;
  const struct eo_design *design; /* complete (eo_design_complete()) */
  int priority;                   /* -10..10; higher ones first, then the older */
  bool fresh;                     /* see struct eo_study_plan */
  const char *spec;               /* of a study or a reproduction: its document, checked; design is its base */
  const char *name, *algorithm;   /* of these; else NULL: the design's */
  const char *key;                /* idempotency key, NULL or "": none; kept as long as the job */
};

/* Queues a job; *job is the new job (or that of then) as it is now, to be released by the caller; empty with any other
   outcome. A pair that waits for its preparation or is in it is prepared once: that job is the answer, as DONE. */
enum eo_code eo_service_submit(struct eo_service *service, const struct eo_job_order *order,
                               enum eo_job_outcome *outcome, struct eo_job_view *job, struct eo_error *error);

/* A job as it is now, to be released by the caller; with its design or without. Outcomes: DONE, MISSING. */
enum eo_code eo_service_job(struct eo_service *service, int64_t id, bool with_design, enum eo_job_outcome *outcome,
                            struct eo_job_view *job, struct eo_error *error);

/* A page of jobs, newest first. state: -1 or one; kind: -1 or one; before: 0 or the number of the last job of the page
   before; limit: 1... */
struct eo_job_page {
  int count;
  bool more;               /* older ones follow */
  struct eo_job_view *job; /* [count]; owned */
};
enum eo_code eo_service_jobs(struct eo_service *service, int state, int kind, int64_t before, int limit,
                             struct eo_job_page *page, struct eo_error *error);
void eo_job_page_done(struct eo_job_page *page);

/* The result document of a finished optimization or tolerance analysis as compact JSON, appended to text. Outcomes:
   DONE, MISSING, STATE (not finished, or of a kind that has none). */
enum eo_code eo_service_result(struct eo_service *service, int64_t id, enum eo_job_outcome *outcome,
                               struct eo_text *text, struct eo_error *error);

/* Cancel: waiting, preparing and running jobs; one that runs ends within an evaluation (its state says so later) and
   keeps what it found. Retry: failed and cancelled ones are queued again under their number, an optimization goes on
   where it stopped. Clone: a new job of the same kind and design, queued; priority NULL: the same. Remove: jobs that
   have ended. Each gives the job (not remove). Outcomes: DONE, MISSING, STATE; retry and clone also FULL,
   CLOSED. */
enum eo_code eo_service_cancel(struct eo_service *service, int64_t id, enum eo_job_outcome *outcome,
                               struct eo_job_view *job, struct eo_error *error);
enum eo_code eo_service_retry(struct eo_service *service, int64_t id, enum eo_job_outcome *outcome,
                              struct eo_job_view *job, struct eo_error *error);
enum eo_code eo_service_clone(struct eo_service *service, int64_t id, const int *priority, enum eo_job_outcome *outcome,
                              struct eo_job_view *job, struct eo_error *error);
enum eo_code eo_service_remove(struct eo_service *service, int64_t id, enum eo_job_outcome *outcome,
                               struct eo_error *error);

/* The convergence of an optimization, live too (without means then). Outcomes: DONE, MISSING. */
enum eo_code eo_service_convergence(struct eo_service *service, int64_t id, enum eo_job_outcome *outcome,
                                    struct eo_job_convergence *convergence, struct eo_error *error);

/* Calls the listener for every event from now on, of one job or of all (0), one at a time and in the order of their
   numbers, beginning before this returns with those after the number `after`. Where there is no such number (0) a job's
   listener first hears its state, of all jobs nothing; where not all are kept since then (the last 1024 are), the state
   of the job or of all jobs that have not ended. These states go under the newest number. The listener is called with a
   lock of the service held: never hold a lock that the listener takes while calling subscribe or unsubscribe. After
   unsubscribe returns the listener is not called any more. */
enum eo_code eo_service_subscribe(struct eo_service *service, int64_t job, int64_t after, eo_service_listener *listener,
                                  void *context, int64_t *subscription, struct eo_error *error);
void eo_service_unsubscribe(struct eo_service *service, int64_t subscription);

enum eo_admission {
  EO_ADMISSION_ACCEPTED,  /* the answer comes through the callback, exactly once, from another thread, maybe before this
                             returns */
  EO_ADMISSION_PREPARING, /* the pair is not prepared and the request does not wait: *job is preparing it */
  EO_ADMISSION_FULL,      /* too many wait */
  EO_ADMISSION_CLOSED,    /* the service is stopping */
};

enum eo_answer_kind {
  EO_ANSWER_DONE,      /* text */
  EO_ANSWER_OVERTAKEN, /* a newer request of the same token came before this one began (a sweep: before it ended) */
  EO_ANSWER_FAILED,    /* error */
  EO_ANSWER_PREPARING, /* the wait ended before the preparation did: job */
  EO_ANSWER_STOPPED,   /* the service is stopping */
};

struct eo_answer {
  enum eo_answer_kind kind;
  struct eo_text text; /* the callback may take it over by emptying it: *text = (struct eo_text){0} */
  struct eo_error error;
  int64_t job;
  double waited_ms, computed_ms, written_ms; /* in the queue; the model; document and text */
};
typedef void eo_answer_function(void *context, struct eo_answer *answer);

enum { EO_TOKEN_LENGTH = 64 };
enum eo_answer_format { EO_ANSWER_JSON, EO_ANSWER_CSV };

struct eo_question {
  const struct eo_design *design;     /* complete; copied, as everything here */
  const struct eo_warnings *warnings; /* of reading it; NULL: none */
  enum eo_answer_format format;       /* CSV: the summary table; of a sweep, one line per point */
  const char *token;                  /* NULL or "": no newer request overtakes this one */
  double wait;                        /* s to wait for the preparation of the pair; 0: none */
  eo_answer_function *answer;
  void *context; /* borrowed */
};

/* want: EO_WANT_... of evaluator.h. left_out: EO_RESULT_NO_... of result.h: null in the document. */
struct eo_analysis_question {
  struct eo_question common;
  int want;
  unsigned left_out;
};

/* Into the lane of what-if questions, in the place of a waiting one of the same token; the question is copied. The
   answer is the result as text. *job: of EO_ADMISSION_PREPARING. Errors: memory. */
enum eo_code eo_service_analyze(struct eo_service *service, const struct eo_analysis_question *question,
                                enum eo_admission *admission, int64_t *job, struct eo_error *error);

/* axes: taken over, and empty then. */
enum eo_code eo_service_sweep(struct eo_service *service, const struct eo_question *question,
                              struct eo_sweep_axes *axes, enum eo_admission *admission, int64_t *job,
                              struct eo_error *error);

/* Other work on a prepared pair (see rig_tasks.h), one at a time at a lower priority. run: adds the answer to text;
   release: of data, called once in any case. A newer question with the same token ends one that runs. */
struct eo_work {
  enum eo_code (*run)(void *data, const struct eo_pair *pair, const struct eo_design *design,
                      const struct eo_progress *progress, struct eo_text *text, struct eo_error *error);
  void (*release)(void *data);
  void *data;
};
enum eo_code eo_service_compute(struct eo_service *service, const struct eo_question *question,
                                const struct eo_work *work, enum eo_admission *admission, int64_t *job,
                                struct eo_error *error);

/* Whether the pairs as made that a design asks for may be evaluated here: its scatter and its limits are sound and
   they fit in memory.
   Errors: EO_ERROR_INPUT with the place in the block, memory. */
enum eo_code eo_service_admit_pairs(const struct eo_service *service, const struct eo_design *design,
                                    struct eo_error *error);

/* Whether the design's pair is in memory (an analysis would be answered at once). */
bool eo_service_is_prepared(struct eo_service *service, const struct eo_design *design);

struct eo_service_status {
  int64_t jobs[EO_JOB_STATES]; /* by state */
  bool database;               /* can be read */
  int analyses_waiting, sweeps_waiting, pairs, subscribers;
  int64_t analyses, overtaken, sweeps, refused; /* since the start: answered, dropped, answered, queue was full */
  double analysis_ms_total, analysis_ms_most;   /* queue, model, document */
  int64_t analysis_ms_bucket[12]; /* answered within 5, 10, 15, 20, 25, 50, 100, 250, 500, 1000, 5000 ms, and all:
                                     cumulative */
  int64_t true_evaluations, reused_evaluations; /* of this service's jobs since the start */
  int64_t events, cache_bytes;                  /* cache_bytes: of prepared pairs on disk */
};
/* Counts at the moment. Errors: of the store, and status->database is false then. */
enum eo_code eo_service_status(struct eo_service *service, struct eo_service_status *status, struct eo_error *error);

#endif
