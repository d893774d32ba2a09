/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "app/app.h"
#include "app/data.h"
#include "app/number.h"
#include "format/json.h"
#include "format/text_table.h"
#include "document/study_result.h"
#include "study/history_document.h"
#include "study/history_prune.h"
#include "store/merge.h"

struct request {
  const char *data, *job, *problem;
  bool json, predictions, outdated, damaged, unused;
  const char *operand[2];
  struct eo_store *store;
};

static enum eo_code read_id(const char *text, const char *what, int *id, struct eo_error *error)
{
  return eo_app_read_whole(text, what, 1, 2000000000, id, error) ? EO_OK : EO_ERROR_INPUT;
}

static void print_problems(const json_t *list, struct eo_text *text)
{
  static const char *const headings[] = {"problem", "name", "hash", "evaluations", "failed", "model time, s", "since"};
  const json_t *row;
  size_t i;
  struct eo_text_table sheet;
  eo_text_table_init(&sheet, 7, headings);
  json_array_foreach(json_object_get(list, "problems"), i, row)
  {
    char name[60], hash[16];
    eo_text_clean(name, sizeof name, json_string_value(json_object_get(row, "name")));
    snprintf(hash, sizeof hash, "%.12s", json_string_value(json_object_get(row, "hash")));
    eo_text_table_number(&sheet, eo_json_find_number(row, "id"), NULL, 0);
    eo_text_table_string(&sheet, name);
    eo_text_table_string(&sheet, hash);
    eo_text_table_number(&sheet, eo_json_find_number(row, "evaluations"), NULL, 0);
    eo_text_table_number(&sheet, eo_json_find_number(row, "failed"), NULL, 0);
    eo_text_table_number(&sheet, eo_json_find_number(row, "cost_s"), NULL, 4);
    eo_text_table_string(&sheet, json_string_value(json_object_get(row, "created")));
  }
  eo_text_table_print(&sheet, 0, text);
  eo_text_table_done(&sheet);
}

static void print_jobs(const json_t *list, struct eo_text *text)
{
  static const char *const headings[] = {"job",  "problem",     "name",   "algorithm", "state",
                                         "true", "individuals", "best J", "last"};
  const json_t *row;
  size_t i;
  struct eo_text_table sheet;
  eo_text_table_init(&sheet, 9, headings);
  json_array_foreach(json_object_get(list, "jobs"), i, row)
  {
    char name[60];
    eo_text_clean(name, sizeof name, json_string_value(json_object_get(row, "name")));
    eo_text_table_number(&sheet, eo_json_find_number(row, "id"), NULL, 0);
    eo_text_table_number(&sheet, eo_json_find_number(row, "problem"), NULL, 0);
    eo_text_table_string(&sheet, name);
    const char *algorithm = json_string_value(json_object_get(row, "algorithm"));
    eo_text_table_string(&sheet, *algorithm ? algorithm : json_string_value(json_object_get(row, "kind")));
    eo_text_table_string(&sheet, json_string_value(json_object_get(row, "state")));
    eo_text_table_number(&sheet, eo_json_find_number(row, "true_evaluations"), NULL, 0);
    eo_text_table_number(&sheet, eo_json_find_number(row, "individuals"), NULL, 0);
    eo_text_table_number(&sheet, eo_json_find_number(row, "best_value"), NULL, 4);
    eo_text_table_string(&sheet, json_string_value(json_object_get(row, "updated")));
  }
  eo_text_table_print(&sheet, 0, text);
  eo_text_table_done(&sheet);
}

static int run_list(struct request *request)
{
  struct eo_error error;
  struct eo_text text = {0};
  json_t *list = NULL;
  if (eo_records_list(request->store, &list, &error))
    return eo_app_fail(NULL, &error);
  if (request->json)
    return eo_app_print_json(list, false);
  print_problems(list, &text);
  eo_text_add(&text, "\n");
  print_jobs(list, &text);
  json_decref(list);
  return eo_app_print(&text);
}

static int run_show(struct request *request)
{
  struct eo_error error;
  json_t *document = NULL;
  int id;
  if (read_id(request->operand[1], "show", &id, &error) || eo_records_result(request->store, id, &document, &error))
    return eo_app_fail(NULL, &error);
  return eo_app_show(document, request->json, eo_study_result_summary);
}

static int export_path(struct request *request)
{
  struct eo_error error;
  struct eo_text text = {0};
  int id;
  enum eo_code code = read_id(request->job, "--job", &id, &error);
  if (!code)
    code = eo_records_path_csv(request->store, id, &text, &error);
  return eo_app_print_unless(code, &text, &error);
}

static int run_export(struct request *request)
{
  struct eo_error error;
  struct eo_text text = {0};
  json_t *rows = NULL;
  int id;
  if (request->job)
    return export_path(request);
  if (read_id(request->operand[1], "export", &id, &error) || eo_records_rows(request->store, id, &rows, &error))
    return eo_app_fail(NULL, &error);
  if (request->json)
    return eo_app_print_json(rows, false);
  enum eo_code code = eo_records_rows_csv(rows, &text, &error);
  json_decref(rows);
  return eo_app_print_unless(code, &text, &error);
}

