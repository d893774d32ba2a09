/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Room that is kept for the day when the disk is full: deleting needs a little, and makes more. */
#ifndef EASEOFF_STORE_SPARE_H
#define EASEOFF_STORE_SPARE_H

#include "store/store.h"

/* Keeps a megabyte in DIR/easeoff.spare, when they are not kept already and the disk has far more than that. */
void eo_spare_keep(struct eo_store *store);

/* Gives them back to the disk; false: there are none. */
bool eo_spare_give(struct eo_store *store);

/* What the disk of the data folder has left for this process, bytes; -1: not known. */
int64_t eo_store_free_bytes(const struct eo_store *store);

/* Writes something that changes nothing. Errors: as of any writing, after a tenth of a second of waiting for others. */
enum eo_code eo_store_probe(struct eo_store *store, struct eo_error *error);

#endif
