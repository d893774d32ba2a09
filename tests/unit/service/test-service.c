/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The service on a coarse pair: what-if answers are those of an analysis made by hand, newest wins, pairs are prepared
   once and forgotten in order, jobs run, stop, go on and are told about, and a graceful stop loses nothing. */
#include <stdatomic.h>

#include "document/result.h"
#include "support/service-fixture.h"
#include "store/queue.h"
#include "support/tap.h"

enum { BUDGET = 150 };

static struct eo_design design;

static enum eo_admission ask(struct eo_service *service, const struct eo_design *about, const char *token, double wait,
                             struct answered *answered, int64_t *job)
{
  const struct eo_analysis_question question = {
      .common = {.design = about, .token = token, .wait = wait, .answer = take_answer, .context = answered},
      .want = EO_WANT_ROOT | EO_WANT_CURVES,
  };
  enum eo_admission admission = EO_ADMISSION_CLOSED;
  if (eo_service_analyze(service, &question, &admission, job, &error))
    printf("# %s\n", error.text);
  return admission;
}

/* What does not depend on the clock. */
static char *lasting_text(const char *text)
{
  json_t *document = json_loads(text ? text : "null", JSON_DECODE_ANY, NULL);
  json_object_del(document, "timing_ms");
  char *lasting = json_dumps(document, JSON_SORT_KEYS | JSON_ENCODE_ANY);
  json_decref(document);
  return lasting;
}

static char *analyse_by_hand(const struct eo_design *about)
{
  struct eo_pair *pair = coarse_pair();
  struct eo_analysis *analysis = NULL;
  struct eo_text text = {0};
  eo_analysis_new(&analysis, pair, &error);
  eo_analysis_run(analysis, about, EO_WANT_ROOT | EO_WANT_CURVES, &error);
  json_t *document = eo_result_encode(analysis, about, NULL);
  eo_json_write(&text, document, EO_JSON_COMPACT);
  char *lasting = lasting_text(text.data);
  json_decref(document);
  eo_text_done(&text);
  eo_analysis_free(analysis);
  eo_pair_free(pair);
  return lasting;
}

static void test_analysis(void)
{
  struct eo_service *service = start();
  struct answered answered = {0};
  int64_t job = 0, again = 0;
  ok(ask(service, &design, "", 0, &answered, &job) == EO_ADMISSION_PREPARING && job, "a new pair is prepared by a job");
  ok(!eo_service_is_prepared(service, &design), "a new pair is not there before its job ends");
  ok(ask(service, &design, "", 0, &answered, &again) == EO_ADMISSION_PREPARING && again == job,
     "one job prepares the pair, whoever asks");
  ok(ask(service, &design, "", 60, &answered, &again) == EO_ADMISSION_ACCEPTED,
     "a question that wants to wait is taken");
  wait_for_answers(&answered, 1);
  ok(answered.last.kind == EO_ANSWER_DONE && wait_for(service, job, "done"), "a question that waits is answered %s",
     answered.last.error.text);
  char *by_hand = analyse_by_hand(&design), *text = lasting_text(answered.last.text.data);
  ok(strcmp(by_hand, text) == 0, "the answer is that of an analysis made by hand, %zu bytes", strlen(text));
  free(text);
  struct eo_design changed = design;
  changed.modification.flank[EO_PINION][EO_LEFT].tip_relief = 20e-6;
  ok(ask(service, &changed, "me", 0, &answered, &job) == EO_ADMISSION_ACCEPTED,
     "a change to a prepared pair is answered at once");
  wait_for_answers(&answered, 2);
  ask(service, &design, "me", 0, &answered, &job);
  wait_for_answers(&answered, 3);
  text = lasting_text(answered.last.text.data);
  ok(strcmp(by_hand, text) == 0, "the first design gives the first answer again");
  struct eo_service_status status;
  ok(!eo_service_status(service, &status, &error) && status.database && status.analyses == 3 && status.pairs == 1 &&
         status.jobs[EO_JOB_DONE] == 1 && status.analysis_ms_bucket[11] == 3 && status.analysis_ms_most > 0,
     "the status counts all of these questions");
  free(text);
  free(by_hand);
  eo_text_done(&answered.last.text);
  eo_service_free(service);
}

