/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/study_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "design/design_grids.h"
#include "store/lock.h"
#include "study/study_crew.h"

static double wall(void)
{
  return 1e-3 * eo_clock_milliseconds();
}

static double budget_fraction(const struct study *study, int extra)
{
  double budget = eo_optimizer_budget(&study->settings), share = 0, most;
  int generations;
  eo_optimizer_generations(study->optimizer, &generations);
  share = (eo_optimizer_counters(study->optimizer).true_evaluations + extra) / budget;
  most = study->settings.algorithm == EO_GA || study->settings.algorithm == EO_FPGA
             ? (double)generations / study->settings.generations
             : 0;
  return fmin(fmax(share, most), 1);
}

/* Only what was computed tells how long the rest takes. */
static double time_left(const struct study *study, double fraction, double now)
{
  if (!(study->first_computed > 0) || !(fraction > study->fraction_before))
    return NAN;
  return (now - study->first_computed) * (1 - fraction) / (fraction - study->fraction_before);
}

int eo_study_tell_progress(struct study *study, int extra)
{
  struct eo_study_report report = {
      .job = study->job.id, .unmodified = &study->result->unmodified, .best = &study->result->best};
  if (!study->plan->watch)
    return 0;
  struct eo_counters counters = eo_optimizer_counters(study->optimizer);
  double now = wall();
  report.history = eo_optimizer_generations(study->optimizer, &report.generation);
  report.true_evaluations = counters.true_evaluations + extra;
  report.predicted = counters.predicted;
  report.repeated = counters.reused;
  report.reused = study->result->reused;
  report.individuals = counters.individuals + extra;
  report.fraction = budget_fraction(study, extra);
  report.seconds = now - study->started;
  report.seconds_left = time_left(study, report.fraction, now);
  return study->plan->watch(study->plan->context, &report);
}

static int report_within(void *context, const char *what, double fraction)
{
  struct study *study = context;
  (void)what;
  return eo_study_tell_progress(study, study->batch.count - study->missing_count +
                                           (int)(fraction * study->missing_count + 0.5));
}

static enum eo_code work(void *context, int thread, int item, struct eo_error *error)
{
  struct study *study = context;
  return eo_study_compute_row(study, &study->worker[thread], eo_rows_at(&study->row, study->missing[item]),
                              study->target, error);
}

/* Rows of the batch behind those already told, and which of them have to be computed. */
static enum eo_code lay_out(struct study *study, struct eo_error *error)
{
  if (study->batch.count > study->missing_capacity) {
    int *more = realloc(study->missing, sizeof *more * (size_t)study->batch.count);
    if (!more)
      return eo_error_memory(error);
    study->missing = more;
    study->missing_capacity = study->batch.count;
  }
  study->missing_count = 0;
  study->target = study->race.first ? study->race.first : study->result->scenarios;
  for (int i = 0; i < study->batch.count; i++) {
    struct eo_modification modification;
    struct eo_row_data *row;
    eo_study_space_apply(&study->result->space, &study->plan->design->modification, study->batch.candidates[i].x,
                         &modification);
    EO_TRY(eo_rows_add(&study->row, &modification, study->plan->design->gear_pair.ends, &row, error));
    EO_TRY(eo_study_look_up(study, row, error));
    memcpy(row->x, study->batch.candidates[i].x, sizeof *row->x * (size_t)study->result->space.count);
    if (!row->point.evaluation)
      study->missing[study->missing_count++] = study->told + i;
  }
  return EO_OK;
}

static enum eo_code compute(struct study *study, struct eo_error *error)
{
  const struct eo_progress progress = {.report = report_within, .context = study};
  const struct eo_parallel parallel = {
      .threads = study->result->threads, .work = work, .context = study, .progress = &progress, .what = "", .last = 1};
  if (!study->missing_count)
    return EO_OK;
  if (!(study->first_computed > 0)) {
    study->first_computed = wall();
    study->fraction_before = budget_fraction(study, study->batch.count - study->missing_count);
  }
  double start = wall();
  enum eo_code code = study->plan->crew ? eo_study_compute_on_crew(study, error)
                                        : eo_parallel_run(&parallel, study->missing_count, error);
  study->result->model_seconds += wall() - start;
  return code;
}

