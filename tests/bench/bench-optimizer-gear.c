/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Optimizers on the real objective of the paper's pair, Case A (5 variables, both ends alike) and Case B (10): J after
   100, 200, 400 and all of 1000 true evaluations (--budget), beside NLopt's and pagmo's when they are there.

     bench-optimizer-gear [--quick] [--front] [--seeds N] [--case a|b] [--plain] [--coarse] [--budget N] [--target
   VALUE] [--algorithm NAME] [--set KEY=NUMBER]... [--cache DIR]

   --front: Pareto fronts of the three objectives in those of the unmodified pair. --plain: without tip edge contact,
   three teeth in the sector, no coupling between neighbours.
   --coarse: a third of the positions, cells and harmonics: an objective of the same kind in a fraction of the time. */
#include "contest.h"
#include "document/design_document.h"
#include "document/examples.h"
#include "evaluation/analysis.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct gear {
  struct eo_design design;
  struct eo_pair *pair;
  struct eo_analysis *analysis;
  int ends; /* that have their own variables */
};

static double lerp(double low, double high, double x)
{
  return low + (high - low) * x;
}

/* Bounds of the paper where it gives them, else the design document's defaults. */
static void set_flank(struct eo_flank_modification *flank, const double *x)
{
  flank->tip_relief = lerp(0, 40e-6, x[0]);
  flank->root_relief = lerp(0, 40e-6, x[1]);
  flank->tip_relief_start = lerp(0.3e-3, 4.5e-3, x[2]);
  flank->root_relief_start = lerp(0.3e-3, 5.2e-3, x[3]);
  flank->lead_crowning = lerp(0, 36e-6, x[4]);
}

static void evaluate(struct gear *gear, const double *x)
{
  struct eo_error error;
  for (int end = 0; end < 2; end++)
    set_flank(&gear->design.modification.flank[EO_PINION][end], x + (gear->ends == 2 ? 5 * end : 0));
  if (eo_analysis_run(gear->analysis, &gear->design, 0, &error) != EO_OK) {
    fprintf(stderr, "%s\n", error.text);
    exit(1);
  }
}

static double value(void *context, const double *x)
{
  struct gear *gear = context;
  evaluate(gear, x);
  const double objective = gear->analysis->value.objective;
  return isfinite(objective) && !gear->analysis->value.sums.failed ? objective : INFINITY;
}

/* The three in those of the unmodified pair. */
static void objectives(void *context, const double *x, double *f)
{
  struct gear *gear = context;
  evaluate(gear, x);
  for (int i = 0; i < CONTEST_OBJECTIVES; i++)
    f[i] = gear->analysis->value.sums.failed
               ? INFINITY
               : gear->analysis->value.sums.f[i] / gear->analysis->unmodified_value.sums.f[i];
}

static void prepare(struct trace *trace, const struct contest_problem *problem, uint64_t seed)
{
  struct gear *gear = (struct gear *)problem->detail;
  (void)seed;
  gear->ends = problem->n / 5;
  trace->value = value;
  trace->objectives = objectives;
  trace->context = gear;
}

static enum eo_code prepare_gear(struct gear *gear, bool plain, bool coarse, const char *cache, struct eo_error *error)
{
  struct eo_geometry geometry;
  const struct eo_pair_options options = {.cache_directory = cache};
  if (!eo_example_build("paper", &gear->design))
    return eo_error_set(error, EO_ERROR_INPUT, "", "The example is missing.");
  if (plain) {
    gear->design.resolution.tip_edge_contact = false;
    gear->design.resolution.sector_teeth = 3;
    gear->design.resolution.neighbour_coupling = false;
  }
  if (coarse) {
    gear->design.resolution.positions = 24;
    gear->design.resolution.cells_per_line = 8;
    gear->design.resolution.harmonics = gear->design.resolution.te_harmonics = 12;
  }
  enum eo_code code = eo_design_complete(&gear->design, &geometry, error);
  if (code == EO_OK)
    code = eo_pair_new(&gear->pair, &gear->design, &options, NULL, error);
  return code == EO_OK ? eo_analysis_new(&gear->analysis, gear->pair, error) : code;
}

int main(int argc, char **argv)
{
  static struct gear gear;
  struct contest contest = contest_default();
  struct eo_error error;
  const char *cache = NULL;
  char only = '\0';
  bool plain = false, coarse = false;
  for (int i = 1; i < argc; i++) {
    const int taken = contest_option(&contest, argc, argv, i);
    if (strcmp(argv[i], "--plain") == 0)
      plain = true;
    else if (strcmp(argv[i], "--coarse") == 0)
      coarse = true;
    else if (!taken && i + 1 < argc && strcmp(argv[i], "--case") == 0)
      only = argv[++i][0];
    else if (!taken && i + 1 < argc && strcmp(argv[i], "--cache") == 0)
      cache = argv[++i];
    i += taken > 1;
  }
  if (prepare_gear(&gear, plain, coarse, cache, &error) != EO_OK) {
    fprintf(stderr, "%s\n", error.text);
    return 2;
  }
  const struct contest_problem a = {"gear-a", 5, prepare, &gear}, b = {"gear-b", 10, prepare, &gear};
  contest_print_head(&contest);
  if (only != 'b')
    contest_run(&contest, &a);
  if (only != 'a')
    contest_run(&contest, &b);
  eo_analysis_free(gear.analysis);
  eo_pair_free(gear.pair);
  return 0;
}
