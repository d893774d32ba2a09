/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "config.h"

#include "contest.h"

#include "base/random.h"
#include "optimizer/optimizer.h"
#include "optimizer/pareto.h"
#include "support/hypervolume.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#ifdef HAVE_NLOPT
#include <nlopt.h>
#endif

static const int early[CONTEST_MARKS - 1] = {100, 200, 400};

static int mark(int budget, int m)
{
  return m < CONTEST_MARKS - 1 && early[m] < budget ? early[m] : budget;
}

double trace_evaluate(struct trace *trace, const double *x)
{
  const double value = trace->value(trace->context, x);
  if (trace->count < trace->budget && value < trace->best)
    trace->best = value;
  trace->count++;
  if (trace->rows) {
    fprintf(trace->rows, "%llu %d %.17g", (unsigned long long)trace->seed, trace->count, value);
    for (int k = 0; k < trace->n; k++)
      fprintf(trace->rows, " %.17g", x[k]);
    fputc('\n', trace->rows);
  }
  if (!trace->reached && trace->best <= trace->target)
    trace->reached = trace->count;
  for (int m = 0; m < CONTEST_MARKS; m++)
    if (trace->count <= mark(trace->budget, m))
      trace->at[m] = trace->best;
  return value;
}

void trace_evaluate_front(struct trace *trace, const double *x, double *f)
{
  trace->objectives(trace->context, x, f);
  if (trace->count < trace->budget)
    memcpy(trace->front[trace->count], f, sizeof *trace->front);
  trace->count++;
}

static void measure_front(struct trace *trace)
{
  static const double reference[CONTEST_OBJECTIVES] = {1, 1, 1};
  static double point[CONTEST_BUDGET_MAX][CONTEST_OBJECTIVES];
  for (int m = 0; m < CONTEST_MARKS; m++) {
    const int last = mark(trace->budget, m), count = trace->count < last ? trace->count : last;
    memcpy(point, trace->front, sizeof *point * (size_t)count);
    trace->at[m] = 1 - hypervolume(*point, count, CONTEST_OBJECTIVES, reference);
  }
}

