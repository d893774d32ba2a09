/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "optimizer/optimizer.h"

#include "optimizer/optimizer_private.h"
#include "optimizer/pareto.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct eo_algorithm_functions *const algorithms[EO_ALGORITHMS] = {
    [EO_GA] = &eo_genetic_algorithm,
    [EO_FPGA] = &eo_genetic_algorithm,
    [EO_CREDIBILITY_GA] = &eo_credibility_algorithm,
    [EO_NSGA2] = &eo_nsga2_algorithm,
};

enum eo_code eo_optimizer_new(const struct eo_optimizer_settings *settings, struct eo_optimizer **optimizer,
                              struct eo_error *error)
{
  enum eo_code code = eo_optimizer_settings_check(settings, error);
  if (code != EO_OK)
    return code;
  struct eo_optimizer *this_optimizer = calloc(1, sizeof *this_optimizer);
  if (!this_optimizer)
    return eo_error_memory(error);
  this_optimizer->settings = *settings;
  this_optimizer->algorithm = algorithms[settings->algorithm];
  this_optimizer->warp.variables = settings->variables;
  this_optimizer->budget = eo_optimizer_budget(settings);
  code = eo_archive_init(&this_optimizer->archive, settings->variables,
                         settings->algorithm == EO_NSGA2 ? settings->objectives : 0, error);
  if (code != EO_OK) {
    eo_optimizer_free(this_optimizer);
    return code;
  }
  *optimizer = this_optimizer;
  return EO_OK;
}

void eo_optimizer_free(struct eo_optimizer *optimizer)
{
  if (!optimizer)
    return;
  optimizer->algorithm->stop(optimizer);
  eo_archive_done(&optimizer->archive);
  free(optimizer->batch_x);
  free(optimizer->candidate);
  free(optimizer->outcome);
  free(optimizer->batch_objective);
  free(optimizer->batch_part);
  free(optimizer->anatomy.group);
  free(optimizer->batch_asked);
  eo_cube_warp_done(&optimizer->warp);
  free(optimizer->told);
  free(optimizer->prediction_x);
  free(optimizer->prediction);
  free(optimizer->generation);
  free(optimizer);
}

static bool has_failed(const struct eo_optimizer *optimizer, const struct eo_outcome *outcome)
{
  bool failed = outcome->failed || !isfinite(outcome->value) || !(outcome->violation >= 0);
  for (int k = 0; k < optimizer->archive.objectives && !failed; k++)
    failed = !outcome->objectives || !isfinite(outcome->objectives[k]);
  return failed;
}

/* asked: x as the caller knows it. */
static void store(struct eo_optimizer *optimizer, const double *x, const double *asked,
                  const struct eo_outcome *outcome, int generation, int individual)
{
  const bool failed = has_failed(optimizer, outcome);
  eo_archive_add(&optimizer->archive, x, asked, failed ? INFINITY : outcome->value,
                 failed ? INFINITY : outcome->violation, failed ? NULL : outcome->objectives,
                 failed ? NULL : outcome->parts, generation, individual);
}

enum eo_code eo_optimizer_set_view(struct eo_optimizer *optimizer, const struct eo_view *view, struct eo_error *error)
{
  if (optimizer->started || optimizer->archive.count)
    return eo_error_set(error, EO_ERROR_INPUT, "", "The view must be set before the first row.");
  if (optimizer->settings.algorithm != EO_CREDIBILITY_GA && optimizer->settings.algorithm != EO_NSGA2)
    return EO_OK;
  eo_cube_warp_done(&optimizer->warp);
  return eo_cube_warp_init(&optimizer->warp, view, optimizer->settings.variables, error);
}

enum eo_code eo_optimizer_describe(struct eo_optimizer *optimizer, const struct eo_anatomy *anatomy,
                                   struct eo_error *error)
{
  if (optimizer->started || optimizer->archive.count)
    return eo_error_set(error, EO_ERROR_INPUT, "", "The value must be described before the first row.");
  if (optimizer->settings.algorithm != EO_CREDIBILITY_GA)
    return EO_OK;
  const size_t bytes = (size_t)anatomy->groups * sizeof *anatomy->group;
  struct eo_part_group *group = malloc(bytes + 1);
  if (!group)
    return eo_error_memory(error);
  if (bytes)
    memcpy(group, anatomy->group, bytes);
  free(optimizer->anatomy.group);
  optimizer->anatomy = *anatomy;
  optimizer->anatomy.group = group;
  eo_archive_set_parts(&optimizer->archive, anatomy->parts);
  return EO_OK;
}

enum eo_code eo_optimizer_import(struct eo_optimizer *optimizer, const double *x, const struct eo_outcome *outcome,
                                 struct eo_error *error)
{
  if (optimizer->started)
    return eo_error_set(error, EO_ERROR_INPUT, "", "Rows can be imported before the first ask only.");
  for (int k = 0; k < optimizer->settings.variables; k++)
    if (!(x[k] >= 0 && x[k] <= 1))
      return eo_error_set(error, EO_ERROR_INPUT, "", "Variable %d of an imported row is %g, outside 0..1.", k + 1,
                          x[k]);
  double inside[EO_MAX_VARIABLES];
  if (eo_archive_find(&optimizer->archive, x) >= 0)
    return EO_OK;
  eo_cube_warp_in(&optimizer->warp, x, inside);
  const enum eo_code code = eo_archive_reserve(&optimizer->archive, 1, error);
  if (code == EO_OK)
    store(optimizer, inside, x, outcome, -1, -1);
  return code;
}

