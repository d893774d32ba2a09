/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reproduction/reproduction_job.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "evaluation/evaluator.h"
#include "format/json.h"
#include "store/jobs.h"
#include "store/lock.h"
#include "store/queue.h"

void eo_reproduction_order_write(const struct eo_reproduction_order *order, struct eo_text *text)
{
  json_t *document = eo_table_encode(&eo_reproduction_order_table, order);
  if (document)
    eo_json_write(text, document, EO_JSON_COMPACT);
  else
    text->failed = true;
  json_decref(document);
}

/* What the table of jobs has of it. */
struct asked {
  struct eo_reproduction_order order;
  char hash[EO_HASH_LENGTH + 1]; /* equal reproductions take equal paths */
};

static enum eo_code read_order(const char *spec, struct eo_reproduction_order *order, struct eo_error *error)
{
  json_t *document = eo_json_parse(spec, strlen(spec), error);
  if (!document)
    return error->code;
  struct eo_faults *faults = calloc(1, sizeof *faults);
  enum eo_code code = faults ? EO_OK : eo_error_memory(error);
  if (!code) {
    eo_table_decode(&eo_reproduction_order_table, document, NULL, order, faults);
    code = eo_faults_first(faults, error);
  }
  free(faults);
  json_decref(document);
  return code;
}

static enum eo_code take_job(void *context, const struct eo_stored_job *job, struct eo_error *error)
{
  struct asked *asked = context;
  struct eo_hash hash;
  if (job->kind != EO_JOB_REPRODUCE)
    return eo_error_set(error, EO_ERROR_INPUT, "", "Job %lld is no reproduction.", (long long)job->id);
  eo_hash_init(&hash);
  eo_hash_add_text(&hash, "reproduce", job->spec);
  eo_hash_add_text(&hash, "design", job->design);
  eo_hash_add_number(&hash, "evaluator", EO_EVALUATOR_VERSION);
  eo_hash_finish(&hash, asked->hash);
  return read_order(job->spec, &asked->order, error);
}

static enum eo_code find_asked(const struct eo_reproduction_job *job, struct asked *asked, struct eo_error *error)
{
  enum eo_job_outcome outcome;
  EO_TRY(eo_queue_find(job->store, job->job, take_job, asked, &outcome, error));
  return outcome == EO_JOB_OUTCOME_DONE
             ? EO_OK
             : eo_error_set(error, EO_ERROR_INPUT, "", "There is no job %lld.", (long long)job->job);
}

static enum eo_code keep_and_end(const struct eo_reproduction_job *job, struct eo_stored_job *row, const char *result,
                                 struct eo_error *error)
{
  row->state = EO_JOB_DONE;
  row->study = "";
  EO_TRY(eo_store_keep_result(job->store, job->job, result, error));
  return eo_store_update_job(job->store, row, error);
}

/* Result and end are one transaction. */
static enum eo_code conclude(const struct eo_reproduction_job *job, struct eo_stored_job *row, const json_t *document,
                             struct eo_error *error)
{
  struct eo_text text = {0};
  eo_json_write(&text, document, EO_JSON_COMPACT);
  enum eo_code code = text.failed ? eo_error_memory(error) : eo_store_begin_lasting(job->store, error);
  if (!code)
    code = eo_store_end(job->store, keep_and_end(job, row, text.data, error), error);
  eo_text_done(&text);
  return code;
}

static enum eo_code begin(struct eo_store *store, struct eo_stored_job *row, struct eo_error *error)
{
  bool resumed;
  EO_TRY(eo_store_begin(store, error));
  return eo_store_end(store, eo_store_begin_job(store, row, &resumed, error), error);
}

enum eo_code eo_reproduction_job_run(const struct eo_reproduction_job *job, struct eo_error *error)
{
  struct asked asked = {0};
  json_t *document = NULL;
  EO_TRY(find_asked(job, &asked, error));
  struct eo_stored_job row = {
      .id = job->job, .kind = EO_JOB_REPRODUCE, .study = asked.hash, .stopped = "", .best_value = NAN};
  EO_TRY(begin(job->store, &row, error));
  const struct eo_reproduction_plan plan = {
      .store = job->store, .order = asked.order, .pair = job->pair, .threads = job->threads, .progress = job->progress};
  enum eo_code code = eo_reproduction_run(&plan, &document, error);
  if (!code)
    code = conclude(job, &row, document, error);
  json_decref(document);
  eo_store_release_job(job->store, job->job);
  return code;
}

enum eo_code eo_reproduction_job_files(const struct eo_text *result, struct eo_file_set *files, struct eo_error *error)
{
  json_t *document = eo_json_parse(result->data, result->size, error);
  if (!document)
    return error->code;
  eo_reproduction_files(document, files);
  struct eo_text *page = eo_file_set_add(files, "reproduction.html");
  if (page)
    eo_reproduction_page(document, page);
  json_decref(document);
  return files->failed ? eo_error_memory(error) : EO_OK;
}

void eo_reproduction_job_follow(struct eo_job_live *live, const char *what, double fraction)
{
  live->state = EO_JOB_RUNNING;
  snprintf(live->what, sizeof live->what, "%s", what);
  live->fraction = fraction;
}
