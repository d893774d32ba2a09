/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "service/pairs.h"

#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "design/pair_identity.h"
#include "service/cached_pairs.h"

enum { MOST_ANALYSES = 4, LOOK_MS = 50 };

struct eo_held_pair {
  struct eo_held_pair *next;
  char key[EO_HASH_LENGTH + 1];
  struct eo_pair *pair; /* owned; NULL while it is prepared */
  int users;
  uint64_t used;   /* the count of uses when it was last asked for */
  double fraction; /* of the preparation */
  struct idle {
    struct eo_analysis *analysis;
    uint64_t user, used;
  } idle[MOST_ANALYSES]; /* owned; analysis NULL: free */
};

struct eo_pairs {
  pthread_mutex_t mutex;   /* guards everything below and in the list */
  pthread_cond_t prepared; /* a preparation ended */
  struct eo_held_pair *first;
  struct eo_pairs_settings settings; /* strings borrowed */
  uint64_t uses;
};

enum eo_code eo_pairs_new(struct eo_pairs **result, const struct eo_pairs_settings *settings, struct eo_error *error)
{
  struct eo_pairs *pairs = calloc(1, sizeof *pairs);
  if (!pairs)
    return eo_error_memory(error);
  pairs->settings = *settings;
  pthread_mutex_init(&pairs->mutex, NULL);
  pthread_cond_init(&pairs->prepared, NULL);
  *result = pairs;
  return EO_OK;
}

static void free_held(struct eo_held_pair *held)
{
  for (int i = 0; i < MOST_ANALYSES; i++)
    eo_analysis_free(held->idle[i].analysis);
  eo_pair_free(held->pair);
  free(held);
}

void eo_pairs_free(struct eo_pairs *pairs)
{
  if (!pairs)
    return;
  for (struct eo_held_pair *held = pairs->first, *next; held; held = next) {
    next = held->next;
    free_held(held);
  }
  pthread_cond_destroy(&pairs->prepared);
  pthread_mutex_destroy(&pairs->mutex);
  free(pairs);
}

void eo_pairs_key(const struct eo_design *design, char key[EO_HASH_LENGTH + 1])
{
  struct eo_pair_identity identity = eo_pair_identity_of_design(design);
  eo_pair_identity_key(&identity, key);
}

static struct eo_held_pair *find(struct eo_pairs *pairs, const char *key)
{
  struct eo_held_pair *held = pairs->first;
  while (held && strcmp(held->key, key) != 0)
    held = held->next;
  return held;
}

static void use(struct eo_pairs *pairs, struct eo_held_pair *held)
{
  held->users++;
  held->used = ++pairs->uses;
}

static void take_out(struct eo_pairs *pairs, struct eo_held_pair *held)
{
  struct eo_held_pair **link = &pairs->first;
  while (*link != held)
    link = &(*link)->next;
  *link = held->next;
}

/* Takes the pair nobody has used for longest out of the list while there are too many; NULL: none to spare. */
static struct eo_held_pair *take_surplus(struct eo_pairs *pairs)
{
  struct eo_held_pair *oldest = NULL;
  int count = 0;
  for (struct eo_held_pair *held = pairs->first; held; held = held->next) {
    count += held->pair != NULL;
    if (held->pair && !held->users && (!oldest || held->used < oldest->used))
      oldest = held;
  }
  if (count <= pairs->settings.most || !oldest)
    return NULL;
  take_out(pairs, oldest);
  return oldest;
}

/* Frees outside the mutex: a pair is large. */
static void evict(struct eo_pairs *pairs)
{
  for (bool more = true; more;) {
    pthread_mutex_lock(&pairs->mutex);
    struct eo_held_pair *surplus = take_surplus(pairs);
    pthread_mutex_unlock(&pairs->mutex);
    more = surplus != NULL;
    if (surplus)
      free_held(surplus);
  }
}

struct eo_held_pair *eo_pairs_find(struct eo_pairs *pairs, const struct eo_design *design)
{
  char key[EO_HASH_LENGTH + 1];
  eo_pairs_key(design, key);
  pthread_mutex_lock(&pairs->mutex);
  struct eo_held_pair *held = find(pairs, key);
  if (held && held->pair)
    use(pairs, held);
  else
    held = NULL;
  pthread_mutex_unlock(&pairs->mutex);
  return held;
}

struct preparation {
  struct eo_pairs *pairs;
  struct eo_held_pair *held;
  const struct eo_progress *progress;
};

static int report(void *context, const char *what, double fraction)
{
  struct preparation *preparation = context;
  pthread_mutex_lock(&preparation->pairs->mutex);
  preparation->held->fraction = fraction;
  pthread_mutex_unlock(&preparation->pairs->mutex);
  return eo_progress_report(preparation->progress, what, fraction);
}