static enum eo_code fill_batch(struct eo_optimizer *optimizer, struct eo_error *error)
{
  if (!optimizer->started) {
    optimizer->started = true;
    EO_TRY(optimizer->algorithm->start(optimizer, error));
  }
  if (!optimizer->finished)
    EO_TRY(optimizer->algorithm->propose(optimizer, error));
  return eo_archive_reserve(&optimizer->archive, optimizer->batch_count, error);
}

enum eo_code eo_optimizer_ask(struct eo_optimizer *optimizer, struct eo_batch *batch, struct eo_error *error)
{
  if (optimizer->told_count < optimizer->batch_count)
    return eo_error_set(error, EO_ERROR_INPUT, "", "%d of %d candidates of the last batch were not told.",
                        optimizer->batch_count - optimizer->told_count, optimizer->batch_count);
  optimizer->batch_count = optimizer->told_count = optimizer->prediction_count = 0;
  enum eo_code code = fill_batch(optimizer, error);
  if (code != EO_OK) {
    optimizer->finished = true;
    optimizer->batch_count = 0;
    return code;
  }
  *batch = (struct eo_batch){optimizer->batch_count, optimizer->candidate, optimizer->prediction_count,
                             optimizer->prediction};
  return EO_OK;
}

static void apply_batch(struct eo_optimizer *optimizer)
{
  for (int i = 0; i < optimizer->batch_count; i++)
    store(optimizer, optimizer->batch_x + (size_t)i * optimizer->settings.variables, optimizer->candidate[i].x,
          &optimizer->outcome[i], optimizer->candidate[i].generation, optimizer->candidate[i].individual);
  optimizer->true_evaluations += optimizer->batch_count;
}

enum eo_code eo_optimizer_tell(struct eo_optimizer *optimizer, int candidate, const struct eo_outcome *outcome,
                               struct eo_error *error)
{
  if (candidate < 0 || candidate >= optimizer->batch_count || optimizer->told[candidate])
    return eo_error_set(error, EO_ERROR_INPUT, "", "Candidate %d is not waiting for an outcome.", candidate);
  const int m = optimizer->archive.objectives;
  struct eo_outcome *kept = &optimizer->outcome[candidate];
  *kept = *outcome;
  kept->objectives = kept->parts = NULL;
  if (m > 0 && outcome->objectives) {
    double *objectives = optimizer->batch_objective + (size_t)candidate * m;
    memcpy(objectives, outcome->objectives, (size_t)m * sizeof *objectives);
    kept->objectives = objectives;
  }
  const size_t parts = (size_t)optimizer->anatomy.parts;
  if (parts > 0 && outcome->parts)
    kept->parts = memcpy(optimizer->batch_part + (size_t)candidate * parts, outcome->parts, parts * sizeof(double));
  optimizer->told[candidate] = true;
  if (++optimizer->told_count < optimizer->batch_count)
    return EO_OK;
  apply_batch(optimizer);
  return optimizer->algorithm->absorb(optimizer, error);
}

int eo_optimizer_left(const struct eo_optimizer *optimizer)
{
  const int pending = optimizer->told_count < optimizer->batch_count ? optimizer->batch_count : 0;
  return optimizer->budget - optimizer->true_evaluations - pending;
}

static int find_pending(const struct eo_optimizer *optimizer, const double *asked)
{
  const size_t bytes = (size_t)optimizer->settings.variables * sizeof *asked;
  for (int i = 0; i < optimizer->batch_count; i++)
    if (memcmp(optimizer->candidate[i].x, asked, bytes) == 0)
      return optimizer->archive.count + i;
  return -1;
}

int eo_optimizer_request(struct eo_optimizer *optimizer, const double *x, int generation, int individual, bool repeat,
                         bool *known)
{
  const size_t n = (size_t)optimizer->settings.variables;
  double asked[EO_MAX_VARIABLES];
  eo_cube_warp_out(&optimizer->warp, x, asked);
  int row = repeat ? -1 : eo_archive_find(&optimizer->archive, asked);
  if (row < 0 && !repeat)
    row = find_pending(optimizer, asked);
  *known = row >= 0;
  if (row >= 0)
    return row;
  if (eo_optimizer_left(optimizer) <= 0)
    return -1;
  const int i = optimizer->batch_count++;
  memcpy(optimizer->batch_x + (size_t)i * n, x, n * sizeof *x);
  optimizer->candidate[i] = (struct eo_candidate){
      memcpy(optimizer->batch_asked + (size_t)i * n, asked, n * sizeof *asked), generation, individual};
  optimizer->told[i] = false;
  return optimizer->archive.count + i;
}

