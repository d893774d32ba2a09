/* Kind "optimizer": the counter, prediction, redundancy, decay, clean-up, operators, whole runs, and the successor's
   latin hypercube, surrogate and credibility. */
#include "reference/formula.h"
#include "reference/verify.h"
#include "base/random.h"
#include "optimizer/prediction_history.h"
#include "optimizer/operators.h"
#include "optimizer/optimizer.h"
#include "optimizer/surrogate.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct verifier {
  const json_t *root;
  struct eo_verification *to;
  struct eo_error *error;
  enum eo_code code; /* of the first fault; later steps do nothing */
  const char *block; /* the case under work */
  int index;
  double relative; /* tolerance in force */
};

static void fault(struct verifier *v, const char *text)
{
  if (v->code != EO_OK)
    return;
  char pointer[100];
  snprintf(pointer, sizeof pointer, "/%s/%d", v->block, v->index);
  v->code = eo_error_set(v->error, EO_ERROR_INPUT, pointer, "%s", text);
}

__attribute__((format(printf, 4, 5))) static void compare(struct verifier *v, double value, double expected,
                                                          const char *format, ...)
{
  char name[100], quantity[100];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(quantity, sizeof quantity, format, arguments);
  va_end(arguments);
  snprintf(name, sizeof name, "%s[%d]", v->block, v->index);
  const double tolerance = v->relative * (expected == 0 || isinf(expected) ? 1 : fabs(expected));
  eo_verify_add(v->to, name, quantity, value, expected, tolerance);
}

/* The value of a key; a missing one is a fault. */
static const json_t *need(struct verifier *v, const json_t *object, const char *key)
{
  const json_t *value = json_object_get(object, key);
  if (value)
    return value;
  char text[120];
  snprintf(text, sizeof text, "The key %s is missing.", key);
  fault(v, text);
  return NULL;
}

/* A number; null stands for infinite. */
static double number(struct verifier *v, const json_t *object, const char *key)
{
  const json_t *value = need(v, object, key);
  if (value && !json_is_number(value) && !json_is_null(value) && !json_is_boolean(value))
    fault(v, "A number is expected.");
  return !value || json_is_null(value) ? INFINITY : json_is_true(value) ? 1 : json_number_value(value);
}

static double number_or(const json_t *object, const char *key, double standard)
{
  const json_t *value = json_object_get(object, key);
  return json_is_number(value) ? json_number_value(value) : json_is_boolean(value) ? json_is_true(value) : standard;
}

static uint64_t seed_of(struct verifier *v, const json_t *object, const char *key)
{
  const json_t *value = need(v, object, key);
  return json_is_string(value) ? strtoull(json_string_value(value), NULL, 10) : (uint64_t)json_number_value(value);
}

static double element(const json_t *array, size_t i)
{
  const json_t *value = json_array_get(array, i);
  return json_is_number(value) ? json_number_value(value)
         : json_is_true(value) ? 1
         : json_is_null(value) ? INFINITY
                               : 0;
}

/* An array of numbers, or of rows of numbers of equal length; freed by the caller. *columns is 1 for a flat one. */
static double *numbers(struct verifier *v, const json_t *array, int *rows, int *columns)
{
  *rows = (int)json_array_size(array);
  *columns = 1;
  if (*rows > 0 && json_is_array(json_array_get(array, 0)))
    *columns = (int)json_array_size(json_array_get(array, 0));
  double *result = calloc((size_t)*rows * (size_t)*columns + 1, sizeof *result);
  if (!result) {
    v->code = eo_error_memory(v->error);
    *rows = 0;
    return NULL;
  }
  for (int i = 0; i < *rows; i++) {
    const json_t *row = json_array_get(array, (size_t)i);
    if (json_is_array(row) && (int)json_array_size(row) != *columns)
      fault(v, "The rows of an array differ in length.");
    for (int k = 0; k < *columns; k++)
      result[i * *columns + k] = json_is_array(row) ? element(row, (size_t)k) : element(array, (size_t)i);
  }
  return result;
}

