/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Times a sweep of 200 speeds and one of 50 torques of a prepared example pair: make bench-sweep, then
   bench-sweep [EXAMPLE [CACHE-DIRECTORY]]. */
#include "document/design_document.h"
#include "document/examples.h"
#include "evaluation/design_sweep.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { SPEEDS = 200, TORQUES = 50, REPEATS = 5 };

static double now(void)
{
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double cpu(void)
{
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void time_sweep(const struct eo_pair *pair, const struct eo_design *design, const char *name,
                       const struct eo_sweep_plan *plan)
{
  double best = 1e9, best_cpu = 1e9;
  int lost = 0;
  for (int i = 0; i < REPEATS; i++) {
    struct eo_sweep sweep;
    struct eo_error error = {0};
    double start = now(), start_cpu = cpu();
    if (eo_sweep_run(&sweep, pair, design, plan, NULL, &error)) {
      printf("%s: %s\n", name, error.text);
      exit(1);
    }
    best = now() - start < best ? now() - start : best;
    best_cpu = cpu() - start_cpu < best_cpu ? cpu() - start_cpu : best_cpu;
    lost = 0;
    for (int v = 0; v < EO_SWEEP_VARIANTS; v++)
      for (int j = 0; j < sweep.torques * sweep.speeds; j++)
        lost += sweep.point[v][EO_SWEEP_UP][j].outcome != EO_VIBRATION_CONVERGED;
    eo_sweep_done(&sweep);
  }
  printf("%-28s %d thread%s  wall %7.3f s  cpu %7.3f s  points not in full contact %d\n", name, plan->threads,
         plan->threads == 1 ? " " : "s", best, best_cpu, lost);
}

int main(int argc, char **argv)
{
  static struct eo_design design;
  struct eo_geometry geometry;
  struct eo_pair *pair;
  struct eo_error error = {0};
  const struct eo_pair_options options = {.cache_directory = argc > 2 ? argv[2] : NULL};
  double speed[SPEEDS], torque[TORQUES];
  if (!eo_example_build(argc > 1 ? argv[1] : "paper", &design) || eo_design_complete(&design, &geometry, &error) ||
      eo_pair_new(&pair, &design, &options, NULL, &error)) {
    printf("No pair: %s\n", error.text);
    return 1;
  }
  printf("preparation %.2f s\n", pair->seconds);
  for (int i = 0; i < SPEEDS; i++)
    speed[i] = (500 + 5500. * i / (SPEEDS - 1)) * M_PI / 30;
  for (int i = 0; i < TORQUES; i++)
    torque[i] = 100 + 1400. * i / (TORQUES - 1);
  for (int threads = 1; threads <= 2; threads++) {
    time_sweep(pair, &design, "200 speeds, with unmodified",
               &(struct eo_sweep_plan){.speeds = SPEEDS, .speed = speed, .threads = threads});
    time_sweep(pair, &design, "50 torques, with unmodified",
               &(struct eo_sweep_plan){.torques = TORQUES, .torque = torque, .threads = threads});
  }
  eo_pair_free(pair);
  return 0;
}
