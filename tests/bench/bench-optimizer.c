/* Optimizers on test problems, beside NLopt's when it is there: medians (quartiles) of the best value found after 100,
   200, 400 and 1000 true evaluations, and the optimizer's own time. Prints a table; asserts nothing.

     bench-optimizer [--quick] [--seeds N] [--variables N] [--problem NAME] [--algorithm NAME] [--set KEY=NUMBER]... */
#include "config.h"
#include "base/random.h"
#include "optimizer/optimizer.h"
#include "problems.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#ifdef HAVE_NLOPT
#include <nlopt.h>
#endif

enum { BUDGET = 1000, MARKS = 4, SEEDS_MAX = 101 };
static const int marks[MARKS] = {100, 200, 400, 1000};

/* Everything an optimizer asks for goes through here. */
struct trace {
  struct problem problem;
  int count;
  double best, at[MARKS];
};

static double evaluate(struct trace *trace, const double *x)
{
  const double value = problem_value(&trace->problem, x);
  if (trace->count < BUDGET && value < trace->best)
    trace->best = value;
  trace->count++;
  for (int m = 0; m < MARKS; m++)
    if (trace->count <= marks[m])
      trace->at[m] = trace->best;
  return value;
}

static struct { const char *text[32]; int count; } changes;

/* --set: parameters other than the defaults. */
static void apply_changes(struct eo_optimizer_settings *settings)
{
  int count;
  const struct eo_parameter *parameter = eo_optimizer_parameters(&count);
  for (int c = 0; c < changes.count; c++)
    for (int i = 0; i < count; i++) {
      const size_t length = strlen(parameter[i].key);
      if (strncmp(changes.text[c], parameter[i].key, length) == 0 && changes.text[c][length] == '=')
        eo_optimizer_put(settings, &parameter[i], atof(changes.text[c] + length + 1));
    }
}

static void run_own(struct trace *trace, int algorithm, uint64_t seed)
{
  struct eo_optimizer_settings settings;
  struct eo_optimizer *optimizer = NULL;
  struct eo_error error;
  struct eo_batch batch = {.count = 1};
  eo_optimizer_defaults(&settings, algorithm, trace->problem.n);
  settings.seed = seed;
  settings.true_evaluations = BUDGET;
  settings.fitness_form = EO_FITNESS_NEGATIVE;
  apply_changes(&settings);
  if (eo_optimizer_new(&settings, &optimizer, &error) != EO_OK)
    batch.count = 0;
  while (batch.count > 0 && eo_optimizer_ask(optimizer, &batch, &error) == EO_OK)
    for (int i = 0; i < batch.count; i++) {
      const struct eo_outcome outcome = {.value = evaluate(trace, batch.candidates[i].x)};
      eo_optimizer_tell(optimizer, i, &outcome, &error);
    }
  eo_optimizer_free(optimizer);
}

static void run_ga(struct trace *trace, uint64_t seed) { run_own(trace, EO_GA, seed); }
static void run_fpga(struct trace *trace, uint64_t seed) { run_own(trace, EO_FPGA, seed); }
static void run_credibility(struct trace *trace, uint64_t seed) { run_own(trace, EO_CREDIBILITY_GA, seed); }

#ifdef HAVE_NLOPT
static double evaluate_nlopt(unsigned n, const double *x, double *gradient, void *context)
{
  (void)n;
  (void)gradient;
  return evaluate(context, x);
}

/* From random starts, until the budget is spent. */
static void run_nlopt(struct trace *trace, nlopt_algorithm algorithm, uint64_t seed)
{
  const int n = trace->problem.n;
  double x[PROBLEM_VARIABLES], value;
  nlopt_srand((unsigned long)seed + 1);
  for (int start = 0; trace->count < BUDGET; start++) {
    nlopt_opt opt = nlopt_create(algorithm, (unsigned)n);
    nlopt_set_min_objective(opt, evaluate_nlopt, trace);
    nlopt_set_lower_bounds1(opt, 0);
    nlopt_set_upper_bounds1(opt, 1);
    nlopt_set_maxeval(opt, BUDGET - trace->count);
    nlopt_set_xtol_rel(opt, 1e-9);
    nlopt_set_initial_step1(opt, 0.2);
    for (int k = 0; k < n; k++)
      x[k] = eo_random_unit(eo_random_at(seed, 200, (uint64_t)start, 0), (uint64_t)k);
    const int before = trace->count;
    nlopt_optimize(opt, x, &value);
    nlopt_destroy(opt);
    if (trace->count == before)
      break;
  }
}

