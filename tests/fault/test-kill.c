/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A study killed many times at random moments ends with the result of an undisturbed one, and computes nothing twice
   that was saved. KILLS=N sets how often (default 10); SEED=N the moments. */
#include <signal.h>
#include <sys/wait.h>
#include <time.h>

#include "base/random.h"
#include "support/study-fixture.h"
#include "support/tap.h"

enum { BUDGET = 160 };

static struct eo_pair *pair;
static struct eo_design design;

/* Slows the study down, so that every phase is met: half of a millisecond after each evaluation. */
static int dawdle(void *context, const struct eo_study_report *report)
{
  const struct timespec pause = {0, 500000};
  (void)context;
  (void)report;
  nanosleep(&pause, NULL);
  return 0;
}

/* The whole program's work: database, study, document, and the document's name at last. *computed: by this process. */
static int work(int *computed)
{
  struct eo_study_plan plan = {.design = &design, .pair = pair, .threads = 2, .watch = dawdle};
  struct eo_study_result result;
  char name[300];
  if (eo_store_open(&plan.store, folder, EO_STORE_WRITE, &error) || eo_study_run(&plan, &result, &error)) {
    printf("# %s\n", error.text);
    return 2;
  }
  *computed = result.computed;
  struct eo_text text = {0};
  char *lasting = lasting_part(&plan, &result);
  snprintf(name, sizeof name, "%s/result", folder);
  eo_text_add(&text, lasting ? lasting : "");
  int status = lasting && !eo_text_save(&text, name, &error) ? 0 : 2;
  eo_study_result_done(&result);
  eo_text_done(&text);
  free(lasting);
  eo_store_close(plan.store);
  return status;
}

static void read_result(struct eo_text *text)
{
  char name[300];
  snprintf(name, sizeof name, "%s/result", folder);
  *text = (struct eo_text){0};
  if (eo_text_read(text, name, 10 << 20, &error))
    eo_text_add(text, "nothing");
}

/* Rows in the history, the unmodified pair included. */
static int count_rows(void)
{
  struct eo_store *store = NULL;
  int64_t last = -1;
  if (!eo_store_open(&store, folder, EO_STORE_READ, &error))
    eo_store_last_evaluation(store, &last, &error);
  eo_store_close(store);
  return (int)last;
}

/* True when the child was killed before it was through. */
static bool run_and_kill(long microseconds)
{
  int status = 0, computed;
  pid_t child = fork();
  if (child == 0)
    _exit(work(&computed));
  const struct timespec pause = {microseconds / 1000000, microseconds % 1000000 * 1000};
  nanosleep(&pause, NULL);
  kill(child, SIGKILL);
  waitpid(child, &status, 0);
  if (WIFEXITED(status) && WEXITSTATUS(status))
    printf("# the study failed\n");
  return WIFSIGNALED(status);
}

static int environment(const char *name, int standard)
{
  const char *text = getenv(name);
  return text ? atoi(text) : standard;
}

int main(void)
{
  struct eo_text undisturbed, disturbed;
  int computed = 0, kills = 0, wanted = environment("KILLS", 10), rounds = 0, rows = 0, lost = 0;
  uint64_t seed = (uint64_t)environment("SEED", (int)time(NULL));
  if (!make_folder() || !(pair = coarse_pair()))
    return 99;
  coarse_design(&design, "credibility-ga", BUDGET);
  complete(&design);
  struct timespec start, end;
  clock_gettime(CLOCK_MONOTONIC, &start);
  bool good = work(&computed) == 0;
  clock_gettime(CLOCK_MONOTONIC, &end);
  long duration = (end.tv_sec - start.tv_sec) * 1000000 + (end.tv_nsec - start.tv_nsec) / 1000;
  ok(good && computed == BUDGET && count_rows() == BUDGET + 1, "an undisturbed search makes %d evaluations", computed);
  read_result(&undisturbed);

  empty_folder();
  for (; kills < wanted && rounds < 20 * wanted; rounds++) {
    struct eo_random random = eo_random_at(seed, 1, 0, (uint64_t)rounds);
    if (rows >= BUDGET + 1 && rounds % 4 == 0) {
      empty_folder(); /* through it: once more from nothing */
      rows = 0;
    }
    kills += run_and_kill((long)(eo_random_unit(random, 0) * (double)duration * (rounds % 2 ? 0.3 : 1)));
    int now = count_rows();
    lost += now < rows && now >= 0;
    rows = now > rows ? now : rows;
  }
  if (rows >= BUDGET + 1) { /* the last run shall find half a study */
    empty_folder();
    run_and_kill((long)(0.5 * (double)duration));
    rows = count_rows() > 0 ? count_rows() : 0;
  }
  good = work(&computed) == 0;
  read_result(&disturbed);
  ok(kills == wanted, "the search is killed %d times (SEED=%llu)", kills, (unsigned long long)seed);
  ok(good && strcmp(undisturbed.data, disturbed.data) == 0,
     "the killed search comes to the result of an undisturbed one, byte for byte");
  ok(!lost && computed == BUDGET - (rows > 0 ? rows - 1 : 0) && count_rows() == BUDGET + 1,
     "no row of the killed search is lost and none computed twice: %d of %d were left for the last run", computed,
     BUDGET);
  eo_text_done(&undisturbed);
  eo_text_done(&disturbed);
  empty_folder();
  rmdir(folder);
  eo_pair_free(pair);
  return tap_done();
}
