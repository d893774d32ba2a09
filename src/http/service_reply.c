/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/deferred.h"
#include "http/answers.h"
#include "http/service_reply.h"

#include "http/job_reply.h"
#include "format/inch.h"
#include "format/json.h"
#include "http/route.h"
#include "http/http_private.h"

static void reply_busy(struct eo_request *request, bool closing)
{
  eo_reply_problem(&request->reply, 503, closing ? "stopping" : "busy",
                   closing ? "The server is stopping." : "Too many questions are waiting already.");
  request->reply.retry_after = closing ? 5 : 1;
}

/* The pair is being prepared: whose job it is, and where to ask. */
static void reply_preparing(struct eo_request *request, int64_t id)
{
  enum eo_job_outcome outcome;
  struct eo_error error;
  struct eo_job_view job;
  if (eo_service_job(request->http->service, id, false, &outcome, &job, &error)) {
    eo_reply_error(&request->reply, "", &error);
    return;
  }
  const struct eo_preparing preparing = {job.texts ? eo_job_view_encode(&job) : json_null()};
  eo_reply_json(&request->reply, 202, eo_outline_encode(&eo_outline_preparing, &preparing));
  eo_job_view_done(&job);
  eo_reply_job_location(&request->reply, id);
  request->reply.retry_after = 1;
}

/* On a thread of the service, which has the time. */
static void spell_in_inches(struct eo_text *text)
{
  struct eo_error error;
  json_t *metric = eo_json_parse(text->data, text->size, &error), *inches = metric ? eo_inch_from_mm(metric) : NULL;
  struct eo_text spelt = {.failed = !inches};
  if (inches)
    eo_json_write(&spelt, inches, EO_JSON_COMPACT);
  json_decref(metric);
  json_decref(inches);
  eo_text_done(text);
  *text = spelt;
}

static void take_answer(struct eo_request *request, struct eo_answer *answer)
{
  switch (answer->kind) {
  case EO_ANSWER_DONE:
    if (request->reply.inches && request->csv)
      eo_inch_table(&answer->text);
    else if (request->reply.inches && !request->answer_type) /* what is not JSON has been written so */
      spell_in_inches(&answer->text);
    eo_reply_text(&request->reply, 200,
                  request->answer_type ? request->answer_type
                  : request->csv       ? "text/csv; charset=utf-8"
                                       : "application/json",
                  &answer->text);
    break;
  case EO_ANSWER_OVERTAKEN:
    eo_reply_problem(&request->reply, 409, "overtaken", "A newer question of the same lane took this one's place.");
    break;
  case EO_ANSWER_FAILED:
    eo_reply_error(&request->reply, request->route->design_at ? request->route->design_at : "", &answer->error);
    break;
  case EO_ANSWER_PREPARING:
    reply_preparing(request, answer->job);
    break;
  case EO_ANSWER_STOPPED:
    reply_busy(request, true);
    break;
  }
}

/* Runs on a thread of the service. */
static void receive(void *context, struct eo_answer *answer)
{
  struct eo_request *request = context;
  take_answer(request, answer);
  eo_request_finish(request);
}

void eo_reply_unless_accepted(struct eo_request *request, enum eo_code code, enum eo_admission admission, int64_t job,
                              const struct eo_error *error)
{
  if (!code && admission == EO_ADMISSION_ACCEPTED)
    return;
  if (code)
    eo_reply_error(&request->reply, "", error);
  else if (admission == EO_ADMISSION_PREPARING)
    reply_preparing(request, job);
  else
    reply_busy(request, admission == EO_ADMISSION_CLOSED);
  eo_request_finish(request);
}

bool eo_request_lane(struct eo_request *request, struct eo_question *question)
{
  const char *token = eo_request_header(request, "Easeoff-Lane");
  question->token = token;
  if (!token || eo_field_is_visible(token, EO_TOKEN_LENGTH + 1))
    return true;
  eo_reply_problem(&request->reply, 400, NULL, "Easeoff-Lane takes 1 to %d visible characters.", EO_TOKEN_LENGTH);
  return false;
}

struct eo_question eo_request_to_question(struct eo_request *request, const struct eo_design *design,
                                          const struct eo_warnings *warnings)
{
  return (struct eo_question){.design = design,
                              .warnings = warnings,
                              .format = request->csv ? EO_ANSWER_CSV : EO_ANSWER_JSON,
                              .wait = eo_field_wait(eo_request_header(request, "Prefer")),
                              .answer = receive,
                              .context = request};
}

void eo_request_compute(struct eo_request *request, const struct eo_design *design, const struct eo_work *work)
{
  enum eo_admission admission;
  struct eo_error error;
  int64_t job = 0;
  struct eo_question question = eo_request_to_question(request, design, NULL);
  if (!eo_request_lane(request, &question)) {
    work->release(work->data);
    return;
  }
  eo_request_defer(request);
  enum eo_code code = eo_service_compute(request->http->service, &question, work, &admission, &job, &error);
  eo_reply_unless_accepted(request, code, admission, job, &error);
}
