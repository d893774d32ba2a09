/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pareto dominance with constraints, all objectives minimised: a row with less violation dominates, among equals (two
   feasible rows) the usual order decides. Sorting and crowding after Deb, Pratap, Agarwal, Meyarivan 2002. */
#ifndef EASEOFF_OPTIMIZER_PARETO_H
#define EASEOFF_OPTIMIZER_PARETO_H

#include "optimizer/true_rows.h"
#include "optimizer/optimizer.h"

/* Front number of every point, 0 the best; objective: [count][objectives]. scratch: [2 count]. */
void eo_pareto_rank(const double *objective, const double *violation, int count, int objectives, int *rank,
                    int *scratch);

/* Crowding distance of every point within its front; infinite at the ends. scratch: [count]. */
void eo_pareto_crowding(const double *objective, const int *rank, int count, int objectives, double *crowding,
                        int *scratch);

/* Indices of all points by rank, then falling crowding, then index. */
void eo_pareto_order(const int *rank, const double *crowding, int count, int *order);

/* The front of the feasible (else least violating) true rows, see eo_optimizer_front(). */
struct eo_front eo_pareto_front(const struct eo_archive *archive, int *front);

#endif
