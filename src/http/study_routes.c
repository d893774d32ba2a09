/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Studies: ordering them, what they cost, their tables. */
#include <stdlib.h>
#include <string.h>

#include "format/json.h"
#include "http/http_private.h"
#include "http/job_reply.h"
#include "http/request_body.h"
#include "http/route.h"
#include "variants/variant_cost.h"
#include "variants/variant_table.h"

/* Reads the study in the body; false: the reply says everything that is wrong. done() in any case. */
static bool read_plan(struct eo_request *request, struct eo_variant_plan *plan)
{
  const json_t *document = eo_request_json(request);
  struct eo_faults *faults = document ? eo_request_memory(request, sizeof *faults) : NULL;
  memset(plan, 0, sizeof *plan);
  bool good = faults && eo_variant_plan_init(plan, document, faults);
  if (faults && !good)
    eo_reply_faults(&request->reply, "", faults);
  free(faults);
  return good;
}

static void submit(struct eo_request *request, const struct eo_variant_plan *plan, const char *spec)
{
  struct eo_job_order order = {.kind = EO_JOB_STUDY,
                               .design = plan->design,
                               .spec = spec,
                               .name = plan->name,
                               .algorithm = plan->table ? "table" : eo_study_samplings[plan->sampling]};
  eo_request_order_job(request, &order, false);
}

static void add(struct eo_request *request)
{
  struct eo_variant_plan plan;
  struct eo_text spec = {0};
  if (read_plan(request, &plan)) {
    json_t *document = eo_variant_plan_encode(request->document, &plan);
    if (document)
      eo_json_write(&spec, document, EO_JSON_COMPACT);
    if (document && !spec.failed)
      submit(request, &plan, spec.data);
    else
      eo_reply_no_memory(&request->reply);
    json_decref(document);
  }
  eo_text_done(&spec);
  eo_variant_plan_done(&plan);
}

static void tell_cost(struct eo_request *request)
{
  struct eo_variant_plan plan;
  struct eo_variant_cost cost;
  struct eo_error error;
  if (read_plan(request, &plan)) {
    if (eo_variant_cost_find(&plan, request->store, &cost, &error))
      eo_reply_error(&request->reply, "", &error);
    else
      eo_reply_json(&request->reply, 200, eo_outline_encode(&eo_variant_cost_outline, &cost));
  }
  eo_variant_plan_done(&plan);
}

static struct eo_variant_query query_of(const struct eo_request *request)
{
  const char *order = eo_request_query(request, "order");
  return (struct eo_variant_query){.filter = eo_request_query(request, "filter"),
                                   .sort = eo_request_query(request, "sort"),
                                   .descending = order && strcmp(order, "descending") == 0,
                                   .first = (int)eo_route_number(request, "cursor"),
                                   .most = request->csv ? -1 : (int)eo_route_number(request, "limit")};
}

static bool is_study(struct eo_request *request, int64_t id)
{
  enum eo_job_outcome outcome = EO_JOB_OUTCOME_DONE;
  struct eo_error error;
  struct eo_job_view job = {0};
  enum eo_code code = eo_service_job(request->http->service, id, false, &outcome, &job, &error);
  bool study = !code && outcome == EO_JOB_OUTCOME_DONE && job.row.kind == EO_JOB_STUDY;
  if (code)
    eo_reply_error(&request->reply, "", &error);
  else if (!study)
    eo_reply_problem(&request->reply, 404, NULL, "There is no study with this number.");
  eo_job_view_done(&job);
  return study;
}

static void get_table(struct eo_request *request)
{
  struct eo_variant_table table;
  struct eo_error error;
  struct eo_text text = {0};
  json_t *document = NULL;
  int64_t id;
  if (!eo_request_id_at(request, 0, &id) || !is_study(request, id))
    return;
  const struct eo_variant_query query = query_of(request);
  enum eo_code code = eo_variant_table_init(&table, request->store, id, &query, &error);
  if (!code && request->csv)
    code = eo_variant_table_csv(&table, request->store, &text, &error);
  else if (!code)
    code = eo_variant_table_encode(&table, request->store, &query, &document, &error);
  if (code)
    eo_reply_error(&request->reply, "", &error);
  else if (request->csv)
    eo_reply_table(request, &text);
  else
    eo_reply_json(&request->reply, 200, document);
  eo_text_done(&text);
  eo_variant_table_done(&table);
}

