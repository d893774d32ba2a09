/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "variants/variant_study_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "document/search_space.h"
#include "evaluation/evaluator.h"
#include "format/json.h"
#include "store/lock.h"
#include "variants/variant_answer.h"
#include "variants/variant_trade.h"

/* Rows of one transaction, and how long it may take: others wait meanwhile. */
enum { MOST_UNSAVED = 500 };
static const double MOST_SECONDS = 0.05;
/* How long a row may wait in memory, to be written with others; a kill loses no more. */
static const double MOST_WAIT = 0.2;

/* s */
static double read_clock(void)
{
  return 1e-3 * eo_clock_milliseconds();
}

enum eo_code eo_variant_scalars(const struct eo_variant_plan *plan, struct eo_scalars *scalars, struct eo_error *error)
{
  return eo_scalars_init(scalars, plan->columns, plan->design->load_cases, plan->design->gear_pair.ends, error);
}

/* Only what is computed tells how long the rest takes. */
static double time_left(const struct variant_study *study, double now)
{
  const struct eo_variant_result *result = study->result;
  if (!(study->computing > 0) || !result->computed)
    return NAN;
  return (now - study->computing) * (result->rows - result->done) / result->computed;
}

int eo_variant_report(struct variant_study *study, const char *what)
{
  const struct eo_variant_result *result = study->result;
  double now = read_clock();
  if (!study->run->watch)
    return 0;
  const struct eo_variant_report report = {.job = study->job.id,
                                           .rows = result->rows,
                                           .done = result->done,
                                           .reused = result->reused,
                                           .computed = result->computed,
                                           .refused = result->refused,
                                           .not_converged = result->not_converged,
                                           .fraction = result->rows ? (double)result->done / result->rows : 1,
                                           .seconds = now - study->started,
                                           .seconds_left = time_left(study, now),
                                           .what = what};
  return study->run->watch(study->run->context, &report);
}

/* Keeping rows: */

enum eo_code eo_variant_open(struct variant_study *study, struct eo_error *error)
{
  if (study->open)
    return EO_OK;
  EO_TRY(eo_store_begin(study->run->store, error));
  study->open = true;
  study->unsaved = 0;
  study->committed = read_clock();
  return EO_OK;
}

static void sum_up(struct variant_study *study, enum eo_job_state state, const char *stopped)
{
  study->job.state = state;
  study->job.stopped = stopped;
  study->job.true_evaluations = study->result->done;
  study->job.individuals = study->result->rows;
  study->job.best_value = NAN;
}

enum eo_code eo_variant_commit(struct variant_study *study, bool now, struct eo_error *error)
{
  if (!study->open || (!now && study->unsaved < MOST_UNSAVED && read_clock() - study->committed < MOST_SECONDS))
    return EO_OK;
  sum_up(study, EO_JOB_RUNNING, "");
  EO_TRY(eo_store_update_job(study->run->store, &study->job, error));
  EO_TRY(eo_store_commit(study->run->store, error));
  study->open = false;
  return EO_OK;
}

enum eo_code eo_variant_keep(struct variant_study *study, int variant, struct eo_stored_variant *row, bool reused,
                             struct eo_error *error)
{
  EO_TRY(eo_store_log_variant(study->run->store, study->job.id, variant, row->id, reused, error));
  study->unsaved++;
  study->result->done++;
  study->result->reused += reused;
  study->result->refused += row->outcome == EO_EVALUATION_REFUSED;
  study->result->not_converged += row->outcome == EO_EVALUATION_NOT_CONVERGED;
  return EO_OK;
}

/* What searches may use. */
static enum eo_code keep_evaluation(struct variant_study *study, const struct eo_variant_answer *answer,
                                    struct eo_error *error)
{
  if (!study->shared || !answer->cases)
    return EO_OK;
  memcpy(study->raw, answer->raw, sizeof *study->raw * (size_t)answer->cases);
  struct eo_stored_evaluation row = {.modification = answer->modification,
                                     .outcome = answer->outcome,
                                     .cost = answer->cost,
                                     .scenarios = 1,
                                     .cases = answer->cases,
                                     .raw = study->raw};
  memcpy(row.reason, answer->reason, sizeof row.reason);
  return eo_store_add_evaluation(study->run->store, study->problem, &row, error);
}

static enum eo_code hash_variant(const struct eo_variant_plan *plan, int variant, char hash[EO_HASH_LENGTH + 1],
                                 struct eo_error *error)
{
  json_t *values = eo_variant_values(plan, variant);
  enum eo_code code = values ? eo_variant_hash(plan, values, hash, error) : eo_error_memory(error);
  json_decref(values);
  return code;
}

static enum eo_code keep_answer(struct variant_study *study, int variant, const struct eo_variant_answer *answer,
                                struct eo_error *error)
{
  char hash[EO_HASH_LENGTH + 1];
  EO_TRY(hash_variant(study->run->plan, variant, hash, error));
  for (int i = 0; i < study->scalars.count; i++)
    study->number[i] = i < answer->numbers ? answer->number[i] : NAN;
  struct eo_stored_variant row = {.design = hash,
                                  .evaluator = EO_EVALUATOR_VERSION,
                                  .columns = study->columns,
                                  .outcome = answer->outcome,
                                  .cost = answer->cost,
                                  .numbers = study->scalars.count,
                                  .number = study->number};
  memcpy(row.reason, answer->reason, sizeof row.reason);
  EO_TRY(eo_variant_open(study, error));
  EO_TRY(eo_store_add_variant(study->run->store, &row, error));
  EO_TRY(keep_evaluation(study, answer, error));
  return eo_variant_keep(study, variant, &row, false, error);
}

