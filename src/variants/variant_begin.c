/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Before anything is evaluated: the job, and what is known already. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "document/search_space.h"
#include "evaluation/evaluator.h"
#include "format/json.h"
#include "store/lock.h"
#include "variants/variant_study_private.h"

enum { LOOKED_UP_BETWEEN_REPORTS = 256 };

/* What is written of a study when it begins. */
struct wording {
  struct eo_text design, spec, names, problem; /* JSON; names: of the columns */
  char hash[EO_HASH_LENGTH + 1];               /* of the problem */
};

/* Rows of a robust objective have more than one scenario, of a rated one more than an analysis looks at. */
static enum eo_code compose_problem(struct variant_study *s, struct wording *wording, struct eo_error *error)
{
  const struct eo_design *design = s->run->plan->design;
  s->shared = s->run->plan->of_modification && eo_evaluator_scenarios(design) == 1 &&
              !eo_objective_wants_rating(&design->objective);
  if (!s->shared)
    return EO_OK;
  s->raw = calloc((size_t)design->load_cases, sizeof *s->raw);
  s->unmodified = calloc((size_t)design->load_cases, sizeof *s->unmodified);
  return s->raw && s->unmodified ? eo_design_problem(design, &wording->problem, wording->hash, error)
                                 : eo_error_memory(error);
}

static enum eo_code compose(struct variant_study *s, struct wording *wording, struct eo_error *error)
{
  json_t *names = json_array();
  for (int i = 0; i < s->scalars.count; i++)
    json_array_append_new(names, json_string(s->scalars.scalar[i].name));
  eo_json_write(&wording->names, names, EO_JSON_COMPACT);
  eo_design_write(s->run->plan->design, &wording->design);
  eo_json_write(&wording->spec, s->run->document, EO_JSON_COMPACT);
  bool good = names && !wording->names.failed && !wording->design.failed && !wording->spec.failed;
  json_decref(names);
  return good ? compose_problem(s, wording, error) : eo_error_memory(error);
}

static enum eo_code new_job(struct variant_study *s, const struct wording *wording, struct eo_error *error)
{
  bool taken = false;
  s->job.kind = EO_JOB_STUDY;
  s->job.design = wording->design.data;
  s->job.spec = wording->spec.data;
  s->job.name = s->run->plan->name;
  s->job.algorithm = s->run->plan->table ? "table" : eo_study_samplings[s->run->plan->sampling];
  s->job.state = EO_JOB_RUNNING;
  enum eo_code code = eo_store_add_job(s->run->store, &s->job, error);
  s->job.design = s->job.spec = "";
  return code ? code : eo_store_claim_job(s->run->store, s->job.id, &taken, error);
}

static enum eo_code find_job(struct variant_study *s, const struct wording *wording, struct eo_error *error)
{
  struct eo_store *store = s->run->store;
  s->job.study = s->run->plan->study_hash;
  s->job.id = s->run->job;
  if (s->run->job)
    return eo_store_begin_job(store, &s->job, &s->result->resumed, error);
  if (!s->run->restart) {
    EO_TRY(eo_store_resume_job(store, s->job.study, false, &s->job, error));
    s->result->resumed = s->job.id != 0;
  }
  return s->job.id ? EO_OK : new_job(s, wording, error);
}

/* Variants that have their row, of an earlier run of this job. */
struct places {
  struct variant_study *study;
  bool *there; /* [rows] */
};

static enum eo_code note_place(void *context, const struct eo_stored_variant *row, struct eo_error *error)
{
  struct places *places = context;
  struct eo_variant_result *result = places->study->result;
  (void)error;
  if (row->ordinal >= result->rows)
    return EO_OK;
  places->there[row->ordinal] = true;
  result->done++;
  result->reused += row->reused;
  result->refused += row->outcome == EO_EVALUATION_REFUSED;
  result->not_converged += row->outcome == EO_EVALUATION_NOT_CONVERGED;
  return EO_OK;
}

