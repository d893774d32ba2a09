/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/evaluations.h"

#include "base/hash.h"
#include "evaluation/scalar.h"
#include "store/statement.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const eo_store_outcomes[] = {"converged", "not_converged", "refused", NULL};

const char *eo_store_outcome_name(enum eo_evaluation_outcome outcome)
{
  return eo_store_outcomes[outcome];
}

static enum eo_evaluation_outcome find_outcome(const char *name)
{
  int i = 0;
  while (i < EO_EVALUATION_REFUSED && strcmp(eo_store_outcomes[i], name) != 0)
    i++;
  return (enum eo_evaluation_outcome)i;
}

/* The curve of a row: the transmission error, then the impacts of the ends, kept whole or not at all; and behind it the
   numbers of evaluation/scalar.h in their order, where a term or a limit asks for them. */
enum { CURVE = EO_OBJECTIVE_SAMPLES + 2, LONG_CURVE = CURVE + EO_SCALARS };

/* Fills curve[CURVE]; false when it is not there. */
static bool copy_curve(const struct eo_objective_case *objective_case, double *curve)
{
  bool finite = true;
  memcpy(curve, objective_case->transmission, sizeof objective_case->transmission);
  memcpy(curve + EO_OBJECTIVE_SAMPLES, objective_case->end_impact, sizeof objective_case->end_impact);
  for (int i = 0; i < CURVE; i++)
    finite = finite && isfinite(curve[i]);
  return finite;
}

/* Fills curve[LONG_CURVE]; returns how many bytes of it are kept, 0: none. */
static size_t pack_curve(const struct eo_objective_case *objective_case, double *curve)
{
  bool there = copy_curve(objective_case, curve), scalars = false;
  for (int i = 0; i < EO_SCALARS; i++) {
    double value = objective_case->scalar[i];
    curve[CURVE + i] = isfinite(value) ? value : NAN;
    scalars = scalars || isfinite(value);
  }
  for (int i = 0; i < CURVE && !there; i++)
    curve[i] = NAN;
  return sizeof *curve * (scalars ? LONG_CURVE : there ? CURVE : 0);
}

/* Rows of a version with fewer scalars are shorter. */
static void read_curve(const struct eo_statement *statement, int column, struct eo_objective_case *objective_case)
{
  double value[LONG_CURVE];
  const void *bytes = sqlite3_column_blob(statement->handle, column);
  const size_t size = bytes ? (size_t)sqlite3_column_bytes(statement->handle, column) : 0;
  for (int i = 0; i < LONG_CURVE; i++)
    value[i] = NAN;
  if (size >= sizeof *value * CURVE && size <= sizeof value)
    memcpy(value, bytes, size);
  memcpy(objective_case->transmission, value, sizeof objective_case->transmission);
  memcpy(objective_case->end_impact, value + EO_OBJECTIVE_SAMPLES, sizeof objective_case->end_impact);
  memcpy(objective_case->scalar, value + CURVE, sizeof objective_case->scalar);
}

static void add_raw(struct eo_hash *hash, const struct eo_objective_case *objective_case)
{
  eo_hash_add_number(hash, "peak_to_peak", objective_case->peak_to_peak);
  eo_hash_add_number(hash, "impact", objective_case->impact);
  eo_hash_add_number(hash, "rms", objective_case->rms);
  eo_hash_add_number(hash, "contact_pressure", objective_case->contact_pressure);
  eo_hash_add_number(hash, "root_stress", objective_case->root_stress);
  eo_hash_add_number(hash, "edge_load_share", objective_case->edge_load_share);
  eo_hash_add_number(hash, "contact_loss", objective_case->contact_loss);
  eo_hash_add_number(hash, "failed", objective_case->failed);
  const struct {
    const char *name;
    double value;
  } rating[] = {{"flank_safety", objective_case->flank_safety},
                {"root_safety", objective_case->root_safety},
                {"film_ratio", objective_case->film_ratio},
                {"contact_temperature", objective_case->contact_temperature}};
  for (size_t i = 0; i < sizeof rating / sizeof rating[0]; i++)
    if (!isnan(rating[i].value)) /* rows of before there was a rating have the check sum they had */
      eo_hash_add_number(hash, rating[i].name, rating[i].value);
  double curve[CURVE];
  const bool there = copy_curve(objective_case, curve);
  for (int i = 0; i < CURVE && there; i++) /* likewise */
    eo_hash_add_number(hash, "curve", curve[i]);
  for (int i = 0; i < EO_SCALARS; i++)
    if (isfinite(objective_case->scalar[i]))
      eo_hash_add_number(hash, eo_scalar_keys[i], objective_case->scalar[i]);
}

