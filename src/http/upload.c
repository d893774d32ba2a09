/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/connection.h"
#include "http/upload.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "base/clock.h"
#include "format/json.h"
#include "format/object.h"
#include "http/route.h"
#include "http/http_private.h"

enum {
  BUFFER = 64 << 10,
  SLOWEST = 4 << 10,  /* bytes per second that an upload has to bring on average, */
  GRACE = 10,         /* s, after these; what is saved up counts up to EO_IDLE_SECONDS */
  PROMISE = 16 << 20, /* bytes between questions for room while nobody knows how much comes */
};

/* A file's name without folders of any system, in one line, within its place. */
static void clean_name(char *target, size_t size, const char *name)
{
  const char *slash = strrchr(name, '/'), *back = strrchr(name, '\\');
  const char *last = slash > back ? slash : back;
  eo_text_clean(target, size, last ? last + 1 : name);
  json_t *text = json_string(target);
  for (char *c = target; !text && *c; c++) /* not UTF-8 */
    *c = *c & 0x80 ? '?' : *c;
  json_decref(text);
  if (!*target || strcmp(target, ".") == 0 || strcmp(target, "..") == 0)
    snprintf(target, size, "recording");
}

static enum MHD_Result refuse(struct eo_request *request, unsigned status, const char *what)
{
  if (!request->reply.status)
    eo_reply_problem(&request->reply, status, status == 507 ? "full" : "form", "%s", what);
  return MHD_NO;
}

/* A row of the form's table. */
static const struct eo_field *find_row(const struct eo_table *table, const char *name)
{
  for (int i = 0; i < table->count; i++)
    if (strcmp(table->field[i].key, name) == 0)
      return &table->field[i];
  return NULL;
}

static bool came_before(const struct eo_upload *upload, const char *name)
{
  for (int i = 0; i < upload->fields; i++)
    if (strcmp(upload->field[i].name, name) == 0)
      return true;
  return false;
}

static void end_file(struct eo_upload *upload)
{
  if (upload->output >= 0)
    close(upload->output);
  upload->output = -1;
}

static enum MHD_Result begin_file(struct eo_request *request, const char *name)
{
  struct eo_upload *upload = request->upload;
  char path[EO_UPLOAD_PATH];
  end_file(upload);
  if (upload->files == EO_MEASUREMENT_FILES)
    return refuse(request, 422, "A measurement has one file, or one of the pinion and one of the gear.");
  struct eo_measurement_file *file = &upload->file[upload->files];
  eo_upload_path(upload, upload->files, path);
  clean_name(file->name, sizeof file->name, name ? name : "");
  file->size = 0;
  upload->output = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (upload->output < 0)
    return refuse(request, 507, "The server has no room for the file.");
  upload->files++;
  return MHD_YES;
}

static enum MHD_Result begin_field(struct eo_request *request, const char *name)
{
  struct eo_upload *upload = request->upload;
  char shown[40], text[120];
  eo_text_clean(shown, sizeof shown, name);
  snprintf(text, sizeof text, "The form has a part \"%s\" that is not known, or has it twice.", shown);
  if (!find_row(request->route->order, name) || came_before(upload, name) || upload->fields == EO_UPLOAD_FIELDS)
    return refuse(request, 422, text);
  snprintf(upload->field[upload->fields++].name, sizeof upload->field[0].name, "%s", name);
  return MHD_YES;
}

static enum MHD_Result begin_part(struct eo_request *request, const char *name, const char *file_name,
                                  const char *coding)
{
  struct eo_upload *upload = request->upload;
  if (coding && strcasecmp(coding, "binary") != 0 && strcasecmp(coding, "8bit") != 0 && strcasecmp(coding, "7bit") != 0)
    return refuse(request, 415, "Parts must come as they are, without a transfer encoding.");
  snprintf(upload->part, sizeof upload->part, "%s", name);
  upload->in_part = true;
  upload->part_size = 0;
  upload->in_file = strcmp(name, "file") == 0;
  return upload->in_file ? begin_file(request, file_name) : begin_field(request, name);
}

static enum MHD_Result add_to_file(struct eo_request *request, const char *data, size_t size)
{
  struct eo_upload *upload = request->upload;
  while (size) {
    ssize_t written = write(upload->output, data, size);
    if (written < 0 && errno == EINTR)
      continue;
    if (written <= 0)
      return refuse(request, 507, "The server has no room for the file.");
    data += written;
    size -= (size_t)written;
    upload->file[upload->files - 1].size += written;
  }
  return MHD_YES;
}

