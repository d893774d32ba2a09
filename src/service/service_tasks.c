/* What-if analyses and sweeps: from the question over the lane to the answer. */
#include "service/service_private.h"

#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "format/json.h"
#include "document/result.h"

static const double bucket_ms[EO_SERVICE_BUCKETS - 1] = {5, 10, 15, 20, 25, 50, 100, 250, 500, 1000, 5000};

/* A question on its way; the lane's task first. */
struct asked {
  struct eo_lane_task task;
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

/* ---- asking ---- */

static struct asked *copy_question(struct eo_service *s, const struct eo_question *q, struct eo_error *error)
{
  struct asked *asked = calloc(1, sizeof *asked);
  if (!asked) {
    eo_error_memory(error);
    return NULL;
  }
  asked->service = s;
  asked->design = *q->design;
  if (q->warnings)
    asked->warnings = *q->warnings;
  asked->format = q->format;
  asked->answer = q->answer;
  asked->context = q->context;
  snprintf(asked->task.token, sizeof asked->task.token, "%s", q->token ? q->token : "");
  return asked;
}

/* The job that prepares the pair: a new one, or the one that is at it. *job 0: admission says why there is none. */
static enum eo_code ask_for_pair(struct eo_service *s, const struct eo_design *design, enum eo_admission *admission,
                                 int64_t *job, struct eo_error *error)
{
  const struct eo_job_order order = {.kind = EO_JOB_PREPARE, .design = design, .priority = EO_MOST_PRIORITY};
  enum eo_job_outcome outcome;
  json_t *document = NULL;
  enum eo_code code = eo_service_submit(s, &order, &outcome, &document, error);
  *job = json_integer_value(json_object_get(document, "id"));
  *admission = outcome == EO_JOB_OUTCOME_CLOSED ? EO_ADMISSION_CLOSED
               : outcome == EO_JOB_OUTCOME_FULL ? EO_ADMISSION_FULL
                                                : EO_ADMISSION_PREPARING;
  json_decref(document);
  return code;
}

static bool is_ready(struct eo_service *s, const struct eo_design *design)
{
  struct eo_held_pair *held = eo_pairs_find(s->pairs, design);
  eo_pairs_release(s->pairs, held);
  return held != NULL;
}

/* Puts it into the lane; where the pair is missing, behind its preparation if the question wants to wait. */
static enum eo_code admit(struct eo_service *s, struct eo_lane *lane, struct asked *asked, double wait,
                          enum eo_admission *admission, int64_t *job, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  bool closed = false, taken = false;
  *job = 0;
  pthread_mutex_lock(&s->preparing_mutex);
  bool ready = is_ready(s, &asked->design);
  if (!ready)
    code = ask_for_pair(s, &asked->design, admission, job, error);
  if (!code && (ready || (*job && wait > 0))) {
    asked->task.awaits = *job;
    asked->task.patience = eo_clock_milliseconds() + 1e3 * wait;
    taken = eo_lane_push(lane, &asked->task, &closed);
    *admission = taken ? EO_ADMISSION_ACCEPTED : closed ? EO_ADMISSION_CLOSED : EO_ADMISSION_FULL;
  }
  pthread_mutex_unlock(&s->preparing_mutex);
  if (!code && !taken && *admission == EO_ADMISSION_FULL)
    atomic_fetch_add(&s->refused, 1);
  if (!taken)
    eo_service_release_task(&asked->task);
  return code;
}

enum eo_code eo_service_analyze(struct eo_service *s, const struct eo_analysis_question *q,
                                enum eo_admission *admission, int64_t *job, struct eo_error *error)
{
  struct asked *asked = copy_question(s, &q->common, error);
  if (!asked)
    return EO_ERROR_MEMORY;
  asked->want = q->want;
  asked->left_out = (q->maps ? 0u : EO_RESULT_NO_MAPS) | (q->histories ? 0u : EO_RESULT_NO_HISTORIES);
  return admit(s, s->analyses, asked, q->common.wait, admission, job, error);
}

static enum eo_code copy_axis(const double *from, int count, double **to, struct eo_error *error)
{
  if (!count)
    return EO_OK;
  *to = malloc(sizeof **to * (size_t)count);
  if (!*to)
    return eo_error_memory(error);
  memcpy(*to, from, sizeof **to * (size_t)count);
  return EO_OK;
}

enum eo_code eo_service_sweep(struct eo_service *s, const struct eo_question *q, const struct eo_sweep_axes *axes,
                              enum eo_admission *admission, int64_t *job, struct eo_error *error)
{
  struct asked *asked = copy_question(s, q, error);
  if (!asked)
    return EO_ERROR_MEMORY;
  asked->axes.torques = axes->torques;
  asked->axes.speeds = axes->speeds;
  enum eo_code code = copy_axis(axes->torque, axes->torques, &asked->axes.torque, error);
  if (!code)
    code = copy_axis(axes->speed, axes->speeds, &asked->axes.speed, error);
  if (!code)
    return admit(s, s->sweeps, asked, q->wait, admission, job, error);
  eo_service_release_task(&asked->task);
  return code;
}

enum eo_code eo_service_compute(struct eo_service *s, const struct eo_question *q, const struct eo_work *work,
                                enum eo_admission *admission, int64_t *job, struct eo_error *error)
{
  struct asked *asked = copy_question(s, q, error);
  if (!asked) {
    work->release(work->data);
    return EO_ERROR_MEMORY;
  }
  asked->work = *work;
  return admit(s, s->works, asked, q->wait, admission, job, error);
}

bool eo_service_is_prepared(struct eo_service *s, const struct eo_design *design)
{
  return is_ready(s, design);
}

/* ---- answering ---- */

/* What a fate other than running means; false: it runs. */
static bool answer_at_once(struct eo_service *s, const struct asked *asked, enum eo_lane_fate fate,
                           struct eo_answer *answer)
{
  switch (fate) {
  case EO_LANE_OVERTAKEN:
    answer->kind = EO_ANSWER_OVERTAKEN;
    atomic_fetch_add(&s->overtaken, 1);
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
static struct eo_held_pair *hold_pair(struct eo_service *s, const struct asked *asked, struct eo_answer *answer)
{
  struct eo_held_pair *held = eo_pairs_find(s->pairs, &asked->design);
  enum eo_admission admission;
  if (held)
    return held;
  answer->kind = EO_ANSWER_PREPARING;
  if (ask_for_pair(s, &asked->design, &admission, &answer->job, &answer->error))
    answer->kind = EO_ANSWER_FAILED;
  else if (!answer->job) {
    answer->kind = admission == EO_ADMISSION_CLOSED ? EO_ANSWER_STOPPED : EO_ANSWER_FAILED;
    eo_error_set(&answer->error, EO_ERROR_CANCELLED, "", "Too many gear pairs wait for their preparation.");
  }
  return NULL;
}

static void fail(struct eo_answer *answer, enum eo_code code)
{
  answer->kind = EO_ANSWER_FAILED;
  if (!answer->error.code)
    eo_error_set(&answer->error, code, "", "The computation failed.");
  eo_text_done(&answer->text);
}

static enum eo_code write_analysis(const struct asked *asked, const struct eo_analysis *analysis,
                                   struct eo_answer *answer)
{
  if (asked->format == EO_ANSWER_JSON)
    return eo_result_write(analysis, &asked->design, &asked->warnings, asked->left_out, &answer->text, &answer->error);
  json_t *document = eo_result_encode_part(analysis, &asked->design, &asked->warnings, asked->left_out);
  if (!document)
    return eo_error_memory(&answer->error);
  eo_result_summary_csv(document, &answer->text);
  json_decref(document);
  return answer->text.failed ? eo_error_memory(&answer->error) : EO_OK;
}

static void analyze(struct eo_service *s, struct asked *asked, struct eo_held_pair *held, struct eo_answer *answer)
{
  uint64_t user = user_of(asked->task.token);
  struct eo_analysis *analysis;
  double start = eo_clock_milliseconds();
  enum eo_code code = eo_pairs_borrow(s->pairs, held, user, &analysis, &answer->error);
  if (code) {
    fail(answer, code);
    return;
  }
  analysis->threads = s->cores > 1 ? 2 : 1;
  code = eo_analysis_run(analysis, &asked->design, asked->want, &answer->error);
  double computed = eo_clock_milliseconds();
  if (!code)
    code = write_analysis(asked, analysis, answer);
  answer->computed_ms = computed - start;
  answer->written_ms = eo_clock_milliseconds() - computed;
  eo_pairs_give_back(s->pairs, held, user, analysis);
  if (code)
    fail(answer, code);
}

static void note_time(struct eo_service *s, const struct eo_answer *answer)
{
  double ms = answer->waited_ms + answer->computed_ms + answer->written_ms;
  atomic_fetch_add(&s->analyses_done, 1);
  pthread_mutex_lock(&s->timing_mutex);
  s->total_ms += ms;
  s->most_ms = ms > s->most_ms ? ms : s->most_ms;
  for (int i = 0; i < EO_SERVICE_BUCKETS; i++)
    s->bucket[i] += i == EO_SERVICE_BUCKETS - 1 || ms <= bucket_ms[i];
  pthread_mutex_unlock(&s->timing_mutex);
}

void eo_service_answer_analysis(void *context, struct eo_lane_task *task, enum eo_lane_fate fate)
{
  struct eo_service *s = context;
  struct asked *asked = (struct asked *)task;
  struct eo_answer answer = {.kind = EO_ANSWER_DONE, .waited_ms = eo_clock_milliseconds() - task->queued};
  struct eo_held_pair *held = NULL;
  if (!answer_at_once(s, asked, fate, &answer) && (held = hold_pair(s, asked, &answer)))
    analyze(s, asked, held, &answer);
  eo_pairs_release(s->pairs, held);
  if (answer.kind == EO_ANSWER_DONE)
    note_time(s, &answer);
  asked->answer(asked->context, &answer);
  eo_text_done(&answer.text);
}

static int watch_task(void *context, const char *what, double fraction)
{
  const struct asked *asked = context;
  (void)what;
  (void)fraction;
  return atomic_load(&asked->task.overtaken) || atomic_load(&asked->service->stopping);
}

static enum eo_code write_sweep(const struct asked *asked, const struct eo_sweep *sweep, struct eo_answer *answer)
{
  if (asked->format == EO_ANSWER_CSV) {
    eo_sweep_csv(sweep, &answer->text);
    return answer->text.failed ? eo_error_memory(&answer->error) : EO_OK;
  }
  json_t *document = eo_sweep_encode(sweep, &asked->design, &asked->warnings);
  if (document)
    eo_json_write(&answer->text, document, EO_JSON_COMPACT);
  json_decref(document);
  return document && !answer->text.failed ? EO_OK : eo_error_memory(&answer->error);
}

static void sweep(struct eo_service *s, struct asked *asked, struct eo_held_pair *held, struct eo_answer *answer)
{
  const struct eo_progress progress = {watch_task, asked};
  const struct eo_sweep_plan plan = {asked->axes.torques, asked->axes.speeds, asked->axes.torque, asked->axes.speed,
                                     s->settings.threads};
  struct eo_sweep result = {0};
  double start = eo_clock_milliseconds();
  enum eo_code code = eo_sweep_run(&result, eo_held_pair(held), &asked->design, &plan, &progress, &answer->error);
  double computed = eo_clock_milliseconds();
  if (!code)
    code = write_sweep(asked, &result, answer);
  answer->computed_ms = computed - start;
  answer->written_ms = eo_clock_milliseconds() - computed;
  eo_sweep_done(&result);
  if (code == EO_ERROR_CANCELLED)
    answer->kind = atomic_load(&s->stopping) ? EO_ANSWER_STOPPED : EO_ANSWER_OVERTAKEN;
  else if (code)
    fail(answer, code);
}

void eo_service_answer_sweep(void *context, struct eo_lane_task *task, enum eo_lane_fate fate)
{
  struct eo_service *s = context;
  struct asked *asked = (struct asked *)task;
  struct eo_answer answer = {.kind = EO_ANSWER_DONE, .waited_ms = eo_clock_milliseconds() - task->queued};
  struct eo_held_pair *held = NULL;
  if (!answer_at_once(s, asked, fate, &answer) && (held = hold_pair(s, asked, &answer)))
    sweep(s, asked, held, &answer);
  eo_pairs_release(s->pairs, held);
  if (answer.kind == EO_ANSWER_DONE)
    atomic_fetch_add(&s->sweeps_done, 1);
  asked->answer(asked->context, &answer);
  eo_text_done(&answer.text);
}

static void work(struct eo_service *s, struct asked *asked, struct eo_held_pair *held, struct eo_answer *answer)
{
  const struct eo_progress progress = {watch_task, asked};
  double start = eo_clock_milliseconds();
  enum eo_code code = asked->work.run(asked->work.data, eo_held_pair(held), &asked->design, &progress, &answer->text,
                                      &answer->error);
  if (!code && answer->text.failed)
    code = eo_error_memory(&answer->error);
  answer->computed_ms = eo_clock_milliseconds() - start;
  if (code)
    fail(answer, code);
  if (code == EO_ERROR_CANCELLED)
    answer->kind = atomic_load(&s->stopping) ? EO_ANSWER_STOPPED : EO_ANSWER_OVERTAKEN;
}

void eo_service_answer_work(void *context, struct eo_lane_task *task, enum eo_lane_fate fate)
{
  struct eo_service *s = context;
  struct asked *asked = (struct asked *)task;
  struct eo_answer answer = {.kind = EO_ANSWER_DONE, .waited_ms = eo_clock_milliseconds() - task->queued};
  struct eo_held_pair *held = NULL;
  if (!answer_at_once(s, asked, fate, &answer) && (held = hold_pair(s, asked, &answer)))
    work(s, asked, held, &answer);
  eo_pairs_release(s->pairs, held);
  asked->answer(asked->context, &answer);
  eo_text_done(&answer.text);
}

/* ---- status ---- */

enum eo_code eo_service_status(struct eo_service *s, struct eo_service_status *status, struct eo_error *error)
{
  *status = (struct eo_service_status){.analyses_waiting = eo_lane_waiting(s->analyses),
                                       .sweeps_waiting = eo_lane_waiting(s->sweeps),
                                       .pairs = eo_pairs_count(s->pairs),
                                       .subscribers = eo_events_subscribers(s->events),
                                       .analyses = atomic_load(&s->analyses_done),
                                       .overtaken = atomic_load(&s->overtaken),
                                       .sweeps = atomic_load(&s->sweeps_done),
                                       .refused = atomic_load(&s->refused),
                                       .true_evaluations = atomic_load(&s->true_evaluations),
                                       .reused_evaluations = atomic_load(&s->reused_evaluations),
                                       .events = eo_events_published(s->events)};
  pthread_mutex_lock(&s->timing_mutex);
  status->analysis_ms_total = s->total_ms;
  status->analysis_ms_most = s->most_ms;
  memcpy(status->analysis_ms_bucket, s->bucket, sizeof s->bucket);
  pthread_mutex_unlock(&s->timing_mutex);
  pthread_mutex_lock(&s->store_mutex);
  enum eo_code code = eo_queue_count(s->store, status->jobs, error);
  pthread_mutex_unlock(&s->store_mutex);
  status->database = !code;
  return code;
}
