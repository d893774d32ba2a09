/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/history_document.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "format/digits.h"
#include "format/json.h"
#include "document/design_document.h"
#include "document/search_space.h"
#include "document/result_private.h"
#include "format/text_table.h"
#include "store/evaluations.h"
#include "store/jobs.h"
#include "store/lock.h"

static enum eo_code append(json_t *array, json_t *value, struct eo_error *error)
{
  return json_array_append_new(array, value) ? eo_error_memory(error) : EO_OK;
}

static const struct eo_outline_row problem_rows[] = {
    EO_KEY("id", "integer", "number of the problem", EO_AT(struct eo_stored_problem, id)),
    EO_KEY("hash", "text", "SHA-256 of everything that an evaluation depends on but the modification",
           EO_AT(struct eo_stored_problem, hash)),
    EO_KEY("name", "text", "of the first design", EO_AT(struct eo_stored_problem, name)),
    EO_KEY("evaluator", "integer", "version of the model", EO_AT(struct eo_stored_problem, evaluator)),
    EO_KEY("evaluations", "integer", "true rows", EO_AT(struct eo_stored_problem, evaluations)),
    EO_KEY("failed", "integer", "of them without a value", EO_AT(struct eo_stored_problem, failed)),
    EO_KEY("cost_s", "number?", "computing time of all, s", EO_AT(struct eo_stored_problem, cost)),
    EO_KEY("created", "text", "date and time, UTC", EO_AT(struct eo_stored_problem, created)),
};
static const struct eo_outline problem_outline = EO_OUTLINE("HistoryProblem", problem_rows);

static enum eo_code add_problem(void *context, const struct eo_stored_problem *problem, struct eo_error *error)
{
  return append(context, eo_outline_encode(&problem_outline, problem), error);
}

struct listed_job {
  struct eo_stored_job job;
  const char *state;
  double pfc_percent;
  bool has_result;
};

/* null before the job begins */
static json_t *write_problem(const void *source)
{
  int64_t problem = ((const struct listed_job *)source)->job.problem;
  return problem ? json_integer(problem) : json_null();
}

static const struct eo_outline_row job_rows[] = {
    EO_KEY("id", "integer", "number of the job", EO_AT(struct listed_job, job.id)),
    EO_KEY("kind", "word", "what it does", .words = eo_store_job_kinds, EO_AT(struct listed_job, job.kind)),
    EO_KEY("problem", "integer?", "null before it begins, and of a preparation", .write = write_problem),
    EO_KEY("name", "text", "of the design", EO_AT(struct listed_job, job.name)),
    EO_KEY("algorithm", "text", "of an optimization; else empty", EO_AT(struct listed_job, job.algorithm)),
    EO_KEY("state", "text", "as of a job, or interrupted: it was running when its process ended",
           EO_AT(struct listed_job, state)),
    EO_KEY("stopped", "text", "why it ended: budget, converged, cancelled; else empty",
           EO_AT(struct listed_job, job.stopped)),
    EO_KEY("true_evaluations", "integer", "by the model, or known from the history",
           EO_AT(struct listed_job, job.true_evaluations)),
    EO_KEY("individuals", "integer", "fitness values needed", EO_AT(struct listed_job, job.individuals)),
    EO_KEY("pfc_percent", "number?", "true evaluations of the individuals, per cent",
           EO_AT(struct listed_job, pfc_percent)),
    EO_KEY("best_value", "number?", "J and penalties of the best", EO_AT(struct listed_job, job.best_value)),
    EO_KEY("has_result", "flag", "there is a result to get", EO_AT(struct listed_job, has_result)),
    EO_KEY("created", "text", "date and time, UTC", EO_AT(struct listed_job, job.created)),
    EO_KEY("updated", "text", "date and time, UTC", EO_AT(struct listed_job, job.updated)),
};
static const struct eo_outline job_outline = EO_OUTLINE("HistoryJob", job_rows);

struct written_lists {
  json_t *problems, *jobs;
};
static const struct eo_outline_row list_rows[] = {
    EO_KEY("problems", "[object]", "what was worked on", .outline = &problem_outline,
           EO_AT(struct written_lists, problems)),
    EO_KEY("jobs", "[object]", "of the service and of the terminal", .outline = &job_outline,
           EO_AT(struct written_lists, jobs)),
};
const struct eo_outline eo_records_outline = EO_OUTLINE("History", list_rows);

struct job_list {
  struct eo_store *store;
  json_t *array;
};

