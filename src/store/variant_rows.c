/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/variant_rows.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "store/statement.h"

#define COLUMNS "r.id, r.outcome, r.reason, r.cost_s, r.numbers, r.digest, r.design, r.evaluator, r.columns"

/* Every NaN has the bytes of one. */
static void settle(struct eo_stored_variant *row)
{
  for (int i = 0; i < row->numbers; i++)
    if (!isfinite(row->number[i]))
      row->number[i] = NAN;
}

static void find_digest(const struct eo_stored_variant *row, char digest[EO_HASH_LENGTH + 1])
{
  struct eo_hash hash;
  eo_hash_init(&hash);
  eo_hash_add_text(&hash, "design", row->design);
  eo_hash_add_text(&hash, "outcome", eo_store_outcome_name(row->outcome));
  eo_hash_add_text(&hash, "reason", row->reason);
  eo_hash_add_number(&hash, "cost", row->cost);
  for (int i = 0; i < row->numbers; i++)
    eo_hash_add_number(&hash, "number", row->number[i]);
  eo_hash_finish(&hash, digest);
}

static enum eo_code damaged(const struct eo_store *store, int64_t id, struct eo_error *error)
{
  return eo_error_set(error, EO_ERROR_DAMAGED, "", "%.150s: row %lld of the studies is damaged.", store->path,
                      (long long)id);
}

/* Columns as above; row->number has room for row->numbers. */
static enum eo_code read_row(const struct eo_store *store, const struct eo_statement *statement,
                             struct eo_stored_variant *row, struct eo_error *error)
{
  char digest[EO_HASH_LENGTH + 1];
  int outcome = 0;
  row->id = eo_column_integer(statement, 0);
  while (outcome < EO_EVALUATION_REFUSED && strcmp(eo_store_outcomes[outcome], eo_column_text(statement, 1)) != 0)
    outcome++;
  row->outcome = (enum eo_evaluation_outcome)outcome;
  snprintf(row->reason, sizeof row->reason, "%s", eo_column_text(statement, 2));
  row->cost = eo_column_number(statement, 3);
  row->design = eo_column_text(statement, 6);
  row->evaluator = (int)eo_column_integer(statement, 7);
  row->columns = eo_column_integer(statement, 8);
  if (!row->number)
    return EO_OK;
  const void *numbers = sqlite3_column_blob(statement->handle, 4);
  if ((size_t)sqlite3_column_bytes(statement->handle, 4) != sizeof *row->number * (size_t)row->numbers)
    return damaged(store, row->id, error);
  if (row->numbers)
    memcpy(row->number, numbers, sizeof *row->number * (size_t)row->numbers);
  find_digest(row, digest);
  return strcmp(digest, eo_column_text(statement, 5)) == 0 ? EO_OK : damaged(store, row->id, error);
}

enum eo_code eo_store_variant_columns(struct eo_store *store, const char *names, int64_t *id, struct eo_error *error)
{
  EO_TRY(EO_STATEMENT_RUN(store, error, "INSERT INTO variant_columns (names) VALUES (?) ON CONFLICT (names) DO NOTHING",
                          "t", names));
  struct eo_statement statement = eo_statement_begin(store, "SELECT id FROM variant_columns WHERE names = ?", "t",
                                                     names);
  *id = eo_statement_step(&statement) ? eo_column_integer(&statement, 0) : 0;
  return eo_statement_end(&statement, error);
}

enum eo_code eo_store_has_variants(struct eo_store *store, int evaluator, int64_t columns, bool *there,
                                   struct eo_error *error)
{
  struct eo_statement statement = eo_statement_begin(
      store, "SELECT 1 FROM variant_row WHERE evaluator = ? AND columns = ? LIMIT 1", "ni", evaluator, columns);
  *there = eo_statement_step(&statement);
  return eo_statement_end(&statement, error);
}

enum eo_code eo_store_find_variant(struct eo_store *store, struct eo_stored_variant *row, struct eo_error *error)
{
  struct eo_stored_variant found = *row;
  struct eo_statement statement = eo_statement_begin(
      store, "SELECT " COLUMNS " FROM variant_row r WHERE design = ? AND evaluator = ? AND columns = ?", "tni",
      row->design, row->evaluator, row->columns);
  enum eo_code code = EO_OK;
  found.id = 0;
  if (eo_statement_step(&statement))
    code = read_row(store, &statement, &found, error);
  enum eo_code end = eo_statement_end(&statement, code ? NULL : error);
  if (code || end)
    return code ? code : end;
  found.design = row->design;
  *row = found;
  return EO_OK;
}

