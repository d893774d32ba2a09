/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Jobs from outside: their events, stopping and resuming them, a server that is killed, questions that overtake each
   other. */
#include "api/description.h"

static int add_job(const char *kind, const char *algorithm, int budget, int seed)
{
  char *order = order_text(kind, algorithm, budget, seed);
  json_t *job = call_json("POST", API "/jobs", NULL, order, NULL);
  int id = (int)json_integer_value(json_object_get(job, "id"));
  json_decref(job);
  free(order);
  return id;
}

static json_t *get_of_job(int id, const char *what)
{
  char path[100];
  snprintf(path, sizeof path, API "/jobs/%d%s", id, what);
  return call_json("GET", path, NULL, NULL, NULL);
}

static int post_to_job(int id, const char *what)
{
  char path[100];
  snprintf(path, sizeof path, API "/jobs/%d/%s", id, what);
  struct reply reply = call("POST", path, NULL, NULL);
  int status = reply.status;
  free_reply(&reply);
  return status;
}

static int count_true(int id)
{
  json_t *job = get_of_job(id, "");
  int count = (int)json_integer_value(json_object_get(json_object_get(job, "progress"), "true_evaluations"));
  json_decref(job);
  return count;
}

static int open_stream(const char *path, long long last)
{
  struct reply reply;
  char headers[80] = "";
  int connection = open_connection();
  if (last)
    snprintf(headers, sizeof headers, "Last-Event-ID: %lld\r\n", last);
  send_request(connection, "GET", path, headers, NULL);
  read_head(connection, &reply);
  free_reply(&reply);
  return connection;
}

/* The number of the next event and, in *job, the job it tells of (owned); 0: the stream ended. Chunk sizes stand on
   lines of their own. */
static long long next_event(int connection, json_t **job)
{
  static char line[100000];
  long long number = 0;
  while (read_line(connection, line, sizeof line)) {
    sscanf(line, "id: %lld", &number);
    if (strncmp(line, "data: ", 6) == 0) {
      *job = json_loads(line + 6, 0, NULL);
      return *job ? number : 0;
    }
  }
  return 0;
}

static void test_events(void)
{
  /* long enough that it runs for some of the eight snapshots a second */
  int stream = open_stream(API "/events", 0), id = add_job("optimize", "ga", 600, 1), events = 0, rising = 1;
  long long last = 0, middle = 0, number;
  json_t *job = NULL;
  const char *state = "";
  char seen[400] = "";
  while (strcmp(state, "done") != 0 && (number = next_event(stream, &job))) {
    state = json_string_value(json_object_get(job, "state"));
    if (json_integer_value(json_object_get(job, "id")) == id && !strstr(seen, state) && strlen(seen) < 300)
      strcat(strcat(seen, state), " ");
    rising = rising && number > last;
    last = number;
    state = strcmp(state, "done") == 0 && strcmp(json_string_value(json_object_get(job, "kind")), "optimize") == 0
                ? "done"
                : "";
    events++;
    if (events == 2)
      middle = number;
    json_decref(job);
  }
  close(stream);
  ok(rising && events >= 4, "%d events come with rising numbers", events);
  ok(strstr(seen, "running") && strstr(seen, "done"), "the events tell of a job's states: %s", seen);
  stream = open_stream(API "/events", middle);
  number = next_event(stream, &job);
  ok(number == middle + 1, "a client that comes back gets what it missed: event %lld after %lld", number, middle);
  json_decref(job);
  close(stream);
  char path[80];
  snprintf(path, sizeof path, API "/jobs/%d/events", id);
  stream = open_stream(path, middle);
  number = next_event(stream, &job);
  ok(number > middle && json_integer_value(json_object_get(job, "id")) == id,
     "the stream of one job tells of this job");
  json_decref(job);
  close(stream);
}

static void wait_for_evaluations(int id, int count)
{
  for (double end = seconds_now() + 60; count_true(id) < count && seconds_now() < end;)
    wait_a_little();
}

