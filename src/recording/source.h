/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bytes of a file, inflated when it is a gzip file, from its beginning to its end. One thread. */
#ifndef EASEOFF_RECORDING_SOURCE_H
#define EASEOFF_RECORDING_SOURCE_H

#include "base/error.h"

#include <stddef.h>
#include <stdint.h>

struct eo_source; /* opaque */

/* limit: bytes that may come out at most. A gzip file may also not grow by more than EO_SOURCE_EXPANSION once
   EO_SOURCE_FREE bytes came out of it: rig data never do, hostile files do. Errors: EO_ERROR_FILE, EO_ERROR_MEMORY. */
#define EO_SOURCE_EXPANSION 200
#define EO_SOURCE_FREE ((int64_t)64 << 20)
/* Bytes that may come out of a file of this size in all, at most limit. */
int64_t eo_source_growth(const char *path, int64_t limit);
enum eo_code eo_source_open(struct eo_source **source, const char *path, int64_t limit, struct eo_error *error);
void eo_source_close(struct eo_source *source); /* NULL is fine */

/* Fills bytes with size bytes; *got is smaller only at the end of the file. Errors: EO_ERROR_FILE; EO_ERROR_INPUT:
   damaged, cut off or growing beyond the limits, with the byte of the file. */
enum eo_code eo_source_read(struct eo_source *source, void *bytes, size_t size, size_t *got, struct eo_error *error);
/* From now on UTF-16 (big: its high bytes first) comes out as UTF-8, without byte order marks. Before the first read.
 */
void eo_source_decode_wide(struct eo_source *source, int big);
int eo_source_is_gzip(const struct eo_source *source);
double eo_source_fraction(const struct eo_source *source); /* 0..1 of the file that has been read */

/* Writes what comes out of a file into a new one in directory, whose path is copied to inflated[size]; the caller
   unlinks it. Errors as those of eo_source_read; EO_ERROR_INPUT when directory is NULL. */
enum eo_code eo_source_inflate(const char *path, int64_t limit, const char *directory, char *inflated, size_t size,
                               struct eo_error *error);

#endif
