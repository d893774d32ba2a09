/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The server's queue and the stored designs on a real database: order, limits, idempotency, every state, many threads,
   revisions, pages. */
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "store/designs.h"
#include "store/evaluations.h"
#include "store/lock.h"
#include "store/queue.h"
#include "support/tap.h"

enum { MOST = 5 };

static struct eo_error error;
static char folder[200];

static struct eo_store *open_store(void)
{
  struct eo_store *store = NULL;
  if (eo_store_open(&store, folder, EO_STORE_WRITE, &error)) {
    printf("Bail out! %s\n", error.text);
    exit(99);
  }
  return store;
}

static void empty(void)
{
  static const char *const names[] = {"easeoff.db", "easeoff.db-wal", "easeoff.db-shm", "easeoff.lock"};
  char name[300];
  for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
    snprintf(name, sizeof name, "%s/%s", folder, names[i]);
    unlink(name);
  }
}

static const char some_hash[] = "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef";
static const char other_hash[] = "f123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef";

static enum eo_job_outcome add_entry(struct eo_store *store, const struct eo_queue_entry *entry, int64_t *id)
{
  enum eo_job_outcome outcome = EO_JOB_OUTCOME_MISSING;
  if (eo_queue_add(store, entry, MOST, id, &outcome, &error))
    printf("# %s\n", error.text);
  return outcome;
}

static int64_t add(struct eo_store *store, int priority)
{
  const struct eo_queue_entry entry = {
      .kind = EO_JOB_OPTIMIZE, .design = "{}", .name = "a job", .algorithm = "ga", .priority = priority};
  int64_t id;
  return add_entry(store, &entry, &id) == EO_JOB_OUTCOME_DONE ? id : 0;
}

static int64_t claim(struct eo_store *store)
{
  int64_t id = -1;
  if (eo_queue_claim(store, EO_JOB_OPTIMIZE, &id, &error))
    printf("# %s\n", error.text);
  return id;
}

struct seen {
  int count;
  int64_t id[50];
  enum eo_job_state state;
  int attempts, priority;
  bool stop, has_result, fresh, started, finished;
  char error[200], progress[200];
};

static enum eo_code see(void *context, const struct eo_stored_job *job, struct eo_error *fault)
{
  struct seen *seen = context;
  (void)fault;
  seen->id[seen->count++] = job->id;
  seen->state = job->state;
  seen->attempts = job->attempts;
  seen->priority = job->priority;
  seen->stop = job->stop;
  seen->fresh = job->fresh;
  seen->has_result = *job->result;
  seen->started = *job->started;
  seen->finished = *job->finished;
  snprintf(seen->error, sizeof seen->error, "%s", job->error);
  snprintf(seen->progress, sizeof seen->progress, "%s", job->progress);
  return EO_OK;
}

static struct seen look(struct eo_store *store, int64_t id)
{
  struct seen seen = {0};
  enum eo_job_outcome outcome;
  if (eo_queue_find(store, id, see, &seen, &outcome, &error))
    printf("# %s\n", error.text);
  return seen;
}

static void test_order(void)
{
  struct eo_store *store = open_store();
  int64_t low = add(store, -1), first = add(store, 0), second = add(store, 0), high = add(store, 3);
  ok(low && first && second && high && claim(store) == high && claim(store) == first && claim(store) == second &&
         claim(store) == low,
     "the queue gives the highest priority first, then the oldest");
  ok(claim(store) == 0, "an empty queue gives nothing");
  struct seen seen = look(store, high);
  ok(seen.state == EO_JOB_PREPARING && seen.attempts == 1 && seen.started && !seen.finished,
     "a claimed job is preparing");
  ok(!eo_queue_note(store, high, "{\"fraction\":0.5}", &error) &&
         strcmp(look(store, high).progress, "{\"fraction\":0.5}") == 0,
     "a claimed job tells how far it is");
  ok(!eo_queue_end(store, high, EO_JOB_FAILED, "{\"detail\":\"no\"}", NULL, &error), "a claimed job fails");
  seen = look(store, high);
  ok(seen.state == EO_JOB_FAILED && seen.finished && strcmp(seen.error, "{\"detail\":\"no\"}") == 0 && *seen.progress,
     "a failed job has its reason and what it knew");
  ok(!eo_queue_end(store, first, EO_JOB_QUEUED, NULL, NULL, &error) && claim(store) == first &&
         look(store, first).attempts == 2,
     "a job that is put back comes again");
  eo_store_close(store);
}

