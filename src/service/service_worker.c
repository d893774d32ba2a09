/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The threads that work jobs off. */
#include "service/service_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>

#include "base/clock.h"
#include "service/launcher.h"
#include "variants/variant_job.h"

enum { EVENT_MS = 120, NOTE_MS = 1000, LAUNCH_EVENT_MS = 500, OPTIMIZE_NICE = 10, PREPARE_NICE = 3 };

static bool must_stop(struct eo_service_worker *w)
{
  return atomic_load(&w->cancelled) || atomic_load(&w->service->stopping);
}

static void begin_live(struct eo_service_worker *w, int64_t id)
{
  pthread_mutex_lock(&w->service->live_mutex);
  eo_job_live_done(&w->live);
  atomic_store(&w->cancelled, false);
  w->live.id = id;
  w->live.state = EO_JOB_PREPARING;
  w->live.seconds = w->live.seconds_left = NAN;
  w->launched = w->recorded = false;
  pthread_mutex_unlock(&w->service->live_mutex);
  w->published = w->noted = 0;
}

static void end_live(struct eo_service_worker *w)
{
  pthread_mutex_lock(&w->service->live_mutex);
  eo_job_live_done(&w->live);
  w->launched = false;
  pthread_mutex_unlock(&w->service->live_mutex);
}

/* What is known of the job as text, to be kept with it. */
static void write_live(struct eo_service_worker *w, struct eo_text *text)
{
  pthread_mutex_lock(&w->service->live_mutex);
  eo_job_live_write(&w->live, text);
  pthread_mutex_unlock(&w->service->live_mutex);
}

/* Tells the listeners now and then, and the table more rarely: what it misses is found again from the history. */
static void spread(struct eo_service_worker *w)
{
  double now = eo_clock_milliseconds();
  if (now - w->published < EVENT_MS)
    return;
  w->published = now;
  eo_service_publish(w->service, w->live.id);
  if (now - w->noted < NOTE_MS)
    return;
  w->noted = now;
  struct eo_text text = {0};
  write_live(w, &text);
  if (text.size && !text.failed)
    eo_queue_note(w->store, w->live.id, text.data, NULL);
  eo_text_done(&text);
}

static int follow_preparation(void *context, const char *what, double fraction)
{
  struct eo_service_worker *w = context;
  pthread_mutex_lock(&w->service->live_mutex);
  snprintf(w->live.what, sizeof w->live.what, "%s", what);
  w->live.fraction = fraction;
  pthread_mutex_unlock(&w->service->live_mutex);
  spread(w);
  return must_stop(w);
}

/* A report's numbers are in w->live, which was locked; what the counters had before. */
static int follow_on(struct eo_service_worker *w, int evaluated, int reused)
{
  atomic_fetch_add(&w->service->true_evaluations, w->live.true_evaluations - evaluated);
  atomic_fetch_add(&w->service->reused_evaluations, w->live.reused - reused);
  pthread_mutex_unlock(&w->service->live_mutex);
  spread(w);
  return must_stop(w);
}

static int follow_variants(void *context, const struct eo_variant_report *report)
{
  struct eo_service_worker *w = context;
  pthread_mutex_lock(&w->service->live_mutex);
  int evaluated = w->live.true_evaluations, reused = w->live.reused;
  eo_variant_job_follow(&w->live, report);
  return follow_on(w, evaluated, reused);
}

static int follow_study(void *context, const struct eo_study_report *report)
{
  struct eo_service_worker *w = context;
  pthread_mutex_lock(&w->service->live_mutex);
  int evaluated = w->live.true_evaluations, reused = w->live.reused;
  eo_job_live_follow(&w->live, report);
  return follow_on(w, evaluated, reused);
}

struct task {
  int64_t id;
  bool fresh, stop;
  struct eo_text text;      /* of the design */
  struct eo_design *design; /* owned */
  struct eo_geometry geometry;
  struct eo_held_pair *held;
  struct eo_warnings warnings;
};

