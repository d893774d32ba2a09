/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/jobs.h"

#include "store/evaluations.h"
#include "store/job_row.h"
#include "store/lock.h"

#include <limits.h>
#include <string.h>

const char *const eo_store_job_states[] = {"queued", "preparing", "running", "done", "failed", "cancelled", NULL};
const char *const eo_store_job_kinds[] = {"optimize", "prepare", "study", "tolerance", "reproduce", NULL};

const char *eo_store_job_state_name(enum eo_job_state state)
{
  return eo_store_job_states[state];
}

const char *eo_store_job_kind_name(enum eo_job_kind kind)
{
  return eo_store_job_kinds[kind];
}

static int find_name(const char *const *names, int count, const char *name)
{
  int i = count - 1;
  while (i >= 0 && strcmp(names[i], name) != 0)
    i--;
  return i;
}

int eo_store_job_state_find(const char *name)
{
  return find_name(eo_store_job_states, EO_JOB_STATES, name);
}

int eo_store_job_kind_find(const char *name)
{
  return find_name(eo_store_job_kinds, EO_JOB_KINDS, name);
}

struct eo_stored_job eo_job_row_read(const struct eo_statement *statement)
{
  return (struct eo_stored_job){.id = eo_column_integer(statement, 0),
                                .problem = eo_column_integer(statement, 1),
                                .study = eo_column_text(statement, 2),
                                .space = eo_column_text(statement, 3),
                                .design = eo_column_text(statement, 4),
                                .name = eo_column_text(statement, 5),
                                .algorithm = eo_column_text(statement, 6),
                                .fresh = eo_column_integer(statement, 7) != 0,
                                .import_upto = eo_column_integer(statement, 8),
                                .state = (enum eo_job_state)eo_store_job_state_find(eo_column_text(statement, 9)),
                                .stopped = eo_column_text(statement, 10),
                                .true_evaluations = (int)eo_column_integer(statement, 11),
                                .individuals = (int)eo_column_integer(statement, 12),
                                .best = eo_column_integer(statement, 13),
                                .best_value = eo_column_number(statement, 14),
                                .result = eo_column_text(statement, 15),
                                .created = eo_column_text(statement, 16),
                                .updated = eo_column_text(statement, 17),
                                .kind = (enum eo_job_kind)eo_store_job_kind_find(eo_column_text(statement, 18)),
                                .pair = eo_column_text(statement, 19),
                                .served = eo_column_integer(statement, 20) != 0,
                                .priority = (int)eo_column_integer(statement, 21),
                                .stop = eo_column_integer(statement, 22) != 0,
                                .attempts = (int)eo_column_integer(statement, 23),
                                .error = eo_column_text(statement, 24),
                                .progress = eo_column_text(statement, 25),
                                .started = eo_column_text(statement, 26),
                                .finished = eo_column_text(statement, 27),
                                .spec = eo_column_text(statement, 28)};
}

enum eo_code eo_store_add_job(struct eo_store *store, struct eo_stored_job *job, struct eo_error *error)
{
  enum eo_code code = eo_store_last_evaluation(store, &job->import_upto, error);
  if (!code)
    code = EO_STATEMENT_RUN(
        store, error,
        "INSERT INTO job (kind, spec, problem, study, space, design, name, algorithm, fresh, import_upto,"
        " state, attempts, started) VALUES (?, ?, nullif(?, 0), ?, ?, ?, ?, ?, ?, ?, ?, 1, " EO_NOW ")",
        "ttitttttnit", eo_store_job_kinds[job->kind], job->spec, job->problem, job->study, job->space, job->design,
        job->name, job->algorithm, (int)job->fresh, job->import_upto, eo_store_job_states[job->state]);
  job->id = sqlite3_last_insert_rowid(store->handle);
  return code;
}

