/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A contest of optimizers on functions over the unit cube: best value after so many evaluations, over many seeds. */
#ifndef EASEOFF_BENCH_CONTEST_H
#define EASEOFF_BENCH_CONTEST_H

#include "optimizer/anatomy.h"
#include "optimizer/cube_warp.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

enum {
  CONTEST_BUDGET = 1000,
  CONTEST_BUDGET_MAX = 40000,
  CONTEST_MARKS = 4,
  CONTEST_SEEDS_MAX = 101,
  CONTEST_VARIABLES = 20,
  CONTEST_OBJECTIVES = 3
};

/* Everything an optimizer asks for goes through here. What counts is least: the best value, or, of a front, the share
   of the unit box of objectives that nothing dominates (1 less the hypervolume). */
struct trace {
  int n;
  double (*value)(void *context, const double *x);               /* infinite when the evaluation fails */
  void (*objectives)(void *context, const double *x, double *f); /* [CONTEST_OBJECTIVES], likewise */
  const struct eo_anatomy *anatomy;                              /* of the value; NULL: not known */
  const struct eo_view *view;                                    /* of a point; NULL: none */
  const double *parts;                                           /* of the point evaluated last */
  void *context;
  int budget, count;
  double best, at[CONTEST_MARKS]; /* at[]: after 100, 200, 400 evaluations and all of the budget */
  double target;
  int reached;                         /* evaluations until the best value was at most the target; 0: never */
  double (*front)[CONTEST_OBJECTIVES]; /* [CONTEST_BUDGET_MAX] of all that was evaluated; NULL: one objective */
  FILE *rows;                          /* what is evaluated is written here: seed, number, value, x; NULL: nowhere */
  uint64_t seed;
};

double trace_evaluate(struct trace *trace, const double *x);
void trace_evaluate_front(struct trace *trace, const double *x, double *f);

/* With pagmo only. */
enum { PAGMO_CMAES, PAGMO_SADE, PAGMO_DE, PAGMO_SGA, PAGMO_NSGA2 };
void pagmo_run(struct trace *trace, int algorithm, unsigned population, unsigned seed);

struct contest {
  int seeds, first;       /* how many, from which on */
  int budget;             /* true evaluations of each run */
  double target;          /* value whose first reaching is counted; -INFINITY: none */
  const char *algorithm;  /* how the names begin, with commas between; NULL: all */
  const char *change[32]; /* KEY=NUMBER: parameters of our own other than the defaults */
  int changes;
  const char *rows; /* file for every evaluation of the run; NULL: none */
  bool front;       /* Pareto fronts instead of one value */
};

/* 11 seeds, 1000 evaluations, every algorithm. */
struct contest contest_default(void);

/* Understands --seeds N, --first SEED, --budget N, --target VALUE, --algorithm NAME[,NAME]..., --set KEY=NUMBER, --rows
   FILE, --front and --quick at argv[i]; returns how many words it took, 0: none. */
int contest_option(struct contest *contest, int argc, char **argv, int i);

void contest_print_head(const struct contest *contest);

/* One line per optimizer. prepare sets trace->value or objectives, and context, for the instance of a seed. */
struct contest_problem {
  const char *name;
  int n;
  void (*prepare)(struct trace *trace, const struct contest_problem *problem, uint64_t seed);
  const void *detail;
};
void contest_run(const struct contest *contest, const struct contest_problem *problem);

#endif