static enum eo_code take_job(void *context, const struct eo_stored_job *job, struct eo_error *error)
{
  struct task *task = context;
  task->fresh = job->fresh;
  task->stop = job->stop; /* asked for after it was claimed and before anybody could tell this thread */
  eo_text_add(&task->text, job->design);
  return task->text.failed ? eo_error_memory(error) : EO_OK;
}

static enum eo_code read_design(struct task *task, struct eo_error *error)
{
  task->design = malloc(sizeof *task->design);
  if (!task->design)
    return eo_error_memory(error);
  return eo_design_read(task->text.data ? task->text.data : "", task->text.size, task->design, &task->geometry,
                        &task->warnings, error);
}

static enum eo_code optimize(struct eo_service_worker *w, struct task *task, bool *stopped, struct eo_error *error)
{
  const struct eo_study_plan plan = {.design = task->design,
                                     .pair = eo_held_pair(task->held),
                                     .store = w->store,
                                     .threads = w->service->settings.threads,
                                     .job = task->id,
                                     .fresh = task->fresh,
                                     .watch = follow_study,
                                     .context = w};
  struct eo_study_result result;
  enum eo_code code = eo_study_run(&plan, &result, error);
  *stopped = !code && result.stopped == EO_STOP_CANCELLED;
  pthread_mutex_lock(&w->service->live_mutex);
  if (!code)
    eo_job_live_conclude(&w->live, &result);
  pthread_mutex_unlock(&w->service->live_mutex);
  bool parked = *stopped && !atomic_load(&w->cancelled);
  if (!code && !parked)
    code = eo_study_document(&plan, &result, &task->warnings, NULL, error);
  eo_study_result_done(&result);
  return code;
}

/* On threads of this process; pairs are prepared one after the other, each once. */
static enum eo_code vary(struct eo_service_worker *w, const struct task *task, bool *stopped, struct eo_error *error)
{
  const struct eo_preparation_settings preparation = eo_service_preparation(w->service);
  const struct eo_crew_place place = {.cache = w->service->settings.cache,
                                      .threads = w->service->settings.threads,
                                      .memory = preparation.memory,
                                      .seconds = preparation.seconds};
  struct eo_crew crew;
  struct eo_variant_result result = {0};
  eo_crew_alone(&crew, &place);
  enum eo_code code = eo_variant_job_run(w->store, task->id, &crew, follow_variants, w, &result, error);
  eo_crew_end(&crew);
  *stopped = !code && result.cancelled;
  pthread_mutex_lock(&w->service->live_mutex);
  if (!code)
    eo_variant_job_conclude(&w->live, &result);
  pthread_mutex_unlock(&w->service->live_mutex);
  return code;
}

/* Jobs of a launcher: */

static enum eo_launch_wish watch_launch(void *context)
{
  struct eo_service_worker *w = context;
  double now = eo_clock_milliseconds();
  if (now - w->published >= LAUNCH_EVENT_MS) {
    w->published = now;
    eo_service_publish(w->service, w->live.id);
  }
  return atomic_load(&w->cancelled)           ? EO_LAUNCH_END
         : atomic_load(&w->service->stopping) ? EO_LAUNCH_END_SOON
                                              : EO_LAUNCH_GO_ON;
}

/* What the table says of a job. */
struct state {
  enum eo_job_state state;
  int evaluated, attempts;
};

static enum eo_code take_state(void *context, const struct eo_stored_job *job, struct eo_error *error)
{
  (void)error;
  *(struct state *)context = (struct state){job->state, job->true_evaluations, job->attempts};
  return EO_OK;
}

static enum eo_code find_state(struct eo_service_worker *w, int64_t id, struct state *state, struct eo_error *error)
{
  enum eo_job_outcome outcome;
  return eo_queue_find(w->store, id, take_state, state, &outcome, error);
}

