/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A crew: answers come in the order of the items for any number of threads, and of ranks that talk through memory in
   place of MPI; the error of the lowest item is the one that is told; a stop keeps what was done in order. */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/random.h"
#include "crew/crew.h"
#include "support/tap.h"

enum { ITEMS = 600, MOST_RANKS = 6 };

static struct eo_error error;
static atomic_int opened, failing = -1;

static enum eo_code open_bench(struct eo_crew_bench *bench, struct eo_error *fault)
{
  atomic_fetch_add(&opened, 1);
  return strcmp(bench->order, "broken") == 0 ? eo_error_set(fault, EO_ERROR_FILE, "", "The bench is broken.") : EO_OK;
}

/* Answers with the order and the item, after a while that has nothing to do with their order. */
static enum eo_code work(struct eo_crew_bench *bench, int thread, const char *item, size_t size, struct eo_text *answer,
                         struct eo_error *fault)
{
  int index = atoi(item);
  long nanoseconds = (long)(3e5 * eo_random_unit(eo_random_at(7, 1, 1, (uint64_t)index), 0));
  (void)thread;
  (void)size;
  nanosleep(&(struct timespec){0, nanoseconds}, NULL);
  if (atomic_load(&failing) >= 0 && index >= atomic_load(&failing))
    return eo_error_set(fault, EO_ERROR_NUMERIC, "", "Item %d failed.", index);
  eo_text_print(answer, "%s %s", bench->order, item);
  return EO_OK;
}

static void close_bench(struct eo_crew_bench *bench)
{
  (void)bench;
}

static const struct eo_crew_trade trade = {"echo", open_bench, work, close_bench};
static const struct eo_crew_trade *const trades[] = {&trade, NULL};

struct list {
  const char *order;
  int next, stop_at; /* stop_at: 0: never */
  bool right;
};

static enum eo_code write_item(void *context, int item, struct eo_text *text, struct eo_error *fault)
{
  (void)context;
  (void)fault;
  eo_text_print(text, "%d", item);
  return EO_OK;
}

static enum eo_code take(void *context, int item, const char *answer, size_t size, struct eo_error *fault)
{
  struct list *list = context;
  char expected[80];
  (void)fault;
  snprintf(expected, sizeof expected, "%s %d", list->order, item);
  list->right = list->right && item == list->next++ && size == strlen(expected) && strcmp(answer, expected) == 0;
  return EO_OK;
}

static int watch(void *context)
{
  const struct list *list = context;
  return list->stop_at && list->next >= list->stop_at;
}

static enum eo_code run(struct eo_crew *crew, const char *order, int items, struct list *list)
{
  const struct eo_crew_task task = {.trade = &trade,
                                    .order = order,
                                    .size = strlen(order),
                                    .items = items,
                                    .write = write_item,
                                    .take = take,
                                    .watch = watch,
                                    .context = list};
  list->order = order;
  list->next = 0;
  list->right = true;
  return eo_crew_run(crew, &task, &error);
}

static void try_crew(struct eo_crew *crew, const char *what)
{
  struct list list = {0};
  ok(run(crew, "one", ITEMS, &list) == EO_OK && list.right && list.next == ITEMS, "%s: every answer comes in its order",
     what);
  int before = atomic_load(&opened);
  ok(run(crew, "one", ITEMS / 4, &list) == EO_OK && list.right && atomic_load(&opened) == before,
     "%s: the same order goes on at the same benches", what);
  ok(run(crew, "two", ITEMS / 4, &list) == EO_OK && list.right && atomic_load(&opened) > before,
     "%s: another order opens other benches", what);
  atomic_store(&failing, 100);
  ok(run(crew, "one", ITEMS, &list) == EO_ERROR_NUMERIC && strcmp(error.text, "Item 100 failed.") == 0 &&
         list.next == 100 && list.right,
     "%s: the error of the lowest item is told, after all before it: %s", what, error.text);
  atomic_store(&failing, -1);
  ok(run(crew, "broken", 10, &list) == EO_ERROR_FILE && list.next == 0, "%s: a bench that cannot be opened is told",
     what);
  list.stop_at = 50;
  ok(run(crew, "one", 20000, &list) == EO_ERROR_CANCELLED && list.right && list.next >= 50 && list.next < 20000,
     "%s: a stop keeps what was done in order: %d", what, list.next);
  list.stop_at = 0;
  ok(run(crew, "one", ITEMS, &list) == EO_OK && list.right && list.next == ITEMS, "%s: the crew goes on after a stop",
     what);
  ok(run(crew, "one", 0, &list) == EO_OK && list.next == 0, "%s: an order of nothing succeeds", what);
}

