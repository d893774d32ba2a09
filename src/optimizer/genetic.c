/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `ga` and `fpga`, the paper's fitness-predicted genetic algorithm, theory (H1) to (H5); ga is fpga that never
   predicts: the same operators on the same random numbers. What was settled where the paper is silent:
   - decisions in batch order see the history as it was before the generation; sequential order is as the paper prints
   it;
   - an individual bit-equal to a true row takes its value and counts neither as true nor as predicted (reuse);
   - the best predicted individual of a generation is evaluated too (verify): nothing else would ever correct it;
   - the elite replaces the worst child when no child is as good. */
#include "optimizer/prediction_history.h"
#include "optimizer/optimizer_private.h"
#include "optimizer/operators.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FIRST_ROWS = 1024 }; /* of the history, which grows */
enum kind { KIND_TRUE, KIND_PREDICTED, KIND_REUSED };

struct genetic {
  bool predicts;
  int generation, cursor;           /* cursor: individuals decided in this generation */
  bool cut;                         /* the budget ended within the generation */
  bool verifying;                   /* sequential order: the verification stands in the batch */
  double *x, *parents;              /* [population][n] */
  double *fitness, *parent_fitness; /* [population], to maximise, -infinite when failed */
  double *credibility;              /* [population] */
  int *row;                         /* [population] of the archive; -1: predicted */
  enum kind *kind;                  /* [population] */
  int *order;                       /* [population] scratch */
  struct eo_history history;
  struct eo_history_law law;
};

static void stop(struct eo_optimizer *optimizer)
{
  struct genetic *genetic = optimizer->state;
  if (!genetic)
    return;
  free(genetic->x);
  free(genetic->parents);
  free(genetic->fitness);
  free(genetic->parent_fitness);
  free(genetic->credibility);
  free(genetic->row);
  free(genetic->kind);
  free(genetic->order);
  eo_history_done(&genetic->history);
  free(genetic);
}

static struct eo_history_law history_law(const struct eo_optimizer_settings *settings)
{
  return (struct eo_history_law){
      .share_radius = eo_optimizer_share_radius(settings),
      .weight_decay = settings->weight_decay,
      .credibility_loss = settings->credibility_loss,
      .removal_threshold = settings->removal_threshold,
      .redundancy_threshold = settings->redundancy_threshold,
      .rms = settings->distance_norm == EO_NORM_RMS,
      .weights_over_all = settings->weight_sum == EO_WEIGHTS_ALL,
      .literal_redundancy = settings->literal_redundancy,
  };
}

static double fitness_of_row(const struct eo_optimizer *optimizer, int row)
{
  const double value = optimizer->archive.value[row];
  if (optimizer->settings.fitness_form == EO_FITNESS_NEGATIVE)
    return -value;
  return value > 0 && isfinite(value) ? 1 / value : -INFINITY;
}

static enum eo_code remember_true(struct eo_optimizer *optimizer, int row, struct eo_error *error)
{
  struct genetic *genetic = optimizer->state;
  const double fitness = fitness_of_row(optimizer, row);
  if (!genetic->predicts || !isfinite(fitness))
    return EO_OK;
  return eo_history_add(&genetic->history, optimizer->archive.x + (size_t)row * optimizer->settings.variables, fitness,
                        1, false, error);
}

static enum eo_code start(struct eo_optimizer *optimizer, struct eo_error *error)
{
  const size_t n = (size_t)optimizer->settings.variables, population = (size_t)optimizer->settings.population;
  struct genetic *genetic = optimizer->state = calloc(1, sizeof *genetic);
  if (!genetic)
    return eo_error_memory(error);
  genetic->predicts = optimizer->settings.algorithm == EO_FPGA;
  genetic->law = history_law(&optimizer->settings);
  genetic->x = malloc(population * n * sizeof(double));
  genetic->parents = malloc(population * n * sizeof(double));
  genetic->fitness = malloc(population * sizeof(double));
  genetic->parent_fitness = malloc(population * sizeof(double));
  genetic->credibility = malloc(population * sizeof(double));
  genetic->row = malloc(population * sizeof(int));
  genetic->kind = malloc(population * sizeof(enum kind));
  genetic->order = malloc(population * sizeof(int));
  if (!genetic->x || !genetic->parents || !genetic->fitness || !genetic->parent_fitness || !genetic->credibility ||
      !genetic->row || !genetic->kind || !genetic->order)
    return eo_error_memory(error);
  EO_TRY(eo_optimizer_reserve_batch(optimizer, optimizer->settings.population + 1, error));
  EO_TRY(eo_history_init(&genetic->history, optimizer->settings.variables, FIRST_ROWS, error));
  for (int row = 0; row < optimizer->archive.count; row++)
    EO_TRY(remember_true(optimizer, row, error));
  eo_random_points(genetic->x, optimizer->settings.population, optimizer->settings.variables, optimizer->settings.seed);
  return EO_OK;
}

