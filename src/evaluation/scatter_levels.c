/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/scatter_levels.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The coarse grid: a third of the positions and harmonics; teeth of their own are looked at at a third of these
   positions. What that leaves of the numbers' order among pairs, and what it costs: theory, Gears as made. */
enum { COARSE_POSITIONS = 24, COARSE_HARMONICS = 12, COARSE_TEETH = 8 };

/* Cells of a line on it. Pairs in full: at first, evenly spread as the first points are, in each round behind, and with
   the rounds at most; pairs from which on it pays. One with teeth of its own takes eight times as long as on the coarse
   level, so that this has more cells, few are in full, and the rounds end where the intervals still have something of
   it in them. Where the progress stands when the coarse rows are there, and in full where as many as expected are done.
 */
enum { MOST_ROUNDS_FOR_LARGEST = 8 };
static const struct levels {
  int cells, first, more, most, fewest;
  double coarse_fraction, expected;
} MESH_CYCLE = {10, 64, 16, INT_MAX, 160, 0.7, 160}, HUNTING_PERIOD = {14, 16, 8, 32, 64, 0.78, 36};

/* How far the completion may leave the 95 % percentile of what decides open: its standard deviation over the value. */
static const double WELL_KNOWN = 0.01;
static const double DECIDING_PERCENT = 95;

static const struct levels *levels_of(const struct eo_design *design)
{
  return design->tolerance.single_teeth ? &HUNTING_PERIOD : &MESH_CYCLE;
}

/* A pinion that is held along its axis couples the teeth of both ends. */
static bool ends_float(const struct eo_design *design)
{
  return design->gear_pair.ends == 1 || design->alignment.pinion_axial == EO_AXIAL_FLOATING ||
         design->alignment.pinion_axial == EO_AXIAL_STOPS;
}

bool eo_scatter_is_coarse_first(const struct eo_design *design)
{
  const struct eo_tolerance_settings *settings = &design->tolerance;
  const struct levels *levels = levels_of(design);
  bool teeth = settings->single_teeth,
       can = !settings->root_stress && !eo_gear_pair_is_uneven(&design->gear_pair) && settings->pairs >= levels->fewest;
  bool pays = settings->pairs >= EO_COARSE_FIRST_FROM && design->resolution.positions >= 2 * COARSE_POSITIONS;
  return can && (!teeth || ends_float(design)) &&
         (settings->method == EO_SCATTER_COARSE_FIRST || (settings->method == EO_SCATTER_AUTO && (teeth || pays)));
}

static void at_most(int *value, int most)
{
  *value = *value < most ? *value : most;
}

/* Positions of a mesh cycle at which teeth of their own are looked at: a divisor of those of the grid. */
static int coarse_divisor(int positions)
{
  int divisor = positions < COARSE_TEETH ? positions : COARSE_TEETH;
  while (positions % divisor)
    divisor--;
  return divisor;
}

void eo_scatter_make_coarse(struct eo_design *coarse, const struct eo_design *design)
{
  memcpy(coarse, design, sizeof *coarse);
  at_most(&coarse->resolution.positions, COARSE_POSITIONS);
  at_most(&coarse->resolution.cells_per_line, levels_of(design)->cells);
  at_most(&coarse->resolution.harmonics, COARSE_HARMONICS);
  at_most(&coarse->resolution.te_harmonics, COARSE_POSITIONS / 2);
  if (!design->tolerance.single_teeth)
    return;
  coarse->pitch.level = EO_TEETH_SKETCHED;
  coarse->pitch.positions = coarse_divisor(coarse->resolution.positions);
}

enum eo_code eo_scatter_coarse_pair(struct eo_pair **coarse, const struct eo_pair *pair, const struct eo_design *design,
                                    const struct eo_progress *progress, struct eo_error *error)
{
  const struct eo_pair_options options = {.kernel = pair->kernel};
  struct eo_design *own = malloc(sizeof *own);
  if (!own)
    return eo_error_memory(error);
  eo_scatter_make_coarse(own, design);
  enum eo_code code = eo_pair_new(coarse, own, &options, progress, error);
  free(own);
  return code;
}

