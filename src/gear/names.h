/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What members, ends and flanks are called, in messages, keys and choices. */
#ifndef EASEOFF_GEAR_NAMES_H
#define EASEOFF_GEAR_NAMES_H

extern const char *const eo_member_name[3];     /* [EO_PINION, EO_GEAR], then NULL */
extern const char *const eo_end_name[3];        /* [EO_LEFT, EO_RIGHT], then NULL */
extern const char *const eo_flank_side_name[3]; /* [enum eo_flank_side], then NULL */

#endif
