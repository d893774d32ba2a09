/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Optimizers on test problems, beside NLopt's and pagmo's when they are there: medians (quartiles) of the best value
   found after 100, 200, 400 and all of 1000 true evaluations (--budget), and the time per evaluation, the problem's own
   included. Prints a table; asserts nothing.

     bench-optimizer [--quick] [--front] [--seeds N] [--variables N] [--problem NAME] [--budget N] [--target VALUE]
   [--algorithm NAME[,NAME]...] [--set KEY=NUMBER]...

   --front: Pareto fronts of DTLZ2 with three objectives. */
#include "contest.h"
#include "problems.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static double value(void *context, const double *x)
{
  return problem_value(context, x);
}

static void prepare(struct trace *trace, const struct contest_problem *contest_problem, uint64_t seed)
{
  static struct problem problem;
  problem_init(&problem, *(const int *)contest_problem->detail, contest_problem->n, seed);
  trace->value = value;
  trace->context = &problem;
}

/* DTLZ2 (Deb, Thiele, Laumanns, Zitzler 2002), in a box of 1.1: the front leaves pi/6 / 1.1^3 = 0.393 undominated. */
static void sphere_objectives(void *context, const double *x, double *f)
{
  const int n = *(const int *)context;
  const double quarter = acos(0);
  double g = 1;
  for (int k = 2; k < n; k++)
    g += (x[k] - 0.5) * (x[k] - 0.5);
  g /= 1.1;
  f[0] = g * cos(quarter * x[0]) * cos(quarter * x[1]);
  f[1] = g * cos(quarter * x[0]) * sin(quarter * x[1]);
  f[2] = g * sin(quarter * x[0]);
}

static void prepare_front(struct trace *trace, const struct contest_problem *contest_problem, uint64_t seed)
{
  static int n;
  (void)seed;
  n = contest_problem->n;
  trace->objectives = sphere_objectives;
  trace->context = &n;
}

static void print_table(const struct contest *contest, const char *name, int n)
{
  const struct contest_problem front = {"dtlz2", n, prepare_front, NULL};
  if (contest->front)
    contest_run(contest, &front);
  for (int kind = 0; kind < PROBLEMS && !contest->front; kind++) {
    const struct contest_problem problem = {problem_name(kind), n, prepare, &kind};
    if (!name || strstr(problem_name(kind), name))
      contest_run(contest, &problem);
  }
}

int main(int argc, char **argv)
{
  struct contest contest = contest_default();
  const char *name = NULL;
  int variables = 0;
  for (int i = 1; i < argc; i++) {
    const int taken = contest_option(&contest, argc, argv, i);
    if (strcmp(argv[i], "--quick") == 0)
      variables = 5;
    else if (!taken && i + 1 < argc && strcmp(argv[i], "--variables") == 0)
      variables = atoi(argv[++i]);
    else if (!taken && i + 1 < argc && strcmp(argv[i], "--problem") == 0)
      name = argv[++i];
    i += taken > 1;
  }
  contest_print_head(&contest);
  if (variables > 0)
    print_table(&contest, name, variables < PROBLEM_VARIABLES ? variables : PROBLEM_VARIABLES);
  for (int n = 5; n <= 10 && variables <= 0; n += 5)
    print_table(&contest, name, n);
  return 0;
}