static void test_left_out(void)
{
  struct eo_service *service = start();
  struct answered answered = {0};
  int64_t job;
  ask(service, &design, "", 60, &answered, &job);
  wait_for_answers(&answered, 1);
  size_t whole = answered.last.text.size;
  struct eo_analysis_question question = {.common = {.design = &design, .answer = take_answer, .context = &answered},
                                          .want = EO_WANT_CURVES,
                                          .left_out = EO_RESULT_NO_MAPS | EO_RESULT_NO_HISTORIES};
  enum eo_admission admission;
  eo_service_analyze(service, &question, &admission, &job, &error);
  wait_for_answers(&answered, 2);
  json_t *document = json_loads(answered.last.text.data, 0, NULL);
  const json_t *first = json_array_get(json_object_get(document, "load_cases"), 0);
  ok(answered.last.text.size < whole / 2 && json_is_null(eo_json_find(first, "contact/pattern/left/pressure_MPa")) &&
         json_is_null(eo_json_find(first, "vibration/left/history")) &&
         json_is_null(eo_json_find(first, "root_stress")) &&
         json_is_object(eo_json_find(first, "vibration/left/orders")),
     "an answer leaves out what is not wanted: %zu of %zu bytes", answered.last.text.size, whole);
  json_decref(document);
  question.common.format = EO_ANSWER_CSV;
  eo_service_analyze(service, &question, &admission, &job, &error);
  wait_for_answers(&answered, 3);
  ok(answered.last.kind == EO_ANSWER_DONE && strncmp(answered.last.text.data, "load_case,torque_Nm", 19) == 0,
     "an analysis is answered as a table");
  eo_text_done(&answered.last.text);
  eo_service_free(service);
}

/* One after another on the same token as fast as they come: none is lost, the last one is answered. */
static void test_overtaking(void)
{
  enum { QUESTIONS = 40 };
  struct eo_service *service = start();
  struct answered first = {0}, rest = {0}, last = {0};
  struct eo_service_status status;
  struct eo_design changed = design;
  int64_t job;
  ask(service, &design, "", 60, &first, &job);
  wait_for_answers(&first, 1);
  for (int i = 0; i < QUESTIONS; i++) {
    changed.modification.flank[EO_PINION][EO_LEFT].tip_relief = 1e-6 * i;
    ask(service, &changed, "slider", 0, i < QUESTIONS - 1 ? &rest : &last, &job);
  }
  wait_for_answers(&rest, QUESTIONS - 1);
  wait_for_answers(&last, 1);
  eo_service_status(service, &status, &error);
  ok(last.last.kind == EO_ANSWER_DONE, "the newest question of a lane is answered");
  ok(status.overtaken > 0 && status.overtaken + status.analyses == QUESTIONS + 1,
     "%lld of the older questions were overtaken", (long long)status.overtaken);
  json_t *document = json_loads(last.last.text.data, 0, NULL);
  close_to(eo_json_find_number(document, "design/modification/pinion/left/tip_relief_um"), QUESTIONS - 1, 1e-9,
           "relief of the newest answer, that of the last question, um");
  json_decref(document);
  eo_text_done(&first.last.text);
  eo_text_done(&rest.last.text);
  eo_text_done(&last.last.text);
  eo_service_free(service);
}

/* Equidistant, N m; the service takes them over. */
static struct eo_sweep_axes axes_of(int torques, double from, double step)
{
  struct eo_sweep_axes axes = {.torques = torques, .torque = calloc((size_t)torques, sizeof(double))};
  for (int i = 0; i < torques; i++)
    axes.torque[i] = from + i * step;
  return axes;
}

