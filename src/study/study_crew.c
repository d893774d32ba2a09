/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/study_crew.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "evaluation/pair.h"

/* A process at work: the study's own row code on a study that has nothing but what that needs. */
struct shop {
  struct eo_design design;
  struct eo_pair *pair; /* owned */
  struct eo_study_plan plan;
  struct eo_study_result result;
  struct study study;
};

/* What stands in front of an answer; its reason is in it, the raw values follow. */
struct head {
  int32_t outcome;
  double cost;
  char reason[EO_REASON_LENGTH];
};

static enum eo_code open(struct eo_crew_bench *bench, struct eo_error *error)
{
  struct shop *shop = calloc(1, sizeof *shop);
  struct eo_geometry geometry;
  const struct eo_progress progress = eo_crew_bench_progress(bench);
  const struct eo_pair_options options = {.cache_directory = bench->place->cache};
  if (!shop)
    return eo_error_memory(error);
  bench->state = shop;
  EO_TRY(eo_design_read(bench->order, bench->size, &shop->design, &geometry, NULL, error));
  EO_TRY(eo_pair_new(&shop->pair, &shop->design, &options, &progress, error));
  shop->plan.design = &shop->design;
  shop->plan.pair = shop->pair;
  shop->result.scenarios = eo_evaluator_scenarios(&shop->design);
  shop->result.cases = shop->design.load_cases;
  shop->study.plan = &shop->plan;
  shop->study.result = &shop->result;
  return EO_OK;
}

static void close(struct eo_crew_bench *bench)
{
  struct shop *shop = bench->state;
  if (!shop)
    return;
  for (int i = 0; i < EO_MAX_THREADS; i++) {
    eo_evaluator_free(shop->study.worker[i].evaluator);
    free(shop->study.worker[i].design);
  }
  eo_pair_free(shop->pair);
  free(shop);
  bench->state = NULL;
}

static enum eo_code work(struct eo_crew_bench *bench, int thread, const char *item, size_t size, struct eo_text *answer,
                         struct eo_error *error)
{
  struct shop *shop = bench->state;
  size_t values = (size_t)shop->result.scenarios * (size_t)shop->result.cases;
  struct eo_row_data row = {0};
  struct head head;
  int states = 0, length = 0;
  (void)size;
  if (sscanf(item, "%d %d %n", &row.states, &states, &length) < 2 || row.states < 0 || states <= row.states ||
      states > shop->result.scenarios)
    return eo_error_set(error, EO_ERROR_FILE, "", "An item of the search says nothing of its states.");
  size_t known = (size_t)row.states * (size_t)shop->result.cases,
         made = (size_t)(states - row.states) * (size_t)shop->result.cases;
  EO_TRY(eo_modification_read(item + length, &row.point.modification, error));
  row.point.raw = calloc(values, sizeof *row.point.raw);
  enum eo_code code = row.point.raw
                          ? eo_study_compute_row(&shop->study, &shop->study.worker[thread], &row, states, error)
                          : eo_error_memory(error);
  memset(&head, 0, sizeof head);
  head.outcome = (int32_t)row.outcome;
  head.cost = row.cost;
  memcpy(head.reason, row.reason, sizeof head.reason);
  eo_text_add_bytes(answer, &head, sizeof head);
  if (row.point.raw)
    eo_text_add_bytes(answer, row.point.raw + known, sizeof *row.point.raw * made);
  free(row.point.raw);
  return code;
}

const struct eo_crew_trade eo_study_trade = {"search", open, work, close};

/* The leader's side: */

static enum eo_code write_item(void *context, int item, struct eo_text *text, struct eo_error *error)
{
  const struct study *study = context;
  const struct eo_row_data *row = eo_rows_at(&study->row, study->missing[item]);
  (void)error;
  eo_text_print(text, "%d %d ", row->states, study->target);
  eo_text_add(text, row->text.data);
  return EO_OK;
}

static enum eo_code take_answer(void *context, int item, const char *answer, size_t size, struct eo_error *error)
{
  struct study *study = context;
  struct eo_row_data *row = eo_rows_at(&study->row, study->missing[item]);
  struct head head;
  size_t known = (size_t)row->states * (size_t)study->result->cases,
         raw = sizeof *row->point.raw * (size_t)(study->target - row->states) * (size_t)study->result->cases;
  if (size != sizeof head + raw)
    return eo_error_set(error, EO_ERROR_FILE, "", "A rank sent an answer of the wrong length.");
  memcpy(&head, answer, sizeof head);
  memcpy(row->point.raw + known, answer + sizeof head, raw);
  memcpy(row->reason, head.reason, sizeof row->reason);
  row->outcome = (enum eo_evaluation_outcome)head.outcome;
  row->cost += head.cost;
  row->states = study->target;
  row->computed = true;
  study->computed_of_batch = item + 1;
  return EO_OK;
}

static int watch(void *context)
{
  struct study *study = context;
  return eo_study_tell_progress(study, study->batch.count - study->missing_count + study->computed_of_batch);
}

enum eo_code eo_study_compute_on_crew(struct study *study, struct eo_error *error)
{
  const struct eo_crew_task task = {.trade = &eo_study_trade,
                                    .order = study->design.data,
                                    .size = study->design.size,
                                    .items = study->missing_count,
                                    .write = write_item,
                                    .take = take_answer,
                                    .watch = watch,
                                    .context = study};
  study->computed_of_batch = 0;
  return eo_crew_run(study->plan->crew, &task, error);
}