/* *held is in the list without a pair, so that nobody else prepares it. */
static enum eo_code prepare(struct eo_pairs *pairs, const struct eo_design *design, const struct eo_progress *progress,
                            struct eo_held_pair *held, struct eo_error *error)
{
  struct preparation preparation = {pairs, held, progress};
  const struct eo_progress own = {report, &preparation};
  const struct eo_preparation_settings *process = &pairs->settings.preparation;
  const struct eo_pair_options options = {.cache_directory = process->cache};
  struct eo_pair *pair = NULL;
  enum eo_code code = process->program ? eo_preparation_run(process, design, &own, error) : EO_OK;
  if (!code)
    code = eo_pair_new(&pair, design, &options, &own, error);
  if (!code)
    eo_cached_pairs_use(process->cache, eo_flexibility_report(pair->flexibility)->key, pairs->settings.cache_bytes);
  pthread_mutex_lock(&pairs->mutex);
  if (code)
    take_out(pairs, held);
  else {
    held->pair = pair;
    use(pairs, held);
  }
  pthread_cond_broadcast(&pairs->prepared);
  pthread_mutex_unlock(&pairs->mutex);
  if (code)
    free(held);
  else
    evict(pairs);
  return code;
}

/* With the mutex held: until a preparation ends, or for a moment. */
static void wait_a_moment(struct eo_pairs *pairs)
{
  struct timespec until;
  clock_gettime(CLOCK_REALTIME, &until);
  until.tv_nsec += LOOK_MS * 1000000L;
  until.tv_sec += until.tv_nsec / 1000000000L;
  until.tv_nsec %= 1000000000L;
  pthread_cond_timedwait(&pairs->prepared, &pairs->mutex, &until);
}

enum eo_code eo_pairs_obtain(struct eo_pairs *pairs, const struct eo_design *design, const struct eo_progress *progress,
                             struct eo_held_pair **result, struct eo_error *error)
{
  struct eo_held_pair *mine = calloc(1, sizeof *mine), *held;
  if (!mine)
    return eo_error_memory(error);
  eo_pairs_key(design, mine->key);
  pthread_mutex_lock(&pairs->mutex);
  while ((held = find(pairs, mine->key)) && !held->pair) {
    double fraction = held->fraction;
    wait_a_moment(pairs);
    pthread_mutex_unlock(&pairs->mutex);
    bool stop = eo_progress_report(progress, "waiting for the preparation", fraction) != 0;
    if (stop) {
      free(mine);
      return eo_error_set(error, EO_ERROR_CANCELLED, "", "The preparation was stopped.");
    }
    pthread_mutex_lock(&pairs->mutex);
  }
  if (held)
    use(pairs, held);
  else {
    mine->next = pairs->first;
    pairs->first = mine;
  }
  pthread_mutex_unlock(&pairs->mutex);
  enum eo_code code = EO_OK;
  if (held)
    free(mine);
  else {
    held = mine;
    code = prepare(pairs, design, progress, mine, error);
  }
  if (!code)
    *result = held;
  return code;
}

void eo_pairs_release(struct eo_pairs *pairs, struct eo_held_pair *held)
{
  if (!held)
    return;
  pthread_mutex_lock(&pairs->mutex);
  held->users--;
  pthread_mutex_unlock(&pairs->mutex);
  evict(pairs);
}

const struct eo_pair *eo_held_pair(const struct eo_held_pair *held)
{
  return held->pair;
}

int eo_pairs_count(struct eo_pairs *pairs)
{
  int count = 0;
  pthread_mutex_lock(&pairs->mutex);
  for (const struct eo_held_pair *held = pairs->first; held; held = held->next)
    count += held->pair != NULL;
  pthread_mutex_unlock(&pairs->mutex);
  return count;
}

/* The idle analysis of this user; else the one that was used last, whoever by, when there is no room for more. */
static struct idle *choose(struct eo_held_pair *held, uint64_t user)
{
  struct idle *oldest = NULL;
  int count = 0;
  for (int i = 0; i < MOST_ANALYSES; i++) {
    struct idle *idle = &held->idle[i];
    count += idle->analysis != NULL;
    if (idle->analysis && user && idle->user == user)
      return idle;
    if (idle->analysis && (!oldest || idle->used < oldest->used || !user))
      oldest = idle;
  }
  return !user || count == MOST_ANALYSES ? oldest : NULL;
}

enum eo_code eo_pairs_borrow(struct eo_pairs *pairs, struct eo_held_pair *held, uint64_t user,
                             struct eo_analysis **analysis, struct eo_error *error)
{
  pthread_mutex_lock(&pairs->mutex);
  struct idle *idle = choose(held, user);
  struct eo_analysis *found = idle ? idle->analysis : NULL;
  if (idle)
    idle->analysis = NULL;
  pthread_mutex_unlock(&pairs->mutex);
  if (!found)
    return eo_analysis_new(analysis, held->pair, error);
  *analysis = found;
  return EO_OK;
}

void eo_pairs_give_back(struct eo_pairs *pairs, struct eo_held_pair *held, uint64_t user, struct eo_analysis *analysis)
{
  pthread_mutex_lock(&pairs->mutex);
  struct idle *place = &held->idle[0];
  for (int i = 0; i < MOST_ANALYSES && place->analysis; i++)
    if (!held->idle[i].analysis || held->idle[i].used < place->used)
      place = &held->idle[i];
  struct eo_analysis *displaced = place->analysis;
  *place = (struct idle){analysis, user, ++pairs->uses};
  pthread_mutex_unlock(&pairs->mutex);
  eo_analysis_free(displaced);
}
