/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reference cases of flanks as made: terms by name and grids, coast flanks, apex offsets, unequal halves. */
#ifndef EASEOFF_REFERENCE_VERIFY_DEVIATIONS_H
#define EASEOFF_REFERENCE_VERIFY_DEVIATIONS_H

#include "gear/flank_grid.h"
#include "reference/verify.h"

enum eo_code eo_verify_deviations(struct eo_case *file, struct eo_verification *v, struct eo_error *error);

/* A flank of a case file (tip_relief_um, triangular, grid ...): its terms, and its grid in *grids. */
struct eo_flank_modification;
void eo_case_flank(struct eo_case *block, enum eo_flank_side side, int member, int end,
                   struct eo_flank_modification *flank, struct eo_flank_grids *grids);

#endif