static void test_full(void)
{
  struct eo_store *store = open_store();
  int64_t id, job = 0;
  while ((id = add(store, 0)))
    job = id;
  const struct eo_queue_entry entry = {.kind = EO_JOB_OPTIMIZE, .design = "{}", .name = "", .algorithm = "ga"};
  ok(add_entry(store, &entry, &id) == EO_JOB_OUTCOME_FULL && id == 0, "a full queue takes no more");
  enum eo_job_outcome outcome;
  ok(!eo_queue_clone(store, job, NULL, MOST, &id, &outcome, &error) && outcome == EO_JOB_OUTCOME_FULL,
     "a full queue takes no copies either");
  int64_t count[EO_JOB_STATES];
  ok(!eo_queue_count(store, count, &error) && count[EO_JOB_QUEUED] == MOST && count[EO_JOB_FAILED] == 0,
     "a full queue holds as many jobs as it may");
  claim(store);
  ok(add(store, 0) != 0, "a job that was begun makes room for another");
  const struct eo_queue_entry other = {
      .kind = EO_JOB_PREPARE, .design = "{}", .name = "", .algorithm = "", .pair = some_hash};
  ok(add_entry(store, &other, &id) == EO_JOB_OUTCOME_DONE && id, "preparations have a limit of their own");
  eo_store_close(store);
}

static void test_idempotency(void)
{
  struct eo_store *store = open_store();
  struct eo_queue_entry entry = {
      .kind = EO_JOB_OPTIMIZE, .design = "{}", .name = "", .algorithm = "ga", .key = "once", .request = some_hash};
  int64_t one, two, three;
  ok(add_entry(store, &entry, &one) == EO_JOB_OUTCOME_DONE &&
         add_entry(store, &entry, &two) == EO_JOB_OUTCOME_REPEATED && two == one,
     "the same request under the same key is the same job");
  entry.request = other_hash;
  ok(add_entry(store, &entry, &three) == EO_JOB_OUTCOME_CONFLICT, "another request under this key is refused");
  entry.key = "twice";
  ok(add_entry(store, &entry, &three) == EO_JOB_OUTCOME_DONE && three != one,
     "the same request under another key is another job");
  claim(store);
  eo_queue_end(store, one, EO_JOB_DONE, NULL, NULL, &error);
  entry.key = "once";
  entry.request = some_hash;
  ok(add_entry(store, &entry, &two) == EO_JOB_OUTCOME_REPEATED && two == one,
     "the same request under the same key is the same job after it has ended");
  enum eo_job_outcome outcome;
  ok(!eo_queue_remove(store, one, &outcome, &error) && !outcome &&
         add_entry(store, &entry, &two) == EO_JOB_OUTCOME_DONE && two != one,
     "a removed job frees its key");
  eo_store_close(store);
}

static void test_preparations(void)
{
  struct eo_store *store = open_store();
  struct eo_queue_entry entry = {
      .kind = EO_JOB_PREPARE, .design = "{}", .name = "", .algorithm = "", .pair = some_hash};
  int64_t one, two, id;
  enum eo_job_outcome outcome;
  add_entry(store, &entry, &one);
  ok(add_entry(store, &entry, &two) == EO_JOB_OUTCOME_DONE && two == one, "a pair that waits is not queued again");
  ok(claim(store) == 0 && !eo_queue_claim(store, EO_JOB_PREPARE, &id, &error) && id == one,
     "each kind of job has its own line");
  ok(add_entry(store, &entry, &two) == EO_JOB_OUTCOME_DONE && two == one,
     "a pair that is being prepared is not queued again");
  eo_queue_cancel(store, one, &outcome, &error);
  ok(add_entry(store, &entry, &two) == EO_JOB_OUTCOME_DONE && two != one,
     "a pair whose preparation was told to stop is queued again");
  for (int i = 0; i < 4; i++) {
    eo_queue_claim(store, EO_JOB_PREPARE, &id, &error);
    eo_queue_end(store, id, EO_JOB_DONE, NULL, NULL, &error);
    add_entry(store, &entry, &two);
  }
  int64_t before[EO_JOB_STATES], after[EO_JOB_STATES];
  eo_queue_count(store, before, &error);
  ok(!eo_queue_tidy(store, 2, &error) && !eo_queue_count(store, after, &error) && before[EO_JOB_DONE] == 4 &&
         after[EO_JOB_DONE] == 2,
     "jobs that have ended are swept up, but for two");
  eo_store_close(store);
}

