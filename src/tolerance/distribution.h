/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How one input scatters about its nominal value: doc/theory/as-made.md. Units are those of whoever
   states it. */
#ifndef EASEOFF_TOLERANCE_DISTRIBUTION_H
#define EASEOFF_TOLERANCE_DISTRIBUTION_H

enum eo_distribution_kind {
  EO_DISTRIBUTION_NORMAL,      /* mean, sigma, cut */
  EO_DISTRIBUTION_UNIFORM,     /* low, high */
  EO_DISTRIBUTION_LIST,        /* value: each as likely as the next */
  EO_DISTRIBUTION_HALF_NORMAL, /* of a size: mean + sigma |z|; cut */
};

struct eo_distribution {
  int kind; /* enum eo_distribution_kind */
  double mean, sigma;
  double
      cut; /* values farther than cut sigma from the mean do not occur; INFINITY: none. sigma is that before the cut */
  double low, high;
  int values;
  const double *value; /* [values], borrowed */
};

/* Phi(x), and its inverse for 0 < p < 1. */
double eo_normal_probability(double x);
double eo_normal_quantile(double p);

/* The value below which the share u of all draws lies, 0 < u < 1. */
double eo_distribution_quantile(const struct eo_distribution *distribution, double u);

/* Mean, standard deviation and the third and fourth central moment over powers of the standard deviation: 0 and 3 for a
   normal one. Where nothing scatters the deviation is 0 and the others are those of a normal one. */
struct eo_moments {
  double mean, deviation, third, fourth;
};
struct eo_moments eo_distribution_moments(const struct eo_distribution *distribution);

#endif
