/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/app.h"
#include "app/crew_start.h"
#include "app/data.h"
#include "app/number.h"
#include "app/watch.h"
#include "app/work_note.h"
#include "document/pair_log.h"
#include "document/tolerance_document.h"
#include "evaluation/scatter_tally.h"
#include "format/json.h"
#include "study/scatter_crew.h"
#include "study/tolerance_job.h"

struct request {
  const char *file, *pairs, *grade, *seed, *csv, *worst, *keep, *work;
  const char *data, *cache, *threads; /* read by eo_app_crew_begin(), like --no-cache */
  bool json, no_cache, no_vibration, single_teeth;
  struct eo_app_crew *crew;
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_warnings warnings;
  struct eo_scatter scatter;
  bool assumed, stopped; /* stopped: what is shown is of the pairs that were there then */
  struct eo_watch watch;
  struct eo_work_note note;
};

/* A whole number of an option; *value stays where it is not given. */
static bool read_whole(const char *text, const char *option, int low, int high, int *value, int *status)
{
  struct eo_error error;
  if (!text || eo_app_read_whole(text, option, low, high, value, &error))
    return true;
  *status = eo_app_fail(NULL, &error);
  return false;
}

/* Options stand in place of what the block says. */
static bool read_options(struct request *request, int *status)
{
  struct eo_tolerance_settings *tolerance_settings = &request->design.tolerance;
  int seed = -1;
  if (!read_whole(request->pairs, "--pairs", 1, EO_SCATTER_MOST_PAIRS, &tolerance_settings->pairs, status) ||
      !read_whole(request->grade, "--class", 0, 12, &tolerance_settings->grade, status) ||
      !read_whole(request->seed, "--seed", 0, 2147483647, &seed, status))
    return false;
  if (request->grade && tolerance_settings->preset == EO_SCATTER_AS_STATED)
    tolerance_settings->preset = EO_SCATTER_ISO_CLASS;
  if (seed >= 0)
    tolerance_settings->seed = (uint64_t)seed;
  if (request->no_vibration)
    tolerance_settings->vibration = false;
  if (request->single_teeth)
    tolerance_settings->single_teeth = true;
  return true;
}

static enum eo_code save(struct eo_text *text, const char *path, struct eo_error *error)
{
  enum eo_code code = eo_text_save(text, path, error);
  eo_text_done(text);
  return code;
}

static enum eo_code save_files(const struct request *request, const struct eo_tolerance_report *report,
                               struct eo_error *error)
{
  struct eo_text rows = {0}, worst = {0};
  if (request->csv) {
    eo_tolerance_csv(report, &rows);
    EO_TRY(save(&rows, request->csv, error));
  }
  if (!request->worst)
    return EO_OK;
  json_t *document = eo_design_encode(&report->worst_design);
  if (document)
    eo_json_write(&worst, document, EO_JSON_PRETTY);
  worst.failed = worst.failed || !document;
  json_decref(document);
  return save(&worst, request->worst, error);
}

static int show(const struct request *request, const struct eo_tolerance_report *report)
{
  struct eo_text text = {0};
  if (request->json)
    return eo_app_print_json(eo_tolerance_encode(report, &request->warnings), false);
  eo_tolerance_summary(report, &request->warnings, &text);
  return eo_app_print(&text);
}

static enum eo_code open_log(const struct request *request, struct eo_pair_log **log, struct eo_error *error)
{
  const struct eo_design *design = &request->design;
  return request->keep ? eo_pair_log_open(log, request->keep, design, eo_scatter_outputs(design), error) : EO_OK;
}

static enum eo_code run_here(const struct request *request, const struct eo_scatter_plan *plan,
                             const struct eo_progress *progress, struct eo_scatter_run *run, struct eo_error *error)
{
  const struct eo_pair_options options = {.cache_directory = request->crew->cache.data};
  struct eo_pair *pair = NULL;
  EO_TRY(eo_pair_new(&pair, &request->design, &options, progress, error));
  enum eo_code code = eo_scatter_run_pairs(run, pair, &request->design, &request->scatter, plan, progress, error);
  eo_pair_free(pair);
  return code;
}

