/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/history_prune.h"

#include "evaluation/evaluator.h"
#include "store/evaluations.h"
#include "store/jobs.h"
#include "store/lock.h"
#include "store/variant_rows.h"

struct outdated {
  int count;
  int64_t problem[1000];
};

static enum eo_code note_outdated(void *context, const struct eo_stored_problem *problem, struct eo_error *error)
{
  struct outdated *list = context;
  (void)error;
  if (problem->evaluator != EO_EVALUATOR_VERSION && list->count < (int)(sizeof list->problem / sizeof list->problem[0]))
    list->problem[list->count++] = problem->id;
  return EO_OK;
}

static enum eo_code remove_outdated(struct eo_store *store, int64_t *rows, struct eo_error *error)
{
  struct outdated list = {0};
  enum eo_code code = eo_store_each_problem(store, note_outdated, &list, error);
  for (int i = 0; i < list.count && !code; i++) {
    int64_t removed;
    code = eo_store_remove_problem(store, list.problem[i], &removed, error);
    *rows += code ? 0 : removed;
  }
  return code;
}

static enum eo_code refuse_running(void *context, const struct eo_stored_job *job, struct eo_error *error)
{
  if (job->state != EO_JOB_RUNNING || !eo_store_job_is_taken(context, job->id))
    return EO_OK;
  return eo_error_set(error, EO_ERROR_INPUT, "", "Job %lld is running; prune when it has ended.", (long long)job->id);
}

static enum eo_code remove_rows(struct eo_store *store, const struct eo_prune *prune, int64_t *rows,
                                struct eo_error *error)
{
  int64_t removed = 0;
  if (prune->outdated)
    EO_TRY(remove_outdated(store, rows, error));
  if (prune->problem)
    EO_TRY(eo_store_remove_problem(store, prune->problem, &removed, error));
  *rows += removed;
  removed = 0;
  if (prune->damaged)
    EO_TRY(eo_store_remove_damaged(store, &removed, error));
  *rows += removed;
  return EO_OK;
}

enum eo_code eo_history_prune(struct eo_store *store, const struct eo_prune *prune, struct eo_pruned *pruned,
                              struct eo_error *error)
{
  *pruned = (struct eo_pruned){0};
  EO_TRY(eo_store_each_job(store, 0, refuse_running, store, error));
  if (prune->predictions) /* in steps: others write between */
    EO_TRY(eo_store_remove_predictions(store, &pruned->predictions, error));
  if (prune->outdated || prune->unused)
    EO_TRY(eo_store_remove_variants(store, prune->outdated ? EO_EVALUATOR_VERSION : 0, prune->unused, &pruned->rows,
                                    error));
  EO_TRY(eo_store_begin(store, error));
  EO_TRY(eo_store_end(store, remove_rows(store, prune, &pruned->rows, error), error));
  return eo_store_compact(store, error);
}

static const struct eo_outline_row rows[] = {
    EO_KEY("rows", "integer", "true evaluations that are gone", EO_AT(struct eo_pruned, rows)),
    EO_KEY("predictions", "integer", "predicted fitness values that are gone", EO_AT(struct eo_pruned, predictions)),
};
const struct eo_outline eo_pruned_outline = EO_OUTLINE("Pruned", rows);
