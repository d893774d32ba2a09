/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/app.h"
#include "app/data.h"
#include "app/watch.h"
#include "base/hash.h"
#include "format/json.h"
#include "document/measure_file.h"
#include "document/update_document.h"

/* One recording with what is known of it. */
struct entry {
  const char *path, *gear_path; /* borrowed from the command line or the list */
  char *joined;                 /* owned: path as the list means it */
  bool unmodified;
  double torque, speed; /* N m, rad/s; NaN: not stated */
  struct eo_part_choice part;
  int end;
  json_t *layout; /* owned */
};

struct request {
  const char *design_file, *label, *torque, *speed, *end, *harmonics, *layout, *gear, *list, *csv, *update, *apply,
      *data, *part, *from, *to;
  bool json, no_cache, alone;
  struct eo_design design, updated;
  struct eo_geometry geometry;
  struct eo_warnings warnings;
  int entries, harmonic_count, results;    /* results: recordings that were not refused */
  struct entry *entry;                     /* owned */
  json_t *list_document, *update_document; /* owned */
  json_t *documents;                       /* owned array */
  struct eo_text text;
  int measured_count;
  struct eo_measured *measured; /* owned, [entries]: those with a result and a torque */
  struct eo_comparison comparison;
  struct eo_update_settings update_settings;
  struct eo_update fit;
};

static enum eo_code read_positive(const char *option, const char *text, double *value, struct eo_error *error)
{
  char *end = NULL;
  *value = text ? strtod(text, &end) : NAN;
  if (text && (end == text || *end || !(*value > 0) || !isfinite(*value)))
    return eo_error_set(error, EO_ERROR_INPUT, "", "%s %.40s is no positive number.", option, text);
  return EO_OK;
}

static enum eo_code read_word(const char *what, const char *text, const char *const words[2], int fallback, int *value,
                              struct eo_error *error)
{
  *value = fallback;
  for (int i = 0; text && i < 2; i++)
    if (strcmp(text, words[i]) == 0) {
      *value = i;
      return EO_OK;
    }
  return text ? eo_error_set(error, EO_ERROR_INPUT, "", "%s is \"%s\" or \"%s\", not \"%.40s\".", what, words[0],
                             words[1], text)
              : EO_OK;
}

/* JSON given in place, or in a file. */
static json_t *load_json(const char *text, struct eo_error *error)
{
  return *text == '{' ? eo_json_parse(text, strlen(text), error) : eo_json_load(text, EO_JSON_DESIGN_BYTES, error);
}

static const char *const label_words[2] = {"modified", "unmodified"}, *const end_words[2] = {"left", "right"};

/* --part N or "whole", --from and --to in s after the first row. */
static enum eo_code read_part(const char *part, const char *from, const char *to, struct eo_part_choice *choice,
                              struct eo_error *error)
{
  char *end = NULL;
  long number = part && strcmp(part, "whole") != 0 ? strtol(part, &end, 10) : 1;
  *choice = (struct eo_part_choice){.whole = part && strcmp(part, "whole") == 0};
  if (end && (end == part || *end || number < 1 || number > EO_PARTS))
    return eo_error_set(error, EO_ERROR_INPUT, "", "--part %.40s is neither \"whole\" nor a number from 1 to %d.", part,
                        EO_PARTS);
  choice->part = end ? (int)number : 0;
  if (from && strcmp(from, "0") != 0)
    EO_TRY(read_positive("--from", from, &choice->from, error));
  if (!to)
    return EO_OK;
  EO_TRY(read_positive("--to", to, &choice->to, error));
  return choice->to > choice->from
             ? EO_OK
             : eo_error_set(error, EO_ERROR_INPUT, "", "--to %.40s s is not after --from %.40s s.", to, from);
}