/* The rows, from the log as far as it has them; with other ranks these prepare the pair and evaluate. */
static enum eo_code run_logged(struct request *request, struct eo_scatter_tally *tally, struct eo_scatter_run *run,
                               struct eo_error *error)
{
  const struct eo_progress *progress = &request->watch.progress;
  struct eo_scatter_plan plan = eo_tolerance_plan(&request->design.tolerance);
  struct eo_crew *crew = &request->crew->crew;
  plan.threads = crew->place.threads;
  plan.log = eo_scatter_tally_log(tally);
  return crew->size > 1 ? eo_scatter_run_on_crew(run, crew, &request->design, &request->scatter, &plan, progress, error)
                        : run_here(request, &plan, progress, run, error);
}

/* After a stop what is there, where it is enough. */
static enum eo_code settle(struct request *request, const struct eo_scatter_tally *tally, struct eo_scatter_run *run,
                           struct eo_error *error)
{
  const char *on = request->keep ? " The same command goes on from here." : "";
  int full;
  EO_TRY(eo_scatter_tally_settle(tally, &request->design, run, &full, error));
  if (full < EO_SCATTER_FEWEST)
    return eo_error_set(error, EO_ERROR_CANCELLED, "", "Stopped.%s Numbers are shown from %d pairs in full on: %s %d.",
                        on, EO_SCATTER_FEWEST, full == 1 ? "there is" : "there are", full);
  request->stopped = true;
  eo_watch_clear(&request->watch);
  fprintf(stderr, "easeoff: Stopped.%s\n", on);
  return EO_OK;
}

static enum eo_code run_tallied(struct request *request, struct eo_pair_log *log, struct eo_scatter_run *run,
                                struct eo_error *error)
{
  struct eo_scatter_tally tally;
  const struct eo_scatter_log kept = eo_pair_log_of(log);
  EO_TRY(eo_scatter_tally_init(&tally, request->design.tolerance.pairs, &kept, error));
  enum eo_code code = run_logged(request, &tally, run, error);
  if (code && request->watch.stopped)
    code = settle(request, &tally, run, error);
  eo_scatter_tally_done(&tally);
  return code;
}

static enum eo_code run_pairs(struct request *request, struct eo_scatter_run *run, struct eo_error *error)
{
  struct eo_pair_log *log = NULL;
  EO_TRY(open_log(request, &log, error));
  enum eo_code code = run_tallied(request, log, run, error);
  eo_pair_log_close(log);
  return code;
}

/* The pairs are there: a stop does not lose their statistics, which take little beside them. */
static int show_statistics(void *context, const char *what, double fraction)
{
  struct eo_watch *watch = context;
  watch->progress.report(watch->progress.context, what, fraction);
  return 0;
}

static enum eo_code make(struct request *request, struct eo_scatter_run *run, struct eo_tolerance_report **report,
                         struct eo_error *error)
{
  const struct eo_progress progress = {show_statistics, &request->watch};
  EO_TRY(eo_scatter_of_design(&request->scatter, &request->design, true, &request->assumed, error));
  EO_TRY(eo_tolerance_check_limits(&request->design, error));
  EO_TRY(run_pairs(request, run, error));
  EO_TRY(eo_tolerance_report_new(report, &request->design, &request->scatter, run, request->assumed, &progress, error));
  (*report)->stopped = request->stopped;
  return EO_OK;
}