static const enum eo_job_state every_state[] = {EO_JOB_QUEUED, EO_JOB_PREPARING, EO_JOB_DONE, EO_JOB_FAILED,
                                                EO_JOB_CANCELLED};

static int64_t make(struct eo_store *store, enum eo_job_state state)
{
  int64_t id = add(store, 10);
  if (state == EO_JOB_QUEUED)
    return id;
  while (claim(store) != id)
    ;
  if (state != EO_JOB_PREPARING)
    eo_queue_end(store, id, state, state == EO_JOB_FAILED ? "{}" : NULL, NULL, &error);
  return id;
}

static void test_states(void)
{
  struct eo_store *store = open_store();
  enum eo_job_outcome outcome;
  for (size_t i = 0; i < sizeof every_state / sizeof every_state[0]; i++) {
    enum eo_job_state state = every_state[i];
    const char *name = eo_store_job_state_name(state);
    bool ended = state == EO_JOB_DONE || state == EO_JOB_FAILED || state == EO_JOB_CANCELLED;
    int64_t id = make(store, state), copy;
    ok(!eo_queue_clone(store, id, &(int){7}, MOST, &copy, &outcome, &error) && !outcome &&
           look(store, copy).priority == 7 && look(store, copy).state == EO_JOB_QUEUED,
       "%s: a copy of the job waits", name);
    eo_queue_cancel(store, copy, &outcome, &error);
    ok(!eo_queue_cancel(store, id, &outcome, &error) && outcome == (ended ? EO_JOB_OUTCOME_STATE : EO_JOB_OUTCOME_DONE),
       "%s: the job is cancelled unless it has ended", name);
    enum eo_job_state then = state == EO_JOB_QUEUED ? EO_JOB_CANCELLED : state;
    ok(look(store, id).state == then && look(store, id).stop == !ended, "%s: the job is then %s", name,
       eo_store_job_state_name(then));
    bool retried = then == EO_JOB_FAILED || then == EO_JOB_CANCELLED;
    ok(!eo_queue_retry(store, id, MOST, &outcome, &error) &&
           outcome == (retried ? EO_JOB_OUTCOME_DONE : EO_JOB_OUTCOME_STATE),
       "%s: the job is tried again if it has failed or was cancelled", name);
    ok(!retried || (look(store, id).state == EO_JOB_QUEUED && !look(store, id).stop && !*look(store, id).error),
       "%s: a job that is tried again begins anew", name);
    ok(!eo_queue_remove(store, id, &outcome, &error) &&
           outcome == (then == EO_JOB_DONE ? EO_JOB_OUTCOME_DONE : EO_JOB_OUTCOME_STATE),
       "%s: the job is removed if it is done", name);
    while (claim(store))
      ;
  }
  ok(!eo_queue_cancel(store, 9999, &outcome, &error) && outcome == EO_JOB_OUTCOME_MISSING &&
         !eo_queue_retry(store, 9999, MOST, &outcome, &error) && outcome == EO_JOB_OUTCOME_MISSING &&
         !eo_queue_remove(store, 9999, &outcome, &error) && outcome == EO_JOB_OUTCOME_MISSING,
     "a job that is not there is told as missing");
  eo_store_close(store);
}

/* What a process that is gone had begun. */
static void test_recovery(void)
{
  struct eo_store *store = open_store(), *terminal = open_store();
  enum eo_job_outcome outcome;
  int64_t queued, begun = make(store, EO_JOB_PREPARING), stopping = make(store, EO_JOB_PREPARING),
                  parked = make(store, EO_JOB_CANCELLED), unwritten = make(store, EO_JOB_DONE),
                  written = make(store, EO_JOB_DONE), taken = make(store, EO_JOB_PREPARING),
                  failed = make(store, EO_JOB_FAILED);
  bool there = false;
  eo_store_keep_result(store, written, "{}", &error);
  eo_queue_cancel(store, stopping, &outcome, &error);
  eo_store_claim_job(terminal, taken, &there, &error);
  ok(!eo_queue_recover(store, 3, "{}", &queued, &error) && queued == 4, "a start looks after %lld jobs",
     (long long)queued);
  ok(look(store, begun).state == EO_JOB_QUEUED, "a job that was begun waits again after a start");
  ok(look(store, stopping).state == EO_JOB_CANCELLED && look(store, stopping).finished,
     "a job that was to be stopped is cancelled by a start");
  ok(look(store, parked).state == EO_JOB_QUEUED, "a job that was being parked waits again after a start");
  ok(look(store, unwritten).state == EO_JOB_QUEUED && look(store, written).state == EO_JOB_DONE,
     "a job without its result waits again after a start, one with it does not");
  ok(look(store, taken).state == EO_JOB_PREPARING && look(store, failed).state == EO_JOB_FAILED,
     "a start leaves what a terminal works on and what failed");
  eo_store_close(store);
  eo_store_close(terminal);
}

