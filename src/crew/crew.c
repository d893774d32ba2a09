/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crew/crew.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/parallel.h"
#include "crew/message.h"
#include "numerics/gram.h"
#include "numerics/threads.h"

#include <config.h>

enum { WATCH_MS = 50 };

/* Who takes part: */

static void introduce(const struct eo_crew *crew, struct eo_crew_member *member)
{
  memset(member, 0, sizeof *member);
  snprintf(member->program, sizeof member->program, "%s", PACKAGE_STRING);
  snprintf(member->kernel, sizeof member->kernel, "%s", eo_gram_select()->name);
  snprintf(member->blas, sizeof member->blas, "%s", eo_threads_blas_kernel());
  member->threads = crew->place.threads;
}

/* avx2 and avx512 round alike (numerics/gram.h), plain does not. */
static bool rounds_alike(const struct eo_crew_member *one, const struct eo_crew_member *other)
{
  bool plain = strcmp(one->kernel, "plain") == 0, other_plain = strcmp(other->kernel, "plain") == 0;
  return plain == other_plain && strcmp(one->blas, other->blas) == 0;
}

static enum eo_code compare(const struct eo_crew *crew, int rank, struct eo_error *error)
{
  const struct eo_crew_member *own = &crew->member[0], *other = &crew->member[rank];
  if (strcmp(own->program, other->program) != 0)
    return eo_error_set(error, EO_ERROR_INPUT, "", "Rank %d runs %s and rank 0 %s: install one version everywhere.",
                        rank, other->program, own->program);
  if (rounds_alike(own, other))
    return EO_OK;
  return eo_error_set(error, EO_ERROR_INPUT, "",
                      "Rank %d would compute with %s and %s, rank 0 with %s and %s, so numbers would differ in their "
                      "last bits: set GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX512F and OPENBLAS_CORETYPE=Haswell for all "
                      "ranks (mpirun -x).",
                      rank, other->kernel, other->blas, own->kernel, own->blas);
}

static enum eo_code hear_one(struct eo_crew *crew, int *heard, int *idle, struct eo_error *error)
{
  struct eo_crew_letter letter;
  bool there = false;
  enum eo_code code = eo_crew_receive(crew, &there, &letter, error);
  if (!code && there && letter.tag == EO_CREW_HELLO && letter.text.size == sizeof crew->member[0]) {
    memcpy(&crew->member[letter.from], letter.text.data, sizeof crew->member[0]);
    ++*heard;
  }
  eo_text_done(&letter.text);
  *idle = there ? 0 : *idle + 1;
  return code;
}

/* Rank 0 hears from every other one. */
static enum eo_code meet(struct eo_crew *crew, struct eo_error *error)
{
  for (int heard = 1, idle = 0; heard < crew->size;) {
    EO_TRY(hear_one(crew, &heard, &idle, error));
    if (idle > 0)
      eo_crew_rest(idle);
  }
  for (int rank = 1; rank < crew->size; rank++)
    EO_TRY(compare(crew, rank, error));
  return EO_OK;
}

static enum eo_code say_hello(struct eo_crew *crew, struct eo_error *error)
{
  struct eo_crew_member member;
  struct eo_text text = {0};
  introduce(crew, &member);
  eo_text_add_bytes(&text, &member, sizeof member);
  enum eo_code code = eo_crew_send(crew, 0, EO_CREW_HELLO, &text, error);
  eo_text_done(&text);
  return code;
}

void eo_crew_alone(struct eo_crew *crew, const struct eo_crew_place *place)
{
  *crew = (struct eo_crew){.place = *place, .size = 1};
}

enum eo_code eo_crew_begin(struct eo_crew *crew, const struct eo_crew_place *place, struct eo_error *error)
{
  eo_crew_alone(crew, place);
  EO_TRY(eo_ranks_find(&crew->ranks, error));
  if (!crew->ranks)
    return EO_OK;
  if (crew->ranks->begin(&crew->rank, &crew->size)) {
    enum eo_code code = eo_error_set(error, EO_ERROR_FILE, "", "MPI: %.300s.", crew->ranks->message());
    crew->ranks = NULL;
    return code;
  }
  if (crew->rank)
    return say_hello(crew, error);
  crew->member = calloc((size_t)crew->size, sizeof *crew->member);
  if (!crew->member)
    return eo_error_memory(error);
  introduce(crew, &crew->member[0]);
  return meet(crew, error);
}

bool eo_crew_is_led(const struct eo_crew *crew)
{
  return crew->rank > 0;
}

/* Rank 0 has enough to do with giving and taking. */
static bool works_alone(const struct eo_crew *crew)
{
  return crew->size < 2;
}

int eo_crew_strength(const struct eo_crew *crew)
{
  int strength = works_alone(crew) ? crew->place.threads : 0;
  for (int rank = 1; rank < crew->size; rank++)
    strength += crew->member[rank].threads;
  return strength;
}

/* The order at the benches: */