static void find_digest(const struct eo_stored_evaluation *row, char digest[EO_HASH_LENGTH + 1])
{
  struct eo_hash hash;
  eo_hash_init(&hash);
  eo_hash_add_text(&hash, "modification", row->modification);
  eo_hash_add_text(&hash, "outcome", eo_store_outcomes[row->outcome]);
  eo_hash_add_text(&hash, "reason", row->reason);
  eo_hash_add_number(&hash, "cost", row->cost);
  for (int i = 0; i < row->scenarios * row->cases; i++)
    add_raw(&hash, &row->raw[i]);
  eo_hash_finish(&hash, digest);
}

static enum eo_code damaged(const struct eo_store *store, int64_t id, struct eo_error *error)
{
  return eo_error_set(
      error, EO_ERROR_DAMAGED, "",
      "%.150s: row %lld of the history is damaged; \"easeoff history prune --damaged\" removes such rows.", store->path,
      (long long)id);
}

enum eo_code eo_store_find_problem(struct eo_store *store, const struct eo_stored_problem *problem, int64_t *id,
                                   struct eo_error *error)
{
  enum eo_code code = EO_STATEMENT_RUN(
      store, error,
      "INSERT INTO problem (hash, spec, name, evaluator, scenarios, cases) VALUES (?, ?, ?, ?, ?, ?)"
      " ON CONFLICT (hash) DO NOTHING",
      "tttnnn", problem->hash, problem->spec, problem->name, problem->evaluator, problem->scenarios, problem->cases);
  if (code)
    return code;
  struct eo_statement statement = eo_statement_begin(store, "SELECT id FROM problem WHERE hash = ?", "t",
                                                     problem->hash);
  *id = eo_statement_step(&statement) ? eo_column_integer(&statement, 0) : 0;
  return eo_statement_end(&statement, error);
}

enum eo_code eo_store_each_problem(struct eo_store *store, eo_store_visit_problem *visit, void *context,
                                   struct eo_error *error)
{
  struct eo_statement statement = eo_statement_begin(
      store,
      "SELECT p.id, p.hash, p.spec, p.name, p.created, p.evaluator, p.scenarios, p.cases, count(e.id),"
      " coalesce(sum(e.outcome <> 'converged'), 0), coalesce(sum(e.cost_s), 0)"
      " FROM problem p LEFT JOIN evaluation e ON e.problem = p.id GROUP BY p.id ORDER BY p.id",
      "");
  enum eo_code code = EO_OK;
  while (!code && eo_statement_step(&statement)) {
    const struct eo_stored_problem problem = {.id = eo_column_integer(&statement, 0),
                                              .hash = eo_column_text(&statement, 1),
                                              .spec = eo_column_text(&statement, 2),
                                              .name = eo_column_text(&statement, 3),
                                              .created = eo_column_text(&statement, 4),
                                              .evaluator = (int)eo_column_integer(&statement, 5),
                                              .scenarios = (int)eo_column_integer(&statement, 6),
                                              .cases = (int)eo_column_integer(&statement, 7),
                                              .evaluations = eo_column_integer(&statement, 8),
                                              .failed = eo_column_integer(&statement, 9),
                                              .cost = eo_column_number(&statement, 10)};
    code = visit(context, &problem, error);
  }
  enum eo_code end = eo_statement_end(&statement, code ? NULL : error);
  return code ? code : end;
}

