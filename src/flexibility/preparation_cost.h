/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the preparation of a pair takes, said before it begins. */
#ifndef EASEOFF_FLEXIBILITY_PREPARATION_COST_H
#define EASEOFF_FLEXIBILITY_PREPARATION_COST_H

#include "flexibility/flexibility.h"

struct eo_preparation_cost {
  double memory;  /* bytes at the most crowded moment */
  double seconds; /* of one processor of 2023: half or twice as long on others */
};

/* From the numbers of nodes of both sections; nothing is assembled. Halves that differ are prepared one after the
   other: the time of both, the memory of the larger one. Right within a factor of two where the whole takes more than a
   second (tests/unit/flexibility/test-cost.c). Errors: as eo_flexibility_prepare() for wrong settings, memory. */
enum eo_code eo_preparation_cost_find(const struct eo_geometry *geometry, const struct eo_gear_pair *pair,
                                      const struct eo_flexibility_settings *settings, struct eo_preparation_cost *cost,
                                      struct eo_error *error);

#endif
