/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Zip files, made byte by byte without compression, for the tests of the readers. */
#ifndef EASEOFF_TESTS_SUPPORT_ARCHIVE_FIXTURE_H
#define EASEOFF_TESTS_SUPPORT_ARCHIVE_FIXTURE_H

#include "support/reader-fixture.h"

#include <stdbool.h>
#include <zlib.h>

static unsigned char bytes[1 << 16];
static size_t size, directory_size;
static unsigned char directory[4096];
static int entries;

static void put(unsigned char *to, size_t *at, uint64_t value, int count)
{
  for (int i = 0; i < count; i++)
    to[(*at)++] = i < 8 ? (unsigned char)(value >> 8 * i) : 0;
}

/* A stored file: local header, name, content; and its line in the directory. */
static void add_bytes(const char *name, const void *content, size_t length)
{
  size_t at = size;
  uint32_t sum = (uint32_t)crc32(0, content, (unsigned)length);
  put(bytes, &size, 0x04034b50, 4);
  put(directory, &directory_size, 0x02014b50, 4);
  put(directory, &directory_size, 20, 2);
  for (int side = 0; side < 2; side++) {
    unsigned char *to = side ? directory : bytes;
    size_t *end = side ? &directory_size : &size;
    put(to, end, 20, 2);
    put(to, end, 0, 8); /* flags, method, time, date */
    put(to, end, sum, 4);
    put(to, end, length, 4);
    put(to, end, length, 4);
    put(to, end, strlen(name), 2);
    put(to, end, 0, 2);
  }
  put(directory, &directory_size, 0, 2 + 2 + 2 + 4);
  put(directory, &directory_size, at, 4);
  memcpy(directory + directory_size, name, strlen(name));
  directory_size += strlen(name);
  memcpy(bytes + size, name, strlen(name));
  size += strlen(name);
  memcpy(bytes + size, content, length);
  size += length;
  entries++;
}

static void add(const char *name, const char *content)
{
  add_bytes(name, content, strlen(content));
}

/* Ends the archive, whose bytes stay where they are until the next one begins. */
static size_t end_archive(void)
{
  size_t at = size;
  memcpy(bytes + size, directory, directory_size);
  size += directory_size;
  put(bytes, &size, 0x06054b50, 4);
  put(bytes, &size, 0, 4);
  put(bytes, &size, (uint64_t)entries, 2);
  put(bytes, &size, (uint64_t)entries, 2);
  put(bytes, &size, directory_size, 4);
  put(bytes, &size, at, 4);
  put(bytes, &size, 0, 2);
  size_t length = size;
  size = directory_size = 0;
  entries = 0;
  return length;
}

static void finish(void)
{
  write_bytes(bytes, end_archive());
}

static struct eo_recording *take(struct eo_notes *notes, struct eo_error *error)
{
  struct eo_reader_options options = {.spool_directory = fixture_directory};
  return read_fixture(&options, notes, error);
}

static void refuse(const char *words, const char *what)
{
  struct eo_error error;
  struct eo_recording *r = take(NULL, &error);
  ok(!r && strstr(error.text, words), "the reader refuses %s: %s", what, r ? "was read" : error.text);
  eo_recording_free(r);
}

#endif
