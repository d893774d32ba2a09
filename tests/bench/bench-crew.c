/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a crew costs beside the work: evaluations of known length (they sleep) on threads or on MPI ranks, with rows of
   a study's size written to a database as a study writes them.

     bench-crew ITEMS MILLISECONDS DIR            EASEOFF_MODULES=BUILD mpirun --oversubscribe -n 65 bench-crew ...

   Efficiency: the time that the evaluations take on so many hands, over the time it took. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

#include "base/clock.h"
#include "base/hash.h"
#include "base/random.h"
#include "crew/crew.h"
#include "evaluation/evaluator.h"
#include "store/variant_rows.h"

enum { NUMBERS = 18, BATCH = 500 };

static enum eo_code open_bench(struct eo_crew_bench *bench, struct eo_error *error)
{
  (void)bench;
  (void)error;
  return EO_OK;
}

/* Between half and one and a half of the mean length: evaluations are not equal. */
static enum eo_code sleep_for(struct eo_crew_bench *bench, int thread, const char *item, size_t size,
                              struct eo_text *answer, struct eo_error *error)
{
  double number[NUMBERS];
  int index = atoi(item);
  double share = 0.5 + eo_random_unit(eo_random_at(1, 2, 3, (uint64_t)index), 0);
  long microseconds = (long)(1e3 * atof(bench->order) * share);
  (void)thread;
  (void)size;
  (void)error;
  nanosleep(&(struct timespec){microseconds / 1000000, 1000 * (microseconds % 1000000)}, NULL);
  for (int i = 0; i < NUMBERS; i++)
    number[i] = index + 0.1 * i;
  eo_text_add_bytes(answer, number, sizeof number);
  return EO_OK;
}

static void close_bench(struct eo_crew_bench *bench)
{
  (void)bench;
}

static const struct eo_crew_trade trade = {"sleep", open_bench, sleep_for, close_bench};
static const struct eo_crew_trade *const trades[] = {&trade, NULL};

struct keeping {
  struct eo_store *store; /* NULL: nothing is kept */
  int64_t columns;
  int items, open;
  double seconds;
};

static enum eo_code write_item(void *context, int item, struct eo_text *text, struct eo_error *error)
{
  (void)context;
  (void)error;
  eo_text_print(text, "%d {\"values\":[12.3456789,%d.5,7.25]}", item, item);
  return EO_OK;
}

static enum eo_code keep(struct keeping *keeping, int item, double number[NUMBERS], struct eo_error *error)
{
  char hash[EO_HASH_LENGTH + 1];
  eo_hash_hex(&item, sizeof item, hash);
  struct eo_stored_variant row = {
      .design = hash, .evaluator = 1, .columns = keeping->columns, .numbers = NUMBERS, .number = number};
  if (!keeping->open)
    EO_TRY(eo_store_begin(keeping->store, error));
  keeping->open++;
  EO_TRY(eo_store_add_variant(keeping->store, &row, error));
  if (keeping->open < BATCH && item + 1 < keeping->items)
    return EO_OK;
  keeping->open = 0;
  return eo_store_commit(keeping->store, error);
}

static enum eo_code take(void *context, int item, const char *answer, size_t size, struct eo_error *error)
{
  struct keeping *keeping = context;
  double number[NUMBERS], start = eo_clock_milliseconds();
  if (size != sizeof number)
    return eo_error_memory(error);
  memcpy(number, answer, sizeof number);
  enum eo_code code = keeping->store ? keep(keeping, item, number, error) : EO_OK;
  keeping->seconds += 1e-3 * (eo_clock_milliseconds() - start);
  return code;
}

static double processor(void)
{
  struct rusage used;
  getrusage(RUSAGE_SELF, &used);
  return (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
         1e-6 * (double)(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

static void lead(struct eo_crew *crew, struct keeping *keeping, const char *length)
{
  struct eo_error error = {0};
  const struct eo_crew_task task = {.trade = &trade,
                                    .order = length,
                                    .size = strlen(length),
                                    .items = keeping->items,
                                    .write = write_item,
                                    .take = take,
                                    .context = keeping};
  double ideal = 0, start = eo_clock_milliseconds(), used = processor();
  for (int i = 0; i < keeping->items; i++)
    ideal += 1e-3 * atof(length) * (0.5 + eo_random_unit(eo_random_at(1, 2, 3, (uint64_t)i), 0));
  ideal /= eo_crew_strength(crew);
  if (eo_crew_run(crew, &task, &error))
    printf("%s\n", error.text);
  double seconds = 1e-3 * (eo_clock_milliseconds() - start);
  printf("%4d hands, %d evaluations of %s ms: %.2f s, efficiency %.3f; rank 0: %.1f us of a processor each, of which "
         "writing rows %.1f us (by the clock)\n",
         eo_crew_strength(crew), keeping->items, length, seconds, ideal / seconds,
         1e6 * (processor() - used) / keeping->items, 1e6 * keeping->seconds / keeping->items);
}

int main(int argc, char **argv)
{
  struct eo_crew crew;
  struct eo_error error = {0};
  struct keeping keeping = {.items = argc > 1 ? atoi(argv[1]) : 200};
  const char *length = argc > 2 ? argv[2] : "5";
  const struct eo_crew_place place = {.threads = 1};
  enum eo_code code = eo_crew_begin(&crew, &place, &error);
  if (!code && eo_crew_is_led(&crew))
    code = eo_crew_serve(&crew, trades, &error);
  else if (!code) {
    if (argc > 3)
      code = eo_store_open(&keeping.store, argv[3], EO_STORE_WRITE, &error);
    if (!code && keeping.store)
      code = eo_store_variant_columns(keeping.store, "[\"bench\"]", &keeping.columns, &error);
    if (!code)
      lead(&crew, &keeping, length);
    eo_store_close(keeping.store);
  }
  if (code)
    printf("%s\n", error.text);
  eo_crew_end(&crew);
  return code != EO_OK;
}
