/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names of a table's rows, conditions on them, and the order: read from text, applied to rows. */
#ifndef EASEOFF_VARIANTS_VARIANT_QUERY_H
#define EASEOFF_VARIANTS_VARIANT_QUERY_H

#include "store/variant_rows.h"
#include "variants/variant_table.h"

/* What a name stands for in a row. */
struct eo_variant_name {
  enum { EO_NAME_VARIANT, EO_NAME_OUTCOME, EO_NAME_AXIS, EO_NAME_COLUMN } kind;
  int index;
};

struct eo_variant_condition {
  struct eo_variant_name name;
  enum { EO_LESS, EO_AT_MOST, EO_MORE, EO_AT_LEAST, EO_EQUAL, EO_UNEQUAL } relation;
  double value;
};

struct eo_variant_conditions {
  int count;
  struct eo_variant_condition condition[EO_VARIANT_FILTERS];
  struct eo_variant_name sort;
};

/* Errors: EO_ERROR_INPUT with pointer "/filter" or "/sort". */
enum eo_code eo_variant_query_read(const struct eo_variant_table *table, const struct eo_variant_query *query,
                                   struct eo_variant_conditions *conditions, struct eo_error *error);

/* The number of a name in a row; NaN: none. A word is its place among the values that were asked for. */
double eo_variant_number(const struct eo_variant_table *table, const struct eo_variant_name *name,
                         const struct eo_stored_variant *row);

/* Whether a row meets all conditions; of a number that it does not have only `not equal` holds. */
bool eo_variant_fits(const struct eo_variant_table *table, const struct eo_variant_conditions *conditions,
                     const struct eo_stored_variant *row);

#endif