static void apply_changes(const struct contest *contest, struct eo_optimizer_settings *settings)
{
  for (int c = 0; c < contest->changes; c++) {
    const char *const value = strchr(contest->change[c], '=');
    if (!value)
      continue;
#define CHANGE(member, ...)                                          \
  if (strncmp(contest->change[c], #member "=", sizeof #member) == 0) \
    settings->member = (__typeof__(settings->member))atof(value + 1);
    EO_OPTIMIZER_SETTINGS(CHANGE, CHANGE, CHANGE, CHANGE, CHANGE, CHANGE, CHANGE)
  }
}

static void run_own(const struct contest *contest, struct trace *trace, int algorithm, uint64_t seed)
{
  struct eo_optimizer_settings settings;
  struct eo_optimizer *optimizer = NULL;
  struct eo_error error;
  struct eo_batch batch = {.count = 1};
  double f[CONTEST_OBJECTIVES];
  eo_optimizer_defaults(&settings, algorithm, trace->n);
  settings.seed = seed;
  settings.true_evaluations = trace->budget;
  settings.fitness_form = EO_FITNESS_NEGATIVE;
  settings.objectives = trace->front ? CONTEST_OBJECTIVES : 1;
  apply_changes(contest, &settings);
  if (eo_optimizer_new(&settings, &optimizer, &error) != EO_OK) {
    printf("%s\n", error.text);
    return;
  }
  if (trace->anatomy && eo_optimizer_describe(optimizer, trace->anatomy, &error) != EO_OK)
    printf("%s\n", error.text);
  if (trace->view && eo_optimizer_set_view(optimizer, trace->view, &error) != EO_OK)
    printf("%s\n", error.text);
  while (batch.count > 0 && eo_optimizer_ask(optimizer, &batch, &error) == EO_OK)
    for (int i = 0; i < batch.count; i++) {
      struct eo_outcome outcome = {.objectives = f};
      if (trace->front) {
        trace_evaluate_front(trace, batch.candidates[i].x, f);
        outcome.value = f[0] + f[1] + f[2];
      } else {
        outcome.value = trace_evaluate(trace, batch.candidates[i].x);
        outcome.parts = trace->parts;
      }
      eo_optimizer_tell(optimizer, i, &outcome, &error);
    }
  eo_optimizer_free(optimizer);
}

#ifdef HAVE_NLOPT
static double evaluate_nlopt(unsigned n, const double *x, double *gradient, void *context)
{
  (void)n;
  (void)gradient;
  const double value = trace_evaluate(context, x);
  return isfinite(value) ? value : 1e3;
}

/* From random starts, until the budget is spent. */
static void run_nlopt(const struct contest *contest, struct trace *trace, int algorithm, uint64_t seed)
{
  double x[CONTEST_VARIABLES], value;
  (void)contest;
  nlopt_srand((unsigned long)seed + 1);
  for (int start = 0; trace->count < trace->budget; start++) {
    nlopt_opt opt = nlopt_create((nlopt_algorithm)algorithm, (unsigned)trace->n);
    nlopt_set_min_objective(opt, evaluate_nlopt, trace);
    nlopt_set_lower_bounds1(opt, 0);
    nlopt_set_upper_bounds1(opt, 1);
    nlopt_set_maxeval(opt, trace->budget - trace->count);
    nlopt_set_xtol_rel(opt, 1e-9);
    nlopt_set_initial_step1(opt, 0.2);
    for (int k = 0; k < trace->n; k++)
      x[k] = eo_random_unit(eo_random_at(seed, 200, (uint64_t)start, 0), (uint64_t)k);
    const int before = trace->count;
    nlopt_optimize(opt, x, &value);
    nlopt_destroy(opt);
    if (trace->count == before)
      break;
  }
}
#endif

#ifdef HAVE_PAGMO
static void run_pagmo(const struct contest *contest, struct trace *trace, int algorithm, uint64_t seed)
{
  static const unsigned population[] = {
      [PAGMO_CMAES] = 10, [PAGMO_SADE] = 20, [PAGMO_DE] = 20, [PAGMO_SGA] = 50, [PAGMO_NSGA2] = 48};
  (void)contest;
  pagmo_run(trace, algorithm, population[algorithm], (unsigned)seed);
}
#endif

static const struct contestant {
  const char *name;
  void (*run)(const struct contest *, struct trace *, int, uint64_t);
  int algorithm;
  bool front;
} contestants[] = {
    {"credibility-ga", run_own, EO_CREDIBILITY_GA, false},
    {"ga", run_own, EO_GA, false},
    {"fpga", run_own, EO_FPGA, false},
    {"nsga2", run_own, EO_NSGA2, true},
#ifdef HAVE_NLOPT
    {"nlopt-bobyqa", run_nlopt, NLOPT_LN_BOBYQA, false},
    {"nlopt-crs2", run_nlopt, NLOPT_GN_CRS2_LM, false},
    {"nlopt-isres", run_nlopt, NLOPT_GN_ISRES, false},
    {"nlopt-direct-l", run_nlopt, NLOPT_GN_DIRECT_L, false},
#endif
#ifdef HAVE_PAGMO
    {"pagmo-cmaes", run_pagmo, PAGMO_CMAES, false},
    {"pagmo-sade", run_pagmo, PAGMO_SADE, false},
    {"pagmo-de", run_pagmo, PAGMO_DE, false},
    {"pagmo-sga", run_pagmo, PAGMO_SGA, false},
    {"pagmo-nsga2", run_pagmo, PAGMO_NSGA2, true},
#endif
};

static int compare_doubles(const void *a, const void *b)
{
  const double p = *(const double *)a, q = *(const double *)b;
  return (p > q) - (p < q);
}

static double cpu_seconds(void)
{
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Nine seeds of ten, rounded up. */
static int nine_of_ten(int seeds)
{
  return (9 * seeds + 9) / 10;
}

static void print_line(const struct contest *contest, const struct contest_problem *problem, const struct contestant *c)
{
  static double front[CONTEST_BUDGET_MAX][CONTEST_OBJECTIVES];
  double at[CONTEST_MARKS][CONTEST_SEEDS_MAX], reached[CONTEST_SEEDS_MAX], evaluated[CONTEST_SEEDS_MAX],
      spent = cpu_seconds();
  const int seeds = contest->seeds;
  long evaluations = 0;
  FILE *const rows = contest->rows ? fopen(contest->rows, "a") : NULL;
  for (int s = 0; s < seeds; s++) {
    struct trace trace = {.n = problem->n,
                          .budget = contest->budget,
                          .best = INFINITY,
                          .target = contest->target,
                          .front = c->front ? front : NULL};
    const uint64_t seed = (uint64_t)(contest->first + s);
    trace.rows = rows;
    trace.seed = seed;
    problem->prepare(&trace, problem, seed);
    c->run(contest, &trace, c->algorithm, seed);
    evaluations += trace.count;
    evaluated[s] = trace.count;
    if (c->front)
      measure_front(&trace);
    for (int m = 0; m < CONTEST_MARKS; m++)
      at[m][s] = trace.at[m];
    reached[s] = trace.reached ? (double)trace.reached : (double)INFINITY;
  }
  spent = cpu_seconds() - spent;
  if (rows)
    fclose(rows);
  printf("%-13s %2d  %-15s", problem->name, problem->n, c->name);
  for (int m = 0; m < CONTEST_MARKS; m++) {
    qsort(at[m], (size_t)seeds, sizeof(double), compare_doubles);
    printf("  %.4g (%.4g %.4g %.4g %.4g)", at[m][seeds / 2], at[m][seeds / 4], at[m][seeds - 1 - seeds / 4],
           at[m][nine_of_ten(seeds) - 1], at[m][seeds - 1]);
  }
  qsort(reached, (size_t)seeds, sizeof(double), compare_doubles);
  if (isfinite(contest->target))
    printf("  %5.0f (%5.0f %5.0f)", reached[seeds / 2], reached[seeds / 4], reached[seeds - 1 - seeds / 4]);
  qsort(evaluated, (size_t)seeds, sizeof(double), compare_doubles);
  printf("  %5.0f  %6.0f\n", evaluated[seeds / 2], evaluations ? 1e6 * spent / (double)evaluations : 0);
  fflush(stdout);
}

void contest_print_head(const struct contest *contest)
{
  printf("%-13s %2s  %-15s", "problem", "n", "algorithm");
  for (int m = 0; m < CONTEST_MARKS; m++)
    printf("  %d (quartiles, 90 %%, worst)", mark(contest->budget, m));
  if (isfinite(contest->target))
    printf("  to %-15.6g", contest->target);
  printf("   true  us/evaluation\n");
}

/* Whether one of the beginnings, with commas between, is that of the name. */
static bool takes_part(const char *beginnings, const char *name)
{
  bool taken = !beginnings;
  for (const char *at = beginnings; at && !taken; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL)
    taken = strncmp(name, at, strcspn(at, ",")) == 0;
  return taken;
}

void contest_run(const struct contest *contest, const struct contest_problem *problem)
{
  for (size_t c = 0; c < sizeof contestants / sizeof *contestants; c++)
    if (contestants[c].front == contest->front && takes_part(contest->algorithm, contestants[c].name))
      print_line(contest, problem, &contestants[c]);
}

struct contest contest_default(void)
{
  return (struct contest){.seeds = 11, .first = 1, .budget = CONTEST_BUDGET, .target = -INFINITY};
}

int contest_option(struct contest *contest, int argc, char **argv, int i)
{
  if (strcmp(argv[i], "--quick") == 0) {
    contest->seeds = 3;
    return 1;
  }
  if (strcmp(argv[i], "--front") == 0) {
    contest->front = true;
    return 1;
  }
  if (i + 1 >= argc)
    return 0;
  if (strcmp(argv[i], "--seeds") == 0) {
    const int seeds = atoi(argv[i + 1]);
    contest->seeds = seeds < 1 ? 1 : seeds > CONTEST_SEEDS_MAX ? CONTEST_SEEDS_MAX : seeds;
  } else if (strcmp(argv[i], "--first") == 0) {
    contest->first = atoi(argv[i + 1]);
  } else if (strcmp(argv[i], "--budget") == 0) {
    const int budget = atoi(argv[i + 1]);
    contest->budget = budget < 1 ? 1 : budget > CONTEST_BUDGET_MAX ? CONTEST_BUDGET_MAX : budget;
  } else if (strcmp(argv[i], "--rows") == 0) {
    contest->rows = argv[i + 1];
  } else if (strcmp(argv[i], "--target") == 0) {
    contest->target = atof(argv[i + 1]);
  } else if (strcmp(argv[i], "--algorithm") == 0) {
    contest->algorithm = argv[i + 1];
  } else if (strcmp(argv[i], "--set") == 0 && contest->changes < 32) {
    contest->change[contest->changes++] = argv[i + 1];
  } else {
    return 0;
  }
  return 2;
}
