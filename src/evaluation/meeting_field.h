/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The gap field of one end as a load case meets it: flank, sense, alignment and apex offsets of a design. */
#ifndef EASEOFF_EVALUATION_MEETING_FIELD_H
#define EASEOFF_EVALUATION_MEETING_FIELD_H

#include "evaluation/pair.h"

/* design: resolved; its modification and alignment count. spline: [member], of the grids of the flanks that carry;
   NULL: none; borrowed by the field. */
void eo_meeting_field_init(struct eo_gap_field *field, const struct eo_pair *pair, const struct eo_design *design,
                           const struct eo_flank_spline *const spline[2], const struct eo_running *running, int end);

/* How the pinion is held in a load case, by a support of the given stiffness, N/m. */
struct eo_axial_hold eo_meeting_axial_hold(const struct eo_pair *pair, const struct eo_design *design,
                                           const struct eo_running *running, double load, double stiffness);

#endif
