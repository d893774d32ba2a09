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

double eo_variant_clock(void)
{
  return 1e-3 * eo_clock_milliseconds();
}

enum eo_code eo_variant_scalars(const struct eo_variant_plan *plan, struct eo_scalars *scalars, struct eo_error *error)
{
  return eo_scalars_init(scalars, plan->columns, plan->design->load_cases, plan->design->gear_pair.ends, error);
}

/* Only what is computed tells how long the rest takes. */
static double time_left(const struct variant_study *s, double now)
{
  const struct eo_variant_result *result = s->result;
  if (!(s->computing > 0) || !result->computed)
    return NAN;
  return (now - s->computing) * (result->rows - result->done) / result->computed;
}

int eo_variant_report(struct variant_study *s, const char *what)
{
  const struct eo_variant_result *result = s->result;
  double now = eo_variant_clock();
  if (!s->run->watch)
    return 0;
  const struct eo_variant_report report = {.job = s->job.id,
                                           .rows = result->rows,
                                           .done = result->done,
                                           .reused = result->reused,
                                           .computed = result->computed,
                                           .refused = result->refused,
                                           .not_converged = result->not_converged,
                                           .fraction = result->rows ? (double)result->done / result->rows : 1,
                                           .seconds = now - s->started,
                                           .seconds_left = time_left(s, now),
                                           .what = what};
  return s->run->watch(s->run->context, &report);
}

/* Keeping rows: */

enum eo_code eo_variant_open(struct variant_study *s, struct eo_error *error)
{
  if (s->open)
    return EO_OK;
  EO_TRY(eo_store_begin(s->run->store, error));
  s->open = true;
  s->unsaved = 0;
  s->committed = eo_variant_clock();
  return EO_OK;
}

static void sum_up(struct variant_study *s, enum eo_job_state state, const char *stopped)
{
  s->job.state = state;
  s->job.stopped = stopped;
  s->job.true_evaluations = s->result->done;
  s->job.individuals = s->result->rows;
  s->job.best_value = NAN;
}

enum eo_code eo_variant_commit(struct variant_study *s, bool now, struct eo_error *error)
{
  if (!s->open || (!now && s->unsaved < MOST_UNSAVED && eo_variant_clock() - s->committed < MOST_SECONDS))
    return EO_OK;
  sum_up(s, EO_JOB_RUNNING, "");
  EO_TRY(eo_store_update_job(s->run->store, &s->job, error));
  EO_TRY(eo_store_commit(s->run->store, error));
  s->open = false;
  return EO_OK;
}

enum eo_code eo_variant_keep(struct variant_study *s, int variant, struct eo_stored_variant *row, bool reused,
                             struct eo_error *error)
{
  EO_TRY(eo_store_log_variant(s->run->store, s->job.id, variant, row->id, reused, error));
  s->unsaved++;
  s->result->done++;
  s->result->reused += reused;
  s->result->refused += row->outcome == EO_EVALUATION_REFUSED;
  s->result->not_converged += row->outcome == EO_EVALUATION_NOT_CONVERGED;
  return EO_OK;
}

/* What searches may use. */
static enum eo_code keep_evaluation(struct variant_study *s, const struct eo_variant_answer *answer,
                                    struct eo_error *error)
{
  if (!s->shared || !answer->cases)
    return EO_OK;
  memcpy(s->raw, answer->raw, sizeof *s->raw * (size_t)answer->cases);
  struct eo_stored_evaluation row = {.modification = answer->modification,
                                     .outcome = answer->outcome,
                                     .cost = answer->cost,
                                     .scenarios = 1,
                                     .cases = answer->cases,
                                     .raw = s->raw};
  memcpy(row.reason, answer->reason, sizeof row.reason);
  return eo_store_add_evaluation(s->run->store, s->problem, &row, error);
}

static enum eo_code keep_answer(struct variant_study *s, int variant, const struct eo_variant_answer *answer,
                                struct eo_error *error)
{
  char hash[EO_HASH_LENGTH + 1];
  json_t *values = eo_variant_values(s->run->plan, variant);
  enum eo_code code = values ? eo_variant_hash(s->run->plan, values, hash, error) : eo_error_memory(error);
  json_decref(values);
  for (int i = 0; i < s->scalars.count; i++)
    s->number[i] = i < answer->numbers ? answer->number[i] : NAN;
  struct eo_stored_variant row = {.design = hash,
                                  .evaluator = EO_EVALUATOR_VERSION,
                                  .columns = s->columns,
                                  .outcome = answer->outcome,
                                  .cost = answer->cost,
                                  .numbers = s->scalars.count,
                                  .number = s->number};
  memcpy(row.reason, answer->reason, sizeof row.reason);
  if (!code)
    code = eo_variant_open(s, error);
  if (!code)
    code = eo_store_add_variant(s->run->store, &row, error);
  if (!code)
    code = keep_evaluation(s, answer, error);
  return code ? code : eo_variant_keep(s, variant, &row, false, error);
}

/* The crew: */

