/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/queue.h"

#include "store/job_row.h"
#include "store/lock.h"

#include <stdlib.h>
#include <string.h>

static enum eo_code find_repeated(struct eo_store *store, const struct eo_queue_entry *entry, int64_t *id,
                                  enum eo_job_outcome *outcome, struct eo_error *error)
{
  struct eo_statement statement = eo_statement_begin(store, "SELECT id, request = ?2 FROM job WHERE idempotency = ?1",
                                                     "tt", entry->key, entry->request);
  if (eo_statement_step(&statement)) {
    *id = eo_column_integer(&statement, 0);
    *outcome = eo_column_integer(&statement, 1) ? EO_JOB_OUTCOME_REPEATED : EO_JOB_OUTCOME_CONFLICT;
  }
  return eo_statement_end(&statement, error);
}

static enum eo_code find_preparation(struct eo_store *store, const char *pair, int64_t *id, struct eo_error *error)
{
  struct eo_statement statement =
      eo_statement_begin(store,
                         "SELECT id FROM job WHERE pair = ? AND kind = 'prepare' AND served = 1 AND stop = 0"
                         " AND state IN ('queued', 'preparing', 'running')",
                         "t", pair);
  if (eo_statement_step(&statement))
    *id = eo_column_integer(&statement, 0);
  return eo_statement_end(&statement, error);
}

static enum eo_code count_waiting(struct eo_store *store, enum eo_job_kind kind, int64_t *count, struct eo_error *error)
{
  struct eo_statement statement =
      eo_statement_begin(store, "SELECT count(*) FROM job WHERE state = 'queued' AND served = 1 AND kind = ?", "t",
                         eo_store_job_kind_name(kind));
  *count = eo_statement_step(&statement) ? eo_column_integer(&statement, 0) : 0;
  return eo_statement_end(&statement, error);
}

static enum eo_code insert(struct eo_store *store, const struct eo_queue_entry *entry, int64_t *id,
                           struct eo_error *error)
{
  enum eo_code code = EO_STATEMENT_RUN(store, error,
                                       "INSERT INTO job (kind, design, spec, name, algorithm, pair, fresh, served, "
                                       "priority, state, idempotency, request)"
                                       " VALUES (?, ?, ?, ?, ?, ?, ?, 1, ?, 'queued', ?, ?)",
                                       "ttttttnntt", eo_store_job_kind_name(entry->kind), entry->design, entry->spec,
                                       entry->name, entry->algorithm, entry->pair, (int)entry->fresh, entry->priority,
                                       entry->key, entry->request);
  *id = sqlite3_last_insert_rowid(store->handle);
  return code;
}

static enum eo_code add(struct eo_store *store, const struct eo_queue_entry *entry, int64_t most, int64_t *id,
                        enum eo_job_outcome *outcome, struct eo_error *error)
{
  int64_t waiting = 0;
  enum eo_code code = entry->key ? find_repeated(store, entry, id, outcome, error) : EO_OK;
  if (code || *id)
    return code;
  code = entry->kind == EO_JOB_PREPARE ? find_preparation(store, entry->pair, id, error) : EO_OK;
  if (code || *id)
    return code;
  code = count_waiting(store, entry->kind, &waiting, error);
  if (!code && waiting >= most) {
    *outcome = EO_JOB_OUTCOME_FULL;
    return EO_OK;
  }
  return code ? code : insert(store, entry, id, error);
}

enum eo_code eo_queue_add(struct eo_store *store, const struct eo_queue_entry *entry, int64_t most, int64_t *id,
                          enum eo_job_outcome *outcome, struct eo_error *error)
{
  *id = 0;
  *outcome = EO_JOB_OUTCOME_DONE;
  EO_TRY(eo_store_begin_lasting(store, error));
  return eo_store_end(store, add(store, entry, most, id, outcome, error), error);
}

