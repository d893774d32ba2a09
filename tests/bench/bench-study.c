/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Wall time of searches on the paper pair, and what of it is not the model: bench-study [CACHE-DIRECTORY
   [GENERATIONS]]. Prints: case, algorithm, J, true evaluations, individuals, PFC, seconds, and the shares of optimizer
   and history. */
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <unistd.h>

#include "base/parallel.h"
#include "document/design_document.h"
#include "document/examples.h"
#include "study/study.h"

static const struct {
  enum eo_algorithm algorithm;
  int budget;
} searches[] = {{EO_FPGA, 0}, {EO_GA, 0}, {EO_CREDIBILITY_GA, 400}, {EO_CREDIBILITY_GA, 1000}, {EO_NSGA2, 400}};
enum { SEARCHES = sizeof searches / sizeof searches[0] };

static struct eo_error error;

static void fail(const char *what)
{
  fprintf(stderr, "%s: %s\n", what, error.text);
  exit(1);
}

static void forget(const char *folder)
{
  static const char *const names[] = {"easeoff.db", "easeoff.db-wal", "easeoff.db-shm", "easeoff.lock"};
  char name[300];
  for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
    snprintf(name, sizeof name, "%s/%s", folder, names[i]);
    unlink(name);
  }
}

/* Each from nothing. */
static void search(const struct eo_design *design, const struct eo_pair *pair, const char *folder, const char *name)
{
  struct eo_study_plan plan = {.design = design, .pair = pair};
  const char *algorithm = eo_optimizer_algorithm_name(design->optimization.search.algorithm);
  struct eo_study_result r;
  forget(folder);
  if (eo_store_open(&plan.store, folder, EO_STORE_WRITE, &error) || eo_study_run(&plan, &r, &error))
    fail(algorithm);
  double overhead = r.seconds - r.model_seconds;
  printf("%-4s %-15s %8.4f %6d %6d %6.1f %8.2f %6.1f %6.1f %6.1f\n", name, algorithm, r.best.value.objective,
         r.true_evaluations, r.individuals, 100. * r.true_evaluations / r.individuals, r.seconds,
         100 * r.optimizer_seconds / r.seconds, 100 * r.store_seconds / r.seconds, 100 * overhead / r.seconds);
  fflush(stdout);
  eo_study_result_done(&r);
  eo_store_close(plan.store);
}

int main(int argc, char **argv)
{
  static struct eo_design design;
  struct eo_geometry geometry;
  struct eo_pair *pair = NULL;
  const struct eo_pair_options options = {.cache_directory = argc > 1 ? argv[1] : NULL};
  char folder[] = "/tmp/easeoff-bench-XXXXXX";
  struct rusage usage;
  eo_example_build("paper", &design);
  if (!mkdtemp(folder) || eo_design_complete(&design, &geometry, &error) ||
      eo_pair_new(&pair, &design, &options, NULL, &error))
    fail("preparation");
  printf("%d threads\ncase algorithm              J   true indiv.  PFC %%        s  opt %%  hist %%  all but the model "
         "%%\n",
         eo_parallel_cores());
  for (int which = 0; which < 2; which++)
    for (int i = 0; i < SEARCHES; i++) {
      eo_example_build("paper", &design);
      design.optimization.variables = which ? EO_VARIABLES_PER_END : EO_VARIABLES_SHARED;
      design.optimization.search.algorithm = (int)searches[i].algorithm;
      design.optimization.search.true_evaluations = searches[i].budget;
      if (argc > 2)
        design.optimization.search.generations = atoi(argv[2]);
      if (eo_design_complete(&design, &geometry, &error))
        fail("design");
      search(&design, pair, folder, which ? "B" : "A");
    }
  getrusage(RUSAGE_SELF, &usage);
  printf("largest memory %ld MB\n", usage.ru_maxrss / 1024);
  forget(folder);
  rmdir(folder);
  eo_pair_free(pair);
  return 0;
}
