/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers of many pairs of which few are computed in full and all coarsely: what the others are taken for, how far that
   leaves a percentile in doubt, and which pairs to compute in full next: theory (A11), (A12). */
#ifndef EASEOFF_TOLERANCE_PAIR_COMPLETION_H
#define EASEOFF_TOLERANCE_PAIR_COMPLETION_H

#include <stdbool.h>
#include <stdint.h>

#include "base/error.h"

struct eo_completion {
  int pairs, outputs;
  const double *coarse; /* [pairs][outputs]; NaN: none */
  double *output;       /* [pairs][outputs]; rows in full as they came, the others completed; NaN: none */
  bool *full;           /* [pairs] */
  uint64_t seed;        /* of the draws */
};

/* What is known of one output after eo_completion_fill(). */
struct eo_completed {
  int rows;     /* in full, with both numbers */
  double error; /* root mean square of full less the line through the coarse numbers, each pair left out of its own
                   line, in the output's unit; NaN: fewer than 3 rows */
};

/* Completes an output: a pair that is not in full gets the line through the full ones at its coarse number, and what
   one of the full pairs nearest to it in that number has beside the line, drawn by seed, output and pair. A pair
   without a coarse number, or an output without full ones, gets NaN. */
enum eo_code eo_completion_fill(const struct eo_completion *completion, int output, struct eo_completed *completed,
                                struct eo_error *error);

/* A percentile of a completed output and its standard deviation from the completion alone, in the output's unit: 0
   where all pairs are in full, NaN without values. share[pairs] (may be NULL): variance of whether the pair lies below,
   0 .. 0.25. */
struct eo_doubt {
  double value, deviation;
  double rows; /* as many pairs in full would leave it as open as these do */
};
enum eo_code eo_completion_doubt(const struct eo_completion *completion, int output, double percent,
                                 struct eo_doubt *doubt, double *share, struct eo_error *error);

/* The same of the share of pairs at or below a value. */
enum eo_code eo_completion_share(const struct eo_completion *completion, int output, double most,
                                 struct eo_doubt *doubt, struct eo_error *error);

#endif
