/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/app.h"
#include "app/data.h"
#include "app/watch.h"
#include "base/parallel.h"
#include "document/sweep_document.h"
#include "variants/sweep_steps.h"

struct request {
  const char *file, *torque, *speed, *vary, *csv, *data, *threads;
  bool json, no_cache;
  int thread_count;
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_warnings warnings;
  struct eo_sweep_axes axes;
};

static bool read_number(const char **text, double *value)
{
  char *end;
  *value = strtod(*text, &end);
  bool good = end != *text && isfinite(*value);
  *text = end;
  return good;
}

/* "A:B:N", "A:B" or "A" as {"from", "to", "points"}; NULL when it is none of them. */
static json_t *read_range(const char *text)
{
  static const char *const key[] = {"from", "to", "points"};
  json_t *range = json_object();
  for (int i = 0; i < 3; i++) {
    double value;
    if (!read_number(&text, &value) || json_object_set_new(range, key[i], json_real(value)) ||
        (*text && *text != ':') || (*text && i == 2)) {
      json_decref(range);
      return NULL;
    }
    if (!*text++)
      return range;
  }
  return range;
}

static enum eo_code add_range(json_t *document, const char *option, const char *key, const char *text,
                              struct eo_error *error)
{
  if (!text)
    return EO_OK;
  json_t *range = read_range(text);
  if (!range)
    return eo_error_set(error, EO_ERROR_INPUT, "", "%s %.40s is not FIRST:LAST:POINTS.", option, text);
  return json_object_set_new(document, key, range) ? eo_error_memory(error) : EO_OK;
}

/* KEY=A:B:N, as `study` takes it. */
static enum eo_code add_vary(json_t *document, const char *text, struct eo_error *error)
{
  size_t length = text ? strcspn(text, "=") : 0;
  if (!text)
    return EO_OK;
  json_t *vary = text[length] && length ? read_range(text + length + 1) : NULL;
  if (!vary)
    return eo_error_set(error, EO_ERROR_INPUT, "", "--vary %.100s is not KEY=FIRST:LAST:POINTS.", text);
  json_object_set_new(vary, "key", json_stringn(text, length));
  return json_object_set_new(document, "vary", vary) ? eo_error_memory(error) : EO_OK;
}

/* The options are checked as the document a script would post. */
static bool decode_axes(const json_t *document, struct eo_sweep_axes *axes, int *status)
{
  struct eo_sweep_request asked;
  struct eo_error error;
  struct eo_faults *faults = calloc(1, sizeof *faults);
  *status = EO_EXIT_DONE;
  if (!faults) {
    *status = eo_app_fail_memory();
    return false;
  }
  eo_table_decode(&eo_sweep_request_table, document, NULL, &asked, faults);
  if (faults->count)
    *status = eo_app_fail_all(NULL, faults);
  else if (eo_sweep_axes_init(axes, &asked, &error))
    *status = eo_app_fail(NULL, &error);
  free(faults);
  return *status == EO_EXIT_DONE;
}

static bool read_axes(struct request *request, int *status)
{
  struct eo_error error;
  json_t *document = json_object();
  enum eo_code code = add_range(document, "--torque", "torque_Nm", request->torque, &error);
  if (!code)
    code = add_range(document, "--speed", "speed_rpm", request->speed, &error);
  if (!code)
    code = add_vary(document, request->vary, &error);
  if (code)
    *status = eo_app_fail(NULL, &error);
  else
    decode_axes(document, &request->axes, status);
  json_decref(document);
  return *status == EO_EXIT_DONE;
}

static bool read_threads(struct request *request, int *status)
{
  struct eo_error error;
  char *end = NULL;
  long count = request->threads ? strtol(request->threads, &end, 10) : 0;
  *status = EO_EXIT_DONE;
  if (request->threads && (*end || end == request->threads || count < 1 || count > EO_MAX_THREADS)) {
    eo_error_set(&error, EO_ERROR_INPUT, "", "--threads %.20s is outside 1 .. %d.", request->threads, EO_MAX_THREADS);
    *status = eo_app_fail(NULL, &error);
  }
  request->thread_count = (int)count;
  return *status == EO_EXIT_DONE;
}

static enum eo_code prepare(struct request *request, const struct eo_progress *progress, struct eo_pair **pair,
                            struct eo_error *error)
{
  struct eo_text directory = {0};
  bool keep = !request->no_cache && eo_app_cache_directory(request->data, &directory);
  struct eo_pair_options options = {.cache_directory = keep ? directory.data : NULL};
  enum eo_code code = eo_pair_new(pair, &request->design, &options, progress, error);
  eo_text_done(&directory);
  return code;
}

