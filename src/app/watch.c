/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "app/watch.h"

#include <stdio.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "app/app.h"
#include "base/clock.h"

bool eo_watch_due(const struct eo_watch *watch)
{
  static const double INTERVAL = 0.1;
  return watch->terminal && 1e-3 * eo_clock_milliseconds() - watch->last >= INTERVAL;
}

void eo_watch_show(struct eo_watch *watch, const char *line)
{
  struct winsize size;
  int width = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col - 1 : 79;
  fprintf(stderr, "\r\033[K%.*s", width, line);
  fflush(stderr);
  watch->last = 1e-3 * eo_clock_milliseconds();
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
  return watch->stopped;
}

static void *wait_for_signals(void *context)
{
  struct eo_watch *watch = context;
  int signal;
  while (sigwait(&watch->signals, &signal) == 0 && !watch->ended)
    if (atomic_exchange(&watch->stopped, true))
      _exit(EO_EXIT_FAILED);
  return NULL;
}

/* A signal that whoever started the program wants ignored stays ignored. */
static void listen(struct eo_watch *watch, int signal)
{
  struct sigaction action;
  if (sigaction(signal, NULL, &action) == 0 && action.sa_handler != SIG_IGN)
    sigaddset(&watch->signals, watch->listens = signal);
}

void eo_watch_start(struct eo_watch *watch)
{
  *watch = (struct eo_watch){.progress = {.report = report, .context = watch}, .terminal = isatty(STDERR_FILENO)};
  sigemptyset(&watch->signals);
  listen(watch, SIGINT);
  listen(watch, SIGTERM);
  if (!watch->listens)
    return;
  pthread_sigmask(SIG_BLOCK, &watch->signals, &watch->before);
  watch->waiting = pthread_create(&watch->thread, NULL, wait_for_signals, watch) == 0;
  if (!watch->waiting)
    pthread_sigmask(SIG_SETMASK, &watch->before, NULL);
}

void eo_watch_clear(struct eo_watch *watch)
{
  if (watch->shown)
    fputs("\r\033[K", stderr);
  watch->shown = false;
}

void eo_watch_end(struct eo_watch *watch)
{
  eo_watch_clear(watch);
  if (!watch->waiting)
    return;
  watch->ended = true;
  pthread_kill(watch->thread, watch->listens);
  pthread_join(watch->thread, NULL);
  pthread_sigmask(SIG_SETMASK, &watch->before, NULL);
}
