/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <ctype.h>
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
#include "format/json.h"
#include "variants/variant_cost.h"
#include "variants/variant_job.h"
#include "variants/variant_study.h"
#include "variants/variant_table.h"

enum { SHOWN = 40 }; /* rows at a terminal unless --limit says otherwise */

struct request {
  const char *file, *data, *sampling, *samples, *seed, *columns, *table, *sort, *filter, *limit, *csv, *job, *work;
  const char *threads, *cache; /* read by eo_app_crew_begin() */
  bool json, dry_run, restart, descending, list_columns;
  struct eo_option_list vary;
  json_t *document; /* owned */
  struct eo_variant_plan plan;
  struct eo_app_crew *crew;
  struct eo_store *store;
  struct eo_watch watch;
  struct eo_work_note note;
};

/* From options to the document: */

static bool is_number(const char *text, size_t length)
{
  char copy[64], *end;
  if (!length || length >= sizeof copy)
    return false;
  snprintf(copy, sizeof copy, "%.*s", (int)length, text);
  double value = strtod(copy, &end);
  return !*end && isfinite(value) && !isspace((unsigned char)*copy);
}

/* "A:B:N" or "A:B"; false: it is no range. */
static bool add_range(json_t *axis, const char *text)
{
  static const char *const key[] = {"from", "to", "points"};
  int part = 0;
  for (const char *at = text; *at && part < 3; part++) {
    size_t length = strcspn(at, ":");
    if (!is_number(at, length))
      return false;
    double value = strtod(at, NULL);
    json_object_set_new(axis, key[part], part == 2 ? eo_json_whole(value) : json_real(value));
    at += length + (at[length] == ':');
    if (part == 2 && *at)
      return false;
  }
  return part >= 2;
}

/* Numbers or words with commas between them. */
static void add_list(json_t *axis, const char *text)
{
  json_t *values = json_array();
  bool numbers = true;
  for (const char *at = text; *at;) {
    size_t length = strcspn(at, ",");
    numbers = numbers && is_number(at, length);
    json_array_append_new(values, json_real(strtod(at, NULL)));
    at += length + (at[length] == ',');
  }
  if (numbers && json_array_size(values))
    json_object_set(axis, "values", values);
  else
    json_object_set_new(axis, "words", json_string(text));
  json_decref(values);
}

static enum eo_code add_axis(json_t *list, const char *option, struct eo_error *error)
{
  size_t length = strcspn(option, "=");
  json_t *axis = json_object();
  if (!option[length] || !length || !option[length + 1]) {
    json_decref(axis);
    return eo_error_set(error, EO_ERROR_INPUT, "", "--vary %.60s is not KEY=VALUE,VALUE,... or KEY=FIRST:LAST:POINTS.",
                        option);
  }
  json_object_set_new(axis, "key", json_stringn(option, length));
  if (!strchr(option + length, ':') || !add_range(axis, option + length + 1)) {
    json_object_del(axis, "from");
    json_object_del(axis, "to");
    add_list(axis, option + length + 1);
  }
  return json_array_append_new(list, axis) ? eo_error_memory(error) : EO_OK;
}

static enum eo_code add_whole(json_t *document, const char *key, const char *option, const char *text,
                              struct eo_error *error)
{
  int value;
  if (!text)
    return EO_OK;
  if (!eo_app_read_whole(text, option, 0, EO_STUDY_MOST_ROWS, &value, error))
    return error->code;
  return json_object_set_new(document, key, json_integer(value)) ? eo_error_memory(error) : EO_OK;
}

static enum eo_code add_table(struct request *request, struct eo_error *error)
{
  struct eo_text text = {0};
  if (!request->table)
    return EO_OK;
  EO_TRY(eo_text_read(&text, request->table, EO_STUDY_BYTES, error));
  json_t *value = json_stringn(text.data ? text.data : "", text.size);
  eo_text_done(&text);
  return value && json_object_set_new(request->document, "table", value) == 0
             ? EO_OK
             : eo_error_set(error, EO_ERROR_INPUT, "", "%.100s is no text in UTF-8.", request->table);
}

/* A study's document as it is, a design inside one; then what the options say. */
static enum eo_code compose(struct request *request, struct eo_error *error)
{
  json_t *document = eo_json_load(request->file, EO_STUDY_BYTES, error), *vary = NULL;
  if (!document)
    return error->code;
  if (!json_object_get(document, "design")) {
    json_t *design = document;
    document = json_pack("{s:o}", "design", design);
  }
  request->document = document;
  if (request->vary.count > EO_OPTION_MOST)
    return eo_error_set(error, EO_ERROR_INPUT, "", "There are more than %d options --vary.", EO_OPTION_MOST);
  if (request->vary.count && (vary = json_array()))
    json_object_set_new(document, "vary", vary);
  for (int i = 0; i < request->vary.count; i++)
    EO_TRY(add_axis(vary, request->vary.value[i], error));
  if (request->sampling)
    json_object_set_new(document, "sampling", json_string(request->sampling));
  if (request->columns)
    json_object_set_new(document, "columns", json_string(request->columns));
  EO_TRY(add_whole(document, "samples", "--samples", request->samples, error));
  EO_TRY(add_whole(document, "seed", "--seed", request->seed, error));
  return add_table(request, error);
}