static void test_sweep(void)
{
  struct eo_service *service = start();
  struct answered answered = {0}, overtaken = {0};
  struct eo_sweep_axes axes = axes_of(3, 500, 100), long_axes = axes_of(200, 300, 1);
  struct eo_question question = {
      .design = &design, .wait = 60, .token = "sweep", .answer = take_answer, .context = &answered};
  enum eo_admission admission;
  int64_t job;
  ok(!eo_service_sweep(service, &question, &axes, &admission, &job, &error) && admission == EO_ADMISSION_ACCEPTED,
     "a sweep waits for its pair");
  wait_for_answers(&answered, 1);
  json_t *document = json_loads(answered.last.text.data ? answered.last.text.data : "{}", 0, NULL);
  ok(answered.last.kind == EO_ANSWER_DONE && json_array_size(json_object_get(document, "torque_Nm")) == 3,
     "the sweep that waited is answered %s", answered.last.error.text);
  json_decref(document);
  axes = axes_of(3, 500, 100);
  question.context = &overtaken;
  eo_service_sweep(service, &question, &long_axes, &admission, &job, &error);
  pause_for(20);
  question.context = &answered;
  question.format = EO_ANSWER_CSV;
  eo_service_sweep(service, &question, &axes, &admission, &job, &error);
  wait_for_answers(&overtaken, 1);
  wait_for_answers(&answered, 2);
  ok(overtaken.last.kind == EO_ANSWER_OVERTAKEN && answered.last.kind == EO_ANSWER_DONE &&
         strchr(answered.last.text.data, ','),
     "a newer question ends one that runs");
  eo_text_done(&answered.last.text);
  eo_text_done(&overtaken.last.text);
  eo_service_free(service);
}

static void test_pairs(void)
{
  struct eo_service *service = start_with(0, 1);
  struct eo_design other = design;
  struct answered answered = {0};
  struct eo_service_status status;
  int64_t job;
  other.resolution.positions = 20;
  ask(service, &design, "", 60, &answered, &job);
  wait_for_answers(&answered, 1);
  ask(service, &other, "", 60, &answered, &job);
  wait_for_answers(&answered, 2);
  wait_for(service, job, "done");
  eo_service_status(service, &status, &error);
  ok(answered.last.kind == EO_ANSWER_DONE && status.pairs == 1, "one prepared pair is kept: %d", status.pairs);
  ok(!eo_service_is_prepared(service, &design) && eo_service_is_prepared(service, &other),
     "the pair that was used last is kept");
  eo_text_done(&answered.last.text);
  eo_service_free(service);
}

struct heard {
  int count;
  int64_t last;
  bool ordered;
  char state[40][16];
  int states; /* that differ from the one before */
};

/* An event shows the job as it is when it is told: a state that is left at once may not be heard of. */
static bool follows_its_life(const struct heard *heard)
{
  static const char *const life[] = {"queued", "preparing", "running", "done"};
  int at = 0;
  for (int i = 0; i < heard->states; i++, at++) {
    while (at < 4 && strcmp(heard->state[i], life[at]) != 0)
      at++;
    if (at == 4)
      return false;
  }
  return heard->states >= 2 && strcmp(heard->state[heard->states - 2], "running") == 0 && at == 4;
}

static void hear(void *context, const struct eo_service_event *event)
{
  struct heard *heard = context;
  json_t *job = json_loadb(event->text, event->size, 0, NULL);
  const char *state = json_string_value(json_object_get(job, "state"));
  pthread_mutex_lock(&answer_mutex);
  heard->ordered = (heard->count == 0 || event->number > heard->last) && (heard->count == 0 || heard->ordered) &&
                   !strchr(event->text, '\n');
  heard->count++;
  heard->last = event->number;
  if (state && heard->states < 40 && (!heard->states || strcmp(heard->state[heard->states - 1], state) != 0))
    snprintf(heard->state[heard->states++], 16, "%s", state);
  pthread_mutex_unlock(&answer_mutex);
  json_decref(job);
}

/* A job is done before its last event is heard. */
static void hear_the_end(struct heard *heard)
{
  bool ended = false;
  for (int i = 0; i < 500 && !ended; i++) {
    pthread_mutex_lock(&answer_mutex);
    ended = heard->states > 0 && strcmp(heard->state[heard->states - 1], "done") == 0;
    pthread_mutex_unlock(&answer_mutex);
    if (!ended)
      usleep(10000);
  }
}

static char *result_of(struct eo_service *service, int64_t id)
{
  struct eo_text text = {0};
  enum eo_job_outcome outcome;
  if (eo_service_result(service, id, &outcome, &text, &error) || outcome)
    return NULL;
  json_t *document = json_loads(text.data, 0, NULL);
  json_object_del(document, "run");
  json_object_del(json_object_get(json_object_get(document, "best"), "result"), "timing_ms");
  char *lasting = json_dumps(document, JSON_SORT_KEYS);
  json_decref(document);
  eo_text_done(&text);
  return lasting;
}

