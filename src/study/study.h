/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The study loop: ask -> history -> evaluate -> save -> tell. The optimizer knows no gears, the evaluators no history;
   here they meet.

   Every true evaluation is looked up in the history first and is saved with the rest of its batch in one transaction;
   the optimizer is told in the order it asked. So a study gives the same bytes for any number of threads, and one that
   was cut short (kill -9, power, Ctrl-C) is taken up by going through it again from the start with the history as
   memory: the same path, nothing computed twice. One that is done gives its result once more in this way. Rows of other
   jobs are imported as they stood when the job began. */
#ifndef EASEOFF_STUDY_STUDY_H
#define EASEOFF_STUDY_STUDY_H

#include "crew/crew.h"
#include "document/study_result.h"
#include "evaluation/pair.h"
#include "optimizer/optimizer.h"
#include "store/store.h"

struct eo_study_report {
  int64_t job;
  int generation;                      /* finished ones */
  const struct eo_generation *history; /* [generation] */
  int true_evaluations, predicted, repeated, reused, individuals;
  double fraction;                                /* 0..1 of the work */
  double seconds, seconds_left;                   /* NaN: not known yet */
  const struct eo_study_point *unmodified, *best; /* best->there: something converged */
};

/* Called from the thread that runs the study, after every evaluation of its own and after every batch; non-zero asks
   for a stop. */
typedef int eo_study_watch(void *context, const struct eo_study_report *report);

struct eo_study_plan {
  const struct eo_design *design; /* complete (eo_design_complete()); borrowed, as all here */
  const struct eo_pair *pair;     /* serves the design */
  struct eo_store *store;         /* of the calling thread */
  struct eo_crew *crew;           /* that computes the rows in place of threads; NULL: none */
  int threads;                    /* 0: eo_parallel_cores() */
  int64_t job;                    /* a queued job to work on; 0: the one to take up, or a new one */
  bool fresh;            /* the algorithm is told nothing of earlier jobs; what it asks for is still looked up */
  bool restart;          /* a new job even where one of the same study could be taken up */
  eo_study_watch *watch; /* may be NULL */
  void *context;
};

/* Runs or takes up a study. A stop that was asked for is no error: result->stopped tells. Errors: EO_ERROR_INPUT
   (settings, an unmodified pair that does not converge), EO_ERROR_FILE (history), EO_ERROR_MEMORY; what was saved
   before stays. eo_study_result_done() also after an error. */
enum eo_code eo_study_run(const struct eo_study_plan *plan, struct eo_study_result *result, struct eo_error *error);

/* The study's document: analyses the best design and keeps the text with the job. warnings may be NULL; document too:
   it is only kept then. */
enum eo_code eo_study_document(const struct eo_study_plan *plan, const struct eo_study_result *result,
                               const struct eo_warnings *warnings, json_t **document, struct eo_error *error);

#endif