static void compare_all(struct verifier *v, const double *value, int count, const json_t *expected,
                        const char *quantity)
{
  compare(v, count, (double)json_array_size(expected), "length of %s", quantity);
  for (int i = 0; i < count && i < (int)json_array_size(expected); i++)
    compare(v, value[i], element(expected, (size_t)i), "%s[%d]", quantity, i);
}

/* The positions that are set in mark against a list of them. */
static void compare_marks(struct verifier *v, const bool *mark, int count, const json_t *expected, const char *quantity)
{
  size_t seen = 0;
  for (int i = 0; i < count; i++) {
    if (!mark[i])
      continue;
    compare(v, i, seen < json_array_size(expected) ? element(expected, seen) : NAN, "%s[%zu]", quantity, seen);
    seen++;
  }
  compare(v, (double)seen, (double)json_array_size(expected), "length of %s", quantity);
}

static void verify_random(struct verifier *v, const json_t *item)
{
  const struct eo_random random = eo_random_at(seed_of(v, item, "seed"), (uint64_t)number(v, item, "stream"),
                                               (uint64_t)number(v, item, "gen"), (uint64_t)number(v, item, "idx"));
  const uint64_t draw = (uint64_t)number(v, item, "draw"), bits = eo_random_bits(random, draw),
                 expected = seed_of(v, item, "u64");
  v->relative = 0; /* bit for bit; a number has 53 bits, so the 64 are compared in halves */
  compare(v, (double)(bits >> 32), (double)(expected >> 32), "u64, upper half");
  compare(v, (double)(bits & UINT32_MAX), (double)(expected & UINT32_MAX), "u64, lower half");
  compare(v, eo_random_unit(random, draw), number(v, item, "u01"), "u01");
}

/* Rows from {x, fit, R, pred}; what is missing is a true row. */
static void load_history(struct verifier *v, struct eo_history *history, const json_t *object)
{
  int rows, n;
  double *x = numbers(v, need(v, object, "x"), &rows, &n);
  if (x && v->code == EO_OK)
    v->code = eo_history_init(history, n, rows + 1, v->error);
  for (int i = 0; i < rows && v->code == EO_OK; i++) {
    const json_t *credibility = json_array_get(json_object_get(object, "R"), (size_t)i);
    v->code = eo_history_add(history, x + (size_t)i * n, element(json_object_get(object, "fit"), (size_t)i),
                             credibility ? json_number_value(credibility) : 1,
                             element(json_object_get(object, "pred"), (size_t)i) != 0, v->error);
  }
  free(x);
}

static bool is_choice(const json_t *object, const char *key, const char *choice)
{
  const char *value = json_string_value(json_object_get(object, key));
  return value && strcmp(value, choice) == 0;
}

static void verify_estimate(struct verifier *v, const json_t *item, struct eo_history *history)
{
  const struct eo_history_law law = {.share_radius = number(v, item, "r_share"),
                                     .weight_decay = number(v, item, "alpha"),
                                     .rms = is_choice(item, "norm", "rms"),
                                     .weights_over_all = is_choice(item, "wnorm", "all")};
  int n, columns, region = 0;
  double *x = numbers(v, need(v, item, "x"), &n, &columns);
  if (x && n == history->variables && v->code == EO_OK) {
    const struct eo_history_estimate estimate = eo_history_predict(history, &law, x);
    for (int j = 0; j < history->count; j++) {
      if (!(history->distance[j] <= law.share_radius))
        continue;
      compare(v, j, element(json_object_get(item, "region"), (size_t)region), "region[%d]", region);
      compare(v, history->distance[j], element(json_object_get(item, "e"), (size_t)region), "e[%d]", region);
      compare(v, history->weight[j], element(json_object_get(item, "w"), (size_t)region), "w[%d]", region);
      region++;
    }
    compare(v, region, (double)json_array_size(json_object_get(item, "region")), "rows in the region");
    compare(v, estimate.credibility, number(v, item, "R"), "R");
    const bool predicts = eo_history_trusts(&estimate, number_or(item, "Rstar", 0.6));
    compare(v, predicts, is_choice(item, "decision_at_Rstar_0_6", "predict"), "predicted (1) or evaluated (0)");
    static const char *const fitness[] = {"fitness", "weighted_fitness"};
    for (int i = 0; i < 2; i++)
      if (json_is_number(json_object_get(item, fitness[i])))
        compare(v, estimate.fitness, number(v, item, fitness[i]), "%s", fitness[i]);
  } else if (v->code == EO_OK) {
    fault(v, "x has another length than the rows of its history.");
  }
  free(x);
}

