/* Recordings of a rig: what is uploaded is read and measured on a thread of its own, and kept only when that gave a result. */
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/hash.h"
#include "document/json.h"
#include "http/measurement.h"
#include "http/route.h"
#include "http/server.h"
#include "http/upload.h"
#include "jobs/rig_work.h"
#include "store/designs.h"

enum { MOST_LISTED = 200 };

/* ---- documents: written as text, since the results are kept as text ---- */

static void add_json(struct eo_text *text, json_t *value)
{
  if (value)
    eo_json_write(text, value, EO_JSON_COMPACT);
  text->failed = text->failed || !value;
  json_decref(value);
}

static void add_files(struct eo_text *text, const struct eo_stored_measurement *row)
{
  json_t *files = json_array();
  for (int i = 0; i < row->files; i++)
    json_array_append_new(files, json_pack("{s:s, s:I, s:s}", "name", row->file[i].name, "size", (json_int_t)row->file[i].size, "sha256", row->file[i].sha256));
  eo_text_add(text, ",\"files\":");
  add_json(text, files);
}

/* document: of the result or its summary, a JSON object. */
static void add_row(struct eo_text *text, const struct eo_stored_measurement *row, const char *document)
{
  eo_text_print(text, "{\"id\":%lld,\"design\":%lld,\"created\":\"%s\",\"stated_speed_rpm\":", (long long)row->id, (long long)row->design, row->created);
  json_t *speed = eo_json_real(row->speed, &eo_unit_rpm);
  add_json(text, speed);
  eo_text_print(text, ",\"asked_layout\":%s", *row->layout ? row->layout : "null");
  add_files(text, row);
  eo_text_add(text, ",");
  eo_text_add(text, document + 1);
}

/* ---- reading ---- */

struct found {
  struct eo_text text;
  int64_t id;
  char tag[EO_TAG];
};

static enum eo_code visit(void *context, const struct eo_stored_measurement *row, struct eo_error *error)
{
  struct found *found = context;
  found->id = row->id;
  snprintf(found->tag, sizeof found->tag, "%s", row->digest);
  add_row(&found->text, row, row->result);
  return found->text.failed ? eo_error_memory(error) : EO_OK;
}

void eo_reply_no_measurement(struct eo_request *request)
{
  eo_reply_problem(request, 404, NULL, "There is no measurement with this number.");
}

static void get_one(struct eo_request *request)
{
  struct found found = {0};
  struct eo_error error;
  enum eo_measurement_outcome outcome;
  int64_t id;
  if (!eo_request_key(request, 0, &id))
    return;
  if (eo_store_find_measurement(request->store, id, visit, &found, &outcome, &error))
    eo_reply_error(request, "", &error);
  else if (outcome == EO_MEASUREMENT_MISSING)
    eo_reply_no_measurement(request);
  else if (!eo_reply_unchanged(request, found.tag))
    eo_reply_text(request, 200, "application/json", &found.text);
  eo_text_done(&found.text);
}

struct page {
  struct eo_text text;
  int count, limit;
  int64_t last;
  bool more;
};

static enum eo_code visit_listed(void *context, const struct eo_stored_measurement *row, struct eo_error *error)
{
  struct page *page = context;
  page->more = page->count == page->limit;
  if (page->more)
    return EO_OK;
  page->last = row->id;
  eo_text_add(&page->text, page->count++ ? "," : "{\"items\":[");
  add_row(&page->text, row, row->summary);
  return page->text.failed ? eo_error_memory(error) : EO_OK;
}

static void list(struct eo_request *request)
{
  struct page page = {.limit = (int)eo_request_number(request, "limit")};
  struct eo_error error;
  enum eo_code code = eo_store_list_measurements(request->store, (int64_t)eo_request_number(request, "design"), (int64_t)eo_request_number(request, "cursor"),
                                                 page.limit + 1, visit_listed, &page, &error);
  if (!page.count)
    eo_text_add(&page.text, "{\"items\":[");
  if (page.more)
    eo_text_print(&page.text, "],\"next\":\"%lld\"}\n", (long long)page.last);
  else
    eo_text_add(&page.text, "],\"next\":null}\n");
  if (code)
    eo_reply_error(request, "", &error);
  else
    eo_reply_text(request, 200, "application/json", &page.text);
  eo_text_done(&page.text);
}

