/* A contest of optimizers on functions over the unit cube: best value after so many evaluations, over many seeds. */
#ifndef EASEOFF_BENCH_CONTEST_H
#define EASEOFF_BENCH_CONTEST_H

#include <stdint.h>

enum { CONTEST_BUDGET = 1000, CONTEST_MARKS = 4, CONTEST_SEEDS_MAX = 101, CONTEST_VARIABLES = 20 };

/* Everything an optimizer asks for goes through here. */
struct trace {
  int n;
  double (*value)(void *context, const double *x); /* infinite when the evaluation fails */
  void *context;
  int count;
  double best, at[CONTEST_MARKS];
};

double trace_evaluate(struct trace *trace, const double *x);

struct contest {
  int seeds;
  const char *algorithm;   /* part of the name; NULL: all */
  const char *change[32];  /* KEY=NUMBER: parameters of our own other than the defaults */
  int changes;
};

/* Understands --seeds N, --algorithm NAME, --set KEY=NUMBER and --quick at argv[i]; returns how many words it took, 0: none. */
int contest_option(struct contest *contest, int argc, char **argv, int i);

void contest_print_head(void);

/* One line per optimizer. prepare sets trace->value and context for the instance of a seed. */
struct contest_problem {
  const char *name;
  int n;
  void (*prepare)(struct trace *trace, const struct contest_problem *problem, uint64_t seed);
  const void *detail;
};
void contest_run(const struct contest *contest, const struct contest_problem *problem);

#endif