static void verify_predict(struct verifier *v, const json_t *item)
{
  struct eo_history history = {0};
  const char *name = json_string_value(need(v, item, "history"));
  load_history(v, &history, name ? json_object_get(json_object_get(v->root, "histories"), name) : NULL);
  if (v->code == EO_OK)
    verify_estimate(v, item, &history);
  eo_history_done(&history);
}

static void verify_redundancy(struct verifier *v, const json_t *item)
{
  struct eo_history history = {0};
  load_history(v, &history, item);
  if (v->code == EO_OK) {
    const struct eo_history_law law = {.redundancy_threshold = number(v, item, "threshold"),
                                       .literal_redundancy = true};
    eo_history_mark_redundant(&history, &law);
    compare_all(v, history.redundancy, history.count, need(v, item, "I_r"), "I_r");
    compare_marks(v, history.removed, history.count, need(v, item, "removed"), "removed");
  }
  eo_history_done(&history);
}

static void verify_decay(struct verifier *v, const json_t *item)
{
  struct eo_history history = {0};
  const struct eo_history_law law = {.credibility_loss = number(v, item, "beta"),
                                     .removal_threshold = number(v, item, "R0")};
  const double origin = 0, trust = number_or(item, "Rstar", 0.6);
  const json_t *expected = need(v, item, "R_after_each_generation");
  v->code = v->code == EO_OK ? eo_history_init(&history, 1, 1, v->error) : v->code;
  if (v->code == EO_OK)
    v->code = eo_history_add(&history, &origin, 1, number(v, item, "R"), true, v->error);
  int last_trusted = 0, removed_after = 0;
  for (int generation = 1; generation <= (int)json_array_size(expected) && v->code == EO_OK; generation++) {
    if (eo_history_decay(&history, &law) > 0)
      removed_after = generation;
    compare(v, history.credibility[0], element(expected, (size_t)generation - 1), "R after generation %d", generation);
    if (history.credibility[0] >= trust)
      last_trusted = generation;
  }
  compare(v, removed_after, number(v, item, "removed_after_generation"), "removed after generation");
  compare(v, last_trusted, number(v, item, "last_generation_with_R_at_least_Rstar"), "last generation with R >= R*");
  eo_history_done(&history);
}

