/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Kind "optimizer": prediction from a history, redundancy, decay and clean-up. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "optimizer/prediction_history.h"
#include "reference/verify_optimizer_private.h"

/* Rows from {x, fit, R, pred}; rows without R and pred are true ones. */
static enum eo_code load_history(struct eo_case *object, struct eo_history *history, struct eo_error *error)
{
  int rows, n, count[3];
  static const char *const keys[3] = {"fit", "R", "pred"};
  double *x = eo_optimizer_case_numbers(eo_case_need(object, "x"), &rows, &n), *column[3] = {NULL};
  enum eo_code code = EO_OK;
  for (int k = 0; k < 3 && x; k++) {
    struct eo_case *list = eo_case_find(object, keys[k]);
    int columns;
    column[k] = list ? eo_optimizer_case_numbers(list, &count[k], &columns) : NULL;
    if (column[k] && (count[k] != rows || columns != 1))
      eo_case_fault(list, "A list of %d eo_optimizer_case_numbers, one for each row, is expected here.", rows);
  }
  if (!eo_case_faulty(object))
    code = x ? eo_history_init(history, n, rows + 1, error) : eo_error_memory(error);
  for (int i = 0; i < rows && !code && !eo_case_faulty(object); i++)
    code = eo_history_add(history, x + (size_t)i * (size_t)n, column[0] ? column[0][i] : 0,
                          column[1] ? column[1][i] : 1, column[2] && column[2][i] != 0, error);
  for (int k = 0; k < 3; k++)
    free(column[k]);
  free(x);
  return code;
}

/* Histories are read where they stand, so that one which no case names cannot be wrong unseen. */
enum eo_code eo_verify_histories(void *context, struct eo_case *block, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  (void)context;
  for (int i = 0; i < eo_case_size(block) && !code && !eo_case_faulty(block); i++) {
    struct eo_history history = {0};
    if (eo_case_is_commentary(eo_case_key(eo_case_peek(block, i))))
      continue;
    code = load_history(eo_case_at(block, i), &history, error);
    eo_history_done(&history);
  }
  return code;
}

/* The rows of the region with their distances and weights. */
static void compare_region(const struct eo_optimizer_verifier *verifier, struct eo_case *item,
                           const struct eo_history *history, double radius)
{
  struct eo_case *rows = eo_case_need(item, "region"), *this_case = eo_case_need(item, "e"),
                 *the_case = eo_case_need(item, "w");
  int region = 0;
  for (int j = 0; j < history->count; j++) {
    if (!(history->distance[j] <= radius))
      continue;
    eo_verify_exact(verifier->v, eo_case_at(rows, region), j);
    eo_optimizer_case_compare(verifier, eo_case_at(this_case, region), history->distance[j]);
    eo_optimizer_case_compare(verifier, eo_case_at(the_case, region), history->weight[j]);
    region++;
  }
  eo_verify_size(verifier->v, rows, region);
  eo_verify_size(verifier->v, this_case, region);
  eo_verify_size(verifier->v, the_case, region);
}

/* null where the point has to be evaluated: then there is no estimate. */
static void compare_fitness(const struct eo_optimizer_verifier *verifier, struct eo_case *item, const char *key,
                            double fitness, bool predicts)
{
  struct eo_case *expected = eo_case_find(item, key);
  if (expected && eo_case_is_null(expected))
    eo_verify_fact(verifier->v, expected, "not predicted", !predicts);
  else
    eo_optimizer_case_compare(verifier, expected, fitness);
}

