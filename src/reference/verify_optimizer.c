/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Kind "optimizer": the counter, operators, whole runs, and the successor's latin hypercube, surrogate and credibility;
   what predicts from the history stands in verify_prediction.c. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "optimizer/operators.h"
#include "optimizer/optimizer.h"
#include "optimizer/surrogate.h"
#include "reference/formula.h"
#include "reference/verify_optimizer_private.h"

enum { MOST_GENERATIONS = 100000 };

void eo_optimizer_case_begin(struct eo_optimizer_verifier *verifier, struct eo_case *item)
{
  verifier->relative = eo_case_relative_or(item, "rel_tol", verifier->usual);
}

void eo_optimizer_case_compare(const struct eo_optimizer_verifier *verifier, struct eo_case *expected, double value)
{
  eo_verify_number(verifier->v, expected, value, verifier->relative,
                   eo_case_largest(expected) == 0 ? verifier->relative : 0);
}

void eo_optimizer_case_compare_list(const struct eo_optimizer_verifier *verifier, struct eo_case *expected, int count,
                                    const double *value)
{
  eo_verify_size(verifier->v, expected, count);
  for (int i = 0; i < eo_case_size(expected); i++)
    eo_optimizer_case_compare(verifier, eo_case_at(expected, i), i < count ? value[i] : NAN);
}

static uint64_t whole_number(struct eo_case *value)
{
  double number = eo_case_real(value);
  if (number >= 0 && number < 9e15 && number == floor(number))
    return (uint64_t)number;
  if (!isnan(number))
    eo_case_fault(value, "A whole number from 0 is expected here.");
  return 0;
}

/* Whole numbers up to 2^64 - 1, as text or as a number. */
static uint64_t big_whole(struct eo_case *value)
{
  const char *text = eo_case_is_text(value) ? eo_case_text(value) : NULL;
  char *end = NULL;
  if (text) {
    uint64_t number = strtoull(text, &end, 10);
    if (end == text || *end || *text == '-')
      eo_case_fault(value, "A whole number, as digits, is expected here.");
    return number;
  }
  return whole_number(value);
}

/* 0 or 1, or a flag. */
static double number_or_flag(struct eo_case *value)
{
  return value && json_is_boolean(eo_case_json(value)) ? eo_case_flag(value) : eo_case_real(value);
}

double *eo_optimizer_case_numbers(struct eo_case *list, int *rows, int *columns)
{
  struct eo_case *first = eo_case_at(list, 0);
  *rows = eo_case_size(list);
  *columns = eo_case_is_list(first) ? eo_case_size(first) : 1;
  if (!list || !eo_case_is_list(list) || *rows < 1 || *rows > EO_OPTIMIZER_MOST_ROWS || *columns < 1 ||
      *columns > EO_MAX_VARIABLES) {
    eo_case_fault(list, "A list of numbers or of rows of numbers is expected here.");
    return NULL;
  }
  double *result = calloc((size_t)*rows * (size_t)*columns, sizeof *result);
  for (int i = 0; i < *rows && result; i++) {
    struct eo_case *row = eo_case_at(list, i);
    if (eo_case_is_list(first))
      eo_case_numbers(row, *columns, *columns, result + (size_t)i * (size_t)*columns);
    else
      result[i] = number_or_flag(row);
  }
  return result;
}

bool eo_optimizer_case_chooses(struct eo_case *object, const char *key, const char *usual, const char *other)
{
  const char *const words[] = {usual, other, NULL};
  return eo_case_choice(object, key, words, 0) == 1;
}

static enum eo_code check_random(void *context, struct eo_case *item, struct eo_error *error)
{
  const struct eo_optimizer_verifier *verifier = context;
  const double unit = 0x1p-53;
  struct eo_case *expected = eo_case_need(item, "u64");
  const uint64_t wanted = big_whole(expected), seed = big_whole(eo_case_need(item, "seed")),
                 stream = whole_number(eo_case_need(item, "stream")),
                 generation = whole_number(eo_case_need(item, "gen")), index = whole_number(eo_case_need(item, "idx")),
                 draw = whole_number(eo_case_need(item, "draw"));
  const struct eo_random random = eo_random_at(seed, stream, generation, index);
  const uint64_t bits = eo_random_bits(random, draw);
  (void)error;
  if (eo_case_faulty(item))
    return EO_OK;
  eo_verify_fact(verifier->v, expected, "the same 64 bits", bits == wanted);
  eo_verify_number(verifier->v, eo_case_need(item, "u01"), eo_random_unit(random, draw), 0, unit / 2);
  return EO_OK;
}