/* Compares ids of the marked rows (redundant), then of those that decay marks in addition. */
static void verify_clean_up(struct verifier *v, const json_t *item)
{
  struct eo_history history = {0};
  const json_t *before = need(v, item, "before"), *after = need(v, item, "after");
  load_history(v, &history, before);
  if (v->code == EO_OK) {
    const struct eo_history_law law = {.redundancy_threshold = number(v, item, "Ir"),
                                       .literal_redundancy = true,
                                       .credibility_loss = number(v, item, "beta"),
                                       .removal_threshold = number(v, item, "R0")};
    const json_t *ids = need(v, before, "id"), *redundant = need(v, item, "removed_redundant"),
                 *decayed = need(v, item, "removed_decayed"), *kept_ids = need(v, after, "id");
    eo_history_mark_redundant(&history, &law);
    size_t seen[3] = {0};
    for (int j = 0; j < history.count; j++)
      if (history.removed[j])
        compare(v, element(ids, (size_t)j), element(redundant, seen[0]), "removed_redundant[%zu]", seen[0]), seen[0]++;
    bool *earlier = calloc((size_t)history.count + 1, sizeof *earlier);
    memcpy(earlier, history.removed, (size_t)history.count * sizeof *earlier);
    eo_history_decay(&history, &law);
    for (int j = 0; j < history.count; j++) {
      if (history.removed[j] && !earlier[j])
        compare(v, element(ids, (size_t)j), element(decayed, seen[1]), "removed_decayed[%zu]", seen[1]), seen[1]++;
      if (!history.removed[j])
        compare(v, element(ids, (size_t)j), element(kept_ids, seen[2]), "after id[%zu]", seen[2]), seen[2]++;
    }
    free(earlier);
    compare(v, (double)seen[0], (double)json_array_size(redundant), "rows removed as redundant");
    compare(v, (double)seen[1], (double)json_array_size(decayed), "rows removed as decayed");
    eo_history_compact(&history);
    compare_all(v, history.credibility, history.count, need(v, after, "R"), "after R");
  }
  eo_history_done(&history);
}

/* The parameters of the files' operators and runs blocks. */
static void read_parameters(struct eo_optimizer_settings *s, const json_t *p)
{
  s->crossover = number_or(p, "pc", s->crossover);
  s->mutation = number_or(p, "pm", s->mutation);
  s->crossover_index = number_or(p, "eta_c", s->crossover_index);
  s->mutation_index = number_or(p, "eta_m", s->mutation_index);
  s->mutation_mode = is_choice(p, "pm_mode", "individual") ? EO_MUTATE_INDIVIDUAL : EO_MUTATE_GENE;
  s->population = (int)number_or(p, "npop", s->population);
  s->generations = (int)number_or(p, "ngen", s->generations);
  s->elite = (int)number_or(p, "elite", s->elite);
  s->share_radius = number_or(p, "r_share", 0);
  s->weight_decay = number_or(p, "alpha", s->weight_decay);
  s->trust_threshold = number_or(p, "Rstar", s->trust_threshold);
  s->credibility_loss = number_or(p, "beta", s->credibility_loss);
  s->removal_threshold = number_or(p, "R0", s->removal_threshold);
  s->redundancy_threshold = number_or(p, "Ir", s->redundancy_threshold);
  s->distance_norm = is_choice(p, "norm", "rms") ? EO_NORM_RMS : EO_NORM_RANGE;
  s->weight_sum = is_choice(p, "wnorm", "all") ? EO_WEIGHTS_ALL : EO_WEIGHTS_REGION;
  s->decision_order = is_choice(p, "order", "batch") ? EO_ORDER_BATCH : EO_ORDER_SEQUENTIAL;
  s->store_predicted = number_or(p, "store_predicted", 1) != 0;
  /* The files hold the algorithm as printed. */
  s->literal_redundancy = number_or(p, "literal", 1) != 0;
  s->verify = number_or(p, "verify", 0) != 0;
  s->reuse = number_or(p, "reuse", 0) != 0;
}

static void verify_operators(struct verifier *v, const json_t *item)
{
  int size, n, count, columns;
  double *parents = numbers(v, need(v, item, "parents"), &size, &n);
  double *fitness = numbers(v, need(v, item, "fitness"), &count, &columns);
  const json_t *expected = need(v, item, "children");
  const int children = (int)json_array_size(expected);
  double *child = calloc((size_t)children * (size_t)n + 1, sizeof *child);
  struct eo_optimizer_settings settings;
  eo_optimizer_defaults(&settings, EO_GA, n);
  read_parameters(&settings, need(v, item, "params"));
  settings.seed = seed_of(v, item, "seed");
  if (n < 1 || n > EO_MAX_VARIABLES || count != size)
    fault(v, "parents and fitness do not belong together.");
  if (v->code == EO_OK && child) {
    eo_breed(&settings, parents, fitness, size, (int)number(v, item, "gen"), 0, child, children);
    for (int i = 0; i < children; i++)
      for (int k = 0; k < n; k++)
        compare(v, child[i * n + k], element(json_array_get(expected, (size_t)i), (size_t)k), "children[%d][%d]", i, k);
  }
  free(child);
  free(fitness);
  free(parents);
}

