/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A branch of periodic states followed in speed through its folds: pseudo-arclength continuation of the harmonic
   balance (Keller 1977; Seydel 2010, chapter 4). */
#ifndef EASEOFF_DYNAMICS_CONTINUATION_H
#define EASEOFF_DYNAMICS_CONTINUATION_H

#include "base/error.h"
#include "dynamics/balance.h"

struct eo_branch_options {
  double low, high;                /* angular mesh frequencies between which the branch is followed, 0 < low < high */
  double size;                     /* typical dynamic deflection, > 0: what a step of one means in X, m */
  double first_step, longest_step; /* in shares of `size` and of the start frequency together */
  double fold_tolerance;           /* relative frequency to which a fold is closed in */
  int max_points;
};

/* first step 0.005, longest 0.05, folds to 1e-5, 2000 points; low, high and size are the caller's. */
extern const struct eo_branch_options eo_branch_defaults;

struct eo_branch_point {
  double frequency;
  const double *x;                   /* [ends][1 + 2 harmonics], valid during the visit */
  int direction;                     /* +1: the branch goes on towards higher frequencies */
  bool fold;                         /* the branch turned here */
  const struct eo_alternating *grid; /* forces and contact at this point */
};

/* Called for every point, in order. Non-zero ends the branch. */
typedef int eo_branch_visit(void *context, const struct eo_branch_point *point);

enum eo_branch_end { EO_BRANCH_LIMIT, EO_BRANCH_STOPPED, EO_BRANCH_POINTS, EO_BRANCH_LOST };

/* Follows the branch from x[ends][1 + 2 harmonics], a solution at cycle->frequency (other members of the cycle stay),
   first towards `direction`. *end: a frequency limit was reached, the visitor stopped, max_points, or no further point
   was found. Errors: EO_ERROR_INPUT (options), EO_ERROR_MEMORY. */
enum eo_code eo_branch_follow(struct eo_balance *balance, const struct eo_oscillator *oscillator,
                              const struct eo_cycle *cycle, const double *x, int direction,
                              const struct eo_branch_options *options, eo_branch_visit *visit, void *context,
                              enum eo_branch_end *end, struct eo_error *error);

#endif
