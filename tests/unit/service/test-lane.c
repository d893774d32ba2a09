/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The lane of what-if requests: order, newest wins, limits, waiting for a job, stopping. The stream of events: order,
   filters, resuming. */
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/clock.h"
#include "service/events.h"
#include "service/lane.h"
#include "support/tap.h"

static struct eo_error error;

struct work {
  struct eo_lane_task task;
  int number;
  bool hold; /* waits for the gate */
};

static struct {
  pthread_mutex_t mutex;
  pthread_cond_t changed;
  int told;        /* tasks that were answered */
  int number[100]; /* in the order of the answers */
  enum eo_lane_fate fate[100];
  enum eo_code code[100];
  bool open, marked; /* marked: a task saw that it was overtaken */
  int held, released;
} book = {.mutex = PTHREAD_MUTEX_INITIALIZER, .changed = PTHREAD_COND_INITIALIZER};

static void answer(void *context, struct eo_lane_task *task, enum eo_lane_fate fate)
{
  struct work *work = (struct work *)task;
  (void)context;
  pthread_mutex_lock(&book.mutex);
  if (fate == EO_LANE_RUN && work->hold) {
    book.held++;
    pthread_cond_broadcast(&book.changed);
    while (!book.open)
      pthread_cond_wait(&book.changed, &book.mutex);
    book.marked = atomic_load(&task->overtaken);
  }
  book.number[book.told] = work->number;
  book.code[book.told] = task->error.code;
  book.fate[book.told++] = fate;
  pthread_cond_broadcast(&book.changed);
  pthread_mutex_unlock(&book.mutex);
}

static void release(struct eo_lane_task *task)
{
  pthread_mutex_lock(&book.mutex);
  book.released++;
  pthread_mutex_unlock(&book.mutex);
  free(task);
}

static void wait_until(const int *value, int least)
{
  pthread_mutex_lock(&book.mutex);
  while (*value < least)
    pthread_cond_wait(&book.changed, &book.mutex);
  pthread_mutex_unlock(&book.mutex);
}

static void set_gate(bool open)
{
  pthread_mutex_lock(&book.mutex);
  book.open = open;
  pthread_cond_broadcast(&book.changed);
  pthread_mutex_unlock(&book.mutex);
}

static struct eo_lane *make_lane(int most, bool overtakes_running)
{
  const struct eo_lane_settings settings = {
      .threads = 1, .most = most, .overtakes_running = overtakes_running, .function = answer, .release = release};
  struct eo_lane *lane = NULL;
  eo_lane_new(&lane, &settings, &error);
  book.told = book.held = book.released = 0;
  book.open = book.marked = false;
  return lane;
}

static bool push(struct eo_lane *lane, int number, const char *token, int64_t awaits, double patience, bool *closed)
{
  struct work *work = calloc(1, sizeof *work);
  *work = (struct work){.task = {.awaits = awaits, .patience = eo_clock_milliseconds() + patience},
                        .number = number,
                        .hold = number == 0};
  snprintf(work->task.token, sizeof work->task.token, "%s", token);
  bool taken = eo_lane_push(lane, &work->task, closed);
  if (!taken)
    free(work);
  return taken;
}

static bool told(int position, int number, enum eo_lane_fate fate)
{
  return book.number[position] == number && book.fate[position] == fate;
}

static void test_overtaking(void)
{
  struct eo_lane *lane = make_lane(4, false);
  bool closed;
  push(lane, 0, "a", 0, 0, &closed);
  wait_until(&book.held, 1);
  ok(push(lane, 1, "a", 0, 0, &closed) && push(lane, 2, "b", 0, 0, &closed) && push(lane, 3, "", 0, 0, &closed) &&
         push(lane, 4, "", 0, 0, &closed),
     "four tasks wait in the lane");
  ok(!push(lane, 5, "c", 0, 0, &closed) && !closed, "a full lane takes no other task");
  ok(push(lane, 6, "a", 0, 0, &closed) && eo_lane_waiting(lane) == 4,
     "a newer task of the same token takes a place in a full lane");
  set_gate(true);
  wait_until(&book.told, 6);
  ok(told(0, 0, EO_LANE_RUN) && !book.marked, "a task that has begun is not overtaken");
  ok(told(1, 1, EO_LANE_OVERTAKEN), "a task that waits is told at once that it is overtaken");
  ok(told(2, 6, EO_LANE_RUN) && told(3, 2, EO_LANE_RUN), "the newer task has its place in the queue");
  ok(told(4, 3, EO_LANE_RUN) && told(5, 4, EO_LANE_RUN), "tasks without a token overtake nobody");
  eo_lane_free(lane);
  ok(book.released == book.told, "each overtaken task is released once");
}

static void test_running(void)
{
  struct eo_lane *lane = make_lane(4, true);
  bool closed;
  push(lane, 0, "a", 0, 0, &closed);
  wait_until(&book.held, 1);
  push(lane, 1, "b", 0, 0, &closed);
  push(lane, 2, "a", 0, 0, &closed);
  set_gate(true);
  wait_until(&book.told, 3);
  ok(book.marked, "a task that runs sees that it is overtaken where it wants to");
  eo_lane_free(lane);
}

