/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Messages between the processes of one run. The ordinary program links no MPI: a module beside it (mpi_ranks.c) gives
   these functions when the program was started by an MPI launcher. */
#ifndef EASEOFF_CREW_RANKS_H
#define EASEOFF_CREW_RANKS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/error.h"

/* Called from one thread. Each returns 0, or the sentence of what failed is in message(). */
struct eo_ranks {
  int (*begin)(int *rank, int *size);
  int (*send)(int to, int tag, const void *data, size_t size); /* copies; returns at once */
  int (*probe)(bool *there, int *from, int *tag, size_t *size);
  int (*receive)(int from, int tag, void *data, size_t size); /* what probe found */
  int (*end)(void);                                           /* waits until all have come here */
  void (*abort)(int status);                                  /* ends all processes of the run */
  const char *(*message)(void);
};

/* The name of the table that a module exports. */
#define EO_RANKS_SYMBOL "eo_mpi_ranks"

/* The module, when this process was started by an MPI launcher; NULL when it was not. EO_ERROR_INPUT when it was and
   there is no module. */
enum eo_code eo_ranks_find(const struct eo_ranks **ranks, struct eo_error *error);

#endif
