/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE /* mkostemp */
#include "recording/source.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include "base/utf8.h"

#define CHUNK ((size_t)128 << 10)

/* Text of two bytes a character on its way to UTF-8. */
struct wide {
  bool on, big;
  uint32_t high; /* first half of a pair; 0: none */
  size_t at, filled;
  char text[6 * 1024 + 1]; /* of 4096 bytes at most, whose first two may end a pair that makes four */
};

struct eo_source {
  int file;
  struct wide wide;
  bool gzip, ended;
  bool between; /* a member of the gzip file has ended, none has begun since */
  int64_t size, taken, given, limit;
  z_stream stream;
  size_t waiting; /* bytes of chunk that were read and not used */
  unsigned char *at, chunk[CHUNK];
};

/* Reads up to size bytes of the file itself. */
static enum eo_code read_file(struct eo_source *source, void *bytes, size_t size, size_t *got, struct eo_error *error)
{
  char *to = bytes;
  *got = 0;
  while (*got < size) {
    ssize_t n = read(source->file, to + *got, size - *got);
    if (n < 0 && errno == EINTR)
      continue;
    if (n < 0)
      return eo_error_set(error, EO_ERROR_FILE, "", "The file could not be read: %s.", strerror(errno));
    if (n == 0)
      break;
    *got += (size_t)n;
  }
  source->taken += (int64_t)*got;
  return EO_OK;
}

static enum eo_code refill(struct eo_source *source, struct eo_error *error)
{
  source->at = source->chunk;
  return read_file(source, source->chunk, CHUNK, &source->waiting, error);
}

enum eo_code eo_source_open(struct eo_source **source, const char *path, int64_t limit, struct eo_error *error)
{
  struct eo_source *this_source = calloc(1, sizeof *this_source);
  if (!this_source)
    return eo_error_memory(error);
  this_source->limit = limit;
  this_source->file = open(path, O_RDONLY | O_CLOEXEC);
  struct stat state;
  enum eo_code code = EO_OK;
  if (this_source->file < 0 || fstat(this_source->file, &state))
    code = eo_error_set(error, EO_ERROR_FILE, "", "The file %s could not be opened: %s.", path, strerror(errno));
  else if (!S_ISREG(state.st_mode))
    code = eo_error_set(error, EO_ERROR_FILE, "", "%s is not a file.", path);
  if (!code) {
    this_source->size = state.st_size;
    code = refill(this_source, error);
  }
  this_source->gzip = !code && this_source->waiting >= 3 && this_source->chunk[0] == 0x1f &&
                      this_source->chunk[1] == 0x8b && this_source->chunk[2] == 8;
  if (this_source->gzip && inflateInit2(&this_source->stream, 15 + 16) != Z_OK) {
    this_source->gzip = false;
    code = eo_error_memory(error);
  }
  if (code) {
    eo_source_close(this_source);
    return code;
  }
  *source = this_source;
  return EO_OK;
}

void eo_source_close(struct eo_source *source)
{
  if (!source)
    return;
  if (source->gzip)
    inflateEnd(&source->stream);
  if (source->file >= 0)
    close(source->file);
  free(source);
}

static enum eo_code read_plain(struct eo_source *source, unsigned char *bytes, size_t size, size_t *got,
                               struct eo_error *error)
{
  size_t kept = source->waiting < size ? source->waiting : size;
  memcpy(bytes, source->at, kept);
  source->at += kept;
  source->waiting -= kept;
  size_t more = 0;
  enum eo_code code = kept < size ? read_file(source, bytes + kept, size - kept, &more, error) : EO_OK;
  *got = kept + more;
  return code;
}

/* One call of inflate with what is waiting; *ended at the end of the last member. */
static enum eo_code inflate_some(struct eo_source *source, unsigned char *bytes, size_t room, size_t *got,
                                 struct eo_error *error)
{
  *got = 0;
  if (!source->waiting) {
    enum eo_code code = refill(source, error);
    if (code)
      return code;
    if (!source->waiting && !source->between)
      return eo_error_set(error, EO_ERROR_INPUT, "",
                          "The gzip file is cut off: it ends at byte %lld in the middle of its data.",
                          (long long)source->taken);
    source->ended = !source->waiting;
    if (source->ended)
      return EO_OK;
  }
  if (source->between && source->at[0] != 0x1f) { /* padding after the last member, as tapes and some copiers add it */
    source->ended = true;
    return EO_OK;
  }
  source->between = false;
  source->stream.next_in = source->at;
  source->stream.avail_in = (uInt)source->waiting;
  source->stream.next_out = bytes;
  source->stream.avail_out = (uInt)room;
  int status = inflate(&source->stream, Z_NO_FLUSH);
  source->at = source->stream.next_in;
  source->waiting = source->stream.avail_in;
  *got = room - source->stream.avail_out;
  if (status == Z_STREAM_END) {
    source->between = true;
    status = inflateReset(&source->stream);
  }
  if (status == Z_MEM_ERROR)
    return eo_error_memory(error);
  if (status != Z_OK && status != Z_BUF_ERROR)
    return eo_error_set(error, EO_ERROR_INPUT, "", "The gzip file is damaged near byte %lld.",
                        (long long)(source->taken - (int64_t)source->waiting));
  return EO_OK;
}

