/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/random.h"

#include <math.h>

static const uint64_t golden = 0x9E3779B97F4A7C15u;

static uint64_t mix(uint64_t z)
{
  z ^= z >> 30;
  z *= 0xBF58476D1CE4E5B9u;
  z ^= z >> 27;
  z *= 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

struct eo_random eo_random_at(uint64_t seed, uint64_t stream, uint64_t generation, uint64_t individual)
{
  uint64_t key = mix(seed + golden);
  key = mix(key + golden * (stream + 1));
  key = mix(key + golden * (generation + 1));
  key = mix(key + golden * (individual + 1));
  return (struct eo_random){.key = key};
}

uint64_t eo_random_bits(struct eo_random random, uint64_t draw)
{
  return mix(random.key + golden * (draw + 1));
}

double eo_random_unit(struct eo_random random, uint64_t draw)
{
  return (double)(eo_random_bits(random, draw) >> 11) * 0x1p-53;
}

double eo_random_normal(struct eo_random random, uint64_t draw)
{
  const double radius = sqrt(-2 * log1p(-eo_random_unit(random, 2 * draw)));
  return radius * cos(2 * M_PI * eo_random_unit(random, 2 * draw + 1));
}

int eo_random_index(struct eo_random random, uint64_t draw, int count)
{
  return (int)(count * eo_random_unit(random, draw));
}
