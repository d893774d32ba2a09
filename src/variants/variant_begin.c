/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Before anything is evaluated: the job, and what is known already. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "design/design_grids.h"
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
static enum eo_code compose_problem(struct variant_study *study, struct wording *wording, struct eo_error *error)
{
  const struct eo_design *design = study->run->plan->design;
  study->shared = study->run->plan->of_modification && eo_evaluator_scenarios(design) == 1 &&
                  !eo_objective_wants_rating(&design->objective);
  if (!study->shared)
    return EO_OK;
  study->raw = calloc((size_t)design->load_cases, sizeof *study->raw);
  study->unmodified = calloc((size_t)design->load_cases, sizeof *study->unmodified);
  return study->raw && study->unmodified ? eo_design_problem(design, &wording->problem, wording->hash, error)
                                         : eo_error_memory(error);
}

static enum eo_code compose(struct variant_study *study, struct wording *wording, struct eo_error *error)
{
  json_t *names = json_array();
  for (int i = 0; i < study->scalars.count; i++)
    json_array_append_new(names, json_string(study->scalars.scalar[i].name));
  eo_json_write(&wording->names, names, EO_JSON_COMPACT);
  eo_design_write(study->run->plan->design, &wording->design);
  eo_json_write(&wording->spec, study->run->document, EO_JSON_COMPACT);
  bool good = names && !wording->names.failed && !wording->design.failed && !wording->spec.failed;
  json_decref(names);
  return good ? compose_problem(study, wording, error) : eo_error_memory(error);
}

static enum eo_code new_job(struct variant_study *study, const struct wording *wording, struct eo_error *error)
{
  bool taken = false;
  study->job.kind = EO_JOB_STUDY;
  study->job.design = wording->design.data;
  study->job.spec = wording->spec.data;
  study->job.name = study->run->plan->name;
  study->job.algorithm = study->run->plan->table ? "table" : eo_study_samplings[study->run->plan->sampling];
  study->job.state = EO_JOB_RUNNING;
  enum eo_code code = eo_store_add_job(study->run->store, &study->job, error);
  study->job.design = study->job.spec = "";
  return code ? code : eo_store_claim_job(study->run->store, study->job.id, &taken, error);
}

