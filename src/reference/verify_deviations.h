/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reference cases of flanks as made: terms by name and grids, coast flanks, apex offsets, unequal halves. */
#ifndef EASEOFF_REFERENCE_VERIFY_DEVIATIONS_H
#define EASEOFF_REFERENCE_VERIFY_DEVIATIONS_H

#include "contact/hunting.h"
#include "design/design.h"
#include "gear/flank_grid.h"
#include "reference/verify.h"

enum eo_code eo_verify_deviations(struct eo_case *file, struct eo_verification *verification, struct eo_error *error);

/* The pair of a file as its cases take it. */
void eo_case_deviation_pair(struct eo_case *pair, struct eo_design *design);

/* The geometry that a file states of its pairs, and its table of tolerances by ISO 1328-1:2013. */
enum eo_code eo_verify_deviation_pairs(struct eo_verification *verification, struct eo_case *pairs,
                                       struct eo_error *error);
enum eo_code eo_verify_flank_tolerances(struct eo_verification *verification, struct eo_case *block,
                                        struct eo_error *error);

/* What a case of pitch deviations is computed on: of each end its grid and the gaps of its flanks, m; borrowed. */
struct eo_pitch_bench {
  int ends;
  const struct eo_contact_grid *grid[2];
  const double *gap[2];
  bool inwards;
  struct eo_axial_hold hold;
};

/* Index deviations over the hunting period. */
enum eo_code eo_verify_pitch(struct eo_verification *verification, struct eo_case *item,
                             const struct eo_pitch_bench *bench, struct eo_error *error);

/* A flank of a case file (tip_relief_um, triangular, grid ...): its terms, and its grid in *grids. */
struct eo_flank_modification;
void eo_case_flank(struct eo_case *block, enum eo_flank_side side, int member, int end,
                   struct eo_flank_modification *flank, struct eo_flank_grids *grids);

#endif
