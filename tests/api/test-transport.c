/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Clients that do it wrong, slowly, all at once or too much; and a server that stops while they are there. */
#include "api/client.h"
#include "support/tap.h"

#include <pthread.h>
#include <stddef.h>
#include <sys/un.h>

static char *coarse;

static bool is_alive(void)
{
  struct reply reply = call("GET", API "/health", NULL, NULL);
  bool alive = reply.status == 200;
  free_reply(&reply);
  return alive;
}

/* Sends a text as it is and nothing more; the status of the reply, 0: none came. */
static int send_raw(const char *text)
{
  struct reply reply;
  int connection = open_connection(), status = 0;
  send_text(connection, text);
  shutdown(connection, SHUT_WR);
  if (read_head(connection, &reply))
    status = reply.status;
  free_reply(&reply);
  close(connection);
  return status;
}

#define HOST "Host: localhost\r\n"

static void test_keep_alive(void)
{
  int connection = open_connection(), good = 0;
  struct reply reply;
  for (int i = 0; i < 5; i++) {
    send_request(connection, i == 2 ? "POST" : "GET", i == 2 ? API "/check" : API "/health", NULL,
                 i == 2 ? "{}" : NULL);
    good += read_reply(connection, &reply, false) && reply.status == (i == 2 ? 422 : 200);
    free_reply(&reply);
  }
  close(connection);
  ok(good == 5, "five requests on one connection are answered, an error among them");
}

static void test_pipelined(void)
{
  int connection = open_connection(), good = 0;
  struct reply reply;
  static const int expected[] = {200, 404, 200};
  send_text(connection, "GET " API "/health HTTP/1.1\r\n" HOST "\r\nGET " API "/nothing HTTP/1.1\r\n" HOST
                        "\r\nGET " API "/examples HTTP/1.1\r\n" HOST "\r\n");
  for (int i = 0; i < 3; i++) {
    good += read_reply(connection, &reply, false) && reply.status == expected[i];
    free_reply(&reply);
  }
  close(connection);
  ok(good == 3, "three requests at once are answered in their order");
}

static void test_declared_too_large(void)
{
  struct reply reply;
  char rest;
  int connection = open_connection();
  send_text(connection,
            "POST " API "/check HTTP/1.1\r\n" HOST "Content-Type: application/json\r\nContent-Length: 2000000\r\n\r\n");
  bool told = read_reply(connection, &reply, false);
  const char *header = header_of(&reply, "Connection");
  ok(told && reply.status == 413 && header && strcasecmp(header, "close") == 0,
     "a body that will be too large is refused before it comes");
  ok(recv(connection, &rest, 1, 0) == 0, "the connection ends after a body that is too large");
  free_reply(&reply);
  close(connection);
  ok(send_raw("POST " API "/check HTTP/1.1\r\n" HOST "Content-Length: 99999999999999999999999\r\n\r\n") >= 400,
     "a length beyond all numbers is refused");
}

/* A body in chunks of 1000 bytes; the status, 0: the connection was dropped. */
static int send_chunked(const char *body, size_t size)
{
  struct reply reply;
  char head[40];
  int connection = open_connection(), status = 0;
  send_text(connection, "POST " API "/check HTTP/1.1\r\n" HOST
                        "Content-Type: application/json\r\nTransfer-Encoding: chunked\r\n\r\n");
  for (size_t at = 0; at < size; at += 1000) {
    size_t part = size - at < 1000 ? size - at : 1000;
    snprintf(head, sizeof head, "%zx\r\n", part);
    if (!send_text(connection, head) || !send_bytes(connection, body + at, part) || !send_text(connection, "\r\n"))
      break;
  }
  send_text(connection, "0\r\n\r\n");
  if (read_reply(connection, &reply, false))
    status = reply.status;
  free_reply(&reply);
  close(connection);
  return status;
}

static void test_chunked(void)
{
  enum { LARGE = 1100000, HUGE_SIZE = 8000000 };
  char *blank = malloc(HUGE_SIZE);
  memset(blank, ' ', HUGE_SIZE);
  ok(send_chunked(coarse, strlen(coarse)) == 200, "a body in chunks is taken");
  ok(send_chunked(blank, LARGE) == 413, "a body in chunks that is too large is refused");
  ok(send_chunked(blank, HUGE_SIZE) == 0, "a body in chunks that goes on and on is cut off");
  free(blank);
  ok(is_alive(), "the server answers after bodies in chunks");
}

static void test_truncated(void)
{
  for (size_t length = 1; length < 120; length += 7) {
    int connection = open_connection();
    char text[200];
    snprintf(text, sizeof text,
             "POST " API "/check HTTP/1.1\r\n" HOST
             "Content-Type: application/json\r\nContent-Length: 500\r\n\r\n{\"name\":\"half\"");
    send_bytes(connection, text, length);
    close(connection);
  }
  ok(is_alive(), "the server answers after clients that broke off anywhere");
}

