/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/app.h"
#include "app/crew_start.h"
#include "app/data.h"
#include "app/number.h"
#include "app/watch.h"
#include "app/work_note.h"
#include "base/parallel.h"
#include "document/search_space.h"
#include "study/study.h"

struct request {
  const char *work, *file, *data, *algorithm, *budget, *threads, *front,
      *cache; /* cache: read by eo_app_crew_begin() */
  struct eo_app_crew *crew;
  struct eo_watch watch;
  struct eo_work_note note;
  bool json, fresh, restart;
  int thread_count;
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_warnings warnings;
};

/* "1:02:03" or "02:03" */
static void format_time(char *text, size_t size, double seconds)
{
  long s = isfinite(seconds) ? lround(seconds) : -1;
  if (s < 0)
    snprintf(text, size, "--:--");
  else if (s < 3600)
    snprintf(text, size, "%02ld:%02ld", s / 60, s % 60);
  else
    snprintf(text, size, "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
}

static int show_progress(void *context, const struct eo_study_report *report)
{
  struct request *request = context;
  struct eo_watch *watch = &request->watch;
  char line[240], left[32], best[20] = "-", sums[80] = "";
  if (eo_watch_due(watch)) { /* what matters most first: narrow terminals cut the line */
    format_time(left, sizeof left, report->seconds_left);
    if (report->best->there) {
      const double *f = report->best->value.sums.f;
      snprintf(best, sizeof best, "%.4g", report->best->value.objective);
      snprintf(sums, sizeof sums, ", %.3g um, %.4g N, %.3g m/s2", 1e6 * f[0], f[1], f[2]);
    }
    snprintf(line, sizeof line, "%3.0f %%, %s left, J %s, gen %d, true %d, predicted %d, known %d, PFC %.0f %%%s",
             100 * report->fraction, left, best, report->generation, report->true_evaluations, report->predicted,
             report->reused, report->individuals ? 100. * report->true_evaluations / report->individuals : 100, sums);
    eo_watch_show(watch, line);
  }
  if (request->note.job)
    eo_job_live_follow(&request->note.live, report);
  return eo_work_note_shall_stop(&request->note, watch);
}

/* What the command line says in place of the design. */
static bool apply_options(struct request *request, struct eo_error *error)
{
  struct eo_optimizer_settings *search = &request->design.optimization.search;
  int budget = search->true_evaluations;
  request->thread_count = 0;
  if (request->algorithm && eo_optimizer_algorithm_find(request->algorithm) < 0) {
    eo_error_set(error, EO_ERROR_INPUT, "", "\"%.40s\" is no algorithm: credibility-ga, fpga, ga or nsga2.",
                 request->algorithm);
    return false;
  }
  if (request->algorithm)
    search->algorithm = eo_optimizer_algorithm_find(request->algorithm);
  if (request->budget && !eo_app_read_whole(request->budget, "--budget", 1, 10000000, &budget, error))
    return false;
  search->true_evaluations = budget;
  if (request->front && search->algorithm != EO_NSGA2) {
    eo_error_set(error, EO_ERROR_INPUT, "", "--front is a Pareto front, and %s finds none: --algorithm nsga2 does.",
                 eo_optimizer_algorithm_name(search->algorithm));
    return false;
  }
  return !request->threads ||
         eo_app_read_whole(request->threads, "--threads", 1, EO_MAX_THREADS, &request->thread_count, error);
}

static enum eo_code prepare(struct request *request, const struct eo_progress *progress, struct eo_pair **pair,
                            struct eo_error *error)
{
  struct eo_pair_options options = {.cache_directory = request->crew->cache.data};
  return eo_pair_new(pair, &request->design, &options, progress, error);
}

static enum eo_code save_front(const struct request *request, const json_t *document, struct eo_error *error)
{
  struct eo_text text = {0};
  enum eo_code code = EO_OK;
  if (request->front && eo_study_front_csv(document, &text))
    code = eo_text_save(&text, request->front, error);
  eo_text_done(&text);
  return code;
}

static enum eo_code search(struct request *request, const struct eo_study_plan *plan, struct eo_study_result *result,
                           json_t **document, struct eo_error *error)
{
  EO_TRY(eo_study_run(plan, result, error));
  EO_TRY(eo_study_document(plan, result, &request->warnings, document, error));
  EO_TRY(save_front(request, *document, error));
  eo_job_live_conclude(&request->note.live, result);
  if (result->stopped != EO_STOP_CANCELLED)
    request->note.live.fraction = 1;
  return EO_OK;
}

static int run_study(struct request *request, const struct eo_pair *pair, struct eo_store *store)
{
  const struct eo_study_plan plan = {.design = &request->design,
                                     .pair = pair,
                                     .store = store,
                                     .crew = request->crew->crew.size > 1 ? &request->crew->crew : NULL,
                                     .threads = request->thread_count,
                                     .job = request->note.job,
                                     .fresh = request->fresh,
                                     .restart = request->restart,
                                     .watch = show_progress,
                                     .context = request};
  struct eo_study_result result;
  struct eo_error error;
  json_t *document = NULL;
  enum eo_code code = search(request, &plan, &result, &document, &error);
  eo_work_note_end(&request->note, code, &error);
  eo_watch_clear(&request->watch);
  eo_study_result_done(&result);
  if (!code && !request->work)
    return eo_app_show(document, request->json, eo_study_result_summary);
  json_decref(document);
  return code ? eo_app_fail(code == EO_ERROR_INPUT ? request->file : NULL, &error) : EO_EXIT_DONE;
}

static int run_prepared(struct request *request, struct eo_store *store)
{
  struct eo_error error;
  struct eo_pair *pair = NULL;
  int status;
  eo_watch_start(&request->watch);
  enum eo_code code = prepare(request, &request->watch.progress, &pair, &error);
  eo_watch_clear(&request->watch);
  if (code) {
    eo_work_note_end(&request->note, code, &error);
    status = eo_app_fail(code == EO_ERROR_INPUT ? request->file : NULL, &error);
  } else
    status = run_study(request, pair, store);
  eo_watch_end(&request->watch);
  eo_pair_free(pair);
  return status;
}

static enum eo_code take_job(void *context, const struct eo_stored_job *job, struct eo_error *error)
{
  struct request *request = context;
  if (job->kind != EO_JOB_OPTIMIZE)
    return eo_error_set(error, EO_ERROR_INPUT, "", "Job %lld is no optimization.", (long long)job->id);
  request->fresh = job->fresh;
  return eo_design_read(job->design, strlen(job->design), &request->design, &request->geometry, &request->warnings,
                        error);
}

/* For a server: the design of its job, of which the table says everything. */
static enum eo_code find_job(struct request *request, struct eo_store *store, struct eo_error *error)
{
  int job;
  enum eo_job_outcome outcome;
  if (!request->work)
    return EO_OK;
  if (!eo_app_read_whole(request->work, "--work", 1, INT32_MAX, &job, error))
    return error->code;
  request->note = (struct eo_work_note){.store = store, .job = job};
  EO_TRY(eo_queue_find(store, job, take_job, request, &outcome, error));
  return outcome == EO_JOB_OUTCOME_DONE ? EO_OK : eo_error_set(error, EO_ERROR_INPUT, "", "There is no job %d.", job);
}

static int run_request(struct request *request)
{
  struct eo_error error;
  struct eo_store *store = NULL;
  struct eo_text directory = {0};
  struct eo_study_space space;
  bool checked = request->work || (apply_options(request, &error) &&
                                   !eo_study_space_init(&space, &request->design, &request->geometry, &error));
  if (!checked)
    return eo_app_fail(*error.pointer ? request->file : NULL, &error);
  enum eo_code code = eo_app_data_directory(request->data, &directory, &error);
  if (!code)
    code = eo_store_open(&store, directory.data, EO_STORE_WRITE, &error);
  if (!code)
    code = find_job(request, store, &error);
  int status = code ? eo_app_fail(NULL, &error) : run_prepared(request, store);
  eo_store_close(store);
  eo_text_done(&directory);
  return status;
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
  const struct eo_option options[] = {{.name = "--algorithm", .value = &request->algorithm},
                                      {.name = "--budget", .value = &request->budget},
                                      {.name = "--threads", .value = &request->threads},
                                      {.name = "--data", .value = &request->data},
                                      {.name = "--cache", .value = &request->cache},
                                      {.name = "--work", .value = &request->work},
                                      {.name = "--front", .value = &request->front},
                                      {.name = "--json", .flag = &request->json},
                                      {.name = "--fresh", .flag = &request->fresh},
                                      {.name = "--restart", .flag = &request->restart},
                                      {.name = NULL}};
  request->crew = &crew;
  if (eo_app_arguments(command, argc, argv, options, 0, 1, &request->file, &operands, &status) &&
      eo_app_design_or_job(command, request->work, operands, &status) &&
      (request->work ||
       eo_app_load_design(request->file, &request->design, &request->geometry, &request->warnings, &status)))
    status = run_request(request);
  free(request);
  eo_app_crew_end(&crew);
  return status;
}

const struct eo_command eo_command_optimize = {
    "optimize",
    "DESIGN.json [--algorithm NAME] [--budget N] [--threads N] [--data DIR] [--cache DIR] [--fresh] [--restart] "
    "[--front FILE] [--json] | --work N",
    "searches the modification that runs quietest over the duty cycle",
    "Every evaluation is kept in the history (see easeoff history), and later searches of the same pair use it, "
    "whatever\n"
    "their weights, bounds and algorithm. Ctrl-C prints the best so far. The same search, run again, goes on where it "
    "was\n"
    "interrupted, or gives its result again when it was finished; --restart searches on.\n"
    "\n"
    "  --algorithm NAME  credibility-ga, fpga, ga or nsga2, in place of the design's\n"
    "  --budget N        largest number of true evaluations, in place of the design's true_evaluations\n"
    "  --threads N       evaluations at a time (default: all cores); the result does not depend on it\n"
    "  --fresh           the algorithm learns nothing from earlier searches; what it asks for is still looked up\n"
    "  --restart         a new search of the same kind, which knows what the earlier ones found\n"
    "  --front FILE      the Pareto front of nsga2 as comma-separated values (-: standard output)\n"
    "  --json            the result document, as the server returns it\n"
    "  --work N          works on job N of a server's queue\n"
    "\n" EO_APP_CREW_HELP EO_APP_HISTORY_HELP EO_APP_DATA_HELP,
    run};
