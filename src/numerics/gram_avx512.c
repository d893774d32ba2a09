/* For processors with AVX-512: thirty-two registers of 64 bytes. */
#if defined(__x86_64__)
#include <immintrin.h>

#define VERSION eo_gram_avx512
#define NAME "avx512"
#define TARGET __attribute__((target("avx512f,avx512dq,avx512vl,fma")))
#define WIDTH 8
#define TILE_ROWS 6
#define TILE_LANES 4
#define FUSED(a, b, c) _mm512_fmadd_pd(_mm512_set1_pd(a), b, c)
#define FUSED_FLOAT(a, b, c) _mm512_fmadd_ps(_mm512_set1_ps(a), b, c)
#include "numerics/gram_body.h"
#endif
