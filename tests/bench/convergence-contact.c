/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How far an evaluation depends on its discretisation, for `make convergence`: one property changed at a time, the
   paper pair with and without modification and shaft error, on finite elements. Deviations are against the finest row
   of each table. Last, whether the default resolution keeps the stated noise: 2 nm of transmission error, 0.5 % of RMS.
   An argument names a cache directory. */
#include "document/design_document.h"
#include "design/resolution.h"
#include "document/examples.h"
#include "evaluation/evaluator.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CASES = 3, FINE_POSITIONS = 256, FINE_CELLS = 80, FINE_EDGE_CELLS = 32 };

static const char *const title[CASES] = {"unmodified", "unmodified, 0.1 deg", "case A, 0.1 deg"};

/* Everything that is varied; the default first. */
struct resolution {
  int positions, cells, edge_cells, harmonics, te_harmonics, stations;
};

struct numbers {
  double mean, peak, stiffness, rms, impact;
  double lte[FINE_POSITIONS]; /* of the pair, m */
  int positions;
};

static struct eo_flexibility *flexibility;

static struct eo_design design_of(int which, const struct resolution *resolution)
{
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_error error;
  eo_example_build(which == 2 ? "paper-case-a" : "paper", &design);
  design.alignment.shaft_angle_in_plane = which ? 0.1 * M_PI / 180 : 0;
  design.load_case[0] = design.load_case[1]; /* 828 N m, 2000 rpm */
  design.load_cases = 1;
  design.load_case[0].share = 1;
  design.resolution.positions = resolution->positions;
  design.resolution.cells_per_line = resolution->cells;
  design.resolution.harmonics = resolution->harmonics;
  design.resolution.te_harmonics = resolution->te_harmonics;
  if (eo_design_complete(&design, &geometry, &error)) {
    printf("%s\n", error.text);
    exit(1);
  }
  return design;
}

static struct numbers evaluate(int which, const struct resolution *resolution)
{
  struct eo_design design = design_of(which, resolution);
  struct eo_contact_grid_settings grid = eo_contact_grid_default(&design.resolution);
  struct eo_pair_options options = {
      .grid = &grid, .impact_stations = resolution->stations, .kernel = eo_flexibility_kernel(flexibility)};
  struct eo_pair *pair = NULL;
  struct eo_evaluator *evaluator = NULL;
  const struct eo_evaluation *r;
  struct eo_error error;
  static struct numbers numbers;
  grid.edge_cells = resolution->edge_cells;
  if (eo_pair_new(&pair, &design, &options, NULL, &error) || eo_evaluator_new(&evaluator, pair, 1, &error) ||
      eo_evaluator_run(evaluator, &design, NULL, 0, &r, &error)) {
    printf("%s\n", error.text);
    exit(1);
  }
  const struct eo_case_result *c = &r->load_case[0];
  numbers = (struct numbers){.mean = c->mean,
                             .peak = c->peak_to_peak,
                             .rms = c->vibration.rms_pair[EO_READING_NORMAL],
                             .impact = r->objective[0].impact,
                             .positions = r->positions};
  for (int j = 0; j < r->positions; j++) {
    numbers.lte[j] = c->transmission[j];
    numbers.stiffness += (c->end[0].loaded.tangent[j] + c->end[1].loaded.tangent[j]) / 2 / r->positions;
  }
  eo_evaluator_free(evaluator);
  eo_pair_free(pair);
  return numbers;
}

/* Largest deviation of the transmission error at the phases both have, mean difference removed, m. */
static double noise_of(const struct numbers *coarse, const struct numbers *fine)
{
  double mean = 0, worst = 0;
  int step = fine->positions / coarse->positions;
  for (int pass = 0; pass < 2; pass++)
    for (int j = 0; j < coarse->positions; j++) {
      double difference = coarse->lte[j] - fine->lte[j * step];
      if (pass == 0)
        mean += difference / coarse->positions;
      else
        worst = fmax(worst, fabs(difference - mean));
    }
  return worst;
}