static void run_bobyqa(struct trace *trace, uint64_t seed) { run_nlopt(trace, NLOPT_LN_BOBYQA, seed); }
static void run_crs2(struct trace *trace, uint64_t seed) { run_nlopt(trace, NLOPT_GN_CRS2_LM, seed); }
static void run_isres(struct trace *trace, uint64_t seed) { run_nlopt(trace, NLOPT_GN_ISRES, seed); }
static void run_direct(struct trace *trace, uint64_t seed) { run_nlopt(trace, NLOPT_GN_DIRECT_L, seed); }
#endif

static const struct contestant {
  const char *name;
  void (*run)(struct trace *, uint64_t);
} contestants[] = {
    {"credibility-ga", run_credibility},
    {"ga", run_ga},
    {"fpga", run_fpga},
#ifdef HAVE_NLOPT
    {"nlopt-bobyqa", run_bobyqa},
    {"nlopt-crs2", run_crs2},
    {"nlopt-isres", run_isres},
    {"nlopt-direct-l", run_direct},
#endif
};

enum { CONTESTANTS = sizeof contestants / sizeof *contestants };

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

static void print_line(const struct contestant *c, int kind, int n, int seeds)
{
  double at[MARKS][SEEDS_MAX], spent = cpu_seconds();
  long evaluations = 0;
  for (int s = 0; s < seeds; s++) {
    struct trace trace = {.best = INFINITY};
    problem_init(&trace.problem, kind, n, (uint64_t)s + 1);
    c->run(&trace, (uint64_t)s + 1);
    evaluations += trace.count;
    for (int m = 0; m < MARKS; m++)
      at[m][s] = trace.at[m];
  }
  spent = cpu_seconds() - spent;
  printf("%-13s %2d  %-15s", problem_name(kind), n, c->name);
  for (int m = 0; m < MARKS; m++) {
    qsort(at[m], (size_t)seeds, sizeof(double), compare_doubles);
    printf("  %8.2e (%7.1e %7.1e)", at[m][seeds / 2], at[m][seeds / 4], at[m][seeds - 1 - seeds / 4]);
  }
  printf("  %6.0f\n", evaluations ? 1e6 * spent / (double)evaluations : 0);
  fflush(stdout);
}

struct choice {
  int seeds, variables;
  const char *problem, *algorithm;
};

static void print_table(const struct choice *choice, int n)
{
  for (int kind = 0; kind < PROBLEMS; kind++) {
    if (choice->problem && !strstr(problem_name(kind), choice->problem))
      continue;
    for (int c = 0; c < CONTESTANTS; c++)
      if (!choice->algorithm || strstr(contestants[c].name, choice->algorithm))
        print_line(&contestants[c], kind, n, choice->seeds);
  }
}

int main(int argc, char **argv)
{
  struct choice choice = {.seeds = 11};
  for (int i = 1; i < argc; i++) {
    const char *value = i + 1 < argc ? argv[i + 1] : "";
    if (strcmp(argv[i], "--quick") == 0)
      choice = (struct choice){.seeds = 3, .variables = 5};
    else if (strcmp(argv[i], "--seeds") == 0)
      choice.seeds = atoi(argv[++i < argc ? i : argc - 1]);
    else if (strcmp(argv[i], "--variables") == 0)
      choice.variables = atoi(argv[++i < argc ? i : argc - 1]);
    else if (strcmp(argv[i], "--problem") == 0)
      choice.problem = value, i++;
    else if (strcmp(argv[i], "--algorithm") == 0)
      choice.algorithm = value, i++;
    else if (strcmp(argv[i], "--set") == 0 && changes.count < 32)
      changes.text[changes.count++] = value, i++;
  }
  choice.seeds = choice.seeds < 1 ? 1 : choice.seeds > SEEDS_MAX ? SEEDS_MAX : choice.seeds;
  printf("%-13s %2s  %-15s", "problem", "n", "algorithm");
  for (int m = 0; m < MARKS; m++)
    printf("  %8d (quartiles)      ", marks[m]);
  printf("  us/evaluation\n");
  if (choice.variables) {
    print_table(&choice, choice.variables > PROBLEM_VARIABLES ? PROBLEM_VARIABLES : choice.variables);
  } else {
    print_table(&choice, 5);
    print_table(&choice, 10);
  }
  return 0;
}
