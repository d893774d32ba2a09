/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Many pairs as they are made: the answer that `easeoff tolerance --json` prints. */
#include <stdlib.h>

#include "document/tolerance_document.h"
#include "http/deferred.h"
#include "http/http_private.h"
#include "http/request_body.h"
#include "http/route.h"
#include "http/service_reply.h"

enum { MOST_PAIRS = 5000 }; /* in one answer; the terminal takes more */

/* Beside the design, which the service copies. */
struct order {
  struct eo_warnings warnings; /* of reading it */
  bool csv, assumed;
  struct eo_scatter scatter;
};

static enum eo_code write_report(const struct order *order, const struct eo_design *design,
                                 const struct eo_scatter_run *run, struct eo_text *text, struct eo_error *error)
{
  struct eo_tolerance_report *report = NULL;
  EO_TRY(eo_tolerance_report_new(&report, design, &order->scatter, run, order->assumed, error));
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
    code = write_report(order, design, &run, text, error);
  eo_scatter_run_done(&run);
  return code;
}

static void put_tolerance(struct eo_request *request, const struct eo_design *design, struct order *order)
{
  enum eo_admission admission;
  struct eo_error error;
  int64_t job = 0;
  const struct eo_work work = {.run = make, .release = free, .data = order};
  struct eo_question question = eo_request_to_question(request, design, NULL);
  if (!eo_request_lane(request, &question)) {
    free(order);
    return;
  }
  order->csv = question.format == EO_ANSWER_CSV;
  eo_request_defer(request);
  enum eo_code code = eo_service_compute(request->http->service, &question, &work, &admission, &job, &error);
  eo_reply_unless_accepted(request, code, admission, job, &error);
}

struct tolerance_order {
  const json_t *design;
  int pairs; /* 0: as the design says */
};
static const struct eo_field fields[] = {
    EO_DOCUMENT(struct tolerance_order, design, "design", "Design", EO_FIELD_REQUIRED,
                "with its block tolerance; without one class 5 of ISO 1328-1:2013 is taken"),
    {.key = "pairs",
     .kind = EO_FIELD_INTEGER,
     .flags = EO_FIELD_NULLABLE,
     .offset = offsetof(struct tolerance_order, pairs),
     .low = 1,
     .high = MOST_PAIRS,
     .fallback = NAN,
     .derived = "as the block says",
     .help = "how many; the first ones are the same for any number, but of Latin points"},
};
static const struct eo_table order_table = EO_TABLE("a tolerance analysis", struct tolerance_order, fields);

/* What the block asks for, as far as it can be told before anything is computed. */
static bool settle(struct eo_request *request, struct eo_design *design, int pairs, struct order *order)
{
  struct eo_error error;
  if (pairs)
    design->tolerance.pairs = pairs;
  enum eo_code code = eo_scatter_of_design(&order->scatter, design, true, &order->assumed, &error);
  if (!code && design->tolerance.pairs > MOST_PAIRS)
    code = eo_error_set(&error, EO_ERROR_INPUT, "/tolerance/pairs",
                        "%d pairs are more than the %d that one answer has here: state fewer, or use the terminal.",
                        design->tolerance.pairs, MOST_PAIRS);
  if (code)
    eo_reply_error(&request->reply, "/design", &error);
  return code == EO_OK;
}

static void tolerance(struct eo_request *request)
{
  struct tolerance_order asked;
  struct eo_design design;
  struct eo_geometry geometry;
  if (!eo_body_read(request, &asked))
    return;
  struct order *order = calloc(1, sizeof *order);
  if (!order) {
    struct eo_error error;
    eo_error_memory(&error);
    eo_reply_error(&request->reply, "", &error);
    return;
  }
  if (eo_request_design(request, asked.design, "/design", &design, &geometry, &order->warnings) &&
      settle(request, &design, asked.pairs, order))
    put_tolerance(request, &design, order);
  else
    free(order);
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
     .headers = "Easeoff-Lane, Prefer",
     .rate = EO_RATE_START,
     .csv = true,
     .summary = "Many pairs of a design as they are made: percentiles, what decides, yield, the worst pair. A newer "
                "request of the same lane ends it. 202 while the gear pair is being prepared."},
    {0}};
