/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/made_check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "design/design_grids.h"
#include "document/scatter_document.h"
#include "evaluation/evaluator.h"
#include "evaluation/objective_terms.h"

struct bench {
  struct eo_evaluator *evaluator;
  struct eo_design *tried, *made; /* as designed, as it comes out */
  struct eo_objective_case *raw;  /* [2][cases]: as designed, unmodified */
};

struct work {
  struct eo_made_check *check;
  const struct eo_made_plan *plan;
  struct eo_modification unmodified;
  struct eo_design *nominal; /* the plan's, its objective of one state; the pairs at hand in its `drawn` */
  int first;                 /* of these */
  struct bench bench[EO_MAX_THREADS];
};

static enum eo_code prepare_bench(struct work *work, struct bench *bench, struct eo_error *error)
{
  int cases = work->nominal->load_cases;
  bench->tried = malloc(sizeof *bench->tried);
  bench->made = malloc(sizeof *bench->made);
  bench->raw = malloc(2 * sizeof *bench->raw * (size_t)cases);
  if (!bench->tried || !bench->made || !bench->raw)
    return eo_error_memory(error);
  return eo_evaluator_new(&bench->evaluator, work->plan->pair, cases, error);
}

static enum eo_code evaluate(const struct work *work, struct bench *bench, int pair,
                             const struct eo_modification *modification, struct eo_objective_case *raw,
                             struct eo_error *error)
{
  const struct eo_evaluation *evaluation;
  struct eo_scenario scenario;
  memcpy(bench->tried, work->nominal, sizeof *bench->tried);
  bench->tried->modification = *modification;
  eo_drawn_pair_apply(bench->tried, pair, bench->made, &scenario);
  EO_TRY(eo_evaluator_run(bench->evaluator, bench->made, &scenario, 0, &evaluation, error));
  memcpy(raw, evaluation->objective, sizeof *raw * (size_t)evaluation->cases);
  return EO_OK;
}

static bool is_worse(int cases, const struct eo_objective_case *raw, const struct eo_objective_case *before)
{
  bool worse = false;
  for (int k = 0; k < cases; k++)
    worse = worse || raw[k].peak_to_peak > before[k].peak_to_peak || raw[k].impact > before[k].impact ||
            raw[k].rms > before[k].rms;
  return worse;
}

static void note(const struct work *work, const struct bench *bench, int design, int pair)
{
  struct eo_made_check *check = work->check;
  const struct eo_design *nominal = work->nominal;
  int cases = nominal->load_cases;
  const struct eo_objective_case *before = bench->raw + cases, *raw = design ? bench->raw : before;
  double *value = check->value + ((size_t)design * (size_t)check->pairs + (size_t)pair) * (size_t)check->numbers;
  struct eo_objective_value of;
  eo_objective_value(&nominal->objective, cases, nominal->load_case, raw, before, false, &of);
  bool there = !of.sums.failed && isfinite(of.objective);
  value[0] = there ? of.objective : NAN;
  for (int i = 0; i < 3; i++)
    value[1 + i] = there ? of.sums.f[i] : NAN;
  for (int i = 0; i < nominal->objective.terms; i++)
    value[EO_MADE_SUMS + i] = there ? of.term[i] : NAN;
  check->worse[(size_t)design * (size_t)check->pairs + (size_t)pair] = design && is_worse(cases, raw, before);
}

static enum eo_code run_pair(void *context, int thread, int item, struct eo_error *error)
{
  struct work *work = context;
  struct bench *bench = &work->bench[thread];
  EO_TRY(evaluate(work, bench, item, &work->unmodified, bench->raw + work->nominal->load_cases, error));
  note(work, bench, 0, work->first + item);
  for (int i = 1; i < work->check->designs; i++) {
    EO_TRY(evaluate(work, bench, item, work->plan->modification[i - 1], bench->raw, error));
    note(work, bench, i, work->first + item);
  }
  return EO_OK;
}

/* Percentiles in the objective are those of one pair here: the numbers themselves. */
static enum eo_code prepare_nominal(struct work *work, struct eo_error *error)
{
  struct eo_design *nominal = work->nominal = malloc(sizeof *nominal);
  if (!nominal)
    return eo_error_memory(error);
  memcpy(nominal, work->plan->design, sizeof *nominal);
  nominal->objective.robust = EO_ROBUST_OFF;
  for (int i = 0; i < nominal->objective.terms; i++)
    nominal->objective.term[i].percent = NAN;
  for (int i = 0; i < nominal->objective.limits; i++)
    nominal->objective.limit[i].percent = NAN;
  nominal->drawn.first = 0;
  work->unmodified = eo_design_unmodified(nominal);
  return EO_OK;
}

static enum eo_code run(struct work *work, struct eo_error *error)
{
  struct eo_made_check *check = work->check;
  int threads = work->plan->threads > 0 ? work->plan->threads : eo_parallel_cores();
  size_t rows = (size_t)check->designs * (size_t)check->pairs;
  check->value = malloc(sizeof *check->value * rows * (size_t)check->numbers);
  check->worse = calloc(rows, sizeof *check->worse);
  if (!check->value || !check->worse)
    return eo_error_memory(error);
  EO_TRY(prepare_nominal(work, error));
  threads = threads < check->pairs ? threads : check->pairs;
  for (int i = 0; i < threads; i++)
    EO_TRY(prepare_bench(work, &work->bench[i], error));
  for (work->first = 0; work->first < check->pairs; work->first += EO_MAX_DRAWN_PAIRS) {
    int left = check->pairs - work->first, count = left < EO_MAX_DRAWN_PAIRS ? left : EO_MAX_DRAWN_PAIRS;
    EO_TRY(eo_scatter_draw_range(work->nominal, check->skipped + work->first, count, check->skipped + check->pairs,
                                 error));
    EO_TRY(eo_parallel_run(&(struct eo_parallel){.threads = threads,
                                                 .work = run_pair,
                                                 .context = work,
                                                 .progress = work->plan->progress,
                                                 .what = "pairs as made",
                                                 .first = (double)work->first / check->pairs,
                                                 .last = (double)(work->first + count) / check->pairs},
                           count, error));
  }
  return EO_OK;
}

enum eo_code eo_made_check_run(struct eo_made_check *check, const struct eo_made_plan *plan, struct eo_error *error)
{
  *check = (struct eo_made_check){.designs = plan->designs + 1,
                                  .pairs = plan->pairs,
                                  .numbers = EO_MADE_SUMS + plan->design->objective.terms,
                                  .skipped = plan->design->drawn.pairs,
                                  .name = {"unmodified"}};
  struct work *work = calloc(1, sizeof *work);
  if (!work)
    return eo_error_memory(error);
  for (int i = 0; i < plan->designs; i++)
    snprintf(check->name[i + 1], sizeof *check->name, "%s", plan->name[i]);
  work->check = check;
  work->plan = plan;
  enum eo_code code = run(work, error);
  for (int i = 0; i < EO_MAX_THREADS; i++) {
    eo_evaluator_free(work->bench[i].evaluator);
    free(work->bench[i].tried);
    free(work->bench[i].made);
    free(work->bench[i].raw);
  }
  free(work->nominal);
  free(work);
  return code;
}
