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
static double normal_quantile(const struct eo_distribution *distribution, double u)
{
  double below = isinf(distribution->cut) ? 0 : eo_normal_probability(-distribution->cut);
  return distribution->mean + distribution->sigma * eo_normal_quantile(below + u * (1 - 2 * below));
}

/* q(u) = mean + sigma Phi^-1(1/2 + u (Phi(c) - 1/2)): theory (A14). */
static double half_normal_quantile(const struct eo_distribution *distribution, double u)
{
  double most = isinf(distribution->cut) ? 1 : eo_normal_probability(distribution->cut);
  return distribution->mean + distribution->sigma * eo_normal_quantile(0.5 + u * (most - 0.5));
}

double eo_distribution_quantile(const struct eo_distribution *distribution, double u)
{
  switch (distribution->kind) {
  case EO_DISTRIBUTION_UNIFORM:
    return distribution->low + u * (distribution->high - distribution->low);
  case EO_DISTRIBUTION_LIST: {
    int i = (int)(u * distribution->values);
    return distribution->values > 0 ? distribution->value[i < distribution->values ? i : distribution->values - 1] : 0;
  }
  case EO_DISTRIBUTION_HALF_NORMAL:
    return distribution->sigma > 0 ? half_normal_quantile(distribution, u) : distribution->mean;
  default:
    return distribution->sigma > 0 ? normal_quantile(distribution, u) : distribution->mean;
  }
}

/* With phi the density at the cut c and w = 2 Phi(c) - 1 what is left: mu2 = 1 - 2 c phi/w,
   mu4 = 3 - 2 c (c^2 + 3) phi/w. */
static struct eo_moments normal_moments(const struct eo_distribution *distribution)
{
  struct eo_moments moments = {.mean = distribution->mean, .deviation = distribution->sigma, .fourth = 3};
  if (isinf(distribution->cut) || !(distribution->sigma > 0))
    return moments;
  double ends = density(distribution->cut) / (1 - 2 * eo_normal_probability(-distribution->cut));
  double square = 1 - 2 * distribution->cut * ends;
  moments.deviation = distribution->sigma * sqrt(square);
  moments.fourth = (3 - 2 * distribution->cut * (distribution->cut * distribution->cut + 3) * ends) / (square * square);
  return moments;
}

/* Raw moments of |z| up to the cut c, by parts: with phi the density and w = 2 Phi(c) - 1 what is left,
   m1 = 2 (phi(0) - phi(c))/w, m2 = 1 - 2 c phi(c)/w, m3 = 2 m1 - 2 c^2 phi(c)/w, m4 = 3 m2 - 2 c^3 phi(c)/w. */
static struct eo_moments half_normal_moments(const struct eo_distribution *distribution)
{
  if (!(distribution->sigma > 0))
    return (struct eo_moments){.mean = distribution->mean, .fourth = 3};
  double cut = isinf(distribution->cut) ? 0 : distribution->cut,
         left = isinf(distribution->cut) ? 1 : 2 * eo_normal_probability(cut) - 1,
         ends = isinf(distribution->cut) ? 0 : 2 * density(cut) / left;
  double first = 2 * density(0) / left - ends, second = 1 - cut * ends, third = 2 * first - cut * cut * ends,
         fourth = 3 * second - cut * cut * cut * ends, square = second - first * first;
  return (struct eo_moments){.mean = distribution->mean + distribution->sigma * first,
                             .deviation = distribution->sigma * sqrt(square),
                             .third = (third - 3 * first * second + 2 * first * first * first) / pow(square, 1.5),
                             .fourth = (fourth - 4 * first * third + 6 * first * first * second - 3 * pow(first, 4)) /
                                       (square * square)};
}

static struct eo_moments list_moments(const struct eo_distribution *distribution)
{
  double sum[5] = {0};
  for (int i = 0; i < distribution->values; i++)
    sum[1] += distribution->value[i] / distribution->values;
  for (int i = 0; i < distribution->values; i++)
    for (int k = 2; k < 5; k++)
      sum[k] += pow(distribution->value[i] - sum[1], k) / distribution->values;
  struct eo_moments moments = {.mean = sum[1], .deviation = sqrt(sum[2]), .fourth = 3};
  if (sum[2] > 0) {
    moments.third = sum[3] / pow(sum[2], 1.5);
    moments.fourth = sum[4] / (sum[2] * sum[2]);
  }
  return moments;
}

struct eo_moments eo_distribution_moments(const struct eo_distribution *distribution)
{
  if (distribution->kind == EO_DISTRIBUTION_LIST)
    return list_moments(distribution);
  if (distribution->kind == EO_DISTRIBUTION_NORMAL)
    return normal_moments(distribution);
  if (distribution->kind == EO_DISTRIBUTION_HALF_NORMAL)
    return half_normal_moments(distribution);
  const double flat = 1.8; /* fourth moment of a uniform distribution: (1/5) / (1/3)^2 */
  return (struct eo_moments){.mean = (distribution->low + distribution->high) / 2,
                             .deviation = (distribution->high - distribution->low) / sqrt(12),
                             .fourth = flat};
}
