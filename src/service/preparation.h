/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The preparation of a gear pair in a process of its own: `easeoff prepare --follow`, which leaves what it computed in
   the cache. Finite elements take gigabytes and minutes and cannot be interrupted; a process can be ended, by a
   cancellation, by the end of this process, or by its limits. */
#ifndef EASEOFF_SERVICE_PREPARATION_H
#define EASEOFF_SERVICE_PREPARATION_H

#include "base/progress.h"
#include "design/design.h"
#include "flexibility/preparation_cost.h"

struct eo_preparation_settings {
  const char *program; /* easeoff; NULL: no process of its own */
  const char *cache;   /* folder */
  double memory;       /* bytes; beyond what the program itself takes */
  double seconds;      /* of processors */
};

/* What the design's pair takes. */
enum eo_code eo_preparation_cost_of(const struct eo_design *design, struct eo_preparation_cost *cost,
                                    struct eo_error *error);

/* EO_ERROR_INPUT with the figures when that is above what is allowed. */
enum eo_code eo_preparation_admit(const struct eo_preparation_settings *settings, const struct eo_design *design,
                                  struct eo_error *error);

/* Returns when the pair is in the cache. Errors: those of the preparation; EO_ERROR_CANCELLED; EO_ERROR_NUMERIC when it
   ended at a limit or without a word, with what is known of why; EO_ERROR_FILE, memory. */
enum eo_code eo_preparation_run(const struct eo_preparation_settings *settings, const struct eo_design *design,
                                const struct eo_progress *progress, struct eo_error *error);

#endif