static enum eo_code add_job(void *context, const struct eo_stored_job *job, struct eo_error *error)
{
  struct job_list *list = context;
  bool taken = job->state != EO_JOB_RUNNING || eo_store_job_is_taken(list->store, job->id);
  const struct listed_job row = {.job = *job,
                                 .state = taken ? eo_store_job_state_name(job->state) : "interrupted",
                                 .pfc_percent = job->individuals ? 100. * job->true_evaluations / job->individuals
                                                                 : NAN,
                                 .has_result = *job->result != '\0'};
  return append(list->array, eo_outline_encode(&job_outline, &row), error);
}

/* Makes a document of what was read without a code. */
static enum eo_code make_document(enum eo_code code, const struct eo_outline *outline, const void *read,
                                  json_t **document, struct eo_error *error)
{
  json_t *all = eo_outline_encode(outline, read); /* takes over what was read in any case */
  if (!code && !all)
    code = eo_error_memory(error);
  if (code)
    json_decref(all);
  else
    *document = all;
  return code;
}

enum eo_code eo_records_list(struct eo_store *store, json_t **document, struct eo_error *error)
{
  const struct written_lists lists = {json_array(), json_array()};
  struct job_list list = {store, lists.jobs};
  enum eo_code code = lists.problems && lists.jobs ? eo_store_each_problem(store, add_problem, lists.problems, error)
                                                   : eo_error_memory(error);
  if (!code)
    code = eo_store_each_job(store, 0, add_job, &list, error);
  return make_document(code, &eo_records_outline, &lists, document, error);
}

struct wanted_job {
  int64_t job;
  bool found;
  struct eo_text result;
};

static enum eo_code take_result(void *context, const struct eo_stored_job *stored_job, struct eo_error *error)
{
  struct wanted_job *wanted = context;
  if (stored_job->id != wanted->job)
    return EO_OK;
  wanted->found = true;
  eo_text_add(&wanted->result, stored_job->result);
  return wanted->result.failed ? eo_error_memory(error) : EO_OK;
}

static enum eo_code read_result(struct eo_store *store, struct wanted_job *wanted, json_t **document,
                                struct eo_error *error)
{
  EO_TRY(eo_store_each_job(store, 0, take_result, wanted, error));
  if (!wanted->found)
    return eo_error_set(error, EO_ERROR_INPUT, "", "There is no job %lld.", (long long)wanted->job);
  if (!wanted->result.size)
    return eo_error_set(error, EO_ERROR_INPUT, "", "Job %lld has no result yet.", (long long)wanted->job);
  *document = eo_json_parse(wanted->result.data, wanted->result.size, error);
  return *document ? EO_OK : EO_ERROR_FILE;
}

enum eo_code eo_records_result(struct eo_store *store, int64_t job, json_t **document, struct eo_error *error)
{
  struct wanted_job wanted = {.job = job};
  enum eo_code code = read_result(store, &wanted, document, error);
  eo_text_done(&wanted.result);
  return code;
}

struct row_list {
  int64_t problem;
  int scenarios, cases; /* of the problem; 0: not found */
  json_t *spec, *rows;
  struct eo_load_case load_case[EO_MAX_LOAD_CASES];
};

static enum eo_code take_problem(void *context, const struct eo_stored_problem *problem, struct eo_error *error)
{
  struct row_list *list = context;
  if (problem->id != list->problem)
    return EO_OK;
  list->scenarios = problem->scenarios;
  list->cases = problem->cases;
  list->spec = eo_json_parse(problem->spec, strlen(problem->spec), error);
  for (int k = 0; k < problem->cases && k < EO_MAX_LOAD_CASES; k++) {
    const json_t *row = json_array_get(json_object_get(list->spec, "load_cases"), (size_t)k);
    list->load_case[k].torque = eo_unit_in(&eo_unit_Nm, eo_json_find_number(row, "torque_Nm"));
    list->load_case[k].speed = eo_unit_in(&eo_unit_rpm, eo_json_find_number(row, "speed_rpm"));
  }
  return list->spec ? EO_OK : EO_ERROR_FILE;
}

static json_t *encode_scenario(const struct row_list *list, const struct eo_objective_case *raw)
{
  json_t *array = json_array();
  for (int k = 0; k < list->cases && array; k++)
    if (json_array_append_new(array, eo_result_raw_case(&list->load_case[k], &raw[k]))) {
      json_decref(array);
      array = NULL;
    }
  return array;
}

static json_t *encode_scenarios(const struct row_list *list, const struct eo_objective_case *raw)
{
  json_t *array = json_array();
  for (int s = 0; s < list->scenarios && array; s++)
    if (json_array_append_new(array, encode_scenario(list, raw + s * list->cases))) {
      json_decref(array);
      array = NULL;
    }
  return array;
}

