/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/app.h"
#include "app/data.h"
#include "app/table_options.h"
#include "app/watch.h"
#include "format/json.h"
#include "document/rig_document.h"

struct request {
  const char *design_file, *output, *truth, *settings, *data;
  bool no_cache;
  struct eo_table_options options;
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_rig_request rig;
};

static void add_options(struct request *request)
{
  struct eo_table_options *options = &request->options;
  eo_table_options_add(options, &eo_rig_table);
  const struct eo_option own[] = {{.name = "--design", .value = &request->design_file},
                                  {.name = "-o", .value = &request->output},
                                  {.name = "--truth", .value = &request->truth},
                                  {.name = "--settings", .value = &request->settings},
                                  {.name = "--torque", .value = eo_table_options_text(options, "torque_Nm")},
                                  {.name = "--speed", .value = eo_table_options_text(options, "speed_rpm")},
                                  {.name = "--data", .value = &request->data},
                                  {.name = "--no-cache", .flag = &request->no_cache}};
  for (size_t i = 0; i < sizeof own / sizeof own[0]; i++)
    eo_table_options_add_own(options, own[i]);
}

/* *document: owned, what --settings and the options say. */
static enum eo_code load_settings(const struct request *request, json_t **document, struct eo_error *error)
{
  *document = request->settings ? eo_json_load(request->settings, EO_JSON_DESIGN_BYTES, error) : json_object();
  if (!*document)
    return request->settings ? error->code : eo_error_memory(error);
  return eo_table_options_put(&request->options, *document, error);
}

static bool read_settings(struct request *request, int *status)
{
  struct eo_error error;
  struct eo_faults *faults = calloc(1, sizeof *faults);
  json_t *document = NULL;
  enum eo_code code = faults ? load_settings(request, &document, &error) : eo_error_memory(&error);
  if (!code)
    eo_table_decode(&eo_rig_table, document, NULL, &request->rig, faults);
  *status = code            ? eo_app_fail(request->settings, &error)
            : faults->count ? eo_app_fail_all(request->settings, faults)
                            : EO_EXIT_DONE;
  json_decref(document);
  free(faults);
  return *status == EO_EXIT_DONE;
}

static enum eo_code respond(struct request *request, const struct eo_progress *progress, struct eo_error *error)
{
  struct eo_text directory = {0};
  bool keep = !request->no_cache && eo_app_cache_directory(request->data, &directory);
  const struct eo_pair_options options = {.cache_directory = keep ? directory.data : NULL};
  struct eo_pair *pair = NULL;
  struct eo_rig_prediction prediction;
  enum eo_code code = eo_pair_new(&pair, &request->design, &options, progress, error);
  eo_text_done(&directory);
  EO_TRY(code);
  code = eo_rig_predict(&request->rig, pair, &request->design, &prediction, error);
  eo_pair_free(pair);
  EO_TRY(code);
  eo_rig_set_pair(&request->rig, &request->geometry, &request->design.supports, &prediction);
  return eo_synthetic_check(&request->rig.synthetic, error);
}

/* Beside the file and then in its place, so that nobody finds half of it. */
static enum eo_code write_file(const struct request *request, const struct eo_progress *progress,
                               struct eo_error *error)
{
  if (strcmp(request->output, "-") == 0)
    return eo_rig_write(&request->rig, progress, stdout, error);
  struct eo_text part = {0};
  eo_text_print(&part, "%s.%ld.part", request->output, (long)getpid());
  FILE *stream = part.failed ? NULL : fopen(part.data, "wx"); /* never over, and then away with, a file of somebody's */
  enum eo_code code = stream ? eo_rig_write(&request->rig, progress, stream, error)
                             : eo_error_set(error, EO_ERROR_FILE, "", "%.200s cannot be written: %s.", request->output,
                                            strerror(errno));
  if (stream && fclose(stream) && !code)
    code = eo_error_set(error, EO_ERROR_FILE, "", "%.200s cannot be written: %s.", request->output, strerror(errno));
  if (!code && rename(part.data, request->output))
    code = eo_error_set(error, EO_ERROR_FILE, "", "%.200s cannot be written: %s.", request->output, strerror(errno));
  if (code && stream)
    remove(part.data);
  eo_text_done(&part);
  return code;
}

static enum eo_code write_truth(const struct request *request, struct eo_error *error)
{
  const char *slash = strrchr(request->output, '/');
  struct eo_text text = {0};
  json_t *document = eo_rig_truth(&request->rig, slash ? slash + 1 : request->output);
  enum eo_code code = document ? EO_OK : eo_error_memory(error);
  if (!code) {
    eo_json_write(&text, document, EO_JSON_PRETTY);
    code = eo_text_save(&text, request->truth, error);
  }
  json_decref(document);
  eo_text_done(&text);
  return code;
}

static enum eo_code make(struct request *request, const struct eo_progress *progress, struct eo_error *error)
{
  EO_TRY(respond(request, progress, error));
  EO_TRY(write_file(request, progress, error));
  return request->truth ? write_truth(request, error) : EO_OK;
}

static int run_request(struct request *request)
{
  struct eo_watch watch;
  struct eo_error error;
  if (eo_rig_complete(&request->rig, &request->design, &error))
    return eo_app_fail(request->settings, &error);
  eo_watch_start(&watch);
  enum eo_code code = make(request, &watch.progress, &error);
  eo_watch_clear(&watch);
  if (watch.stopped)
    code = eo_error_set(&error, EO_ERROR_CANCELLED, "", "Stopped.");
  eo_watch_end(&watch);
  return code ? eo_app_fail(code == EO_ERROR_INPUT ? request->design_file : NULL, &error) : EO_EXIT_DONE;
}

static int run_named(struct request *request)
{
  struct eo_error error;
  int status;
  if (!request->design_file || !request->output) {
    eo_error_set(&error, EO_ERROR_INPUT, "", "A rig needs --design FILE and -o FILE.");
    return eo_app_fail(NULL, &error);
  }
  if (read_settings(request, &status) &&
      eo_app_load_design(request->design_file, &request->design, &request->geometry, NULL, &status))
    status = run_request(request);
  return status;
}

static int run(const struct eo_command *command, int argc, char **argv)
{
  const char *operand;
  int operands, status;
  struct request *request = eo_app_request(sizeof *request, &status);
  if (!request)
    return status;
  add_options(request);
  if (eo_table_options_read(&request->options, command, argc, argv, 0, 0, &operand, &operands, &status))
    status = run_named(request);
  free(request);
  return status;
}

const struct eo_command eo_command_rig = {
    "rig", "--design FILE --torque T --speed S -o FILE [--truth FILE] [--KEY VALUE]...",
    "a synthetic recording with known truth",
    "Simulates the design at a torque (N m, on the pinion) and a speed (rpm, of the pinion), and writes what two "
    "encoders would\n"
    "record. --truth writes a case file for easeoff verify as well. The same settings give the same "
    "bytes.\n\n" EO_APP_DATA_HELP "--no-cache neither reads nor keeps it.\n\n"
    "Keys of --settings FILE (JSON). Each is an option too, with dashes in place of underscores: \"sample_rate_Hz\" "
    "is\n"
    "--sample-rate-Hz 50000, and what is true or false takes yes or no: --wrapped yes.\n",
    run};
