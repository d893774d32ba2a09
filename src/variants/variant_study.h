/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A study of variants, run: what the history has is looked up, the rest is evaluated by a crew, every row is kept as it
   comes, in the order of the study. So a study gives the same rows for any number of threads and ranks; one that was
   cut short goes on with the first row that is missing, and one that is done gives its table once more. Where nothing
   but the modification varies (and the objective is neither robust nor rated) the rows are those of the history that
   searches use: what either evaluated the other need not. */
#ifndef EASEOFF_VARIANTS_VARIANT_STUDY_H
#define EASEOFF_VARIANTS_VARIANT_STUDY_H

#include "crew/crew.h"
#include "document/result_scalars.h"
#include "store/store.h"
#include "variants/variant_plan.h"

struct eo_variant_report {
  int64_t job;
  int rows;                               /* of the study */
  int done, reused;                       /* that have a result; of them known before the study asked */
  int computed, refused, not_converged;   /* by this run; of all that are done */
  double fraction, seconds, seconds_left; /* NaN: not known yet */
  const char *what;                       /* for people */
};

/* Several times a second, on the thread that runs the study; non-zero asks for a stop. */
typedef int eo_variant_watch(void *context, const struct eo_variant_report *report);

struct eo_variant_run {
  const struct eo_variant_plan *plan;
  const json_t *document; /* of eo_variant_plan_encode(): kept with the job */
  struct eo_store *store; /* of the calling thread */
  struct eo_crew *crew;
  int64_t job;             /* a queued job to work on; 0: the one to take up, or a new one */
  bool restart;            /* a new job even where one of the same study could be taken up */
  eo_variant_watch *watch; /* may be NULL */
  void *context;
};

struct eo_variant_result {
  int64_t job;
  bool resumed, cancelled;
  int rows, done, reused, computed, refused, not_converged;
  double seconds, store_seconds, look_up_seconds; /* wall time */
  double cost;                                    /* s of processors, of what was computed */
};

/* A stop that was asked for is no error: result->cancelled tells. Errors: EO_ERROR_INPUT (job, columns), of the crew,
   of the history; what was kept before stays. */
enum eo_code eo_variant_study_run(const struct eo_variant_run *run, struct eo_variant_result *result,
                                  struct eo_error *error);

/* The columns of a study; eo_scalars_done(). */
enum eo_code eo_variant_scalars(const struct eo_variant_plan *plan, struct eo_scalars *scalars, struct eo_error *error);

#endif