static enum eo_code find_missing(struct variant_study *s, struct eo_error *error)
{
  int rows = s->run->plan->rows, pairs;
  struct places places = {s, calloc((size_t)rows + 1, sizeof *places.there)};
  s->missing = malloc(sizeof *s->missing * ((size_t)rows + 1));
  s->number = malloc(sizeof *s->number * (size_t)s->scalars.count);
  enum eo_code code = places.there && s->missing && s->number ? EO_OK : eo_error_memory(error);
  if (!code)
    code = eo_variant_sort(s->run->plan, s->missing, &pairs, error);
  if (!code)
    code = eo_store_each_variant(s->run->store, s->job.id, -1, -1, note_place, &places, error);
  for (int i = 0; i < rows && !code; i++)
    if (!places.there[s->missing[i]])
      s->missing[s->missing_count++] = s->missing[i];
  free(places.there);
  return code;
}

static enum eo_code write_down(struct variant_study *s, const struct wording *wording, struct eo_error *error)
{
  const struct eo_stored_problem problem = {.hash = wording->hash,
                                            .spec = wording->problem.data,
                                            .name = s->run->plan->design->name,
                                            .evaluator = EO_EVALUATOR_VERSION,
                                            .scenarios = 1,
                                            .cases = s->run->plan->design->load_cases};
  EO_TRY(find_job(s, wording, error));
  EO_TRY(eo_store_variant_columns(s->run->store, wording->names.data, &s->columns, error));
  return s->shared ? eo_store_find_problem(s->run->store, &problem, &s->problem, error) : EO_OK;
}

/* Nobody waits for the database while this is composed. */
static enum eo_code begin_job(struct variant_study *s, struct wording *wording, struct eo_error *error)
{
  EO_TRY(compose(s, wording, error));
  EO_TRY(eo_store_begin(s->run->store, error));
  enum eo_code code = write_down(s, wording, error);
  if (!code)
    code = eo_store_commit(s->run->store, error);
  if (code) {
    eo_store_rollback(s->run->store);
    s->job.id = 0;
  }
  s->result->job = s->job.id;
  return code;
}

enum eo_code eo_variant_study_begin(struct variant_study *s, struct eo_error *error)
{
  struct wording wording = {0};
  EO_TRY(eo_variant_scalars(s->run->plan, &s->scalars, error));
  enum eo_code code = begin_job(s, &wording, error);
  eo_text_done(&wording.design);
  eo_text_done(&wording.spec);
  eo_text_done(&wording.names);
  eo_text_done(&wording.problem);
  return code ? code : find_missing(s, error);
}

/* The history of searches: */

static struct eo_stored_evaluation evaluation_of(const struct variant_study *s, struct eo_objective_case *raw)
{
  return (struct eo_stored_evaluation){.scenarios = 1, .cases = s->run->plan->design->load_cases, .raw = raw};
}

/* Whether there is a row that all others relate to: without it no objective is known. */
static enum eo_code find_unmodified(struct variant_study *s, bool *there, struct eo_error *error)
{
  struct eo_stored_evaluation row = evaluation_of(s, s->unmodified);
  *there = false;
  if (!s->shared || !s->scalars.objectives || s->scalars.want)
    return EO_OK;
  EO_TRY(eo_store_find_evaluation(s->run->store, s->problem, "{}", &row, error));
  *there = row.id != 0;
  return EO_OK;
}

/* A row of a search as a row of this study. */
static enum eo_code convert(struct variant_study *s, const struct eo_design *design, const struct eo_geometry *geometry,
                            struct eo_stored_variant *row, bool *there, struct eo_error *error)
{
  struct eo_text modification = {0};
  struct eo_stored_evaluation found = evaluation_of(s, s->raw);
  enum eo_code code = eo_modification_write(&design->modification, design->gear_pair.ends, &modification, error);
  if (!code)
    code = eo_store_find_evaluation(s->run->store, s->problem, modification.data, &found, error);
  eo_text_done(&modification);
  if (code || !found.id)
    return code;
  row->outcome = found.outcome;
  row->cost = found.cost;
  memcpy(row->reason, found.reason, sizeof row->reason);
  if (found.outcome == EO_EVALUATION_REFUSED)
    for (int i = 0; i < row->numbers; i++)
      row->number[i] = NAN;
  else
    code = eo_scalars_of_raw(&s->scalars, design, geometry, s->raw, s->unmodified, row->number, error);
  *there = !code;
  return code;
}

