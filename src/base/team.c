/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/team.h"

#include <pthread.h>
#include <stdlib.h>

struct eo_team {
  pthread_t second;
  bool started;
  pthread_mutex_t mutex;         /* guards what follows, and the lists */
  pthread_cond_t offered, ended; /* for the second thread: there is a piece; for the first: one is done, or there is */
  bool waits[EO_TEAM_THREADS];   /* [thread]: so that nobody is woken who is awake */
  bool helps, closed;            /* helps: the second thread may take pieces */
  struct eo_work_list *first;
};

/* The next piece of the work that is most urgent, of that list alone where one is named; with the mutex held. */
static struct eo_work_list *find_piece(struct eo_team *team, const struct eo_work_list *alone)
{
  struct eo_work_list *found = NULL;
  for (struct eo_work_list *list = team->first; list; list = list->behind) {
    bool waits = list->next < list->pieces && (!alone || list == alone);
    if (waits && (!found || (found->filler && !list->filler)))
      found = list;
  }
  return found;
}

static void wait_on(struct eo_team *team, int thread, pthread_cond_t *condition)
{
  team->waits[thread] = true;
  pthread_cond_wait(condition, &team->mutex);
  team->waits[thread] = false;
}

static void wake(struct eo_team *team)
{
  if (team->waits[0])
    pthread_cond_signal(&team->ended);
  if (team->waits[1] && (team->closed || (team->helps && find_piece(team, NULL))))
    pthread_cond_signal(&team->offered);
}

/* Takes one piece; false: there is none. With the mutex held, not while working. */
static bool take_piece(struct eo_team *team, int thread, const struct eo_work_list *alone)
{
  struct eo_work_list *list = find_piece(team, alone);
  if (!list)
    return false;
  int piece = list->next++;
  pthread_mutex_unlock(&team->mutex);
  list->work(list->context, thread, piece);
  pthread_mutex_lock(&team->mutex);
  if (++list->done == list->pieces)
    wake(team);
  return true;
}

static void *run_second(void *argument)
{
  struct eo_team *team = argument;
  pthread_mutex_lock(&team->mutex);
  while (!team->closed)
    if (!team->helps || !take_piece(team, 1, NULL))
      wait_on(team, 1, &team->offered);
  pthread_mutex_unlock(&team->mutex);
  return NULL;
}

enum eo_code eo_team_new(struct eo_team **result, struct eo_error *error)
{
  struct eo_team *team = calloc(1, sizeof *team);
  if (!team)
    return eo_error_memory(error);
  pthread_mutex_init(&team->mutex, NULL);
  pthread_cond_init(&team->offered, NULL);
  pthread_cond_init(&team->ended, NULL);
  *result = team;
  return EO_OK;
}

void eo_team_free(struct eo_team *team)
{
  if (!team)
    return;
  if (team->started) {
    pthread_mutex_lock(&team->mutex);
    team->closed = true;
    wake(team);
    pthread_mutex_unlock(&team->mutex);
    pthread_join(team->second, NULL);
  }
  pthread_cond_destroy(&team->ended);
  pthread_cond_destroy(&team->offered);
  pthread_mutex_destroy(&team->mutex);
  free(team);
}

void eo_team_use(struct eo_team *team, int threads)
{
  pthread_mutex_lock(&team->mutex);
  team->helps = threads > 1;
  pthread_mutex_unlock(&team->mutex);
  if (threads > 1 && !team->started)
    team->started = pthread_create(&team->second, NULL, run_second, team) == 0;
}

void eo_team_offer(struct eo_team *team, struct eo_work_list *list)
{
  list->next = list->done = 0;
  list->behind = NULL;
  pthread_mutex_lock(&team->mutex);
  struct eo_work_list **link = &team->first;
  while (*link)
    link = &(*link)->behind;
  *link = list;
  wake(team);
  pthread_mutex_unlock(&team->mutex);
}

void eo_team_do(struct eo_team *team, struct eo_work_list *list)
{
  eo_team_offer(team, list);
  pthread_mutex_lock(&team->mutex);
  while (list->done < list->pieces)
    if (!take_piece(team, 0, list) && !take_piece(team, 0, NULL))
      wait_on(team, 0, &team->ended);
  struct eo_work_list **link = &team->first;
  while (*link != list)
    link = &(*link)->behind;
  *link = list->behind;
  pthread_mutex_unlock(&team->mutex);
}

void eo_team_settle(struct eo_team *team)
{
  pthread_mutex_lock(&team->mutex);
  for (struct eo_work_list *list = team->first; list; list = list->behind)
    while (list->done < list->pieces)
      if (!take_piece(team, 0, NULL))
        wait_on(team, 0, &team->ended);
  team->first = NULL;
  pthread_mutex_unlock(&team->mutex);
}