static void run_to_the_end(struct verifier *v, struct eo_optimizer *optimizer, const char *formula, int n)
{
  struct eo_batch batch = {.count = 1};
  while (v->code == EO_OK && batch.count > 0) {
    v->code = eo_optimizer_ask(optimizer, &batch, v->error);
    for (int i = 0; i < batch.count && v->code == EO_OK; i++) {
      double fitness;
      v->code = eo_formula_evaluate(formula, batch.candidates[i].x, n, &fitness, v->error);
      const struct eo_outcome outcome = {.value = -fitness};
      if (v->code == EO_OK)
        v->code = eo_optimizer_tell(optimizer, i, &outcome, v->error);
    }
  }
}

static void compare_run(struct verifier *v, const struct eo_optimizer *optimizer, const json_t *item)
{
  int generations, true_evaluations = 0;
  const struct eo_generation *g = eo_optimizer_generations(optimizer, &generations);
  const json_t *expected = need(v, item, "true_evaluations_after_generation");
  compare(v, generations, (double)json_array_size(expected), "generations");
  for (int i = 0; i < generations; i++) {
    true_evaluations += g[i].true_count;
    const size_t j = (size_t)i;
    compare(v, true_evaluations, element(expected, j), "true_evaluations_after_generation[%d]", i);
    compare(v, g[i].history_rows, element(need(v, item, "rows_after_generation"), j), "rows_after_generation[%d]", i);
    compare(v, g[i].removed_redundant, element(need(v, item, "removed_redundant"), j), "removed_redundant[%d]", i);
    compare(v, g[i].removed_decayed, element(need(v, item, "removed_decayed"), j), "removed_decayed[%d]", i);
    compare(v, -g[i].best_value, element(need(v, item, "best_true_fitness"), j), "best_true_fitness[%d]", i);
  }
  compare(v, eo_optimizer_counters(optimizer).fitness_computed, number(v, item, "pfc"), "pfc");
  const int best = eo_optimizer_best(optimizer);
  if (best >= 0)
    compare_all(v, eo_optimizer_row(optimizer, best).x, (int)json_array_size(json_object_get(item, "best_x")),
                need(v, item, "best_x"), "best_x");
}

static void verify_run(struct verifier *v, const json_t *item)
{
  const char *formula = json_string_value(need(v, item, "fitness"));
  const int n = (int)number(v, item, "n");
  struct eo_optimizer *optimizer = NULL;
  struct eo_optimizer_settings settings;
  eo_optimizer_defaults(&settings, EO_FPGA, n);
  read_parameters(&settings, need(v, item, "params"));
  settings.seed = seed_of(v, item, "seed");
  settings.fitness_form = EO_FITNESS_NEGATIVE;
  if (!formula)
    fault(v, "fitness is no text.");
  if (v->code == EO_OK)
    v->code = eo_optimizer_new(&settings, &optimizer, v->error);
  if (v->code == EO_OK)
    run_to_the_end(v, optimizer, formula, n);
  if (v->code == EO_OK)
    compare_run(v, optimizer, item);
  eo_optimizer_free(optimizer);
}

/* Reads "... ridge 1e-9" from the description of the surrogate. */
static double ridge_of(const json_t *item)
{
  const char *text = json_string_value(json_object_get(item, "rbf"));
  const char *ridge = text ? strstr(text, "ridge") : NULL;
  return ridge ? strtod(ridge + strlen("ridge"), NULL) : 0;
}

