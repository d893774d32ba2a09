/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What holds for every algorithm whatever it finds: repeatable, independent of threads and the order of telling,
   resumable, never twice the same point, within its budget, honest about failures. */
#include "base/random.h"
#include "optimizer/operators.h"
#include "optimizer/optimizer.h"
#include "optimizer/pareto.h"
#include "support/hypervolume.h"
#include "support/tap.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

enum { N = 4, ROWS_MAX = 4000, OBJECTIVES = 2, PARTS = 3, NUMBERS = OBJECTIVES + PARTS };

/* One run: every row in the order of the archive, and how it was made. */
struct run {
  int rows, calls, best, predictions;
  double x[ROWS_MAX][N], value[ROWS_MAX];
  bool failed[ROWS_MAX];
  struct eo_counters counters;
  int generations, individuals_of_generations;
};

struct how {
  int threads;           /* evaluate with this many */
  bool backwards;        /* tell in reverse order */
  const struct run *log; /* answer from these rows where possible */
  int log_rows;
  double fail_below; /* x[0] below this fails */
  double failed_value;
};

static const struct how plainly = {.threads = 1, .fail_below = -1};

/* Smooth with ripples, a minimum at a bound; cheap. */
static double value_at(const double *x)
{
  double f = 0.2 + 0.5 * x[1];
  for (int k = 0; k < N; k++)
    f += (x[k] - 0.3) * (x[k] - 0.3) + 0.02 * (1 - cos(20 * x[k]));
  return f;
}

/* Whether the searches are told what the value is made of: the larger of two and a rest of its own. */
static bool described;
static struct eo_part_group groups[] = {{EO_PART_LARGEST, 2, 1}, {EO_PART_RANGE, 1, 1}};

static enum eo_code make(const struct eo_optimizer_settings *s, struct eo_optimizer **o, struct eo_error *error)
{
  const struct eo_anatomy anatomy = {.parts = PARTS, .groups = 2, .group = groups};
  enum eo_code code = eo_optimizer_new(s, o, error);
  return code || !described ? code : eo_optimizer_describe(*o, &anatomy, error);
}

static struct eo_outcome outcome_at(const struct how *how, const double *x, double *objectives)
{
  struct eo_outcome outcome = {.value = value_at(x), .objectives = objectives};
  objectives[0] = x[0] + (x[2] - 0.5) * (x[2] - 0.5);
  objectives[1] = (1 - x[0]) * (1 - x[0]) + x[1];
  double *parts = objectives + OBJECTIVES;
  parts[0] = 0.2 + 0.5 * x[1];
  parts[1] = 0.1 + x[0];
  parts[2] = x[2];
  outcome.parts = parts;
  outcome.violation = x[3] < 0.2 ? 0.2 - x[3] : 0;
  if (x[0] < how->fail_below) {
    outcome.failed = true;
    outcome.value = how->failed_value;
  }
  return outcome;
}

static int find_in_log(const struct how *how, const double *x)
{
  for (int i = 0; how->log && i < how->log_rows; i++)
    if (memcmp(how->log->x[i], x, sizeof how->log->x[i]) == 0)
      return i;
  return -1;
}

struct share {
  const struct how *how;
  const struct eo_batch *batch;
  struct eo_outcome *outcome;
  double (*objectives)[NUMBERS];
  int first, calls;
};

static void *evaluate_share(void *context)
{
  struct share *s = context;
  for (int i = s->first; i < s->batch->count; i += s->how->threads) {
    const double *x = s->batch->candidates[i].x;
    if (find_in_log(s->how, x) < 0)
      s->calls++;
    s->outcome[i] = outcome_at(s->how, x, s->objectives[i]); /* the log would say the same */
  }
  return NULL;
}

static int evaluate_batch(const struct how *how, const struct eo_batch *batch, struct eo_outcome *outcome,
                          double (*objectives)[NUMBERS])
{
  pthread_t thread[8];
  struct share share[8];
  int calls = 0;
  for (int t = 0; t < how->threads; t++) {
    share[t] = (struct share){how, batch, outcome, objectives, t, 0};
    pthread_create(&thread[t], NULL, evaluate_share, &share[t]);
  }
  for (int t = 0; t < how->threads; t++) {
    pthread_join(thread[t], NULL);
    calls += share[t].calls;
  }
  return calls;
}