static void get_design(struct eo_request *request)
{
  struct eo_error error;
  int64_t id, variant;
  if (!eo_request_id_at(request, 0, &id) || !is_study(request, id))
    return;
  char *end;
  variant = strtoll(request->argument[1], &end, 10);
  struct eo_design *design = malloc(sizeof *design);
  if (*end || end == request->argument[1] || variant < 0 || variant > EO_STUDY_MOST_ROWS)
    eo_reply_problem(&request->reply, 404, NULL, "There is no variant with this number.");
  else if (!design)
    eo_reply_no_memory(&request->reply);
  else if (eo_variant_table_design(request->store, id, (int)variant, design, &error))
    eo_reply_error(&request->reply, "", &error);
  else
    eo_reply_json(&request->reply, 200, eo_design_encode(design));
  free(design);
}

static void list_columns(struct eo_request *request)
{
  struct eo_scalars scalars;
  struct eo_error error;
  if (eo_scalars_init(&scalars, "*", (int)eo_route_number(request, "cases"), (int)eo_route_number(request, "ends"),
                      &error)) {
    eo_reply_error(&request->reply, "", &error);
    return;
  }
  eo_reply_json(&request->reply, 200, eo_variant_columns_encode(&scalars));
  eo_scalars_done(&scalars);
}

enum { STUDY_BYTES = 8 << 20 }; /* with a table in it */

const struct eo_route eo_routes_studies[] = {
    {.method = EO_POST,
     .pattern = "/studies",
     .handle = add,
     .name = "addStudy",
     .summary =
         "Orders a study: any numbers of a design over lists, ranges or samples. Its job is listed with the others.",
     .takes = "StudyOrder",
     .order = &eo_study_order_table,
     .design_at = "design",
     .gives = "202 Job",
     .headers = "Idempotency-Key",
     .body = STUDY_BYTES,
     .rate = EO_RATE_START},
    {.method = EO_POST,
     .pattern = "/study-cost",
     .handle = tell_cost,
     .name = "getStudyCost",
     .summary = "What a study would take: variants, gear pairs, memory, time.",
     .takes = "StudyOrder",
     .order = &eo_study_order_table,
     .design_at = "design",
     .gives = "200 StudyCost",
     .body = STUDY_BYTES,
     .aside = true},
    {.method = EO_GET,
     .pattern = "/study-columns",
     .handle = list_columns,
     .name = "listStudyColumns",
     .summary = "The numbers of a result that a study can keep.",
     .gives = "200 StudyColumns",
     .query = {{"cases", 1, 64, 1, NULL, "load cases of the design"}, {"ends", 1, 2, 2, NULL, "of the pair"}}},
    {.method = EO_GET,
     .pattern = "/studies/{id}/table",
     .handle = get_table,
     .name = "getStudy",
     .summary = "The table of a study, also while it runs; as CSV all rows that fit.",
     .gives = "200 StudyTable",
     .csv = true,
     .aside = true,
     .query = {{"limit", 1, 100000, 100, NULL, "most rows"},
               {"cursor", 0, 1e7, 0, NULL, "`next` of the page before"},
               {"filter", 0, 0, 0, "", "rows that fit: objectives.J<0.4,outcome=converged"},
               {"sort", 0, 0, 0, "", "name of a key or a column, variant or outcome"},
               {"order", 0, 0, 0, "ascending|descending", "of the sort"},
               EO_UNITS_OF_CSV}},
    {.method = EO_GET,
     .pattern = "/studies/{id}/variants/{variant}/design",
     .handle = get_design,
     .name = "getStudyVariant",
     .summary = "The design of one variant, complete.",
     .gives = "200 ResolvedDesign",
     .aside = true},
    {0}};