static enum eo_code find_job(struct variant_study *study, const struct wording *wording, struct eo_error *error)
{
  struct eo_store *store = study->run->store;
  study->job.study = study->run->plan->study_hash;
  study->job.id = study->run->job;
  if (study->run->job)
    return eo_store_begin_job(store, &study->job, &study->result->resumed, error);
  if (!study->run->restart) {
    EO_TRY(eo_store_resume_job(store, study->job.study, false, &study->job, error));
    study->result->resumed = study->job.id != 0;
  }
  return study->job.id ? EO_OK : new_job(study, wording, error);
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

static enum eo_code find_missing(struct variant_study *study, struct eo_error *error)
{
  int rows = study->run->plan->rows, pairs;
  struct places places = {study, calloc((size_t)rows + 1, sizeof *places.there)};
  study->missing = malloc(sizeof *study->missing * ((size_t)rows + 1));
  study->number = malloc(sizeof *study->number * (size_t)study->scalars.count);
  enum eo_code code = places.there && study->missing && study->number ? EO_OK : eo_error_memory(error);
  if (!code)
    code = eo_variant_sort(study->run->plan, study->missing, &pairs, error);
  if (!code)
    code = eo_store_each_variant(study->run->store, study->job.id, -1, -1, note_place, &places, error);
  for (int i = 0; i < rows && !code; i++)
    if (!places.there[study->missing[i]])
      study->missing[study->missing_count++] = study->missing[i];
  free(places.there);
  return code;
}

static enum eo_code write_down(struct variant_study *study, const struct wording *wording, struct eo_error *error)
{
  const struct eo_stored_problem problem = {.hash = wording->hash,
                                            .spec = wording->problem.data,
                                            .name = study->run->plan->design->name,
                                            .evaluator = EO_EVALUATOR_VERSION,
                                            .scenarios = 1,
                                            .cases = study->run->plan->design->load_cases};
  EO_TRY(find_job(study, wording, error));
  EO_TRY(eo_store_variant_columns(study->run->store, wording->names.data, &study->columns, error));
  return study->shared ? eo_store_find_problem(study->run->store, &problem, &study->problem, error) : EO_OK;
}

/* Nobody waits for the database while this is composed. */
static enum eo_code begin_job(struct variant_study *study, struct wording *wording, struct eo_error *error)
{
  EO_TRY(compose(study, wording, error));
  EO_TRY(eo_store_begin(study->run->store, error));
  enum eo_code code = eo_store_end(study->run->store, write_down(study, wording, error), error);
  if (code)
    study->job.id = 0;
  study->result->job = study->job.id;
  return code;
}

enum eo_code eo_variant_study_begin(struct variant_study *study, struct eo_error *error)
{
  struct wording wording = {0};
  EO_TRY(eo_variant_scalars(study->run->plan, &study->scalars, error));
  enum eo_code code = begin_job(study, &wording, error);
  eo_text_done(&wording.design);
  eo_text_done(&wording.spec);
  eo_text_done(&wording.names);
  eo_text_done(&wording.problem);
  return code ? code : find_missing(study, error);
}

/* The history of searches: */

static struct eo_stored_evaluation evaluation_of(const struct variant_study *study, struct eo_objective_case *raw)
{
  return (struct eo_stored_evaluation){.scenarios = 1, .cases = study->run->plan->design->load_cases, .raw = raw};
}

/* Whether there is a row that all others relate to: without it no objective is known. */
static enum eo_code find_unmodified(struct variant_study *study, bool *there, struct eo_error *error)
{
  const struct eo_design *design = study->run->plan->design;
  const struct eo_modification none = eo_design_unmodified(design);
  struct eo_stored_evaluation row = evaluation_of(study, study->unmodified);
  struct eo_text text = {0};
  *there = false;
  if (!study->shared || !study->scalars.objectives || study->scalars.want)
    return EO_OK;
  enum eo_code code = eo_modification_write(&none, design->gear_pair.ends, &text, error);
  if (!code)
    code = eo_store_find_evaluation(study->run->store, study->problem, text.data, &row, error);
  eo_text_done(&text);
  *there = row.id != 0;
  return code;
}

/* A row of a search as a row of this study. */
static enum eo_code convert(struct variant_study *study, const struct eo_design *design,
                            const struct eo_geometry *geometry, struct eo_stored_variant *row, bool *there,
                            struct eo_error *error)
{
  struct eo_text modification = {0};
  struct eo_stored_evaluation found = evaluation_of(study, study->raw);
  enum eo_code code = eo_modification_write(&design->modification, design->gear_pair.ends, &modification, error);
  if (!code)
    code = eo_store_find_evaluation(study->run->store, study->problem, modification.data, &found, error);
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
    code = eo_scalars_of_raw(&study->scalars, design, geometry, study->raw, study->unmodified, row->number, error);
  *there = !code;
  return code;
}

static enum eo_code find_in_history(struct variant_study *study, const json_t *values, struct eo_stored_variant *row,
                                    bool *there, struct eo_error *error)
{
  const struct eo_variant_plan *plan = study->run->plan;
  struct eo_design *design = malloc(sizeof *design);
  struct eo_geometry geometry;
  if (!design)
    return eo_error_memory(error);
  enum eo_code code = eo_variant_design(plan->base, plan->axis, plan->axes, values, design, &geometry, error);
  if (code == EO_ERROR_INPUT) /* whoever evaluates it says why it cannot be */
    code = EO_OK;
  else if (!code)
    code = convert(study, design, &geometry, row, there, error);
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

/* A row of an earlier study, or of a search. */
static enum eo_code find_row(struct variant_study *study, const struct known *known, const json_t *values,
                             struct found *found, bool *there, struct eo_error *error)
{
  EO_TRY(eo_variant_hash(study->run->plan, values, found->hash, error));
  if (known->rows)
    EO_TRY(eo_store_find_variant(study->run->store, &found->row, error));
  *there = found->row.id != 0;
  return *there || !known->history ? EO_OK : find_in_history(study, values, &found->row, there, error);
}

static enum eo_code look_up_one(struct variant_study *study, const struct known *known, int variant,
                                struct finds *finds, bool *there, struct eo_error *error)
{
  struct found *found = &finds->found[finds->count];
  json_t *values = eo_variant_values(study->run->plan, variant);
  found->variant = variant;
  found->row =
      (struct eo_stored_variant){.design = found->hash,
                                 .evaluator = EO_EVALUATOR_VERSION,
                                 .columns = study->columns,
                                 .numbers = study->scalars.count,
                                 .number = finds->number + (size_t)finds->count * (size_t)study->scalars.count};
  *there = false;
  enum eo_code code = values ? find_row(study, known, values, found, there, error) : eo_error_memory(error);
  json_decref(values);
  finds->count += !code && *there;
  return code;
}

static enum eo_code keep_finds(struct variant_study *study, struct finds *finds, struct eo_error *error)
{
  if (!finds->count)
    return EO_OK;
  EO_TRY(eo_variant_open(study, error));
  for (int i = 0; i < finds->count; i++) {
    struct found *found = &finds->found[i];
    if (!found->row.id)
      EO_TRY(eo_store_add_variant(study->run->store, &found->row, error));
    EO_TRY(eo_variant_keep(study, found->variant, &found->row, true, error));
  }
  finds->count = 0;
  return eo_variant_commit(study, true, error);
}

static enum eo_code look_up_all(struct variant_study *study, const struct known *known, struct finds *finds,
                                struct eo_error *error)
{
  int left = 0;
  for (int i = 0; i < study->missing_count; i++) {
    bool there = false;
    EO_TRY(look_up_one(study, known, study->missing[i], finds, &there, error));
    if (!there)
      study->missing[left++] = study->missing[i];
    if (finds->count == MOST_FOUND)
      EO_TRY(keep_finds(study, finds, error));
    if (i % LOOKED_UP_BETWEEN_REPORTS == 0 && eo_variant_report(study, "history"))
      return eo_error_set(error, EO_ERROR_CANCELLED, "", "The study was stopped.");
  }
  study->missing_count = left;
  return keep_finds(study, finds, error);
}

enum eo_code eo_variant_look_up(struct variant_study *study, struct eo_error *error)
{
  struct known known;
  EO_TRY(eo_store_has_variants(study->run->store, EO_EVALUATOR_VERSION, study->columns, &known.rows, error));
  EO_TRY(find_unmodified(study, &known.history, error));
  if (!known.rows && !known.history)
    return EO_OK;
  struct finds *finds = calloc(1, sizeof *finds);
  if (finds)
    finds->number = malloc(sizeof *finds->number * MOST_FOUND * (size_t)study->scalars.count);
  enum eo_code code = finds && finds->number ? look_up_all(study, &known, finds, error) : eo_error_memory(error);
  if (finds)
    free(finds->number);
  free(finds);
  return code;
}
