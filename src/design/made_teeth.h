/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Teeth of pairs as made: where the block `tolerance` asks for single teeth, every pair has index deviations of its
   own, drawn from a class (rating/pitch_deviation.h) by a seed and to a share that the pair brings. */
#ifndef EASEOFF_DESIGN_MADE_TEETH_H
#define EASEOFF_DESIGN_MADE_TEETH_H

struct eo_design;

/* States the teeth that pairs are drawn with: a member without a class of its own has that of the block. Their share of
   the tolerances is 0: what is stated (tables, eccentricities) stands, everything else is alike. Nothing changes where
   single teeth are not asked for. */
void eo_design_state_teeth(struct eo_design *design);

#endif