static enum eo_code find_in_history(struct variant_study *s, const json_t *values, struct eo_stored_variant *row,
                                    bool *there, struct eo_error *error)
{
  const struct eo_variant_plan *plan = s->run->plan;
  struct eo_design *design = malloc(sizeof *design);
  struct eo_geometry geometry;
  if (!design)
    return eo_error_memory(error);
  enum eo_code code = eo_variant_design(plan->base, plan->axis, plan->axes, values, design, &geometry, error);
  if (code == EO_ERROR_INPUT) /* whoever evaluates it says why it cannot be */
    code = EO_OK;
  else if (!code)
    code = convert(s, design, &geometry, row, there, error);
  free(design);
  return code;
}

struct known {
  bool rows, history; /* there is something to be found */
};

/* What was found and has no place yet: it is read and composed before the database is locked. */
enum { MOST_FOUND = 256 };
struct finds {
  int count;
  struct found {
    int variant;
    char hash[EO_HASH_LENGTH + 1];
    struct eo_stored_variant row; /* id 0: a row of a search, which is to be added */
  } found[MOST_FOUND];
  double *number; /* [MOST_FOUND][columns]; owned */
};

static enum eo_code look_up_one(struct variant_study *s, const struct known *known, int variant, struct finds *finds,
                                bool *there, struct eo_error *error)
{
  struct found *found = &finds->found[finds->count];
  json_t *values = eo_variant_values(s->run->plan, variant);
  found->variant = variant;
  found->row = (struct eo_stored_variant){.design = found->hash,
                                          .evaluator = EO_EVALUATOR_VERSION,
                                          .columns = s->columns,
                                          .numbers = s->scalars.count,
                                          .number = finds->number + (size_t)finds->count * (size_t)s->scalars.count};
  enum eo_code code = values ? eo_variant_hash(s->run->plan, values, found->hash, error) : eo_error_memory(error);
  if (!code && known->rows)
    code = eo_store_find_variant(s->run->store, &found->row, error);
  *there = !code && found->row.id;
  if (!code && !*there && known->history)
    code = find_in_history(s, values, &found->row, there, error);
  json_decref(values);
  finds->count += !code && *there;
  return code;
}

static enum eo_code keep_finds(struct variant_study *s, struct finds *finds, struct eo_error *error)
{
  if (!finds->count)
    return EO_OK;
  EO_TRY(eo_variant_open(s, error));
  for (int i = 0; i < finds->count; i++) {
    struct found *found = &finds->found[i];
    if (!found->row.id)
      EO_TRY(eo_store_add_variant(s->run->store, &found->row, error));
    EO_TRY(eo_variant_keep(s, found->variant, &found->row, true, error));
  }
  finds->count = 0;
  return eo_variant_commit(s, true, error);
}

static enum eo_code look_up_all(struct variant_study *s, const struct known *known, struct finds *finds,
                                struct eo_error *error)
{
  int left = 0;
  for (int i = 0; i < s->missing_count; i++) {
    bool there = false;
    EO_TRY(look_up_one(s, known, s->missing[i], finds, &there, error));
    if (!there)
      s->missing[left++] = s->missing[i];
    if (finds->count == MOST_FOUND)
      EO_TRY(keep_finds(s, finds, error));
    if (i % LOOKED_UP_BETWEEN_REPORTS == 0 && eo_variant_report(s, "history"))
      return eo_error_set(error, EO_ERROR_CANCELLED, "", "The study was stopped.");
  }
  s->missing_count = left;
  return keep_finds(s, finds, error);
}

enum eo_code eo_variant_look_up(struct variant_study *s, struct eo_error *error)
{
  struct known known;
  EO_TRY(eo_store_has_variants(s->run->store, EO_EVALUATOR_VERSION, s->columns, &known.rows, error));
  EO_TRY(find_unmodified(s, &known.history, error));
  if (!known.rows && !known.history)
    return EO_OK;
  struct finds *finds = calloc(1, sizeof *finds);
  if (finds)
    finds->number = malloc(sizeof *finds->number * MOST_FOUND * (size_t)s->scalars.count);
  enum eo_code code = finds && finds->number ? look_up_all(s, &known, finds, error) : eo_error_memory(error);
  if (finds)
    free(finds->number);
  free(finds);
  return code;
}
