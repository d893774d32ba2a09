/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/design_scatter.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/parallel.h"
#include "design/made_teeth.h"
#include "evaluation/pitch_analysis.h"
#include "evaluation/scatter_levels.h"

struct eo_scatter_bench {
  const struct eo_design *nominal; /* borrowed, like the scatter */
  const struct eo_scatter *scatter;
  bool vibration, root_stress;
  struct eo_pair_distances *distances; /* borrowed */
  const struct eo_pair *pair;          /* of them, what the evaluator works on */
  struct eo_evaluator *evaluator;
  struct eo_design *design; /* the nominal one with the values of a pair in it */
  enum eo_teeth_level level;
};

/* Few pairs, or all in full as asked for, have every instant of their hunting period solved. */
static enum eo_teeth_level level_of(const struct eo_design *design)
{
  return design->pitch.level == EO_TEETH_SOLVED && design->tolerance.single_teeth && eo_scatter_is_coarse_first(design)
             ? EO_TEETH_FOLLOWED
             : design->pitch.level;
}

/* An evaluator for the pair at the distance of bench->design. What it would keep from one run for the next is of no use
   where every pair differs. */
static enum eo_code take_distance(struct eo_scatter_bench *bench, struct eo_error *error)
{
  const struct eo_pair *pair;
  EO_TRY(eo_pair_distances_find(bench->distances, bench->design->alignment.centre_distance_deviation, &pair, error));
  if (pair == bench->pair)
    return EO_OK;
  eo_evaluator_free(bench->evaluator);
  bench->evaluator = NULL;
  bench->pair = NULL;
  EO_TRY(eo_evaluator_new(&bench->evaluator, pair, bench->nominal->load_cases, error));
  bench->pair = pair;
  return EO_OK;
}

enum eo_code eo_scatter_bench_new(struct eo_scatter_bench **result, struct eo_pair_distances *distances,
                                  const struct eo_design *design, const struct eo_scatter *scatter, bool vibration,
                                  bool root_stress, struct eo_error *error)
{
  struct eo_scatter_bench *bench = calloc(1, sizeof *bench);
  if (!bench)
    return eo_error_memory(error);
  bench->distances = distances;
  bench->nominal = design;
  bench->scatter = scatter;
  bench->vibration = vibration || root_stress;
  bench->root_stress = root_stress;
  bench->level = level_of(design);
  bench->design = malloc(sizeof *bench->design);
  if (!bench->design) {
    eo_scatter_bench_free(bench);
    return eo_error_memory(error);
  }
  *result = bench;
  return EO_OK;
}

void eo_scatter_bench_free(struct eo_scatter_bench *bench)
{
  if (!bench)
    return;
  eo_evaluator_free(bench->evaluator);
  free(bench->design);
  free(bench);
}

int eo_scatter_outputs(const struct eo_design *design)
{
  return (design->tolerance.single_teeth ? EO_ALL_SCALARS : EO_SCALARS) * design->load_cases;
}

/* Of a scalar, where what it needs was asked for. */
static double number_of(const struct eo_scatter_bench *bench, const struct eo_scalar *scalar,
                        const struct eo_evaluation *evaluation, const struct eo_pitch_analysis *pitch, int load_case)
{
  if ((scalar->needs & EO_SCALAR_VIBRATION && !bench->vibration) ||
      (scalar->needs & EO_SCALAR_ROOT && !bench->root_stress))
    return NAN;
  return scalar->needs & EO_SCALAR_TEETH ? eo_scalar_of_period(scalar, &pitch->load_case[load_case])
                                         : eo_scalar_value(scalar, evaluation, load_case);
}

/* The hunting period of the pair that was run, where it has teeth of its own, and all numbers of the row. */
static enum eo_code count_numbers(struct eo_scatter_bench *bench, const struct eo_scenario *scenario,
                                  const struct eo_evaluation *evaluation, double *output, struct eo_error *error)
{
  struct eo_pitch_analysis pitch = {0};
  const struct eo_pitch_question question = {.design = bench->design,
                                             .compliance_factor = scenario->compliance,
                                             .speed_factor = scenario->speed,
                                             .root = bench->root_stress,
                                             .vibration = bench->vibration,
                                             .threads = 1};
  int cases = bench->nominal->load_cases, outputs = eo_scatter_outputs(bench->nominal);
  enum eo_code code = bench->nominal->tolerance.single_teeth
                          ? eo_pitch_analysis_run(&pitch, bench->evaluator, &question, error)
                          : EO_OK;
  for (int i = 0; i < outputs && !code; i++)
    output[i] = number_of(bench, eo_scalar_at(i / cases), evaluation, &pitch, i % cases);
  eo_pitch_analysis_done(&pitch);
  return code;
}