enum eo_code eo_store_add_variant(struct eo_store *store, struct eo_stored_variant *row, struct eo_error *error)
{
  char digest[EO_HASH_LENGTH + 1];
  static const double nothing;
  settle(row);
  find_digest(row, digest);
  EO_TRY(
      EO_STATEMENT_RUN(store, error,
                       "INSERT INTO variant_row (design, evaluator, columns, outcome, reason, cost_s, numbers, digest)"
                       " VALUES (?, ?, ?, ?, ?, ?, ?, ?) ON CONFLICT (design, evaluator, columns) DO NOTHING",
                       "tnittrbt", row->design, row->evaluator, row->columns, eo_store_outcome_name(row->outcome),
                       row->reason, row->cost, (const void *)(row->numbers ? row->number : &nothing),
                       sizeof *row->number * (size_t)row->numbers, digest));
  if (sqlite3_changes(store->handle) == 0)
    return eo_store_find_variant(store, row, error);
  row->id = sqlite3_last_insert_rowid(store->handle);
  return EO_OK;
}

static enum eo_code find_last(struct eo_store *store, int64_t *last, struct eo_error *error)
{
  struct eo_statement statement = eo_statement_begin(store, "SELECT ifnull(max(id), 0) FROM variant_row", "");
  *last = eo_statement_step(&statement) ? eo_column_integer(&statement, 0) : 0;
  return eo_statement_end(&statement, error);
}

enum eo_code eo_store_remove_variants(struct eo_store *store, int evaluator, bool unused, int64_t *removed,
                                      struct eo_error *error)
{
  enum { STEP = 2000 };
  int64_t last;
  EO_TRY(find_last(store, &last, error));
  for (int64_t first = 1; first <= last; first += STEP) {
    EO_TRY(EO_STATEMENT_RUN(store, error,
                            "DELETE FROM variant_row WHERE id BETWEEN ?1 AND ?2 AND ((?3 <> 0 AND evaluator <> ?3) OR"
                            " (?4 = 1 AND NOT EXISTS (SELECT 1 FROM variant WHERE row = variant_row.id)))",
                            "iinn", first, first + STEP - 1, evaluator, (int)unused));
    *removed += sqlite3_changes64(store->handle);
  }
  return EO_OK;
}

enum eo_code eo_store_mean_cost(struct eo_store *store, double *seconds, struct eo_error *error)
{
  struct eo_statement statement = eo_statement_begin(
      store,
      "SELECT avg(cost_s) FROM (SELECT cost_s FROM variant_row WHERE outcome <> 'refused' ORDER BY id DESC LIMIT 1000)",
      "");
  *seconds = eo_statement_step(&statement) ? eo_column_number(&statement, 0) : NAN;
  return eo_statement_end(&statement, error);
}

enum eo_code eo_store_log_variant(struct eo_store *store, int64_t job, int ordinal, int64_t row, bool reused,
                                  struct eo_error *error)
{
  return EO_STATEMENT_RUN(store, error,
                          "INSERT INTO variant (job, ordinal, row, reused) VALUES (?, ?, ?, ?)"
                          " ON CONFLICT (job, ordinal) DO NOTHING",
                          "inin", job, ordinal, row, (int)reused);
}

enum eo_code eo_store_each_variant(struct eo_store *store, int64_t job, int ordinal, int numbers,
                                   eo_store_visit_variant *visit, void *context, struct eo_error *error)
{
  double *number = numbers >= 0 ? malloc(sizeof *number * (size_t)(numbers + 1)) : NULL;
  if (numbers >= 0 && !number)
    return eo_error_memory(error);
  struct eo_statement statement = eo_statement_begin(store,
                                                     "SELECT " COLUMNS ", v.ordinal, v.reused FROM variant v"
                                                     " JOIN variant_row r ON r.id = v.row WHERE v.job = ?1"
                                                     " AND (?2 < 0 OR v.ordinal = ?2) ORDER BY v.ordinal",
                                                     "in", job, ordinal);
  enum eo_code code = EO_OK;
  while (!code && eo_statement_step(&statement)) {
    struct eo_stored_variant row = {.numbers = numbers, .number = number};
    code = read_row(store, &statement, &row, error);
    row.ordinal = (int)eo_column_integer(&statement, 9);
    row.reused = eo_column_integer(&statement, 10) != 0;
    if (!code)
      code = visit(context, &row, error);
  }
  enum eo_code end = eo_statement_end(&statement, code ? NULL : error);
  free(number);
  return code ? code : end;
}
