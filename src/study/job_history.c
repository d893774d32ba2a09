/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/job_history.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "format/list_page.h"
#include "design/design_grids.h"
#include "document/design_document.h"
#include "format/json.h"
#include "document/result_private.h"
#include "format/text_table.h"
#include "document/search_space.h"
#include "evaluation/evaluator.h"
#include "store/evaluations.h"

/* A job as its rows are weighed. */
struct history {
  struct eo_store *store;
  struct eo_design design; /* of the job; its modification changes from row to row */
  struct eo_geometry geometry;
  int64_t problem;
  int scenarios, cases, limit, last;
  bool more;
  struct eo_objective_case *unmodified, *raw; /* [scenarios][cases]; owned */
  json_t *items;                              /* owned */
};

static void done(struct history *history)
{
  free(history->unmodified);
  free(history->raw);
  json_decref(history->items);
  free(history);
}

static enum eo_code take_job(void *context, const struct eo_stored_job *job, struct eo_error *error)
{
  struct history *history = context;
  history->problem = job->problem;
  return eo_design_read(job->design, strlen(job->design), &history->design, &history->geometry, NULL, error);
}

static enum eo_code reserve(struct history *history, struct eo_error *error)
{
  history->scenarios = eo_evaluator_scenarios(&history->design);
  history->cases = history->design.load_cases;
  size_t size = (size_t)history->scenarios * (size_t)history->cases;
  history->unmodified = calloc(size, sizeof *history->unmodified);
  history->raw = calloc(size, sizeof *history->raw);
  history->items = json_array();
  return history->unmodified && history->raw && history->items ? EO_OK : eo_error_memory(error);
}

/* A search over grids that no document called designed, as jobs of 0.1 have it, related to the grid that it began with.
 */
static bool is_older(const struct eo_design *design)
{
  bool older = false;
  for (int i = 0; i < 8; i++) {
    const struct eo_grid_place *grid = &design->grids.place[i / 4][i / 2 % 2][i % 2];
    older = older || (grid->kind == EO_GRID_DESIGNED && !grid->kind_stated);
  }
  return older;
}

static enum eo_code find_row(struct history *history, const struct eo_modification *modification,
                             struct eo_stored_evaluation *row, struct eo_error *error)
{
  struct eo_text text = {0};
  enum eo_code code = eo_modification_write(modification, history->design.gear_pair.ends, &text, error);
  if (!code)
    code = eo_store_find_evaluation(history->store, history->problem, text.data, row, error);
  eo_text_done(&text);
  return code;
}

static enum eo_code find_unmodified(struct history *history, struct eo_error *error)
{
  static const struct eo_modification nothing;
  const struct eo_modification none = eo_design_unmodified(&history->design);
  struct eo_stored_evaluation row = {
      .scenarios = history->scenarios, .cases = history->cases, .raw = history->unmodified};
  enum eo_code code = find_row(history, &none, &row, error);
  if (!code && !row.id && is_older(&history->design))
    code = find_row(history, &nothing, &row, error);
  for (int i = 0; !code && !row.id && i < history->scenarios * history->cases; i++)
    history->unmodified[i].failed = true;
  return code;
}

static enum eo_code weigh(struct history *history, const char *modification, int states,
                          struct eo_objective_value *value, struct eo_error *error)
{
  enum eo_code code = eo_modification_read(modification, &history->design.modification, error);
  history->design.drawn.first = states < history->scenarios ? states : 0;
  if (!code)
    eo_evaluator_combine(&history->design, &history->geometry, history->raw, history->unmodified, value);
  return code;
}

struct row {
  struct eo_stored_candidate candidate;
  struct eo_stored_evaluation evaluation;
  struct eo_objective_value value;
};

static json_t *write_modification(const void *source)
{
  const char *text = ((const struct row *)source)->evaluation.modification;
  return eo_json_parse(text, strlen(text), NULL);
}

static const struct eo_outline_row history_rows[] = {
    EO_KEY("ordinal", "integer", "from 0, in the order in which the job asked", EO_AT(struct row, candidate.ordinal)),
    EO_KEY("generation", "integer", "from 0", EO_AT(struct row, candidate.generation)),
    EO_KEY("individual", "integer", "of its generation, from 0", EO_AT(struct row, candidate.individual)),
    EO_KEY("outcome", "word", "refused: the modification is impossible", .words = eo_store_outcomes,
           EO_AT(struct row, evaluation.outcome)),
    EO_KEY("reason", "text", "why it has no value; else empty", EO_AT(struct row, evaluation.reason)),
    EO_KEY("modification", "object", "what is not at its default", .table = &eo_modification_table,
           .name = "SparseModification", .sparse = true, .write = write_modification),
    {.outline = &eo_outline_value, .offset = offsetof(struct row, value)},
    EO_KEY("reused", "flag", "the history knew it before the job asked", EO_AT(struct row, candidate.reused)),
    EO_KEY("states", "integer", "of the pair that its values are over: 1, scenarios, or pairs as made",
           EO_AT(struct row, evaluation.scenarios)),
};
const struct eo_outline eo_job_history_outline = EO_OUTLINE("JobHistoryRow", history_rows);