enum eo_code eo_optimizer_reserve_batch(struct eo_optimizer *optimizer, int count, struct eo_error *error)
{
  const size_t c = (size_t)count, n = (size_t)optimizer->settings.variables, m = (size_t)optimizer->archive.objectives;
  optimizer->batch_capacity = count;
  optimizer->batch_x = malloc(c * n * sizeof(double));
  optimizer->batch_asked = malloc(c * n * sizeof(double));
  optimizer->candidate = malloc(c * sizeof *optimizer->candidate);
  optimizer->outcome = malloc(c * sizeof *optimizer->outcome);
  optimizer->batch_objective = malloc((c * m + 1) * sizeof(double));
  optimizer->batch_part = malloc((c * (size_t)optimizer->anatomy.parts + 1) * sizeof(double));
  optimizer->told = malloc(c * sizeof *optimizer->told);
  return optimizer->batch_x && optimizer->batch_asked && optimizer->batch_part && optimizer->candidate &&
                 optimizer->outcome && optimizer->batch_objective && optimizer->told
             ? EO_OK
             : eo_error_memory(error);
}

static enum eo_code reserve_prediction(struct eo_optimizer *optimizer, struct eo_error *error)
{
  if (optimizer->prediction_count < optimizer->prediction_capacity)
    return EO_OK;
  const size_t n = (size_t)optimizer->settings.variables, capacity = 2 * (size_t)optimizer->prediction_capacity + 256;
  double *x = realloc(optimizer->prediction_x, capacity * n * sizeof *x);
  if (x)
    optimizer->prediction_x = x;
  struct eo_predicted *prediction = realloc(optimizer->prediction, capacity * sizeof *prediction);
  if (prediction)
    optimizer->prediction = prediction;
  if (!x || !prediction)
    return eo_error_memory(error);
  optimizer->prediction_capacity = (int)capacity;
  for (int i = 0; i < optimizer->prediction_count; i++)
    prediction[i].x = x + (size_t)i * n;
  return EO_OK;
}

enum eo_code eo_optimizer_note_prediction(struct eo_optimizer *optimizer, const struct eo_predicted *prediction,
                                          struct eo_error *error)
{
  const enum eo_code code = reserve_prediction(optimizer, error);
  if (code != EO_OK)
    return code;
  const int i = optimizer->prediction_count++, n = optimizer->settings.variables;
  double *copy = optimizer->prediction_x + (size_t)i * n;
  memcpy(copy, prediction->x, (size_t)n * sizeof *copy);
  optimizer->prediction[i] = *prediction;
  optimizer->prediction[i].x = copy;
  return EO_OK;
}

enum eo_code eo_optimizer_close_generation(struct eo_optimizer *optimizer, const struct eo_generation *generation,
                                           struct eo_error *error)
{
  if (optimizer->generation_count == optimizer->generation_capacity) {
    const size_t capacity = 2 * (size_t)optimizer->generation_capacity + 64;
    struct eo_generation *larger = realloc(optimizer->generation, capacity * sizeof *larger);
    if (!larger)
      return eo_error_memory(error);
    optimizer->generation = larger;
    optimizer->generation_capacity = (int)capacity;
  }
  struct eo_generation *closed = &optimizer->generation[optimizer->generation_count++];
  *closed = *generation;
  closed->best_value = optimizer->archive.best < 0 ? INFINITY : optimizer->archive.value[optimizer->archive.best];
  optimizer->predicted += closed->predicted_count;
  optimizer->reused += closed->reused_count;
  return EO_OK;
}

int eo_optimizer_rows(const struct eo_optimizer *optimizer)
{
  return optimizer->archive.count;
}

struct eo_row eo_optimizer_row(const struct eo_optimizer *optimizer, int index)
{
  const struct eo_archive *archive = &optimizer->archive;
  return (struct eo_row){
      .x = archive->asked + (size_t)index * archive->variables,
      .objectives = archive->objectives ? archive->objective + (size_t)index * archive->objectives : NULL,
      .value = archive->value[index],
      .violation = archive->violation[index],
      .failed = eo_archive_failed(archive, index),
      .imported = archive->generation[index] < 0,
      .generation = archive->generation[index],
      .individual = archive->individual[index],
  };
}

int eo_optimizer_best(const struct eo_optimizer *optimizer)
{
  return optimizer->archive.best;
}

struct eo_counters eo_optimizer_counters(const struct eo_optimizer *optimizer)
{
  struct eo_counters counters = {
      .true_evaluations = optimizer->true_evaluations, .predicted = optimizer->predicted, .reused = optimizer->reused};
  counters.individuals = counters.true_evaluations + counters.predicted + counters.reused;
  counters.fitness_computed = counters.individuals ? (double)counters.true_evaluations / counters.individuals : 0;
  return counters;
}

const struct eo_generation *eo_optimizer_generations(const struct eo_optimizer *optimizer, int *count)
{
  *count = optimizer->generation_count;
  return optimizer->generation;
}

struct eo_front eo_optimizer_front(const struct eo_optimizer *optimizer, int *front)
{
  return eo_pareto_front(&optimizer->archive, front);
}
