/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/hash.h"

#include <math.h>
#include <string.h>

void eo_hash_init(struct eo_hash *hash)
{
  SHA256Init(&hash->state);
}

void eo_hash_add(struct eo_hash *hash, const void *data, size_t size)
{
  SHA256Update(&hash->state, data, size);
}

void eo_hash_add_number(struct eo_hash *hash, const char *name, double value)
{
  unsigned char bytes[sizeof value] = {0}; /* of 0, whatever its sign */
  if (isnan(value))
    value = NAN;
  if (value != 0)
    memcpy(bytes, &value, sizeof bytes);
  eo_hash_add(hash, name, strlen(name) + 1);
  eo_hash_add(hash, bytes, sizeof bytes);
}

void eo_hash_add_text(struct eo_hash *hash, const char *name, const char *text)
{
  eo_hash_add(hash, name, strlen(name) + 1);
  eo_hash_add(hash, text, strlen(text) + 1);
}

void eo_hash_finish(struct eo_hash *hash, char key[EO_HASH_LENGTH + 1])
{
  static const char digit[] = "0123456789abcdef";
  unsigned char digest[SHA256_DIGEST_LENGTH];
  SHA256Final(digest, &hash->state);
  for (size_t i = 0; i < sizeof digest; i++) {
    key[2 * i] = digit[digest[i] >> 4];
    key[2 * i + 1] = digit[digest[i] & 15];
  }
  key[EO_HASH_LENGTH] = 0;
}

void eo_hash_hex(const void *data, size_t size, char key[EO_HASH_LENGTH + 1])
{
  struct eo_hash hash;
  eo_hash_init(&hash);
  eo_hash_add(&hash, data, size);
  eo_hash_finish(&hash, key);
}