/* Asks for individual i, if the budget allows. */
static void decide_true(struct eo_optimizer *optimizer, int i, bool repeat)
{
  struct genetic *genetic = optimizer->state;
  bool known;
  genetic->row[i] = eo_optimizer_request(optimizer, genetic->x + (size_t)i * optimizer->settings.variables,
                                         genetic->generation, i, repeat, &known);
  genetic->kind[i] = known ? KIND_REUSED : KIND_TRUE;
  genetic->credibility[i] = 1;
  genetic->cut |= genetic->row[i] < 0;
}

/* Predicts an individual by (H3) where its region is trusted, else asks for its evaluation. */
static enum eo_code decide(struct eo_optimizer *optimizer, int i, struct eo_error *error)
{
  struct genetic *genetic = optimizer->state;
  const double *x = genetic->x + (size_t)i * optimizer->settings.variables;
  const bool reuse = optimizer->settings.reuse;
  if (!genetic->predicts || (reuse && eo_archive_find(&optimizer->archive, x) >= 0)) {
    decide_true(optimizer, i, !reuse);
    return EO_OK;
  }
  const struct eo_history_estimate estimate = eo_history_predict(&genetic->history, &genetic->law, x);
  if (!eo_history_trusts(&estimate, optimizer->settings.trust_threshold)) {
    decide_true(optimizer, i, !reuse);
    return EO_OK;
  }
  genetic->kind[i] = KIND_PREDICTED;
  genetic->row[i] = -1;
  genetic->fitness[i] = estimate.fitness;
  genetic->credibility[i] = estimate.credibility;
  const struct eo_predicted prediction = {x, genetic->generation, i, estimate.fitness, estimate.credibility};
  return eo_optimizer_note_prediction(optimizer, &prediction, error);
}

/* Individual i, whose fitness is known by now, enters the history. Reused rows stand in it already. */
static enum eo_code remember(struct eo_optimizer *optimizer, int i, struct eo_error *error)
{
  struct genetic *genetic = optimizer->state;
  if (genetic->kind[i] == KIND_TRUE)
    return remember_true(optimizer, genetic->row[i], error);
  if (genetic->kind[i] == KIND_REUSED || !optimizer->settings.store_predicted)
    return EO_OK;
  return eo_history_add(&genetic->history, genetic->x + (size_t)i * optimizer->settings.variables, genetic->fitness[i],
                        genetic->credibility[i], true, error);
}

static void verify_best_prediction(struct eo_optimizer *optimizer)
{
  struct genetic *genetic = optimizer->state;
  int best = -1;
  for (int i = 0; i < genetic->cursor; i++)
    if (genetic->kind[i] == KIND_PREDICTED && (best < 0 || genetic->fitness[i] > genetic->fitness[best]))
      best = i;
  if (best < 0 || eo_optimizer_left(optimizer) <= 0)
    return;
  decide_true(optimizer, best, false);
  if (genetic->row[best] < optimizer->archive.count)
    genetic->fitness[best] = fitness_of_row(optimizer, genetic->row[best]);
}

static enum eo_code decide_batch(struct eo_optimizer *optimizer, struct eo_error *error)
{
  struct genetic *genetic = optimizer->state;
  enum eo_code code = EO_OK;
  for (; genetic->cursor < optimizer->settings.population && code == EO_OK && !genetic->cut; genetic->cursor++)
    code = decide(optimizer, genetic->cursor, error);
  if (genetic->cut)
    genetic->cursor--;
  if (code == EO_OK && genetic->predicts && optimizer->settings.verify)
    verify_best_prediction(optimizer);
  return code;
}

/* Until a true evaluation is needed or the generation is through. */
static enum eo_code decide_in_sequence(struct eo_optimizer *optimizer, struct eo_error *error)
{
  struct genetic *genetic = optimizer->state;
  while (genetic->cursor < optimizer->settings.population && optimizer->batch_count == 0 && !genetic->cut) {
    EO_TRY(decide(optimizer, genetic->cursor, error));
    if (genetic->cut)
      break;
    if (optimizer->batch_count == 0) {
      if (genetic->row[genetic->cursor] >= 0)
        genetic->fitness[genetic->cursor] = fitness_of_row(optimizer, genetic->row[genetic->cursor]);
      EO_TRY(remember(optimizer, genetic->cursor, error));
    }
    genetic->cursor++;
  }
  if (optimizer->batch_count == 0 && genetic->predicts && optimizer->settings.verify) {
    verify_best_prediction(optimizer);
    genetic->verifying = optimizer->batch_count > 0;
  }
  return EO_OK;
}

/* (H4), then (H5). */
static void clean_history(struct genetic *genetic, struct eo_generation *statistics)
{
  statistics->removed_redundant = eo_history_mark_redundant(&genetic->history, &genetic->law);
  statistics->removed_decayed = eo_history_decay(&genetic->history, &genetic->law);
  eo_history_compact(&genetic->history);
  statistics->history_rows = genetic->history.count;
}

