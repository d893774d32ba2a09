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

#endif