static char *undisturbed; /* result of an optimization that nobody disturbed */

static void test_job(void)
{
  struct eo_service *service = start();
  struct heard heard = {0};
  enum eo_job_outcome outcome;
  int64_t subscription, id, again;
  struct eo_job_convergence convergence;
  eo_service_subscribe(service, 0, 0, hear, &heard, &subscription, &error);
  id = submit(service, EO_JOB_OPTIMIZE, &design, "once", &outcome);
  ok(outcome == EO_JOB_OUTCOME_DONE && id, "an optimization is queued");
  again = submit(service, EO_JOB_OPTIMIZE, &design, "once", &outcome);
  ok(outcome == EO_JOB_OUTCOME_REPEATED && again == id, "the same request again is the same job");
  ok(wait_for_evaluations(service, id, 20), "the optimization runs");
  struct eo_text none = {0};
  ok(!eo_service_result(service, id, &outcome, &none, &error) && outcome == EO_JOB_OUTCOME_STATE,
     "the result of a running job is not there");
  eo_text_done(&none);
  ok(wait_for(service, id, "done"), "the optimization ends");
  undisturbed = result_of(service, id);
  ok(undisturbed != NULL, "the optimization has a result");
  json_t *job = look(service, id);
  close_to(eo_json_find_number(job, "progress/fraction"), 1, 0, "fraction of the progress at the end");
  ok(progress_of(service, id, "true_evaluations") == BUDGET && eo_json_find_number(job, "best/J") < 1 &&
         eo_json_find(job, "best/modification/pinion") && eo_json_find_number(job, "unmodified/J") == 1 &&
         json_is_true(json_object_get(job, "has_result")) && json_string_value(json_object_get(job, "finished")),
     "the document of the job says what it found");
  json_decref(job);
  ok(!eo_service_convergence(service, id, &outcome, &convergence, &error) && !outcome,
     "the job tells of its convergence");
  json_t *columns = eo_job_convergence_encode(&convergence);
  eo_job_convergence_done(&convergence);
  ok(json_array_size(json_object_get(columns, "best")) > 1 &&
         json_array_size(json_object_get(columns, "mean")) == json_array_size(json_object_get(columns, "pfc_percent")),
     "the convergence has as many means as bests");
  json_decref(columns);
  hear_the_end(&heard);
  eo_service_unsubscribe(service, subscription);
  ok(heard.ordered && heard.count > 3 && follows_its_life(&heard),
     "%d events come in order: (queued, preparing,) running, done", heard.count);
  struct heard later = {0};
  eo_service_subscribe(service, id, heard.last - 2, hear, &later, &subscription, &error);
  ok(later.count == 2 && later.last == heard.last, "a listener who comes back hears what he missed");
  eo_service_unsubscribe(service, subscription);
  struct heard late = {0};
  eo_service_subscribe(service, id, 0, hear, &late, &subscription, &error);
  ok(late.count == 1 && late.last == heard.last, "a listener who comes after the end hears that it has ended");
  eo_service_unsubscribe(service, subscription);
  late = (struct heard){0};
  eo_service_subscribe(service, id, 1, hear, &late, &subscription, &error);
  ok(late.count == 1, "a listener who comes back too late hears of the end");
  eo_service_unsubscribe(service, subscription);
  eo_service_free(service);
}

