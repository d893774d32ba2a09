/* SHA-256 (FIPS 180-4), for names of things that must change whenever their content does. */
#ifndef EASEOFF_BASE_HASH_H
#define EASEOFF_BASE_HASH_H

#include <stddef.h>

enum { EO_HASH_HEX = 65 }; /* 64 digits and the end of the string */

/* Writes the lower-case hexadecimal SHA-256 of data[size]. Thread-safe. */
void eo_hash_hex(const void *data, size_t size, char hex[EO_HASH_HEX]);

#endif
