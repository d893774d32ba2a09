/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a study will take, said before it begins. */
#ifndef EASEOFF_VARIANTS_VARIANT_COST_H
#define EASEOFF_VARIANTS_VARIANT_COST_H

#include "format/outline.h"
#include "store/store.h"
#include "variants/variant_plan.h"

struct eo_variant_cost {
  int rows, pairs, refused_pairs; /* variants; gear pairs to be prepared; first variants of a pair that are refused */
  double memory;                  /* bytes of the largest preparation */
  double preparation;             /* s of a processor of 2023, for all pairs that are not kept already */
  double evaluation;              /* s of a processor for one variant, mean of earlier ones; NaN: none is known */
  double kept;                    /* bytes of the rows in the data folder */
};

extern const struct eo_outline eo_variant_cost_outline;

/* store: NULL, or what knows how long evaluations took. Errors: memory, the store's. */
enum eo_code eo_variant_cost_find(const struct eo_variant_plan *plan, struct eo_store *store,
                                  struct eo_variant_cost *cost, struct eo_error *error);

#endif