/* The options hold for every file; an entry of the list may say otherwise. */
static enum eo_code set_usual(const struct request *request, struct entry *entry, struct eo_error *error)
{
  int unmodified;
  EO_TRY(read_positive("--torque", request->torque, &entry->torque, error));
  EO_TRY(read_positive("--speed", request->speed, &entry->speed, error));
  EO_TRY(read_word("--label", request->label, label_words, 0, &unmodified, error));
  EO_TRY(read_word("--end", request->end, end_words, EO_RIGHT, &entry->end, error));
  EO_TRY(read_part(request->part, request->from, request->to, &entry->part, error));
  if (request->layout && !(entry->layout = load_json(request->layout, error)))
    return error->code;
  entry->unmodified = unmodified == 1;
  entry->speed *= M_PI / 30;
  return EO_OK;
}

static double stated(const json_t *item, const char *key, double fallback, double scale)
{
  const json_t *value = json_object_get(item, key);
  return json_is_number(value) ? scale * json_number_value(value) : fallback;
}

/* A row of the list: file relative to it, label, torque_Nm, speed_rpm, end, part, from_s, to_s, layout. */
static enum eo_code read_item(const struct request *request, const json_t *item, struct entry *entry,
                              struct eo_error *error)
{
  const char *file = json_string_value(json_object_get(item, "file")), *slash = strrchr(request->list, '/');
  int unmodified;
  if (!file)
    return eo_error_set(error, EO_ERROR_INPUT, "/measurements", "Each entry of the list names its file.");
  struct eo_text path = {0};
  eo_text_print(&path, "%.*s%s", *file == '/' || !slash ? 0 : (int)(slash - request->list + 1), request->list, file);
  if (path.failed)
    return eo_error_memory(error);
  entry->path = entry->joined = path.data;
  entry->torque = stated(item, "torque_Nm", entry->torque, 1);
  entry->speed = stated(item, "speed_rpm", entry->speed, M_PI / 30);
  enum eo_code code = read_word("A label", json_string_value(json_object_get(item, "label")), label_words,
                                entry->unmodified, &unmodified, error);
  if (!code)
    code = read_word("An end", json_string_value(json_object_get(item, "end")), end_words, entry->end, &entry->end,
                     error);
  entry->unmodified = unmodified == 1;
  entry->part.part = (int)stated(item, "part", entry->part.part, 1);
  entry->part.from = stated(item, "from_s", entry->part.from, 1);
  entry->part.to = stated(item, "to_s", entry->part.to, 1);
  const struct eo_part_choice *part = &entry->part;
  double number = stated(item, "part", part->part, 1);
  if (!code && (number != floor(number) || part->part < 0 || part->part > EO_PARTS || part->from < 0 ||
                (part->to != 0 && part->to <= part->from)))
    return eo_error_set(error, EO_ERROR_INPUT, "/measurements",
                        "An entry of the list has \"part\" from 1 to %d and \"to_s\" after \"from_s\", in s.",
                        EO_PARTS);
  if (json_object_get(item, "layout")) {
    json_decref(entry->layout);
    entry->layout = json_incref(json_object_get(item, "layout"));
  }
  return code;
}

static enum eo_code read_entries(struct request *request, int files, const char *const *file, struct eo_error *error)
{
  const json_t *list = NULL;
  if (request->list && !(request->list_document = load_json(request->list, error)))
    return error->code;
  if (request->list && !json_is_array(list = json_object_get(request->list_document, "measurements")))
    return eo_error_set(error, EO_ERROR_INPUT, "/measurements", "The list holds an array \"measurements\".");
  int listed = (int)json_array_size(list);
  if (files + listed < 1 || files + listed > EO_MOST_MEASURED)
    return eo_error_set(error, EO_ERROR_INPUT, "", "Between 1 and %d recordings are measured at once.",
                        EO_MOST_MEASURED);
  if (request->gear && files + listed != 1)
    return eo_error_set(error, EO_ERROR_INPUT, "", "--gear goes with one recording.");
  request->entry = calloc((size_t)files + listed, sizeof *request->entry);
  request->measured = calloc((size_t)files + listed, sizeof *request->measured);
  if (!request->entry || !request->measured)
    return eo_error_memory(error);
  request->entries = files + listed;
  enum eo_code code = EO_OK;
  for (int i = 0; i < request->entries && !code; i++) {
    code = set_usual(request, &request->entry[i], error);
    request->entry[i].gear_path = request->gear;
    if (!code && i < files)
      request->entry[i].path = file[i];
    else if (!code)
      code = read_item(request, json_array_get(list, (size_t)(i - files)), &request->entry[i], error);
  }
  return code;
}

