/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scatter_crew.h"

#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/parallel.h"
#include "document/scatter_document.h"
#include "evaluation/scatter_levels.h"

/* Levels of an item. */
static const char FULL = 'f', COARSE = 'c';

/* A process at work. */
struct shop {
  struct eo_design design, coarse_design;
  struct eo_scatter scatter;
  struct eo_pair *pair, *coarse_pair;                     /* owned; coarse_pair: NULL where there is no coarse level */
  struct eo_pair_distances *distances, *coarse_distances; /* owned */
  int outputs;                                            /* numbers of a row */
  struct eo_scatter_bench *bench[EO_MAX_THREADS], *coarse_bench[EO_MAX_THREADS]; /* owned; made by the thread that uses
                                                                                    it */
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
  EO_TRY(eo_scatter_of_design(&shop->scatter, &shop->design, true, NULL, error));
  shop->outputs = eo_scatter_outputs(&shop->design);
  EO_TRY(eo_pair_new(&shop->pair, &shop->design, &options, &progress, error));
  EO_TRY(eo_pair_distances_new(&shop->distances, shop->pair, shop->design.tolerance.root_stress, error));
  if (!eo_scatter_is_coarse_first(&shop->design))
    return EO_OK;
  eo_scatter_make_coarse(&shop->coarse_design, &shop->design);
  EO_TRY(eo_scatter_coarse_pair(&shop->coarse_pair, shop->pair, &shop->design, &progress, error));
  return eo_pair_distances_new(&shop->coarse_distances, shop->coarse_pair, false, error);
}

static void free_benches(struct shop *shop, int thread)
{
  eo_scatter_bench_free(shop->bench[thread]);
  eo_scatter_bench_free(shop->coarse_bench[thread]);
}

static void close(struct eo_crew_bench *bench)
{
  struct shop *shop = bench->state;
  if (!shop)
    return;
  for (int i = 0; i < EO_MAX_THREADS; i++)
    free_benches(shop, i);
  eo_pair_distances_free(shop->coarse_distances);
  eo_pair_distances_free(shop->distances);
  eo_pair_free(shop->coarse_pair);
  eo_pair_free(shop->pair);
  free(shop);
  bench->state = NULL;
}

/* The bench of a thread at a level. */
static enum eo_code find_bench(struct shop *shop, int thread, bool coarse, struct eo_scatter_bench **bench,
                               struct eo_error *error)
{
  const struct eo_tolerance_settings *settings = &shop->design.tolerance;
  struct eo_scatter_bench **own = coarse ? &shop->coarse_bench[thread] : &shop->bench[thread];
  if (!*own)
    EO_TRY(eo_scatter_bench_new(own, coarse ? shop->coarse_distances : shop->distances,
                                coarse ? &shop->coarse_design : &shop->design, &shop->scatter, settings->vibration,
                                settings->root_stress, error));
  *bench = *own;
  return EO_OK;
}

static enum eo_code compute_row(struct shop *shop, struct eo_scatter_bench *bench, const double *input,
                                struct eo_text *answer, struct eo_error *error)
{
  size_t bytes = sizeof(double) * (size_t)shop->outputs;
  double *output = malloc(bytes), cost = eo_clock_thread_seconds();
  if (!output)
    return eo_error_memory(error);
  enum eo_code code = eo_scatter_bench_run(bench, input, output, error);
  cost = eo_clock_thread_seconds() - cost;
  if (!code) {
    eo_text_add_bytes(answer, output, bytes);
    eo_text_add_bytes(answer, &cost, sizeof cost);
  }
  free(output);
  return code;
}

/* An item: the level, and the inputs of a pair; without inputs the design itself. */
static enum eo_code work(struct eo_crew_bench *bench, int thread, const char *item, size_t size, struct eo_text *answer,
                         struct eo_error *error)
{
  struct shop *shop = bench->state;
  struct eo_scatter_bench *own;
  double input[EO_MAX_SCATTER_INPUTS];
  bool coarse = size > 0 && *item == COARSE, drawn = size > 1;
  if (size == 0 || (drawn && size != 1 + sizeof *input * (size_t)shop->scatter.inputs) ||
      (coarse && !shop->coarse_pair))
    return eo_error_set(error, EO_ERROR_FILE, "", "Rank 0 sent a pair of the wrong length.");
  memcpy(input, item + 1, size - 1);
  EO_TRY(find_bench(shop, thread, coarse, &own, error));
  return compute_row(shop, own, drawn ? input : NULL, answer, error);
}