static void compare_surrogate(struct verifier *v, const json_t *item, struct eo_surrogate *s, const double *query,
                              int queries)
{
  const json_t *credibility = need(v, item, "credibility");
  const double length = number(v, credibility, "ell");
  compare_all(v, s->residual, s->rows, need(v, item, "loo_abs"), "loo_abs");
  compare_all(v, s->residual, s->rows, need(v, item, "loo_by_refit"), "loo_by_refit");
  eo_surrogate_set_scale(s, number(v, credibility, "scale"));
  for (int i = 0; i < queries; i++) {
    eo_surrogate_visit(s, query + (size_t)i * s->variables);
    compare(v, eo_surrogate_value(s, 0), element(need(v, item, "prediction"), (size_t)i), "prediction[%d]", i);
    compare(v, eo_surrogate_credibility(s, length), element(need(v, credibility, "R"), (size_t)i), "credibility R[%d]",
            i);
  }
}

static void verify_surrogate(struct verifier *v, const json_t *item, const double *x, int m, int n)
{
  int rows, columns, queries;
  double *y = numbers(v, need(v, item, "y"), &rows, &columns);
  double *query = numbers(v, need(v, item, "query"), &queries, &columns);
  struct eo_surrogate surrogate = {0};
  if (rows != m || columns != n)
    fault(v, "y or query do not belong to the latin hypercube.");
  if (v->code == EO_OK)
    v->code = eo_surrogate_init(&surrogate, n, m, 1, EO_TAIL_LINEAR, v->error);
  if (v->code == EO_OK && !eo_surrogate_fit(&surrogate, EO_TAIL_LINEAR, ridge_of(item), x, y, m, 1))
    fault(v, "The rows do not determine a surrogate.");
  if (v->code == EO_OK)
    compare_surrogate(v, item, &surrogate, query, queries);
  eo_surrogate_done(&surrogate);
  free(query);
  free(y);
}

static void verify_successor(struct verifier *v, const json_t *item)
{
  const json_t *latin = need(v, item, "lhs");
  const int n = (int)number(v, latin, "n"), m = (int)number(v, latin, "m");
  if (v->code != EO_OK || n < 1 || n > EO_MAX_VARIABLES || m < 1 || m > 100000) {
    fault(v, "lhs does not say how many points of how many variables.");
    return;
  }
  double *x = calloc((size_t)m * (size_t)n, sizeof *x), *scratch = calloc((size_t)m, sizeof *scratch);
  if (x && scratch) {
    eo_latin_hypercube(x, m, n, seed_of(v, latin, "seed"), 0, scratch);
    for (int i = 0; i < m; i++)
      for (int k = 0; k < n; k++)
        compare(v, x[i * n + k], element(json_array_get(need(v, latin, "x"), (size_t)i), (size_t)k), "lhs[%d][%d]", i,
                k);
    if (json_object_get(item, "y"))
      verify_surrogate(v, item, x, m, n);
  } else {
    v->code = eo_error_memory(v->error);
  }
  free(scratch);
  free(x);
}

static const char *const random_keys[] = {"seed", "stream", "gen", "idx", "draw", "u64", "u01", NULL};
static const char *const predict_keys[] = {"history", "x",
                                           "r_share", "alpha",
                                           "norm",    "wnorm",
                                           "Rstar",   "region",
                                           "e",       "w",
                                           "R",       "decision_at_Rstar_0_6",
                                           "fitness", "weighted_fitness",
                                           NULL};
static const char *const redundancy_keys[] = {"x", "fit", "R", "pred", "threshold", "I_r", "removed", NULL};
static const char *const decay_keys[] = {"R",
                                         "beta",
                                         "R0",
                                         "Rstar",
                                         "R_after_each_generation",
                                         "removed_after_generation",
                                         "last_generation_with_R_at_least_Rstar",
                                         NULL};