static void take_out(struct eo_request *request)
{
  struct eo_error error;
  enum eo_measurement_outcome outcome;
  int64_t id;
  if (!eo_request_key(request, 0, &id))
    return;
  if (eo_store_remove_measurement(request->store, id, &outcome, &error))
    eo_reply_error(request, "", &error);
  else if (outcome == EO_MEASUREMENT_MISSING)
    eo_reply_no_measurement(request);
  else
    eo_reply_empty(request, 204);
}

/* ---- the file as it came ---- */

static enum eo_code visit_files(void *context, const struct eo_stored_measurement *row, struct eo_error *error)
{
  (void)error;
  *(struct eo_stored_measurement *)context = *row;
  return EO_OK;
}

/* SHA-256 as RFC 9530 writes it: base64 of the bytes. */
static void write_digest(const char *hex, char *text, size_t size)
{
  static const char letter[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  unsigned char byte[EO_HASH_LENGTH / 2 + 1] = {0};
  char code[64];
  int count = 0;
  for (int i = 0; i < EO_HASH_LENGTH / 2; i++) {
    unsigned value = 0;
    sscanf(hex + (size_t)2 * (size_t)i, "%2x", &value);
    byte[i] = (unsigned char)value;
  }
  for (int i = 0; i < EO_HASH_LENGTH / 2; i += 3) {
    unsigned bits = (unsigned)byte[i] << 16 | (unsigned)byte[i + 1] << 8 | (i + 2 < EO_HASH_LENGTH / 2 ? byte[i + 2] : 0u);
    for (int k = 18; k >= 0; k -= 6)
      code[count++] = letter[bits >> k & 63];
  }
  snprintf(text, size, "sha-256=:%.43s=:", code); /* 32 bytes: 43 letters and one in place of the last */
}

/* A header field takes fewer characters than a name may have. */
static void name_download(char *target, size_t size, const char *name)
{
  snprintf(target, size, "%.*s", (int)size - 1, name);
  for (char *c = target; *c; c++)
    if ((unsigned char)*c >= 127 || *c == '"' || *c == '\\' || *c == '/' || *c < ' ')
      *c = '_';
}

static void send_file(struct eo_request *request, const struct eo_stored_measurement *row, int number)
{
  char path[4200], digest[80];
  struct eo_error error;
  const struct eo_measurement_file *file = &row->file[number];
  int descriptor = eo_measurement_file_path(request->store, row->id, number, path, sizeof path) ? open(path, O_RDONLY | O_CLOEXEC) : -1;
  struct MHD_Response *response = descriptor < 0 ? NULL : MHD_create_response_from_fd64((uint64_t)file->size, descriptor);
  if (!response) {
    if (descriptor >= 0)
      close(descriptor);
    eo_error_set(&error, EO_ERROR_FILE, "", "%.250s: %s.", path, strerror(errno));
    eo_reply_error(request, "", &error);
    return;
  }
  write_digest(file->sha256, digest, sizeof digest);
  MHD_add_response_header(response, "Repr-Digest", digest);
  eo_reply_empty(request, 200);
  request->reply.type = "application/octet-stream";
  request->reply.stream = response;
  request->sent = (size_t)file->size;
  name_download(request->reply.file_name, sizeof request->reply.file_name, file->name);
}

static void get_file(struct eo_request *request)
{
  struct eo_stored_measurement row = {0};
  struct eo_error error;
  enum eo_measurement_outcome outcome;
  int64_t id;
  int number = (int)eo_request_number(request, "part") - 1;
  if (!eo_request_key(request, 0, &id))
    return;
  if (eo_store_find_measurement(request->store, id, visit_files, &row, &outcome, &error))
    eo_reply_error(request, "", &error);
  else if (outcome == EO_MEASUREMENT_MISSING)
    eo_reply_no_measurement(request);
  else if (number >= row.files)
    eo_reply_problem(request, 404, NULL, "This measurement has one file.");
  else if (!eo_reply_unchanged(request, row.file[number].sha256))
    send_file(request, &row, number);
}

/* ---- a new one ---- */

/* What the form said. */
struct asked {
  int64_t design;
  bool unmodified;
  int end, harmonics;
  double torque, speed; /* speed: rad/s, NaN: not stated */
  json_t *layout;       /* owned */
  struct eo_design parsed;
  struct eo_geometry geometry;
  struct eo_faults faults;
};

static double read_positive(struct asked *asked, const char *text, const char *pointer)
{
  double value = NAN;
  if (text && *text && (!eo_field_real(text, &value) || !(value > 0) || value > 1e9))
    eo_faults_add(&asked->faults, pointer, "This must be a positive number.");
  return value;
}

/* 0 or 1 of two words; the first one is what holds without any. */
static int read_word(struct asked *asked, const char *text, const char *pointer, const char *usual, const char *other)
{
  if (text && *text && strcmp(text, usual) != 0 && strcmp(text, other) != 0)
    eo_faults_add(&asked->faults, pointer, "This must be \"%s\" or \"%s\".", usual, other);
  return text && strcmp(text, other) == 0;
}

static void read_layout(struct asked *asked, const char *text)
{
  struct eo_error error;
  if (!text || !*text || strcmp(text, "null") == 0)
    return;
  asked->layout = eo_json_parse(text, strlen(text), &error);
  if (!asked->layout)
    eo_faults_add(&asked->faults, "/layout", "%s", error.text);
}

static bool read_form(struct eo_request *request, struct asked *asked)
{
  const struct eo_upload *form = request->upload;
  const char *design = eo_upload_field(form, "design"), *label = eo_upload_field(form, "label"), *harmonics = eo_upload_field(form, "harmonics");
  int64_t orders = 0;
  if (!design || !eo_field_integer(design, &asked->design) || asked->design < 1)
    eo_faults_add(&asked->faults, "/design", "The number of the stored design that was measured is missing.");
  if (!label || !*label)
    eo_faults_add(&asked->faults, "/label", "Say whether the pair was \"unmodified\" or \"modified\".");
  asked->unmodified = read_word(asked, label, "/label", "modified", "unmodified") == 1;
  asked->end = read_word(asked, eo_upload_field(form, "end"), "/end", "right", "left") ? EO_LEFT : EO_RIGHT;
  asked->torque = read_positive(asked, eo_upload_field(form, "torque_Nm"), "/torque_Nm");
  if (isnan(asked->torque) && !asked->faults.count)
    eo_faults_add(&asked->faults, "/torque_Nm", "The torque on the pinion is missing.");
  asked->speed = eo_unit_in(&eo_unit_rpm, read_positive(asked, eo_upload_field(form, "speed_rpm"), "/speed_rpm"));
  if (harmonics && *harmonics && (!eo_field_integer(harmonics, &orders) || orders < 1 || orders > EO_MESH_ORDERS))
    eo_faults_add(&asked->faults, "/harmonics", "This must be a whole number from 1 to %d.", EO_MESH_ORDERS);
  asked->harmonics = (int)orders;
  read_layout(asked, eo_upload_field(form, "layout"));
  if (asked->faults.count)
    eo_reply_faults(request, "", &asked->faults);
  return !asked->faults.count;
}

static bool find_design(struct eo_request *request, struct asked *asked)
{
  bool missing = false;
  if (eo_request_stored_design(request, asked->design, &asked->parsed, &asked->geometry, NULL, &missing))
    return true;
  if (missing) {
    eo_faults_add(&asked->faults, "/design", "There is no design with this number.");
    eo_reply_faults(request, "", &asked->faults);
  }
  return false;
}

/* ---- check sums ---- */

static enum eo_code hash_file(const char *path, char sha256[EO_HASH_LENGTH + 1], struct eo_error *error)
{
  enum { BLOCK = 64 << 10 };
  unsigned char *block = malloc(BLOCK);
  struct eo_hash hash;
  int file = open(path, O_RDONLY | O_CLOEXEC);
  ssize_t got = -1;
  eo_hash_init(&hash);
  while (block && file >= 0 && (got = read(file, block, BLOCK)) > 0)
    eo_hash_add(&hash, block, (size_t)got);
  eo_hash_finish(&hash, sha256);
  if (file >= 0)
    close(file);
  free(block);
  return got < 0 ? eo_error_set(error, EO_ERROR_FILE, "", "%.250s: %s.", path, strerror(errno)) : EO_OK;
}

static enum eo_code hash_files(struct eo_upload *upload, struct eo_error *error)
{
  char path[EO_UPLOAD_PATH];
  enum eo_code code = EO_OK;
  for (int i = 0; i < upload->files && !code; i++) {
    eo_upload_path(upload, i, path);
    code = hash_file(path, upload->file[i].sha256, error);
  }
  return code;
}

/* Everything that decides what comes out. */
static void write_request_digest(const struct asked *asked, const struct eo_upload *upload, const char *pair, char digest[EO_HASH_LENGTH + 1])
{
  struct eo_hash hash;
  struct eo_text layout = {0};
  if (asked->layout)
    eo_json_write(&layout, asked->layout, EO_JSON_CANONICAL);
  eo_hash_init(&hash);
  eo_hash_add_number(&hash, "design", (double)asked->design);
  eo_hash_add_number(&hash, "unmodified", asked->unmodified);
  eo_hash_add_number(&hash, "end", asked->end);
  eo_hash_add_number(&hash, "harmonics", asked->harmonics);
  eo_hash_add_number(&hash, "torque", asked->torque);
  eo_hash_add_number(&hash, "speed", asked->speed);
  eo_hash_add_text(&hash, "layout", layout.data ? layout.data : "");
  eo_hash_add_text(&hash, "pair", pair);
  for (int i = 0; i < upload->files; i++)
    eo_hash_add_text(&hash, "file", upload->file[i].sha256);
  eo_hash_finish(&hash, digest);
  eo_text_done(&layout);
}

/* ---- reading and keeping ---- */

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

static enum eo_code measure(struct eo_request *request, const struct asked *asked, json_t **document, struct eo_error *error)
{
  const struct eo_upload *upload = request->upload;
  char path[EO_MEASUREMENT_FILES][EO_UPLOAD_PATH];
  const struct eo_progress progress = {watch, request->http};
  for (int i = 0; i < upload->files; i++)
    eo_upload_path(upload, i, path[i]);
  const struct eo_measure_request work = {.path = path[0], .gear_path = upload->files > 1 ? path[1] : NULL, .name = upload->file[0].name,
                                          .unmodified = asked->unmodified, .torque = asked->torque, .stated_speed = asked->speed, .end = asked->end,
                                          .harmonics = asked->harmonics, .layout = asked->layout, .geometry = &asked->geometry,
                                          .spool_directory = upload->folder};
  return eo_measure_file(&work, &progress, document, NULL, NULL, error);
}

static void reply_refused(struct eo_request *request, const json_t *document)
{
  static const char *const kept[] = {"findings", "notes", "layout", "signal"};
  json_t *more = json_object();
  const char *detail = "The recording has no result; its findings say why.";
  json_t *finding;
  size_t i;
  for (i = 0; i < sizeof kept / sizeof kept[0]; i++)
    json_object_set(more, kept[i], json_object_get(document, kept[i]));
  json_array_foreach(json_object_get(document, "findings"), i, finding)
    if (strcmp(json_string_value(json_object_get(finding, "severity")), "refused") == 0) {
      detail = json_string_value(json_object_get(finding, "text"));
      break;
    }
  eo_reply_problem_with(request, 422, "refused", more, detail);
}

static void reply_stored(struct eo_request *request, unsigned status, struct found *found)
{
  eo_reply_text(request, status, "application/json", &found->text);
  snprintf(request->reply.tag, sizeof request->reply.tag, "%s", found->tag);
  snprintf(request->reply.location, sizeof request->reply.location, EO_API "/measurements/%lld", (long long)found->id);
}

static char *dump(const json_t *document)
{
  struct eo_text text = {0};
  eo_json_write(&text, document, EO_JSON_COMPACT);
  return text.failed ? (eo_text_done(&text), NULL) : text.data;
}

static enum eo_code keep(struct eo_request *request, const struct asked *asked, const char *pair, const char *digest, const json_t *document,
                         struct found *found, enum eo_measurement_outcome *outcome, struct eo_error *error)
{
  const struct eo_upload *upload = request->upload;
  json_t *summary = eo_rig_summary(document);
  char *texts[3] = {dump(document), summary ? dump(summary) : NULL, asked->layout ? dump(asked->layout) : strdup("")};
  struct eo_stored_measurement row = {.design = asked->design, .digest = digest, .unmodified = asked->unmodified, .torque = asked->torque,
                                      .speed = asked->speed, .layout = texts[2], .pair = pair, .summary = texts[1], .result = texts[0],
                                      .files = upload->files};
  memcpy(row.file, upload->file, sizeof row.file);
  enum eo_code code = texts[0] && texts[1] && texts[2]
                          ? eo_store_add_measurement(request->store, &row, upload->folder, visit, found, outcome, error)
                          : eo_error_memory(error);
  for (int i = 0; i < 3; i++)
    free(texts[i]);
  json_decref(summary);
  return code;
}

static void measure_and_keep(struct eo_request *request, const struct asked *asked, const char *pair, const char *digest)
{
  struct found found = {0};
  struct eo_error error;
  enum eo_measurement_outcome outcome;
  json_t *document = NULL;
  enum eo_code code = measure(request, asked, &document, &error);
  if (code == EO_ERROR_CANCELLED) {
    eo_reply_problem(request, 503, "stopping", "The server is stopping.");
    request->reply.retry_after = 5;
  } else if (code)
    eo_reply_error(request, "", &error);
  else if (json_is_true(json_object_get(document, "refused")))
    reply_refused(request, document);
  else if (keep(request, asked, pair, digest, document, &found, &outcome, &error))
    eo_reply_error(request, "", &error);
  else if (outcome == EO_MEASUREMENT_NO_DESIGN)
    eo_reply_problem(request, 409, NULL, "The design was removed meanwhile.");
  else
    reply_stored(request, outcome == EO_MEASUREMENT_KNOWN ? 200 : 201, &found);
  eo_text_done(&found.text);
  json_decref(document);
}

/* The same files with the same words are the same measurement: a client that heard no answer sends them again. */
static void answer_upload(struct eo_request *request, struct asked *asked)
{
  struct found found = {0};
  struct eo_error error;
  enum eo_measurement_outcome outcome = EO_MEASUREMENT_MISSING;
  char pair[EO_HASH_LENGTH + 1], digest[EO_HASH_LENGTH + 1];
  if (!read_form(request, asked) || !find_design(request, asked))
    return;
  eo_rig_pair_hash(&asked->geometry, pair);
  enum eo_code code = hash_files(request->upload, &error);
  if (!code) {
    write_request_digest(asked, request->upload, pair, digest);
    code = eo_store_find_measurement_digest(request->store, digest, visit, &found, &outcome, &error);
  }
  if (code)
    eo_reply_error(request, "", &error);
  else if (outcome == EO_MEASUREMENT_DONE)
    reply_stored(request, 200, &found);
  else
    measure_and_keep(request, asked, pair, digest);
  eo_text_done(&found.text);
}

static void add(struct eo_request *request)
{
  struct asked *asked = calloc(1, sizeof *asked);
  struct eo_error error;
  if (!asked) {
    eo_reply_error(request, "", (eo_error_memory(&error), &error));
    return;
  }
  answer_upload(request, asked);
  json_decref(asked->layout);
  free(asked);
}

const struct eo_route eo_routes_measurements[] = {
    {.method = EO_GET, .pattern = "/measurements", .handle = list, .name = "listMeasurements", .gives = "200 Measurements",
     .summary = "Rig measurements, newest first, without their curves.",
     .query = {{"limit", 1, MOST_LISTED, 50, NULL, "most items"}, {"cursor", 1, 9e15, 0, NULL, "`next` of the page before"},
               {"design", 1, 9e15, 0, NULL, "of this design alone"}}},
    {.method = EO_POST, .pattern = "/measurements", .handle = add, .name = "addMeasurement", .takes = "MeasurementForm", .form = true,
     .gives = "201 Measurement, 200 Measurement", .rate = EO_RATE_QUESTION, .body = EO_UPLOAD_BYTES,
     .summary = "A recording of two encoders: one file, or the pinion's and then the gear's. 200 when it is known already; 422 with the findings when "
                "it gives no result, and nothing is kept then."},
    {.method = EO_GET, .pattern = "/measurements/{id}", .handle = get_one, .name = "getMeasurement", .gives = "200 Measurement", .headers = "If-None-Match",
     .summary = "A measurement: what was found in the recording, transmission error, orders, RMS."},
    {.method = EO_DELETE, .pattern = "/measurements/{id}", .handle = take_out, .name = "removeMeasurement", .gives = "204 -",
     .summary = "Removes a measurement with its files."},
    {.method = EO_GET, .pattern = "/measurements/{id}/file", .handle = get_file, .name = "getMeasurementFile", .gives = "200 application/octet-stream",
     .headers = "If-None-Match", .summary = "The recording as it came; its SHA-256 is the ETag.",
     .query = {{"part", 1, EO_MEASUREMENT_FILES, 1, NULL, "2: the gear's file, where each encoder had one"}}},
    {0}};
