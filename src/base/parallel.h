/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Independent items on several threads: handed out in ascending order, each with the number of the thread that runs it,
   so that every thread can have workspaces of its own. What an item computes must not depend on which thread runs it;
   then results do not depend on the number of threads. */
#ifndef EASEOFF_BASE_PARALLEL_H
#define EASEOFF_BASE_PARALLEL_H

#include "base/error.h"
#include "base/progress.h"

enum { EO_MAX_THREADS = 256 };

/* thread: 0 .. threads - 1; thread 0 is the calling one. */
typedef enum eo_code eo_parallel_function(void *context, int thread, int item, struct eo_error *error);

struct eo_parallel {
  int threads; /* 1..EO_MAX_THREADS, see eo_parallel_cores() */
  eo_parallel_function *work;
  void *context;                      /* borrowed; shared by all threads */
  const struct eo_progress *progress; /* called from the calling thread alone; NULL: nobody watches */
  const char *what;                   /* for the progress */
  double first, last;                 /* fraction of the whole work at the start and at the end of these items */
};

/* Threads that can run at once: processors that this process may use, 1..EO_MAX_THREADS. */
int eo_parallel_cores(void);

/* Runs items 0 .. items - 1. After an error no further item is started and the error of the lowest failing item is
   handed up, the same for any number of threads. Where no thread can be made, fewer do the work. Errors: of the work,
   EO_ERROR_CANCELLED. */
enum eo_code eo_parallel_run(const struct eo_parallel *parallel, int items, struct eo_error *error);

#endif