static void close_order(struct eo_crew *crew)
{
  for (int rank = 1; crew->trade && crew->rank == 0 && rank < crew->size; rank++)
    eo_crew_send(crew, rank, EO_CREW_CLOSE, NULL, NULL);
  eo_hands_free(crew->hands);
  eo_text_done(&crew->order);
  crew->hands = NULL;
  crew->trade = NULL;
}

static bool is_open(const struct eo_crew *crew, const struct eo_crew_task *task)
{
  return crew->trade == task->trade && crew->order.size == task->size &&
         memcmp(crew->order.data, task->order, task->size) == 0;
}

static enum eo_code spread_order(struct eo_crew *crew, const struct eo_crew_task *task, struct eo_error *error)
{
  struct eo_crew_parcel parcel = {.order = ++crew->order_number};
  enum eo_code code = EO_OK;
  eo_text_add_bytes(&parcel.text, task->trade->name, strlen(task->trade->name) + 1);
  eo_text_add_bytes(&parcel.text, task->order, task->size);
  if (parcel.text.failed)
    code = eo_error_memory(error);
  for (int rank = 1; !code && rank < crew->size; rank++)
    code = eo_crew_send_parcel(crew, rank, EO_CREW_ORDER, &parcel, error);
  eo_text_done(&parcel.text);
  return code;
}

static enum eo_code open_order(struct eo_crew *crew, const struct eo_crew_task *task, struct eo_error *error)
{
  if (is_open(crew, task))
    return EO_OK;
  close_order(crew);
  eo_text_add_bytes(&crew->order, task->order, task->size);
  if (crew->order.failed)
    return eo_error_memory(error);
  crew->trade = task->trade;
  return works_alone(crew) ? eo_hands_new(&crew->hands, task->trade, task->order, task->size, &crew->place, error)
                           : spread_order(crew, task, error);
}

/* A task on its way: */

struct course {
  struct eo_crew *crew;
  const struct eo_crew_task *task;
  struct eo_hands *hands;      /* of this process alone; else NULL */
  int next, lowest;            /* items: to be given next; not taken yet */
  struct eo_crew_parcel *ring; /* [EO_CREW_AHEAD] answers ahead of the lowest; item: -1 where none is */
  int *load;                   /* [size] items that a rank has */
  int flying, turn;            /* of all ranks; the rank to be looked at first */
  double watched;              /* ms */
};

/* So that no thread waits for the way to rank 0 and back. */
static int most_load(const struct course *course, int rank)
{
  int threads = works_alone(course->crew) ? course->crew->place.threads : course->crew->member[rank].threads;
  return 2 * threads + 1;
}

/* A rank that has room, the one with nothing to do before one that works; -1: none has. */
static int find_room(struct course *course)
{
  int first = works_alone(course->crew) ? 0 : 1, count = course->crew->size - first, best = -1;
  for (int i = 0; i < count; i++) {
    int rank = first + (course->turn + i) % count;
    if (course->load[rank] < most_load(course, rank) && (best < 0 || course->load[rank] < course->load[best]))
      best = rank;
  }
  return best;
}

/* Writes an item and gives it to a rank, or to a thread of this process. */
static enum eo_code hand_over(struct course *course, int rank, struct eo_crew_parcel *parcel, struct eo_error *error)
{
  EO_TRY(course->task->write(course->task->context, course->next, &parcel->text, error));
  if (parcel->text.failed)
    return eo_error_memory(error);
  if (!course->hands)
    return eo_crew_send_parcel(course->crew, rank, EO_CREW_ITEM, parcel, error);
  return eo_hands_give(course->hands, parcel) ? EO_OK : eo_error_memory(error);
}

static enum eo_code give(struct course *course, int rank, struct eo_error *error)
{
  struct eo_crew_parcel parcel = {.order = course->crew->order_number, .item = course->next};
  enum eo_code code = hand_over(course, rank, &parcel, error);
  eo_text_done(&parcel.text);
  EO_TRY(code);
  course->next++;
  course->load[rank]++;
  course->flying++;
  course->turn++;
  return EO_OK;
}

static enum eo_code give_all(struct course *course, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  for (int rank; !code && course->next < course->task->items && course->next - course->lowest < EO_CREW_AHEAD &&
                 (rank = find_room(course)) >= 0;)
    code = give(course, rank, error);
  return code;
}

/* *there: an answer came and lies in the ring. An error of an item waits there for its turn. */
static enum eo_code collect_local(struct course *course, bool *there)
{
  struct eo_crew_parcel parcel;
  *there = eo_hands_collect(course->hands, WATCH_MS, &parcel);
  if (!*there)
    return EO_OK;
  course->ring[parcel.item % EO_CREW_AHEAD] = parcel;
  course->load[0]--;
  course->flying--;
  return EO_OK;
}

