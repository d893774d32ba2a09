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
#include "optimizer/credibility_pool.h"
#include "optimizer/global_minima.h"
#include "optimizer/optimizer_private.h"
#include "optimizer/trust_region.h"
#include "optimizer/operators.h"
#include "optimizer/view_distance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum search { BREED, SAMPLE, MODEL, REFINE };
enum { USUAL_STARTS = 8 };                /* of descents on the model for a batch; an epoch begins with more */
static const double polish_radius = 0.25; /* of the trust region when polishing starts, in local_radius */

struct credibility {
  int epoch, epoch_first; /* first archive row of the epoch */
  int batch;              /* batches so far, counts the random numbers */
  int stalled;
  double epoch_best;           /* when the epoch last gained */
  bool fresh;                  /* the epoch's latin hypercube is still to come */
  enum search search;          /* what makes the batches */
  bool evolving;               /* the evolution strategy stands; SAMPLE: once the hypercube is told */
  bool polishing;              /* the last share of the budget */
  int local_places;            /* SAMPLE: of the trust region in the next batch */
  int local_count;             /* proposals of the trust region at the head of the pending batch */
  int refined;                 /* archive row that the evolution strategy ended with, -1 before */
  int *generation;             /* [batch] archive rows, best first; owned, as all below */
  const double **generation_x; /* [batch] */
  int *taboo;                  /* archive rows */
  int taboo_count, taboo_capacity;
  int *parent;    /* [population] archive rows, best first */
  double *latin;  /* scratch [initial_factor n] */
  double *chosen; /* [batch][n] */
  struct eo_credibility_model model;
  struct eo_credibility_pool pool;
  struct eo_local local;
  struct eo_evolution evolution;
  struct eo_global_minima global;
  struct eo_view_distance distance;
};

