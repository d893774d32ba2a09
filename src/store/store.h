/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The data folder's database: one file, DIR/easeoff.db, SQLite in WAL mode. This floor is its only user; JSON is text
   to it.

   A store is a connection: one per thread, as many processes on one folder as there are. Writing happens in short
   transactions that wait for each other (eo_store_begin()); a process that dies in any phase leaves what it committed
   and nothing else. Errors: EO_ERROR_FILE with the file and the reason in one sentence; nothing of a failed transaction
   stays. */
#ifndef EASEOFF_STORE_STORE_H
#define EASEOFF_STORE_STORE_H

#include "base/error.h"

#include <stdbool.h>
#include <stdint.h>

struct eo_store;

enum eo_store_mode {
  EO_STORE_WRITE, /* makes the folder and the database when missing */
  EO_STORE_READ,  /* what is there; brought to the present schema when the folder can be written */
};

/* Opens the database of a folder and brings it to the present schema in one transaction. A newer schema, another
   program's database, a damaged file and a folder that cannot be written are errors. */
enum eo_code eo_store_open(struct eo_store **store, const char *directory, enum eo_store_mode mode,
                           struct eo_error *error);
void eo_store_close(struct eo_store *store); /* NULL is fine */

/* How long a writer waits for another one, 10 s unless set. */
void eo_store_wait(struct eo_store *store, int milliseconds);

/* One transaction for everything that is added until commit. eo_store_rollback() after an error; it cannot fail. */
enum eo_code eo_store_begin(struct eo_store *store, struct eo_error *error);
enum eo_code eo_store_commit(struct eo_store *store, struct eo_error *error);
void eo_store_rollback(struct eo_store *store);

/* Ends a transaction as `code` says of what was done in it: commits, or rolls back, also where the commit fails.
   Returns what went wrong first. */
enum eo_code eo_store_end(struct eo_store *store, enum eo_code code, struct eo_error *error);

/* The same for what somebody is told that it is kept: its commit is on the disk when it returns, whatever happens to
   the power. */
enum eo_code eo_store_begin_lasting(struct eo_store *store, struct eo_error *error);

/* A copy of the database as it is at this moment, in one file that was not there; others may write meanwhile. */
enum eo_code eo_store_copy(struct eo_store *store, const char *path, struct eo_error *error);

/* Gives room that was freed back to the file system, in steps between which others can write. */
enum eo_code eo_store_compact(struct eo_store *store, struct eo_error *error);

/* Reads the whole file and says what is damaged, if anything: EO_ERROR_DAMAGED. quickly: without comparing tables and
   their indexes. */
enum eo_code eo_store_inspect(struct eo_store *store, bool quickly, struct eo_error *error);

/* Bytes of the database and of its journal. */
int64_t eo_store_size(const struct eo_store *store, int64_t *journal);

#endif
