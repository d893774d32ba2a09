/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A part of gram_body.h, which includes it and nobody else does: what local springs carry, and at what rate, by vectors
   whose width and macros it has. */
typedef int64_t mask __attribute__((vector_size(8 * WIDTH), may_alias));
typedef uint64_t word __attribute__((vector_size(8 * WIDTH), may_alias));
typedef double loose_lane __attribute__((vector_size(8 * WIDTH), aligned(8), may_alias));

INLINE lane choose(mask where, lane a, lane b)
{
  return (lane)(((mask)a & where) | ((mask)b & ~where));
}

/* Both numbers of the nodes at[0 .. WIDTH) and of those behind them: value, slope, next value, next slope. */
INLINE void nodes_at(const double (*node)[2], word at, lane of[4])
{
#if WIDTH == 2
  pair a = *(const loose_lane *)node[at[0]], b = *(const loose_lane *)node[at[1]],
       c = *(const loose_lane *)node[at[0] + 1], d = *(const loose_lane *)node[at[1] + 1];
  of[0] = __builtin_shufflevector(a, b, 0, 2);
  of[1] = __builtin_shufflevector(a, b, 1, 3);
  of[2] = __builtin_shufflevector(c, d, 0, 2);
  of[3] = __builtin_shufflevector(c, d, 1, 3);
#else
  typedef double loose_four __attribute__((vector_size(32), aligned(8), may_alias));
  four part[PARTS_OF_FOUR][4];
  UNROLL
  for (int p = 0; p < PARTS_OF_FOUR; p++) {
    four a = *(const loose_four *)node[at[4 * p]], b = *(const loose_four *)node[at[4 * p + 1]],
         c = *(const loose_four *)node[at[4 * p + 2]], d = *(const loose_four *)node[at[4 * p + 3]],
         ab = __builtin_shufflevector(a, b, 0, 4, 2, 6), cd = __builtin_shufflevector(c, d, 0, 4, 2, 6),
         slope_ab = __builtin_shufflevector(a, b, 1, 5, 3, 7), slope_cd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    part[p][0] = __builtin_shufflevector(ab, cd, 0, 1, 4, 5);
    part[p][1] = __builtin_shufflevector(slope_ab, slope_cd, 0, 1, 4, 5);
    part[p][2] = __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
    part[p][3] = __builtin_shufflevector(slope_ab, slope_cd, 2, 3, 6, 7);
  }
  UNROLL
  for (int k = 0; k < 4; k++)
#if WIDTH == 4
    of[k] = part[0][k];
#else
    of[k] = __builtin_shufflevector(part[0][k], part[1][k], 0, 1, 2, 3, 4, 5, 6, 7);
#endif
#endif
}

/* eo_local_inverse_at() for a vector, step by step the same arithmetic. */
INLINE lane inverse_at(const double (*node)[2], lane u, lane *slope)
{
  static const uint64_t ONE = UINT64_C(1023) << 52, WITHIN = (UINT64_C(1) << 46) - 1;
  const lane straight = SPLAT(EO_LOCAL_INVERSE_STRAIGHT), least = SPLAT(EO_LOCAL_INVERSE_LEAST);
  mask below = u < straight, tiny = u < least;
  word bits = (word)choose(below & ~tiny, u, least), cell = (bits >> 46) - (UINT64_C(959) << 6);
  cell += cell >> 6;
  lane r = (lane)(ONE | (bits & WITHIN) << 6) - 1;
  lane per_width = (lane)((UINT64_C(2052) << 52) - (bits & UINT64_C(2047) << 52));
  lane of[4];
  nodes_at(node, cell, of);
  lane rise = of[2] - of[0], bow = 3 * rise - 2 * of[1] - of[3], turn = of[1] + of[3] - 2 * rise;
  lane within = (of[1] + r * (2 * bow + 3 * r * turn)) * per_width;
  lane first = SPLAT(node[0][0] / EO_LOCAL_INVERSE_LEAST);
  *slope = choose(below, choose(tiny, first, within), SPLAT(1.0));
  return choose(below, choose(tiny, u * first, of[0] + r * (of[1] + r * (bow + r * turn))),
                u - EO_LOCAL_INVERSE_OFFSET);
}

TARGET static double carry(int points, const struct eo_line_law *law, const double *local, const double *spread,
                           double *load, double *rate)
{
  double sum = 0;
  int i = 0;
  for (; i + WIDTH <= points; i += WIDTH) {
    lane g = *(const lane *)(local + i), half = *(const lane *)(spread + i), zero = SPLAT(0.0);
    mask touches = ~(g <= -half); /* NaN too */
    *(lane *)(load + i) = *(lane *)(rate + i) = zero;
    if (!ANY(touches))
      continue;
    mask in_part = touches & (g < half);
    lane share = SPLAT(1.0);
    if (ANY(in_part)) { /* theory (C5) */
      share = choose(in_part, (g + half) / (2 * half), share);
      g = choose(in_part, share * share * half, g);
    }
    lane per_depth = *(const loose_lane *)(law->per_depth + i), strength = *(const loose_lane *)(law->strength + i);
    lane slope, carried = inverse_at(law->node, g * per_depth, &slope);
    lane p = choose(touches, strength * carried, zero);
    *(lane *)(load + i) = p;
    *(lane *)(rate + i) = choose(touches, share * slope * strength * per_depth, zero);
    UNROLL
    for (int l = 0; l < WIDTH; l++)
      sum += p[l];
  }
  for (; i < points; i++) {
    double g = local[i], half = spread[i], share = 1, slope;
    load[i] = rate[i] = 0;
    if (g <= -half)
      continue;
    if (g < half) {
      share = (g + half) / (2 * half);
      g = share * share * half;
    }
    load[i] = law->strength[i] * eo_local_inverse_at(law->node, g * law->per_depth[i], &slope);
    rate[i] = share * slope * law->strength[i] * law->per_depth[i];
    sum += load[i];
  }
  return sum;
}
