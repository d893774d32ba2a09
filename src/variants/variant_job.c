/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "variants/variant_job.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "format/json.h"
#include "store/queue.h"

static enum eo_code take_spec(void *context, const struct eo_stored_job *job, struct eo_error *error)
{
  json_t **document = context;
  if (job->kind != EO_JOB_STUDY)
    return eo_error_set(error, EO_ERROR_INPUT, "", "Job %lld is no study.", (long long)job->id);
  *document = eo_json_parse(job->spec, strlen(job->spec), error);
  return *document ? EO_OK : error->code;
}

static enum eo_code find_document(struct eo_store *store, int64_t job, json_t **document, struct eo_error *error)
{
  enum eo_job_outcome outcome;
  EO_TRY(eo_queue_find(store, job, take_spec, document, &outcome, error));
  return *document ? EO_OK : eo_error_set(error, EO_ERROR_INPUT, "", "There is no job %lld.", (long long)job);
}

enum eo_code eo_variant_job_run(struct eo_store *store, int64_t job, struct eo_crew *crew, eo_variant_watch *watch,
                                void *context, struct eo_variant_result *result, struct eo_error *error)
{
  struct eo_variant_plan plan;
  json_t *document = NULL;
  struct eo_faults *faults = calloc(1, sizeof *faults);
  struct eo_variant_run run = {
      .plan = &plan, .store = store, .crew = crew, .job = job, .watch = watch, .context = context};
  enum eo_code code = faults ? find_document(store, job, &document, error) : eo_error_memory(error);
  if (!code) {
    if (!eo_variant_plan_init(&plan, document, faults))
      code = eo_faults_first(faults, error);
    run.document = document;
    if (!code)
      code = eo_variant_study_run(&run, result, error);
    eo_variant_plan_done(&plan);
  }
  json_decref(document);
  free(faults);
  return code;
}

static void count(struct eo_job_live *live, int rows, int done, int reused, int refused, int not_converged)
{
  live->state = EO_JOB_RUNNING;
  live->study = true;
  live->individuals = rows;
  live->true_evaluations = done;
  live->reused = reused;
  snprintf(live->what, sizeof live->what, "%d of %d variants, %d refused, %d not converged", done, rows, refused,
           not_converged);
}

void eo_variant_job_follow(struct eo_job_live *live, const struct eo_variant_report *report)
{
  count(live, report->rows, report->done, report->reused, report->refused, report->not_converged);
  live->fraction = report->fraction;
  live->seconds = report->seconds;
  live->seconds_left = report->seconds_left;
}

void eo_variant_job_conclude(struct eo_job_live *live, const struct eo_variant_result *result)
{
  count(live, result->rows, result->done, result->reused, result->refused, result->not_converged);
  live->fraction = result->rows ? (double)result->done / result->rows : 1;
  live->seconds = result->seconds;
  live->seconds_left = result->cancelled ? NAN : 0;
}
