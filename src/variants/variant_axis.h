/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What varies: from names and numbers as people write them to paths of the document and values. */
#ifndef EASEOFF_VARIANTS_VARIANT_AXIS_H
#define EASEOFF_VARIANTS_VARIANT_AXIS_H

#include "variants/variant_plan.h"

/* Reads a name: "load_cases.*.speed_rpm", "b [inch]", "modification.pinion.both.tip_relief_um",
   "gear_pair.pinion_profile_shift+gear_pair.gear_profile_shift". design: the base. pointer: of the faults. */
void eo_variant_axis_name(struct eo_variant_axis *axis, const char *name, const struct eo_design *design,
                          const char *pointer, struct eo_faults *faults);

/* Takes its values: a list, words or a range. */
void eo_variant_axis_fill(struct eo_variant_axis *axis, const struct eo_study_axis *asked,
                          enum eo_study_sampling sampling, const char *pointer, struct eo_faults *faults);

void eo_variant_axis_done(struct eo_variant_axis *axis);

/* A cell of a table as a value; NULL: it is none. */
json_t *eo_variant_axis_read(const struct eo_variant_axis *axis, const char *cell);

/* How many values a full factorial study takes from it, and the one with a number. */
int eo_variant_axis_count(const struct eo_variant_axis *axis);
json_t *eo_variant_axis_level(const struct eo_variant_axis *axis, int level);

/* The value at x in (0, 1). */
json_t *eo_variant_axis_at(const struct eo_variant_axis *axis, double x);

#endif
