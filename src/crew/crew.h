/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The one way to compute many independent things at once: on the threads of this process, or on the ranks of an MPI
   run. The caller gives items and takes answers, on its own thread and in the order of the items, so that what it
   writes down is the same for any number of threads and ranks. In an MPI run rank 0 gives and takes; the others serve,
   each with threads of its own. A process that dies ends the run (mpirun, srun); what was taken is the caller's. */
#ifndef EASEOFF_CREW_CREW_H
#define EASEOFF_CREW_CREW_H

#include "crew/ranks.h"
#include "crew/trade.h"

struct eo_hands;

/* What a process says of itself. */
struct eo_crew_member {
  char program[64]; /* name and version */
  char kernel[16];  /* of numerics/gram.h */
  char blas[32];    /* kernels of the BLAS */
  int threads;
};

struct eo_crew {
  struct eo_crew_place place;
  const struct eo_ranks *ranks; /* NULL: this process alone */
  int rank, size;
  struct eo_crew_member *member; /* [size], of rank 0; owned */
  /* The order that the benches are open for: the next task with the same one goes on at them. */
  const struct eo_crew_trade *trade; /* NULL: none */
  struct eo_text order;
  int order_number;       /* between ranks: grows with every order */
  struct eo_hands *hands; /* of a process alone */
};

/* Finds out whether an MPI launcher started this process, and with rank 0 who else is there. place: of this process; it
   is copied, its texts are borrowed. Errors: EO_ERROR_INPUT (no module; programs or processors of which the numbers
   would differ, with the remedy), EO_ERROR_FILE (MPI), memory. */
enum eo_code eo_crew_begin(struct eo_crew *crew, const struct eo_crew_place *place, struct eo_error *error);

/* The threads of this process alone, whatever started it. */
void eo_crew_alone(struct eo_crew *crew, const struct eo_crew_place *place);

/* Whether somebody else leads: then eo_crew_serve() is all there is to do. */
bool eo_crew_is_led(const struct eo_crew *crew);

/* Works for rank 0 until that ends the run. trades: ends with NULL. */
enum eo_code eo_crew_serve(const struct eo_crew *crew, const struct eo_crew_trade *const *trades,
                           struct eo_error *error);

/* Ends the run: the others go home. {0} and a crew that did not begin are fine. */
void eo_crew_end(struct eo_crew *crew);

/* Items that are worked on at once. */
int eo_crew_strength(const struct eo_crew *crew);

struct eo_crew_task {
  const struct eo_crew_trade *trade;
  const char *order; /* [size], what all items have in common */
  size_t size;
  int items;
  /* The item's bytes, appended. */
  enum eo_code (*write)(void *context, int item, struct eo_text *text, struct eo_error *error);
  /* Its answer; items come in ascending order. answer[size] ends with NUL. */
  enum eo_code (*take)(void *context, int item, const char *answer, size_t size, struct eo_error *error);
  int (*watch)(void *context); /* several times a second; non-zero asks for a stop. NULL: nobody watches */
  void *context;
};

/* How far answers may be ahead of the lowest that is missing: more would have to be done again after a kill. */
enum { EO_CREW_AHEAD = 4096 };

/* Errors: of the trade (of the lowest item), of write and take, EO_ERROR_CANCELLED after a stop: what was done in
   order until then has been taken. */
enum eo_code eo_crew_run(struct eo_crew *crew, const struct eo_crew_task *task, struct eo_error *error);

#endif