static bool read_plan(struct request *request, int *status)
{
  struct eo_error error;
  struct eo_faults *faults = calloc(1, sizeof *faults);
  *status = EO_EXIT_DONE;
  if (!faults || compose(request, &error))
    *status = faults ? eo_app_fail(NULL, &error) : EO_EXIT_FAILED;
  else if (!eo_variant_plan_init(&request->plan, request->document, faults))
    *status = eo_app_fail_all(request->file, faults);
  free(faults);
  return *status == EO_EXIT_DONE;
}

/* What is asked for beside a study: */

static int list_columns(struct request *request)
{
  struct eo_scalars scalars;
  struct eo_error error;
  struct eo_text text = {0};
  struct eo_geometry geometry;
  struct eo_design *design = malloc(sizeof *design);
  enum eo_code code = design ? compose(request, &error) : eo_error_memory(&error);
  if (!code) {
    struct eo_text written = {0};
    eo_json_write(&written, json_object_get(request->document, "design"), EO_JSON_COMPACT);
    code = eo_design_read(written.data, written.size, design, &geometry, NULL, &error);
    eo_text_done(&written);
  }
  if (!code)
    code = eo_scalars_init(&scalars, request->columns ? request->columns : "*", design->load_cases,
                           design->gear_pair.ends, &error);
  free(design);
  if (code)
    return eo_app_fail(request->file, &error);
  for (int i = 0; i < scalars.count; i++)
    eo_text_print(&text, "%-60s %-8s %s\n", scalars.scalar[i].name, scalars.scalar[i].unit, scalars.scalar[i].help);
  eo_scalars_done(&scalars);
  return eo_app_print(&text);
}

static void print_time(struct eo_text *text, double seconds)
{
  if (seconds < 120)
    eo_text_print(text, "%.3g s", seconds);
  else if (seconds < 7200)
    eo_text_print(text, "%.3g min", seconds / 60);
  else
    eo_text_print(text, "%.3g h", seconds / 3600);
}

static int tell_cost(struct request *request, struct eo_store *store)
{
  struct eo_variant_cost cost;
  struct eo_error error;
  struct eo_text text = {0};
  int strength = eo_crew_strength(&request->crew->crew);
  if (eo_variant_cost_find(&request->plan, store, &cost, &error))
    return eo_app_fail(NULL, &error);
  eo_text_print(&text, "%d variants of %d gear pair%s\n", cost.rows, cost.pairs, cost.pairs == 1 ? "" : "s");
  if (cost.refused_pairs)
    eo_text_print(&text, "%d of the pairs cannot be as their first variant states them\n", cost.refused_pairs);
  eo_text_print(&text, "preparation of pairs that are not kept: at most ");
  print_time(&text, cost.preparation);
  eo_text_print(&text, " of a processor, %.0f MB at its most crowded moment\n", cost.memory / 1e6);
  if (isnan(cost.evaluation))
    eo_text_add(&text, "evaluation: not known, the history has none yet; some 5 to 50 ms of a processor each\n");
  else {
    eo_text_print(&text, "evaluation: %.3g ms of a processor each (mean of earlier ones), ", 1e3 * cost.evaluation);
    print_time(&text, cost.evaluation * cost.rows / strength);
    eo_text_print(&text, " for all on %d at a time\n", strength);
  }
  eo_text_print(&text, "rows in the data folder: %.3g MB\n", cost.kept / 1e6);
  return eo_app_print(&text);
}

/* The run: */

static int show_progress(void *context, const struct eo_variant_report *report)
{
  struct request *request = context;
  char line[200], left[32] = "--:--";
  if (eo_watch_due(&request->watch)) {
    if (isfinite(report->seconds_left))
      snprintf(left, sizeof left, "%ld:%02ld:%02ld", lround(report->seconds_left) / 3600,
               lround(report->seconds_left) / 60 % 60, lround(report->seconds_left) % 60);
    snprintf(line, sizeof line, "%3.0f %%, %s left, %d of %d variants, known %d, refused %d, not converged %d",
             100 * report->fraction, left, report->done, report->rows, report->reused, report->refused,
             report->not_converged);
    eo_watch_show(&request->watch, line);
  }
  if (request->note.job)
    eo_variant_job_follow(&request->note.live, report);
  return eo_work_note_shall_stop(&request->note, &request->watch);
}