/* Columns from first: scenario, load case, then the values. Rows come in order. */
static bool read_raw(const struct eo_statement *statement, int first, int expected,
                     const struct eo_stored_evaluation *row)
{
  if (eo_column_integer(statement, first) != expected / row->cases ||
      eo_column_integer(statement, first + 1) != expected % row->cases)
    return false;
  row->raw[expected] = (struct eo_objective_case){.peak_to_peak = eo_column_number(statement, first + 2),
                                                  .impact = eo_column_number(statement, first + 3),
                                                  .rms = eo_column_number(statement, first + 4),
                                                  .contact_pressure = eo_column_number(statement, first + 5),
                                                  .root_stress = eo_column_number(statement, first + 6),
                                                  .edge_load_share = eo_column_number(statement, first + 7),
                                                  .contact_loss = eo_column_number(statement, first + 8),
                                                  .failed = eo_column_integer(statement, first + 9) != 0,
                                                  .flank_safety = eo_column_number(statement, first + 10),
                                                  .root_safety = eo_column_number(statement, first + 11),
                                                  .film_ratio = eo_column_number(statement, first + 12),
                                                  .contact_temperature = eo_column_number(statement, first + 13)};
  read_curve(statement, first + 14, &row->raw[expected]);
  return true;
}

static enum eo_code read_all_raw(struct eo_store *store, struct eo_stored_evaluation *row, struct eo_error *error)
{
  int count = 0, size = row->scenarios * row->cases;
  struct eo_statement statement = eo_statement_begin(
      store,
      "SELECT scenario, load_case, peak_to_peak_m, impact_N, rms_m_per_s2, contact_pressure_Pa, root_stress_Pa,"
      " edge_load_share, contact_loss, failed, flank_safety, root_safety, film_ratio, contact_temperature_C, curve"
      " FROM raw WHERE evaluation = ? ORDER BY scenario, load_case",
      "i", row->id);
  bool good = true;
  while (good && eo_statement_step(&statement)) {
    good = count < size && read_raw(&statement, 0, count, row);
    count++;
  }
  enum eo_code code = eo_statement_end(&statement, error);
  row->scenarios = row->cases > 0 ? count / row->cases : 0;
  return code || (good && count > 0 && count % row->cases == 0) ? code : damaged(store, row->id, error);
}

/* Columns id, outcome, reason, cost. */
static void read_head(const struct eo_statement *statement, struct eo_stored_evaluation *row)
{
  row->id = eo_column_integer(statement, 0);
  row->outcome = find_outcome(eo_column_text(statement, 1));
  snprintf(row->reason, sizeof row->reason, "%s", eo_column_text(statement, 2));
  row->cost = eo_column_number(statement, 3);
}

static enum eo_code verify(struct eo_store *store, const struct eo_stored_evaluation *row, const char *expected,
                           struct eo_error *error)
{
  char digest[EO_HASH_LENGTH + 1];
  find_digest(row, digest);
  return strcmp(digest, expected) == 0 ? EO_OK : damaged(store, row->id, error);
}

/* The values of a row whose head and modification are read. */
static enum eo_code read_verified(struct eo_store *store, struct eo_stored_evaluation *row, const char *digest,
                                  struct eo_error *error)
{
  EO_TRY(read_all_raw(store, row, error));
  return verify(store, row, digest, error);
}

enum eo_code eo_store_find_evaluation(struct eo_store *store, int64_t problem, const char *modification,
                                      struct eo_stored_evaluation *row, struct eo_error *error)
{
  char digest[EO_HASH_LENGTH + 1] = "";
  struct eo_stored_evaluation found = *row;
  struct eo_statement statement = eo_statement_begin(
      store, "SELECT id, outcome, reason, cost_s, digest FROM evaluation WHERE problem = ? AND modification = ?", "it",
      problem, modification);
  found.id = 0;
  found.modification = modification;
  if (eo_statement_step(&statement)) {
    read_head(&statement, &found);
    snprintf(digest, sizeof digest, "%s", eo_column_text(&statement, 4));
  }
  EO_TRY(eo_statement_end(&statement, error));
  if (found.id)
    EO_TRY(read_verified(store, &found, digest, error));
  found.modification = row->modification;
  *row = found;
  return EO_OK;
}

