/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper once more, as `easeoff reproduce` computes it: a job, then its tables and its page. */
#include <stdlib.h>
#include <string.h>

#include "format/object.h"
#include "http/answers.h"
#include "http/http_private.h"
#include "http/job_reply.h"
#include "http/request_body.h"
#include "http/route.h"
#include "reproduction/reproduction_job.h"

static void submit(struct eo_request *request, const struct eo_reproduction_order *order,
                   const struct eo_design *design)
{
  struct eo_text spec = {0};
  struct eo_job_order wanted = {
      .kind = EO_JOB_REPRODUCE, .design = design, .name = "the paper once more", .algorithm = ""};
  eo_reproduction_order_write(order, &spec);
  wanted.spec = spec.data;
  if (spec.failed)
    eo_reply_no_memory(&request->reply);
  else
    eo_request_order_job(request, &wanted, false);
  eo_text_done(&spec);
}

static void add(struct eo_request *request)
{
  struct eo_reproduction_order order;
  struct eo_error error;
  if (!eo_body_read(request, &order))
    return;
  struct eo_design *design = malloc(sizeof *design);
  enum eo_code code = design ? eo_reproduction_design(&order, design, &error) : eo_error_memory(&error);
  if (code)
    eo_reply_error(&request->reply, "", &error);
  else
    submit(request, &order, design);
  free(design);
}

/* The files of a reproduction that is done; false: the reply says what is in the way. */
static bool find_files(struct eo_request *request, struct eo_file_set *files)
{
  enum eo_job_outcome outcome = EO_JOB_OUTCOME_DONE;
  struct eo_error error;
  struct eo_job_view job = {0};
  struct eo_text result = {0};
  int64_t id;
  if (!eo_request_id_at(request, 0, &id))
    return false;
  enum eo_code code = eo_service_job(request->http->service, id, false, &outcome, &job, &error);
  bool there = !code && outcome == EO_JOB_OUTCOME_DONE && job.row.kind == EO_JOB_REPRODUCE;
  if (there)
    code = eo_service_result(request->http->service, id, &outcome, &result, &error);
  bool done = there && !code && outcome == EO_JOB_OUTCOME_DONE;
  if (done)
    code = eo_reproduction_job_files(&result, files, &error);
  if (code)
    eo_reply_error(&request->reply, "", &error);
  else if (!there)
    eo_reply_problem(&request->reply, 404, NULL, "There is no reproduction with this number.");
  else if (!done)
    eo_reply_job_outcome(&request->reply, outcome);
  eo_job_view_done(&job);
  eo_text_done(&result);
  return done && !code;
}

struct listed_files {
  json_t *items;
};
static const struct eo_outline_row files_rows[] = {
    EO_KEY("items", "[text]", "names, as getJobFile takes them", EO_AT(struct listed_files, items)),
};
const struct eo_outline eo_outline_job_files = EO_OUTLINE("JobFiles", files_rows);

static void list(struct eo_request *request)
{
  struct eo_file_set files = {0};
  if (find_files(request, &files)) {
    struct eo_object items = eo_list_open();
    for (int i = 0; i < files.count; i++)
      eo_list_add(&items, json_string(files.file[i].name));
    const struct listed_files listed = {eo_object_close(&items)};
    eo_reply_json(&request->reply, 200, eo_outline_encode(&eo_outline_job_files, &listed));
  }
  eo_file_set_done(&files);
}

static bool ends_with(const char *text, const char *end)
{
  size_t length = strlen(text), short_one = strlen(end);
  return length >= short_one && strcmp(text + length - short_one, end) == 0;
}

static void get_file(struct eo_request *request)
{
  struct eo_file_set files = {0};
  if (find_files(request, &files)) {
    int i = 0;
    while (i < files.count && strcmp(files.file[i].name, request->argument[1]) != 0)
      i++;
    if (i == files.count)
      eo_reply_problem(&request->reply, 404, NULL, "The reproduction has no file of this name.");
    else {
      bool page = ends_with(files.file[i].name, ".html");
      snprintf(request->reply.file_name, sizeof request->reply.file_name, "%s", files.file[i].name);
      eo_reply_text(&request->reply, 200, page ? "text/html; charset=utf-8" : "text/csv; charset=utf-8",
                    &files.file[i].text);
    }
  }
  eo_file_set_done(&files);
}

const struct eo_route eo_routes_reproduction[] = {
    {.method = EO_POST,
     .pattern = "/reproductions",
     .handle = add,
     .name = "addReproduction",
     .summary = "Orders the paper's tables and figures compared with ours, as `easeoff reproduce` computes them: some "
                "minutes, "
                "less when the history knows them. Its job is listed with the others.",
     .takes = "ReproductionOrder",
     .order = &eo_reproduction_order_table,
     .takes_nothing = true,
     .gives = "202 Job",
     .headers = "Idempotency-Key",
     .rate = EO_RATE_START},
    {.method = EO_GET,
     .pattern = "/jobs/{id}/files",
     .handle = list,
     .name = "listJobFiles",
     .summary =
         "The files of a reproduction that is done: tables, data of the figures, a page that needs nothing else. "
         "409 while it is not.",
     .gives = "200 JobFiles",
     .aside = true},
    {.method = EO_GET,
     .pattern = "/jobs/{id}/files/{name}",
     .handle = get_file,
     .name = "getJobFile",
     .summary = "One of these files.",
     .gives = "200 text/csv, 200 text/html",
     .aside = true},
    {0}};
