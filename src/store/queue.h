/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The server's queue, on the table of jobs. Every function that writes is one transaction of its own, so any number of
   threads and processes may work on it, each with its own store: no job is claimed twice.

   A job waits (queued), is begun (preparing, then running) and ends (done, failed, cancelled). Jobs made by a terminal
   are in the table too; the queue lists them and leaves them alone until somebody retries one. */
#ifndef EASEOFF_STORE_QUEUE_H
#define EASEOFF_STORE_QUEUE_H

#include "store/jobs.h"

enum { EO_MOST_PRIORITY = 10 }; /* -10..10 */

enum eo_job_outcome {
  EO_JOB_OUTCOME_DONE,
  EO_JOB_OUTCOME_MISSING,  /* there is no such job */
  EO_JOB_OUTCOME_REPEATED, /* this idempotency key was used for the same request */
  EO_JOB_OUTCOME_CONFLICT, /* ... for another request */
  EO_JOB_OUTCOME_FULL,     /* too many jobs wait; try again later */
  EO_JOB_OUTCOME_STATE,    /* the job's state does not allow it */
  EO_JOB_OUTCOME_CLOSED,   /* of the service: it is stopping */
};

struct eo_queue_entry {
  enum eo_job_kind kind;
  const char *design; /* JSON, every default resolved */
  const char *spec;   /* JSON: what a study or a reproduction is asked for; NULL of another kind */
  const char *name, *algorithm;
  const char *pair;    /* of a preparation: hash of what is prepared; else NULL */
  const char *key;     /* idempotency key, up to 255 bytes; NULL: none */
  const char *request; /* hash of the request with this key; NULL without key */
  bool fresh;
  int priority; /* -10..10 */
};

/* Adds a job unless most of its kind wait already. *id: its number; with REPEATED that of the earlier job. A
   preparation of a pair that waits for one or is in one, and is not to be stopped, is that job: DONE. Outcomes: DONE,
   REPEATED, CONFLICT, FULL. */
enum eo_code eo_queue_add(struct eo_store *store, const struct eo_queue_entry *entry, int64_t most, int64_t *id,
                          enum eo_job_outcome *outcome, struct eo_error *error);

/* Begins the next job of a kind: highest priority, then oldest. It is preparing then. *id 0: none waits. */
enum eo_code eo_queue_claim(struct eo_store *store, enum eo_job_kind kind, int64_t *id, struct eo_error *error);

/* Ends a job that was begun, or (QUEUED) puts it back. error_text, progress: JSON, NULL leaves what is there
   (error_text: none). */
enum eo_code eo_queue_end(struct eo_store *store, int64_t id, enum eo_job_state state, const char *error_text,
                          const char *progress, struct eo_error *error);

/* How far a job is, JSON. */
enum eo_code eo_queue_note(struct eo_store *store, int64_t id, const char *progress, struct eo_error *error);

/* Cancels a waiting job, marks one that was begun as to be stopped. Outcomes: DONE, MISSING, STATE. */
enum eo_code eo_queue_cancel(struct eo_store *store, int64_t id, enum eo_job_outcome *outcome, struct eo_error *error);

/* Queues a failed or cancelled job again, under its number and with what it found. Outcomes: DONE, MISSING, STATE,
   FULL. */
enum eo_code eo_queue_retry(struct eo_store *store, int64_t id, int64_t most, enum eo_job_outcome *outcome,
                            struct eo_error *error);

/* Queues a new job like another one; priority NULL: the same. Outcomes: DONE, MISSING, FULL. */
enum eo_code eo_queue_clone(struct eo_store *store, int64_t id, const int *priority, int64_t most, int64_t *clone,
                            enum eo_job_outcome *outcome, struct eo_error *error);

/* Removes a job that has ended, and its path; evaluations stay. Outcomes: DONE, MISSING, STATE. */
enum eo_code eo_queue_remove(struct eo_store *store, int64_t id, enum eo_job_outcome *outcome, struct eo_error *error);

/* After the server's process ended: what it had begun waits again, what was to be stopped is cancelled, and what was
   begun so many times and came no further each time has failed, with fault (JSON). *queued: how many wait. Only for who
   holds the server's lock. */
enum eo_code eo_queue_recover(struct eo_store *store, int attempts, const char *fault, int64_t *queued,
                              struct eo_error *error);

/* Removes finished preparations but the newest ones: nobody asks for them. */
enum eo_code eo_queue_tidy(struct eo_store *store, int keep, struct eo_error *error);

/* What somebody who runs a server does not want to keep: of optimizations that have ended all but the newest (keep 0:
   none goes), and predictions of jobs that ended so many days ago (0: none). Evaluations stay. In steps between which
   others can write. */
enum eo_code eo_queue_retain(struct eo_store *store, int keep, double prediction_days, struct eo_error *error);

/* One job with everything; the texts are borrowed until visit returns. Outcomes: DONE, MISSING. */
enum eo_code eo_queue_find(struct eo_store *store, int64_t id, eo_store_visit_job *visit, void *context,
                           enum eo_job_outcome *outcome, struct eo_error *error);

/* At most limit jobs with numbers below before (0: all), newest first; design "", result "" or "{}" when there is one.
   state, kind: -1 or one; active: only those that have not ended. */
struct eo_queue_filter {
  int state, kind;
  bool active;
  int64_t before;
  int limit;
};
enum eo_code eo_queue_list(struct eo_store *store, const struct eo_queue_filter *filter, eo_store_visit_job *visit,
                           void *context, struct eo_error *error);

/* How many jobs of each state there are. */
enum eo_code eo_queue_count(struct eo_store *store, int64_t count[EO_JOB_STATES], struct eo_error *error);

#endif
