/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bytes of binary files for the tests, number by number in either byte order. */
#ifndef EASEOFF_TESTS_SUPPORT_BYTE_WRITER_H
#define EASEOFF_TESTS_SUPPORT_BYTE_WRITER_H

#include <stdint.h>
#include <string.h>

struct writer {
  unsigned char bytes[1 << 20];
  size_t size;
  int big; /* byte order */
};

__attribute__((unused)) static void put_number(struct writer *w, uint64_t value, int bytes)
{
  for (int i = 0; i < bytes; i++)
    w->bytes[w->size + (size_t)(w->big ? bytes - 1 - i : i)] = i < 8 ? (unsigned char)(value >> 8 * i) : 0;
  w->size += (size_t)bytes;
}

__attribute__((unused)) static void put_double(struct writer *w, double value)
{
  uint64_t bits;
  memcpy(&bits, &value, 8);
  put_number(w, bits, 8);
}

__attribute__((unused)) static void put_float(struct writer *w, double value)
{
  float narrow = (float)value;
  uint32_t bits;
  memcpy(&bits, &narrow, 4);
  put_number(w, bits, 4);
}

__attribute__((unused)) static void put_bytes(struct writer *w, const void *bytes, size_t size)
{
  memcpy(w->bytes + w->size, bytes, size);
  w->size += size;
}

/* A string behind its length. */
__attribute__((unused)) static void put_string(struct writer *w, const char *text)
{
  put_number(w, strlen(text), 4);
  put_bytes(w, text, strlen(text));
}

#endif