static void copy_rows(struct run *run, const struct eo_optimizer *o)
{
  run->rows = eo_optimizer_rows(o);
  run->best = eo_optimizer_best(o);
  run->counters = eo_optimizer_counters(o);
  for (int i = 0; i < run->rows && i < ROWS_MAX; i++) {
    const struct eo_row row = eo_optimizer_row(o, i);
    memcpy(run->x[i], row.x, sizeof run->x[i]);
    run->value[i] = row.value;
    run->failed[i] = row.failed;
  }
  const struct eo_generation *g = eo_optimizer_generations(o, &run->generations);
  for (int i = 0; i < run->generations; i++)
    run->individuals_of_generations += g[i].true_count + g[i].predicted_count + g[i].reused_count;
}

/* Runs o to its end, or until `stop` rows stand. */
static bool finish(struct eo_optimizer *o, const struct how *how, int stop, struct run *run)
{
  static struct eo_outcome outcome[2048];
  static double objectives[2048][NUMBERS];
  struct eo_error error;
  struct eo_batch batch;
  bool good = true;
  memset(run, 0, sizeof *run);
  while (good && eo_optimizer_rows(o) < stop) {
    good = eo_optimizer_ask(o, &batch, &error) == EO_OK && batch.count <= 2048;
    run->predictions += good ? batch.predictions_count : 0;
    if (!good || batch.count == 0)
      break;
    run->calls += evaluate_batch(how, &batch, outcome, objectives);
    for (int i = 0; i < batch.count && good; i++) {
      const int c = how->backwards ? batch.count - 1 - i : i;
      good = eo_optimizer_tell(o, c, &outcome[c], &error) == EO_OK;
    }
  }
  copy_rows(run, o);
  return good;
}

static struct eo_optimizer_settings settings_of(int algorithm)
{
  struct eo_optimizer_settings s;
  eo_optimizer_defaults(&s, algorithm, N);
  s.objectives = OBJECTIVES;
  s.true_evaluations = 300;
  s.generations = 20;
  s.share_radius = 0.05;
  s.seed = 12345;
  return s;
}

static bool run_with(const struct eo_optimizer_settings *s, const struct how *how, struct run *run)
{
  struct eo_optimizer *o = NULL;
  struct eo_error error;
  if (make(s, &o, &error) != EO_OK)
    return false;
  const bool good = finish(o, how, INT32_MAX, run);
  eo_optimizer_free(o);
  return good;
}

static bool same(const struct run *a, const struct run *b)
{
  return a->rows == b->rows && a->best == b->best && memcmp(a->x, b->x, sizeof a->x) == 0 &&
         memcmp(a->value, b->value, sizeof a->value) == 0 && a->counters.predicted == b->counters.predicted;
}

static struct run first, second; /* too large for the stack */

static int count_twins(const struct run *run)
{
  int twins = 0;
  for (int i = 0; i < run->rows; i++)
    for (int j = 0; j < i; j++)
      twins += memcmp(run->x[i], run->x[j], sizeof run->x[i]) == 0;
  return twins;
}

static int best_by_hand(const struct run *run)
{
  int best = -1;
  for (int i = 0; i < run->rows; i++)
    if (!run->failed[i] && (best < 0 || run->value[i] < run->value[best]))
      best = i;
  return best;
}

static void test_repeatable(int algorithm)
{
  const char *name = eo_optimizer_algorithm_name(algorithm);
  const struct eo_optimizer_settings s = settings_of(algorithm);
  struct how how = plainly;
  bool ended = run_with(&s, &how, &first);
  ok(ended && first.rows > 100, "%s: the search has %d rows", name, first.rows);
  ok(run_with(&s, &how, &second) && same(&first, &second), "%s: a second run gives the same bytes", name);
  for (how.threads = 2; how.threads <= 4; how.threads *= 2)
    ok(run_with(&s, &how, &second) && same(&first, &second), "%s: a run with %d threads gives the same bytes", name,
       how.threads);
  how = plainly;
  how.backwards = true;
  ok(run_with(&s, &how, &second) && same(&first, &second), "%s: a run that is told backwards gives the same bytes",
     name);
  struct eo_optimizer_settings other = s;
  other.seed++;
  ok(run_with(&other, &plainly, &second) && !same(&first, &second), "%s: another seed goes another way", name);
}

