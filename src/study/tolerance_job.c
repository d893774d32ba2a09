/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/tolerance_job.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "document/pair_log.h"
#include "evaluation/scatter_levels.h"
#include "evaluation/scatter_tally.h"
#include "format/json.h"
#include "store/jobs.h"
#include "store/lock.h"
#include "store/variant_rows.h"
#include "study/scatter_crew.h"

/* How long a row may wait in memory, to be written with others (a kill loses no more), and how many may. */
static const double MOST_WAIT_MS = 200;
enum { MOST_WAITING = 500, LOOKED_UP_BETWEEN_REPORTS = 256 };

struct waiting {
  int pair;
  const double *output; /* in the run */
  double cost;
};

struct run {
  const struct eo_tolerance_job *job;
  struct eo_tolerance_outcome *outcome;
  struct eo_stored_job row;
  struct eo_scatter scatter;
  bool assumed, coarse_first;
  int pairs, outputs, swing; /* swing: which of the outputs a pair that converged has */
  int64_t columns;
  char of[EO_HASH_LENGTH + 1]; /* the design and its scatter: what all rows belong to */
  int *at;                     /* [pairs], which of the known rows; -1: none; owned */
  double *known;               /* rows; owned */
  int known_room;
  pthread_mutex_t mutex; /* guards what follows: pairs are finished on any thread and written by one */
  struct waiting *waiting;
  int waiting_count, waiting_room;
  struct waiting *writing;            /* those that the thread that writes has taken */
  double started, computing, written; /* ms of the clock */
  double fraction;                    /* coarse first: of the run */
  struct eo_error fault;              /* of writing, where it could not be told at once */
};

static double milliseconds_left(const struct run *run, double now)
{
  const struct eo_tolerance_outcome *outcome = run->outcome;
  if (run->coarse_first)
    return run->fraction > 0 ? (now - run->computing) * (1 - run->fraction) / run->fraction : NAN;
  if (!(run->computing > 0) || !outcome->computed)
    return NAN;
  return (now - run->computing) * (outcome->pairs - outcome->done) / outcome->computed;
}

static int report(struct run *run, const char *what)
{
  const struct eo_tolerance_outcome *outcome = run->outcome;
  double now = eo_clock_milliseconds();
  if (!run->job->watch)
    return 0;
  const struct eo_tolerance_progress progress = {.job = run->job->job,
                                                 .pairs = outcome->pairs,
                                                 .done = outcome->done,
                                                 .known = outcome->known,
                                                 .fraction = run->coarse_first ? run->fraction
                                                                               : (double)outcome->done / outcome->pairs,
                                                 .seconds = 1e-3 * (now - run->started),
                                                 .seconds_left = 1e-3 * milliseconds_left(run, now),
                                                 .what = what};
  return run->job->watch(run->job->context, &progress);
}

/* What a row of a pair is known by. */
static void hash_pair(const struct run *run, int pair, char hash[EO_HASH_LENGTH + 1])
{
  struct eo_hash pair_hash;
  eo_hash_init(&pair_hash);
  eo_hash_add_text(&pair_hash, "scatter", run->of);
  eo_hash_add_number(&pair_hash, "pair", pair);
  eo_hash_finish(&pair_hash, hash);
}

static void hash_job(const struct run *run, char hash[EO_HASH_LENGTH + 1])
{
  struct eo_hash job_hash;
  eo_hash_init(&job_hash);
  eo_hash_add_text(&job_hash, "tolerance", run->of);
  eo_hash_add_number(&job_hash, "evaluator", EO_EVALUATOR_VERSION);
  eo_hash_finish(&job_hash, hash);
}

/* "load_cases.1.peak_to_peak_um", in the order of a row. */
static enum eo_code name_columns(const struct run *run, struct eo_text *names, struct eo_error *error)
{
  json_t *list = json_array();
  int cases = run->job->design->load_cases;
  for (int i = 0; i < run->outputs; i++)
    json_array_append_new(list, json_sprintf("load_cases.%d.%s", i % cases + 1, eo_scalar_at(i / cases)->key));
  eo_json_write(names, list, EO_JSON_COMPACT);
  bool good = list && !names->failed;
  json_decref(list);
  return good ? EO_OK : eo_error_memory(error);
}

/* Before anything is evaluated: the job, and what is known already. */

static enum eo_code find_columns(struct run *run, struct eo_error *error)
{
  struct eo_text names = {0};
  enum eo_code code = name_columns(run, &names, error);
  if (!code)
    code = eo_store_variant_columns(run->job->store, names.data, &run->columns, error);
  eo_text_done(&names);
  return code;
}