enum eo_code eo_store_get_evaluation(struct eo_store *store, int64_t id, struct eo_stored_evaluation *row,
                                     struct eo_text *modification, struct eo_error *error)
{
  char digest[EO_HASH_LENGTH + 1] = "";
  size_t start = modification->size;
  struct eo_stored_evaluation found = *row;
  struct eo_statement statement = eo_statement_begin(
      store, "SELECT id, outcome, reason, cost_s, digest, modification FROM evaluation WHERE id = ?", "i", id);
  found.id = 0;
  if (eo_statement_step(&statement)) {
    read_head(&statement, &found);
    snprintf(digest, sizeof digest, "%s", eo_column_text(&statement, 4));
    eo_text_add(modification, eo_column_text(&statement, 5));
  }
  EO_TRY(eo_statement_end(&statement, error));
  if (modification->failed)
    return eo_error_memory(error);
  if (!found.id)
    return damaged(store, id, error);
  found.modification = modification->data ? modification->data + start : "";
  EO_TRY(read_verified(store, &found, digest, error));
  *row = found;
  return EO_OK;
}

static enum eo_code add_values(struct eo_store *store, const struct eo_stored_evaluation *row, struct eo_error *error)
{
  for (int i = 0; i < row->scenarios * row->cases; i++) {
    const struct eo_objective_case *objective_case = &row->raw[i];
    double curve[LONG_CURVE];
    const size_t size = pack_curve(objective_case, curve);
    EO_TRY(EO_STATEMENT_RUN(store, error, "INSERT INTO raw VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
                            "innrrrrrrrnrrrrb", row->id, i / row->cases, i % row->cases, objective_case->peak_to_peak,
                            objective_case->impact, objective_case->rms, objective_case->contact_pressure,
                            objective_case->root_stress, objective_case->edge_load_share, objective_case->contact_loss,
                            (int)objective_case->failed, objective_case->flank_safety, objective_case->root_safety,
                            objective_case->film_ratio, objective_case->contact_temperature,
                            size > 0 ? (const void *)curve : NULL, size));
  }
  return EO_OK;
}

/* What is not finite is stored as NULL and read back as NaN: the check sum has to see the same. */
static void blank(struct eo_stored_evaluation *row)
{
  for (int i = 0; i < row->scenarios * row->cases; i++) {
    double *value[] = {&row->raw[i].peak_to_peak,
                       &row->raw[i].impact,
                       &row->raw[i].rms,
                       &row->raw[i].contact_pressure,
                       &row->raw[i].root_stress,
                       &row->raw[i].edge_load_share,
                       &row->raw[i].contact_loss,
                       &row->raw[i].flank_safety,
                       &row->raw[i].root_safety,
                       &row->raw[i].film_ratio,
                       &row->raw[i].contact_temperature};
    for (size_t k = 0; k < sizeof value / sizeof value[0]; k++)
      if (!isfinite(*value[k]))
        *value[k] = NAN;
  }
}

enum eo_code eo_store_add_evaluation(struct eo_store *store, int64_t problem, struct eo_stored_evaluation *row,
                                     struct eo_error *error)
{
  char digest[EO_HASH_LENGTH + 1];
  blank(row);
  find_digest(row, digest);
  enum eo_code code = EO_STATEMENT_RUN(store, error,
                                       "INSERT INTO evaluation (problem, modification, outcome, reason, cost_s, digest)"
                                       " VALUES (?, ?, ?, ?, ?, ?) ON CONFLICT (problem, modification) DO NOTHING",
                                       "itttrt", problem, row->modification, eo_store_outcomes[row->outcome],
                                       row->reason, row->cost, digest);
  if (code)
    return code;
  if (sqlite3_changes(store->handle) == 0)
    return eo_store_find_evaluation(store, problem, row->modification, row, error);
  row->id = sqlite3_last_insert_rowid(store->handle);
  return add_values(store, row, error);
}