static void test_accounts(int algorithm)
{
  const char *name = eo_optimizer_algorithm_name(algorithm);
  const struct eo_optimizer_settings s = settings_of(algorithm);
  run_with(&s, &plainly, &first);
  const struct eo_counters c = first.counters;
  ok(c.true_evaluations == first.rows && first.calls == first.rows, "%s: every true evaluation is a row", name);
  ok(c.true_evaluations <= s.true_evaluations, "%s: the budget is kept: %d", name, c.true_evaluations);
  ok(algorithm == EO_GA || algorithm == EO_FPGA || c.true_evaluations == s.true_evaluations,
     "%s: the budget is used up", name);
  ok(c.true_evaluations + c.predicted + c.reused == c.individuals, "%s: true, predicted and reused are the individuals",
     name);
  ok(first.individuals_of_generations == c.individuals,
     "%s: the individuals of the generations are those of the search", name);
  close_to(c.fitness_computed, (double)c.true_evaluations / c.individuals, 1e-15,
           "PFC, true evaluations over individuals");
  ok(algorithm == EO_FPGA ? c.predicted > 0 && first.predictions >= c.predicted : c.predicted == 0,
     "%s: %d rows are predicted, %d announced", name, c.predicted, first.predictions);
  ok(count_twins(&first) == 0, "%s: no point stands twice", name);
  ok(first.best == best_by_hand(&first) && first.value[first.best] == value_at(first.x[first.best]),
     "%s: the best is a true row", name);
}

/* A run is cut, then resumed by running again with what the cut one knew. */
static void test_resume(int algorithm)
{
  const char *name = eo_optimizer_algorithm_name(algorithm);
  const struct eo_optimizer_settings s = settings_of(algorithm);
  static struct run cut;
  struct eo_optimizer *o = NULL;
  struct eo_error error;
  run_with(&s, &plainly, &first);
  make(&s, &o, &error);
  finish(o, &plainly, 150, &cut);
  eo_optimizer_free(o);
  struct how how = plainly;
  how.log = &cut;
  how.log_rows = cut.rows;
  const bool ended = run_with(&s, &how, &second);
  ok(cut.rows >= 150 && cut.rows < first.rows && ended && same(&first, &second),
     "%s: a replay from the log of %d rows goes the same way", name, cut.rows);
  ok(second.calls == first.rows - cut.rows, "%s: a replay makes %d new evaluations", name, second.calls);
}

static void test_import(int algorithm)
{
  const char *name = eo_optimizer_algorithm_name(algorithm);
  const struct eo_optimizer_settings s = settings_of(algorithm);
  struct eo_optimizer *o = NULL;
  struct eo_error error;
  struct eo_batch batch;
  double objectives[NUMBERS];
  run_with(&s, &plainly, &first);
  make(&s, &o, &error);
  for (int i = 0; i < first.rows; i += 2) {
    const struct eo_outcome outcome = outcome_at(&plainly, first.x[i], objectives);
    eo_optimizer_import(o, first.x[i], &outcome, &error);
    eo_optimizer_import(o, first.x[i], &outcome, &error);
  }
  const int imported = (first.rows + 1) / 2;
  ok(eo_optimizer_rows(o) == imported && eo_optimizer_row(o, 0).imported, "%s: %d rows are imported, none twice", name,
     imported);
  finish(o, &plainly, INT32_MAX, &second);
  ok(count_twins(&second) == 0 && second.counters.true_evaluations == second.rows - imported,
     "%s: no imported row is asked for again", name);
  const double inside[N] = {0.5, 0.5, 0.5, 0.25}, outside[N] = {0.5, 1.5, 0.5, 0.5};
  const struct eo_outcome outcome = {.value = 1};
  ok(eo_optimizer_import(o, inside, &outcome, &error) == EO_ERROR_INPUT,
     "%s: an import after the first row is refused: %s", name, error.text);
  eo_optimizer_free(o);
  make(&s, &o, &error);
  ok(eo_optimizer_import(o, outside, &outcome, &error) == EO_ERROR_INPUT,
     "%s: an import outside the cube is refused: %s", name, error.text);
  ok(eo_optimizer_ask(o, &batch, &error) == EO_OK && eo_optimizer_ask(o, &batch, &error) == EO_ERROR_INPUT,
     "%s: asking twice is refused: %s", name, error.text);
  ok(eo_optimizer_tell(o, batch.count, &outcome, &error) == EO_ERROR_INPUT,
     "%s: the answer to another question is refused: %s", name, error.text);
  eo_optimizer_free(o);
}

