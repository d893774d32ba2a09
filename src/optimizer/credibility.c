/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `credibility-ga`: a genetic algorithm whose true evaluations go where a surrogate promises most, doubted as far as it
   has not earned its credibility by leave-one-out (surrogate.h). Every member of its population is a true row.

   epoch: a latin hypercube, then batches until too many of them gain nothing: the best joins the taboo list.
   Even epochs sample: an evolution strategy (evolution.h) from the best of the hypercube, of whose many samples the
   surrogate chooses; the trust region (trust_region.h) round the best has a place in each batch, and twice as many
   after each gain of its own. Odd epochs breed: half of a batch trust region; half children of the epoch's best rows,
   bred three times among themselves by score = surrogate + kappa s (1 - R), then the best scores that keep growing
   distances from all rows and from each other. What is the best of all when an epoch ends is refined once by an
   evolution strategy of small steps: objectives made of maxima over load cases, ends and mesh positions lead along
   kinks, where a smooth surrogate stops. The last share of the budget polishes the best row of all: trust region only,
   then refinement.

   A value whose parts are known (eo_optimizer_describe()) has surrogates with its kinks (composite.h), which are right
   from afar. Its even epochs go to the minima of the model of the whole cube (global_minima.h), the trust region beside
   them, two of eight places to what nobody knows; every epoch but the first begins where the model promises most or
   knows least away from what is finished, not with a hypercube; they end sooner, and nothing is refined between them.
   How far points are from what is finished is told by what is seen of them (eo_optimizer_set_view()).
 */
#include "optimizer/credibility_private.h"

#include "optimizer/optimizer_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double polish_radius = 0.25; /* of the trust region when polishing starts, in local_radius */

static void stop(struct eo_optimizer *optimizer)
{
  struct eo_credibility *credibility = optimizer->state;
  if (!credibility)
    return;
  free(credibility->generation);
  free(credibility->generation_x);
  free(credibility->taboo);
  free(credibility->parent);
  free(credibility->latin);
  free(credibility->chosen);
  eo_credibility_model_done(&credibility->model);
  eo_credibility_pool_done(&credibility->pool);
  eo_local_done(&credibility->local);
  eo_evolution_done(&credibility->evolution);
  eo_global_minima_done(&credibility->global);
  eo_view_distance_done(&credibility->distance);
  free(credibility);
}

static void plan_epoch(struct eo_optimizer *optimizer)
{
  struct eo_credibility *credibility = optimizer->state;
  credibility->fresh = true;
  credibility->search = eo_credibility_is_described(optimizer)
                            ? (credibility->epoch % 2 == 0 ? EO_SEARCH_MODEL : EO_SEARCH_SAMPLE)
                        : credibility->epoch % 2 == 0 ? EO_SEARCH_SAMPLE
                                                      : EO_SEARCH_BREED;
  credibility->local_places = credibility->search == EO_SEARCH_MODEL ? optimizer->settings.batch / 2
                                                                     : eo_credibility_least_places(optimizer);
  credibility->evolving = false;
  credibility->epoch_first = credibility->epoch ? optimizer->archive.count
                                                : 0; /* rows known from elsewhere belong to the first */
  credibility->epoch_best = INFINITY;
  credibility->stalled = 0;
  eo_local_restart(&credibility->local, optimizer->settings.local_radius);
}

static enum eo_code start(struct eo_optimizer *optimizer, struct eo_error *error)
{
  const struct eo_optimizer_settings *settings = &optimizer->settings;
  const size_t n = (size_t)settings->variables;
  struct eo_credibility *credibility = optimizer->state = calloc(1, sizeof *credibility);
  if (!credibility)
    return eo_error_memory(error);
  credibility->refined = -1;
  const size_t initial = (size_t)settings->initial_factor * n,
               batch = (size_t)settings->batch > initial ? (size_t)settings->batch : initial;
  credibility->latin = malloc(initial * sizeof(double));
  credibility->chosen = malloc(batch * n * sizeof(double));
  credibility->generation = malloc(batch * sizeof(int));
  credibility->generation_x = malloc(batch * sizeof *credibility->generation_x);
  credibility->parent = malloc((size_t)settings->population * sizeof(int));
  if (!credibility->latin || !credibility->chosen || !credibility->generation || !credibility->generation_x ||
      !credibility->parent)
    return eo_error_memory(error);
  EO_TRY(eo_credibility_model_init(&credibility->model, settings, &optimizer->anatomy, error));
  EO_TRY(eo_credibility_pool_init(&credibility->pool, settings, error));
  EO_TRY(eo_local_init(&credibility->local, &optimizer->anatomy, settings->variables, error));
  EO_TRY(eo_evolution_init(&credibility->evolution, settings->variables, error));
  EO_TRY(eo_global_minima_init(&credibility->global, settings->variables, error));
  EO_TRY(eo_view_distance_init(&credibility->distance, &optimizer->warp, error));
  plan_epoch(optimizer);
  return eo_optimizer_reserve_batch(optimizer, (int)batch, error);
}

