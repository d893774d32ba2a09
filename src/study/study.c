/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/study_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "store/lock.h"
#include "study/study_crew.h"

static double wall(void)
{
  return 1e-3 * eo_clock_milliseconds();
}

static double budget_fraction(const struct study *s, int extra)
{
  double budget = eo_optimizer_budget(&s->settings), share = 0, most;
  int generations;
  eo_optimizer_generations(s->optimizer, &generations);
  share = (eo_optimizer_counters(s->optimizer).true_evaluations + extra) / budget;
  most = s->settings.algorithm == EO_GA || s->settings.algorithm == EO_FPGA
             ? (double)generations / s->settings.generations
             : 0;
  return fmin(fmax(share, most), 1);
}

/* Only what was computed tells how long the rest takes. */
static double time_left(const struct study *s, double fraction, double now)
{
  if (!(s->first_computed > 0) || !(fraction > s->fraction_before))
    return NAN;
  return (now - s->first_computed) * (1 - fraction) / (fraction - s->fraction_before);
}

int eo_study_tell_progress(struct study *s, int extra)
{
  struct eo_study_report report = {.job = s->job.id, .unmodified = &s->result->unmodified, .best = &s->result->best};
  if (!s->plan->watch)
    return 0;
  struct eo_counters counters = eo_optimizer_counters(s->optimizer);
  double now = wall();
  report.history = eo_optimizer_generations(s->optimizer, &report.generation);
  report.true_evaluations = counters.true_evaluations + extra;
  report.predicted = counters.predicted;
  report.repeated = counters.reused;
  report.reused = s->result->reused;
  report.individuals = counters.individuals + extra;
  report.fraction = budget_fraction(s, extra);
  report.seconds = now - s->started;
  report.seconds_left = time_left(s, report.fraction, now);
  return s->plan->watch(s->plan->context, &report);
}

static int report_within(void *context, const char *what, double fraction)
{
  struct study *s = context;
  (void)what;
  return eo_study_tell_progress(s, s->batch.count - s->missing_count + (int)(fraction * s->missing_count + 0.5));
}

static enum eo_code work(void *context, int thread, int item, struct eo_error *error)
{
  struct study *s = context;
  return eo_study_compute_row(s, &s->worker[thread], eo_rows_at(&s->row, s->missing[item]), error);
}

/* Rows of the batch behind those already told, and which of them have to be computed. */
static enum eo_code lay_out(struct study *s, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  if (s->batch.count > s->missing_capacity) {
    int *more = realloc(s->missing, sizeof *more * (size_t)s->batch.count);
    if (!more)
      return eo_error_memory(error);
    s->missing = more;
    s->missing_capacity = s->batch.count;
  }
  s->missing_count = 0;
  for (int i = 0; i < s->batch.count && !code; i++) {
    struct eo_modification modification;
    struct eo_row_data *row;
    eo_study_space_apply(&s->result->space, &s->plan->design->modification, s->batch.candidates[i].x, &modification);
    code = eo_rows_add(&s->row, &modification, s->plan->design->gear_pair.ends, &row, error);
    if (!code)
      code = eo_study_look_up(s, row, error);
    if (!code && !row->point.evaluation)
      s->missing[s->missing_count++] = s->told + i;
  }
  return code;
}

static enum eo_code compute(struct study *s, struct eo_error *error)
{
  const struct eo_progress progress = {.report = report_within, .context = s};
  const struct eo_parallel parallel = {
      .threads = s->result->threads, .work = work, .context = s, .progress = &progress, .what = "", .last = 1};
  if (!s->missing_count)
    return EO_OK;
  if (!(s->first_computed > 0)) {
    s->first_computed = wall();
    s->fraction_before = budget_fraction(s, s->batch.count - s->missing_count);
  }
  double start = wall();
  enum eo_code code = s->plan->crew ? eo_study_compute_on_crew(s, error)
                                    : eo_parallel_run(&parallel, s->missing_count, error);
  s->result->model_seconds += wall() - start;
  return code;
}

static enum eo_code log_candidate(struct study *s, int i, bool known, struct eo_error *error)
{
  const struct eo_row_data *row = eo_rows_at(&s->row, s->told + i);
  struct eo_stored_candidate candidate = {.job = s->job.id,
                                          .evaluation = row->point.evaluation,
                                          .ordinal = s->told - s->result->imported + i,
                                          .generation = s->batch.candidates[i].generation,
                                          .individual = s->batch.candidates[i].individual,
                                          .reused = known,
                                          .x = s->batch.candidates[i].x,
                                          .size = s->result->space.count};
  enum eo_code code = eo_store_log_candidate(s->plan->store, &candidate, error);
  s->result->reused += !code && candidate.reused;
  return code;
}

