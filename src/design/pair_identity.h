/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the preparation of a pair depends on: gear pair, material, and of the resolution what the finite elements and
   the contact grid are made of. Whoever keeps prepared pairs tells them apart by this and by nothing else. (The cache
   on disk keeps the finite-element tables alone, which depend on less: flexibility/prepare.c.) */
#ifndef EASEOFF_DESIGN_PAIR_IDENTITY_H
#define EASEOFF_DESIGN_PAIR_IDENTITY_H

#include <stdbool.h>

#include "base/hash.h"
#include "design/design.h"

enum { EO_PAIR_MEMBERS = 58 };

/* One number for each member. */
struct eo_pair_identity {
  double value[EO_PAIR_MEMBERS];
};

/* Of resolved members of a design; deviation: from the centre distance, m. */
struct eo_pair_identity eo_pair_identity_of(const struct eo_gear_pair *pair, const struct eo_material *material,
                                            const struct eo_resolution *resolution, double deviation);
struct eo_pair_identity eo_pair_identity_of_design(const struct eo_design *design);

/* True when one prepared pair serves both. */
bool eo_pair_identity_equal(const struct eo_pair_identity *a, const struct eo_pair_identity *b);

/* The same as a key: equal identities have equal keys. */
void eo_pair_identity_key(const struct eo_pair_identity *identity, char key[EO_HASH_LENGTH + 1]);

#endif
