/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Trust region round the best row: a local surrogate in coordinates scaled by the radius, its minimum in the box
   |x - centre| <= radius, and the radius that follows how well this went (Powell 2009, Regis and Shoemaker 2013). What
   a batch has room for beyond the minimum are points on the way to it, where the surrogate promises a gain too: they
   teach the next surrogate where it matters. Which polynomial tail it has is decided by leave-one-out each time. */
#ifndef EASEOFF_OPTIMIZER_TRUST_REGION_H
#define EASEOFF_OPTIMIZER_TRUST_REGION_H

#include "optimizer/true_rows.h"
#include "optimizer/composite.h"

struct eo_local {
  int variables, rows_max;
  double radius;       /* of the box, in the unit cube */
  double centre_value; /* when the last proposals were made */
  int reaching;        /* how many of them are minima, the first ones */
  struct eo_composite composite;
  int *row;         /* [rows_max] rows of the local surrogate; owned, as all below */
  double *distance; /* [rows_max] */
  double *u;        /* [rows_max][variables] (x - centre) / radius */
  double *y;        /* [rows_max] values */
  double low, high; /* the least and the largest of them */
};

/* Room for the rows that a quadratic of so many variables takes; anatomy: borrowed. Errors: memory. */
enum eo_code eo_local_init(struct eo_local *local, const struct eo_anatomy *anatomy, int variables,
                           struct eo_error *error);
void eo_local_done(struct eo_local *local);

/* Starts anew with the given radius. */
void eo_local_restart(struct eo_local *local, double radius);

/* Up to count points x[][variables] to evaluate round row `centre`, at least one; those that would teach nothing new
   are left out. Returns how many. generation counts the calls, for the random numbers. */
int eo_local_propose(struct eo_local *local, const struct eo_archive *archive, int centre, uint64_t seed,
                     int generation, int count, double *x);

/* Learns from the archive's rows first .. first + count - 1, which the last proposals became: grows, keeps or shrinks
   the radius. */
void eo_local_learn(struct eo_local *local, const struct eo_archive *archive, int first, int count);

#endif
