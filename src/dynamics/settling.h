/* SPDX-License-Identifier: GPL-3.0-or-later */
/* When a motion followed period by period has become periodic. States are [2 n]: positions, then velocities per mesh
   period. */
#ifndef EASEOFF_DYNAMICS_SETTLING_H
#define EASEOFF_DYNAMICS_SETTLING_H

#include "dynamics/oscillator.h"

enum { EO_LONGEST_REPEAT = 4 };

/* How nearly the state comes back after 1, 2, 3 and 4 periods, by number less one. */
struct eo_settling {
  int n, seen;    /* coordinates; periods so far */
  double settled; /* periodic when the state changes by less than this share of its swing, see integration.h */
  int max_repeat; /* 1..EO_LONGEST_REPEAT */
  double before[EO_LONGEST_REPEAT][2 * EO_MAX_COORDINATES];  /* states at the beginning of the last periods */
  double swing[EO_LONGEST_REPEAT];                           /* of these periods */
  double change[EO_LONGEST_REPEAT], best[EO_LONGEST_REPEAT]; /* shares of the swing */
  int idle[EO_LONGEST_REPEAT];                               /* periods since the best was last bettered */
};

/* n: coordinates, at most EO_MAX_COORDINATES; settled: share of the swing; max_repeat: 1..EO_LONGEST_REPEAT periods
   after which the state may come back. Nothing to let go of. */
void eo_settling_init(struct eo_settling *settling, int n, double settled, int max_repeat);

/* A period begins at y; returns where the largest size of a position within it is to be kept, 0 at first. */
double *eo_settling_begin(struct eo_settling *settling, const double *y);

/* It has ended in y; returns after how many periods the state repeats, or 0. */
int eo_settling_end(struct eo_settling *settling, const double *y);

/* Smallest change over any of the numbers of periods allowed. */
double eo_settling_change(const struct eo_settling *settling);

#endif
