/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ranks on MPI (MPI 3.1), as a module that the program loads: eo_ranks_find(). */
#include "crew/ranks.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <mpi.h>

/* A message that may not have left yet. */
struct pending {
  MPI_Request request;
  void *data; /* owned */
  struct pending *next;
};

static struct pending *first_pending;
static char message[MPI_MAX_ERROR_STRING + 1];

static int check(int code)
{
  int length = 0;
  if (code == MPI_SUCCESS)
    return 0;
  if (MPI_Error_string(code, message, &length) != MPI_SUCCESS)
    snprintf(message, sizeof message, "MPI error %d", code);
  return 1;
}

static int fail(const char *text)
{
  snprintf(message, sizeof message, "%s", text);
  return 1;
}

static int begin(int *rank, int *size)
{
  int provided;
  /* threads work beside the one that talks */
  if (check(MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &provided)))
    return 1;
  if (provided < MPI_THREAD_FUNNELED)
    return fail("MPI allows no threads");
  return check(MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN)) ||
         check(MPI_Comm_rank(MPI_COMM_WORLD, rank)) || check(MPI_Comm_size(MPI_COMM_WORLD, size));
}

/* Lets go of what has left. */
static int tidy(void)
{
  for (struct pending **at = &first_pending; *at;) {
    struct pending *pending = *at;
    int done = 0;
    if (check(MPI_Test(&pending->request, &done, MPI_STATUS_IGNORE)))
      return 1;
    if (!done) {
      at = &pending->next;
      continue;
    }
    *at = pending->next;
    free(pending->data);
    free(pending);
  }
  return 0;
}

static int send(int to, int tag, const void *data, size_t size)
{
  struct pending *pending = malloc(sizeof *pending);
  void *copy = malloc(size ? size : 1);
  if (!pending || !copy || size > INT_MAX) {
    free(pending);
    free(copy);
    return fail("no memory for a message");
  }
  memcpy(copy, data, size);
  pending->data = copy;
  pending->next = first_pending;
  if (check(MPI_Isend(copy, (int)size, MPI_BYTE, to, tag, MPI_COMM_WORLD, &pending->request))) {
    free(copy);
    free(pending);
    return 1;
  }
  first_pending = pending;
  return tidy();
}

static int probe(bool *there, int *from, int *tag, size_t *size)
{
  int flag = 0, count = 0;
  MPI_Status status;
  if (tidy() || check(MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &flag, &status)))
    return 1;
  *there = flag;
  if (!flag)
    return 0;
  if (check(MPI_Get_count(&status, MPI_BYTE, &count)))
    return 1;
  *from = status.MPI_SOURCE;
  *tag = status.MPI_TAG;
  *size = (size_t)count;
  return 0;
}

static int receive(int from, int tag, void *data, size_t size)
{
  return check(MPI_Recv(data, (int)size, MPI_BYTE, from, tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE));
}

static int end(void)
{
  while (first_pending)
    if (tidy())
      return 1;
  return check(MPI_Finalize());
}

static void abort_all(int status)
{
  MPI_Abort(MPI_COMM_WORLD, status);
}

static const char *describe(void)
{
  return message;
}

extern const struct eo_ranks eo_mpi_ranks;
const struct eo_ranks eo_mpi_ranks = {begin, send, probe, receive, end, abort_all, describe};