static enum MHD_Result add_to_field(struct eo_request *request, const char *data, size_t size)
{
  struct eo_upload *upload = request->upload;
  struct eo_text *value = &upload->field[upload->fields - 1].value;
  if (value->size + size > EO_UPLOAD_FIELD_BYTES)
    return refuse(request, 413, "A part of the form that is no file is too long.");
  if (memchr(data, '\0', size)) /* what follows it would not be looked at */
    return refuse(request, 422, "A part of the form that is no file holds a NUL byte.");
  eo_text_add_bytes(value, data, size);
  return MHD_YES;
}

/* The library tells a part's beginning by its offset alone, and may do so twice while nothing of the part came. */
static enum MHD_Result take_part(void *context, enum MHD_ValueKind kind, const char *name, const char *file_name,
                                 const char *type, const char *coding, const char *data, uint64_t offset, size_t size)
{
  struct eo_request *request = context;
  struct eo_upload *upload = request->upload;
  (void)kind, (void)type;
  if (!name || request->reply.status)
    return MHD_NO;
  bool same = upload->in_part && upload->part_size == 0 && strncmp(upload->part, name, sizeof upload->part - 1) == 0;
  if ((offset == 0 || !upload->in_part) && !same && begin_part(request, name, file_name, coding) == MHD_NO)
    return MHD_NO;
  upload->part_size += size;
  if (!size)
    return MHD_YES;
  return upload->in_file ? add_to_file(request, data, size) : add_to_field(request, data, size);
}

/* Bytes that uploads on their way may come to, and those that they may still write. */
static int64_t find_promised(const struct eo_http *http, int64_t *missing)
{
  int64_t sum = 0;
  *missing = 0;
  for (const struct eo_upload *upload = http->uploads; upload; upload = upload->next) {
    int64_t written = 0;
    for (int i = 0; i < upload->files; i++)
      written += upload->file[i].size;
    sum += upload->promised;
    *missing += upload->promised > written ? upload->promised - written : 0;
  }
  return sum;
}

/* Whether the disk, and what the limits say of recordings, has room for all that is promised. */
static bool has_room(struct eo_request *request, const struct eo_upload *upload)
{
  const struct eo_http_limits *limits = &request->http->settings.limits;
  struct statvfs disk;
  struct eo_error error;
  int64_t kept, missing, promised = find_promised(request->http, &missing);
  if (eo_store_measured_bytes(request->store, &kept, &error)) {
    eo_reply_error(&request->reply, "", &error);
    return false;
  }
  bool free = statvfs(upload->folder, &disk) != 0 ||
              (double)disk.f_bavail * (double)disk.f_frsize > (double)missing + 1e6 * limits->spare_MB;
  if (free && (double)(kept + promised) <= 1e9 * limits->recordings_GB)
    return true;
  refuse(request, 507, "The server has no room for more measurements.");
  return false;
}

static int count_uploads(const struct eo_http *http, const unsigned char *client)
{
  int count = 0;
  for (const struct eo_upload *upload = http->uploads; upload; upload = upload->next)
    count += !client || memcmp(upload->client, client, sizeof upload->client) == 0;
  return count;
}

int eo_uploads_count(const struct eo_http *http)
{
  return count_uploads(http, NULL);
}

/* False: the reply says that there are too many. */
static bool may_begin(struct eo_request *request)
{
  const struct eo_http_limits *limits = &request->http->settings.limits;
  if (count_uploads(request->http, NULL) >= limits->uploads)
    eo_reply_problem(&request->reply, 503, "busy", "%d uploads are on their way already.", limits->uploads);
  else if (count_uploads(request->http, request->client_key) >= limits->uploads_per_client)
    eo_reply_problem(&request->reply, 429, NULL, "%d uploads of this client are on their way already.",
                     limits->uploads_per_client);
  else
    return true;
  request->reply.retry_after = 5;
  return false;
}

static void link_in(struct eo_request *request, struct eo_upload *upload)
{
  memcpy(upload->client, request->client_key, sizeof upload->client);
  upload->next = request->http->uploads;
  request->http->uploads = upload;
}

static void link_out(struct eo_http *http, const struct eo_upload *upload)
{
  struct eo_upload **link = &http->uploads;
  while (*link != upload)
    link = &(*link)->next;
  *link = upload->next;
}

