/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/design_scatter.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"

/* What each thread has of its own. */
struct bench {
  struct eo_evaluator *evaluator;
  struct eo_design *design; /* the nominal one with the values of a pair in it */
};

struct work {
  struct eo_scatter_run *run;
  const struct eo_pair *pair;
  const struct eo_design *design;
  const struct eo_scatter *scatter;
  const struct eo_scatter_plan *plan;
  const struct eo_sampler *sampler;
  struct bench *bench; /* [threads] */
  pthread_mutex_t keeping;
};

/* No more than the numbers take: root stress and vibration where they are asked for. */
static enum eo_code evaluate(const struct work *work, struct bench *bench, const struct eo_scenario *scenario,
                             double *output, struct eo_error *error)
{
  const struct eo_evaluation *evaluation;
  const struct eo_scalar *scalar;
  bool root = work->plan->root_stress, vibration = work->plan->vibration || root;
  if (vibration)
    EO_TRY(eo_evaluator_run(bench->evaluator, bench->design, scenario, root ? EO_WANT_ROOT : 0, &evaluation, error));
  else
    EO_TRY(eo_evaluator_contact_at(bench->evaluator, bench->design, scenario, &evaluation, error));
  for (int i = 0; (scalar = eo_scalar_at(i)); i++)
    for (int k = 0; k < work->run->cases; k++) {
      bool asked = (vibration || !(scalar->needs & EO_SCALAR_VIBRATION)) && (root || !(scalar->needs & EO_SCALAR_ROOT));
      output[i * work->run->cases + k] = asked ? eo_scalar_value(scalar, evaluation, k) : NAN;
    }
  return EO_OK;
}

static enum eo_code keep(struct work *work, int pair, const double *output, struct eo_error *error)
{
  const struct eo_scatter_log *log = &work->plan->log;
  if (!log->keep)
    return EO_OK;
  pthread_mutex_lock(&work->keeping);
  enum eo_code code = log->keep(log->context, pair, output, error);
  pthread_mutex_unlock(&work->keeping);
  return code;
}

static enum eo_code run_pair(void *context, int thread, int pair, struct eo_error *error)
{
  struct work *work = context;
  struct eo_scatter_run *run = work->run;
  struct bench *bench = &work->bench[thread];
  double *output = run->output + (size_t)pair * (size_t)run->outputs;
  const struct eo_scatter_log *log = &work->plan->log;
  struct eo_scenario scenario = {NAN, NAN, 1, 1};
  if (log->find && log->find(log->context, pair, output))
    return EO_OK;
  memcpy(bench->design, work->design, sizeof *bench->design);
  eo_scatter_apply(work->scatter, run->input + (size_t)pair * (size_t)run->inputs, bench->design, &scenario.compliance,
                   &scenario.speed);
  EO_TRY(evaluate(work, bench, &scenario, output, error));
  return keep(work, pair, output, error);
}

static enum eo_code allocate(struct eo_scatter_run *run, const struct work *work, struct eo_error *error)
{
  size_t pairs = (size_t)work->plan->pairs;
  run->pairs = work->plan->pairs;
  run->inputs = work->scatter->inputs;
  run->cases = work->design->load_cases;
  while (eo_scalar_at(run->scalars))
    run->scalars++;
  run->outputs = run->scalars * run->cases;
  run->input = malloc(sizeof *run->input * pairs * (size_t)run->inputs);
  run->output = malloc(sizeof *run->output * pairs * (size_t)run->outputs);
  run->nominal = malloc(sizeof *run->nominal * (size_t)run->outputs);
  return run->input && run->output && run->nominal ? EO_OK : eo_error_memory(error);
}

static enum eo_code make_benches(struct work *work, int threads, struct eo_error *error)
{
  work->bench = calloc((size_t)threads, sizeof *work->bench);
  if (!work->bench)
    return eo_error_memory(error);
  for (int i = 0; i < threads; i++) {
    work->bench[i].design = malloc(sizeof *work->bench[i].design);
    if (!work->bench[i].design)
      return eo_error_memory(error);
    EO_TRY(eo_evaluator_new(&work->bench[i].evaluator, work->pair, work->design->load_cases, error));
  }
  return EO_OK;
}

static void drop_benches(struct work *work, int threads)
{
  for (int i = 0; i < threads && work->bench; i++) {
    eo_evaluator_free(work->bench[i].evaluator);
    free(work->bench[i].design);
  }
  free(work->bench);
}

/* Draws every pair, evaluates the nominal one, then all. */
static enum eo_code run_all(struct work *work, int threads, const struct eo_progress *progress, struct eo_error *error)
{
  struct eo_scatter_run *run = work->run;
  for (int i = 0; i < run->pairs; i++)
    run->bounded += eo_scatter_draw(work->scatter, work->sampler, i, run->input + (size_t)i * (size_t)run->inputs);
  memcpy(work->bench[0].design, work->design, sizeof *work->design);
  EO_TRY(evaluate(work, &work->bench[0], NULL, run->nominal, error));
  return eo_parallel_run(&(struct eo_parallel){.threads = threads,
                                               .work = run_pair,
                                               .context = work,
                                               .progress = progress,
                                               .what = "pairs as made",
                                               .first = 0,
                                               .last = 1},
                         run->pairs, error);
}

enum eo_code eo_scatter_run_pairs(struct eo_scatter_run *run, const struct eo_pair *pair,
                                  const struct eo_design *design, const struct eo_scatter *scatter,
                                  const struct eo_scatter_plan *plan, const struct eo_progress *progress,
                                  struct eo_error *error)
{
  struct eo_sampler *sampler = NULL;
  struct work work = {.run = run, .pair = pair, .design = design, .scatter = scatter, .plan = plan};
  int threads = plan->threads ? plan->threads : eo_parallel_cores();
  *run = (struct eo_scatter_run){0};
  if (plan->pairs < 1 || plan->pairs > EO_SCATTER_MOST_PAIRS)
    return eo_error_set(error, EO_ERROR_INPUT, "/tolerance/pairs", "%d pairs are outside 1 .. %d.", plan->pairs,
                        EO_SCATTER_MOST_PAIRS);
  EO_TRY(eo_sampler_new(&sampler, plan->sampling, scatter->dimensions, plan->pairs, plan->seed, error));
  work.sampler = sampler;
  pthread_mutex_init(&work.keeping, NULL);
  threads = threads < plan->pairs ? threads : plan->pairs;
  enum eo_code code = allocate(run, &work, error);
  if (!code)
    code = make_benches(&work, threads, error);
  if (!code)
    code = run_all(&work, threads, progress, error);
  drop_benches(&work, threads);
  pthread_mutex_destroy(&work.keeping);
  eo_sampler_free(sampler);
  return code;
}

void eo_scatter_run_done(struct eo_scatter_run *run)
{
  if (!run)
    return;
  free(run->input);
  free(run->output);
  free(run->nominal);
  *run = (struct eo_scatter_run){0};
}