static enum eo_code read_update(struct request *request, struct eo_error *error)
{
  double harmonics;
  enum eo_code code = read_positive("--harmonics", request->harmonics, &harmonics, error);
  if (code)
    return code;
  if (request->harmonics && (harmonics > EO_MESH_ORDERS || harmonics != floor(harmonics)))
    return eo_error_set(error, EO_ERROR_INPUT, "", "--harmonics is a whole number up to %d.", EO_MESH_ORDERS);
  request->harmonic_count = request->harmonics ? (int)harmonics : 0;
  if (!request->update)
    return request->apply ? eo_error_set(error, EO_ERROR_INPUT, "", "--apply goes with --update.") : EO_OK;
  struct eo_faults *faults = calloc(1, sizeof *faults);
  if (!faults)
    return eo_error_memory(error);
  request->update_document = load_json(request->update, error);
  if (request->update_document)
    eo_update_decode(request->update_document, &request->update_settings, faults);
  code = request->update_document ? eo_faults_first(faults, error) : error->code;
  free(faults);
  return code;
}

/* Lowest and highest speed of the load cases: a speed far from both is a question. */
static void find_speeds(const struct eo_design *design, double speed[2])
{
  speed[0] = speed[1] = design->load_case[0].speed;
  for (int i = 1; i < design->load_cases; i++) {
    speed[0] = fmin(speed[0], design->load_case[i].speed);
    speed[1] = fmax(speed[1], design->load_case[i].speed);
  }
}

static enum eo_code measure_all(struct request *request, const struct eo_progress *progress, const char **failed_at,
                                struct eo_error *error)
{
  const char *folder = getenv("TMPDIR");
  for (int i = 0; i < request->entries; i++) {
    const struct entry *entry = &request->entry[i];
    struct eo_measure_request one = {.path = entry->path,
                                     .gear_path = entry->gear_path,
                                     .unmodified = entry->unmodified,
                                     .torque = entry->torque,
                                     .stated_speed = entry->speed,
                                     .end = entry->end,
                                     .harmonics = request->harmonic_count,
                                     .part = entry->part,
                                     .layout = entry->layout,
                                     .geometry = &request->geometry,
                                     .spool_directory = folder ? folder : "/tmp"};
    struct eo_measured *measured = &request->measured[request->measured_count];
    json_t *document;
    find_speeds(&request->design, one.speed);
    *failed_at = entry->path;
    enum eo_code code = eo_measure_file(&one, progress, &document, &request->text, measured, error);
    if (!code && json_array_append_new(request->documents, document))
      code = eo_error_memory(error);
    if (code)
      return code;
    bool result = measured->harmonics > 0, loaded = measured->torque > 0;
    if (result && !loaded && !request->alone)
      eo_text_add(&request->text,
                  "  note: no torque was stated and no column of the recording tells it; nothing is compared. "
                  "State it (--torque).\n");
    request->results += result;
    request->measured_count += result && loaded;
  }
  *failed_at = NULL;
  return EO_OK;
}

static enum eo_code predict(struct request *request, struct eo_pair **pair, struct eo_evaluator **evaluator,
                            const struct eo_pair_options *options, const struct eo_progress *progress,
                            struct eo_error *error)
{
  EO_TRY(eo_pair_new(pair, &request->design, options, progress, error));
  EO_TRY(eo_evaluator_new(evaluator, *pair, 1, error));
  EO_TRY(eo_comparison_run(&request->comparison, *evaluator, &request->design, request->measured_count,
                           request->measured, progress, error));
  return request->update
             ? eo_update_run(&request->fit, *pair, &request->design, request->measured_count, request->measured,
                             &request->update_settings, &request->updated, progress, error)
             : EO_OK;
}

