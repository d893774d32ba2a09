/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A running study and the parts it is made of; see study.h. */
#ifndef EASEOFF_STUDY_STUDY_PRIVATE_H
#define EASEOFF_STUDY_STUDY_PRIVATE_H

#include "base/parallel.h"
#include "evaluation/evaluator.h"
#include "evaluation/objective_anatomy.h"
#include "study/study_rows.h"
#include "study/study.h"
#include "optimizer/optimizer.h"
#include "store/jobs.h"

/* What one thread needs to evaluate. */
struct worker {
  struct eo_evaluator *evaluator; /* owned */
  struct eo_design *design;       /* owned scratch */
};

struct study {
  const struct eo_study_plan *plan;
  struct eo_study_result *result;
  struct eo_stored_job job;
  struct eo_text design, problem; /* JSON */
  char hash[EO_HASH_LENGTH + 1], study_hash[EO_HASH_LENGTH + 1], space_hash[EO_HASH_LENGTH + 1];
  struct eo_optimizer_settings settings;
  struct eo_optimizer *optimizer;
  struct eo_design *scratch; /* owned */
  struct eo_rows row;        /* true rows, in the optimizer's order; the pending batch behind them */
  int told;                  /* rows the optimizer has */
  int *missing;              /* [missing_capacity] rows of the pending batch to compute; owned */
  int missing_count, missing_capacity;
  struct worker worker[EO_MAX_THREADS];
  struct eo_batch batch;
  int computed_of_batch;          /* by a crew, of the missing ones */
  struct eo_anatomy anatomy;      /* of what is minimised; its groups owned */
  double *part;                   /* [anatomy.parts] of the row told; owned */
  double started, first_computed; /* s; first_computed: 0 until something was */
  double fraction_before;         /* of the work that was done then */
};

/* J, fitness and what is minimised, from raw values: any weighting serves any row. */
void eo_study_weigh(struct study *study, struct eo_study_point *point);

/* What a modification does to the model is an outcome; only what would befall any other row too is an error. One worker
   per thread. */
enum eo_code eo_study_compute_row(struct study *study, struct worker *worker, struct eo_row_data *row,
                                  struct eo_error *error);

/* point.evaluation stays 0 when the history does not have the row. */
enum eo_code eo_study_look_up(struct study *study, struct eo_row_data *row, struct eo_error *error);

/* Somebody else may have saved the same row meanwhile; then theirs counts. */
enum eo_code eo_study_save_row(struct study *study, struct eo_row_data *row, struct eo_error *error);

/* What the history knows of a row but its raw values. */
void eo_study_take(struct eo_row_data *row, const struct eo_stored_evaluation *stored);

/* What the optimizer is told. objectives: the three, in the unmodified pair's. The parts are valid until the next. */
struct eo_outcome eo_study_outcome(struct study *study, const struct eo_row_data *row, double objectives[3]);

/* Everything before the first ask: hashes, job, unmodified pair, rows of other jobs. */
enum eo_code eo_study_begin(struct study *study, struct eo_error *error);

/* Reports; extra: evaluations of the batch in work that are known. Non-zero: stop. */
int eo_study_tell_progress(struct study *study, int extra);

#endif
