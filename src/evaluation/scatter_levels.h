/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pairs as made at two levels: all on a coarse grid, and in full as many as the percentiles take; what single teeth do
   follows from few solutions (contact/tooth_courses.h), more of them in full. Which ones follows from the rows alone,
   so that threads, ranks and a resumed run change nothing. */
#ifndef EASEOFF_EVALUATION_SCATTER_LEVELS_H
#define EASEOFF_EVALUATION_SCATTER_LEVELS_H

#include "evaluation/design_scatter.h"

/* Whether the design's pairs are computed coarsely first: as its method says, but never with root stress, with halves
   that differ, or with single teeth and a pinion that is held along its axis. */
bool eo_scatter_is_coarse_first(const struct eo_design *design);

/* The design with the resolution of the coarse level, and a pair that serves it. pair: that of the design, borrowed as
   long as the coarse one lives. Errors: memory, cancelled. */
void eo_scatter_make_coarse(struct eo_design *coarse, const struct eo_design *design);
enum eo_code eo_scatter_coarse_pair(struct eo_pair **coarse, const struct eo_pair *pair, const struct eo_design *design,
                                    const struct eo_progress *progress, struct eo_error *error);

/* Computes the rows of these pairs, of run->coarse or of run->output, while the progress goes from first to last. */
struct eo_scatter_stage {
  bool coarse;
  int count;
  const int *pair; /* [count] */
  double first, last;
};
typedef enum eo_code eo_scatter_compute(void *context, const struct eo_scatter_stage *stage, struct eo_error *error);

/* Computes and completes what the design asks for: run as eo_scatter_run_draw() left it. Errors: of compute, memory. */
enum eo_code eo_scatter_run_levels(struct eo_scatter_run *run, const struct eo_design *design,
                                   eo_scatter_compute *compute, void *context, struct eo_error *error);

/* Pairs in full. */
int eo_scatter_full_pairs(const struct eo_scatter_run *run);

/* A run's rows as the completion sees them. */
struct eo_completion eo_scatter_completion(const struct eo_scatter_run *run, const struct eo_design *design);

#endif