static void compare_estimate(const struct eo_optimizer_verifier *verifier, struct eo_case *item,
                             struct eo_history *history)
{
  static const char decision_key[] = "decision_at_Rstar_0_6";
  const double usual_trust = 0.6;
  const struct eo_history_law law = {.share_radius = eo_case_number(item, "r_share"),
                                     .weight_decay = eo_case_number(item, "alpha"),
                                     .rms = eo_optimizer_case_chooses(item, "norm", "range", "rms"),
                                     .weights_over_all = eo_optimizer_case_chooses(item, "wnorm", "region", "all")};
  const double trust = eo_case_number_or(item, "Rstar", usual_trust);
  int n, columns;
  double *x = eo_optimizer_case_numbers(eo_case_need(item, "x"), &n, &columns);
  if (x && (n != history->variables || columns != 1))
    eo_case_fault(eo_case_find(item, "x"), "x has another length than the rows of its history.");
  const bool evaluates = eo_optimizer_case_chooses(item, decision_key, "predict", "evaluate");
  eo_case_need(item, decision_key);
  if (x && !eo_case_faulty(item)) {
    const struct eo_history_estimate estimate = eo_history_predict(history, &law, x);
    const bool predicts = eo_history_trusts(&estimate, trust);
    compare_region(verifier, item, history, law.share_radius);
    eo_optimizer_case_compare(verifier, eo_case_need(item, "R"), estimate.credibility);
    eo_verify_fact(verifier->v, eo_case_find(item, decision_key), "the same decision", predicts == !evaluates);
    compare_fitness(verifier, item, "fitness", estimate.fitness, predicts);
    compare_fitness(verifier, item, "weighted_fitness", estimate.fitness, predicts);
  }
  free(x);
}

enum eo_code eo_verify_predict(void *context, struct eo_case *item, struct eo_error *error)
{
  struct eo_optimizer_verifier *verifier = context;
  struct eo_history history = {0};
  struct eo_case *name = eo_case_need(item, "history"), *all = eo_case_need(verifier->file, "histories");
  struct eo_case *block = eo_case_text(name) ? eo_case_find(all, eo_case_text(name)) : NULL;
  eo_optimizer_case_begin(verifier, item);
  if (!block && eo_case_is_text(name))
    eo_case_fault(name, "There is no such history.");
  enum eo_code code = block ? load_history(block, &history, error) : EO_OK;
  if (!code && !eo_case_faulty(item))
    compare_estimate(verifier, item, &history);
  eo_history_done(&history);
  return code;
}

/* Positions that are set in mark, in order, as the ids of their rows. ids NULL: the positions themselves. */
static void compare_marks(const struct eo_optimizer_verifier *verifier, const bool *mark, const double *ids, int count,
                          struct eo_case *expected)
{
  int seen = 0;
  for (int i = 0; i < count; i++)
    if (mark[i]) {
      eo_verify_exact(verifier->v, eo_case_at(expected, seen), ids ? ids[i] : i);
      seen++;
    }
  eo_verify_size(verifier->v, expected, seen);
}

enum eo_code eo_verify_redundancy(void *context, struct eo_case *item, struct eo_error *error)
{
  struct eo_optimizer_verifier *verifier = context;
  struct eo_history history = {0};
  const struct eo_history_law law = {.redundancy_threshold = eo_case_number(item, "threshold"),
                                     .literal_redundancy = true};
  struct eo_case *expected = eo_case_need(item, "I_r"), *removed = eo_case_need(item, "removed");
  eo_optimizer_case_begin(verifier, item);
  enum eo_code code = load_history(item, &history, error);
  if (!code && !eo_case_faulty(item)) {
    eo_history_mark_redundant(&history, &law);
    eo_verify_size(verifier->v, expected, history.count);
    for (int i = 0; i < history.count && i < eo_case_size(expected); i++) {
      struct eo_case *one = eo_case_at(expected, i);
      if (eo_case_is_null(one)) /* the first and last row of a coordinate */
        eo_verify_fact(verifier->v, one, "infinite", isinf(history.redundancy[i]));
      else
        eo_optimizer_case_compare(verifier, one, history.redundancy[i]);
    }
    compare_marks(verifier, history.removed, NULL, history.count, removed);
  }
  eo_history_done(&history);
  return code;
}

