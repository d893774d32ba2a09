/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the attack on the service of 2026 got through with, each as its whole class: requests that two readers take in
   two ways, signals, a log that nobody reads, uploads that fill the disk or every place, orders that take all memory,
   tokens that are guessed, sessions that never end. */
#include "api/client.h"
#include "support/tap.h"

#include <sys/resource.h>

#define HOST "Host: localhost\r\n"
#define CHECK "POST " API "/check HTTP/1.1\r\n" HOST "Content-Type: application/json\r\n"

static bool is_alive(void)
{
  struct reply reply = call("GET", API "/health", NULL, NULL);
  bool alive = reply.status == 200;
  free_reply(&reply);
  return alive;
}

/* The status of the reply to bytes as they are; closes: whether the connection ends after it. */
static int send_raw(const char *text, size_t size, bool *closes)
{
  struct reply reply;
  char rest;
  struct timeval limit = {.tv_sec = 5};
  int connection = open_connection(), status = 0;
  setsockopt(connection, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  send_bytes(connection, text, size);
  if (read_reply(connection, &reply, false))
    status = reply.status;
  const char *says = header_of(&reply, "Connection");
  *closes = (says && strcasecmp(says, "close") == 0) || recv(connection, &rest, 1, 0) == 0;
  free_reply(&reply);
  close(connection);
  return status;
}

static void test_framing(void)
{
#define RAW(what, text, status)         \
  {                                     \
    what, text, sizeof text - 1, status \
  }
  static const struct {
    const char *what, *text;
    size_t size;
    int status;
  } wrong[] = {
      RAW("two lengths", CHECK "Content-Length: 2\r\nContent-Length: 50\r\n\r\n{}", 400),
      RAW("the same length twice", CHECK "Content-Length: 2\r\nContent-Length: 2\r\n\r\n{}", 400),
      RAW("a list of lengths", CHECK "Content-Length: 2, 2\r\n\r\n{}", 400),
      RAW("a length with a sign", CHECK "Content-Length: +2\r\n\r\n{}", 400),
      RAW("a length and chunks", CHECK "Content-Length: 2\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n", 400),
      RAW("chunks and a length", CHECK "Transfer-Encoding: chunked\r\nContent-Length: 2\r\n\r\n0\r\n\r\n", 400),
      RAW("no coding", CHECK "Transfer-Encoding: identity\r\n\r\n{}", 501),
      RAW("an unknown coding", CHECK "Transfer-Encoding: xchunked\r\n\r\n{}", 501),
      RAW("two codings", CHECK "Transfer-Encoding: gzip, chunked\r\n\r\n0\r\n\r\n", 501),
      RAW("chunks that are not last", CHECK "Transfer-Encoding: chunked, identity\r\n\r\n0\r\n\r\n", 501),
      RAW("two hosts", "GET " API "/health HTTP/1.1\r\n" HOST "Host: elsewhere\r\n\r\n", 400),
      RAW("the same host twice", "GET " API "/health HTTP/1.1\r\n" HOST HOST "\r\n", 400),
  };
  for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
    bool closes;
    int status = send_raw(wrong[i].text, wrong[i].size, &closes);
    ok(status == wrong[i].status && closes, "%s: refused with %d, and the connection %s", wrong[i].what, status,
       closes ? "ends" : "stays");
  }
  struct reply reply = call("GET", API "/health%00x", NULL, NULL);
  ok(reply.status == 404, "a NUL in a path is answered with %d", reply.status);
  free_reply(&reply);
  reply = call("GET", API "/jobs?limit=5%00", NULL, NULL);
  ok(reply.status == 400, "a NUL in a query is answered with %d", reply.status);
  free_reply(&reply);
  reply = call("GET", API "/health%2f%2E%2e/x", NULL, NULL);
  ok(reply.status == 400, "a path is looked at once it is decoded, answer %d", reply.status);
  free_reply(&reply);
}

static void test_signals(void)
{
  static const int harmless[] = {SIGUSR1, SIGUSR2, SIGXFSZ, SIGALRM, SIGPIPE, SIGVTALRM, SIGPROF, SIGIO};
  for (size_t i = 0; i < sizeof harmless / sizeof harmless[0]; i++)
    kill(server.pid, harmless[i]);
  for (int i = 0; i < 5; i++)
    wait_a_little();
  ok(is_alive(), "signals that mean nothing here end nothing");
  ok(stop_server(SIGHUP) == 0, "a terminal that is closed stops the server as SIGTERM does");
}