enum eo_code eo_queue_claim(struct eo_store *store, enum eo_job_kind kind, int64_t *id, struct eo_error *error)
{
  *id = 0;
  enum eo_code code = eo_store_begin(store, error);
  if (code)
    return code;
  struct eo_statement statement = eo_statement_begin(
      store,
      "UPDATE job SET state = 'preparing', attempts = attempts + 1, started = coalesce(started, " EO_NOW "),"
      " finished = NULL, error = NULL, updated = " EO_NOW " WHERE id = (SELECT id FROM job WHERE kind = ?"
      " AND state = 'queued' AND served = 1 ORDER BY priority DESC, id LIMIT 1) RETURNING id",
      "t", eo_store_job_kind_name(kind));
  while (eo_statement_step(&statement))
    *id = eo_column_integer(&statement, 0);
  code = eo_store_end(store, eo_statement_end(&statement, error), error);
  if (code)
    *id = 0;
  return code;
}

enum eo_code eo_queue_end(struct eo_store *store, int64_t id, enum eo_job_state state, const char *error_text,
                          const char *progress, struct eo_error *error)
{
  return EO_STATEMENT_RUN(
      store, error,
      "UPDATE job SET state = ?2, error = ?3, progress = coalesce(?4, progress), updated = " EO_NOW ","
      " stop = CASE WHEN ?2 = 'queued' THEN 0 ELSE stop END,"
      " finished = CASE WHEN ?2 IN ('done', 'failed', 'cancelled') THEN " EO_NOW " END WHERE id = ?1",
      "ittt", id, eo_store_job_state_name(state), error_text, progress);
}

enum eo_code eo_queue_note(struct eo_store *store, int64_t id, const char *progress, struct eo_error *error)
{
  return EO_STATEMENT_RUN(store, error, "UPDATE job SET progress = ?, updated = " EO_NOW " WHERE id = ?", "ti",
                          progress, id);
}

/* An unclean end counts from one again when the job has come further since the last. */
static enum eo_code count_unclean(struct eo_store *store, int64_t id, struct eo_error *error)
{
  return EO_STATEMENT_RUN(store, error,
                          "UPDATE job SET unclean = CASE WHEN now > reached THEN 1 ELSE unclean + 1 END, reached = now"
                          " FROM (SELECT (SELECT count(*) FROM candidate WHERE job = ?1) + (SELECT count(*) FROM "
                          "variant WHERE job = ?1) AS now)"
                          " WHERE id = ?1 AND stop = 0 AND state IN ('preparing', 'running')",
                          "i", id);
}

/* Leaves alone what a terminal took up meanwhile. */
static enum eo_code recover_one(struct eo_store *store, int64_t id, int attempts, const char *fault, int64_t *queued,
                                struct eo_error *error)
{
  if (eo_store_job_is_taken(store, id))
    return EO_OK;
  EO_TRY(count_unclean(store, id, error));
  struct eo_statement statement = eo_statement_begin(
      store,
      "UPDATE job SET state = CASE WHEN stop = 1 THEN 'cancelled' WHEN unclean >= ?2 THEN 'failed' ELSE 'queued' END,"
      " error = CASE WHEN stop = 0 AND unclean >= ?2 THEN ?3 ELSE error END, updated = " EO_NOW ","
      " finished = CASE WHEN stop = 1 OR unclean >= ?2 THEN " EO_NOW " END WHERE id = ?1 RETURNING state = 'failed'",
      "int", id, attempts, fault);
  while (eo_statement_step(&statement))
    *queued += !eo_column_integer(&statement, 0);
  return eo_statement_end(&statement, error);
}