enum eo_code eo_store_last_evaluation(struct eo_store *store, int64_t *last, struct eo_error *error)
{
  struct eo_statement statement = eo_statement_begin(store, "SELECT coalesce(max(id), 0) FROM evaluation", "");
  *last = eo_statement_step(&statement) ? eo_column_integer(&statement, 0) : 0;
  return eo_statement_end(&statement, error);
}

struct walk {
  struct eo_store *store;
  struct eo_stored_evaluation row;
  char *modification; /* owned copy */
  double *x;          /* [size]; owned copy, NULL without a point */
  int size, count;    /* count: raw rows so far */
  char digest[EO_HASH_LENGTH + 1];
  eo_store_visit *visit;
  void *context;
};

/* The row collected last is complete: hand it over. */
static enum eo_code hand_over(struct walk *walk, struct eo_error *error)
{
  if (!walk->row.id)
    return EO_OK;
  enum eo_code code = walk->count == walk->row.scenarios * walk->row.cases
                          ? verify(walk->store, &walk->row, walk->digest, error)
                          : damaged(walk->store, walk->row.id, error);
  return code ? code : walk->visit(walk->context, &walk->row, walk->x, walk->size, error);
}

static enum eo_code start_row(struct walk *walk, const struct eo_statement *statement, struct eo_error *error)
{
  const void *x = sqlite3_column_blob(statement->handle, 6);
  walk->size = x ? (int)((size_t)sqlite3_column_bytes(statement->handle, 6) / sizeof *walk->x) : 0;
  free(walk->modification);
  free(walk->x);
  read_head(statement, &walk->row);
  walk->row.modification = walk->modification = strdup(eo_column_text(statement, 4));
  walk->x = walk->size ? malloc((size_t)walk->size * sizeof *walk->x) : NULL;
  snprintf(walk->digest, sizeof walk->digest, "%s", eo_column_text(statement, 5));
  walk->count = 0;
  if (!walk->modification || (walk->size && !walk->x))
    return eo_error_memory(error);
  if (walk->size)
    memcpy(walk->x, x, (size_t)walk->size * sizeof *walk->x);
  return EO_OK;
}

static enum eo_code take_row(struct walk *walk, const struct eo_statement *statement, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  if (eo_column_integer(statement, 0) != walk->row.id) {
    code = hand_over(walk, error);
    if (!code)
      code = start_row(walk, statement, error);
  }
  if (code)
    return code;
  if (walk->count >= walk->row.scenarios * walk->row.cases || !read_raw(statement, 7, walk->count, &walk->row))
    return damaged(walk->store, walk->row.id, error);
  walk->count++;
  return EO_OK;
}

