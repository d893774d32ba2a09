/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Any bytes as an upload: the first line is what follows multipart/form-data in the Content-Type (another never comes
   here), the rest the body. It is handed over in pieces of several sizes, so that every boundary is cut at every place,
   and each time the same must come out of it. A real connection carries the type, as the library wants it; the body
   does not pass through it. For libFuzzer, and replayed by replay.c. */
#define _GNU_SOURCE
#include "base/hash.h"
#include "document/measure_order.h"
#include "http/http_private.h"
#include "http/route.h"
#include "http/upload.h"
#include "fuzz/fuzz.h"

#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

/* What came out. */
struct outcome {
  unsigned status; /* of the reply; 0: the upload is whole */
  int files, fields;
  char hash[EO_HASH_LENGTH + 1]; /* of names and contents */
};

static struct eo_http http;
static const uint8_t *body;
static size_t body_size;

static void demand(bool good, const char *what)
{
  if (good)
    return;
  fprintf(stderr, "fuzz-upload: %s\n", what);
  abort();
}

static void hash_file(const struct eo_upload *upload, int number, struct eo_hash *hash)
{
  char path[EO_UPLOAD_PATH], block[4096];
  int64_t size = 0;
  size_t got;
  eo_upload_path(upload, number, path);
  FILE *stream = fopen(path, "rb");
  demand(stream != NULL, "a file is not there");
  for (; (got = fread(block, 1, sizeof block, stream)) > 0; size += (int64_t)got)
    eo_hash_add(hash, block, got);
  fclose(stream);
  demand(size == upload->file[number].size && size > 0, "a file has another size than it says");
  const char *name = upload->file[number].name;
  demand(*name && !strpbrk(name, "/\\\n\r") && strcmp(name, "..") != 0, "a file has a name that leads elsewhere");
  eo_hash_add_text(hash, "file", name);
}

static void look(const struct eo_upload *upload, struct outcome *outcome)
{
  struct eo_hash hash;
  eo_hash_init(&hash);
  outcome->files = upload->files;
  outcome->fields = upload->fields;
  demand(upload->files >= 1 && upload->files <= EO_MEASUREMENT_FILES && upload->fields >= 0 &&
             upload->fields <= EO_UPLOAD_FIELDS,
         "more than there is room for");
  for (int i = 0; i < upload->files; i++)
    hash_file(upload, i, &hash);
  for (int i = 0; i < upload->fields; i++) {
    const struct eo_upload_field *field = &upload->field[i];
    demand(field->value.size <= EO_UPLOAD_FIELD_BYTES, "a field is longer than it may be");
    eo_hash_add_text(&hash, field->name, field->value.data ? field->value.data : "");
  }
  eo_hash_finish(&hash, outcome->hash);
}

/* As server.c does it: once a reply is known, what comes is only counted. */
static struct outcome upload_in_pieces(struct MHD_Connection *connection, size_t piece)
{
  static const struct eo_route route = {.order = &eo_measure_form_table, .form = true};
  struct eo_request request = {
      .http = &http, .store = http.store, .connection = connection, .route = &route, .id = "0123456789abcdef"};
  request.reply.request = request.id;
  struct outcome outcome = {0};
  eo_upload_begin(&request, (int64_t)body_size);
  for (size_t at = 0; at < body_size && !request.reply.status; at += piece)
    eo_upload_take(&request, (const char *)body + at, body_size - at < piece ? body_size - at : piece);
  if (!request.reply.status && eo_upload_end(&request))
    look(request.upload, &outcome);
  outcome.status = request.reply.status;
  eo_upload_free(&request);
  eo_text_done(&request.reply.body);
  demand(!http.uploads, "an upload is still on its way");
  return outcome;
}

static enum MHD_Result handle(void *context, struct MHD_Connection *connection, const char *url, const char *method,
                              const char *version, const char *data, size_t *size, void **state)
{
  static const size_t pieces[] = {1, 2, 3, 7, 61};
  (void)url, (void)method, (void)version, (void)data, (void)size, (void)state;
  struct outcome whole = upload_in_pieces(connection, body_size + 1);
  for (size_t i = 0; i < sizeof pieces / sizeof pieces[0]; i++) {
    struct outcome other = upload_in_pieces(connection, pieces[i]);
    demand(memcmp(&other, &whole, sizeof whole) == 0, "what comes out depends on the pieces");
  }
  *(bool *)context = true;
  return MHD_NO;
}

static char folder[200];

static int remove_entry(const char *path, const struct stat *status, int type, struct FTW *place)
{
  (void)status, (void)type, (void)place;
  return remove(path);
}

static void close_store(void)
{
  eo_store_close(http.store);
  nftw(folder, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
}

static void open_store(void)
{
  struct eo_error error;
  snprintf(folder, sizeof folder, "%s/easeoff-fuzz-XXXXXX", getenv("TMPDIR") ? getenv("TMPDIR") : "/tmp");
  demand(mkdtemp(folder) && eo_store_open(&http.store, folder, EO_STORE_WRITE, &error) == EO_OK, "no store");
  atexit(close_store);
}

static struct MHD_Daemon *start(bool *handled)
{
  open_store();
  eo_table_defaults(&eo_http_limits_table, &http.settings.limits);
  struct MHD_Daemon *daemon = MHD_start_daemon(MHD_USE_NO_LISTEN_SOCKET, 0, NULL, NULL, handle, handled,
                                               MHD_OPTION_END);
  demand(daemon != NULL, "no daemon");
  return daemon;
}

/* A request head with this type; anything that would end the line is left out. */
static size_t write_head(char *head, size_t size, const uint8_t *type, size_t length)
{
  size_t at = (size_t)snprintf(head, size,
                               "POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 0\r\nContent-Type: multipart/form-data");
  for (size_t i = 0; i < length && at < size - 5; i++)
    if (type[i] >= ' ' && type[i] != 127)
      head[at++] = (char)type[i];
  memcpy(head + at, "\r\n\r\n", 4);
  return at + 4;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
  static struct MHD_Daemon *daemon;
  static bool handled;
  char head[1000];
  int ends[2];
  const uint8_t *line = memchr(bytes, '\n', size);
  size_t length = line ? (size_t)(line - bytes) : size;
  if (!daemon)
    daemon = start(&handled);
  body = bytes + length + (line != NULL);
  body_size = size - length - (line != NULL);
  demand(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) == 0, "no sockets");
  size_t head_size = write_head(head, sizeof head, bytes, length);
  const struct sockaddr address = {.sa_family = AF_UNIX};
  demand(write(ends[0], head, head_size) == (ssize_t)head_size &&
             MHD_add_connection(daemon, ends[1], &address, sizeof address) == MHD_YES,
         "no connection");
  handled = false;
  for (int i = 0; i < 10 && !handled; i++)
    MHD_run(daemon);
  demand(handled, "the request did not come through");
  close(ends[0]);
  MHD_run(daemon);
  return 0;
}