enum eo_code eo_store_resume_job(struct eo_store *store, const char *study, bool fresh, struct eo_stored_job *job,
                                 struct eo_error *error)
{
  struct eo_statement statement = eo_statement_begin(
      store,
      "SELECT id, import_upto FROM job WHERE study = ? AND fresh = ? AND state IN ('running', 'cancelled', 'done')"
      " ORDER BY id DESC",
      "tn", study, (int)fresh);
  enum eo_code code = EO_OK;
  bool taken = false;
  job->id = 0;
  while (!code && !taken && eo_statement_step(&statement)) {
    job->id = eo_column_integer(&statement, 0);
    job->import_upto = eo_column_integer(&statement, 1);
    code = eo_store_claim_job(store, job->id, &taken, error);
  }
  enum eo_code end = eo_statement_end(&statement, code ? NULL : error);
  if (!taken)
    job->id = 0;
  code = code ? code : end;
  /* whoever takes it up has it from now on: no server queues it again */
  return code || !taken
             ? code
             : EO_STATEMENT_RUN(store, error, "UPDATE job SET served = 0 WHERE id = ? AND served = 1", "i", job->id);
}

/* A job of an older model took another path. */
static enum eo_code forget_path(struct eo_store *store, int64_t job, struct eo_error *error)
{
  EO_TRY(EO_STATEMENT_RUN(store, error, "DELETE FROM candidate WHERE job = ?", "i", job));
  EO_TRY(EO_STATEMENT_RUN(store, error, "DELETE FROM prediction WHERE job = ?", "i", job));
  EO_TRY(EO_STATEMENT_RUN(store, error, "DELETE FROM variant WHERE job = ?", "i", job));
  return EO_STATEMENT_RUN(store, error,
                          "UPDATE job SET import_upto = NULL, best = NULL, best_value = NULL WHERE id = ?", "i", job);
}

enum eo_code eo_store_begin_job(struct eo_store *store, struct eo_stored_job *job, bool *resumed,
                                struct eo_error *error)
{
  bool there = false, same = false, taken = false;
  struct eo_statement statement = eo_statement_begin(
      store, "SELECT study IS ?2, import_upto IS NOT NULL FROM job WHERE id = ?1", "it", job->id, job->study);
  if ((there = eo_statement_step(&statement))) {
    same = eo_column_integer(&statement, 0) != 0;
    *resumed = same && eo_column_integer(&statement, 1);
  }
  EO_TRY(eo_statement_end(&statement, error));
  if (!there)
    return eo_error_set(error, EO_ERROR_INPUT, "", "There is no job %lld.", (long long)job->id);
  EO_TRY(eo_store_claim_job(store, job->id, &taken, error));
  if (!taken)
    return eo_error_set(error, EO_ERROR_INPUT, "", "Another process works on job %lld.", (long long)job->id);
  if (!same)
    EO_TRY(forget_path(store, job->id, error));
  statement = eo_statement_begin(
      store,
      "UPDATE job SET state = 'running', problem = nullif(?, 0), study = ?, space = ?, updated = " EO_NOW ","
      " import_upto = coalesce(import_upto, (SELECT coalesce(max(id), 0) FROM evaluation)) WHERE id "
      "= ? RETURNING import_upto",
      "itti", job->problem, job->study, job->space, job->id);
  while (eo_statement_step(&statement))
    job->import_upto = eo_column_integer(&statement, 0);
  return eo_statement_end(&statement, error);
}

enum eo_code eo_store_update_job(struct eo_store *store, const struct eo_stored_job *job, struct eo_error *error)
{
  return EO_STATEMENT_RUN(
      store, error,
      "UPDATE job SET state = ?1, stopped = ?2, true_evaluations = ?3, individuals = ?4, best = nullif(?5, 0),"
      " best_value = ?6, updated = " EO_NOW ", finished = CASE WHEN ?1 IN ('done', 'failed', 'cancelled') THEN " EO_NOW
      " END"
      " WHERE id = ?7",
      "ttnniri", eo_store_job_states[job->state], job->stopped ? job->stopped : "", job->true_evaluations,
      job->individuals, job->best, job->best_value, job->id);
}

