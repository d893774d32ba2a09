/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The versions of the kernel, one file each: gram_plain.c, gram_avx2.c, gram_avx512.c. */
#ifndef EASEOFF_NUMERICS_GRAM_PRIVATE_H
#define EASEOFF_NUMERICS_GRAM_PRIVATE_H

#include "numerics/gram.h"
#include "numerics/local_inverse.h"

extern const struct eo_gram eo_gram_plain;
#if defined(__x86_64__)
extern const struct eo_gram eo_gram_avx2, eo_gram_avx512;
#endif

#endif
