/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Points of the unit cube that fill it more evenly than chance, each a pure function of its number. */
#ifndef EASEOFF_VARIANTS_SAMPLING_H
#define EASEOFF_VARIANTS_SAMPLING_H

#include <stdint.h>

enum { EO_SOBOL_DIMENSIONS = 21 };

/* Coordinate `dimension` (0 .. EO_SOBOL_DIMENSIONS - 1) of point `index` (below 2^32) of Sobol's sequence with the
   direction numbers of Joe and Kuo (SIAM J. Sci. Comput. 30, 2635, 2008, new-joe-kuo-6), in [0, 1), digitally shifted
   by the seed; seed 0: not shifted. The first 2^k points have one in each of 2^k equal parts of every coordinate. */
double eo_sobol(uint64_t seed, int dimension, uint64_t index);

/* The same coordinate of a Latin hypercube of `count` points (McKay, Beckman, Conover, Technometrics 21, 239, 1979): one
   point, at a random place, in each of `count` equal parts of every coordinate. order[count]: the part of each point,
   filled by eo_latin_order() for this dimension. */
void eo_latin_order(uint64_t seed, int dimension, int count, int *order);
double eo_latin(uint64_t seed, int dimension, int count, const int *order, int index);

#endif
