/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tolerance/interval.h"

#include <math.h>

#include "tolerance/distribution.h"

static double binomial_term(int n, int k, double p)
{
  return exp(lgamma(n + 1.) - lgamma(k + 1.) - lgamma(n - k + 1.) + k * log(p) + (n - k) * log1p(-p));
}

/* Terms from k away from the mode, where each is smaller than the one before it: the lower tail, or 1 less the upper
   one. */
static double binomial_probability(int n, int k, double p)
{
  double sum = 0, term;
  if (k < 0)
    return 0;
  if (k >= n || p <= 0)
    return 1;
  if (p >= 1)
    return 0;
  if (k < n * p) {
    term = binomial_term(n, k, p);
    for (int i = k; i >= 0 && term > sum * 1e-18; i--) {
      sum += term;
      term *= i * (1 - p) / ((n - i + 1.) * p);
    }
    return fmin(sum, 1);
  }
  term = binomial_term(n, k + 1, p);
  for (int i = k + 1; i <= n && term > sum * 1e-18; i++) {
    sum += term;
    term *= (n - i) * p / ((i + 1.) * (1 - p));
  }
  return fmax(1 - sum, 0);
}

/* The least k with P(X <= k) >= share. */
static int binomial_quantile(int n, double p, double share)
{
  int low = 0, high = n;
  while (low < high) {
    int middle = (low + high) / 2;
    if (binomial_probability(n, middle, p) >= share)
      high = middle;
    else
      low = middle + 1;
  }
  return low;
}

/* X values lie below the quantile, X binomial: x_(low) <= quantile < x_(high) when low <= X < high: theory (A4). */
struct eo_rank_interval eo_order_statistic_ranks(int n, double p, double level)
{
  struct eo_rank_interval interval = {.low = binomial_quantile(n, p, (1 - level) / 2),
                                      .high = binomial_quantile(n, p, (1 + level) / 2) + 1};
  interval.coverage = binomial_probability(n, interval.high - 1, p) - binomial_probability(n, interval.low - 1, p);
  return interval;
}

/* The p at which at most k of n are seen with the given probability: it falls as p grows. */
static double share_at(int n, int k, double probability)
{
  double low = 0, high = 1;
  for (int i = 0; i < 60; i++) {
    double middle = (low + high) / 2;
    if (binomial_probability(n, k, middle) > probability)
      low = middle;
    else
      high = middle;
  }
  return (low + high) / 2;
}

/* The shares at which as few, or as many, would be seen with half of what the level leaves: theory (A5). */
struct eo_share_interval eo_clopper_pearson(int inside, int n, double level)
{
  double tail = (1 - level) / 2;
  return (struct eo_share_interval){.low = inside == 0 ? 0 : share_at(n, inside - 1, 1 - tail),
                                    .high = inside == n ? 1 : share_at(n, inside, tail)};
}

/* theory (A6); Wilson 1927. */
struct eo_share_interval eo_wilson(int inside, int n, double level)
{
  double z = eo_normal_quantile((1 + level) / 2), share = (double)inside / n, weight = z * z / n;
  double middle = (share + weight / 2) / (1 + weight);
  double half = z / (1 + weight) * sqrt(share * (1 - share) / n + weight / (4 * n));
  return (struct eo_share_interval){.low = fmax(0, middle - half), .high = fmin(1, middle + half)};
}
