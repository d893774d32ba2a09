/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the server says about itself. */
#include <stdio.h>
#include <string.h>

#include "base/clock.h"
#include "http/documents.h"
#include "http/route.h"
#include "http/http_private.h"

#include <config.h>

static void get_health(struct eo_request *request)
{
  struct eo_service_status status;
  struct eo_error error;
  bool good = eo_service_status(request->http->service, &status, &error) == EO_OK && status.database;
  if (!good)
    memset(&status, 0, sizeof status);
  const char *notice = eo_http_notice(request->http);
  json_t *warnings = json_array();
  if (*notice)
    json_array_append_new(warnings, json_string(notice));
  json_t *health = json_pack("{s:s, s:s, s:f, s:{s:I, s:I}, s:s, s:o}", "status", good ? "ok" : "failing", "program",
                             PACKAGE_STRING, "uptime_s",
                             (double)(long)(eo_clock_milliseconds() - request->http->started) / 1e3, "jobs", "queued",
                             (json_int_t)status.jobs[EO_JOB_QUEUED], "running",
                             (json_int_t)status.jobs[EO_JOB_PREPARING] + status.jobs[EO_JOB_RUNNING], "database",
                             good ? "ok" : "failing", "warnings", warnings);
  eo_reply_json(&request->reply, good ? 200 : 503, health);
}

static void describe(struct eo_text *text, const char *name, const char *type, const char *help)
{
  eo_text_print(text, "# HELP easeoff_%s %s\n# TYPE easeoff_%s %s\n", name, help, name, type);
}

static void put(struct eo_text *text, const char *name, const char *type, const char *help, double value)
{
  describe(text, name, type, help);
  eo_text_print(text, "easeoff_%s %.15g\n", name, value);
}

static void put_replies(struct eo_text *text, const struct eo_http *http)
{
  describe(text, "http_replies_total", "counter", "Replies by hundreds of the status.");
  for (int i = 2; i < 6; i++)
    eo_text_print(text, "easeoff_http_replies_total{status=\"%dxx\"} %llu\n", i, (unsigned long long)http->replies[i]);
}

static void put_jobs(struct eo_text *text, const struct eo_service_status *status)
{
  describe(text, "jobs", "gauge", "Jobs by state.");
  for (int i = 0; i < EO_JOB_STATES; i++)
    eo_text_print(text, "easeoff_jobs{state=\"%s\"} %lld\n", eo_store_job_state_name((enum eo_job_state)i),
                  (long long)status->jobs[i]);
}

static void put_analyses(struct eo_text *text, const struct eo_service_status *status)
{
  static const char *const bound[] = {"0.005", "0.01", "0.015", "0.02", "0.025", "0.05",
                                      "0.1",   "0.25", "0.5",   "1",    "5",     "+Inf"};
  describe(text, "analysis_seconds", "histogram", "What-if analyses from question to answer.");
  for (int i = 0; i < 12; i++)
    eo_text_print(text, "easeoff_analysis_seconds_bucket{le=\"%s\"} %lld\n", bound[i],
                  (long long)status->analysis_ms_bucket[i]);
  eo_text_print(text, "easeoff_analysis_seconds_sum %.9g\neaseoff_analysis_seconds_count %lld\n",
                1e-3 * status->analysis_ms_total, (long long)status->analyses);
}

static void get_metrics(struct eo_request *request)
{
  struct eo_http *http = request->http;
  struct eo_service_status status;
  struct eo_error error;
  struct eo_text text = {0};
  if (eo_service_status(http->service, &status, &error)) {
    eo_reply_error(&request->reply, "", &error);
    return;
  }
  pthread_mutex_lock(&http->lock);
  int connections = http->connection_count, streams = http->stream_count;
  pthread_mutex_unlock(&http->lock);
  put(&text, "uptime_seconds", "gauge", "Since the start.", 1e-3 * (eo_clock_milliseconds() - http->started));
  put(&text, "http_connections", "gauge", "Open connections.", connections);
  put(&text, "http_streams", "gauge", "Open event streams.", streams);
  put(&text, "http_requests_total", "counter", "Requests since the start.", (double)http->requests);
  put_replies(&text, http);
  put_jobs(&text, &status);
  put_analyses(&text, &status);
  put(&text, "analyses_overtaken_total", "counter", "Analyses that a newer one made needless.",
      (double)status.overtaken);
  put(&text, "sweeps_total", "counter", "Sweeps answered.", (double)status.sweeps);
  put(&text, "refused_total", "counter", "Questions and jobs refused because too many waited.", (double)status.refused);
  put(&text, "pairs_prepared", "gauge", "Gear pairs kept in memory.", status.pairs);
  put(&text, "true_evaluations_total", "counter", "Evaluations by the model in jobs.", (double)status.true_evaluations);
  put(&text, "reused_evaluations_total", "counter", "Evaluations that the history knew.",
      (double)status.reused_evaluations);
  put(&text, "events_total", "counter", "Events published.", (double)status.events);
  eo_reply_text(&request->reply, 200, "text/plain; version=0.0.4; charset=utf-8", &text);
}

static void get_openapi(struct eo_request *request)
{
  eo_request_resource(request, &request->http->documents->openapi);
}

static void get_schema(struct eo_request *request)
{
  eo_request_resource(request, &request->http->documents->schema);
}

const struct eo_route eo_routes_service[] = {
    {.method = EO_GET,
     .pattern = "/health",
     .handle = get_health,
     .name = "getHealth",
     .open = true,
     .summary = "Whether the server works; 503 when its database does not.",
     .gives = "200 Health, 503 Health"},
    {.method = EO_GET,
     .pattern = "/metrics",
     .handle = get_metrics,
     .name = "getMetrics",
     .summary = "Counters in the text format of Prometheus.",
     .gives = "200 text/plain"},
    {.method = EO_GET,
     .pattern = "/openapi.json",
     .handle = get_openapi,
     .name = "getOpenapi",
     .open = true,
     .summary = "This description.",
     .gives = "200 Description",
     .headers = "If-None-Match"},
    {.method = EO_GET,
     .pattern = "/schema",
     .handle = get_schema,
     .name = "getSchema",
     .gives = "200 Form",
     .headers = "If-None-Match",
     .summary = "The fields of a design with units, ranges, defaults and help: what a form is built from."},
    {0}};