enum eo_code eo_queue_recover(struct eo_store *store, int attempts, const char *fault, int64_t *queued,
                              struct eo_error *error)
{
  int64_t id = 0;
  *queued = 0;
  enum eo_code code = eo_store_begin(store, error);
  if (code)
    return code;
  /* cancelled without anybody wanting it: parked in the moment the process ended. Done without a result: ended before
     it was written. */
  for (bool more = true; more && !code;) {
    struct eo_statement statement = eo_statement_begin(
        store,
        "SELECT id FROM job WHERE id > ? AND served = 1 AND (state IN ('preparing', 'running') OR (stop = 0 AND"
        " state = 'cancelled') OR (state = 'done' AND kind = 'optimize' AND result IS NULL)) ORDER BY id LIMIT 1",
        "i", id);
    more = eo_statement_step(&statement);
    id = more ? eo_column_integer(&statement, 0) : 0;
    code = eo_statement_end(&statement, error);
    if (!code && more)
      code = recover_one(store, id, attempts, fault, queued, error);
  }
  return eo_store_end(store, code, error);
}

static enum eo_code find_state(struct eo_store *store, int64_t id, enum eo_job_state *state, enum eo_job_kind *kind,
                               enum eo_job_outcome *outcome, struct eo_error *error)
{
  struct eo_statement statement = eo_statement_begin(store, "SELECT state, kind FROM job WHERE id = ?", "i", id);
  *outcome = eo_statement_step(&statement) ? EO_JOB_OUTCOME_DONE : EO_JOB_OUTCOME_MISSING;
  if (*outcome == EO_JOB_OUTCOME_DONE) {
    *state = (enum eo_job_state)eo_store_job_state_find(eo_column_text(&statement, 0));
    *kind = (enum eo_job_kind)eo_store_job_kind_find(eo_column_text(&statement, 1));
  }
  return eo_statement_end(&statement, error);
}

static bool has_ended(enum eo_job_state state)
{
  return state == EO_JOB_DONE || state == EO_JOB_FAILED || state == EO_JOB_CANCELLED;
}

static enum eo_code cancel(struct eo_store *store, int64_t id, enum eo_job_outcome *outcome, struct eo_error *error)
{
  enum eo_job_state state;
  enum eo_job_kind kind;
  enum eo_code code = find_state(store, id, &state, &kind, outcome, error);
  if (code || *outcome)
    return code;
  if (has_ended(state))
    *outcome = EO_JOB_OUTCOME_STATE;
  else if (state == EO_JOB_QUEUED)
    code = EO_STATEMENT_RUN(store, error,
                            "UPDATE job SET state = 'cancelled', stop = 1, finished = " EO_NOW ", updated = " EO_NOW
                            " WHERE id = ?",
                            "i", id);
  else {
    code = EO_STATEMENT_RUN(store, error, "UPDATE job SET stop = 1, updated = " EO_NOW " WHERE id = ? AND served = 1",
                            "i", id);
    if (!code && !sqlite3_changes(store->handle)) /* a terminal's */
      *outcome = EO_JOB_OUTCOME_STATE;
  }
  return code;
}

enum eo_code eo_queue_cancel(struct eo_store *store, int64_t id, enum eo_job_outcome *outcome, struct eo_error *error)
{
  EO_TRY(eo_store_begin_lasting(store, error));
  return eo_store_end(store, cancel(store, id, outcome, error), error);
}

static enum eo_code retry(struct eo_store *store, int64_t id, int64_t most, enum eo_job_outcome *outcome,
                          struct eo_error *error)
{
  enum eo_job_state state;
  enum eo_job_kind kind;
  int64_t waiting = 0;
  enum eo_code code = find_state(store, id, &state, &kind, outcome, error);
  if (code || *outcome)
    return code;
  if ((state != EO_JOB_FAILED && state != EO_JOB_CANCELLED) || eo_store_job_is_taken(store, id)) {
    *outcome = EO_JOB_OUTCOME_STATE;
    return EO_OK;
  }
  EO_TRY(count_waiting(store, kind, &waiting, error));
  if (waiting >= most) {
    *outcome = EO_JOB_OUTCOME_FULL;
    return EO_OK;
  }
  return EO_STATEMENT_RUN(
      store, error,
      "UPDATE job SET state = 'queued', served = 1, stop = 0, stopped = '', error = NULL, started = NULL, unclean = 0,"
      " finished = NULL, updated = " EO_NOW " WHERE id = ?",
      "i", id);
}

