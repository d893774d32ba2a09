/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Many pairs as made: each drawn, evaluated as far as its numbers are asked for, and kept as one row. */
#ifndef EASEOFF_EVALUATION_DESIGN_SCATTER_H
#define EASEOFF_EVALUATION_DESIGN_SCATTER_H

#include "evaluation/pair_distances.h"
#include "evaluation/scalar.h"
#include "tolerance/pair_completion.h"
#include "tolerance/scatter.h"

enum { EO_SCATTER_MOST_PAIRS = 100000 };
#define EO_SCATTER_PROGRESS "pairs as made"

/* A row that is known from before is not computed again; each new one is handed over once, from several threads, one at
   a time. */
struct eo_scatter_log {
  bool (*find)(void *context, int pair, double *output); /* fills output[outputs]; NULL: nothing is known */
  /* cost: s of a processor; output stays until the run is done. NULL: nowhere */
  enum eo_code (*keep)(void *context, int pair, const double *output, double cost, struct eo_error *error);
  void *context;
};

struct eo_scatter_plan {
  int pairs;
  enum eo_sampling sampling;
  uint64_t seed;
  bool vibration, root_stress; /* the numbers that need them are NaN without */
  int threads;                 /* 0: eo_parallel_cores() */
  struct eo_scatter_log log;
};

/* One column per number of each load case: scalar * cases + load case. */
struct eo_scatter_run {
  int pairs, inputs, cases, scalars, outputs, bounded; /* bounded: draws that met a bound of their key */
  double *input;                                       /* [pairs][inputs], in the units of the keys */
  double *output;                                      /* [pairs][outputs], in the units of the scalars; NaN: none */
  bool *full;     /* [pairs]: computed as an analysis does; the others are completed: tolerance/pair_completion.h */
  double *coarse; /* [pairs][outputs]; NULL: every pair is in full */
  struct eo_completed *completed; /* [outputs]; with coarse */
  double *nominal;                /* [outputs], of the design itself */
};

/* Numbers of a row of the design: those of the hunting period where its pairs have teeth of their own. */
int eo_scatter_outputs(const struct eo_design *design);

/* Evaluates pairs as made, one after the other; a row depends on the values alone, not on what came before. */
struct eo_scatter_bench;

/* distances of the pair that serves the design (resolved), design and scatter are borrowed. Errors: memory. */
enum eo_code eo_scatter_bench_new(struct eo_scatter_bench **bench, struct eo_pair_distances *distances,
                                  const struct eo_design *design, const struct eo_scatter *scatter, bool vibration,
                                  bool root_stress, struct eo_error *error);
/* input[inputs] in the units of the keys; NULL: the design itself. output[eo_scatter_outputs()]. Errors: of the
   evaluator, of a pair at another distance. */
enum eo_code eo_scatter_bench_run(struct eo_scatter_bench *bench, const double *input, double *output,
                                  struct eo_error *error);
void eo_scatter_bench_free(struct eo_scatter_bench *bench); /* NULL is fine */

/* Draws the pairs and makes room for their rows, which whoever evaluates them fills in: all are said to be in full,
   unless the design is coarse first (scatter_levels.h). Errors: EO_ERROR_INPUT (pairs), memory. eo_scatter_run_done()
   also after an error. */
enum eo_code eo_scatter_run_draw(struct eo_scatter_run *run, const struct eo_design *design,
                                 const struct eo_scatter *scatter, const struct eo_scatter_plan *plan,
                                 struct eo_error *error);

/* design: resolved, served by the pair. The same bytes for any number of threads. Errors: EO_ERROR_INPUT (pairs,
   supports), memory, cancelled, of the log. eo_scatter_run_done() also after an error. */
enum eo_code eo_scatter_run_pairs(struct eo_scatter_run *run, const struct eo_pair *pair,
                                  const struct eo_design *design, const struct eo_scatter *scatter,
                                  const struct eo_scatter_plan *plan, const struct eo_progress *progress,
                                  struct eo_error *error);
void eo_scatter_run_done(struct eo_scatter_run *run); /* NULL is fine */

#endif