const struct eo_crew_trade eo_scatter_trade = {"tolerance", open, work, close};

/* The leader's side: */

struct lead {
  struct eo_scatter_run *run;
  struct eo_crew *crew;
  const struct eo_scatter_log *log;
  const struct eo_progress *progress;
  struct eo_text order;
  const struct eo_scatter_stage *stage; /* NULL: the design itself is evaluated */
  int *missing;                         /* [missing_count], pairs of the stage that the log does not have */
  int missing_count, taken;
};

static enum eo_code write_item(void *context, int item, struct eo_text *text, struct eo_error *error)
{
  const struct lead *lead = context;
  size_t inputs = (size_t)lead->run->inputs;
  (void)error;
  eo_text_add_bytes(text, lead->stage && lead->stage->coarse ? &COARSE : &FULL, 1);
  if (lead->stage)
    eo_text_add_bytes(text, lead->run->input + (size_t)lead->missing[item] * inputs, sizeof(double) * inputs);
  return EO_OK;
}

static enum eo_code take_answer(void *context, int item, const char *answer, size_t size, struct eo_error *error)
{
  struct lead *lead = context;
  struct eo_scatter_run *run = lead->run;
  int pair = lead->stage ? lead->missing[item] : 0;
  double *rows = !lead->stage ? run->nominal : lead->stage->coarse ? run->coarse : run->output, cost;
  double *output = rows + (size_t)pair * (size_t)run->outputs;
  size_t bytes = sizeof *output * (size_t)run->outputs;
  if (size != bytes + sizeof cost)
    return eo_error_set(error, EO_ERROR_FILE, "", "A rank sent a row of the wrong length.");
  memcpy(output, answer, bytes);
  memcpy(&cost, answer + bytes, sizeof cost);
  lead->taken = item + 1;
  return lead->stage && !lead->stage->coarse && lead->log->keep
             ? lead->log->keep(lead->log->context, pair, output, cost, error)
             : EO_OK;
}

static int watch(void *context)
{
  const struct lead *lead = context;
  const struct eo_scatter_stage *stage = lead->stage;
  double done = stage ? stage->count - lead->missing_count + lead->taken : 0;
  return eo_progress_report(lead->progress, EO_SCATTER_PROGRESS,
                            stage ? stage->first + (stage->last - stage->first) * done / stage->count : 0);
}

static void find_missing(struct lead *lead)
{
  struct eo_scatter_run *run = lead->run;
  const struct eo_scatter_log *log = lead->log;
  lead->missing_count = lead->taken = 0;
  for (int i = 0; i < lead->stage->count; i++) {
    int pair = lead->stage->pair[i];
    if (lead->stage->coarse || !log->find ||
        !log->find(log->context, pair, run->output + (size_t)pair * (size_t)run->outputs))
      lead->missing[lead->missing_count++] = pair;
  }
}

static enum eo_code run_items(struct lead *lead, int items, struct eo_error *error)
{
  const struct eo_crew_task task = {.trade = &eo_scatter_trade,
                                    .order = lead->order.data,
                                    .size = lead->order.size,
                                    .items = items,
                                    .write = write_item,
                                    .take = take_answer,
                                    .watch = watch,
                                    .context = lead};
  return eo_crew_run(lead->crew, &task, error);
}

static enum eo_code run_stage(void *context, const struct eo_scatter_stage *stage, struct eo_error *error)
{
  struct lead *lead = context;
  lead->stage = stage;
  find_missing(lead);
  return lead->missing_count > 0 ? run_items(lead, lead->missing_count, error) : EO_OK;
}

enum eo_code eo_scatter_run_on_crew(struct eo_scatter_run *run, struct eo_crew *crew, const struct eo_design *design,
                                    const struct eo_scatter *scatter, const struct eo_scatter_plan *plan,
                                    const struct eo_progress *progress, struct eo_error *error)
{
  struct lead lead = {.run = run, .crew = crew, .log = &plan->log, .progress = progress};
  EO_TRY(eo_scatter_run_draw(run, design, scatter, plan, error));
  eo_design_write(design, &lead.order);
  lead.missing = malloc(sizeof *lead.missing * (size_t)run->pairs);
  enum eo_code code = lead.order.failed || !lead.missing ? eo_error_memory(error) : run_items(&lead, 1, error);
  if (!code)
    code = eo_scatter_run_levels(run, design, run_stage, &lead, error);
  eo_text_done(&lead.order);
  free(lead.missing);
  return code;
}