/* One process after another ends in the middle of it. */
static void test_unclean(void)
{
  struct eo_store *store = open_store();
  enum eo_job_outcome outcome;
  int64_t queued, id = add(store, 10);
  for (int i = 0; i < 3; i++) {
    ok(claim(store) == id, "attempt %d claims the job", i + 1);
    eo_queue_recover(store, 3, "{\"detail\": \"thrice\"}", &queued, &error);
  }
  struct seen seen = look(store, id);
  ok(seen.state == EO_JOB_FAILED && seen.finished && strstr(seen.error, "thrice"),
     "a job that comes no further has failed after three attempts: %s", seen.error);
  ok(!eo_queue_retry(store, id, MOST, &outcome, &error) && outcome == EO_JOB_OUTCOME_DONE && claim(store) == id,
     "a job that comes no further can be tried again");
  eo_queue_recover(store, 3, "{}", &queued, &error);
  ok(look(store, id).state == EO_JOB_QUEUED, "a job that is tried again has three attempts");
  eo_queue_cancel(store, id, &outcome, &error);
  eo_store_close(store);
}

static void test_retention(void)
{
  struct eo_store *store = open_store();
  int64_t id[5];
  for (int i = 0; i < 5; i++)
    id[i] = make(store, i == 4 ? EO_JOB_PREPARING : EO_JOB_DONE);
  ok(!eo_queue_retain(store, 0, 0, &error) && look(store, id[0]).count,
     "all jobs are kept unless somebody says otherwise");
  ok(!eo_queue_retain(store, 2, 0, &error) && !look(store, id[1]).count && look(store, id[2]).count &&
         look(store, id[3]).count && look(store, id[4]).count,
     "the newest two jobs that have ended are kept, and one that has not");
  eo_store_close(store);
}

static int64_t add_problem(struct eo_store *store)
{
  const struct eo_stored_problem problem = {
      .hash = some_hash, .spec = "{}", .name = "", .evaluator = 1, .scenarios = 1, .cases = 1};
  int64_t id = 0;
  eo_store_find_problem(store, &problem, &id, &error);
  return id;
}

static enum eo_code log_one(struct eo_store *store, int64_t problem, int64_t job)
{
  struct eo_objective_case raw = {.peak_to_peak = 1, .impact = 1, .rms = 1, .contact_pressure = 1, .root_stress = 1};
  struct eo_stored_evaluation row = {.modification = "{}", .scenarios = 1, .cases = 1, .raw = &raw};
  const double x = 0.5;
  struct eo_stored_candidate candidate = {.job = job, .x = &x, .size = 1};
  enum eo_code code = eo_store_add_evaluation(store, problem, &row, &error);
  candidate.evaluation = row.id;
  return code ? code : eo_store_log_candidate(store, &candidate, &error);
}

static enum eo_code count_step(void *context, const struct eo_stored_candidate *candidate, struct eo_error *fault)
{
  (void)candidate;
  (void)fault;
  ++*(int *)context;
  return EO_OK;
}

static void test_begin(void)
{
  struct eo_store *store = open_store(), *other = open_store();
  int64_t id = make(store, EO_JOB_PREPARING), problem = add_problem(store);
  struct eo_stored_job job = {.id = 4711, .problem = problem, .study = some_hash, .space = some_hash};
  bool resumed = true;
  int steps = 0;
  ok(eo_store_begin_job(store, &job, &resumed, &error) == EO_ERROR_INPUT && strstr(error.text, "no job"),
     "a job that is not there does not begin: %s", error.text);
  job.id = id;
  ok(!eo_store_begin_job(store, &job, &resumed, &error) && !resumed && job.import_upto == 0 &&
         look(store, id).state == EO_JOB_RUNNING,
     "a job begins");
  ok(eo_store_begin_job(other, &job, &resumed, &error) == EO_ERROR_INPUT && strstr(error.text, "Another process"),
     "a job does not begin twice: %s", error.text);
  ok(!log_one(store, problem, id), "a job that runs logs a row");
  ok(!eo_store_begin_job(store, &job, &resumed, &error) && resumed && job.import_upto == 0,
     "a job taken up as the same study goes on with what it knew");
  job.study = other_hash;
  ok(!eo_store_begin_job(store, &job, &resumed, &error) && !resumed && job.import_upto == 1 &&
         !eo_store_each_candidate(store, id, count_step, &steps, &error) && steps == 0,
     "a job taken up as another study forgets its path");
  eo_store_close(other);
  eo_store_close(store);
}