static double per_cent(double value, double of)
{
  return 100 * (value / of - 1);
}

static void print_row(const char *what, int value, const struct numbers *n, const struct numbers *fine)
{
  printf("  %-14s %4d  LTE %8.4f um %+7.2f nm  noise ", what, value, 1e6 * n->mean, 1e9 * (n->mean - fine->mean));
  if (n->positions <= fine->positions)
    printf("%6.2f nm", 1e9 * noise_of(n, fine));
  else
    printf("%9s", "");
  printf("  PPLTE %7.4f um %+6.2f %%  k_tan %8.2f N/um %+6.3f %%  RMS %7.3f %+6.2f %%  impact %7.1f N %+6.2f %%\n",
         1e6 * n->peak, per_cent(n->peak, fine->peak), 1e-6 * n->stiffness, per_cent(n->stiffness, fine->stiffness),
         n->rms, per_cent(n->rms, fine->rms), n->impact, per_cent(n->impact, fine->impact));
  fflush(stdout);
}

static const struct resolution usual = {64, 30, 12, 24, 16, 0};

/* values: the finest last. */
static void vary(int which, const char *name, size_t offset, int values, const int *value)
{
  struct resolution r = usual;
  int *member = (int *)(void *)((char *)&r + offset);
  *member = value[values - 1];
  struct numbers fine = evaluate(which, &r);
  for (int i = 0; i < values; i++) {
    *member = value[i];
    struct numbers n = i == values - 1 ? fine : evaluate(which, &r);
    print_row(name, value[i], &n, &fine);
  }
}

#define VARY(which, name, member, ...)                                                                          \
  vary(which, name, offsetof(struct resolution, member), (int)(sizeof(const int[]){__VA_ARGS__} / sizeof(int)), \
       (const int[]){__VA_ARGS__})

static void judge(int which)
{
  struct resolution finest = usual;
  finest.positions = 128;
  finest.cells = FINE_CELLS;
  finest.edge_cells = FINE_EDGE_CELLS;
  struct numbers fine = evaluate(which, &finest), n = evaluate(which, &usual);
  double noise = 1e9 * noise_of(&n, &fine), rms = per_cent(n.rms, fine.rms);
  printf("%-22s transmission error %.2f nm (%s 2 nm), RMS %+.2f %% (%s 0.5 %%)\n", title[which], noise,
         noise <= 2 ? "within" : "above", rms, fabs(rms) <= 0.5 ? "within" : "above");
}

int main(int argc, char **argv)
{
  struct eo_design design = design_of(0, &usual);
  struct eo_geometry geometry;
  struct eo_flexibility_settings settings = eo_flexibility_settings_of(&design.resolution);
  struct eo_error error;
  if (eo_geometry_init(&geometry, &design.gear_pair, &error) ||
      eo_flexibility_prepare(&geometry, &design.gear_pair, &design.material, &settings, argc > 1 ? argv[1] : NULL, NULL,
                             &flexibility, &error)) {
    printf("%s\n", error.text);
    return 1;
  }
  printf("Paper pair, 828 N m, 2000 rpm; %d positions, %d cells per line, %d per tip edge, %d harmonics, %d of the "
         "transmission error\n",
         usual.positions, usual.cells, usual.edge_cells, usual.harmonics, usual.te_harmonics);
  for (int which = 0; which < CASES; which++) {
    printf("\n%s\n", title[which]);
    VARY(which, "positions", positions, 32, 64, 128, 256);
    VARY(which, "cells", cells, 20, 30, 40, 80);
    VARY(which, "tip-edge cells", edge_cells, 6, 12, 24, 48);
    VARY(which, "harmonics", harmonics, 10, 16, 24, 40);
    VARY(which, "te harmonics", te_harmonics, 6, 10, 16, 24);
    VARY(which, "stations", stations, 21, 51, 111, 221, 0);
  }
  printf("\nthe default resolution against 128 positions and %d cells:\n", FINE_CELLS);
  for (int which = 0; which < CASES; which++)
    judge(which);
  eo_flexibility_free(flexibility);
  return 0;
}
