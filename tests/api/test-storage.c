/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Disks that are full, databases that somebody else holds or that are damaged: what the server says of itself, what it
   answers, and that deleting goes on. */
#include "api/client.h"
#include "support/tap.h"

#include <sqlite3.h>

static char *design, control[300];

static int status_of(const char *method, const char *path, const char *body, char *type, size_t size)
{
  struct reply reply = call(method, path, NULL, body);
  int status = reply.status;
  json_t *document = reply.size ? json_loadb(reply.body, reply.size, 0, NULL) : NULL;
  const char *text = json_string_value(json_object_get(document, "type"));
  snprintf(type, size, "%s", text ? text : "");
  json_decref(document);
  free_reply(&reply);
  return status;
}

static int post_design(void)
{
  char type[100];
  return status_of("POST", API "/designs", design, type, sizeof type);
}

/* Until health says so; false after ten seconds. */
static bool wait_for_health(int status, const char *database)
{
  for (int i = 0; i < 500; i++, wait_a_little()) {
    int now;
    json_t *health = call_json("GET", API "/health", NULL, NULL, &now);
    const char *is = json_string_value(json_object_get(health, "database"));
    bool there = now == status && is && strcmp(is, database) == 0;
    json_decref(health);
    if (there)
      return true;
  }
  return false;
}

static void set_left(const char *text)
{
  FILE *file = fopen(control, "w");
  if (file) {
    fputs(text, file);
    fclose(file);
  }
}

static bool start_with_disk(void)
{
  const char *shim = getenv("FULL_DISK_SHIM");
  if (!shim || access(shim, R_OK))
    return false;
  snprintf(control, sizeof control, "%s/left", server.folder);
  set_left("none");
  setenv("LD_PRELOAD", shim, 1);
  setenv("FULL_DISK", control, 1);
  setenv("FULL_DISK_FOLDER", server.folder, 1);
  bool started = start_server("--quiet", "--threads", "2", "--spare-MB", "0.001");
  unsetenv("LD_PRELOAD");
  return started;
}

/* Pairs that do not end by themselves, as job 1. */
static bool order_pairs(void)
{
  json_t *own = coarse_document("ga", 10), *order = json_pack("{s:s, s:o}", "kind", "tolerance", "design", own);
  json_object_set_new(own, "tolerance", json_pack("{s:i,s:s}", "pairs", 100000, "method", "full"));
  char *text = json_dumps(order, JSON_COMPACT), type[100];
  bool taken = status_of("POST", API "/jobs", text, type, sizeof type) == 202;
  free(text);
  json_decref(order);
  return taken && wait_for_job(1, "running", 60);
}

/* A job that the full disk has ended says so as soon as that can be written. */
static bool has_ended(void)
{
  for (double end = seconds_now() + 60; seconds_now() < end; wait_a_little()) {
    json_t *job = call_json("GET", API "/jobs/1", NULL, NULL, NULL);
    const char *state = json_string_value(json_object_get(job, "state"));
    bool ended = state && (strcmp(state, "failed") == 0 || strcmp(state, "cancelled") == 0);
    json_decref(job);
    if (ended)
      return true;
  }
  return false;
}

static void test_full_disk(void)
{
  char type[100];
  int stored = 0, status = 201;
  if (!start_with_disk()) {
    ok(1, "a full disk # SKIP the shim is not built, or cannot be loaded beside a sanitizer");
    return;
  }
  ok(wait_for_health(200, "ok") && post_design() == 201, "a server starts on a disk of its own");
  for (int i = 0; i < 200; i++, wait_a_little()) { /* the spare is kept by a thread of its own */
    char spare[300];
    snprintf(spare, sizeof spare, "%s/easeoff.spare", server.folder);
    if (access(spare, F_OK) == 0)
      break;
  }
  ok(order_pairs(), "a job starts that writes all the time");
  set_left("00000000000000200000");
  for (int i = 0; i < 2000 && status == 201; i++)
    stored += (status = post_design()) == 201;
  ok(status == 507 && stored > 1, "%d designs are stored, the next is answered with %d", stored, status);
  status = status_of("POST", API "/designs", design, type, sizeof type);
  ok(status == 507 && strcmp(type, "/problems/full") == 0, "a design on a full disk is refused with the problem %s",
     type);
  ok(wait_for_health(503, "full"), "health says that the disk is full");
  ok(status_of("GET", API "/health/live", NULL, type, sizeof type) == 200, "the server answers on a full disk");
  ok(status_of("GET", API "/designs/1", NULL, type, sizeof type) == 200, "a design is read on a full disk");
  int cancelled = status_of("POST", API "/jobs/1/cancel", "{}", type, sizeof type);
  ok(cancelled == 202 || cancelled == 409, "the job can be stopped, unless it has ended: %d", cancelled);
  int removed = 0;
  for (int i = 1; i <= stored && i <= 30; i++) {
    char path[80];
    snprintf(path, sizeof path, API "/designs/%d", i);
    removed += status_of("DELETE", path, NULL, type, sizeof type) == 204;
  }
  ok(removed == (stored < 30 ? stored : 30), "designs are deleted on a full disk: %d are gone", removed);
  ok(post_design() == 201, "deleted designs make room for others");
  set_left("none");
  ok(has_ended(), "the job has ended when there is room to say so");
  ok(wait_for_health(200, "ok") && post_design() == 201, "health is good when there is room again");
  ok(stop_server(SIGTERM) == 0, "the server on a full disk stops when told");
  remove_data_folder();
  ok(make_data_folder(), "a new folder is made");
}

