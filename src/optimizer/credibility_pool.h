/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Points that credibility-ga lets its model score before a few of them are truly evaluated: bred, or sampled. */
#ifndef EASEOFF_OPTIMIZER_CREDIBILITY_POOL_H
#define EASEOFF_OPTIMIZER_CREDIBILITY_POOL_H

#include "optimizer/credibility_model.h"
#include "optimizer/evolution.h"

struct eo_credibility_pool {
  const struct eo_optimizer_settings *settings; /* borrowed */
  int count;                                    /* points that stand here */
  double *x;     /* [capacity][n], capacity: the larger of children and evolution_samples batch; owned, as all below */
  double *score; /* [capacity], to maximise */
  int *order;    /* [capacity] the points by falling score */
  bool
      *barred; /* [capacity] what eo_credibility_pool_spread() must not choose: for the caller to fill after breeding */
  double *gap; /* [capacity] scratch: distance to the nearest row */
  int parents_count;
  double *parents, *parent_score; /* [population][n], [population] */
};

/* Room for the children and parents that the settings ask for; settings: borrowed. Errors: memory. */
enum eo_code eo_credibility_pool_init(struct eo_credibility_pool *pool, const struct eo_optimizer_settings *settings,
                                      struct eo_error *error);
void eo_credibility_pool_done(struct eo_credibility_pool *pool);

/* `children` points: bred from these rows of the archive (at most `population`), then again from the best that came of
   it. batch counts the random numbers. */
void eo_credibility_pool_breed(struct eo_credibility_pool *pool, struct eo_credibility_model *model,
                               const struct eo_archive *archive, const int *row, int count, int batch);

/* `count` samples of the strategy, at most evolution_samples batch, by the predicted value alone. */
void eo_credibility_pool_sample(struct eo_credibility_pool *pool, struct eo_credibility_model *model,
                                const struct eo_evolution *evolution, int count, int batch);

/* The point with so many better ones before it. */
const double *eo_credibility_pool_at(const struct eo_credibility_pool *pool, int rank);

/* Fills chosen[][n] from `first` to `count` with the best that keep growing distances from all rows and from what is
   chosen; a distance that nobody keeps leaves its place free. Returns how many there are. */
int eo_credibility_pool_spread(struct eo_credibility_pool *pool, const struct eo_archive *archive, double *chosen,
                               int first, int count);

#endif
