/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which pairs are computed in full: responses in closed form in the place of an evaluation, over all 600 pairs. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/sort.h"
#include "base/random.h"
#include "document/design_document.h"
#include "document/examples.h"
#include "evaluation/scatter_levels.h"
#include "support/tap.h"
#include "tolerance/statistics.h"

enum { PAIRS = 600 };

/* Response of a swing to two standard normal inputs, at a level. */
typedef double response_function(const struct eo_scatter_run *run, int pair, bool coarse);

struct bench {
  struct eo_scatter_run *run;
  response_function *swing;
  int stages, in_full, twice;
  bool seen[PAIRS];
};

static double normal_of(const struct eo_scatter_run *run, int pair, int input)
{
  return run->input[pair * run->inputs + input];
}

static double linear(const struct eo_scatter_run *run, int pair, bool coarse)
{
  double response = 10 + 1.2 * normal_of(run, pair, 0) + 1.6 * normal_of(run, pair, 1);
  return coarse ? 0.9 * response : response;
}

/* Of what the coarse level knows a half. */
static double half_known(const struct eo_scatter_run *run, int pair, bool coarse)
{
  return 10 + 2 * normal_of(run, pair, 0) + (coarse ? 0 : 2 * normal_of(run, pair, 1));
}

static double unknown(const struct eo_scatter_run *run, int pair, bool coarse)
{
  return coarse ? eo_random_unit(eo_random_at(1, 2, 3, (uint64_t)pair), 0) : 10 + 5 * normal_of(run, pair, 0);
}

static double broken(const struct eo_scatter_run *run, int pair, bool coarse)
{
  return coarse && pair % 100 == 99 ? NAN : linear(run, pair, coarse);
}

static enum eo_code compute(void *context, const struct eo_scatter_stage *stage, struct eo_error *error)
{
  struct bench *bench = context;
  struct eo_scatter_run *run = bench->run;
  double *rows = stage->coarse ? run->coarse : run->output;
  (void)error;
  bench->stages++;
  for (int i = 0; i < stage->count; i++) {
    int pair = stage->pair[i];
    for (int k = 0; k < run->outputs; k++)
      rows[pair * run->outputs + k] = bench->swing(run, pair, stage->coarse);
    bench->in_full += !stage->coarse;
    bench->twice += !stage->coarse && bench->seen[pair];
    bench->seen[pair] |= !stage->coarse;
  }
  return EO_OK;
}

static struct eo_design design_of(int method)
{
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_error error;
  eo_example_build("paper", &design);
  eo_design_complete(&design, &geometry, &error);
  design.tolerance.pairs = PAIRS;
  design.tolerance.method = method;
  return design;
}

/* Two independent standard normals. */
static struct eo_scatter scatter_of_two(void)
{
  struct eo_scatter scatter = {.inputs = 2};
  struct eo_error error;
  for (int i = 0; i < 2; i++)
    scatter.input[i] = (struct eo_scatter_input){
        .unit = 1, .least = -INFINITY, .most = INFINITY, .deviation = {.sigma = 1, .cut = INFINITY}};
  eo_scatter_settle(&scatter, &error);
  return scatter;
}

struct found {
  double percentile, of_all;
  int in_full;
};

static struct found run(int method, response_function *swing)
{
  static struct eo_scatter scatter;
  static double sorted[2][PAIRS];
  struct eo_error error;
  struct eo_scatter_run rows;
  struct eo_design design = design_of(method);
  const struct eo_scatter_plan plan = {.pairs = PAIRS, .seed = 1};
  scatter = scatter_of_two();
  eo_scatter_run_draw(&rows, &design, &scatter, &plan, &error);
  struct bench bench = {.run = &rows, .swing = swing};
  eo_scatter_run_levels(&rows, &design, compute, &bench, &error);
  for (int i = 0; i < PAIRS; i++) {
    sorted[0][i] = rows.output[i * rows.outputs];
    sorted[1][i] = swing(&rows, i, false);
  }
  eo_sort_numbers(PAIRS, sorted[0]);
  eo_sort_numbers(PAIRS, sorted[1]);
  struct found found = {eo_percentile(PAIRS, sorted[0], 95), eo_percentile(PAIRS, sorted[1], 95), bench.in_full};
  ok(bench.twice == 0 && bench.in_full == eo_scatter_full_pairs(&rows),
     "%d pairs are computed in full, none twice, in %d stages", bench.in_full, bench.stages);
  ok(rows.full[PAIRS - 1] || method != EO_SCATTER_FULL, "all pairs are in full where full is asked for");
  close_to(sorted[0][PAIRS - 1], sorted[1][PAIRS - 1], swing == half_known ? 1 : 1e-12,
           "largest number, which is computed in full");
  eo_scatter_run_done(&rows);
  return found;
}

static void test_rounds(void)
{
  struct found found = run(EO_SCATTER_FULL, linear);
  close_to(found.percentile, 10 + 2 * 1.6448536269514722, 0.05, "95 % of a normal");
  found = run(EO_SCATTER_COARSE_FIRST, linear);
  close_to(found.percentile, found.of_all, 1e-12, "95th percentile from a coarse level that knows all");
  ok(found.in_full <= 70, "a coarse level that knows all leaves %d in full", found.in_full);
  int few = found.in_full;
  found = run(EO_SCATTER_AUTO, half_known);
  ok(fabs(found.percentile / found.of_all - 1) < 0.025 && found.in_full > few,
     "a coarse level that knows half gives %.3f, of all %.3f, with %d in full", found.percentile, found.of_all,
     found.in_full);
  found = run(EO_SCATTER_AUTO, unknown);
  ok(fabs(found.percentile / found.of_all - 1) < 0.025 && found.in_full > PAIRS / 2,
     "a coarse level that knows nothing gives %.3f, of all %.3f, with %d in full", found.percentile, found.of_all,
     found.in_full);
  found = run(EO_SCATTER_AUTO, broken);
  close_to(found.percentile, found.of_all, 1e-12, "95th percentile where some pairs have no coarse number");
  ok(found.in_full <= 76, "pairs without a coarse number leave %d in full", found.in_full);
}

static void test_method(void)
{
  struct eo_design design = design_of(EO_SCATTER_AUTO), coarse;
  ok(eo_scatter_is_coarse_first(&design), "600 pairs are coarse first");
  design.resolution.positions = 32;
  ok(!eo_scatter_is_coarse_first(&design), "all pairs are in full on a grid that is hardly finer");
  design.resolution.positions = 64;
  design.tolerance.pairs = EO_COARSE_FIRST_FROM - 1;
  ok(!eo_scatter_is_coarse_first(&design), "fewer pairs are in full from the first");
  design.tolerance.method = EO_SCATTER_COARSE_FIRST;
  ok(eo_scatter_is_coarse_first(&design), "fewer pairs are coarse first where it is asked for");
  design.tolerance.root_stress = true;
  ok(!eo_scatter_is_coarse_first(&design), "pairs with root stress are in full from the first");
  design.tolerance.root_stress = false;
  design.gear_pair.right_face_width = 0.9 * design.gear_pair.face_width;
  ok(!eo_scatter_is_coarse_first(&design), "pairs whose halves differ are in full from the first");
  eo_scatter_make_coarse(&coarse, &design);
  ok(coarse.resolution.positions == 24 && coarse.resolution.cells_per_line == 10,
     "the coarse level has a third of the positions and cells");
}

int main(void)
{
  test_method();
  test_rounds();
  return tap_done();
}