enum eo_code eo_store_job_shall_stop(struct eo_store *store, int64_t job, bool *stop, struct eo_error *error)
{
  struct eo_statement statement = eo_statement_begin(store, "SELECT stop FROM job WHERE id = ?", "i", job);
  *stop = eo_statement_step(&statement) && eo_column_integer(&statement, 0) != 0;
  return eo_statement_end(&statement, error);
}

enum eo_code eo_store_keep_result(struct eo_store *store, int64_t job, const char *result, struct eo_error *error)
{
  return EO_STATEMENT_RUN(store, error, "UPDATE job SET result = ? WHERE id = ?", "ti", result, job);
}

/* The point belongs to the evaluation: it outlives the job. */
static enum eo_code keep_point(struct eo_store *store, const struct eo_stored_candidate *candidate,
                               struct eo_error *error)
{
  return EO_STATEMENT_RUN(store, error,
                          "INSERT OR IGNORE INTO point (evaluation, space, x) SELECT ?, space, ? FROM job WHERE id = ? "
                          "AND space IS NOT NULL",
                          "ibi", candidate->evaluation, (const void *)candidate->x,
                          (size_t)candidate->size * sizeof *candidate->x, candidate->job);
}

enum eo_code eo_store_log_candidate(struct eo_store *store, struct eo_stored_candidate *candidate,
                                    struct eo_error *error)
{
  enum eo_code code =
      EO_STATEMENT_RUN(store, error,
                       "INSERT INTO candidate (job, ordinal, generation, individual, evaluation, reused, x)"
                       " VALUES (?, ?, ?, ?, ?, ?, ?) ON CONFLICT (job, ordinal) DO NOTHING",
                       "innninb", candidate->job, candidate->ordinal, candidate->generation, candidate->individual,
                       candidate->evaluation, (int)candidate->reused, (const void *)candidate->x,
                       (size_t)candidate->size * sizeof *candidate->x);
  if (code)
    return code;
  if (sqlite3_changes(store->handle))
    return candidate->reused ? EO_OK : keep_point(store, candidate, error);
  struct eo_statement statement = eo_statement_begin(
      store, "SELECT reused FROM candidate WHERE job = ? AND ordinal = ?", "in", candidate->job, candidate->ordinal);
  if (eo_statement_step(&statement))
    candidate->reused = eo_column_integer(&statement, 0) != 0;
  return eo_statement_end(&statement, error);
}

enum eo_code eo_store_log_prediction(struct eo_store *store, const struct eo_stored_prediction *prediction,
                                     struct eo_error *error)
{
  return EO_STATEMENT_RUN(
      store, error,
      "INSERT INTO prediction (job, generation, individual, fitness, credibility, x) VALUES (?, ?, ?, ?, ?, ?)"
      " ON CONFLICT (job, generation, individual) DO NOTHING",
      "innrrb", prediction->job, prediction->generation, prediction->individual, prediction->fitness,
      prediction->credibility, (const void *)prediction->x, (size_t)prediction->size * sizeof *prediction->x);
}

enum eo_code eo_store_each_job(struct eo_store *store, int64_t problem, eo_store_visit_job *visit, void *context,
                               struct eo_error *error)
{
  struct eo_statement statement = eo_statement_begin(
      store, "SELECT " EO_JOB_COLUMNS("design", "spec", "result") " FROM job WHERE ?1 = 0 OR problem = ?1 ORDER BY id",
      "i", problem);
  enum eo_code code = EO_OK;
  while (!code && eo_statement_step(&statement)) {
    const struct eo_stored_job job = eo_job_row_read(&statement);
    code = visit(context, &job, error);
  }
  enum eo_code end = eo_statement_end(&statement, code ? NULL : error);
  return code ? code : end;
}