static enum eo_code add_row(struct history *history, const struct eo_stored_candidate *candidate, struct eo_text *text,
                            struct eo_error *error)
{
  struct row row = {.candidate = *candidate,
                    .evaluation = {.scenarios = history->scenarios, .cases = history->cases, .raw = history->raw}};
  EO_TRY(eo_store_get_evaluation(history->store, candidate->evaluation, &row.evaluation, text, error));
  EO_TRY(weigh(history, row.evaluation.modification, row.evaluation.scenarios, &row.value, error));
  return json_array_append_new(history->items, eo_outline_encode(&eo_job_history_outline, &row))
             ? eo_error_memory(error)
             : EO_OK;
}

static enum eo_code take_candidate(void *context, const struct eo_stored_candidate *candidate, struct eo_error *error)
{
  struct history *history = context;
  struct eo_text text = {0};
  if ((int)json_array_size(history->items) == history->limit) {
    history->more = true;
    return EO_OK;
  }
  enum eo_code code = add_row(history, candidate, &text, error);
  history->last = candidate->ordinal;
  eo_text_done(&text);
  return code;
}

static enum eo_code collect(struct history *history, int64_t job, int after, int limit, enum eo_job_outcome *outcome,
                            struct eo_error *error)
{
  enum eo_code code = eo_queue_find(history->store, job, take_job, history, outcome, error);
  if (code || *outcome != EO_JOB_OUTCOME_DONE)
    return code;
  code = reserve(history, error);
  if (code || !history->problem) /* it has not begun */
    return code;
  history->limit = limit;
  code = find_unmodified(history, error);
  if (!code)
    code = eo_store_page_candidates(history->store, job, after, limit < INT_MAX ? limit + 1 : limit, take_candidate,
                                    history, error);
  return code;
}

static enum eo_code begin(struct history **history, struct eo_store *store, struct eo_error *error)
{
  *history = calloc(1, sizeof **history);
  if (!*history)
    return eo_error_memory(error);
  (*history)->store = store;
  return EO_OK;
}

static const struct eo_outline_row page_rows[] = {
    EO_PAGE_ROWS("true evaluations in their order", .outline = &eo_job_history_outline),
};
const struct eo_outline eo_outline_job_history_page = EO_OUTLINE("JobHistory", page_rows);

enum eo_code eo_job_history(struct eo_store *store, int64_t job, int after, int limit, enum eo_job_outcome *outcome,
                            json_t **page, struct eo_error *error)
{
  struct history *history;
  enum eo_code code = begin(&history, store, error);
  if (code)
    return code;
  *page = NULL;
  code = collect(history, job, after, limit, outcome, error);
  if (!code && *outcome == EO_JOB_OUTCOME_DONE) {
    *page = eo_page_encode(&eo_outline_job_history_page, json_incref(history->items), history->more, history->last);
    code = *page ? EO_OK : eo_error_memory(error);
  }
  done(history);
  return code;
}

static const char *const plain_columns[] = {"ordinal", "generation", "individual",  "outcome", "reused",
                                            "f1_um",   "f2_N",       "f3_m_per_s2", "J",       "fitness"};
enum { PLAIN = sizeof plain_columns / sizeof plain_columns[0] };

static void add_cell(struct eo_text_table *sheet, const json_t *value, double standard)
{
  if (json_is_string(value))
    eo_text_table_string(sheet, json_string_value(value));
  else if (json_is_boolean(value))
    eo_text_table_string(sheet, json_is_true(value) ? "true" : "false");
  else
    eo_text_table_number(sheet, json_is_number(value) ? json_number_value(value) : standard, NULL, 0);
}

static void write_rows(const json_t *items, const json_t *paths, const char **heading, struct eo_text *text)
{
  struct eo_text_table sheet;
  const char *key;
  json_t *row, *value;
  size_t i;
  int columns = PLAIN;
  memcpy(heading, plain_columns, sizeof plain_columns);
  json_object_foreach((json_t *)paths, key, value) heading[columns++] = key;
  eo_text_table_init(&sheet, columns, heading);
  json_array_foreach((json_t *)items, i, row)
  {
    for (int j = 0; j < PLAIN; j++)
      add_cell(&sheet, json_object_get(row, plain_columns[j]), NAN);
    for (int j = PLAIN; j < columns; j++)
      add_cell(&sheet, eo_json_find(json_object_get(row, "modification"), heading[j]), 0);
  }
  eo_text_table_csv(&sheet, text);
  eo_text_table_done(&sheet);
}

static enum eo_code write_csv(const json_t *items, struct eo_text *text, struct eo_error *error)
{
  json_t *paths = eo_modification_columns(items);
  const char **heading = calloc(PLAIN + json_object_size(paths), sizeof *heading);
  if (paths && heading)
    write_rows(items, paths, heading, text);
  else
    text->failed = true;
  free(heading);
  json_decref(paths);
  return text->failed ? eo_error_memory(error) : EO_OK;
}

enum eo_code eo_job_history_csv(struct eo_store *store, int64_t job, enum eo_job_outcome *outcome, struct eo_text *text,
                                struct eo_error *error)
{
  struct history *history;
  enum eo_code code = begin(&history, store, error);
  if (code)
    return code;
  code = collect(history, job, -1, INT_MAX, outcome, error);
  if (!code && *outcome == EO_JOB_OUTCOME_DONE)
    code = write_csv(history->items, text, error);
  done(history);
  return code;
}
