/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One row of a study: looked up, computed, saved, weighed. */
#include "study/study_private.h"

#include <math.h>
#include <stdlib.h>
#include <time.h>

#include "store/evaluations.h"

static double thread_seconds(void)
{
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void eo_study_weigh(struct study *s, struct eo_study_point *point)
{
  const struct eo_design *design = s->plan->design;
  s->scratch->modification = point->modification;
  eo_evaluator_combine(s->scratch, &s->plan->pair->geometry, point->raw, s->result->unmodified.raw, &point->value);
  bool normalised = design->objective.normalise == EO_NORMALISE_UNMODIFIED;
  double scale = normalised || !s->result->unmodified.there ? 1 : s->result->unmodified.value.objective;
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

static void judge(struct eo_row_data *row, int scenarios, int cases)
{
  row->outcome = EO_EVALUATION_CONVERGED;
  row->reason[0] = '\0';
  for (int i = scenarios * cases - 1; i >= 0; i--) {
    const struct eo_objective_case *c = &row->point.raw[i];
    if (!c->failed && isfinite(c->peak_to_peak) && isfinite(c->impact) && isfinite(c->rms))
      continue;
    row->outcome = EO_EVALUATION_NOT_CONVERGED;
    snprintf(row->reason, sizeof row->reason, "%s did not converge at load case %d%s.",
             isfinite(c->rms) ? "Contact" : "Vibration or contact", i % cases + 1,
             scenarios > 1 ? " of a scenario" : "");
  }
}

static enum eo_code prepare_worker(struct study *s, struct worker *w, struct eo_error *error)
{
  if (w->evaluator)
    return EO_OK;
  if (!w->design && !(w->design = malloc(sizeof *w->design)))
    return eo_error_memory(error);
  *w->design = *s->plan->design;
  return eo_evaluator_new(&w->evaluator, s->plan->pair, s->result->cases, error);
}

enum eo_code eo_study_compute_row(struct study *s, struct worker *w, struct eo_row_data *row, struct eo_error *error)
{
  struct eo_error found = {0};
  enum eo_code code = prepare_worker(s, w, error);
  if (code)
    return code;
  double start = thread_seconds();
  w->design->modification = row->point.modification;
  code = eo_evaluator_raw(w->evaluator, w->design, row->point.raw, &found);
  row->cost = thread_seconds() - start;
  if (code && code != EO_ERROR_INPUT && code != EO_ERROR_NUMERIC) {
    *error = found;
    return code;
  }
  if (code)
    refuse(row, s->result->scenarios * s->result->cases, &found);
  else
    judge(row, s->result->scenarios, s->result->cases);
  row->computed = true;
  return EO_OK;
}

static struct eo_stored_evaluation stored(const struct study *s, struct eo_row_data *row)
{
  struct eo_stored_evaluation e = {.id = row->point.evaluation,
                                   .modification = row->text.data,
                                   .outcome = row->outcome,
                                   .cost = row->cost,
                                   .scenarios = s->result->scenarios,
                                   .cases = s->result->cases,
                                   .raw = row->point.raw};
  snprintf(e.reason, sizeof e.reason, "%s", row->reason);
  return e;
}

void eo_study_take(struct eo_row_data *row, const struct eo_stored_evaluation *e)
{
  row->point.evaluation = e->id;
  row->outcome = e->outcome;
  row->cost = e->cost;
  snprintf(row->reason, sizeof row->reason, "%s", e->reason);
}

enum eo_code eo_study_look_up(struct study *s, struct eo_row_data *row, struct eo_error *error)
{
  struct eo_stored_evaluation e = stored(s, row);
  enum eo_code code = eo_store_find_evaluation(s->plan->store, s->job.problem, row->text.data, &e, error);
  if (!code && e.id)
    eo_study_take(row, &e);
  return code;
}

enum eo_code eo_study_save_row(struct study *s, struct eo_row_data *row, struct eo_error *error)
{
  struct eo_stored_evaluation e = stored(s, row);
  enum eo_code code = eo_store_add_evaluation(s->plan->store, s->job.problem, &e, error);
  if (!code)
    eo_study_take(row, &e);
  return code;
}

struct eo_outcome eo_study_outcome(struct study *s, const struct eo_row_data *row, double objectives[3])
{
  const struct eo_objective_sums *own = &row->point.value.sums, *before = &s->result->unmodified.value.sums;
  for (int i = 0; i < 3; i++)
    objectives[i] = before->f[i] > 0 ? own->f[i] / before->f[i] : own->f[i];
  if (s->part)
    eo_objective_parts(row->point.raw, s->row.values, s->part);
  return (struct eo_outcome){.failed = !row->point.there,
                             .value = row->point.rank,
                             .violation = row->point.value.violation,
                             .objectives = objectives,
                             .parts = s->part};
}
