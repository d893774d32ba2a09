/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is seen of a tolerance job: how far it is, and its pairs. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "store/variant_rows.h"
#include "study/tolerance_job.h"

struct table {
  struct eo_scatter_run rows;
  bool whole;
  int there;
};

static enum eo_code take_row(void *context, const struct eo_stored_variant *row, struct eo_error *error)
{
  struct table *table = context;
  (void)error;
  if (row->ordinal >= table->rows.pairs)
    return EO_OK;
  memcpy(table->rows.output + (size_t)row->ordinal * (size_t)table->rows.outputs, row->number,
         sizeof *row->number * (size_t)table->rows.outputs);
  table->there += !table->rows.full[row->ordinal];
  table->rows.full[row->ordinal] = true;
  return EO_OK;
}

/* The rows of a job that has all of them, as many as it computes in full, or those that were there at its stop. */
static enum eo_code fill_table(struct table *table, struct eo_store *store, int64_t job, const struct eo_design *design,
                               struct eo_scatter *scatter, struct eo_error *error)
{
  const struct eo_scatter_plan plan = eo_tolerance_plan(&design->tolerance);
  EO_TRY(eo_scatter_of_design(scatter, design, true, NULL, error));
  EO_TRY(eo_scatter_run_draw(&table->rows, design, scatter, &plan, error));
  for (int i = 0; i < table->rows.pairs; i++)
    table->rows.full[i] = false;
  EO_TRY(eo_store_each_variant(store, job, -1, table->rows.outputs, take_row, table, error));
  if (table->whole && !table->rows.coarse && table->there < table->rows.pairs)
    return eo_error_set(error, EO_ERROR_INPUT, "", "The job has %d of its %d pairs.", table->there, table->rows.pairs);
  return EO_OK;
}

enum eo_code eo_tolerance_job_csv(struct eo_store *store, int64_t job, bool whole, const struct eo_design *design,
                                  struct eo_text *text, struct eo_error *error)
{
  struct table table = {.whole = whole};
  struct eo_scatter *scatter = malloc(sizeof *scatter);
  if (!scatter)
    return eo_error_memory(error);
  enum eo_code code = fill_table(&table, store, job, design, scatter, error);
  const struct eo_tolerance_report report = {.design = design, .scatter = scatter, .run = &table.rows};
  if (!code) {
    eo_tolerance_csv(&report, text);
    code = text->failed ? eo_error_memory(error) : EO_OK;
  }
  eo_scatter_run_done(&table.rows);
  free(scatter);
  return code;
}

static void count(struct eo_job_live *live, int pairs, int done, int known)
{
  live->state = EO_JOB_RUNNING;
  live->study = true;
  live->individuals = pairs;
  live->true_evaluations = done;
  live->reused = known;
}

void eo_tolerance_job_follow(struct eo_job_live *live, const struct eo_tolerance_progress *progress)
{
  count(live, progress->pairs, progress->done, progress->known);
  snprintf(live->what, sizeof live->what, "%.20s, %d of %d", progress->what, progress->done, progress->pairs);
  live->fraction = progress->fraction;
  live->seconds = progress->seconds;
  live->seconds_left = progress->seconds_left;
}

void eo_tolerance_job_conclude(struct eo_job_live *live, const struct eo_tolerance_outcome *outcome)
{
  count(live, outcome->pairs, outcome->done, outcome->known);
  snprintf(live->what, sizeof live->what, "%d of %d pairs as made", outcome->done, outcome->pairs);
  live->fraction = outcome->cancelled ? (double)outcome->done / outcome->pairs : 1;
  live->seconds = outcome->seconds;
  live->seconds_left = outcome->cancelled ? NAN : 0;
}