static void begin_epoch(struct eo_optimizer *optimizer)
{
  struct eo_credibility *credibility = optimizer->state;
  credibility->epoch++;
  plan_epoch(optimizer);
}

/* Where the latin hypercube is known (an earlier run's rows were imported) children follow at once; nothing new to try
   ends an epoch, too. */
static enum eo_code propose(struct eo_optimizer *optimizer, struct eo_error *error)
{
  struct eo_credibility *credibility = optimizer->state;
  if (eo_optimizer_left(optimizer) <= 0) {
    optimizer->finished = true;
    return EO_OK;
  }
  EO_TRY(eo_credibility_model_reserve(&credibility->model, optimizer->archive.count, error));
  EO_TRY(eo_view_distance_follow(&credibility->distance, &optimizer->archive, error));
  while (optimizer->batch_count == 0) {
    if (credibility->fresh)
      eo_credibility_propose_epoch(optimizer);
    if (optimizer->batch_count == 0)
      eo_credibility_propose_batch(optimizer);
    if (optimizer->batch_count == 0)
      begin_epoch(optimizer);
  }
  return EO_OK;
}

static double best_row(const struct eo_optimizer *optimizer, int *best)
{
  const struct eo_credibility *credibility = optimizer->state;
  double value = INFINITY;
  *best = -1;
  for (int row = eo_credibility_sees_all(credibility) ? 0 : credibility->epoch_first; row < optimizer->archive.count;
       row++)
    if (optimizer->archive.value[row] < value && !eo_credibility_is_taboo(optimizer, row)) {
      value = optimizer->archive.value[row];
      *best = row;
    }
  return value;
}

static enum eo_code avoid(struct eo_credibility *credibility, int row, struct eo_error *error)
{
  if (credibility->taboo_count == credibility->taboo_capacity) {
    const size_t capacity = 2 * (size_t)credibility->taboo_capacity + 16;
    int *larger = realloc(credibility->taboo, capacity * sizeof *larger);
    if (!larger)
      return eo_error_memory(error);
    credibility->taboo = larger;
    credibility->taboo_capacity = (int)capacity;
  }
  credibility->taboo[credibility->taboo_count++] = row;
  return EO_OK;
}

/* Counts the batches without gain; returns the best row of the epoch. */
static int watch_progress(struct eo_optimizer *optimizer)
{
  struct eo_credibility *credibility = optimizer->state;
  int best;
  const double value = best_row(optimizer, &best);
  const bool gained = credibility->epoch_best == INFINITY ||
                      value < credibility->epoch_best - optimizer->settings.stall_gain * fabs(credibility->epoch_best);
  credibility->stalled = gained ? 0 : credibility->stalled + 1;
  if (gained)
    credibility->epoch_best = value;
  return best;
}

static void begin_refinement(struct eo_optimizer *optimizer)
{
  struct eo_credibility *credibility = optimizer->state;
  const int best = eo_optimizer_best(optimizer);
  credibility->stalled = 0;
  if (best < 0)
    return;
  credibility->search = EO_SEARCH_REFINE;
  credibility->evolving = true;
  credibility->epoch_best = optimizer->archive.value[best];
  eo_evolution_restart(&credibility->evolution, eo_credibility_row(optimizer, best),
                       optimizer->settings.evolution_step);
}

/* From its own samples: the best point of the trust region, led elsewhere by other means, would draw it in too soon.
   False when the strategy has come to its end. */
static bool learn_generation(struct eo_optimizer *optimizer)
{
  struct eo_credibility *credibility = optimizer->state;
  const int count = optimizer->batch_count - credibility->local_count, first = optimizer->archive.count - count;
  for (int i = 0; i < count; i++) {
    const double value = optimizer->archive.value[first + i];
    int j = i;
    for (; j > 0 && optimizer->archive.value[credibility->generation[j - 1]] > value; j--)
      credibility->generation[j] = credibility->generation[j - 1];
    credibility->generation[j] = first + i;
  }
  for (int i = 0; i < count; i++)
    credibility->generation_x[i] = eo_credibility_row(optimizer, credibility->generation[i]);
  return count < 2 || eo_evolution_learn(&credibility->evolution, credibility->generation_x, count);
}

