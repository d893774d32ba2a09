/* SPDX-License-Identifier: GPL-3.0-or-later */
/* For processors with AVX2 and FMA: sixteen registers of 32 bytes. */
#if defined(__x86_64__)
#include <immintrin.h>

#define VERSION eo_gram_avx2
#define NAME "avx2"
#define TARGET __attribute__((target("avx2,fma")))
#define WIDTH 4
#define SPLAT(a) _mm256_set1_pd(a)
#define SPLAT_FLOAT(a) _mm256_set1_ps(a)
#define WIDEN(at) _mm256_cvtps_pd(_mm_load_ps(at))
#define MADD(a, b, c) _mm256_fmadd_pd(a, b, c)
#define MADD_FLOAT(a, b, c) _mm256_fmadd_ps(a, b, c)
#define ANY(mask) (_mm256_movemask_pd((__m256d)(mask)) != 0)
#define ANY_FLOAT(mask) (_mm256_movemask_ps((__m256)(mask)) != 0)
#define APPLY_ROWS 4
#define GATHER_UNITS 6
#define TILE_ROWS 6
#define TILE_LANES 2
#define FEW_LANES 3
#include "numerics/gram_body.h"
#endif