static enum eo_code compare(struct request *request, const struct eo_progress *progress, struct eo_error *error)
{
  struct eo_text directory = {0};
  bool keep = !request->no_cache && eo_app_cache_directory(request->data, &directory);
  const struct eo_pair_options options = {.cache_directory = keep ? directory.data : NULL};
  struct eo_pair *pair = NULL;
  struct eo_evaluator *evaluator = NULL;
  enum eo_code code = predict(request, &pair, &evaluator, &options, progress, error);
  eo_evaluator_free(evaluator);
  eo_pair_free(pair);
  eo_text_done(&directory);
  return code;
}

static enum eo_code save_design(const struct request *request, struct eo_error *error)
{
  struct eo_text text = {0};
  json_t *document = eo_design_encode(&request->updated);
  enum eo_code code = document ? EO_OK : eo_error_memory(error);
  if (!code) {
    eo_json_write(&text, document, EO_JSON_PRETTY);
    code = eo_text_save(&text, request->apply, error);
  }
  json_decref(document);
  eo_text_done(&text);
  return code;
}

static enum eo_code save_csv(const struct request *request, struct eo_error *error)
{
  struct eo_text text = {0};
  eo_comparison_csv(&request->comparison, request->measured, &text);
  enum eo_code code = eo_text_save(&text, request->csv, error);
  eo_text_done(&text);
  return code;
}

static json_t *encode(const struct request *request)
{
  char hash[EO_HASH_LENGTH + 1];
  json_t *document = json_object();
  bool failed = !document, compared = request->comparison.count > 0;
  eo_json_put(document, "program", json_string(eo_program), &failed);
  eo_json_put(document, "design_hash", eo_design_hash(&request->design, hash, NULL) ? NULL : json_string(hash),
              &failed);
  eo_json_put(document, "measurements", json_incref(request->documents), &failed);
  eo_json_put(document, "comparison",
              compared ? eo_comparison_encode(&request->comparison, request->measured, NULL) : json_null(), &failed);
  eo_json_put(document, "update", request->update && compared ? eo_update_encode(&request->fit) : json_null(), &failed);
  return failed ? (json_decref(document), NULL) : document;
}

static int show(struct request *request)
{
  if (request->json)
    return eo_app_print_json(encode(request), false);
  if (request->comparison.count)
    eo_comparison_summary(&request->comparison, request->measured, &request->text);
  if (request->comparison.count && request->update)
    eo_update_summary(&request->fit, &request->text);
  return eo_app_print(&request->text);
}

static enum eo_code save(const struct request *request, struct eo_error *error)
{
  if (request->apply && request->comparison.count)
    EO_TRY(save_design(request, error));
  return request->csv ? save_csv(request, error) : EO_OK;
}

static int run_request(struct request *request)
{
  struct eo_watch watch;
  struct eo_error error;
  const char *failed_at = NULL;
  eo_watch_start(&watch);
  enum eo_code code = measure_all(request, &watch.progress, &failed_at, &error);
  if (!code && request->measured_count && !request->alone)
    code = compare(request, &watch.progress, &error);
  eo_watch_clear(&watch);
  if (watch.stopped)
    code = eo_error_set(&error, EO_ERROR_CANCELLED, "", "Stopped.");
  if (!code)
    code = save(request, &error);
  int status = code ? eo_app_fail(failed_at, &error) : show(request);
  eo_watch_end(&watch);
  return status ? status : request->results ? EO_EXIT_DONE : EO_EXIT_INPUT;
}

static void done(struct request *request)
{
  for (int i = 0; i < request->entries; i++) {
    free(request->entry[i].joined);
    json_decref(request->entry[i].layout);
  }
  free(request->entry);
  free(request->measured);
  json_decref(request->list_document);
  json_decref(request->update_document);
  json_decref(request->documents);
  eo_comparison_done(&request->comparison);
  eo_text_done(&request->text);
  free(request);
}

