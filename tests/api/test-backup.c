/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One archive out of a server that works, and back: whole, into a folder that has something, damaged, and by the
   doctor. BACKUPS=N sets how many are made under load (default 3). */
#include "api/client.h"
#include "support/tap.h"

#include <pthread.h>
#include <stdatomic.h>

static char other[220], archive[260];
static atomic_bool over;

/* The exit status of `easeoff ARGUMENTS`; its standard output in *said (1000 bytes). */
static int run(char *said, const char *format, ...)
{
  char arguments[1200], command[1600];
  va_list list;
  va_start(list, format);
  vsnprintf(arguments, sizeof arguments, format, list);
  va_end(list);
  snprintf(command, sizeof command, "%s %s 2>&1", getenv("EASEOFF") ? getenv("EASEOFF") : "./easeoff", arguments);
  FILE *stream = popen(command, "r");
  size_t size = stream ? fread(said, 1, 999, stream) : 0;
  said[size && said[size - 1] == '\n' ? size - 1 : size] = '\0';
  int status = stream ? pclose(stream) : -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/* A design and a recording of it, uploaded. */
static bool add_recording(void)
{
  static const char edge[] = "--edge\r\nContent-Disposition: form-data; name=\"";
  struct reply reply;
  json_t *design = coarse_document("ga", 10), *order = json_pack("{s:O, s:{}}", "design", design, "rig");
  char *text = json_dumps(order, JSON_COMPACT), *alone = json_dumps(design, JSON_COMPACT);
  reply = call("POST", API "/designs", NULL, alone);
  bool good = reply.status == 201;
  free_reply(&reply);
  struct reply recording = call("POST", API "/rig", "Prefer: wait=60\r\n", text);
  char *body = NULL;
  size_t size = 0;
  FILE *stream = open_memstream(&body, &size);
  fprintf(stream, "%sdesign\"\r\n\r\n1\r\n%slabel\"\r\n\r\nmodified\r\n%storque_Nm\"\r\n\r\n828\r\n", edge, edge, edge);
  fprintf(stream, "%sfile\"; filename=\"run.csv\"\r\n\r\n", edge);
  fwrite(recording.body, 1, recording.size, stream);
  fputs("\r\n--edge--\r\n", stream);
  fclose(stream);
  int connection = open_connection();
  char head[200];
  snprintf(head, sizeof head,
           "POST " API
           "/measurements HTTP/1.1\r\nHost: localhost\r\nContent-Type: multipart/form-data; boundary=edge\r\n"
           "Content-Length: %zu\r\n\r\n",
           size);
  send_text(connection, head);
  send_bytes(connection, body, size);
  good = good && recording.status == 200 && read_reply(connection, &reply, false) && reply.status == 201;
  if (!good)
    printf("# %d, %s\n", recording.status, reply.body ? reply.body : "");
  close(connection);
  free_reply(&reply);
  free_reply(&recording);
  free(body);
  free(text);
  free(alone);
  json_decref(order);
  json_decref(design);
  return good;
}

static void *write_designs(void *context)
{
  char *text = coarse_text();
  int *written = context;
  while (!atomic_load(&over)) {
    struct reply reply = call("POST", API "/designs", NULL, text);
    *written += reply.status == 201;
    free_reply(&reply);
  }
  free(text);
  return NULL;
}

static void test_under_load(void)
{
  const char *wanted = getenv("BACKUPS");
  int backups = wanted ? atoi(wanted) : 3, good = 0, restored = 0, sound = 0, written = 0;
  char said[1000];
  pthread_t thread;
  bool writes = pthread_create(&thread, NULL, write_designs, &written) == 0;
  for (int i = 0; i < backups; i++) {
    snprintf(other, sizeof other, "%s-%d", server.folder, i);
    snprintf(archive, sizeof archive, "%s.tar.gz", other);
    good += run(said, "backup %s --data %s", archive, server.folder) == 0 && strstr(said, "1 recordings");
    restored += run(said, "restore %s --data %s", archive, other) == 0 && strstr(said, "1 recordings");
    sound += run(said, "doctor --data %s", other) == 0 && strstr(said, "0 lost, 0 can");
    if (i + 1 < backups) {
      char command[600];
      snprintf(command, sizeof command, "rm -rf %s %s", other, archive);
      if (system(command) != 0)
        printf("# %s stays\n", other);
    }
  }
  atomic_store(&over, true);
  if (writes)
    pthread_join(thread, NULL);
  ok(good == backups && written > 0, "%d backups are made while %d designs are written", good, written);
  ok(restored == backups && sound == backups, "%d archives are restored and %d are sound: %s", restored, sound, said);
  ok(run(said, "backup %s --data %s", archive, server.folder) == 1 && strstr(said, "is there already"),
     "an archive is not overwritten");
}

/* What was restored serves. */
static void test_restored(void)
{
  char kept[200], said[1000];
  snprintf(kept, sizeof kept, "%s", server.folder);
  ok(stop_server(SIGTERM) == 0, "the server stops");
  snprintf(server.folder, sizeof server.folder, "%.190s", other);
  ok(start_server("--quiet", "--threads", "2"), "another server starts on what was restored");
  struct reply reply = call("GET", API "/measurements/1", NULL, NULL);
  ok(reply.status == 200, "the restored recording is measured");
  free_reply(&reply);
  reply = call("GET", API "/measurements/1/file", NULL, NULL);
  ok(reply.status == 200 && reply.size > 10000, "the file of the restored recording has %zu bytes", reply.size);
  free_reply(&reply);
  json_t *named = json_pack("{s:s, s:o}", "name", "of this server", "design", coarse_document("ga", 10));
  char *text = json_dumps(named, 0);
  reply = call("POST", API "/designs", NULL, text);
  json_decref(named);
  free(text);
  free_reply(&reply);
  char one[300];
  snprintf(one, sizeof one, "%s.one.tar.gz", other);
  ok(run(said, "backup %s --data %s --design 1", one, kept) == 0 && strstr(said, "1 designs, 1 recordings, 0 jobs"),
     "one design is backed up with its recording alone: %s", said);
  ok(run(said, "restore %s --data %s", one, server.folder) == 0 && strstr(said, "0 designs, 0 recordings") &&
         strstr(said, "2 were there"),
     "a restore into a folder that has it all adds nothing while a server works there: %s", said);
  reply = call("DELETE", API "/measurements/1", NULL, NULL);
  free_reply(&reply);
  ok(run(said, "restore %s --data %s", one, server.folder) == 0 && strstr(said, "1 recordings"),
     "a restore adds the recording that is missing: %s", said);
  reply = call("GET", API "/measurements/2/file", NULL, NULL);
  ok(reply.status == 200, "the recording that was added has a number of its own");
  free_reply(&reply);
  unlink(one);
  ok(stop_server(SIGTERM) == 0, "the server of the restored folder stops when told");
}

static void test_damaged(void)
{
  char said[1000], path[300], third[260];
  snprintf(path, sizeof path, "%s/measurements/2/0", other);
  FILE *file = fopen(path, "r+");
  if (file) {
    fseek(file, 5000, SEEK_SET);
    fputc('x', file);
    fclose(file);
  }
  ok(run(said, "doctor --data %s", other) == 2 && strstr(said, "lost: Recording 2") && strstr(said, "1 lost"),
     "the doctor says what is lost: %.100s", said);
  ok(start_server("--quiet", "--threads", "2"), "a server starts beside a damaged recording");
  struct reply reply = call("GET", API "/measurements/2/file", NULL, NULL);
  ok(reply.status == 500 && reply.body && strstr(reply.body, "damaged"),
     "a damaged recording is not given out, but answered with %d", reply.status);
  free_reply(&reply);
  stop_server(SIGTERM);
  file = fopen(archive, "r+");
  if (file) {
    fseek(file, -3000, SEEK_END);
    for (int i = 0; i < 20; i++)
      fputc('x', file);
    fclose(file);
  }
  snprintf(third, sizeof third, "%s.third", other);
  ok(run(said, "restore %s --data %s", archive, third) == 1, "a damaged archive is refused: %.150s", said);
  snprintf(path, sizeof path, "%s/easeoff.db", third);
  ok(access(path, F_OK) != 0, "a damaged archive is refused before a database is made");
  rmdir(third);
}

int main(void)
{
  char kept[200];
  signal(SIGPIPE, SIG_IGN);
  if (!make_data_folder() || !ok(start_server("--quiet", "--threads", "2"), "a server starts on an empty folder"))
    return 1;
  snprintf(kept, sizeof kept, "%s", server.folder);
  ok(add_recording(), "the server takes a recording");
  test_under_load();
  test_restored();
  test_damaged();
  remove_data_folder();
  unlink(archive);
  snprintf(server.folder, sizeof server.folder, "%s", kept);
  remove_data_folder();
  return tap_done();
}
