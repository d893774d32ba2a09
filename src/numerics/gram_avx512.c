/* SPDX-License-Identifier: GPL-3.0-or-later */
/* For processors with AVX-512: thirty-two registers of 64 bytes. */
#if defined(__x86_64__)
#include <immintrin.h>

#define VERSION eo_gram_avx512
#define NAME "avx512"
#define TARGET __attribute__((target("avx512f,avx512dq,avx512vl,fma")))
#define WIDTH 8
#define SPLAT(a) _mm512_set1_pd(a)
#define SPLAT_FLOAT(a) _mm512_set1_ps(a)
#define WIDEN(at) _mm512_cvtps_pd(_mm256_load_ps(at))
#define MADD(a, b, c) _mm512_fmadd_pd(a, b, c)
#define MADD_FLOAT(a, b, c) _mm512_fmadd_ps(a, b, c)
#define ANY(mask) (_mm512_movepi64_mask((__m512i)(mask)) != 0)
#define ANY_FLOAT(mask) (_mm512_movepi32_mask((__m512i)(mask)) != 0)
#define APPLY_ROWS 8
#define GATHER_UNITS 6
#define TILE_ROWS 8
#define TILE_LANES 3
#define FEW_LANES 6
#include "numerics/gram_body.h"
#endif