void eo_upload_begin(struct eo_request *request, int64_t size)
{
  struct eo_error error;
  if (!may_begin(request))
    return;
  struct eo_upload *upload = calloc(1, sizeof *upload);
  if (!upload) {
    eo_reply_no_memory(&request->reply);
    return;
  }
  upload->output = -1;
  upload->promised = size ? size : PROMISE;
  request->upload = upload;
  link_in(request, upload);
  if (eo_measurement_folder_new(request->store, upload->folder, sizeof upload->folder, &error)) {
    *upload->folder = '\0';
    eo_reply_error(&request->reply, "", &error);
  } else if (has_room(request, upload)) {
    upload->processor = MHD_create_post_processor(request->connection, BUFFER, take_part, request);
    if (!upload->processor)
      eo_reply_problem(&request->reply, 415, NULL, "The body must be multipart/form-data with a boundary.");
  }
}

/* Who does not say how much comes is asked for room a piece at a time. */
static bool promise_more(struct eo_request *request)
{
  struct eo_upload *upload = request->upload;
  if ((int64_t)request->received <= upload->promised)
    return true;
  upload->promised = (int64_t)request->received + PROMISE;
  return has_room(request, upload);
}

void eo_upload_take(struct eo_request *request, const char *data, size_t size)
{
  if (!promise_more(request))
    return;
  if (MHD_post_process(request->upload->processor, data, size) == MHD_NO)
    refuse(request, 400, "The body is no multipart/form-data.");
}

bool eo_upload_end(struct eo_request *request)
{
  struct eo_upload *upload = request->upload;
  bool whole = upload->processor && MHD_destroy_post_processor(upload->processor) == MHD_YES;
  upload->processor = NULL;
  end_file(upload);
  for (int i = 0; i < upload->fields; i++)
    whole = whole && !upload->field[i].value.failed;
  if (!whole)
    refuse(request, 400, "The body was cut off.");
  else if (!upload->files || !upload->file[0].size || !upload->file[upload->files - 1].size)
    refuse(request, 422, upload->files ? "The file is empty." : "The form has no part \"file\".");
  return !request->reply.status;
}

int eo_upload_patience(const struct eo_request *request)
{
  double left = GRACE + (double)request->received / SLOWEST - 1e-3 * (eo_clock_milliseconds() - request->started);
  return left < 1 ? 1 : left > EO_IDLE_SECONDS ? EO_IDLE_SECONDS : (int)left;
}

void eo_upload_path(const struct eo_upload *upload, int file, char *path)
{
  snprintf(path, EO_UPLOAD_PATH, "%s/%d", upload->folder, file);
}

static json_t *read_object(const struct eo_field *row, const struct eo_text *text, struct eo_faults *faults)
{
  struct eo_error error;
  const struct eo_path path = {.key = row->key};
  if (strcmp(text->data, "null") == 0)
    return json_null();
  json_t *object = eo_json_parse(text->data, text->size, &error);
  if (object)
    return object;
  eo_faults_at(faults, &path, "%s", error.text);
  return json_object();
}

/* A part's text as the row wants it; what is no number stays a text, which the table refuses. */
static json_t *read_part(const struct eo_field *row, const struct eo_text *text, struct eo_faults *faults)
{
  double number;
  bool numeric = row->kind == EO_FIELD_NUMBER || row->kind == EO_FIELD_INTEGER || row->kind == EO_FIELD_SEED;
  if (row->kind == EO_FIELD_DOCUMENT)
    return read_object(row, text, faults);
  return numeric && eo_field_real(text->data, &number) ? json_real(number) : json_string(text->data);
}

json_t *eo_upload_document(const struct eo_upload *upload, const struct eo_table *table, struct eo_faults *faults)
{
  struct eo_object object = eo_object_open();
  for (int i = 0; i < upload->fields; i++) {
    const struct eo_upload_field *field = &upload->field[i];
    const struct eo_field *row = find_row(table, field->name);
    const struct eo_path path = {.key = field->name};
    json_t *value = row && field->value.size ? read_part(row, &field->value, faults) : NULL;
    if (value)
      eo_object_put(&object, field->name, value);
    else if (field->value.size)
      eo_faults_at(faults, &path, "The text is not UTF-8.");
  }
  return eo_object_close(&object);
}

void eo_upload_free(struct eo_request *request)
{
  struct eo_upload *upload = request->upload;
  if (!upload)
    return;
  if (upload->processor)
    MHD_destroy_post_processor(upload->processor);
  end_file(upload);
  if (*upload->folder)
    eo_measurement_folder_remove(upload->folder);
  for (int i = 0; i < upload->fields; i++)
    eo_text_done(&upload->field[i].value);
  link_out(request->http, upload);
  free(upload);
  request->upload = NULL;
}
