/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The key of a cache file: SHA-256 against the examples of FIPS 180-4, and what counts as the same number. */
#include "base/hash.h"
#include "support/tap.h"

#include <string.h>

static void hash_of(const char *text, char *key)
{
  struct eo_hash hash;
  eo_hash_init(&hash);
  eo_hash_add(&hash, text, strlen(text));
  eo_hash_finish(&hash, key);
}

static void number_of(const char *name, double value, char *key)
{
  struct eo_hash hash;
  eo_hash_init(&hash);
  eo_hash_add_number(&hash, name, value);
  eo_hash_finish(&hash, key);
}

int main(void)
{
  char a[EO_HASH_LENGTH + 1], b[EO_HASH_LENGTH + 1];
  hash_of("abc", a);
  ok(!strcmp(a, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"),
     "one block has the hash that FIPS 180-4 prints: %s", a);
  hash_of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq", a);
  ok(!strcmp(a, "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1"),
     "two blocks have the hash that FIPS 180-4 prints: %s", a);
  number_of("x", 0.0, a);
  number_of("x", -0.0, b);
  ok(!strcmp(a, b), "-0 has the hash of 0");
  number_of("x", NAN, a);
  number_of("x", -NAN, b);
  ok(!strcmp(a, b), "every NaN has one hash");
  number_of("x", 1.0, a);
  number_of("x", nextafter(1.0, 2.0), b);
  ok(strcmp(a, b) != 0, "the last bit of a number changes the hash");
  number_of("y", 1.0, b);
  ok(strcmp(a, b) != 0, "the name of a number changes the hash");
  return tap_done();
}