/* SQLite aligns a blob's bytes for nothing in particular. */
struct point {
  double x[64];
  int size;
};

static void read_point(const struct eo_statement *statement, int column, struct point *point)
{
  size_t bytes = (size_t)sqlite3_column_bytes(statement->handle, column);
  const void *x = sqlite3_column_blob(statement->handle, column);
  if (!x || bytes > sizeof point->x)
    bytes = 0;
  point->size = (int)(bytes / sizeof point->x[0]);
  if (bytes)
    memcpy(point->x, x, bytes);
}

enum eo_code eo_store_page_candidates(struct eo_store *store, int64_t job, int after, int limit,
                                      eo_store_visit_candidate *visit, void *context, struct eo_error *error)
{
  struct eo_statement statement =
      eo_statement_begin(store,
                         "SELECT evaluation, ordinal, generation, individual, reused, x FROM candidate"
                         " WHERE job = ? AND ordinal > ? ORDER BY ordinal LIMIT ?",
                         "inn", job, after, limit);
  enum eo_code code = EO_OK;
  struct point point;
  while (!code && eo_statement_step(&statement)) {
    read_point(&statement, 5, &point);
    const struct eo_stored_candidate candidate = {.job = job,
                                                  .evaluation = eo_column_integer(&statement, 0),
                                                  .ordinal = (int)eo_column_integer(&statement, 1),
                                                  .generation = (int)eo_column_integer(&statement, 2),
                                                  .individual = (int)eo_column_integer(&statement, 3),
                                                  .reused = eo_column_integer(&statement, 4) != 0,
                                                  .x = point.x,
                                                  .size = point.size};
    code = visit(context, &candidate, error);
  }
  enum eo_code end = eo_statement_end(&statement, code ? NULL : error);
  return code ? code : end;
}

enum eo_code eo_store_each_candidate(struct eo_store *store, int64_t job, eo_store_visit_candidate *visit,
                                     void *context, struct eo_error *error)
{
  return eo_store_page_candidates(store, job, -1, INT_MAX, visit, context, error);
}

enum eo_code eo_store_each_prediction(struct eo_store *store, int64_t job, eo_store_visit_prediction *visit,
                                      void *context, struct eo_error *error)
{
  struct eo_statement statement =
      eo_statement_begin(store,
                         "SELECT generation, individual, fitness, credibility, x FROM prediction WHERE job = ?"
                         " ORDER BY generation, individual",
                         "i", job);
  enum eo_code code = EO_OK;
  struct point point;
  while (!code && eo_statement_step(&statement)) {
    read_point(&statement, 4, &point);
    const struct eo_stored_prediction prediction = {.job = job,
                                                    .generation = (int)eo_column_integer(&statement, 0),
                                                    .individual = (int)eo_column_integer(&statement, 1),
                                                    .fitness = eo_column_number(&statement, 2),
                                                    .credibility = eo_column_number(&statement, 3),
                                                    .x = point.x,
                                                    .size = point.size};
    code = visit(context, &prediction, error);
  }
  enum eo_code end = eo_statement_end(&statement, code ? NULL : error);
  return code ? code : end;
}

/* One generation of one job: a few thousand rows, after which others can write. */
static enum eo_code remove_generation(struct eo_store *store, struct eo_error *error)
{
  return EO_STATEMENT_RUN(
      store, error,
      "DELETE FROM prediction WHERE (job, generation) = (SELECT p.job, p.generation FROM job j JOIN prediction p"
      " ON p.job = j.id WHERE j.state IN ('done', 'failed') LIMIT 1)",
      "");
}

enum eo_code eo_store_remove_predictions(struct eo_store *store, int64_t *removed, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  int64_t step = 1;
  for (*removed = 0; step && !code; *removed += step) {
    code = remove_generation(store, error);
    step = code ? 0 : sqlite3_changes64(store->handle);
  }
  return code;
}
