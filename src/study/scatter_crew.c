/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scatter_crew.h"

#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/parallel.h"
#include "document/scatter_document.h"
#include "evaluation/pair.h"

/* A process at work. */
struct shop {
  struct eo_design design;
  struct eo_scatter scatter;
  struct eo_pair *pair;                           /* owned */
  int outputs;                                    /* numbers of a row */
  struct eo_scatter_bench *bench[EO_MAX_THREADS]; /* owned; made by the thread that uses it */
};

static int look_for_stop(void *context, const char *what, double fraction)
{
  const struct eo_crew_bench *bench = context;
  (void)what;
  (void)fraction;
  return atomic_load(bench->stopped);
}

static enum eo_code open(struct eo_crew_bench *bench, struct eo_error *error)
{
  struct shop *shop = calloc(1, sizeof *shop);
  struct eo_geometry geometry;
  const struct eo_progress progress = {look_for_stop, bench};
  const struct eo_pair_options options = {.cache_directory = bench->place->cache};
  if (!shop)
    return eo_error_memory(error);
  bench->state = shop;
  EO_TRY(eo_design_read(bench->order, bench->size, &shop->design, &geometry, NULL, error));
  EO_TRY(eo_scatter_of_design(&shop->scatter, &shop->design, true, NULL, error));
  shop->outputs = eo_scatter_outputs(&shop->design);
  return eo_pair_new(&shop->pair, &shop->design, &options, &progress, error);
}

static void close(struct eo_crew_bench *bench)
{
  struct shop *shop = bench->state;
  if (!shop)
    return;
  for (int i = 0; i < EO_MAX_THREADS; i++)
    eo_scatter_bench_free(shop->bench[i]);
  eo_pair_free(shop->pair);
  free(shop);
  bench->state = NULL;
}

static enum eo_code compute_row(struct shop *shop, int thread, const double *input, struct eo_text *answer,
                                struct eo_error *error)
{
  const struct eo_tolerance_settings *settings = &shop->design.tolerance;
  size_t bytes = sizeof(double) * (size_t)shop->outputs;
  if (!shop->bench[thread])
    EO_TRY(eo_scatter_bench_new(&shop->bench[thread], shop->pair, &shop->design, &shop->scatter, settings->vibration,
                                settings->root_stress, error));
  double *output = malloc(bytes), cost = eo_clock_thread_seconds();
  if (!output)
    return eo_error_memory(error);
  enum eo_code code = eo_scatter_bench_run(shop->bench[thread], input, output, error);
  cost = eo_clock_thread_seconds() - cost;
  if (!code) {
    eo_text_add_bytes(answer, output, bytes);
    eo_text_add_bytes(answer, &cost, sizeof cost);
  }
  free(output);
  return code;
}

static enum eo_code work(struct eo_crew_bench *bench, int thread, const char *item, size_t size, struct eo_text *answer,
                         struct eo_error *error)
{
  struct shop *shop = bench->state;
  double input[EO_MAX_SCATTER_INPUTS];
  if (size && size != sizeof *input * (size_t)shop->scatter.inputs)
    return eo_error_set(error, EO_ERROR_FILE, "", "Rank 0 sent a pair of the wrong length.");
  memcpy(input, item, size);
  return compute_row(shop, thread, size ? input : NULL, answer, error);
}

const struct eo_crew_trade eo_scatter_trade = {"tolerance", open, work, close};

/* The leader's side: */

struct lead {
  struct eo_scatter_run *run;
  const struct eo_scatter_log *log;
  const struct eo_progress *progress;
  int *missing; /* [missing_count], pairs that the log does not have */
  int missing_count, taken;
};

/* Item 0 is the design itself. */
static enum eo_code write_item(void *context, int item, struct eo_text *text, struct eo_error *error)
{
  const struct lead *lead = context;
  size_t inputs = (size_t)lead->run->inputs;
  (void)error;
  if (item)
    eo_text_add_bytes(text, lead->run->input + (size_t)lead->missing[item - 1] * inputs, sizeof(double) * inputs);
  return EO_OK;
}

static enum eo_code take_answer(void *context, int item, const char *answer, size_t size, struct eo_error *error)
{
  struct lead *lead = context;
  struct eo_scatter_run *run = lead->run;
  int pair = item ? lead->missing[item - 1] : -1;
  double *output = item ? run->output + (size_t)pair * (size_t)run->outputs : run->nominal, cost;
  size_t bytes = sizeof *output * (size_t)run->outputs;
  if (size != bytes + sizeof cost)
    return eo_error_set(error, EO_ERROR_FILE, "", "A rank sent a row of the wrong length.");
  memcpy(output, answer, bytes);
  memcpy(&cost, answer + bytes, sizeof cost);
  lead->taken = item;
  return item && lead->log->keep ? lead->log->keep(lead->log->context, pair, output, cost, error) : EO_OK;
}

static int watch(void *context)
{
  const struct lead *lead = context;
  int done = lead->run->pairs - lead->missing_count + lead->taken;
  return eo_progress_report(lead->progress, EO_SCATTER_PROGRESS, (double)done / lead->run->pairs);
}

static enum eo_code find_missing(struct lead *lead, struct eo_error *error)
{
  struct eo_scatter_run *run = lead->run;
  const struct eo_scatter_log *log = lead->log;
  lead->missing = malloc(sizeof *lead->missing * (size_t)run->pairs);
  if (!lead->missing)
    return eo_error_memory(error);
  for (int i = 0; i < run->pairs; i++)
    if (!log->find || !log->find(log->context, i, run->output + (size_t)i * (size_t)run->outputs))
      lead->missing[lead->missing_count++] = i;
  return EO_OK;
}

enum eo_code eo_scatter_run_on_crew(struct eo_scatter_run *run, struct eo_crew *crew, const struct eo_design *design,
                                    const struct eo_scatter *scatter, const struct eo_scatter_plan *plan,
                                    const struct eo_progress *progress, struct eo_error *error)
{
  struct lead lead = {.run = run, .log = &plan->log, .progress = progress};
  struct eo_text order = {0};
  EO_TRY(eo_scatter_run_draw(run, design, scatter, plan, error));
  eo_design_write(design, &order);
  enum eo_code code = order.failed ? eo_error_memory(error) : find_missing(&lead, error);
  const struct eo_crew_task task = {.trade = &eo_scatter_trade,
                                    .order = order.data,
                                    .size = order.size,
                                    .items = 1 + lead.missing_count,
                                    .write = write_item,
                                    .take = take_answer,
                                    .watch = watch,
                                    .context = &lead};
  if (!code)
    code = eo_crew_run(crew, &task, error);
  eo_text_done(&order);
  free(lead.missing);
  return code;
}