enum eo_code eo_store_each_evaluation(struct eo_store *store, int64_t problem, int64_t upto, const char *space,
                                      int scenarios, int cases, eo_store_visit *visit, void *context,
                                      struct eo_error *error)
{
  struct walk walk = {
      .store = store, .row = {.scenarios = scenarios, .cases = cases}, .visit = visit, .context = context};
  walk.row.raw = calloc((size_t)scenarios * (size_t)cases, sizeof *walk.row.raw);
  if (!walk.row.raw)
    return eo_error_memory(error);
  struct eo_statement statement =
      eo_statement_begin(store,
                         "SELECT e.id, e.outcome, e.reason, e.cost_s, e.modification, e.digest,"
                         " (SELECT p.x FROM point p WHERE p.evaluation = e.id AND p.space = ?3),"
                         " r.scenario, r.load_case, r.peak_to_peak_m, r.impact_N, r.rms_m_per_s2, "
                         "r.contact_pressure_Pa, r.root_stress_Pa, r.edge_load_share,"
                         " r.contact_loss, r.failed, r.flank_safety, r.root_safety, r.film_ratio,"
                         " r.contact_temperature_C, r.curve"
                         " FROM evaluation e LEFT JOIN raw r ON r.evaluation = e.id WHERE e.problem = ?1 AND (?2 = 0 "
                         "OR e.id <= ?2) ORDER BY e.id, r.scenario, r.load_case",
                         "iit", problem, upto, space);
  enum eo_code code = EO_OK;
  while (!code && eo_statement_step(&statement))
    code = take_row(&walk, &statement, error);
  enum eo_code end = eo_statement_end(&statement, code ? NULL : error);
  if (!code)
    code = end;
  if (!code)
    code = hand_over(&walk, error);
  free(walk.row.raw);
  free(walk.modification);
  free(walk.x);
  return code;
}

enum eo_code eo_store_remove_problem(struct eo_store *store, int64_t problem, int64_t *removed, struct eo_error *error)
{
  struct eo_statement statement = eo_statement_begin(store, "SELECT count(*) FROM evaluation WHERE problem = ?", "i",
                                                     problem);
  *removed = eo_statement_step(&statement) ? eo_column_integer(&statement, 0) : 0;
  enum eo_code code = eo_statement_end(&statement, error);
  return code ? code : EO_STATEMENT_RUN(store, error, "DELETE FROM problem WHERE id = ?", "i", problem);
}

/* Columns id, problem, scenarios, cases, modification. */
static enum eo_code is_damaged(struct eo_store *store, const struct eo_statement *statement, bool *answer,
                               struct eo_error *error)
{
  struct eo_stored_evaluation row = {.scenarios = (int)eo_column_integer(statement, 2),
                                     .cases = (int)eo_column_integer(statement, 3)};
  struct eo_error found;
  row.raw = calloc((size_t)row.scenarios * (size_t)row.cases, sizeof *row.raw);
  if (!row.raw)
    return eo_error_memory(error);
  *answer = eo_store_find_evaluation(store, eo_column_integer(statement, 1), eo_column_text(statement, 4), &row,
                                     &found) ||
            row.id != eo_column_integer(statement, 0);
  free(row.raw);
  return EO_OK;
}

/* Every row once; those that do not have their sum are removed, or counted alone. */
static enum eo_code look_at_all(struct eo_store *store, bool removes, int64_t *rows, int64_t *damaged_rows,
                                struct eo_error *error)
{
  enum eo_code code = EO_OK;
  int64_t last = 0;
  *rows = *damaged_rows = 0;
  for (;;) {
    struct eo_statement statement = eo_statement_begin(
        store,
        "SELECT e.id, p.id, p.scenarios, p.cases, e.modification FROM evaluation e JOIN problem p ON p.id = e.problem"
        " WHERE e.id > ? ORDER BY e.id LIMIT 1",
        "i", last);
    bool more = eo_statement_step(&statement), wrong = false;
    if (more) {
      last = eo_column_integer(&statement, 0);
      code = is_damaged(store, &statement, &wrong, error);
    }
    enum eo_code end = eo_statement_end(&statement, code ? NULL : error);
    code = code ? code : end;
    if (!code && wrong && removes)
      code = EO_STATEMENT_RUN(store, error, "DELETE FROM evaluation WHERE id = ?", "i", last);
    *rows += !code && more;
    *damaged_rows += !code && wrong;
    if (code || !more)
      return code;
  }
}

enum eo_code eo_store_remove_damaged(struct eo_store *store, int64_t *removed, struct eo_error *error)
{
  int64_t rows;
  return look_at_all(store, true, &rows, removed, error);
}

enum eo_code eo_store_count_damaged(struct eo_store *store, int64_t *rows, int64_t *wrong, struct eo_error *error)
{
  return look_at_all(store, false, rows, wrong, error);
}