static void test_malformed(void)
{
  static const char *const wrong[] = {"\r\n\r\n\r\n",
                                      "GET\r\n\r\n",
                                      "GET / HTTP/9.9\r\n" HOST "\r\n",
                                      "GET / HTTP/1.1\r\nHost\r\n\r\n",
                                      "GET / HTTP/1.1\r\n\r\n",
                                      "POST " API "/check HTTP/1.1\r\n" HOST "Content-Length: -5\r\n\r\n",
                                      "POST " API "/check HTTP/1.1\r\n" HOST "Content-Length: 5x\r\n\r\n{}",
                                      "POST " API "/check HTTP/1.1\r\n" HOST
                                      "Transfer-Encoding: chunked\r\n\r\nzz\r\n"};
  int answered = 0;
  for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
    int status = send_raw(wrong[i]);
    answered += status == 0 || status >= 400;
    if (status && status < 400)
      printf("# %zu: %d\n", i, status);
  }
  ok(answered == (int)(sizeof wrong / sizeof wrong[0]), "malformed requests are refused");
  char *long_text = malloc(100000);
  memset(long_text, 'a', 100000);
  memcpy(long_text, "GET /", 5);
  strcpy(long_text + 50000, " HTTP/1.1\r\n" HOST "\r\n");
  ok(send_raw(long_text) == 414, "an address that is too long is refused");
  memset(long_text, 'a', 100000);
  memcpy(long_text, "GET / HTTP/1.1\r\n" HOST "X: ", 35);
  strcpy(long_text + 50000, "\r\n\r\n");
  ok(send_raw(long_text) == 431, "header fields that are too long are refused");
  free(long_text);
}

static void test_noise(void)
{
  unsigned state = 1;
  for (int i = 0; i < 50; i++) {
    char noise[400];
    for (size_t k = 0; k < sizeof noise; k++)
      noise[k] = (char)((state = state * 1664525 + 1013904223) >> 24);
    int connection = open_connection();
    send_bytes(connection, noise, sizeof noise);
    close(connection);
  }
  ok(is_alive(), "the server answers after noise");
}

static void test_deep(void)
{
  char deep[4000];
  memset(deep, '[', sizeof deep - 1);
  memcpy(deep, "{\"a\":", 5);
  deep[sizeof deep - 1] = '\0';
  struct reply reply = call("POST", API "/check", NULL, deep);
  ok(reply.status == 400 && strstr(reply.body, "brackets"), "thousands of brackets are refused");
  free_reply(&reply);
}

static void test_continue(void)
{
  struct reply reply;
  int connection = open_connection();
  send_text(connection, "POST " API "/check HTTP/1.1\r\n" HOST
                        "Content-Type: application/json\r\nExpect: 100-continue\r\nContent-Length: 2\r\n\r\n");
  bool asked = read_head(connection, &reply) && reply.status == 100;
  free_reply(&reply);
  send_text(connection, "{}");
  ok(asked && read_reply(connection, &reply, false) && reply.status == 422,
     "a client that asks first is told to go on");
  free_reply(&reply);
  close(connection);
}

/* Clients that say a little and wait hold nobody up. */
static void test_dawdlers(void)
{
  enum { DAWDLERS = 150 };
  int connection[DAWDLERS];
  for (int i = 0; i < DAWDLERS; i++) {
    connection[i] = open_connection();
    send_text(connection[i], i % 2 ? "GET " API "/health HTTP/1.1\r\nHo"
                                   : "POST " API "/check HTTP/1.1\r\n" HOST "Content-Length: 400\r\n\r\n{");
  }
  double begun = seconds_now();
  bool alive = is_alive();
  ok(alive && seconds_now() - begun < 5, "other clients are answered while %d dawdle", DAWDLERS);
  for (int i = 0; i < DAWDLERS; i++)
    close(connection[i]);
}

/* A hundred at once and two more every second. */
static void test_rate(void)
{
  enum { REQUESTS = 200 };
  int refused = 0;
  bool says_when = true;
  double begun = seconds_now();
  for (int i = 0; i < REQUESTS; i++) {
    struct reply reply = call("POST", API "/jobs", NULL, "{}");
    refused += reply.status == 429;
    says_when = says_when && (reply.status != 429 || header_of(&reply, "Retry-After"));
    free_reply(&reply);
  }
  double allowed = 100 + 2 * (seconds_now() - begun);
  ok(refused >= REQUESTS - allowed - 1 && refused <= 100, "who asks too much is refused: %d of %d, %.0f were allowed",
     refused, REQUESTS, allowed);
  ok(says_when, "a client that asks too much is told when to come again");
}

enum { STREAMS = 200 };

/* Reads what has come until the text is there. */
static bool read_until(int connection, const char *text)
{
  char seen[20000];
  size_t length = 0;
  while (length < sizeof seen - 1) {
    ssize_t got = recv(connection, seen + length, sizeof seen - 1 - length, 0);
    if (got <= 0)
      return false;
    length += (size_t)got;
    seen[length] = '\0';
    if (strstr(seen, text))
      return true;
  }
  return false;
}