enum { THREADS = 4, JOBS = 200 };
static int taken_by[JOBS + 1][THREADS];
static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;

static void *claim_all(void *context)
{
  int number = *(int *)context;
  pthread_mutex_lock(&mutex); /* error is shared */
  struct eo_store *store = open_store();
  pthread_mutex_unlock(&mutex);
  int64_t id = 1;
  struct eo_error own;
  while (!eo_queue_claim(store, EO_JOB_OPTIMIZE, &id, &own) && id)
    taken_by[id][number]++;
  eo_store_close(store);
  return NULL;
}

static void test_threads(void)
{
  struct eo_store *store = open_store();
  const struct eo_queue_entry entry = {.kind = EO_JOB_OPTIMIZE, .design = "{}", .name = "", .algorithm = "ga"};
  enum eo_job_outcome outcome;
  int64_t id;
  pthread_t thread[THREADS];
  int number[THREADS], once = 0;
  for (int i = 0; i < JOBS; i++)
    eo_queue_add(store, &entry, JOBS, &id, &outcome, &error);
  for (int i = 0; i < THREADS; i++) {
    number[i] = i;
    pthread_create(&thread[i], NULL, claim_all, &number[i]);
  }
  for (int i = 0; i < THREADS; i++)
    pthread_join(thread[i], NULL);
  for (int job = 1; job <= JOBS; job++) {
    int times = 0;
    for (int i = 0; i < THREADS; i++)
      times += taken_by[job][i];
    once += times == 1;
  }
  ok(once == JOBS, "%d threads claim %d of %d jobs exactly once", THREADS, once, JOBS);
  eo_store_close(store);
}

static void test_pages(void)
{
  struct eo_store *store = open_store();
  struct seen seen = {0};
  for (int i = 0; i < 4; i++)
    add(store, 0);
  int64_t newest = make(store, EO_JOB_DONE);
  struct eo_queue_filter filter = {.state = -1, .kind = -1, .limit = 2};
  eo_store_keep_result(store, newest, "{}", &error);
  ok(!eo_queue_list(store, &filter, see, &seen, &error) && seen.count == 2 && seen.id[0] == newest &&
         seen.id[1] == newest - 1,
     "a list of jobs has the newest first");
  seen = (struct seen){0};
  filter.before = newest - 1;
  filter.limit = 10;
  ok(!eo_queue_list(store, &filter, see, &seen, &error) && seen.count == 3 && seen.id[0] == newest - 2,
     "a list of jobs goes on page by page");
  filter = (struct eo_queue_filter){.state = EO_JOB_DONE, .kind = -1, .limit = 10};
  seen = (struct seen){0};
  ok(!eo_queue_list(store, &filter, see, &seen, &error) && seen.count == 1 && seen.id[0] == newest && seen.has_result,
     "a list of jobs is chosen by state");
  filter = (struct eo_queue_filter){.state = -1, .kind = EO_JOB_PREPARE, .limit = 10};
  seen = (struct seen){0};
  ok(!eo_queue_list(store, &filter, see, &seen, &error) && seen.count == 0, "a list of jobs is chosen by kind");
  filter = (struct eo_queue_filter){.state = -1, .kind = -1, .active = true, .limit = 10};
  ok(!eo_queue_list(store, &filter, see, &seen, &error) && seen.count == 4,
     "a list of jobs is chosen by those that have not ended");
  eo_store_close(store);
}

static void test_server_lock(void)
{
  struct eo_store *one = open_store(), *two = open_store();
  bool first = false, second = true;
  eo_store_claim_server(one, &first, &error);
  eo_store_claim_server(two, &second, &error);
  ok(first && !second, "one server at a time has the database");
  eo_store_close(one);
  eo_store_claim_server(two, &second, &error);
  ok(second, "another server has the database once the first is gone");
  eo_store_close(two);
}

struct seen_design {
  int count;
  int64_t id[20], revision;
  char name[50], document[50], created[40], updated[40];
};