enum eo_code eo_queue_retry(struct eo_store *store, int64_t id, int64_t most, enum eo_job_outcome *outcome,
                            struct eo_error *error)
{
  EO_TRY(eo_store_begin_lasting(store, error));
  return eo_store_end(store, retry(store, id, most, outcome, error), error);
}

static enum eo_code clone(struct eo_store *store, int64_t id, const int *priority, int64_t most, int64_t *copy,
                          enum eo_job_outcome *outcome, struct eo_error *error)
{
  enum eo_job_state state;
  enum eo_job_kind kind;
  int64_t waiting = 0;
  EO_TRY(find_state(store, id, &state, &kind, outcome, error));
  if (*outcome)
    return EO_OK;
  EO_TRY(count_waiting(store, kind, &waiting, error));
  if (waiting >= most) {
    *outcome = EO_JOB_OUTCOME_FULL;
    return EO_OK;
  }
  EO_TRY(EO_STATEMENT_RUN(store, error,
                          "INSERT INTO job (kind, design, spec, name, algorithm, pair, fresh, served, priority, state)"
                          " SELECT kind, design, spec, name, algorithm, pair, fresh, 1, CASE ?2 WHEN 1 THEN ?3 ELSE "
                          "priority END, 'queued'"
                          " FROM job WHERE id = ?1",
                          "inn", id, priority != NULL, priority ? *priority : 0));
  *copy = sqlite3_last_insert_rowid(store->handle);
  return EO_OK;
}

enum eo_code eo_queue_clone(struct eo_store *store, int64_t id, const int *priority, int64_t most, int64_t *copy,
                            enum eo_job_outcome *outcome, struct eo_error *error)
{
  *copy = 0;
  EO_TRY(eo_store_begin_lasting(store, error));
  return eo_store_end(store, clone(store, id, priority, most, copy, outcome, error), error);
}

static enum eo_code remove_job(struct eo_store *store, int64_t id, enum eo_job_outcome *outcome, struct eo_error *error)
{
  enum eo_job_state state;
  enum eo_job_kind kind;
  enum eo_code code = find_state(store, id, &state, &kind, outcome, error);
  if (code || *outcome)
    return code;
  if (!has_ended(state) || eo_store_job_is_taken(store, id)) {
    *outcome = EO_JOB_OUTCOME_STATE;
    return EO_OK;
  }
  return EO_STATEMENT_RUN(store, error, "DELETE FROM job WHERE id = ?", "i", id);
}

enum eo_code eo_queue_remove(struct eo_store *store, int64_t id, enum eo_job_outcome *outcome, struct eo_error *error)
{
  EO_TRY(eo_store_begin_lasting(store, error));
  return eo_store_end(store, remove_job(store, id, outcome, error), error);
}

enum eo_code eo_queue_tidy(struct eo_store *store, int keep, struct eo_error *error)
{
  return EO_STATEMENT_RUN(
      store, error,
      "DELETE FROM job WHERE kind = 'prepare' AND state = 'done' AND idempotency IS NULL AND id NOT IN"
      " (SELECT id FROM job WHERE kind = 'prepare' AND state = 'done' ORDER BY id DESC LIMIT ?)",
      "n", keep);
}

/* The oldest job beyond those that are kept; 0: none. */
static enum eo_code find_surplus(struct eo_store *store, int keep, int64_t *id, struct eo_error *error)
{
  struct eo_statement statement = eo_statement_begin(
      store,
      "SELECT min(id) FROM job WHERE kind <> 'prepare' AND served = 1 AND state IN ('done', 'failed', 'cancelled')"
      " AND id NOT IN (SELECT id FROM job WHERE kind <> 'prepare' AND served = 1 AND state IN ('done', 'failed',"
      " 'cancelled') ORDER BY id DESC LIMIT ?)",
      "n", keep);
  *id = eo_statement_step(&statement) ? eo_column_integer(&statement, 0) : 0;
  return eo_statement_end(&statement, error);
}