struct written_evaluation {
  struct eo_stored_evaluation stored;
  json_t *modification, *scenarios;
};
#define OF_EVALUATION(member) EO_AT(struct written_evaluation, member)
static const struct eo_outline_row evaluation_rows[] = {
    EO_KEY("id", "integer", "number of the evaluation", OF_EVALUATION(stored.id)),
    EO_KEY("outcome", "word", "how it ended", .words = eo_store_outcomes, OF_EVALUATION(stored.outcome)),
    EO_KEY("reason", "text", "empty when it converged", OF_EVALUATION(stored.reason)),
    EO_KEY("cost_s", "number?", "computing time, s", OF_EVALUATION(stored.cost)),
    EO_KEY("modification", "object", "what is not at its default", .table = &eo_modification_table,
           .name = "SparseModification", .sparse = true, OF_EVALUATION(modification)),
    EO_KEY("scenarios", "[[object]]", "raw numbers of every load case, scenario by scenario",
           .outline = &eo_outline_raw_case, OF_EVALUATION(scenarios)),
};
static const struct eo_outline evaluation_outline = EO_OUTLINE("ProblemRow", evaluation_rows);

struct written_rows {
  json_t *problem, *rows;
};
static const struct eo_outline_row problem_row_rows[] = {
    EO_KEY("problem", "{any}", "what its evaluations have in common, as it is hashed",
           EO_AT(struct written_rows, problem)),
    EO_KEY("rows", "[object]", "every true evaluation", .outline = &evaluation_outline,
           EO_AT(struct written_rows, rows)),
};
const struct eo_outline eo_outline_problem_rows = EO_OUTLINE("ProblemRows", problem_row_rows);

static enum eo_code add_row(void *context, const struct eo_stored_evaluation *evaluation, const double *x, int size,
                            struct eo_error *error)
{
  struct row_list *list = context;
  (void)x;
  (void)size;
  const struct written_evaluation row = {
      *evaluation, eo_json_parse(evaluation->modification, strlen(evaluation->modification), error),
      encode_scenarios(list, evaluation->raw)};
  return append(list->rows, eo_outline_encode(&evaluation_outline, &row), error);
}

static enum eo_code collect_rows(struct eo_store *store, struct row_list *list, struct eo_error *error)
{
  if (!list->rows)
    return eo_error_memory(error);
  EO_TRY(eo_store_each_problem(store, take_problem, list, error));
  if (!list->cases)
    return eo_error_set(error, EO_ERROR_INPUT, "", "There is no problem %lld.", (long long)list->problem);
  return eo_store_each_evaluation(store, list->problem, 0, NULL, list->scenarios, list->cases, add_row, list, error);
}

enum eo_code eo_records_rows(struct eo_store *store, int64_t problem, json_t **document, struct eo_error *error)
{
  struct row_list list = {.problem = problem, .rows = json_array()};
  enum eo_code code = collect_rows(store, &list, error);
  const struct written_rows rows = {list.spec ? list.spec : json_null(), list.rows};
  return make_document(code, &eo_outline_problem_rows, &rows, document, error);
}

static const char *const value_keys[] = {
    "peak_to_peak_um", "impact_N",        "rms_m_per_s2",         "contact_pressure_MPa",
    "root_stress_MPa", "edge_load_share", "contact_loss",         "flank_safety",
    "root_safety",     "film_ratio",      "contact_temperature_C"};
enum { VALUES = sizeof value_keys / sizeof value_keys[0] };

static const json_t *first_scenario(const json_t *row)
{
  return json_array_get(json_object_get(row, "scenarios"), 0);
}

static void add_headings(const json_t *paths, const json_t *cases, char **heading)
{
  const char *key;
  json_t *value;
  int i = 0;
  for (const char *const *fixed = (const char *const[]){"id", "outcome", "cost_s", NULL}; *fixed; fixed++)
    heading[i++] = strdup(*fixed);
  json_object_foreach((json_t *)paths, key, value) heading[i++] = strdup(key);
  for (size_t k = 0; k < json_array_size(cases); k++)
    for (int v = 0; v < VALUES; v++) {
      char text[100];
      const json_t *value_of = json_array_get(cases, k);
      snprintf(text, sizeof text, "%s at %.6g Nm %.6g rpm", value_keys[v], eo_json_find_number(value_of, "torque_Nm"),
               eo_json_find_number(value_of, "speed_rpm"));
      heading[i++] = strdup(text);
    }
}

static void add_cell(struct eo_text_table *sheet, const json_t *value, double standard)
{
  if (json_is_string(value))
    eo_text_table_string(sheet, json_string_value(value));
  else
    eo_text_table_number(sheet, json_is_number(value) ? json_number_value(value) : standard, NULL, 0);
}

