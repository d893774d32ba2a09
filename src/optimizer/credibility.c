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
 */
#include "optimizer/credibility_pool.h"
#include "optimizer/global_minima.h"
#include "optimizer/optimizer_private.h"
#include "optimizer/trust_region.h"
#include "optimizer/operators.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum search { BREED, SAMPLE, MODEL, REFINE };
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
};

static void stop(struct eo_optimizer *o)
{
  struct credibility *c = o->state;
  if (!c)
    return;
  free(c->generation);
  free(c->generation_x);
  free(c->taboo);
  free(c->parent);
  free(c->latin);
  free(c->chosen);
  eo_credibility_model_done(&c->model);
  eo_credibility_pool_done(&c->pool);
  eo_local_done(&c->local);
  eo_evolution_done(&c->evolution);
  eo_global_minima_done(&c->global);
  free(c);
}

/* Whether the value's parts are known: a model of them leads to the bottom sooner, and says where to look next. */
static bool is_described(const struct eo_optimizer *o)
{
  return o->anatomy.parts > 0;
}

static int least_places(const struct eo_optimizer *o)
{
  return o->settings.batch > 1 ? 1 : 0;
}

static void plan_epoch(struct eo_optimizer *o)
{
  struct credibility *c = o->state;
  c->fresh = true;
  c->search = is_described(o) ? (c->epoch % 2 == 0 ? MODEL : SAMPLE) : c->epoch % 2 == 0 ? SAMPLE : BREED;
  c->local_places = c->search == MODEL ? o->settings.batch / 2 : least_places(o);
  c->evolving = false;
  c->epoch_first = c->epoch ? o->archive.count : 0; /* rows known from elsewhere belong to the first */
  c->epoch_best = INFINITY;
  c->stalled = 0;
  eo_local_restart(&c->local, o->settings.local_radius);
}

static enum eo_code start(struct eo_optimizer *o, struct eo_error *error)
{
  const struct eo_optimizer_settings *s = &o->settings;
  const size_t n = (size_t)s->variables;
  struct credibility *c = o->state = calloc(1, sizeof *c);
  if (!c)
    return eo_error_memory(error);
  c->refined = -1;
  const size_t initial = (size_t)s->initial_factor * n, batch = (size_t)s->batch > initial ? (size_t)s->batch : initial;
  c->latin = malloc(initial * sizeof(double));
  c->chosen = malloc(batch * n * sizeof(double));
  c->generation = malloc(batch * sizeof(int));
  c->generation_x = malloc(batch * sizeof *c->generation_x);
  c->parent = malloc((size_t)s->population * sizeof(int));
  if (!c->latin || !c->chosen || !c->generation || !c->generation_x || !c->parent)
    return eo_error_memory(error);
  enum eo_code code = eo_credibility_model_init(&c->model, s, &o->anatomy, error);
  if (code == EO_OK)
    code = eo_credibility_pool_init(&c->pool, s, error);
  if (code == EO_OK)
    code = eo_local_init(&c->local, &o->anatomy, s->variables, error);
  if (code == EO_OK)
    code = eo_evolution_init(&c->evolution, s->variables, error);
  if (code == EO_OK)
    code = eo_global_minima_init(&c->global, s->variables, error);
  if (code == EO_OK)
    plan_epoch(o);
  return code == EO_OK ? eo_optimizer_reserve_batch(o, (int)batch, error) : code;
}

static const double *row_x(const struct eo_optimizer *o, int row)
{
  return o->archive.x + (size_t)row * o->settings.variables;
}

/* Polishing and refining go for the best row of all; else an epoch sees its own rows only. */
static bool sees_all(const struct credibility *c)
{
  return c->polishing || c->search == REFINE;
}

/* A model of parts finds the bottom of a valley from afar: what is finished is twice as large. */
static double taboo_radius(const struct eo_optimizer *o)
{
  return (is_described(o) ? 2 : 1) * o->settings.taboo_radius * sqrt(o->settings.variables);
}

