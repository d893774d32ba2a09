/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A study made ready: which variant has which values. A variant is a pure function of its number, counted from 0. */
#ifndef EASEOFF_VARIANTS_VARIANT_PLAN_H
#define EASEOFF_VARIANTS_VARIANT_PLAN_H

#include "document/design_document.h"
#include "exchange/design_keys.h"
#include "tolerance/pair_sampler.h"
#include "variants/variant_order.h"

struct eo_variant_axis {
  char name[400]; /* as it was asked for, its unit in brackets where it has one of its own */
  int paths;
  char (*path)[EO_KEY_PATH];    /* [paths] of the document, which take the same value; owned */
  const struct eo_field *field; /* of the first path */
  double factor;                /* from a value to the unit of the key */
  bool of_pair;                 /* a variant may need another prepared pair */
  json_t *levels;               /* array, owned; NULL: from a range */
  double from, to;
  int points;
};

struct eo_variant_plan {
  char name[EO_NAME_LENGTH], columns[2000];
  json_t *base;             /* the design as it was stated; owned */
  struct eo_design *design; /* complete; owned */
  struct eo_geometry geometry;
  int axes, rows;
  struct eo_variant_axis axis[EO_STUDY_AXES];
  json_t *table; /* array of rows of values; NULL: from the axes; owned */
  enum eo_study_sampling sampling;
  int samples;
  uint64_t seed;
  struct eo_sampler *sampler; /* of samples; owned */
  bool of_modification; /* nothing but the modification varies, and no grid: all are of one problem of the history */
  char study_hash[EO_HASH_LENGTH + 1];  /* equal studies have equal rows */
  char design_hash[EO_HASH_LENGTH + 1]; /* of what is evaluated of the base design */
};

/* Reads a study's document. Errors: every fault of the order and of the design goes to faults; false then. done() in
   any case. */
bool eo_variant_plan_init(struct eo_variant_plan *plan, const json_t *document, struct eo_faults *faults);
void eo_variant_plan_done(struct eo_variant_plan *plan);

/* The document once more, with nothing left open but the design's defaults: kept with the job. NULL without memory. */
json_t *eo_variant_plan_encode(const json_t *document, const struct eo_variant_plan *plan);

/* The values of a variant, in the order of the axes: a new array; NULL without memory. */
json_t *eo_variant_values(const struct eo_variant_plan *plan, int row);

/* What identifies a variant's evaluation: equal hashes, equal designs. values: of eo_variant_values(). Errors: memory.
 */
enum eo_code eo_variant_hash(const struct eo_variant_plan *plan, const json_t *values, char hash[EO_HASH_LENGTH + 1],
                             struct eo_error *error);

/* The variants in the order in which they are evaluated, order[rows]: those of one gear pair together, a pair in the
   place of its first variant. *pairs: how many. Errors: memory. */
enum eo_code eo_variant_sort(const struct eo_variant_plan *plan, int *order, int *pairs, struct eo_error *error);

/* The design of a variant, complete; a value null leaves the base as it is. Errors: EO_ERROR_INPUT (what the design may
 * not be), memory. */
enum eo_code eo_variant_design(const json_t *base, const struct eo_variant_axis *axis, int axes, const json_t *values,
                               struct eo_design *design, struct eo_geometry *geometry, struct eo_error *error);

#endif