/* A launcher has no tolerance for a rank that dies: the job is begun again while that brings it further. */
static enum eo_code judge_launch(struct eo_service_worker *w, const struct state *before, const struct state *after,
                                 int status, bool *stopped, struct eo_error *error)
{
  switch (after->state) {
  case EO_JOB_DONE:
  case EO_JOB_FAILED:
    w->recorded = true;
    return after->state == EO_JOB_DONE ? EO_OK : eo_error_set(error, EO_ERROR_NUMERIC, "", "See the job.");
  case EO_JOB_CANCELLED:
    *stopped = true;
    return EO_OK;
  default:
    break;
  }
  *stopped = must_stop(w) || after->evaluated > before->evaluated ||
             after->attempts < w->service->settings.limits.attempts;
  return *stopped ? EO_OK
                  : eo_error_set(error, EO_ERROR_NUMERIC, "",
                                 "The launcher ended without a result (%s %d); the server's log has what it said.",
                                 WIFSIGNALED(status) ? "signal" : "status",
                                 WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status));
}

static enum eo_code launch(struct eo_service_worker *w, const struct task *task, bool *stopped, struct eo_error *error)
{
  const struct eo_launch launch = {.launcher = w->service->settings.launcher,
                                   .program = w->service->settings.worker,
                                   .data = w->service->settings.data,
                                   .kind = w->kind,
                                   .job = task->id};
  struct state before = {0}, after = {0};
  int status = 0;
  pthread_mutex_lock(&w->service->live_mutex);
  w->launched = true;
  pthread_mutex_unlock(&w->service->live_mutex);
  EO_TRY(find_state(w, task->id, &before, error));
  EO_TRY(eo_launch_run(&launch, watch_launch, w, &status, error));
  EO_TRY(find_state(w, task->id, &after, error));
  return judge_launch(w, &before, &after, status, stopped, error);
}

static enum eo_code run_job(struct eo_service_worker *w, struct task *task, bool *stopped, struct eo_error *error)
{
  const struct eo_progress progress = {follow_preparation, w};
  enum eo_job_outcome outcome;
  EO_TRY(eo_queue_find(w->store, task->id, take_job, task, &outcome, error));
  if (task->stop)
    atomic_store(&w->cancelled, true);
  if (w->kind != EO_JOB_PREPARE && w->service->settings.launcher)
    return launch(w, task, stopped, error);
  if (w->kind == EO_JOB_STUDY)
    return vary(w, task, stopped, error);
  EO_TRY(read_design(task, error));
  EO_TRY(eo_pairs_obtain(w->service->pairs, task->design, &progress, &task->held, error));
  return w->kind == EO_JOB_OPTIMIZE ? optimize(w, task, stopped, error) : EO_OK;
}

/* A stop that nobody asked for by name is the service's: the job waits for the next one. */
static enum eo_job_state find_end(struct eo_service_worker *w, enum eo_code code, bool stopped)
{
  if (stopped || code == EO_ERROR_CANCELLED)
    return atomic_load(&w->cancelled) ? EO_JOB_CANCELLED : EO_JOB_QUEUED;
  return code ? EO_JOB_FAILED : EO_JOB_DONE;
}

static void end_job(struct eo_service_worker *w, int64_t id, enum eo_job_state state, const struct eo_error *error)
{
  struct eo_text progress = {0}, fault = {0};
  if (w->recorded)
    return;
  pthread_mutex_lock(&w->service->live_mutex);
  if (state == EO_JOB_DONE)
    w->live.fraction = 1;
  pthread_mutex_unlock(&w->service->live_mutex);
  if (!w->launched)
    write_live(w, &progress);
  if (state == EO_JOB_FAILED)
    eo_job_error_write(error, &fault);
  /* a database that fails here leaves the job as begun: the next start of the service queues it again */
  eo_queue_end(w->store, id, state, fault.failed ? NULL : fault.data, progress.failed ? NULL : progress.data, NULL);
  if (w->kind == EO_JOB_PREPARE)
    eo_queue_tidy(w->store, w->service->settings.limits.kept_preparations, NULL);
  eo_text_done(&progress);
  eo_text_done(&fault);
}

