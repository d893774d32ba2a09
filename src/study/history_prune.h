/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What somebody wants out of the history. */
#ifndef EASEOFF_STUDY_HISTORY_PRUNE_H
#define EASEOFF_STUDY_HISTORY_PRUNE_H

#include "format/outline.h"
#include "store/store.h"

struct eo_prune {
  bool predictions; /* fitness values that were predicted */
  bool outdated;    /* rows of older models, of searches, studies and pairs as made */
  bool damaged;     /* rows that are not what was written */
  bool unused;      /* rows of studies and pairs as made that no job has any more */
  int problem;      /* whose rows go; 0: none */
};

struct eo_pruned {
  int64_t rows, predictions;
};
extern const struct eo_outline eo_pruned_outline;

/* Room that is freed is given back. Errors: EO_ERROR_INPUT (somebody works on a job), of the store. */
enum eo_code eo_history_prune(struct eo_store *store, const struct eo_prune *prune, struct eo_pruned *pruned,
                              struct eo_error *error);

#endif
