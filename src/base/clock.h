/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The monotonic clock, for reporting where the time went; results never depend on it. */
#ifndef EASEOFF_BASE_CLOCK_H
#define EASEOFF_BASE_CLOCK_H

#include <time.h>

/* Milliseconds from an arbitrary start. */
static inline double eo_clock_milliseconds(void)
{
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

/* Seconds of a processor that the calling thread has had. */
static inline double eo_clock_thread_seconds(void)
{
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* A time that is being taken. */
struct eo_stopwatch {
  double *slot, start; /* ms */
};

/* Adds the wall time since the start to the slot, ms. */
static inline void eo_stopwatch_stop(const struct eo_stopwatch *stopwatch)
{
  *stopwatch->slot += eo_clock_milliseconds() - stopwatch->start;
}

/* Adds the milliseconds from here to the end of the enclosing block, however it is left, to the double `slot`. */
#define EO_TIMED(slot)               \
  const struct eo_stopwatch eo_timed \
      __attribute__((cleanup(eo_stopwatch_stop), unused)) = {&(slot), eo_clock_milliseconds()}

#endif
