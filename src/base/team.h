/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two threads that work off lists of pieces, the calling one and one that is kept: to make a thread takes as long as
   many a list. What a piece computes must not depend on which thread takes it. */
#ifndef EASEOFF_BASE_TEAM_H
#define EASEOFF_BASE_TEAM_H

#include "base/error.h"

#include <stdbool.h>

enum { EO_TEAM_THREADS = 2 };

/* A list of pieces of work, in any order and on either thread. */
struct eo_work_list {
  void (*work)(void *context, int thread, int piece); /* thread: 0, the calling one, or 1 */
  void *context;                                      /* borrowed */
  int pieces;
  bool filler; /* what nobody waits for yet: taken where there is nothing else */
  int next, done;
  struct eo_work_list *behind;
};

/* One per calling thread. */
struct eo_team;

/* The second thread starts with the first work. Errors: memory. */
enum eo_code eo_team_new(struct eo_team **team, struct eo_error *error);

/* Ends the second thread. */
void eo_team_free(struct eo_team *team);

/* threads: 1 or 2 that may work from now on, between lists; where no thread can be made, the calling one does all. */
void eo_team_use(struct eo_team *team, int threads);

/* Leaves a list to whoever has time; it is borrowed until eo_team_settle(). Any of the two threads may offer one. */
void eo_team_offer(struct eo_team *team, struct eo_work_list *list);

/* Works a list off, with the other thread; back when it is done. */
void eo_team_do(struct eo_team *team, struct eo_work_list *list);

/* Back when everything that was offered is done. */
void eo_team_settle(struct eo_team *team);

#endif
