/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The places of a batch of credibility-ga: what is asked for next, away from what is finished. */
#include "optimizer/credibility_private.h"

#include <math.h>
#include <string.h>

#include "optimizer/operators.h"
#include "optimizer/optimizer_private.h"

enum { USUAL_STARTS = 8 }; /* of descents on the model for a batch; an epoch begins with more */

bool eo_credibility_is_described(const struct eo_optimizer *optimizer)
{
  return optimizer->anatomy.parts > 0;
}

int eo_credibility_least_places(const struct eo_optimizer *optimizer)
{
  return optimizer->settings.batch > 1 ? 1 : 0;
}

const double *eo_credibility_row(const struct eo_optimizer *optimizer, int row)
{
  return optimizer->archive.x + (size_t)row * optimizer->settings.variables;
}

bool eo_credibility_sees_all(const struct eo_credibility *credibility)
{
  return credibility->polishing || credibility->search == EO_SEARCH_REFINE;
}

/* A model of parts finds the bottom of a valley from afar: what is finished is twice as large. */
static double taboo_radius(const struct eo_optimizer *optimizer)
{
  return (eo_credibility_is_described(optimizer) ? 2 : 1) * optimizer->settings.taboo_radius *
         sqrt(optimizer->settings.variables);
}

bool eo_credibility_is_taboo(const struct eo_optimizer *optimizer, int row)
{
  const struct eo_credibility *credibility = optimizer->state;
  const double radius = taboo_radius(optimizer);
  for (int i = 0; i < credibility->taboo_count && !eo_credibility_sees_all(credibility); i++)
    if (eo_view_distance_between(&credibility->distance, credibility->taboo[i], row) < radius)
      return true;
  return false;
}

/* The same of a point that is no row. */
static bool is_near_taboo(struct eo_optimizer *optimizer, const double *x)
{
  struct eo_credibility *credibility = optimizer->state;
  const double radius = taboo_radius(optimizer);
  if (credibility->taboo_count && !eo_credibility_sees_all(credibility))
    eo_view_distance_visit(&credibility->distance, x);
  for (int i = 0; i < credibility->taboo_count && !eo_credibility_sees_all(credibility); i++)
    if (eo_view_distance_from(&credibility->distance, credibility->taboo[i]) < radius)
      return true;
  return false;
}

/* The best rows that may be parents, best first, into c->parent. */
static int gather_parents(struct eo_optimizer *optimizer)
{
  struct eo_credibility *credibility = optimizer->state;
  const int most = optimizer->settings.population;
  int count = 0, *parent = credibility->parent;
  for (int row = eo_credibility_sees_all(credibility) ? 0 : credibility->epoch_first; row < optimizer->archive.count;
       row++) {
    const double value = optimizer->archive.value[row];
    if (eo_archive_failed(&optimizer->archive, row) || eo_credibility_is_taboo(optimizer, row) ||
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
  struct eo_credibility *credibility = optimizer->state;
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
  struct eo_credibility *credibility = optimizer->state;
  const struct eo_global_bars bars = {credibility->taboo, credibility->taboo_count, taboo_radius(optimizer),
                                      &credibility->distance, starts};
  const int minima = count - first > unknown ? count - first - unknown : 0;
  eo_credibility_model_fit(&credibility->model, &optimizer->archive, eo_credibility_row(optimizer, best));
  return eo_global_minima_choose(&credibility->global, &credibility->model, &optimizer->archive, &bars, best,
                                 credibility->batch, minima, credibility->chosen, first, count);
}

void eo_credibility_propose_epoch(struct eo_optimizer *optimizer)
{
  struct eo_credibility *credibility = optimizer->state;
  const int n = optimizer->settings.variables, count = optimizer->settings.initial_factor * n,
            best = eo_optimizer_best(optimizer);
  credibility->fresh = false;
  if (eo_credibility_is_described(optimizer) && credibility->epoch > 0 && best >= 0) {
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
  struct eo_credibility *credibility = optimizer->state;
  credibility->evolving = true;
  credibility->local_places = eo_credibility_least_places(optimizer);
  eo_evolution_restart(&credibility->evolution, eo_credibility_row(optimizer, from), optimizer->settings.sampling_step);
}

/* Both fill c->chosen from `first` to `count`; the second may leave places free. */
static void choose_samples(struct eo_optimizer *optimizer, int first, int count)
{
  struct eo_credibility *credibility = optimizer->state;
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
  struct eo_credibility *credibility = optimizer->state;
  eo_credibility_model_fit(&credibility->model, &optimizer->archive,
                           eo_credibility_row(optimizer, credibility->parent[0]));
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
  const struct eo_credibility *credibility = optimizer->state;
  const int batch = optimizer->settings.batch;
  switch (credibility->search) {
  case EO_SEARCH_SAMPLE:
  case EO_SEARCH_MODEL:
    return credibility->local_places;
  case EO_SEARCH_REFINE:
    return 0;
  default:
    return credibility->polishing ? batch : (int)(optimizer->settings.local_share * batch + 0.5);
  }
}

void eo_credibility_propose_batch(struct eo_optimizer *optimizer)
{
  struct eo_credibility *credibility = optimizer->state;
  const int parents = gather_parents(optimizer), batch = optimizer->settings.batch;
  if (parents == 0)
    return;
  if (credibility->search == EO_SEARCH_SAMPLE && !credibility->evolving)
    begin_sampling(optimizer, credibility->parent[0]);
  const int share = local_share(optimizer);
  const int local = share > 0
                        ? eo_local_propose(&credibility->local, &optimizer->archive, credibility->parent[0],
                                           optimizer->settings.seed, credibility->batch, share, credibility->chosen)
                        : 0;
  int chosen = local + batch - share;
  if (credibility->evolving)
    choose_samples(optimizer, local, chosen);
  else if (credibility->search == EO_SEARCH_MODEL)
    chosen = choose_minima(optimizer, credibility->parent[0], local, chosen, optimizer->settings.batch / 4,
                           USUAL_STARTS);
  else if (share < batch)
    chosen = choose_children(optimizer, parents, local, chosen);
  request_chosen(optimizer, chosen, local);
}
