/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two threads on lists of pieces: every piece once, what is urgent first, the second thread kept, one thread alone. */
#include "base/team.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stddef.h>

#include "support/tap.h"

enum { PIECES = 500 };

struct count {
  atomic_int done[PIECES];
  atomic_bool second; /* the second thread had a piece */
  pthread_t thread;   /* which it is */
};

static void count_piece(void *context, int thread, int piece)
{
  struct count *count = context;
  atomic_fetch_add(&count->done[piece], 1);
  if (thread == 1) {
    count->thread = pthread_self();
    atomic_store(&count->second, true);
  }
}

/* Takes a piece on each thread: neither ends before the other has begun. */
static void meet(void *context, int thread, int piece)
{
  struct count *count = context;
  count_piece(context, thread, piece);
  while (!atomic_load(&count->done[!piece]))
    ;
}

static bool each_once(struct count *count)
{
  int once = 0;
  for (int i = 0; i < PIECES; i++)
    once += atomic_load(&count->done[i]) == 1;
  return once == PIECES;
}

static struct eo_team *make_team(int threads)
{
  struct eo_team *team = NULL;
  struct eo_error error;
  if (eo_team_new(&team, &error) == EO_OK)
    eo_team_use(team, threads);
  return team;
}

static void every_piece_once(int threads)
{
  struct eo_team *team = make_team(threads);
  struct count urgent = {0}, filler = {0};
  struct eo_work_list later = {count_piece, &filler, .pieces = PIECES, .filler = true};
  eo_team_offer(team, &later);
  eo_team_do(team, &(struct eo_work_list){count_piece, &urgent, .pieces = PIECES});
  ok(each_once(&urgent), "%d threads: every piece of a list is done once", threads);
  eo_team_settle(team);
  ok(each_once(&filler), "%d threads: every piece of a list left to whoever has time is done once", threads);
  ok(threads > 1 || (!urgent.second && !filler.second), "%d threads: one thread alone works alone", threads);
  eo_team_free(team);
}

/* Two pieces that wait for each other need both threads; the second is the same one again, also after a time alone. */
static void second_is_kept(void)
{
  struct eo_team *team = make_team(2);
  struct count first = {0}, alone = {0}, again = {0};
  eo_team_do(team, &(struct eo_work_list){meet, &first, .pieces = 2});
  eo_team_use(team, 1);
  eo_team_do(team, &(struct eo_work_list){count_piece, &alone, .pieces = PIECES});
  eo_team_use(team, 2);
  eo_team_do(team, &(struct eo_work_list){meet, &again, .pieces = 2});
  ok(first.second && again.second && pthread_equal(first.thread, again.thread), "the second thread is kept");
  ok(each_once(&alone) && !alone.second, "the second thread takes nothing while one thread is to work");
  eo_team_free(team);
}

/* A list that a piece of another one offers is done before all are. */
struct offer {
  struct eo_team *team;
  struct count count;
  struct eo_work_list list;
};

static void offer_more(void *context, int thread, int piece)
{
  struct offer *offer = context;
  (void)thread;
  (void)piece;
  eo_team_offer(offer->team, &offer->list);
}

static void pieces_offer_lists(int threads)
{
  struct offer offer = {.team = make_team(threads)};
  offer.list = (struct eo_work_list){count_piece, &offer.count, .pieces = PIECES, .filler = true};
  eo_team_do(offer.team, &(struct eo_work_list){offer_more, &offer, .pieces = 1});
  eo_team_settle(offer.team);
  ok(each_once(&offer.count), "%d threads: a piece may offer a list", threads);
  eo_team_free(offer.team);
}

int main(void)
{
  for (int threads = 1; threads <= EO_TEAM_THREADS; threads++) {
    every_piece_once(threads);
    pieces_offer_lists(threads);
  }
  second_is_kept();
  eo_team_free(NULL);
  return tap_done();
}