static void test_cancel_and_retry(void)
{
  int id = add_job("optimize", "ga", 3000, 2);
  wait_for_evaluations(id, 20);
  ok(post_to_job(id, "cancel") == 202 && wait_for_job(id, "cancelled", 30), "a running job is stopped");
  int before = count_true(id);
  ok(before > 0 && before < 3000, "a stopped job keeps the %d evaluations that it made", before);
  ok(post_to_job(id, "retry") == 202, "a stopped job is taken up again");
  wait_for_evaluations(id, before + 20);
  ok(post_to_job(id, "cancel") == 202 && wait_for_job(id, "cancelled", 30),
     "a job that was taken up again is stopped again");
}

/* Nothing that was evaluated before the kill is evaluated again, and the result is that of a run in one piece. */
static void test_kill(void)
{
  int id = add_job("optimize", "ga", 400, 3);
  wait_for_evaluations(id, 60);
  int before = count_true(id);
  ok(stop_server(SIGKILL) == 128 + SIGKILL && before < 400, "the server is killed after %d evaluations of its job",
     before);
  ok(start_server("--quiet", "--threads", "2"), "the server starts again after it was killed");
  ok(wait_for_job(id, "done", 120), "the job of the killed server goes on by itself");
  json_t *job = get_of_job(id, ""), *result = get_of_job(id, "/result");
  ok(count_true(id) == 400, "the job of the killed server comes to its whole budget, %d", count_true(id));
  ok(json_integer_value(json_object_get(result, "true_evaluations")) == 400,
     "the result of the killed server's job counts its whole budget: %d, %s",
     (int)json_integer_value(json_object_get(result, "true_evaluations")),
     json_string_value(json_object_get(result, "stopped")));
  ok(json_integer_value(json_object_get(job, "attempts")) == 2,
     "the job of the killed server ends at the second attempt");
  json_t *history = call_json("GET", API "/history", NULL, NULL, NULL);
  ok(json_is_object(result) && json_is_object(history), "the job of the killed server has a result and a history");
  json_decref(history);
  json_decref(result);
  json_decref(job);
}

static void test_park(void)
{
  int id = add_job("optimize", "ga", 1500, 4);
  wait_for_evaluations(id, 30);
  double begun = seconds_now();
  int status = stop_server(SIGTERM);
  ok(status == 0, "a server that is told to stop during a job does so in %.1f s", seconds_now() - begun);
  ok(start_server("--quiet", "--threads", "2"), "the server starts again after its stop during a job");
  json_t *job = get_of_job(id, "");
  const char *state = json_string_value(json_object_get(job, "state"));
  ok(state && strcmp(state, "failed") != 0 && strcmp(state, "cancelled") != 0,
     "the job that was parked waits or runs: %s", state ? state : "");
  json_decref(job);
  ok(post_to_job(id, "cancel") == 202 && wait_for_job(id, "cancelled", 30),
     "the job that was parked can be stopped for good");
}

/* Pairs that were drawn before the stop are a result; where it goes on, more are. */
/* Stopped while it waits for the one before it. */
static void test_stopped_early(int before)
{
  json_t *own = coarse_document("ga", 10);
  json_object_set_new(own, "tolerance", json_pack("{s:i,s:i}", "pairs", 100000, "seed", 5));
  json_t *order = json_pack("{s:s, s:o}", "kind", "tolerance", "design", own);
  char *text = json_dumps(order, JSON_COMPACT);
  json_t *added = call_json("POST", API "/jobs", NULL, text, NULL);
  int id = (int)json_integer_value(json_object_get(added, "id"));
  static const char *const parts[] = {"/result", "/pairs"};
  ok(before < id && post_to_job(id, "cancel") == 202 && wait_for_job(id, "cancelled", 30),
     "a tolerance analysis is stopped before its pairs are there");
  for (int i = 0; i < 2; i++) {
    char path[80];
    struct reply reply;
    snprintf(path, sizeof path, API "/jobs/%d%s", id, parts[i]);
    int connection = open_connection();
    send_request(connection, "GET", path, "", NULL);
    read_reply(connection, &reply, false);
    ok(reply.status == 409 && strstr(reply.body, "stopped before 10 pairs were there"), "%s says so: %s", parts[i],
       reply.body);
    free_reply(&reply);
    close(connection);
  }
  json_decref(added);
  json_decref(order);
  free(text);
}

