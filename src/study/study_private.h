/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A running study and the parts it is made of; see study.h. */
#ifndef EASEOFF_STUDY_STUDY_PRIVATE_H
#define EASEOFF_STUDY_STUDY_PRIVATE_H

#include "base/parallel.h"
#include "evaluation/evaluator.h"
#include "document/search_view.h"
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

/* A search over pairs as made that looks at most flanks with the first of them alone; see study_race.c. */
struct race {
  int first;                /* scenarios of the first look; 0: every flank is looked at with all */
  struct eo_design *design; /* of the first look; owned */
  int64_t problem;          /* of its rows */
  struct eo_text spec;      /* its JSON */
  char hash[EO_HASH_LENGTH + 1];
  int asked, whole; /* flanks so far; of them looked at with all */
  double best;      /* least rank of these; infinite: none */
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
  int visited;               /* rows of other jobs that were looked at */
  int *missing;              /* [missing_capacity] rows of the pending batch to compute; owned */
  int target;                /* states that they get */
  int missing_count, missing_capacity;
  struct worker worker[EO_MAX_THREADS];
  struct eo_batch batch;
  int computed_of_batch; /* by a crew, of the missing ones */
  struct race race;
  struct eo_anatomy anatomy;      /* of what is minimised; its groups owned */
  int parted;                     /* scenarios whose values the parts are */
  double *part;                   /* [anatomy.parts] of the row told; owned */
  struct eo_search_view *view;    /* of the optimizer; owned */
  double started, first_computed; /* s; first_computed: 0 until something was */
  double fraction_before;         /* of the work that was done then */
};

/* J, fitness and what is minimised, from raw values: any weighting serves any row. */
void eo_study_weigh(struct study *study, struct eo_study_point *point);
/* Over the first pairs alone; 0: over all. */
void eo_study_weigh_over(struct study *study, int first, struct eo_study_point *point);

/* From the states that a row has up to `states` of them. What a modification does to the model is an outcome; only what
   would befall any other row too is an error. One worker per thread. */
enum eo_code eo_study_compute_row(struct study *study, struct worker *worker, struct eo_row_data *row, int states,
                                  struct eo_error *error);

/* point.evaluation and states stay 0 when the history does not have the row. In a race it may have the first look. */
enum eo_code eo_study_look_up(struct study *study, struct eo_row_data *row, struct eo_error *error);

/* Somebody else may have saved the same row meanwhile; then theirs counts. */
enum eo_code eo_study_save_row(struct study *study, struct eo_row_data *row, struct eo_error *error);

/* What the history knows of a row but its raw values. */
void eo_study_take(struct eo_row_data *row, const struct eo_stored_evaluation *stored);

/* What the optimizer is told. objectives: the axes of the front. The parts are valid until the next. */
struct eo_outcome eo_study_outcome(struct study *study, const struct eo_row_data *row,
                                   double objectives[EO_MAX_OBJECTIVES]);

/* The race of a design, before there is a job; after an error it is released like the rest. */
enum eo_code eo_race_begin(struct study *study, struct eo_error *error);
void eo_race_end(struct study *study);
/* Which rows of the pending batch go on from the first look to all pairs, into study->missing where they have to be
   computed. */
void eo_race_choose(struct study *study);
/* What a row is told by: its rank, or of a first look what the whole of it is likely to be, behind the best. A whole
   row that is known from before, too. */
void eo_race_settle(struct study *study, struct eo_row_data *row);
double eo_race_value(const struct study *study, const struct eo_row_data *row);

/* Everything before the first ask: hashes, job, unmodified pair, rows of other jobs. */
enum eo_code eo_study_begin(struct study *study, struct eo_error *error);

/* Reports; extra: evaluations of the batch in work that are known. Non-zero: stop. */
int eo_study_tell_progress(struct study *study, int extra);

#endif