/* For a server: its job, of which the table says everything. */
static int work(struct request *request, int job)
{
  struct eo_variant_result result = {0};
  struct eo_error error;
  request->note = (struct eo_work_note){.store = request->store, .job = job};
  eo_watch_start(&request->watch);
  enum eo_code code = eo_variant_job_run(request->store, job, &request->crew->crew, show_progress, request, &result,
                                         &error);
  eo_watch_clear(&request->watch);
  eo_watch_end(&request->watch);
  if (!code)
    eo_variant_job_conclude(&request->note.live, &result);
  eo_work_note_end(&request->note, code, &error);
  return code ? eo_app_fail(NULL, &error) : EO_EXIT_DONE;
}

static void summarise(const struct eo_variant_result *variant_result, struct eo_text *text)
{
  eo_text_print(text,
                "Study %lld%s: %d of %d variants, %d known before, %d computed now, %d refused, %d not converged%s\n",
                (long long)variant_result->job, variant_result->resumed ? " (taken up)" : "", variant_result->done,
                variant_result->rows, variant_result->reused, variant_result->computed, variant_result->refused,
                variant_result->not_converged, variant_result->cancelled ? "; stopped" : "");
}

static enum eo_code write_table(struct request *request, const struct eo_variant_table *table,
                                const struct eo_variant_query *query, struct eo_text *text, struct eo_error *error)
{
  json_t *document;
  struct eo_text csv = {0};
  if (request->csv) {
    enum eo_code code = eo_variant_table_csv(table, request->store, strcmp(request->csv, "-") == 0 ? text : &csv,
                                             error);
    if (!code && csv.size)
      code = eo_text_save(&csv, request->csv, error);
    eo_text_done(&csv);
    return code;
  }
  if (!request->json)
    return eo_variant_table_print(table, request->store, text, error);
  EO_TRY(eo_variant_table_encode(table, request->store, query, &document, error));
  eo_json_write(text, document, EO_JSON_PRETTY);
  json_decref(document);
  return EO_OK;
}

/* The rows that are asked for; people see what was done before them, and what they do not show. */
static enum eo_code write_rows(struct request *request, const struct eo_variant_table *table,
                               const struct eo_variant_query *query, const struct eo_variant_result *result,
                               struct eo_text *text, struct eo_error *error)
{
  bool people = !request->json && (!request->csv || strcmp(request->csv, "-") != 0);
  if (result && people)
    summarise(result, text);
  EO_TRY(write_table(request, table, query, text, error));
  if (people && !request->csv && table->count < table->fits)
    eo_text_print(text, "%d rows more: --limit, --csv FILE or --json.\n", table->fits - table->count);
  return EO_OK;
}

static enum eo_code write(struct request *request, int64_t job, const struct eo_variant_query *query,
                          const struct eo_variant_result *result, struct eo_text *text, struct eo_error *error)
{
  struct eo_variant_table table;
  enum eo_code code = eo_variant_table_init(&table, request->store, job, query, error);
  if (!code)
    code = write_rows(request, &table, query, result, text, error);
  eo_variant_table_done(&table);
  return code;
}

static int show(struct request *request, int64_t job, const struct eo_variant_result *result)
{
  struct eo_error error;
  struct eo_text text = {0};
  int limit = request->json || request->csv ? -1 : SHOWN;
  struct eo_variant_query query = {.filter = request->filter, .sort = request->sort, .descending = request->descending};
  if (request->limit && !eo_app_read_whole(request->limit, "--limit", 1, EO_STUDY_MOST_ROWS, &limit, &error))
    return eo_app_fail(NULL, &error);
  query.most = limit;
  enum eo_code code = write(request, job, &query, result, &text, &error);
  return eo_app_print_unless(code, &text, &error);
}

static int run_study(struct request *request)
{
  struct eo_variant_result result;
  struct eo_error error;
  json_t *kept = eo_variant_plan_encode(request->document, &request->plan);
  const struct eo_variant_run run = {.plan = &request->plan,
                                     .document = kept,
                                     .store = request->store,
                                     .crew = &request->crew->crew,
                                     .restart = request->restart,
                                     .watch = show_progress,
                                     .context = request};
  eo_watch_start(&request->watch);
  enum eo_code code = kept ? eo_variant_study_run(&run, &result, &error) : eo_error_memory(&error);
  eo_watch_clear(&request->watch);
  eo_watch_end(&request->watch);
  json_decref(kept);
  return code ? eo_app_fail(code == EO_ERROR_INPUT ? request->file : NULL, &error) : show(request, result.job, &result);
}

