/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A data folder as one file, and back: a tar archive with the recordings (measurements/ID/N), the database as it was at
   one moment (easeoff.db) and the SHA-256 of each (SHA256SUMS, as sha256sum writes them). Prepared gear pairs are left
   out: they are computed again. Others may work on the folder meanwhile. */
#ifndef EASEOFF_STORE_BACKUP_H
#define EASEOFF_STORE_BACKUP_H

#include "store/store.h"

struct eo_backup_report {
  int64_t designs, recordings, jobs;
  int64_t known;   /* restored into a folder that had them: left as they were */
  int missing;     /* recordings whose files are not what was uploaded, or not there: not in the archive */
  char first[200]; /* the first of them, a sentence */
  bool whole;      /* restored into a folder that had no database */
};

/* Writes the archive to a file that was not there; it appears when it is complete. design: 0: everything; else one
   design with its recordings alone, without jobs and history. Errors: EO_ERROR_INPUT (the file is there, no such
   design), EO_ERROR_FILE, EO_ERROR_FULL, EO_ERROR_DAMAGED for the database. */
enum eo_code eo_backup_write(struct eo_store *store, const char *path, int64_t design, struct eo_backup_report *report,
                             struct eo_error *error);

/* Reads the archive, compares every sum before anything is touched, and puts everything into the folder. Where that has
   a database already, designs and recordings are added to it under numbers of their own, what is there already stays
   once, and jobs and history stay in the archive. Errors: EO_ERROR_INPUT (no such archive, damaged), EO_ERROR_FILE,
   EO_ERROR_FULL. */
enum eo_code eo_backup_restore(const char *directory, const char *path, struct eo_backup_report *report,
                               struct eo_error *error);

#endif
