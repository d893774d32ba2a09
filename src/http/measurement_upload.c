/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is uploaded is read and measured on a thread of its own, and kept only when that gave a result. */
#include "http/measurement_upload.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "format/json.h"
#include "http/request_body.h"
#include "http/stored_design.h"
#include "http/stored_measurement.h"
#include "http/route.h"
#include "http/http_private.h"
#include "http/upload.h"
#include "document/measure_order.h"
#include "service/rig_tasks.h"

/* What the form said, and the design that it names. */
struct asked {
  struct eo_measure_order order;
  struct eo_design parsed;
  struct eo_geometry geometry;
};

static bool is_unmodified(const struct asked *asked)
{
  return asked->order.label == EO_MEASURE_UNMODIFIED;
}

static bool find_design(struct eo_request *request, struct asked *asked)
{
  bool missing = false;
  struct eo_error error;
  if (eo_request_stored_design(request, (int64_t)asked->order.design, &asked->parsed, &asked->geometry, NULL, &missing))
    return true;
  if (missing) {
    eo_error_set(&error, EO_ERROR_INPUT, "/design", "There is no design with this number.");
    eo_reply_error(&request->reply, "", &error);
  }
  return false;
}

static enum eo_code hash_files(struct eo_upload *upload, struct eo_error *error)
{
  char path[EO_UPLOAD_PATH];
  enum eo_code code = EO_OK;
  for (int i = 0; i < upload->files && !code; i++) {
    eo_upload_path(upload, i, path);
    code = eo_measurement_file_hash(path, upload->file[i].sha256, error);
  }
  return code;
}

/* Everything that decides what comes out. */
static void write_request_digest(const struct asked *asked, const struct eo_upload *upload, const char *pair,
                                 char digest[EO_HASH_LENGTH + 1])
{
  const struct eo_measure_order *order = &asked->order;
  struct eo_hash hash;
  struct eo_text layout = {0};
  if (order->layout)
    eo_json_write(&layout, order->layout, EO_JSON_CANONICAL);
  eo_hash_init(&hash);
  eo_hash_add_number(&hash, "design", (double)order->design);
  eo_hash_add_number(&hash, "unmodified", is_unmodified(asked));
  eo_hash_add_number(&hash, "end", order->end);
  eo_hash_add_number(&hash, "harmonics", order->harmonics);
  eo_hash_add_number(&hash, "torque", order->torque);
  eo_hash_add_number(&hash, "speed", order->speed);
  /* what was stored before has none of these */
  if (order->part || order->run_up || order->from > 0 || order->to > 0) {
    eo_hash_add_number(&hash, "part", order->part);
    eo_hash_add_number(&hash, "whole", order->run_up);
    eo_hash_add_number(&hash, "from", order->from);
    eo_hash_add_number(&hash, "to", order->to);
  }
  eo_hash_add_text(&hash, "layout", layout.data ? layout.data : "");
  eo_hash_add_text(&hash, "pair", pair);
  for (int i = 0; i < upload->files; i++)
    eo_hash_add_text(&hash, "file", upload->file[i].sha256);
  eo_hash_finish(&hash, digest);
  eo_text_done(&layout);
}

static int watch(void *context, const char *what, double fraction)
{
  struct eo_http *http = context;
  (void)what;
  (void)fraction;
  pthread_mutex_lock(&http->lock);
  bool closing = http->closing;
  pthread_mutex_unlock(&http->lock);
  return closing;
}

/* torque: as stated, or as the recording has it. */
static enum eo_code measure(struct eo_request *request, const struct asked *asked, json_t **document, double *torque,
                            struct eo_error *error)
{
  const struct eo_upload *upload = request->upload;
  char path[EO_MEASUREMENT_FILES][EO_UPLOAD_PATH];
  const struct eo_progress progress = {watch, request->http};
  for (int i = 0; i < upload->files; i++)
    eo_upload_path(upload, i, path[i]);
  struct eo_measure_request work = {.path = path[0],
                                    .gear_path = upload->files > 1 ? path[1] : NULL,
                                    .name = upload->file[0].name,
                                    .geometry = &asked->geometry,
                                    .spool_directory = upload->folder,
                                    .seconds = request->http->settings.limits.reading_seconds};
  eo_measure_order_take(&asked->order, &asked->parsed, &work);
  struct eo_measured *outcome = calloc(1, sizeof *outcome);
  if (!outcome)
    return eo_error_memory(error);
  enum eo_code code = eo_measure_file(&work, &progress, document, NULL, outcome, error);
  *torque = outcome->torque;
  free(outcome);
  return code;
}

static void reply_refused(struct eo_request *request, const json_t *document)
{
  const struct eo_problem_more more = {.of_recording = true,
                                       .findings = json_incref(json_object_get(document, "findings")),
                                       .notes = json_incref(json_object_get(document, "notes")),
                                       .layout = json_incref(json_object_get(document, "layout")),
                                       .signal = json_incref(json_object_get(document, "signal"))};
  const char *detail = "The recording has no result; its findings say why.";
  json_t *finding;
  size_t i;
  json_array_foreach(more.findings, i,
                     finding) if (strcmp(json_string_value(json_object_get(finding, "severity")), "refused") == 0)
  {
    detail = json_string_value(json_object_get(finding, "text"));
    break;
  }
  eo_reply_problem_with(&request->reply, 422, "refused", &more, detail);
}

