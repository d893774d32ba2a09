/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `ga` and `fpga`, the paper's fitness-predicted genetic algorithm (section 4); ga is fpga that never predicts: the
   same operators on the same random numbers. What was settled where the paper is silent:
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

static void stop(struct eo_optimizer *o)
{
  struct genetic *g = o->state;
  if (!g)
    return;
  free(g->x);
  free(g->parents);
  free(g->fitness);
  free(g->parent_fitness);
  free(g->credibility);
  free(g->row);
  free(g->kind);
  free(g->order);
  eo_history_done(&g->history);
  free(g);
}

static struct eo_history_law history_law(const struct eo_optimizer_settings *s)
{
  return (struct eo_history_law){
      .share_radius = eo_optimizer_share_radius(s),
      .weight_decay = s->weight_decay,
      .credibility_loss = s->credibility_loss,
      .removal_threshold = s->removal_threshold,
      .redundancy_threshold = s->redundancy_threshold,
      .rms = s->distance_norm == EO_NORM_RMS,
      .weights_over_all = s->weight_sum == EO_WEIGHTS_ALL,
      .literal_redundancy = s->literal_redundancy,
  };
}

static double fitness_of_row(const struct eo_optimizer *o, int row)
{
  const double value = o->archive.value[row];
  if (o->settings.fitness_form == EO_FITNESS_NEGATIVE)
    return -value;
  return value > 0 && isfinite(value) ? 1 / value : -INFINITY;
}

static enum eo_code remember_true(struct eo_optimizer *o, int row, struct eo_error *error)
{
  struct genetic *g = o->state;
  const double fitness = fitness_of_row(o, row);
  if (!g->predicts || !isfinite(fitness))
    return EO_OK;
  return eo_history_add(&g->history, o->archive.x + (size_t)row * o->settings.variables, fitness, 1, false, error);
}

static enum eo_code start(struct eo_optimizer *o, struct eo_error *error)
{
  const size_t n = (size_t)o->settings.variables, population = (size_t)o->settings.population;
  struct genetic *g = o->state = calloc(1, sizeof *g);
  if (!g)
    return eo_error_memory(error);
  g->predicts = o->settings.algorithm == EO_FPGA;
  g->law = history_law(&o->settings);
  g->x = malloc(population * n * sizeof(double));
  g->parents = malloc(population * n * sizeof(double));
  g->fitness = malloc(population * sizeof(double));
  g->parent_fitness = malloc(population * sizeof(double));
  g->credibility = malloc(population * sizeof(double));
  g->row = malloc(population * sizeof(int));
  g->kind = malloc(population * sizeof(enum kind));
  g->order = malloc(population * sizeof(int));
  if (!g->x || !g->parents || !g->fitness || !g->parent_fitness || !g->credibility || !g->row || !g->kind || !g->order)
    return eo_error_memory(error);
  enum eo_code code = eo_optimizer_reserve_batch(o, o->settings.population + 1, error);
  if (code == EO_OK)
    code = eo_history_init(&g->history, o->settings.variables, 1024, error);
  for (int row = 0; row < o->archive.count && code == EO_OK; row++)
    code = remember_true(o, row, error);
  if (code == EO_OK)
    eo_random_points(g->x, o->settings.population, o->settings.variables, o->settings.seed);
  return code;
}

/* Asks for individual i, if the budget allows. */
static void decide_true(struct eo_optimizer *o, int i, bool repeat)
{
  struct genetic *g = o->state;
  bool known;
  g->row[i] = eo_optimizer_request(o, g->x + (size_t)i * o->settings.variables, g->generation, i, repeat, &known);
  g->kind[i] = known ? KIND_REUSED : KIND_TRUE;
  g->credibility[i] = 1;
  g->cut |= g->row[i] < 0;
}