static enum eo_code log_candidate(struct study *study, int i, bool known, struct eo_error *error)
{
  const struct eo_row_data *row = eo_rows_at(&study->row, study->told + i);
  struct eo_stored_candidate candidate = {.job = study->job.id,
                                          .evaluation = row->point.evaluation,
                                          .ordinal = study->told - study->result->imported + i,
                                          .generation = study->batch.candidates[i].generation,
                                          .individual = study->batch.candidates[i].individual,
                                          .reused = known,
                                          .x = study->batch.candidates[i].x,
                                          .size = study->result->space.count};
  enum eo_code code = eo_store_log_candidate(study->plan->store, &candidate, error);
  study->result->reused += !code && candidate.reused;
  return code;
}

static enum eo_code log_predictions(struct study *study, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  for (int i = 0; i < study->batch.predictions_count && !code; i++) {
    const struct eo_predicted *predicted = &study->batch.predictions[i];
    const struct eo_stored_prediction prediction = {.job = study->job.id,
                                                    .generation = predicted->generation,
                                                    .individual = predicted->individual,
                                                    .fitness = predicted->fitness,
                                                    .credibility = predicted->credibility,
                                                    .x = predicted->x,
                                                    .size = study->result->space.count};
    code = eo_store_log_prediction(study->plan->store, &prediction, error);
  }
  return code;
}

/* Whatever was computed is kept, of a batch that was cut short too. */
static enum eo_code save_rows(struct study *study, bool whole, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  for (int i = 0; i < study->batch.count && !code; i++) {
    struct eo_row_data *row = eo_rows_at(&study->row, study->told + i);
    bool computed = row->computed;
    if (computed)
      code = eo_study_save_row(study, row, error);
    study->result->computed += computed;
    row->computed = false;
    if (!code && (computed || whole))
      code = log_candidate(study, i, !computed, error);
  }
  return code;
}

static void sum_up(struct study *study, enum eo_job_state state, const char *stopped)
{
  struct eo_counters counters = eo_optimizer_counters(study->optimizer);
  study->job.state = state;
  study->job.stopped = stopped;
  study->job.true_evaluations = counters.true_evaluations;
  study->job.individuals = counters.individuals;
  study->job.best = study->result->best.evaluation;
  study->job.best_value = study->result->best.there ? study->result->best.rank : NAN;
}

static enum eo_code write_batch(struct study *study, bool whole, struct eo_error *error)
{
  EO_TRY(save_rows(study, whole, error));
  if (whole)
    EO_TRY(log_predictions(study, error));
  sum_up(study, EO_JOB_RUNNING, "");
  return eo_store_update_job(study->plan->store, &study->job, error);
}

static enum eo_code save_batch(struct study *study, bool whole, struct eo_error *error)
{
  double start = wall();
  EO_TRY(eo_store_begin(study->plan->store, error));
  enum eo_code code = eo_store_end(study->plan->store, write_batch(study, whole, error), error);
  study->result->store_seconds += wall() - start;
  return code;
}

static enum eo_code copy_point(const struct study *study, const struct eo_study_point *from, struct eo_study_point *to,
                               struct eo_error *error)
{
  struct eo_objective_case *raw = to->raw ? to->raw : malloc(sizeof *raw * (size_t)study->row.values);
  if (!raw)
    return eo_error_memory(error);
  *to = *from;
  to->raw = raw;
  memcpy(raw, from->raw, sizeof *raw * (size_t)study->row.values);
  return EO_OK;
}

static enum eo_code note_best(struct study *study, struct eo_error *error)
{
  int best = eo_optimizer_best(study->optimizer);
  if (best < 0 || eo_rows_at(&study->row, best)->point.evaluation == study->result->best.evaluation)
    return EO_OK;
  return copy_point(study, &eo_rows_at(&study->row, best)->point, &study->result->best, error);
}

