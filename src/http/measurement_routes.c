/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stored measurements of a rig: lists, results, the files as they came. */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "document/measure_order.h"
#include "format/list_page.h"
#include "format/object.h"
#include "http/answers.h"
#include "http/measurement_upload.h"
#include "http/stored_measurement.h"
#include "http/route.h"
#include "http/http_private.h"
#include "http/upload.h"

enum { MOST_LISTED = 200 };

static void get_one(struct eo_request *request)
{
  struct eo_found_measurement found = {0};
  struct eo_error error;
  enum eo_measurement_outcome outcome;
  int64_t id;
  if (!eo_request_id_at(request, 0, &id))
    return;
  if (eo_store_find_measurement(request->store, id, eo_measurement_take, &found, &outcome, &error))
    eo_reply_error(&request->reply, "", &error);
  else if (outcome == EO_MEASUREMENT_MISSING)
    eo_reply_no_measurement(&request->reply);
  else if (!eo_request_unchanged(request, found.tag))
    eo_reply_text(&request->reply, 200, "application/json", &found.text);
  eo_text_done(&found.text);
}

static const struct eo_outline_row list_rows[] = {
    EO_PAGE_ROWS("newest first", .outline = &eo_outline_listed_measurement)};
const struct eo_outline eo_outline_measurements = EO_OUTLINE("Measurements", list_rows);

struct page {
  struct eo_object items;
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
  page->count++;
  page->last = row->id;
  eo_list_add(&page->items, eo_listed_measurement_encode(row));
  return page->items.failed ? eo_error_memory(error) : EO_OK;
}

static void list(struct eo_request *request)
{
  struct page page = {.items = eo_list_open(), .limit = (int)eo_route_number(request, "limit")};
  struct eo_error error;
  enum eo_code code = eo_store_list_measurements(request->store, (int64_t)eo_route_number(request, "design"),
                                                 (int64_t)eo_route_number(request, "cursor"), page.limit + 1,
                                                 visit_listed, &page, &error);
  json_t *items = eo_object_close(&page.items);
  if (code) {
    json_decref(items);
    eo_reply_error(&request->reply, "", &error);
  } else
    eo_reply_json(&request->reply, 200, eo_page_encode(&eo_outline_measurements, items, page.more, page.last));
}

static void take_out(struct eo_request *request)
{
  struct eo_error error;
  enum eo_measurement_outcome outcome;
  int64_t id;
  if (!eo_request_id_at(request, 0, &id))
    return;
  if (eo_store_remove_measurement(request->store, id, &outcome, &error))
    eo_reply_error(&request->reply, "", &error);
  else if (outcome == EO_MEASUREMENT_MISSING)
    eo_reply_no_measurement(&request->reply);
  else
    eo_reply_empty(&request->reply, 204);
}

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
    unsigned bits = (unsigned)byte[i] << 16 | (unsigned)byte[i + 1] << 8 |
                    (i + 2 < EO_HASH_LENGTH / 2 ? byte[i + 2] : 0u);
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

/* Whether the bytes are those that were uploaded; false: the reply says that they are not. */
static bool is_what_came(struct eo_request *request, const struct eo_measurement_file *file, const char *path)
{
  char sum[EO_HASH_LENGTH + 1];
  struct eo_error error;
  enum eo_code code = eo_measurement_file_hash(path, sum, &error);
  if (!code && strcmp(sum, file->sha256) != 0)
    code = eo_error_set(&error, EO_ERROR_DAMAGED, "", "%.250s is not what was uploaded.", path);
  if (code)
    eo_reply_error(&request->reply, "", &error);
  return !code;
}

static void send_file(struct eo_request *request, const struct eo_stored_measurement *row, int number)
{
  char path[4200], digest[80];
  struct eo_error error;
  const struct eo_measurement_file *file = &row->file[number];
  bool named = eo_measurement_file_path(request->store, row->id, number, path, sizeof path);
  if (named && !is_what_came(request, file, path))
    return;
  int descriptor = named ? open(path, O_RDONLY | O_CLOEXEC) : -1;
  struct MHD_Response *response = descriptor < 0 ? NULL
                                                 : MHD_create_response_from_fd64((uint64_t)file->size, descriptor);
  if (!response) {
    if (descriptor >= 0)
      close(descriptor);
    eo_error_set(&error, EO_ERROR_FILE, "", "%.250s: %s.", path, strerror(errno));
    eo_reply_error(&request->reply, "", &error);
    return;
  }
  write_digest(file->sha256, digest, sizeof digest);
  MHD_add_response_header(response, "Repr-Digest", digest);
  eo_reply_empty(&request->reply, 200);
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
  int number = (int)eo_route_number(request, "part") - 1;
  if (!eo_request_id_at(request, 0, &id))
    return;
  if (eo_store_find_measurement(request->store, id, visit_files, &row, &outcome, &error))
    eo_reply_error(&request->reply, "", &error);
  else if (outcome == EO_MEASUREMENT_MISSING)
    eo_reply_no_measurement(&request->reply);
  else if (number >= row.files)
    eo_reply_problem(&request->reply, 404, NULL, "This measurement has one file.");
  else if (!eo_request_unchanged(request, row.file[number].sha256))
    send_file(request, &row, number);
}

const struct eo_route eo_routes_measurements[] = {
    {.method = EO_GET,
     .pattern = "/measurements",
     .handle = list,
     .name = "listMeasurements",
     .gives = "200 Measurements",
     .summary = "Rig measurements, newest first, without their curves.",
     .query = {{"limit", 1, MOST_LISTED, 50, NULL, "most items"},
               {"cursor", 1, 9e15, 0, NULL, "`next` of the page before"},
               {"design", 1, 9e15, 0, NULL, "of this design alone"}}},
    {.method = EO_POST,
     .pattern = "/measurements",
     .handle = eo_measurement_add,
     .name = "addMeasurement",
     .takes = "MeasurementForm",
     .order = &eo_measure_form_table,
     .form = true,
     .gives = "201 Measurement, 200 Measurement",
     .rate = EO_RATE_QUESTION,
     .summary = "A recording of two encoders: one file, or the pinion's and then the gear's. 200 when it is known "
                "already; 422 with the findings when "
                "it gives no result, and nothing is kept then."},
    {.method = EO_POST,
     .pattern = "/measure",
     .handle = eo_measurement_try,
     .name = "tryMeasurement",
     .takes = "MeasurementForm",
     .order = &eo_measure_form_table,
     .form = true,
     .gives = "200 MeasurementOfFile",
     .rate = EO_RATE_QUESTION,
     .summary = "The same without keeping anything: what `easeoff measure --json` prints."},
    {.method = EO_GET,
     .pattern = "/measurements/{id}",
     .handle = get_one,
     .name = "getMeasurement",
     .gives = "200 Measurement",
     .headers = "If-None-Match",
     .summary = "A measurement: what was found in the recording, transmission error, orders, RMS."},
    {.method = EO_DELETE,
     .pattern = "/measurements/{id}",
     .handle = take_out,
     .name = "removeMeasurement",
     .gives = "204 -",
     .summary = "Removes a measurement with its files."},
    {.method = EO_GET,
     .pattern = "/measurements/{id}/file",
     .handle = get_file,
     .name = "getMeasurementFile",
     .gives = "200 application/octet-stream",
     .headers = "If-None-Match",
     .aside = true,
     .summary = "The recording as it came, compared with its SHA-256, which is the ETag, before it is sent.",
     .query = {{"part", 1, EO_MEASUREMENT_FILES, 1, NULL, "2: the gear's file, where each encoder had one"}}},
    {0}};
