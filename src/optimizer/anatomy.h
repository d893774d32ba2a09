/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a value to minimise is made of, for surrogates: values made of maxima have kinks where their parts are smooth.

     value = rest + sum over groups of weight * reduce(parts of the group)

   A group's parts follow those of the group before. reduce: the largest part, or the range (largest less least). The
   rest is what the groups leave: penalties, corrections. */
#ifndef EASEOFF_OPTIMIZER_ANATOMY_H
#define EASEOFF_OPTIMIZER_ANATOMY_H

#include "optimizer/settings.h"

enum eo_part_kind { EO_PART_LARGEST, EO_PART_RANGE };

struct eo_part_group {
  enum eo_part_kind kind;
  int count; /* parts, at least one */
  double weight;
};

struct eo_anatomy {
  int parts, groups;           /* parts: sum of the groups' */
  struct eo_part_group *group; /* [groups] */
  int blocks;                  /* of variables whose effects on the parts nearly add up; 0: none */
  int block[EO_MAX_VARIABLES]; /* whose block a variable is in */
};

/* The parts among a group's that its reduction takes: most, and least of a range (else -1). Returns the reduction. */
double eo_anatomy_reduce(const struct eo_part_group *group, const double *part, int *most, int *least);

/* The same with a softer largest, s log sum exp(part / s), and weights[count] of the parts in its derivative. softness
   s > 0, in the unit of the parts. */
double eo_anatomy_soften(const struct eo_part_group *group, const double *part, double softness, double *weight);

/* The value less the rest. */
double eo_anatomy_sum(const struct eo_anatomy *anatomy, const double *part);

#endif
