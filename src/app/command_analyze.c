/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>

#include "app/app.h"
#include "app/data.h"
#include "app/watch.h"
#include "base/parallel.h"
#include "format/inch.h"
#include "format/json.h"
#include "document/pitch_document.h"
#include "document/result.h"
#include "evaluation/analysis.h"

struct request {
  const char *file, *csv, *data, *pitch, *units;
  bool json, no_cache, inches;
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_warnings warnings;
};

static enum eo_code cancelled(struct eo_error *error)
{
  return eo_error_set(error, EO_ERROR_CANCELLED, "", "Stopped.");
}

static enum eo_code prepare(struct request *request, const struct eo_progress *progress, struct eo_pair **pair,
                            struct eo_error *error)
{
  struct eo_text directory = {0};
  bool keep = !request->no_cache && eo_app_cache_directory(request->data, &directory);
  struct eo_pair_options options = {.cache_directory = keep ? directory.data : NULL};
  if (!keep && !request->no_cache)
    eo_warnings_add(&request->warnings,
                    "There is no place to keep the flexibility of this gear pair; --data names one.");
  enum eo_code code = eo_pair_new(pair, &request->design, &options, progress, error);
  eo_text_done(&directory);
  return code;
}

static enum eo_code analyze(const struct request *request, const struct eo_pair *pair,
                            const struct eo_progress *progress, json_t **result, struct eo_error *error)
{
  struct eo_analysis *analysis = NULL;
  enum eo_code code = eo_analysis_new(&analysis, pair, error);
  if (!code) {
    analysis->threads = eo_parallel_cores() > 1 ? 2 : 1;
    analysis->progress = progress;
    code = eo_analysis_run(analysis, &request->design,
                           EO_WANT_ROOT | EO_WANT_BAND | EO_WANT_CURVES | EO_WANT_RATING | EO_WANT_PITCH, error);
  }
  if (!code && !(*result = eo_result_encode(analysis, &request->design, &request->warnings)))
    code = eo_error_memory(error);
  eo_analysis_free(analysis);
  return code;
}

static enum eo_code save_files(const json_t *result, const struct request *request, struct eo_error *error)
{
  struct eo_file_set bundle = {0};
  const char *directory = request->csv;
  eo_result_files(result, &bundle);
  for (int i = 0; i < bundle.count && request->inches; i++)
    eo_inch_table(&bundle.file[i].text);
  enum eo_code code = eo_file_set_save(&bundle, directory, error);
  eo_file_set_done(&bundle);
  return code;
}

static int show(const struct request *request, json_t *result)
{
  struct eo_text text = {0};
  if (request->json)
    return eo_app_print_json(request->inches ? eo_inch_from_mm(result) : json_incref(result), false);
  if (request->csv)
    return EO_EXIT_DONE;
  eo_result_summary(result, request->inches, &text);
  return eo_app_print(&text);
}

/* The result, and its files where some are asked for. */
static enum eo_code make(struct request *request, struct eo_watch *watch, struct eo_pair **pair, json_t **result,
                         struct eo_error *error)
{
  enum eo_code code = prepare(request, &watch->progress, pair, error);
  if (!code)
    code = analyze(request, *pair, &watch->progress, result, error);
  eo_watch_clear(watch);
  if (watch->stopped)
    return cancelled(error);
  EO_TRY(code);
  return request->csv ? save_files(*result, request, error) : EO_OK;
}

static int run_request(struct request *request)
{
  struct eo_watch watch;
  struct eo_error error;
  struct eo_pair *pair = NULL;
  json_t *result = NULL;
  eo_watch_start(&watch);
  enum eo_code code = make(request, &watch, &pair, &result, &error);
  int status = code ? eo_app_fail(code == EO_ERROR_INPUT ? request->file : NULL, &error) : show(request, result);
  eo_watch_end(&watch);
  json_decref(result);
  eo_pair_free(pair);
  return status;
}

static enum eo_code take_teeth(struct request *request, struct eo_text *text, json_t *table, struct eo_faults *faults,
                               struct eo_error *error)
{
  enum { MOST_TABLE = 1 << 20 };
  if (!faults || !table)
    return eo_error_memory(error);
  EO_TRY(eo_text_read(text, request->pitch, MOST_TABLE, error));
  if (json_object_set_new(table, "csv", json_string(text->data)) != 0)
    return eo_error_set(error, EO_ERROR_INPUT, NULL, "The table is not text in UTF-8.");
  int positions = request->design.pitch.positions, gear_tooth = request->design.pitch.gear_tooth;
  eo_pitch_decode(table, &request->design.gear_pair, &request->design.pitch, faults);
  EO_TRY(eo_faults_first(faults, error));
  request->design.pitch.positions = positions;
  request->design.pitch.gear_tooth = gear_tooth;
  return eo_design_complete(&request->design, &request->geometry, error);
}

/* The deviations of a measured pair's teeth in place of those of the design, which says how the pair is put together
   and looked at. */
static bool read_teeth(struct request *request, int *status)
{
  struct eo_text text = {0};
  struct eo_error error;
  struct eo_faults *faults = calloc(1, sizeof *faults);
  json_t *table = json_object();
  enum eo_code code = take_teeth(request, &text, table, faults, &error);
  *status = code ? eo_app_fail(request->pitch, &error) : EO_EXIT_DONE;
  eo_text_done(&text);
  json_decref(table);
  free(faults);
  return !code;
}

static int run(const struct eo_command *command, int argc, char **argv)
{
  int operands, status;
  struct request *request = eo_app_request(sizeof *request, &status);
  if (!request)
    return status;
  const struct eo_option options[] = {{.name = "--json", .flag = &request->json},
                                      {.name = "--csv", .value = &request->csv},
                                      {.name = "--units", .value = &request->units},
                                      {.name = "--data", .value = &request->data},
                                      {.name = "--pitch", .value = &request->pitch},
                                      {.name = "--no-cache", .flag = &request->no_cache},
                                      {.name = NULL}};
  if (eo_app_arguments(command, argc, argv, options, 1, 1, &request->file, &operands, &status) &&
      eo_app_units(request->units, &request->inches, &status) &&
      eo_app_load_design(request->file, &request->design, &request->geometry, &request->warnings, &status) &&
      (!request->pitch || read_teeth(request, &status)))
    status = run_request(request);
  free(request);
  return status;
}

const struct eo_command eo_command_analyze = {
    "analyze", "DESIGN.json [--json] [--csv DIR] [--units mm|inch] [--pitch FILE] [--data DIR] [--no-cache]",
    "one true evaluation of a design, with everything it computed",
    "Without --json or --csv it prints a summary: every load case for the unmodified pair and for the design, the\n"
    "objectives, notes, and where the time went. --json prints the result document. --csv writes the curves as files\n"
    "into DIR, which is made when it is missing. --pitch takes the deviations of single teeth from FILE, a table of a\n"
    "measuring machine with the headings member, end, flank, tooth and index_um or single_um, in place of the "
    "design's; its gear_tooth and positions stay.\n"
    "--units inch shows lengths in inches and thousandths of an inch: in documents the keys, in CSV the headings end "
    "in\n"
    "_in and _thou.\n"
    "\n" EO_APP_DATA_HELP "--no-cache neither reads nor keeps it.\n",
    run};