static bool is_taboo(const struct eo_optimizer *o, const double *x)
{
  const struct credibility *c = o->state;
  const int n = o->settings.variables;
  const double radius = taboo_radius(o);
  for (int i = 0; i < c->taboo_count && !sees_all(c); i++)
    if (eo_unit_distance(row_x(o, c->taboo[i]), x, n) < radius)
      return true;
  return false;
}

/* The best rows that may be parents, best first, into c->parent. */
static int gather_parents(struct eo_optimizer *o)
{
  struct credibility *c = o->state;
  const int most = o->settings.population;
  int count = 0, *parent = c->parent;
  for (int row = sees_all(c) ? 0 : c->epoch_first; row < o->archive.count; row++) {
    const double value = o->archive.value[row];
    if (eo_archive_failed(&o->archive, row) || is_taboo(o, row_x(o, row)) ||
        (count == most && value >= o->archive.value[parent[count - 1]]))
      continue;
    int j = count < most ? count++ : count - 1;
    for (; j > 0 && o->archive.value[parent[j - 1]] > value; j--)
      parent[j] = parent[j - 1];
    parent[j] = row;
  }
  return count;
}

/* Asks for c->chosen, the first `local` of which come from the trust region. */
static void request_chosen(struct eo_optimizer *o, int count, int local)
{
  struct credibility *c = o->state;
  bool known = false;
  c->local_count = 0;
  for (int i = 0; i < count; i++) {
    if (eo_optimizer_request(o, c->chosen + (size_t)i * o->settings.variables, c->batch, i, false, &known) < 0)
      return;
    c->local_count += i < local && !known;
  }
}

/* Fills c->chosen from `first` to `count` with minima of the model, away from what is finished; `unknown` of the places
   go to what nobody knows. */
static int choose_minima(struct eo_optimizer *o, int best, int first, int count, int unknown)
{
  struct credibility *c = o->state;
  const struct eo_global_bars bars = {c->taboo, c->taboo_count, taboo_radius(o)};
  const int minima = count - first > unknown ? count - first - unknown : 0;
  eo_credibility_model_fit(&c->model, &o->archive, row_x(o, best));
  return eo_global_minima_choose(&c->global, &c->model, &o->archive, &bars, best, c->batch, minima, c->chosen, first,
                                 count);
}

static void propose_epoch(struct eo_optimizer *o)
{
  struct credibility *c = o->state;
  const int n = o->settings.variables, count = o->settings.initial_factor * n, best = eo_optimizer_best(o);
  c->fresh = false;
  if (is_described(o) && c->epoch > 0 && best >= 0) {
    const int places = 2 * o->settings.batch < count ? 2 * o->settings.batch : count;
    request_chosen(o, choose_minima(o, best, 0, places, places / 2), 0);
    return;
  }
  eo_latin_hypercube(c->chosen, count, n, o->settings.seed, c->epoch, c->latin);
  request_chosen(o, count, 0);
}

static void begin_sampling(struct eo_optimizer *o, int from)
{
  struct credibility *c = o->state;
  c->evolving = true;
  c->local_places = least_places(o);
  eo_evolution_restart(&c->evolution, row_x(o, from), o->settings.sampling_step);
}

/* Both fill c->chosen from `first` to `count`; the second may leave places free. */
static void choose_samples(struct eo_optimizer *o, int first, int count)
{
  struct credibility *c = o->state;
  const size_t n = (size_t)o->settings.variables;
  eo_credibility_model_fit(&c->model, &o->archive, c->evolution.mean);
  eo_credibility_pool_sample(&c->pool, &c->model, &c->evolution, o->settings.evolution_samples * (count - first),
                             c->batch);
  for (int i = first; i < count; i++)
    memcpy(c->chosen + (size_t)i * n, eo_credibility_pool_at(&c->pool, i - first), n * sizeof(double));
}

static int choose_children(struct eo_optimizer *o, int parents, int first, int count)
{
  struct credibility *c = o->state;
  eo_credibility_model_fit(&c->model, &o->archive, row_x(o, c->parent[0]));
  eo_credibility_pool_breed(&c->pool, &c->model, &o->archive, c->parent, parents, c->batch);
  for (int i = 0; i < c->pool.count; i++)
    c->pool.barred[i] = is_taboo(o, c->pool.x + (size_t)i * o->settings.variables);
  return eo_credibility_pool_spread(&c->pool, &o->archive, c->chosen, first, count);
}

