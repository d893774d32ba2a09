/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A job as the service shows it, and as a document: what the table of jobs says, and what is known of one that is being
   worked on. */
#ifndef EASEOFF_STUDY_JOB_DOCUMENT_H
#define EASEOFF_STUDY_JOB_DOCUMENT_H

#include <jansson.h>

#include "format/outline.h"
#include "format/text.h"
#include "store/jobs.h"
#include "study/study.h"

/* A design that a job found: its values, and its modification unless the history alone knows of it. */
struct eo_job_point {
  bool there, has_modification;
  struct eo_objective_value value;
  struct eo_modification modification;
};

/* A generation of an optimization. */
struct eo_job_generation {
  int index;
  double best, mean;                   /* J and penalties: of the best so far; of its true rows. NaN: not known */
  int true_count, predicted;           /* individuals */
  int true_so_far, individuals_so_far; /* of all generations up to this one; with the repeated individuals */
  double pfc_percent;                  /* of these */
};

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
  struct eo_job_point best, unmodified;
  int generations, capacity;
  struct eo_job_generation *history; /* [generations]; owned */
};

void eo_job_live_done(struct eo_job_live *live);

/* Takes over what a study reports. */
void eo_job_live_follow(struct eo_job_live *live, const struct eo_study_report *report);

/* ... and what it gave in the end. */
void eo_job_live_conclude(struct eo_job_live *live, const struct eo_study_result *result);

/* { "progress", "best", "unmodified" }: what is kept with the job, compact JSON. Without memory the text has failed. */
void eo_job_live_write(const struct eo_job_live *live, struct eo_text *text);

/* { "detail", "pointer" }: what is kept with a job that failed, compact JSON. */
void eo_job_error_write(const struct eo_error *error, struct eo_text *text);

/* A job at a moment: its row, and how far it is when somebody works on it. */
struct eo_job_view {
  struct eo_stored_job row; /* its texts are in `texts`; result: "" or "{}"; pair, study, space: "" */
  struct eo_job_live live;  /* without its generations; id 0: nobody works on it */
  char *texts;              /* owned */
};
/* Copies a row and, where somebody works on it, how far it is (else NULL). with_design: the design too. Errors: memory;
 *view is empty then. */
enum eo_code eo_job_view_init(struct eo_job_view *view, const struct eo_stored_job *row, const struct eo_job_live *live,
                              bool with_design, struct eo_error *error);
void eo_job_view_done(struct eo_job_view *view); /* an empty one is fine */

extern const struct eo_outline eo_job_outline, eo_job_generations_outline;

/* The whole document: id, kind, name, algorithm, state, priority, attempts, created, started, finished, progress {
   fraction, what, generation, true_evaluations, predicted, reused, individuals, pfc_percent, seconds, seconds_left },
   best and unmodified { J, f1_um, f2_N, f3_m_per_s2, fitness, modification }, error { detail, pointer }; what is not
   known is null. The design is there when the row has it. NULL without memory. */
json_t *eo_job_view_encode(const struct eo_job_view *view);
void eo_job_view_write(const struct eo_job_view *view, struct eo_text *text); /* compact */

/* How an optimization converged. */
struct eo_job_convergence {
  int count;
  struct eo_job_generation *generation; /* [count]; owned */
};
/* Out of a result document ("": none yet), or of a job that is being worked on. Errors: memory. */
enum eo_code eo_job_convergence_read(struct eo_job_convergence *convergence, const char *result,
                                     struct eo_error *error);
enum eo_code eo_job_convergence_copy(struct eo_job_convergence *convergence, const struct eo_job_live *live,
                                     struct eo_error *error);
void eo_job_convergence_done(struct eo_job_convergence *convergence);

/* Columns { "generation", "best", "mean", "true_evaluations", "predicted", "pfc_percent" }. NULL without memory. */
json_t *eo_job_convergence_encode(const struct eo_job_convergence *convergence);

#endif
