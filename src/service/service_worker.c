/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The threads that work jobs off. */
#include "service/service_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>

#include "base/clock.h"
#include "reproduction/reproduction_job.h"
#include "service/launcher.h"
#include "store/spare.h"
#include "study/tolerance_job.h"
#include "variants/variant_job.h"

enum { EVENT_MS = 120, NOTE_MS = 1000, LAUNCH_EVENT_MS = 500, OPTIMIZE_NICE = 10, PREPARE_NICE = 3 };

static bool must_stop(struct eo_service_worker *worker)
{
  return atomic_load(&worker->cancelled) || atomic_load(&worker->service->stopping);
}

static void begin_live(struct eo_service_worker *worker, int64_t id)
{
  pthread_mutex_lock(&worker->service->live_mutex);
  eo_job_live_done(&worker->live);
  atomic_store(&worker->cancelled, false);
  worker->live.id = id;
  worker->live.state = EO_JOB_PREPARING;
  worker->live.seconds = worker->live.seconds_left = NAN;
  worker->launched = worker->recorded = false;
  pthread_mutex_unlock(&worker->service->live_mutex);
  worker->published = worker->noted = 0;
}

static void end_live(struct eo_service_worker *worker)
{
  pthread_mutex_lock(&worker->service->live_mutex);
  eo_job_live_done(&worker->live);
  worker->launched = false;
  pthread_mutex_unlock(&worker->service->live_mutex);
}

/* What is known of the job as text, to be kept with it. */
static void write_live(struct eo_service_worker *worker, struct eo_text *text)
{
  pthread_mutex_lock(&worker->service->live_mutex);
  eo_job_live_write(&worker->live, text);
  pthread_mutex_unlock(&worker->service->live_mutex);
}

/* Tells the listeners now and then, and the table more rarely: what it misses is found again from the history. */
static void spread(struct eo_service_worker *worker)
{
  double now = eo_clock_milliseconds();
  if (now - worker->published < EVENT_MS)
    return;
  worker->published = now;
  eo_service_publish(worker->service, worker->live.id);
  if (now - worker->noted < NOTE_MS)
    return;
  worker->noted = now;
  struct eo_text text = {0};
  write_live(worker, &text);
  if (text.size && !text.failed)
    eo_queue_note(worker->store, worker->live.id, text.data, NULL);
  eo_text_done(&text);
}

static int follow_preparation(void *context, const char *what, double fraction)
{
  struct eo_service_worker *worker = context;
  pthread_mutex_lock(&worker->service->live_mutex);
  snprintf(worker->live.what, sizeof worker->live.what, "%s", what);
  worker->live.fraction = fraction;
  pthread_mutex_unlock(&worker->service->live_mutex);
  spread(worker);
  return must_stop(worker);
}

/* A report's numbers are in w->live, which was locked; what the counters had before. */
static int follow_on(struct eo_service_worker *worker, int evaluated, int reused)
{
  atomic_fetch_add(&worker->service->true_evaluations, worker->live.true_evaluations - evaluated);
  atomic_fetch_add(&worker->service->reused_evaluations, worker->live.reused - reused);
  pthread_mutex_unlock(&worker->service->live_mutex);
  spread(worker);
  return must_stop(worker);
}

static int follow_variants(void *context, const struct eo_variant_report *report)
{
  struct eo_service_worker *worker = context;
  pthread_mutex_lock(&worker->service->live_mutex);
  int evaluated = worker->live.true_evaluations, reused = worker->live.reused;
  eo_variant_job_follow(&worker->live, report);
  return follow_on(worker, evaluated, reused);
}

static int follow_pairs(void *context, const struct eo_tolerance_progress *progress)
{
  struct eo_service_worker *worker = context;
  pthread_mutex_lock(&worker->service->live_mutex);
  int evaluated = worker->live.true_evaluations, reused = worker->live.reused;
  eo_tolerance_job_follow(&worker->live, progress);
  return follow_on(worker, evaluated, reused);
}