static void stop(struct eo_optimizer *optimizer)
{
  struct credibility *credibility = optimizer->state;
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

/* Whether the value's parts are known: a model of them leads to the bottom sooner, and says where to look next. */
static bool is_described(const struct eo_optimizer *optimizer)
{
  return optimizer->anatomy.parts > 0;
}

static int least_places(const struct eo_optimizer *optimizer)
{
  return optimizer->settings.batch > 1 ? 1 : 0;
}

static void plan_epoch(struct eo_optimizer *optimizer)
{
  struct credibility *credibility = optimizer->state;
  credibility->fresh = true;
  credibility->search = is_described(optimizer)       ? (credibility->epoch % 2 == 0 ? MODEL : SAMPLE)
                        : credibility->epoch % 2 == 0 ? SAMPLE
                                                      : BREED;
  credibility->local_places = credibility->search == MODEL ? optimizer->settings.batch / 2 : least_places(optimizer);
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
  struct credibility *credibility = optimizer->state = calloc(1, sizeof *credibility);
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
  enum eo_code code = eo_credibility_model_init(&credibility->model, settings, &optimizer->anatomy, error);
  if (code == EO_OK)
    code = eo_credibility_pool_init(&credibility->pool, settings, error);
  if (code == EO_OK)
    code = eo_local_init(&credibility->local, &optimizer->anatomy, settings->variables, error);
  if (code == EO_OK)
    code = eo_evolution_init(&credibility->evolution, settings->variables, error);
  if (code == EO_OK)
    code = eo_global_minima_init(&credibility->global, settings->variables, error);
  if (code == EO_OK)
    code = eo_view_distance_init(&credibility->distance, &optimizer->warp, error);
  if (code == EO_OK)
    plan_epoch(optimizer);
  return code == EO_OK ? eo_optimizer_reserve_batch(optimizer, (int)batch, error) : code;
}

static const double *row_x(const struct eo_optimizer *optimizer, int row)
{
  return optimizer->archive.x + (size_t)row * optimizer->settings.variables;
}

/* Polishing and refining go for the best row of all; else an epoch sees its own rows only. */
static bool sees_all(const struct credibility *credibility)
{
  return credibility->polishing || credibility->search == REFINE;
}

/* A model of parts finds the bottom of a valley from afar: what is finished is twice as large. */
static double taboo_radius(const struct eo_optimizer *optimizer)
{
  return (is_described(optimizer) ? 2 : 1) * optimizer->settings.taboo_radius * sqrt(optimizer->settings.variables);
}

static bool is_taboo(const struct eo_optimizer *optimizer, int row)
{
  const struct credibility *credibility = optimizer->state;
  const double radius = taboo_radius(optimizer);
  for (int i = 0; i < credibility->taboo_count && !sees_all(credibility); i++)
    if (eo_view_distance_between(&credibility->distance, credibility->taboo[i], row) < radius)
      return true;
  return false;
}

/* The same of a point that is no row. */
static bool is_near_taboo(struct eo_optimizer *optimizer, const double *x)
{
  struct credibility *credibility = optimizer->state;
  const double radius = taboo_radius(optimizer);
  if (credibility->taboo_count && !sees_all(credibility))
    eo_view_distance_visit(&credibility->distance, x);
  for (int i = 0; i < credibility->taboo_count && !sees_all(credibility); i++)
    if (eo_view_distance_from(&credibility->distance, credibility->taboo[i]) < radius)
      return true;
  return false;
}

/* The best rows that may be parents, best first, into c->parent. */
static int gather_parents(struct eo_optimizer *optimizer)
{
  struct credibility *credibility = optimizer->state;
  const int most = optimizer->settings.population;
  int count = 0, *parent = credibility->parent;
  for (int row = sees_all(credibility) ? 0 : credibility->epoch_first; row < optimizer->archive.count; row++) {
    const double value = optimizer->archive.value[row];
    if (eo_archive_failed(&optimizer->archive, row) || is_taboo(optimizer, row) ||
        (count == most && value >= optimizer->archive.value[parent[count - 1]]))
      continue;
    int j = count < most ? count++ : count - 1;
    for (; j > 0 && optimizer->archive.value[parent[j - 1]] > value; j--)
      parent[j] = parent[j - 1];
    parent[j] = row;
  }
  return count;
}

/* Asks for c->chosen, the first `local` of which come from the trust region. */
static void request_chosen(struct eo_optimizer *optimizer, int count, int local)
{
  struct credibility *credibility = optimizer->state;
  bool known = false;
  credibility->local_count = 0;
  for (int i = 0; i < count; i++) {
    if (eo_optimizer_request(optimizer, credibility->chosen + (size_t)i * optimizer->settings.variables,
                             credibility->batch, i, false, &known) < 0)
      return;
    credibility->local_count += i < local && !known;
  }
}

/* Fills c->chosen from `first` to `count` with minima of the model, away from what is finished; `unknown` of the places
   go to what nobody knows. */
static int choose_minima(struct eo_optimizer *optimizer, int best, int first, int count, int unknown, int starts)
{
  struct credibility *credibility = optimizer->state;
  const struct eo_global_bars bars = {credibility->taboo, credibility->taboo_count, taboo_radius(optimizer),
                                      &credibility->distance, starts};
  const int minima = count - first > unknown ? count - first - unknown : 0;
  eo_credibility_model_fit(&credibility->model, &optimizer->archive, row_x(optimizer, best));
  return eo_global_minima_choose(&credibility->global, &credibility->model, &optimizer->archive, &bars, best,
                                 credibility->batch, minima, credibility->chosen, first, count);
}

static void propose_epoch(struct eo_optimizer *optimizer)
{
  struct credibility *credibility = optimizer->state;
  const int n = optimizer->settings.variables, count = optimizer->settings.initial_factor * n,
            best = eo_optimizer_best(optimizer);
  credibility->fresh = false;
  if (is_described(optimizer) && credibility->epoch > 0 && best >= 0) {
    const int places = 2 * optimizer->settings.batch < count ? 2 * optimizer->settings.batch : count;
    request_chosen(optimizer, choose_minima(optimizer, best, 0, places, places / 2, EO_GLOBAL_STARTS), 0);
    return;
  }
  eo_latin_hypercube(credibility->chosen, count, n, optimizer->settings.seed, credibility->epoch, credibility->latin);
  for (int i = 1; i < count; i += 2) /* what lies where little is seen to change has its share */
    eo_cube_warp_in(&optimizer->warp, credibility->chosen + (size_t)i * (size_t)n,
                    credibility->chosen + (size_t)i * (size_t)n);
  request_chosen(optimizer, count, 0);
}

static void begin_sampling(struct eo_optimizer *optimizer, int from)
{
  struct credibility *credibility = optimizer->state;
  credibility->evolving = true;
  credibility->local_places = least_places(optimizer);
  eo_evolution_restart(&credibility->evolution, row_x(optimizer, from), optimizer->settings.sampling_step);
}

/* Both fill c->chosen from `first` to `count`; the second may leave places free. */
static void choose_samples(struct eo_optimizer *optimizer, int first, int count)
{
  struct credibility *credibility = optimizer->state;
  const size_t n = (size_t)optimizer->settings.variables;
  eo_credibility_model_fit(&credibility->model, &optimizer->archive, credibility->evolution.mean);
  eo_credibility_pool_sample(&credibility->pool, &credibility->model, &credibility->evolution,
                             optimizer->settings.evolution_samples * (count - first), credibility->batch);
  for (int i = first; i < count; i++)
    memcpy(credibility->chosen + (size_t)i * n, eo_credibility_pool_at(&credibility->pool, i - first),
           n * sizeof(double));
}

static int choose_children(struct eo_optimizer *optimizer, int parents, int first, int count)
{
  struct credibility *credibility = optimizer->state;
  eo_credibility_model_fit(&credibility->model, &optimizer->archive, row_x(optimizer, credibility->parent[0]));
  eo_credibility_pool_breed(&credibility->pool, &credibility->model, &optimizer->archive, credibility->parent, parents,
                            credibility->batch);
  for (int i = 0; i < credibility->pool.count; i++)
    credibility->pool.barred[i] = is_near_taboo(optimizer,
                                                credibility->pool.x + (size_t)i * optimizer->settings.variables);
  return eo_credibility_pool_spread(&credibility->pool, &optimizer->archive, credibility->chosen, first, count);
}

/* Places of the trust region in the next batch. */
static int local_share(const struct eo_optimizer *optimizer)
{
  const struct credibility *credibility = optimizer->state;
  const int batch = optimizer->settings.batch;
  switch (credibility->search) {
  case SAMPLE:
  case MODEL:
    return credibility->local_places;
  case REFINE:
    return 0;
  default:
    return credibility->polishing ? batch : (int)(optimizer->settings.local_share * batch + 0.5);
  }
}

static void propose_batch(struct eo_optimizer *optimizer)
{
  struct credibility *credibility = optimizer->state;
  const int parents = gather_parents(optimizer), batch = optimizer->settings.batch;
  if (parents == 0)
    return;
  if (credibility->search == SAMPLE && !credibility->evolving)
    begin_sampling(optimizer, credibility->parent[0]);
  const int share = local_share(optimizer);
  const int local = share > 0
                        ? eo_local_propose(&credibility->local, &optimizer->archive, credibility->parent[0],
                                           optimizer->settings.seed, credibility->batch, share, credibility->chosen)
                        : 0;
  int chosen = local + batch - share;
  if (credibility->evolving)
    choose_samples(optimizer, local, chosen);
  else if (credibility->search == MODEL)
    chosen = choose_minima(optimizer, credibility->parent[0], local, chosen, optimizer->settings.batch / 4,
                           USUAL_STARTS);
  else if (share < batch)
    chosen = choose_children(optimizer, parents, local, chosen);
  request_chosen(optimizer, chosen, local);
}

static void begin_epoch(struct eo_optimizer *optimizer)
{
  struct credibility *credibility = optimizer->state;
  credibility->epoch++;
  plan_epoch(optimizer);
}

/* Where the latin hypercube is known (an earlier run's rows were imported) children follow at once; nothing new to try
   ends an epoch, too. */
static enum eo_code propose(struct eo_optimizer *optimizer, struct eo_error *error)
{
  struct credibility *credibility = optimizer->state;
  if (eo_optimizer_left(optimizer) <= 0) {
    optimizer->finished = true;
    return EO_OK;
  }
  enum eo_code code = eo_credibility_model_reserve(&credibility->model, optimizer->archive.count, error);
  if (code == EO_OK)
    code = eo_view_distance_follow(&credibility->distance, &optimizer->archive, error);
  while (code == EO_OK && optimizer->batch_count == 0) {
    if (credibility->fresh)
      propose_epoch(optimizer);
    if (optimizer->batch_count == 0)
      propose_batch(optimizer);
    if (optimizer->batch_count == 0)
      begin_epoch(optimizer);
  }
  return code;
}

static double best_row(const struct eo_optimizer *optimizer, int *best)
{
  const struct credibility *credibility = optimizer->state;
  double value = INFINITY;
  *best = -1;
  for (int row = sees_all(credibility) ? 0 : credibility->epoch_first; row < optimizer->archive.count; row++)
    if (optimizer->archive.value[row] < value && !is_taboo(optimizer, row)) {
      value = optimizer->archive.value[row];
      *best = row;
    }
  return value;
}

static enum eo_code avoid(struct credibility *credibility, int row, struct eo_error *error)
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
  struct credibility *credibility = optimizer->state;
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
  struct credibility *credibility = optimizer->state;
  const int best = eo_optimizer_best(optimizer);
  credibility->stalled = 0;
  if (best < 0)
    return;
  credibility->search = REFINE;
  credibility->evolving = true;
  credibility->epoch_best = optimizer->archive.value[best];
  eo_evolution_restart(&credibility->evolution, row_x(optimizer, best), optimizer->settings.evolution_step);
}

