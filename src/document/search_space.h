/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From a design's optimization to what an optimizer works with: the unit cube over the variables. */
#ifndef EASEOFF_DOCUMENT_SEARCH_SPACE_H
#define EASEOFF_DOCUMENT_SEARCH_SPACE_H

#include <jansson.h>

#include "base/hash.h"
#include "format/table.h"
#include "design/design.h"
#include "gear/geometry.h"

/* One coordinate of the unit cube. */
struct eo_study_variable {
  int member, end;              /* end: EO_LEFT, EO_RIGHT or EO_BOTH_ENDS (the same on both) */
  int side;                     /* EO_DRIVE_FLANK, EO_COAST_FLANK or EO_BOTH_FLANKS (the same on both) */
  const struct eo_field *field; /* of eo_flank_modification_table, or eo_grid_number_field */
  double low, high;             /* in the unit of its key */
  int row, column;              /* of the grid, from 1 on; 0: all; of numbers of a grid */
};

extern const char *const eo_variable_end_name[4]; /* [EO_LEFT, EO_RIGHT, EO_BOTH_ENDS], then NULL */

struct eo_study_space {
  int count;
  struct eo_study_variable variable[EO_MAX_LISTED];
};

/* The variables of a resolved design. Shared and per end: the five parameters of the paper on the pinion, of both ends
   or of the left and then the right one. EO_ERROR_INPUT, with the key: what eo_design_check_search() refuses, two
   variables for one parameter, bounds that a flank cannot have, an end that is not there. */
enum eo_code eo_study_space_init(struct eo_study_space *space, const struct eo_design *design,
                                 const struct eo_geometry *geometry, struct eo_error *error);

/* *modification = base with the variables at x[count] in the unit cube; every number is one the document can express.
 */
void eo_study_space_apply(const struct eo_study_space *space, const struct eo_modification *base, const double *x,
                          struct eo_modification *modification);

/* The way back. False when the modification is not in this space: out of bounds, ends differ that are tied, or another
   base. */
bool eo_study_space_locate(const struct eo_study_space *space, const struct eo_modification *base,
                           const struct eo_modification *modification, double *x);

/* Value of a variable in a modification, in the unit of its key; its name, "pinion/both/tip_relief_um". */
double eo_study_variable_value(const struct eo_study_variable *variable, const struct eo_modification *modification);
void eo_study_variable_name(const struct eo_study_variable *variable, char *name, size_t size);

/* block[count]: variables of one end, of the other, of both are a block each, since every end carries its own load;
   returns how many blocks there are, at most 3. */
int eo_study_space_blocks(const struct eo_study_space *space, int *block);

/* Two spaces with the same hash have the same variables with the same bounds in the same order. */
void eo_study_space_hash(const struct eo_study_space *space, char hex[EO_HASH_LENGTH + 1]);

/* A modification as canonical JSON without defaults, "{}" for none, and back. ends: of the pair. */
enum eo_code eo_modification_write(const struct eo_modification *modification, int ends, struct eo_text *text,
                                   struct eo_error *error);
/* For tables: the columns of rows with such a "modification" each, "pinion/left/tip_relief_um" true for all that stand
   in any, the caller's to release; NULL: no memory. In the rows a number in place of a grid's gets a name of its own,
   "grid_um[u2 y*]", as variables have it. */
json_t *eo_modification_columns(const json_t *rows);
enum eo_code eo_modification_read(const char *text, struct eo_modification *modification, struct eo_error *error);

#endif
