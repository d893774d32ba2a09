/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Designs side by side on the same pairs as made: the unmodified pair, and flanks that a search or a paper proposes.
   The pairs are drawn from the block `tolerance` behind those that a robust search has seen, so that what was found is
   not judged by what found it. */
#ifndef EASEOFF_STUDY_MADE_CHECK_H
#define EASEOFF_STUDY_MADE_CHECK_H

#include "base/progress.h"
#include "document/made_check_document.h"
#include "evaluation/pair.h"
#include "design/design.h"

struct eo_made_plan {
  const struct eo_design *design; /* complete; borrowed, as all here */
  const struct eo_pair *pair;     /* serves it */
  int designs;                    /* beside the unmodified pair */
  const struct eo_modification *modification[EO_MADE_DESIGNS];
  const char *name[EO_MADE_DESIGNS]; /* for people */
  int pairs, threads;                /* threads 0: eo_parallel_cores() */
  const struct eo_progress *progress;
};

/* The same numbers for any number of threads. Errors: of the scatter, memory, cancelled. eo_made_check_done() also
   after an error. */
enum eo_code eo_made_check_run(struct eo_made_check *check, const struct eo_made_plan *plan, struct eo_error *error);

#endif