/* Cancelled in the middle and taken up again: the same result. */
static void test_cancel(void)
{
  struct eo_service *service = start();
  enum eo_job_outcome outcome;
  struct eo_job_view job;
  int64_t id = submit(service, EO_JOB_OPTIMIZE, &design, NULL, &outcome),
          waiting = submit(service, EO_JOB_OPTIMIZE, &design, NULL, &outcome);
  ok(!eo_service_cancel(service, waiting, &outcome, &job, &error) && !outcome && is_in(service, waiting, "cancelled"),
     "a waiting job is cancelled at once");
  eo_job_view_done(&job);
  ok(wait_for_evaluations(service, id, 30), "the other job runs");
  ok(!eo_service_remove(service, id, &outcome, &error) && outcome == EO_JOB_OUTCOME_STATE,
     "a running job cannot be removed");
  double asked = eo_clock_milliseconds();
  ok(!eo_service_cancel(service, id, &outcome, &job, &error) && !outcome, "a running job is told to stop");
  eo_job_view_done(&job);
  ok(wait_for(service, id, "cancelled"), "a job that was told to stop does so after %.0f ms",
     eo_clock_milliseconds() - asked);
  int before = progress_of(service, id, "true_evaluations");
  char *found = result_of(service, id);
  ok(found != NULL && before < BUDGET, "a stopped job keeps its %d evaluations", before);
  free(found);
  ok(!eo_service_cancel(service, id, &outcome, &job, &error) && outcome == EO_JOB_OUTCOME_STATE && !job.texts,
     "a stopped job is not stopped again");
  ok(!eo_service_retry(service, id, &outcome, &job, &error) && !outcome, "a stopped job is tried again");
  eo_job_view_done(&job);
  ok(wait_for(service, id, "done"), "a job that is tried again goes on to its end");
  char *result = result_of(service, id);
  json_t *one = json_loads(undisturbed, 0, NULL), *two = json_loads(result ? result : "{}", 0, NULL);
  ok(json_equal(json_object_get(json_object_get(one, "best"), "objectives"),
                json_object_get(json_object_get(two, "best"), "objectives")),
     "the result of a job with a stop is that of an undisturbed one");
  json_decref(one);
  json_decref(two);
  free(result);
  ok(!eo_service_clone(service, id, NULL, &outcome, &job, &error) && !outcome && job.row.id > id,
     "a copy is another job");
  eo_job_view_done(&job);
  ok(!eo_service_remove(service, waiting, &outcome, &error) && !outcome && !look(service, waiting),
     "an ended job can be removed");
  eo_service_free(service);
}

/* Pairs as made: cancelled in the middle they are kept, taken up again they give what an undisturbed job gives. */
static void test_tolerance(void)
{
  struct eo_service *service = start();
  enum eo_job_outcome outcome;
  struct eo_job_view job;
  struct eo_design many = design, few = design;
  many.tolerance.pairs = 300;
  few.tolerance.pairs = 20;
  few.tolerance.limits = 1;
  few.tolerance.limit[0] = (struct eo_tolerance_limit){.output = "peak_to_peak_um", .most = 1};
  int64_t id = submit(service, EO_JOB_TOLERANCE, &many, "pairs", &outcome);
  ok(wait_for_evaluations(service, id, 30), "a tolerance analysis computes pairs");
  ok(!eo_service_cancel(service, id, &outcome, &job, &error) && !outcome && wait_for(service, id, "cancelled"),
     "the tolerance analysis is stopped");
  eo_job_view_done(&job);
  int kept = progress_of(service, id, "true_evaluations");
  int64_t other = submit(service, EO_JOB_TOLERANCE, &few, NULL, &outcome);
  ok(wait_for(service, other, "done") && progress_of(service, other, "reused") == 20,
     "another job takes its pairs over, whatever its limits and their number");
  eo_service_free(service);
  service = start();
  ok(!eo_service_retry(service, id, &outcome, &job, &error) && !outcome && wait_for(service, id, "done"),
     "the tolerance analysis goes on from %d pairs", kept);
  eo_job_view_done(&job);
  ok(kept < 300 && progress_of(service, id, "true_evaluations") == 300 && progress_of(service, id, "reused") == 0,
     "the tolerance analysis comes to all of its pairs");
  char *interrupted = result_of(service, id);
  eo_service_free(service);
  empty_folder();
  service = start();
  id = submit(service, EO_JOB_TOLERANCE, &many, NULL, &outcome);
  ok(wait_for(service, id, "done"), "the same tolerance analysis runs undisturbed");
  char *result = result_of(service, id);
  ok(interrupted && result && strcmp(interrupted, result) == 0,
     "a tolerance analysis with a stop gives the same bytes");
  free(interrupted);
  free(result);
  eo_service_free(service);
}