static enum eo_code log_predictions(struct study *s, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  for (int i = 0; i < s->batch.predictions_count && !code; i++) {
    const struct eo_predicted *p = &s->batch.predictions[i];
    const struct eo_stored_prediction prediction = {.job = s->job.id,
                                                    .generation = p->generation,
                                                    .individual = p->individual,
                                                    .fitness = p->fitness,
                                                    .credibility = p->credibility,
                                                    .x = p->x,
                                                    .size = s->result->space.count};
    code = eo_store_log_prediction(s->plan->store, &prediction, error);
  }
  return code;
}

/* Whatever was computed is kept, of a batch that was cut short too. */
static enum eo_code save_rows(struct study *s, bool whole, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  for (int i = 0; i < s->batch.count && !code; i++) {
    struct eo_row_data *row = eo_rows_at(&s->row, s->told + i);
    bool computed = row->computed;
    if (computed)
      code = eo_study_save_row(s, row, error);
    s->result->computed += computed;
    row->computed = false;
    if (!code && (computed || whole))
      code = log_candidate(s, i, !computed, error);
  }
  return code;
}

static void sum_up(struct study *s, enum eo_job_state state, const char *stopped)
{
  struct eo_counters counters = eo_optimizer_counters(s->optimizer);
  s->job.state = state;
  s->job.stopped = stopped;
  s->job.true_evaluations = counters.true_evaluations;
  s->job.individuals = counters.individuals;
  s->job.best = s->result->best.evaluation;
  s->job.best_value = s->result->best.there ? s->result->best.rank : NAN;
}

static enum eo_code save_batch(struct study *s, bool whole, struct eo_error *error)
{
  double start = wall();
  enum eo_code code = eo_store_begin(s->plan->store, error);
  if (!code)
    code = save_rows(s, whole, error);
  if (!code && whole)
    code = log_predictions(s, error);
  sum_up(s, EO_JOB_RUNNING, "");
  if (!code)
    code = eo_store_update_job(s->plan->store, &s->job, error);
  if (!code)
    code = eo_store_commit(s->plan->store, error);
  if (code)
    eo_store_rollback(s->plan->store);
  s->result->store_seconds += wall() - start;
  return code;
}

static enum eo_code copy_point(const struct study *s, const struct eo_study_point *from, struct eo_study_point *to,
                               struct eo_error *error)
{
  struct eo_objective_case *raw = to->raw ? to->raw : malloc(sizeof *raw * (size_t)s->row.values);
  if (!raw)
    return eo_error_memory(error);
  *to = *from;
  to->raw = raw;
  memcpy(raw, from->raw, sizeof *raw * (size_t)s->row.values);
  return EO_OK;
}

static enum eo_code note_best(struct study *s, struct eo_error *error)
{
  int best = eo_optimizer_best(s->optimizer);
  if (best < 0 || eo_rows_at(&s->row, best)->point.evaluation == s->result->best.evaluation)
    return EO_OK;
  return copy_point(s, &eo_rows_at(&s->row, best)->point, &s->result->best, error);
}

static enum eo_code tell(struct study *s, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  double objectives[3];
  for (int i = 0; i < s->batch.count && !code; i++) {
    struct eo_row_data *row = eo_rows_at(&s->row, s->told + i);
    eo_study_weigh(s, &row->point);
    s->result->failed += !row->point.there;
    struct eo_outcome outcome = eo_study_outcome(s, row, objectives);
    code = eo_optimizer_tell(s->optimizer, i, &outcome, error);
  }
  s->told += s->batch.count;
  return code ? code : note_best(s, error);
}

/* One batch; *more is false when the optimizer is through. EO_ERROR_CANCELLED: a stop was asked for. */
static enum eo_code run_batch(struct study *s, bool *more, struct eo_error *error)
{
  double start = wall();
  enum eo_code code = eo_optimizer_ask(s->optimizer, &s->batch, error);
  s->result->optimizer_seconds += wall() - start;
  *more = !code && s->batch.count > 0;
  if (code)
    return code;
  if (*more)
    code = lay_out(s, error);
  if (!code)
    code = compute(s, error);
  if (code && code != EO_ERROR_CANCELLED)
    return code;
  enum eo_code saved = save_batch(s, !code, error);
  if (code || saved || !*more)
    return saved ? saved : code;
  start = wall();
  code = tell(s, error);
  s->result->optimizer_seconds += wall() - start;
  if (!code && eo_study_tell_progress(s, 0))
    code = eo_error_set(error, EO_ERROR_CANCELLED, "", "The study was stopped.");
  return code;
}