/* From its own samples: the best point of the trust region, led elsewhere by other means, would draw it in too soon.
   False when the strategy has come to its end. */
static bool learn_generation(struct eo_optimizer *optimizer)
{
  struct credibility *credibility = optimizer->state;
  const int count = optimizer->batch_count - credibility->local_count, first = optimizer->archive.count - count;
  for (int i = 0; i < count; i++) {
    const double value = optimizer->archive.value[first + i];
    int j = i;
    for (; j > 0 && optimizer->archive.value[credibility->generation[j - 1]] > value; j--)
      credibility->generation[j] = credibility->generation[j - 1];
    credibility->generation[j] = first + i;
  }
  for (int i = 0; i < count; i++)
    credibility->generation_x[i] = row_x(optimizer, credibility->generation[i]);
  return count < 2 || eo_evolution_learn(&credibility->evolution, credibility->generation_x, count);
}

/* An evolution strategy that has the best row of all is left to it. */
static void begin_polishing(struct eo_optimizer *optimizer)
{
  struct credibility *credibility = optimizer->state;
  credibility->polishing = true;
  if (credibility->evolving && eo_optimizer_best(optimizer) >= credibility->epoch_first)
    return;
  credibility->search = BREED;
  credibility->evolving = false;
  credibility->stalled = 0;
  credibility->epoch_best = INFINITY;
  eo_local_restart(&credibility->local, polish_radius * optimizer->settings.local_radius);
}

