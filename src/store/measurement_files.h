/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The files behind measurements on their way to the disk; for this floor alone. In DATA/measurements: ID, the files of
   a row; incoming-XXXXXX, an upload on its way; deleted-ID, a row's files whose deletion was asked for. */
#ifndef EASEOFF_STORE_MEASUREMENT_FILES_H
#define EASEOFF_STORE_MEASUREMENT_FILES_H

#include <stdbool.h>
#include <stddef.h>

#include "store/store.h"

#define EO_MEASUREMENT_INCOMING "incoming-"
#define EO_MEASUREMENT_DELETED "deleted-"

enum { EO_STORE_PATH = 4096, EO_MEASUREMENT_LETTERS = 6 /* that mkdtemp() and mkstemp() choose */ };

/* Whether we name files in such folders so: 0 and 1, and what reading an upload puts beside them for a while. */
bool eo_measurement_file_is_ours(const char *name);

/* "DATA/measurements/PREFIXID"; false: it does not fit. */
bool eo_measurement_folder_path(const struct eo_store *store, const char *prefix, int64_t id, char *path, size_t size);

/* Files 0..files - 1 and the folder's entries are on the disk afterwards. */
enum eo_code eo_measurement_folder_flush(const char *folder, int files, struct eo_error *error);

/* The folder becomes that of a measurement; whatever holds files under this number already is an error. */
enum eo_code eo_measurement_folder_keep(const struct eo_store *store, const char *folder, int64_t id,
                                        struct eo_error *error);

/* ... and is the folder on its way again, after a transaction that could not be finished. */
void eo_measurement_folder_give_back(const struct eo_store *store, const char *folder, int64_t id);

/* deleted: the folder of a measurement is marked as one whose deletion was asked for; else the mark is taken off. One
   that is not there is fine. */
enum eo_code eo_measurement_folder_mark(const struct eo_store *store, int64_t id, bool deleted, struct eo_error *error);

/* A marked folder goes away. */
void eo_measurement_folder_drop(const struct eo_store *store, int64_t id);

/* Whatever stands under the number, marked or not. */
bool eo_measurement_folder_is_there(const struct eo_store *store, int64_t id);

/* The highest number of a recording here, deleted half-way or set aside; 0: none. What has no number of ours does not
   count: eo_measurement_folder_is_there() tells whether it stands in the way. */
int64_t eo_measurement_folder_highest(const struct eo_store *store);

#endif
