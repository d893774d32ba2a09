/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Progress and cancellation of long work: one callback, called from the thread that does the work. */
#ifndef EASEOFF_BASE_PROGRESS_H
#define EASEOFF_BASE_PROGRESS_H

/* Returns non-zero to ask for a stop (the work then ends with EO_ERROR_CANCELLED).
   what: a short phrase for people, for instance "pinion: factorisation"; fraction: 0..1 of the whole work. */
typedef int eo_progress_function(void *context, const char *what, double fraction);

struct eo_progress {
  eo_progress_function *report; /* NULL: nobody watches */
  void *context;                /* borrowed */
};

/* Reports when somebody watches; returns non-zero when a stop was asked for. progress may be NULL. */
static inline int eo_progress_report(const struct eo_progress *progress, const char *what, double fraction)
{
  return progress && progress->report ? progress->report(progress->context, what, fraction) : 0;
}

#endif
