/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parallel loop: every item once, the lowest failure, cancellation, progress. */
#include "base/parallel.h"

#include <stdbool.h>
#include <string.h>

#include "support/tap.h"

enum { ITEMS = 200 };

struct work {
  int done[ITEMS]; /* each item writes its own */
  int thread[ITEMS];
  int fails_at, also_at; /* items that fail; -1: none */
};

static enum eo_code count_item(void *context, int thread, int item, struct eo_error *error)
{
  struct work *w = context;
  w->done[item]++;
  w->thread[item] = thread;
  if (item == w->fails_at || item == w->also_at)
    return eo_error_set(error, EO_ERROR_NUMERIC, "/item", "Item %d failed.", item);
  return EO_OK;
}

static void every_item_once(int threads)
{
  struct work w = {.fails_at = -1, .also_at = -1};
  struct eo_error error = {0};
  const struct eo_parallel p = {.threads = threads, .work = count_item, .context = &w, .what = "counting", .last = 1};
  int once = 0, inside = 0;
  enum eo_code code = eo_parallel_run(&p, ITEMS, &error);
  for (int i = 0; i < ITEMS; i++) {
    once += w.done[i] == 1;
    inside += w.thread[i] >= 0 && w.thread[i] < threads;
  }
  ok(code == EO_OK && once == ITEMS && inside == ITEMS, "%d threads: %d of %d items ran once", threads, once, ITEMS);
}

static void lowest_failure(int threads)
{
  struct work w = {.fails_at = 90, .also_at = 40};
  struct eo_error error = {0};
  const struct eo_parallel p = {.threads = threads, .work = count_item, .context = &w, .what = "counting", .last = 1};
  enum eo_code code = eo_parallel_run(&p, ITEMS, &error);
  int before = 0, last = 0;
  for (int i = 0; i < ITEMS; i++) {
    before += i < 40 && w.done[i];
    last = w.done[i] ? i : last;
  }
  ok(code == EO_ERROR_NUMERIC && strcmp(error.text, "Item 40 failed.") == 0 && strcmp(error.pointer, "/item") == 0,
     "%d threads: the lowest failure is told: %s", threads, error.text);
  ok(before == 40 && last < ITEMS - 1, "%d threads: everything below it ran, and not everything after it (last %d)",
     threads, last);
}

struct watch {
  int calls, most;
  double last;
  int ascending;
};

static int watch_progress(void *context, const char *what, double fraction)
{
  struct watch *watch = context;
  watch->ascending = watch->ascending && fraction >= watch->last && strcmp(what, "counting") == 0;
  watch->last = fraction;
  return ++watch->calls > watch->most;
}

static void progress_and_cancellation(int threads)
{
  struct work w = {.fails_at = -1, .also_at = -1};
  struct watch watch = {.most = ITEMS, .ascending = 1};
  struct eo_error error = {0};
  const struct eo_progress progress = {watch_progress, &watch};
  const struct eo_parallel p = {threads, count_item, &w, &progress, "counting", 0.25, 0.75};
  enum eo_code code = eo_parallel_run(&p, ITEMS, &error);
  /* with other threads around, the calling one may come too late for any item */
  bool within = watch.last > 0.25 && watch.last <= 0.75, late = threads > 1 && watch.calls == 0;
  ok(!code && watch.ascending && (within || late), "%d threads: progress ascends to %g within its share", threads,
     watch.last);
  w = (struct work){.fails_at = -1, .also_at = -1};
  watch = (struct watch){.most = 3, .ascending = 1};
  code = eo_parallel_run(&p, ITEMS, &error);
  ok(threads > 1 ? code == EO_ERROR_CANCELLED || watch.calls <= 3
                 : code == EO_ERROR_CANCELLED && w.done[ITEMS - 1] == 0,
     "%d threads: a stop is heeded (code %d after %d reports)", threads, code, watch.calls);
}

int main(void)
{
  struct work w = {.fails_at = -1, .also_at = -1};
  const struct eo_parallel none = {.threads = 4, .work = count_item, .context = &w, .what = "counting", .last = 1};
  for (int threads = 1; threads <= 8; threads *= 2) {
    every_item_once(threads);
    lowest_failure(threads);
    progress_and_cancellation(threads);
  }
  ok(eo_parallel_run(&none, 0, NULL) == EO_OK && w.done[0] == 0, "a run of no items does no work");
  ok(eo_parallel_cores() >= 1 && eo_parallel_cores() <= EO_MAX_THREADS,
     "the machine has %d cores, within what is allowed", eo_parallel_cores());
  return tap_done();
}