static int run_request(struct request *request)
{
  struct eo_watch *watch = &request->watch;
  struct eo_error error;
  struct eo_scatter_run run = {0};
  struct eo_tolerance_report *report = NULL;
  eo_watch_start(watch);
  enum eo_code code = make(request, &run, &report, &error);
  eo_watch_clear(watch);
  if (!code)
    code = save_files(request, report, &error);
  int status = code ? eo_app_fail(code == EO_ERROR_INPUT ? request->file : NULL, &error) : show(request, report);
  eo_watch_end(watch);
  eo_tolerance_report_free(report);
  eo_scatter_run_done(&run);
  return status;
}

/* For a server: its job, of which the table says everything. */

static enum eo_code take_job(void *context, const struct eo_stored_job *job, struct eo_error *error)
{
  struct request *request = context;
  if (job->kind != EO_JOB_TOLERANCE)
    return eo_error_set(error, EO_ERROR_INPUT, "", "Job %lld is no tolerance analysis.", (long long)job->id);
  return eo_design_read(job->design, strlen(job->design), &request->design, &request->geometry, &request->warnings,
                        error);
}

static int follow_pairs(void *context, const struct eo_tolerance_progress *progress)
{
  struct request *request = context;
  eo_tolerance_job_follow(&request->note.live, progress);
  return eo_work_note_shall_stop(&request->note, &request->watch);
}

/* By the table; a signal only ends this process. */
static bool is_given_up(void *context)
{
  return ((const struct request *)context)->note.stop;
}

static enum eo_code run_job(struct request *request, struct eo_tolerance_outcome *outcome, struct eo_error *error)
{
  const struct eo_pair_options options = {.cache_directory = request->crew->cache.data};
  struct eo_tolerance_job job = {.store = request->note.store,
                                 .job = request->note.job,
                                 .design = &request->design,
                                 .warnings = &request->warnings,
                                 .threads = request->crew->crew.place.threads,
                                 .watch = follow_pairs,
                                 .is_given_up = is_given_up,
                                 .context = request};
  struct eo_pair *pair = NULL;
  if (request->crew->crew.size > 1)
    job.crew = &request->crew->crew;
  else
    EO_TRY(eo_pair_new(&pair, &request->design, &options, &request->watch.progress, error));
  job.pair = pair;
  enum eo_code code = eo_tolerance_job_run(&job, outcome, error);
  eo_pair_free(pair);
  return code;
}

static enum eo_code open_store(struct request *request, struct eo_error *error)
{
  struct eo_text directory = {0};
  enum eo_code code = eo_app_data_directory(request->data, &directory, error);
  if (!code)
    code = eo_store_open(&request->note.store, directory.data, EO_STORE_WRITE, error);
  eo_text_done(&directory);
  return code;
}

static enum eo_code find_job(struct request *request, struct eo_error *error)
{
  int job;
  enum eo_job_outcome outcome;
  request->note.job = 0;
  if (!eo_app_read_whole(request->work, "--work", 1, INT32_MAX, &job, error))
    return error->code;
  EO_TRY(open_store(request, error));
  EO_TRY(eo_queue_find(request->note.store, job, take_job, request, &outcome, error));
  if (outcome != EO_JOB_OUTCOME_DONE)
    return eo_error_set(error, EO_ERROR_INPUT, "", "There is no job %d.", job);
  request->note.job = job;
  return EO_OK;
}

static int work(struct request *request)
{
  struct eo_error error;
  struct eo_tolerance_outcome outcome;
  enum eo_code code = find_job(request, &error);
  if (!code) {
    eo_watch_start(&request->watch);
    code = run_job(request, &outcome, &error);
    if (!code)
      eo_tolerance_job_conclude(&request->note.live, &outcome);
    eo_work_note_end(&request->note, code, &error);
    eo_watch_end(&request->watch);
  }
  eo_store_close(request->note.store);
  return code ? eo_app_fail(NULL, &error) : EO_EXIT_DONE;
}

static int run_design(struct request *request)
{
  int status;
  return eo_app_load_design(request->file, &request->design, &request->geometry, &request->warnings, &status) &&
                 read_options(request, &status)
             ? run_request(request)
             : status;
}