/* Another program begins to write and does not end. */
static void test_foreign_lock(void)
{
  sqlite3 *other;
  char path[300], type[100];
  snprintf(path, sizeof path, "%s/easeoff.db", server.folder);
  ok(start_server("--quiet", "--threads", "2") && post_design() == 201, "a server starts and stores a design");
  sqlite3_open(path, &other);
  ok(sqlite3_exec(other, "BEGIN IMMEDIATE", NULL, NULL, NULL) == SQLITE_OK, "another process locks the database");
  double begun = seconds_now();
  int status = status_of("POST", API "/designs", design, type, sizeof type);
  ok(status == 503 && strcmp(type, "/problems/locked") == 0 && seconds_now() - begun < 2,
     "a write to a locked database is refused: %d %s", status, type);
  begun = seconds_now();
  ok(status_of("GET", API "/examples", NULL, type, sizeof type) == 200 && seconds_now() - begun < 2,
     "questions that write nothing do not wait for the lock: %.2f s", seconds_now() - begun);
  ok(wait_for_health(503, "locked"), "health says that the database is locked");
  sqlite3_exec(other, "ROLLBACK", NULL, NULL, NULL);
  sqlite3_close(other);
  ok(wait_for_health(200, "ok") && post_design() == 201, "health says when the lock is over");
  ok(stop_server(SIGTERM) == 0, "the server with a lock stops when told");
}

static void turn_bit(off_t at)
{
  char path[300];
  unsigned char byte;
  snprintf(path, sizeof path, "%s/easeoff.db", server.folder);
  int file = open(path, O_RDWR | O_CLOEXEC);
  if (pread(file, &byte, 1, at) == 1) {
    byte ^= 1;
    if (pwrite(file, &byte, 1, at) != 1)
      printf("# the bit stays\n");
  }
  close(file);
}

/* A bit in the middle of a design. */
static void test_damage(void)
{
  static char content[1 << 20];
  char path[300], type[100];
  snprintf(path, sizeof path, "%s/easeoff.db", server.folder);
  FILE *file = fopen(path, "rb");
  size_t size = file ? fread(content, 1, sizeof content, file) : 0;
  if (file)
    fclose(file);
  const char *at = memmem(content, size, "normal_module_mm", 16);
  ok(at != NULL, "the design is found in the bytes of the database");
  if (!at)
    return;
  turn_bit(at - content);
  ok(start_server("--quiet", "--threads", "2"), "the server starts with a damaged page");
  ok(wait_for_health(503, "damaged"), "health says that a page is damaged");
  int good = 0, damaged = 0, other = 0;
  for (int i = 1; i < 300; i++) {
    snprintf(path, sizeof path, API "/designs/%d", i);
    int status = status_of("GET", path, NULL, type, sizeof type);
    damaged += status == 500 && strcmp(type, "/problems/damaged") == 0;
    good += status == 200;
    other += status != 500 && status != 200 && status != 404;
  }
  ok(damaged > 0 && other == 0, "a damaged page is not given out: %d designs damaged, %d good", damaged, good);
  ok(status_of("GET", API "/health/live", NULL, type, sizeof type) == 200, "the server answers beside a damaged page");
  ok(stop_server(SIGTERM) == 0, "the server with a damaged page stops when told");
  turn_bit(at - content);
}

int main(void)
{
  signal(SIGPIPE, SIG_IGN);
  design = coarse_text();
  if (!make_data_folder())
    return 1;
  test_full_disk();
  test_foreign_lock();
  test_damage();
  remove_data_folder();
  free(design);
  return tap_done();
}
