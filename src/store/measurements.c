/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/measurements.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "store/measurement_files.h"
#include "store/statement.h"

#define COLUMNS "id, design, digest, label, torque_Nm, speed_rad_s, ifnull(layout, ''), pair, summary, created"

static enum eo_code read_files(struct eo_store *store, struct eo_stored_measurement *measurement,
                               struct eo_error *error)
{
  struct eo_statement statement = eo_statement_begin(
      store, "SELECT name, size, sha256 FROM measurement_file WHERE measurement = ? ORDER BY ordinal", "i",
      measurement->id);
  for (measurement->files = 0; measurement->files < EO_MEASUREMENT_FILES && eo_statement_step(&statement);
       measurement->files++) {
    struct eo_measurement_file *file = &measurement->file[measurement->files];
    snprintf(file->name, sizeof file->name, "%s", eo_column_text(&statement, 0));
    file->size = eo_column_integer(&statement, 1);
    snprintf(file->sha256, sizeof file->sha256, "%s", eo_column_text(&statement, 2));
  }
  return eo_statement_end(&statement, error);
}

/* Hands every row over; *rows: how many there were. */
static enum eo_code visit_all(struct eo_statement statement, eo_store_visit_measurement *visit, void *context,
                              int *rows, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  *rows = 0;
  while (!code && eo_statement_step(&statement)) {
    struct eo_stored_measurement measurement = {.id = eo_column_integer(&statement, 0),
                                                .design = eo_column_integer(&statement, 1),
                                                .digest = eo_column_text(&statement, 2),
                                                .unmodified = strcmp(eo_column_text(&statement, 3), "unmodified") == 0,
                                                .torque = eo_column_number(&statement, 4),
                                                .speed = eo_column_number(&statement, 5),
                                                .layout = eo_column_text(&statement, 6),
                                                .pair = eo_column_text(&statement, 7),
                                                .summary = eo_column_text(&statement, 8),
                                                .created = eo_column_text(&statement, 9),
                                                .result = eo_column_text(&statement, 10)};
    ++*rows;
    code = read_files(statement.store, &measurement, error);
    if (!code && visit)
      code = visit(context, &measurement, error);
  }
  enum eo_code end = eo_statement_end(&statement, code ? NULL : error);
  return code ? code : end;
}

enum eo_code eo_store_find_measurement(struct eo_store *store, int64_t id, eo_store_visit_measurement *visit,
                                       void *context, enum eo_measurement_outcome *outcome, struct eo_error *error)
{
  int rows;
  enum eo_code code =
      visit_all(eo_statement_begin(store, "SELECT " COLUMNS ", result FROM measurement WHERE id = ?", "i", id), visit,
                context, &rows, error);
  *outcome = rows ? EO_MEASUREMENT_DONE : EO_MEASUREMENT_MISSING;
  return code;
}

enum eo_code eo_store_find_measurement_digest(struct eo_store *store, const char *digest,
                                              eo_store_visit_measurement *visit, void *context,
                                              enum eo_measurement_outcome *outcome, struct eo_error *error)
{
  int rows;
  enum eo_code code =
      visit_all(eo_statement_begin(store, "SELECT " COLUMNS ", result FROM measurement WHERE digest = ?", "t", digest),
                visit, context, &rows, error);
  *outcome = rows ? EO_MEASUREMENT_DONE : EO_MEASUREMENT_MISSING;
  return code;
}

enum eo_code eo_store_list_measurements(struct eo_store *store, int64_t design, int64_t before, int limit,
                                        eo_store_visit_measurement *visit, void *context, struct eo_error *error)
{
  int rows;
  return visit_all(eo_statement_begin(store,
                                      "SELECT " COLUMNS
                                      ", '' FROM measurement WHERE (?1 = 0 OR design = ?1) AND (?2 = 0 OR id < ?2) "
                                      "ORDER BY id DESC LIMIT ?3",
                                      "iin", design, before, limit),
                   visit, context, &rows, error);
}

enum eo_code eo_store_measured_bytes(struct eo_store *store, int64_t *bytes, struct eo_error *error)
{
  struct eo_statement statement = eo_statement_begin(store, "SELECT ifnull(sum(size), 0) FROM measurement_file", "");
  *bytes = eo_statement_step(&statement) ? eo_column_integer(&statement, 0) : 0;
  return eo_statement_end(&statement, error);
}

static enum eo_code has_design(struct eo_store *store, int64_t design, bool *there, struct eo_error *error)
{
  struct eo_statement statement = eo_statement_begin(store, "SELECT 1 FROM design WHERE id = ?", "i", design);
  *there = eo_statement_step(&statement);
  return eo_statement_end(&statement, error);
}