/* An order of any size is refused before it costs anything. */
static void test_tolerance_bounds(void)
{
  struct eo_service_settings settings = {.data = folder, .threads = 2};
  struct eo_service *service = NULL;
  struct eo_design many = design;
  enum eo_job_outcome outcome;
  struct eo_job_view job;
  const struct eo_job_order order = {.kind = EO_JOB_TOLERANCE, .design = &many};
  eo_table_defaults(&eo_service_limits_table, &settings.limits);
  settings.limits.pair_memory_MB = 200;
  many.tolerance.pairs = 100000;
  ok(!eo_service_new(&service, &settings, &error), "a service with little memory is made");
  ok(eo_service_submit(service, &order, &outcome, &job, &error) == EO_ERROR_INPUT &&
         strcmp(error.pointer, "/tolerance/pairs") == 0,
     "a tolerance analysis beyond the memory is refused: %s", error.text);
  eo_job_view_done(&job);
  many.tolerance.pairs = 100;
  many.tolerance.limits = 1;
  many.tolerance.limit[0] = (struct eo_tolerance_limit){.output = "loudness"};
  ok(eo_service_submit(service, &order, &outcome, &job, &error) == EO_ERROR_INPUT &&
         strcmp(error.pointer, "/tolerance/limits/0/output") == 0,
     "a limit on what is not computed is refused: %s", error.text);
  eo_job_view_done(&job);
  eo_service_free(service);
}

static void test_full(void)
{
  struct eo_service *service = start_with(2, 0);
  enum eo_job_outcome outcome = EO_JOB_OUTCOME_DONE;
  struct eo_job_page page;
  for (int i = 0; i < 10 && !outcome; i++)
    submit(service, EO_JOB_OPTIMIZE, &design, NULL, &outcome);
  ok(outcome == EO_JOB_OUTCOME_FULL, "a full queue is told");
  ok(!eo_service_jobs(service, -1, -1, 0, 1, &page, &error) && page.count == 1 && page.more, "jobs come in pages");
  eo_job_page_done(&page);
  eo_service_free(service);
}

/* A study that cannot be: its settings are found wrong only when it begins. */
static void test_failure(void)
{
  struct eo_service *service = start();
  struct eo_design wrong = design;
  enum eo_job_outcome outcome;
  wrong.gear_pair.helix_angle = 0.7;
  wrong.gear_pair.face_width = 400e-3;
  wrong.resolution.positions = 8;
  int64_t id = submit(service, EO_JOB_OPTIMIZE, &wrong, NULL, &outcome);
  json_t *job = NULL;
  for (int i = 0; i < 12000; i++) {
    json_decref(job);
    job = look(service, id);
    if (json_string_value(json_object_get(job, "finished")))
      break;
    pause_for(5);
  }
  const char *state = json_string_value(json_object_get(job, "state"));
  ok(state && strcmp(state, "failed") == 0 && json_is_string(eo_json_find(job, "error/detail")),
     "a job that fails says why: %s", json_string_value(eo_json_find(job, "error/detail")));
  json_decref(job);
  eo_service_free(service);
}

/* Looks at the newest job as fast as it can until told to stop; counts what is said of an end that was not yet noted.
 */
struct watching {
  struct eo_service *service;
  atomic_bool stop;
  int ends, torn;
};

static void *watch_ends(void *argument)
{
  struct watching *w = argument;
  while (!atomic_load(&w->stop)) {
    struct eo_job_page page = {0};
    eo_service_jobs(w->service, -1, EO_JOB_OPTIMIZE, 0, 1, &page, NULL);
    json_t *job = page.count ? eo_job_view_encode(page.job) : NULL;
    const char *state = json_string_value(json_object_get(job, "state"));
    bool done = state && strcmp(state, "done") == 0;
    w->ends += done;
    w->torn += done && eo_json_find_number(job, "progress/fraction") != 1;
    json_decref(job);
    eo_job_page_done(&page);
  }
  return NULL;
}

/* A job that is done says so with its last numbers, whenever it is looked at. */
static void test_ends(void)
{
  enum { JOBS = 6 };
  struct eo_service *service = start();
  struct watching watching = {.service = service};
  struct eo_design small = design;
  enum eo_job_outcome outcome;
  pthread_t thread;
  small.optimization.search.true_evaluations = 12;
  small.optimization.search.population = 12;
  pthread_create(&thread, NULL, watch_ends, &watching);
  for (int i = 0; i < JOBS; i++) {
    small.optimization.search.seed = (uint64_t)(1 + i);
    wait_for(service, submit(service, EO_JOB_OPTIMIZE, &small, NULL, &outcome), "done");
  }
  atomic_store(&watching.stop, true);
  pthread_join(thread, NULL);
  ok(watching.ends > JOBS && !watching.torn, "the job is seen done %d times, %d of them before it was", watching.ends,
     watching.torn);
  eo_service_free(service);
}