static int best_of(const double *fitness, const int *excluded, int excluded_count, int size, double sign)
{
  int best = -1;
  for (int i = 0; i < size; i++) {
    bool skip = false;
    for (int j = 0; j < excluded_count && !skip; j++)
      skip = excluded[j] == i;
    if (!skip && (best < 0 || sign * fitness[i] > sign * fitness[best]))
      best = i;
  }
  return best;
}

/* The best parents that no child equals replace the worst children. */
static void keep_elite(struct eo_optimizer *optimizer)
{
  struct genetic *genetic = optimizer->state;
  const int size = optimizer->settings.population, n = optimizer->settings.variables;
  const double best = genetic->fitness[best_of(genetic->fitness, NULL, 0, size, 1)];
  int *chosen = genetic->order;
  for (int kept = 0; kept < optimizer->settings.elite; kept++) {
    const int parent = best_of(genetic->parent_fitness, chosen, kept, size, 1);
    if (!(genetic->parent_fitness[parent] > best))
      return;
    const int worst = best_of(genetic->fitness, NULL, 0, size, -1);
    memcpy(genetic->x + (size_t)worst * n, genetic->parents + (size_t)parent * n, (size_t)n * sizeof(double));
    genetic->fitness[worst] = genetic->parent_fitness[parent];
    chosen[kept] = parent;
  }
}

static void breed_next(struct eo_optimizer *optimizer)
{
  struct genetic *genetic = optimizer->state;
  double *x = genetic->parents, *fitness = genetic->parent_fitness;
  genetic->parents = genetic->x;
  genetic->parent_fitness = genetic->fitness;
  genetic->x = x;
  genetic->fitness = fitness;
  genetic->generation++;
  genetic->cursor = 0;
  eo_breed(&optimizer->settings, genetic->parents, genetic->parent_fitness, optimizer->settings.population,
           genetic->generation, 0, genetic->x, optimizer->settings.population);
}

static enum eo_code close_generation(struct eo_optimizer *optimizer, struct eo_error *error)
{
  struct genetic *genetic = optimizer->state;
  struct eo_generation statistics = {0};
  for (int i = 0; i < genetic->cursor; i++) {
    statistics.true_count += genetic->kind[i] == KIND_TRUE;
    statistics.predicted_count += genetic->kind[i] == KIND_PREDICTED;
    statistics.reused_count += genetic->kind[i] == KIND_REUSED;
  }
  if (genetic->predicts)
    clean_history(genetic, &statistics);
  const enum eo_code code = eo_optimizer_close_generation(optimizer, &statistics, error);
  genetic->verifying = false;
  optimizer->finished = genetic->cut || genetic->generation + 1 >= optimizer->settings.generations;
  if (code != EO_OK || optimizer->finished)
    return code;
  if (genetic->generation > 0)
    keep_elite(optimizer);
  breed_next(optimizer);
  return EO_OK;
}

static enum eo_code finish_batch_order(struct eo_optimizer *optimizer, struct eo_error *error)
{
  struct genetic *genetic = optimizer->state;
  for (int i = 0; i < genetic->cursor; i++) {
    if (genetic->row[i] >= 0)
      genetic->fitness[i] = fitness_of_row(optimizer, genetic->row[i]);
    EO_TRY(remember(optimizer, i, error));
  }
  return close_generation(optimizer, error);
}

static enum eo_code propose(struct eo_optimizer *optimizer, struct eo_error *error)
{
  const struct genetic *genetic = optimizer->state;
  const bool sequential = genetic->predicts && optimizer->settings.decision_order == EO_ORDER_SEQUENTIAL;
  while (!optimizer->finished && optimizer->batch_count == 0) {
    EO_TRY(sequential ? decide_in_sequence(optimizer, error) : decide_batch(optimizer, error));
    if (optimizer->batch_count == 0)
      EO_TRY(sequential ? close_generation(optimizer, error) : finish_batch_order(optimizer, error));
  }
  return EO_OK;
}

static enum eo_code absorb_in_sequence(struct eo_optimizer *optimizer, struct eo_error *error)
{
  struct genetic *genetic = optimizer->state;
  int last = genetic->cursor - 1;
  if (genetic->verifying) /* it entered the history as a prediction; the true row joins it */
    for (int i = 0; i < genetic->cursor; i++)
      if (genetic->row[i] == optimizer->archive.count - 1)
        last = i;
  genetic->fitness[last] = fitness_of_row(optimizer, genetic->row[last]);
  const enum eo_code code = remember(optimizer, last, error);
  return code == EO_OK && genetic->verifying ? close_generation(optimizer, error) : code;
}

static enum eo_code absorb(struct eo_optimizer *optimizer, struct eo_error *error)
{
  const struct genetic *genetic = optimizer->state;
  const bool sequential = genetic->predicts && optimizer->settings.decision_order == EO_ORDER_SEQUENTIAL;
  return sequential ? absorb_in_sequence(optimizer, error) : finish_batch_order(optimizer, error);
}

const struct eo_algorithm_functions eo_genetic_algorithm = {start, propose, absorb, stop};
