/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One file of the cache: numbers under a key. A lock keeps two processes from making the same file at once; the file
   appears under its name only when it is complete and on the disk. Nothing that goes wrong here is an error: the work
   is then simply done again. */
#ifndef EASEOFF_FLEXIBILITY_CACHE_H
#define EASEOFF_FLEXIBILITY_CACHE_H

#include "base/error.h"
#include "base/hash.h"
#include "base/progress.h"

#include <stdbool.h>

/* A block of memory that is read or written in one piece. */
struct eo_cache_part {
  double *data;
  size_t count;
};

struct eo_cache {
  char *path, *part_path, *lock_path; /* owned; NULL without a directory */
  char key[EO_HASH_LENGTH + 1];
  int lock;       /* file descriptor, -1 when the lock could not be had */
  char note[200]; /* what went wrong, "" when nothing did */
};

/* Waits for the lock of this key. directory may be NULL. Errors: memory, EO_ERROR_CANCELLED. */
enum eo_code eo_cache_open(struct eo_cache *cache, const char *directory, const char *key,
                           const struct eo_progress *progress, struct eo_error *error);

/* Reads all parts; false when there is no file or it does not fit in every respect (then the parts hold rubbish and the
   file is gone). */
bool eo_cache_read(struct eo_cache *cache, struct eo_cache_part *part, int parts);

/* Writes all parts, or leaves a note. */
void eo_cache_write(struct eo_cache *cache, const struct eo_cache_part *part, int parts);

/* Lets the lock go. */
void eo_cache_close(struct eo_cache *cache);

#endif
