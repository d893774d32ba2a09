/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bytes of binary rig files: reads of a file at a place, numbers of either byte order. Internal to the readers. */
#ifndef EASEOFF_RECORDING_BYTES_H
#define EASEOFF_RECORDING_BYTES_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* Opens a regular file for reading. Errors: EO_ERROR_FILE. The caller closes *file. */
enum eo_code eo_bytes_open(const char *path, int *file, int64_t *size, struct eo_error *error);

/* Reads exactly size bytes at a place. Errors: EO_ERROR_FILE; EO_ERROR_INPUT when the file ends before, with the byte.
 */
enum eo_code eo_bytes_read(int file, int64_t at, void *bytes, size_t size, struct eo_error *error);

/* Writes all bytes at a place. Errors: EO_ERROR_FILE. */
enum eo_code eo_bytes_write(int file, int64_t at, const void *bytes, size_t size, struct eo_error *error);

/* Makes a temporary file in directory that has no name, so that it ends with the process. Errors: EO_ERROR_FILE;
   EO_ERROR_INPUT when directory is NULL. The caller closes *file. */
enum eo_code eo_bytes_spool(const char *directory, int *file, struct eo_error *error);

static inline uint16_t eo_bytes_16(const unsigned char *p, bool big)
{
  return (uint16_t)(big ? p[0] << 8 | p[1] : p[1] << 8 | p[0]);
}

static inline uint32_t eo_bytes_32(const unsigned char *p, bool big)
{
  uint32_t value;
  memcpy(&value, p, sizeof value);
  return big == (__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__) ? value : __builtin_bswap32(value);
}

static inline uint64_t eo_bytes_64(const unsigned char *p, bool big)
{
  uint64_t value;
  memcpy(&value, p, sizeof value);
  return big == (__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__) ? value : __builtin_bswap64(value);
}

static inline double eo_bytes_float(const unsigned char *p, bool big)
{
  uint32_t bits = eo_bytes_32(p, big);
  float value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

static inline double eo_bytes_double(const unsigned char *p, bool big)
{
  uint64_t bits = eo_bytes_64(p, big);
  double value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

#endif
