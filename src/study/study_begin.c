/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Before the first ask. */
#include "study/study_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "design/design_grids.h"
#include "format/json.h"
#include "store/evaluations.h"
#include "store/lock.h"

/* The problem's hash carries the evaluator's version: a job of an older model is another study, as is one whose search
   took another path. */
static enum eo_code word_study(struct study *study, const struct eo_design *design, json_t *document,
                               struct eo_text *problem, struct eo_error *error)
{
  EO_TRY(eo_design_problem(design, &study->problem, study->hash, error));
  if (!document)
    return eo_error_memory(error);
  eo_json_write(&study->design, document, EO_JSON_COMPACT);
  json_object_del(document, "name");
  eo_json_write(problem, document, EO_JSON_CANONICAL);
  eo_text_add(problem, study->hash);
  eo_text_print(problem, " %d", EO_OPTIMIZER_VERSION);
  if (study->design.failed || problem->failed)
    return eo_error_memory(error);
  eo_hash_hex(problem->data, problem->size, study->study_hash);
  return EO_OK;
}

static enum eo_code describe(struct study *study, struct eo_error *error)
{
  const struct eo_design *design = study->plan->design;
  struct eo_text problem = {0};
  json_t *document = eo_design_encode(design);
  enum eo_code code = word_study(study, design, document, &problem, error);
  eo_text_done(&problem);
  json_decref(document);
  return code;
}

static enum eo_code new_job(struct study *study, struct eo_error *error)
{
  bool taken = false;
  study->job.design = study->design.data;
  study->job.name = study->plan->design->name;
  study->job.algorithm = eo_optimizer_algorithm_name(study->plan->design->optimization.search.algorithm);
  study->job.state = EO_JOB_RUNNING;
  study->job.best_value = NAN;
  EO_TRY(eo_store_add_job(study->plan->store, &study->job, error));
  return eo_store_claim_job(study->plan->store, study->job.id, &taken, error);
}

/* The problems of all pairs and of the first ones alone. */
static enum eo_code find_problems(struct study *study, struct eo_error *error)
{
  struct eo_store *store = study->plan->store;
  const struct eo_stored_problem problem = {.hash = study->hash,
                                            .spec = study->problem.data,
                                            .name = study->plan->design->name,
                                            .evaluator = EO_EVALUATOR_VERSION,
                                            .scenarios = study->result->scenarios,
                                            .cases = study->result->cases};
  const struct eo_stored_problem first = {.hash = study->race.hash,
                                          .spec = study->race.spec.data,
                                          .name = study->plan->design->name,
                                          .evaluator = EO_EVALUATOR_VERSION,
                                          .scenarios = study->race.first,
                                          .cases = study->result->cases};
  EO_TRY(eo_store_find_problem(store, &problem, &study->job.problem, error));
  return study->race.first ? eo_store_find_problem(store, &first, &study->race.problem, error) : EO_OK;
}

/* The job that was ordered, one that was interrupted, or a new one. */
static enum eo_code take_job(struct study *study, struct eo_error *error)
{
  struct eo_store *store = study->plan->store;
  EO_TRY(find_problems(study, error));
  if (study->plan->job)
    return eo_store_begin_job(store, &study->job, &study->result->resumed, error);
  if (!study->plan->restart) {
    EO_TRY(eo_store_resume_job(store, study->study_hash, study->plan->fresh, &study->job, error));
    study->result->resumed = study->job.id != 0;
  }
  return study->job.id ? EO_OK : new_job(study, error);
}

static enum eo_code find_job(struct study *study, struct eo_error *error)
{
  struct eo_store *store = study->plan->store;
  study->job.study = study->study_hash;
  study->job.space = study->space_hash;
  study->job.fresh = study->plan->fresh;
  study->job.id = study->plan->job;
  EO_TRY(eo_store_begin(store, error));
  enum eo_code code = eo_store_end(store, take_job(study, error), error);
  study->result->job = study->job.id;
  return code;
}

static enum eo_code compute_unmodified(struct study *study, struct eo_row_data *row, struct eo_error *error)
{
  struct eo_store *store = study->plan->store;
  EO_TRY(eo_study_compute_row(study, &study->worker[0], row, study->result->scenarios, error));
  EO_TRY(eo_store_begin(store, error));
  return eo_store_end(store, eo_study_save_row(study, row, error), error);
}

static enum eo_code take_unmodified(struct study *study, struct eo_rows *rows, struct eo_error *error)
{
  struct eo_row_data *row;
  const struct eo_modification none = eo_design_unmodified(study->plan->design);
  EO_TRY(eo_rows_add(rows, &none, study->plan->design->gear_pair.ends, &row, error));
  EO_TRY(eo_study_look_up(study, row, error));
  if (row->states < study->result->scenarios)
    EO_TRY(compute_unmodified(study, row, error));
  study->result->unmodified = row->point;
  row->point.raw = NULL;
  eo_study_weigh(study, &study->result->unmodified);
  return study->result->unmodified.there
             ? EO_OK
             : eo_error_set(error, EO_ERROR_INPUT, "/load_cases",
                            "The unmodified pair, to which the objectives relate, has no objective: %s",
                            row->reason[0] ? row->reason : "all of its values are zero.");
}

