/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a crew can do: a trade turns items into answers, both of them bytes. What it computes from an item depends on
   the order and the item alone, never on the thread, the process or what was asked before, so a result does not depend
   on how many work. Numbers travel as they lie in memory: all of a crew run the same program on one kind of processor
   (crew.h checks it). */
#ifndef EASEOFF_CREW_TRADE_H
#define EASEOFF_CREW_TRADE_H

#include <stdatomic.h>

#include "base/progress.h"
#include "format/text.h"

/* Where a process works. */
struct eo_crew_place {
  const char *cache;      /* folder of prepared pairs; NULL: none */
  int threads;            /* items at a time, 1..EO_MAX_THREADS */
  double memory, seconds; /* most bytes and s of a processor that preparing a pair may take; 0: no bound */
};

/* What all threads of a process share while they work on one order. */
struct eo_crew_bench {
  const struct eo_crew_place *place; /* borrowed */
  const char *order;                 /* [size], ends with NUL; the same in every process of the crew; borrowed */
  size_t size;
  const atomic_bool *stopped; /* whoever works long looks at it and ends with EO_ERROR_CANCELLED */
  void *state;                /* of the trade */
};

/* What asks a trade's long work to end when the crew stops; valid as long as the bench. */
static inline int eo_crew_bench_look(void *bench, const char *what, double fraction)
{
  (void)what;
  (void)fraction;
  return atomic_load(((const struct eo_crew_bench *)bench)->stopped);
}

/* The same as what long computations take. */
static inline struct eo_progress eo_crew_bench_progress(struct eo_crew_bench *bench)
{
  return (struct eo_progress){eo_crew_bench_look, bench};
}

struct eo_crew_trade {
  const char *name; /* known to all of the crew */
  /* Once per process. Errors end the whole run. */
  enum eo_code (*open)(struct eo_crew_bench *bench, struct eo_error *error);
  /* item[size], ends with NUL. thread: 0 .. threads - 1, never two at once. What the model refuses is an answer; an
     error ends the whole run. */
  enum eo_code (*work)(struct eo_crew_bench *bench, int thread, const char *item, size_t size, struct eo_text *answer,
                       struct eo_error *error);
  void (*close)(struct eo_crew_bench *bench); /* also after an open that failed */
};

#endif
