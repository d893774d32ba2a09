/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One number of many pairs: how it is distributed and what decides. */
#ifndef EASEOFF_TOLERANCE_OUTPUT_REPORT_H
#define EASEOFF_TOLERANCE_OUTPUT_REPORT_H

#include <stdbool.h>
#include <stdint.h>

#include "base/error.h"
#include "tolerance/pair_completion.h"
#include "tolerance/distribution.h"
#include "tolerance/statistics.h"

enum { EO_REPORT_PERCENTS = 9, EO_REPORT_BINS = 25 };

/* A percentile and where it lies with 95 %, by the ranks of the values (distribution-free); NaN: that side is open. */
struct eo_report_percentile {
  double percent, value, low, high;
};
/* Of sorted values; without any all are NaN. */
struct eo_report_percentile eo_report_percentile_of(int rows, const double *sorted, double percent);

/* One input: standardised coefficient, Sobol indices of the surface. NaN where there is none. */
struct eo_report_influence {
  int input;
  double coefficient, first, total;
};

/* Where the pairs are completed: by what, the output's number there, and what came of it. */
struct eo_report_completion {
  const struct eo_completion *completion;
  int output;
  struct eo_completed completed;
};

struct eo_output_report {
  int rows;            /* pairs that have the number; the rest did not converge */
  int full;            /* of them computed in full */
  double coarse_error; /* of struct eo_completed; NaN: all pairs are in full */
  struct eo_summary summary;
  double mean_interval[2], deviation_interval[2]; /* 95 %, bootstrap */
  struct eo_report_percentile percentile[EO_REPORT_PERCENTS];
  int count[EO_REPORT_BINS]; /* equal parts from least to largest */
  int largest;               /* pair, of those in full */
  bool varies;
  double r2, r2_adjusted; /* of the linear regression; NaN: none */
  double q2, residual;    /* of the quadratic surface, each row left out once; NaN: none */
  int leading;            /* inputs that it has squares and products of */
  int inputs;
  struct eo_report_influence *influence; /* [inputs], by size of the total index where the surface carries more than the
                                            regression, else by that of the coefficient; owned */
};

/* input[pairs][inputs]; output: every stride-th value, NaN where there is none. moments: of independent inputs; NULL:
   they are not independent, so there is no surface. completion: NULL where all pairs are in full; intervals have in
   them what it leaves open. Errors: memory. */
enum eo_code eo_output_report_make(struct eo_output_report *report, int pairs, int inputs, const double *input,
                                   const double *output, int stride, const struct eo_moments *moments, uint64_t seed,
                                   const struct eo_report_completion *completion, struct eo_error *error);
void eo_output_report_done(struct eo_output_report *report);

#endif