static int run_prune(struct request *request)
{
  struct eo_error error;
  struct eo_text text = {0};
  struct eo_pruned pruned;
  struct eo_prune prune = {.outdated = request->outdated, .damaged = request->damaged, .unused = request->unused};
  bool other = prune.outdated || prune.damaged || prune.unused || request->problem;
  prune.predictions = request->predictions || !other;
  if ((request->problem && read_id(request->problem, "--problem", &prune.problem, &error)) ||
      eo_history_prune(request->store, &prune, &pruned, &error))
    return eo_app_fail(NULL, &error);
  eo_text_print(&text, "%lld true rows and %lld predictions removed\n", (long long)pruned.rows,
                (long long)pruned.predictions);
  return eo_app_print(&text);
}

static int run_import(struct request *request)
{
  struct eo_error error;
  struct eo_text text = {0};
  struct eo_merge_counts counts;
  if (eo_store_merge(request->store, request->operand[1], &counts, &error))
    return eo_app_fail(NULL, &error);
  eo_text_print(&text, "%lld problems, %lld evaluations and %lld rows of studies added\n", (long long)counts.problems,
                (long long)counts.evaluations, (long long)counts.variants);
  return eo_app_print(&text);
}

static const struct action {
  const char *name;
  int operands; /* with the name */
  int (*run)(struct request *request);
} actions[] = {{"list", 1, run_list},
               {"show", 2, run_show},
               {"export", 2, run_export},
               {"prune", 1, run_prune},
               {"import", 2, run_import}};

static const struct action *find_action(const struct request *request, int operands, struct eo_error *error)
{
  for (size_t i = 0; i < sizeof actions / sizeof actions[0]; i++)
    if (strcmp(actions[i].name, request->operand[0]) == 0) {
      bool by_job = actions[i].run == run_export && request->job;
      if (operands == actions[i].operands - by_job)
        return &actions[i];
      eo_error_set(error, EO_ERROR_INPUT, "", "history %s takes %s; see easeoff history --help.", actions[i].name,
                   actions[i].run == run_import          ? "one folder"
                   : actions[i].operands == 2 && !by_job ? "one number"
                                                         : "no number");
      return NULL;
    }
  eo_error_set(error, EO_ERROR_INPUT, "", "\"%.40s\" is no action: list, show, export, import or prune.",
               request->operand[0]);
  return NULL;
}

static int run_action(struct request *request, int operands)
{
  struct eo_error error;
  struct eo_text directory = {0};
  const struct action *action = find_action(request, operands, &error);
  enum eo_code code = action ? eo_app_data_directory(request->data, &directory, &error) : EO_ERROR_INPUT;
  if (!code)
    code = eo_store_open(&request->store, directory.data, action->run == run_import ? EO_STORE_WRITE : EO_STORE_READ,
                         &error);
  int status = code ? eo_app_fail(NULL, &error) : action->run(request);
  eo_store_close(request->store);
  eo_text_done(&directory);
  return status;
}

static int run(const struct eo_command *command, int argc, char **argv)
{
  struct request request = {0};
  int operands, status;
  const struct eo_option options[] = {{.name = "--data", .value = &request.data},
                                      {.name = "--json", .flag = &request.json},
                                      {.name = "--job", .value = &request.job},
                                      {.name = "--problem", .value = &request.problem},
                                      {.name = "--predictions", .flag = &request.predictions},
                                      {.name = "--outdated", .flag = &request.outdated},
                                      {.name = "--damaged", .flag = &request.damaged},
                                      {.name = "--unused", .flag = &request.unused},
                                      {.name = NULL}};
  if (eo_app_arguments(command, argc, argv, options, 1, 2, request.operand, &operands, &status))
    status = run_action(&request, operands);
  return status;
}

const struct eo_command eo_command_history = {
    "history", "list | show JOB | export PROBLEM | export --job JOB | import DIR | prune  [--data DIR] [--json]",
    "what was evaluated and searched before",
    "  list              problems (all that an evaluation depends on except the modification) and jobs\n"
    "  show JOB          the result of a search, as optimize printed it\n"
    "  export PROBLEM    every true row as comma-separated values: modification, values per load case\n"
    "  export --job JOB  the path of a search: each individual, and whether it was computed, known or predicted\n"
    "  import DIR        adds the evaluations and the rows of studies of another data folder; what is here stays. The\n"
    "                    same study or search, run again, then finds them\n"
    "  prune             removes predictions of searches that have ended; or instead\n"
    "    --predictions   all predictions (with other options; alone it is the default)\n"
    "    --outdated      rows of an older model\n"
    "    --problem N     a problem with its jobs\n"
    "    --damaged       rows with a wrong check sum\n"
    "    --unused        rows of studies and tolerance analyses that no job has any more\n"
    "\n" EO_APP_HISTORY_HELP,
    run};