static enum eo_code tell(struct study *study, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  double objectives[EO_MAX_OBJECTIVES];
  for (int i = 0; i < study->batch.count; i++)
    eo_race_settle(study, eo_rows_at(&study->row, study->told + i));
  for (int i = 0; i < study->batch.count && !code; i++) {
    struct eo_row_data *row = eo_rows_at(&study->row, study->told + i);
    study->result->failed += !row->point.there;
    struct eo_outcome outcome = eo_study_outcome(study, row, objectives);
    code = eo_optimizer_tell(study->optimizer, i, &outcome, error);
  }
  study->told += study->batch.count;
  return code ? code : note_best(study, error);
}

/* Whether the search could have asked for flanks that take nothing off: where the variables that the unmodified pair
   has within their bounds, the others as near to it as they come, leave none, a relief's start among them. */
static bool can_be_unmodified(struct study *study)
{
  const struct eo_study_space *space = &study->result->space;
  double x[EO_MAX_LISTED];
  for (int i = 0; i < space->count; i++) {
    const struct eo_study_variable *variable = &space->variable[i];
    double value = eo_study_variable_value(variable, &study->result->unmodified.modification);
    x[i] = fmin(fmax((value - variable->low) / (variable->high - variable->low), 0), 1);
  }
  eo_study_space_apply(space, &study->plan->design->modification, x, &study->scratch->modification);
  return eo_design_is_unmodified(study->scratch);
}

/* The unmodified pair is evaluated for reference alone: where the search may choose it, nothing less fit is its best.
 */
static enum eo_code settle_best(struct study *study, struct eo_error *error)
{
  struct eo_study_result *result = study->result;
  bool fitter = study->told > 0 && (!result->best.there || result->unmodified.rank < result->best.rank);
  return fitter && can_be_unmodified(study) ? copy_point(study, &result->unmodified, &result->best, error) : EO_OK;
}

static enum eo_code compute_batch(struct study *study, struct eo_error *error)
{
  EO_TRY(lay_out(study, error));
  EO_TRY(compute(study, error));
  if (!study->race.first)
    return EO_OK;
  eo_race_choose(study);
  return compute(study, error);
}

/* One batch; *more is false when the optimizer is through. EO_ERROR_CANCELLED: a stop was asked for; what was computed
   until then is kept. */
static enum eo_code run_batch(struct study *study, bool *more, struct eo_error *error)
{
  double start = wall();
  *more = false;
  EO_TRY(eo_optimizer_ask(study->optimizer, &study->batch, error));
  study->result->optimizer_seconds += wall() - start;
  *more = study->batch.count > 0;
  enum eo_code code = *more ? compute_batch(study, error) : EO_OK;
  if (code && code != EO_ERROR_CANCELLED)
    return code;
  enum eo_code saved = save_batch(study, !code, error);
  if (code || saved || !*more)
    return saved ? saved : code;
  start = wall();
  EO_TRY(tell(study, error));
  study->result->optimizer_seconds += wall() - start;
  return eo_study_tell_progress(study, 0) ? eo_error_set(error, EO_ERROR_CANCELLED, "", "The study was stopped.")
                                          : EO_OK;
}

static enum eo_code collect_generations(struct study *study, struct eo_error *error)
{
  struct eo_study_result *result = study->result;
  const struct eo_generation *generation = eo_optimizer_generations(study->optimizer, &result->generations);
  int *count = calloc((size_t)result->generations + 1, sizeof *count);
  result->generation = calloc((size_t)result->generations + 1, sizeof *result->generation);
  if (!count || !result->generation) {
    free(count);
    return eo_error_memory(error);
  }
  for (int i = 0; i < result->generations; i++)
    result->generation[i] = (struct eo_study_generation){generation[i].true_count,
                                                         generation[i].predicted_count,
                                                         generation[i].reused_count,
                                                         generation[i].history_rows,
                                                         generation[i].epoch,
                                                         generation[i].best_value,
                                                         0};
  for (int i = result->imported; i < study->told; i++) {
    const struct eo_row row = eo_optimizer_row(study->optimizer, i);
    if (row.generation < result->generations && !row.failed) {
      result->generation[row.generation].mean += row.value;
      count[row.generation]++;
    }
  }
  for (int i = 0; i < result->generations; i++)
    result->generation[i].mean = count[i] ? result->generation[i].mean / count[i] : NAN;
  free(count);
  return EO_OK;
}

