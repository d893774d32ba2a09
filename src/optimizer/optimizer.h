/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Optimizers over the unit cube, ask and tell: they know x[n] -> value, no gear, no file, no clock.

     eo_optimizer_defaults(&settings, EO_CREDIBILITY_GA, n);
     eo_optimizer_new(&settings, &optimizer, error);
     eo_optimizer_import(...)                              rows known before the start, if any
     for (;;) {
       eo_optimizer_ask(optimizer, &batch, error);
       if (batch.count == 0) break;                        done
       for (i = 0; i < batch.count; i++)                   in any order, by any number of threads
         ... evaluate batch.candidates[i].x ...
       for (i = 0; i < batch.count; i++)
         eo_optimizer_tell(optimizer, i, &outcome[i], error);
     }
     eo_optimizer_best(optimizer) ...

   The trajectory is a function of settings, imported rows and outcomes alone: outcomes are applied in candidate order,
   whatever the order of telling, and random numbers come from counters. So a run is resumed by running it again from
   the start and answering from a log what was evaluated before. One thread at a time may use an optimizer.

   Laws: doc/theory/search.md; what was settled where the paper is silent or misprinted stands at each algorithm. */
#ifndef EASEOFF_OPTIMIZER_OPTIMIZER_H
#define EASEOFF_OPTIMIZER_OPTIMIZER_H

#include "base/error.h"
#include "optimizer/anatomy.h"
#include "optimizer/cube_warp.h"
#include "optimizer/settings.h"

#include <stdbool.h>

struct eo_optimizer;

struct eo_candidate {
  const double *x; /* [n] in 0..1; borrowed until the next ask */
  int generation, individual;
};

/* An individual whose value was predicted, not asked for (fpga). */
struct eo_predicted {
  const double *x; /* [n]; borrowed until the next ask */
  int generation, individual;
  double fitness, credibility;
};

struct eo_batch {
  int count; /* 0: the optimizer is done */
  const struct eo_candidate *candidates;
  int predictions_count; /* decided since the ask before */
  const struct eo_predicted *predictions;
};

/* What an evaluation gave. A failed one, or one with a value that is no finite number, ranks last, is kept, is never
   evaluated again and never used for prediction. */
struct eo_outcome {
  bool failed;
  double value;             /* to minimise: J + penalties */
  double violation;         /* >= 0: sum of constraint violations; nsga2 ranks by it first */
  const double *objectives; /* [objectives], to minimise; nsga2 only, else may be NULL */
  const double *parts;      /* [parts] of the anatomy; NULL: not known */
};

/* A truly evaluated point. */
struct eo_row {
  const double *x; /* borrowed until the next tell or import, as is the next */
  const double *objectives;
  double value, violation;
  bool failed, imported;
  int generation, individual; /* -1 when imported */
};

/* One generation (ga, fpga), batch (credibility-ga) or cycle (nsga2). */
struct eo_generation {
  int true_count, predicted_count, reused_count;        /* of this generation; their sum is its individuals */
  int history_rows, removed_redundant, removed_decayed; /* fpga: after the generation, and by its clean-up */
  int epoch;                                            /* credibility-ga: how often it started anew */
  double best_value; /* best true value so far; infinite when every evaluation failed */
};

struct eo_counters {
  int true_evaluations; /* told, imported rows not counted */
  int predicted, reused, individuals;
  double fitness_computed; /* PFC: true evaluations / individuals, 0..1 */
};

/* Bad settings are EO_ERROR_INPUT. eo_optimizer_free() accepts NULL. */
enum eo_code eo_optimizer_new(const struct eo_optimizer_settings *settings, struct eo_optimizer **optimizer,
                              struct eo_error *error);
void eo_optimizer_free(struct eo_optimizer *optimizer);

/* What the values are made of, before the first row: credibility-ga makes its surrogates of the parts, the others
   do not look at them. anatomy is copied. */
enum eo_code eo_optimizer_describe(struct eo_optimizer *optimizer, const struct eo_anatomy *anatomy,
                                   struct eo_error *error);

/* How a point is seen, before the first row: credibility-ga and nsga2 search a cube that is stretched by it; the
   others do not look at it. What is asked for and told stays in the cube of the variables. */
enum eo_code eo_optimizer_set_view(struct eo_optimizer *optimizer, const struct eo_view *view, struct eo_error *error);

/* Adds a true row known from elsewhere, before the first ask. A second row with the same x is ignored. */
enum eo_code eo_optimizer_import(struct eo_optimizer *optimizer, const double *x, const struct eo_outcome *outcome,
                                 struct eo_error *error);

/* The points to evaluate next; the batch before must have been told. No two candidates of a run are equal
   (but with reuse = 0), none equals an imported row. */
enum eo_code eo_optimizer_ask(struct eo_optimizer *optimizer, struct eo_batch *batch, struct eo_error *error);

/* The outcome of batch.candidates[candidate]. */
enum eo_code eo_optimizer_tell(struct eo_optimizer *optimizer, int candidate, const struct eo_outcome *outcome,
                               struct eo_error *error);

/* True rows in the order imported and asked; best: the row with the least value, -1 while there is none. */
int eo_optimizer_rows(const struct eo_optimizer *optimizer);
struct eo_row eo_optimizer_row(const struct eo_optimizer *optimizer, int index);
int eo_optimizer_best(const struct eo_optimizer *optimizer);

/* Of this run so far. */
struct eo_counters eo_optimizer_counters(const struct eo_optimizer *optimizer);

/* Finished generations; borrowed until the next ask or tell. */
const struct eo_generation *eo_optimizer_generations(const struct eo_optimizer *optimizer, int *count);

/* Rows of the Pareto front over the true rows, with room for eo_optimizer_rows() indices in front; ordered by the first
   objective. knee: the row with the least sum of objectives, each normalised to its range on the front (with two
   objectives: farthest below the line through the ends); weighted: the one with the least value. Both -1 for an empty
   front. Returns how many. */
struct eo_front {
  int count, knee, weighted;
};
struct eo_front eo_optimizer_front(const struct eo_optimizer *optimizer, int *front);

#endif