static enum eo_code save_csv(const struct eo_sweep *sweep, const char *path, struct eo_error *error)
{
  struct eo_text text = {0};
  eo_sweep_csv(sweep, &text);
  enum eo_code code = eo_text_save(&text, path, error);
  eo_text_done(&text);
  return code;
}

static int show(const struct request *request, const struct eo_sweep *sweep)
{
  struct eo_text text = {0};
  if (request->json)
    return eo_app_print_json(eo_sweep_encode(sweep, &request->design, &request->warnings), false);
  if (request->csv)
    return EO_EXIT_DONE;
  eo_sweep_summary(sweep, &request->design, &request->warnings, &text);
  return eo_app_print(&text);
}

static int run_request(struct request *request)
{
  struct eo_watch watch;
  struct eo_error error;
  struct eo_pair *pair = NULL;
  struct eo_sweep sweep = {0};
  const struct eo_sweep_axes *axes = &request->axes;
  const struct eo_sweep_plan plan = {.torques = axes->torques,
                                     .speeds = axes->speeds,
                                     .torque = axes->torque,
                                     .speed = axes->speed,
                                     .threads = request->thread_count,
                                     .steps = axes->steps,
                                     .key = axes->key,
                                     .value = axes->value,
                                     .step = axes->step};
  eo_watch_start(&watch);
  enum eo_code code = prepare(request, &watch.progress, &pair, &error);
  if (!code)
    code = eo_sweep_run(&sweep, pair, &request->design, &plan, &watch.progress, &error);
  eo_watch_clear(&watch);
  if (watch.stopped)
    code = eo_error_set(&error, EO_ERROR_CANCELLED, "", "Stopped.");
  if (!code && request->csv)
    code = save_csv(&sweep, request->csv, &error);
  int status = code ? eo_app_fail(code == EO_ERROR_INPUT ? request->file : NULL, &error) : show(request, &sweep);
  eo_watch_end(&watch);
  eo_sweep_done(&sweep);
  eo_pair_free(pair);
  return status;
}

/* The design, and that of each step. */
static bool load(struct request *request, int *status)
{
  json_t *stated;
  struct eo_error error;
  bool good = eo_app_load_stated(request->file, &stated, &request->design, &request->geometry, &request->warnings,
                                 status);
  if (good && (eo_sweep_steps_take(&request->axes, stated, &error) ||
               eo_sweep_steps_init(&request->axes, &request->design, &error))) {
    *status = eo_app_fail(NULL, &error);
    good = false;
  }
  json_decref(stated);
  return good;
}

static int run(const struct eo_command *command, int argc, char **argv)
{
  int operands, status;
  struct request *request = eo_app_request(sizeof *request, &status);
  if (!request)
    return status;
  const struct eo_option options[] = {{.name = "--torque", .value = &request->torque},
                                      {.name = "--speed", .value = &request->speed},
                                      {.name = "--vary", .value = &request->vary},
                                      {.name = "--json", .flag = &request->json},
                                      {.name = "--csv", .value = &request->csv},
                                      {.name = "--data", .value = &request->data},
                                      {.name = "--no-cache", .flag = &request->no_cache},
                                      {.name = "--threads", .value = &request->threads},
                                      {.name = NULL}};
  if (eo_app_arguments(command, argc, argv, options, 1, 1, &request->file, &operands, &status) &&
      read_threads(request, &status) && read_axes(request, &status) && load(request, &status))
    status = run_request(request);
  eo_sweep_axes_done(&request->axes);
  free(request);
  return status;
}

const struct eo_command eo_command_sweep = {
    "sweep",
    "DESIGN.json [--torque A:B:N | --vary KEY=A:B:N] [--speed A:B:N] [--json] [--csv FILE] [--threads N] [--data DIR] "
    "[--no-cache]",
    "a design over torque or another of its numbers, over speed or both, compared with the unmodified pair",
    "N torques from A to B (N m, on the pinion), N speeds from A to B (rpm, of the pinion), or both: a map. An axis "
    "that is\n"
    "not given has the value of the load case with the largest share. A alone is one value.\n"
    "\n"
    "--vary takes another number of the design in place of the torque, by the name that a study has for it\n"
    "(modification.pinion.*.tip_relief_um, modification.pinion.left.grid_um.3.4); the gear pair has to stay as it is.\n"
    "\n"
    "Loaded contact is solved once per torque; every speed is solved upwards and downwards, and both are shown where "
    "they\n"
    "differ (contact loss). --json prints everything as columns, --csv writes a line per point. All cores work unless\n"
    "--threads says otherwise; the numbers do not depend on it.\n"
    "\n" EO_APP_DATA_HELP "--no-cache neither reads nor keeps it.\n",
    run};
