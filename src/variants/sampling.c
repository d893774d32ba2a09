/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "variants/sampling.h"

#include "base/random.h"

enum { BITS = 32, SHIFT_STREAM = 71, ORDER_STREAM = 72, PLACE_STREAM = 73 };

/* Primitive polynomial (degree, inner coefficients) and first direction numbers of each dimension but the first. */
static const struct {
  unsigned degree, inner, start[7];
} direction[EO_SOBOL_DIMENSIONS - 1] = {
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
    {5, 4, {1, 1, 5, 5, 5}},
    {5, 7, {1, 1, 7, 11, 19}},
    {5, 11, {1, 1, 5, 1, 1}},
    {5, 13, {1, 1, 1, 3, 11}},
    {5, 14, {1, 3, 5, 5, 31}},
    {6, 1, {1, 3, 3, 9, 7, 49}},
    {6, 13, {1, 1, 1, 15, 21, 21}},
    {6, 16, {1, 3, 1, 13, 27, 49}},
    {6, 19, {1, 1, 1, 15, 7, 5}},
    {6, 22, {1, 3, 1, 15, 13, 25}},
    {6, 25, {1, 1, 5, 5, 19, 61}},
    {7, 1, {1, 3, 7, 11, 23, 15, 103}},
    {7, 4, {1, 3, 7, 13, 13, 15, 69}},
};

/* v_k = m_k 2^(32-k): the recurrence of Bratley and Fox (ACM TOMS 14, 88, 1988), eq. 2. */
static void find_directions(int dimension, uint32_t v[BITS])
{
  if (dimension == 0) {
    for (int k = 0; k < BITS; k++)
      v[k] = UINT32_C(1) << (BITS - 1 - k);
    return;
  }
  unsigned degree = direction[dimension - 1].degree, inner = direction[dimension - 1].inner;
  for (unsigned k = 0; k < degree; k++)
    v[k] = direction[dimension - 1].start[k] << (BITS - 1 - k);
  for (unsigned k = degree; k < BITS; k++) {
    v[k] = v[k - degree] ^ (v[k - degree] >> degree);
    for (unsigned i = 1; i < degree; i++)
      if (inner >> (degree - 1 - i) & 1)
        v[k] ^= v[k - i];
  }
}

double eo_sobol(uint64_t seed, int dimension, uint64_t index)
{
  uint32_t v[BITS], x = 0;
  find_directions(dimension, v);
  for (uint64_t k = 0, gray = index ^ (index >> 1); gray; k++, gray >>= 1)
    if (gray & 1)
      x ^= v[k];
  if (seed)
    x ^= (uint32_t)(eo_random_bits(eo_random_at(seed, SHIFT_STREAM, 0, (uint64_t)dimension), 0) >> 32);
  return (double)x / 4294967296.0;
}

void eo_latin_order(uint64_t seed, int dimension, int count, int *order)
{
  struct eo_random random = eo_random_at(seed, ORDER_STREAM, 0, (uint64_t)dimension);
  for (int i = 0; i < count; i++)
    order[i] = i;
  for (int i = count - 1; i > 0; i--) { /* Fisher and Yates */
    int other = eo_random_index(random, (uint64_t)i, i + 1), kept = order[i];
    order[i] = order[other];
    order[other] = kept;
  }
}

double eo_latin(uint64_t seed, int dimension, int count, const int *order, int index)
{
  struct eo_random random = eo_random_at(seed, PLACE_STREAM, (uint64_t)index, (uint64_t)dimension);
  return (order[index] + eo_random_unit(random, 0)) / count;
}