static const char *const clean_up_keys[] = {"before",          "after", "beta", "R0", "Ir", "removed_redundant",
                                            "removed_decayed", NULL};
static const char *const operator_keys[] = {"seed", "gen", "parents", "fitness", "params", "children", NULL};
static const char *const run_keys[] = {"fitness",
                                       "n",
                                       "seed",
                                       "params",
                                       "true_evaluations_after_generation",
                                       "rows_after_generation",
                                       "removed_redundant",
                                       "removed_decayed",
                                       "best_true_fitness",
                                       "pfc",
                                       "best_x",
                                       NULL};
static const char *const successor_keys[] = {"lhs",          "y",           "rbf", "query", "prediction", "loo_abs",
                                             "loo_by_refit", "credibility", NULL};

static const struct block {
  const char *key;
  void (*verify)(struct verifier *, const json_t *);
  const char *const *keys;
} blocks[] = {{"rng", verify_random, random_keys},
              {"predict", verify_predict, predict_keys},
              {"redundancy", verify_redundancy, redundancy_keys},
              {"decay", verify_decay, decay_keys},
              {"S6", verify_clean_up, clean_up_keys},
              {"operators", verify_operators, operator_keys},
              {"runs", verify_run, run_keys},
              {"successor", verify_successor, successor_keys}};
enum { BLOCKS = sizeof blocks / sizeof *blocks };

/* Keys of a case that its block does not read; every case may carry words for people and its own tolerance. */
static void note_unknown(struct verifier *v, const json_t *object, const char *const *keys)
{
  static const char *const always[] = {"name", "id", "about", "note", "rel_tol", NULL};
  const char *key;
  json_t *value;
  json_object_foreach((json_t *)object, key, value)
  {
    bool found = false;
    for (int i = 0; keys[i] && !found; i++)
      found = strcmp(keys[i], key) == 0;
    for (int i = 0; always[i] && !found; i++)
      found = strcmp(always[i], key) == 0;
    if (!found)
      eo_verify_ignore(v->to, "%s[%d]: \"%s\" is not a key of this block", v->block, v->index, key);
  }
}

/* One case; what cannot be computed is a failed check of its own. */
static enum eo_code verify_item(struct verifier *v, const struct block *block, const json_t *item)
{
  char name[100];
  note_unknown(v, item, block->keys);
  block->verify(v, item);
  if (v->code != EO_ERROR_INPUT && v->code != EO_ERROR_NUMERIC)
    return v->code;
  snprintf(name, sizeof name, "%s[%d]", v->block, v->index);
  eo_verify_broken(v->to, name, v->error);
  return v->code = EO_OK;
}

enum eo_code eo_verify_optimizer(const json_t *cases, struct eo_verification *to, struct eo_error *error)
{
  static const char *const other[] = {"kind", "about", "conventions", "histories", "invariants", "note", "source"};
  enum { OTHERS = sizeof other / sizeof *other };
  const double relative = number_or(json_object_get(cases, "conventions"), "rel_tol", 1e-12);
  struct verifier v = {.root = cases, .to = to, .error = error};
  const char *known[BLOCKS + OTHERS + 1] = {NULL};
  for (int b = 0; b < BLOCKS; b++) {
    const json_t *block = json_object_get(cases, blocks[b].key);
    const int items = json_is_array(block) ? (int)json_array_size(block) : block != NULL;
    v.block = known[b] = blocks[b].key;
    for (v.index = 0; v.index < items && v.code == EO_OK; v.index++) {
      const json_t *item = json_is_array(block) ? json_array_get(block, (size_t)v.index) : block;
      v.relative = number_or(item, "rel_tol", relative);
      verify_item(&v, &blocks[b], item);
    }
  }
  memcpy(known + BLOCKS, other, sizeof other);
  eo_verify_unknown(to, "the file", cases, known);
  return v.code;
}
