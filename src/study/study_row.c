/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One row of a study: looked up, computed, saved, weighed. */
#include "study/study_private.h"

#include <math.h>
#include <stdlib.h>

#include "base/clock.h"
#include "evaluation/objective_terms.h"
#include "store/evaluations.h"

void eo_study_weigh(struct study *study, struct eo_study_point *point)
{
  eo_study_weigh_over(study, 0, point);
}

void eo_study_weigh_over(struct study *study, int first, struct eo_study_point *point)
{
  const struct eo_design *design = study->plan->design;
  study->scratch->modification = point->modification;
  study->scratch->drawn.first = first;
  eo_evaluator_combine(study->scratch, &study->plan->pair->geometry, point->raw, study->result->unmodified.raw,
                       &point->value);
  bool normalised = design->objective.normalise == EO_NORMALISE_UNMODIFIED;
  double scale = normalised || !study->result->unmodified.there ? 1 : study->result->unmodified.value.objective;
  point->rank = point->value.sums.failed
                    ? NAN
                    : point->value.objective + design->objective.penalty * point->value.violation * scale;
  point->there = isfinite(point->rank);
}

static void refuse(struct eo_row_data *row, int count, const struct eo_error *error)
{
  row->outcome = EO_EVALUATION_REFUSED;
  snprintf(row->reason, sizeof row->reason, "%.*s", (int)sizeof row->reason - 1, error->text);
  for (int i = 0; i < count; i++)
    row->point.raw[i] = eo_objective_nothing();
}

static void judge(struct eo_row_data *row, int from, int scenarios, int cases)
{
  row->outcome = EO_EVALUATION_CONVERGED;
  row->reason[0] = '\0';
  for (int i = scenarios * cases - 1; i >= from * cases; i--) {
    const struct eo_objective_case *objective_case = &row->point.raw[i];
    if (!objective_case->failed && isfinite(objective_case->peak_to_peak) && isfinite(objective_case->impact) &&
        isfinite(objective_case->rms))
      continue;
    row->outcome = EO_EVALUATION_NOT_CONVERGED;
    snprintf(row->reason, sizeof row->reason, "%s did not converge at load case %d%s.",
             isfinite(objective_case->rms) ? "Contact" : "Vibration or contact", i % cases + 1,
             scenarios > 1 ? " of a scenario" : "");
  }
}

static enum eo_code prepare_worker(struct study *study, struct worker *worker, struct eo_error *error)
{
  if (worker->evaluator)
    return EO_OK;
  if (!worker->design && !(worker->design = malloc(sizeof *worker->design)))
    return eo_error_memory(error);
  *worker->design = *study->plan->design;
  return eo_evaluator_new(&worker->evaluator, study->plan->pair, study->result->cases, error);
}

enum eo_code eo_study_compute_row(struct study *study, struct worker *worker, struct eo_row_data *row, int states,
                                  struct eo_error *error)
{
  struct eo_error found = {0};
  enum eo_code code = prepare_worker(study, worker, error);
  if (code)
    return code;
  double start = eo_clock_thread_seconds();
  worker->design->modification = row->point.modification;
  worker->design->drawn.first = states < study->result->scenarios ? states : 0;
  code = eo_evaluator_raw_from(worker->evaluator, worker->design, row->states, row->point.raw, &found);
  row->cost += eo_clock_thread_seconds() - start;
  if (code && code != EO_ERROR_INPUT && code != EO_ERROR_NUMERIC) {
    *error = found;
    return code;
  }
  if (code)
    refuse(row, states * study->result->cases, &found);
  else
    judge(row, row->states, states, study->result->cases);
  row->states = states;
  row->computed = true;
  return EO_OK;
}

static struct eo_stored_evaluation stored(const struct study *study, struct eo_row_data *row)
{
  struct eo_stored_evaluation evaluation = {.id = row->point.evaluation,
                                            .modification = row->text.data,
                                            .outcome = row->outcome,
                                            .cost = row->cost,
                                            .scenarios = row->states,
                                            .cases = study->result->cases,
                                            .raw = row->point.raw};
  snprintf(evaluation.reason, sizeof evaluation.reason, "%s", row->reason);
  return evaluation;
}

void eo_study_take(struct eo_row_data *row, const struct eo_stored_evaluation *evaluation)
{
  row->point.evaluation = evaluation->id;
  row->outcome = evaluation->outcome;
  row->cost = evaluation->cost;
  snprintf(row->reason, sizeof row->reason, "%s", evaluation->reason);
}

enum eo_code eo_study_look_up(struct study *study, struct eo_row_data *row, struct eo_error *error)
{
  const int states[2] = {study->result->scenarios, study->race.first};
  const int64_t problem[2] = {study->job.problem, study->race.problem};
  for (int i = 0; i < 2 && states[i] > 0 && !row->states; i++) {
    struct eo_stored_evaluation evaluation = stored(study, row);
    evaluation.scenarios = states[i];
    EO_TRY(eo_store_find_evaluation(study->plan->store, problem[i], row->text.data, &evaluation, error));
    if (evaluation.id) {
      eo_study_take(row, &evaluation);
      row->states = states[i];
    }
  }
  return EO_OK;
}

enum eo_code eo_study_save_row(struct study *study, struct eo_row_data *row, struct eo_error *error)
{
  struct eo_stored_evaluation evaluation = stored(study, row);
  int64_t problem = row->states < study->result->scenarios ? study->race.problem : study->job.problem;
  enum eo_code code = eo_store_add_evaluation(study->plan->store, problem, &evaluation, error);
  if (!code)
    eo_study_take(row, &evaluation);
  return code;
}

struct eo_outcome eo_study_outcome(struct study *study, const struct eo_row_data *row,
                                   double objectives[EO_MAX_OBJECTIVES])
{
  eo_front_values(study->plan->design, &row->point.value, &study->result->unmodified.value, objectives);
  if (study->part)
    eo_objective_parts(row->point.raw, study->parted * study->result->cases, study->part);
  double told = eo_race_value(study, row);
  return (struct eo_outcome){.failed = !row->point.there || !isfinite(told),
                             .value = told,
                             .violation = row->point.value.violation,
                             .objectives = objectives,
                             .parts = study->part};
}