static enum eo_code remove_old_generation(struct eo_store *store, double days, struct eo_error *error)
{
  return EO_STATEMENT_RUN(
      store, error,
      "DELETE FROM prediction WHERE (job, generation) = (SELECT p.job, p.generation FROM job j JOIN prediction p"
      " ON p.job = j.id WHERE j.finished < strftime('%Y-%m-%dT%H:%M:%fZ', julianday('now') - ?) LIMIT 1)",
      "r", days);
}

enum eo_code eo_queue_retain(struct eo_store *store, int keep, double prediction_days, struct eo_error *error)
{
  enum eo_job_outcome outcome = EO_JOB_OUTCOME_DONE;
  int64_t id = keep > 0, changes = prediction_days > 0;
  while (id && outcome == EO_JOB_OUTCOME_DONE) {
    EO_TRY(find_surplus(store, keep, &id, error));
    if (id)
      EO_TRY(eo_queue_remove(store, id, &outcome, error));
  }
  while (changes) {
    EO_TRY(remove_old_generation(store, prediction_days, error));
    changes = sqlite3_changes64(store->handle);
  }
  return EO_OK;
}

enum eo_code eo_queue_find(struct eo_store *store, int64_t id, eo_store_visit_job *visit, void *context,
                           enum eo_job_outcome *outcome, struct eo_error *error)
{
  struct eo_statement statement =
      eo_statement_begin(store, "SELECT " EO_JOB_COLUMNS("design", "spec", "result") " FROM job WHERE id = ?", "i", id);
  enum eo_code code = EO_OK;
  *outcome = EO_JOB_OUTCOME_MISSING;
  if (eo_statement_step(&statement)) {
    const struct eo_stored_job job = eo_job_row_read(&statement);
    *outcome = EO_JOB_OUTCOME_DONE;
    code = visit(context, &job, error);
  }
  enum eo_code end = eo_statement_end(&statement, code ? NULL : error);
  return code ? code : end;
}

enum eo_code eo_queue_list(struct eo_store *store, const struct eo_queue_filter *filter, eo_store_visit_job *visit,
                           void *context, struct eo_error *error)
{
  struct eo_statement statement = eo_statement_begin(
      store,
      "SELECT " EO_JOB_COLUMNS(
          "''", "''",
          "CASE WHEN result IS NULL THEN '' ELSE '{}' END") " FROM job WHERE (?1 = 0 OR id < ?1) AND (?2 IS NULL "
                                                            "OR state = ?2)"
                                                            " AND (?3 IS NULL OR kind = ?3) AND (?4 = 0 OR state "
                                                            "IN ('queued', 'preparing', 'running')) ORDER BY id "
                                                            "DESC LIMIT ?5",
      "ittnn", filter->before, filter->state < 0 ? NULL : eo_store_job_state_name((enum eo_job_state)filter->state),
      filter->kind < 0 ? NULL : eo_store_job_kind_name((enum eo_job_kind)filter->kind), (int)filter->active,
      filter->limit);
  enum eo_code code = EO_OK;
  while (!code && eo_statement_step(&statement)) {
    const struct eo_stored_job job = eo_job_row_read(&statement);
    code = visit(context, &job, error);
  }
  enum eo_code end = eo_statement_end(&statement, code ? NULL : error);
  return code ? code : end;
}

enum eo_code eo_queue_count(struct eo_store *store, int64_t count[EO_JOB_STATES], struct eo_error *error)
{
  struct eo_statement statement = eo_statement_begin(store, "SELECT state, count(*) FROM job GROUP BY state", "");
  memset(count, 0, sizeof *count * EO_JOB_STATES);
  while (eo_statement_step(&statement))
    count[eo_store_job_state_find(eo_column_text(&statement, 0))] = eo_column_integer(&statement, 1);
  return eo_statement_end(&statement, error);
}