static int run_request(struct request *request)
{
  struct eo_error error;
  struct eo_text directory = {0};
  int status;
  const char *number = request->job ? request->job : request->work;
  if (!number && request->list_columns)
    return list_columns(request);
  if (!number && !read_plan(request, &status))
    return status;
  enum eo_code code = eo_app_data_directory(request->data, &directory, &error);
  if (!code)
    code = eo_store_open(&request->store, directory.data,
                         request->job || request->dry_run ? EO_STORE_READ : EO_STORE_WRITE, &error);
  int job = 0;
  if (code && request->dry_run)
    status = tell_cost(request, NULL); /* there is no history yet */
  else if (code ||
           (number && !eo_app_read_whole(number, request->job ? "--job" : "--work", 1, INT32_MAX, &job, &error)))
    status = eo_app_fail(NULL, &error);
  else
    status = request->dry_run ? tell_cost(request, request->store)
             : request->work  ? work(request, job)
             : request->job   ? show(request, job, NULL)
                              : run_study(request);
  eo_store_close(request->store);
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
  const struct eo_option options[] = {{.name = "--vary", .list = &request->vary},
                                      {.name = "--table", .value = &request->table},
                                      {.name = "--sampling", .value = &request->sampling},
                                      {.name = "--samples", .value = &request->samples},
                                      {.name = "--seed", .value = &request->seed},
                                      {.name = "--columns", .value = &request->columns},
                                      {.name = "--list-columns", .flag = &request->list_columns},
                                      {.name = "--sort", .value = &request->sort},
                                      {.name = "--descending", .flag = &request->descending},
                                      {.name = "--filter", .value = &request->filter},
                                      {.name = "--limit", .value = &request->limit},
                                      {.name = "--csv", .value = &request->csv},
                                      {.name = "--json", .flag = &request->json},
                                      {.name = "--job", .value = &request->job},
                                      {.name = "--work", .value = &request->work},
                                      {.name = "--dry-run", .flag = &request->dry_run},
                                      {.name = "--restart", .flag = &request->restart},
                                      {.name = "--threads", .value = &request->threads},
                                      {.name = "--data", .value = &request->data},
                                      {.name = "--cache", .value = &request->cache},
                                      {.name = NULL}};
  request->crew = &crew;
  if (eo_app_arguments(command, argc, argv, options, 0, 1, &request->file, &operands, &status) &&
      eo_app_design_or_job(command, request->job || request->work, operands, &status))
    status = run_request(request);
  eo_variant_plan_done(&request->plan);
  json_decref(request->document);
  free(request);
  eo_app_crew_end(&crew);
  return status;
}

const struct eo_command eo_command_study = {
    "study",
    "STUDY.json|DESIGN.json [--vary KEY=VALUES]... [--table FILE.csv] [--sampling NAME] [--samples N] [--seed N] "
    "[--columns LIST] [--list-columns] [--filter LIST] [--sort NAME] [--descending] [--limit N] [--csv FILE] [--json] "
    "[--dry-run] [--restart] [--threads N] [--data DIR] [--cache DIR] | --job N | --work N",
    "varies any numbers of a design over lists, ranges or samples: a table",
    "  --vary KEY=A,B,C     each of these values (or words); KEY=A:B:N: N values from A to B; KEY=A:B: samples "
    "between\n"
    "                       them\n"
    "                       KEY is the path in the design, load_cases.1.torque_Nm; * for all load cases, both ends\n"
    "                       (modification.pinion.*.tip_relief_um); KEY+KEY: the same value; KEY [unit]: values in "
    "that\n"
    "                       unit\n"
    "  --table FILE.csv     in place of --vary: a heading of keys, and a row for each variant\n"
    "  --sampling NAME      factorial (every value with every other one), or latin or sobol with --samples N and "
    "--seed N\n"
    "  --columns LIST       numbers of the result to keep, by their path, * for anything; --list-columns lists them\n"
    "  --filter LIST        rows to show: objectives.J<0.4,outcome=converged; --sort NAME, --descending, --limit N\n"
    "  --csv FILE           the table as comma-separated values (-: standard output)\n"
    "  --json               the document, as the server gives it\n"
    "  --dry-run            says how many variants and gear pairs, how much memory and time\n"
    "  --restart            a new study even where the same one is there; its rows are used again\n"
    "  --job N              shows a study that is there\n"
    "  --work N             works on job N of a server's queue\n"
    "\n"
    "Every row is kept as soon as it is computed: the same study, run again, goes on where it was interrupted, or "
    "shows\n"
    "its table again. A design that is impossible gives a row with the reason. Searches of the same pair use rows in "
    "which\n"
    "only the modification varies.\n"
    "\n" EO_APP_CREW_HELP EO_APP_HISTORY_HELP EO_APP_DATA_HELP,
    run};
