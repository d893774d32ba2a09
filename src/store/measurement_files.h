/* The files behind measurements on their way to the disk; for this floor alone. */
#ifndef EASEOFF_STORE_MEASUREMENT_FILES_H
#define EASEOFF_STORE_MEASUREMENT_FILES_H

#include "store/store.h"

enum { EO_STORE_PATH = 4096 };

/* Files 0..files - 1 and the folder's entries are on the disk afterwards. */
enum eo_code eo_measurement_folder_flush(const char *folder, int files, struct eo_error *error);

/* The folder becomes that of a measurement. */
enum eo_code eo_measurement_folder_keep(const struct eo_store *store, const char *folder, int64_t id,
                                        struct eo_error *error);

/* The folder of a measurement goes away. */
void eo_measurement_folder_drop(const struct eo_store *store, int64_t id);

#endif
