/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Jobs handed to a launcher (mpirun, srun, a script): it starts this program on the machines of its own, with
   `easeoff optimize|study|tolerance --work N --data DIR`, which works on the job's row like anybody else, notes how far
   it is there and looks there whether it shall stop. */
#ifndef EASEOFF_SERVICE_LAUNCHER_H
#define EASEOFF_SERVICE_LAUNCHER_H

#include "store/jobs.h"

struct eo_launch {
  const char *launcher; /* words, separated by blanks: "mpirun -n 64 --hostfile hosts" */
  const char *program;  /* path of easeoff on every machine */
  const char *data;
  enum eo_job_kind kind;
  int64_t job;
};

/* What the caller wants of a launcher that runs: asked some times a second. */
enum eo_launch_wish {
  EO_LAUNCH_GO_ON,
  EO_LAUNCH_END,      /* it was asked to end by its job's row: if it does not, it is ended after a while */
  EO_LAUNCH_END_SOON, /* it is ended */
};
typedef enum eo_launch_wish eo_launch_watch(void *context);

/* Waits for its end. *status: as of waitpid(). Errors: EO_ERROR_MEMORY (no process), EO_ERROR_INPUT (there is no such
   launcher). */
enum eo_code eo_launch_run(const struct eo_launch *launch, eo_launch_watch *watch, void *context, int *status,
                           struct eo_error *error);

#endif
