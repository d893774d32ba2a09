/* For processors with AVX2 and FMA: sixteen registers of 32 bytes. */
#if defined(__x86_64__)
#include <immintrin.h>

#define VERSION eo_gram_avx2
#define NAME "avx2"
#define TARGET __attribute__((target("avx2,fma")))
#define WIDTH 4
#define TILE_ROWS 6
#define TILE_LANES 2
#define FUSED(a, b, c) _mm256_fmadd_pd(_mm256_set1_pd(a), b, c)
#define FUSED_FLOAT(a, b, c) _mm256_fmadd_ps(_mm256_set1_ps(a), b, c)
#include "numerics/gram_body.h"
#endif