/* The crew: */

static enum eo_code write_item(void *context, int item, struct eo_text *text, struct eo_error *error)
{
  struct variant_study *study = context;
  json_t *wrapped = json_pack("{s:o}", "values", eo_variant_values(study->run->plan, study->missing[item]));
  if (!wrapped)
    return eo_error_memory(error);
  eo_json_write(text, wrapped, EO_JSON_COMPACT);
  json_decref(wrapped);
  return EO_OK;
}

static enum eo_code keep_waiting(struct variant_study *study, const struct waiting_answer *waiting,
                                 struct eo_error *error)
{
  struct eo_variant_answer answer;
  void *room;
  if (!eo_variant_answer_read(&answer, waiting->bytes.data, waiting->bytes.size, &room))
    return eo_error_memory(error);
  study->result->computed++;
  study->result->cost += answer.cost;
  enum eo_code code = keep_answer(study, waiting->variant, &answer, error);
  free(room);
  return code;
}

static enum eo_code write_waiting(struct variant_study *study, struct eo_error *error)
{
  for (int i = 0; i < study->waiting_count; i++) {
    EO_TRY(keep_waiting(study, &study->waiting[i], error));
    EO_TRY(eo_variant_commit(study, false, error));
  }
  return EO_OK;
}

/* Writes what waits, in its order. */
static enum eo_code flush(struct variant_study *study, struct eo_error *error)
{
  double start = read_clock();
  enum eo_code code = write_waiting(study, error);
  for (int i = 0; i < study->waiting_count; i++)
    eo_text_done(&study->waiting[i].bytes);
  study->waiting_count = 0;
  if (!code)
    code = eo_variant_commit(study, true, error);
  study->result->store_seconds += read_clock() - start;
  return code;
}

static enum eo_code take_answer(void *context, int item, const char *bytes, size_t size, struct eo_error *error)
{
  struct variant_study *study = context;
  struct waiting_answer *waiting = &study->waiting[study->waiting_count++];
  *waiting = (struct waiting_answer){.variant = study->missing[item]};
  eo_text_add_bytes(&waiting->bytes, bytes, size);
  if (study->waiting_count == 1)
    study->waits_since = read_clock();
  if (waiting->bytes.failed)
    return eo_error_memory(error);
  return study->waiting_count == MOST_WAITING || read_clock() - study->waits_since > MOST_WAIT ? flush(study, error)
                                                                                               : EO_OK;
}

static int watch_crew(void *context)
{
  struct variant_study *study = context;
  if (study->waiting_count && read_clock() - study->waits_since > MOST_WAIT && flush(study, &study->fault))
    return 1; /* told when the crew has stopped */
  return eo_variant_report(study, "");
}

static enum eo_code first_of(enum eo_code one, enum eo_code other)
{
  return other ? other : one;
}

static enum eo_code compute(struct variant_study *study, struct eo_error *error)
{
  struct eo_text order = {0};
  struct eo_crew_task task = {.trade = &eo_variant_trade,
                              .items = study->missing_count,
                              .write = write_item,
                              .take = take_answer,
                              .watch = watch_crew,
                              .context = study};
  if (!study->missing_count)
    return EO_OK;
  enum eo_code code = eo_variant_trade_order(study->run->plan, &order, error);
  study->computing = read_clock();
  task.order = order.data;
  task.size = order.size;
  if (!code)
    code = eo_crew_run(study->run->crew, &task, error);
  eo_text_done(&order);
  if (study->fault.code) {
    *error = study->fault;
    return study->fault.code;
  }
  return code && code != EO_ERROR_CANCELLED ? code : first_of(code, flush(study, error));
}

/* The end: what came is kept, of a run that was cut short too. */
static enum eo_code finish(struct variant_study *study, enum eo_code code, struct eo_error *error)
{
  struct eo_error later;
  bool cancelled = code == EO_ERROR_CANCELLED;
  study->result->cancelled = cancelled;
  if (!study->job.id)
    return code;
  enum eo_code end = eo_variant_commit(study, true, &later);
  if (end)
    eo_store_rollback(study->run->store);
  if (!end && (!code || cancelled)) {
    sum_up(study, cancelled ? EO_JOB_CANCELLED : EO_JOB_DONE, cancelled ? "cancelled" : "");
    end = eo_store_update_job(study->run->store, &study->job, &later);
  }
  if (end && (!code || cancelled)) {
    *error = later;
    return end;
  }
  return cancelled ? EO_OK : code;
}

enum eo_code eo_variant_study_run(const struct eo_variant_run *run, struct eo_variant_result *result,
                                  struct eo_error *error)
{
  struct variant_study *study = calloc(1, sizeof *study);
  *result = (struct eo_variant_result){.rows = run->plan->rows};
  if (!study)
    return eo_error_memory(error);
  study->run = run;
  study->result = result;
  study->started = read_clock();
  enum eo_code code = eo_variant_study_begin(study, error);
  if (!code)
    code = eo_variant_look_up(study, error);
  result->look_up_seconds = read_clock() - study->started;
  if (!code)
    code = compute(study, error);
  code = finish(study, code, error);
  result->seconds = read_clock() - study->started;
  if (study->job.id)
    eo_store_release_job(run->store, study->job.id);
  eo_scalars_done(&study->scalars);
  for (int i = 0; i < study->waiting_count; i++)
    eo_text_done(&study->waiting[i].bytes);
  free(study->missing);
  free(study->number);
  free(study->raw);
  free(study->unmodified);
  free(study);
  return code;
}
