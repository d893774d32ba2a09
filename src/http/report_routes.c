/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is signed and sent: the report of a design, the bytes that `easeoff report` writes. */
#include <stdio.h>
#include <stdlib.h>

#include "http/deferred.h"
#include "http/http_private.h"
#include "http/route.h"
#include "http/service_reply.h"
#include "report/report.h"

/* Beside the design, which the service copies. */
struct order {
  struct eo_warnings warnings; /* of reading it */
  bool inches;
};

static enum eo_code make(void *data, const struct eo_pair *pair, const struct eo_design *design,
                         const struct eo_progress *progress, struct eo_text *text, struct eo_error *error)
{
  const struct order *order = data;
  const struct eo_page page = {text, order->inches};
  return eo_report_make(pair, design, &order->warnings, progress, &page, error);
}

static void put_report(struct eo_request *request, const struct eo_design *design, struct order *order)
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
  request->answer_type = "text/html; charset=utf-8";
  eo_request_defer(request);
  enum eo_code code = eo_service_compute(request->http->service, &question, &work, &admission, &job, &error);
  eo_reply_unless_accepted(request, code, admission, job, &error);
}

static void report(struct eo_request *request)
{
  struct eo_design design;
  struct eo_geometry geometry;
  const json_t *body = eo_request_json(request);
  struct order *order = body ? calloc(1, sizeof *order) : NULL;
  struct eo_error error;
  if (body && !order) {
    eo_error_memory(&error);
    eo_reply_error(&request->reply, "", &error);
  }
  if (!order)
    return;
  order->inches = request->reply.inches;
  if (eo_request_design(request, body, "", &design, &geometry, &order->warnings))
    put_report(request, &design, order);
  else
    free(order);
}

const struct eo_route eo_routes_report[] = {
    {.method = EO_POST,
     .pattern = "/report",
     .handle = report,
     .name = "reportDesign",
     .takes = "Design",
     .gives = "200 text/html, 202 Preparing",
     .headers = "Easeoff-Lane, Prefer",
     .query =
         {{"units", 0, 0, 0, "mm|inch",
           "inch: lengths in inches and, where they are in um else, in thousandths, in tables, figures and sentences"}},
     .rate = EO_RATE_START,
     .summary = "One HTML file a reviewer can check: inputs, standards, factors, figures, verdict, as `easeoff report` "
                "writes it. 202 while the gear pair is being prepared."},
    {0}};