/* Predicts an individual by (H3) where its region is trusted, else asks for its evaluation. */
static enum eo_code decide(struct eo_optimizer *o, int i, struct eo_error *error)
{
  struct genetic *g = o->state;
  const double *x = g->x + (size_t)i * o->settings.variables;
  const bool reuse = o->settings.reuse;
  if (!g->predicts || (reuse && eo_archive_find(&o->archive, x) >= 0)) {
    decide_true(o, i, !reuse);
    return EO_OK;
  }
  const struct eo_history_estimate estimate = eo_history_predict(&g->history, &g->law, x);
  if (!eo_history_trusts(&estimate, o->settings.trust_threshold)) {
    decide_true(o, i, !reuse);
    return EO_OK;
  }
  g->kind[i] = KIND_PREDICTED;
  g->row[i] = -1;
  g->fitness[i] = estimate.fitness;
  g->credibility[i] = estimate.credibility;
  const struct eo_predicted prediction = {x, g->generation, i, estimate.fitness, estimate.credibility};
  return eo_optimizer_note_prediction(o, &prediction, error);
}

/* Individual i, whose fitness is known by now, enters the history. Reused rows stand in it already. */
static enum eo_code remember(struct eo_optimizer *o, int i, struct eo_error *error)
{
  struct genetic *g = o->state;
  if (g->kind[i] == KIND_TRUE)
    return remember_true(o, g->row[i], error);
  if (g->kind[i] == KIND_REUSED || !o->settings.store_predicted)
    return EO_OK;
  return eo_history_add(&g->history, g->x + (size_t)i * o->settings.variables, g->fitness[i], g->credibility[i], true,
                        error);
}

static void verify_best_prediction(struct eo_optimizer *o)
{
  struct genetic *g = o->state;
  int best = -1;
  for (int i = 0; i < g->cursor; i++)
    if (g->kind[i] == KIND_PREDICTED && (best < 0 || g->fitness[i] > g->fitness[best]))
      best = i;
  if (best < 0 || eo_optimizer_left(o) <= 0)
    return;
  decide_true(o, best, false);
  if (g->row[best] < o->archive.count)
    g->fitness[best] = fitness_of_row(o, g->row[best]);
}

static enum eo_code decide_batch(struct eo_optimizer *o, struct eo_error *error)
{
  struct genetic *g = o->state;
  enum eo_code code = EO_OK;
  for (; g->cursor < o->settings.population && code == EO_OK && !g->cut; g->cursor++)
    code = decide(o, g->cursor, error);
  if (g->cut)
    g->cursor--;
  if (code == EO_OK && g->predicts && o->settings.verify)
    verify_best_prediction(o);
  return code;
}

/* Until a true evaluation is needed or the generation is through. */
static enum eo_code decide_in_sequence(struct eo_optimizer *o, struct eo_error *error)
{
  struct genetic *g = o->state;
  enum eo_code code = EO_OK;
  while (g->cursor < o->settings.population && o->batch_count == 0 && code == EO_OK && !g->cut) {
    code = decide(o, g->cursor, error);
    if (g->cut)
      break;
    if (code == EO_OK && o->batch_count == 0) {
      if (g->row[g->cursor] >= 0)
        g->fitness[g->cursor] = fitness_of_row(o, g->row[g->cursor]);
      code = remember(o, g->cursor, error);
    }
    g->cursor++;
  }
  if (code == EO_OK && o->batch_count == 0 && g->predicts && o->settings.verify) {
    verify_best_prediction(o);
    g->verifying = o->batch_count > 0;
  }
  return code;
}