/* Above every number that was ever given and every folder that bears one: after an older database was put back there
   are folders that it knows nothing of. */
static enum eo_code next_number(struct eo_store *store, int64_t *id, struct eo_error *error)
{
  struct eo_statement statement = eo_statement_begin(
      store, "SELECT max(?, ifnull((SELECT seq FROM sqlite_sequence WHERE name = 'measurement'), 0)) + 1", "i",
      eo_measurement_folder_highest(store));
  *id = eo_statement_step(&statement) ? eo_column_integer(&statement, 0) : 0;
  enum eo_code code = eo_statement_end(&statement, error);
  while (!code && eo_measurement_folder_is_there(store, *id))
    ++*id;
  return code;
}

static enum eo_code insert(struct eo_store *store, const struct eo_stored_measurement *measurement, int64_t *id,
                           struct eo_error *error)
{
  enum eo_code code = next_number(store, id, error);
  if (!code)
    code = EO_STATEMENT_RUN(
        store, error,
        "INSERT INTO measurement (id, design, digest, label, torque_Nm, speed_rad_s, layout, pair, summary, result) "
        "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
        "iittrrtttt", *id, measurement->design, measurement->digest,
        measurement->unmodified ? "unmodified" : "modified", measurement->torque, measurement->speed,
        *measurement->layout ? measurement->layout : NULL, measurement->pair, measurement->summary,
        measurement->result);
  for (int i = 0; i < measurement->files && !code; i++)
    code = EO_STATEMENT_RUN(
        store, error, "INSERT INTO measurement_file (measurement, ordinal, name, size, sha256) VALUES (?, ?, ?, ?, ?)",
        "intit", *id, i, measurement->file[i].name, measurement->file[i].size, measurement->file[i].sha256);
  return code;
}

/* *kept: the number that the folder bears from then on. */
static enum eo_code add(struct eo_store *store, const struct eo_stored_measurement *measurement, const char *folder,
                        int64_t *kept, eo_store_visit_measurement *visit, void *context,
                        enum eo_measurement_outcome *outcome, struct eo_error *error)
{
  int64_t id;
  bool design;
  enum eo_code code = has_design(store, measurement->design, &design, error);
  *outcome = EO_MEASUREMENT_NO_DESIGN;
  if (code || !design)
    return code;
  code = eo_store_find_measurement_digest(store, measurement->digest, visit, context, outcome, error);
  if (code || *outcome == EO_MEASUREMENT_DONE) {
    *outcome = EO_MEASUREMENT_KNOWN;
    return code;
  }
  EO_TRY(insert(store, measurement, &id, error));
  EO_TRY(eo_measurement_folder_keep(store, folder, id, error));
  *kept = id;
  return eo_store_find_measurement(store, id, visit, context, outcome, error);
}

enum eo_code eo_store_add_measurement(struct eo_store *store, const struct eo_stored_measurement *measurement,
                                      const char *folder, eo_store_visit_measurement *visit, void *context,
                                      enum eo_measurement_outcome *outcome, struct eo_error *error)
{
  int64_t kept = 0;
  EO_TRY(eo_measurement_folder_flush(folder, measurement->files, error));
  EO_TRY(eo_store_begin_lasting(store, error));
  enum eo_code code = eo_store_end(store, add(store, measurement, folder, &kept, visit, context, outcome, error),
                                   error);
  if (code && kept)
    eo_measurement_folder_give_back(store, folder, kept);
  return code;
}

static enum eo_code remove_row(struct eo_store *store, int64_t id, enum eo_measurement_outcome *outcome,
                               struct eo_error *error)
{
  enum eo_code code = EO_STATEMENT_RUN(store, error, "DELETE FROM measurement WHERE id = ?", "i", id);
  bool gone = !code && sqlite3_changes(store->handle);
  *outcome = gone ? EO_MEASUREMENT_DONE : EO_MEASUREMENT_MISSING;
  return gone ? eo_measurement_folder_mark(store, id, true, error) : code;
}

/* The folder is marked before the row is gone for good: a start that finds the mark without a row knows that the
   deletion was asked for, and one that finds both takes the mark off. */
enum eo_code eo_store_remove_measurement(struct eo_store *store, int64_t id, enum eo_measurement_outcome *outcome,
                                         struct eo_error *error)
{
  enum eo_code code = eo_store_begin_lasting(store, error);
  if (code)
    return code;
  code = eo_store_end(store, remove_row(store, id, outcome, error), error);
  if (*outcome == EO_MEASUREMENT_DONE && code)
    eo_measurement_folder_mark(store, id, false, NULL);
  else if (*outcome == EO_MEASUREMENT_DONE)
    eo_measurement_folder_drop(store, id);
  return code;
}
