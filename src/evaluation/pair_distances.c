/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/pair_distances.h"

#include <pthread.h>
#include <stdlib.h>

struct place {
  double deviation;
  bool ready;
  struct eo_pair *pair; /* owned; NULL: it could not be made */
  struct eo_error error;
  struct place *next;
};

struct eo_pair_distances {
  const struct eo_pair *pair;
  bool root;
  pthread_mutex_t mutex; /* guards the list and what it says */
  pthread_cond_t made;
  struct place *first;
};

enum eo_code eo_pair_distances_new(struct eo_pair_distances **result, const struct eo_pair *pair, bool root,
                                   struct eo_error *error)
{
  struct eo_pair_distances *distances = calloc(1, sizeof *distances);
  if (!distances)
    return eo_error_memory(error);
  distances->pair = pair;
  distances->root = root;
  pthread_mutex_init(&distances->mutex, NULL);
  pthread_cond_init(&distances->made, NULL);
  *result = distances;
  return EO_OK;
}

void eo_pair_distances_free(struct eo_pair_distances *distances)
{
  if (!distances)
    return;
  for (struct place *place = distances->first, *next; place; place = next) {
    next = place->next;
    eo_pair_free(place->pair);
    free(place);
  }
  pthread_cond_destroy(&distances->made);
  pthread_mutex_destroy(&distances->mutex);
  free(distances);
}

static struct place *find(const struct eo_pair_distances *distances, double deviation)
{
  struct place *place = distances->first;
  while (place && place->deviation != deviation)
    place = place->next;
  return place;
}

/* Others go on while the pair is made. */
static struct place *add(struct eo_pair_distances *distances, double deviation)
{
  struct place *place = calloc(1, sizeof *place);
  if (!place)
    return NULL;
  place->deviation = deviation;
  place->next = distances->first;
  distances->first = place;
  pthread_mutex_unlock(&distances->mutex);
  place->error.code = eo_pair_apart(&place->pair, distances->pair, deviation, distances->root, &place->error);
  pthread_mutex_lock(&distances->mutex);
  place->ready = true;
  pthread_cond_broadcast(&distances->made);
  return place;
}

enum eo_code eo_pair_distances_find(struct eo_pair_distances *distances, double deviation, const struct eo_pair **pair,
                                    struct eo_error *error)
{
  if (deviation == distances->pair->centre_distance_deviation) {
    *pair = distances->pair;
    return EO_OK;
  }
  pthread_mutex_lock(&distances->mutex);
  struct place *place = find(distances, deviation);
  if (!place)
    place = add(distances, deviation);
  while (place && !place->ready)
    pthread_cond_wait(&distances->made, &distances->mutex);
  pthread_mutex_unlock(&distances->mutex);
  if (!place)
    return eo_error_memory(error);
  *pair = place->pair;
  if (place->error.code && error)
    *error = place->error;
  return place->error.code;
}