/* (H4), then (H5). */
static void clean_history(struct genetic *g, struct eo_generation *statistics)
{
  statistics->removed_redundant = eo_history_mark_redundant(&g->history, &g->law);
  statistics->removed_decayed = eo_history_decay(&g->history, &g->law);
  eo_history_compact(&g->history);
  statistics->history_rows = g->history.count;
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
static void keep_elite(struct eo_optimizer *o)
{
  struct genetic *g = o->state;
  const int size = o->settings.population, n = o->settings.variables;
  const double best = g->fitness[best_of(g->fitness, NULL, 0, size, 1)];
  int *chosen = g->order;
  for (int kept = 0; kept < o->settings.elite; kept++) {
    const int parent = best_of(g->parent_fitness, chosen, kept, size, 1);
    if (!(g->parent_fitness[parent] > best))
      return;
    const int worst = best_of(g->fitness, NULL, 0, size, -1);
    memcpy(g->x + (size_t)worst * n, g->parents + (size_t)parent * n, (size_t)n * sizeof(double));
    g->fitness[worst] = g->parent_fitness[parent];
    chosen[kept] = parent;
  }
}

static void breed_next(struct eo_optimizer *o)
{
  struct genetic *g = o->state;
  double *x = g->parents, *fitness = g->parent_fitness;
  g->parents = g->x;
  g->parent_fitness = g->fitness;
  g->x = x;
  g->fitness = fitness;
  g->generation++;
  g->cursor = 0;
  eo_breed(&o->settings, g->parents, g->parent_fitness, o->settings.population, g->generation, 0, g->x,
           o->settings.population);
}

static enum eo_code close_generation(struct eo_optimizer *o, struct eo_error *error)
{
  struct genetic *g = o->state;
  struct eo_generation statistics = {0};
  for (int i = 0; i < g->cursor; i++) {
    statistics.true_count += g->kind[i] == KIND_TRUE;
    statistics.predicted_count += g->kind[i] == KIND_PREDICTED;
    statistics.reused_count += g->kind[i] == KIND_REUSED;
  }
  if (g->predicts)
    clean_history(g, &statistics);
  const enum eo_code code = eo_optimizer_close_generation(o, &statistics, error);
  g->verifying = false;
  o->finished = g->cut || g->generation + 1 >= o->settings.generations;
  if (code != EO_OK || o->finished)
    return code;
  if (g->generation > 0)
    keep_elite(o);
  breed_next(o);
  return EO_OK;
}

static enum eo_code finish_batch_order(struct eo_optimizer *o, struct eo_error *error)
{
  struct genetic *g = o->state;
  enum eo_code code = EO_OK;
  for (int i = 0; i < g->cursor && code == EO_OK; i++) {
    if (g->row[i] >= 0)
      g->fitness[i] = fitness_of_row(o, g->row[i]);
    code = remember(o, i, error);
  }
  return code == EO_OK ? close_generation(o, error) : code;
}

static enum eo_code propose(struct eo_optimizer *o, struct eo_error *error)
{
  const struct genetic *g = o->state;
  const bool sequential = g->predicts && o->settings.decision_order == EO_ORDER_SEQUENTIAL;
  enum eo_code code = EO_OK;
  while (!o->finished && o->batch_count == 0 && code == EO_OK) {
    code = sequential ? decide_in_sequence(o, error) : decide_batch(o, error);
    if (code == EO_OK && o->batch_count == 0)
      code = sequential ? close_generation(o, error) : finish_batch_order(o, error);
  }
  return code;
}

static enum eo_code absorb_in_sequence(struct eo_optimizer *o, struct eo_error *error)
{
  struct genetic *g = o->state;
  int last = g->cursor - 1;
  if (g->verifying) /* it entered the history as a prediction; the true row joins it */
    for (int i = 0; i < g->cursor; i++)
      if (g->row[i] == o->archive.count - 1)
        last = i;
  g->fitness[last] = fitness_of_row(o, g->row[last]);
  const enum eo_code code = remember(o, last, error);
  return code == EO_OK && g->verifying ? close_generation(o, error) : code;
}

static enum eo_code absorb(struct eo_optimizer *o, struct eo_error *error)
{
  const struct genetic *g = o->state;
  const bool sequential = g->predicts && o->settings.decision_order == EO_ORDER_SEQUENTIAL;
  return sequential ? absorb_in_sequence(o, error) : finish_batch_order(o, error);
}

const struct eo_algorithm_functions eo_genetic_algorithm = {start, propose, absorb, stop};
