/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which pairs of a run are there, so that one that is stopped can say something of those. */
#ifndef EASEOFF_EVALUATION_SCATTER_TALLY_H
#define EASEOFF_EVALUATION_SCATTER_TALLY_H

#include "evaluation/design_scatter.h"

/* Fewer pairs in full say nothing. */
enum { EO_SCATTER_FEWEST = 10 };

struct eo_scatter_tally {
  struct eo_scatter_log log; /* that of the run, which the tally hands everything on to */
  int pairs;
  bool *there; /* [pairs], in full; owned */
};

/* Errors: memory. eo_scatter_tally_done() also after an error. */
enum eo_code eo_scatter_tally_init(struct eo_scatter_tally *tally, int pairs, const struct eo_scatter_log *log,
                                   struct eo_error *error);
void eo_scatter_tally_done(struct eo_scatter_tally *tally);

/* The log for the plan of the run. */
struct eo_scatter_log eo_scatter_tally_log(struct eo_scatter_tally *tally);

/* Of a run that was stopped one of what is there, where this is enough; *full: its pairs in full. Coarse first these
   are all pairs, completed by those in full; else the first ones, as far as none is missing: they are drawn as well as
   all are, and none is left out because it takes long. Where *full is below EO_SCATTER_FEWEST the run is of no use.
   Errors: memory. */
enum eo_code eo_scatter_tally_settle(const struct eo_scatter_tally *tally, const struct eo_design *design,
                                     struct eo_scatter_run *run, int *full, struct eo_error *error);

#endif
