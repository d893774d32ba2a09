/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random numbers from a counter: each value is a pure function of where it is used, so threads, the order of completion
   and resuming change nothing. The mixing function is the finaliser of SplitMix64 (Steele, Lea, Flood 2014). */
#ifndef EASEOFF_BASE_RANDOM_H
#define EASEOFF_BASE_RANDOM_H

#include <stdint.h>

struct eo_random {
  uint64_t key; /* seed, stream, generation and individual, mixed */
};

/* The numbers of one individual: all four are any non-negative counters. */
struct eo_random eo_random_at(uint64_t seed, uint64_t stream, uint64_t generation, uint64_t individual);

/* The draw-th number of it, all 64 bits. */
uint64_t eo_random_bits(struct eo_random random, uint64_t draw);

/* The same, uniform in [0, 1) with 53 bits. */
double eo_random_unit(struct eo_random random, uint64_t draw);

/* Standard normal from the draws 2 draw and 2 draw + 1 (Box and Muller 1958). */
double eo_random_normal(struct eo_random random, uint64_t draw);

/* An index in 0 .. count-1. */
int eo_random_index(struct eo_random random, uint64_t draw, int count);

#endif