static void add_cells(struct eo_text_table *sheet, const json_t *row, const json_t *paths)
{
  const char *key;
  json_t *value;
  add_cell(sheet, json_object_get(row, "id"), NAN);
  add_cell(sheet, json_object_get(row, "outcome"), NAN);
  add_cell(sheet, json_object_get(row, "cost_s"), NAN);
  json_object_foreach((json_t *)paths, key, value)
      add_cell(sheet, eo_json_find(json_object_get(row, "modification"), key), 0);
  for (size_t k = 0; k < json_array_size(first_scenario(row)); k++)
    for (int v = 0; v < VALUES; v++)
      add_cell(sheet, json_object_get(json_array_get(first_scenario(row), k), value_keys[v]), NAN);
}

static void write_rows(const json_t *rows, const json_t *paths, char **heading, int columns, struct eo_text *text)
{
  struct eo_text_table sheet;
  const json_t *row;
  size_t i;
  add_headings(paths, first_scenario(json_array_get(rows, 0)), heading);
  for (int j = 0; j < columns; j++)
    text->failed |= !heading[j];
  if (text->failed)
    return;
  eo_text_table_init(&sheet, columns, (const char *const *)heading);
  json_array_foreach((json_t *)rows, i, row) add_cells(&sheet, row, paths);
  eo_text_table_csv(&sheet, text);
  eo_text_table_done(&sheet);
}

enum eo_code eo_records_rows_csv(const json_t *document, struct eo_text *text, struct eo_error *error)
{
  const json_t *rows = json_object_get(document, "rows");
  json_t *paths = eo_modification_columns(rows);
  int columns = 3 + (int)json_object_size(paths) +
                VALUES * (int)json_array_size(first_scenario(json_array_get(rows, 0)));
  char **heading = calloc((size_t)columns, sizeof *heading);
  if (paths && heading)
    write_rows(rows, paths, heading, columns, text);
  else
    text->failed = true;
  for (int j = 0; heading && j < columns; j++)
    free(heading[j]);
  free(heading);
  json_decref(paths);
  return text->failed ? eo_error_memory(error) : EO_OK;
}

struct path_list {
  struct eo_text *text;
  int size; /* variables, once known */
};

static void write_head(struct path_list *list, int size)
{
  if (list->size)
    return;
  list->size = size;
  eo_text_add(list->text, "generation,individual,kind,evaluation,fitness,credibility");
  for (int i = 0; i < size; i++)
    eo_text_print(list->text, ",x%d", i + 1);
  eo_text_add(list->text, "\r\n");
}

static void write_point(struct eo_text *text, const double *x, int size)
{
  for (int i = 0; i < size; i++) {
    char number[40];
    eo_digits_write(number, sizeof number, x[i]);
    eo_text_print(text, ",%s", number);
  }
  eo_text_add(text, "\r\n");
}

static enum eo_code write_candidate(void *context, const struct eo_stored_candidate *candidate, struct eo_error *error)
{
  struct path_list *list = context;
  write_head(list, candidate->size);
  eo_text_print(list->text, "%d,%d,%s,%lld,,", candidate->generation, candidate->individual,
                candidate->reused ? "known" : "computed", (long long)candidate->evaluation);
  write_point(list->text, candidate->x, candidate->size);
  return list->text->failed ? eo_error_memory(error) : EO_OK;
}

static enum eo_code write_prediction(void *context, const struct eo_stored_prediction *prediction,
                                     struct eo_error *error)
{
  struct path_list *list = context;
  char fitness[40], credibility[40];
  write_head(list, prediction->size);
  eo_digits_write(fitness, sizeof fitness, prediction->fitness);
  eo_digits_write(credibility, sizeof credibility, prediction->credibility);
  eo_text_print(list->text, "%d,%d,predicted,,%s,%s", prediction->generation, prediction->individual, fitness,
                credibility);
  write_point(list->text, prediction->x, prediction->size);
  return list->text->failed ? eo_error_memory(error) : EO_OK;
}

enum eo_code eo_records_path_csv(struct eo_store *store, int64_t job, struct eo_text *text, struct eo_error *error)
{
  struct path_list list = {.text = text};
  EO_TRY(eo_store_each_candidate(store, job, write_candidate, &list, error));
  EO_TRY(eo_store_each_prediction(store, job, write_prediction, &list, error));
  if (!list.size)
    EO_TRY(eo_error_set(error, EO_ERROR_INPUT, "", "There is no path of a job %lld.", (long long)job));
  return EO_OK;
}