static enum eo_code file_answer(struct course *course, const struct eo_crew_letter *letter, struct eo_error *error)
{
  struct eo_crew_parcel parcel;
  if (letter->tag != EO_CREW_ANSWER)
    return EO_OK;
  bool sound = eo_crew_open_parcel(letter, &parcel);
  if (sound && parcel.order != course->crew->order_number) { /* it came too late */
    eo_text_done(&parcel.text);
    return EO_OK;
  }
  if (sound && parcel.item < 0) { /* the order failed there */
    *error = parcel.error;
    return parcel.error.code ? parcel.error.code : EO_ERROR_NUMERIC;
  }
  if (!sound || parcel.item < course->lowest || parcel.item >= course->next) {
    eo_text_done(&parcel.text);
    return eo_error_set(error, EO_ERROR_FILE, "", "Rank %d sent an answer that nobody asked for.", letter->from);
  }
  course->ring[parcel.item % EO_CREW_AHEAD] = parcel;
  course->load[letter->from]--;
  course->flying--;
  return EO_OK;
}

static enum eo_code collect_remote(struct course *course, bool *there, struct eo_error *error)
{
  double until = eo_clock_milliseconds() + WATCH_MS;
  enum eo_code code = EO_OK;
  *there = false;
  for (int idle = 0; !code && !*there && eo_clock_milliseconds() < until; idle++) {
    struct eo_crew_letter letter;
    code = eo_crew_receive(course->crew, there, &letter, error);
    if (!code && *there)
      code = file_answer(course, &letter, error);
    eo_text_done(&letter.text);
    if (!code && !*there)
      eo_crew_rest(idle);
  }
  return code;
}

static enum eo_code collect(struct course *course, bool *there, struct eo_error *error)
{
  return course->hands ? collect_local(course, there) : collect_remote(course, there, error);
}

/* Hands on what lies in order. */
static enum eo_code take_all(struct course *course, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  while (!code && course->lowest < course->next) {
    struct eo_crew_parcel *parcel = &course->ring[course->lowest % EO_CREW_AHEAD];
    if (parcel->item != course->lowest)
      return EO_OK;
    code = parcel->error.code;
    if (code)
      *error = parcel->error;
    else
      code = course->task->take(course->task->context, parcel->item, parcel->text.data ? parcel->text.data : "",
                                parcel->text.size, error);
    eo_text_done(&parcel->text);
    parcel->item = -1;
    course->lowest++;
  }
  return code;
}

static enum eo_code watch(struct course *course, struct eo_error *error)
{
  double now = eo_clock_milliseconds();
  if (!course->task->watch || now - course->watched < WATCH_MS)
    return EO_OK;
  course->watched = now;
  return course->task->watch(course->task->context)
             ? eo_error_set(error, EO_ERROR_CANCELLED, "", "The work was cancelled.")
             : EO_OK;
}

/* Nobody begins anything new; what is under way comes back. */
static void call_off(struct course *course)
{
  struct eo_error ignored;
  if (course->hands)
    eo_hands_stop(course->hands);
  for (int rank = 1; !course->hands && rank < course->crew->size; rank++)
    eo_crew_send(course->crew, rank, EO_CREW_STOP, NULL, NULL);
  for (bool there; course->flying > 0;)
    if (collect(course, &there, &ignored))
      return;
}

static enum eo_code go_through(struct course *course, struct eo_error *error)
{
  while (course->lowest < course->task->items) {
    bool there = false;
    EO_TRY(give_all(course, error));
    EO_TRY(collect(course, &there, error));
    EO_TRY(take_all(course, error));
    EO_TRY(watch(course, error));
  }
  return EO_OK;
}

static enum eo_code run_course(struct course *course, struct eo_error *error)
{
  enum eo_code code = go_through(course, error);
  if (!code)
    return EO_OK;
  call_off(course);
  struct eo_error ignored;
  if (code == EO_ERROR_CANCELLED)
    take_all(course, &ignored); /* until the first that was ended early */
  return code;
}

enum eo_code eo_crew_run(struct eo_crew *crew, const struct eo_crew_task *task, struct eo_error *error)
{
  struct course course = {.crew = crew, .task = task};
  course.load = calloc((size_t)crew->size, sizeof *course.load);
  course.ring = calloc(EO_CREW_AHEAD, sizeof *course.ring);
  enum eo_code code = course.load && course.ring ? EO_OK : eo_error_memory(error);
  for (int i = 0; !code && i < EO_CREW_AHEAD; i++)
    course.ring[i].item = -1;
  if (!code && task->items > 0) {
    code = open_order(crew, task, error);
    course.hands = crew->hands;
    if (!code)
      code = run_course(&course, error);
    if (code)
      close_order(crew); /* its benches were told to stop */
  }
  for (int i = 0; course.ring && i < EO_CREW_AHEAD; i++)
    eo_text_done(&course.ring[i].text);
  free(course.ring);
  free(course.load);
  return code;
}

void eo_crew_end(struct eo_crew *crew)
{
  close_order(crew);
  for (int rank = 1; crew->ranks && crew->rank == 0 && rank < crew->size; rank++)
    eo_crew_send(crew, rank, EO_CREW_HOME, NULL, NULL);
  if (crew->ranks)
    crew->ranks->end();
  free(crew->member);
  *crew = (struct eo_crew){0};
}