/* Places of the trust region in the next batch. */
static int local_share(const struct eo_optimizer *o)
{
  const struct credibility *c = o->state;
  const int batch = o->settings.batch;
  switch (c->search) {
  case SAMPLE:
  case MODEL:
    return c->local_places;
  case REFINE:
    return 0;
  default:
    return c->polishing ? batch : (int)(o->settings.local_share * batch + 0.5);
  }
}

static void propose_batch(struct eo_optimizer *o)
{
  struct credibility *c = o->state;
  const int parents = gather_parents(o), batch = o->settings.batch;
  if (parents == 0)
    return;
  if (c->search == SAMPLE && !c->evolving)
    begin_sampling(o, c->parent[0]);
  const int share = local_share(o);
  const int local = share > 0 ? eo_local_propose(&c->local, &o->archive, c->parent[0], o->settings.seed, c->batch,
                                                 share, c->chosen)
                              : 0;
  int chosen = local + batch - share;
  if (c->evolving)
    choose_samples(o, local, chosen);
  else if (c->search == MODEL)
    chosen = choose_minima(o, c->parent[0], local, chosen, o->settings.batch / 4);
  else if (share < batch)
    chosen = choose_children(o, parents, local, chosen);
  request_chosen(o, chosen, local);
}

static void begin_epoch(struct eo_optimizer *o)
{
  struct credibility *c = o->state;
  c->epoch++;
  plan_epoch(o);
}

/* Where the latin hypercube is known (an earlier run's rows were imported) children follow at once; nothing new to try
   ends an epoch, too. */
static enum eo_code propose(struct eo_optimizer *o, struct eo_error *error)
{
  struct credibility *c = o->state;
  if (eo_optimizer_left(o) <= 0) {
    o->finished = true;
    return EO_OK;
  }
  const enum eo_code code = eo_credibility_model_reserve(&c->model, o->archive.count, error);
  while (code == EO_OK && o->batch_count == 0) {
    if (c->fresh)
      propose_epoch(o);
    if (o->batch_count == 0)
      propose_batch(o);
    if (o->batch_count == 0)
      begin_epoch(o);
  }
  return code;
}

static double best_row(const struct eo_optimizer *o, int *best)
{
  const struct credibility *c = o->state;
  double value = INFINITY;
  *best = -1;
  for (int row = sees_all(c) ? 0 : c->epoch_first; row < o->archive.count; row++)
    if (o->archive.value[row] < value && !is_taboo(o, row_x(o, row))) {
      value = o->archive.value[row];
      *best = row;
    }
  return value;
}

static enum eo_code avoid(struct credibility *c, int row, struct eo_error *error)
{
  if (c->taboo_count == c->taboo_capacity) {
    const size_t capacity = 2 * (size_t)c->taboo_capacity + 16;
    int *larger = realloc(c->taboo, capacity * sizeof *larger);
    if (!larger)
      return eo_error_memory(error);
    c->taboo = larger;
    c->taboo_capacity = (int)capacity;
  }
  c->taboo[c->taboo_count++] = row;
  return EO_OK;
}

/* Counts the batches without gain; returns the best row of the epoch. */
static int watch_progress(struct eo_optimizer *o)
{
  struct credibility *c = o->state;
  int best;
  const double value = best_row(o, &best);
  const bool gained = c->epoch_best == INFINITY || value < c->epoch_best - o->settings.stall_gain * fabs(c->epoch_best);
  c->stalled = gained ? 0 : c->stalled + 1;
  if (gained)
    c->epoch_best = value;
  return best;
}

static void begin_refinement(struct eo_optimizer *o)
{
  struct credibility *c = o->state;
  const int best = eo_optimizer_best(o);
  c->stalled = 0;
  if (best < 0)
    return;
  c->search = REFINE;
  c->evolving = true;
  c->epoch_best = o->archive.value[best];
  eo_evolution_restart(&c->evolution, row_x(o, best), o->settings.evolution_step);
}