static enum eo_code collect_generations(struct study *s, struct eo_error *error)
{
  struct eo_study_result *r = s->result;
  const struct eo_generation *g = eo_optimizer_generations(s->optimizer, &r->generations);
  int *count = calloc((size_t)r->generations + 1, sizeof *count);
  r->generation = calloc((size_t)r->generations + 1, sizeof *r->generation);
  if (!count || !r->generation) {
    free(count);
    return eo_error_memory(error);
  }
  for (int i = 0; i < r->generations; i++)
    r->generation[i] = (struct eo_study_generation){
        g[i].true_count, g[i].predicted_count, g[i].reused_count, g[i].history_rows, g[i].epoch, g[i].best_value, 0};
  for (int i = r->imported; i < s->told; i++) {
    const struct eo_row row = eo_optimizer_row(s->optimizer, i);
    if (row.generation < r->generations && !row.failed) {
      r->generation[row.generation].mean += row.value;
      count[row.generation]++;
    }
  }
  for (int i = 0; i < r->generations; i++)
    r->generation[i].mean = count[i] ? r->generation[i].mean / count[i] : NAN;
  free(count);
  return EO_OK;
}

static enum eo_code collect_front(struct study *s, struct eo_error *error)
{
  struct eo_study_result *r = s->result;
  r->knee = r->weighted = -1;
  if (s->settings.algorithm != EO_NSGA2 || !s->told)
    return EO_OK;
  int *index = malloc(sizeof *index * (size_t)s->told);
  r->front = calloc((size_t)s->told, sizeof *r->front);
  if (!index || !r->front) {
    free(index);
    return eo_error_memory(error);
  }
  struct eo_front front = eo_optimizer_front(s->optimizer, index);
  r->front_count = front.count;
  for (int i = 0; i < front.count; i++) {
    r->front[i] = eo_rows_at(&s->row, index[i])->point;
    r->front[i].raw = NULL;
    r->knee = index[i] == front.knee ? i : r->knee;
    r->weighted = index[i] == front.weighted ? i : r->weighted;
  }
  free(index);
  return EO_OK;
}

static enum eo_code finish(struct study *s, bool cancelled, struct eo_error *error)
{
  struct eo_study_result *r = s->result;
  struct eo_counters counters = eo_optimizer_counters(s->optimizer);
  r->individuals = counters.individuals;
  r->true_evaluations = counters.true_evaluations;
  r->predicted = counters.predicted;
  r->repeated = counters.reused;
  r->stopped = cancelled                                                        ? EO_STOP_CANCELLED
               : counters.true_evaluations >= eo_optimizer_budget(&s->settings) ? EO_STOP_BUDGET
                                                                                : EO_STOP_CONVERGED;
  if (!cancelled && (s->settings.algorithm == EO_GA || s->settings.algorithm == EO_FPGA))
    r->stopped = EO_STOP_BUDGET; /* its generations are its budget */
  enum eo_code code = collect_generations(s, error);
  if (!code)
    code = collect_front(s, error);
  sum_up(s, cancelled ? EO_JOB_CANCELLED : EO_JOB_DONE, eo_study_stop_name(r->stopped));
  return code ? code : eo_store_update_job(s->plan->store, &s->job, error);
}

static void release(struct study *s)
{
  if (s->job.id)
    eo_store_release_job(s->plan->store, s->job.id);
  for (int i = 0; i < EO_MAX_THREADS; i++) {
    eo_evaluator_free(s->worker[i].evaluator);
    free(s->worker[i].design);
  }
  eo_rows_done(&s->row);
  eo_optimizer_free(s->optimizer);
  eo_text_done(&s->design);
  eo_text_done(&s->problem);
  free(s->anatomy.group);
  free(s->part);
  free(s->missing);
  free(s->scratch);
  free(s);
}

enum eo_code eo_study_run(const struct eo_study_plan *plan, struct eo_study_result *result, struct eo_error *error)
{
  struct study *s = calloc(1, sizeof *s);
  bool more = true;
  *result = (struct eo_study_result){.knee = -1, .weighted = -1};
  if (!s)
    return eo_error_memory(error);
  s->plan = plan;
  s->result = result;
  s->started = wall();
  enum eo_code code = eo_study_begin(s, error);
  if (!code)
    code = note_best(s, error);
  if (!code && eo_study_tell_progress(s, 0))
    code = EO_ERROR_CANCELLED;
  while (!code && more)
    code = run_batch(s, &more, error);
  if (!code || code == EO_ERROR_CANCELLED)
    code = finish(s, code == EO_ERROR_CANCELLED, error);
  result->seconds = wall() - s->started;
  release(s);
  return code;
}
