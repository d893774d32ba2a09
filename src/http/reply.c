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
  if (text->failed) {
    eo_text_done(text);
    eo_reply_no_memory(reply);
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

/* A problem document, as it is written. */
struct problem {
  char type[80];
  const char *title, *detail, *request;
  int status;
  struct eo_problem_more more;
};

static json_t *write_pointer(const void *source)
{
  const struct eo_problem_fault *fault = source;
  return json_sprintf("%s%s", fault->path, fault->pointer);
}

static const struct eo_outline_row fault_rows[] = {
    EO_KEY("pointer", "text", "to the key of the body that is to blame, or empty", .write = write_pointer),
    EO_KEY("detail", "text", "what is wrong with it, for people", EO_AT(struct eo_problem_fault, detail)),
};
static const struct eo_outline fault_outline = EO_OUTLINE("ProblemError", fault_rows);

#define OF_PROBLEM(member) EO_AT(struct problem, member)
#define OF_RECORDING .when = "of a recording without a result", EO_IF(struct problem, more.of_recording)
static const struct eo_outline_row problem_rows[] = {
    EO_KEY("type", "text", "which problem, /problems/NAME, or about:blank", OF_PROBLEM(type)),
    EO_KEY("title", "text", "of the status", OF_PROBLEM(title)),
    EO_KEY("status", "integer", "of the reply", OF_PROBLEM(status)),
    EO_KEY("detail", "text", "what is wrong, for people", OF_PROBLEM(detail)),
    EO_KEY("errors", "[object]", "every fault of the body", .outline = &fault_outline,
           EO_ROWS_AT(struct problem, more.fault, more.faults)),
    EO_KEY("request_id", "text", "under which the log has it", OF_PROBLEM(request)),
    EO_KEY("findings", "[object]", "of the recording", .name = "Finding", OF_PROBLEM(more.findings), OF_RECORDING),
    EO_KEY("notes", "[text]", "of reading it", OF_PROBLEM(more.notes), OF_RECORDING),
    EO_KEY("layout", "object?", "of its columns", .name = "Layout", OF_PROBLEM(more.layout), OF_RECORDING),
    EO_KEY("signal", "object", "its quality", .name = "Signal", OF_PROBLEM(more.signal), OF_RECORDING),
    EO_KEY("imported", "object", "what was found in the file", .when = "of an import", .name = "Import",
           OF_PROBLEM(more.imported), EO_IF(struct problem, more.of_import)),
};
const struct eo_outline eo_outline_problem = EO_OUTLINE("Problem", problem_rows);

void eo_reply_problem_with(struct eo_reply *reply, unsigned status, const char *name,
                           const struct eo_problem_more *more, const char *detail)
{
  struct problem problem = {.type = "about:blank",
                            .title = title_of(status),
                            .detail = detail,
                            .request = reply->request,
                            .status = (int)status,
                            .more = *more};
  if (name && eo_problem_find(name)) /* each has a page */
    snprintf(problem.type, sizeof problem.type, "/problems/%s", name);
  json_t *document = eo_outline_encode(&eo_outline_problem, &problem);
  *reply->file_name = *reply->notes = '\0';
  if (document)
    reply_document(reply, status, "application/problem+json", document);
  else
    eo_reply_empty(reply, 500);
}

static void put_problem(struct eo_reply *reply, unsigned status, const char *name, const char *detail)
{
  eo_reply_problem_with(reply, status, name, &(struct eo_problem_more){.faults = 0}, detail);
}

void eo_reply_problem(struct eo_reply *reply, unsigned status, const char *name, const char *format, ...)
{
  char detail[600];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(detail, sizeof detail, format, arguments);
  va_end(arguments);
  put_problem(reply, status, name, detail);
}

/* Every pointer lies below the place of the document in the body. */
static struct eo_problem_fault fault_of(const char *path, const struct eo_error *error)
{
  return (struct eo_problem_fault){path, error->pointer, error->text};
}

void eo_reply_faults(struct eo_reply *reply, const char *path, const struct eo_faults *faults)
{
  struct eo_error first;
  if (eo_faults_first(faults, &first) == EO_ERROR_MEMORY) {
    eo_reply_error(reply, "", &first);
    return;
  }
  char detail[80];
  struct eo_problem_fault kept[EO_MAX_FAULTS];
  int count = faults->count < EO_MAX_FAULTS ? faults->count : EO_MAX_FAULTS;
  for (int i = 0; i < count; i++)
    kept[i] = fault_of(path, &faults->fault[i]);
  snprintf(detail, sizeof detail, faults->count == 1 ? "One value is wrong." : "%d values are wrong.", faults->count);
  eo_reply_problem_with(reply, 422, "invalid", &(struct eo_problem_more){.faults = count, .fault = kept}, detail);
}

void eo_reply_error(struct eo_reply *reply, const char *path, const struct eo_error *error)
{
  if (error->code == EO_ERROR_FILE || error->code > EO_ERROR_CANCELLED)
    eo_storage_note(reply->storage, error);
  if (error->code == EO_ERROR_INPUT) {
    const struct eo_problem_fault fault = fault_of(path, error);
    eo_reply_problem_with(reply, 422, "invalid", &(struct eo_problem_more){.faults = 1, .fault = &fault}, error->text);
  } else if (error->code == EO_ERROR_MEMORY) {
    put_problem(reply, 503, NULL, "There is not enough memory at the moment.");
    reply->retry_after = 5;
  } else if (error->code == EO_ERROR_FULL) {
    eo_log_event(reply->log, EO_LOG_ERROR, "full", "%s: %s", reply->request, error->text);
    put_problem(reply, 507, "full",
                "The server's disk is full; what was saved before is kept, and what is deleted makes room.");
  } else if (error->code == EO_ERROR_BUSY) {
    eo_log_event(reply->log, EO_LOG_WARNING, "locked", "%s: %s", reply->request, error->text);
    put_problem(reply, 503, "locked", "Another program keeps the server's database locked.");
    reply->retry_after = 1;
  } else if (error->code == EO_ERROR_DAMAGED) {
    eo_log_event(reply->log, EO_LOG_ERROR, "damaged", "%s: %s", reply->request, error->text);
    put_problem(
        reply, 500, "damaged",
        "What is stored there is damaged and is not given out; `easeoff doctor` says what is lost and what can be "
        "computed again.");
  } else if (error->code == EO_ERROR_FILE) {
    /* it names files of this machine: not for the client */
    eo_log_event(reply->log, EO_LOG_ERROR, "storage", "%s: %s", reply->request, error->text);
    put_problem(reply, 500, "storage",
                "The server's data cannot be read or written; its log says more under the request's id.");
  } else
    put_problem(reply, 500, "failed", error->text);
}

void eo_reply_no_memory(struct eo_reply *reply)
{
  struct eo_error error;
  eo_error_memory(&error);
  eo_reply_error(reply, "", &error);
}

void eo_reply_done(struct eo_reply *reply)
{
  eo_text_done(&reply->body);
  if (reply->stream)
    MHD_destroy_response(reply->stream);
  reply->stream = NULL;
}