static void replace(struct eo_case *object, const char *key, double *value)
{
  *value = eo_case_number_or(object, key, *value);
}

/* The parameters of the files' operators and runs blocks; the files hold the algorithm as the paper has it. */
static void read_parameters(struct eo_optimizer_settings *settings, struct eo_case *this_case)
{
  replace(this_case, "pc", &settings->crossover);
  replace(this_case, "pm", &settings->mutation);
  replace(this_case, "eta_c", &settings->crossover_index);
  replace(this_case, "eta_m", &settings->mutation_index);
  settings->mutation_mode = eo_optimizer_case_chooses(this_case, "pm_mode", "gene", "individual") ? EO_MUTATE_INDIVIDUAL
                                                                                                  : EO_MUTATE_GENE;
  settings->population = eo_case_whole_or(this_case, "npop", 1, EO_OPTIMIZER_MOST_ROWS, settings->population);
  settings->generations = eo_case_whole_or(this_case, "ngen", 1, MOST_GENERATIONS, settings->generations);
  settings->elite = eo_case_whole_or(this_case, "elite", 0, EO_OPTIMIZER_MOST_ROWS, settings->elite);
  settings->share_radius = eo_case_number_or(this_case, "r_share", NAN);
  replace(this_case, "alpha", &settings->weight_decay);
  replace(this_case, "Rstar", &settings->trust_threshold);
  replace(this_case, "beta", &settings->credibility_loss);
  replace(this_case, "R0", &settings->removal_threshold);
  replace(this_case, "Ir", &settings->redundancy_threshold);
  settings->distance_norm = eo_optimizer_case_chooses(this_case, "norm", "range", "rms") ? EO_NORM_RMS : EO_NORM_RANGE;
  settings->weight_sum = eo_optimizer_case_chooses(this_case, "wnorm", "region", "all") ? EO_WEIGHTS_ALL
                                                                                        : EO_WEIGHTS_REGION;
  settings->decision_order = eo_optimizer_case_chooses(this_case, "order", "sequential", "batch") ? EO_ORDER_BATCH
                                                                                                  : EO_ORDER_SEQUENTIAL;
  settings->store_predicted = eo_case_flag_or(this_case, "store_predicted", true);
  settings->literal_redundancy = eo_case_flag_or(this_case, "literal", true);
  settings->verify = eo_case_whole_or(this_case, "verify", 0, 1, 0);
  settings->reuse = eo_case_flag_or(this_case, "reuse", false);
}

static enum eo_code compare_children(const struct eo_optimizer_verifier *verifier, struct eo_case *expected,
                                     const struct eo_optimizer_settings *settings, const double *parents,
                                     const double *fitness, int size, int n, int generation, struct eo_error *error)
{
  const int children = eo_case_size(expected);
  double *child = calloc((size_t)children * (size_t)n + 1, sizeof *child);
  if (!child)
    return eo_error_memory(error);
  eo_breed(settings, parents, fitness, size, generation, 0, child, children);
  for (int i = 0; i < children; i++)
    eo_optimizer_case_compare_list(verifier, eo_case_at(expected, i), n, child + (size_t)i * (size_t)n);
  free(child);
  return EO_OK;
}

static enum eo_code check_operators(void *context, struct eo_case *item, struct eo_error *error)
{
  struct eo_optimizer_verifier *verifier = context;
  int size, n, count, columns;
  double *parents = eo_optimizer_case_numbers(eo_case_need(item, "parents"), &size, &n);
  double *fitness = eo_optimizer_case_numbers(eo_case_need(item, "fitness"), &count, &columns);
  struct eo_case *expected = eo_case_need(item, "children"), *parameters = eo_case_need(item, "params");
  const int generation = eo_case_whole(item, "gen", 0, MOST_GENERATIONS);
  struct eo_optimizer_settings settings;
  enum eo_code code = EO_OK;
  eo_optimizer_case_begin(verifier, item);
  eo_optimizer_defaults(&settings, EO_GA, n);
  read_parameters(&settings, parameters);
  settings.seed = big_whole(eo_case_need(item, "seed"));
  if (parents && fitness && count != size)
    eo_case_fault(item, "parents and fitness do not belong together.");
  if (!eo_case_faulty(item))
    code = compare_children(verifier, expected, &settings, parents, fitness, size, n, generation, error);
  free(fitness);
  free(parents);
  return code;
}

