/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the server says about itself. */
#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "http/answers.h"
#include "base/clock.h"
#include "http/background.h"
#include "http/documents.h"
#include "http/log.h"
#include "http/route.h"
#include "http/http_private.h"
#include "http/storage_watch.h"
#include "http/upload.h"

#include <config.h>

static json_t *encode_warnings(const struct eo_http *http, const struct eo_storage *storage)
{
  json_t *warnings = json_array();
  const char *notice = eo_http_notice(http);
  if (*notice)
    json_array_append_new(warnings, json_string(notice));
  if (*storage->damage) /* the sentence names files of this machine */
    json_array_append_new(warnings,
                          json_string("Stored data are damaged and not given out; `easeoff doctor` says what is "
                                      "lost and what can be computed again."));
  return warnings;
}

static struct eo_health health_of(const struct eo_http *http)
{
  return (struct eo_health){.program = PACKAGE_STRING,
                            .uptime = (double)(long)(eo_clock_milliseconds() - http->started) / 1e3};
}

/* Whether what is sent now can be worked on and kept. */
static void get_health(struct eo_request *request)
{
  struct eo_http *http = request->http;
  struct eo_service_status status;
  struct eo_error error;
  struct eo_storage storage = eo_storage_now(http->storage);
  bool good = eo_service_status(http->service, &status, &error) == EO_OK && status.database;
  if (!good)
    memset(&status, 0, sizeof status);
  if (!good && storage.state == EO_STORAGE_OK)
    storage.state = error.code == EO_ERROR_DAMAGED ? EO_STORAGE_DAMAGED : EO_STORAGE_FAILING;
  good = storage.state == EO_STORAGE_OK;
  struct eo_health health = health_of(http);
  health.failing = !good;
  health.jobs.queued = status.jobs[EO_JOB_QUEUED];
  health.jobs.running = status.jobs[EO_JOB_PREPARING] + status.jobs[EO_JOB_RUNNING];
  health.database = storage.state;
  health.free_megabytes = round((double)storage.free_bytes / 1e6);
  health.warnings = encode_warnings(http, &storage);
  eo_reply_json(&request->reply, good ? 200 : 503, eo_outline_encode(&eo_outline_health, &health));
}

/* That this thread answers is all that is asked. */
static void get_live(struct eo_request *request)
{
  const struct eo_health health = health_of(request->http);
  eo_reply_json(&request->reply, 200, eo_outline_encode(&eo_outline_live, &health));
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

/* Resident memory, bytes. */
static double find_memory(void)
{
  unsigned long long all = 0, resident = 0;
  FILE *file = fopen("/proc/self/statm", "re");
  if (file && fscanf(file, "%llu %llu", &all, &resident) != 2)
    resident = 0;
  if (file)
    fclose(file);
  return (double)resident * (double)sysconf(_SC_PAGESIZE);
}

static int count_descriptors(void)
{
  DIR *folder = opendir("/proc/self/fd");
  int count = -3; /* the folder itself and its two names of folders */
  while (folder && readdir(folder))
    count++;
  if (folder)
    closedir(folder);
  return count > 0 ? count : 0;
}

static void put_storage(struct eo_text *text, const struct eo_storage *storage)
{
  describe(text, "storage_state", "gauge", "1 for what the storage is now.");
  for (int i = 0; eo_storage_states[i]; i++)
    eo_text_print(text, "easeoff_storage_state{state=\"%s\"} %d\n", eo_storage_states[i], (int)storage->state == i);
  describe(text, "storage_failures_total", "counter", "Requests that failed, by what was wrong with the storage.");
  for (int i = 1; eo_storage_states[i]; i++)
    eo_text_print(text, "easeoff_storage_failures_total{state=\"%s\"} %lld\n", eo_storage_states[i],
                  (long long)storage->failures[i]);
  put(text, "disk_free_bytes", "gauge", "Of the data folder's disk.", (double)storage->free_bytes);
  put(text, "database_bytes", "gauge", "Size of the database.", (double)storage->database_bytes);
  put(text, "journal_bytes", "gauge", "Size of its journal.", (double)storage->journal_bytes);
}

static void put_process(struct eo_text *text, struct eo_http *http)
{
  put(text, "resident_memory_bytes", "gauge", "Of this process.", find_memory());
  put(text, "open_descriptors", "gauge", "Of this process.", count_descriptors());
  put(text, "log_lines_dropped_total", "counter", "Lines that nobody read in time.", (double)eo_log_dropped(http->log));
  put(text, "uploads", "gauge", "Uploads on their way.", eo_uploads_count(http));
  put(text, "readings_waiting", "gauge", "Recordings that wait to be read.", eo_background_waiting(http->readings));
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
  put(&text, "cached_pairs_bytes", "gauge", "Prepared gear pairs on disk.", (double)status.cache_bytes);
  const struct eo_storage storage = eo_storage_now(http->storage);
  put_storage(&text, &storage);
  put_process(&text, http);
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
     .summary = "Whether the server can work and keep what it is sent (readiness); 503 when not: the disk is full, the "
                "database locked or damaged.",
     .gives = "200 Health, 503 Health"},
    {.method = EO_GET,
     .pattern = "/health/ready",
     .handle = get_health,
     .name = "getReady",
     .open = true,
     .summary = "The same.",
     .gives = "200 Health, 503 Health"},
    {.method = EO_GET,
     .pattern = "/health/live",
     .handle = get_live,
     .name = "getLive",
     .open = true,
     .summary = "Whether the server answers at all (liveness).",
     .gives = "200 Live"},
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