struct eo_completion eo_scatter_completion(const struct eo_scatter_run *run, const struct eo_design *design)
{
  return (struct eo_completion){run->pairs, run->outputs, run->coarse, run->output, run->full, design->tolerance.seed};
}

int eo_scatter_full_pairs(const struct eo_scatter_run *run)
{
  int count = 0;
  for (int i = 0; i < run->pairs; i++)
    count += run->full[i];
  return count;
}

/* What goes on between the rounds. */
struct rounds {
  struct eo_scatter_run *run;
  const struct eo_design *design;
  struct eo_completion completion;
  eo_scatter_compute *compute;
  void *context;
  int *pair;              /* [pairs], of a stage */
  double *share, *weight; /* [pairs] */
  const struct levels *levels;
  int decide; /* outputs by which the pairs in full are chosen */
  int deciding[EO_MAX_LOAD_CASES * EO_ALL_SCALARS];
};

static void add_deciding(struct rounds *rounds, int scalar, int load_case)
{
  int output = scalar * rounds->run->cases + load_case;
  for (int i = 0; i < rounds->decide; i++)
    if (rounds->deciding[i] == output)
      return;
  rounds->deciding[rounds->decide++] = output;
}

/* Outputs that are limited; swing and RMS in any case, of the hunting period where teeth are single. */
static void find_deciding(struct rounds *rounds)
{
  const struct eo_tolerance_settings *settings = &rounds->design->tolerance;
  bool teeth = settings->single_teeth;
  for (int k = 0; k < rounds->run->cases; k++) {
    add_deciding(rounds, eo_scalar_find(teeth ? "period_peak_to_peak_um" : "peak_to_peak_um"), k);
    if (settings->vibration)
      add_deciding(rounds, eo_scalar_find(teeth ? "period_rms_m_per_s2" : "rms_m_per_s2"), k);
    for (int i = 0; i < settings->limits; i++) {
      int scalar = eo_scalar_find(settings->limit[i].output);
      if (scalar >= 0 && scalar < rounds->run->scalars &&
          (settings->limit[i].load_case == 0 || settings->limit[i].load_case == k + 1))
        add_deciding(rounds, scalar, k);
    }
  }
}

static enum eo_code complete(struct rounds *rounds, struct eo_error *error)
{
  for (int i = 0; i < rounds->run->outputs; i++)
    EO_TRY(eo_completion_fill(&rounds->completion, i, &rounds->run->completed[i], error));
  return EO_OK;
}

static double progress_at(const struct levels *levels, int full)
{
  return levels->coarse_fraction + (1 - levels->coarse_fraction) * fmin(1, full / levels->expected);
}

/* The first `count` of rounds->pair. */
static enum eo_code compute_in_full(struct rounds *rounds, int count, struct eo_error *error)
{
  int before = eo_scatter_full_pairs(rounds->run);
  for (int i = 0; i < count; i++)
    rounds->run->full[rounds->pair[i]] = true;
  const struct eo_scatter_stage stage = {false, count, rounds->pair, progress_at(rounds->levels, before),
                                         progress_at(rounds->levels, before + count)};
  EO_TRY(rounds->compute(rounds->context, &stage, error));
  return complete(rounds, error);
}

/* The first points, and pairs of which the coarse level knows nothing. */
static int choose_first(struct rounds *rounds)
{
  const struct eo_scatter_run *run = rounds->run;
  int count = 0;
  for (int i = 0; i < run->pairs; i++)
    if (i < rounds->levels->first || isnan(run->coarse[(size_t)i * (size_t)run->outputs + (size_t)rounds->deciding[0]]))
      rounds->pair[count++] = i;
  return count;
}