static bool ends(int connection)
{
  char rest[1000];
  ssize_t got;
  while ((got = recv(connection, rest, sizeof rest, 0)) > 0)
    ;
  return got == 0;
}

static void test_streams_and_stop(void)
{
  int stream[STREAMS], opened = 0, told = 0, ended = 0;
  for (int i = 0; i < STREAMS; i++) {
    struct reply reply;
    stream[i] = open_connection();
    send_request(stream[i], "GET", API "/events", NULL, NULL);
    opened += read_head(stream[i], &reply) && reply.status == 200 &&
              strstr(header_of(&reply, "Content-Type"), "text/event-stream");
    free_reply(&reply);
  }
  ok(opened == STREAMS, "%d streams of events are opened", opened);
  for (int i = 0; i < STREAMS; i += 2) /* every other one leaves without a word */
    close(stream[i]);
  char *order = order_text("prepare", "ga", 10, 1);
  struct reply reply = call("POST", API "/jobs", NULL, order);
  ok(reply.status == 202, "a job is taken that the streams tell of");
  free_reply(&reply);
  free(order);
  for (int i = 1; i < STREAMS; i += 2)
    told += read_until(stream[i], "\"state\":\"done\"");
  ok(told == STREAMS / 2, "each stream that stayed hears of the job: %d", told);
  ok(stop_server(SIGTERM) == 0, "the server stops while streams are open");
  for (int i = 1; i < STREAMS; i += 2) {
    ended += ends(stream[i]);
    close(stream[i]);
  }
  ok(ended == STREAMS / 2, "the server ends every open stream properly: %d", ended);
}

/* Somebody waits for a preparation that takes long. */
static void test_stop_while_waiting(void)
{
  struct reply reply;
  struct eo_design design;
  eo_example_build("narrow", &design);
  json_t *document = eo_design_encode(&design);
  char *text = json_dumps(document, JSON_COMPACT);
  int connection = open_connection();
  send_request(connection, "POST", API "/analyze", "Prefer: wait=60\r\n", text);
  for (double end = seconds_now() + 10; !wait_for_job(2, "preparing", 0.1) && seconds_now() < end;)
    ;
  ok(stop_server(SIGTERM) == 0, "the server stops while somebody waits");
  bool answered = read_reply(connection, &reply, false);
  ok(answered && (reply.status == 503 || reply.status == 202), "a client that waits is answered at the stop with %d",
     reply.status);
  free_reply(&reply);
  close(connection);
  free(text);
  json_decref(document);
}

/* What systemd does for a unit of Type=notify, with a socket that is a file and with one that is a name alone. */
static void test_manager(const char *path)
{
  struct sockaddr_un address = {.sun_family = AF_UNIX};
  struct timeval limit = {.tv_sec = 20};
  char message[100] = "";
  size_t length = strlen(path);
  memcpy(address.sun_path, path, length);
  if (path[0] == '@')
    address.sun_path[0] = '\0';
  int manager = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  setsockopt(manager, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  bool bound = bind(manager, (struct sockaddr *)&address,
                    (socklen_t)(offsetof(struct sockaddr_un, sun_path) + length)) == 0;
  setenv("NOTIFY_SOCKET", path, 1);
  bool started = start_server("--quiet");
  unsetenv("NOTIFY_SOCKET");
  ssize_t size = recv(manager, message, sizeof message - 1, 0);
  ok(bound && started && size > 0 && strcmp(message, "READY=1") == 0 && is_alive(),
     "a service manager hears that the server is ready: %s", message);
  ok(stop_server(SIGTERM) == 0, "the service manager stops the server");
  close(manager);
}

static void test_managers(void)
{
  char path[100]; /* the kernel takes no longer one */
  if (snprintf(path, sizeof path, "%s/manager", server.folder) < (int)sizeof path)
    test_manager(path);
  snprintf(path, sizeof path, "@easeoff-test-%d", (int)getpid());
  test_manager(path);
}

int main(void)
{
  signal(SIGPIPE, SIG_IGN);
  coarse = coarse_text();
  if (!make_data_folder() || !ok(start_server("--quiet", "--threads", "2"), "the server starts"))
    return 1;
  test_keep_alive();
  test_pipelined();
  test_declared_too_large();
  test_chunked();
  test_truncated();
  test_malformed();
  test_noise();
  test_deep();
  test_continue();
  test_dawdlers();
  test_rate();
  ok(stop_server(SIGTERM) == 0, "the server stops when told");
  ok(start_server("--quiet", "--threads", "2"), "the server starts again for streams");
  test_streams_and_stop();
  ok(start_server("--quiet", "--threads", "2"), "the server starts again for a client that waits");
  test_stop_while_waiting();
  test_managers();
  remove_data_folder();
  free(coarse);
  return tap_done();
}
