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
#include "base/parallel.h"
#include "document/search_space.h"
#include "study/study.h"

struct request {
  const char *file, *data, *algorithm, *budget, *threads, *cache; /* cache: read by eo_app_crew_begin() */
  struct eo_app_crew *crew;
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

static int show_progress(void *context, const struct eo_study_report *r)
{
  struct eo_watch *watch = context;
  char line[240], left[32], best[20] = "-", sums[80] = "";
  if (eo_watch_due(watch)) { /* what matters most first: narrow terminals cut the line */
    format_time(left, sizeof left, r->seconds_left);
    if (r->best->there) {
      const double *f = r->best->value.sums.f;
      snprintf(best, sizeof best, "%.4g", r->best->value.objective);
      snprintf(sums, sizeof sums, ", %.3g um, %.4g N, %.3g m/s2", 1e6 * f[0], f[1], f[2]);
    }
    snprintf(line, sizeof line, "%3.0f %%, %s left, J %s, gen %d, true %d, predicted %d, known %d, PFC %.0f %%%s",
             100 * r->fraction, left, best, r->generation, r->true_evaluations, r->predicted, r->reused,
             r->individuals ? 100. * r->true_evaluations / r->individuals : 100, sums);
    eo_watch_show(watch, line);
  }
  return watch->stopped;
}

/* What the command line says in place of the design. */
static bool apply_options(struct request *q, struct eo_error *error)
{
  struct eo_optimizer_settings *search = &q->design.optimization.search;
  int budget = search->true_evaluations;
  q->thread_count = 0;
  if (q->algorithm && eo_optimizer_algorithm_find(q->algorithm) < 0) {
    eo_error_set(error, EO_ERROR_INPUT, "", "\"%.40s\" is no algorithm: credibility-ga, fpga, ga or nsga2.",
                 q->algorithm);
    return false;
  }
  if (q->algorithm)
    search->algorithm = eo_optimizer_algorithm_find(q->algorithm);
  if (q->budget && !eo_app_read_whole(q->budget, "--budget", 1, 10000000, &budget, error))
    return false;
  search->true_evaluations = budget;
  return !q->threads || eo_app_read_whole(q->threads, "--threads", 1, EO_MAX_THREADS, &q->thread_count, error);
}

static enum eo_code prepare(struct request *q, const struct eo_progress *progress, struct eo_pair **pair,
                            struct eo_error *error)
{
  struct eo_pair_options options = {.cache_directory = q->crew->cache.data};
  return eo_pair_new(pair, &q->design, &options, progress, error);
}

static int show(const struct request *q, json_t *document)
{
  struct eo_text text = {0};
  if (q->json)
    return eo_app_print_json(document, false);
  eo_study_result_summary(document, &text);
  json_decref(document);
  return eo_app_print(&text);
}

static int run_study(struct request *q, const struct eo_pair *pair, struct eo_store *store, struct eo_watch *watch)
{
  const struct eo_study_plan plan = {.design = &q->design,
                                     .pair = pair,
                                     .store = store,
                                     .crew = q->crew->crew.size > 1 ? &q->crew->crew : NULL,
                                     .threads = q->thread_count,
                                     .fresh = q->fresh,
                                     .restart = q->restart,
                                     .watch = show_progress,
                                     .context = watch};
  struct eo_study_result result;
  struct eo_error error;
  json_t *document = NULL;
  enum eo_code code = eo_study_run(&plan, &result, &error);
  if (!code)
    code = eo_study_document(&plan, &result, &q->warnings, &document, &error);
  eo_watch_clear(watch);
  eo_study_result_done(&result);
  return code ? eo_app_fail(code == EO_ERROR_INPUT ? q->file : NULL, &error) : show(q, document);
}

static int run_request(struct request *q)
{
  struct eo_watch watch;
  struct eo_error error;
  struct eo_pair *pair = NULL;
  struct eo_store *store = NULL;
  struct eo_text directory = {0};
  int status;
  if (!apply_options(q, &error))
    return eo_app_fail(NULL, &error);
  struct eo_study_space space;
  if (eo_study_space_init(&space, &q->design, &q->geometry, &error))
    return eo_app_fail(q->file, &error);
  enum eo_code code = eo_app_data_directory(q->data, &directory, &error);
  if (!code)
    code = eo_store_open(&store, directory.data, EO_STORE_WRITE, &error);
  eo_watch_start(&watch);
  if (!code)
    code = prepare(q, &watch.progress, &pair, &error);
  eo_watch_clear(&watch);
  if (code)
    status = eo_app_fail(code == EO_ERROR_INPUT ? q->file : NULL, &error);
  else
    status = run_study(q, pair, store, &watch);
  eo_watch_end(&watch);
  eo_pair_free(pair);
  eo_store_close(store);
  eo_text_done(&directory);
  return status;
}

static int run(const struct eo_command *command, int argc, char **argv)
{
  struct request *q = calloc(1, sizeof *q);
  struct eo_app_crew crew;
  int operands, status = EO_EXIT_FAILED;
  if (!q || !eo_app_crew_begin(&crew, argc, argv, &status)) {
    free(q);
    return status;
  }
  const struct eo_option options[] = {{.name = "--algorithm", .value = &q->algorithm},
                                      {.name = "--budget", .value = &q->budget},
                                      {.name = "--threads", .value = &q->threads},
                                      {.name = "--data", .value = &q->data},
                                      {.name = "--cache", .value = &q->cache},
                                      {.name = "--json", .flag = &q->json},
                                      {.name = "--fresh", .flag = &q->fresh},
                                      {.name = "--restart", .flag = &q->restart},
                                      {.name = NULL}};
  q->crew = &crew;
  if (eo_app_arguments(command, argc, argv, options, 1, 1, &q->file, &operands, &status) &&
      eo_app_load_design(q->file, &q->design, &q->geometry, &q->warnings, &status))
    status = run_request(q);
  free(q);
  eo_app_crew_end(&crew);
  return status;
}

const struct eo_command eo_command_optimize = {
    "optimize", "DESIGN.json [--algorithm NAME] [--budget N] [--threads N] [--data DIR] [--cache DIR] [--fresh] [--restart] [--json]",
    "searches the modification that runs quietest over the duty cycle",
    "Every evaluation is kept in the history (see easeoff history) and used again by later searches of the same pair, "
    "whatever their\n"
    "weights, bounds and algorithm. Ctrl-C prints the best so far. The same search once more takes up an interrupted "
    "one where it stopped\n"
    "and gives the result of a finished one again; --restart searches on.\n\n"
    "  --algorithm NAME  credibility-ga, fpga, ga or nsga2, in place of the design's\n"
    "  --budget N        most true evaluations, in place of the design's true_evaluations\n"
    "  --threads N       evaluations at a time (default: all cores); the result does not depend on it\n"
    "  --fresh           the algorithm is told nothing of earlier searches; what it asks for is still looked up\n"
    "  --restart         a new search of the same kind, which knows what the earlier ones found\n"
    "  --json            the result document, as the server returns it\n\n" EO_APP_CREW_HELP EO_APP_HISTORY_HELP EO_APP_DATA_HELP,
    run};
