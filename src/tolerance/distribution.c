/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tolerance/distribution.h"

#include <math.h>

double eo_normal_probability(double x)
{
  return 0.5 * erfc(-x * M_SQRT1_2);
}

/* Density of the standard normal distribution. */
static double density(double x)
{
  return exp(-x * x / 2) / sqrt(2 * M_PI);
}

/* Halley's steps on erfc from the rational start of Abramowitz and Stegun 26.2.23 (4.5e-4): the third is rounding. */
double eo_normal_quantile(double p)
{
  double tail = fmin(p, 1 - p), t = sqrt(-2 * log(tail));
  double x = t - (2.515517 + t * (0.802853 + t * 0.010328)) / (1 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
  for (int i = 0; i < 3; i++) {
    double step = (tail - 0.5 * erfc(x * M_SQRT1_2)) / density(x);
    x -= step / (1 + x * step / 2);
  }
  return p < 0.5 ? -x : x;
}

/* q(u) = mean + sigma Phi^-1(Phi(-c) + u (Phi(c) - Phi(-c))): theory (A1). */
static double normal_quantile(const struct eo_distribution *d, double u)
{
  double below = isinf(d->cut) ? 0 : eo_normal_probability(-d->cut);
  return d->mean + d->sigma * eo_normal_quantile(below + u * (1 - 2 * below));
}

double eo_distribution_quantile(const struct eo_distribution *d, double u)
{
  switch (d->kind) {
  case EO_DISTRIBUTION_UNIFORM:
    return d->low + u * (d->high - d->low);
  case EO_DISTRIBUTION_LIST: {
    int i = (int)(u * d->values);
    return d->values > 0 ? d->value[i < d->values ? i : d->values - 1] : 0;
  }
  default:
    return d->sigma > 0 ? normal_quantile(d, u) : d->mean;
  }
}

/* With phi the density at the cut c and w = 2 Phi(c) - 1 what is left: mu2 = 1 - 2 c phi/w,
   mu4 = 3 - 2 c (c^2 + 3) phi/w. */
static struct eo_moments normal_moments(const struct eo_distribution *d)
{
  struct eo_moments m = {.mean = d->mean, .deviation = d->sigma, .fourth = 3};
  if (isinf(d->cut) || !(d->sigma > 0))
    return m;
  double ends = density(d->cut) / (1 - 2 * eo_normal_probability(-d->cut));
  double square = 1 - 2 * d->cut * ends;
  m.deviation = d->sigma * sqrt(square);
  m.fourth = (3 - 2 * d->cut * (d->cut * d->cut + 3) * ends) / (square * square);
  return m;
}

static struct eo_moments list_moments(const struct eo_distribution *d)
{
  double sum[5] = {0};
  for (int i = 0; i < d->values; i++)
    sum[1] += d->value[i] / d->values;
  for (int i = 0; i < d->values; i++)
    for (int k = 2; k < 5; k++)
      sum[k] += pow(d->value[i] - sum[1], k) / d->values;
  struct eo_moments m = {.mean = sum[1], .deviation = sqrt(sum[2]), .fourth = 3};
  if (sum[2] > 0) {
    m.third = sum[3] / pow(sum[2], 1.5);
    m.fourth = sum[4] / (sum[2] * sum[2]);
  }
  return m;
}

struct eo_moments eo_distribution_moments(const struct eo_distribution *d)
{
  if (d->kind == EO_DISTRIBUTION_LIST)
    return list_moments(d);
  if (d->kind == EO_DISTRIBUTION_NORMAL)
    return normal_moments(d);
  const double flat = 1.8; /* fourth moment of a uniform distribution: (1/5) / (1/3)^2 */
  return (struct eo_moments){
      .mean = (d->low + d->high) / 2, .deviation = (d->high - d->low) / sqrt(12), .fourth = flat};
}
