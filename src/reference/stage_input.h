/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What several stages read and write alike: parts of a design, places on a flank, columns of numbers. */
#ifndef EASEOFF_REFERENCE_STAGE_INPUT_H
#define EASEOFF_REFERENCE_STAGE_INPUT_H

#include "contact/field.h"
#include "document/design_document.h"
#include "evaluation/objective.h"
#include "gear/names.h"

/* Rows of an input table whose struct starts with `struct eo_design design`. */
#define EO_STAGE_GEAR_PAIR(type) \
  EO_OBJECT(type, design.gear_pair, "gear_pair", &eo_gear_pair_table, "as in a design document")
#define EO_STAGE_MATERIAL(type) \
  EO_OBJECT(type, design.material, "material", &eo_material_table, "as in a design document")
#define EO_STAGE_ALIGNMENT(type) \
  EO_OBJECT(type, design.alignment, "alignment", &eo_alignment_table, "as in a design document")
#define EO_STAGE_MODIFICATION(type) \
  EO_OBJECT(type, design.modification, "modification", &eo_modification_terms_table, "as in a design document")
#define EO_STAGE_RESOLUTION(type) \
  EO_OBJECT(type, design.resolution, "resolution", &eo_resolution_table, "as in a design document")

extern const char *const eo_stage_pivots[];
#define EO_STAGE_MEMBER(type, member) EO_CHOICE(type, member, "member", eo_member_name, EO_PINION, "whose flank")
#define EO_STAGE_END(type, member)                     \
  EO_CHOICE(type, member, "end", eo_end_name, EO_LEFT, \
            "of the two helical halves; a pair with one end has the left one")

enum eo_stage_pivot { EO_PIVOT_GROOVE, EO_PIVOT_MID_FACE };
#define EO_STAGE_PIVOT(type, member)                                 \
  EO_CHOICE(type, member, "pivot", eo_stage_pivots, EO_PIVOT_GROOVE, \
            "of the shaft angle errors: middle of the groove, or each end's own mid face")

/* Raw values of one load case (struct eo_objective_case): what stage evaluation prints and stage objective reads. */
extern const struct eo_table eo_stage_raw_table;
enum { EO_STAGE_RAW = EO_MAX_LOAD_CASES * EO_MAX_SCENARIOS };

enum { EO_STAGE_MOST = 100000 }; /* rows of a column that a stage takes */

/* Derived values and checks, as for a whole design. end: which one the stage asks for. */
enum eo_code eo_stage_complete(struct eo_design *design, struct eo_geometry *geometry, int end, struct eo_error *error);

/* A gap field with its tables and the geometry it borrows. */
struct eo_stage_field {
  struct eo_geometry geometry;
  struct eo_corner_gap corner[2];
  struct eo_gap_field gap;
  double pivot; /* distance of the end's mid face from the pivot of the shaft angle errors, m */
};
enum eo_code eo_stage_field_init(struct eo_stage_field *field, struct eo_design *design, int end,
                                 enum eo_stage_pivot pivot, struct eo_error *error);

/* EO_ERROR_INPUT naming `key` unless both columns have the same length. */
enum eo_code eo_stage_same_length(const struct eo_numbers *first, const char *first_key,
                                  const struct eo_numbers *second, const char *key, struct eo_error *error);

/* Allocates columns of `rows` zeros for the output. */
enum eo_code eo_stage_columns(int columns, struct eo_numbers *series, int rows, struct eo_error *error);

/* The same, and copies value[rows]. */
enum eo_code eo_stage_copy(struct eo_numbers *series, int rows, const double *value, struct eo_error *error);

#endif