enum eo_code eo_verify_decay(void *context, struct eo_case *item, struct eo_error *error)
{
  struct eo_optimizer_verifier *verifier = context;
  struct eo_history history = {0};
  const struct eo_history_law law = {.credibility_loss = eo_case_number(item, "beta"),
                                     .removal_threshold = eo_case_number(item, "R0")};
  const double origin = 0, trust = eo_case_number_or(item, "Rstar", 0.6), start = eo_case_number(item, "R");
  struct eo_case *expected = eo_case_need(item, "R_after_each_generation");
  int last_trusted = 0, removed_after = 0;
  eo_optimizer_case_begin(verifier, item);
  if (eo_case_faulty(item))
    return EO_OK;
  enum eo_code code = eo_history_init(&history, 1, 1, error);
  if (!code)
    code = eo_history_add(&history, &origin, 1, start, true, error);
  for (int generation = 1; generation <= eo_case_size(expected) && !code; generation++) {
    if (eo_history_decay(&history, &law) > 0)
      removed_after = generation;
    eo_optimizer_case_compare(verifier, eo_case_at(expected, generation - 1), history.credibility[0]);
    if (history.credibility[0] >= trust)
      last_trusted = generation;
  }
  if (!code) {
    eo_verify_exact(verifier->v, eo_case_need(item, "removed_after_generation"), removed_after);
    eo_verify_exact(verifier->v, eo_case_need(item, "last_generation_with_R_at_least_Rstar"), last_trusted);
  }
  eo_history_done(&history);
  return code;
}

/* Ids of the redundant rows, of those that decay marks in addition, and of what stays. */
static enum eo_code compare_clean_up(const struct eo_optimizer_verifier *verifier, struct eo_case *item,
                                     struct eo_history *history, const double *ids, const struct eo_history_law *law,
                                     struct eo_error *error)
{
  struct eo_case *after = eo_case_need(item, "after");
  const int count = history->count;
  bool *decayed = calloc((size_t)count + 1, sizeof *decayed), *kept = calloc((size_t)count + 1, sizeof *kept);
  enum eo_code code = decayed && kept ? EO_OK : eo_error_memory(error);
  if (!code) {
    eo_history_mark_redundant(history, law);
    compare_marks(verifier, history->removed, ids, count, eo_case_need(item, "removed_redundant"));
    for (int j = 0; j < count; j++)
      kept[j] = history->removed[j]; /* before decay */
    eo_history_decay(history, law);
    for (int j = 0; j < count; j++) {
      decayed[j] = history->removed[j] && !kept[j];
      kept[j] = !history->removed[j];
    }
    compare_marks(verifier, decayed, ids, count, eo_case_need(item, "removed_decayed"));
    compare_marks(verifier, kept, ids, count, eo_case_need(after, "id"));
    eo_history_compact(history);
    eo_optimizer_case_compare_list(verifier, eo_case_need(after, "R"), history->count, history->credibility);
  }
  free(kept);
  free(decayed);
  return code;
}

enum eo_code eo_verify_clean_up(void *context, struct eo_case *item, struct eo_error *error)
{
  struct eo_optimizer_verifier *verifier = context;
  struct eo_history history = {0};
  struct eo_case *before = eo_case_need(item, "before");
  const struct eo_history_law law = {.redundancy_threshold = eo_case_number(item, "Ir"),
                                     .literal_redundancy = true,
                                     .credibility_loss = eo_case_number(item, "beta"),
                                     .removal_threshold = eo_case_number(item, "R0")};
  int count, columns;
  double *ids = eo_optimizer_case_numbers(eo_case_need(before, "id"), &count, &columns);
  eo_optimizer_case_begin(verifier, item);
  enum eo_code code = before ? load_history(before, &history, error) : EO_OK;
  if (!code && ids && !eo_case_faulty(item) && (count != history.count || columns != 1))
    eo_case_fault(eo_case_find(before, "id"), "There are %d rows.", history.count);
  if (!code && !eo_case_faulty(item))
    code = compare_clean_up(verifier, item, &history, ids, &law, error);
  eo_history_done(&history);
  free(ids);
  return code;
}