static enum eo_code see_design(void *context, const struct eo_stored_design *design, struct eo_error *fault)
{
  struct seen_design *seen = context;
  (void)fault;
  seen->id[seen->count++] = design->id;
  seen->revision = design->revision;
  snprintf(seen->name, sizeof seen->name, "%s", design->name);
  snprintf(seen->document, sizeof seen->document, "%s", design->document);
  snprintf(seen->created, sizeof seen->created, "%s", design->created);
  snprintf(seen->updated, sizeof seen->updated, "%s", design->updated);
  return EO_OK;
}

static void test_designs(void)
{
  struct eo_store *store = open_store();
  struct seen_design seen = {0};
  enum eo_design_outcome outcome;
  ok(!eo_store_add_design(store, "one", "{\"a\":1}", 3, see_design, &seen, &outcome, &error) &&
         outcome == EO_DESIGN_DONE && seen.revision == 1 && strcmp(seen.name, "one") == 0 && strlen(seen.created) == 24,
     "a design is stored: %s", seen.created);
  int64_t id = seen.id[0];
  ok(eo_store_add_design(store, "bad", "{", 3, NULL, NULL, &outcome, &error) == EO_ERROR_FILE,
     "a design that is no JSON is not stored");
  ok(!eo_store_change_design(store, id, 1, "two", "{}", see_design, &seen, &outcome, &error) &&
         outcome == EO_DESIGN_DONE && seen.revision == 2 && strcmp(seen.name, "two") == 0 &&
         strcmp(seen.document, "{}") == 0,
     "a stored design is changed");
  ok(!eo_store_change_design(store, id, 1, "three", "{}", see_design, &seen, &outcome, &error) &&
         outcome == EO_DESIGN_STALE && seen.revision == 2 && strcmp(seen.name, "two") == 0,
     "a stored design is not changed over a change that was not seen");
  ok(!eo_store_change_design(store, id, 0, "three", "{}", NULL, NULL, &outcome, &error) && outcome == EO_DESIGN_DONE,
     "a stored design is changed whatever it is where that is asked");
  ok(!eo_store_change_design(store, 77, 1, "x", "{}", NULL, NULL, &outcome, &error) && outcome == EO_DESIGN_MISSING,
     "a design that is not there is not changed");
  eo_store_add_design(store, "b", "{}", 3, NULL, NULL, &outcome, &error);
  eo_store_add_design(store, "c", "{}", 3, NULL, NULL, &outcome, &error);
  ok(!eo_store_add_design(store, "d", "{}", 3, NULL, NULL, &outcome, &error) && outcome == EO_DESIGN_FULL,
     "a design above the limit is not stored");
  seen = (struct seen_design){0};
  ok(!eo_store_list_designs(store, 0, 2, see_design, &seen, &error) && seen.count == 2 && seen.id[0] > seen.id[1],
     "a list of designs has the newest first");
  int64_t last = seen.id[1];
  ok(!eo_store_list_designs(store, last, 2, see_design, &seen, &error) && seen.count == 3 && seen.id[2] == id,
     "a list of designs goes on page by page");
  ok(!eo_store_remove_design(store, id, 2, &outcome, &error) && outcome == EO_DESIGN_STALE &&
         !eo_store_remove_design(store, id, 3, &outcome, &error) && outcome == EO_DESIGN_DONE,
     "a design is removed in the revision that was seen");
  ok(!eo_store_find_design(store, id, see_design, &seen, &outcome, &error) && outcome == EO_DESIGN_MISSING &&
         !eo_store_remove_design(store, id, 0, &outcome, &error) && outcome == EO_DESIGN_MISSING,
     "a removed design is gone");
  seen = (struct seen_design){0};
  eo_store_add_design(store, "e", "{}", 3, see_design, &seen, &outcome, &error);
  ok(seen.id[0] > id + 2, "the number of a removed design is not used again");
  eo_store_close(store);
}

int main(void)
{
  void (*const test[])(void) = {test_order,    test_full,        test_idempotency, test_preparations, test_states,
                                test_recovery, test_unclean,     test_retention,   test_begin,        test_threads,
                                test_pages,    test_server_lock, test_designs};
  snprintf(folder, sizeof folder, "%s/easeoff-queue-XXXXXX", getenv("TMPDIR") ? getenv("TMPDIR") : "/tmp");
  if (!mkdtemp(folder))
    return 99;
  for (size_t i = 0; i < sizeof test / sizeof test[0]; i++) {
    empty();
    test[i]();
  }
  empty();
  rmdir(folder);
  return tap_done();
}
