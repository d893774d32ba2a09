/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/app.h"
#include "app/data.h"
#include "app/table_options.h"
#include "app/watch.h"
#include "base/hash.h"
#include "format/json.h"
#include "document/layout_document.h"
#include "document/measure_order.h"
#include "document/update_document.h"

/* One recording with what is known of it. */
struct entry {
  const char *path; /* borrowed from the command line, or joined */
  char *joined;     /* owned: a path of the list, as seen from here */
  struct eo_measure_order order;
};

struct request {
  const char *design_file, *gear, *list, *csv, *update, *apply, *data;
  bool json, no_cache, alone;
  struct eo_table_options options;
  json_t *option_document; /* owned: what the options say */
  struct eo_design design, updated;
  struct eo_geometry geometry;
  struct eo_warnings warnings;
  int entries, results;                    /* results: recordings that were not refused */
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

/* JSON given in place, or in a file. */
static json_t *load_json(const char *text, struct eo_error *error)
{
  return *text == '{' ? eo_json_parse(text, strlen(text), error) : eo_json_load(text, EO_JSON_DESIGN_BYTES, error);
}

/* --part whole is another name for --run-up included. */
static void settle_part(struct request *request)
{
  const char **part = eo_table_options_text(&request->options, "part");
  if (*part && strcmp(*part, "whole") == 0) {
    *part = NULL;
    *eo_table_options_text(&request->options, "run_up") = "included";
  }
}

static enum eo_code read_options(struct request *request, struct eo_measure_order *usual, struct eo_faults *faults,
                                 struct eo_error *error)
{
  settle_part(request);
  EO_TRY(eo_table_options_put(&request->options, request->option_document, error));
  eo_table_decode(&eo_measure_option_table, request->option_document, NULL, usual, faults);
  eo_measure_order_check(usual, NULL, faults);
  return EO_OK;
}

/* The options hold for every row that does not say otherwise. */
static enum eo_code read_list(struct request *request, struct eo_measure_list *list, struct eo_faults *faults,
                              struct eo_error *error)
{
  if (!request->list)
    return EO_OK;
  if (!(request->list_document = load_json(request->list, error)))
    return error->code;
  json_t *row;
  size_t i;
  json_array_foreach(json_object_get(request->list_document, "measurements"), i, row)
  {
    if (json_is_object(row) && json_object_update_missing(row, request->option_document))
      return eo_error_memory(error);
  }
  eo_table_decode(&eo_measure_list_table, request->list_document, NULL, list, faults);
  const struct eo_path rows = {.key = "measurements"};
  for (int k = 0; k < list->count && !faults->count; k++)
    eo_measure_order_check(&list->row[k], &(struct eo_path){&rows, NULL, k}, faults);
  return EO_OK;
}

/* A file of the list stands relative to it. */
static enum eo_code join_path(const struct request *request, struct entry *entry, struct eo_error *error)
{
  const char *file = entry->order.file, *slash = strrchr(request->list, '/');
  struct eo_text path = {0};
  eo_text_print(&path, "%.*s%s", *file == '/' || !slash ? 0 : (int)(slash - request->list + 1), request->list, file);
  entry->path = entry->joined = path.data;
  return path.failed ? eo_error_memory(error) : EO_OK;
}

static enum eo_code set_entries(struct request *request, int files, const char *const *file,
                                const struct eo_measure_order *usual, const struct eo_measure_list *list,
                                struct eo_error *error)
{
  int count = files + list->count;
  if (count < 1 || count > EO_MOST_MEASURED)
    return eo_error_set(error, EO_ERROR_INPUT, "", "Between 1 and %d recordings are measured at once.",
                        EO_MOST_MEASURED);
  if (request->gear && count != 1)
    return eo_error_set(error, EO_ERROR_INPUT, "", "--gear goes with one recording.");
  request->entry = calloc((size_t)count, sizeof *request->entry);
  request->measured = calloc((size_t)count, sizeof *request->measured);
  if (!request->entry || !request->measured)
    return eo_error_memory(error);
  request->entries = count;
  for (int i = 0; i < count; i++) {
    struct entry *entry = &request->entry[i];
    entry->order = i < files ? *usual : list->row[i - files];
    if (i < files)
      entry->path = file[i];
    else
      EO_TRY(join_path(request, entry, error));
  }
  return EO_OK;
}

/* False with *status set and told. */
static bool read_entries(struct request *request, int files, const char *const *file, int *status)
{
  struct eo_error error;
  struct eo_measure_order *usual = calloc(1, sizeof *usual);
  struct eo_measure_list *list = calloc(1, sizeof *list);
  struct eo_faults *faults = calloc(1, sizeof *faults);
  bool ready = usual && list && faults;
  enum eo_code code = ready ? read_options(request, usual, faults, &error) : eo_error_memory(&error);
  const char *told = NULL;
  if (!code && !faults->count) {
    told = request->list && *request->list != '{' ? request->list : NULL;
    code = read_list(request, list, faults, &error);
  }
  bool faulty = ready && faults->count;
  if (!code && !faulty)
    code = set_entries(request, files, file, usual, list, &error);
  *status = faulty ? eo_app_fail_all(told, faults) : code ? eo_app_fail(NULL, &error) : EO_EXIT_DONE;
  free(usual);
  free(list);
  free(faults);
  return *status == EO_EXIT_DONE;
}

static enum eo_code read_update(struct request *request, struct eo_error *error)
{
  if (!request->update)
    return request->apply ? eo_error_set(error, EO_ERROR_INPUT, "", "--apply goes with --update.") : EO_OK;
  struct eo_faults *faults = calloc(1, sizeof *faults);
  if (!faults)
    return eo_error_memory(error);
  request->update_document = load_json(request->update, error);
  if (request->update_document)
    eo_update_decode(request->update_document, &request->update_settings, faults);
  enum eo_code code = request->update_document ? eo_faults_first(faults, error) : error->code;
  free(faults);
  return code;
}

static enum eo_code measure_all(struct request *request, const struct eo_progress *progress, const char **failed_at,
                                struct eo_error *error)
{
  const char *folder = getenv("TMPDIR");
  for (int i = 0; i < request->entries; i++) {
    const struct entry *entry = &request->entry[i];
    struct eo_measure_request one = {.path = entry->path,
                                     .gear_path = request->gear,
                                     .geometry = &request->geometry,
                                     .spool_directory = folder ? folder : "/tmp"};
    struct eo_measured *measured = &request->measured[request->measured_count];
    json_t *document;
    eo_measure_order_take(&entry->order, &request->design, &one);
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
  for (int i = 0; i < request->entries; i++)
    free(request->entry[i].joined);
  free(request->entry);
  free(request->measured);
  json_decref(request->option_document);
  json_decref(request->list_document);
  json_decref(request->update_document);
  json_decref(request->documents);
  eo_comparison_done(&request->comparison);
  eo_text_done(&request->text);
  free(request);
}

static void add_options(struct request *request)
{
  struct eo_table_options *options = &request->options;
  eo_table_options_add(options, &eo_measure_option_table);
  const struct eo_option own[] = {{.name = "--torque", .value = eo_table_options_text(options, "torque_Nm")},
                                  {.name = "--speed", .value = eo_table_options_text(options, "speed_rpm")},
                                  {.name = "--from", .value = eo_table_options_text(options, "from_s")},
                                  {.name = "--to", .value = eo_table_options_text(options, "to_s")},
                                  {.name = "--gear", .value = &request->gear},
                                  {.name = "--list", .value = &request->list},
                                  {.name = "--csv", .value = &request->csv},
                                  {.name = "--update", .value = &request->update},
                                  {.name = "--apply", .value = &request->apply},
                                  {.name = "--data", .value = &request->data},
                                  {.name = "--json", .flag = &request->json},
                                  {.name = "--no-cache", .flag = &request->no_cache},
                                  {.name = "--no-prediction", .flag = &request->alone}};
  for (size_t i = 0; i < sizeof own / sizeof own[0]; i++)
    eo_table_options_add_own(options, own[i]);
}

/* Below the command's own help stand the keys of what it reads. */
static void write_help(const struct eo_command *command, struct eo_text *help)
{
  const struct {
    const char *heading;
    const struct eo_table *table;
  } keys[] = {{"Keys of --update", &eo_update_table}, {"Keys of --layout", &eo_asked_layout_table}};
  eo_text_add(help, command->help);
  for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++) {
    eo_text_print(help, "\n%s:\n\n", keys[i].heading);
    eo_table_describe(keys[i].table, false, help);
  }
  eo_text_add(help,
              "\nKeys of a row of --list. Each is an option for all recordings too, with dashes in place of\n"
              "underscores: \"run_up\" is --run-up included. --torque, --speed, --from and --to are short names,\n"
              "--part whole is --run-up included, and --layout takes JSON or the name of a file with it.\n");
}

static bool read_arguments(struct request *request, const struct eo_command *command, int argc, char **argv,
                           const char **operand, int *operands, int *status)
{
  struct eo_text help = {0};
  struct eo_command described = *command;
  write_help(command, &help);
  described.help = help.failed ? command->help : help.data;
  bool more = eo_table_options_read(&request->options, &described, argc, argv, 1, argc, operand, operands, status);
  eo_text_done(&help);
  return more;
}

static int run_arguments(const struct eo_command *command, struct request *request, int argc, char **argv,
                         const char **operand)
{
  struct eo_error error;
  int operands, status;
  if (!read_arguments(request, command, argc, argv, operand, &operands, &status))
    return status;
  request->design_file = operand[0];
  if (read_update(request, &error))
    return eo_app_fail(NULL, &error);
  if (read_entries(request, operands - 1, operand + 1, &status) &&
      eo_app_load_design(request->design_file, &request->design, &request->geometry, &request->warnings, &status))
    status = run_request(request);
  return status;
}

static int run(const struct eo_command *command, int argc, char **argv)
{
  int status;
  struct request *request = eo_app_request(sizeof *request, &status);
  if (!request)
    return status;
  const char **operand = calloc((size_t)argc, sizeof *operand);
  request->documents = json_array();
  request->option_document = json_object();
  if (operand && request->documents && request->option_document) {
    add_options(request);
    status = run_arguments(command, request, argc, argv, operand);
  } else
    status = eo_app_fail_memory();
  free(operand);
  done(request);
  return status;
}

const struct eo_command eo_command_measure = {
    "measure", "DESIGN.json FILE... [--label L] [--torque T] [--speed S] [--layout JSON] [--json]",
    "rig files: transmission error, vibration, compared with the prediction",
    "Reads recordings of two encoders, says what is wrong with them, and compares the vibration of the mesh orders\n"
    "with the prediction at the recording's torque and measured speed. What neither the recording nor you state, and\n"
    "what cannot be recognised, is asked for, never guessed.\n"
    "\n"
    "Files: delimited text (tabs, semicolons, commas, bars, blanks; decimal comma, thousands, UTF-16; .csv, .txt,\n"
    ".asc, .lvm with its sections, exports of oscilloscopes, catman, DASYLab, DEWESoft, imc, DIAdem); one table for\n"
    "each channel below the other, or a column with the channel of each row, or a name before each value\n"
    "(t=0.1 pinion:12.3). Also gzip, tar or zip (with a readme, a file for each channel, one archive in another);\n"
    ".xlsx, .ods, .fods (also a sheet for each channel); MATLAB 4 to 7.3 (structs, cells, matrices with names),\n"
    "Octave text, TDMS (scaled, raw DAQmx), UFF 58 and 58b, HDF5 (records, data frames of pandas), ASAM MDF 4 (.mf4).\n"
    "Each channel may have its own times, rate and start. For imc and DEWESoft files, Parquet, NumPy, WAV, XML, JSON\n"
    "and others the program names the format and the way to convert it.\n"
    "\n"
    "Times: ns to days, times of day and dates (ISO 8601, German, American, AM/PM, 20240305T085959, days of the\n"
    "year as 2024-065T08:59:59), durations (PT1.25S), numbers of Unix, spreadsheets, LabVIEW and datenum, ticks of a\n"
    "stated clock, counters of 16, 24 or 32 bits that start again (micros(), millis()); parts in columns of their own\n"
    "(seconds and nanoseconds; date, time and fraction; hours, minutes, seconds); steps from row to row in a column\n"
    "called dt. The program asks about times that are too coarse for the rate, and about a speed that is far from\n"
    "those of all load cases.\n"
    "\n"
    "Angles: deg, rad, mrad, arcmin, arcsec, gon, turns (rev, U, cycles), degrees with minutes and seconds of arc in\n"
    "a cell or in columns, counts with the counts per turn, also hexadecimal or since the row before; sine and cosine\n"
    "tracks; pulse times or periods, in columns or a row for each edge; square waves. Where the unit is open (none,\n"
    "\"grad\", lines or edges per turn), the program takes the unit with which shaft and mesh orders show.\n"
    "\n"
    "Words, in English, German, French, Spanish, Italian: any of sampling, scan, Abtast-, d'echantillonnage,\n"
    "de muestreo, di campionamento, acquisition, Mess- with rate, frequency, Frequenz, cadence, ... or interval,\n"
    "period, step, -zeit, pas, paso, passo, ...; fs, dt, Delta_X, wf_increment; 5 kS/s alone, sentences (sampled with\n"
    "5 kHz); t0, start time; tick, timebase, clock; cpr, ppr, lines, counts per turn, Strichzahl (of both in one\n"
    "line: pinion, gear), resolution in bits or the angle of a count, interpolation, x4; scale, slope, gain, offset;\n"
    "decimation, skip, compression. They may stand in headings, properties, attributes, structs or in a column that\n"
    "holds one number, as numbers or as text, with the unit before or after the number. The program asks about two\n"
    "rates that contradict each other.\n"
    "\n"
    "Columns: the two that turn in the ratio of the teeth, whatever they are called; else by the names pinion, input,\n"
    "motor, Ritzel, Antrieb, pignon, 1 and gear, output, Rad, Abtrieb, roue, 2; sin and cos. Torque (torque, "
    "Drehmoment,\n"
    "couple, Md; kNm, lbf ft) and speed (speed, rpm, Drehzahl, vitesse, n) are read as well, and the program says "
    "where\n"
    "they contradict what you state.\n"
    "\n"
    "Options:\n"
    "  --gear FILE       the recording of the gear's encoder, when each encoder has a file of its own\n"
    "  --list LIST.json  several recordings: {\"measurements\": [{\"file\": \"a.csv\", \"torque_Nm\": 600}, ...]}; a "
    "row has\n"
    "                    the keys at the end of this text\n"
    "  --no-prediction   measures the recordings and compares nothing\n"
    "  --csv FILE        writes measured and predicted values, one line for each recording\n"
    "  --update JSON     fits inputs of the design within ranges, in place or a file:\n"
    "                    {\"unknowns\": {\"mesh_damping_ratio\": [0.01, 0.2]}}\n"
    "  --apply FILE      writes the design with the fitted inputs\n"
    "Without a torque, stated or in a column of the recording, nothing is compared. A stated speed is only checked.\n"
    "Exit status 1 also when every recording was refused.\n"
    "\n" EO_APP_DATA_HELP "--no-cache neither reads nor keeps it.\n",
    run};
