/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/letters.h"

#include <ctype.h>
#include <stdbool.h>
#include <string.h>

/* Letters from 0xc0 on without their accents; a blank where there is no such letter. */
static const char bases[] = "aaaaaaaceeeeiiiidnooooo ouuuuy saaaaaaaceeeeiiiidnooooo ouuuuy y";

/* The letter at text and the bytes it takes; 0: not of Latin 1. */
static char base_at(const char *text, size_t length, size_t *bytes)
{
  unsigned char first = (unsigned char)text[0], next = length > 1 ? (unsigned char)text[1] : 0;
  bool continued = next >= 0x80 && next < 0xc0;
  *bytes = first == 0xc3 && continued ? 2 : 1;
  unsigned code = *bytes == 2 ? 0xc0u + (next & 0x3fu) : first;
  return code >= 0xc0 && code <= 0xff && (*bytes == 2 || !continued) && bases[code - 0xc0] != ' ' ? bases[code - 0xc0]
                                                                                                  : '\0';
}

void eo_letters_plain(const char *text, size_t length, char *plain, size_t size)
{
  size_t n = 0;
  for (size_t at = 0; at < length && n + 1 < size;) {
    size_t bytes;
    char base = base_at(text + at, length - at, &bytes);
    plain[n++] = base ? base : (char)tolower((unsigned char)text[at]);
    at += base ? bytes : 1;
  }
  plain[n] = '\0';
}

bool eo_letters_listed(const char *text, size_t length, const char *words)
{
  char plain[64]; /* no word is as long */
  eo_letters_plain(text, length, plain, sizeof plain);
  length = strlen(plain);
  for (const char *p = words; *p;) {
    size_t n = strcspn(p, "|");
    if (n == length && !memcmp(p, plain, n))
      return true;
    p += n + (p[n] == '|');
  }
  return false;
}