/* Standard error is a pipe that nobody reads. */
static void test_log_without_reader(void)
{
  int ends[2], kept = dup(STDERR_FILENO), good = 0;
  if (!ok(getenv("EASEOFF") && pipe2(ends, O_CLOEXEC) == 0, "a pipe is made that nobody reads"))
    return;
  setenv("SHOW_LOG", "1", 1);
  dup2(ends[1], STDERR_FILENO);
  bool started = start_server("--threads", "2");
  dup2(kept, STDERR_FILENO);
  unsetenv("SHOW_LOG");
  close(ends[1]);
  for (int i = 0; i < 1500; i++)
    good += is_alive();
  ok(started && good == 1500, "a log that nobody reads holds nobody up: %d of 1500 answered", good);
  double begun = seconds_now();
  int status = stop_server(SIGTERM);
  ok(status == 0 && seconds_now() - begun < 8, "a log that nobody reads does not hold up the stop, which takes %.1f s",
     seconds_now() - begun);
  char text[4096];
  ssize_t got = read(ends[0], text, sizeof text - 1);
  text[got > 0 ? got : 0] = '\0';
  ok(strstr(text, "\"client\":\"127.0.0.1\"") && strstr(text, "\"level\":\"info\"") && strstr(text, "\"user\":\"-\""),
     "a line of the log says who asked");
  close(ends[0]);
  close(kept);
}

