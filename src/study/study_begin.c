/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Before the first ask. */
#include "study/study_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "format/json.h"
#include "store/evaluations.h"
#include "store/lock.h"

static enum eo_code describe(struct study *s, struct eo_error *error)
{
  const struct eo_design *design = s->plan->design;
  struct eo_text problem = {0};
  json_t *document = eo_design_encode(design);
  enum eo_code code = eo_design_problem(design, &s->problem, s->hash, error);
  if (document) {
    eo_json_write(&s->design, document, EO_JSON_COMPACT);
    json_object_del(document, "name");
    eo_json_write(&problem, document, EO_JSON_CANONICAL);
  }
  if (!code && (!document || s->design.failed || problem.failed))
    code = eo_error_memory(error);
  /* the problem's hash carries the evaluator's version: a job of an older model is another study, as is one whose
     search took another path */
  if (!code) {
    eo_text_add(&problem, s->hash);
    eo_text_print(&problem, " %d", EO_OPTIMIZER_VERSION);
  }
  if (!code && problem.failed)
    code = eo_error_memory(error);
  if (!code)
    eo_hash_hex(problem.data, problem.size, s->study_hash);
  eo_text_done(&problem);
  json_decref(document);
  return code;
}

static enum eo_code new_job(struct study *s, struct eo_error *error)
{
  bool taken = false;
  s->job.design = s->design.data;
  s->job.name = s->plan->design->name;
  s->job.algorithm = eo_optimizer_algorithm_name(s->plan->design->optimization.search.algorithm);
  s->job.state = EO_JOB_RUNNING;
  s->job.best_value = NAN;
  enum eo_code code = eo_store_add_job(s->plan->store, &s->job, error);
  return code ? code : eo_store_claim_job(s->plan->store, s->job.id, &taken, error);
}

static enum eo_code find_job(struct study *s, struct eo_error *error)
{
  struct eo_store *store = s->plan->store;
  const struct eo_stored_problem problem = {.hash = s->hash,
                                            .spec = s->problem.data,
                                            .name = s->plan->design->name,
                                            .evaluator = EO_EVALUATOR_VERSION,
                                            .scenarios = s->result->scenarios,
                                            .cases = s->result->cases};
  enum eo_code code = eo_store_begin(store, error);
  if (!code)
    code = eo_store_find_problem(store, &problem, &s->job.problem, error);
  s->job.study = s->study_hash;
  s->job.space = s->space_hash;
  s->job.fresh = s->plan->fresh;
  s->job.id = s->plan->job;
  if (!code && s->plan->job)
    code = eo_store_begin_job(store, &s->job, &s->result->resumed, error);
  else if (!code && !s->plan->restart) {
    code = eo_store_resume_job(store, s->study_hash, s->plan->fresh, &s->job, error);
    s->result->resumed = s->job.id != 0;
  }
  if (!code && !s->job.id)
    code = new_job(s, error);
  if (!code)
    code = eo_store_commit(store, error);
  if (code)
    eo_store_rollback(store);
  s->result->job = s->job.id;
  return code;
}

/* The unmodified pair is a row of the history like any other. */
static enum eo_code find_unmodified(struct study *s, struct eo_error *error)
{
  struct eo_rows rows = {.values = s->result->scenarios * s->result->cases};
  struct eo_row_data *row;
  struct eo_modification none;
  memset(&none, 0, sizeof none);
  enum eo_code code = eo_rows_add(&rows, &none, s->plan->design->gear_pair.ends, &row, error);
  if (!code)
    code = eo_study_look_up(s, row, error);
  if (!code && !row->point.evaluation) {
    code = eo_study_compute_row(s, &s->worker[0], row, error);
    if (!code)
      code = eo_store_begin(s->plan->store, error);
    if (!code)
      code = eo_study_save_row(s, row, error);
    if (!code)
      code = eo_store_commit(s->plan->store, error);
    if (code)
      eo_store_rollback(s->plan->store);
  }
  if (!code) {
    s->result->unmodified = row->point;
    row->point.raw = NULL;
    eo_study_weigh(s, &s->result->unmodified);
    if (!s->result->unmodified.there)
      code = eo_error_set(error, EO_ERROR_INPUT, "/load_cases",
                          "The unmodified pair, to which the objectives relate, has no objective: %s",
                          row->reason[0] ? row->reason : "all of its values are zero.");
  }
  eo_rows_done(&rows);
  return code;
}

/* What the values are made of, once the unmodified pair is known. */
static enum eo_code describe_value(struct study *s, struct eo_error *error)
{
  enum eo_code code = eo_objective_anatomy(s->plan->design, s->result->scenarios, s->result->unmodified.raw,
                                           &s->anatomy, error);
  if (code || s->anatomy.parts == 0)
    return code;
  s->part = malloc((size_t)s->anatomy.parts * sizeof *s->part);
  return s->part ? eo_optimizer_describe(s->optimizer, &s->anatomy, error) : eo_error_memory(error);
}

/* One row of other jobs, if this study can ask for it. x: bit for bit as it was asked for in the same space, so that it
   is found again. */
static enum eo_code import(void *context, const struct eo_stored_evaluation *e, const double *x, int size,
                           struct eo_error *error)
{
  struct study *s = context;
  struct eo_row_data *row;
  struct eo_modification modification;
  double point[EO_MAX_LISTED], objectives[3];
  const struct eo_modification *base = &s->plan->design->modification;
  enum eo_code code = eo_modification_read(e->modification, &modification, error);
  if (code || !eo_study_space_locate(&s->result->space, base, &modification, point))
    return code;
  code = eo_rows_add(&s->row, &modification, s->plan->design->gear_pair.ends, &row, error);
  if (code)
    return code;
  memcpy(row->point.raw, e->raw, sizeof *e->raw * (size_t)s->row.values);
  eo_study_take(row, e);
  eo_study_weigh(s, &row->point);
  struct eo_outcome outcome = eo_study_outcome(s, row, objectives);
  code = eo_optimizer_import(s->optimizer, size == s->result->space.count ? x : point, &outcome, error);
  if (!code && eo_optimizer_rows(s->optimizer) < s->row.count) /* the same point once more */
    eo_rows_drop(&s->row, s->row.count - 1);
  s->told = s->row.count;
  return code;
}

enum eo_code eo_study_begin(struct study *s, struct eo_error *error)
{
  struct eo_study_result *r = s->result;
  const struct eo_design *design = s->plan->design;
  r->scenarios = eo_evaluator_scenarios(design);
  r->cases = design->load_cases;
  r->threads = s->plan->threads > 0 ? s->plan->threads : eo_parallel_cores();
  s->row.values = r->scenarios * r->cases;
  s->scratch = malloc(sizeof *s->scratch);
  if (!s->scratch)
    return eo_error_memory(error);
  *s->scratch = *design;
  s->settings = design->optimization.search;
  enum eo_code code = eo_study_space_init(&r->space, design, &s->plan->pair->geometry, error);
  if (code)
    return code;
  eo_study_space_hash(&r->space, s->space_hash);
  code = eo_optimizer_new(&s->settings, &s->optimizer, error);
  if (!code)
    code = describe(s, error);
  if (!code)
    code = find_job(s, error);
  if (!code)
    code = find_unmodified(s, error);
  if (!code)
    code = describe_value(s, error);
  if (!code && !s->plan->fresh && s->job.import_upto > 0)
    code = eo_store_each_evaluation(s->plan->store, s->job.problem, s->job.import_upto, s->space_hash, r->scenarios,
                                    r->cases, import, s, error);
  r->imported = s->row.count;
  return code;
}