/* Those of which it matters most for the percentiles that are not well known on which side they lie. */
static enum eo_code choose_next(struct rounds *rounds, int *count, struct eo_error *error)
{
  const struct eo_scatter_run *run = rounds->run;
  bool open = false;
  *count = 0;
  memset(rounds->weight, 0, sizeof *rounds->weight * (size_t)run->pairs);
  for (int i = 0; i < rounds->decide; i++) {
    struct eo_doubt doubt;
    EO_TRY(
        eo_completion_doubt(&rounds->completion, rounds->deciding[i], DECIDING_PERCENT, &doubt, rounds->share, error));
    double by = doubt.deviation / (WELL_KNOWN * fabs(doubt.value));
    if (!(by > 1) || isinf(by))
      continue;
    open = true;
    for (int pair = 0; pair < run->pairs; pair++)
      rounds->weight[pair] += by * by * rounds->share[pair];
  }
  while (open && *count < rounds->levels->more) {
    int best = 0;
    for (int pair = 1; pair < run->pairs; pair++)
      best = rounds->weight[pair] > rounds->weight[best] ? pair : best;
    if (!(rounds->weight[best] > 0))
      break;
    rounds->weight[best] = 0;
    rounds->pair[(*count)++] = best;
  }
  return EO_OK;
}

/* Pairs that have the largest number of something that decides and are not in full yet. */
static int choose_largest(struct rounds *rounds)
{
  const struct eo_scatter_run *run = rounds->run;
  int count = 0;
  for (int i = 0; i < rounds->decide; i++) {
    int best = -1;
    double largest = -INFINITY;
    bool there = false;
    for (int pair = 0; pair < run->pairs; pair++) {
      double value = run->output[(size_t)pair * (size_t)run->outputs + (size_t)rounds->deciding[i]];
      if (value > largest) {
        largest = value;
        best = pair;
      }
    }
    for (int k = 0; k < count; k++)
      there |= rounds->pair[k] == best;
    if (best >= 0 && !run->full[best] && !there)
      rounds->pair[count++] = best;
  }
  return count;
}

static enum eo_code run_rounds(struct rounds *rounds, struct eo_error *error)
{
  struct eo_scatter_run *run = rounds->run;
  int count, pairs = run->pairs;
  for (int i = 0; i < pairs; i++)
    rounds->pair[i] = i;
  const struct eo_scatter_stage coarse = {true, pairs, rounds->pair, 0, rounds->levels->coarse_fraction};
  EO_TRY(rounds->compute(rounds->context, &coarse, error));
  memset(run->full, 0, sizeof *run->full * (size_t)pairs);
  EO_TRY(compute_in_full(rounds, choose_first(rounds), error));
  while (eo_scatter_full_pairs(run) + rounds->levels->more <= rounds->levels->most) {
    EO_TRY(choose_next(rounds, &count, error));
    if (count == 0)
      break;
    EO_TRY(compute_in_full(rounds, count, error));
  }
  for (int i = 0; i < MOST_ROUNDS_FOR_LARGEST; i++) {
    count = choose_largest(rounds);
    if (count == 0)
      break;
    EO_TRY(compute_in_full(rounds, count, error));
  }
  return EO_OK;
}

static enum eo_code run_all(struct rounds *rounds, struct eo_error *error)
{
  for (int i = 0; i < rounds->run->pairs; i++)
    rounds->pair[i] = i;
  const struct eo_scatter_stage stage = {false, rounds->run->pairs, rounds->pair, 0, 1};
  return rounds->compute(rounds->context, &stage, error);
}

enum eo_code eo_scatter_run_levels(struct eo_scatter_run *run, const struct eo_design *design,
                                   eo_scatter_compute *compute, void *context, struct eo_error *error)
{
  size_t pairs = (size_t)run->pairs;
  struct rounds *rounds = calloc(1, sizeof *rounds);
  if (!rounds)
    return eo_error_memory(error);
  rounds->run = run;
  rounds->design = design;
  rounds->levels = levels_of(design);
  rounds->completion = eo_scatter_completion(run, design);
  rounds->compute = compute;
  rounds->context = context;
  rounds->pair = malloc(sizeof *rounds->pair * pairs);
  rounds->share = malloc(sizeof *rounds->share * pairs);
  rounds->weight = malloc(sizeof *rounds->weight * pairs);
  find_deciding(rounds);
  enum eo_code code = rounds->pair && rounds->share && rounds->weight ? EO_OK : eo_error_memory(error);
  if (!code)
    code = run->coarse ? run_rounds(rounds, error) : run_all(rounds, error);
  free(rounds->pair);
  free(rounds->share);
  free(rounds->weight);
  free(rounds);
  return code;
}
