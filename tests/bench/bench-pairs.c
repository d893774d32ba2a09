/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pairs as made, coarse first against all in full: percentiles of swing and RMS, and the processor time of both in
   plain evaluations of the design as a search makes them, taken in turns in the same run. With --first-only the pairs
   are not computed in full, which takes hours where a design has "single_teeth": true.

     bench-pairs [--pairs N] [--seed N] [--cache DIR] [--first-only] DESIGN.json... */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/sort.h"
#include "document/design_document.h"
#include "document/scatter_document.h"
#include "document/tolerance_document.h"
#include "evaluation/scatter_levels.h"
#include "tolerance/statistics.h"

enum { PLAIN = 60, MOST_PAIRS = 20000 };

static struct eo_error error;

static void stop(void)
{
  printf("%s: %s\n", error.pointer, error.text);
  exit(1);
}

static double processor_seconds(void)
{
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Seconds of one: every flank moves by up to a micrometre, alike where the flanks are. */
static double plain_evaluation(const struct eo_pair *pair, const struct eo_design *design, int round)
{
  struct eo_evaluator *evaluator;
  const struct eo_evaluation *evaluation;
  struct eo_design *own = malloc(sizeof *own);
  if (!own || eo_evaluator_new(&evaluator, pair, design->load_cases, &error))
    stop();
  double start = processor_seconds();
  for (int i = 0; i < PLAIN; i++) {
    *own = *design;
    for (int k = 0; k < 4; k++) {
      struct eo_flank_modification *flank = &own->modification.flank[k / 2][k % 2];
      flank->lead_crowning += 1e-7 * ((7 * i + 3 * round) % 10);
      flank->tip_relief += flank->tip_relief > 0 ? 1e-7 * (3 * i % 10) : 0;
    }
    if (eo_evaluator_run(evaluator, own, NULL, 0, &evaluation, &error))
      stop();
  }
  double seconds = processor_seconds() - start;
  eo_evaluator_free(evaluator);
  free(own);
  return seconds / PLAIN;
}

static double run_pairs(struct eo_scatter_run *run, const struct eo_pair *pair, struct eo_design *design,
                        const struct eo_scatter *scatter, int method)
{
  struct eo_scatter_plan plan = eo_tolerance_plan(&design->tolerance);
  design->tolerance.method = method;
  plan.threads = 1;
  double start = processor_seconds();
  if (eo_scatter_run_pairs(run, pair, design, scatter, &plan, NULL, &error))
    stop();
  return processor_seconds() - start;
}

static double percentile_of(const struct eo_scatter_run *run, int output, double percent)
{
  static double sorted[MOST_PAIRS];
  int rows = 0;
  for (int i = 0; i < run->pairs; i++) {
    sorted[rows] = run->output[(size_t)i * (size_t)run->outputs + (size_t)output];
    rows += isfinite(sorted[rows]);
  }
  eo_sort_numbers(rows, sorted);
  return eo_percentile(rows, sorted, percent);
}

/* The largest difference of a percentile over the load cases, per cent. */
static void print_differences(const struct eo_scatter_run *few, const struct eo_scatter_run *all)
{
  static const char *const cycle[] = {"peak_to_peak_um",  "rms_m_per_s2", "impact_N",
                                      "max_pressure_MPa", "K_Hbeta",      NULL},
                           *const period[] = {"period_peak_to_peak_um",
                                              "period_rms_m_per_s2",
                                              "pinion_order_um",
                                              "gear_order_um",
                                              "sideband_um",
                                              "tooth_load_N",
                                              "tooth_pressure_MPa",
                                              NULL};
  static const double percents[] = {50, 90, 95, 99};
  const char *const *outputs = all->scalars == EO_ALL_SCALARS ? period : cycle;
  for (size_t i = 0; outputs[i]; i++) {
    printf("  %s", outputs[i]);
    for (size_t p = 0; p < sizeof percents / sizeof *percents; p++) {
      double largest = 0;
      for (int k = 0; k < all->cases; k++) {
        int output = eo_scalar_find(outputs[i]) * all->cases + k;
        double of_all = percentile_of(all, output, percents[p]);
        double off = 100 * (percentile_of(few, output, percents[p]) / of_all - 1);
        largest = fabs(off) > fabs(largest) ? off : largest;
      }
      printf(" %+.2f", largest);
    }
  }
  printf("\n");
}

static void compare(const char *file, int pairs, int seed, const char *cache, bool first_only)
{
  static struct eo_design design;
  static struct eo_scatter scatter;
  struct eo_geometry geometry;
  struct eo_faults faults = {0};
  struct eo_pair *pair = NULL;
  struct eo_scatter_run few, all = {0};
  const struct eo_pair_options options = {.cache_directory = cache};
  json_t *document = json_load_file(file, 0, NULL);
  if (!document || !eo_design_decode(document, &design, NULL, &faults)) {
    printf("%s: %s\n", file, document ? faults.fault[0].text : "no JSON document");
    exit(1);
  }
  json_decref(document);
  design.tolerance.pairs = pairs;
  design.tolerance.seed = (uint64_t)seed;
  if (eo_design_complete(&design, &geometry, &error) || eo_pair_new(&pair, &design, &options, NULL, &error) ||
      eo_scatter_of_design(&scatter, &design, true, NULL, &error))
    stop();
  double plain = plain_evaluation(pair, &design, 0),
         first = run_pairs(&few, pair, &design, &scatter, EO_SCATTER_COARSE_FIRST);
  plain += plain_evaluation(pair, &design, 1);
  double full = first_only ? 0 : run_pairs(&all, pair, &design, &scatter, EO_SCATTER_FULL);
  plain = (plain + plain_evaluation(pair, &design, 2)) / 3;
  printf("%s: plain %.2f ms; coarse first %d in full, %.0f plain evaluations", file, 1e3 * plain,
         eo_scatter_full_pairs(&few), first / plain);
  if (first_only)
    printf("\n");
  else {
    printf("; all in full %.0f; percentiles 50 90 95 99, %% off:", full / plain);
    print_differences(&few, &all);
  }
  fflush(stdout);
  eo_scatter_run_done(&few);
  eo_scatter_run_done(&all);
  eo_pair_free(pair);
}

int main(int argc, char **argv)
{
  int pairs = 1000, seed = 1;
  const char *cache = NULL;
  bool first_only = false;
  for (int i = 1; i < argc; i++)
    if (i + 1 < argc && strcmp(argv[i], "--pairs") == 0)
      pairs = atoi(argv[++i]);
    else if (i + 1 < argc && strcmp(argv[i], "--seed") == 0)
      seed = atoi(argv[++i]);
    else if (i + 1 < argc && strcmp(argv[i], "--cache") == 0)
      cache = argv[++i];
    else if (strcmp(argv[i], "--first-only") == 0)
      first_only = true;
    else
      compare(argv[i], pairs < MOST_PAIRS ? pairs : MOST_PAIRS, seed, cache, first_only);
  return 0;
}