static enum eo_code begin_job(struct run *run, struct eo_error *error)
{
  struct eo_store *store = run->job->store;
  char hash[EO_HASH_LENGTH + 1];
  hash_job(run, hash);
  run->row = (struct eo_stored_job){.id = run->job->job, .kind = EO_JOB_TOLERANCE, .study = hash};
  EO_TRY(eo_store_begin(store, error));
  enum eo_code code = eo_store_begin_job(store, &run->row, &run->outcome->resumed, error);
  if (!code)
    code = find_columns(run, error);
  if (!code)
    code = eo_store_commit(store, error);
  if (code) {
    eo_store_rollback(store);
    run->row.id = 0;
  }
  run->row.study = "";
  return code;
}

/* Room for one row more; NULL without memory. */
static double *add_known(struct run *run, int pair)
{
  if (run->outcome->done == run->known_room) {
    int room = 2 * run->known_room + 64;
    double *more = realloc(run->known, sizeof *more * (size_t)room * (size_t)run->outputs);
    if (!more)
      return NULL;
    run->known = more;
    run->known_room = room;
  }
  run->at[pair] = run->outcome->done;
  return run->known + (size_t)run->outcome->done * (size_t)run->outputs;
}

static enum eo_code take_known(void *context, const struct eo_stored_variant *row, struct eo_error *error)
{
  struct run *run = context;
  if (row->ordinal >= run->pairs)
    return EO_OK;
  double *known = add_known(run, row->ordinal);
  if (!known)
    return eo_error_memory(error);
  memcpy(known, row->number, sizeof *known * (size_t)run->outputs);
  run->outcome->done++;
  run->outcome->known += row->reused;
  return EO_OK;
}

static enum eo_code look_up_pair(struct run *run, int pair, bool *there, struct eo_error *error)
{
  char hash[EO_HASH_LENGTH + 1];
  struct eo_stored_variant row = {.design = hash,
                                  .evaluator = EO_EVALUATOR_VERSION,
                                  .columns = run->columns,
                                  .numbers = run->outputs,
                                  .number = add_known(run, pair)};
  if (!row.number)
    return eo_error_memory(error);
  hash_pair(run, pair, hash);
  EO_TRY(eo_store_find_variant(run->job->store, &row, error));
  *there = row.id != 0;
  if (!*there) {
    run->at[pair] = -1;
    return EO_OK;
  }
  run->outcome->done++;
  run->outcome->known++;
  return eo_store_log_variant(run->job->store, run->job->job, pair, row.id, true, error);
}

static enum eo_code look_up(struct run *run, int first, int last, struct eo_error *error)
{
  EO_TRY(eo_store_begin(run->job->store, error));
  enum eo_code code = EO_OK;
  for (int pair = first; pair < last && !code; pair++) {
    bool there = run->at[pair] >= 0;
    if (!there)
      code = look_up_pair(run, pair, &there, error);
  }
  if (!code)
    code = eo_store_commit(run->job->store, error);
  if (code)
    eo_store_rollback(run->job->store);
  return code;
}

static enum eo_code find_known(struct run *run, struct eo_error *error)
{
  bool there = false;
  EO_TRY(eo_store_each_variant(run->job->store, run->job->job, -1, run->outputs, take_known, run, error));
  EO_TRY(eo_store_has_variants(run->job->store, EO_EVALUATOR_VERSION, run->columns, &there, error));
  for (int pair = 0; there && pair < run->pairs; pair += LOOKED_UP_BETWEEN_REPORTS) {
    int last = pair + LOOKED_UP_BETWEEN_REPORTS;
    EO_TRY(look_up(run, pair, last < run->pairs ? last : run->pairs, error));
    if (report(run, "history"))
      return eo_error_set(error, EO_ERROR_CANCELLED, "", "The analysis was stopped.");
  }
  return EO_OK;
}

/* Rows as they come: */

static bool find(void *context, int pair, double *output)
{
  const struct run *run = context;
  if (run->at[pair] < 0)
    return false;
  memcpy(output, run->known + (size_t)run->at[pair] * (size_t)run->outputs, sizeof *output * (size_t)run->outputs);
  return true;
}

static enum eo_code keep(void *context, int pair, const double *output, double cost, struct eo_error *error)
{
  struct run *run = context;
  pthread_mutex_lock(&run->mutex);
  bool room = run->waiting_count < run->waiting_room;
  if (!room) {
    int count = 2 * run->waiting_room + MOST_WAITING;
    struct waiting *more = realloc(run->waiting, sizeof *more * (size_t)count);
    if (more) {
      run->waiting = more;
      run->waiting_room = count;
    }
    room = more != NULL;
  }
  if (room)
    run->waiting[run->waiting_count++] = (struct waiting){pair, output, cost};
  pthread_mutex_unlock(&run->mutex);
  return room ? EO_OK : eo_error_memory(error);
}