/* No more than the numbers take: root stress and vibration where they are asked for. */
enum eo_code eo_scatter_bench_run(struct eo_scatter_bench *bench, const double *input, double *output,
                                  struct eo_error *error)
{
  const struct eo_evaluation *evaluation;
  struct eo_scenario scenario = {NAN, NAN, 1, 1};
  memcpy(bench->design, bench->nominal, sizeof *bench->design);
  bench->design->pitch.level = bench->level;
  eo_design_state_teeth(bench->design);
  if (input)
    eo_scatter_apply(bench->scatter, input, bench->design, &scenario.compliance, &scenario.speed);
  EO_TRY(take_distance(bench, error));
  const struct eo_scenario *chosen = input ? &scenario : NULL;
  if (bench->vibration)
    EO_TRY(eo_evaluator_run(bench->evaluator, bench->design, chosen, bench->root_stress ? EO_WANT_ROOT : 0, &evaluation,
                            error));
  else
    EO_TRY(eo_evaluator_contact_at(bench->evaluator, bench->design, chosen, &evaluation, error));
  return count_numbers(bench, &scenario, evaluation, output, error);
}

struct work {
  struct eo_scatter_run *run;
  const struct eo_scatter_plan *plan;
  const struct eo_progress *progress;
  int threads;
  struct eo_scatter_bench *bench[EO_MAX_THREADS], *coarse_bench[EO_MAX_THREADS]; /* owned */
  struct eo_design *coarse;                                                      /* the design at that level; owned */
  struct eo_pair *coarse_pair;                                                   /* owned */
  struct eo_pair_distances *distances, *coarse_distances;                        /* owned */
  const struct eo_scatter_stage *stage;
  pthread_mutex_t keeping;
};

static enum eo_code keep(struct work *work, int pair, const double *output, double cost, struct eo_error *error)
{
  const struct eo_scatter_log *log = &work->plan->log;
  if (!log->keep)
    return EO_OK;
  pthread_mutex_lock(&work->keeping);
  enum eo_code code = log->keep(log->context, pair, output, cost, error);
  pthread_mutex_unlock(&work->keeping);
  return code;
}

static enum eo_code run_pair(void *context, int thread, int item, struct eo_error *error)
{
  struct work *work = context;
  struct eo_scatter_run *run = work->run;
  int pair = work->stage->pair[item];
  const double *input = run->input + (size_t)pair * (size_t)run->inputs;
  size_t row = (size_t)pair * (size_t)run->outputs;
  const struct eo_scatter_log *log = &work->plan->log;
  if (work->stage->coarse)
    return eo_scatter_bench_run(work->coarse_bench[thread], input, run->coarse + row, error);
  if (log->find && log->find(log->context, pair, run->output + row))
    return EO_OK;
  double start = eo_clock_thread_seconds();
  EO_TRY(eo_scatter_bench_run(work->bench[thread], input, run->output + row, error));
  return keep(work, pair, run->output + row, eo_clock_thread_seconds() - start, error);
}

static enum eo_code run_stage(void *context, const struct eo_scatter_stage *stage, struct eo_error *error)
{
  struct work *work = context;
  work->stage = stage;
  return eo_parallel_run(&(struct eo_parallel){.threads = work->threads < stage->count ? work->threads : stage->count,
                                               .work = run_pair,
                                               .context = work,
                                               .progress = work->progress,
                                               .what = EO_SCATTER_PROGRESS,
                                               .first = stage->first,
                                               .last = stage->last},
                         stage->count, error);
}

static enum eo_code allocate(struct eo_scatter_run *run, const struct eo_design *design,
                             const struct eo_scatter *scatter, int count, struct eo_error *error)
{
  size_t pairs = (size_t)count;
  run->pairs = count;
  run->inputs = scatter->inputs;
  run->cases = design->load_cases;
  run->outputs = eo_scatter_outputs(design);
  run->scalars = run->outputs / run->cases;
  run->input = malloc(sizeof *run->input * pairs * (size_t)run->inputs);
  run->output = malloc(sizeof *run->output * pairs * (size_t)run->outputs);
  run->nominal = malloc(sizeof *run->nominal * (size_t)run->outputs);
  run->full = malloc(sizeof *run->full * pairs);
  if (!run->input || !run->output || !run->nominal || !run->full)
    return eo_error_memory(error);
  for (size_t i = 0; i < pairs; i++)
    run->full[i] = true;
  if (!eo_scatter_is_coarse_first(design))
    return EO_OK;
  run->coarse = malloc(sizeof *run->coarse * pairs * (size_t)run->outputs);
  run->completed = calloc((size_t)run->outputs, sizeof *run->completed);
  return run->coarse && run->completed ? EO_OK : eo_error_memory(error);
}

