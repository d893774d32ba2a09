/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Long work at a terminal: a progress line on standard error, only when that is a terminal, and a clean stop on Ctrl-C
   or SIGTERM. The two signals are blocked in every thread and taken by one that waits for them: METIS puts handlers of
   its own in their place while it orders a matrix, which must never run. */
#ifndef EASEOFF_APP_WATCH_H
#define EASEOFF_APP_WATCH_H

#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>

#include "base/progress.h"

struct eo_watch {
  struct eo_progress progress; /* to hand to the work */
  atomic_bool stopped;         /* a stop was asked for */
  atomic_bool ended;           /* the thread that waits for signals has nothing more to wait for */
  int listens;                 /* one of the signals that ask for a stop; 0: none does */
  bool terminal, shown, waiting;
  double last; /* when the line was written, s */
  sigset_t signals, before;
  pthread_t thread;
};

/* From here on SIGINT and SIGTERM ask for a stop; a second one ends the program at once. Call before any thread starts;
 *watch stays where it is until eo_watch_end(). */
void eo_watch_start(struct eo_watch *watch);

/* True when the line may be written anew: at a terminal, and not more often than eyes follow. */
bool eo_watch_due(const struct eo_watch *watch);

/* Writes the line, cut to the terminal's width. */
void eo_watch_show(struct eo_watch *watch, const char *line);

/* Wipes the line. */
void eo_watch_clear(struct eo_watch *watch);

/* Signals act as before. */
void eo_watch_end(struct eo_watch *watch);

#endif
