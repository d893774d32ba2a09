/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A service killed in the middle of an optimization: the next one on the same folder goes on with it, evaluates nothing
   twice and ends with the result of an undisturbed run. KILLS=N sets how often it is killed (default 4). */
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>

#include "base/random.h"
#include "support/service-fixture.h"
#include "store/evaluations.h"
#include "support/tap.h"

enum { BUDGET = 150 };

static struct eo_design design;

static char *result_of(struct eo_service *service, int64_t id, int *computed)
{
  struct eo_text text = {0};
  enum eo_job_outcome outcome;
  if (eo_service_result(service, id, &outcome, &text, &error) || outcome)
    return NULL;
  json_t *document = json_loads(text.data, 0, NULL);
  *computed = (int)eo_json_find_number(document, "run/computed_evaluations");
  json_object_del(document, "run");
  json_object_del(json_object_get(json_object_get(document, "best"), "result"), "timing_ms");
  char *lasting = json_dumps(document, JSON_SORT_KEYS);
  json_decref(document);
  eo_text_done(&text);
  return lasting;
}

/* Rows in the history, the unmodified pair included. */
static int count_rows(void)
{
  struct eo_store *store = NULL;
  int64_t last = 0;
  if (!eo_store_open(&store, folder, EO_STORE_READ, &error))
    eo_store_last_evaluation(store, &last, &error);
  eo_store_close(store);
  return (int)last;
}

/* A child that serves until it is killed, once the history has at least this many rows. */
static bool serve_and_kill(int rows)
{
  int status = 0;
  fflush(stdout);
  pid_t child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    eo_service_new(&(struct eo_service *){NULL}, &(struct eo_service_settings){.data = folder, .threads = 2}, &error);
    for (;;)
      pause();
  }
  for (int i = 0; i < 30000 && count_rows() < rows; i++)
    pause_for(20);
  kill(child, SIGKILL);
  waitpid(child, &status, 0);
  return WIFSIGNALED(status);
}

static int64_t queue_job(void)
{
  struct eo_service *service = start();
  enum eo_job_outcome outcome;
  int64_t id = submit(service, EO_JOB_OPTIMIZE, &design, NULL, &outcome);
  eo_service_free(service); /* before it has begun much */
  return id;
}

int main(void)
{
  const char *wanted = getenv("KILLS");
  int kills = wanted ? atoi(wanted) : 4, killed = 0, rows = BUDGET + 1, computed = 0, rest = 0;
  if (!make_folder())
    return 99;
  make_design(&design, BUDGET);
  struct eo_service *service = start();
  enum eo_job_outcome outcome;
  int64_t id = submit(service, EO_JOB_OPTIMIZE, &design, NULL, &outcome);
  bool done = wait_for(service, id, "done");
  char *undisturbed = result_of(service, id, &computed);
  eo_service_free(service);
  ok(done && undisturbed && computed == BUDGET && count_rows() == BUDGET + 1,
     "an undisturbed service makes %d evaluations", computed);

  for (int round = 0; round < 10 && rows > BUDGET; round++) { /* through before the signal: once more from nothing */
    empty_folder();
    id = queue_job();
    killed = 0;
    for (int i = 0; i < kills; i++)
      killed += serve_and_kill(count_rows() + (BUDGET / 2) / kills);
    rows = count_rows();
  }
  ok(killed == kills, "the service is killed %d times", killed);
  service = start();
  ok(wait_for(service, id, "done"), "the next service goes on with the job");
  char *result = result_of(service, id, &rest);
  ok(result && undisturbed && strcmp(result, undisturbed) == 0,
     "the job comes to the result of an undisturbed one, byte for byte");
  ok(rows > 20 && rows <= BUDGET && rest == BUDGET + 1 - rows && count_rows() == BUDGET + 1,
     "nothing is evaluated twice: %d rows were there, %d were left", rows, rest);
  eo_service_free(service);
  free(result);
  free(undisturbed);
  empty_folder();
  rmdir(folder);
  return tap_done();
}