int64_t eo_source_growth(const char *path, int64_t limit)
{
  struct stat state;
  if (stat(path, &state) || state.st_size > INT64_MAX / EO_SOURCE_EXPANSION)
    return limit;
  int64_t most = state.st_size * EO_SOURCE_EXPANSION;
  most = most < EO_SOURCE_FREE ? EO_SOURCE_FREE : most;
  return most < limit ? most : limit;
}

static enum eo_code check_growth(const struct eo_source *source, struct eo_error *error)
{
  if (source->gzip && source->given > EO_SOURCE_FREE && source->given / EO_SOURCE_EXPANSION > source->taken)
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "The gzip file grows more than %d times by byte %lld; that is no measurement.",
                        EO_SOURCE_EXPANSION, (long long)source->taken);
  if (source->given > source->limit)
    return eo_error_set(error, EO_ERROR_INPUT, "", "The file holds more than the %lld MB that are read at most.",
                        (long long)(source->limit >> 20));
  return EO_OK;
}

static enum eo_code read_gzip(struct eo_source *source, unsigned char *bytes, size_t size, size_t *got,
                              struct eo_error *error)
{
  while (*got < size && !source->ended) {
    size_t n, room = size - *got < CHUNK * 8 ? size - *got : CHUNK * 8;
    enum eo_code code = inflate_some(source, bytes + *got, room, &n, error);
    if (code)
      return code;
    *got += n;
  }
  return EO_OK;
}

static enum eo_code read_bytes(struct eo_source *source, void *bytes, size_t size, size_t *got, struct eo_error *error)
{
  *got = 0;
  enum eo_code code = source->gzip ? read_gzip(source, bytes, size, got, error)
                                   : read_plain(source, bytes, size, got, error);
  source->given += (int64_t)*got;
  return code ? code : check_growth(source, error);
}

/* One character as UTF-8; byte order marks go away, halves of pairs wait for the other half. */
static void put_character(struct wide *wide, uint32_t c)
{
  if (c >= 0xd800 && c < 0xdc00) {
    wide->high = c;
    return;
  }
  if (c >= 0xdc00 && c < 0xe000)
    c = wide->high ? 0x10000 + ((wide->high - 0xd800) << 10) + (c - 0xdc00) : '?';
  wide->high = 0;
  if (c == 0xfeff)
    return;
  wide->filled += eo_utf8_put(wide->text + wide->filled, c);
}

static enum eo_code read_wide(struct eo_source *source, char *bytes, size_t size, size_t *got, struct eo_error *error)
{
  struct wide *wide = &source->wide;
  unsigned char raw[4096];
  *got = 0;
  while (*got < size) {
    if (wide->at == wide->filled) {
      size_t n;
      enum eo_code code = read_bytes(source, raw, sizeof raw, &n, error);
      if (code || n < 2)
        return code;
      wide->at = wide->filled = 0;
      for (size_t i = 0; i + 1 < n; i += 2)
        put_character(wide, wide->big ? (uint32_t)(raw[i] << 8 | raw[i + 1]) : (uint32_t)(raw[i + 1] << 8 | raw[i]));
    }
    size_t n = wide->filled - wide->at < size - *got ? wide->filled - wide->at : size - *got;
    memcpy(bytes + *got, wide->text + wide->at, n);
    wide->at += n;
    *got += n;
  }
  return EO_OK;
}

void eo_source_decode_wide(struct eo_source *source, int big)
{
  source->wide.on = true;
  source->wide.big = big;
}

enum eo_code eo_source_read(struct eo_source *source, void *bytes, size_t size, size_t *got, struct eo_error *error)
{
  return source->wide.on ? read_wide(source, bytes, size, got, error) : read_bytes(source, bytes, size, got, error);
}

int eo_source_is_gzip(const struct eo_source *source)
{
  return source->gzip;
}

double eo_source_fraction(const struct eo_source *source)
{
  return source->size > 0 && source->taken < source->size ? (double)source->taken / (double)source->size : 1;
}

static enum eo_code copy_to(struct eo_source *source, int file, struct eo_error *error)
{
  char *bytes = malloc(CHUNK);
  if (!bytes)
    return eo_error_memory(error);
  enum eo_code code;
  size_t got;
  do {
    code = eo_source_read(source, bytes, CHUNK, &got, error);
    for (size_t done = 0; !code && done < got;) {
      ssize_t n = write(file, bytes + done, got - done);
      if (n < 0 && errno == EINTR)
        continue;
      if (n <= 0)
        code = eo_error_set(error, EO_ERROR_FILE, "", "A temporary file could not be written: %s.",
                            strerror(n < 0 ? errno : ENOSPC));
      else
        done += (size_t)n;
    }
  } while (!code && got == CHUNK);
  free(bytes);
  return code;
}

enum eo_code eo_source_inflate(const char *path, int64_t limit, const char *directory, char *inflated, size_t size,
                               struct eo_error *error)
{
  struct eo_source *source;
  if (!directory || (size_t)snprintf(inflated, size, "%s/inflated-XXXXXX", directory) >= size)
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "This kind of file must be uploaded without gzip: there is no folder to inflate it to.");
  enum eo_code code = eo_source_open(&source, path, limit, error);
  if (code)
    return code;
  int file = mkostemp(inflated, O_CLOEXEC);
  if (file < 0)
    code = eo_error_set(error, EO_ERROR_FILE, "", "No temporary file could be made in %s: %s.", directory,
                        strerror(errno));
  else {
    code = copy_to(source, file, error);
    close(file);
    if (code)
      unlink(inflated);
  }
  eo_source_close(source);
  return code;
}
