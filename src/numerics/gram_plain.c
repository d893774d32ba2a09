/* SPDX-License-Identifier: GPL-3.0-or-later */
/* For any processor: vectors of 16 bytes, which every x86-64 and every 64-bit ARM has. */
#if defined(__SSE2__)
#include <emmintrin.h>
#define WIDEN(at) _mm_cvtps_pd(_mm_castsi128_ps(_mm_loadl_epi64((const __m128i *)(at))))
#else
#define WIDEN(at) ((lane){(double)(at)[0], (double)(at)[1]})
#endif

#define VERSION eo_gram_plain
#define NAME "plain"
#define TARGET
#define WIDTH 2
#define SPLAT(a) ((lane){0} + (a))
#define SPLAT_FLOAT(a) ((float_lane){0} + (a))
#define MADD(a, b, c) ((a) * (b) + (c))
#define MADD_FLOAT(a, b, c) ((a) * (b) + (c))
#define ANY(mask) (((mask)[0] | (mask)[1]) != 0)
#define ANY_FLOAT(mask) (((mask)[0] | (mask)[1] | (mask)[2] | (mask)[3]) != 0)
#define APPLY_ROWS 2
#define GATHER_UNITS 3
#define TILE_ROWS 4
#define TILE_LANES 2
#define FEW_LANES 3
#include "numerics/gram_body.h"
