/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A ring of many teeth by condensed chains of 1, 2, 4 .. teeth: log2(z) real steps in place of z/2 complex harmonics.
   Two chains A, B side by side share a face; eliminating it leaves a chain between A's left and B's right face,
       K = A_RR + B_LL,  S_LL = A_LL - A_LR K^-1 A_RL,  S_LR = -A_LR K^-1 B_LR,  S_RR = B_RR - B_RL K^-1 B_LR.
   The forces that balance a floating body stand on every face; each chain carries their three patterns (rotation, two
   translations, as its first tooth sees them) condensed to its ends, and what they move inside, for the mean motion. */
#ifndef EASEOFF_FLEXIBILITY_CHAIN_H
#define EASEOFF_FLEXIBILITY_CHAIN_H

#include "flexibility/ring.h"

/* Floating-point operations of the ring by chains, by harmonics; by chains INFINITY when the ring is too small. */
double eo_chain_cost(const struct eo_ring_tooth *tooth, int reach);

/* Fills motion->left (not the parts). Errors: memory, EO_ERROR_NUMERIC, EO_ERROR_CANCELLED. */
enum eo_code eo_chain_solve(struct eo_ring_motion *motion, const struct eo_ring_tooth *tooth,
                            const struct eo_progress *progress, const char *what, double first, double last,
                            struct eo_error *error);

#endif
