/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Points of the unit cube for a Monte Carlo: each a function of seed, number and dimension alone, so that threads, the
   order of completion and a resume change nothing. */
#ifndef EASEOFF_TOLERANCE_PAIR_SAMPLER_H
#define EASEOFF_TOLERANCE_PAIR_SAMPLER_H

#include <stdint.h>

#include "base/error.h"

enum eo_sampling {
  EO_SAMPLING_SOBOL,  /* scrambled; the first n points of more */
  EO_SAMPLING_LATIN,  /* Latin hypercube: one point in each n-th of every dimension */
  EO_SAMPLING_RANDOM, /* independent: what the intervals of order statistics assume */
};

struct eo_sampler;

/* points: with Latin points, how many in all. Errors: EO_ERROR_INPUT (dimensions, points), memory. */
enum eo_code eo_sampler_new(struct eo_sampler **sampler, enum eo_sampling sampling, int dimensions, int points,
                            uint64_t seed, struct eo_error *error);
void eo_sampler_free(struct eo_sampler *sampler); /* NULL is fine */

/* Fills u[dimensions], each in (0, 1). May be called by several threads at once. */
void eo_sampler_at(const struct eo_sampler *sampler, int point, double *u);

#endif
