/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/evaluator_private.h"

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
  list->done++;
  pthread_cond_broadcast(&team->changed);
  return true;
}

static void *run_second(void *argument)
{
  struct eo_team *team = argument;
  pthread_mutex_lock(&team->mutex);
  for (;;) {
    if (take_piece(team, 1, NULL))
      continue;
    if (team->closed)
      break;
    pthread_cond_wait(&team->changed, &team->mutex);
  }
  pthread_mutex_unlock(&team->mutex);
  return NULL;
}

/* Where no thread can be made, the calling one does all of the work. */
void eo_team_start(struct eo_team *team, int threads)
{
  team->first = NULL;
  team->closed = false;
  pthread_mutex_init(&team->mutex, NULL);
  pthread_cond_init(&team->changed, NULL);
  team->started = threads > 1 && pthread_create(&team->thread, NULL, run_second, team) == 0;
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
  pthread_cond_broadcast(&team->changed);
  pthread_mutex_unlock(&team->mutex);
}

void eo_team_do(struct eo_team *team, struct eo_work_list *list)
{
  eo_team_offer(team, list);
  pthread_mutex_lock(&team->mutex);
  while (list->done < list->pieces)
    if (!take_piece(team, 0, list) && !take_piece(team, 0, NULL))
      pthread_cond_wait(&team->changed, &team->mutex);
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
        pthread_cond_wait(&team->changed, &team->mutex);
  team->first = NULL;
  pthread_mutex_unlock(&team->mutex);
}

void eo_team_finish(struct eo_team *team)
{
  eo_team_settle(team);
  pthread_mutex_lock(&team->mutex);
  team->closed = true;
  pthread_cond_broadcast(&team->changed);
  pthread_mutex_unlock(&team->mutex);
  if (team->started)
    pthread_join(team->thread, NULL);
  pthread_cond_destroy(&team->changed);
  pthread_mutex_destroy(&team->mutex);
}

struct ends {
  struct eo_evaluator *evaluator;
  const struct eo_run *run;
  eo_end_step *step;
};

static void take_end(void *context, int thread, int end)
{
  const struct ends *ends = context;
  (void)thread;
  ends->step(ends->evaluator, ends->run, end);
}

void eo_evaluator_each_end(struct eo_evaluator *evaluator, const struct eo_run *run, eo_end_step *step)
{
  EO_TIMED(evaluator->result.static_ms);
  struct ends ends = {.evaluator = evaluator, .run = run, .step = step};
  eo_team_do(run->team, &(struct eo_work_list){take_end, &ends, .pieces = evaluator->result.ends});
}