static enum eo_code write_row(struct run *run, const struct waiting *waiting, double *number, struct eo_error *error)
{
  char hash[EO_HASH_LENGTH + 1];
  hash_pair(run, waiting->pair, hash);
  memcpy(number, waiting->output, sizeof *number * (size_t)run->outputs);
  bool failed = isnan(number[run->swing]);
  struct eo_stored_variant row = {.design = hash,
                                  .evaluator = EO_EVALUATOR_VERSION,
                                  .columns = run->columns,
                                  .outcome = failed ? EO_EVALUATION_NOT_CONVERGED : EO_EVALUATION_CONVERGED,
                                  .cost = waiting->cost,
                                  .numbers = run->outputs,
                                  .number = number};
  if (failed)
    snprintf(row.reason, sizeof row.reason, "Contact did not converge.");
  EO_TRY(eo_store_add_variant(run->job->store, &row, error));
  return eo_store_log_variant(run->job->store, run->job->job, waiting->pair, row.id, false, error);
}

static void sum_up(struct run *run, enum eo_job_state state, const char *stopped)
{
  run->row.state = state;
  run->row.stopped = stopped;
  run->row.true_evaluations = run->outcome->done;
  run->row.individuals = run->outcome->pairs;
  run->row.best_value = NAN;
}

static enum eo_code put_rows(struct run *run, int count, double *number, struct eo_error *error)
{
  for (int i = 0; i < count; i++)
    EO_TRY(write_row(run, &run->writing[i], number, error));
  run->outcome->done += count;
  run->outcome->computed += count;
  sum_up(run, EO_JOB_RUNNING, "");
  EO_TRY(eo_store_update_job(run->job->store, &run->row, error));
  return eo_store_commit(run->job->store, error);
}

/* One transaction. */
static enum eo_code write_rows(struct run *run, int count, struct eo_error *error)
{
  double *number = malloc(sizeof *number * (size_t)run->outputs);
  enum eo_code code = number ? eo_store_begin(run->job->store, error) : eo_error_memory(error);
  if (!code) {
    code = put_rows(run, count, number, error);
    if (code)
      eo_store_rollback(run->job->store);
  }
  free(number);
  return code;
}

/* What waits is taken as a whole, so that nobody who has finished a pair waits for the disk. */
static enum eo_code flush(struct run *run, bool now, struct eo_error *error)
{
  if (!now && eo_clock_milliseconds() - run->written < MOST_WAIT_MS)
    return EO_OK;
  pthread_mutex_lock(&run->mutex);
  int count = run->waiting_count;
  run->writing = run->waiting;
  run->waiting = NULL;
  run->waiting_count = run->waiting_room = 0;
  pthread_mutex_unlock(&run->mutex);
  enum eo_code code = count ? write_rows(run, count, error) : EO_OK;
  free(run->writing);
  run->writing = NULL;
  run->written = eo_clock_milliseconds();
  return code;
}

/* On the thread that runs the job. */
static int watch(void *context, const char *what, double fraction)
{
  struct run *run = context;
  run->fraction = fraction;
  if (flush(run, false, &run->fault))
    return 1; /* told when the work has stopped */
  return report(run, what);
}

static enum eo_code put_result(struct run *run, const char *text, struct eo_error *error)
{
  EO_TRY(eo_store_keep_result(run->job->store, run->job->job, text, error));
  EO_TRY(eo_store_update_job(run->job->store, &run->row, error));
  return eo_store_commit(run->job->store, error);
}

/* A job's end and its result are one transaction. */
static enum eo_code write_result(struct run *run, bool stopped, const char *text, struct eo_error *error)
{
  EO_TRY(eo_store_begin_lasting(run->job->store, error));
  sum_up(run, stopped ? EO_JOB_CANCELLED : EO_JOB_DONE, stopped ? "cancelled" : "");
  enum eo_code code = put_result(run, text, error);
  if (code)
    eo_store_rollback(run->job->store);
  return code;
}

/* The document of what came, kept with the job. */
static enum eo_code conclude(struct run *run, const struct eo_scatter_run *rows, bool stopped,
                             const struct eo_progress *progress, struct eo_error *error)
{
  struct eo_tolerance_report *report = NULL;
  struct eo_text text = {0};
  EO_TRY(eo_tolerance_report_new(&report, run->job->design, &run->scatter, rows, run->assumed, progress, error));
  report->stopped = stopped;
  eo_tolerance_write(report, run->job->warnings, &text);
  eo_tolerance_report_free(report);
  enum eo_code code = text.failed ? eo_error_memory(error) : write_result(run, stopped, text.data, error);
  eo_text_done(&text);
  return code;
}

