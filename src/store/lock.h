/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Who works on which job: one byte of DIR/easeoff.lock per job, locked by the open file. The kernel lets go of it when
   the process ends in whatever way, so a job that says "running" and is not locked was interrupted. */
#ifndef EASEOFF_STORE_LOCK_H
#define EASEOFF_STORE_LOCK_H

#include "store/store.h"

#include <stdbool.h>

/* Takes the job for this store until it is closed or the job released; *taken is false when somebody else has it. */
enum eo_code eo_store_claim_job(struct eo_store *store, int64_t job, bool *taken, struct eo_error *error);
void eo_store_release_job(struct eo_store *store, int64_t job);

/* Whether any other store, in this process or another, works on the job. Without a lock file nobody does. */
bool eo_store_job_is_taken(struct eo_store *store, int64_t job);

/* Takes the whole folder for one server, in the same way (byte 0), until this store is closed. */
enum eo_code eo_store_claim_server(struct eo_store *store, bool *taken, struct eo_error *error);

#endif
