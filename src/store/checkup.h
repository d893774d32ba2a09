/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Everything in a data folder, looked at once: pages, rows with their own sums, recordings byte by byte. Others may
   work on the folder meanwhile. */
#ifndef EASEOFF_STORE_CHECKUP_H
#define EASEOFF_STORE_CHECKUP_H

#include "store/store.h"

/* What a finding means for its owner. */
enum eo_loss {
  EO_LOSS_LOST,  /* it cannot be had again from here: a copy is needed */
  EO_LOSS_AGAIN, /* it can be computed again */
  EO_LOSS_NOTE   /* nothing is lost */
};

struct eo_finding_of_store {
  enum eo_loss loss;
  const char *text; /* one sentence */
};
typedef void eo_checkup_visit(void *context, const struct eo_finding_of_store *finding);

struct eo_checkup {
  int64_t pages, designs, recordings, jobs, evaluations; /* that were looked at */
  int64_t lost, again;                                   /* findings */
};

/* Errors only where the folder cannot be looked at at all. */
enum eo_code eo_store_checkup(struct eo_store *store, eo_checkup_visit *visit, void *context,
                              struct eo_checkup *checkup, struct eo_error *error);

/* Gives every page the sum that belongs to what it holds now: after another program has written the file, and whoever
   runs this knows that it is right. Nobody else may have the file open. */
enum eo_code eo_store_trust(const char *directory, int64_t *pages, struct eo_error *error);

#endif