/* A POST that has begun and sends no more; the status when it is refused at once. */
static int begin_upload(int *connection)
{
  struct reply reply;
  struct timeval limit = {.tv_usec = 200000};
  int status = 0;
  *connection = open_connection();
  send_text(*connection, "POST " API "/measurements HTTP/1.1\r\n" HOST
                         "Content-Type: multipart/form-data; boundary=xx\r\nContent-Length: 400000\r\n\r\n-");
  setsockopt(*connection, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  if (read_head(*connection, &reply))
    status = reply.status;
  free_reply(&reply);
  return status;
}

static void test_slow_uploads(void)
{
  enum { MANY = 6 };
  int connection[MANY], held = 0, refused = 0;
  for (int i = 0; i < MANY; i++) {
    int status = begin_upload(&connection[i]);
    held += status == 0;
    refused += status == 429;
  }
  /* a refusal is only sent once the body has come or the connection closes: what is small is drained */
  ok(held >= 4 && held + refused == MANY, "%d uploads of one client come, and %d are on their way", MANY, held);
  char rest;
  struct timeval limit = {.tv_sec = 25};
  double begun = seconds_now();
  setsockopt(connection[0], SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  ssize_t got = recv(connection[0], &rest, 1, 0);
  ok(got <= 0 && seconds_now() - begun < 20, "an upload that sends nothing is let go after %.0f s",
     seconds_now() - begun);
  for (int i = 0; i < MANY; i++)
    close(connection[i]);
  ok(is_alive(), "the server answers after all these uploads");
}

/* Chunks without end: the limit of recordings is met without a stated length. */
static void test_endless_upload(void)
{
  static char block[65536];
  struct reply reply = {0};
  char head[40];
  int connection = open_connection();
  long sent = 0;
  memset(block, '1', sizeof block);
  send_text(connection,
            "POST " API "/measurements HTTP/1.1\r\n" HOST "Content-Type: multipart/form-data; boundary=xx\r\n"
            "Transfer-Encoding: chunked\r\n\r\n");
  static const char part[] = "--xx\r\nContent-Disposition: form-data; name=\"file\"; filename=\"a.csv\"\r\n\r\n";
  snprintf(head, sizeof head, "%zx\r\n", sizeof part - 1);
  send_text(connection, head);
  send_text(connection, part);
  send_text(connection, "\r\n");
  snprintf(head, sizeof head, "%zx\r\n", sizeof block);
  for (int i = 0; i < 700; i++, sent += (long)sizeof block)
    if (!send_text(connection, head) || !send_bytes(connection, block, sizeof block) || !send_text(connection, "\r\n"))
      break;
  send_text(connection, "0\r\n\r\n");
  read_reply(connection, &reply, false);
  ok(reply.status == 507, "an upload in chunks that would take all room is refused: %d after %ld bytes", reply.status,
     sent);
  free_reply(&reply);
  close(connection);
}

/* Twice the mesh that is usual: minutes and gigabytes. */
static void test_large_order(void)
{
  json_t *design = coarse_document("ga", 10), *resolution = json_object_get(design, "resolution");
  json_object_set_new(resolution, "layers", json_integer(60));
  json_object_set_new(resolution, "flank_rows", json_integer(30));
  json_object_set_new(resolution, "fillet_elements", json_integer(40));
  json_t *order = json_pack("{s:s, s:O}", "kind", "prepare", "design", design);
  char *text = json_dumps(order, 0), *alone = json_dumps(design, 0);
  int status;
  json_t *told = call_json("POST", API "/check", NULL, alone, &status);
  const json_t *cost = json_object_get(told, "preparation");
  ok(status == 200 && json_number_value(json_object_get(cost, "memory_MB")) > 1000 &&
         json_number_value(json_object_get(cost, "seconds")) > 20,
     "a check says what a pair takes: %.0f MB, %.0f s", json_number_value(json_object_get(cost, "memory_MB")),
     json_number_value(json_object_get(cost, "seconds")));
  json_decref(told);
  json_t *job = call_json("POST", API "/jobs", NULL, text, &status);
  int id = (int)json_integer_value(json_object_get(job, "id"));
  json_decref(job);
  ok(status == 202 && wait_for_job(id, "preparing", 20), "a large order begins");
  for (int i = 0; i < 50; i++)
    wait_a_little();
  char path[80];
  snprintf(path, sizeof path, API "/jobs/%d/cancel", id);
  double begun = seconds_now();
  struct reply reply = call("POST", path, NULL, "");
  free_reply(&reply);
  ok(wait_for_job(id, "cancelled", 10) && seconds_now() - begun < 3, "a large order ends %.2f s after it was cancelled",
     seconds_now() - begun);
  job = call_json("POST", API "/jobs", NULL, text, &status);
  json_decref(job);
  wait_for_job(id + 1, "preparing", 20);
  begun = seconds_now();
  ok(stop_server(SIGTERM) == 0 && seconds_now() - begun < 5, "a stop does not wait for a large order, but takes %.2f s",
     seconds_now() - begun);
  ok(start_server("--quiet", "--pair-memory-MB", "500"), "a server that allows less memory starts");
  job = call_json("POST", API "/analyze", NULL, alone, &status);
  const char *detail = json_string_value(json_object_get(job, "detail"));
  ok(status == 422 && detail && strstr(detail, "500 MB"),
     "a pair above the allowed memory is refused with the figures: %s", detail ? detail : "");
  json_decref(job);
  ok(stop_server(SIGTERM) == 0, "the server that allows less memory stops when told");
  json_decref(order);
  json_decref(design);
  free(text);
  free(alone);
}

static int ask(const char *headers)
{
  struct reply reply = call("GET", API "/designs", headers, NULL);
  int status = reply.status;
  free_reply(&reply);
  return status;
}

static const char token[] = "a-token-of-useful-length";
#define BEARER "Authorization: Bearer "

static void test_tokens(void)
{
  char right[100], text[200];
  int told = 0, waits = 0;
  snprintf(right, sizeof right, BEARER "%s\r\n", token);
  setenv("EASEOFF_TOKEN", "short", 1);
  ok(!start_server("--quiet"), "a short token is refused");
  waitpid(server.pid, NULL, 0);
  setenv("EASEOFF_TOKEN", token, 1);
  ok(start_server("--quiet", "--wrong-tokens-per-minute", "20", "--session-hours", "0.0004"),
     "a server with a token starts");
  unsetenv("EASEOFF_TOKEN");
  snprintf(text, sizeof text, "/proc/%d/environ", (int)server.pid);
  char environment[100000] = "";
  int file = open(text, O_RDONLY | O_CLOEXEC);
  ssize_t size = file >= 0 ? read(file, environment, sizeof environment) : 0;
  ok(size > 0 && !memmem(environment, (size_t)size, token, strlen(token)),
     "the environment of the server does not keep the token");
  close(file);
  for (int i = 0; i < 60; i++) {
    int status = ask(BEARER "a-guess-of-useful-length\r\n");
    told += status == 401;
    waits += status == 429;
  }
  ok(told >= 20 && told <= 30 && told + waits == 60, "60 wrong tokens are refused: %d are told so, %d wait", told,
     waits);
  ok(ask(right) == 200, "the right token from the same address is never refused");
  snprintf(text, sizeof text, "{\"token\":\"%s\"}", token);
  struct reply reply = call("POST", API "/session", NULL, text);
  const char *set = header_of(&reply, "Set-Cookie");
  char cookie[300];
  snprintf(cookie, sizeof cookie, "Cookie: %.*s\r\n", set ? (int)strcspn(set, ";") : 0, set ? set : "");
  ok(reply.status == 204 && ask(cookie) == 200, "a session begins with the right token");
  free_reply(&reply);
  reply = call("POST", API "/session", NULL, text);
  set = header_of(&reply, "Set-Cookie");
  ok(set && strncmp(set, cookie + 8, strcspn(cookie + 8, "\r")) != 0, "each session has a name of its own");
  free_reply(&reply);
  reply = call("DELETE", API "/session", cookie, NULL);
  free_reply(&reply);
  ok(ask(cookie) == 401, "a session that was ended opens nothing");
  reply = call("POST", API "/session", NULL, text);
  set = header_of(&reply, "Set-Cookie");
  snprintf(cookie, sizeof cookie, "Cookie: %.*s\r\n", set ? (int)strcspn(set, ";") : 0, set ? set : "");
  free_reply(&reply);
  for (int i = 0; i < 75; i++)
    wait_a_little();
  ok(ask(cookie) == 401, "a session whose time is over opens nothing");
  ok(stop_server(SIGTERM) == 0, "the server with a token stops when told");
}

/* The client is whom a proxy names that is trusted, and nobody else. */
static void test_proxy(void)
{
  int mine = 0, other = 0;
  ok(start_server("--quiet", "--trusted-proxies", "127.0.0.1, 10.0.0.0/8", "--base-path", "/easeoff",
                  "--questions-at-once", "5", "--questions-per-second", "0.01"),
     "a server behind a proxy starts");
  for (int i = 0; i < 8; i++) {
    struct reply reply = call("POST", API "/check", "X-Forwarded-For: 203.0.113.9, 10.1.2.3\r\n", "{}");
    mine += reply.status == 429;
    free_reply(&reply);
  }
  struct reply reply = call("POST", API "/check", "X-Forwarded-For: 203.0.113.9, 203.0.113.10\r\n", "{}");
  other = reply.status;
  free_reply(&reply);
  ok(mine == 3 && other == 422, "each client behind the proxy has rates of its own: %d refused, the other %d", mine,
     other);
  char *design = coarse_text();
  reply = call("POST", "/easeoff" API "/designs", "X-Forwarded-For: 203.0.113.11\r\n", design);
  const char *place = header_of(&reply, "Location");
  ok(reply.status == 201 && place && strcmp(place, "/easeoff" API "/designs/1") == 0,
     "the path of the proxy stands in Location: %s", place ? place : "none");
  free_reply(&reply);
  free(design);
  reply = call("DELETE", API "/session", "X-Forwarded-Proto: https\r\n", NULL);
  const char *set = header_of(&reply, "Set-Cookie");
  ok(set && strstr(set, "Secure") && strstr(set, "Path=/easeoff/"), "a session's cookie is sent over TLS alone: %s",
     set ? set : "");
  free_reply(&reply);
  ok(stop_server(SIGTERM) == 0, "the server behind a proxy stops when told");
  ok(!start_server("--quiet", "--trusted-proxies", "10.0.0.0/64"), "a network of proxies that is none is refused");
  waitpid(server.pid, NULL, 0);
}

int main(void)
{
  signal(SIGPIPE, SIG_IGN);
  signal(SIGHUP, SIG_DFL); /* ignored under nohup, which the server would take over */
  if (!make_data_folder() ||
      !ok(start_server("--quiet", "--threads", "2", "--recordings-GB", "0.02"), "the server starts"))
    return 1;
  test_framing();
  test_endless_upload();
  test_slow_uploads();
  test_signals();
  test_log_without_reader();
  ok(start_server("--quiet", "--threads", "2"), "the server starts again for a large order");
  test_large_order();
  test_tokens();
  test_proxy();
  remove_data_folder();
  return tap_done();
}
