/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "variants/pair_rack.h"

#include <pthread.h>
#include <stdlib.h>

#include "design/pair_identity.h"
#include "design/resolution.h"
#include "flexibility/preparation_cost.h"

struct eo_racked_pair {
  struct eo_pair_identity identity;
  struct eo_pair *pair;  /* owned; NULL while it is being prepared, and where that failed */
  struct eo_error error; /* where it failed */
  bool ready;            /* prepared, or failed */
  int holders;
  struct eo_racked_pair *next;
};

struct eo_pair_rack {
  const struct eo_crew_place *place;
  const struct eo_progress *progress;
  pthread_mutex_t mutex; /* guards what follows */
  pthread_cond_t changed;
  struct eo_racked_pair *first;
};

enum eo_code eo_pair_rack_new(struct eo_pair_rack **result, const struct eo_crew_place *place,
                              const struct eo_progress *progress, struct eo_error *error)
{
  struct eo_pair_rack *rack = calloc(1, sizeof *rack);
  if (!rack)
    return eo_error_memory(error);
  rack->place = place;
  rack->progress = progress;
  pthread_mutex_init(&rack->mutex, NULL);
  pthread_cond_init(&rack->changed, NULL);
  *result = rack;
  return EO_OK;
}

static void drop(struct eo_racked_pair *held)
{
  eo_pair_free(held->pair);
  free(held);
}

/* Those that nobody holds. */
static void clear(struct eo_pair_rack *rack)
{
  for (struct eo_racked_pair **at = &rack->first; *at;) {
    struct eo_racked_pair *held = *at;
    if (held->holders) {
      at = &held->next;
      continue;
    }
    *at = held->next;
    drop(held);
  }
}

void eo_pair_rack_free(struct eo_pair_rack *rack)
{
  if (!rack)
    return;
  clear(rack);
  pthread_cond_destroy(&rack->changed);
  pthread_mutex_destroy(&rack->mutex);
  free(rack);
}

static struct eo_racked_pair *find(const struct eo_pair_rack *rack, const struct eo_pair_identity *identity)
{
  struct eo_racked_pair *held = rack->first;
  while (held && !eo_pair_identity_equal(&held->identity, identity))
    held = held->next;
  return held;
}

static enum eo_code admit(const struct eo_crew_place *place, const struct eo_design *design, struct eo_error *error)
{
  struct eo_preparation_cost cost;
  struct eo_geometry geometry;
  struct eo_flexibility_settings settings = eo_flexibility_settings_of(&design->resolution);
  if (!(place->memory > 0) || eo_geometry_init(&geometry, &design->gear_pair, NULL) ||
      eo_preparation_cost_find(&geometry, &design->gear_pair, &settings, &cost, NULL))
    return EO_OK; /* the preparation says what is wrong with it */
  if (cost.memory <= place->memory && cost.seconds <= place->seconds)
    return EO_OK;
  return eo_error_set(
      error, EO_ERROR_INPUT, "/resolution",
      "Preparing this pair would take %.0f MB and %.0f s of a processor; %.0f MB and %.0f s are allowed.",
      cost.memory / 1e6, cost.seconds, place->memory / 1e6, place->seconds);
}

/* Called and left with the mutex locked, which it lets go of meanwhile. */
static void prepare(struct eo_pair_rack *rack, struct eo_racked_pair *held, const struct eo_design *design)
{
  const struct eo_pair_options options = {.cache_directory = rack->place->cache};
  struct eo_pair *pair = NULL;
  struct eo_error error = {0};
  pthread_mutex_unlock(&rack->mutex);
  enum eo_code code = admit(rack->place, design, &error);
  if (!code)
    code = eo_pair_new(&pair, design, &options, rack->progress, &error);
  pthread_mutex_lock(&rack->mutex);
  held->pair = code ? NULL : pair;
  held->error = error;
  held->error.code = code;
  held->ready = true;
  pthread_cond_broadcast(&rack->changed);
}

static struct eo_racked_pair *add(struct eo_pair_rack *rack, const struct eo_pair_identity *identity)
{
  struct eo_racked_pair *held = calloc(1, sizeof *held);
  if (!held)
    return NULL;
  held->identity = *identity;
  held->next = rack->first;
  rack->first = held;
  return held;
}

enum eo_code eo_pair_rack_take(struct eo_pair_rack *rack, const struct eo_design *design,
                               struct eo_racked_pair **result, struct eo_error *error)
{
  const struct eo_pair_identity identity = eo_pair_identity_of_design(design);
  enum eo_code code = EO_OK;
  pthread_mutex_lock(&rack->mutex);
  struct eo_racked_pair *held = find(rack, &identity);
  bool fresh = !held;
  if (fresh) {
    clear(rack);
    held = add(rack, &identity);
  }
  if (!held) {
    pthread_mutex_unlock(&rack->mutex);
    return eo_error_memory(error);
  }
  held->holders++;
  if (fresh)
    prepare(rack, held, design);
  while (!held->ready)
    pthread_cond_wait(&rack->changed, &rack->mutex);
  code = held->error.code;
  if (code) {
    *error = held->error;
    held->holders--;
  } else
    *result = held;
  pthread_mutex_unlock(&rack->mutex);
  return code;
}

void eo_pair_rack_put(struct eo_pair_rack *rack, struct eo_racked_pair *held)
{
  if (!held)
    return;
  pthread_mutex_lock(&rack->mutex);
  held->holders--;
  pthread_mutex_unlock(&rack->mutex);
}

const struct eo_pair *eo_racked_pair(const struct eo_racked_pair *held)
{
  return held->pair;
}
