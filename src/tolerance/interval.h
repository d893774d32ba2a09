/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a count of independent trials leaves open: binomial distribution, order statistics, shares. */
#ifndef EASEOFF_TOLERANCE_INTERVAL_H
#define EASEOFF_TOLERANCE_INTERVAL_H

/* Ranks (1 .. n) of the sorted values between which the quantile of share p lies at least with the given level,
   whatever the distribution; coverage: with which probability it does. 0 or n + 1: beyond the values there are, that
   side is open. */
struct eo_rank_interval {
  int low, high;
  double coverage;
};
struct eo_rank_interval eo_order_statistic_ranks(int n, double p, double level);

/* The interval of a share of which `inside` of n were seen. */
struct eo_share_interval {
  double low, high;
};
struct eo_share_interval eo_clopper_pearson(int inside, int n, double level); /* never covers less than the level */
struct eo_share_interval eo_wilson(int inside, int n, double level);          /* shorter, covers the level on average */

#endif
