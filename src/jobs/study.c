#include "jobs/study.h"

#include "base/parallel.h"
#include "document/json.h"
#include "document/result.h"
#include "evaluation/analysis.h"
#include "jobs/rows.h"
#include "optimizer/optimizer.h"
#include "store/evaluations.h"
#include "store/jobs.h"
#include "store/lock.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* What one thread needs to evaluate. */
struct worker {
  struct eo_evaluator *evaluator; /* owned */
  struct eo_design *design;       /* owned scratch */
};

struct study {
  const struct eo_study_plan *plan;
  struct eo_study_result *result;
  struct eo_stored_job job;
  struct eo_text design, problem; /* JSON */
  char hash[EO_HASH_LENGTH + 1], study_hash[EO_HASH_LENGTH + 1], space_hash[EO_HASH_LENGTH + 1];
  struct eo_optimizer_settings settings;
  struct eo_optimizer *optimizer;
  struct eo_design *scratch;      /* owned */
  struct eo_rows row;             /* true rows, in the optimizer's order; the pending batch behind them */
  int told;                       /* rows the optimizer has */
  int *missing;                   /* [missing_capacity] rows of the pending batch to compute; owned */
  int missing_count, missing_capacity;
  struct worker worker[EO_MAX_THREADS];
  struct eo_batch batch;
  double started, first_computed; /* s; first_computed: 0 until something was */
  double fraction_before;         /* of the work that was done then */
};

