/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of another data folder added to this one's: evaluations of the history and rows of studies, with the check sums
   that they have. */
#ifndef EASEOFF_STORE_MERGE_H
#define EASEOFF_STORE_MERGE_H

#include "store/store.h"

struct eo_merge_counts {
  int64_t problems, evaluations, points, variants; /* that were not here */
};

/* directory: of the other folder; nothing is written there but what brings an older one to the present schema. What
   is here already stays as it is. All or nothing, in one transaction. Errors: EO_ERROR_INPUT (the same folder),
   EO_ERROR_FILE, EO_ERROR_DAMAGED (rows there without their sum). */
enum eo_code eo_store_merge(struct eo_store *store, const char *directory, struct eo_merge_counts *counts,
                            struct eo_error *error);

#endif
