/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Test problems over the unit cube, shifted and turned anew for every instance; the least value is 0 (ripple: its
   value at the known design, about the optimum). Definitions: Hansen, Finck, Ros, Auger 2009 (BBOB), simplified. */
#ifndef EASEOFF_BENCH_PROBLEMS_H
#define EASEOFF_BENCH_PROBLEMS_H

#include <stdint.h>

enum { PROBLEMS = 8, PROBLEM_VARIABLES = 20, PEAKS = 101 };

struct problem {
  int kind, n;
  double optimum[PROBLEM_VARIABLES];                      /* in the unit cube */
  double rotation[PROBLEM_VARIABLES * PROBLEM_VARIABLES]; /* orthonormal rows */
  double peak[PEAKS][PROBLEM_VARIABLES], shape[PEAKS][PROBLEM_VARIABLES];
  double wave[PROBLEM_VARIABLES + 1][16]; /* ripple: amplitude of harmonics, cosine and sine, per variable */
};

const char *problem_name(int kind);
void problem_init(struct problem *problem, int kind, int n, uint64_t instance);
double problem_value(const struct problem *problem, const double *x);

#endif
