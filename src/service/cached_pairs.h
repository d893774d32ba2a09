/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The folder of prepared pairs, held to a size: those that were not used for longest go. Each can be computed again. */
#ifndef EASEOFF_SERVICE_CACHED_PAIRS_H
#define EASEOFF_SERVICE_CACHED_PAIRS_H

#include <stdint.h>

/* Notes that the pair with this key is used, then removes others while all together have more than `most` bytes. folder
   NULL: there is none. */
void eo_cached_pairs_use(const char *folder, const char *key, double most);

/* Bytes of all. */
int64_t eo_cached_pairs_size(const char *folder);

#endif
