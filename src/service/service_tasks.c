/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What-if analyses and sweeps: from the question over the lane to the answer. */
#include "service/service_private.h"

#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "document/result.h"
#include "service/cached_pairs.h"
#include "variants/sweep_steps.h"

static const double bucket_ms[EO_SERVICE_BUCKETS - 1] = {5, 10, 15, 20, 25, 50, 100, 250, 500, 1000, 5000};

struct asked;

/* Computes what was asked for and adds it to the answer's text. Errors: EO_ERROR_CANCELLED when it was to end early,
   any other. */
typedef enum eo_code run_function(struct asked *asked, struct eo_held_pair *held, struct eo_answer *answer);

/* A question on its way; the lane's task first. */
struct asked {
  struct eo_lane_task task;
  run_function *run;
  struct eo_design design;
  struct eo_warnings warnings;
  enum eo_answer_format format;
  eo_answer_function *answer;
  void *context;
  int want;
  unsigned left_out;
  struct eo_sweep_axes axes; /* of a sweep; owned */
  struct eo_work work;       /* of other work; its data owned */
  struct eo_service *service;
};

void eo_service_release_task(struct eo_lane_task *task)
{
  struct asked *asked = (struct asked *)task;
  if (!asked)
    return;
  eo_sweep_axes_done(&asked->axes);
  if (asked->work.release)
    asked->work.release(asked->work.data);
  free(asked);
}

/* Tells tokens apart (FNV-1a, Fowler, Noll, Vo); 0: none. */
static uint64_t user_of(const char *token)
{
  uint64_t hash = 14695981039346656037u;
  for (const char *c = token; *c; c++)
    hash = (hash ^ (unsigned char)*c) * 1099511628211u;
  return *token ? hash | 1 : 0;
}

static enum eo_code write_analysis(const struct asked *asked, const struct eo_analysis *analysis,
                                   struct eo_answer *answer)
{
  if (asked->format == EO_ANSWER_CSV)
    return eo_result_write_csv(analysis, &asked->design, &answer->text, &answer->error);
  return eo_result_write(analysis, &asked->design, &asked->warnings, asked->left_out, &answer->text, &answer->error);
}

/* Notes how long the model took, and the writing. */
static void note_parts(struct eo_answer *answer, double start, double computed)
{
  answer->computed_ms = computed - start;
  answer->written_ms = eo_clock_milliseconds() - computed;
}

static int watch_task(void *context, const char *what, double fraction)
{
  const struct asked *asked = context;
  (void)what;
  (void)fraction;
  return atomic_load(&asked->task.overtaken) || atomic_load(&asked->service->stopping);
}

static enum eo_code run_analysis(struct asked *asked, struct eo_held_pair *held, struct eo_answer *answer)
{
  struct eo_service *service = asked->service;
  uint64_t user = user_of(asked->task.token);
  const struct eo_progress progress = {watch_task, asked};
  struct eo_analysis *analysis;
  double start = eo_clock_milliseconds();
  EO_TRY(eo_pairs_borrow(service->pairs, held, user, &analysis, &answer->error));
  analysis->threads = service->cores > 1 ? 2 : 1;
  analysis->progress = &progress;
  enum eo_code code = eo_analysis_run(analysis, &asked->design, asked->want, &answer->error);
  double computed = eo_clock_milliseconds();
  analysis->progress = NULL;
  if (!code)
    code = write_analysis(asked, analysis, answer);
  note_parts(answer, start, computed);
  eo_pairs_give_back(service->pairs, held, user, analysis);
  return code;
}

static void write_sweep(const struct asked *asked, const struct eo_sweep *sweep, struct eo_text *text)
{
  if (asked->format == EO_ANSWER_CSV)
    eo_sweep_csv(sweep, text);
  else
    eo_sweep_write(sweep, &asked->design, &asked->warnings, text);
}

static enum eo_code run_sweep(struct asked *asked, struct eo_held_pair *held, struct eo_answer *answer)
{
  const struct eo_progress progress = {watch_task, asked};
  struct eo_sweep_axes *axes = &asked->axes;
  EO_TRY(eo_sweep_steps_init(axes, &asked->design, &answer->error));
  const struct eo_sweep_plan plan = {.torques = axes->torques,
                                     .speeds = axes->speeds,
                                     .torque = axes->torque,
                                     .speed = axes->speed,
                                     .threads = asked->service->settings.threads,
                                     .steps = axes->steps,
                                     .key = axes->key,
                                     .value = axes->value,
                                     .step = axes->step};
  struct eo_sweep result = {0};
  double start = eo_clock_milliseconds();
  enum eo_code code = eo_sweep_run(&result, eo_held_pair(held), &asked->design, &plan, &progress, &answer->error);
  double computed = eo_clock_milliseconds();
  if (!code)
    write_sweep(asked, &result, &answer->text);
  note_parts(answer, start, computed);
  eo_sweep_done(&result);
  return code;
}