static enum eo_code run_to_the_end(struct eo_optimizer *optimizer, const char *formula, int n, struct eo_error *error)
{
  struct eo_batch batch = {.count = 1};
  enum eo_code code = EO_OK;
  while (!code && batch.count > 0) {
    code = eo_optimizer_ask(optimizer, &batch, error);
    for (int i = 0; i < batch.count && !code; i++) {
      double fitness;
      code = eo_formula_evaluate(formula, batch.candidates[i].x, n, &fitness, error);
      const struct eo_outcome outcome = {.value = -fitness};
      if (!code)
        code = eo_optimizer_tell(optimizer, i, &outcome, error);
    }
  }
  return code;
}

static void compare_run(const struct eo_optimizer_verifier *verifier, const struct eo_optimizer *optimizer,
                        struct eo_case *item)
{
  static const char *const keys[] = {"true_evaluations_after_generation", "rows_after_generation", "removed_redundant",
                                     "removed_decayed", "best_true_fitness"};
  enum { KEYS = sizeof keys / sizeof *keys, COUNTS = KEYS - 1 };
  int generations, true_evaluations = 0, best = eo_optimizer_best(optimizer);
  const struct eo_generation *generation = eo_optimizer_generations(optimizer, &generations);
  struct eo_case *list[KEYS], *best_x = eo_case_need(item, "best_x");
  for (int k = 0; k < KEYS; k++) {
    list[k] = eo_case_need(item, keys[k]);
    eo_verify_size(verifier->v, list[k], generations);
  }
  for (int i = 0; i < generations; i++) {
    true_evaluations += generation[i].true_count;
    const double count[COUNTS] = {true_evaluations, generation[i].history_rows, generation[i].removed_redundant,
                                  generation[i].removed_decayed};
    for (int k = 0; k < COUNTS; k++)
      eo_verify_exact(verifier->v, eo_case_at(list[k], i), count[k]);
    eo_optimizer_case_compare(verifier, eo_case_at(list[COUNTS], i), -generation[i].best_value);
  }
  eo_optimizer_case_compare(verifier, eo_case_need(item, "pfc"), eo_optimizer_counters(optimizer).fitness_computed);
  eo_verify_fact(verifier->v, best_x, "there is a best point", best >= 0);
  if (best >= 0)
    eo_optimizer_case_compare_list(verifier, best_x, eo_case_whole(item, "n", 1, EO_MAX_VARIABLES),
                                   eo_optimizer_row(optimizer, best).x);
}

static enum eo_code check_run(void *context, struct eo_case *item, struct eo_error *error)
{
  struct eo_optimizer_verifier *verifier = context;
  const char *formula = eo_case_word(item, "fitness");
  const int n = eo_case_whole(item, "n", 1, EO_MAX_VARIABLES);
  struct eo_optimizer *optimizer = NULL;
  struct eo_optimizer_settings settings;
  eo_optimizer_case_begin(verifier, item);
  eo_optimizer_defaults(&settings, EO_FPGA, n);
  read_parameters(&settings, eo_case_need(item, "params"));
  settings.seed = big_whole(eo_case_need(item, "seed"));
  settings.fitness_form = EO_FITNESS_NEGATIVE;
  if (eo_case_faulty(item))
    return EO_OK;
  enum eo_code code = eo_optimizer_new(&settings, &optimizer, error);
  if (!code)
    code = run_to_the_end(optimizer, formula, n, error);
  if (!code)
    compare_run(verifier, optimizer, item);
  eo_optimizer_free(optimizer);
  return code;
}

/* Reads "... ridge 1e-9" from the description of the surrogate. */
static double ridge_of(struct eo_case *item)
{
  struct eo_case *words = eo_case_need(item, "rbf");
  const char *text = eo_case_text(words), *ridge = text ? strstr(text, "ridge ") : NULL;
  char *end = NULL;
  double value = ridge ? strtod(ridge + strlen("ridge "), &end) : NAN;
  if (text && (!ridge || end == ridge + strlen("ridge ") || !(value >= 0)))
    eo_case_fault(words, "The words end with the ridge, like \"ridge 1e-9\".");
  return value;
}

static void compare_surrogate(const struct eo_optimizer_verifier *verifier, struct eo_case *item,
                              struct eo_surrogate *surrogate, const double *query, int queries)
{
  struct eo_case *credibility = eo_case_need(item, "credibility"), *trust = eo_case_need(credibility, "R"),
                 *prediction = eo_case_need(item, "prediction");
  const double length = eo_case_number(credibility, "ell"), scale = eo_case_number(credibility, "scale");
  eo_case_remark(credibility, "formula");
  if (eo_case_faulty(item))
    return;
  eo_optimizer_case_compare_list(verifier, eo_case_need(item, "loo_abs"), surrogate->rows, surrogate->residual);
  eo_optimizer_case_compare_list(verifier, eo_case_need(item, "loo_by_refit"), surrogate->rows, surrogate->residual);
  eo_surrogate_set_scale(surrogate, surrogate->residual, scale);
  eo_verify_size(verifier->v, prediction, queries);
  eo_verify_size(verifier->v, trust, queries);
  for (int i = 0; i < queries; i++) {
    eo_surrogate_visit(surrogate, query + (size_t)i * (size_t)surrogate->variables);
    eo_optimizer_case_compare(verifier, eo_case_at(prediction, i), eo_surrogate_value(surrogate, 0));
    eo_optimizer_case_compare(verifier, eo_case_at(trust, i), eo_surrogate_credibility(surrogate, length));
  }
}