static void reply_stored(struct eo_request *request, unsigned status, struct eo_found_measurement *found)
{
  eo_reply_text(&request->reply, status, "application/json", &found->text);
  snprintf(request->reply.tag, sizeof request->reply.tag, "%s", found->tag);
  snprintf(request->reply.location, sizeof request->reply.location, EO_API "/measurements/%lld", (long long)found->id);
}

static char *dump(const json_t *document)
{
  struct eo_text text = {0};
  eo_json_write(&text, document, EO_JSON_COMPACT);
  return text.failed ? (eo_text_done(&text), NULL) : text.data;
}

static enum eo_code keep(struct eo_request *request, const struct asked *asked, double torque, const char *pair,
                         const char *digest, const json_t *document, struct eo_found_measurement *found,
                         enum eo_measurement_outcome *outcome, struct eo_error *error)
{
  const struct eo_upload *upload = request->upload;
  json_t *summary = eo_outline_take(&eo_measurement_brief, document);
  char *texts[3] = {dump(document), summary ? dump(summary) : NULL,
                    asked->order.layout ? dump(asked->order.layout) : strdup("")};
  struct eo_stored_measurement row = {.design = (int64_t)asked->order.design,
                                      .digest = digest,
                                      .unmodified = is_unmodified(asked),
                                      .torque = torque,
                                      .speed = asked->order.speed,
                                      .layout = texts[2],
                                      .pair = pair,
                                      .summary = texts[1],
                                      .result = texts[0],
                                      .files = upload->files};
  memcpy(row.file, upload->file, sizeof row.file);
  enum eo_code code = texts[0] && texts[1] && texts[2]
                          ? eo_store_add_measurement(request->store, &row, upload->folder, eo_measurement_take, found,
                                                     outcome, error)
                          : eo_error_memory(error);
  for (int i = 0; i < 3; i++)
    free(texts[i]);
  json_decref(summary);
  return code;
}

static void reply_unmeasured(struct eo_request *request, enum eo_code code, const struct eo_error *error)
{
  if (code != EO_ERROR_CANCELLED) {
    eo_reply_error(&request->reply, "", error);
    return;
  }
  eo_reply_problem(&request->reply, 503, "stopping", "The server is stopping.");
  request->reply.retry_after = 5;
}

static void measure_and_keep(struct eo_request *request, const struct asked *asked, const char *pair,
                             const char *digest)
{
  struct eo_found_measurement found = {0};
  struct eo_error error;
  enum eo_measurement_outcome outcome;
  json_t *document = NULL;
  double torque = NAN;
  enum eo_code code = measure(request, asked, &document, &torque, &error);
  if (code)
    reply_unmeasured(request, code, &error);
  else if (json_is_true(json_object_get(document, "refused")))
    reply_refused(request, document);
  else if (!(torque > 0)) {
    eo_error_set(&error, EO_ERROR_INPUT, "/torque_Nm",
                 "No column of the recording holds a torque; state that of the pinion.");
    eo_reply_error(&request->reply, "", &error);
  } else if (keep(request, asked, torque, pair, digest, document, &found, &outcome, &error))
    eo_reply_error(&request->reply, "", &error);
  else if (outcome == EO_MEASUREMENT_NO_DESIGN)
    eo_reply_problem(&request->reply, 409, NULL, "The design was removed meanwhile.");
  else
    reply_stored(request, outcome == EO_MEASUREMENT_KNOWN ? 200 : 201, &found);
  eo_text_done(&found.text);
  json_decref(document);
}

/* The same files with the same words are the same measurement: a client that heard no answer sends them again. */
static void answer_upload(struct eo_request *request, struct asked *asked)
{
  struct eo_found_measurement found = {0};
  struct eo_error error;
  enum eo_measurement_outcome outcome = EO_MEASUREMENT_MISSING;
  char pair[EO_HASH_LENGTH + 1], digest[EO_HASH_LENGTH + 1];
  if (!eo_body_read(request, &asked->order) || !find_design(request, asked))
    return;
  eo_rig_pair_hash(&asked->geometry, pair);
  enum eo_code code = hash_files(request->upload, &error);
  if (!code) {
    write_request_digest(asked, request->upload, pair, digest);
    code = eo_store_find_measurement_digest(request->store, digest, eo_measurement_take, &found, &outcome, &error);
  }
  if (code)
    eo_reply_error(&request->reply, "", &error);
  else if (outcome == EO_MEASUREMENT_DONE)
    reply_stored(request, 200, &found);
  else
    measure_and_keep(request, asked, pair, digest);
  eo_text_done(&found.text);
}

/* What was measured, as `easeoff measure --json` prints it; the upload goes away with the request. */
static void answer_trial(struct eo_request *request, struct asked *asked)
{
  struct eo_error error;
  json_t *document = NULL;
  if (!eo_body_read(request, &asked->order) || !find_design(request, asked))
    return;
  double torque = NAN;
  enum eo_code code = measure(request, asked, &document, &torque, &error);
  if (code)
    reply_unmeasured(request, code, &error);
  else if (json_is_true(json_object_get(document, "refused")))
    reply_refused(request, document);
  else
    eo_reply_json(&request->reply, 200, json_incref(document));
  json_decref(document);
}

static void answer_asked(struct eo_request *request, void (*answer)(struct eo_request *request, struct asked *asked))
{
  struct asked *asked = eo_request_memory(request, sizeof *asked);
  if (asked)
    answer(request, asked);
  free(asked);
}

void eo_measurement_try(struct eo_request *request)
{
  answer_asked(request, answer_trial);
}

void eo_measurement_add(struct eo_request *request)
{
  answer_asked(request, answer_upload);
}