/* From its own samples: the best point of the trust region, led elsewhere by other means, would draw it in too soon.
   False when the strategy has come to its end. */
static bool learn_generation(struct eo_optimizer *o)
{
  struct credibility *c = o->state;
  const int count = o->batch_count - c->local_count, first = o->archive.count - count;
  for (int i = 0; i < count; i++) {
    const double value = o->archive.value[first + i];
    int j = i;
    for (; j > 0 && o->archive.value[c->generation[j - 1]] > value; j--)
      c->generation[j] = c->generation[j - 1];
    c->generation[j] = first + i;
  }
  for (int i = 0; i < count; i++)
    c->generation_x[i] = row_x(o, c->generation[i]);
  return count < 2 || eo_evolution_learn(&c->evolution, c->generation_x, count);
}

/* An evolution strategy that has the best row of all is left to it. */
static void begin_polishing(struct eo_optimizer *o)
{
  struct credibility *c = o->state;
  c->polishing = true;
  if (c->evolving && eo_optimizer_best(o) >= c->epoch_first)
    return;
  c->search = BREED;
  c->evolving = false;
  c->stalled = 0;
  c->epoch_best = INFINITY;
  eo_local_restart(&c->local, polish_radius * o->settings.local_radius);
}

/* Batches without gain that end what makes them. */
static int patience(const struct eo_optimizer *o)
{
  const struct credibility *c = o->state;
  const int sampling = o->settings.sampling_stall;
  return c->search == MODEL || c->search == SAMPLE ? (is_described(o) ? (sampling + 1) / 2 : sampling)
         : c->search == REFINE                     ? o->settings.evolution_stall
                                                   : o->settings.stall_batches;
}

/* What follows a batch that gained nothing for long enough: the best row of all is refined once; then a new epoch. */
static enum eo_code go_on(struct eo_optimizer *o, int best, struct eo_error *error)
{
  struct credibility *c = o->state;
  const enum eo_code code = best >= 0 ? avoid(c, best, error) : EO_OK;
  const int best_of_all = eo_optimizer_best(o);
  if (c->search == REFINE)
    c->refined = best_of_all;
  if (!is_described(o) && c->search != REFINE && best_of_all >= 0 && best_of_all != c->refined)
    begin_refinement(o);
  else
    begin_epoch(o);
  return code;
}

/* More places for the trust region when its point is the gain, fewer when not. */
static void share_places(struct eo_optimizer *o, int best, bool gained)
{
  struct credibility *c = o->state;
  const int first = o->archive.count - o->batch_count, half = o->settings.batch / 2;
  const bool local = gained && best >= first && best < first + c->local_count;
  const int places = local ? 2 * c->local_places : c->local_places / 2;
  c->local_places = places > half ? half : places < least_places(o) ? least_places(o) : places;
}

static enum eo_code absorb(struct eo_optimizer *o, struct eo_error *error)
{
  struct credibility *c = o->state;
  const struct eo_generation statistics = {.true_count = o->batch_count, .epoch = c->epoch};
  const enum eo_code code = eo_optimizer_close_generation(o, &statistics, error);
  if (code != EO_OK)
    return code;
  if (c->local_count > 0)
    eo_local_learn(&c->local, &o->archive, o->archive.count - o->batch_count, c->local_count);
  c->batch++;
  const double before = c->epoch_best;
  const int best = watch_progress(o);
  share_places(o, best, best >= 0 && o->archive.value[best] < before);
  const bool through = c->evolving && !learn_generation(o), stalled = c->stalled >= patience(o);
  if (c->polishing) {
    if (through || (stalled && c->search != REFINE))
      begin_refinement(o);
  } else if (eo_optimizer_left(o) <= (is_described(o) ? 0.5 : 1) * o->settings.polish_share * o->budget) {
    begin_polishing(o);
  } else if (through || stalled) {
    return go_on(o, best, error);
  }
  return EO_OK;
}

const struct eo_algorithm_functions eo_credibility_algorithm = {start, propose, absorb, stop};