/* The value of a failed evaluation is never looked at, and nothing is predicted from it. */
static void test_failures(int algorithm)
{
  const char *name = eo_optimizer_algorithm_name(algorithm);
  const struct eo_optimizer_settings s = settings_of(algorithm);
  struct how how = {.threads = 1, .fail_below = 0.4, .failed_value = NAN};
  ok(run_with(&s, &how, &first), "%s: a run in which a part of the space fails ends", name);
  int failed = 0;
  for (int i = 0; i < first.rows; i++)
    failed += first.failed[i];
  ok(failed > 0 && !first.failed[first.best] && first.x[first.best][0] >= 0.4,
     "%s: %d of %d rows failed, the best did not", name, failed, first.rows);
  how.failed_value = -1e9;
  ok(run_with(&s, &how, &second) && same(&first, &second), "%s: what a failed evaluation returns plays no part", name);
  how.fail_below = 2;
  const bool ended = run_with(&s, &how, &second);
  ok(ended && second.best == -1 && second.counters.predicted == 0,
     "%s: when all fail there is no best and no prediction (%d rows)", name, second.rows);
}

/* ga is fpga that never predicts. */
static void test_family(void)
{
  struct eo_optimizer_settings s = settings_of(EO_GA), apart = s;
  apart.true_evaluations = s.true_evaluations = 0;
  apart.mutation = 1, apart.mutation_index = 0; /* every gene, so far that no child lies as near as the region below */
  run_with(&apart, &plainly, &first);
  apart.algorithm = EO_FPGA;
  apart.share_radius = 1e-6;
  run_with(&apart, &plainly, &second);
  ok(same(&first, &second), "fpga with an empty region is ga");
  run_with(&s, &plainly, &first);
  s.algorithm = EO_FPGA;
  ok(first.counters.individuals == s.population * s.generations, "the search has %d individuals",
     first.counters.individuals);
  s.share_radius = 0.1;
  run_with(&s, &plainly, &second);
  ok(second.counters.fitness_computed < 0.8 * first.counters.fitness_computed,
     "fpga computes less: PFC %.3f against %.3f", second.counters.fitness_computed, first.counters.fitness_computed);
  s.decision_order = EO_ORDER_SEQUENTIAL;
  static struct run sequential;
  const bool ended = run_with(&s, &plainly, &sequential);
  ok(ended && !same(&second, &sequential) && count_twins(&sequential) == 0 &&
         sequential.counters.individuals == s.population * s.generations,
     "the sequential order of the paper runs: PFC %.3f", sequential.counters.fitness_computed);
}

static void test_quality(void)
{
  struct eo_optimizer_settings s = settings_of(EO_CREDIBILITY_GA), ga = settings_of(EO_GA);
  double won = 0;
  ga.generations = 200;
  ga.true_evaluations = 1000;
  s.true_evaluations = 150;
  for (s.seed = ga.seed = 1; s.seed <= 5; s.seed = ++ga.seed) {
    run_with(&s, &plainly, &first);
    run_with(&ga, &plainly, &second);
    won += first.value[first.best] <= second.value[second.best];
  }
  ok(won >= 4, "credibility-ga with 150 evaluations beats ga with 1000: %g of 5 seeds", won);
}

static void test_front(void)
{
  const struct eo_optimizer_settings s = settings_of(EO_NSGA2);
  static int front[ROWS_MAX];
  static double point[ROWS_MAX * OBJECTIVES];
  const double reference[OBJECTIVES] = {1.2, 2.2};
  struct eo_optimizer *o = NULL;
  struct eo_error error;
  make(&s, &o, &error);
  finish(o, &plainly, INT32_MAX, &first);
  const struct eo_front f = eo_optimizer_front(o, front);
  bool rising = true, feasible = true, knee = false, weighted = false;
  for (int i = 0; i < f.count; i++) {
    const struct eo_row row = eo_optimizer_row(o, front[i]);
    feasible = feasible && row.violation == 0;
    rising = rising && (i == 0 || row.objectives[1] < eo_optimizer_row(o, front[i - 1]).objectives[1]);
    knee |= front[i] == f.knee;
    weighted |= front[i] == f.weighted;
    memcpy(point + (size_t)i * OBJECTIVES, row.objectives, sizeof(double[OBJECTIVES]));
  }
  ok(f.count > 20 && rising, "the front has %d rows and none dominates another", f.count);
  ok(feasible, "all rows of the front are feasible");
  ok(knee && weighted, "knee and weighted optimum stand on the front");
  /* The true front is f2 = (1 - f1)^2 for f1 in 0..1. Volume below the reference: 1.2 * 2.2 less the area under it. */
  const double ideal = 1.2 * 2.2 - 1.0 / 3, volume = hypervolume(point, f.count, OBJECTIVES, reference);
  ok(volume > 0.985 * ideal && volume <= ideal, "the hypervolume of the front is %.4f of %.4f", volume, ideal);
  eo_optimizer_free(o);
}

