/* Long work at a terminal: a progress line on standard error, only when that is a terminal, and a clean stop on Ctrl-C. */
#ifndef EASEOFF_APP_WATCH_H
#define EASEOFF_APP_WATCH_H

#include <stdbool.h>

#include "base/progress.h"

struct eo_watch {
  struct eo_progress progress; /* to hand to the work */
  bool terminal, shown;
  double last;                 /* when the line was written, s */
};

/* From here on SIGINT and SIGTERM ask for a stop; a second one ends the program at once. */
void eo_watch_start(struct eo_watch *watch);

/* True when the line may be written anew: at a terminal, and not more often than eyes follow. */
bool eo_watch_due(const struct eo_watch *watch);

/* Writes the line, cut to the terminal's width. */
void eo_watch_show(struct eo_watch *watch, const char *line);

/* Wipes the line. */
void eo_watch_end(struct eo_watch *watch);

/* True once a stop was asked for. */
bool eo_watch_stopped(void);

#endif