static int run(const struct eo_command *command, int argc, char **argv)
{
  struct request *request = calloc(1, sizeof *request);
  const char **operand = calloc((size_t)argc, sizeof *operand);
  struct eo_error error;
  int operands, status;
  if (!request || !operand || !(request->documents = json_array())) {
    free(request);
    free(operand);
    return eo_app_fail_memory();
  }
  const struct eo_option options[] = {{.name = "--label", .value = &request->label},
                                      {.name = "--torque", .value = &request->torque},
                                      {.name = "--speed", .value = &request->speed},
                                      {.name = "--end", .value = &request->end},
                                      {.name = "--harmonics", .value = &request->harmonics},
                                      {.name = "--layout", .value = &request->layout},
                                      {.name = "--gear", .value = &request->gear},
                                      {.name = "--part", .value = &request->part},
                                      {.name = "--from", .value = &request->from},
                                      {.name = "--to", .value = &request->to},
                                      {.name = "--list", .value = &request->list},
                                      {.name = "--csv", .value = &request->csv},
                                      {.name = "--update", .value = &request->update},
                                      {.name = "--apply", .value = &request->apply},
                                      {.name = "--data", .value = &request->data},
                                      {.name = "--json", .flag = &request->json},
                                      {.name = "--no-cache", .flag = &request->no_cache},
                                      {.name = "--no-prediction", .flag = &request->alone},
                                      {.name = NULL}};
  if (!eo_app_arguments(command, argc, argv, options, 1, argc, operand, &operands, &status))
    goto out;
  request->design_file = operand[0];
  if (read_update(request, &error) || read_entries(request, operands - 1, operand + 1, &error))
    status = eo_app_fail(NULL, &error);
  else if (eo_app_load_design(request->design_file, &request->design, &request->geometry, &request->warnings, &status))
    status = run_request(request);
out:
  free(operand);
  done(request);
  return status;
}