static enum eo_code run_work(struct asked *asked, struct eo_held_pair *held, struct eo_answer *answer)
{
  const struct eo_progress progress = {watch_task, asked};
  double start = eo_clock_milliseconds();
  enum eo_code code = asked->work.run(asked->work.data, eo_held_pair(held), &asked->design, &progress, &answer->text,
                                      &answer->error);
  note_parts(answer, start, eo_clock_milliseconds());
  return code;
}

static struct asked *copy_question(struct eo_service *service, const struct eo_question *question, run_function *run,
                                   struct eo_error *error)
{
  struct asked *asked = calloc(1, sizeof *asked);
  if (!asked) {
    eo_error_memory(error);
    return NULL;
  }
  asked->service = service;
  asked->run = run;
  asked->design = *question->design;
  if (question->warnings)
    asked->warnings = *question->warnings;
  asked->format = question->format;
  asked->answer = question->answer;
  asked->context = question->context;
  snprintf(asked->task.token, sizeof asked->task.token, "%s", question->token ? question->token : "");
  return asked;
}

/* The job that prepares the pair: a new one, or the one that is at it. *job 0: admission says why there is none. */
static enum eo_code ask_for_pair(struct eo_service *service, const struct eo_design *design,
                                 enum eo_admission *admission, int64_t *job, struct eo_error *error)
{
  const struct eo_job_order order = {.kind = EO_JOB_PREPARE, .design = design, .priority = EO_MOST_PRIORITY};
  enum eo_job_outcome outcome;
  struct eo_job_view made;
  enum eo_code code = eo_service_submit(service, &order, &outcome, &made, error);
  *job = made.row.id;
  *admission = outcome == EO_JOB_OUTCOME_CLOSED ? EO_ADMISSION_CLOSED
               : outcome == EO_JOB_OUTCOME_FULL ? EO_ADMISSION_FULL
                                                : EO_ADMISSION_PREPARING;
  eo_job_view_done(&made);
  return code;
}

static bool is_ready(struct eo_service *service, const struct eo_design *design)
{
  struct eo_held_pair *held = eo_pairs_find(service->pairs, design);
  eo_pairs_release(service->pairs, held);
  return held != NULL;
}

/* Puts it into the lane; where the pair is missing, behind its preparation if the question wants to wait. */
static enum eo_code admit(struct eo_service *service, struct eo_lane *lane, struct asked *asked, double wait,
                          enum eo_admission *admission, int64_t *job, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  bool closed = false, taken = false;
  *job = 0;
  pthread_mutex_lock(&service->preparing_mutex);
  bool ready = is_ready(service, &asked->design);
  if (!ready)
    code = ask_for_pair(service, &asked->design, admission, job, error);
  if (!code && (ready || (*job && wait > 0))) {
    asked->task.awaits = *job;
    asked->task.patience = eo_clock_milliseconds() + 1e3 * wait;
    taken = eo_lane_push(lane, &asked->task, &closed);
    *admission = taken ? EO_ADMISSION_ACCEPTED : closed ? EO_ADMISSION_CLOSED : EO_ADMISSION_FULL;
  }
  pthread_mutex_unlock(&service->preparing_mutex);
  if (!code && !taken && *admission == EO_ADMISSION_FULL)
    atomic_fetch_add(&service->refused, 1);
  if (!taken)
    eo_service_release_task(&asked->task);
  return code;
}

enum eo_code eo_service_analyze(struct eo_service *service, const struct eo_analysis_question *question,
                                enum eo_admission *admission, int64_t *job, struct eo_error *error)
{
  struct asked *asked = copy_question(service, &question->common, run_analysis, error);
  if (!asked)
    return EO_ERROR_MEMORY;
  asked->want = question->want;
  asked->left_out = question->left_out;
  return admit(service, service->analyses, asked, question->common.wait, admission, job, error);
}

enum eo_code eo_service_sweep(struct eo_service *service, const struct eo_question *question,
                              struct eo_sweep_axes *axes, enum eo_admission *admission, int64_t *job,
                              struct eo_error *error)
{
  struct asked *asked = copy_question(service, question, run_sweep, error);
  if (!asked)
    return EO_ERROR_MEMORY;
  asked->axes = *axes;
  *axes = (struct eo_sweep_axes){0};
  return admit(service, service->sweeps, asked, question->wait, admission, job, error);
}

enum eo_code eo_service_compute(struct eo_service *service, const struct eo_question *question,
                                const struct eo_work *work, enum eo_admission *admission, int64_t *job,
                                struct eo_error *error)
{
  struct asked *asked = copy_question(service, question, run_work, error);
  if (!asked) {
    work->release(work->data);
    return EO_ERROR_MEMORY;
  }
  asked->work = *work;
  return admit(service, service->works, asked, question->wait, admission, job, error);
}

bool eo_service_is_prepared(struct eo_service *service, const struct eo_design *design)
{
  return is_ready(service, design);
}

