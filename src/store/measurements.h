/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Recordings of a rig: rows, and the files they stand for. A measurement is there once its row is; its files are then
   complete in DATA/measurements/ID/0 (and 1), brought to the disk before the row. What a process left that ended in
   between is put in order by eo_measurement_folder_tidy(). Functions that write open their own transaction;
   texts that a visit gets are borrowed until it returns. */
#ifndef EASEOFF_STORE_MEASUREMENTS_H
#define EASEOFF_STORE_MEASUREMENTS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/hash.h"
#include "store/store.h"

enum { EO_MEASUREMENT_FILES = 2, EO_MEASUREMENT_NAME = 120 };

struct eo_measurement_file {
  char name[EO_MEASUREMENT_NAME]; /* the client's, cleaned */
  int64_t size;
  char sha256[EO_HASH_LENGTH + 1];
};

struct eo_stored_measurement {
  int64_t id, design; /* id: never used again after a deletion */
  const char *digest; /* of the request and its files */
  bool unmodified;
  double torque;                /* N m */
  double speed;                 /* as stated, rad/s; NaN: not stated */
  const char *layout;           /* JSON as asked for; "" without */
  const char *pair;             /* hash of what of the design it was measured with */
  const char *summary, *result; /* JSON; result is "" in lists */
  const char *created;
  int files;
  struct eo_measurement_file file[EO_MEASUREMENT_FILES];
};

enum eo_measurement_outcome {
  EO_MEASUREMENT_DONE,
  EO_MEASUREMENT_KNOWN,     /* one with this digest is there already */
  EO_MEASUREMENT_NO_DESIGN, /* there is no such design */
  EO_MEASUREMENT_MISSING,   /* there is no such measurement */
};

typedef enum eo_code eo_store_visit_measurement(void *context, const struct eo_stored_measurement *measurement,
                                                struct eo_error *error);

/* Adds the row; folder: where the files 0 (and 1) lie, which becomes the measurement's own. visit (may be NULL) gets
   the row, of the new or of the known one. Outcomes: DONE, KNOWN (the folder stays), NO_DESIGN. Errors: EO_ERROR_FILE
   too when the files cannot be brought to the disk. */
enum eo_code eo_store_add_measurement(struct eo_store *store, const struct eo_stored_measurement *measurement,
                                      const char *folder, eo_store_visit_measurement *visit, void *context,
                                      enum eo_measurement_outcome *outcome, struct eo_error *error);

/* Outcomes: DONE (visit was called), MISSING. */
enum eo_code eo_store_find_measurement(struct eo_store *store, int64_t id, eo_store_visit_measurement *visit,
                                       void *context, enum eo_measurement_outcome *outcome, struct eo_error *error);
enum eo_code eo_store_find_measurement_digest(struct eo_store *store, const char *digest,
                                              eo_store_visit_measurement *visit, void *context,
                                              enum eo_measurement_outcome *outcome, struct eo_error *error);

/* At most limit rows of a design (0: of all) with a number below before (0: from the newest), newest first, without
   their results. */
enum eo_code eo_store_list_measurements(struct eo_store *store, int64_t design, int64_t before, int limit,
                                        eo_store_visit_measurement *visit, void *context, struct eo_error *error);

/* Its row and its files. Outcomes: DONE, MISSING. */
enum eo_code eo_store_remove_measurement(struct eo_store *store, int64_t id, enum eo_measurement_outcome *outcome,
                                         struct eo_error *error);

/* Bytes of all files. */
enum eo_code eo_store_measured_bytes(struct eo_store *store, int64_t *bytes, struct eo_error *error);

/* Puts DATA/measurements in order after whatever ended the process before. Unfinished uploads go away, and so does what
   somebody asked to have deleted. A recording without a row (an older database was put back, or an upload ended before
   its answer) is set aside: moved to DATA/measurements/lost+found, under its number or NUMBER-2, ... where that is
   taken; *aside: how many. What is not ours stays. Errors: EO_ERROR_FILE too when there are recordings beside a
   database that never had a design. Nobody else may add or remove meanwhile: once, when the server starts. */
enum eo_code eo_measurement_folder_tidy(struct eo_store *store, int *aside, struct eo_error *error);

/* A new empty folder for files on their way, below the data folder; copied to path[size]. */
enum eo_code eo_measurement_folder_new(struct eo_store *store, char *path, size_t size, struct eo_error *error);

/* With the files in it that we put there; it stays when it holds anything else, or cannot be removed. */
void eo_measurement_folder_remove(const char *path);

/* SHA-256 of a file's bytes. */
enum eo_code eo_measurement_file_hash(const char *path, char sha256[EO_HASH_LENGTH + 1], struct eo_error *error);

/* "DATA/measurements/ID/FILE"; false: it does not fit. */
bool eo_measurement_file_path(const struct eo_store *store, int64_t id, int file, char *path, size_t size);

#endif