/* Of a job that nobody wants to go on what is there; the stop stays one. */
static enum eo_code conclude_stopped(struct run *run, const struct eo_scatter_tally *tally, struct eo_scatter_run *rows,
                                     struct eo_error *error)
{
  int full;
  if (!run->job->is_given_up || !run->job->is_given_up(run->job->context))
    return EO_ERROR_CANCELLED;
  EO_TRY(eo_scatter_tally_settle(tally, run->job->design, rows, &full, error));
  if (full >= EO_SCATTER_FEWEST)
    EO_TRY(conclude(run, rows, true, NULL, error));
  return EO_ERROR_CANCELLED;
}

static enum eo_code compute_rows(struct run *run, const struct eo_scatter_log *log, struct eo_scatter_run *rows,
                                 const struct eo_progress *progress, struct eo_error *error)
{
  const struct eo_tolerance_job *job = run->job;
  struct eo_scatter_plan plan = eo_tolerance_plan(&job->design->tolerance);
  plan.threads = job->threads;
  plan.log = *log;
  run->computing = eo_clock_milliseconds();
  enum eo_code code = job->pair
                          ? eo_scatter_run_pairs(rows, job->pair, job->design, &run->scatter, &plan, progress, error)
                          : eo_scatter_run_on_crew(rows, job->crew, job->design, &run->scatter, &plan, progress, error);
  if (!run->fault.code)
    flush(run, true, &run->fault);
  if (run->fault.code && (!code || code == EO_ERROR_CANCELLED)) {
    *error = run->fault;
    code = run->fault.code;
  }
  return code;
}

static enum eo_code compute(struct run *run, struct eo_error *error)
{
  const struct eo_progress progress = {watch, run};
  const struct eo_scatter_log own = {find, keep, run};
  struct eo_scatter_tally tally;
  struct eo_scatter_run rows = {0};
  EO_TRY(eo_scatter_tally_init(&tally, run->pairs, &own, error));
  const struct eo_scatter_log log = eo_scatter_tally_log(&tally);
  enum eo_code code = compute_rows(run, &log, &rows, &progress, error);
  if (!code)
    code = conclude(run, &rows, false, &progress, error);
  if (code == EO_ERROR_CANCELLED)
    code = conclude_stopped(run, &tally, &rows, error);
  eo_scatter_tally_done(&tally);
  eo_scatter_run_done(&rows);
  return code;
}

static enum eo_code begin(struct run *run, struct eo_error *error)
{
  const struct eo_design *design = run->job->design;
  EO_TRY(eo_scatter_of_design(&run->scatter, design, true, &run->assumed, error));
  EO_TRY(eo_pair_log_hash(design, run->of, error));
  run->at = malloc(sizeof *run->at * (size_t)run->pairs);
  if (!run->at)
    return eo_error_memory(error);
  for (int i = 0; i < run->pairs; i++)
    run->at[i] = -1;
  EO_TRY(begin_job(run, error));
  return find_known(run, error);
}

static struct run *run_new(const struct eo_tolerance_job *job, struct eo_tolerance_outcome *outcome)
{
  struct run *run = calloc(1, sizeof *run);
  if (!run)
    return NULL;
  run->job = job;
  run->outcome = outcome;
  run->pairs = job->design->tolerance.pairs;
  run->outputs = eo_scatter_outputs(job->design);
  run->coarse_first = eo_scatter_is_coarse_first(job->design);
  run->swing = eo_scalar_find("peak_to_peak_um") * job->design->load_cases;
  run->started = run->written = eo_clock_milliseconds();
  pthread_mutex_init(&run->mutex, NULL);
  *outcome = (struct eo_tolerance_outcome){.pairs = run->pairs};
  return run;
}

static void run_free(struct run *run)
{
  pthread_mutex_destroy(&run->mutex);
  free(run->waiting);
  free(run->known);
  free(run->at);
  free(run);
}

enum eo_code eo_tolerance_job_run(const struct eo_tolerance_job *job, struct eo_tolerance_outcome *outcome,
                                  struct eo_error *error)
{
  struct run *run = run_new(job, outcome);
  if (!run)
    return eo_error_memory(error);
  enum eo_code code = begin(run, error);
  if (!code)
    code = compute(run, error);
  outcome->cancelled = code == EO_ERROR_CANCELLED;
  if (outcome->cancelled && run->row.id) {
    sum_up(run, EO_JOB_CANCELLED, "cancelled");
    code = eo_store_update_job(job->store, &run->row, error);
  }
  if (run->row.id)
    eo_store_release_job(job->store, job->job);
  outcome->seconds = 1e-3 * (eo_clock_milliseconds() - run->started);
  run_free(run);
  return code;
}