/* The process ended after the study and before the last note: the row knows better. */
static void test_stale_note(void)
{
  const struct eo_stored_job job = {
      .id = 1,
      .design = "{}",
      .name = "",
      .algorithm = "ga",
      .state = EO_JOB_CANCELLED,
      .stopped = "cancelled",
      .true_evaluations = 400,
      .individuals = 500,
      .best_value = 0.5,
      .result = "",
      .created = "",
      .updated = "",
      .error = "",
      .started = "",
      .finished = "",
      .progress = "{\"progress\":{\"fraction\":0.99,\"true_evaluations\":399,\"individuals\":499,\"pfc_percent\":80}}"};
  struct eo_job_view view;
  eo_job_view_init(&view, &job, NULL, false, &error);
  json_t *document = eo_job_view_encode(&view);
  eo_job_view_done(&view);
  ok(eo_json_find_number(document, "progress/true_evaluations") == 400 &&
         eo_json_find_number(document, "progress/individuals") == 500 &&
         eo_json_find_number(document, "progress/pfc_percent") == 80,
     "notes of a job do not hide what its row knows");
  json_decref(document);
}

static void test_park(void)
{
  struct eo_service *service = start();
  enum eo_job_outcome outcome;
  struct answered answered = {0};
  int64_t id = submit(service, EO_JOB_OPTIMIZE, &design, NULL, &outcome), job;
  wait_for_evaluations(service, id, 40);
  struct eo_service *second = NULL;
  const struct eo_service_settings settings = {.data = folder};
  ok(eo_service_new(&second, &settings, &error) == EO_ERROR_FILE && strstr(error.text, "Another server"),
     "a second service is refused: %s", error.text);
  struct eo_design other = design;
  other.resolution.positions = 20;
  ask(service, &other, "", 60, &answered, &job);
  double asked = eo_clock_milliseconds();
  eo_service_stop(service);
  ok(submit(service, EO_JOB_OPTIMIZE, &design, NULL, &outcome) == 0 && outcome == EO_JOB_OUTCOME_CLOSED &&
         ask(service, &design, "", 0, &answered, &job) == EO_ADMISSION_CLOSED,
     "a service that has stopped takes nothing");
  eo_service_free(service);
  ok(eo_clock_milliseconds() - asked < 20000 && answered.count == 1 &&
         (answered.last.kind == EO_ANSWER_STOPPED || answered.last.kind == EO_ANSWER_DONE),
     "a service stops within %.0f ms and answers who waits", eo_clock_milliseconds() - asked);
  eo_text_done(&answered.last.text);
  struct eo_store *store = NULL;
  eo_store_open(&store, folder, EO_STORE_WRITE, &error);
  int64_t count[EO_JOB_STATES];
  eo_queue_count(store, count, &error);
  ok(count[EO_JOB_QUEUED] >= 1 && count[EO_JOB_RUNNING] == 0 && count[EO_JOB_CANCELLED] == 0,
     "a job that ran at the stop is parked");
  eo_store_close(store);
  service = start();
  ok(wait_for(service, id, "done"), "the next service goes on with the parked job");
  char *result = result_of(service, id);
  ok(result && undisturbed && strlen(result) > 1000, "the parked job comes to its result");
  free(result);
  json_t *done = look(service, id);
  ok(json_integer_value(json_object_get(done, "attempts")) == 2, "the parked job ends at its second attempt");
  json_decref(done);
  eo_service_free(service);
}

int main(void)
{
  void (*const test[])(void) = {
      test_analysis,  test_left_out,         test_overtaking, test_sweep,   test_pairs, test_job,        test_cancel,
      test_tolerance, test_tolerance_bounds, test_full,       test_failure, test_ends,  test_stale_note, test_park};
  if (!make_folder())
    return 99;
  make_design(&design, BUDGET);
  for (size_t i = 0; i < sizeof test / sizeof test[0]; i++) {
    empty_folder();
    test[i]();
  }
  free(undisturbed);
  empty_folder();
  rmdir(folder);
  return tap_done();
}
