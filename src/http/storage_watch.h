/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether what is sent can be kept: a thread tries to write every few seconds and looks at the disk, so that health and
   metrics say what is and not what was when the server started. */
#ifndef EASEOFF_HTTP_STORAGE_WATCH_H
#define EASEOFF_HTTP_STORAGE_WATCH_H

#include <stdbool.h>
#include <stdint.h>

#include "base/error.h"

struct eo_storage_watch;

enum eo_storage_state { EO_STORAGE_OK, EO_STORAGE_FULL, EO_STORAGE_LOCKED, EO_STORAGE_DAMAGED, EO_STORAGE_FAILING };
extern const char *const eo_storage_states[]; /* their names; ends with NULL */

struct eo_storage {
  enum eo_storage_state state;
  int64_t free_bytes; /* of the disk; -1: not known */
  int64_t database_bytes, journal_bytes;
  int64_t failures[EO_STORAGE_FAILING + 1]; /* requests that failed since the start, by what was wrong */
  char damage[400];                         /* the first damage that was found, "": none */
};

/* spare: bytes below which the disk counts as full. */
enum eo_code eo_storage_watch_new(struct eo_storage_watch **watch, const char *data, double spare,
                                  struct eo_error *error);
void eo_storage_watch_free(struct eo_storage_watch *watch); /* NULL is fine */

/* What is known at the moment; asks no disk, from any thread. */
struct eo_storage eo_storage_now(struct eo_storage_watch *watch);

/* A request failed so; from any thread. watch may be NULL. Damage stays until the next start. */
void eo_storage_note(struct eo_storage_watch *watch, const struct eo_error *error);

#endif
