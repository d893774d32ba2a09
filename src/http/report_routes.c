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

static void report(struct eo_request *request)
{
  struct eo_design design;
  struct eo_geometry geometry;
  const json_t *body = eo_request_json(request);
  struct order *order = body ? eo_request_memory(request, sizeof *order) : NULL;
  if (!order)
    return;
  order->inches = request->reply.inches;
  if (!eo_request_design(request, body, "", &design, &geometry, &order->warnings)) {
    free(order);
    return;
  }
  request->answer_type = "text/html; charset=utf-8";
  eo_request_compute(request, &design, &(struct eo_work){.run = make, .release = free, .data = order});
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