static double seconds(clockid_t clock)
{
  struct timespec now;
  clock_gettime(clock, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static double wall(void)
{
  return seconds(CLOCK_MONOTONIC);
}

/* ---- one row ---- */

/* J, fitness and what is minimised, from raw values: any weighting serves any row. */
static void weigh(struct study *s, struct eo_study_point *point)
{
  const struct eo_design *design = s->plan->design;
  s->scratch->modification = point->modification;
  eo_evaluator_combine(s->scratch, &s->plan->pair->geometry, point->raw, s->result->unmodified.raw, &point->value);
  bool normalised = design->objective.normalise == EO_NORMALISE_UNMODIFIED;
  double scale = normalised || !s->result->unmodified.there ? 1 : s->result->unmodified.value.objective;
  point->rank = point->value.sums.failed ? NAN : point->value.objective + design->objective.penalty * point->value.violation * scale;
  point->there = isfinite(point->rank);
}

static void refuse(struct eo_row_data *row, int count, const struct eo_error *error)
{
  row->outcome = EO_EVALUATION_REFUSED;
  snprintf(row->reason, sizeof row->reason, "%.*s", (int)sizeof row->reason - 1, error->text);
  for (int i = 0; i < count; i++)
    row->point.raw[i] = (struct eo_objective_case){NAN, NAN, NAN, NAN, NAN, NAN, NAN, true};
}

static void judge(struct eo_row_data *row, int scenarios, int cases)
{
  row->outcome = EO_EVALUATION_CONVERGED;
  row->reason[0] = '\0';
  for (int i = scenarios * cases - 1; i >= 0; i--) {
    const struct eo_objective_case *c = &row->point.raw[i];
    if (!c->failed && isfinite(c->peak_to_peak) && isfinite(c->impact) && isfinite(c->rms))
      continue;
    row->outcome = EO_EVALUATION_NOT_CONVERGED;
    snprintf(row->reason, sizeof row->reason, "%s did not converge at load case %d%s.", isfinite(c->rms) ? "Contact" : "Vibration or contact",
             i % cases + 1, scenarios > 1 ? " of a scenario" : "");
  }
}

static enum eo_code prepare_worker(struct study *s, struct worker *w, struct eo_error *error)
{
  if (w->evaluator)
    return EO_OK;
  if (!w->design && !(w->design = malloc(sizeof *w->design)))
    return eo_error_memory(error);
  *w->design = *s->plan->design;
  return eo_evaluator_new(&w->evaluator, s->plan->pair, s->result->cases, error);
}

/* What a modification does to the model is an outcome; only what would befall any other row too is an error. */
static enum eo_code compute_row(struct study *s, struct worker *w, struct eo_row_data *row, struct eo_error *error)
{
  struct eo_error found = {0};
  enum eo_code code = prepare_worker(s, w, error);
  if (code)
    return code;
  double start = seconds(CLOCK_THREAD_CPUTIME_ID);
  w->design->modification = row->point.modification;
  code = eo_evaluator_raw(w->evaluator, w->design, row->point.raw, &found);
  row->cost = seconds(CLOCK_THREAD_CPUTIME_ID) - start;
  if (code && code != EO_ERROR_INPUT && code != EO_ERROR_NUMERIC) {
    *error = found;
    return code;
  }
  if (code)
    refuse(row, s->result->scenarios * s->result->cases, &found);
  else
    judge(row, s->result->scenarios, s->result->cases);
  row->computed = true;
  return EO_OK;
}

static struct eo_stored_evaluation stored(const struct study *s, struct eo_row_data *row)
{
  struct eo_stored_evaluation e = {.id = row->point.evaluation, .modification = row->text.data, .outcome = row->outcome, .cost = row->cost,
                                   .scenarios = s->result->scenarios, .cases = s->result->cases, .raw = row->point.raw};
  snprintf(e.reason, sizeof e.reason, "%s", row->reason);
  return e;
}

static void take(struct eo_row_data *row, const struct eo_stored_evaluation *e)
{
  row->point.evaluation = e->id;
  row->outcome = e->outcome;
  row->cost = e->cost;
  snprintf(row->reason, sizeof row->reason, "%s", e->reason);
}

/* point.evaluation stays 0 when the history does not have it. */
static enum eo_code look_up(struct study *s, struct eo_row_data *row, struct eo_error *error)
{
  struct eo_stored_evaluation e = stored(s, row);
  enum eo_code code = eo_store_find_evaluation(s->plan->store, s->job.problem, row->text.data, &e, error);
  if (!code && e.id)
    take(row, &e);
  return code;
}

/* Somebody else may have saved the same row meanwhile; then theirs counts. */
static enum eo_code save_row(struct study *s, struct eo_row_data *row, struct eo_error *error)
{
  struct eo_stored_evaluation e = stored(s, row);
  enum eo_code code = eo_store_add_evaluation(s->plan->store, s->job.problem, &e, error);
  if (!code)
    take(row, &e);
  return code;
}

/* ---- before the loop ---- */

static enum eo_code describe(struct study *s, struct eo_error *error)
{
  const struct eo_design *design = s->plan->design;
  struct eo_text problem = {0};
  json_t *document = eo_design_encode(design);
  enum eo_code code = eo_design_problem(design, &s->problem, s->hash, error);
  if (document) {
    eo_json_write(&s->design, document, EO_JSON_COMPACT);
    json_object_del(document, "name");
    eo_json_write(&problem, document, EO_JSON_CANONICAL);
  }
  if (!code && (!document || s->design.failed || problem.failed))
    code = eo_error_memory(error);
  /* the problem's hash carries the evaluator's version: a job of an older model is another study */
  if (!code)
    eo_text_add(&problem, s->hash);
  if (!code && problem.failed)
    code = eo_error_memory(error);
  if (!code)
    eo_hash_hex(problem.data, problem.size, s->study_hash);
  eo_text_done(&problem);
  json_decref(document);
  return code;
}

static enum eo_code new_job(struct study *s, struct eo_error *error)
{
  bool taken = false;
  s->job.space = s->space_hash;
  s->job.design = s->design.data;
  s->job.name = s->plan->design->name;
  s->job.algorithm = s->plan->design->optimization.algorithm;
  s->job.state = EO_JOB_RUNNING;
  s->job.best_value = NAN;
  enum eo_code code = eo_store_add_job(s->plan->store, &s->job, error);
  return code ? code : eo_store_claim_job(s->plan->store, s->job.id, &taken, error);
}

static enum eo_code find_job(struct study *s, struct eo_error *error)
{
  struct eo_store *store = s->plan->store;
  const struct eo_stored_problem problem = {.hash = s->hash, .spec = s->problem.data, .name = s->plan->design->name, .evaluator = EO_EVALUATOR_VERSION,
                                            .scenarios = s->result->scenarios, .cases = s->result->cases};
  enum eo_code code = eo_store_begin(store, error);
  if (!code)
    code = eo_store_find_problem(store, &problem, &s->job.problem, error);
  s->job.study = s->study_hash;
  s->job.fresh = s->plan->fresh;
  if (!code && !s->plan->restart)
    code = eo_store_resume_job(store, s->study_hash, s->plan->fresh, &s->job, error);
  s->result->resumed = s->job.id != 0;
  if (!code && !s->job.id)
    code = new_job(s, error);
  if (!code)
    code = eo_store_commit(store, error);
  if (code)
    eo_store_rollback(store);
  s->result->job = s->job.id;
  return code;
}

/* The unmodified pair is a row of the history like any other. */
static enum eo_code find_unmodified(struct study *s, struct eo_error *error)
{
  struct eo_rows rows = {.values = s->result->scenarios * s->result->cases};
  struct eo_row_data *row;
  struct eo_modification none;
  memset(&none, 0, sizeof none);
  enum eo_code code = eo_rows_add(&rows, &none, s->plan->design->gear_pair.ends, &row, error);
  if (!code)
    code = look_up(s, row, error);
  if (!code && !row->point.evaluation) {
    code = compute_row(s, &s->worker[0], row, error);
    if (!code)
      code = eo_store_begin(s->plan->store, error);
    if (!code)
      code = save_row(s, row, error);
    if (!code)
      code = eo_store_commit(s->plan->store, error);
    if (code)
      eo_store_rollback(s->plan->store);
  }
  if (!code) {
    s->result->unmodified = row->point;
    row->point.raw = NULL;
    weigh(s, &s->result->unmodified);
    if (!s->result->unmodified.there)
      code = eo_error_set(error, EO_ERROR_INPUT, "/load_cases", "The unmodified pair, to which the objectives relate, has no objective: %s",
                          row->reason[0] ? row->reason : "all of its values are zero.");
  }
  eo_rows_done(&rows);
  return code;
}

static struct eo_outcome outcome_of(const struct study *s, const struct eo_row_data *row, double objectives[3])
{
  const struct eo_objective_sums *own = &row->point.value.sums, *before = &s->result->unmodified.value.sums;
  for (int i = 0; i < 3; i++)
    objectives[i] = before->f[i] > 0 ? own->f[i] / before->f[i] : own->f[i];
  return (struct eo_outcome){.failed = !row->point.there, .value = row->point.rank, .violation = row->point.value.violation, .objectives = objectives};
}

/* One row of other jobs, if this study can ask for it. x: bit for bit as it was asked for in the same space, so that it is found again. */
static enum eo_code import(void *context, const struct eo_stored_evaluation *e, const double *x, int size, struct eo_error *error)
{
  struct study *s = context;
  struct eo_row_data *row;
  struct eo_modification modification;
  double point[EO_MAX_LISTED], objectives[3];
  const struct eo_modification *base = &s->plan->design->modification;
  enum eo_code code = eo_modification_read(e->modification, &modification, error);
  if (code || !eo_study_space_locate(&s->result->space, base, &modification, point))
    return code;
  code = eo_rows_add(&s->row, &modification, s->plan->design->gear_pair.ends, &row, error);
  if (code)
    return code;
  memcpy(row->point.raw, e->raw, sizeof *e->raw * (size_t)s->row.values);
  take(row, e);
  weigh(s, &row->point);
  struct eo_outcome outcome = outcome_of(s, row, objectives);
  code = eo_optimizer_import(s->optimizer, size == s->result->space.count ? x : point, &outcome, error);
  if (!code && eo_optimizer_rows(s->optimizer) < s->row.count) /* the same point once more */
    eo_rows_drop(&s->row, s->row.count - 1);
  s->told = s->row.count;
  return code;
}

static enum eo_code begin(struct study *s, struct eo_error *error)
{
  struct eo_study_result *r = s->result;
  const struct eo_design *design = s->plan->design;
  r->scenarios = eo_evaluator_scenarios(design);
  r->cases = design->load_cases;
  r->threads = s->plan->threads > 0 ? s->plan->threads : eo_parallel_cores();
  s->row.values = r->scenarios * r->cases;
  s->scratch = malloc(sizeof *s->scratch);
  if (!s->scratch)
    return eo_error_memory(error);
  *s->scratch = *design;
  eo_design_study(design, &s->settings);
  enum eo_code code = eo_study_space_init(&r->space, design, &s->plan->pair->geometry, error);
  if (code)
    return code;
  eo_study_space_hash(&r->space, s->space_hash);
  code = eo_optimizer_new(&s->settings, &s->optimizer, error);
  if (!code)
    code = describe(s, error);
  if (!code)
    code = find_job(s, error);
  if (!code)
    code = find_unmodified(s, error);
  if (!code && !s->plan->fresh && s->job.import_upto > 0)
    code = eo_store_each_evaluation(s->plan->store, s->job.problem, s->job.import_upto, s->space_hash, r->scenarios, r->cases, import, s, error);
  r->imported = s->row.count;
  return code;
}

/* ---- watching ---- */

static double budget_fraction(const struct study *s, int extra)
{
  double budget = eo_optimizer_budget(&s->settings), share = 0, most;
  int generations;
  eo_optimizer_generations(s->optimizer, &generations);
  share = (eo_optimizer_counters(s->optimizer).true_evaluations + extra) / budget;
  most = s->settings.algorithm == EO_GA || s->settings.algorithm == EO_FPGA ? (double)generations / s->settings.generations : 0;
  return fmin(fmax(share, most), 1);
}

/* Only what was computed tells how long the rest takes. */
static double time_left(const struct study *s, double fraction, double now)
{
  if (!(s->first_computed > 0) || !(fraction > s->fraction_before))
    return NAN;
  return (now - s->first_computed) * (1 - fraction) / (fraction - s->fraction_before);
}

/* extra: evaluations of the batch in work that are known. Non-zero: stop. */
static int report(struct study *s, int extra)
{
  struct eo_study_report report = {.job = s->job.id, .unmodified = &s->result->unmodified, .best = &s->result->best};
  if (!s->plan->watch)
    return 0;
  struct eo_counters counters = eo_optimizer_counters(s->optimizer);
  double now = wall();
  eo_optimizer_generations(s->optimizer, &report.generation);
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
  return report(s, s->batch.count - s->missing_count + (int)(fraction * s->missing_count + 0.5));
}

/* ---- the loop ---- */

static enum eo_code work(void *context, int thread, int item, struct eo_error *error)
{
  struct study *s = context;
  return compute_row(s, &s->worker[thread], eo_rows_at(&s->row, s->missing[item]), error);
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
      code = look_up(s, row, error);
    if (!code && !row->point.evaluation)
      s->missing[s->missing_count++] = s->told + i;
  }
  return code;
}

static enum eo_code compute(struct study *s, struct eo_error *error)
{
  const struct eo_progress progress = {.report = report_within, .context = s};
  const struct eo_parallel parallel = {.threads = s->result->threads, .work = work, .context = s, .progress = &progress, .what = "", .last = 1};
  if (!s->missing_count)
    return EO_OK;
  if (!(s->first_computed > 0)) {
    s->first_computed = wall();
    s->fraction_before = budget_fraction(s, s->batch.count - s->missing_count);
  }
  double start = wall();
  enum eo_code code = eo_parallel_run(&parallel, s->missing_count, error);
  s->result->model_seconds += wall() - start;
  return code;
}

static enum eo_code log_candidate(struct study *s, int i, bool known, struct eo_error *error)
{
  const struct eo_row_data *row = eo_rows_at(&s->row, s->told + i);
  struct eo_stored_candidate candidate = {.job = s->job.id, .evaluation = row->point.evaluation, .ordinal = s->told - s->result->imported + i,
                                          .generation = s->batch.candidates[i].generation, .individual = s->batch.candidates[i].individual,
                                          .reused = known, .x = s->batch.candidates[i].x, .size = s->result->space.count};
  enum eo_code code = eo_store_log_candidate(s->plan->store, &candidate, error);
  s->result->reused += !code && candidate.reused;
  return code;
}

static enum eo_code log_predictions(struct study *s, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  for (int i = 0; i < s->batch.predictions_count && !code; i++) {
    const struct eo_prediction *p = &s->batch.predictions[i];
    const struct eo_stored_prediction prediction = {.job = s->job.id, .generation = p->generation, .individual = p->individual, .fitness = p->fitness,
                                                    .credibility = p->credibility, .x = p->x, .size = s->result->space.count};
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
      code = save_row(s, row, error);
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

static enum eo_code copy_point(const struct study *s, const struct eo_study_point *from, struct eo_study_point *to, struct eo_error *error)
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
    weigh(s, &row->point);
    s->result->failed += !row->point.there;
    struct eo_outcome outcome = outcome_of(s, row, objectives);
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
  if (!code && report(s, 0))
    code = eo_error_set(error, EO_ERROR_CANCELLED, "", "The study was stopped.");
  return code;
}

/* ---- after the loop ---- */

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
    r->generation[i] = (struct eo_study_generation){g[i].true_count, g[i].predicted_count, g[i].reused_count, g[i].history_rows, g[i].epoch, g[i].best_value, 0};
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
  r->stopped = cancelled ? EO_STOP_CANCELLED : counters.true_evaluations >= eo_optimizer_budget(&s->settings) ? EO_STOP_BUDGET : EO_STOP_CONVERGED;
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
  enum eo_code code = begin(s, error);
  if (!code)
    code = note_best(s, error);
  if (!code && report(s, 0))
    code = EO_ERROR_CANCELLED;
  while (!code && more)
    code = run_batch(s, &more, error);
  if (!code || code == EO_ERROR_CANCELLED)
    code = finish(s, code == EO_ERROR_CANCELLED, error);
  result->seconds = wall() - s->started;
  release(s);
  return code;
}

bool eo_study_best_design(const struct eo_study_plan *plan, const struct eo_study_result *result, struct eo_design *best)
{
  *best = *plan->design;
  best->modification = result->best.there ? result->best.modification : result->unmodified.modification;
  return result->best.there;
}

static enum eo_code analyse(const struct eo_study_plan *plan, const struct eo_design *design, json_t **document, struct eo_error *error)
{
  struct eo_analysis *analysis = NULL;
  enum eo_code code = eo_analysis_new(&analysis, plan->pair, error);
  if (!code)
    code = eo_analysis_run(analysis, design, EO_WANT_ROOT | EO_WANT_BAND | EO_WANT_CURVES, error);
  if (!code && !(*document = eo_result_encode(analysis, design, NULL)))
    code = eo_error_memory(error);
  eo_analysis_free(analysis);
  return code;
}

static enum eo_code keep(struct eo_store *store, int64_t job, const json_t *document, struct eo_error *error)
{
  struct eo_text text = {0};
  eo_json_write(&text, document, EO_JSON_COMPACT);
  enum eo_code code = text.failed ? eo_error_memory(error) : eo_store_keep_result(store, job, text.data, error);
  eo_text_done(&text);
  return code;
}

enum eo_code eo_study_document(const struct eo_study_plan *plan, const struct eo_study_result *result, const struct eo_warnings *warnings,
                               json_t **document, struct eo_error *error)
{
  json_t *analysis = NULL;
  struct eo_design *best = malloc(sizeof *best);
  enum eo_code code = best ? EO_OK : eo_error_memory(error);
  if (!code && eo_study_best_design(plan, result, best))
    code = analyse(plan, best, &analysis, error);
  if (!code && !(*document = eo_study_result_encode(result, plan->design, analysis, warnings)))
    code = eo_error_memory(error);
  if (!code)
    code = keep(plan->store, result->job, *document, error);
  json_decref(analysis);
  free(best);
  return code;
}
