/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Characters of UTF-8 (RFC 3629), one at a time. */
#ifndef EASEOFF_BASE_UTF8_H
#define EASEOFF_BASE_UTF8_H

#include <stddef.h>
#include <stdint.h>

/* Bytes, at most `left`, of the character at text; 0 when they are none (overlong ones and halves of pairs among them).
   A text that ends with 0 may be given with any `left`. */
size_t eo_utf8_size(const char *text, size_t left);

/* Writes a character below 0x110000, 1 to 4 bytes without a 0 behind; returns how many. */
size_t eo_utf8_put(char *to, uint32_t character);

#endif
