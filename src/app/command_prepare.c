/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include "app/app.h"
#include "app/data.h"
#include "app/watch.h"
#include "base/sanitized.h"
#include "design/resolution.h"
#include "flexibility/preparation_cost.h"
#include "http/header_field.h"
#include "numerics/threads.h"
#include "service/preparation_line.h"

struct request {
  const char *data, *cache, *memory, *seconds;
  bool follow;
};

static void say(const struct eo_preparation_line *line)
{
  char text[sizeof line->error + 80];
  eo_preparation_line_write(line, text, sizeof text);
  for (size_t at = 0, size = strlen(text); at < size;) {
    ssize_t written = write(STDOUT_FILENO, text + at, size - at);
    if (written <= 0 && errno != EINTR)
      _exit(EO_EXIT_FAILED); /* nobody waits for the pair any more */
    at += written > 0 ? (size_t)written : 0;
  }
}

static int tell_progress(void *context, const char *what, double fraction)
{
  struct eo_preparation_line line = {.kind = EO_PREPARATION_PROGRESS, .fraction = fraction};
  (void)context;
  snprintf(line.what, sizeof line.what, "%s", what);
  say(&line);
  return 0;
}

/* Bytes beyond the address space that is taken already; none where sanitizers take nearly all of it. */
static void limit_memory(double bytes)
{
#ifdef EO_SANITIZED
  (void)bytes;
#else
  FILE *file = fopen("/proc/self/statm", "re");
  unsigned long long pages = 0;
  if (file && fscanf(file, "%llu", &pages) == 1) {
    rlim_t most = (rlim_t)pages * (rlim_t)sysconf(_SC_PAGESIZE) + (rlim_t)bytes;
    setrlimit(RLIMIT_AS, &(struct rlimit){most, most});
  }
  if (file)
    fclose(file);
#endif
}

/* When memory is short the system shall end this process rather than another. */
static void stand_first_in_line(void)
{
  int file = open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  if (file >= 0) {
    if (write(file, "800", 3) != 3)
      errno = 0; /* then it shall not */
    close(file);
  }
}

static enum eo_code read_limit(const char *name, const char *text, double *value, struct eo_error *error)
{
  if (!text || (eo_field_real(text, value) && *value > 0))
    return EO_OK;
  return eo_error_set(error, EO_ERROR_INPUT, "", "%s takes a number above 0, not %.40s.", name, text);
}

static enum eo_code set_limits(const struct request *request, struct eo_error *error)
{
  double memory = 0, seconds = 0;
  EO_TRY(read_limit("--memory-MB", request->memory, &memory, error));
  EO_TRY(read_limit("--seconds", request->seconds, &seconds, error));
  EO_TRY(eo_threads_reserve(2, error)); /* of both members; their room does not count */
  if (memory > 0)
    limit_memory(1e6 * memory);
  if (seconds > 0)
    setrlimit(RLIMIT_CPU, &(struct rlimit){(rlim_t)seconds + 1, (rlim_t)seconds + 5});
  setrlimit(RLIMIT_CORE, &(struct rlimit){0, 0});
  return EO_OK;
}

/* Its note may speak of a damaged file that was replaced. */
static bool is_kept(const char *cache, const struct eo_flexibility_report *report)
{
  struct eo_text path = {0};
  eo_text_print(&path, "%s/%s.flex", cache, report->key);
  bool kept = !path.failed && access(path.data, R_OK) == 0;
  eo_text_done(&path);
  return kept;
}

static enum eo_code prepare_half(const struct request *request, const struct eo_design *design,
                                 const struct eo_geometry *whole, int end, const struct eo_progress *progress,
                                 struct eo_error *error)
{
  const struct eo_geometry half = eo_geometry_of_half(whole, &design->gear_pair, end), *geometry = &half;
  const struct eo_gear_pair pair = eo_gear_pair_half(&design->gear_pair, end);
  struct eo_text cache = {0};
  struct eo_flexibility *flexibility = NULL;
  struct eo_flexibility_settings settings = eo_flexibility_settings_of(&design->resolution);
  if (request->cache)
    eo_text_add(&cache, request->cache);
  else if (!eo_app_cache_directory(request->data, &cache))
    return eo_error_set(error, EO_ERROR_INPUT, "", "There is no place for prepared pairs; --data names one.");
  enum eo_code code = eo_flexibility_prepare(geometry, &pair, &design->material, &settings, cache.data, progress,
                                             &flexibility, error);
  if (!code && !is_kept(cache.data, eo_flexibility_report(flexibility)))
    code = eo_error_set(error, EO_ERROR_FULL, "", "The prepared pair cannot be kept: %.200s",
                        eo_flexibility_report(flexibility)->note);
  if (!code && !request->follow) {
    const struct eo_flexibility_report *report = eo_flexibility_report(flexibility);
    struct rusage used;
    getrusage(RUSAGE_SELF, &used);
    printf("%s in %.1f s with %ld MB: %s/%s.flex\n", report->from_cache ? "read" : "prepared", report->seconds,
           used.ru_maxrss / 1024, cache.data, report->key);
  }
  eo_flexibility_free(flexibility);
  eo_text_done(&cache);
  return code;
}