/* Ranks that are threads of this process: */

struct letter {
  int from, tag;
  size_t size;
  void *data;
  struct letter *next;
};
static struct box {
  pthread_mutex_t mutex;
  struct letter *first, **last;
} box[MOST_RANKS];
static __thread int own_rank;

static int post(int to, int tag, const void *data, size_t size)
{
  struct letter *letter = malloc(sizeof *letter);
  *letter = (struct letter){own_rank, tag, size, malloc(size + 1), NULL};
  memcpy(letter->data, data, size);
  pthread_mutex_lock(&box[to].mutex);
  *box[to].last = letter;
  box[to].last = &letter->next;
  pthread_mutex_unlock(&box[to].mutex);
  return 0;
}

static int look(bool *there, int *from, int *tag, size_t *size)
{
  pthread_mutex_lock(&box[own_rank].mutex);
  const struct letter *letter = box[own_rank].first;
  *there = letter != NULL;
  if (letter) {
    *from = letter->from;
    *tag = letter->tag;
    *size = letter->size;
  }
  pthread_mutex_unlock(&box[own_rank].mutex);
  return 0;
}

static int receive(int from, int tag, void *data, size_t size)
{
  (void)from;
  (void)tag;
  pthread_mutex_lock(&box[own_rank].mutex);
  struct letter *letter = box[own_rank].first;
  box[own_rank].first = letter->next;
  if (!letter->next)
    box[own_rank].last = &box[own_rank].first;
  pthread_mutex_unlock(&box[own_rank].mutex);
  memcpy(data, letter->data, size);
  free(letter->data);
  free(letter);
  return 0;
}

static int leave(void)
{
  return 0;
}

static const char *describe(void)
{
  return "";
}

static const struct eo_ranks ranks = {
    .send = post, .probe = look, .receive = receive, .end = leave, .message = describe};

static void *serve(void *argument)
{
  struct eo_crew *crew = argument;
  struct eo_error fault;
  own_rank = crew->rank;
  return eo_crew_serve(crew, trades, &fault) ? argument : NULL;
}

static void try_ranks(int size, int threads)
{
  const struct eo_crew_place place = {.threads = threads};
  struct eo_crew crew[MOST_RANKS];
  struct eo_crew_member *members = calloc((size_t)size, sizeof *members);
  pthread_t thread[MOST_RANKS];
  char what[60];
  bool good = true;
  for (int rank = 0; rank < size; rank++) {
    crew[rank] = (struct eo_crew){.place = place, .ranks = &ranks, .rank = rank, .size = size};
    members[rank].threads = threads;
    pthread_mutex_init(&box[rank].mutex, NULL);
    box[rank].first = NULL;
    box[rank].last = &box[rank].first;
  }
  crew[0].member = members;
  for (int rank = 1; rank < size; rank++)
    pthread_create(&thread[rank], NULL, serve, &crew[rank]);
  snprintf(what, sizeof what, "%d ranks of %d threads", size, threads);
  ok(eo_crew_strength(&crew[0]) == (size - 1) * threads, "%s: the crew knows its strength", what);
  try_crew(&crew[0], what);
  eo_crew_end(&crew[0]);
  for (int rank = 1; rank < size; rank++) {
    void *failed;
    pthread_join(thread[rank], &failed);
    good = good && !failed;
  }
  ok(good, "%s: all ranks go home", what);
}

int main(void)
{
  for (int threads = 1; threads <= 4; threads *= 2) {
    const struct eo_crew_place place = {.threads = threads};
    struct eo_crew crew;
    char what[40];
    snprintf(what, sizeof what, "%d threads", threads);
    eo_crew_alone(&crew, &place);
    try_crew(&crew, what);
    eo_crew_end(&crew);
  }
  try_ranks(2, 1);
  try_ranks(5, 2);
  return tap_done();
}
