/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of the kind "rating": inputs, expected numbers as a report prints them, and where known as formulae give them at
   full precision. Readers shared by the files that know the quantities. */
#ifndef EASEOFF_REFERENCE_VERIFY_RATING_H
#define EASEOFF_REFERENCE_VERIFY_RATING_H

#include "rating/rating_pair.h"
#include "reference/verify.h"

struct eo_rating_row {
  struct eo_verification *v;
  struct eo_case *inputs, *expected;
  const char *edition;
};

/* Inputs. number: a fault when absent. or: a substitute. A key of NULL ends lists of keys. */
double eo_row_number(struct eo_rating_row *row, const char *key);
double eo_row_number_or(struct eo_rating_row *row, const char *key, double missing);
bool eo_row_has(struct eo_rating_row *row, const char *key);
/* Two numbers, or one for both. */
void eo_row_both(struct eo_rating_row *row, const char *key, double value[2]);
/* Angle in degrees to rad. */
double eo_row_angle(struct eo_rating_row *row, const char *key, double missing_degrees);
/* Inputs that say what the row is of and do not enter the quantity; numbers all the same. */
void eo_row_unused(struct eo_rating_row *row, const char *const *keys);
/* Member index 0 or 1, from "member": 1 or 2; the first when absent. */
int eo_row_member(struct eo_rating_row *row);

/* Compares an expected number, where the row has it: printed and formula, both within the tolerance. */
void eo_row_check(struct eo_rating_row *row, const char *key, double value);
/* The same with what the rounding of an input adds to the tolerance. */
void eo_row_check_rounded(struct eo_rating_row *row, const char *key, double value, double rounding);

/* Teeth, module, angles, width, distance and tips of a pair, SI; what the row lacks is NaN, width 1. */
void eo_row_pair(struct eo_rating_row *row, struct eo_rating_pair *pair);

typedef enum eo_code eo_row_function(struct eo_rating_row *row, struct eo_error *error);

/* Drawing dimensions. */
eo_row_function eo_row_geometry, eo_row_thickness, eo_row_allowance, eo_row_backlash, eo_row_tolerances;
/* General factors. */
eo_row_function eo_row_stiffness, eo_row_mass, eo_row_dynamic, eo_row_transverse, eo_row_root_face, eo_row_face;
/* Strength. */
eo_row_function eo_row_contact, eo_row_flank_strength, eo_row_root, eo_row_root_strength, eo_row_life, eo_row_damage,
    eo_row_material, eo_row_service_life;

#endif
