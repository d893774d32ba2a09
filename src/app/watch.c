#include "app/watch.h"

#include "base/clock.h"

#include <signal.h>
#include <stdio.h>
#include <unistd.h>

/* A signal handler can reach nothing else. */
static volatile sig_atomic_t stopped;

static void stop(int signal)
{
  (void)signal;
  stopped = 1;
}

static int report(void *context, const char *what, double fraction)
{
  static const double INTERVAL = 0.1;
  struct eo_watch *watch = context;
  double now = (1e-3 * eo_clock_milliseconds());
  if (watch->terminal && now - watch->last >= INTERVAL) {
    fprintf(stderr, "\r\033[K%3.0f %% %.60s", 100 * fraction, what);
    fflush(stderr);
    watch->last = now;
    watch->shown = true;
  }
  return stopped;
}

void eo_watch_start(struct eo_watch *watch)
{
  struct sigaction action = {.sa_handler = stop, .sa_flags = (int)SA_RESETHAND};
  *watch = (struct eo_watch){.progress = {.report = report, .context = watch}, .terminal = isatty(STDERR_FILENO)};
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, NULL);
  sigaction(SIGTERM, &action, NULL);
}

void eo_watch_end(struct eo_watch *watch)
{
  if (watch->shown)
    fputs("\r\033[K", stderr);
  watch->shown = false;
}

bool eo_watch_stopped(void)
{
  return stopped;
}
