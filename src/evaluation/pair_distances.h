/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One pair at the centre distances of pairs as made: each distance that is asked for is prepared once, by the thread
   that asks first, and kept. */
#ifndef EASEOFF_EVALUATION_PAIR_DISTANCES_H
#define EASEOFF_EVALUATION_PAIR_DISTANCES_H

#include "evaluation/pair.h"

struct eo_pair_distances;

/* pair is borrowed; root: with root stress. Errors: memory. */
enum eo_code eo_pair_distances_new(struct eo_pair_distances **distances, const struct eo_pair *pair, bool root,
                                   struct eo_error *error);
/* NULL is fine; no thread may use a pair of them any more. */
void eo_pair_distances_free(struct eo_pair_distances *distances);

/* The pair at a deviation from the centre distance, m: the borrowed one where it has this, else one of its own. Any
   thread. Errors: of eo_pair_apart(). */
enum eo_code eo_pair_distances_find(struct eo_pair_distances *distances, double deviation, const struct eo_pair **pair,
                                    struct eo_error *error);

#endif
