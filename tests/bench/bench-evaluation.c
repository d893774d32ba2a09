/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Times true evaluations of the paper pair (three torques, default resolution) on finite elements: by stage, for equal
   and different ends, when one value of the modification changes, and on one and two threads; and the memory of a
   worker. Then, for every version of the kernel that this processor can run, the figure of one evaluation: its
   processor time times what one core makes of a product of matrices of the same library in the same run, in Gflop, so
   that it says the same on a slower processor. An argument names a cache directory, a second one the number of repeats.
 */
#include "document/design_document.h"
#include "document/examples.h"
#include "evaluation/evaluator.h"
#include "numerics/gram.h"

#include <cblas.h>
#include <malloc.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { MOST_REPEATS = 1001 };

static int repeats = 41;

struct times {
  double total, contact, impact, dynamics, objective; /* ms */
};

static double now(clockid_t clock)
{
  struct timespec t;
  clock_gettime(clock, &t);
  return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static void stop(const struct eo_error *error)
{
  printf("%s: %s\n", error->pointer, error->text);
  exit(1);
}

static struct eo_design design_of(const char *name, double angle_deg)
{
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_error error;
  eo_example_build(name, &design);
  design.alignment.shaft_angle_in_plane = angle_deg * M_PI / 180;
  if (eo_design_complete(&design, &geometry, &error))
    stop(&error);
  return design;
}

static struct eo_evaluator *make_evaluator(const struct eo_pair *pair)
{
  struct eo_evaluator *evaluator;
  struct eo_error error;
  if (eo_evaluator_new(&evaluator, pair, 3, &error))
    stop(&error);
  return evaluator;
}

static struct times evaluate(struct eo_evaluator *evaluator, const struct eo_pair *pair, const struct eo_design *design,
                             const struct eo_objective_case *unmodified, struct eo_objective_value *value)
{
  const struct eo_evaluation *r;
  struct eo_error error;
  double start = now(CLOCK_THREAD_CPUTIME_ID);
  if (eo_evaluator_run(evaluator, design, NULL, 0, &r, &error))
    stop(&error);
  double combined = now(CLOCK_THREAD_CPUTIME_ID);
  eo_evaluator_combine(design, &pair->geometry, r->objective, unmodified, value);
  double end = now(CLOCK_THREAD_CPUTIME_ID);
  return (struct times){end - start, r->static_ms, r->impact_ms, r->dynamics_ms, end - combined};
}

static int compare(const void *a, const void *b)
{
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double median_of(int n, const struct times *times, size_t offset)
{
  static double value[MOST_REPEATS];
  for (int i = 0; i < n; i++)
    memcpy(&value[i], (const char *)&times[i] + offset, sizeof value[i]);
  qsort(value, (size_t)n, sizeof *value, compare);
  return value[n / 2];
}

#define MEDIAN(member) median_of(repeats, times, offsetof(struct times, member))

/* An end whose inputs have not changed is not computed again, so the pinion's tip relief grows from one evaluation to
   the next: by step[end], m. */
static void change(struct eo_design *design, const double step[2])
{
  for (int end = 0; end < 2; end++)
    design->modification.flank[EO_PINION][end].tip_relief += step[end];
}

static const double both_ends[2] = {1e-12, 1e-12}, left_end[2] = {1e-8, 0};

static void time_design(const char *what, const struct eo_pair *pair, struct eo_design design, const double step[2])
{
  static struct times times[MOST_REPEATS];
  struct eo_evaluator *evaluator = make_evaluator(pair);
  struct eo_design unmodified = design;
  struct eo_objective_case before[3];
  struct eo_objective_value value;
  struct eo_error error;
  memset(&unmodified.modification, 0, sizeof unmodified.modification);
  if (eo_evaluator_raw(evaluator, &unmodified, before, &error))
    stop(&error);
  evaluate(evaluator, pair, &design, before, &value);
  double objective = value.objective;
  for (int i = 0; i < repeats; i++) {
    change(&design, step);
    times[i] = evaluate(evaluator, pair, &design, before, &value);
  }
  printf("%-36s %7.2f %8.2f %7.3f %9.2f %10.4f   J = %.4f\n", what, MEDIAN(total), MEDIAN(contact), MEDIAN(impact),
         MEDIAN(dynamics), MEDIAN(objective), objective);
  fflush(stdout);
  eo_evaluator_free(evaluator);
}

struct worker {
  const struct eo_pair *pair;
  struct eo_design design;
  int evaluations;
};

static void *work(void *argument)
{
  struct worker *w = argument;
  struct eo_evaluator *evaluator = make_evaluator(w->pair);
  const struct eo_evaluation *r;
  struct eo_error error;
  for (int i = 0; i < w->evaluations; i++) {
    change(&w->design, both_ends);
    if (eo_evaluator_run(evaluator, &w->design, NULL, 0, &r, &error))
      stop(&error);
  }
  eo_evaluator_free(evaluator);
  return NULL;
}

static void time_threads(const struct eo_pair *pair, const struct eo_design *design)
{
  double alone = 0;
  for (int threads = 1; threads <= 2; threads++) {
    struct worker worker[2];
    pthread_t thread[2];
    double start = now(CLOCK_MONOTONIC);
    for (int i = 0; i < threads; i++) {
      worker[i] = (struct worker){pair, *design, 2 * repeats};
      pthread_create(&thread[i], NULL, work, &worker[i]);
    }
    for (int i = 0; i < threads; i++)
      pthread_join(thread[i], NULL);
    double rate = 1e3 * threads * 2 * repeats / (now(CLOCK_MONOTONIC) - start);
    alone = threads == 1 ? rate : alone;
    printf("%d thread%s %6.1f evaluations/s, %.2f times one thread\n", threads, threads == 1 ? ": " : "s:", rate,
           rate / alone);
  }
}

static double allocated(void)
{
  struct mallinfo2 info = mallinfo2();
  return 1e-6 * (double)(info.uordblks + info.hblkhd);
}

static void measure_memory(const struct eo_pair *pair, const struct eo_design *design)
{
  double before = allocated();
  struct eo_evaluator *evaluator = make_evaluator(pair);
  const struct eo_evaluation *r;
  struct eo_error error;
  if (eo_evaluator_run(evaluator, design, NULL, EO_WANT_ROOT | EO_WANT_BAND | EO_WANT_CURVES, &r, &error))
    stop(&error);
  printf("a worker holds %.2f MB, what all share %.1f MB\n", allocated() - before, before);
  eo_evaluator_free(evaluator);
}

/* Gflop/s of one core on c = a b of 512 rows. */
static double product_rate(void)
{
  enum { N = 512 };
  static double a[N * N], b[N * N], c[N * N];
  for (int i = 0; i < N * N; i++) {
    a[i] = i % 7 - 3;
    b[i] = i % 5 - 2;
  }
  double start = now(CLOCK_THREAD_CPUTIME_ID);
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, N, N, N, 1, a, N, b, N, 0, c, N);
  return 2e-6 * N * N * N / (now(CLOCK_THREAD_CPUTIME_ID) - start);
}

/* Case A at 0.1 degrees, three torques, two different ends, tip edges, vibration: evaluations and products in turn. */
static void print_figure(const struct eo_pair *pair)
{
  static double spent[MOST_REPEATS], rate[MOST_REPEATS];
  struct eo_design design = design_of("paper-case-a", 0.1);
  struct eo_evaluator *evaluator = make_evaluator(pair);
  const struct eo_evaluation *r;
  struct eo_error error;
  for (int i = 0; i < repeats; i++) {
    change(&design, both_ends);
    double start = now(CLOCK_THREAD_CPUTIME_ID);
    if (eo_evaluator_run(evaluator, &design, NULL, 0, &r, &error))
      stop(&error);
    spent[i] = now(CLOCK_THREAD_CPUTIME_ID) - start;
    rate[i] = product_rate();
  }
  qsort(spent, (size_t)repeats, sizeof *spent, compare);
  qsort(rate, (size_t)repeats, sizeof *rate, compare);
  const char *core = getenv("OPENBLAS_CORETYPE");
  printf("  %-7s %7.2f ms x %6.1f Gflop/s (OpenBLAS for %s) = %.3f Gflop\n", eo_gram_select()->name, spent[repeats / 2],
         rate[repeats / 2], core && *core ? core : "this processor", 1e-3 * spent[repeats / 2] * rate[repeats / 2]);
  eo_evaluator_free(evaluator);
}

/* This program once more, as on a processor that has fewer features. */
static void print_figure_as(const char *features, const char *core, char **argv)
{
  char text[16];
  snprintf(text, sizeof text, "%d", repeats);
  fflush(stdout);
  pid_t child = fork();
  if (child == 0) {
    setenv("GLIBC_TUNABLES", features, 1);
    setenv("OPENBLAS_CORETYPE", core, 1);
    execl("/proc/self/exe", argv[0], argv[1], text, "figure", (char *)NULL);
    _exit(1);
  }
  waitpid(child, NULL, 0);
}

static void print_figures(const struct eo_pair *pair, char **argv)
{
  printf("\none evaluation of case A at 0.1 degrees:\n");
  print_figure(pair);
  if (strcmp(eo_gram_select()->name, "avx512") == 0)
    print_figure_as("glibc.cpu.hwcaps=-AVX512F", "Haswell", argv);
  if (strcmp(eo_gram_select()->name, "plain") != 0)
    print_figure_as("glibc.cpu.hwcaps=-AVX512F,-AVX2", "Nehalem", argv);
}

int main(int argc, char **argv)
{
  struct eo_design aligned = design_of("paper-case-a", 0), tilted = design_of("paper-case-a", 0.1),
                   different = design_of("paper-case-b", 0.1);
  struct eo_design plain = design_of("paper", 0.1);
  struct eo_pair_options options = {.cache_directory = argc > 1 ? argv[1] : NULL};
  struct eo_pair *pair;
  struct eo_error error;
  if (argc > 2)
    repeats = atoi(argv[2]);
  if (repeats < 1 || repeats > MOST_REPEATS) {
    printf("repeats: 1 to %d\n", MOST_REPEATS);
    return 1;
  }
  if (eo_pair_new(&pair, &aligned, &options, NULL, &error))
    stop(&error);
  if (argc > 3) {
    print_figure(pair);
    eo_pair_free(pair);
    return 0;
  }
  printf("preparation %.2f s%s, contact grid of %d positions with up to %d points and %d modes\n", pair->seconds,
         eo_flexibility_report(pair->flexibility)->from_cache ? " (from the cache)" : "", pair->grid->positions,
         pair->grid->most_points, pair->grid->most_rank);
  printf("\nms, medians of %d: processor time, then stages by the clock\n%36s   total  contact  impact  dynamics  "
         "objective\n",
         repeats, "");
  time_design("case A, aligned: equal ends", pair, aligned, both_ends);
  time_design("case A, 0.1 deg", pair, tilted, both_ends);
  time_design("case B, 0.1 deg", pair, different, both_ends);
  time_design("unmodified, 0.1 deg", pair, plain, both_ends);
  time_design("what if: left tip relief + 10 nm", pair, tilted, left_end);
  printf("\n");
  time_threads(pair, &tilted);
  measure_memory(pair, &tilted);
  if (argc > 1)
    print_figures(pair, argv);
  eo_pair_free(pair);
  return 0;
}
