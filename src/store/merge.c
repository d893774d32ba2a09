/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/merge.h"

#include <string.h>
#include <sys/stat.h>

#include "store/evaluations.h"
#include "store/statement.h"

/* Numbers of rows mean nothing in another folder: problems are the same by their hash, evaluations by problem and
   modification, rows of studies by what was evaluated. */
#define OTHER_PROBLEM "other.problem o JOIN main.problem p ON p.hash = o.hash"
#define SAME_EVALUATION                                                                                        \
  OTHER_PROBLEM " JOIN other.evaluation e ON e.problem = o.id JOIN main.evaluation m ON m.problem = p.id AND " \
                "m.modification = e.modification"

static enum eo_code add_problems(struct eo_store *store, int64_t *count, struct eo_error *error)
{
  EO_TRY(EO_STATEMENT_RUN(store, error,
                          "INSERT INTO main.problem (hash, spec, evaluator, scenarios, cases, name, created)"
                          " SELECT hash, spec, evaluator, scenarios, cases, name, created FROM other.problem WHERE true"
                          " ORDER BY id ON CONFLICT (hash) DO NOTHING",
                          ""));
  *count = sqlite3_changes64(store->handle);
  return EO_OK;
}

/* In the order in which they were found there, so that searches import them in the same order. */
static enum eo_code add_evaluations(struct eo_store *store, int64_t *count, struct eo_error *error)
{
  EO_TRY(
      EO_STATEMENT_RUN(store, error,
                       "INSERT INTO main.evaluation (problem, modification, outcome, reason, cost_s, created, digest)"
                       " SELECT p.id, e.modification, e.outcome, e.reason, e.cost_s, e.created, e.digest"
                       " FROM " OTHER_PROBLEM " JOIN other.evaluation e ON e.problem = o.id WHERE true ORDER BY e.id"
                       " ON CONFLICT (problem, modification) DO NOTHING",
                       ""));
  *count = sqlite3_changes64(store->handle);
  /* of those that were here already all raw values are here too */
  return EO_STATEMENT_RUN(
      store, error,
      "INSERT INTO main.raw (evaluation, scenario, load_case, peak_to_peak_m, impact_N, rms_m_per_s2,"
      " contact_pressure_Pa, root_stress_Pa, edge_load_share, contact_loss, failed, flank_safety, root_safety,"
      " film_ratio, contact_temperature_C, curve)"
      " SELECT m.id, r.scenario, r.load_case, r.peak_to_peak_m, r.impact_N, r.rms_m_per_s2, r.contact_pressure_Pa,"
      " r.root_stress_Pa, r.edge_load_share, r.contact_loss, r.failed, r.flank_safety, r.root_safety, r.film_ratio,"
      " r.contact_temperature_C, r.curve FROM " SAME_EVALUATION " JOIN other.raw r ON r.evaluation = e.id WHERE true"
      " ON CONFLICT (evaluation, scenario, load_case) DO NOTHING",
      "");
}

static enum eo_code add_points(struct eo_store *store, int64_t *count, struct eo_error *error)
{
  EO_TRY(
      EO_STATEMENT_RUN(store, error,
                       "INSERT INTO main.point (evaluation, space, x) SELECT m.id, t.space, t.x FROM " SAME_EVALUATION
                       " JOIN other.point t ON t.evaluation = e.id WHERE true"
                       " ON CONFLICT (evaluation, space) DO NOTHING",
                       ""));
  *count = sqlite3_changes64(store->handle);
  return EO_OK;
}

static enum eo_code add_variants(struct eo_store *store, int64_t *count, struct eo_error *error)
{
  EO_TRY(EO_STATEMENT_RUN(store, error,
                          "INSERT INTO main.variant_columns (names) SELECT names FROM other.variant_columns WHERE true"
                          " ORDER BY id ON CONFLICT (names) DO NOTHING",
                          ""));
  EO_TRY(EO_STATEMENT_RUN(
      store, error,
      "INSERT INTO main.variant_row (design, evaluator, columns, outcome, reason, cost_s, numbers, digest, created)"
      " SELECT v.design, v.evaluator, c.id, v.outcome, v.reason, v.cost_s, v.numbers, v.digest, v.created"
      " FROM other.variant_row v JOIN other.variant_columns o ON o.id = v.columns"
      " JOIN main.variant_columns c ON c.names = o.names WHERE true ORDER BY v.id"
      " ON CONFLICT (design, evaluator, columns) DO NOTHING",
      ""));
  *count = sqlite3_changes64(store->handle);
  return EO_OK;
}

static enum eo_code merge(struct eo_store *store, struct eo_merge_counts *counts, struct eo_error *error)
{
  EO_TRY(add_problems(store, &counts->problems, error));
  EO_TRY(add_evaluations(store, &counts->evaluations, error));
  EO_TRY(add_points(store, &counts->points, error));
  return add_variants(store, &counts->variants, error);
}

static bool is_same_file(const char *one, const char *other)
{
  struct stat a, b;
  return stat(one, &a) == 0 && stat(other, &b) == 0 && a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

/* Opening it brings it to the present schema; every row has to have its sum. path: of its database. */
static enum eo_code check_other(const struct eo_store *store, const char *directory, char path[4096],
                                struct eo_error *error)
{
  struct eo_store *other = NULL;
  int64_t rows = 0, wrong = 0;
  EO_TRY(eo_store_open(&other, directory, EO_STORE_READ, error));
  snprintf(path, 4096, "%s", other->path);
  enum eo_code code = EO_OK;
  if (is_same_file(store->path, path))
    code = eo_error_set(error, EO_ERROR_INPUT, "", "%.150s is the data folder itself.", directory);
  if (!code)
    code = eo_store_count_damaged(other, &rows, &wrong, error);
  if (!code && wrong)
    code = eo_error_set(error, EO_ERROR_DAMAGED, "",
                        "%.150s has %lld damaged rows; \"easeoff history prune --damaged --data\" there removes them.",
                        directory, (long long)wrong);
  eo_store_close(other);
  return code;
}

enum eo_code eo_store_merge(struct eo_store *store, const char *directory, struct eo_merge_counts *counts,
                            struct eo_error *error)
{
  char path[4096];
  *counts = (struct eo_merge_counts){0};
  EO_TRY(check_other(store, directory, path, error));
  EO_TRY(EO_STATEMENT_RUN(store, error, "ATTACH DATABASE ? AS other", "t", path));
  enum eo_code code = eo_store_begin(store, error);
  if (!code)
    code = eo_store_end(store, merge(store, counts, error), error);
  enum eo_code end = EO_STATEMENT_RUN(store, code ? NULL : error, "DETACH DATABASE other", "");
  return code ? code : end;
}
