/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/app.h"
#include "app/data.h"
#include "app/watch.h"
#include "format/json.h"
#include "document/rig_document.h"

struct request {
  const char *design_file, *output, *truth, *settings, *torque, *speed, *data;
  bool no_cache;
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_rig_request rig;
};

enum { OWN_OPTIONS = 8, MOST_OPTIONS = 64, NAME_SIZE = 40 };

/* Every key of the table is an option, "--sample-rate-Hz 50000". */
struct options {
  struct eo_option option[MOST_OPTIONS];
  char name[MOST_OPTIONS][NAME_SIZE];
  const char *value[MOST_OPTIONS];
};

static void make_options(struct request *request, struct options *options)
{
  const struct eo_option own[OWN_OPTIONS] = {
      {.name = "--design", .value = &request->design_file}, {.name = "-o", .value = &request->output},
      {.name = "--truth", .value = &request->truth},        {.name = "--settings", .value = &request->settings},
      {.name = "--torque", .value = &request->torque},      {.name = "--speed", .value = &request->speed},
      {.name = "--data", .value = &request->data},          {.name = "--no-cache", .flag = &request->no_cache}};
  memcpy(options->option, own, sizeof own);
  for (int i = 0; i < eo_rig_table.count; i++) {
    snprintf(options->name[i], NAME_SIZE, "--%s", eo_rig_table.field[i].key);
    for (char *c = options->name[i]; *c; c++)
      *c = *c == '_' ? '-' : *c;
    options->option[OWN_OPTIONS + i] = (struct eo_option){.name = options->name[i], .value = &options->value[i]};
  }
  options->option[OWN_OPTIONS + eo_rig_table.count] = (struct eo_option){.name = NULL};
}

/* An option as the JSON value its key would have; what is no number stays text, for the table to refuse. */
static json_t *value_of(const struct eo_field *field, const char *text)
{
  char *end;
  if (field->kind == EO_FIELD_FLAG && (strcmp(text, "yes") == 0 || strcmp(text, "no") == 0))
    return json_boolean(text[0] == 'y');
  if (field->kind == EO_FIELD_CHOICE)
    return json_string(text);
  double number = strtod(text, &end);
  bool whole = field->kind == EO_FIELD_INTEGER || field->kind == EO_FIELD_SEED;
  if (*end || end == text || !isfinite(number))
    return json_string(text);
  return whole ? eo_json_whole(number) : json_real(number);
}

static json_t *settings_document(struct request *request, const struct options *options, struct eo_error *error)
{
  json_t *document = request->settings ? eo_json_load(request->settings, EO_JSON_DESIGN_BYTES, error) : json_object();
  bool failed = false;
  for (int i = 0; i < eo_rig_table.count && document; i++) {
    const struct eo_field *field = &eo_rig_table.field[i];
    const char *text = options->value[i];
    if (!text && strcmp(field->key, "torque_Nm") == 0)
      text = request->torque;
    if (!text && strcmp(field->key, "speed_rpm") == 0)
      text = request->speed;
    if (text)
      eo_json_put(document, field->key, value_of(field, text), &failed);
  }
  if (failed)
    eo_error_memory(error);
  return failed ? (json_decref(document), NULL) : document;
}

static bool read_settings(struct request *request, const struct options *options, int *status)
{
  struct eo_error error = {0};
  struct eo_faults *faults = calloc(1, sizeof *faults);
  json_t *document = faults ? settings_document(request, options, &error) : NULL;
  *status = EO_EXIT_DONE;
  if (!document)
    *status = eo_app_fail(request->settings, error.code ? &error : (eo_error_memory(&error), &error));
  else
    eo_table_decode(&eo_rig_table, document, NULL, &request->rig, faults);
  if (document && faults->count)
    *status = eo_app_fail_all(request->settings, faults);
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

static int run(const struct eo_command *command, int argc, char **argv)
{
  struct request *request = calloc(1, sizeof *request);
  struct options *options = calloc(1, sizeof *options);
  struct eo_error error;
  const char *operand;
  int operands, status;
  if (!request || !options) {
    status = eo_app_fail_memory();
    goto out;
  }
  make_options(request, options);
  if (!eo_app_arguments(command, argc, argv, options->option, 0, 0, &operand, &operands, &status))
    goto out;
  if (!request->design_file || !request->output) {
    eo_error_set(&error, EO_ERROR_INPUT, "", "A rig needs --design FILE and -o FILE.");
    status = eo_app_fail(NULL, &error);
  } else if (read_settings(request, options, &status) &&
             eo_app_load_design(request->design_file, &request->design, &request->geometry, NULL, &status)) {
    status = run_request(request);
  }
out:
  free(options);
  free(request);
  return status;
}

const struct eo_command eo_command_rig = {
    "rig", "--design FILE --torque T --speed S -o FILE [--truth FILE] [--KEY VALUE]...",
    "a synthetic recording with known truth",
    "Simulates the design at a torque (N m, on the pinion) and speed (rpm) and writes what two encoders would record. "
    "--truth writes a case file\n"
    "for easeoff verify beside it. Every key of the settings is an option, for instance --sample-rate-Hz 50000 "
    "--output sine-cosine\n"
    "--pinion-lines 200 --fault slip --fault-row 5000 --separator semicolon --decimal-comma yes; --settings FILE.json "
    "holds them as JSON:\n"
    "turns, sample_rate_Hz, noise_urad, jitter_us, skew_us, speed_drift, speed_swing, pinion_eccentricity_um, "
    "gear_eccentricity_um, pinion_lines,\n"
    "gear_lines, interpolation, output (angles, counts, sine-cosine, pulses), wrapped, radians, track_amplitude_V, "
    "track_offset, track_gain,\n"
    "track_phase_deg, track_noise_mV, track_step_mV, fault, fault_row, fault_size, seed, separator, heading, "
    "decimal_comma, byte_order_mark,\n"
    "carriage_return, end, unmodified, harmonics. The same settings give the same bytes.\n\n" EO_APP_DATA_HELP
    "--no-cache neither reads nor keeps it.\n",
    run};
