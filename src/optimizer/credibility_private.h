/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the parts of credibility-ga share: credibility.c counts the epochs, credibility_batch.c fills the places of a
   batch. */
#ifndef EASEOFF_OPTIMIZER_CREDIBILITY_PRIVATE_H
#define EASEOFF_OPTIMIZER_CREDIBILITY_PRIVATE_H

#include "optimizer/credibility_pool.h"
#include "optimizer/global_minima.h"
#include "optimizer/optimizer.h"
#include "optimizer/trust_region.h"
#include "optimizer/view_distance.h"

enum eo_credibility_search { EO_SEARCH_BREED, EO_SEARCH_SAMPLE, EO_SEARCH_MODEL, EO_SEARCH_REFINE };

struct eo_credibility {
  int epoch, epoch_first; /* first archive row of the epoch */
  int batch;              /* batches so far, counts the random numbers */
  int stalled;
  double epoch_best;                 /* when the epoch last gained */
  bool fresh;                        /* the epoch's latin hypercube is still to come */
  enum eo_credibility_search search; /* what makes the batches */
  bool evolving;                     /* the evolution strategy stands; EO_SEARCH_SAMPLE: once the hypercube is told */
  bool polishing;                    /* the last share of the budget */
  int local_places;                  /* EO_SEARCH_SAMPLE: of the trust region in the next batch */
  int local_count;                   /* proposals of the trust region at the head of the pending batch */
  int refined;                       /* archive row that the evolution strategy ended with, -1 before */
  int *generation;                   /* [batch] archive rows, best first; owned, as all below */
  const double **generation_x;       /* [batch] */
  int *taboo;                        /* archive rows */
  int taboo_count, taboo_capacity;
  int *parent;    /* [population] archive rows, best first */
  double *latin;  /* scratch [initial_factor n] */
  double *chosen; /* [batch][n] */
  struct eo_credibility_model model;
  struct eo_credibility_pool pool;
  struct eo_local local;
  struct eo_evolution evolution;
  struct eo_global_minima global;
  struct eo_view_distance distance;
};

/* Whether the value's parts are known: a model of them leads to the bottom sooner, and says where to look next. */
bool eo_credibility_is_described(const struct eo_optimizer *optimizer);

/* Of the trust region in a batch that it has not earned more of. */
int eo_credibility_least_places(const struct eo_optimizer *optimizer);

/* Polishing and refining go for the best row of all; else an epoch sees its own rows only. */
bool eo_credibility_sees_all(const struct eo_credibility *credibility);

/* Whether a row lies where an epoch has ended. */
bool eo_credibility_is_taboo(const struct eo_optimizer *optimizer, int row);

/* Variables of a row of the archive, in the unit cube: [n]. */
const double *eo_credibility_row(const struct eo_optimizer *optimizer, int row);

/* Ask for the points of a new epoch, of one more batch; nothing is asked for where all that they would try is known. */
void eo_credibility_propose_epoch(struct eo_optimizer *optimizer);
void eo_credibility_propose_batch(struct eo_optimizer *optimizer);

#endif
