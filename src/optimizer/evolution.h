/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Evolution strategy with covariance matrix adaptation (CMA-ES; Hansen and Ostermeier 2001, parameters of Hansen 2016),
   one generation at a time: it goes along valleys whose floor has a kink, where a smooth surrogate sees no way down.
   Points are clipped to the unit cube, and it learns from what they became. */
#ifndef EASEOFF_OPTIMIZER_EVOLUTION_H
#define EASEOFF_OPTIMIZER_EVOLUTION_H

#include "base/error.h"
#include "base/random.h"

#include <stdbool.h>

struct eo_evolution {
  int variables, generations; /* since the start */
  double step;                /* sigma, in the unit cube */
  double *mean;               /* [variables]; owned, as all below */
  double *covariance;         /* [variables][variables] */
  double *axes, *length;      /* its eigenvectors [variables][variables], one a row, and the roots of its eigenvalues */
  double *path, *step_path;   /* [variables] evolution paths */
  double *steps;              /* scratch, of the parents */
  double *move;               /* scratch [2 variables] */
};

/* Room for so many variables, not begun. Errors: memory. */
enum eo_code eo_evolution_init(struct eo_evolution *evolution, int variables, struct eo_error *error);
void eo_evolution_done(struct eo_evolution *evolution);

/* Starts anew round mean[variables]. */
void eo_evolution_restart(struct eo_evolution *evolution, const double *mean, double step);

/* A sample x[variables]; the random numbers are those of one individual. */
void eo_evolution_sample(const struct eo_evolution *evolution, struct eo_random random, double *x);

/* Learns from a generation, best first: x[count] points of [variables] each, at least two, sampled or found otherwise.
   Returns false when the matrix is no longer sound or the step has vanished: start anew. */
bool eo_evolution_learn(struct eo_evolution *evolution, const double *const *x, int count);

#endif