const struct eo_command eo_command_measure = {
    "measure", "DESIGN.json FILE... [--label L] [--torque T] [--speed S] [--layout JSON] [--json]",
    "rig files: transmission error, vibration, compared with the prediction",
    "Reads recordings of two encoders, says what is wrong with them, and sets the vibration of the mesh orders\n"
    "compared with the prediction at their torque and measured speed. What nobody can know is asked for instead of "
    "guessed.\n"
    "Files: delimited text (tabs, semicolons, commas, bars, blanks; decimal comma, thousands, UTF-16; .csv, .txt, "
    ".asc, .lvm with its\n"
    "sections, oscilloscopes, catman, DASYLab, DEWESoft, imc, DIAdem exports), one table for each channel below "
    "the other or a\n"
    "column with the channel of each row, a name before each value (t=0.1 pinion:12.3); also gzip, tar or zip (a "
    "readme "
    "beside it, a\n"
    "file for each channel, one archive in another); .xlsx, .ods, .fods (also a\n"
    "sheet for each channel); MATLAB 4 to\n"
    "7.3 (structs, cells, matrices with names), Octave text, TDMS (scaled, raw DAQmx), UFF 58 and 58b, HDF5 (records, "
    "data frames "
    "of pandas), ASAM\n"
    "MDF 4 (.mf4). Each channel may have its own times, rate and start. imc and DEWESoft files, Parquet, NumPy, WAV, "
    "XML, JSON and\n"
    "others are named, with the way to convert them.\n"
    "Times: ns to days, times of day and dates (ISO 8601, German, American, AM/PM, 20240305T085959), Unix, "
    "spreadsheet, LabVIEW and\n"
    "datenum numbers, ticks of a stated clock, counters of 16, 24 or 32 bits that start again (micros(), millis()); "
    "parts in columns of their own (seconds beside nanoseconds, date beside "
    "time beside\n"
    "fraction, hours, minutes, seconds); steps from row to row in a column called dt. Times too coarse for the rate, "
    "or a speed no load case is near to, are "
    "asked about.\n"
    "Angles: deg, rad, mrad, arcmin, arcsec, gon, turns (rev, U, cycles), degrees with minutes and seconds of arc in "
    "a cell or in\n"
    "columns, counts with the counts per turn, also "
    "hexadecimal or since\n"
    "the row before; sine and cosine tracks; pulse times or periods, in columns or a row for each edge; square waves.\n"
    "Where a unit is open (none, \"grad\", lines or edges per turn) that one is taken with which shaft and mesh orders "
    "show.\n"
    "Words, in English, German, French, Spanish, Italian: any of sampling, scan, Abtast-, d'echantillonnage, de "
    "muestreo, di\n"
    "campionamento, acquisition, Mess- with rate, frequency, Frequenz, cadence, ... or interval, period, step, -zeit, "
    "pas, paso,\n"
    "passo, ...; fs, dt, Delta_X, wf_increment; 5 kS/s alone, sentences (sampled with 5 kHz); t0, start time; tick, "
    "timebase, clock; cpr, ppr, lines, "
    "counts per turn,\n"
    "Strichzahl (of both in one line: pinion, gear), resolution in bits or the angle of a count, interpolation, x4; "
    "scale, slope,\n"
    "gain, offset; decimation: in headings, properties, attributes or structs, as numbers or as text, units on either "
    "side of the\n"
    "number. Two rates that contradict each other are asked about.\n"
    "Columns: the two that turn in the ratio of the teeth, whatever they are called; else by pinion, input, motor, "
    "Ritzel, Antrieb,\n"
    "pignon, 1 and gear, output, Rad, Abtrieb, roue, 2; sin and cos; torque, Drehmoment, couple, Md, kNm, lbf ft and "
    "speed, rpm,\n"
    "Drehzahl, vitesse, n are read beside them, and what contradicts what you state is said.\n"
    "The options hold for all files:\n"
    "  --label modified|unmodified   which of the two the recording shows (modified)\n"
    "  --torque N m, --speed rpm     of the pinion; without a torque a column of the recording tells it, or nothing is "
    "compared; the speed is only checked\n"
    "  --end left|right              where the encoders sit (right)\n"
    "  --harmonics N                 mesh orders (8)\n"
    "  --layout JSON                 what the columns mean, in place or a file: {\"kind\": "
    "\"angles|sine-cosine|pulses\", \"unit\": \"deg|rad|turn|count\",\n"
    "                                \"time\": COLUMN or [PINION'S, GEAR'S], \"time_unit\": \"s|ms|us|ns|min|d\" or "
    "seconds, "
    "\"columns\": {\"pinion\": COLUMN or [SINE, COSINE], \"gear\": "
    "...}, \"sample_rate_Hz\", \"lines\"}; guessed else\n"
    "  --gear FILE                   the gear's encoder, when each has a file of its own\n"
    "  --part N|whole                the N-th stretch without a stop, or run-up and run-down with the steady state "
    "(the "
    "longest stretch,\n"
    "                                what leads to a long steady state left out)\n"
    "  --from s, --to s              the times to measure, after the first row\n"
    "  --list LIST.json              {\"measurements\": [{\"file\", \"label\", \"torque_Nm\", \"speed_rpm\", \"end\", "
    "\"part\", \"from_s\", \"to_s\", \"layout\"}, ...]}, files relative to it\n"
    "  --no-prediction               the recordings alone\n"
    "  --csv FILE                    measured and predicted, one line per recording\n"
    "  --update JSON                 fits inputs within ranges: {\"unknowns\": {\"pinion_bearing_stiffness_N_per_um\": "
    "[200, 3000], ...}}; known are\n"
    "                                pinion_ and gear_bearing_stiffness_N_per_um, mesh_damping_ratio, gear_ and "
    "pinion_axial_stiffness_N_per_um,\n"
    "                                shaft_angle_error_in_plane_deg, shaft_angle_error_out_of_plane_deg, "
    "impact_patch_mm\n"
    "  --apply FILE                  writes the design with the inputs found\n"
    "Exit status 1 also when every recording was refused.\n\n" EO_APP_DATA_HELP
    "--no-cache neither reads nor keeps it.\n",
    run};