/* An evolution strategy that has the best row of all is left to it. */
static void begin_polishing(struct eo_optimizer *optimizer)
{
  struct eo_credibility *credibility = optimizer->state;
  credibility->polishing = true;
  if (credibility->evolving && eo_optimizer_best(optimizer) >= credibility->epoch_first)
    return;
  credibility->search = EO_SEARCH_BREED;
  credibility->evolving = false;
  credibility->stalled = 0;
  credibility->epoch_best = INFINITY;
  eo_local_restart(&credibility->local, polish_radius * optimizer->settings.local_radius);
}

/* Batches without gain that end what makes them. */
static int patience(const struct eo_optimizer *optimizer)
{
  const struct eo_credibility *credibility = optimizer->state;
  const int sampling = optimizer->settings.sampling_stall;
  return credibility->search == EO_SEARCH_MODEL || credibility->search == EO_SEARCH_SAMPLE
             ? (eo_credibility_is_described(optimizer) ? (sampling + 1) / 2 : sampling)
         : credibility->search == EO_SEARCH_REFINE ? optimizer->settings.evolution_stall
                                                   : optimizer->settings.stall_batches;
}

/* What follows a batch that gained nothing for long enough: the best row of all is refined once; then a new epoch. */
static enum eo_code go_on(struct eo_optimizer *optimizer, int best, struct eo_error *error)
{
  struct eo_credibility *credibility = optimizer->state;
  const enum eo_code code = best >= 0 ? avoid(credibility, best, error) : EO_OK;
  const int best_of_all = eo_optimizer_best(optimizer);
  if (credibility->search == EO_SEARCH_REFINE)
    credibility->refined = best_of_all;
  if (!eo_credibility_is_described(optimizer) && credibility->search != EO_SEARCH_REFINE && best_of_all >= 0 &&
      best_of_all != credibility->refined)
    begin_refinement(optimizer);
  else
    begin_epoch(optimizer);
  return code;
}

/* More places for the trust region when its point is the gain, fewer when not. */
static void share_places(struct eo_optimizer *optimizer, int best, bool gained)
{
  struct eo_credibility *credibility = optimizer->state;
  const int first = optimizer->archive.count - optimizer->batch_count, half = optimizer->settings.batch / 2;
  const bool local = gained && best >= first && best < first + credibility->local_count;
  const int places = local ? 2 * credibility->local_places : credibility->local_places / 2;
  credibility->local_places = places > half                                     ? half
                              : places < eo_credibility_least_places(optimizer) ? eo_credibility_least_places(optimizer)
                                                                                : places;
}

static enum eo_code absorb(struct eo_optimizer *optimizer, struct eo_error *error)
{
  struct eo_credibility *credibility = optimizer->state;
  const struct eo_generation statistics = {.true_count = optimizer->batch_count, .epoch = credibility->epoch};
  EO_TRY(eo_optimizer_close_generation(optimizer, &statistics, error));
  EO_TRY(eo_view_distance_follow(&credibility->distance, &optimizer->archive, error));
  if (credibility->local_count > 0)
    eo_local_learn(&credibility->local, &optimizer->archive, optimizer->archive.count - optimizer->batch_count,
                   credibility->local_count);
  credibility->batch++;
  const double before = credibility->epoch_best;
  const int best = watch_progress(optimizer);
  share_places(optimizer, best, best >= 0 && optimizer->archive.value[best] < before);
  const bool through = credibility->evolving && !learn_generation(optimizer),
             stalled = credibility->stalled >= patience(optimizer);
  if (credibility->polishing) {
    if (through || (stalled && credibility->search != EO_SEARCH_REFINE))
      begin_refinement(optimizer);
  } else if (eo_optimizer_left(optimizer) <= (eo_credibility_is_described(optimizer) ? 0.5 : 1) *
                                                 optimizer->settings.polish_share * optimizer->budget) {
    begin_polishing(optimizer);
  } else if (through || stalled) {
    return go_on(optimizer, best, error);
  }
  return EO_OK;
}

const struct eo_algorithm_functions eo_credibility_algorithm = {start, propose, absorb, stop};