/* The unmodified pair is a row of the history like any other. */
static enum eo_code find_unmodified(struct study *study, struct eo_error *error)
{
  struct eo_rows rows = {.values = study->result->scenarios * study->result->cases};
  enum eo_code code = take_unmodified(study, &rows, error);
  eo_rows_done(&rows);
  return code;
}

/* What the values are made of, once the unmodified pair is known. */
static enum eo_code describe_value(struct study *study, struct eo_error *error)
{
  study->parted = study->race.first ? study->race.first : study->result->scenarios;
  EO_TRY(
      eo_objective_anatomy(study->plan->design, study->parted, study->result->unmodified.raw, &study->anatomy, error));
  if (study->anatomy.parts == 0)
    return EO_OK;
  study->anatomy.blocks = eo_study_space_blocks(&study->result->space, study->anatomy.block);
  study->part = malloc((size_t)study->anatomy.parts * sizeof *study->part);
  return study->part ? eo_optimizer_describe(study->optimizer, &study->anatomy, error) : eo_error_memory(error);
}

/* Pairs as made scatter about the flanks that are seen. */
static enum eo_code set_view(struct study *study, struct eo_error *error)
{
  study->view = malloc(sizeof *study->view);
  if (!study->view)
    return eo_error_memory(error);
  const struct eo_view view = eo_search_view_init(study->view, study->plan->design, &study->result->space,
                                                  &study->plan->pair->geometry);
  return eo_optimizer_set_view(study->optimizer, &view, error);
}

/* Rows of other jobs between two looks at whether a stop is asked for: tens of thousands take a while. */
enum { EVERY = 32 };

/* One row of other jobs, if this study can ask for it. x: bit for bit as it was asked for in the same space, so that it
   is found again. */
static enum eo_code import(void *context, const struct eo_stored_evaluation *evaluation, const double *x, int size,
                           struct eo_error *error)
{
  struct study *study = context;
  struct eo_row_data *row;
  struct eo_modification modification;
  double point[EO_MAX_LISTED], objectives[EO_MAX_OBJECTIVES];
  const struct eo_modification *base = &study->plan->design->modification;
  if (study->visited++ % EVERY == 0 && eo_study_tell_progress(study, 0))
    return EO_ERROR_CANCELLED;
  enum eo_code code = eo_modification_read(evaluation->modification, &modification, error);
  if (code || !eo_study_space_locate(&study->result->space, base, &modification, point))
    return code;
  code = eo_rows_add(&study->row, &modification, study->plan->design->gear_pair.ends, &row, error);
  if (code)
    return code;
  memcpy(row->point.raw, evaluation->raw, sizeof *evaluation->raw * (size_t)study->row.values);
  eo_study_take(row, evaluation);
  row->states = study->result->scenarios;
  row->whole = true;
  memcpy(row->x, size == study->result->space.count ? x : point, sizeof *row->x * (size_t)study->result->space.count);
  eo_race_settle(study, row);
  struct eo_outcome outcome = eo_study_outcome(study, row, objectives);
  code = eo_optimizer_import(study->optimizer, size == study->result->space.count ? x : point, &outcome, error);
  if (!code && eo_optimizer_rows(study->optimizer) < study->row.count) /* the same point once more */
    eo_rows_drop(&study->row, study->row.count - 1);
  study->told = study->row.count;
  return code;
}

enum eo_code eo_study_begin(struct study *study, struct eo_error *error)
{
  struct eo_study_result *result = study->result;
  const struct eo_design *design = study->plan->design;
  result->scenarios = eo_evaluator_scenarios(design);
  result->cases = design->load_cases;
  result->threads = study->plan->threads > 0 ? study->plan->threads : eo_parallel_cores();
  study->row.values = result->scenarios * result->cases;
  study->scratch = malloc(sizeof *study->scratch);
  if (!study->scratch)
    return eo_error_memory(error);
  *study->scratch = *design;
  study->settings = design->optimization.search;
  EO_TRY(eo_study_space_init(&result->space, design, &study->plan->pair->geometry, error));
  eo_study_space_hash(&result->space, study->space_hash);
  EO_TRY(eo_optimizer_new(&study->settings, &study->optimizer, error));
  EO_TRY(set_view(study, error));
  EO_TRY(eo_race_begin(study, error));
  EO_TRY(describe(study, error));
  EO_TRY(find_job(study, error));
  EO_TRY(find_unmodified(study, error));
  EO_TRY(describe_value(study, error));
  enum eo_code code = EO_OK;
  if (!study->plan->fresh && study->job.import_upto > 0)
    code = eo_store_each_evaluation(study->plan->store, study->job.problem, study->job.import_upto, study->space_hash,
                                    result->scenarios, result->cases, import, study, error);
  result->imported = study->row.count; /* after a stop too: none of them is this job's */
  return code;
}