/* Those who wait for a preparation have their turn. */
static void wake(struct eo_service *s, int64_t id, enum eo_job_state state, const struct eo_error *error)
{
  struct eo_error why = {0};
  if (state == EO_JOB_FAILED)
    why = *error;
  else if (state == EO_JOB_CANCELLED)
    eo_error_set(&why, EO_ERROR_CANCELLED, "", "The preparation of the gear pair was cancelled.");
  eo_lane_wake(s->analyses, id, &why);
  eo_lane_wake(s->sweeps, id, &why);
  eo_lane_wake(s->works, id, &why);
}

static void tell(struct eo_service *s, int64_t id, enum eo_job_kind kind, const char *what, const char *detail)
{
  pthread_mutex_lock(&s->note_mutex);
  if (s->note)
    s->note(s->note_context, id, eo_store_job_kind_name(kind), what, detail);
  pthread_mutex_unlock(&s->note_mutex);
}

static void work_off(struct eo_service_worker *w, int64_t id)
{
  struct eo_service *s = w->service;
  struct task task = {.id = id};
  struct eo_error error = {0};
  bool stopped = false;
  begin_live(w, id);
  eo_service_publish(s, id);
  tell(s, id, w->kind, "begun", "");
  enum eo_code code = run_job(w, &task, &stopped, &error);
  if (code && !error.code)
    error.code = code;
  enum eo_job_state state = find_end(w, code, stopped);
  pthread_mutex_lock(&s->preparing_mutex);
  end_job(w, id, state, &error);
  end_live(w);
  wake(s, id, state, &error);
  pthread_mutex_unlock(&s->preparing_mutex);
  eo_service_publish(s, id);
  tell(s, id, w->kind, eo_store_job_state_name(state), error.text);
  eo_pairs_release(s->pairs, task.held);
  eo_text_done(&task.text);
  free(task.design);
}

/* Until somebody says that there is work; at most for a while, so that a database that failed is tried again. */
static void wait_for_work(struct eo_service *s, uint64_t *calls)
{
  struct timespec until;
  clock_gettime(CLOCK_MONOTONIC, &until);
  until.tv_sec += 2;
  pthread_mutex_lock(&s->work_mutex);
  while (*calls == s->calls && !atomic_load(&s->stopping))
    if (pthread_cond_timedwait(&s->work, &s->work_mutex, &until))
      break;
  *calls = s->calls;
  pthread_mutex_unlock(&s->work_mutex);
}

/* Now and then, on the thread of preparations: what is no longer to be kept goes. */
static void retain(struct eo_service_worker *w, double *last)
{
  static const double INTERVAL_MS = 600e3;
  const struct eo_service_limits *limits = &w->service->settings.limits;
  double now = eo_clock_milliseconds();
  if (w->kind != EO_JOB_PREPARE || (*last > 0 && now - *last < INTERVAL_MS))
    return;
  *last = now;
  eo_queue_retain(w->store, limits->kept_jobs, limits->kept_predictions_days, NULL); /* tried again the next time */
}

void *eo_service_work(void *argument)
{
  struct eo_service_worker *w = argument;
  struct eo_service *s = w->service;
  uint64_t calls = 0;
  double retained = 0;
  eo_lane_stand_back(w->kind == EO_JOB_PREPARE ? PREPARE_NICE : OPTIMIZE_NICE);
  while (!atomic_load(&s->stopping)) {
    int64_t id;
    enum eo_code code = eo_queue_claim(w->store, w->kind, &id, NULL);
    if (!code && id)
      work_off(w, id);
    else {
      retain(w, &retained);
      wait_for_work(s, &calls);
    }
  }
  return NULL;
}