static void test_waiting(void)
{
  struct eo_lane *lane = make_lane(8, false);
  const struct eo_error failed = {.code = EO_ERROR_INPUT};
  bool closed;
  double start = eo_clock_milliseconds();
  push(lane, 1, "", 11, 1e5, &closed);
  push(lane, 2, "", 12, 1e5, &closed);
  push(lane, 3, "", 13, 50, &closed);
  push(lane, 4, "d", 14, 1e5, &closed);
  push(lane, 5, "d", 0, 0, &closed);
  wait_until(&book.told, 3);
  double waited = eo_clock_milliseconds() - start;
  ok(told(0, 4, EO_LANE_OVERTAKEN) && told(1, 5, EO_LANE_RUN), "a task that waits for a job is overtaken too");
  ok(told(2, 3, EO_LANE_EXPIRED) && waited >= 49, "a task's patience ends after %.0f ms", waited);
  eo_lane_wake(lane, 12, NULL);
  wait_until(&book.told, 4);
  ok(told(3, 2, EO_LANE_RUN) && book.code[3] == EO_OK, "a task has its turn when its job is done");
  eo_lane_wake(lane, 11, &failed);
  wait_until(&book.told, 5);
  ok(told(4, 1, EO_LANE_RUN) && book.code[4] == EO_ERROR_INPUT,
     "a task has its turn when its job failed, with the reason");
  eo_lane_free(lane);
}

static void test_stop(void)
{
  struct eo_lane *lane = make_lane(8, false);
  bool closed = false;
  push(lane, 0, "a", 0, 0, &closed);
  wait_until(&book.held, 1);
  push(lane, 1, "", 0, 0, &closed);
  push(lane, 2, "", 11, 1e5, &closed);
  eo_lane_stop(lane);
  ok(!push(lane, 3, "", 0, 0, &closed) && closed, "a lane that has stopped takes nothing");
  set_gate(true);
  eo_lane_free(lane);
  ok(book.told == 3 && book.marked && told(1, 1, EO_LANE_STOPPED) && told(2, 2, EO_LANE_STOPPED),
     "a lane that stops tells everybody who waits");
}

static struct {
  int count;
  int64_t number[3000], job[3000];
  char last[40];
} heard;

static void hear(void *context, const struct eo_service_event *event)
{
  (void)context;
  heard.number[heard.count] = event->number;
  heard.job[heard.count++] = event->job;
  snprintf(heard.last, sizeof heard.last, "%.*s", (int)event->size, event->text);
}

static void publish(struct eo_events *events, int64_t job)
{
  struct eo_text text = {0};
  eo_text_print(&text, "job %lld", (long long)job);
  eo_events_publish(events, job, &text);
  if (text.data)
    printf("# the text was not taken over\n");
}

static bool consecutive(int64_t first)
{
  for (int i = 0; i < heard.count; i++)
    if (heard.number[i] != first + i)
      return false;
  return true;
}

static void test_events(void)
{
  struct eo_events *events = NULL;
  int64_t all, one, start;
  eo_events_new(&events, &error);
  start = eo_events_newest(events);
  ok(start > 1600000000000 && eo_events_reach(events, start) && !eo_events_reach(events, start - 1) &&
         !eo_events_reach(events, start + 1),
     "numbers of events begin above those of any run before: %lld", (long long)start);
  publish(events, 7);
  eo_events_subscribe(events, 0, start, NULL, 0, hear, NULL, &all, &error);
  ok(heard.count == 1 && heard.number[0] == start + 1 && strcmp(heard.last, "job 7") == 0,
     "a new listener is told first what came before");
  publish(events, 8);
  ok(heard.count == 2 && consecutive(start + 1) && heard.job[1] == 8, "a listener is told then what comes");
  heard.count = 0;
  eo_events_subscribe(events, 8, start, NULL, 0, hear, NULL, &one, &error);
  ok(heard.count == 1 && heard.job[0] == 8, "a listener to one job hears of this one alone");
  ok(eo_events_subscribers(events) == 2, "both listeners are counted");
  eo_events_unsubscribe(events, all);
  publish(events, 7);
  ok(heard.count == 1, "a listener who has left hears nothing");
  eo_events_unsubscribe(events, one);
  eo_events_unsubscribe(events, one);
  for (int i = 0; i < 2 * EO_EVENTS_KEPT; i++)
    publish(events, i);
  int64_t newest = eo_events_newest(events);
  ok(newest == start + 3 + 2 * EO_EVENTS_KEPT && eo_events_published(events) == 3 + 2 * EO_EVENTS_KEPT,
     "all events are counted");
  ok(!eo_events_reach(events, newest - EO_EVENTS_KEPT - 1) && eo_events_reach(events, newest - EO_EVENTS_KEPT),
     "the last %d events are kept", EO_EVENTS_KEPT);
  heard.count = 0;
  eo_events_subscribe(events, 0, newest - EO_EVENTS_KEPT, NULL, 0, hear, NULL, &all, &error);
  ok(heard.count == EO_EVENTS_KEPT && consecutive(newest - EO_EVENTS_KEPT + 1),
     "the events that are kept are told without a gap");
  eo_events_unsubscribe(events, all);
  struct eo_service_event first[2] = {{.job = 1, .text = "{}", .size = 2}, {.job = 2, .text = "{}", .size = 2}};
  heard.count = 0;
  eo_events_subscribe(events, 2, newest - 1, first, 2, hear, NULL, &all, &error);
  ok(heard.count >= 1 && heard.number[0] == newest - 1 && heard.job[0] == 2,
     "a snapshot comes first, under the number it stands for");
  eo_events_free(events);
}

int main(void)
{
  test_overtaking();
  test_running();
  test_waiting();
  test_stop();
  test_events();
  return tap_done();
}
