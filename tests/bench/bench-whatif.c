/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How long POST /analyze takes over the loopback, in a real server, on the paper's pair as it is by default with all
   curves: alone, beside connections that ask for what they have already, beside an optimization, beside both.
   bench-whatif [CACHE-DIRECTORY [REQUESTS]]; $EASEOFF is the program. The processor time is the server's, so the first
   lines can be compared where the clock cannot. */
#include "api/client.h"

enum { MOST_REQUESTS = 10000, CONNECTIONS = 1000, GETS_PER_SECOND = 1000 };

static int requests = 200;
static json_t *design;

static double processor_ms(void)
{
  clockid_t clock;
  struct timespec used = {0};
  if (clock_getcpuclockid(server.pid, &clock) == 0)
    clock_gettime(clock, &used);
  return 1e3 * (double)used.tv_sec + 1e-6 * (double)used.tv_nsec;
}

static int compare(const void *a, const void *b)
{
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* No two requests are the same, and no two ends: equal ones are computed once. right: the right end changes too. */
static char *next_design(bool right)
{
  static double relief = 14;
  relief += 0.01;
  for (int end = 0; end <= right; end++) {
    json_t *flank = json_object_get(json_object_get(json_object_get(design, "modification"), "pinion"),
                                    end ? "right" : "left");
    json_object_set_new(flank, "tip_relief_um", json_real(relief + end));
  }
  return json_dumps(design, JSON_COMPACT | JSON_REAL_PRECISION(9));
}

/* Reads a whole reply in large pieces; 0: it is not a result. */
static size_t read_result(int connection)
{
  static char text[1 << 20];
  size_t size = 0, whole = sizeof text;
  while (size < whole) {
    ssize_t got = recv(connection, text + size, sizeof text - 1 - size, 0);
    if (got <= 0)
      return 0;
    size += (size_t)got;
    text[size] = '\0';
    const char *end = strstr(text, "\r\n\r\n"), *length = strstr(text, "Content-Length: ");
    if (end && length)
      whole = (size_t)(end + 4 - text) + strtoul(length + 16, NULL, 10);
  }
  return strncmp(text, "HTTP/1.1 200", 12) == 0 ? size : 0;
}

static void fail(const char *what)
{
  printf("%s\n", what);
  stop_server(SIGTERM);
  remove_data_folder();
  exit(1);
}

static void measure(const char *what, const char *headers, bool right)
{
  static double wall[MOST_REQUESTS], used[MOST_REQUESTS];
  int connection = open_connection();
  size_t size = 0;
  for (int i = -3; i < requests; i++) {
    char *body = next_design(right);
    double before = processor_ms(), start = seconds_now();
    if (!send_request(connection, "POST", API "/analyze?histories=1&rating=0", headers, body) ||
        !(size = read_result(connection)))
      fail("A what-if was not answered.");
    double end = seconds_now();
    if (i >= 0) {
      wall[i] = 1e3 * (end - start);
      used[i] = processor_ms() - before;
    }
    free(body);
  }
  close(connection);
  qsort(wall, (size_t)requests, sizeof *wall, compare);
  qsort(used, (size_t)requests, sizeof *used, compare);
  printf("%-46s %6.0f %7.1f %7.1f %7.1f %7.1f %7.1f\n", what, (double)size / 1e3, wall[requests / 2],
         wall[requests * 9 / 10], wall[requests * 99 / 100], wall[requests - 1], used[requests / 2]);
  fflush(stdout);
}

/* A process with many connections that ask in turn whether something has changed. */
static pid_t start_crowd(void)
{
  pid_t child = fork();
  if (child)
    return child;
  static int connection[CONNECTIONS];
  char headers[300], buffer[65536];
  struct reply reply = call("GET", API "/openapi.json", NULL, NULL);
  const char *tag = header_of(&reply, "ETag");
  snprintf(headers, sizeof headers, "If-None-Match: %s\r\n", tag ? tag : "*");
  for (int i = 0; i < CONNECTIONS; i++)
    connection[i] = open_connection();
  for (int i = 0;; i = (i + 1) % CONNECTIONS) {
    if (!send_request(connection[i], "GET", API "/openapi.json", headers, NULL) ||
        recv(connection[i], buffer, sizeof buffer, 0) <= 0)
      _exit(1);
    nanosleep(&(struct timespec){.tv_nsec = 1000000000 / GETS_PER_SECOND}, NULL);
  }
}

static void stop_crowd(pid_t crowd)
{
  int status = 0;
  kill(crowd, SIGKILL);
  waitpid(crowd, &status, 0);
  if (WIFEXITED(status))
    fail("The connections beside it broke off.");
}

/* A search that goes on for longer than all of this. */
static int start_job(void)
{
  json_t *order = json_pack("{s:s, s:O}", "kind", "optimize", "design", design), *job;
  json_object_set_new(json_object_get(json_object_get(order, "design"), "optimization"), "algorithm",
                      json_string("ga"));
  char *text = json_dumps(order, JSON_COMPACT);
  job = call_json("POST", API "/jobs", NULL, text, NULL);
  int id = (int)json_integer_value(json_object_get(job, "id"));
  free(text);
  json_decref(job);
  json_decref(order);
  if (!wait_for_job(id, "running", 60))
    fail("The optimization does not run.");
  return id;
}

static void stop_job(int id)
{
  char path[80];
  snprintf(path, sizeof path, API "/jobs/%d/cancel", id);
  struct reply reply = call("POST", path, NULL, "{}");
  free_reply(&reply);
  wait_for_job(id, "cancelled", 60);
}

static void start(const char *cache)
{
  char path[300], *full = cache ? realpath(cache, NULL) : NULL;
  if (!make_data_folder())
    exit(1);
  snprintf(path, sizeof path, "%s/flexibility", server.folder);
  if ((full && symlink(full, path) != 0) || !start_server("--quiet"))
    fail("The server does not start.");
  free(full);
}

static void prepare(void)
{
  char *body = next_design(true);
  struct reply reply = call("POST", API "/analyze", "Prefer: wait=60\r\n", body);
  if (reply.status != 200)
    fail("The pair is not prepared.");
  free_reply(&reply);
  free(body);
}

int main(int argc, char **argv)
{
  static struct eo_design built;
  eo_example_build("paper-case-a", &built);
  design = eo_design_encode(&built);
  if (argc > 2)
    requests = atoi(argv[2]);
  if (requests < 1 || requests > MOST_REQUESTS)
    return 1;
  start(argc > 1 ? argv[1] : NULL);
  prepare();
  printf("%d requests each%40s kB     p50     p90     p99    most     CPU, ms\n", requests, "");
  measure("both ends change", NULL, true);
  measure("both ends change, gzip", "Accept-Encoding: gzip\r\n", true);
  measure("one end changes", NULL, false);
  pid_t crowd = start_crowd();
  measure("beside 1000 connections, 1000 GET/s", NULL, true);
  int job = start_job();
  measure("beside them and an optimization", NULL, true);
  stop_crowd(crowd);
  measure("beside an optimization", NULL, true);
  stop_job(job);
  stop_server(SIGTERM);
  remove_data_folder();
  json_decref(design);
  return 0;
}