static int run(const struct eo_command *command, int argc, char **argv)
{
  int operands, status = EO_EXIT_FAILED;
  struct request *request = eo_app_request(sizeof *request, &status);
  struct eo_app_crew crew;
  if (!request || !eo_app_crew_begin(&crew, argc, argv, &status)) {
    free(request);
    return status;
  }
  const struct eo_option options[] = {{.name = "--pairs", .value = &request->pairs},
                                      {.name = "--class", .value = &request->grade},
                                      {.name = "--seed", .value = &request->seed},
                                      {.name = "--no-vibration", .flag = &request->no_vibration},
                                      {.name = "--worst", .value = &request->worst},
                                      {.name = "--keep", .value = &request->keep},
                                      {.name = "--work", .value = &request->work},
                                      {.name = "--json", .flag = &request->json},
                                      {.name = "--csv", .value = &request->csv},
                                      {.name = "--data", .value = &request->data},
                                      {.name = "--no-cache", .flag = &request->no_cache},
                                      {.name = "--threads", .value = &request->threads},
                                      {.name = "--cache", .value = &request->cache},
                                      {.name = "--single-teeth", .flag = &request->single_teeth},
                                      {.name = NULL}};
  request->crew = &crew;
  if (eo_app_arguments(command, argc, argv, options, 0, 1, &request->file, &operands, &status) &&
      eo_app_design_or_job(command, request->work, operands, &status))
    status = request->work ? work(request) : run_design(request);
  free(request);
  eo_app_crew_end(&crew);
  return status;
}

const struct eo_command eo_command_tolerance = {
    "tolerance",
    "DESIGN.json [--pairs N] [--class N] [--seed N] [--no-vibration] [--single-teeth] [--worst FILE] [--keep FILE] "
    "[--json] "
    "[--csv FILE] [--threads N] [--data DIR] [--cache DIR] [--no-cache] | --work N",
    "many pairs as they are made: percentiles, the deciding inputs, yield",
    "The design's block \"tolerance\" states what scatters: a preset, inputs by their keys, and limits that a good "
    "pair\n"
    "meets. \"tolerance\": {\"preset\": \"iso_class\", \"class\": 5} is enough; without a block the program takes "
    "class 5 of ISO\n"
    "1328-1:2013.\n"
    "\n"
    "Percentiles come with the interval in which they lie with 95 % probability. R2 says how much of the variance the\n"
    "inputs explain linearly; Q2 says how much a quadratic surface explains for pairs that it was not fitted to.\n"
    "\n"
    "From 500 pairs on, all pairs are computed on a coarse grid, and only those that decide are computed in full. A "
    "note\n"
    "then says how many these are and how far the coarse ones are off; every interval includes that error. "
    "\"method\":\n"
    "\"full\" in the block computes all pairs in full.\n"
    "\n"
    "\"centre_distance\": true in the block lets the axes stand apart within their allowance; the key\n"
    "alignment.centre_distance_deviation_um among the inputs does it with a distribution of its own.\n\n"
    "--single-teeth gives every pair teeth of its own, with index deviations within the class, and computes its "
    "hunting\n"
    "period; at every instant that takes some hundred times as long. From 64 pairs on it follows from few solutions, "
    "for\n"
    "all pairs on a coarse grid and for some forty in full.\n"
    "\n"
    "--worst FILE writes the worst pair as a design. --csv FILE writes a line for each pair that was computed in "
    "full.\n"
    "--keep FILE keeps every pair as soon as it is computed: the same command goes on from there. Ctrl-C prints "
    "what\n"
    "the pairs say that are there. All cores work unless --threads says otherwise; the numbers do not depend on it.\n"
    "--work N works on job N of a server's queue.\n"
    "\n" EO_APP_CREW_HELP EO_APP_DATA_HELP "--no-cache neither reads nor keeps it.\n",
    run};