static void test_stopped_pairs(void)
{
  json_t *own = coarse_document("ga", 10);
  json_object_set_new(own, "tolerance", json_pack("{s:i,s:s}", "pairs", 100000, "method", "full"));
  json_t *order = json_pack("{s:s, s:o}", "kind", "tolerance", "design", own);
  char *text = json_dumps(order, JSON_COMPACT);
  json_t *added = call_json("POST", API "/jobs", NULL, text, NULL);
  int id = (int)json_integer_value(json_object_get(added, "id"));
  json_decref(added);
  json_decref(order);
  free(text);
  long long before = 0;
  for (int i = 0; i < 2; i++) {
    wait_for_evaluations(id, (int)before + 30);
    if (i == 0)
      test_stopped_early(id);
    ok(post_to_job(id, "cancel") == 202 && wait_for_job(id, "cancelled", 30), "a tolerance analysis is stopped");
    json_t *job = get_of_job(id, ""), *answer = get_of_job(id, "/result");
    long long pairs = json_integer_value(json_object_get(answer, "pairs"));
    const char *note = json_string_value(json_array_get(json_object_get(answer, "warnings"), 0));
    ok(json_is_true(json_object_get(job, "has_result")) && pairs >= 10 && pairs > before && pairs < 100000 && note &&
           strstr(note, "of the 100000 pairs"),
       "it has a result of %lld pairs: %s", pairs, note ? note : "");
    before = pairs;
    json_decref(answer);
    json_decref(job);
    char path[80];
    struct reply lines;
    snprintf(path, sizeof path, API "/jobs/%d/pairs", id);
    int connection = open_connection();
    send_request(connection, "GET", path, "", NULL);
    read_reply(connection, &lines, false);
    ok(lines.status == 200 && strncmp(lines.body, "pair,", 5) == 0, "and lines of its pairs: %d", lines.status);
    free_reply(&lines);
    close(connection);
    if (i == 0)
      ok(post_to_job(id, "retry") == 202, "it goes on");
  }
}

static void test_overtaking(void)
{
  enum { QUESTIONS = 4 };
  int connection[QUESTIONS], answered = 0, overtaken = 0;
  json_t *document = coarse_document("ga", 10);
  json_object_set_new(json_object_get(document, "material"), "youngs_modulus_GPa",
                      json_integer(190)); /* a pair that nobody prepared */
  char *text = json_dumps(document, JSON_COMPACT);
  for (int i = 0; i < QUESTIONS; i++) {
    connection[i] = open_connection();
    send_request(connection[i], "POST", API "/analyze?maps=0", "Easeoff-Lane: tab-7\r\nPrefer: wait=60\r\n", text);
    wait_a_little();
  }
  for (int i = 0; i < QUESTIONS; i++) {
    struct reply reply;
    read_reply(connection[i], &reply, false);
    answered += reply.status == 200;
    overtaken += reply.status == 409 && strstr(reply.body, "/problems/overtaken");
    if (i == QUESTIONS - 1)
      ok(reply.status == 200, "the newest question of a lane is answered with %d", reply.status);
    free_reply(&reply);
    close(connection[i]);
  }
  ok(answered + overtaken == QUESTIONS && overtaken >= 1, "%d older questions of the same lane are overtaken",
     overtaken);
  free(text);
  json_decref(document);
}

int main(void)
{
  signal(SIGPIPE, SIG_IGN);
  if (!make_data_folder() || !ok(start_server("--quiet", "--threads", "2"), "the server starts"))
    return 1;
  ok(listen_to_replies(), "the server describes itself");
  test_events();
  test_cancel_and_retry();
  test_kill();
  test_park();
  test_stopped_pairs();
  test_overtaking();
  ok(stop_server(SIGTERM) == 0, "the server stops when told");
  remove_data_folder();
  tell_what_was_heard();
  return tap_done();
}