static enum eo_code collect_front(struct study *study, struct eo_error *error)
{
  struct eo_study_result *result = study->result;
  result->knee = result->weighted = -1;
  if (study->settings.algorithm != EO_NSGA2 || !study->told)
    return EO_OK;
  int *index = malloc(sizeof *index * (size_t)study->told);
  result->front = calloc((size_t)study->told, sizeof *result->front);
  if (!index || !result->front) {
    free(index);
    return eo_error_memory(error);
  }
  struct eo_front front = eo_optimizer_front(study->optimizer, index);
  result->front_count = front.count;
  for (int i = 0; i < front.count; i++) {
    result->front[i] = eo_rows_at(&study->row, index[i])->point;
    result->front[i].raw = NULL;
    result->knee = index[i] == front.knee ? i : result->knee;
    result->weighted = index[i] == front.weighted ? i : result->weighted;
  }
  free(index);
  return EO_OK;
}

static enum eo_code finish(struct study *study, bool cancelled, struct eo_error *error)
{
  struct eo_study_result *result = study->result;
  struct eo_counters counters = eo_optimizer_counters(study->optimizer);
  result->individuals = counters.individuals;
  result->whole = study->race.first ? study->race.whole : counters.true_evaluations;
  result->true_evaluations = counters.true_evaluations;
  result->predicted = counters.predicted;
  result->repeated = counters.reused;
  result->stopped = cancelled                                                            ? EO_STOP_CANCELLED
                    : counters.true_evaluations >= eo_optimizer_budget(&study->settings) ? EO_STOP_BUDGET
                                                                                         : EO_STOP_CONVERGED;
  if (!cancelled && (study->settings.algorithm == EO_GA || study->settings.algorithm == EO_FPGA))
    result->stopped = EO_STOP_BUDGET; /* its generations are its budget */
  EO_TRY(collect_generations(study, error));
  EO_TRY(collect_front(study, error));
  EO_TRY(settle_best(study, error));
  sum_up(study, cancelled ? EO_JOB_CANCELLED : EO_JOB_DONE, eo_study_stop_name(result->stopped));
  return eo_store_update_job(study->plan->store, &study->job, error);
}

static void release(struct study *study)
{
  if (study->job.id)
    eo_store_release_job(study->plan->store, study->job.id);
  for (int i = 0; i < EO_MAX_THREADS; i++) {
    eo_evaluator_free(study->worker[i].evaluator);
    free(study->worker[i].design);
  }
  eo_race_end(study);
  eo_rows_done(&study->row);
  eo_optimizer_free(study->optimizer);
  eo_text_done(&study->design);
  eo_text_done(&study->problem);
  free(study->anatomy.group);
  free(study->part);
  free(study->view);
  free(study->missing);
  free(study->scratch);
  free(study);
}

/* Batches until the optimizer is through, or a stop is asked for. */
static enum eo_code run(struct study *study, struct eo_error *error)
{
  EO_TRY(eo_study_begin(study, error));
  EO_TRY(note_best(study, error));
  if (eo_study_tell_progress(study, 0))
    return EO_ERROR_CANCELLED;
  for (bool more = true; more;)
    EO_TRY(run_batch(study, &more, error));
  return EO_OK;
}

enum eo_code eo_study_run(const struct eo_study_plan *plan, struct eo_study_result *result, struct eo_error *error)
{
  struct study *study = calloc(1, sizeof *study);
  *result = (struct eo_study_result){.knee = -1, .weighted = -1};
  if (!study)
    return eo_error_memory(error);
  study->plan = plan;
  study->result = result;
  study->started = wall();
  enum eo_code code = run(study, error);
  if (!code || code == EO_ERROR_CANCELLED)
    code = finish(study, code == EO_ERROR_CANCELLED, error);
  result->seconds = wall() - study->started;
  release(study);
  return code;
}
