/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Many pairs as they are made: the answer that `easeoff tolerance --json` prints. */
#include <stdlib.h>
#include <string.h>

#include "document/tolerance_document.h"
#include "http/deferred.h"
#include "http/http_private.h"
#include "http/job_reply.h"
#include "http/request_body.h"
#include "http/route.h"
#include "http/service_reply.h"
#include "study/tolerance_job.h"

enum { MOST_PAIRS = 5000, MOST_WITH_TEETH = 64 }; /* in one answer; a job takes more */

/* Beside the design, which the service copies. */
struct order {
  struct eo_warnings warnings; /* of reading it */
  bool csv, assumed;
  struct eo_scatter scatter;
};

static enum eo_code write_report(const struct order *order, const struct eo_design *design,
                                 const struct eo_scatter_run *run, const struct eo_progress *progress,
                                 struct eo_text *text, struct eo_error *error)
{
  struct eo_tolerance_report *report = NULL;
  EO_TRY(eo_tolerance_report_new(&report, design, &order->scatter, run, order->assumed, progress, error));
  if (order->csv)
    eo_tolerance_csv(report, text);
  else
    eo_tolerance_write(report, &order->warnings, text);
  eo_tolerance_report_free(report);
  return EO_OK;
}

static enum eo_code make(void *data, const struct eo_pair *pair, const struct eo_design *design,
                         const struct eo_progress *progress, struct eo_text *text, struct eo_error *error)
{
  struct order *order = data;
  struct eo_scatter_plan plan = eo_tolerance_plan(&design->tolerance);
  struct eo_scatter_run run = {0};
  enum eo_code code = eo_scatter_run_pairs(&run, pair, design, &order->scatter, &plan, progress, error);
  if (!code)
    code = write_report(order, design, &run, progress, text, error);
  eo_scatter_run_done(&run);
  return code;
}

struct tolerance_order {
  const json_t *design;
  int pairs; /* 0: as the design says */
};
static const struct eo_field fields[] = {
    EO_DOCUMENT(struct tolerance_order, design, "design", "Design", EO_FIELD_REQUIRED,
                "with its block tolerance; without one class 5 of ISO 1328-1:2013 is taken"),
    EO_INTEGER_DERIVED(struct tolerance_order, pairs, "pairs", 1, EO_SCATTER_MOST_PAIRS, "as the block says",
                       "how many, at most 5000 (with single teeth 64) unless it is a job; the first ones are the same "
                       "for any number, but of Latin points"),
};
static const struct eo_table order_table = EO_TABLE("a tolerance analysis", struct tolerance_order, fields);

/* What the block asks for, as far as it can be told before anything is computed. */
static bool settle(struct eo_request *request, struct eo_design *design, int pairs, bool later, struct order *order)
{
  struct eo_error error;
  if (pairs)
    design->tolerance.pairs = pairs;
  enum eo_code code = eo_scatter_of_design(&order->scatter, design, true, &order->assumed, &error);
  int most = design->tolerance.single_teeth ? MOST_WITH_TEETH : MOST_PAIRS;
  if (!code && !later && design->tolerance.pairs > most)
    code = eo_error_set(&error, EO_ERROR_INPUT, "/tolerance/pairs",
                        "%d pairs are more than the %d that one answer has here: state fewer, or order a job by "
                        "Prefer: respond-async.",
                        design->tolerance.pairs, most);
  if (!code)
    code = eo_service_admit_pairs(request->http->service, design, &error);
  if (code)
    eo_reply_error(&request->reply, "/design", &error);
  return code == EO_OK;
}

static void order_job(struct eo_request *request, const struct eo_design *design)
{
  struct eo_job_order wanted = {.kind = EO_JOB_TOLERANCE, .design = design};
  eo_request_order_job(request, &wanted, true);
}

static void tolerance(struct eo_request *request)
{
  struct tolerance_order asked;
  struct eo_design design;
  struct eo_geometry geometry;
  bool later = eo_field_is_async(eo_request_header(request, "Prefer"));
  if (!eo_body_read(request, &asked))
    return;
  struct order *order = eo_request_memory(request, sizeof *order);
  if (!order)
    return;
  order->csv = request->csv;
  bool good = eo_request_design(request, asked.design, "/design", &design, &geometry, &order->warnings) &&
              settle(request, &design, asked.pairs, later, order);
  if (good && !later)
    eo_request_compute(request, &design, &(struct eo_work){.run = make, .release = free, .data = order});
  else
    free(order);
  if (good && later)
    order_job(request, &design);
}

/* The design of a tolerance job that has a result, done or stopped; false: the reply says what is in the way. */
static bool find_result(struct eo_request *request, int64_t id, struct eo_design *design, bool *whole)
{
  enum eo_job_outcome outcome = EO_JOB_OUTCOME_DONE;
  struct eo_error error;
  struct eo_geometry geometry;
  struct eo_job_view job = {0};
  enum eo_code code = eo_service_job(request->http->service, id, true, &outcome, &job, &error);
  bool there = !code && outcome == EO_JOB_OUTCOME_DONE && job.row.kind == EO_JOB_TOLERANCE;
  *whole = there && job.row.state == EO_JOB_DONE;
  bool ended = *whole || (there && job.row.state == EO_JOB_CANCELLED && *job.row.result);
  if (ended)
    code = eo_design_read(job.row.design, strlen(job.row.design), design, &geometry, NULL, &error);
  if (code)
    eo_reply_error(&request->reply, "", &error);
  else if (!there)
    eo_reply_problem(&request->reply, 404, NULL, "There is no tolerance analysis with this number.");
  else if (!ended)
    eo_reply_no_result(&request->reply, &job);
  eo_job_view_done(&job);
  return ended && !code;
}

static void get_pairs(struct eo_request *request)
{
  struct eo_design *design = malloc(sizeof *design);
  struct eo_error error;
  struct eo_text text = {0};
  int64_t id;
  bool whole;
  if (!design)
    eo_reply_no_memory(&request->reply);
  else if (eo_request_id_at(request, 0, &id) && find_result(request, id, design, &whole)) {
    if (eo_tolerance_job_csv(request->store, id, whole, design, &text, &error))
      eo_reply_error(&request->reply, "", &error);
    else
      eo_reply_table(request, &text);
  }
  eo_text_done(&text);
  free(design);
}

const struct eo_route eo_routes_tolerance[] = {
    {.method = EO_POST,
     .pattern = "/tolerance",
     .handle = tolerance,
     .name = "tolerance",
     .takes = "ToleranceRequest",
     .order = &order_table,
     .design_at = "/design",
     .gives = "200 Tolerance, 202 Preparing",
     .headers = "Easeoff-Lane, Prefer, Idempotency-Key",
     .rate = EO_RATE_START,
     .csv = true,
     .query = {EO_UNITS_OF_CSV},
     .summary = "Many pairs of a design as they are made: percentiles, what decides, yield, the worst pair. A newer "
                "request of the same lane ends it. 202 while the gear pair is being prepared, or, with Prefer: "
                "respond-async, for a job of its own that goes on whatever happens: its result is the same document."},
    {.method = EO_GET,
     .pattern = "/jobs/{id}/pairs",
     .handle = get_pairs,
     .name = "getJobPairs",
     .gives = "200 text/csv",
     .aside = true,
     .query = {EO_UNITS_QUERY},
     .summary = "The pairs of a tolerance analysis that is done, or was stopped with a result, as CSV, a line for each "
                "that was "
                "computed in full: `easeoff tolerance --csv`. 409 while it is neither."},
    {0}};