static enum eo_code write_item(void *context, int item, struct eo_text *text, struct eo_error *error)
{
  struct variant_study *s = context;
  json_t *wrapped = json_pack("{s:o}", "values", eo_variant_values(s->run->plan, s->missing[item]));
  if (!wrapped)
    return eo_error_memory(error);
  eo_json_write(text, wrapped, EO_JSON_COMPACT);
  json_decref(wrapped);
  return EO_OK;
}

static enum eo_code keep_waiting(struct variant_study *s, const struct waiting_answer *waiting, struct eo_error *error)
{
  struct eo_variant_answer answer;
  void *room;
  if (!eo_variant_answer_read(&answer, waiting->bytes.data, waiting->bytes.size, &room))
    return eo_error_memory(error);
  s->result->computed++;
  s->result->cost += answer.cost;
  enum eo_code code = keep_answer(s, waiting->variant, &answer, error);
  free(room);
  return code;
}

/* Writes what waits, in its order. */
static enum eo_code flush(struct variant_study *s, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  double start = eo_variant_clock();
  for (int i = 0; i < s->waiting_count; i++) {
    if (!code)
      code = keep_waiting(s, &s->waiting[i], error);
    if (!code)
      code = eo_variant_commit(s, false, error);
    eo_text_done(&s->waiting[i].bytes);
  }
  s->waiting_count = 0;
  if (!code)
    code = eo_variant_commit(s, true, error);
  s->result->store_seconds += eo_variant_clock() - start;
  return code;
}

static enum eo_code take_answer(void *context, int item, const char *bytes, size_t size, struct eo_error *error)
{
  struct variant_study *s = context;
  struct waiting_answer *waiting = &s->waiting[s->waiting_count++];
  *waiting = (struct waiting_answer){.variant = s->missing[item]};
  eo_text_add_bytes(&waiting->bytes, bytes, size);
  if (s->waiting_count == 1)
    s->waits_since = eo_variant_clock();
  if (waiting->bytes.failed)
    return eo_error_memory(error);
  return s->waiting_count == MOST_WAITING || eo_variant_clock() - s->waits_since > MOST_WAIT ? flush(s, error) : EO_OK;
}

static int watch_crew(void *context)
{
  struct variant_study *s = context;
  if (s->waiting_count && eo_variant_clock() - s->waits_since > MOST_WAIT && flush(s, &s->fault))
    return 1; /* told when the crew has stopped */
  return eo_variant_report(s, "");
}

static enum eo_code first_of(enum eo_code one, enum eo_code other)
{
  return other ? other : one;
}

static enum eo_code compute(struct variant_study *s, struct eo_error *error)
{
  struct eo_text order = {0};
  struct eo_crew_task task = {.trade = &eo_variant_trade,
                              .items = s->missing_count,
                              .write = write_item,
                              .take = take_answer,
                              .watch = watch_crew,
                              .context = s};
  if (!s->missing_count)
    return EO_OK;
  enum eo_code code = eo_variant_trade_order(s->run->plan, &order, error);
  s->computing = eo_variant_clock();
  task.order = order.data;
  task.size = order.size;
  if (!code)
    code = eo_crew_run(s->run->crew, &task, error);
  eo_text_done(&order);
  if (s->fault.code) {
    *error = s->fault;
    return s->fault.code;
  }
  return code && code != EO_ERROR_CANCELLED ? code : first_of(code, flush(s, error));
}

/* The end: what came is kept, of a run that was cut short too. */
static enum eo_code finish(struct variant_study *s, enum eo_code code, struct eo_error *error)
{
  struct eo_error later;
  bool cancelled = code == EO_ERROR_CANCELLED;
  s->result->cancelled = cancelled;
  if (!s->job.id)
    return code;
  enum eo_code end = eo_variant_commit(s, true, &later);
  if (end)
    eo_store_rollback(s->run->store);
  if (!end && (!code || cancelled)) {
    sum_up(s, cancelled ? EO_JOB_CANCELLED : EO_JOB_DONE, cancelled ? "cancelled" : "");
    end = eo_store_update_job(s->run->store, &s->job, &later);
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
  struct variant_study *s = calloc(1, sizeof *s);
  *result = (struct eo_variant_result){.rows = run->plan->rows};
  if (!s)
    return eo_error_memory(error);
  s->run = run;
  s->result = result;
  s->started = eo_variant_clock();
  enum eo_code code = eo_variant_study_begin(s, error);
  if (!code)
    code = eo_variant_look_up(s, error);
  result->look_up_seconds = eo_variant_clock() - s->started;
  if (!code)
    code = compute(s, error);
  code = finish(s, code, error);
  result->seconds = eo_variant_clock() - s->started;
  if (s->job.id)
    eo_store_release_job(run->store, s->job.id);
  eo_scalars_done(&s->scalars);
  for (int i = 0; i < s->waiting_count; i++)
    eo_text_done(&s->waiting[i].bytes);
  free(s->missing);
  free(s->number);
  free(s->raw);
  free(s->unmodified);
  free(s);
  return code;
}
