/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What every algorithm shares: the true rows, the pending batch, counters. Included by the algorithms only.

   An algorithm is a state machine of two calls. propose() runs until it has requested at least one true evaluation or
   sets finished; absorb() follows when all of them were told and stand in the archive. */
#ifndef EASEOFF_OPTIMIZER_OPTIMIZER_PRIVATE_H
#define EASEOFF_OPTIMIZER_OPTIMIZER_PRIVATE_H

#include "optimizer/cube_warp.h"
#include "optimizer/true_rows.h"
#include "optimizer/optimizer.h"

struct eo_algorithm_functions {
  enum eo_code (*start)(struct eo_optimizer *optimizer, struct eo_error *error);
  enum eo_code (*propose)(struct eo_optimizer *optimizer, struct eo_error *error);
  enum eo_code (*absorb)(struct eo_optimizer *optimizer, struct eo_error *error);
  void (*stop)(struct eo_optimizer *optimizer); /* frees state, which may be NULL or half built */
};

extern const struct eo_algorithm_functions eo_genetic_algorithm, eo_credibility_algorithm, eo_nsga2_algorithm;

struct eo_optimizer {
  struct eo_optimizer_settings settings;
  const struct eo_algorithm_functions *algorithm;
  void *state; /* of the algorithm; owned */
  bool started, finished;
  int budget;
  struct eo_archive archive;
  struct eo_anatomy anatomy; /* owned; empty unless described */
  struct eo_cube_warp warp;  /* from the archive's x to what is asked for */

  /* the pending batch: candidate i becomes the archive's row archive.count + i */
  int batch_count, batch_capacity, told_count;
  double *batch_x;                /* [batch_capacity][variables], as in the archive */
  double *batch_asked;            /* [batch_capacity][variables], as asked for */
  struct eo_candidate *candidate; /* [batch_capacity] */
  struct eo_outcome *outcome;     /* [batch_capacity], objectives pointing into batch_objective */
  double *batch_objective;        /* [batch_capacity][objectives] */
  double *batch_part;             /* [batch_capacity][parts] */
  bool *told;                     /* [batch_capacity] */

  int prediction_count, prediction_capacity;
  double *prediction_x;            /* [prediction_capacity][variables] */
  struct eo_predicted *prediction; /* [prediction_capacity] */

  int true_evaluations, predicted, reused;
  int generation_count, generation_capacity;
  struct eo_generation *generation; /* [generation_capacity], the last one may be in work */
};

/* Asks for a true evaluation of x (of the archive's) and returns the archive row that holds it or will hold it after
   the batch; -1 when the budget is spent. repeat: evaluate even what is known. *known tells that nothing new is asked
   for. */
int eo_optimizer_request(struct eo_optimizer *optimizer, const double *x, int generation, int individual, bool repeat,
                         bool *known);

/* True evaluations that may still be requested, the pending ones taken off. */
int eo_optimizer_left(const struct eo_optimizer *optimizer);

/* Notes a prediction for the next ask. */
enum eo_code eo_optimizer_note_prediction(struct eo_optimizer *optimizer, const struct eo_predicted *prediction,
                                          struct eo_error *error);

/* Closes a generation: adds its statistics and sums up the counters. */
enum eo_code eo_optimizer_close_generation(struct eo_optimizer *optimizer, const struct eo_generation *generation,
                                           struct eo_error *error);

/* Makes room for a batch of this many candidates. */
enum eo_code eo_optimizer_reserve_batch(struct eo_optimizer *optimizer, int count, struct eo_error *error);

#endif
