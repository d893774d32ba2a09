/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Of a sample: moments, percentiles and how far they can be trusted, counts. Nothing here is NaN but what says so. */
#ifndef EASEOFF_TOLERANCE_STATISTICS_H
#define EASEOFF_TOLERANCE_STATISTICS_H

#include <stdint.h>

#include "base/error.h"

struct eo_summary {
  double mean, deviation; /* divisor n - 1; 0 for one value */
  double least, largest;
};
struct eo_summary eo_summary_of(int n, const double *value);

/* Percentile 0 .. 100 of sorted values, by linear interpolation at rank 1 + (n - 1) percent/100 (type 7 of Hyndman and
   Fan 1996). */
double eo_percentile(int n, const double *sorted, double percent);

/* Interval of level 0 .. 1 from resamples (Efron 1979): of the mean, the deviation, and each percentile. */
struct eo_bootstrap {
  double mean[2], deviation[2];
  double (*percentile)[2]; /* [percents], caller's */
};
enum eo_code eo_bootstrap_run(struct eo_bootstrap *bootstrap, int n, const double *value, int percents,
                              const double *percent, double level, int resamples, uint64_t seed,
                              struct eo_error *error);

/* Numbers of values in `bins` equal parts of low .. high; what lies outside counts to the nearest one. */
void eo_histogram(int n, const double *value, double low, double high, int bins, int *count);

/* Pearson's correlation; NaN where one of both is constant. */
double eo_correlation(int n, const double *a, const double *b);

/* Ranks 1 .. n, equal values share the mean of theirs. Allocates. Spearman's correlation is that of ranks. */
enum eo_code eo_ranks(int n, const double *value, double *rank, struct eo_error *error);

#endif