/* What a fate other than running means; false: it runs. */
static bool answer_at_once(struct eo_service *service, const struct asked *asked, enum eo_lane_fate fate,
                           struct eo_answer *answer)
{
  switch (fate) {
  case EO_LANE_OVERTAKEN:
    answer->kind = EO_ANSWER_OVERTAKEN;
    atomic_fetch_add(&service->overtaken, 1);
    return true;
  case EO_LANE_EXPIRED:
    answer->kind = EO_ANSWER_PREPARING;
    answer->job = asked->task.awaits;
    return true;
  case EO_LANE_STOPPED:
    answer->kind = EO_ANSWER_STOPPED;
    return true;
  case EO_LANE_RUN:
    break;
  }
  if (asked->task.error.code) {
    answer->kind = EO_ANSWER_FAILED;
    answer->error = asked->task.error;
  }
  return asked->task.error.code != EO_OK;
}

/* The pair; NULL with the answer: it went out of memory before its turn came. */
static struct eo_held_pair *hold_pair(struct eo_service *service, const struct asked *asked, struct eo_answer *answer)
{
  struct eo_held_pair *held = eo_pairs_find(service->pairs, &asked->design);
  enum eo_admission admission;
  if (held)
    return held;
  answer->kind = EO_ANSWER_PREPARING;
  if (ask_for_pair(service, &asked->design, &admission, &answer->job, &answer->error))
    answer->kind = EO_ANSWER_FAILED;
  else if (!answer->job) {
    answer->kind = admission == EO_ADMISSION_CLOSED ? EO_ANSWER_STOPPED : EO_ANSWER_FAILED;
    eo_error_set(&answer->error, EO_ERROR_CANCELLED, "", "Too many gear pairs wait for their preparation.");
  }
  return NULL;
}

/* What the code of a computation makes of its answer. */
static void conclude(struct eo_service *service, enum eo_code code, struct eo_answer *answer)
{
  if (!code && answer->text.failed)
    code = eo_error_memory(&answer->error);
  if (!code)
    return;
  answer->kind = code != EO_ERROR_CANCELLED        ? EO_ANSWER_FAILED
                 : atomic_load(&service->stopping) ? EO_ANSWER_STOPPED
                                                   : EO_ANSWER_OVERTAKEN;
  if (!answer->error.code)
    eo_error_set(&answer->error, code, "", "The computation failed.");
  eo_text_done(&answer->text);
}

static void note_time(struct eo_service *service, const struct eo_answer *answer)
{
  double ms = answer->waited_ms + answer->computed_ms + answer->written_ms;
  atomic_fetch_add(&service->analyses_done, 1);
  pthread_mutex_lock(&service->timing_mutex);
  service->total_ms += ms;
  service->most_ms = ms > service->most_ms ? ms : service->most_ms;
  for (int i = 0; i < EO_SERVICE_BUCKETS; i++)
    service->bucket[i] += i == EO_SERVICE_BUCKETS - 1 || ms <= bucket_ms[i];
  pthread_mutex_unlock(&service->timing_mutex);
}

static void note_done(struct eo_service *service, const struct asked *asked, const struct eo_answer *answer)
{
  if (asked->run == run_analysis)
    note_time(service, answer);
  else if (asked->run == run_sweep)
    atomic_fetch_add(&service->sweeps_done, 1);
}

void eo_service_run_task(void *context, struct eo_lane_task *task, enum eo_lane_fate fate)
{
  struct eo_service *service = context;
  struct asked *asked = (struct asked *)task;
  struct eo_answer answer = {.kind = EO_ANSWER_DONE, .waited_ms = eo_clock_milliseconds() - task->queued};
  struct eo_held_pair *held = NULL;
  if (!answer_at_once(service, asked, fate, &answer) && (held = hold_pair(service, asked, &answer)))
    conclude(service, asked->run(asked, held, &answer), &answer);
  eo_pairs_release(service->pairs, held);
  if (answer.kind == EO_ANSWER_DONE)
    note_done(service, asked, &answer);
  asked->answer(asked->context, &answer);
  eo_text_done(&answer.text);
}

enum eo_code eo_service_status(struct eo_service *service, struct eo_service_status *status, struct eo_error *error)
{
  *status = (struct eo_service_status){.analyses_waiting = eo_lane_waiting(service->analyses),
                                       .sweeps_waiting = eo_lane_waiting(service->sweeps),
                                       .pairs = eo_pairs_count(service->pairs),
                                       .subscribers = eo_events_subscribers(service->events),
                                       .analyses = atomic_load(&service->analyses_done),
                                       .overtaken = atomic_load(&service->overtaken),
                                       .sweeps = atomic_load(&service->sweeps_done),
                                       .refused = atomic_load(&service->refused),
                                       .true_evaluations = atomic_load(&service->true_evaluations),
                                       .reused_evaluations = atomic_load(&service->reused_evaluations),
                                       .events = eo_events_published(service->events),
                                       .cache_bytes = eo_cached_pairs_size(service->settings.cache)};
  pthread_mutex_lock(&service->timing_mutex);
  status->analysis_ms_total = service->total_ms;
  status->analysis_ms_most = service->most_ms;
  memcpy(status->analysis_ms_bucket, service->bucket, sizeof service->bucket);
  pthread_mutex_unlock(&service->timing_mutex);
  pthread_mutex_lock(&service->store_mutex);
  enum eo_code code = eo_queue_count(service->store, status->jobs, error);
  pthread_mutex_unlock(&service->store_mutex);
  status->database = !code;
  return code;
}
