/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pairs as made that a crew evaluates (crew/crew.h): rank 0 draws them and keeps their rows. */
#ifndef EASEOFF_STUDY_SCATTER_CREW_H
#define EASEOFF_STUDY_SCATTER_CREW_H

#include "base/progress.h"
#include "crew/crew.h"
#include "evaluation/design_scatter.h"

/* The order is the complete design, an item the drawn values of a pair (none: the design itself), an answer its row and
 * what it cost. */
extern const struct eo_crew_trade eo_scatter_trade;

/* What eo_scatter_run_pairs() does, to the same bytes, without a pair of its own. scatter: that of the design's block,
   eo_scatter_of_design() with a class assumed. plan->threads is the crew's. Errors: as there, and of the crew. */
enum eo_code eo_scatter_run_on_crew(struct eo_scatter_run *run, struct eo_crew *crew, const struct eo_design *design,
                                    const struct eo_scatter *scatter, const struct eo_scatter_plan *plan,
                                    const struct eo_progress *progress, struct eo_error *error);

#endif
