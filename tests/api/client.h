/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A real server on a free port with a data folder of its own, and a small HTTP client that sends what it is told, right
   or wrong. */
#ifndef EASEOFF_TESTS_API_CLIENT_H
#define EASEOFF_TESTS_API_CLIENT_H

#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <jansson.h>

#include "document/design_document.h"
#include "document/examples.h"

#define API "/api/v1"

static struct {
  pid_t pid;
  int port;
  char folder[200], url[100];
} server;

__attribute__((unused)) static double seconds_now(void)
{
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

__attribute__((unused)) static void wait_a_little(void)
{
  nanosleep(&(struct timespec){.tv_nsec = 20000000}, NULL);
}

__attribute__((unused)) static bool make_data_folder(void)
{
  snprintf(server.folder, sizeof server.folder, "%s/easeoff-api-XXXXXX", getenv("TMPDIR") ? getenv("TMPDIR") : "/tmp");
  return mkdtemp(server.folder) != NULL;
}

static int remove_entry(const char *path, const struct stat *status, int type, struct FTW *place)
{
  (void)status, (void)type, (void)place;
  return remove(path);
}

__attribute__((unused)) static void remove_data_folder(void)
{
  nftw(server.folder, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
}

static void run_server(int output, char *const *options)
{
  const char *program = getenv("EASEOFF") ? getenv("EASEOFF") : "./easeoff";
  char *argument[32] = {(char *)program, "serve", "--listen", "127.0.0.1:0", "--data", server.folder};
  int count = 6, errors = open("/dev/null", O_WRONLY);
  for (; *options && count < 31; options++)
    argument[count++] = *options;
  prctl(PR_SET_PDEATHSIG, SIGKILL); /* a test that is ended leaves no server with its queue */
  dup2(output, STDOUT_FILENO);
  if (!getenv("SHOW_LOG"))
    dup2(errors, STDERR_FILENO);
  execv(program, argument);
  _exit(127);
}

/* Ends with the line that names the address; false: the server did not start. options end with NULL. */
__attribute__((unused)) static bool start_server_with(char *const *options)
{
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    return false;
  server.pid = fork();
  if (server.pid == 0)
    run_server(ends[1], options);
  close(ends[1]);
  FILE *stream = fdopen(ends[0], "r");
  char line[200] = "";
  bool told = fgets(line, sizeof line, stream) && sscanf(line, "easeoff: http://127.0.0.1:%d/", &server.port) == 1;
  fclose(stream);
  return told;
}

#define start_server(...) start_server_with((char *const[]){__VA_ARGS__ __VA_OPT__(, ) NULL})

/* The exit status; -1: it had to be killed after 20 s. */
__attribute__((unused)) static int stop_server(int signal)
{
  int status = 0;
  double begun = seconds_now();
  kill(server.pid, signal);
  while (waitpid(server.pid, &status, WNOHANG) == 0) {
    if (seconds_now() - begun > 20) {
      kill(server.pid, SIGKILL);
      waitpid(server.pid, &status, 0);
      return -1;
    }
    wait_a_little();
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/* source: an address of this machine that the server sees as the client's. */
__attribute__((unused)) static int open_connection_from(uint32_t source)
{
  struct sockaddr_in own = {.sin_family = AF_INET, .sin_addr.s_addr = htonl(source)};
  struct sockaddr_in address = {
      .sin_family = AF_INET, .sin_port = htons((uint16_t)server.port), .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
  int connection = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0), on = 1;
  struct timeval limit = {.tv_sec = 60};
  setsockopt(connection, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  setsockopt(connection, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  if (bind(connection, (struct sockaddr *)&own, sizeof own) == 0 &&
      connect(connection, (struct sockaddr *)&address, sizeof address) == 0)
    return connection;
  close(connection);
  return -1;
}

__attribute__((unused)) static int open_connection(void)
{
  return open_connection_from(INADDR_LOOPBACK);
}

__attribute__((unused)) static bool send_bytes(int connection, const char *data, size_t size)
{
  while (size) {
    ssize_t sent = send(connection, data, size, MSG_NOSIGNAL);
    if (sent <= 0)
      return false;
    data += sent;
    size -= (size_t)sent;
  }
  return true;
}

__attribute__((unused)) static bool send_text(int connection, const char *text)
{
  return send_bytes(connection, text, strlen(text));
}

struct reply {
  int status; /* 0: none came */
  char *head; /* owned; status line and header fields */
  char *body; /* owned; ends with NUL */
  size_t size;
};

__attribute__((unused)) static void free_reply(struct reply *reply)
{
  free(reply->head);
  free(reply->body);
  *reply = (struct reply){0};
}

static bool read_bytes(int connection, char *data, size_t size)
{
  while (size) {
    ssize_t got = recv(connection, data, size, 0);
    if (got <= 0)
      return false;
    data += got;
    size -= (size_t)got;
  }
  return true;
}

/* A line without its end. */
static bool read_line(int connection, char *line, size_t size)
{
  size_t length = 0;
  while (length + 1 < size && read_bytes(connection, line + length, 1))
    if (line[length++] == '\n') {
      while (length && (line[length - 1] == '\n' || line[length - 1] == '\r'))
        length--;
      line[length] = '\0';
      return true;
    }
  return false;
}

/* The value of a header field, copied; NULL: it is not there. */
__attribute__((unused)) static const char *header_of(const struct reply *reply, const char *name)
{
  static char value[2000];
  size_t length = strlen(name);
  for (const char *line = reply->head ? reply->head : ""; *line;
       line = strchr(line, '\n') ? strchr(line, '\n') + 1 : "")
    if (strncasecmp(line, name, length) == 0 && line[length] == ':') {
      const char *text = line + length + 1 + strspn(line + length + 1, " ");
      snprintf(value, sizeof value, "%.*s", (int)strcspn(text, "\n"), text);
      return value;
    }
  return NULL;
}

static bool read_chunks(int connection, struct reply *reply)
{
  char line[100];
  for (;;) {
    if (!read_line(connection, line, sizeof line))
      return false;
    size_t size = strtoul(line, NULL, 16);
    reply->body = realloc(reply->body, reply->size + size + 1);
    if (!read_bytes(connection, reply->body + reply->size, size))
      return false;
    reply->size += size;
    reply->body[reply->size] = '\0';
    if (!read_line(connection, line, sizeof line))
      return false;
    if (!size)
      return true;
  }
}

/* Everything up to the empty line. */
__attribute__((unused)) static bool read_head(int connection, struct reply *reply)
{
  char line[4000];
  size_t length = 0;
  *reply = (struct reply){0};
  while (read_line(connection, line, sizeof line)) {
    if (!*line && reply->head)
      return sscanf(reply->head, "HTTP/1.1 %d", &reply->status) == 1;
    reply->head = realloc(reply->head, length + strlen(line) + 2);
    length += (size_t)sprintf(reply->head + length, "%s\n", line);
  }
  return false;
}

/* head_only: the reply to HEAD. False: the connection ended before the reply did. */
__attribute__((unused)) static bool read_reply(int connection, struct reply *reply, bool head_only)
{
  if (!read_head(connection, reply))
    return false;
  const char *length = header_of(reply, "Content-Length");
  if (head_only || reply->status == 204 || reply->status == 304)
    return true;
  if (!length)
    return header_of(reply, "Transfer-Encoding") && read_chunks(connection, reply);
  reply->size = strtoul(length, NULL, 10);
  reply->body = calloc(reply->size + 1, 1);
  return read_bytes(connection, reply->body, reply->size);
}

/* One request on a connection. headers: lines that end with \r\n, or NULL; body may be NULL. Host and Content-Length
   are added unless the headers bring them. */
__attribute__((unused)) static bool send_request(int connection, const char *method, const char *path,
                                                 const char *headers, const char *body)
{
  char *text = NULL;
  size_t size = 0;
  const char *more = headers ? headers : "";
  FILE *stream = open_memstream(&text, &size);
  fprintf(stream, "%s %s HTTP/1.1\r\n%s", method, path, more);
  if (!strcasestr(more, "Host:"))
    fprintf(stream, "Host: 127.0.0.1:%d\r\n", server.port);
  if (body && !strcasestr(more, "Content-Type:"))
    fprintf(stream, "Content-Type: application/json\r\n");
  if (body)
    fprintf(stream, "Content-Length: %zu\r\n", strlen(body));
  fprintf(stream, "\r\n%s", body ? body : "");
  fclose(stream);
  bool sent = send_bytes(connection, text, size);
  free(text);
  return sent;
}

/* Is told every reply to call(); NULL: nobody. */
static void (*listener)(const char *method, const char *path, const struct reply *reply);

__attribute__((unused)) static void hear(const char *method, const char *path, const struct reply *reply)
{
  if (listener)
    listener(method, path, reply);
}

/* On a connection of its own. */
__attribute__((unused)) static struct reply call(const char *method, const char *path, const char *headers,
                                                 const char *body)
{
  struct reply reply = {0};
  int connection = open_connection();
  send_request(connection, method, path, headers, body);
  if (!read_reply(connection, &reply, strcmp(method, "HEAD") == 0))
    reply.status = 0;
  close(connection);
  hear(method, path, &reply);
  return reply;
}

/* The reply's body as JSON, owned by the caller. */
__attribute__((unused)) static json_t *call_json(const char *method, const char *path, const char *headers,
                                                 const char *body, int *status)
{
  struct reply reply = call(method, path, headers, body);
  json_t *document = reply.size ? json_loadb(reply.body, reply.size, 0, NULL) : NULL;
  if (status)
    *status = reply.status;
  free_reply(&reply);
  return document;
}

/* The paper's pair so coarse that everything takes a moment. The caller frees it. */
__attribute__((unused)) static json_t *coarse_document(const char *algorithm, int budget)
{
  struct eo_design design;
  eo_example_build("paper", &design);
  struct eo_resolution *r = &design.resolution;
  r->positions = 16;
  r->cells_per_line = 6;
  r->elements.body = EO_BODY_SECTOR;
  r->elements.sector_teeth = 3;
  r->elements.neighbour_coupling = false;
  r->elements.layers = 6;
  r->elements.flank_rows = 4;
  r->elements.fillet_elements = 6;
  r->harmonics = 6;
  r->te_harmonics = 6;
  design.optimization.search.algorithm = eo_optimizer_algorithm_find(algorithm);
  design.optimization.search.true_evaluations = budget;
  design.optimization.search.population = 20;
  return eo_design_encode(&design);
}

__attribute__((unused)) static char *coarse_text(void)
{
  json_t *document = coarse_document("ga", 60);
  char *text = json_dumps(document, JSON_COMPACT);
  json_decref(document);
  return text;
}

/* An order for a job; the caller frees it. */
__attribute__((unused)) static char *order_text(const char *kind, const char *algorithm, int budget, int seed)
{
  json_t *design = coarse_document(algorithm, budget);
  json_object_set_new(json_object_get(design, "optimization"), "seed", json_integer(seed));
  json_t *order = json_pack("{s:s, s:o}", "kind", kind, "design", design);
  char *text = json_dumps(order, JSON_COMPACT);
  json_decref(order);
  return text;
}

/* Waits until a job is in a state; false after so many seconds, or when it ended otherwise. */
__attribute__((unused)) static bool wait_for_job(int id, const char *state, double seconds)
{
  char path[80];
  snprintf(path, sizeof path, API "/jobs/%d", id);
  for (double end = seconds_now() + seconds; seconds_now() < end; wait_a_little()) {
    json_t *job = call_json("GET", path, NULL, NULL, NULL);
    const char *is = json_string_value(json_object_get(job, "state"));
    bool there = is && strcmp(is, state) == 0, failed = is && strcmp(is, "failed") == 0;
    json_decref(job);
    if (there || failed)
      return there;
  }
  return false;
}

#endif
