/* SPDX-License-Identifier: GPL-3.0-or-later */
/* SHA-256 (FIPS 180-4) as a hexadecimal key: what a result depends on, in one file name. */
#ifndef EASEOFF_BASE_HASH_H
#define EASEOFF_BASE_HASH_H

#include <stddef.h>
#include <sys/types.h>

#include <sha2.h>

enum { EO_HASH_LENGTH = 64 }; /* characters without the closing zero */

struct eo_hash {
  SHA2_CTX state;
};

/* SHA-256: empty, then bytes as they come. Nothing to let go of. */
void eo_hash_init(struct eo_hash *hash);
void eo_hash_add(struct eo_hash *hash, const void *data, size_t size);

/* A name and its value; names keep neighbouring values apart. -0 counts as 0 and every NaN as the same NaN. */
void eo_hash_add_number(struct eo_hash *hash, const char *name, double value);
void eo_hash_add_text(struct eo_hash *hash, const char *name, const char *text);

/* Writes the key, lower case, and ends the use of *hash. */
void eo_hash_finish(struct eo_hash *hash, char key[EO_HASH_LENGTH + 1]);

/* The key of data[size] alone. */
void eo_hash_hex(const void *data, size_t size, char key[EO_HASH_LENGTH + 1]);

#endif
