/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/designs.h"

#include <stddef.h>

#include "store/statement.h"

#define COLUMNS "id, revision, name, document, created, updated"
#define NOW "strftime('%Y-%m-%dT%H:%M:%fZ', 'now')"

/* Hands every row over; *rows: how many there were. */
static enum eo_code visit_all(struct eo_statement statement, eo_store_visit_design *visit, void *context, int *rows,
                              struct eo_error *error)
{
  enum eo_code code = EO_OK;
  *rows = 0;
  while (!code && eo_statement_step(&statement)) {
    const struct eo_stored_design design = {.id = eo_column_integer(&statement, 0),
                                            .revision = eo_column_integer(&statement, 1),
                                            .name = eo_column_text(&statement, 2),
                                            .document = eo_column_text(&statement, 3),
                                            .created = eo_column_text(&statement, 4),
                                            .updated = eo_column_text(&statement, 5)};
    ++*rows;
    code = visit ? visit(context, &design, error) : EO_OK;
  }
  enum eo_code end = eo_statement_end(&statement, code ? NULL : error);
  return code ? code : end;
}

enum eo_code eo_store_find_design(struct eo_store *store, int64_t id, eo_store_visit_design *visit, void *context,
                                  enum eo_design_outcome *outcome, struct eo_error *error)
{
  int rows;
  enum eo_code code = visit_all(eo_statement_begin(store, "SELECT " COLUMNS " FROM design WHERE id = ?", "i", id),
                                visit, context, &rows, error);
  *outcome = rows ? EO_DESIGN_DONE : EO_DESIGN_MISSING;
  return code;
}

static enum eo_code add(struct eo_store *store, const char *name, const char *document, int64_t most,
                        eo_store_visit_design *visit, void *context, enum eo_design_outcome *outcome,
                        struct eo_error *error)
{
  int rows;
  enum eo_code code = EO_STATEMENT_RUN(
      store, error, "INSERT INTO design (name, document) SELECT ?, ? WHERE (SELECT count(*) FROM design) < ?", "tti",
      name, document, most);
  *outcome = sqlite3_changes(store->handle) ? EO_DESIGN_DONE : EO_DESIGN_FULL;
  if (code || *outcome)
    return code;
  return visit_all(eo_statement_begin(store, "SELECT " COLUMNS " FROM design WHERE id = ?", "i",
                                      (int64_t)sqlite3_last_insert_rowid(store->handle)),
                   visit, context, &rows, error);
}

enum eo_code eo_store_add_design(struct eo_store *store, const char *name, const char *document, int64_t most,
                                 eo_store_visit_design *visit, void *context, enum eo_design_outcome *outcome,
                                 struct eo_error *error)
{
  EO_TRY(eo_store_begin_lasting(store, error));
  return eo_store_end(store, add(store, name, document, most, visit, context, outcome, error), error);
}

/* What stands in the way of a change, if anything. */
static enum eo_code check(struct eo_store *store, int64_t id, int64_t expected, enum eo_design_outcome *outcome,
                          struct eo_error *error)
{
  struct eo_statement statement = eo_statement_begin(store, "SELECT revision FROM design WHERE id = ?", "i", id);
  *outcome = EO_DESIGN_MISSING;
  if (eo_statement_step(&statement))
    *outcome = !expected || eo_column_integer(&statement, 0) == expected ? EO_DESIGN_DONE : EO_DESIGN_STALE;
  return eo_statement_end(&statement, error);
}

static enum eo_code change(struct eo_store *store, int64_t id, int64_t expected, const char *name, const char *document,
                           eo_store_visit_design *visit, void *context, enum eo_design_outcome *outcome,
                           struct eo_error *error)
{
  int rows;
  enum eo_code code = check(store, id, expected, outcome, error);
  if (!code && *outcome == EO_DESIGN_DONE)
    code = EO_STATEMENT_RUN(store, error,
                            "UPDATE design SET revision = revision + 1, name = ?, document = ?, updated = " NOW
                            " WHERE id = ?",
                            "tti", name, document, id);
  return code ? code
              : visit_all(eo_statement_begin(store, "SELECT " COLUMNS " FROM design WHERE id = ?", "i", id), visit,
                          context, &rows, error);
}

enum eo_code eo_store_change_design(struct eo_store *store, int64_t id, int64_t expected, const char *name,
                                    const char *document, eo_store_visit_design *visit, void *context,
                                    enum eo_design_outcome *outcome, struct eo_error *error)
{
  EO_TRY(eo_store_begin_lasting(store, error));
  return eo_store_end(store, change(store, id, expected, name, document, visit, context, outcome, error), error);
}

/* Recordings are not thrown away with the design they belong to. */
static enum eo_code check_measurements(struct eo_store *store, int64_t id, enum eo_design_outcome *outcome,
                                       struct eo_error *error)
{
  struct eo_statement statement = eo_statement_begin(store, "SELECT 1 FROM measurement WHERE design = ? LIMIT 1", "i",
                                                     id);
  if (eo_statement_step(&statement))
    *outcome = EO_DESIGN_USED;
  return eo_statement_end(&statement, error);
}

static enum eo_code remove_design(struct eo_store *store, int64_t id, int64_t expected, enum eo_design_outcome *outcome,
                                  struct eo_error *error)
{
  enum eo_code code = check(store, id, expected, outcome, error);
  if (!code && *outcome == EO_DESIGN_DONE)
    code = check_measurements(store, id, outcome, error);
  return code || *outcome ? code : EO_STATEMENT_RUN(store, error, "DELETE FROM design WHERE id = ?", "i", id);
}

enum eo_code eo_store_remove_design(struct eo_store *store, int64_t id, int64_t expected,
                                    enum eo_design_outcome *outcome, struct eo_error *error)
{
  EO_TRY(eo_store_begin_lasting(store, error));
  return eo_store_end(store, remove_design(store, id, expected, outcome, error), error);
}

enum eo_code eo_store_list_designs(struct eo_store *store, int64_t before, int limit, eo_store_visit_design *visit,
                                   void *context, struct eo_error *error)
{
  int rows;
  return visit_all(
      eo_statement_begin(store, "SELECT " COLUMNS " FROM design WHERE ?1 = 0 OR id < ?1 ORDER BY id DESC LIMIT ?2",
                         "in", before, limit),
      visit, context, &rows, error);
}
