/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "numerics/gram_private.h"

#include <stdlib.h>
#include <string.h>

/* What the processor has: as the C library tells it, so that a feature that is switched off there is off here too;
   libraries without such a list leave it to the compiler's. */
#if defined(__x86_64__) && defined(__has_include)
#if __has_include(<sys/platform/x86.h>)
#include <sys/platform/x86.h>
#define HAS(library_name, compiler_name) is_active(x86_cpu_##library_name)

/* CPU_FEATURE_ACTIVE of the C library, whose shift into the sign bit is undefined. */
static bool is_active(unsigned index)
{
  enum { WORD = 8 * sizeof(unsigned), LEAF = 4 * WORD };
  const struct cpuid_feature *leaf = __x86_get_cpuid_feature_leaf(index / LEAF);
  unsigned bit = index % LEAF;
  return (leaf->active_array[bit / WORD] >> bit % WORD & 1) != 0;
}
#endif
#endif
#ifndef HAS
#define HAS(library_name, compiler_name) (__builtin_cpu_supports(compiler_name) != 0)
#endif

const struct eo_gram *eo_gram_version(int index)
{
#if defined(__x86_64__)
  bool wide = HAS(AVX2, "avx2") && HAS(FMA, "fma"),
       widest = wide && HAS(AVX512F, "avx512f") && HAS(AVX512DQ, "avx512dq") && HAS(AVX512VL, "avx512vl");
  if (widest && index-- == 0)
    return &eo_gram_avx512;
  if (wide && index-- == 0)
    return &eo_gram_avx2;
#endif
  return index == 0 ? &eo_gram_plain : NULL;
}

const struct eo_gram *eo_gram_select(void)
{
  return eo_gram_version(0);
}

void *eo_gram_allocate(long count)
{
  size_t bytes = ((size_t)(count > 0 ? count : 1) * sizeof(double) + EO_GRAM_ALIGN - 1) / EO_GRAM_ALIGN * EO_GRAM_ALIGN;
  void *memory = aligned_alloc(EO_GRAM_ALIGN, bytes);
  if (memory)
    memset(memory, 0, bytes);
  return memory;
}