/* Both halves of a pair whose halves differ, one after the other. */
static enum eo_code prepare(const struct request *request, const struct eo_design *design,
                            const struct eo_geometry *geometry, const struct eo_progress *progress,
                            struct eo_error *error)
{
  int halves = eo_gear_pair_is_uneven(&design->gear_pair) ? 2 : 1;
  for (int end = 0; end < halves; end++)
    EO_TRY(prepare_half(request, design, geometry, end, progress, error));
  return EO_OK;
}

/* For a server: it ends with whoever started it; where that was before this could be said, its first word finds nobody.
 */
static int prepare_followed(const struct request *request, const struct eo_design *design,
                            const struct eo_geometry *geometry)
{
  const struct eo_progress progress = {tell_progress, NULL};
  struct eo_preparation_line line = {.kind = EO_PREPARATION_DONE};
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  stand_first_in_line();
  enum eo_code code = set_limits(request, &line.error);
  if (!code)
    code = prepare(request, design, geometry, &progress, &line.error);
  line.error.code = code;
  line.kind = code ? EO_PREPARATION_FAILED : EO_PREPARATION_DONE;
  say(&line);
  return code ? EO_EXIT_FAILED : EO_EXIT_DONE;
}

static int prepare_alone(const struct request *request, const struct eo_design *design,
                         const struct eo_geometry *geometry)
{
  struct eo_watch watch;
  struct eo_error error;
  struct eo_preparation_cost cost;
  struct eo_flexibility_settings settings = eo_flexibility_settings_of(&design->resolution);
  enum eo_code code = eo_preparation_cost_find(geometry, &design->gear_pair, &settings, &cost, &error);
  if (!code) {
    fprintf(stderr, "easeoff: about %.0f MB and %.0f s of a processor\n", cost.memory / 1e6, cost.seconds);
    code = set_limits(request, &error);
  }
  if (code)
    return eo_app_fail(NULL, &error);
  eo_watch_start(&watch);
  code = prepare(request, design, geometry, &watch.progress, &error);
  eo_watch_end(&watch);
  return code ? eo_app_fail(NULL, &error) : EO_EXIT_DONE;
}

static int run(const struct eo_command *command, int argc, char **argv)
{
  struct request request = {0};
  struct eo_design design;
  struct eo_geometry geometry;
  const char *path;
  int operands, status;
  const struct eo_option options[] = {
      {.name = "--data", .value = &request.data},        {.name = "--cache", .value = &request.cache},
      {.name = "--memory-MB", .value = &request.memory}, {.name = "--seconds", .value = &request.seconds},
      {.name = "--follow", .flag = &request.follow},     {.name = NULL}};
  if (!eo_app_arguments(command, argc, argv, options, 1, 1, &path, &operands, &status) ||
      !eo_app_load_design(path, &design, &geometry, NULL, &status))
    return status;
  return request.follow ? prepare_followed(&request, &design, &geometry) : prepare_alone(&request, &design, &geometry);
}

const struct eo_command eo_command_prepare = {
    "prepare", "DESIGN.json [--data DIR | --cache DIR] [--memory-MB N] [--seconds N] [--follow]",
    "computes the finite elements of a gear pair and keeps them for later commands",
    "Says what the preparation will take, computes the flexibility of the pair and keeps it. --memory-MB and "
    "--seconds\n"
    "(processor time) end it when it takes more. --follow prints progress as lines, for the server to read.\n"
    "\n" EO_APP_DATA_HELP,
    run};
