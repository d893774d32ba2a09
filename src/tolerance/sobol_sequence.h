/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Points that fill the unit cube evenly (Sobol 1967), scrambled after Owen (1995): each point alone is uniformly
   distributed, and any leading 2^k of them fill the cube. The direction numbers are our own: primitive polynomials in
   ascending order, and of a few starts that the counter generator draws the one whose plane projections with the
   dimensions before it are the most even. */
#ifndef EASEOFF_TOLERANCE_SOBOL_SEQUENCE_H
#define EASEOFF_TOLERANCE_SOBOL_SEQUENCE_H

#include <stdint.h>

#include "base/error.h"

enum { EO_SOBOL_BITS = 32, EO_SOBOL_DIMENSIONS = 256 };

struct eo_sobol_sequence {
  int dimensions;
  uint32_t (*direction)[EO_SOBOL_BITS]; /* [dimensions], owned */
};

/* 1 .. EO_SOBOL_DIMENSIONS dimensions, otherwise EO_ERROR_INPUT; memory. */
enum eo_code eo_sobol_sequence_init(struct eo_sobol_sequence *sequence, int dimensions, struct eo_error *error);
void eo_sobol_sequence_done(struct eo_sobol_sequence *sequence);

/* Coordinate of a point, in (0, 1): a function of these four alone. */
double eo_sobol_sequence_at(const struct eo_sobol_sequence *sequence, uint64_t seed, uint32_t point, int dimension);

#endif
