/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Job events as Server-Sent Events. */
#include "http/route.h"
#include "http/http_private.h"
#include "http/stream.h"

/* The number of the last event that was seen; 0: none. */
static int64_t last_seen(const struct eo_request *request)
{
  const char *header = eo_request_header(request, "Last-Event-ID");
  int64_t number;
  return header && eo_field_integer(header, &number) && number > 0 ? number : 0;
}

static void get_all(struct eo_request *request)
{
  eo_stream_open(request, 0, last_seen(request));
}

static void get_of_job(struct eo_request *request)
{
  enum eo_job_outcome outcome;
  struct eo_error error;
  struct eo_job_view job;
  int64_t id;
  if (!eo_request_id_at(request, 0, &id))
    return;
  if (eo_service_job(request->http->service, id, false, &outcome, &job, &error))
    eo_reply_error(&request->reply, "", &error);
  else if (outcome == EO_JOB_OUTCOME_MISSING)
    eo_reply_problem(&request->reply, 404, NULL, "There is no job with this number.");
  else
    eo_stream_open(request, id, last_seen(request));
  eo_job_view_done(&job);
}

#define STREAM \
  "`event: job` with the job (without its design) as data whenever one changes, a comment every ten seconds."
#define STATE_FIRST " Without Last-Event-ID the first event is the job as it is."
const struct eo_route eo_routes_events[] = {{.method = EO_GET,
                                             .pattern = "/events",
                                             .handle = get_all,
                                             .name = "getEvents",
                                             .summary = "All jobs: " STREAM,
                                             .gives = "200 text/event-stream",
                                             .headers = "Last-Event-ID"},
                                            {.method = EO_GET,
                                             .pattern = "/jobs/{id}/events",
                                             .handle = get_of_job,
                                             .name = "getJobEvents",
                                             .summary = "One job: " STREAM STATE_FIRST,
                                             .gives = "200 text/event-stream",
                                             .headers = "Last-Event-ID"},
                                            {0}};