static enum eo_code check_surrogate(const struct eo_optimizer_verifier *verifier, struct eo_case *item, const double *x,
                                    int m, int n, struct eo_error *error)
{
  int rows, queries, one, columns;
  double *y = eo_optimizer_case_numbers(eo_case_need(item, "y"), &rows, &one);
  double *query = eo_optimizer_case_numbers(eo_case_need(item, "query"), &queries, &columns);
  struct eo_surrogate surrogate = {0};
  const double ridge = ridge_of(item);
  enum eo_code code = EO_OK;
  if (y && query && (rows != m || one != 1 || columns != n))
    eo_case_fault(item, "y or query do not belong to the latin hypercube.");
  if (!eo_case_faulty(item))
    code = eo_surrogate_init(&surrogate, n, m, 1, EO_TAIL_LINEAR, error);
  if (!code && !eo_case_faulty(item) && !eo_surrogate_fit(&surrogate, EO_TAIL_LINEAR, ridge, x, y, m, 1))
    code = eo_error_set(error, EO_ERROR_NUMERIC, "", "The rows do not determine a surrogate.");
  if (!code && !eo_case_faulty(item))
    compare_surrogate(verifier, item, &surrogate, query, queries);
  eo_surrogate_done(&surrogate);
  free(query);
  free(y);
  return code;
}

static enum eo_code check_successor(void *context, struct eo_case *item, struct eo_error *error)
{
  struct eo_optimizer_verifier *verifier = context;
  struct eo_case *latin = eo_case_need(item, "lhs"), *expected = eo_case_need(latin, "x");
  const int n = eo_case_whole(latin, "n", 1, EO_MAX_VARIABLES),
            m = eo_case_whole(latin, "m", 1, EO_OPTIMIZER_MOST_ROWS);
  const uint64_t seed = big_whole(eo_case_need(latin, "seed"));
  eo_optimizer_case_begin(verifier, item);
  if (eo_case_faulty(item))
    return EO_OK;
  double *x = calloc((size_t)m * (size_t)n, sizeof *x), *scratch = calloc((size_t)m, sizeof *scratch);
  enum eo_code code = x && scratch ? EO_OK : eo_error_memory(error);
  if (!code) {
    eo_latin_hypercube(x, m, n, seed, 0, scratch);
    eo_verify_size(verifier->v, expected, m);
    for (int i = 0; i < m && i < eo_case_size(expected); i++)
      eo_optimizer_case_compare_list(verifier, eo_case_at(expected, i), n, x + (size_t)i * (size_t)n);
    if (eo_case_find(item, "y"))
      code = check_surrogate(verifier, item, x, m, n, error);
  }
  free(scratch);
  free(x);
  return code;
}

static const struct eo_verify_block blocks[] = {
    {"rng", EO_BLOCK_EACH, check_random},
    {"histories", EO_BLOCK_EITHER, eo_verify_histories},
    {"predict", EO_BLOCK_EACH, eo_verify_predict},
    {"redundancy", EO_BLOCK_EACH, eo_verify_redundancy},
    {"decay", EO_BLOCK_EACH, eo_verify_decay},
    {"clean_up", EO_BLOCK_EACH, eo_verify_clean_up},
    {"operators", EO_BLOCK_EACH, check_operators},
    {"runs", EO_BLOCK_EACH, check_run},
    {"invariants", EO_BLOCK_REMARKS, NULL},
    {"successor", EO_BLOCK_WHOLE, check_successor},
    {NULL, EO_BLOCK_INPUT, NULL},
};

enum eo_code eo_verify_optimizer(struct eo_case *file, struct eo_verification *verification, struct eo_error *error)
{
  struct eo_case *conventions = eo_case_find(file, "conventions");
  struct eo_optimizer_verifier verifier = {
      .file = file, .v = verification, .usual = eo_case_relative_or(conventions, "rel_tol", 1e-12)};
  return eo_verify_blocks(verification, file, blocks, &verifier, error);
}