static void refused(struct eo_optimizer_settings s, const char *pointer)
{
  struct eo_optimizer *o = NULL;
  struct eo_error error = {0};
  ok(make(&s, &o, &error) == EO_ERROR_INPUT && !o && strcmp(error.pointer, pointer) == 0,
     "the settings are refused: %s %s", error.pointer, error.text);
}

/* Whether the check answers so, a refusal at this pointer; thresholds that only contradict each other are sound. */
static bool answers(const struct eo_optimizer_settings *s, const char *pointer, enum eo_code wanted)
{
  struct eo_error error = {0};
  enum eo_code code = eo_optimizer_settings_check(s, &error);
  bool contradiction = code && strstr(error.text, "trust threshold");
  bool good = contradiction ? !wanted : code == wanted && (!code || strcmp(error.pointer, pointer) == 0);
  if (!good)
    printf("# %s: %s\n", pointer, error.text);
  return good;
}

static void test_bad_settings(void)
{
  const struct eo_optimizer_settings good = settings_of(EO_FPGA);
  struct eo_optimizer_settings s = good;
  s.removal_threshold = s.trust_threshold;
  refused(s, "/optimization/removal_threshold");
  s = good, s.population = 3;
  refused(s, "/optimization/population");
  s = good, s.crossover = 1.01;
  refused(s, "/optimization/crossover");
  s = good, s.mutation = NAN;
  refused(s, "/optimization/mutation");
  s = good, s.generations = 0;
  refused(s, "/optimization/generations");
  s = good, s.elite = s.population = 8;
  refused(s, "/optimization/elite");
  s = good, s.variables = 0;
  refused(s, "/optimization/variables");
  s = good, s.algorithm = 9;
  refused(s, "/optimization/algorithm");
  s = good, s.algorithm = EO_NSGA2, s.objectives = 99;
  refused(s, "/optimization/objectives");
  ok(eo_optimizer_algorithm_find("credibility-ga") == EO_CREDIBILITY_GA && eo_optimizer_algorithm_find("x") == -1,
     "algorithms are found by name");
  close_to((s = good, s.share_radius = NAN, s.variables = 5, eo_optimizer_share_radius(&s)), 0.03, 1e-12,
           "sharing radius r_share of 5 variables");
  close_to((s.variables = 10, eo_optimizer_share_radius(&s)), 0.11, 0.003, "sharing radius r_share of 10 variables");
}

/* Every row of the list: its default lies in its range, and what the range excludes is refused at its key. */
static void test_list(void)
{
  struct eo_optimizer_settings s, standard;
  int wrong = 0, rows = 0;
  eo_optimizer_defaults(&standard, EO_NSGA2, 5);
#define CHECK_VALUE(member, value, code) \
  s = standard, s.member = (value);      \
  wrong += !answers(&s, "/optimization/" #member, code);
#define CHECK(member, low, high, ...)          \
  rows++;                                      \
  CHECK_VALUE(member, low, EO_OK)              \
  CHECK_VALUE(member, high, EO_OK)             \
  CHECK_VALUE(member, (low)-1, EO_ERROR_INPUT) \
  CHECK_VALUE(member, (high) + 1, EO_ERROR_INPUT)
#define CHECK_BUDGET(member, low, high, ...) CHECK(member, 0, high)
#define CHECK_CHOICE(member, names, standard, ...) CHECK(member, 0, !names[2] ? 1 : 99)
#define SKIP(...) rows++;
  EO_OPTIMIZER_SETTINGS(SKIP, CHECK_BUDGET, CHECK, CHECK, CHECK, SKIP, CHECK_CHOICE)
  ok(wrong == 0 && rows == 44 && answers(&standard, "", EO_OK), "%d settings keep to their ranges", rows);
}

static void test_algorithm(int algorithm)
{
  test_repeatable(algorithm);
  test_accounts(algorithm);
  test_resume(algorithm);
  test_import(algorithm);
  test_failures(algorithm);
}

int main(void)
{
  for (int algorithm = 0; algorithm < EO_ALGORITHMS; algorithm++)
    test_algorithm(algorithm);
  described = true;
  test_algorithm(EO_CREDIBILITY_GA);
  test_algorithm(EO_GA); /* which does not look at it */
  described = false;
  test_family();
  test_quality();
  test_front();
  test_bad_settings();
  test_list();
  return tap_done();
}
