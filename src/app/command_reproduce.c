/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>

#include "app/app.h"
#include "app/data.h"
#include "app/number.h"
#include "app/watch.h"
#include "base/parallel.h"
#include "reproduction/reproduction.h"

struct request {
  const char *csv, *html, *data, *threads;
  bool json, quick;
  int thread_count;
};

static enum eo_code save(const struct request *request, const json_t *document, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  struct eo_file_set bundle = {0};
  struct eo_text page = {0};
  if (request->csv) {
    eo_reproduction_files(document, &bundle);
    code = eo_file_set_save(&bundle, request->csv, error);
  }
  if (!code && request->html) {
    eo_reproduction_page(document, &page);
    code = eo_text_save(&page, request->html, error);
  }
  eo_file_set_done(&bundle);
  eo_text_done(&page);
  return code;
}

static enum eo_code reproduce(const struct request *request, const char *data, const char *cache,
                              struct eo_watch *watch, json_t **document, struct eo_error *error)
{
  struct eo_store *store = NULL;
  EO_TRY(eo_store_open(&store, data, EO_STORE_WRITE, error));
  struct eo_reproduction_plan plan = {
      .store = store, .cache_directory = cache, .threads = request->thread_count, .progress = &watch->progress};
  eo_table_defaults(&eo_reproduction_order_table, &plan.order);
  plan.order.quick = request->quick;
  enum eo_code code = eo_reproduction_run(&plan, document, error);
  eo_watch_clear(watch);
  eo_store_close(store);
  return code ? code : save(request, *document, error);
}

static int run_request(struct request *request)
{
  struct eo_watch watch;
  struct eo_error error;
  struct eo_text data = {0}, cache = {0};
  json_t *document = NULL;
  if (request->threads &&
      !eo_app_read_whole(request->threads, "--threads", 1, EO_MAX_THREADS, &request->thread_count, &error))
    return eo_app_fail(NULL, &error);
  eo_watch_start(&watch);
  enum eo_code code = eo_app_data_directory(request->data, &data, &error);
  bool keep = eo_app_cache_directory(request->data, &cache);
  if (!code)
    code = reproduce(request, data.data, keep ? cache.data : NULL, &watch, &document, &error);
  int status = code ? eo_app_fail(NULL, &error) : eo_app_show(document, request->json, eo_reproduction_summary);
  eo_watch_end(&watch);
  eo_text_done(&data);
  eo_text_done(&cache);
  return status;
}

static int run(const struct eo_command *command, int argc, char **argv)
{
  struct request request = {0};
  int operands, status;
  const struct eo_option options[] = {{.name = "--json", .flag = &request.json},
                                      {.name = "--csv", .value = &request.csv},
                                      {.name = "--html", .value = &request.html},
                                      {.name = "--data", .value = &request.data},
                                      {.name = "--threads", .value = &request.threads},
                                      {.name = "--quick", .flag = &request.quick},
                                      {.name = NULL}};
  if (eo_app_arguments(command, argc, argv, options, 0, 0, NULL, &operands, &status))
    status = run_request(&request);
  return status;
}

const struct eo_command eo_command_reproduce = {
    "reproduce", "[--quick] [--json] [--csv DIR] [--html FILE] [--data DIR] [--threads N]",
    "the paper's tables and figures compared with ours",
    "Runs the paper's pair unmodified and with Table 3 as given, and optimizes its two cases with the paper's "
    "algorithm,\n"
    "the plain genetic algorithm and ours. Then it prints every number of the paper next to ours, and whether trend "
    "and\n"
    "value agree. This takes some minutes the first time; after that the history has the answers. --quick takes a "
    "tenth\n"
    "of the generations. --html writes one page with all figures.\n"
    "\n" EO_APP_HISTORY_HELP EO_APP_DATA_HELP,
    run};