/* Batches without gain that end what makes them. */
static int patience(const struct eo_optimizer *optimizer)
{
  const struct credibility *credibility = optimizer->state;
  const int sampling = optimizer->settings.sampling_stall;
  return credibility->search == MODEL || credibility->search == SAMPLE
             ? (is_described(optimizer) ? (sampling + 1) / 2 : sampling)
         : credibility->search == REFINE ? optimizer->settings.evolution_stall
                                         : optimizer->settings.stall_batches;
}

/* What follows a batch that gained nothing for long enough: the best row of all is refined once; then a new epoch. */
static enum eo_code go_on(struct eo_optimizer *optimizer, int best, struct eo_error *error)
{
  struct credibility *credibility = optimizer->state;
  const enum eo_code code = best >= 0 ? avoid(credibility, best, error) : EO_OK;
  const int best_of_all = eo_optimizer_best(optimizer);
  if (credibility->search == REFINE)
    credibility->refined = best_of_all;
  if (!is_described(optimizer) && credibility->search != REFINE && best_of_all >= 0 &&
      best_of_all != credibility->refined)
    begin_refinement(optimizer);
  else
    begin_epoch(optimizer);
  return code;
}

/* More places for the trust region when its point is the gain, fewer when not. */
static void share_places(struct eo_optimizer *optimizer, int best, bool gained)
{
  struct credibility *credibility = optimizer->state;
  const int first = optimizer->archive.count - optimizer->batch_count, half = optimizer->settings.batch / 2;
  const bool local = gained && best >= first && best < first + credibility->local_count;
  const int places = local ? 2 * credibility->local_places : credibility->local_places / 2;
  credibility->local_places = places > half                      ? half
                              : places < least_places(optimizer) ? least_places(optimizer)
                                                                 : places;
}

static enum eo_code absorb(struct eo_optimizer *optimizer, struct eo_error *error)
{
  struct credibility *credibility = optimizer->state;
  const struct eo_generation statistics = {.true_count = optimizer->batch_count, .epoch = credibility->epoch};
  enum eo_code code = eo_optimizer_close_generation(optimizer, &statistics, error);
  if (code == EO_OK)
    code = eo_view_distance_follow(&credibility->distance, &optimizer->archive, error);
  if (code != EO_OK)
    return code;
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
    if (through || (stalled && credibility->search != REFINE))
      begin_refinement(optimizer);
  } else if (eo_optimizer_left(optimizer) <=
             (is_described(optimizer) ? 0.5 : 1) * optimizer->settings.polish_share * optimizer->budget) {
    begin_polishing(optimizer);
  } else if (through || stalled) {
    return go_on(optimizer, best, error);
  }
  return EO_OK;
}

const struct eo_algorithm_functions eo_credibility_algorithm = {start, propose, absorb, stop};
