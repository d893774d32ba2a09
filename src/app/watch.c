#include "app/watch.h"

#include <signal.h>
#include <stdio.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

/* A signal handler can reach nothing else. */
static volatile sig_atomic_t stopped;

static void stop(int signal)
{
  (void)signal;
  stopped = 1;
}

static double seconds(void)
{
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

bool eo_watch_due(const struct eo_watch *watch)
{
  static const double INTERVAL = 0.1;
  return watch->terminal && seconds() - watch->last >= INTERVAL;
}

void eo_watch_show(struct eo_watch *watch, const char *line)
{
  struct winsize size;
  int width = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col - 1 : 79;
  fprintf(stderr, "\r\033[K%.*s", width, line);
  fflush(stderr);
  watch->last = seconds();
  watch->shown = true;
}

static int report(void *context, const char *what, double fraction)
{
  struct eo_watch *watch = context;
  char line[80];
  if (eo_watch_due(watch)) {
    snprintf(line, sizeof line, "%3.0f %% %.60s", 100 * fraction, what);
    eo_watch_show(watch, line);
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