enum eo_code eo_scatter_run_draw(struct eo_scatter_run *run, const struct eo_design *design,
                                 const struct eo_scatter *scatter, const struct eo_scatter_plan *plan,
                                 struct eo_error *error)
{
  struct eo_sampler *sampler = NULL;
  *run = (struct eo_scatter_run){0};
  if (plan->pairs < 1 || plan->pairs > EO_SCATTER_MOST_PAIRS)
    return eo_error_set(error, EO_ERROR_INPUT, "/tolerance/pairs", "%d pairs are outside 1 .. %d.", plan->pairs,
                        EO_SCATTER_MOST_PAIRS);
  EO_TRY(eo_sampler_new(&sampler, plan->sampling, scatter->dimensions, plan->pairs, plan->seed, error));
  enum eo_code code = allocate(run, design, scatter, plan->pairs, error);
  for (int i = 0; !code && i < run->pairs; i++)
    run->bounded += eo_scatter_draw(scatter, sampler, i, run->input + (size_t)i * (size_t)run->inputs);
  eo_sampler_free(sampler);
  return code;
}

static enum eo_code make_benches(struct work *work, const struct eo_pair *pair, const struct eo_design *design,
                                 const struct eo_scatter *scatter, struct eo_error *error)
{
  const struct eo_scatter_plan *plan = work->plan;
  EO_TRY(eo_pair_distances_new(&work->distances, pair, plan->root_stress, error));
  for (int i = 0; i < work->threads; i++)
    EO_TRY(eo_scatter_bench_new(&work->bench[i], work->distances, design, scatter, plan->vibration, plan->root_stress,
                                error));
  if (!work->run->coarse)
    return EO_OK;
  work->coarse = malloc(sizeof *work->coarse);
  if (!work->coarse)
    return eo_error_memory(error);
  eo_scatter_make_coarse(work->coarse, design);
  EO_TRY(eo_scatter_coarse_pair(&work->coarse_pair, pair, design, work->progress, error));
  EO_TRY(eo_pair_distances_new(&work->coarse_distances, work->coarse_pair, plan->root_stress, error));
  for (int i = 0; i < work->threads; i++)
    EO_TRY(eo_scatter_bench_new(&work->coarse_bench[i], work->coarse_distances, work->coarse, scatter, plan->vibration,
                                plan->root_stress, error));
  return EO_OK;
}

static void work_done(struct work *work)
{
  for (int i = 0; i < EO_MAX_THREADS; i++) {
    eo_scatter_bench_free(work->bench[i]);
    eo_scatter_bench_free(work->coarse_bench[i]);
  }
  eo_pair_distances_free(work->coarse_distances);
  eo_pair_distances_free(work->distances);
  eo_pair_free(work->coarse_pair);
  free(work->coarse);
  pthread_mutex_destroy(&work->keeping);
}

/* The nominal pair first, then all. */
enum eo_code eo_scatter_run_pairs(struct eo_scatter_run *run, const struct eo_pair *pair,
                                  const struct eo_design *design, const struct eo_scatter *scatter,
                                  const struct eo_scatter_plan *plan, const struct eo_progress *progress,
                                  struct eo_error *error)
{
  struct work work = {.run = run, .plan = plan, .progress = progress};
  EO_TRY(eo_scatter_run_draw(run, design, scatter, plan, error));
  work.threads = plan->threads ? plan->threads : eo_parallel_cores();
  work.threads = work.threads < plan->pairs ? work.threads : plan->pairs;
  pthread_mutex_init(&work.keeping, NULL);
  enum eo_code code = make_benches(&work, pair, design, scatter, error);
  if (!code)
    code = eo_scatter_bench_run(work.bench[0], NULL, run->nominal, error);
  if (!code)
    code = eo_scatter_run_levels(run, design, run_stage, &work, error);
  work_done(&work);
  return code;
}

void eo_scatter_run_done(struct eo_scatter_run *run)
{
  if (!run)
    return;
  free(run->input);
  free(run->output);
  free(run->nominal);
  free(run->full);
  free(run->coarse);
  free(run->completed);
  *run = (struct eo_scatter_run){0};
}