static int follow_study(void *context, const struct eo_study_report *report)
{
  struct eo_service_worker *worker = context;
  pthread_mutex_lock(&worker->service->live_mutex);
  int evaluated = worker->live.true_evaluations, reused = worker->live.reused;
  eo_job_live_follow(&worker->live, report);
  return follow_on(worker, evaluated, reused);
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

static enum eo_code optimize(struct eo_service_worker *worker, struct task *task, bool *stopped, struct eo_error *error)
{
  const struct eo_study_plan plan = {.design = task->design,
                                     .pair = eo_held_pair(task->held),
                                     .store = worker->store,
                                     .threads = worker->service->settings.threads,
                                     .job = task->id,
                                     .fresh = task->fresh,
                                     .watch = follow_study,
                                     .context = worker};
  struct eo_study_result result;
  enum eo_code code = eo_study_run(&plan, &result, error);
  *stopped = !code && result.stopped == EO_STOP_CANCELLED;
  pthread_mutex_lock(&worker->service->live_mutex);
  if (!code)
    eo_job_live_conclude(&worker->live, &result);
  pthread_mutex_unlock(&worker->service->live_mutex);
  bool parked = *stopped && !atomic_load(&worker->cancelled);
  if (!code && !parked)
    code = eo_study_document(&plan, &result, &task->warnings, NULL, error);
  eo_study_result_done(&result);
  return code;
}

/* On threads of this process; pairs are prepared one after the other, each once. */
static enum eo_code vary(struct eo_service_worker *worker, const struct task *task, bool *stopped,
                         struct eo_error *error)
{
  const struct eo_preparation_settings preparation = eo_service_preparation(worker->service);
  const struct eo_crew_place place = {.cache = worker->service->settings.cache,
                                      .threads = worker->service->settings.threads,
                                      .memory = preparation.memory,
                                      .seconds = preparation.seconds};
  struct eo_crew crew;
  struct eo_variant_result result = {0};
  eo_crew_alone(&crew, &place);
  enum eo_code code = eo_variant_job_run(worker->store, task->id, &crew, follow_variants, worker, &result, error);
  eo_crew_end(&crew);
  *stopped = !code && result.cancelled;
  pthread_mutex_lock(&worker->service->live_mutex);
  if (!code)
    eo_variant_job_conclude(&worker->live, &result);
  pthread_mutex_unlock(&worker->service->live_mutex);
  return code;
}

static bool is_given_up(void *context)
{
  return atomic_load(&((struct eo_service_worker *)context)->cancelled);
}

static enum eo_code draw_pairs(struct eo_service_worker *worker, const struct task *task, bool *stopped,
                               struct eo_error *error)
{
  const struct eo_tolerance_job job = {.store = worker->store,
                                       .job = task->id,
                                       .design = task->design,
                                       .warnings = &task->warnings,
                                       .pair = eo_held_pair(task->held),
                                       .threads = worker->service->settings.threads,
                                       .watch = follow_pairs,
                                       .is_given_up = is_given_up,
                                       .context = worker};
  struct eo_tolerance_outcome outcome;
  enum eo_code code = eo_tolerance_job_run(&job, &outcome, error);
  *stopped = !code && outcome.cancelled;
  pthread_mutex_lock(&worker->service->live_mutex);
  if (!code)
    eo_tolerance_job_conclude(&worker->live, &outcome);
  pthread_mutex_unlock(&worker->service->live_mutex);
  return code;
}

static int follow_reproduction(void *context, const char *what, double fraction)
{
  struct eo_service_worker *worker = context;
  pthread_mutex_lock(&worker->service->live_mutex);
  eo_reproduction_job_follow(&worker->live, what, fraction);
  pthread_mutex_unlock(&worker->service->live_mutex);
  spread(worker);
  return must_stop(worker);
}

static enum eo_code reproduce(struct eo_service_worker *worker, const struct task *task, struct eo_error *error)
{
  const struct eo_progress progress = {follow_reproduction, worker};
  const struct eo_reproduction_job job = {.store = worker->store,
                                          .job = task->id,
                                          .pair = eo_held_pair(task->held),
                                          .threads = worker->service->settings.threads,
                                          .progress = &progress};
  return eo_reproduction_job_run(&job, error);
}

/* Jobs of a launcher: */

static enum eo_launch_wish watch_launch(void *context)
{
  struct eo_service_worker *worker = context;
  double now = eo_clock_milliseconds();
  if (now - worker->published >= LAUNCH_EVENT_MS) {
    worker->published = now;
    eo_service_publish(worker->service, worker->live.id);
  }
  return atomic_load(&worker->cancelled)           ? EO_LAUNCH_END
         : atomic_load(&worker->service->stopping) ? EO_LAUNCH_END_SOON
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

static enum eo_code find_state(struct eo_service_worker *worker, int64_t id, struct state *state,
                               struct eo_error *error)
{
  enum eo_job_outcome outcome;
  return eo_queue_find(worker->store, id, take_state, state, &outcome, error);
}

/* A launcher has no tolerance for a rank that dies: the job is begun again while that brings it further. */
static enum eo_code judge_launch(struct eo_service_worker *worker, const struct state *before,
                                 const struct state *after, int status, bool *stopped, struct eo_error *error)
{
  switch (after->state) {
  case EO_JOB_DONE:
  case EO_JOB_FAILED:
    worker->recorded = true;
    return after->state == EO_JOB_DONE ? EO_OK : eo_error_set(error, EO_ERROR_NUMERIC, "", "See the job.");
  case EO_JOB_CANCELLED:
    *stopped = true;
    return EO_OK;
  default:
    break;
  }
  *stopped = must_stop(worker) || after->evaluated > before->evaluated ||
             after->attempts < worker->service->settings.limits.attempts;
  return *stopped ? EO_OK
                  : eo_error_set(error, EO_ERROR_NUMERIC, "",
                                 "The launcher ended without a result (%s %d); the server's log has what it said.",
                                 WIFSIGNALED(status) ? "signal" : "status",
                                 WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status));
}

static enum eo_code launch(struct eo_service_worker *worker, const struct task *task, bool *stopped,
                           struct eo_error *error)
{
  const struct eo_launch launch = {.launcher = worker->service->settings.launcher,
                                   .program = worker->service->settings.worker,
                                   .data = worker->service->settings.data,
                                   .kind = worker->kind,
                                   .job = task->id};
  struct state before = {0}, after = {0};
  int status = 0;
  pthread_mutex_lock(&worker->service->live_mutex);
  worker->launched = true;
  pthread_mutex_unlock(&worker->service->live_mutex);
  EO_TRY(find_state(worker, task->id, &before, error));
  EO_TRY(eo_launch_run(&launch, watch_launch, worker, &status, error));
  EO_TRY(find_state(worker, task->id, &after, error));
  return judge_launch(worker, &before, &after, status, stopped, error);
}

/* Whether the program has a command that works on such a job on all ranks of a launcher. */
static bool is_of_crews(enum eo_job_kind kind)
{
  return kind == EO_JOB_OPTIMIZE || kind == EO_JOB_STUDY || kind == EO_JOB_TOLERANCE;
}

static enum eo_code run_job(struct eo_service_worker *worker, struct task *task, bool *stopped, struct eo_error *error)
{
  const struct eo_progress progress = {follow_preparation, worker};
  enum eo_job_outcome outcome;
  EO_TRY(eo_queue_find(worker->store, task->id, take_job, task, &outcome, error));
  if (task->stop)
    atomic_store(&worker->cancelled, true);
  if (is_of_crews(worker->kind) && worker->service->settings.launcher)
    return launch(worker, task, stopped, error);
  if (worker->kind == EO_JOB_STUDY)
    return vary(worker, task, stopped, error);
  EO_TRY(read_design(task, error));
  EO_TRY(eo_pairs_obtain(worker->service->pairs, task->design, &progress, &task->held, error));
  return worker->kind == EO_JOB_OPTIMIZE    ? optimize(worker, task, stopped, error)
         : worker->kind == EO_JOB_TOLERANCE ? draw_pairs(worker, task, stopped, error)
         : worker->kind == EO_JOB_REPRODUCE ? reproduce(worker, task, error)
                                            : EO_OK;
}

/* A stop that nobody asked for by name is the service's: the job waits for the next one. */
static enum eo_job_state find_end(struct eo_service_worker *worker, enum eo_code code, bool stopped)
{
  if (stopped || code == EO_ERROR_CANCELLED)
    return atomic_load(&worker->cancelled) ? EO_JOB_CANCELLED : EO_JOB_QUEUED;
  return code ? EO_JOB_FAILED : EO_JOB_DONE;
}

static void forget_end(struct eo_service_worker *worker)
{
  eo_text_done(&worker->unended.fault);
  eo_text_done(&worker->unended.progress);
  worker->unended.id = 0;
}

/* Writes down the end of the last job; false: it cannot be yet. */
static bool settle(struct eo_service_worker *worker)
{
  struct eo_unended_job *job = &worker->unended;
  struct eo_error error;
  if (!job->id)
    return true;
  const char *fault = job->fault.failed ? NULL : job->fault.data,
             *progress = job->progress.failed ? NULL : job->progress.data;
  enum eo_code code = eo_queue_end(worker->store, job->id, job->state, fault, progress, &error);
  if (code == EO_ERROR_FULL && eo_spare_give(worker->store))
    code = eo_queue_end(worker->store, job->id, job->state, fault, progress, &error);
  if (code)
    return false;
  forget_end(worker);
  return true;
}

static void end_job(struct eo_service_worker *worker, int64_t id, enum eo_job_state state, const struct eo_error *error)
{
  struct eo_text progress = {0}, fault = {0};
  if (worker->recorded)
    return;
  pthread_mutex_lock(&worker->service->live_mutex);
  if (state == EO_JOB_DONE)
    worker->live.fraction = 1;
  pthread_mutex_unlock(&worker->service->live_mutex);
  if (!worker->launched)
    write_live(worker, &progress);
  if (state == EO_JOB_FAILED)
    eo_job_error_write(error, &fault);
  /* a database that fails here, as on a full disk, is tried again before the next job, and what is not needed gives its
     room for it; a stop leaves the job as begun, and the next start queues it again */
  worker->unended = (struct eo_unended_job){id, state, fault, progress};
  if (!settle(worker))
    return;
  if (worker->kind == EO_JOB_PREPARE)
    eo_queue_tidy(worker->store, worker->service->settings.limits.kept_preparations, NULL);
}

/* Those who wait for a preparation have their turn. */
static void wake(struct eo_service *service, int64_t id, enum eo_job_state state, const struct eo_error *error)
{
  struct eo_error why = {0};
  if (state == EO_JOB_FAILED)
    why = *error;
  else if (state == EO_JOB_CANCELLED)
    eo_error_set(&why, EO_ERROR_CANCELLED, "", "The preparation of the gear pair was cancelled.");
  eo_lane_wake(service->analyses, id, &why);
  eo_lane_wake(service->sweeps, id, &why);
  eo_lane_wake(service->works, id, &why);
}

static void tell(struct eo_service *service, int64_t id, enum eo_job_kind kind, const char *what, const char *detail)
{
  pthread_mutex_lock(&service->note_mutex);
  if (service->note)
    service->note(service->note_context, id, eo_store_job_kind_name(kind), what, detail);
  pthread_mutex_unlock(&service->note_mutex);
}

static void work_off(struct eo_service_worker *worker, int64_t id)
{
  struct eo_service *service = worker->service;
  struct task task = {.id = id};
  struct eo_error error = {0};
  bool stopped = false;
  begin_live(worker, id);
  eo_service_publish(service, id);
  tell(service, id, worker->kind, "begun", "");
  enum eo_code code = run_job(worker, &task, &stopped, &error);
  if (code && !error.code)
    error.code = code;
  enum eo_job_state state = find_end(worker, code, stopped);
  pthread_mutex_lock(&service->preparing_mutex);
  end_job(worker, id, state, &error);
  end_live(worker);
  wake(service, id, state, &error);
  pthread_mutex_unlock(&service->preparing_mutex);
  eo_service_publish(service, id);
  tell(service, id, worker->kind, eo_store_job_state_name(state), error.text);
  eo_pairs_release(service->pairs, task.held);
  eo_text_done(&task.text);
  free(task.design);
}

/* Until somebody says that there is work; at most for a while, so that a database that failed is tried again. */
static void wait_for_work(struct eo_service *service, uint64_t *calls)
{
  struct timespec until;
  clock_gettime(CLOCK_MONOTONIC, &until);
  until.tv_sec += 2;
  pthread_mutex_lock(&service->work_mutex);
  while (*calls == service->calls && !atomic_load(&service->stopping))
    if (pthread_cond_timedwait(&service->work, &service->work_mutex, &until))
      break;
  *calls = service->calls;
  pthread_mutex_unlock(&service->work_mutex);
}

/* Now and then, on the thread of preparations: what is no longer to be kept goes. */
static void retain(struct eo_service_worker *worker, double *last)
{
  static const double INTERVAL_MS = 600e3;
  const struct eo_service_limits *limits = &worker->service->settings.limits;
  double now = eo_clock_milliseconds();
  if (worker->kind != EO_JOB_PREPARE || (*last > 0 && now - *last < INTERVAL_MS))
    return;
  *last = now;
  eo_queue_retain(worker->store, limits->kept_jobs, limits->kept_predictions_days,
                  NULL); /* tried again the next time */
}

void *eo_service_work(void *argument)
{
  struct eo_service_worker *worker = argument;
  struct eo_service *service = worker->service;
  uint64_t calls = 0;
  double retained = 0;
  eo_lane_stand_back(worker->kind == EO_JOB_PREPARE ? PREPARE_NICE : OPTIMIZE_NICE);
  while (!atomic_load(&service->stopping)) {
    int64_t id = 0, ended = worker->unended.id;
    bool settled = settle(worker);
    if (settled && ended)
      eo_service_publish(service, ended);
    enum eo_code code = settled ? eo_queue_claim(worker->store, worker->kind, &id, NULL) : EO_ERROR_FULL;
    if (!code && id)
      work_off(worker, id);
    else {
      retain(worker, &retained);
      wait_for_work(service, &calls);
    }
  }
  forget_end(worker);
  return NULL;
}
