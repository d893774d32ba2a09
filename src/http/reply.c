/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/reply.h"

#include <stdarg.h>
#include <stdio.h>

#include <microhttpd.h>

#include "format/inch.h"
#include "format/json.h"
#include "http/log.h"
#include "http/problems.h"
#include "http/storage_watch.h"

void eo_reply_text(struct eo_reply *reply, unsigned status, const char *type, struct eo_text *text)
{
  struct eo_error error;
  if (text->failed) {
    eo_text_done(text);
    eo_error_memory(&error);
    eo_reply_error(reply, "", &error);
    return;
  }
  eo_text_done(&reply->body);
  reply->status = status;
  reply->type = type;
  reply->body = *text;
  *text = (struct eo_text){0};
}

static void reply_document(struct eo_reply *reply, unsigned status, const char *type, json_t *document)
{
  struct eo_text text = {0};
  if (reply->inches && document) {
    json_t *metric = document;
    document = eo_inch_from_mm(metric);
    json_decref(metric);
  }
  text.failed = !document;
  if (document)
    eo_json_write(&text, document, EO_JSON_COMPACT);
  eo_text_add(&text, "\n");
  json_decref(document);
  eo_reply_text(reply, status, type, &text);
}

void eo_reply_json(struct eo_reply *reply, unsigned status, json_t *document)
{
  reply_document(reply, status, "application/json", document);
}

void eo_reply_empty(struct eo_reply *reply, unsigned status)
{
  eo_text_done(&reply->body);
  reply->status = status;
  reply->type = NULL;
}

static const char *title_of(unsigned status)
{
  const char *phrase = MHD_get_reason_phrase_for(status);
  return phrase ? phrase : "Error";
}

/* Every pointer lies below the place of the document in the body. */
static json_t *encode_fault(const char *path, const struct eo_error *fault)
{
  char pointer[sizeof fault->pointer + 40];
  snprintf(pointer, sizeof pointer, "%s%s", path, fault->pointer);
  return json_pack("{s:s, s:s}", "pointer", pointer, "detail", fault->text);
}

static void put_problem_with(struct eo_reply *reply, unsigned status, const char *name, const char *detail,
                             json_t *errors, json_t *more)
{
  char type[80] = "about:blank";
  if (name && eo_problem_find(name)) /* each has a page */
    snprintf(type, sizeof type, "/problems/%s", name);
  json_t *problem = json_pack("{s:s, s:s, s:i, s:s, s:o, s:s}", "type", type, "title", title_of(status), "status",
                              (int)status, "detail", detail, "errors", errors ? errors : json_array(), "request_id",
                              reply->request);
  *reply->file_name = '\0';
  if (problem && more)
    json_object_update(problem, more);
  json_decref(more);
  if (problem) {
    reply_document(reply, status, "application/problem+json", problem);
    return;
  }
  eo_reply_empty(reply, 500);
}

static void put_problem(struct eo_reply *reply, unsigned status, const char *name, const char *detail, json_t *errors)
{
  put_problem_with(reply, status, name, detail, errors, NULL);
}

void eo_reply_problem_with(struct eo_reply *reply, unsigned status, const char *name, json_t *more, const char *detail)
{
  put_problem_with(reply, status, name, detail, NULL, more);
}

void eo_reply_problem(struct eo_reply *reply, unsigned status, const char *name, const char *format, ...)
{
  char detail[600];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(detail, sizeof detail, format, arguments);
  va_end(arguments);
  put_problem(reply, status, name, detail, NULL);
}

void eo_reply_faults(struct eo_reply *reply, const char *path, const struct eo_faults *faults)
{
  struct eo_error first;
  if (eo_faults_first(faults, &first) == EO_ERROR_MEMORY) {
    eo_reply_error(reply, "", &first);
    return;
  }
  char detail[80];
  json_t *errors = json_array();
  int kept = faults->count < EO_MAX_FAULTS ? faults->count : EO_MAX_FAULTS;
  for (int i = 0; i < kept; i++)
    json_array_append_new(errors, encode_fault(path, &faults->fault[i]));
  snprintf(detail, sizeof detail, faults->count == 1 ? "One value is wrong." : "%d values are wrong.", faults->count);
  put_problem(reply, 422, "invalid", detail, errors);
}

void eo_reply_error(struct eo_reply *reply, const char *path, const struct eo_error *error)
{
  if (error->code == EO_ERROR_FILE || error->code > EO_ERROR_CANCELLED)
    eo_storage_note(reply->storage, error);
  if (error->code == EO_ERROR_INPUT) {
    json_t *errors = json_array();
    json_array_append_new(errors, encode_fault(path, error));
    put_problem(reply, 422, "invalid", error->text, errors);
  } else if (error->code == EO_ERROR_MEMORY) {
    put_problem(reply, 503, NULL, "There is not enough memory at the moment.", NULL);
    reply->retry_after = 5;
  } else if (error->code == EO_ERROR_FULL) {
    eo_log_event(reply->log, EO_LOG_ERROR, "full", "%s: %s", reply->request, error->text);
    put_problem(reply, 507, "full",
                "The server's disk is full; what was saved before is kept, and what is deleted makes room.", NULL);
  } else if (error->code == EO_ERROR_BUSY) {
    eo_log_event(reply->log, EO_LOG_WARNING, "locked", "%s: %s", reply->request, error->text);
    put_problem(reply, 503, "locked", "Another program keeps the server's database locked.", NULL);
    reply->retry_after = 1;
  } else if (error->code == EO_ERROR_DAMAGED) {
    eo_log_event(reply->log, EO_LOG_ERROR, "damaged", "%s: %s", reply->request, error->text);
    put_problem(
        reply, 500, "damaged",
        "What is stored there is damaged and is not given out; `easeoff doctor` says what is lost and what can be "
        "computed again.",
        NULL);
  } else if (error->code == EO_ERROR_FILE) {
    /* it names files of this machine: not for the client */
    eo_log_event(reply->log, EO_LOG_ERROR, "storage", "%s: %s", reply->request, error->text);
    put_problem(reply, 500, "storage",
                "The server's data cannot be read or written; its log says more under the request's id.", NULL);
  } else
    put_problem(reply, 500, "failed", error->text, NULL);
}

void eo_reply_done(struct eo_reply *reply)
{
  eo_text_done(&reply->body);
  if (reply->stream)
    MHD_destroy_response(reply->stream);
  reply->stream = NULL;
}
